// The picture of two bodies. What lies where, kernels say: here it is only put on the screen.

const SVG = "http://www.w3.org/2000/svg";
const SIDES = ["a", "b"];
const WHOLE = { HalfPlane: true, AxisAlignedHalfPlane: true }; // below other bodies

/** The picture, and what pointers and keys do to it. */
export class Drawing {
  /**
   * @param {object} react functions: choose(side), move(side, x, y), aim(side, vx, vy), and
   *   press(event, side, isTip)
   */
  constructor(react) {
    this._react = react;
    this._svg = document.getElementById("collisions");
    const layer = (name) => [name, this._svg.querySelector(`.${name}`)];
    this._layers = Object.fromEntries(["regions", "ghosts", "marks", "handles"].map(layer));
    this._bodies = Object.fromEntries(SIDES.map((side) => [side, this._makeBody(side)]));
    this._svg.addEventListener("pointerdown", (event) => this._grab(event));
    this._svg.addEventListener("pointermove", (event) => this._drag(event));
    for (const end of ["pointerup", "pointercancel"]) {
      this._svg.addEventListener(end, ({ pointerId }) => {
        if (this._held?.pointer === pointerId) this._held = null;
      });
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
    this._sink(SIDES.find((side) => WHOLE[bodies[side].collider]));
    const separable = record.overlap && Number.isFinite(record.depth);
    const flies = Number.isFinite(record.time) && record.touching === 0;
    const marks = [];
    const ghosts = [];
    for (const side of SIDES) {
      const said = record[side];
      if (separable && said.share > 0) {
        ghosts.push(ghost(side, said, said.relaxed_x, said.relaxed_y, "relaxed"));
      }
      if (flies) {
        ghosts.push(ghost(side, said, said.impact_x, said.impact_y, "impact"));
        marks.push(way(side, said));
      }
      if (record.impulse !== 0 && (said.bounced_vx || said.bounced_vy)) {
        marks.push(bounced(side, said));
      }
    }
    if (separable) {
      const { point_x: x, point_y: y, normal_x: normalX, normal_y: normalY, depth } = record;
      marks.push(...normal(x, y, normalX, normalY, depth));
    }
    if (flies) {
      const { impact_point_x: x, impact_point_y: y } = record;
      marks.push(...normal(x, y, record.impact_normal_x, record.impact_normal_y, 0));
    }
    this._layers.ghosts.replaceChildren(...ghosts);
    this._layers.marks.replaceChildren(...marks);
  }

  /** Put a body below the other one, unless that would take the focus from it. */
  _sink(side) {
    if (!side) return;
    const { region } = this._bodies[side];
    const isFree = !region.contains(document.activeElement);
    if (isFree && this._layers.regions.firstElementChild !== region) {
      this._layers.regions.prepend(region);
    }
  }

  _makeBody(side) {
    const named = { tabindex: 0, role: "group", "data-side": side };
    const region = make("g", { class: `body ${side}`, ...named });
    const velocity = make("line", { class: "velocity", "marker-end": `url(#tip-${side})` });
    const centre = make("circle", { class: "centre", r: 0.07, "data-side": side });
    const name = make("text", { transform: "scale(1 -1)", "data-side": side, y: -0.16, x: 0.12 });
    name.textContent = side;
    const tip = make("g", { class: "tip", ...named, "data-tip": "" });
    tip.append(
      make("circle", { class: "reach", r: 0.42 }),
      make("circle", { class: "knob", r: 0.13 }),
    );
    const place = make("g", { class: `handle ${side}` });
    place.append(velocity, centre, name, tip);
    this._layers.regions.append(region);
    this._layers.handles.append(place);
    return { region, place, velocity, tip };
  }

  _showBody(side, body, said, isChosen) {
    const { region, place, velocity, tip } = this._bodies[side];
    region.classList.toggle("chosen", isChosen);
    const label = `Body ${side}, ${body.collider}, at ${body.x}, ${body.y}`;
    region.setAttribute("aria-label", label);
    region.replaceChildren(outline(said));
    set(region, { transform: `translate(${body.x} ${body.y})` });
    set(place, { transform: `translate(${body.x} ${body.y})` });
    const visibility = body.vx || body.vy ? "visible" : "hidden";
    set(velocity, { x2: body.vx, y2: body.vy, visibility });
    set(tip, { transform: `translate(${body.vx} ${body.vy})` });
    tip.setAttribute("aria-label", `Velocity of ${side}: ${body.vx}, ${body.vy}`);
  }

  /** @returns {DOMPoint} where a pointer is, in the scene's unit */
  _place(event) {
    const toScene = this._layers.marks.getScreenCTM().inverse();
    return new DOMPoint(event.clientX, event.clientY).matrixTransform(toScene);
  }

  _grab(event) {
    const held = event.target.closest("[data-side]");
    if (!held || event.button > 0 || this._held) return;
    const { side, tip } = held.dataset;
    const body = this._bodies[side];
    event.preventDefault();
    this._svg.setPointerCapture(event.pointerId);
    const { x, y } = this._place(event);
    const isTip = tip !== undefined;
    const [from] = (isTip ? body.tip : body.place).transform.baseVal;
    const pointer = event.pointerId;
    this._held = { pointer, side, isTip, x: x - from.matrix.e, y: y - from.matrix.f };
    (isTip ? body.tip : body.region).focus({ preventScroll: true });
  }

  _drag(event) {
    if (this._held?.pointer !== event.pointerId) return; // of a second finger
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

/** The way of a body to the impact. */
function way(side, { x: x1, y: y1, impact_x: x2, impact_y: y2 }) {
  return make("line", { class: `way ${side}`, x1, y1, x2, y2 });
}

/** The velocity of a body after the bounce. */
function bounced(side, { impact_x: x, impact_y: y, bounced_vx: x2, bounced_vy: y2 }) {
  const transform = `translate(${x} ${y})`;
  const tip = "url(#tip-bounced)";
  return make("line", { class: `bounced ${side}`, x2, y2, transform, "marker-end": tip });
}

/** The normal as an arrow of length 1 from a point, and the depth along it. */
function normal(x, y, normalX, normalY, depth) {
  const transform = `matrix(${normalX} ${normalY} ${-normalY} ${normalX} ${x} ${y})`;
  const tip = "url(#tip-normal)";
  const parts = [
    make("line", { class: "normal", x2: 1, transform, "marker-end": tip }),
    make("circle", { class: "point", r: 0.07, transform }),
  ];
  if (depth > 0) {
    parts.push(make("line", { class: "depth", x1: -depth / 2, x2: depth / 2, transform }));
  }
  return parts;
}

function make(tag, attributes) {
  return set(document.createElementNS(SVG, tag), attributes);
}

function set(element, attributes) {
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  return element;
}
