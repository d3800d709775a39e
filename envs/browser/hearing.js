// What of a game can be heard: a kernel compares the game before and after a tick.

/** Ears in a game. */
export class Ears {
  /** @param {Game} game */
  constructor(game) {
    const { machine } = game;
    this._game = game;
    this._record = machine.record("Hearing");
    this._record.before = machine.reserve(machine.manifest.records.World.length);
    this._record.after = game.address("world");
    this._record.outcome = game.address("outcome");
  }

  /** Remember the game as it is before a tick. */
  listen() {
    const { machine } = this._game;
    const { before, after } = this._record;
    const { length } = machine.manifest.records.World;
    machine.bytes(before, length).set(machine.bytes(after, length));
  }

  /** @returns {string[]} the names of the tones since then, the loudest first */
  hear() {
    const { machine } = this._game;
    machine.kernels.hear(0, this._record.$address);
    const { tones } = this._record;
    return machine.manifest.tones.filter((_, place) => (tones >> place) & 1);
  }
}
