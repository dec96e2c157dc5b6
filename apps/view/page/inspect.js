// The panel "Pixel": all records under the pointer as a table, and the spectra of what is seen there.

import {html, newestWins, pixelRecords, svg, text} from "./plot.js";
import {spectrumPlot} from "./spectrum_plot.js";

const kPause = 60;   // ms between two requests while the pointer moves
const kLookRests = 250; // ms after the last change of the look
/** What rows are called; the rest keep their channel's name. */
const kMeanings = {
  Z: "affine distance along the ray", A: "opacity", order: "caustics passed", sample: "which ray of the pixel",
  uv: "texture coordinates", shift: "frequency ratio observed / emitted", t: "coordinate time of emission minus that of observation",
  tau: "the object's proper time", mu: "cosine of the angle of emission", duv: "footprint in the texture",
  N: "unit normal", K: "direction of emission", P: "place minus that of the observation",
};
const kNames = {shift: "g", tau: "τ", mu: "μ"};

export function setup(app) {
  new Inspection(app);
}

class Inspection {
  #app;
  #panel;
  #at = null;
  #pinned = false;
  #shown = null;
  #logarithmic = false;
  #timer = 0;
  #title = html("p", {class: "inspect-title"}, "Move the pointer over the picture.");
  #pin = html("button", {type: "button", "aria-pressed": "false", disabled: true}, "Pin (P)");
  #copy = html("button", {type: "button", disabled: true}, "Copy as JSON");
  #records = html("div", {class: "extras-scroll", tabindex: 0, role: "region", "aria-label": "records of the pixel"});
  #spectra = html("div", {});
  #log = html("input", {type: "checkbox"});
  #logLabel = html("label", {hidden: true}, this.#log, " logarithmic");
  #marker = svg("path", {class: "inspect-marker", visibility: "hidden"});
  #ask = newestWins((x, y) => this.#fetch(x, y));

  constructor(app) {
    this.#app = app;
    this.#panel = app.panel("pixel", "Pixel", {open: true});
    this.#panel.body.append(this.#title, html("div", {class: "extras-row"}, this.#pin, this.#copy, this.#logLabel), this.#records, this.#spectra);
    app.picture.overlay.append(this.#marker);
    app.picture.addEventListener("pixel", ({detail}) => this.#over(detail));
    app.picture.addEventListener("pick", ({detail}) => this.#setPin(true, detail));
    app.keys?.add(["P"], "pin the pixel under the pointer, and let go of it", () => this.#setPin(!this.#pinned, this.#at));
    app.store.addEventListener("change", () => this.#again(kLookRests));
    app.addEventListener("view", () => this.#again(0));
    app.addEventListener("traced", () => this.#again(0));
    this.#pin.addEventListener("click", () => this.#setPin(!this.#pinned, this.#at));
    this.#copy.addEventListener("click", () => this.#copyShown());
    this.#log.addEventListener("change", () => {
      this.#logarithmic = this.#log.checked;
      this.#drawSpectra();
    });
  }

  get #open() {
    return this.#panel.element.open !== false;
  }

  #over({x, y, inside}) {
    if (!inside || this.#pinned) return;
    this.#at = {x, y};
    if (this.#open) this.#ask(x, y);
  }

  /** Picking the pinned pixel again lets go of it. */
  #setPin(on, at) {
    if (at === null) return;
    const same = this.#pinned && this.#at.x === at.x && this.#at.y === at.y;
    this.#pinned = on && !same;
    this.#at = {x: at.x, y: at.y};
    this.#pin.setAttribute("aria-pressed", String(this.#pinned));
    this.#pin.textContent = this.#pinned ? "Unpin (P)" : "Pin (P)";
    this.#marker.setAttribute("visibility", this.#pinned ? "visible" : "hidden");
    if (this.#pinned) {
      this.#marker.setAttribute("d", cross(at.x + 0.5, at.y + 0.5, 1 + 8 / this.#app.picture.zoom));
      this.#panel.element.open = true;
    }
    this.#ask(at.x, at.y);
  }

  #again(pause) {
    clearTimeout(this.#timer);
    if (this.#at === null || !this.#open) return;
    this.#timer = setTimeout(() => this.#ask(this.#at.x, this.#at.y), pause);
  }

  async #fetch(x, y) {
    if (x >= this.#app.picture.width || y >= this.#app.picture.height) return;
    try {
      this.#shown = await pixelRecords(this.#app, x, y);
      this.#draw();
      if (this.#pinned && this.#at.x === x && this.#at.y === y) this.#app.say(this.#sentence());
    } catch (error) {
      this.#title.textContent = error.message;
    }
    await new Promise((done) => setTimeout(done, kPause));
  }

  #sentence() {
    const {pixel, hits} = this.#shown;
    const first = hits.filter((hit, i) => hits.findIndex(({object}) => object === hit.object) === i);
    const seen = hits.length === 0 ? "nothing" : first.slice(0, 3).map((hit) => `${hit.object}, g ${text(hit.shift)}`).join("; ");
    return `Pixel ${pixel.join(", ")}: ${seen}.`;
  }

  #draw() {
    const {pixel, rays, hits} = this.#shown;
    const name = hits[0]?.object ?? (Array.isArray(rays) ? rays[0] : rays).status;
    this.#title.textContent = `x ${pixel[0]}, y ${pixel[1]}: ${name}`;
    this.#pin.disabled = this.#copy.disabled = false;
    this.#records.replaceChildren(rayTable(rays), ...(hits.length > 0 ? [hitTable(hits)] : []));
    this.#drawSpectra();
  }

  #drawSpectra() {
    const spectra = this.#shown?.spectra ?? [];
    this.#logLabel.hidden = spectra.length === 0;
    this.#spectra.replaceChildren(...spectra.slice(0, 4).map((one) => spectrumPlot(one, {logarithmic: this.#logarithmic})));
  }

  async #copyShown() {
    const words = JSON.stringify(this.#shown, null, 2);
    try {
      await navigator.clipboard.writeText(words);
    } catch {
      copyBySelection(words);
    }
    this.#app.say(`Records of pixel ${this.#shown.pixel.join(", ")} copied as JSON.`);
  }
}

/** Where the page is not served securely there is no clipboard but this. */
function copyBySelection(words) {
  const area = html("textarea", {class: "extras-hidden", "aria-hidden": "true"});
  area.value = words;
  document.body.append(area);
  area.select();
  document.execCommand("copy");
  area.remove();
}

const cross = (x, y, r) => `M${x - r},${y}H${x - 1}M${x + 1},${y}H${x + r}M${x},${y - r}V${y - 1}M${x},${y + 1}V${y + r}`;

const value = (x) => (Array.isArray(x) ? x.map((one) => text(one)).join(", ") : typeof x === "number" || x === null ? text(x) : String(x));
const path = (p) => `E ${text(p.E)}, g ${text(p.shift)}, t ${text(p.t)}, τ ${text(p.tau)}`;

/** How the rays ended: of several samples each status with its number, and the greatest of the rest. */
export function rayRows(rays) {
  if (!Array.isArray(rays)) return Object.entries(rays);
  const counts = new Map();
  for (const {status} of rays) counts.set(status, (counts.get(status) ?? 0) + 1);
  const rows = [["status", [...counts].map(([status, n]) => `${status} × ${n}`).join(", ")]];
  for (const key of Object.keys(rays[0])) {
    if (key === "status" || key === "sample") continue;
    rows.push([`${key}, greatest`, Math.max(...rays.map((ray) => ray[key] ?? Infinity))]);
  }
  return rows;
}

function rayTable(rays) {
  const rows = rayRows(rays).map(([name, what]) => html("tr", {}, html("th", {scope: "row"}, name), html("td", {}, value(what))));
  const many = Array.isArray(rays) ? `${rays.length} rays` : "ray";
  return html("table", {class: "records"}, html("caption", {}, many), html("tbody", {}, ...rows));
}

/** One column a crossing, one row a quantity; light by lamp and path. */
export function hitRows(hits) {
  const keys = [...new Set(hits.flatMap((hit) => Object.keys(hit)))].filter((key) => key !== "object" && key !== "lights");
  const rows = keys.map((key) => ({name: kNames[key] ?? key, title: kMeanings[key], cells: hits.map((hit) => (key in hit ? value(hit[key]) : ""))}));
  for (const lamp of new Set(hits.flatMap((hit) => Object.keys(hit.lights ?? {})))) {
    const paths = Math.max(...hits.map((hit) => hit.lights?.[lamp]?.length ?? 0));
    for (let i = 0; i < Math.max(paths, 1); ++i)
      rows.push({name: paths > 1 ? `${lamp}, path ${i}` : lamp, title: `light of ${lamp}`,
        cells: hits.map((hit) => (hit.lights?.[lamp]?.[i] ? path(hit.lights[lamp][i]) : "none"))});
  }
  return rows;
}

function hitTable(hits) {
  const head = hits.map((hit, i) => html("th", {scope: "col"}, `${i + 1} ${hit.object}`));
  const rows = hitRows(hits).map(({name, title, cells}) =>
    html("tr", {}, html("th", {scope: "row", title}, name), ...cells.map((cell) => html("td", {}, cell))));
  return html("table", {class: "records"}, html("caption", {}, hits.length === 1 ? "crossing" : "crossings, nearest first"),
    html("thead", {}, html("tr", {}, html("td", {}), ...head)), html("tbody", {}, ...rows));
}
