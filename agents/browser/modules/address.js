// The page's address, which holds what one made: changes are written once they settle.

const SETTLED = 300; // milliseconds

export class Address {
  /** @param {() => string} write the address that holds what there is */
  constructor(write) {
    this._write = write;
  }

  /** Write what there is after a while without changes. */
  later() {
    clearTimeout(this._later);
    const { hash } = location;
    // Another address was asked for, if it differs then: the page may hear of that later.
    this._later = setTimeout(() => location.hash === hash && this.now(), SETTLED);
  }

  /** Write what there is. */
  now() {
    clearTimeout(this._later);
    history.replaceState(null, "", this._write());
  }

  /** Write nothing any more: the address is that of another part or scene by now. */
  leave() {
    clearTimeout(this._later);
  }
}
