// Controls: each with its label, number, reset, and all that a keyboard and a screen reader need. The elements that
// the functions give have `value` (set it to show another one; that calls nobody) and `fault(text)`.

import {fromNotch, notches, nudged, numberText, toNotch, typedNumber} from "./number_scale.js";

let count = 0;

/** An element with attributes (functions: listeners) and children. */
export function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") element.addEventListener(name, value);
    else if (name in element && typeof value !== "string") element[name] = value;
    else element.setAttribute(name, value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

/** The frame that all controls have. `parts` follow the label; `main` is what the label is of. */
function control(kind, {label, unit, title, reset, pointer}, main, ...parts) {
  const id = (main.id ||= `control-${++count}`);
  const name = make("label", {for: id, class: "name"}, label);
  if (unit) name.append(" ", make("span", {class: "unit"}, unit));
  if (title) name.title = title;
  const fault = make("p", {class: "fault", id: `${id}-fault`, role: "alert", hidden: true});
  const undo = make("button", {type: "button", class: "reset", "aria-label": `Reset ${label}`, title: "Reset", click: () => reset?.()}, "↺");
  undo.hidden = !reset;
  const element = make("div", {class: `control ${kind}`}, name, ...parts, undo, fault);
  if (pointer) element.dataset.pointer = pointer;
  /** @param {string} text what is wrong; "" for nothing */
  element.fault = (text) => {
    fault.textContent = text;
    fault.hidden = text === "";
    main.toggleAttribute("aria-invalid", text !== "");
    if (text === "") main.removeAttribute("aria-describedby");
    else main.setAttribute("aria-describedby", fault.id);
  };
  element.focus = () => main.focus();
  /** Whether reset would change anything. */
  element.changed = (on) => undo.classList.toggle("idle", !on);
  return element;
}

const asValue = (element, get, set) => Object.defineProperty(element, "value", {get, set});

/**
 * A slider and a field. Typing may go beyond the slider, from `least` to `most`. `onInput(value)` while it changes,
 * `onChange(value)` when that has ended.
 * @param {{label: string, unit?: string, value: number, min: number, max: number, step?: number,
 *   scale?: "linear" | "log", digits?: number, least?: number, most?: number, slider?: boolean, whole?: boolean,
 *   optional?: boolean, reset?: function(), onInput?: function(number), onChange?: function(number)}} options
 *   optional: an empty field is undefined
 */
export function numberControl(options) {
  const {label, unit, digits = 6, least = -Infinity, most = Infinity, slider: slides = true} = options;
  let value = options.value, held = false, pending = false, dirty = false;
  const field = make("input", {type: "text", inputmode: "decimal", class: "number", autocomplete: "off", spellcheck: "false"});
  const slider = make("input", {type: "range", min: 0, max: notches(options), step: 1, "aria-label": `${label}${unit ? `, ${unit}` : ""}, slider`, tabindex: "0"});
  slider.hidden = !slides;
  const element = control("number-control", options, field, slider, field);
  const text = () => (value === undefined ? "" : numberText(value, digits));
  const show = () => {
    dirty = false;
    field.value = text();
    slider.value = toNotch(value ?? options.min, options);
    slider.setAttribute("aria-valuetext", `${text() || "not set"}${unit ? ` ${unit}` : ""}`);
  };
  const take = (next, report) => {
    const whole = options.whole ? Math.round(next) : next;
    value = Math.min(Math.max(whole, least), most);
    element.fault("");
    show();
    report?.(value);
  };
  const end = () => {
    if (pending && !held) options.onChange?.(value);
    pending &&= held;
  };
  const input = (next) => {
    pending = true;
    take(next, options.onInput);
  };
  slider.addEventListener("input", () => input(fromNotch(Number(slider.value), options)));
  slider.addEventListener("change", end);
  const typed = () => {
    const next = typedNumber(field.value), empty = field.value.trim() === "";
    if (text() === field.value.trim()) return;
    if (empty && options.optional) return (value = undefined), show(), options.onChange?.(value);
    if (Number.isNaN(next)) return element.fault(`“${field.value}” is not a number`);
    take(next, options.onInput);
    options.onChange?.(value);
  };
  field.addEventListener("change", typed);
  field.addEventListener("input", () => (dirty = true));
  field.addEventListener("keydown", (event) => {
    const up = {ArrowUp: 1, ArrowDown: -1, PageUp: 10, PageDown: -10}[event.key];
    if (event.key === "Enter") typed();
    if (event.key === "Escape") element.fault(""), show();
    if (up === undefined || event.altKey || event.ctrlKey) return;
    event.preventDefault();
    held = true;
    input(nudged(Number.isFinite(value) ? value : 0, up * (event.shiftKey ? 10 : 1), options));
  });
  // A key that is held is one change, not many.
  slider.addEventListener("keydown", (event) => (held ||= /^(Arrow|Page|Home|End)/.test(event.key)));
  for (const [part, name] of [[slider, "keyup"], [slider, "blur"], [field, "keyup"], [field, "blur"]])
    part.addEventListener(name, () => ((held = false), end()));
  show();
  return asValue(element, () => value, (next) => {
    if (pending && held) return;
    value = next;
    if (!dirty) show();
  });
}

/** @param {{label: string, value: boolean, reset?: function(), onChange: function(boolean)}} options */
export function switchControl(options) {
  const box = make("input", {type: "checkbox", role: "switch", checked: Boolean(options.value)});
  box.addEventListener("change", () => options.onChange?.(box.checked));
  const element = control("switch-control", options, box, box);
  return asValue(element, () => box.checked, (on) => (box.checked = Boolean(on)));
}

/** @param {{label: string, value: string, options: (string | {value: string, text: string})[], reset?: function(),
 *   onChange: function(string)}} options */
export function selectControl(options) {
  const select = make("select");
  const fill = (choices) => select.replaceChildren(...choices.map((choice) =>
    typeof choice === "string" ? make("option", {value: choice}, choice.replaceAll("_", " ")) : make("option", {value: choice.value}, choice.text)));
  fill(options.options);
  select.value = options.value;
  select.addEventListener("change", () => options.onChange?.(select.value));
  const element = control("select-control", options, select, select);
  element.choices = fill;
  return asValue(element, () => select.value, (next) => (select.value = next));
}

const hex = (rgb) => "#" + rgb.map((part) => Math.round(Math.min(Math.max(part, 0), 1) * 255).toString(16).padStart(2, "0")).join("");
const fromHex = (text) => [1, 3, 5].map((at) => Number((parseInt(text.slice(at, at + 2), 16) / 255).toFixed(4)));

/** sRGB from 0 to 1. @param {{label: string, value: number[], reset?: function(), onInput?: function(number[]),
 *   onChange: function(number[])}} options */
export function colorControl(options) {
  let value = options.value;
  const well = make("input", {type: "color", "aria-label": `${options.label}, colour`});
  const field = make("input", {type: "text", class: "numbers", autocomplete: "off", spellcheck: "false"});
  const element = control("color-control", options, field, well, field);
  const show = () => {
    well.value = hex(value);
    field.value = value.map((part) => numberText(part, 4)).join(", ");
  };
  const take = (next, ...reports) => {
    value = next;
    element.fault("");
    show();
    for (const report of reports) report?.(value);
  };
  well.addEventListener("input", () => take(fromHex(well.value), options.onInput));
  well.addEventListener("change", () => take(fromHex(well.value), options.onInput, options.onChange));
  field.addEventListener("change", () => {
    const parts = /^#[0-9a-f]{6}$/i.test(field.value.trim()) ? fromHex(field.value.trim()) : field.value.split(/[,;\s]+/).filter(Boolean).map(Number);
    const good = parts.length === 3 && parts.every((part) => part >= 0 && part <= 1);
    if (good) take(parts, options.onInput, options.onChange);
    else element.fault("three numbers from 0 to 1, or #rrggbb");
  });
  show();
  return asValue(element, () => value, (next) => ((value = next), show()));
}

/** A line of text. @param {{label: string, value: string, reset?: function(), onChange: function(string)}} options */
export function textControl(options) {
  const field = make("input", {type: "text", class: "text", autocomplete: "off", spellcheck: "false"});
  field.value = options.value ?? "";
  field.addEventListener("change", () => options.onChange?.(field.value));
  const element = control("text-control", options, field, field);
  return asValue(element, () => field.value, (next) => (field.value = next ?? ""));
}

/** Anything, as JSON. @param {{label: string, value: *, reset?: function(), onChange: function(*)}} options */
export function jsonControl(options) {
  const field = make("textarea", {rows: 3, class: "json", autocomplete: "off", spellcheck: "false"});
  const element = control("json-control", options, field, field);
  let value = options.value;
  const show = () => (field.value = value === undefined ? "" : JSON.stringify(value));
  field.addEventListener("change", () => {
    try {
      value = field.value.trim() === "" ? undefined : JSON.parse(field.value);
      element.fault("");
      options.onChange?.(value);
    } catch (error) {
      element.fault(error.message);
    }
  });
  show();
  return asValue(element, () => value, (next) => {
    if (document.activeElement === field && JSON.stringify(next) === JSON.stringify(value)) return;
    value = next;
    show();
  });
}
