// A run of a training, followed: what its files say by now, and its latest agent.

import { bytesOf } from "arkanoid/data";

const EVERY = 2000; // milliseconds
const ENDED = "The command that served this page has ended. This is what it said last.";

/**
 * What a run says; see `FollowedRun.news` in `following.py`.
 * @typedef {object} News
 * @property {"training" | "stopped" | "finished" | "lost"} state
 * @property {string} said
 * @property {number | null} done
 * @property {Array<{title: string, steps: number[], values: number[]}>} curves
 * @property {string | null} version
 * @property {string} agent
 */

export class Following {
  /**
   * @param {string} name of the run's agent
   * @param {{live: boolean, news: News}} run live: whether a server knows more
   * @param {() => void} changed is called when there is news
   */
  constructor(name, { live, news }, changed) {
    this.name = name;
    this.live = live;
    this.news = news;
    this._changed = changed;
    this._first = live ? this._look() : this._unpack();
    if (live) this._follow();
  }

  /** @returns {Promise<Uint8Array | null>} the latest agent's network; null if there is none yet */
  async network() {
    await this._first;
    return this._network;
  }

  async _unpack() {
    this._network = await bytesOf(`agent-${this.name}`);
  }

  async _follow() {
    await this._first;
    for (;;) {
      this._changed();
      await new Promise((resolve) => setTimeout(resolve, EVERY));
      if (!document.hidden) await this._look();
    }
  }

  async _look() {
    try {
      const news = await (await ask("run.json")).json();
      if (news.version !== this._version) {
        const asked = news.version && (await ask("agent"));
        this._network = asked ? new Uint8Array(await asked.arrayBuffer()) : null;
        this._version = news.version;
      }
      this.news = news;
    } catch {
      // Of a run that has ended there is no more news.
      if (this.news.state === "finished") return;
      this.news = { ...this.news, state: "lost", said: ENDED };
    }
  }
}

async function ask(name) {
  const answer = await fetch(name);
  if (!answer.ok) throw new Error(`${name}: ${answer.status}`);
  return answer;
}
