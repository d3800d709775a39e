// High scores, kept by the browser; forgotten with the page where it keeps nothing.

const PLACE = "arkanoid.scores";
const MOST_KEPT = 10; // of one game

/** @typedef {{score: number, round: number, day: string}} Score */

export class Scores {
  constructor() {
    this._games = {};
  }

  /** @returns {Score[]} of a game, the highest first */
  best(game) {
    this._read();
    return this._games[game] ?? [];
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
    } catch {
      // It is full, or forbidden.
    }
    return place;
  }

  /** Read them anew: another window may have written. */
  _read() {
    try {
      const read = JSON.parse(localStorage.getItem(PLACE));
      if (read && typeof read === "object") this._games = read;
    } catch {
      // Forbidden, or damaged.
    }
  }
}
