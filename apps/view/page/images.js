// The panel "Images": those of the selected object in the order in which their light set out.

import {fillObjects, firstLine, html, svg, text} from "./plot.js";

export function setup(app) {
  const list = new ImageList(app);
  app.addEventListener("select", () => list.select(app.selected));
  app.addEventListener("dataset", () => list.refill());
  app.addEventListener("view", () => list.stale());
  app.addEventListener("traced", () => list.stale());
}

class ImageList {
  #app;
  #panel;
  #object;
  #asked = 0;
  #fresh = false;
  #chosen = 0;
  #words = html("p", {class: "extras-note", role: "status"});
  #list = html("ol", {class: "images"});
  #outline = svg("rect", {class: "images-outline", visibility: "hidden"});

  constructor(app) {
    this.#app = app;
    this.#panel = app.panel("images", "Images of an object", {open: false});
    this.#object = html("select", {"aria-label": "object"});
    this.refill();
    this.#object.addEventListener("change", () => this.stale());
    this.#panel.body.append(this.#object, this.#words, this.#list);
    app.picture.overlay.append(this.#outline);
    this.#panel.element.addEventListener("toggle", () => this.#load());
  }

  refill() {
    fillObjects(this.#object, this.#app);
  }

  select(name) {
    if (!name || name === this.#object.value) return;
    this.#object.value = name;
    this.stale();
  }

  /** The list is made when it can be seen. */
  stale() {
    this.#fresh = false;
    this.#choose(null);
    this.#load();
  }

  async #load() {
    if (this.#fresh || !this.#panel.element.open) return;
    this.#fresh = true;
    const asked = ++this.#asked, object = this.#object.value;
    try {
      const {images} = await this.#app.api.json("api/images", {query: {data: this.#app.view.data, object}});
      if (asked !== this.#asked) return;
      this.#words.textContent = images.length === 0 ? `${object} is not seen.`
        : `${images.length} ${images.length === 1 ? "image" : "images"} of ${object}, earliest light first`;
      this.#list.replaceChildren(...images.map((image) => html("li", {}, this.#button(image))));
    } catch (error) {
      if (asked !== this.#asked) return;
      this.#words.textContent = error.message;
      this.#list.replaceChildren();
    }
  }

  #button(image) {
    const {order, pixels, t, tau, shift} = image;
    const button = html("button", {type: "button", class: "images-item", "aria-pressed": "false"},
      html("strong", {}, `t ${span(t)}`),
      ` ${ordinal(order)}, ${pixels} px, g ${text(shift?.[1], 3)}, τ ${span(tau)}`);
    button.addEventListener("click", () => this.#choose(this.#chosen === image ? null : image, button));
    return button;
  }

  #choose(image, button) {
    this.#chosen = image;
    for (const other of this.#list.querySelectorAll("button")) other.setAttribute("aria-pressed", String(other === button && image !== null));
    this.#outline.setAttribute("visibility", image ? "visible" : "hidden");
    if (!image) return;
    const first = firstLine(this.#app), [x0, y0, x1, y1] = image.box;
    const set = {x: x0 - 2, y: y0 - first - 2, width: x1 - x0 + 5, height: y1 - y0 + 5};
    for (const [name, value] of Object.entries(set)) this.#outline.setAttribute(name, value);
    const {picture} = this.#app;
    picture.reveal(image.centre[0], image.centre[1] - first, zoomFor(picture, x1 - x0 + 1, y1 - y0 + 1));
    this.#app.say(`Image ${image.number}: ${image.pixels} pixels about ${image.centre.map((x) => Math.round(x)).join(", ")}.`);
  }
}

/** Near enough that a small image can be seen, else as it is. */
function zoomFor(picture, width, height) {
  const {clientWidth, clientHeight} = picture.element;
  const whole = 0.6 * Math.min(clientWidth / width, clientHeight / height);
  return Math.max(Math.min(picture.zoom, whole), Math.min(whole, picture.zoom * 4, 4));
}

const ordinal = (order) => (order === 0 ? "primary" : order === undefined ? "" : `order ${order}`);
const span = (range) => (range ? `${text(range[0], 3)} to ${text(range[2], 3)}` : "unknown");
