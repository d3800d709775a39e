// The page: it opens the game, shows one of its parts, and passes keys, pointer and time on.

import { loadArkanoid } from "arkanoid/game";
import { Clock } from "arkanoid/clock";
import { Collide } from "arkanoid/collide";
import { FIELD_KEYS, KEYS } from "arkanoid/controls";
import { bytesOf, jsonOf } from "arkanoid/data";
import { Editor } from "arkanoid/editor";
import { Following } from "arkanoid/following";
import { Play } from "arkanoid/play";
import { Scores } from "arkanoid/scores";
import { Speaker } from "arkanoid/sound";
import { Stage } from "arkanoid/stage";
import { Viewer } from "arkanoid/viewer";
import { Watch } from "arkanoid/watch";
import { World } from "arkanoid/world";

/** What the page consists of, by the addresses of its parts: #play. */
const PARTS = {
  play: Play, watch: Watch, replay: Viewer, editor: Editor, collide: Collide, world: World,
};

class App {
  constructor(arkanoid, facts) {
    this.arkanoid = arkanoid;
    this.facts = facts;
    this.stage = new Stage(arkanoid.manifest.view);
    this.speaker = new Speaker(facts.hearing);
    this.scores = new Scores();
    this.clock = new Clock();
    this._parts = {};
    this._networks = {};
    const [first] = facts.agents;
    const changed = () => this._parts.watch?.renew();
    /** The run of the first agent, if there is one. */
    this.following = facts.run && new Following(first.name, facts.run, changed);
    this._held = new Map(); // what keys and the pointer mean that are held, by their codes
    // Some telephones fill the screen with films only.
    document.getElementById("full").hidden = !document.fullscreenEnabled;
    this._button = (id) => document.getElementById(id);
  }

  /** @returns {HTMLElement} the panel of a part */
  panel(name) {
    return document.getElementById(`panel-${name}`);
  }

  /** @returns {Promise<Uint8Array | null>} an agent's network; null if it has none yet */
  network(name) {
    if (name === this.following?.name) return this.following.network();
    return (this._networks[name] ??= bytesOf(`agent-${name}`));
  }

  /** @returns {object | undefined} the replay of the game that was played last */
  played() {
    return this._parts.play?.recorded;
  }

  /** Play a level of the editor. */
  async playLevel(level) {
    if (!(await this._go("play"))) return;
    this.part.offer(level);
    this.stage.focus();
  }

  /** Tell those who can't see. */
  say(text) {
    document.getElementById("said").textContent = text;
  }

  /** Show a part of the page. @returns {Promise<boolean>} false: the user has gone on meanwhile */
  show(name) {
    return (this._shown = this._show(name));
  }

  async _show(name) {
    const turn = (this._turn = Symbol());
    this.open = false;
    this.part?.leave();
    this.stage.say({}); // the buttons there were of the part before
    for (const panel of document.querySelectorAll(".panel")) {
      panel.hidden = panel.id !== `panel-${name}`;
    }
    for (const link of document.querySelectorAll("nav a")) {
      if (link.hash === `#${name}`) {
        link.setAttribute("aria-current", "page");
        document.title = `${link.textContent} – Arkanoid`;
      } else link.removeAttribute("aria-current");
    }
    const part = (this._parts[name] ??= new PARTS[name](this));
    this.part = part;
    document.querySelector(".stage").hidden = Boolean(part.scene);
    for (const scene of document.querySelectorAll(".scene")) {
      scene.hidden = scene.id !== `scene-${part.scene}`;
    }
    // A part that is not open yet has nothing that one could change.
    const places = document.querySelectorAll(`#panel-${name}, #scene-${name}`);
    for (const place of places) place.inert = true;
    await part.enter();
    if (this._turn !== turn) return false;
    for (const place of places) place.inert = false;
    this.open = true;
    this.stage.sheet();
    document.querySelector(".bar").hidden = Boolean(part.still);
    this.stage.offerStrip(part.steers !== null);
    this.stage.stale = true;
    return true;
  }

  /** React to a key that has a meaning. */
  press(key) {
    if (key === "faster" || key === "slower") this.clock.change(key === "faster" ? 1 : -1);
    else if (key === "full") this.stage.fillScreen();
    else if (key === "sound") this._switchSound();
    else if (this.open) this.part.press(key);
  }

  /** Listen to everything, and begin to show pictures. */
  run() {
    this._listen();
    const picture = (now) => {
      requestAnimationFrame(picture); // first: a fault must not be the end of all pictures
      this._picture(now);
    };
    requestAnimationFrame(picture);
  }

  _picture(now) {
    const { part, stage, clock } = this;
    if (!part?.game) return;
    stage.follow();
    const rate = this.arkanoid.manifest.rules.TICKS_PER_SECOND / part.game.config.frame_skip;
    clock.run(now, rate, () => {
      const more = part.tick();
      stage.stale = true;
      return more;
    });
    if (stage.stale) {
      stage.paint(part.game);
      part.painted?.();
      const { score, lives, round_number: round } = part.game.world;
      this._label(`The field: round ${round}, ${lives} lives, score ${score}`);
    }
    stage.say(part.notice());
    stage.hide(part.runs && part.steers);
    for (const id of ["pause", "once"]) this._button(id).disabled = part.deed === null;
    write(this._button("pause").firstElementChild, part.deed ?? "Pause");
    write(this._button("speed"), clock.text);
  }

  _label(text) {
    if (text !== this._labelled) this.stage.canvas.setAttribute("aria-label", text);
    this._labelled = text;
  }

  _switchSound() {
    this.speaker.switch();
    this._button("sound").setAttribute("aria-pressed", String(this.speaker.on));
  }

  _listen() {
    addEventListener("hashchange", async () => {
      if (!(await this.show(partOf(location.hash)))) return;
      (this.part.scene ? this.part : this.stage).focus();
    });
    // Who points at things needs no ring around the field; who goes on by Tab does.
    const { classList } = document.documentElement;
    addEventListener("pointerdown", () => classList.add("points"), true);
    addEventListener("keydown", (event) => {
      if (event.key === "Tab") classList.remove("points");
      const key = this._meaning(event);
      if (!key) return;
      event.preventDefault();
      this._held.set(event.code, key);
      if (!event.repeat || this.part?.keys) this.press(key);
    });
    addEventListener("keyup", (event) => this._release(event.code));
    for (const id of ["pause", "once", "slower", "faster", "sound", "full"]) {
      this._button(id).onclick = (event) => {
        this.press(id);
        // Who uses the mouse goes on to play with keys.
        if (event.detail > 0) this.stage.focus();
      };
    }
    addEventListener("blur", () => {
      this._held.clear();
      this.part?.loseFocus?.();
    });
    const hide = () => document.hidden && this.part?.loseFocus?.();
    document.addEventListener("visibilitychange", hide);
    addEventListener("dragover", (event) => event.preventDefault());
    addEventListener("drop", (event) => this._drop(event));
    addEventListener("pagehide", (event) => event.persisted || this._parts.play?.close());
    this.stage.listen({
      press: (key) => {
        this._held.set("pointer", key);
        if (this.open) this.part.press(key);
      },
      release: (key) => {
        this._held.set("pointer", key);
        this._release("pointer");
      },
      point: (...where) => this.open && this.part.point(...where),
    });
  }

  /** Let go what a key or the pointer means, unless another one still means it. */
  _release(code) {
    const key = this._held.get(code);
    this._held.delete(code);
    if (![...this._held.values()].includes(key)) this.part?.release(key);
  }

  /** Show a file that is dropped anywhere on the page. */
  async _drop(event) {
    event.preventDefault();
    const [file] = event.dataTransfer.files;
    if (!file) return;
    const name = file.name.toLowerCase().endsWith(".txt") ? "editor" : "replay";
    if (await this._go(name)) await this.part.dropped(file);
  }

  /** Go to a part of the page; return as `show` does. */
  _go(name) {
    if (this.part === this._parts[name]) return this._shown;
    history.pushState(null, "", `#${name}`);
    return this.show(name);
  }

  /** @returns {string | undefined} what a key means where the focus is */
  _meaning(event) {
    const { target } = event;
    if (this.part?.scene) return undefined;
    const typing = target.closest("input:not([type=checkbox]), select, textarea");
    if (event.altKey || typing) return undefined;
    if (event.key === " " && target.closest("input, button, a, summary")) return undefined;
    const own = this.part?.keys;
    if (own && Object.hasOwn(own, wordOf(event))) return own[wordOf(event)];
    if (event.ctrlKey || event.metaKey) return undefined;
    const onField = target === this.stage.canvas;
    return meaningOf(event) ?? (onField ? FIELD_KEYS[event.key] : undefined);
  }
}

function meaningOf({ key = "" }) {
  return KEYS[key.length === 1 ? key.toLowerCase() : key];
}

/** @returns {string} a key with those that are held: Ctrl+z */
function wordOf({ key = "", ctrlKey, metaKey, shiftKey }) {
  const plain = key.length === 1 ? key.toLowerCase() : key;
  if (!(ctrlKey || metaKey)) return plain;
  return `Ctrl+${shiftKey ? "Shift+" : ""}${plain}`;
}

function partOf(hash) {
  const [name] = hash.slice(1).split("?");
  return Object.hasOwn(PARTS, name) ? name : document.body.dataset.opens;
}

function write(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/** Put the images of the games, which are packed apart, into the manifest. */
function join(manifest, images) {
  let end = 0;
  for (const game of Object.values(manifest.games)) {
    game.image = images.subarray(end, (end += game.image));
  }
}

const [code, images, manifest, facts] = await Promise.all([
  ...["code", "images"].map(bytesOf),
  ...["manifest", "facts"].map(jsonOf),
]);
join(manifest, images);
const app = new App(await loadArkanoid(code, manifest), facts);
await app.show(partOf(location.hash));
app.run();
/** For tests, and for whoever is curious. */
globalThis.arkanoid = app;
