// Pointer, wheel, touch and keys on the picture.

const kClick = 4; // px a click may move
const kWheel = 0.0015;

/** Turns what the hand does on `picture` into its pans, zooms and events. */
export class Pointing {
  #picture;
  #pointers = new Map(); // id -> {x, y}
  #moved = 0;
  #handler = null;

  constructor(picture) {
    this.#picture = picture;
    const {element} = picture;
    element.addEventListener("pointerdown", (event) => this.#down(event));
    element.addEventListener("pointermove", (event) => this.#move(event));
    element.addEventListener("pointerup", (event) => this.#up(event));
    element.addEventListener("pointercancel", (event) => this.#up(event));
    element.addEventListener("pointerleave", () => this.#leave());
    element.addEventListener("wheel", (event) => this.#wheel(event), {passive: false});
    element.addEventListener("keydown", (event) => this.#key(event));
    element.addEventListener("blur", () => this.#leave(true));
  }

  #down(event) {
    if (event.button > 1) return;
    const {element, mode} = this.#picture;
    element.setPointerCapture(event.pointerId);
    this.#pointers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    if (this.#pointers.size > 1) return this.#endHandler(event);
    this.#moved = 0;
    element.classList.add("held");
    // The middle button pans whatever the mode.
    this.#handler = typeof mode === "function" && event.button === 0 ? mode : null;
    this.#handler?.("start", event, {dx: 0, dy: 0});
  }

  #move(event) {
    const before = this.#pointers.get(event.pointerId);
    if (before === undefined) return this.#tell(this.#picture.at(event.clientX, event.clientY));
    const now = {x: event.clientX, y: event.clientY};
    const dx = now.x - before.x,
      dy = now.y - before.y;
    this.#moved += Math.hypot(dx, dy);
    if (this.#pointers.size === 1) {
      if (this.#handler) this.#handler("move", event, {dx, dy});
      else if (this.#moved > kClick) this.#picture.panBy(dx, dy);
    } else {
      this.#pinch(event.pointerId, before, now);
    }
    this.#pointers.set(event.pointerId, now);
  }

  /** About the middle between two fingers. */
  #pinch(id, before, now) {
    const [, other] = [...this.#pointers].find(([one]) => one !== id);
    const distance = (a) => Math.max(Math.hypot(a.x - other.x, a.y - other.y), 1);
    const box = this.#picture.element.getBoundingClientRect();
    this.#picture.panBy((now.x - before.x) / 2, (now.y - before.y) / 2);
    const middle = {x: (now.x + other.x) / 2 - box.left, y: (now.y + other.y) / 2 - box.top};
    this.#picture.zoomBy(distance(now) / distance(before), middle.x, middle.y);
  }

  #up(event) {
    if (!this.#pointers.delete(event.pointerId)) return;
    if (this.#pointers.size > 0) return;
    this.#picture.element.classList.remove("held");
    this.#endHandler(event);
    const at = this.#picture.at(event.clientX, event.clientY);
    this.#tell(at);
    if (event.type === "pointerup" && this.#moved <= kClick && event.button === 0 && at.inside) this.#pick(at);
  }

  #endHandler(event) {
    this.#handler?.("end", event, {dx: 0, dy: 0});
    this.#handler = null;
  }

  #leave(always = false) {
    if (always || !this.#picture.pixel.cursor) this.#tell({...this.#picture.pixel, inside: false, cursor: false});
  }

  #wheel(event) {
    event.preventDefault();
    const unit = event.deltaMode === 1 ? 33 : event.deltaMode === 2 ? 400 : 1;
    const speed = event.ctrlKey ? 6 * kWheel : kWheel; // ctrl: a pinch on a touch pad
    const box = this.#picture.element.getBoundingClientRect();
    const factor = Math.exp(-event.deltaY * unit * speed);
    this.#picture.zoomBy(factor, event.clientX - box.left, event.clientY - box.top);
    this.#tell(this.#picture.at(event.clientX, event.clientY));
  }

  #key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target !== this.#picture.element) return;
    const step = event.shiftKey ? 10 : 1;
    const by = {ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step]}[event.key];
    if (by !== undefined) this.#cursor(...by);
    else if (event.key === "Enter" && this.#picture.pixel.inside) this.#pick(this.#picture.pixel);
    else if (event.key === "Escape") this.#leave(true);
    else return;
    event.preventDefault();
  }

  /** Where the pointer was last, or in the middle to begin with. */
  #cursor(dx, dy) {
    const {pixel, width, height} = this.#picture;
    const known = pixel.x >= 0 && pixel.y >= 0 && pixel.x < width && pixel.y < height && (pixel.x > 0 || pixel.y > 0);
    const from = known ? pixel : {x: width >> 1, y: height >> 1};
    const x = Math.min(Math.max(from.x + dx, 0), width - 1),
      y = Math.min(Math.max(from.y + dy, 0), height - 1);
    this.#picture.reveal(x, y);
    this.#tell({x, y, inside: true, cursor: true});
  }

  #pick({x, y}) {
    this.#picture.dispatchEvent(new CustomEvent("pick", {detail: {x, y}}));
  }
  #tell(detail) {
    this.#picture.dispatchEvent(new CustomEvent("pixel", {detail}));
  }
}
