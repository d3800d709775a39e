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
    this._later = setTimeout(() => this.now(), SETTLED);
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
