// The picture: a canvas in the picture's own size, moved and zoomed as a whole, with layers and an overlay in picture
// coordinates above it.

import {Pointing} from "./pointing.js";

const kClosest = 64; // screen pixels a pixel of the picture
const kOutlined = 8; // from this zoom on the pixel under the pointer is outlined
const kLargestFit = 8;
const kSvg = "http://www.w3.org/2000/svg";

/**
 * Events: "pixel" {x, y, inside} in pixels of the canvas, for the pointer and the keyboard's cursor; "pick" {x, y} when
 * one is clicked or Enter is pressed; "drawn" {width, height, scale, ms}; "zoom" {zoom}.
 */
export class Picture extends EventTarget {
  #canvas;
  #context;
  #sheet;
  #outline;
  #layers = new Map();
  #fitted = true;
  #place = {x: 0, y: 0, zoom: 1}; // of the sheet's corner in the box, in its pixels

  /** @param {HTMLElement} element the box, with <div class="sheet"><canvas id="picture"> in it */
  constructor(element) {
    super();
    this.element = element;
    this.#sheet = element.querySelector(".sheet");
    this.#canvas = element.querySelector("canvas");
    // Pixels are put and read, never drawn: memory of the CPU.
    this.#context = this.#canvas.getContext("2d", {alpha: false, willReadFrequently: true});
    this.overlay = document.createElementNS(kSvg, "svg");
    this.overlay.setAttribute("class", "overlay");
    this.overlay.setAttribute("aria-hidden", "true");
    this.#outline = this.overlay.appendChild(document.createElementNS(kSvg, "rect"));
    this.#outline.setAttribute("class", "outline");
    this.#sheet.append(this.overlay);
    this.width = this.height = 0;
    /** The pixel that the pointer or the cursor is on. */
    this.pixel = {x: 0, y: 0, inside: false};
    /** What dragging does: "pan", or a function (phase "start" | "move" | "end", event, {dx, dy}). */
    this.mode = "pan";
    this.#listen();
    new Pointing(this);
  }

  #listen() {
    new ResizeObserver(() => (this.#fitted ? this.fit() : this.#move(this.#place))).observe(this.element);
    this.addEventListener("pixel", ({detail}) => {
      this.pixel = detail;
      this.#drawOutline();
    });
  }

  get pixels() {
    return this.width * this.height;
  }
  get zoom() {
    return this.#place.zoom;
  }
  get canvas() {
    return this.#canvas;
  }

  resize(width, height) {
    if (width === this.width && height === this.height) return;
    Object.assign(this, {width, height});
    for (const one of [this.#sheet, this.overlay]) {
      one.style.width = `${width}px`;
      one.style.height = `${height}px`;
    }
    this.overlay.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.fit();
  }

  /** Coarse frames (scale 2 or 4) take the same place. After one of scale 1 the canvas has exactly its pixels. */
  draw(frame) {
    const begin = performance.now(),
      scale = frame.scale ?? 1;
    const fits = Math.ceil(this.width / scale) === frame.width && Math.ceil(this.height / scale) === frame.height;
    if (!fits) this.resize(frame.width * scale, frame.height * scale);
    paint(this.#context, frame);
    stretch(this.#canvas, scale);
    const detail = {width: frame.width, height: frame.height, scale, ms: performance.now() - begin};
    this.dispatchEvent(new CustomEvent("drawn", {detail}));
  }

  /** Another canvas over the picture, hidden until it is drawn on by layer.show(frame); layer.hide(). */
  layer(name) {
    if (!this.#layers.has(name)) {
      const canvas = document.createElement("canvas");
      canvas.className = `layer layer-${name}`;
      canvas.hidden = true;
      canvas.show = (frame) => {
        paint(canvas.getContext("2d"), frame);
        stretch(canvas, frame.scale ?? 1);
        canvas.hidden = false;
      };
      canvas.hide = () => (canvas.hidden = true);
      this.overlay.before(canvas);
      this.#layers.set(name, canvas);
    }
    return this.#layers.get(name);
  }

  /** As large as it can be seen whole. */
  fit() {
    const {clientWidth, clientHeight} = this.element;
    if (this.width === 0 || clientWidth === 0) return;
    const zoom = Math.min(clientWidth / this.width, clientHeight / this.height, kLargestFit);
    this.#move({zoom, x: (clientWidth - zoom * this.width) / 2, y: (clientHeight - zoom * this.height) / 2});
    this.#fitted = true;
  }

  /** By a factor about a point of the box, in its pixels; by default the keyboard's cursor, or else the middle. */
  zoomBy(factor, x, y) {
    if (x === undefined) ({x, y} = this.#centre());
    const {clientWidth, clientHeight} = this.element;
    const whole = Math.min(clientWidth / this.width, clientHeight / this.height, 1);
    const before = this.#place;
    const zoom = Math.min(Math.max(before.zoom * factor, whole / 2), kClosest);
    const share = zoom / before.zoom;
    this.#move({zoom, x: x - share * (x - before.x), y: y - share * (y - before.y)});
  }

  #centre() {
    const {cursor, inside, x, y} = this.pixel;
    if (cursor && inside) return {x: this.#place.x + (x + 0.5) * this.zoom, y: this.#place.y + (y + 0.5) * this.zoom};
    return {x: this.element.clientWidth / 2, y: this.element.clientHeight / 2};
  }

  panBy(dx, dy) {
    this.#move({...this.#place, x: this.#place.x + dx, y: this.#place.y + dy});
  }

  /** Moves the picture so that the pixel is seen, at `zoom` if that is given. */
  reveal(x, y, zoom = this.zoom) {
    const {clientWidth, clientHeight} = this.element;
    const at = {x: this.#place.x + (x + 0.5) * this.zoom, y: this.#place.y + (y + 0.5) * this.zoom};
    const seen = at.x >= 0 && at.y >= 0 && at.x < clientWidth && at.y < clientHeight;
    if (seen && zoom === this.zoom) return;
    this.#move({zoom, x: clientWidth / 2 - (x + 0.5) * zoom, y: clientHeight / 2 - (y + 0.5) * zoom});
  }

  /** The pixel at a point of the window. */
  at(clientX, clientY) {
    const box = this.element.getBoundingClientRect();
    const x = Math.floor((clientX - box.left - this.element.clientLeft - this.#place.x) / this.zoom);
    const y = Math.floor((clientY - box.top - this.element.clientTop - this.#place.y) / this.zoom);
    return {x, y, inside: x >= 0 && y >= 0 && x < this.width && y < this.height};
  }

  #move({x, y, zoom}) {
    const {clientWidth, clientHeight} = this.element;
    // Some of the picture stays in sight.
    const margin = 48;
    x = Math.min(Math.max(x, margin - zoom * this.width), clientWidth - margin);
    y = Math.min(Math.max(y, margin - zoom * this.height), clientHeight - margin);
    this.#place = {x, y, zoom};
    this.#fitted = false;
    this.#sheet.style.transform = `translate(${x}px, ${y}px) scale(${zoom})`;
    this.#sheet.style.setProperty("--zoom", zoom);
    this.element.classList.toggle("close", zoom >= 2);
    this.#drawOutline();
    this.dispatchEvent(new CustomEvent("zoom", {detail: {zoom}}));
  }

  #drawOutline() {
    const {x, y, inside, cursor} = this.pixel;
    this.#outline.toggleAttribute("hidden", !(inside && (cursor || this.zoom >= kOutlined)));
    for (const [name, value] of Object.entries({x, y, width: 1, height: 1})) this.#outline.setAttribute(name, value);
  }
}

/** The canvas becomes the frame, pixel by pixel. */
function paint(context, frame) {
  const {canvas} = context;
  if (canvas.width !== frame.width) canvas.width = frame.width;
  if (canvas.height !== frame.height) canvas.height = frame.height;
  if (frame.rgba) context.putImageData(new ImageData(frame.rgba, frame.width, frame.height), 0, 0);
  else context.drawImage(frame.bitmap, 0, 0);
}

function stretch(canvas, scale) {
  canvas.style.width = `${canvas.width * scale}px`;
  canvas.style.height = `${canvas.height * scale}px`;
}
