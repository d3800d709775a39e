// Sound: a few tones, made from their formulas. Which there are, and when, Python's sources say.

const APART = 1 / 60; // seconds between two of the same tones, at least

/** Plays tones. It is off at first. */
export class Speaker {
  /** @param {object} hearing the loudness, the tones, and what they stand for */
  constructor(hearing) {
    this._hearing = hearing;
    this._began = {}; // when tones began last, by their names
    this.on = false;
  }

  /** Switch sound on or off. Browsers allow it only where the user has done something. */
  switch() {
    this.on = !this.on;
    if (this.on) this._context ??= new AudioContext();
    if (this._context) this.on ? this._context.resume() : this._context.suspend();
  }

  /** Remember the balls before a tick. */
  before({ world }) {
    if (!this.on) return;
    const { ball_state: state, ball_vx: vx, ball_vy: vy } = world;
    this._balls = { state: state.slice(), vx: vx.slice(), vy: vy.slice() };
  }

  /** Play what is heard of a tick. */
  after(game) {
    if (!this.on || !this._balls) return;
    for (const tone of this._tonesOf(this._balls, game)) this._play(tone);
  }

  /** @returns {string[]} the tones of a tick, as `envs/play/hearing.py` chooses them */
  _tonesOf(before, { world, outcome, machine }) {
    const { counted, paddleReach } = this._hearing;
    const { FLYING } = machine.manifest.state;
    const tones = Object.keys(counted).filter((field) => outcome[field] > 0);
    const { ball_state: state, ball_vx: vx, ball_vy: vy, ball_y: y } = world;
    let paddle = false;
    let wall = false;
    state.forEach((now, ball) => {
      if (now !== FLYING || before.state[ball] !== FLYING) return;
      const turnedX = Math.sign(before.vx[ball]) !== Math.sign(vx[ball]);
      const turnedY = Math.sign(before.vy[ball]) !== Math.sign(vy[ball]);
      paddle ||= turnedY && y[ball] < paddleReach && vy[ball] > 0;
      wall ||= turnedX || turnedY;
    });
    const names = tones.map((field) => counted[field]);
    if (paddle) names.push("PADDLE");
    else if (!names.length && wall) names.push("WALL");
    return names;
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
