// The panel "Move": camera, observer, objects and spacetime of a scene that is traced again as one drags.

import {html} from "./plot.js";
import {Store} from "./store.js";
import {LiveSource} from "./live_source.js";
import {LiveHand} from "./live_hand.js";
import {liveControls} from "./live_controls.js";
import {sceneNumbers} from "./scene_numbers.js";

const kSettled = 200; // ms after which another dataset stays: while a sequence plays no controls are made
const kModes = [["pan", "pan the picture"], ["look", "look round"], ["object", "move the object under the pointer"]];

export function setup(app) {
  const {body} = app.panel("live", "Move", {open: false});
  let live = null, timer = 0;
  const begin = () => {
    body.inert = false;
    body.replaceChildren();
    const {possible, why} = app.dataset.live ?? {possible: false, why: "the server does not trace"};
    if (possible) live = app.live = new Live(app, body);
    else body.append(html("p", {class: "hint"}, `The scene cannot be moved: ${why}.`));
    app.dispatchEvent(new CustomEvent("live"));
  };
  app.addEventListener("dataset", () => {
    live?.leave();
    live = app.live = null;
    body.inert = true;
    app.dispatchEvent(new CustomEvent("live"));
    clearTimeout(timer);
    timer = setTimeout(begin, kSettled);
  });
  app.keys?.add(["W", "S", "A", "D", "R", "F"], "on the picture, once a scene is moved: forwards, back, left, right, up, down");
  begin();
}

/** `scene`: a store of the scene's numbers; steering writes there too. */
export class Live {
  #app;
  #body;
  #plain;      // the source of frames before
  #on = false;
  #beginning = null;
  #drawn = []; // when the last frames came
  #status = html("output", {class: "live-status", "aria-live": "off"});
  #back = html("button", {type: "button", disabled: true}, "Back to the file");
  #undo = html("button", {type: "button", disabled: true}, "Undo");
  #redo = html("button", {type: "button", disabled: true}, "Redo");
  #reset = html("button", {type: "button", disabled: true}, "Reset");
  #save = html("button", {type: "button"}, "Save as dataset");

  constructor(app, body) {
    this.#app = app;
    this.#body = body;
    this.#plain = app.frames.source;
    this.type = app.dataset.scene.camera.type;
    this.metric = app.dataset.scene.metric.name;
    this.scene = new Store(sceneNumbers(app.dataset.scene));
    this.source = new LiveSource(app, this.scene, app.view.data === "live" ? 0 : app.view.data);
    this.hand = new LiveHand(app, this);
    this.steering = false; // keys are those of steering
    this.moving = false;   // steering, and not at rest
    this.source.hurry = () => this.moving || this.hand.held;
    this.place = html("div", {}); // of what steers
    body.append(html("p", {class: "hint"}, "Drags and changes here trace the scene again, coarsely while something moves."),
      this.#modes(), html("div", {class: "row"}, this.#undo, this.#redo, this.#reset, this.#back, this.#save),
      this.#status, this.place, liveControls(this));
    this.#listen();
  }

  get on() {
    return this.#on;
  }

  #modes() {
    const radios = kModes.map(([value, text]) => html("label", {class: "live-mode"},
      html("input", {type: "radio", name: "live-mode", value, checked: value === "pan", onchange: () => this.hand.setMode(value)}), ` ${text}`));
    return html("fieldset", {}, html("legend", {}, "Dragging on the picture"), ...radios);
  }

  #listen() {
    const {scene, source} = this, {frames} = this.#app;
    scene.addEventListener("change", ({detail}) => this.#changed(detail));
    scene.addEventListener("history", () => {
      this.#undo.disabled = !scene.canUndo;
      this.#redo.disabled = !scene.canRedo;
      this.#reset.disabled = Object.keys(source.changes).length === 0;
      if (!this.source.hurry()) frames.dragging = false;
    });
    this.#undo.addEventListener("click", () => scene.undo());
    this.#redo.addEventListener("click", () => scene.redo());
    this.#reset.addEventListener("click", () => scene.replace(scene.base));
    this.#back.addEventListener("click", () => this.#app.show({data: source.data}));
    this.#save.addEventListener("click", () => this.#saveDataset());
    source.addEventListener("frame", ({detail}) => this.#count(detail));
    this.onView = () => this.#on && this.#app.view.data !== "live" && this.leave(false);
    this.#app.addEventListener("view", this.onView);
  }

  #changed({live, pointer}) {
    const {frames} = this.#app;
    if (pointer.startsWith("/camera/resolution")) this.source.forget();
    if (live) frames.dragging = true;
    if (this.#on) frames.refresh();
    else this.begin();
  }

  /** From the file to what is traced. The page's other parts hear of it once there is something to ask about. */
  async begin() {
    if (this.#on || this.#beginning) return this.#beginning;
    const {frames} = this.#app;
    frames.source = (query, look) => this.source.frame(query, look);
    const first = new Promise((done) => this.source.addEventListener("frame", done, {once: true}));
    frames.refresh();
    this.#beginning = first;
    await first;
    this.#beginning = null;
    this.#on = true;
    this.#back.disabled = false;
    await this.#app.show({data: "live"});
  }

  /** Back to frames of files. */
  leave(all = true) {
    this.#on = false;
    this.#app.frames.source = this.#plain;
    this.#back.disabled = true;
    this.#status.textContent = "";
    this.hand.release();
    if (!all) return;
    this.hand.end();
    this.#app.removeEventListener("view", this.onView);
  }

  #count({ms, scale, trace}) {
    const now = performance.now();
    this.#drawn = [...this.#drawn.filter((at) => now - at < 1000), now];
    const span = now - this.#drawn[0];
    const rate = this.#drawn.length > 3 ? `${((1000 * (this.#drawn.length - 1)) / span).toFixed(0)} frames/s, ` : "";
    const how = scale === 1 ? "every pixel" : `every ${scale === 2 ? "2nd" : "4th"} pixel`;
    this.#status.textContent = `${rate}${how}, ${trace?.toFixed(0) ?? "?"} ms to trace, ${ms.toFixed(0)} ms in all`;
    if (scale === 1) this.#app.dispatchEvent(new CustomEvent("traced"));
  }

  async #saveDataset() {
    this.#save.disabled = true;
    this.#app.say("Tracing the dataset at full resolution …");
    try {
      const body = {scene: this.source.changes, look: this.#app.store.look};
      const answer = await this.#app.api.request("api/dataset", {query: {data: this.source.data}, body});
      const url = URL.createObjectURL(await answer.blob());
      const link = html("a", {href: url, download: this.#app.dataset.name.replace(/(\.exr)?$/, "-moved.exr")});
      link.click();
      setTimeout(() => URL.revokeObjectURL(url), 60000);
      this.#app.say("The dataset was traced and is saved.");
    } catch (error) {
      this.#app.say(error.message, {error: true});
    }
    this.#save.disabled = false;
  }
}
