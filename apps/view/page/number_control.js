// A number with a slider, a field and keys.

import {asValue, control, make} from "./control.js";
import {fromNotch, notches, nudged, numberText, toNotch, typedNumber} from "./number_scale.js";

/**
 * A slider and a field. Typing may go beyond the slider, from `least` to `most`. `onInput(value)` while it changes,
 * `onChange(value)` when that has ended.
 * @param {{label: string, unit?: string, value: number, min: number, max: number, step?: number,
 *   scale?: "linear" | "log", digits?: number, least?: number, most?: number, slider?: boolean, whole?: boolean,
 *   optional?: boolean, reset?: function(), onInput?: function(number), onChange?: function(number)}} options
 *   optional: an empty field is undefined
 */
export function numberControl(options) {
  return new NumberControl(options).element;
}

const kSteps = {ArrowUp: 1, ArrowDown: -1, PageUp: 10, PageDown: -10};

class NumberControl {
  #options;
  #value;
  #held = false; // a key is down: what it changes is one change, not many
  #pending = false; // something was told to onInput, and not yet to onChange
  #dirty = false; // what is typed was not yet taken
  #field = make("input", {
    type: "text",
    inputmode: "decimal",
    class: "number",
    autocomplete: "off",
    spellcheck: "false",
  });
  #slider;

  constructor(options) {
    const {digits = 6, least = -Infinity, most = Infinity} = options;
    this.#options = {...options, digits, least, most};
    this.#value = options.value;
    const label = `${options.label}${options.unit ? `, ${options.unit}` : ""}, slider`;
    this.#slider = make("input", {type: "range", min: 0, max: notches(options), step: 1, "aria-label": label});
    this.#slider.hidden = options.slider === false;
    this.element = control("number-control", options, this.#field, this.#slider, this.#field);
    this.#listen();
    this.#show();
    const put = (next) => {
      if (this.#pending && this.#held) return;
      this.#value = next;
      if (!this.#dirty) this.#show();
    };
    asValue(this.element, () => this.#value, put);
  }

  #listen() {
    const slider = this.#slider,
      field = this.#field;
    slider.addEventListener("input", () => this.#input(fromNotch(Number(slider.value), this.#options)));
    slider.addEventListener("change", () => this.#end());
    slider.addEventListener("keydown", (event) => (this.#held ||= /^(Arrow|Page|Home|End)/.test(event.key)));
    field.addEventListener("change", () => this.#typed());
    field.addEventListener("input", () => (this.#dirty = true));
    field.addEventListener("keydown", (event) => this.#key(event));
    for (const part of [slider, field])
      for (const name of ["keyup", "blur"]) part.addEventListener(name, () => this.#released());
  }

  #text() {
    return this.#value === undefined ? "" : numberText(this.#value, this.#options.digits);
  }

  #show() {
    const {min, unit} = this.#options;
    this.#dirty = false;
    this.#field.value = this.#text();
    this.#slider.value = toNotch(this.#value ?? min, this.#options);
    this.#slider.setAttribute("aria-valuetext", `${this.#text() || "not set"}${unit ? ` ${unit}` : ""}`);
  }

  #take(next) {
    const {whole, least, most} = this.#options;
    this.#value = Math.min(Math.max(whole ? Math.round(next) : next, least), most);
    this.element.fault("");
    this.#show();
    this.#options.onInput?.(this.#value);
  }

  #input(next) {
    this.#pending = true;
    this.#take(next);
  }

  #end() {
    if (!this.#pending || this.#held) return;
    this.#pending = false;
    this.#options.onChange?.(this.#value);
  }

  #released() {
    this.#held = false;
    this.#end();
  }

  #typed() {
    const typed = this.#field.value.trim();
    if (typed === this.#text()) return;
    const next = typedNumber(typed);
    if (typed === "" && this.#options.optional) {
      this.#value = undefined;
      this.element.fault("");
      this.#show();
    } else if (Number.isNaN(next)) {
      return this.element.fault(`“${this.#field.value}” is not a number`);
    } else {
      this.#take(next);
    }
    this.#options.onChange?.(this.#value);
  }

  #key(event) {
    if (event.key === "Enter") this.#typed();
    if (event.key === "Escape") {
      this.element.fault("");
      this.#show();
    }
    const count = kSteps[event.key];
    if (count === undefined || event.altKey || event.ctrlKey) return;
    event.preventDefault();
    this.#held = true;
    const from = Number.isFinite(this.#value) ? this.#value : 0;
    this.#input(nudged(from, count * (event.shiftKey ? 10 : 1), this.#options));
  }
}
