// A wipe between two looks: left of the line the one that was kept, right of it the present one.

import {html} from "./plot.js";

const kSteps = {ArrowLeft: -0.01, ArrowRight: 0.01, ArrowDown: -0.01, ArrowUp: 0.01, PageDown: -0.1, PageUp: 0.1};

export function setup(app) {
  new Compare(app);
}

class Compare {
  #app;
  #kept = null;
  #layer;
  #share = 0.5; // of the box's width
  #asked = 0;
  #line = html("div", {class: "wipe", role: "slider", tabindex: 0, hidden: true, "aria-label": "line between the kept look and the present one",
    "aria-orientation": "horizontal", "aria-valuemin": 0, "aria-valuemax": 100});
  #keep = html("button", {type: "button"}, "Keep this look to compare");
  #swap = html("button", {type: "button", disabled: true}, "Swap");
  #leave = html("button", {type: "button", disabled: true}, "Leave");
  #note = html("p", {class: "extras-note"}, "The kept look is shown left of a line, the present one right of it.");

  constructor(app) {
    this.#app = app;
    this.#layer = app.picture.layer("compare");
    const {body} = app.panel("compare", "Compare", {open: false});
    body.append(html("div", {class: "extras-row"}, this.#keep, this.#swap, this.#leave), this.#note);
    app.picture.element.append(this.#line);
    this.#keep.addEventListener("click", () => this.#begin());
    this.#swap.addEventListener("click", () => this.#swapLooks());
    this.#leave.addEventListener("click", () => this.#end());
    this.#listen();
  }

  #listen() {
    this.#line.addEventListener("pointerdown", (event) => {
      event.preventDefault();
      event.stopPropagation(); // the picture would be moved
      this.#line.focus({preventScroll: true});
      this.#line.setPointerCapture(event.pointerId);
    });
    this.#line.addEventListener("pointermove", (event) => {
      event.stopPropagation();
      if (!this.#line.hasPointerCapture(event.pointerId)) return;
      const box = this.#app.picture.element.getBoundingClientRect();
      this.#put((event.clientX - box.left) / box.width);
    });
    this.#line.addEventListener("pointerup", (event) => event.stopPropagation());
    this.#line.addEventListener("keydown", (event) => this.#key(event));
    for (const name of ["zoom", "drawn"]) this.#app.picture.addEventListener(name, () => this.#clip());
    for (const name of ["view", "traced"]) this.#app.addEventListener(name, () => this.#load());
    new ResizeObserver(() => this.#clip()).observe(this.#app.picture.element);
  }

  #key(event) {
    if (event.key === "Escape") this.#end();
    else if (event.key in kSteps) this.#put(this.#share + kSteps[event.key]);
    else if (event.key === "Home") this.#put(0);
    else if (event.key === "End") this.#put(1);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  #begin() {
    this.#kept = this.#app.store.look;
    this.#load();
    this.#line.hidden = false;
    this.#swap.disabled = this.#leave.disabled = false;
    this.#keep.textContent = "Keep the present look instead";
    this.#put(this.#share);
    this.#app.say("The look is kept; change it and drag the line.");
  }

  #end() {
    if (this.#kept === null) return;
    this.#kept = null;
    this.#layer.hide();
    this.#line.hidden = true;
    this.#swap.disabled = this.#leave.disabled = true;
    this.#keep.textContent = "Keep this look to compare";
    this.#keep.focus();
  }

  #swapLooks() {
    const present = this.#app.store.look;
    this.#app.store.replace(this.#kept);
    this.#kept = present;
    this.#load();
  }

  /** The kept look's picture, in full and without loss. */
  async #load() {
    if (this.#kept === null) return;
    const asked = ++this.#asked, {data, frame} = this.#app.view;
    try {
      const format = this.#app.frames.link?.choose({lossless: true, pixels: this.#app.picture.pixels}) ?? "png";
      const got = await this.#app.api.frame({data, frame, scale: 1, format}, this.#kept);
      if (asked !== this.#asked || this.#kept === null) return;
      got.scale = Math.max(1, Math.round(this.#app.picture.width / got.width));
      this.#layer.show(got);
      this.#clip();
    } catch (error) {
      this.#app.say(`The kept look: ${error.message}`, {error: true});
    }
  }

  #put(share) {
    this.#share = Math.min(1, Math.max(0, share));
    const percent = Math.round(100 * this.#share);
    this.#line.style.left = `${100 * this.#share}%`;
    this.#line.setAttribute("aria-valuenow", percent);
    this.#line.setAttribute("aria-valuetext", `kept look on the left ${percent} %`);
    this.#clip();
  }

  /** The layer moves with the picture, the line stays: what is left of the line changes with every pan. */
  #clip() {
    if (this.#kept === null) return;
    const box = this.#app.picture.element.getBoundingClientRect(), layer = this.#layer.getBoundingClientRect();
    if (layer.width === 0) return;
    const share = (box.left + this.#share * box.width - layer.left) / layer.width;
    this.#layer.style.clipPath = `inset(0 ${100 * (1 - Math.min(1, Math.max(0, share)))}% 0 0)`;
  }
}
