// Level files: the text that `envs/levels/files.py` reads and writes.

/** @typedef {{name: string, bricks: string, boss: boolean}} Level bricks: a letter for each cell */

/** @param {Level} level @returns {string} its file */
export function levelText({ name, bricks, boss }, { COLUMNS }) {
  const rows = bricks.match(new RegExp(`.{${COLUMNS}}`, "g"));
  while (rows.length > 1 && /^\.*$/.test(rows.at(-1))) rows.pop();
  return [`name: ${name}`, ...(boss ? ["boss: yes"] : []), "", ...rows, ""].join("\n");
}

/**
 * @param {string} text of a file
 * @returns {Level}
 * @throws {Error} it is no level
 */
export function parseLevel(text, { BRICK_LETTERS, CELLS, COLUMNS, ROWS }) {
  const level = { name: "Mine", bricks: "", boss: false };
  text.trimEnd().split(/\r?\n/).forEach((line, index) => {
    const heading = level.bricks ? null : /^\s*(\w+)\s*:\s*(.*)$/.exec(line);
    if (heading) {
      const [, key, value] = heading;
      if (key === "name") level.name = value.trim();
      if (key === "boss") level.boss = value.trim() === "yes";
    } else if (line.trim() || level.bricks) {
      const row = line.trimEnd();
      const strange = Array.from(row).find((letter) => !BRICK_LETTERS.includes(letter));
      if (strange || row.length !== COLUMNS) {
        const why = strange ? `“${strange}” is no brick` : `a row has ${COLUMNS} letters`;
        throw new Error(`This is no level: line ${index + 1}: ${why}.`);
      }
      level.bricks += row;
    }
  });
  if (level.bricks.length > CELLS) throw new Error(`This is no level: ${ROWS} rows fit the field.`);
  level.bricks = level.bricks.padEnd(CELLS, ".");
  return level;
}
