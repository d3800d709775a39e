// A world to throw things in: what is in it, how its time runs, and what one may undo.

import { Address } from "arkanoid/address";
import { Arena } from "arkanoid/arena";
import { Hand } from "arkanoid/hand";
import { Lamp } from "arkanoid/lamp";
import { Live } from "arkanoid/live_world";
import { Meters } from "arkanoid/meters";
import { pythonOf } from "arkanoid/python";
import { Things } from "arkanoid/things";
import { Tray } from "arkanoid/tray";

const STEP = 1 / 60; // of time, at the usual speed
const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4];
const MOST_DUE = 3; // steps that are made up for, if pictures are late
const MOST_UNDONE = 20;
const FIRST = "shapes";

export class World {
  /** The page shows its scene instead of the game. */
  scene = "world";
  steers = null;

  /** @param {object} app what all pages share, see `app.js` */
  constructor(app) {
    this.app = app;
    const { worlds } = app.arkanoid.manifest;
    this._polygons = worlds.polygons;
    this.things = new Things(worlds);
    this.arena = new Arena();
    this.spot = new Lamp();
    this.meters = new Meters(worlds.kinds);
    this.tray = new Tray(this.things.usual, {
      change: (changes, isShape) => this.change(changes, isShape),
    });
    this.hand = new Hand(this);
    this._address = new Address(() => this.things.writeScene(this._start));
    this.chosen = undefined;
    this._undone = [];
    this.runs = !matchMedia("(prefers-reduced-motion: reduce)").matches;
    this._speed = SPEEDS.indexOf(1);
    this._listen();
    this._list(worlds.scenes);
  }

  async enter() {
    const turn = (this._turn = Symbol());
    this._sandbox ??= this.app.arkanoid.sandbox();
    const sandbox = await this._sandbox;
    if (this._turn !== turn) return; // one went away meanwhile, and may have come again
    this.live ??= new Live(sandbox);
    const scene = this.things.readScene(location.hash);
    if (scene) this.load(scene);
    else if (!this._start) this.load(this.things.ready(FIRST));
    // One comes back, or the address says what can't be.
    this._address.now();
    this._due = 0;
    this._then = undefined;
    const picture = (now) => {
      if (this._turn !== turn) return;
      requestAnimationFrame(picture);
      this._picture(now);
    };
    requestAnimationFrame(picture);
    this._showState();
  }

  leave() {
    this._turn = null;
    this.hand.cancel();
    this._address.leave();
  }

  press() {}

  release() {}

  loseFocus() {
    this.hand.cancel();
  }

  focus() {
    this.arena.canvas.focus({ preventScroll: true });
  }

  /** Begin with a scene, from which one can go back to what was before. */
  load(scene) {
    if (this._start) this.remember();
    this._start = scene;
    this._lay(scene);
  }

  _lay(scene) {
    this.hand.drop();
    this.chosen = this._changed = undefined;
    this.gravity = scene.gravity;
    this.lamp = scene.lamp;
    this.meters.clear();
    this.arena.forget();
    if (!this.live.lay(scene.things)) this._tell("There is room for 1024 bodies only.");
    else this._tell("");
    this._showSettings();
    this._shown = undefined;
    this._showChosen();
    this._showState();
  }

  // What one does.

  /** Keep the world as it is, to come back to it. */
  remember() {
    const { live, meters, chosen, gravity, lamp, _start: start } = this;
    const kept = { world: live.save(), meters: meters.save(), chosen, gravity, lamp, start };
    this._undone.push(kept);
    if (this._undone.length > MOST_UNDONE) this._undone.shift();
  }

  /** Forget what was remembered last: nothing has changed since. */
  forgetLast() {
    this._undone.pop();
    this._showState();
  }

  undo() {
    const kept = this._undone.pop();
    if (!kept) return;
    this.hand.drop();
    this.live.restore(kept.world);
    Object.assign(this, { chosen: kept.chosen, gravity: kept.gravity, lamp: kept.lamp });
    this._changed = undefined;
    this._start = kept.start;
    this.meters.restore(kept.meters);
    this.arena.forget();
    this._showSettings();
    this._shown = undefined;
    this._tell("");
    this._showChosen();
    this._showState();
    this._address.later();
  }

  /** Throw in what the tray holds; return its handle. */
  throwIn(x, y) {
    this.remember();
    const handle = this.live.add({ ...this.tray.next, x, y, vx: 0, vy: 0 });
    if (handle === undefined) {
      this._undone.pop();
      this._tell("There is no room for more bodies.");
      return undefined;
    }
    this._tell("");
    return handle;
  }

  /** Change the body that is chosen. */
  change(changes, isShape) {
    const thing = this.live.thing(this.chosen);
    if (!thing) return;
    const name = Object.keys(changes).join();
    this._rememberOnce(`${this.chosen} ${name}`);
    const changed = { ...thing, ...changes };
    if (isShape) {
      this.live.remove(this.chosen);
      this.chosen = this.live.add(changed);
    } else this.live.change(this.chosen, changed);
    this._changed = `${this.chosen} ${name}`;
    this.tray.show(changed, true);
    this.edited(true);
  }

  /** Remember what was before somebody changes something, in many steps as a slider does. */
  _rememberOnce(what) {
    if (this._changed !== what) this.remember();
    this._changed = what;
  }

  /** Put the lamp somewhere; null: take it away. */
  light(place) {
    this.remember();
    this.lamp = place;
    this.edited();
    this._showSettings();
  }

  remove() {
    if (this.chosen === undefined) return;
    this.remember();
    this.live.remove(this.chosen);
    this.choose(undefined);
    this.edited();
  }

  /** Show a body in the form; undefined: what is thrown in next. */
  choose(handle) {
    this.chosen = handle;
    this._changed = this._followed = undefined;
    this._showChosen();
  }

  /** Take note that somebody has changed the world: the address will hold it as it is now. */
  edited(isForm = false) {
    if (!isForm) this._changed = undefined;
    this._start = this._now();
    this._shown = undefined;
    this._address.later();
    this._showState();
  }

  again() {
    this.remember();
    this._lay(this._start);
  }

  pause() {
    this.runs = !this.runs;
    this._due = 0;
    this._showState();
  }

  once() {
    this.runs = false;
    this._step(STEP);
    this._showState();
  }

  // Time.

  _picture(now) {
    const elapsed = Math.min(0.25, (now - (this._then ?? now)) / 1000);
    this._then = now;
    if (this.runs && !this.hand.aims) {
      this._due = Math.min(MOST_DUE, this._due + elapsed / STEP);
      const speed = SPEEDS[this._speed];
      const parts = Math.ceil(speed);
      while (this._due >= 1 && this.runs) {
        this._due -= 1;
        for (let part = 0; part < parts && this.runs; part += 1) this._step(STEP * speed / parts);
      }
    }
    const bodies = this.live.see(this.gravity);
    const { record } = this.live.sandbox;
    if (!this.live.has(this.chosen) && this.chosen !== undefined) this.choose(undefined);
    this.meters.show(record, bodies.length, now);
    if (this.chosen !== undefined) this._follow();
    this._showLamp();
    const rays = this.lamp && this.live.cast(this.lamp);
    this.arena.paint(bodies, this.live.paths, {
      chosen: this.chosen, arrows: !this.runs || this.hand.aims, lamp: this.lamp,
      isRinged: this.spot.isRinged, rays, now,
    });
  }

  _step(dt) {
    this.hand.pull(dt);
    let events;
    try {
      events = this.live.step(dt, this.gravity);
    } catch (error) {
      if (!(error instanceof RangeError)) throw error;
      this.runs = false;
      this.live.lay(this._start.things);
      this._tell(`It begins again: ${error.message}.`);
      this._showState();
      return;
    }
    const { HIT } = this.app.arkanoid.manifest.worlds.kinds;
    this.arena.note(events.filter(({ kind }) => kind === HIT), performance.now());
    this.live.see(this.gravity);
    this.meters.note(events, this.live.sandbox.record.energy);
  }

  /** Let the fields of a moving body follow it. */
  _follow() {
    const now = performance.now();
    if (now - (this._followed ?? 0) < 100) return;
    this._followed = now;
    const thing = this.live.thing(this.chosen);
    const text = `at (${thing.x.toFixed(2)}, ${thing.y.toFixed(2)}), velocity (${thing.vx.toFixed(2)}, ${thing.vy.toFixed(2)})`;
    const output = document.getElementById("thing-motion");
    if (output.textContent !== text) output.textContent = text.replaceAll("-", "−");
  }

  // What is shown.

  _showSettings() {
    document.getElementById("gravity").value = this.gravity;
    document.getElementById("lamp").checked = Boolean(this.lamp);
    this._showLamp();
  }

  _showLamp() {
    // What is hidden can't keep the focus.
    if (!this.lamp && this.spot.isFocused) this.focus();
    this.spot.show(this.lamp);
  }

  _showChosen() {
    const thing = this.live?.thing(this.chosen);
    this.tray.show(thing ?? this.tray.next, Boolean(thing));
  }

  _showState() {
    const text = this.runs ? "Pause" : "Run";
    this._button("pause").textContent = text;
    this._button("undo").disabled = this._undone.length === 0;
    this._button("speed").value = `${SPEEDS[this._speed]}×`;
    for (const link of document.querySelectorAll("#world-scenes a")) {
      const isShown = this._start?.name && link.dataset.scene === this._start.name;
      if (isShown) link.setAttribute("aria-current", "true");
      else link.removeAttribute("aria-current");
    }
    const says = this._start?.name && this.app.arkanoid.manifest.worlds.scenes[this._start.name];
    document.getElementById("world-says").textContent = says ? `${says.title}: ${says.says}` : "";
    this._showPython();
  }

  /** Write the program that makes the scene, if one looks at it. */
  _showPython() {
    const box = document.getElementById("world-python");
    if (!box.open || this._shown === this._start) return;
    this._shown = this._start;
    box.querySelector("pre").textContent = pythonOf(this._start, this._polygons);
  }

  /** Tell those who can't see which body is chosen. */
  tell(handle) {
    const { collider, x, y } = this.live.thing(handle);
    this.app.say(`${collider} at ${x.toFixed(1)}, ${y.toFixed(1)}`);
  }

  _tell(text) {
    document.getElementById("world-fault").textContent = text;
  }

  /** Return the scene as it is now. */
  _now() {
    const { gravity, lamp } = this;
    return { things: this.live.things(), gravity, lamp };
  }

  _button(name) {
    return document.getElementById(`world-${name}`);
  }

  _list(scenes) {
    const list = document.getElementById("world-scenes");
    for (const [name, { title }] of Object.entries(scenes)) {
      const link = Object.assign(document.createElement("a"), {
        href: `#world?scene=${name}`, textContent: title,
      });
      link.dataset.scene = name;
      // The same scene again begins again.
      link.onclick = () => { if (location.hash === link.hash) this.load(this.things.ready(name)); };
      const item = document.createElement("li");
      item.append(link);
      list.append(item);
    }
  }

  _listen() {
    const deeds = {
      pause: () => this.pause(), once: () => this.once(), undo: () => this.undo(),
      again: () => this.again(), remove: () => this.remove(),
      slower: () => this.hurry(-1), faster: () => this.hurry(1),
    };
    for (const [name, deed] of Object.entries(deeds)) this._button(name).onclick = deed;
    const gravity = document.getElementById("gravity");
    gravity.oninput = () => {
      const number = gravity.valueAsNumber;
      if (!(number >= 0 && number <= 100)) return;
      this._rememberOnce("gravity");
      this.gravity = number;
      this.edited(true);
    };
    // What can't be is put right when one goes on.
    gravity.onchange = () => { gravity.value = this.gravity; };
    document.getElementById("lamp").onchange = ({ target }) => {
      this.light(target.checked ? [0, 0] : null);
    };
    document.getElementById("thing-other").onclick = () => this.choose(undefined);
    document.getElementById("world-python").ontoggle = () => this._showPython();
    this._button("copy").onclick = async () => {
      const pre = document.querySelector("#world-python pre");
      try {
        await navigator.clipboard.writeText(pre.textContent);
        this.app.say("Copied");
      } catch {
        getSelection().selectAllChildren(pre); // from a file, or without permission
      }
    };
  }

  hurry(by) {
    this._speed = Math.max(0, Math.min(SPEEDS.length - 1, this._speed + by));
    this._showState();
  }
}
