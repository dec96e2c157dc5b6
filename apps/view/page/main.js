// The page of nullcone-view: asks what there is to see, shows its picture, and makes the controls.

import {Api} from "./api.js";
import {Store} from "./store.js";
import {Picture} from "./picture.js";
import {Frames} from "./frames.js";
import {fill} from "./filling.js";
import {merged} from "./look_patch.js";
import {readFragment} from "./fragment.js";
import {make} from "./widgets.js";
import * as header from "./header.js";
import * as keys from "./keys.js";
import * as objects from "./controls_objects.js";
import * as effects from "./controls_effects.js";
import * as lights from "./controls_lights.js";
import * as develop from "./controls_develop.js";
import * as textures from "./textures.js";
import * as share from "./share.js";
import * as raw from "./look_editor.js";
import * as timeline from "./timeline.js";
import * as histogram from "./histogram.js";
import * as inspect from "./inspect.js";
import * as channels from "./channels.js";
import * as compare from "./compare.js";
import * as images from "./images.js";
import * as live from "./live.js";
import * as steer from "./steer.js";

// In the order of their panels.
const kModules = [
  header,
  keys,
  objects,
  effects,
  lights,
  develop,
  textures,
  histogram,
  inspect,
  images,
  channels,
  compare,
  live,
  steer,
  timeline,
  share,
  raw,
];

const kRemembered = 12000; // ms

/**
 * What the modules share. Events: "view" when another dataset or frame is shown, "dataset" when the description is of
 * another dataset, "select" when another object is selected.
 */
class App extends EventTarget {
  api = new Api();
  state = null; // answer of api/state
  dataset = null; // answer of api/dataset
  view = {data: 0, frame: 0};
  /** Name of the object that the panel shows. */
  selected = null;
  /** Who refused the look: "look" or "frame"; null while it is right. */
  fault = null;
  store;
  picture;
  frames;
  #datasets = new Map(); // by number
  #status = document.getElementById("status");
  #forget = 0;
  #panels = document.getElementById("panels");

  /** A collapsible section of the side bar. @returns {{element: HTMLDetailsElement, body: HTMLElement}} */
  panel(id, title, {open = false} = {}) {
    const body = make("div", {class: "body"});
    const element = make(
      "details",
      {class: "panel", id: `panel-${id}`, open},
      make("summary", {}, make("h2", {}, title)),
      body,
    );
    this.#panels.append(element);
    return {element, body};
  }

  /** One line of what happened. */
  say(text, {error = false} = {}) {
    clearTimeout(this.#forget);
    if (!error) this.#forget = setTimeout(() => (this.#status.textContent = ""), kRemembered);
    this.#status.textContent = text;
    this.#status.classList.toggle("error", error);
  }

  /** @param {number} data @returns {Promise<object>} answer of api/dataset */
  async describe(data) {
    if (!this.#datasets.has(data)) this.#datasets.set(data, this.api.json("api/dataset", {query: {data}}));
    return this.#datasets.get(data);
  }

  /** Shows another dataset, frame or both. Looks go along between datasets with the same objects and lamps. */
  async show({data = this.view.data, frame}) {
    frame ??= data === this.view.data ? this.view.frame : (this.state.datasets[data]?.frame ?? 0);
    if (data === this.view.data && frame === this.view.frame) return;
    const other = typeof data === "number" && data !== this.view.data ? await this.describe(data) : this.dataset;
    const before = this.dataset;
    this.view = {data, frame};
    this.dataset = other;
    if (other !== before) {
      this.picture.resize(other.width, other.height);
      this.store.rebase(other.look, alike(before, other) ? undefined : other.look);
      if (!other.objects.some(({name}) => name === this.selected)) this.selected = other.objects[0]?.name ?? null;
      this.#tell("dataset");
    }
    this.#tell("view");
  }

  /** @param {string} name of an object */
  select(name) {
    if (name === this.selected || !this.dataset.objects.some((object) => object.name === name)) return;
    this.selected = name;
    this.#tell("select");
  }

  async begin() {
    this.state = await this.api.json("api/state");
    const given = await readFragment(location.hash).catch((error) => ({fault: error.message}));
    const data = given.data < this.state.datasets.length ? given.data : 0;
    this.dataset = await this.describe(data);
    this.view = {data, frame: given.frame ?? this.state.datasets[data]?.frame ?? 0};
    this.selected = this.dataset.objects[0]?.name ?? null;
    this.store = new Store(this.dataset.look);
    if (given.patch) this.store.replace(merged(this.dataset.look, given.patch));
    this.picture = new Picture(document.getElementById("stage"));
    this.picture.resize(this.dataset.width, this.dataset.height);
    this.frames = new Frames(this);
    this.frames.refresh();
    if (given.fault) this.say(given.fault, {error: true});
    fill(this);
    for (const module of kModules) this.#set(module);
  }

  /** A part that fails leaves the others alone. */
  async #set(module) {
    try {
      await module.setup(this);
    } catch (error) {
      console.error(error);
      this.say(`a part of the page failed: ${error.message}`, {error: true});
    }
  }
  #tell(name) {
    this.dispatchEvent(new CustomEvent(name));
  }
}

function alike(a, b) {
  const names = (dataset) => JSON.stringify([dataset.objects.map(({name}) => name), dataset.lights]);
  return names(a) === names(b);
}

const app = new App();
window.nullcone = app;
app.begin().catch((error) => {
  console.error(error);
  app.say(error.message, {error: true});
});
