// Playing by hand: one game after another, with pauses and titles. As in `envs/play/sitting.py`.

import { Recorder } from "arkanoid/replay";
import { Controls } from "arkanoid/controls";
import { download, make, timeStamp } from "arkanoid/data";
import { StartForm, randomSeed, roundTitle } from "arkanoid/levels";

const GAMES = [
  { name: "full", title: "Full", hint: "Capsules, enemies and a boss.", game: "full by hand" },
  { name: "lite", title: "Lite", hint: "Ball and bricks only.", game: "lite by hand" },
];
const QUESTIONS = { restart: "Restart?", next: "Next round?", change: "Change the game?" };
const SHOWN_SCORES = 5;

export class Play {
  /** @param {object} app what all pages share, see `app.js` */
  constructor(app) {
    this.app = app;
    this._sitting = app.facts.sitting;
    this._controls = new Controls(app.facts.steps);
    this._recorders = {};
    this._place = -1; // of the latest game among the high scores
    this.phase = "opening";
    this._panel = app.panel("play");
    const form = this._panel.querySelector("form");
    this._form = new StartForm(form, app.arkanoid.manifest, "Game", GAMES, () => this._change());
    form.onsubmit = (event) => {
      event.preventDefault();
      if (this.phase !== "asked") this._goOn();
    };
    for (const button of this._panel.querySelectorAll("[data-do]")) {
      button.onclick = () => this[button.dataset.do]();
    }
    this._save = this._panel.querySelector("[data-do=save]");
    this._fillThings(app.facts.things);
  }

  get game() {
    return this._recorder?.game;
  }

  /** Whether the game runs. */
  get runs() {
    return this.phase === "playing";
  }

  /** Whether the player steers; null: nobody can. */
  get steers() {
    return true;
  }

  /** What the pause button does; null: nothing. */
  get deed() {
    return { playing: "Pause", over: "Again", ready: "Start" }[this.phase] ?? "Go on";
  }

  async enter() {
    if (!this.game) await this._layOut();
  }

  leave() {
    if (this.runs) this._enter("paused");
  }

  /** Pause: the player looks elsewhere. */
  loseFocus() {
    this.leave();
  }

  press(key) {
    if (key === "restart" || key === "next") this._ask(key);
    else if (key === "pause") this.runs ? this._enter("paused") : this._goOn();
    else if (key === "once") this._once();
    else if (key === "fire" && !this.runs) this._goOn();
    else this._controls.press(key);
  }

  release(key) {
    this._controls.release(key);
  }

  point(x) {
    this._controls.point(x);
  }

  /** Lay out a game with a level of the editor. */
  offer(level) {
    this._form.offer(level);
    this._change();
  }

  restart() {
    this._ask("restart");
  }

  next() {
    this._ask("next");
  }

  /** The replay of the game so far; undefined before its first tick. */
  get recorded() {
    return this.game?.world.decisions > 0 ? this._recorder.replay() : undefined;
  }

  /** Let the user keep the game so far. */
  async save() {
    const file = await this.recorded.toBytes(this.game);
    download(file, `arkanoid_${timeStamp()}.replay`);
  }

  /** Play a tick. @returns {boolean} whether the game goes on */
  tick() {
    if (!this.runs) return false;
    this._step();
    return this.runs;
  }

  /** @returns {object} what is written over the picture */
  notice() {
    const { world } = this.game;
    if (this.phase === "ready") return this._readyNotice();
    if (this.phase === "paused") {
      return { title: "Paused", buttons: [["Go on", () => this._goOn()]], band: true };
    }
    if (this.phase === "asked") return this._question();
    if (this.phase === "over") return this._ending();
    const { IDLE_TICKS, TICKS_PER_SECOND } = this.app.arkanoid.manifest.rules;
    const left = IDLE_TICKS - world.idle;
    if (left <= this._sitting.warning) {
      return { lines: [`Hit a brick within ${Math.ceil(left / TICKS_PER_SECOND)} s`] };
    }
    if (this._roundTicks < this._sitting.title) return this._roundNotice();
    return {};
  }

  _step() {
    const { game } = this;
    const { world } = game;
    this.app.speaker.before(game);
    this._recorder.step(this._controls.command(world.paddle_x, this._rules.paddle_speed));
    this.app.speaker.after();
    if (world.lives_lost && !game.over) this.app.say(`Life lost. ${world.lives} left.`);
    this._roundTicks = world.rounds_cleared ? 0 : this._roundTicks + 1;
    if (world.rounds_cleared) this.app.say(`Round ${world.round_number}: ${roundTitle(game)}.`);
    this._save.disabled = false;
    if (game.over) this._end();
  }

  /** Play one tick, and pause. */
  _once() {
    if (this.runs) {
      this._enter("paused");
    } else if (this.phase === "ready" || this.phase === "paused") {
      this._step();
      if (this.phase !== "over") this.phase = "paused";
      this.app.stage.stale = true;
    }
  }

  /** Lay out a new game as the form says. */
  async _layOut() {
    this._keepUnfinished();
    const turn = (this._turn = Symbol());
    const { game: name } = this._form.choice;
    const { app } = this;
    this.phase = "opening";
    this._recorders[name] ??= new Recorder(await app.arkanoid.open(name));
    if (this._turn !== turn) return; // another one was asked for meanwhile
    this._recorder = this._recorders[name];
    this._rules = this.game.machine.record("Rules", this.game.address("rules"));
    this._laidOut = this._form.state;
    this._options = this._form.options;
    this._recorder.reset({ seed: randomSeed(), ...this._options });
    this._roundTicks = this._sitting.title;
    this._save.disabled = true;
    this._enter("ready");
    this._fillScores();
    app.stage.stale = true;
  }

  _end() {
    this._keepScore();
    this._overSince = performance.now();
    this._enter("over");
    const { score, round_number: round } = this.game.world;
    this.app.say(`Game over. Score ${score}, round ${round}.`);
  }

  _keepUnfinished() {
    if (this._begun && this.phase !== "opening") this._keepScore();
  }

  /** Keep the score of an unfinished game: the page goes. */
  close() {
    this._keepUnfinished();
  }

  get _begun() {
    const { game } = this;
    return game && game.world.decisions > 0 && !game.over;
  }

  _keepScore() {
    const { score, round_number: round } = this.game.world;
    this._place = this.app.scores.add(this._scoresName, score, round);
    this._fillScores();
  }

  /** What distinguishes games whose scores can be compared. */
  get _scoresName() {
    return `${this.game.name} ${JSON.stringify(this._options)}`;
  }

  /** The form says something else. */
  _change() {
    if (!this._begun) this._layOut();
    // A further change is no answer.
    else if (this.phase !== "asked" || this._asked !== "change") this._ask("change");
  }

  /** Lay out another game; if this one has begun, only when asked a second time. */
  _ask(key) {
    if (key !== "change" && this._laidOut) this._form.state = this._laidOut;
    if (this._begun && !(this.phase === "asked" && this._asked === key)) {
      this._asked = key;
      this._enter("asked");
      this.app.stage.frame.scrollIntoView({ block: "nearest" });
      this.app.say(QUESTIONS[key]);
      return;
    }
    if (key === "next") this._form.chooseRound(this.game.world.round_number + 1);
    this._layOut();
    this.app.stage.focus();
  }

  /** Start the game, continue it, or lay out another one. */
  _goOn() {
    if (this.phase === "opening") return;
    this.app.stage.focus();
    const { rules } = this.app.arkanoid.manifest;
    const wait = (1000 * this._sitting.over) / rules.TICKS_PER_SECOND;
    if (this.phase === "asked") this._form.state = this._laidOut;
    if (this.phase !== "over") this._enter("playing");
    else if (performance.now() - this._overSince >= wait) this._layOut();
  }

  _enter(phase) {
    this.phase = phase;
    this._controls.letGo();
  }

  _roundNotice() {
    const { round_number: round } = this.game.world;
    const title = roundTitle(this.game);
    return { title, lines: title === `Round ${round}` ? [] : [`Round ${round}`] };
  }

  _readyNotice() {
    const [best] = this.app.scores.best(this._scoresName);
    const notice = this._roundNotice();
    if (best) notice.lines.push(`High score ${best.score}`);
    const small = matchMedia("(hover: none)").matches
      ? "Drag to move, tap to fire"
      : "Mouse or arrow keys move, space fires";
    return { ...notice, buttons: [["Start", () => this._goOn()]], small, band: true };
  }

  _question() {
    const yes = () => this._ask(this._asked);
    const buttons = [["No, go on", () => this._goOn()], ["Yes, leave this game", yes]];
    return { title: QUESTIONS[this._asked], buttons, band: true };
  }

  _ending() {
    const { score, round_number: round } = this.game.world;
    const table = this.app.scores
      .best(this._scoresName)
      .slice(0, SHOWN_SCORES)
      .map((entry, place) => [
        [`${place + 1}.`, entry.score, `round ${entry.round}`], place === this._place]);
    const buttons = [["Play again", () => this._goOn()]];
    const lines = [`Score ${score} · round ${round}`];
    return { title: "Game over", lines, table, buttons, band: true };
  }

  _fillScores() {
    const best = this.app.scores.best(this._scoresName).slice(0, SHOWN_SCORES);
    const rows = best.map(({ score, round, day }, place) => {
      const cells = [`${place + 1}.`, String(score), `round ${round} · ${day}`];
      const isNew = this.phase === "over" && place === this._place;
      const row = make("li", { className: isNew ? "new" : "" });
      row.append(...cells.map((cell) => make("span", {}, cell)));
      return row;
    });
    if (!rows.length) rows.push(make("li", { className: "none" }, "None yet with this start."));
    document.getElementById("scores").replaceChildren(...rows);
  }

  _fillThings(things) {
    const list = document.getElementById("things");
    for (const { name, meaning, picture, width } of things) {
      const image = make("img", { src: `data:image/png;base64,${picture}`, alt: "", width });
      list.append(make("dt", {}, image, make("span", {}, name)), make("dd", {}, meaning));
    }
  }
}
