// High scores, kept by the browser; forgotten with the page where it keeps nothing.

const PLACE = "arkanoid.scores";
const MOST_KEPT = 10; // of one game

/** @typedef {{score: number, round: number, day: string}} Score */

export class Scores {
  constructor() {
    this._games = {};
    this._kept = true; // whether the browser took the last score
  }

  /** @returns {Score[]} of a game, the highest first */
  best(game) {
    this._read();
    const scores = this._games[game];
    return Array.isArray(scores) ? scores.filter(isScore) : [];
  }

  /** @returns {number} the place of a score among the best, 0 for the highest; -1 if it is not */
  add(game, score, round) {
    const kept = [...this.best(game)];
    const place = kept.filter((other) => score <= other.score).length;
    if (score <= 0 || place >= MOST_KEPT) return -1;
    kept.splice(place, 0, { score, round, day: new Date().toISOString().slice(0, 10) });
    this._games[game] = kept.slice(0, MOST_KEPT);
    try {
      localStorage.setItem(PLACE, JSON.stringify(this._games));
      this._kept = true;
    } catch {
      this._kept = false;
      // It is full, or forbidden.
    }
    return place;
  }

  /** Read them anew: another window may have written. */
  _read() {
    if (!this._kept) return;
    try {
      const read = JSON.parse(localStorage.getItem(PLACE));
      if (read && typeof read === "object" && !Array.isArray(read)) this._games = read;
    } catch {
      // Forbidden, or damaged.
    }
  }
}

/** What the browser holds may come from anywhere: from another release, say. */
function isScore(value) {
  return [value?.score, value?.round].every(Number.isFinite) && typeof value.day === "string";
}
