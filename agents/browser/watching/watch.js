// Watching agents: what they do, think and see; taking over from them, and handing back.

import { Agent } from "arkanoid/network";
import { Controls } from "arkanoid/controls";
import { StartForm, randomSeed, roundTitle } from "arkanoid/levels";
import { Pictures, Planes, Seen } from "arkanoid/seen";
import { Thoughts } from "arkanoid/thoughts";
import { Training } from "arkanoid/training";

const SEEN_EVERY = 6; // pictures
const STILL = matchMedia("(prefers-reduced-motion: reduce)");
/** What is shown of what agents see, by what they see. */
const VIEWS = [
  ["seen", Seen, ["vector"]], ["planes", Planes, ["vector", "grid"]], ["pictures", Pictures, ["rgb"]],
];
const LANDING = { colour: "#ffd866", radius: 0.2, height: 1.4 }; // brick widths

export class Watch {
  /** @param {object} app what all pages share, see `app.js` */
  constructor(app) {
    this.app = app;
    this._sitting = app.facts.sitting;
    this._controls = new Controls(app.facts.steps);
    this._agents = {};
    this._networks = {}; // of the agents
    this.phase = "opening";
    const panel = app.panel("watch");
    const form = panel.querySelector("form");
    const choices = app.facts.agents.map(({ name, game }) => {
      return { name, title: name, hint: "", game };
    });
    this._form = new StartForm(form, app.arkanoid.manifest, "Agent", choices, () => this._layOut());
    if (app.facts.asked) this._form.ask(app.facts.asked);
    form.onsubmit = (event) => event.preventDefault();
    panel.querySelector("[data-do=next]").onclick = () => this._next();
    this._take = panel.querySelector("[data-do=hand]");
    this._take.onclick = () => this._toggle();
    this._landing = document.getElementById("landing");
    this._landing.onchange = () => (app.stage.stale = true);
    this._thoughts = new Thoughts();
    this._views = VIEWS.map(([id, View, kinds]) => {
      const details = document.getElementById(id);
      details.ontoggle = () => this._see(true);
      return { details, kinds, view: new View(details.lastElementChild) };
    });
    this._pictures = 0;
    this._training = app.following && new Training(document.getElementById("training"));
    this._showTraining();
  }

  get game() {
    return this._agent?.game;
  }

  get runs() {
    return this.phase === "playing" || this.phase === "over";
  }

  /** Whether the player steers, and not the agent. */
  get steers() {
    return this._hand;
  }

  get deed() {
    if (this.phase === "waiting") return null;
    return this.phase === "paused" ? "Go on" : "Pause";
  }

  async enter() {
    if (!this.game) await this._layOut();
    if (this.phase === "paused" && !STILL.matches) this.phase = "playing";
    else if (STILL.matches && this.phase !== "waiting") this.phase = "paused";
  }

  /** Show what the run says that is followed, and its latest agent. */
  async renew() {
    this._showTraining();
    const { name, game: played } = this._form.choice;
    if (name !== this.app.following.name || this.phase === "opening") return;
    const turn = this._turn;
    const network = await this.app.network(name);
    if (!network || network === this._networks[name]) return;
    if (this.phase === "waiting") {
      await this._layOut();
      if (STILL.matches) this.phase = "paused";
      return;
    }
    const agent = new Agent(await this.app.arkanoid.open(played), network);
    if (this._turn !== turn) return; // the next game has it
    // It plays on from here.
    agent.game.restore(this.game.save());
    this._agents[name] = agent;
    this._networks[name] = network;
    this._become(agent);
    this._judgement = null;
    this.app.stage.stale = true;
  }

  leave() {
    this._controls.letGo();
    if (this.runs) this.phase = "paused";
  }

  /** Pause if the player steers; agents go on. */
  loseFocus() {
    if (this._hand && this.phase === "playing") this._pause();
  }

  press(key) {
    if (key === "restart") this._layOut();
    else if (key === "next") this._next();
    else if (this.phase === "waiting") return;
    else if (key === "pause" || (key === "fire" && !(this._hand && this.runs))) this._pause();
    else if (key === "once") this._once();
    else if (key === "hand") this._toggle();
    else {
      if (key === "left" || key === "right") this._takeOver(true);
      this._controls.press(key);
    }
  }

  release(key) {
    this._controls.release(key);
  }

  point(x, y, held) {
    if (held && this.phase === "playing") this._takeOver(true);
    if (this._hand) this._controls.point(x);
  }

  /** Play a tick. @returns {boolean} whether there are more */
  tick() {
    if (!this.runs) return false;
    if (this.phase === "over") return this._wait();
    this._step();
    return true;
  }

  notice() {
    if (this.phase === "waiting") return { title: "No agent", lines: [this._lack], band: true };
    if (this.phase === "paused") {
      return { title: "Paused", buttons: [["Go on", () => this._pause()]], band: true };
    }
    const { score, round_number: round } = this.game.world;
    if (this.phase === "over") {
      return { title: "Game over", lines: [`Score ${score} · round ${round}`] };
    }
    if (this._handTicks > 0) {
      return { lines: [this._hand ? "You play. T hands back." : `${this._agent.name} plays.`] };
    }
    if (this._roundTicks < this._sitting.title) return { title: roundTitle(this.game) };
    return {};
  }

  /** Show what belongs to the picture that was just painted. */
  painted() {
    const { stage } = this.app;
    const pen = stage.sheet();
    if (this._landing.checked) this._mark(pen);
    if (this._judgement) this._thoughts.show(this._judgement);
    this._see(this._pictures++ % SEEN_EVERY === 0);
  }

  async _layOut() {
    const turn = (this._turn = Symbol());
    const { name, game } = this._form.choice;
    this.phase = "opening";
    const network = await this.app.network(name);
    if (!this._agents[name] || network !== this._networks[name]) {
      const opened = await this.app.arkanoid.open(game);
      if (this._turn !== turn) return;
      this._agents[name] = network ? new Agent(opened, network) : { name, game: opened };
      this._networks[name] = network;
    }
    if (this._turn !== turn) return; // another one was asked for meanwhile
    const agent = this._agents[name];
    this._become(agent);
    this.game.reset({ seed: randomSeed(), ...this._form.options });
    this._thoughts.forget();
    this._judgement = null;
    this._roundTicks = 0;
    this._takeOver(false);
    this._handTicks = 0;
    this.app.stage.stale = true;
    this._take.disabled = !network;
    this.phase = network ? "playing" : "waiting";
    if (!network) return;
    this.app.say(`${name} plays ${roundTitle(this.game)}.`);
  }

  /** Let an agent be the one that plays; or a game without one be shown. */
  _become(agent) {
    if (agent.game !== this.game) this._thoughts.begin(agent.game.meanings);
    this._agent = agent;
    this._landing.parentElement.hidden = !this.game.parts.vector.landing_x;
    for (const { details, kinds } of this._views) {
      details.hidden = !kinds.includes(agent.sees?.kind);
    }
    this._rules = this.game.machine.record("Rules", this.game.address("rules"));
    if (agent.config) this._every = agent.config.frame_skip / this.game.config.frame_skip;
  }

  /** Begin the next game, on the next level where there are several. */
  _next() {
    this._form.turn();
    return this._layOut();
  }

  get _lack() {
    return this.app.following.news.agent;
  }

  _showTraining() {
    this._training?.show(this.app.following.news);
  }

  _step() {
    const { game } = this;
    const { world } = game;
    // An agent that was trained to decide in every fourth tick does so here.
    if (!this._judgement || world.decisions % this._every === 0) this._judge();
    this.app.speaker.before(game);
    const steered = () => this._controls.command(world.paddle_x, this._rules.paddle_speed);
    game.step(this._hand ? steered() : this._judgement.action);
    this.app.speaker.after();
    this._thoughts.note(this._judgement.value);
    this._handTicks -= 1;
    this._roundTicks = world.rounds_cleared ? 0 : this._roundTicks + 1;
    if (game.over) {
      this.phase = "over";
      this._overTicks = 0;
      this.app.say(`Game over. Score ${world.score}, round ${world.round_number}.`);
    }
  }

  _judge() {
    const { action, value, probabilities } = this._agent.judge();
    this._judgement = { action, value, probabilities: Array.from(probabilities) };
  }

  /** Show the score for a while, and begin the next game. */
  _wait() {
    this._overTicks += 1;
    if (this._overTicks > this._sitting.title) this._next();
    return this.phase === "over";
  }

  _once() {
    if (this.phase === "paused" && !this.game.over) this._step();
    if (this.phase !== "over") this.phase = "paused";
    this.app.stage.stale = true;
  }

  _pause() {
    if (this.phase === "opening") return;
    const goesOn = this.game.over ? "over" : "playing";
    this.phase = this.runs ? "paused" : goesOn;
    this._controls.letGo();
  }

  _toggle() {
    this._takeOver(!this._hand);
    if (this.phase === "paused") this._pause();
    this.app.stage.focus();
  }

  _takeOver(hand) {
    if (hand === this._hand) return;
    this._hand = hand;
    this._handTicks = this._sitting.title;
    this._controls.letGo();
    this._judgement = null;
    this._take.textContent = hand ? "Hand back" : "Take over";
    if (this.phase === "playing") this.app.say(hand ? "You play." : "The agent plays.");
  }

  /** Mark where the balls will come down. */
  _mark(pen) {
    const { parts, machine } = this.game;
    if (!parts.vector.landing_x) return;
    const vector = this.game.vector();
    const { rules, view } = machine.manifest;
    const [known, xs, ticks] = ["landing_known", "landing_x", "landing_ticks"].map((name) => {
      return vector.subarray(...parts.vector[name]);
    });
    const y = view.height - rules.PADDLE_TOP;
    pen.strokeStyle = LANDING.colour;
    known.forEach((is, ball) => {
      if (!is) return;
      const x = view.wall + ((1 + xs[ball]) / 2) * rules.FIELD_WIDTH;
      pen.globalAlpha = 0.35 + 0.65 * (1 - ticks[ball]);
      pen.lineWidth = 0.06;
      pen.setLineDash([0.12, 0.12]);
      pen.beginPath();
      pen.moveTo(x, y - LANDING.height);
      pen.lineTo(x, y - LANDING.radius);
      pen.stroke();
      pen.setLineDash([]);
      pen.beginPath();
      pen.arc(x, y - rules.BALL_RADIUS, LANDING.radius, 0, 2 * Math.PI);
      pen.stroke();
    });
    pen.globalAlpha = 1;
  }

  _see(now) {
    if (!now || !this.game) return;
    for (const { details, view } of this._views) {
      if (details.open && !details.hidden) view.show(this.game, this._agent);
    }
  }
}
