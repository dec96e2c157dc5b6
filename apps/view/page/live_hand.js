// Pointer and keys that move the camera, the observer and objects of a live scene.

import {pixelRecords} from "./plot.js";
import {cameraAxes, scaled, sum} from "./relativity.js";
import {angles, extent, lookedRound, pixelFrame} from "./scene_numbers.js";

/** Along forward, left and up. */
const kKeys = {w: [1, 0, 0], s: [-1, 0, 0], a: [0, 1, 0], d: [0, -1, 0], r: [0, 0, 1], f: [0, 0, -1]};
const kRounding = 1e6;

export class LiveHand {
  #app;
  #live;
  #mode = "pan";
  #object = null; // what is dragged: {name, Z, frame}
  #keys = new Set();
  #clock = 0;
  #dragging = false;

  constructor(app, live) {
    this.#app = app;
    this.#live = live;
    /** Lengths a second of the keys. */
    this.pace = rounded(extent(live.scene.base) / 5);
    this.down = (event) => this.#down(event);
    this.up = (event) => this.#up(event.key.toLowerCase());
    this.blur = () => this.#letGo();
    app.picture.element.addEventListener("keydown", this.down);
    window.addEventListener("keyup", this.up);
    window.addEventListener("blur", this.blur);
  }

  /** Whether something is being moved. */
  get held() {
    return this.#dragging || this.#keys.size > 0;
  }

  setMode(mode) {
    this.#mode = mode;
    const handler = {look: (...all) => this.#look(...all), object: (...all) => this.#moveObject(...all)}[mode];
    this.#app.picture.mode = handler ?? "pan";
    if (mode !== "pan") this.#live.begin();
  }

  /** The picture is panned again. */
  release() {
    this.#letGo();
    this.#app.picture.mode = "pan";
    const pan = document.querySelector("input[name=live-mode][value=pan]");
    if (pan) pan.checked = true;
  }
  end() {
    this.#app.picture.element.removeEventListener("keydown", this.down);
    window.removeEventListener("keyup", this.up);
    window.removeEventListener("blur", this.blur);
  }

  #phase(phase) {
    this.#dragging = phase !== "end";
    if (phase === "start") this.#app.frames.dragging = true;
    if (phase !== "end") return;
    this.#live.scene.commit();
    if (!this.#live.moving) this.#app.frames.dragging = false;
  }

  #look(phase, event, {dx, dy}) {
    this.#phase(phase);
    if (phase !== "move") return;
    const {scene, type} = this.#live, zoom = this.#app.picture.zoom;
    scene.set("/camera", lookedRound(type, scene.look.camera, dx / zoom, dy / zoom), {live: true});
  }

  #moveObject(phase, event, {dx, dy}) {
    this.#phase(phase);
    if (phase === "start") this.#pick(this.#app.picture.at(event.clientX, event.clientY));
    if (phase === "end") this.#object = null;
    if (phase !== "move" || !this.#object) return;
    this.#object.dx += dx / this.#app.picture.zoom;
    this.#object.dy += dy / this.#app.picture.zoom;
    if (this.#object.frame) this.#place();
  }

  /** At right angles to the line of sight, as far as it is away: where light runs straight it stays under the pointer. */
  #place() {
    const {name, start, Z, frame, dx, dy} = this.#object;
    const by = scaled(sum(scaled(frame.right, dx), scaled(frame.down, dy)), frame.parallel ? 1 : Z);
    this.#live.scene.set(`/objects/${name}/event`, [start[0], ...sum(start.slice(1), by)].map(rounded), {live: true});
  }

  async #pick({x, y, inside}) {
    if (!inside) return;
    const object = (this.#object = {dx: 0, dy: 0});
    const {scene, type} = this.#live;
    try {
      const {hits} = await pixelRecords(this.#app, x, y);
      const hit = hits.find((one) => scene.look.objects[one.object] && Number.isFinite(one.Z));
      if (!hit) return this.#app.say("There is no object here that can be moved.");
      const start = scene.look.objects[hit.object].event;
      Object.assign(object, {name: hit.object, Z: hit.Z, start, frame: pixelFrame(type, scene.look.camera, x, y)});
      this.#app.say(`Moving ${hit.object}.`);
      if (this.#object === object) this.#place();
    } catch (error) {
      this.#app.say(error.message, {error: true});
    }
  }

  #down(event) {
    const key = event.key.toLowerCase();
    if (!(key in kKeys) || event.ctrlKey || event.metaKey || event.altKey || this.#live.steering) return;
    if (!this.#live.on && this.#mode === "pan") return;
    event.preventDefault();
    if (this.#keys.has(key)) return;
    this.#keys.add(key);
    if (this.#keys.size === 1) this.#run();
  }
  #up(key) {
    if (this.#keys.delete(key) && this.#keys.size === 0) this.#live.scene.commit();
  }
  #letGo() {
    if (this.#keys.size === 0) return;
    this.#keys.clear();
    this.#live.scene.commit();
  }

  #run() {
    this.#clock = performance.now();
    const step = () => {
      if (this.#keys.size === 0) return;
      const now = performance.now(), dt = Math.min((now - this.#clock) / 1000, 0.1);
      this.#clock = now;
      this.#walk(dt);
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  #walk(dt) {
    const {scene} = this.#live, {forward, left, up} = cameraAxes(angles(scene.look.camera));
    let by = [0, 0, 0];
    for (const key of this.#keys)
      [forward, left, up].forEach((axis, i) => (by = sum(by, scaled(axis, kKeys[key][i] * this.pace * dt))));
    const [t, ...place] = scene.look.observer.event;
    scene.set("/observer/event", [t, ...sum(place, by).map(rounded)], {live: true});
  }
}

function rounded(x) {
  return Math.round(x * kRounding) / kRounding;
}
