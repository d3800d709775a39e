// Sound: a few tones, made from their formulas. Which there are, and when, Python's sources say.

import { Ears } from "arkanoid/hearing";

const APART = 1 / 60; // seconds between two of the same tones, at least

/** Plays tones. It is off at first. */
export class Speaker {
  /** @param {object} hearing the loudness, and the tones by their names */
  constructor(hearing) {
    this._hearing = hearing;
    this._all = new WeakMap(); // ears, by their games
    this._began = {}; // when tones began last, by their names
    this.on = false;
  }

  /** Switch sound on or off. Browsers allow it only where the user has done something. */
  switch() {
    this.on = !this.on;
    if (this.on) this._context ??= new AudioContext();
    if (this._context) this.on ? this._context.resume() : this._context.suspend();
  }

  /** Listen before a tick. */
  before(game) {
    this._ears = this.on ? this._earsIn(game) : null;
    this._ears?.listen();
  }

  /** Play what is heard of a tick. */
  after() {
    for (const tone of this._ears?.hear() ?? []) this._play(tone);
  }

  _earsIn(game) {
    if (!this._all.has(game)) this._all.set(game, new Ears(game));
    return this._all.get(game);
  }

  /** Play a gliding sine with an octave in it, which fades. */
  _play(tone) {
    const { loudness, attack, tones } = this._hearing;
    const [begin, end, seconds] = tones[tone];
    const start = this._context.currentTime;
    // Time stands still where the system took the sound away: what is played then sounds later, all
    // at once. Fast games would have hundreds of tones in a picture.
    if (this._context.state !== "running") this._context.resume().catch(() => {});
    if (this._context.state !== "running" || start - this._began[tone] < APART) return;
    this._began[tone] = start;
    const volume = this._context.createGain();
    volume.gain.setValueAtTime(0, start);
    volume.gain.linearRampToValueAtTime(loudness, start + attack);
    volume.gain.exponentialRampToValueAtTime(loudness / 1000, start + seconds);
    volume.connect(this._context.destination);
    for (const [octave, part] of [[1, 1 / 1.3], [2, 0.3 / 1.3]]) {
      const wave = this._context.createOscillator();
      const share = this._context.createGain();
      share.gain.value = part;
      wave.frequency.setValueAtTime(begin * octave, start);
      wave.frequency.linearRampToValueAtTime(end * octave, start + seconds);
      wave.connect(share).connect(volume);
      wave.start(start);
      wave.stop(start + seconds);
    }
  }
}
