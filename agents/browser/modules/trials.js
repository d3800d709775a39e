// Trials: an agent plays a level again and again, as fast as it can.

import { Agent } from "arkanoid/network";
import { randomSeed } from "arkanoid/levels";

const MOST_TICKS = 5 * 60 * 60; // five minutes of a game: it will not clear the level any more
const BUSY = 24; // milliseconds between two pictures

/** @typedef {{played: number, cleared: number, ticks: number}} Outcome ticks: of cleared games */

export class Trials {
  /**
   * @param {Arkanoid} arkanoid
   * @param {{name: string, game: string}} agent
   * @param {(name: string) => Promise<Uint8Array | null>} network gives the agent's latest one
   */
  constructor(arkanoid, agent, network) {
    this._arkanoid = arkanoid;
    this._described = agent;
    this._network = network;
  }

  /** Whether this agent's game has a boss. */
  get knowsBoss() {
    return this._arkanoid.manifest.games[this._described.game].config.enemies;
  }

  /**
   * Let the agent play. A later call ends an earlier one.
   * @param {object} level for `Game.reset`
   * @param {number} count of games
   * @param {(outcome: Outcome) => void} tell is called after each game
   * @returns {Promise<boolean>} whether there is an agent
   */
  async run(level, count, tell) {
    const turn = (this._turn = Symbol());
    const outcome = { played: 0, cleared: 0, ticks: 0 };
    const { name, game: opened } = this._described;
    const network = await this._network(name);
    if (!network) return false;
    // The agent of a run that is followed changes.
    if (network !== this._known) this._agent = new Agent(await this._arkanoid.open(opened), network);
    this._known = network;
    if (this._turn !== turn) return true;
    while (outcome.played < count) {
      const game = this._play(level);
      while (!game.next().done) {
        await new Promise((resolve) => setTimeout(resolve));
        if (this._turn !== turn) return true;
      }
      const { world } = this._agent.game;
      outcome.played += 1;
      if (world.round_number > 1) {
        outcome.cleared += 1;
        outcome.ticks += this._ticks;
      }
      tell(outcome);
    }
    return true;
  }

  /** Forget the games that are being played. */
  stop() {
    this._turn = null;
  }

  /** Play a game until its first round is over; yields when it is time for a picture. */
  *_play(level) {
    const { game, config } = this._agent;
    const every = config.frame_skip / game.config.frame_skip;
    game.reset({ seed: randomSeed(), ...level });
    const { world } = game;
    let until = performance.now() + BUSY;
    for (this._ticks = 0; this._ticks < MOST_TICKS; ) {
      const { action } = this._agent.judge();
      for (let decision = 0; decision < every; decision += 1) {
        game.step(action);
        this._ticks += game.config.frame_skip;
        if (game.over || world.round_number > 1) return;
      }
      if (performance.now() > until) {
        yield;
        until = performance.now() + BUSY;
      }
    }
  }
}
