"""Pages as on a slow, busy machine: what browsers do later, they do much later.

`ARKANOID_TESTS_SLOW_PAGES=6 pytest tests/agents/browser` shows which tests, and which parts of the
page, count on what has not happened yet.
"""

import os
from typing import Any

VARIABLE = "ARKANOID_TESTS_SLOW_PAGES"
DELAY = 200  # milliseconds; less than what the page itself waits for changes to settle
DELAYS = """(() => {
  const wait = (act) => setTimeout(act, %d);
  const picture = requestAnimationFrame.bind(globalThis);
  globalThis.requestAnimationFrame = (act) => wait(() => picture(act));
  const told = new WeakSet();
  for (const kind of ["toggle", "hashchange", "fullscreenchange", "resize"]) {
    addEventListener(kind, (event) => {
      if (told.has(event)) return;
      event.stopImmediatePropagation();
      const again = new event.constructor(kind, event);
      told.add(again);
      wait(() => event.target.dispatchEvent(again));
    }, true);
  }
  const delay = (holder, name) => {
    const act = holder[name];
    holder[name] = async function (...given) {
      await new Promise(wait);
      return act.apply(this, given);
    };
  };
  delay(globalThis, "fetch");
  for (const name of ["text", "arrayBuffer"]) delay(Blob.prototype, name);
  for (const name of ["instantiate", "compile"]) delay(WebAssembly, name);
})()"""


def slow_down(page: Any) -> None:
    """Make a new page as many times slower as the variable says, if it is set."""
    factor = float(os.environ.get(VARIABLE, "1"))
    if factor > 1:
        page.add_init_script(DELAYS % DELAY)
        session = page.context.new_cdp_session(page)
        session.send("Emulation.setCPUThrottlingRate", {"rate": factor})
