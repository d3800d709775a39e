// How fast games are shown.

const FASTEST = 64;
const SLOWEST = 1 / 16;
const STEP = 2; // a key's factor
const PATIENCE = 100; // milliseconds; what is later than this is not caught up with
const BUSY = 12; // milliseconds of a picture's time that may be spent on playing

export class Clock {
  constructor() {
    this.speed = 1;
    this._due = 0;
    this._last = 0;
  }

  /** Become faster (1) or slower (-1). */
  change(direction) {
    const speed = direction > 0 ? this.speed * STEP : this.speed / STEP;
    this.speed = Math.min(FASTEST, Math.max(SLOWEST, speed));
  }

  /** @returns {string} the speed, for people */
  get text() {
    const { speed } = this;
    return speed < 1 ? `1/${1 / speed}×` : `${speed}×`;
  }

  /**
   * Let the states that are due happen.
   * @param {number} now in milliseconds
   * @param {number} rate how many states of the game there are per second of its time
   * @param {() => boolean} next lets one happen, and returns whether there are more
   */
  run(now, rate, next) {
    const passed = now - this._last;
    this._last = now;
    if (passed > PATIENCE) return;
    this._due += (passed / 1000) * rate * this.speed;
    const until = performance.now() + BUSY;
    for (; this._due >= 1; this._due -= 1) {
      if (!next() || performance.now() > until) {
        this._due = 0;
        return;
      }
    }
  }
}
