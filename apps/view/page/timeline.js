// The time line of a sequence: datasets one after another, or the frames of keyframes.

import {html} from "./plot.js";

const kSlowest = 0.2, kFastest = 60;
const kPatience = 6; // frames until it is clear that they are late

export function setup(app) {
  const {frames, datasets} = app.state;
  const [first, last] = frames ?? [0, datasets.length - 1];
  if (last <= first) return;
  new Timeline(app, first, last, Boolean(frames));
}

class Timeline {
  #app;
  #first;
  #last;
  #keyframes;
  #playing = false;
  #drawn = [];   // when the last frames of the play were drawn
  #play = html("button", {type: "button", "aria-pressed": "false", class: "timeline-play"}, "▶ Play");
  #slider;
  #number;
  #loop = html("input", {type: "checkbox", checked: true});
  #rate = html("input", {type: "number", min: kSlowest, max: kFastest, step: "any", value: 24, "aria-label": "frames a second"});
  #reached = html("output", {class: "timeline-reached"});

  constructor(app, first, last, keyframes) {
    this.#app = app;
    this.#first = first;
    this.#last = last;
    this.#keyframes = keyframes;
    const range = {min: first, max: last, step: 1, value: this.#now, "aria-label": "frame"};
    this.#slider = html("input", {type: "range", class: "timeline-slider", ...range});
    this.#number = html("input", {type: "number", class: "timeline-number", ...range});
    const step = (label, by, sign) => html("button", {type: "button", "aria-label": label, title: label, onclick: () => this.#step(by)}, sign);
    const element = html("section", {class: "timeline", "aria-label": "Time line"},
      this.#play, step("frame before", -1, "◀|"), step("next frame", 1, "|▶"), this.#slider, this.#number,
      html("span", {class: "timeline-of"}, `of ${first} to ${last}`), html("label", {}, this.#loop, " loop"),
      html("label", {}, this.#rate, " frames/s"), this.#reached);
    (document.getElementById("timeline") ?? app.picture.element.parentElement).append(element);
    this.#listen(element);
    this.#update();
  }

  get #now() {
    const {data, frame} = this.#app.view;
    if (this.#keyframes) return frame ?? this.#first;
    return data === "live" ? this.#app.live?.source.data ?? this.#first : data; // what is moved is of that dataset
  }

  #listen(element) {
    this.#play.addEventListener("click", () => this.#setPlaying(!this.#playing));
    this.#slider.addEventListener("input", () => this.#go(this.#slider.valueAsNumber));
    this.#slider.addEventListener("pointerdown", () => (this.#app.frames.dragging = true));
    for (const name of ["pointerup", "pointercancel", "change"])
      this.#slider.addEventListener(name, () => (this.#app.frames.dragging = this.#playing));
    this.#number.addEventListener("change", () => this.#go(this.#number.valueAsNumber));
    element.addEventListener("keydown", (event) => {
      // On buttons and switches the space bar already does something.
      if (event.key !== " " || event.target.matches("button, input[type=checkbox]")) return;
      event.preventDefault();
      this.#setPlaying(!this.#playing);
    });
    this.#app.addEventListener("view", () => this.#update());
  }

  /** Resolves when the page has turned to that frame; drawn it is later. */
  async #go(frame) {
    if (!Number.isFinite(frame)) return;
    const to = Math.min(this.#last, Math.max(this.#first, Math.round(frame)));
    if (to !== this.#now) await this.#app.show(this.#keyframes ? {frame: to} : {data: to});
    this.#update();
  }

  #step(by) {
    this.#setPlaying(false);
    this.#go(this.#now + by);
  }

  #update() {
    const now = this.#now;
    this.#slider.value = now;
    this.#slider.setAttribute("aria-valuetext", this.#keyframes ? `frame ${now}` : this.#app.state.datasets[now]?.name ?? `${now}`);
    if (document.activeElement !== this.#number) this.#number.value = now;
  }

  async #setPlaying(on) {
    if (on === this.#playing) return;
    this.#playing = on;
    this.#play.setAttribute("aria-pressed", String(on));
    this.#play.textContent = on ? "❚❚ Pause" : "▶ Play";
    if (!on) this.#app.frames.dragging = false;
    this.#reached.textContent = "";
    this.#drawn = [];
    if (!on) return;
    if (this.#now === this.#last) await this.#go(this.#first);
    let due = performance.now();
    while (this.#playing) {
      due = Math.max(due + 1000 / this.#wanted, performance.now() - 100);
      await pause(due - performance.now());
      if (!this.#playing) break;
      if (!(await this.#advance())) return this.#setPlaying(false);
      await this.#app.frames.idle();
      this.#measure();
    }
  }

  get #wanted() {
    return Math.min(kFastest, Math.max(kSlowest, this.#rate.valueAsNumber || 24));
  }

  /** False at the end. */
  async #advance() {
    if (this.#now < this.#last) await this.#go(this.#now + 1);
    else if (this.#loop.checked) await this.#go(this.#first);
    else return false;
    return true;
  }

  #measure() {
    this.#drawn.push(performance.now());
    if (this.#drawn.length > 20) this.#drawn.shift();
    const rate = reachedRate(this.#drawn);
    // Frames of half the size only where whole ones come too late.
    if (this.#drawn.length >= kPatience && rate < 0.8 * this.#wanted) this.#app.frames.dragging = true;
    if (rate > 0) this.#reached.textContent = `${rate.toFixed(1)}/s reached`;
  }
}

const pause = (ms) => new Promise((done) => setTimeout(done, Math.max(0, ms)));

/** Frames a second of frames drawn at these times in ms. */
export function reachedRate(times) {
  if (times.length < 2) return 0;
  const span = times.at(-1) - times[0];
  return span > 0 ? (1000 * (times.length - 1)) / span : 0;
}
