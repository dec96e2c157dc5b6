// The fields of one time slice: its numbers, and what it changes.

import {html} from "./plot.js";
import {fades, fromHex, toHex, withFades, words} from "./slices.js";

/** A labelled number; an empty one calls back with undefined. */
function number(label, attributes, onChange) {
  const input = html("input", {type: "number", step: "any", ...attributes});
  input.addEventListener("change", () => {
    if (input.value === "" || Number.isFinite(input.valueAsNumber))
      onChange(input.value === "" ? undefined : input.valueAsNumber);
  });
  return {input, element: html("label", {class: "extras-field"}, html("span", {}, label), input)};
}

/** A switch, and beside it what it switches. */
function option(label, control, onChange) {
  const box = html("input", {type: "checkbox", onchange: () => onChange(box.checked)});
  return {box, element: html("div", {class: "extras-row"}, html("label", {}, box, ` ${label}`), control)};
}

const without = (slice, key) => Object.fromEntries(Object.entries(slice).filter(([name]) => name !== key));

/** `owner` has put(i, slice, live) and remove(i). The element has show(slice). */
export function sliceFields(first, i, owner) {
  let slice = first;
  const put = (changed, live = false) => owner.put(i, changed, live);
  const set = (key, value) => put(value === undefined ? without(slice, key) : {...slice, [key]: value});

  const from = number("from", {placeholder: "open"}, (x) => set("from", x));
  const to = number("to", {placeholder: "open"}, (x) => set("to", x));
  const coming = number("fade in", {min: 0}, (x) => put(withFades(slice, [x ?? 0, fades(slice)[1]])));
  const going = number("fade out", {min: 0}, (x) => put(withFades(slice, [fades(slice)[0], x ?? 0])));

  const colour = html("input", {type: "color", "aria-label": `colour of slice ${i + 1}`});
  colour.addEventListener("input", () => put({...slice, texture: {type: "color", rgb: fromHex(colour.value)}}, true));
  colour.addEventListener("change", () => put({...slice, texture: {type: "color", rgb: fromHex(colour.value)}}));
  const kelvin = html("input", {type: "number", min: 1, max: 1e9, step: "any", "aria-label": `temperature of slice ${i + 1} in kelvin`});
  kelvin.addEventListener("change", () => {
    if (kelvin.valueAsNumber > 0) set("spectrum", {type: "black_body", temperature_K: kelvin.valueAsNumber});
  });
  const intensity = html("input", {type: "number", min: 0, step: "any", "aria-label": `intensity of slice ${i + 1}`});
  intensity.addEventListener("change", () => {
    if (intensity.valueAsNumber >= 0) set("intensity", intensity.valueAsNumber);
  });

  const options = {
    texture: option("colour", colour, (on) => set("texture", on ? {type: "color", rgb: [1, 0.2, 0.2]} : undefined)),
    spectrum: option("temperature in K", kelvin, (on) => set("spectrum", on ? {type: "black_body", temperature_K: 6500} : undefined)),
    intensity: option("intensity (0: dark)", intensity, (on) => set("intensity", on ? 0 : undefined)),
  };
  const also = html("p", {class: "extras-note"});
  const legend = html("legend", {});
  const element = html("fieldset", {class: "slice"}, legend,
    html("div", {class: "extras-fields"}, from.element, to.element, coming.element, going.element),
    ...Object.values(options).map((each) => each.element), also,
    html("button", {type: "button", onclick: () => owner.remove(i)}, `Remove slice ${i + 1}`));

  element.show = (now) => {
    slice = now;
    legend.textContent = `${i + 1}: ${words(now)} (by ${now.channel})`;
    const write = (input, value) => document.activeElement !== input && (input.value = value);
    write(from.input, now.from ?? "");
    write(to.input, now.to ?? "");
    write(coming.input, fades(now)[0]);
    write(going.input, fades(now)[1]);
    for (const [key, {box}] of Object.entries(options)) box.checked = now[key] !== undefined;
    const plain = {texture: now.texture?.type === "color", spectrum: now.spectrum?.type === "black_body", intensity: typeof now.intensity === "number"};
    colour.disabled = !plain.texture;
    kelvin.disabled = !plain.spectrum;
    intensity.disabled = !plain.intensity;
    if (plain.texture && Array.isArray(now.texture.rgb)) write(colour, toHex(now.texture.rgb));
    write(kelvin, plain.spectrum ? now.spectrum.temperature_K : "");
    write(intensity, plain.intensity ? now.intensity : "");
    const kept = ["texture", "spectrum", "intensity"].filter((key) => now[key] !== undefined && !plain[key]);
    if (now.blink) kept.push("blink");
    also.textContent = kept.length > 0 ? `Kept as the look has it: ${kept.join(", ")}.` : "";
  };
  element.show(first);
  return element;
}
