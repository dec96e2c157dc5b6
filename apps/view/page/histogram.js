// The panel "Time slices": when the selected object sent out the light that is seen, and what it looks like in slices
// of that time, as bands that are dragged.

import {fillObjects, html, linearTicks, scaleOf, svg, text} from "./plot.js";
import {ends, fresh, moved} from "./slices.js";
import {sliceFields} from "./slice_fields.js";

const kWidth = 320, kHeight = 130, kFloor = 108, kBins = 128;
const kSteps = {ArrowLeft: -0.01, ArrowDown: -0.01, ArrowRight: 0.01, ArrowUp: 0.01, PageDown: -0.1, PageUp: 0.1};

export function setup(app) {
  const panel = new Slices(app);
  app.store.addEventListener("change", () => panel.update());
  app.addEventListener("select", () => panel.select(app.selected));
  app.addEventListener("dataset", () => panel.refill());
  for (const name of ["view", "traced"]) app.addEventListener(name, () => panel.stale());
}

class Slices {
  #app;
  #panel;
  #fresh = false;
  #object;
  #channel = "t";
  #histogram = null;
  #asked = 0;
  #logarithmic = false;
  #drag = null;
  #drawing = svg("svg", {viewBox: `0 0 ${kWidth} ${kHeight}`, class: "plot slices-plot", role: "group"});
  #words = html("p", {class: "plot-words"});
  #list = html("div", {class: "slices-list"});
  #shownFields = "";

  constructor(app) {
    this.#app = app;
    this.#panel = app.panel("slices", "Time slices", {open: false});
    this.#object = html("select", {"aria-label": "object", onchange: () => this.stale()});
    this.refill();
    const channel = html("select", {"aria-label": "clock", onchange: () => {
      this.#channel = channel.value;
      this.stale();
    }}, html("option", {value: "t"}, "t, coordinate time"), html("option", {value: "tau"}, "tau, its own clock"));
    const log = html("input", {type: "checkbox", onchange: () => {
      this.#logarithmic = log.checked;
      this.#draw();
    }});
    const add = html("button", {type: "button", onclick: () => this.#add()}, "Add slice");
    this.#panel.body.append(html("div", {class: "extras-row"}, this.#object, channel, html("label", {}, log, " log")),
      this.#drawing, this.#words, this.#list, add);
    this.#panel.element.addEventListener("toggle", () => this.#load());
    this.#drawing.addEventListener("pointermove", (event) => this.#move(event));
    for (const name of ["pointerup", "pointercancel"]) this.#drawing.addEventListener(name, () => this.#drop());
  }

  get #pointer() {
    return `/objects/${this.#object.value}/time_slices`;
  }
  get #slices() {
    return this.#app.store.look.objects?.[this.#object.value]?.time_slices ?? [];
  }

  select(name) {
    if (!name || name === this.#object.value) return;
    this.#object.value = name;
    this.stale();
  }
  refill() {
    fillObjects(this.#object, this.#app);
  }

  /** Asked for when it can be seen. */
  stale() {
    this.#fresh = false;
    this.#load();
  }

  async #load() {
    if (this.#fresh || !this.#panel.element.open) return;
    this.#fresh = true;
    const asked = ++this.#asked;
    const query = {data: this.#app.view.data, object: this.#object.value, channel: this.#channel, bins: kBins};
    try {
      const got = await this.#app.api.json("api/histogram", {query});
      if (asked !== this.#asked) return;
      this.#histogram = got;
      this.#words.textContent = describe(got, this.#object.value);
    } catch (error) {
      if (asked !== this.#asked) return;
      this.#histogram = null;
      this.#words.textContent = error.message;
    }
    this.#shownFields = "";
    this.update();
  }

  update() {
    if (!this.#panel.element.open) return;
    this.#draw();
    this.#fields();
  }

  /** The histogram's range, widened so that closed ends of slices can be seen. */
  get #range() {
    const {from, to} = this.#histogram?.finite > 0 ? this.#histogram : {from: -1, to: 0};
    const pad = 0.02 * (to - from || Math.abs(from) || 1);
    return {from: from - pad, to: to + pad};
  }

  #draw() {
    const range = this.#range, x = scaleOf(range, kWidth), focused = document.activeElement?.dataset?.handle;
    const parts = [...this.#bars(x)];
    for (const tick of linearTicks(range.from, range.to, 6)) {
      parts.push(svg("path", {d: `M${x(tick)},${kFloor}v4`, class: "plot-axis"}));
      parts.push(svg("text", {x: x(tick), y: kHeight - 6, class: "plot-number plot-middle"}, text(tick)));
    }
    parts.push(svg("path", {d: `M0,${kFloor}H${kWidth}`, class: "plot-axis"}));
    this.#slices.forEach((slice, i) => {
      if (slice.channel === this.#channel) parts.push(this.#band(slice, i, x, range));
    });
    this.#drawing.setAttribute("aria-label", `Times of emission of ${this.#object.value} and its time slices`);
    this.#drawing.replaceChildren(...parts);
    if (focused) this.#drawing.querySelector(`[data-handle="${focused}"]`)?.focus({preventScroll: true});
  }

  #bars(x) {
    if (!(this.#histogram?.finite > 0)) return [];
    const {from, to, counts} = this.#histogram;
    const size = this.#logarithmic ? (n) => Math.log1p(n) : (n) => n;
    const most = Math.max(...counts.map(size), 1), wide = (to - from) / counts.length;
    let d = "";
    counts.forEach((count, i) => {
      if (count === 0) return;
      const left = to > from ? x(from + i * wide) : kWidth / 2 - 1, right = to > from ? x(from + (i + 1) * wide) : kWidth / 2 + 1;
      d += `M${left.toFixed(2)},${kFloor}V${(kFloor * (1 - (0.95 * size(count)) / most)).toFixed(2)}H${right.toFixed(2)}V${kFloor}Z`;
    });
    return [svg("path", {d, class: "slices-bars"})];
  }

  #band(slice, i, x, range) {
    const {from, to} = ends(slice), left = x(from), right = x(to);
    const body = this.#handle(slice, i, "both", svg("rect", {x: left, width: Math.max(right - left, 1), y: 0, height: kFloor, class: "slices-band"}), range);
    const number = svg("text", {x: (left + right) / 2, y: 14, class: "plot-number plot-middle slices-number"}, String(i + 1));
    const edge = (part, at) => this.#handle(slice, i, part, svg("g", {},
      svg("rect", {x: at - 7, width: 14, y: 0, height: kFloor, class: "slices-grip"}),
      svg("path", {d: `M${at},0V${kFloor}`, class: "slices-edge"}),
      svg("circle", {cx: at, cy: kFloor / 2, r: 5, class: "slices-knob"})), range);
    return svg("g", {}, body, number, edge("from", Math.max(left, 1)), edge("to", Math.min(right, kWidth - 1)));
  }

  #handle(slice, i, part, element, range) {
    const name = part === "both" ? "place" : part;
    const {from, to} = ends(slice);
    const now = Math.min(range.to, Math.max(range.from, part === "to" ? to : from));
    const value = part === "both" ? `${end(slice.from)} to ${end(slice.to)}` : end(slice[part]);
    const set = {role: "slider", tabindex: 0, "data-handle": `${i}-${part}`, "aria-label": `slice ${i + 1}, ${name}`,
      "aria-valuemin": range.from, "aria-valuemax": range.to, "aria-valuenow": now, "aria-valuetext": value};
    for (const [key, what] of Object.entries(set)) element.setAttribute(key, what);
    element.classList.add("slices-handle", `slices-${part}`);
    element.addEventListener("pointerdown", (event) => this.#grab(event, i, part));
    element.addEventListener("keydown", (event) => this.#key(event, i, part));
    return element;
  }

  #time(event) {
    const box = this.#drawing.getBoundingClientRect(), {from, to} = this.#range;
    return from + ((event.clientX - box.left) / box.width) * (to - from);
  }

  #grab(event, i, part) {
    if (event.button !== 0) return;
    event.preventDefault();
    event.currentTarget.focus({preventScroll: true});
    this.#drag = {i, part, slice: this.#slices[i], start: this.#time(event)};
    this.#drawing.setPointerCapture(event.pointerId);
    this.#app.frames.dragging = true;
  }
  #move(event) {
    if (!this.#drag) return;
    const {i, part, slice, start} = this.#drag, at = this.#time(event), {from, to} = this.#range;
    this.put(i, moved(slice, part, part === "both" ? at - start : at, to - from), true);
  }
  #drop() {
    if (!this.#drag) return;
    this.#drag = null;
    this.#app.store.commit();
    this.#app.frames.dragging = false;
  }

  #key(event, i, part) {
    const slice = this.#slices[i], {from, to} = this.#range, range = to - from;
    if (event.key === "Delete") return this.remove(i);
    const at = part === "both" ? 0 : Math.min(to, Math.max(from, ends(slice)[part]));
    let x;
    if (event.key in kSteps) x = at + kSteps[event.key] * (event.shiftKey ? 0.1 : 1) * range;
    else if (event.key === "Home" && part !== "both") x = from;
    else if (event.key === "End" && part !== "both") x = to;
    else return;
    event.preventDefault();
    event.stopPropagation();
    this.put(i, moved(slice, part, x, range), false);
  }

  put(i, slice, live) {
    this.#app.store.set(this.#pointer, this.#slices.map((old, k) => (k === i ? slice : old)), {live});
  }
  remove(i) {
    const left = this.#slices.filter((_, k) => k !== i);
    this.#app.store.set(this.#pointer, left.length > 0 ? left : undefined);
    this.#app.say(`Slice ${i + 1} removed.`);
  }
  #add() {
    const {from, to} = this.#range;
    this.#app.store.set(this.#pointer, [...this.#slices, fresh(this.#channel, from, to)]);
    this.#drawing.querySelector(`[data-handle="${this.#slices.length - 1}-both"]`)?.focus();
  }

  /** Made anew only where the slices are others: whoever types in a field keeps it. */
  #fields() {
    const now = JSON.stringify([this.#object.value, this.#slices]);
    if (now === this.#shownFields) return;
    const alike = this.#list.childElementCount === this.#slices.length && this.#list.contains(document.activeElement);
    this.#shownFields = now;
    if (alike) [...this.#list.children].forEach((element, i) => element.show(this.#slices[i]));
    else this.#list.replaceChildren(...this.#slices.map((slice, i) => sliceFields(slice, i, this)));
  }
}

const end = (x) => (x === undefined ? "open" : text(x));

function describe({finite, other, from, to, counts}, object) {
  if (!(finite > 0)) return `${object} is not seen.`;
  const most = counts.indexOf(Math.max(...counts)), wide = (to - from) / counts.length;
  const beyond = other > 0 ? ` ${other} without a finite time.` : "";
  return `${finite} crossings from ${text(from)} to ${text(to)}, most about ${text(from + (most + 0.5) * wide)}.${beyond}`;
}

