// Frames of a scene that is traced again as its numbers change.

import {ApiError} from "./api.js";
import {difference} from "./look_patch.js";
import {dragScale} from "./scene_numbers.js";

const kMost = 40; // ms a frame while something moves: 25 a second

/** Events: "frame" {ms, scale, traced}. */
export class LiveSource extends EventTarget {
  #app;
  #scene;
  #version = 0;  // of the scene
  #sent = 0;
  #traced = {number: 0, version: -1, scale: 1};
  #took = new Map();
  #scale = 4;

  /** @param {import("./store.js").Store} scene its numbers @param {number} data of the dataset that it is of */
  constructor(app, scene, data) {
    super();
    this.#app = app;
    this.#scene = scene;
    this.data = data;
    /** Whether something moves: then frames are coarse, whoever asks. */
    this.hurry = () => false;
    scene.addEventListener("change", () => ++this.#version);
  }

  get changes() {
    return difference(this.#scene.base, this.#scene.look);
  }
  /** Another size, or more to trace: what frames took tells nothing any more. */
  forget() {
    this.#took.clear();
    this.#traced.version = -1;
  }

  /** In the place of frames.source. */
  async frame(query, look) {
    const {version, scale} = this.#traced, coarse = query.scale > 1 || this.hurry();
    if (version === this.#version && (scale === 1 || coarse)) {
      try {
        return await this.#seen(query, look, scale);
      } catch (error) {
        if (!(error instanceof ApiError) || error.status !== 409) throw error; // the server has forgotten it
      }
    }
    return this.#trace(query, look, coarse);
  }

  /** What was traced last, with another look. */
  async #seen(query, look, traced) {
    const frame = await this.#app.api.frame({...query, data: "live", scale: traced > 1 ? 1 : query.scale}, look);
    frame.scale = traced > 1 ? traced : query.scale;
    return frame;
  }

  async #trace({format, frame: key}, look, coarse) {
    const version = this.#version, number = ++this.#sent;
    const scale = coarse ? (this.#scale = dragScale(this.#took, this.#scale, kMost)) : 1;
    const query = {data: this.data, frame: key, scale, format};
    const frame = await this.#app.api.frame(query, {scene: this.changes, look}, "api/trace");
    frame.scale = scale;
    const work = Object.values(frame.times).reduce((sum, ms) => sum + ms, 0), before = this.#took.get(scale);
    this.#took.set(scale, before === undefined ? work : 0.6 * before + 0.4 * work);
    // A scale that was too slow once is tried again after a while.
    for (const [other, ms] of this.#took) if (other !== scale) this.#took.set(other, 0.98 * ms);
    if (number > this.#traced.number) this.#traced = {number, version, scale};
    this.dispatchEvent(new CustomEvent("frame", {detail: {ms: frame.ms, scale, trace: frame.times.trace}}));
    return frame;
  }
}
