// The panel "False colours": a channel of the dataset over the picture, with its legend.

import {html, text} from "./plot.js";

export function setup(app) {
  new FalseColours(app);
}

class FalseColours {
  #app;
  #layer;
  #asked = 0;
  #on = html("input", {type: "checkbox"});
  #channel = html("select", {"aria-label": "channel"});
  #meaning = html("p", {class: "extras-note"});
  #from = html("input", {type: "number", step: "any", placeholder: "auto"});
  #to = html("input", {type: "number", step: "any", placeholder: "auto"});
  #opacity = html("input", {type: "range", min: 0, max: 1, step: 0.05, value: 1, "aria-label": "opacity of the false colours"});
  #legend = html("div", {class: "legend", role: "group", "aria-label": "legend"});

  constructor(app) {
    this.#app = app;
    this.#layer = app.picture.layer("channel");
    const {body} = app.panel("channels", "False colours", {open: false});
    this.#fill();
    const field = (label, input) => html("label", {class: "extras-field"}, html("span", {}, label), input);
    body.append(
      html("div", {class: "extras-row"}, html("label", {}, this.#on, " show"), this.#channel), this.#meaning,
      html("div", {class: "extras-fields"}, field("from", this.#from), field("to", this.#to)),
      html("label", {class: "extras-row"}, html("span", {}, "opacity"), this.#opacity), this.#legend);
    this.#on.addEventListener("change", () => this.#load());
    this.#channel.addEventListener("change", () => {
      this.#from.value = this.#to.value = "";
      this.#on.checked = true;
      this.#load();
    });
    for (const input of [this.#from, this.#to]) input.addEventListener("change", () => this.#load());
    this.#opacity.addEventListener("input", () => (this.#layer.style.opacity = this.#opacity.value));
    app.addEventListener("dataset", () => this.#fill());
    for (const name of ["view", "traced"]) app.addEventListener(name, () => this.#load());
    this.#describe();
  }

  #fill() {
    const names = (this.#app.dataset.channels ?? []).map(({name}) => name), before = this.#channel.value || "shift";
    this.#channel.replaceChildren(...names.map((name) => html("option", {value: name}, name)));
    this.#channel.value = names.includes(before) ? before : names[0] ?? "";
  }

  #describe() {
    const {unit, meaning} = this.#app.dataset.channels?.find(({name}) => name === this.#channel.value) ?? {};
    this.#meaning.textContent = meaning ? `${meaning}${unit && unit !== "1" ? `, in ${unit}` : ""}` : "";
  }

  async #load() {
    this.#describe();
    const asked = ++this.#asked;
    if (!this.#on.checked) {
      this.#layer.hide();
      this.#legend.replaceChildren();
      return;
    }
    // Both ends or none.
    const [from, to] = [this.#from.value, this.#to.value];
    const range = from !== "" && to !== "" ? {from, to} : {};
    try {
      const query = {data: this.#app.view.data, format: "raw", name: this.#channel.value, ...range};
      const frame = await this.#app.api.frame(query, undefined, "api/channel");
      if (asked !== this.#asked) return;
      // What was traced coarsely takes the place of the picture.
      frame.scale = Math.max(1, Math.round(this.#app.picture.width / frame.width));
      this.#layer.show(frame);
      this.#draw(JSON.parse(frame.headers.get("X-Nullcone-Legend")));
    } catch (error) {
      if (asked !== this.#asked) return;
      this.#layer.hide();
      this.#legend.replaceChildren(html("p", {class: "extras-note"}, error.message));
    }
  }

  #draw(legend) {
    this.#legend.setAttribute("aria-label", `Legend of ${legend.name}`);
    this.#legend.replaceChildren(...(legend.kind === "categories" ? categories(legend) : [bar(legend), ticks(legend), ends(legend)]), others(legend));
    if (legend.kind === "categories") return;
    this.#from.placeholder = text(legend.from);
    this.#to.placeholder = text(legend.to);
  }
}

const swatch = (color, label) => {
  const square = html("span", {class: "legend-swatch", "aria-hidden": "true"});
  square.style.background = color;
  return html("li", {}, square, ` ${label}`);
};

const categories = ({categories: list}) => [html("ul", {class: "legend-list"}, ...list.map(({text: words, color}) => swatch(color, words)))];

function bar({colors}) {
  const out = html("div", {class: "legend-bar", "aria-hidden": "true"});
  out.style.background = `linear-gradient(to right, ${colors.join(", ")})`;
  return out;
}

function ticks({ticks: list}) {
  const out = html("div", {class: "legend-ticks", "aria-hidden": "true"});
  for (const {text: words, place} of list) {
    const tick = html("span", {}, words);
    tick.style.left = `${100 * place}%`;
    if (place < 0.08) tick.classList.add("legend-first");
    if (place > 0.92) tick.classList.add("legend-last");
    out.append(tick);
  }
  return out;
}

function ends({from, to, unit, kind}) {
  const scale = kind === "linear" ? "linear" : "logarithmic";
  return html("p", {class: "extras-note"}, `${text(from)} to ${text(to)}${unit && unit !== "1" ? ` ${unit}` : ""}, ${scale}`);
}

function others({missing, infinite}) {
  const items = [];
  if (missing) items.push(swatch(missing, "nothing there"));
  if (infinite) items.push(swatch(infinite, "not finite"));
  return html("ul", {class: "legend-list"}, ...items);
}
