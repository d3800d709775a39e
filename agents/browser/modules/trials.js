// Trials: an agent plays a level again and again, as fast as it can.

import { Agent } from "arkanoid/network";
import { bytesOf } from "arkanoid/data";
import { randomSeed } from "arkanoid/levels";

const MOST_TICKS = 5 * 60 * 60; // five minutes of a game: it will not clear the level any more
const BUSY = 24; // milliseconds between two pictures

/** @typedef {{played: number, cleared: number, ticks: number}} Outcome ticks: of cleared games */

export class Trials {
  /**
   * @param {Arkanoid} arkanoid
   * @param {{name: string, game: string}} agent
   */
  constructor(arkanoid, agent) {
    this._arkanoid = arkanoid;
    this._described = agent;
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
   */
  async run(level, count, tell) {
    const turn = (this._turn = Symbol());
    const outcome = { played: 0, cleared: 0, ticks: 0 };
    this._agent ??= new Agent(
      await this._arkanoid.open(this._described.game),
      await bytesOf(`agent-${this._described.name}`),
    );
    while (outcome.played < count) {
      const game = this._play(level);
      while (!game.next().done) {
        await new Promise((resolve) => setTimeout(resolve));
        if (this._turn !== turn) return;
      }
      const { world } = this._agent.game;
      outcome.played += 1;
      if (world.round_number > 1) {
        outcome.cleared += 1;
        outcome.ticks += this._ticks;
      }
      tell(outcome);
    }
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
