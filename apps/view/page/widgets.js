// Controls: each with its label, number, reset, and all that a keyboard and a screen reader need. The elements that
// the functions give have `value` (set it to show another one; that calls nobody) and `fault(text)`.

import {asValue, control, make} from "./control.js";
import {numberText} from "./number_scale.js";

export {make};
export {numberControl} from "./number_control.js";

/** @param {{label: string, value: boolean, reset?: function(), onChange: function(boolean)}} options */
export function switchControl(options) {
  const box = make("input", {type: "checkbox", role: "switch", checked: Boolean(options.value)});
  box.addEventListener("change", () => options.onChange?.(box.checked));
  const element = control("switch-control", options, box, box);
  return asValue(
    element,
    () => box.checked,
    (on) => (box.checked = Boolean(on)),
  );
}

/** @param {{label: string, value: string, options: (string | {value: string, text: string})[], reset?: function(),
 *   onChange: function(string)}} options */
export function selectControl(options) {
  const select = make("select");
  const fill = (choices) =>
    select.replaceChildren(
      ...choices.map((choice) =>
        typeof choice === "string"
          ? make("option", {value: choice}, choice.replaceAll("_", " "))
          : make("option", {value: choice.value}, choice.text),
      ),
    );
  fill(options.options);
  select.value = options.value;
  select.addEventListener("change", () => options.onChange?.(select.value));
  const element = control("select-control", options, select, select);
  element.choices = fill;
  return asValue(
    element,
    () => select.value,
    (next) => (select.value = next),
  );
}

const hex = (rgb) =>
  "#" +
  rgb
    .map((part) =>
      Math.round(Math.min(Math.max(part, 0), 1) * 255)
        .toString(16)
        .padStart(2, "0"),
    )
    .join("");
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
    const parts = /^#[0-9a-f]{6}$/i.test(field.value.trim())
      ? fromHex(field.value.trim())
      : field.value
          .split(/[,;\s]+/)
          .filter(Boolean)
          .map(Number);
    const good = parts.length === 3 && parts.every((part) => part >= 0 && part <= 1);
    if (good) take(parts, options.onInput, options.onChange);
    else element.fault("three numbers from 0 to 1, or #rrggbb");
  });
  show();
  return asValue(
    element,
    () => value,
    (next) => ((value = next), show()),
  );
}

/** A line of text. @param {{label: string, value: string, reset?: function(), onChange: function(string)}} options */
export function textControl(options) {
  const field = make("input", {type: "text", class: "text", autocomplete: "off", spellcheck: "false"});
  field.value = options.value ?? "";
  field.addEventListener("change", () => options.onChange?.(field.value));
  const element = control("text-control", options, field, field);
  return asValue(
    element,
    () => field.value,
    (next) => (field.value = next ?? ""),
  );
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
  return asValue(
    element,
    () => value,
    (next) => {
      if (document.activeElement === field && JSON.stringify(next) === JSON.stringify(value)) return;
      value = next;
      show();
    },
  );
}
