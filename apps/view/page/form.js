// A list of controls of the look, made from descriptions and kept up to date. Controls stay as they are while their
// descriptions do, so that a slider that is held is not replaced under the hand.

import {colorControl, jsonControl, make, numberControl, selectControl, switchControl, textControl} from "./widgets.js";
import {find, same} from "./look_patch.js";

/**
 * @typedef {object} Field
 * @property {string} [pointer] of the entry in the look
 * @property {"number"|"switch"|"select"|"color"|"text"|"json"|"vector"|"group"|"node"} kind
 * @property {string} label
 * @property {*} [fallback] what holds where neither the look nor its defaults say
 * @property {function(*)} [put] in place of storing the value at `pointer`: for what changes more than that
 * @property {*} [begin] what reset makes of it where the look to begin with says nothing
 * @property {*} [value] in place of what is stored at `pointer`
 * Others are options of the widgets. "vector": numbers with one control each, labelled `labels`. "group": a heading.
 * "node": `make()` gives an element, which is made anew when `key` changes.
 */

const kWidgets = {
  number: numberControl,
  switch: switchControl,
  select: selectControl,
  color: colorControl,
  text: textControl,
  json: jsonControl,
};

const isColor = (value) => Array.isArray(value) && value.length === 3 && value.every(Number.isFinite);
const kPlain = {
  number: (value, field) => Number.isFinite(value) || (value === undefined && field.optional),
  switch: (value) => typeof value === "boolean",
  select: (value) => typeof value === "string",
  color: isColor,
  text: (value) => typeof value === "string",
  vector: (value) => Array.isArray(value) && value.every(Number.isFinite),
};

export class Form {
  #app;
  #body;
  #describe;
  #panel; // around it
  #stale = false;
  #planned = 0;
  #shown = []; // {field, elements}

  /** @param {object} app @param {HTMLElement} body @param {function(): Field[]} describe the fields for the look as it is */
  constructor(app, body, describe) {
    this.#app = app;
    this.#body = body;
    this.#describe = describe;
    this.#panel = body.closest("details");
    this.#panel?.addEventListener("toggle", () => this.#stale && this.update());
    app.store.addEventListener("change", ({detail}) => (detail.live ? this.#soon() : this.update()));
    app.store.addEventListener("full", () => this.update());
    app.store.addEventListener("base", () => this.update());
    this.update();
  }

  /** While something is dragged frames come first. */
  #soon() {
    this.#planned ||= requestAnimationFrame(() => this.update());
  }

  update() {
    cancelAnimationFrame(this.#planned);
    this.#planned = 0;
    if (Object.keys(this.#app.store.full).length === 0) return;
    this.#stale = this.#panel !== null && !this.#panel.open;
    if (this.#stale) return;
    const fields = this.#describe()
      .filter(Boolean)
      .map((field) => this.#asStored(field));
    const alike =
      fields.length === this.#shown.length && fields.every((field, at) => unchanged(field, this.#shown[at].field));
    if (!alike) this.#rebuild(fields);
    fields.forEach((field, at) => this.#refresh(this.#shown[at], field));
  }

  /** With its value; values that are not plain (keyframes) are shown as JSON. */
  #asStored(field) {
    if (field.kind === "group" || field.kind === "node") return field;
    const value = "value" in field ? field.value : (this.#app.store.get(field.pointer) ?? field.fallback);
    const plain = kPlain[field.kind];
    return plain && !plain(value, field) ? {...field, kind: "json", value, put: undefined} : {...field, value};
  }

  #rebuild(fields) {
    const held = document.activeElement?.closest?.("[data-key]");
    const key = this.#body.contains(held) ? held.dataset.key : null;
    const part = key === null ? -1 : focusable(held).indexOf(document.activeElement);
    const before = this.#shown;
    this.#shown = fields.map((field) => {
      const kept = before.find((one) => unchanged(field, one.field));
      return {field, elements: kept?.elements ?? this.#make(field)};
    });
    let group = make("div");
    this.#body.replaceChildren(group);
    for (const {field, elements} of this.#shown) {
      if (field.kind === "group") {
        [group] = elements;
        group.replaceChildren(group.firstChild); // its legend
        this.#body.append(group);
      } else group.append(...elements);
    }
    if (key === null || this.#body.contains(document.activeElement)) return;
    const again = this.#body.querySelector(`[data-key="${CSS.escape(key)}"]`);
    if (again) (focusable(again)[part] ?? focusable(again)[0])?.focus();
  }

  #make(field) {
    if (field.kind === "group") return [make("fieldset", {}, make("legend", {}, field.label))];
    if (field.kind === "node") return [field.make()];
    if (field.kind === "vector") return field.labels.map((label, at) => this.#component(field, label, at));
    return [this.#control(field, kWidgets[field.kind], field, field.value, (value) => value, field.pointer)];
  }

  #component(field, label, at) {
    const whole = (value) => {
      const list = [...(this.#app.store.get(field.pointer) ?? field.fallback)];
      list[at] = value;
      return list;
    };
    return this.#control(field, numberControl, {...field, label}, field.value[at], whole, `${field.pointer}/${at}`);
  }

  #control(field, widget, options, value, whole, pointer) {
    const {store} = this.#app;
    const put = field.put ?? ((next, live) => store.set(field.pointer, next, {live}));
    const element = widget({
      ...options,
      value,
      pointer,
      reset: field.reset === false ? undefined : (field.reset ?? (() => store.set(field.pointer, this.#origin(field)))),
      onInput: (next) => put(whole(next), true),
      onChange: (next) => put(whole(next), false),
    });
    element.dataset.key = pointer ?? field.label;
    return element;
  }

  #origin({pointer, begin}) {
    return find(this.#app.store.base, pointer) ?? begin;
  }

  #refresh({elements, field: made}, field) {
    if (field.kind === "group" || field.kind === "node") return;
    made.value = field.value;
    elements.forEach((element, at) => {
      element.value = field.kind === "vector" ? field.value[at] : field.value;
      if (field.pointer) element.changed(!same(find(this.#app.store.look, field.pointer), this.#origin(field)));
    });
  }
}

const focusable = (element) => [...element.querySelectorAll("input, select, textarea, button")];

const kIgnored = new Set(["value", "put", "make", "reset", "fallback", "begin"]);

/** But for the value. */
function unchanged(a, b) {
  const rest = (field) =>
    Object.fromEntries(Object.entries(field).filter(([name, value]) => !kIgnored.has(name) && value !== undefined));
  return same(rest(a), rest(b)) && (a.kind !== "vector" || a.value.length === b.value.length);
}

/** A panel with a form in it. @param {function(): Field[]} describe */
export function formPanel(app, id, title, describe, options) {
  const panel = app.panel(id, title, options);
  const form = new Form(app, panel.body, describe);
  return {...panel, form};
}
