// Lamps, where the dataset has any, and light from everywhere.

import {Form} from "./form.js";
import {pointerTo} from "./look_patch.js";
import {spectrumFields} from "./spectrum_fields.js";
import {make, selectControl} from "./widgets.js";

const kTypes = [
  "display",
  "black_body",
  "tabulated",
  "lines",
  "constant",
  "equal_energy",
  "power_law",
  "gaussian",
  "dominant_wavelength",
  "sum",
  "lit",
];
const kIntensity = {
  kind: "number",
  label: "Intensity",
  scale: "log",
  min: 1e-3,
  max: 1e4,
  least: 0,
  most: 1e12,
  fallback: 1,
};

export function setup(app) {
  const {element, body} = app.panel("lights", "Lamps and ambient light", {open: true});
  let name = app.dataset.lights[0] ?? null;
  const choice = selectControl({
    label: "Lamp",
    options: app.dataset.lights,
    value: name,
    onChange: (next) => ((name = next), lamps.update()),
  });
  const fields = make("div"),
    around = make("div");
  body.append(choice, fields, around);
  const lamps = new Form(app, fields, () => (name === null ? [] : lampFields(app, name)));
  new Form(app, around, () => (element.hidden ? [] : ambientFields(app)));
  const show = () => {
    const {lights} = app.dataset;
    if (!lights.includes(name)) name = lights[0] ?? null;
    choice.choices(lights);
    choice.value = name;
    choice.hidden = lights.length < 2;
    element.hidden = lights.length === 0;
    lamps.update();
  };
  app.addEventListener("dataset", show);
  show();
}

/** @returns {import("./form.js").Field[]} */
function lampFields(app, name) {
  const pointer = pointerTo("lights", name);
  const more = ["blink", "time_slices"].filter((key) => app.store.get(`${pointer}/${key}`) !== undefined);
  return [
    {kind: "group", label: name},
    {kind: "switch", pointer: `${pointer}/on`, label: "On", fallback: true},
    {...kIntensity, pointer: `${pointer}/intensity`},
    ...spectrumFields(app, `${pointer}/spectrum`, {types: kTypes}),
    {
      kind: "json",
      pointer: `${pointer}/paths`,
      label: "Paths",
      title: "numbers of the paths of its light that count, from 0; empty: all",
    },
    ...more.map((key) => ({kind: "json", pointer: `${pointer}/${key}`, label: key.replace("_", " ")})),
  ];
}

/** @returns {import("./form.js").Field[]} */
function ambientFields(app) {
  const {store} = app;
  const on = store.get("/ambient") !== undefined;
  const put = (next) => store.set("/ambient", next ? {intensity: 0.1} : undefined);
  return [
    {kind: "group", label: "Ambient"},
    {kind: "switch", pointer: "/ambient", label: "Ambient light", value: on, put},
    ...(on
      ? [{...kIntensity, pointer: "/ambient/intensity"}, ...spectrumFields(app, "/ambient/spectrum", {types: kTypes})]
      : []),
  ];
}
