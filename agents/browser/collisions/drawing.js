// The picture of two bodies. What lies where, kernels say: here it is only put on the screen.

const SVG = "http://www.w3.org/2000/svg";
const SIDES = ["a", "b"];
const WHOLE = { HalfPlane: true, AxisAlignedHalfPlane: true }; // below other bodies

/** The picture, and what pointers and keys do to it. */
export class Drawing {
  /** @param {object} react functions: choose(side), move(side, x, y), aim(side, vx, vy), press(event, side, isTip) */
  constructor(react) {
    this._react = react;
    this._svg = document.getElementById("collisions");
    this._layers = Object.fromEntries(
      ["regions", "ghosts", "marks", "handles"].map((name) => [name, this._svg.querySelector(`.${name}`)]),
    );
    this._bodies = Object.fromEntries(SIDES.map((side) => [side, this._makeBody(side)]));
    this._svg.addEventListener("pointerdown", (event) => this._grab(event));
    this._svg.addEventListener("pointermove", (event) => this._drag(event));
    for (const end of ["pointerup", "pointercancel"]) {
      this._svg.addEventListener(end, () => { this._held = null; });
    }
    this._svg.addEventListener("keydown", (event) => {
      const { side, tip } = event.target.dataset ?? {};
      if (!side || !this._react.press(event, side, tip !== undefined)) return;
      event.preventDefault();
      event.stopPropagation();
    });
    // A picture that listens to the focus itself would take it, too.
    this._svg.parentElement.addEventListener("focusin", ({ target }) => {
      if (target.dataset.side) this._react.choose(target.dataset.side);
    });
  }

  focus(side) {
    this._bodies[side].region.focus();
  }

  /** Draw bodies and what is said of them. */
  show(bodies, record, chosen) {
    for (const side of SIDES) this._showBody(side, bodies[side], record[side], side === chosen);
    const below = SIDES.find((side) => WHOLE[bodies[side].collider]);
    const [first] = this._layers.regions.children;
    if (below && first !== this._bodies[below].region && document.activeElement?.dataset?.side !== below) {
      this._layers.regions.prepend(this._bodies[below].region);
    }
    const parts = [];
    const ghosts = [];
    const separable = record.overlap && Number.isFinite(record.depth);
    const flies = Number.isFinite(record.time) && record.touching === 0;
    for (const side of SIDES) {
      const said = record[side];
      if (separable && said.share > 0) ghosts.push(ghost(side, said, said.relaxed_x, said.relaxed_y, "relaxed"));
      if (flies) {
        ghosts.push(ghost(side, said, said.impact_x, said.impact_y, "impact"));
        parts.push(line("way", side, said.x, said.y, said.impact_x, said.impact_y));
      }
      if (record.impulse !== 0 && (said.bounced_vx || said.bounced_vy)) {
        parts.push(arrow("bounced", side, said.impact_x, said.impact_y, said.bounced_vx, said.bounced_vy));
      }
    }
    if (separable) parts.push(...normal(record.point_x, record.point_y, record.normal_x, record.normal_y, record.depth));
    if (flies) parts.push(...normal(record.impact_point_x, record.impact_point_y, record.impact_normal_x, record.impact_normal_y, 0));
    this._layers.ghosts.replaceChildren(...ghosts);
    this._layers.marks.replaceChildren(...parts);
  }

  _makeBody(side) {
    const region = make("g", { class: `body ${side}`, tabindex: 0, role: "group", "data-side": side });
    const velocity = make("line", { class: "velocity", "marker-end": `url(#tip-${side})` });
    const centre = make("circle", { class: "centre", r: 0.07, "data-side": side });
    const name = make("text", { transform: "scale(1 -1)", "data-side": side, y: -0.16, x: 0.12 });
    name.textContent = side;
    const tip = make("g", { class: "tip", tabindex: 0, role: "group", "data-side": side, "data-tip": "" });
    tip.append(make("circle", { class: "reach", r: 0.42 }), make("circle", { class: "knob", r: 0.13 }));
    const place = make("g", { class: `handle ${side}` });
    place.append(velocity, centre, name, tip);
    this._layers.regions.append(region);
    this._layers.handles.append(place);
    return { region, place, velocity, tip };
  }

  _showBody(side, body, said, isChosen) {
    const { region, place, velocity, tip } = this._bodies[side];
    region.classList.toggle("chosen", isChosen);
    region.setAttribute("aria-label", `Body ${side}, ${body.collider}, at ${body.x}, ${body.y}`);
    region.replaceChildren(outline(said));
    set(region, { transform: `translate(${body.x} ${body.y})` });
    set(place, { transform: `translate(${body.x} ${body.y})` });
    set(velocity, { x2: body.vx, y2: body.vy, visibility: body.vx || body.vy ? "visible" : "hidden" });
    set(tip, { transform: `translate(${body.vx} ${body.vy})` });
    tip.setAttribute("aria-label", `Velocity of ${side}: ${body.vx}, ${body.vy}`);
  }

  /** @returns {DOMPoint} where a pointer is, in the scene's unit */
  _place(event) {
    return new DOMPoint(event.clientX, event.clientY).matrixTransform(this._layers.marks.getScreenCTM().inverse());
  }

  _grab(event) {
    const held = event.target.closest("[data-side]");
    if (!held || event.button > 0) return;
    const { side, tip } = held.dataset;
    const body = this._bodies[side];
    event.preventDefault();
    this._svg.setPointerCapture(event.pointerId);
    const { x, y } = this._place(event);
    const isTip = tip !== undefined;
    const [from] = (isTip ? body.tip : body.place).transform.baseVal;
    this._held = { side, isTip, x: x - from.matrix.e, y: y - from.matrix.f };
    (isTip ? body.tip : body.region).focus({ preventScroll: true });
  }

  _drag(event) {
    if (!this._held) return;
    const { side, isTip, x, y } = this._held;
    const at = this._place(event);
    if (isTip) this._react.aim(side, at.x - x, at.y - y);
    else this._react.move(side, at.x - x, at.y - y);
  }
}

/** The outline of a body about its position. */
function outline(said) {
  if (said.corners === 0) return make("circle", { r: Math.max(said.radius, 0.02) });
  const points = Array.from(said.outline.subarray(0, 2 * said.corners));
  return make("polygon", { points: points.join(" ") });
}

function ghost(side, said, x, y, what) {
  const shown = outline(said);
  set(shown, { class: `ghost ${side} ${what}`, transform: `translate(${x} ${y})` });
  return shown;
}

function line(what, side, x1, y1, x2, y2) {
  return make("line", { class: `${what} ${side}`, x1, y1, x2, y2 });
}

function arrow(what, side, x, y, vx, vy) {
  const transform = `translate(${x} ${y})`;
  return make("line", { class: `${what} ${side}`, x2: vx, y2: vy, transform, "marker-end": "url(#tip-bounced)" });
}

/** The normal as an arrow of length 1 from a point, and the depth along it. */
function normal(x, y, normalX, normalY, depth) {
  const transform = `matrix(${normalX} ${normalY} ${-normalY} ${normalX} ${x} ${y})`;
  const parts = [];
  if (normalX || normalY) parts.push(make("line", { class: "normal", x2: 1, transform, "marker-end": "url(#tip-normal)" }));
  if (Number.isFinite(depth) && depth > 0) parts.push(make("line", { class: "depth", x1: -depth / 2, x2: depth / 2, transform }));
  if (normalX || normalY) parts.push(make("circle", { class: "point", r: 0.07, transform }));
  return parts;
}

function make(tag, attributes) {
  return set(document.createElementNS(SVG, tag), attributes);
}

function set(element, attributes) {
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  return element;
}
