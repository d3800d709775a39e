// Replays: a file is played again and verified; then one can go to any time of it.

import { Replay } from "arkanoid/replay";
import { download, make, picks } from "arkanoid/data";

const MOST_SNAPSHOTS = 2000;
const LEAST_APART = 256; // decisions between two snapshots
const BUSY = 24; // milliseconds of verifying between two pictures
const MOST_BYTES = 64 << 20;

export class Viewer {
  /** @param {object} app what all pages share, see `app.js` */
  constructor(app) {
    this.app = app;
    this.phase = "empty";
    const [drop, file] = ["drop", "file"].map((id) => document.getElementById(id));
    document.getElementById("open").onclick = () => file.click();
    picks(file, (picked) => this._take(picked));
    this._mine = document.getElementById("mine");
    this._mine.onclick = () => this._begin(app.played(), "The game just played");
    this._scrub = document.getElementById("scrub");
    this._scrub.oninput = () => {
      this.leave();
      this._goTo(Number(this._scrub.value));
    };
    document.getElementById("first").onclick = () => this._restart();
    document.getElementById("keep").onclick = () => this._keep();
    this._drop = drop;
  }

  /** Take a file that is dropped anywhere. */
  async dropped(file) {
    await this._take(file);
  }

  get game() {
    return this._game ?? this._blank;
  }

  get runs() {
    return this.phase === "playing";
  }

  /** Nobody can steer. */
  get steers() {
    return null;
  }

  get deed() {
    if (this.phase === "empty" || this.phase === "verifying") return null;
    return { playing: "Pause", over: "Again" }[this.phase] ?? "Go on";
  }

  async enter() {
    this._mine.hidden = !this.app.played();
    if (this._blank) return;
    // Until there is a replay: the field as it is before the first game.
    this._blank = await this.app.arkanoid.open("lite by hand");
    this._blank.reset({ seed: 0, bricks: "." });
  }

  leave() {
    if (this.runs) this.phase = "paused";
  }

  press(key) {
    if (this.phase === "empty" || this.phase === "verifying") return;
    if (key === "pause" || key === "fire") this._pause();
    else if (key === "restart") this._restart();
    else if (key === "once") this._once(1);
    else if (key === "right") this._once(this._second);
    else if (key === "left") this._once(-this._second);
  }

  release() {}

  point() {}

  tick() {
    if (this.phase === "verifying") return this._verify();
    if (!this.runs) return false;
    if (this._at < this._replay.length) this._step();
    if (this._at === this._replay.length) this.phase = "over";
    return this.runs;
  }

  notice() {
    const band = true;
    if (this.phase === "empty") {
      return { title: "No replay yet", lines: ["Drop a file here."], band };
    }
    if (this.phase === "verifying") return { title: "Verifying", lines: [this._share()], band };
    if (this.phase === "paused") return { buttons: [["Go on", () => this._pause()]] };
    if (this.phase === "over") {
      const { score, round } = this._replay.result;
      const buttons = [["Again", () => this._pause()]];
      return { title: "The end", lines: [`Score ${score} · round ${round}`], buttons, band: true };
    }
    return {};
  }

  painted() {
    this.app.stage.sheet();
    if (!this._replay) return;
    this._scrub.value = this._at;
    const [now, end] = [this._at, this._replay.length].map((decision) => this._clock(decision));
    document.getElementById("time").value = `${now} of ${end}`;
  }

  async _take(file) {
    const turn = (this._turn = Symbol());
    this._forget();
    try {
      if (file.size > MOST_BYTES) throw new Error("the file is too large for a replay");
      const bytes = new Uint8Array(await file.arrayBuffer());
      await this._begin(await Replay.fromBytes(bytes, this._blank), file.name, turn);
    } catch (error) {
      if (this._turn === turn) this._tell(file.name, `${sentence(reason(error))}.`, false);
    }
  }

  /** Begin to verify a replay, unless another one was asked for meanwhile. */
  async _begin(replay, name, turn = (this._turn = Symbol())) {
    if (this._turn !== turn) return;
    this._forget();
    const { arkanoid, stage } = this.app;
    let game;
    try {
      game = await replay.open(arkanoid);
    } catch (error) {
      if (this._turn === turn) this._tell(name, `${sentence(reason(error))}.`, false);
      return;
    }
    if (this._turn !== turn) return;
    this._game = game;
    this._replay = replay;
    this._name = name;
    this._apart = Math.max(LEAST_APART, Math.ceil(replay.length / MOST_SNAPSHOTS));
    this._second = Math.round(this._rate);
    this._snapshots = [];
    this._course = replay.play(this._game);
    this._at = 0;
    this._scrub.max = replay.length;
    this.phase = "verifying";
    this._fillFacts();
    this._verify();
    stage.stale = true;
  }

  /** How many decisions there are in a second of the game. */
  get _rate() {
    return this.app.arkanoid.manifest.rules.TICKS_PER_SECOND / this._game.config.frame_skip;
  }

  /** Play on for a while, and compare checksums. @returns {boolean} false: a picture is due */
  _verify() {
    const until = performance.now() + BUSY;
    try {
      while (performance.now() < until) {
        const { value, done } = this._course.next();
        if (done) {
          this._verified();
          return false;
        }
        this._at = value;
        if (value % this._apart === 0) this._snapshots.push(this._game.save());
      }
    } catch (error) {
      const name = this._name;
      this._forget();
      this._tell(name, `Not the same game: ${reason(error)}.`, false);
    }
    return false;
  }

  _verified() {
    const { checksums } = this._replay;
    this._tell(this._name, `The same game: all ${checksums.length} checksums are equal.`, true);
    this._goTo(0);
    this.phase = "playing";
    this.app.stage.focus();
  }

  _step() {
    const { commands } = this._replay;
    this.app.speaker.before(this._game);
    this._game.step([commands[2 * this._at], commands[2 * this._at + 1]]);
    this.app.speaker.after();
    this._at += 1;
  }

  /** Go to the state after a number of decisions. */
  _goTo(decision) {
    const place = Math.min(Math.floor(decision / this._apart), this._snapshots.length - 1);
    this._game.restore(this._snapshots[place]);
    const { commands } = this._replay;
    for (this._at = place * this._apart; this._at < decision; this._at += 1) {
      this._game.step([commands[2 * this._at], commands[2 * this._at + 1]]);
    }
    if (this.phase === "over") this.phase = "paused";
    this.app.stage.stale = true;
  }

  _pause() {
    if (this.phase === "over") this._goTo(0);
    this.phase = this.runs ? "paused" : "playing";
    this.app.stage.stale = true;
  }

  _once(decisions) {
    this.leave();
    this._goTo(Math.min(this._replay.length, Math.max(0, this._at + decisions)));
  }

  _restart() {
    this._goTo(0);
    this.phase = "playing";
  }

  async _keep() {
    const name = this._name.endsWith(".replay") ? this._name : "arkanoid.replay";
    download(await this._replay.toBytes(this._blank), name);
  }

  _forget() {
    this.phase = "empty";
    this._game = this._replay = null;
    document.getElementById("played").hidden = true;
    this.app.stage.stale = true;
  }

  /** Say what came of a file. */
  _tell(name, text, good) {
    document.getElementById("played").hidden = false;
    document.getElementById("replay-name").textContent = name;
    const verdict = document.getElementById("verdict");
    verdict.textContent = text;
    verdict.className = good ? "verdict good" : "verdict bad";
    const shown = document.getElementById("played").querySelectorAll("dl, label, input, .row");
    for (const element of shown) {
      element.hidden = !this._replay;
    }
  }

  _fillFacts() {
    const { result, length, version } = this._replay;
    const facts = {
      Score: result.score,
      Round: result.round,
      "Lives left": result.lives,
      Length: `${this._clock(length)}, ${length} decisions`,
      "Made by": `Arkanoid ${version}`,
    };
    const rows = Object.entries(facts).flatMap(([name, value]) => {
      return [make("dt", {}, name), make("dd", {}, String(value))];
    });
    document.getElementById("replay-facts").replaceChildren(...rows);
    this._tell(this._name, "", true);
  }

  _share() {
    return `${Math.floor((100 * this._at) / Math.max(1, this._replay.length))} %`;
  }

  /** @returns {string} minutes and seconds until a decision */
  _clock(decision) {
    const seconds = Math.floor(decision / this._rate);
    return `${Math.floor(seconds / 60)}:${String(seconds % 60).padStart(2, "0")}`;
  }
}

/** @returns {string} why a file can't be shown. Some lack what others have. */
function reason(error) {
  const lacks = error instanceof TypeError || error instanceof SyntaxError;
  return lacks ? "the replay is damaged" : error.message;
}

function sentence(text) {
  return text[0].toUpperCase() + text.slice(1);
}
