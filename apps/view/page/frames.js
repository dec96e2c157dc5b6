// Asks for frames whenever the look, the view or the size is another one. The newest wins: while two are under way
// nothing more is asked for, and what has changed meanwhile is asked for next.

import {ApiError, isLost} from "./api.js";
import {Link} from "./link.js";

const kSmooth = 33; // ms from a slider to the frame that shows it
const kAgain = 2000; // ms until a server that does not answer is asked again

/** Events: "shown" {frame, scale, ms}, "fault" {error}. */
export class Frames extends EventTarget {
  #app;
  #dragging = false;
  #wanted = false;
  #sent = 0;
  #shown = 0;
  #flying = new Map(); // number of the request -> when it was sent
  #waiting = []; // who waits for idle()
  #timer = 0;
  #half = 0; // ms a frame of half the size takes, 0: not known
  #known = false; // whether the link was measured

  constructor(app) {
    super();
    this.#app = app;
    this.link = new Link(location.hostname);
    /** What makes frames; live tracing puts its own in this place. */
    this.source = (query, body) => app.api.frame(query, body);
    this.last = null; // the frame that is shown
    app.store.addEventListener("change", ({detail}) => {
      this.#dragging = detail.live;
      this.refresh();
    });
    app.store.addEventListener("history", () => (this.dragging = false));
    app.addEventListener("view", () => this.refresh());
  }

  get dragging() {
    return this.#dragging;
  }
  /** While something is dragged frames have half the size; afterwards one in full follows. */
  set dragging(on) {
    if (this.#dragging === on) return;
    this.#dragging = on;
    if (!on) this.refresh();
  }

  refresh() {
    this.#wanted = true;
    this.#pump();
  }

  /** Resolves when the frame of the present look is on the screen, or was refused. */
  idle() {
    if (!this.#wanted && this.#flying.size === 0) return Promise.resolve();
    return new Promise((done) => this.#waiting.push(done));
  }

  #scale() {
    if (!this.#known) return 4; // measures the link, and is there at once
    if (!this.#dragging) return 1;
    return this.#half > kSmooth ? 4 : 2;
  }

  /** A second request goes out when the first should be drawn and is only on its way. */
  #delay() {
    if (this.#flying.size === 0) return 0;
    if (this.#flying.size >= 2) return Infinity;
    const [sent] = this.#flying.values();
    return sent + this.link.serverTime - performance.now();
  }

  #pump() {
    clearTimeout(this.#timer);
    if (!this.#wanted) return;
    const delay = this.#delay();
    if (delay === Infinity) return;
    if (delay > 1) this.#timer = setTimeout(() => this.#pump(), delay);
    else this.#ask();
  }

  async #ask() {
    this.#wanted = false;
    const number = ++this.#sent,
      begin = performance.now(),
      scale = this.#scale();
    this.#flying.set(number, begin);
    const {data, frame} = this.#app.view;
    const format = this.link.choose({lossless: scale === 1, pixels: this.#app.picture.pixels / scale ** 2});
    try {
      const got = await this.source({data, frame, scale, format}, this.#app.store.look);
      if (number > this.#shown) this.#show(got, number, scale, begin);
      else got.bitmap?.close();
    } catch (error) {
      if (!(error instanceof ApiError)) console.error(error);
      if (number > this.#shown) this.#failed(error, number);
    }
    this.#flying.delete(number);
    this.#settle();
  }

  #show(frame, number, scale, begin) {
    this.#shown = number;
    frame.scale ??= scale; // a source may make coarser ones than it was asked for
    this.#app.picture.draw(frame);
    this.last?.bitmap?.close();
    this.last = frame;
    const ms = performance.now() - begin;
    this.link.measured(frame);
    if (scale > 1 && this.#known) this.#count(frame, scale, ms);
    this.dispatchEvent(new CustomEvent("shown", {detail: {frame, scale, ms}}));
  }

  /** Of a quarter's time what goes with its pixels would be fourfold in a half. */
  #count(frame, scale, ms) {
    const work = Object.values(frame.times).reduce((sum, part) => sum + part, frame.decoded ?? 0);
    const half = scale === 2 ? ms : ms + 3 * work;
    this.#half = this.#half === 0 ? half : 0.6 * this.#half + 0.4 * half;
  }

  #failed(error, number) {
    this.#shown = number;
    this.dispatchEvent(new CustomEvent("fault", {detail: {error}}));
    if (isLost(error)) setTimeout(() => this.refresh(), kAgain);
  }

  #settle() {
    if (!this.#known) {
      this.#known = true;
      this.#wanted = true;
    }
    this.#pump();
    if (this.#wanted || this.#flying.size > 0) return;
    for (const done of this.#waiting.splice(0)) done();
  }
}
