// Level files: the text that `envs/levels/files.py` reads and writes.

/**
 * @typedef {object} Level
 * @property {string} name
 * @property {string} [comment] of the author
 * @property {string} bricks a letter for each cell
 * @property {boolean} boss
 */

const HEADINGS = ["name", "comment", "boss"];

/** @param {Level} level @returns {string} its file */
export function levelText({ name, comment = "", bricks, boss }, { COLUMNS }) {
  const rows = bricks.match(new RegExp(`.{${COLUMNS}}`, "g"));
  while (rows.length > 1 && /^\.*$/.test(rows.at(-1))) rows.pop();
  const headings = [`name: ${printable(name)}`];
  if (comment) headings.push(`comment: ${printable(comment)}`);
  if (boss) headings.push("boss: yes");
  return [...headings, "", ...rows, ""].join("\n");
}

/**
 * @param {string} text of a file
 * @param {object} rules
 * @param {string} name of a level whose file says none
 * @returns {Level}
 * @throws {Error} it is no level
 */
export function parseLevel(text, { BRICK_LETTERS, CELLS, COLUMNS, ROWS }, name = "Mine") {
  const level = { name, comment: "", bricks: "", boss: false };
  const refuse = (index, why) => {
    throw new Error(`This is no level: line ${index + 1}: ${why}.`);
  };
  text.trimEnd().split(/\r?\n/).forEach((line, index) => {
    const colon = level.bricks ? -1 : line.indexOf(":");
    if (colon >= 0) {
      const [key, value] = [line.slice(0, colon).trim(), line.slice(colon + 1).trim()];
      if (!HEADINGS.includes(key)) refuse(index, `headings are ${HEADINGS.join(", ")}`);
      if (key === "boss" && !["yes", "no"].includes(value)) refuse(index, "boss is yes or no");
      level[key] = key === "boss" ? value === "yes" : value;
    } else if (line.trim() || level.bricks) {
      const row = line.trimEnd();
      const strange = Array.from(row).find((letter) => !BRICK_LETTERS.includes(letter));
      if (strange) refuse(index, `“${strange}” is no brick`);
      if (row.length !== COLUMNS) refuse(index, `a row has ${COLUMNS} letters`);
      level.bricks += row;
    }
  });
  if (level.bricks.length > CELLS) throw new Error(`This is no level: ${ROWS} rows fit the field.`);
  level.bricks = level.bricks.padEnd(CELLS, ".");
  return level;
}

/** @returns {string} a heading without what Python refuses there: letters that nobody sees */
function printable(text) {
  return text.replace(/\p{Z}/gu, " ").replace(/\p{C}/gu, "");
}
