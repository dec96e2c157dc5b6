// One object's controls; the object is chosen in a list or by a click in the picture.

import {Form} from "./form.js";
import {pointerTo} from "./look_patch.js";
import {spectrumFields} from "./spectrum_fields.js";
import {textureFields} from "./texture_fields.js";
import {objectAt} from "./textures.js";
import {make, selectControl} from "./widgets.js";

const kIntensity = {
  kind: "number",
  label: "Intensity",
  scale: "log",
  min: 1e-3,
  max: 1e3,
  least: 0,
  most: 1e12,
  fallback: 1,
};
const kOpacity = {kind: "number", label: "Opacity", min: 0, max: 1, step: 0.01, least: 0, most: 1, fallback: 1};

export function setup(app) {
  const {body} = app.panel("objects", "Object", {open: true});
  const names = () => app.dataset.objects.map(({name, shape}) => ({value: name, text: `${name} (${shape})`}));
  const choice = selectControl({
    label: "Object",
    options: names(),
    value: app.selected,
    onChange: (name) => app.select(name),
  });
  const fields = make("div");
  body.append(choice, fields);
  const form = new Form(app, fields, () => (app.selected === null ? [] : objectFields(app, app.selected)));
  app.addEventListener("select", () => {
    choice.value = app.selected;
    form.update();
  });
  app.addEventListener("dataset", () => {
    choice.choices(names());
    choice.value = app.selected;
    form.update();
  });
  app.picture.addEventListener("pick", async ({detail}) => {
    const name = await objectAt(app, detail).catch(() => null);
    if (name !== null) app.select(name);
  });
}

/** @returns {import("./form.js").Field[]} */
function objectFields(app, name) {
  const pointer = pointerTo("objects", name);
  const surface = {
    kind: "select",
    pointer: `${pointer}/surface/type`,
    label: "Surface",
    options: ["self_luminous", "lambertian"],
    fallback: "self_luminous",
    put: (type) => app.store.set(`${pointer}/surface`, {type}),
    reset: () => app.store.reset(`${pointer}/surface`),
  };
  const lit = app.dataset.lights.length > 0 || app.store.get(`${pointer}/surface/type`) === "lambertian";
  return [
    ...textureFields(app, pointer),
    {kind: "group", label: "Light"},
    lit && surface,
    ...spectrumFields(app, `${pointer}/spectrum`, {
      materials: app.store.get(`${pointer}/texture/type`) === "materials",
    }),
    {...kIntensity, pointer: `${pointer}/intensity`},
    {...kOpacity, pointer: `${pointer}/opacity`},
    app.store.get(`${pointer}/blink`) && {kind: "json", pointer: `${pointer}/blink`, label: "Blink"},
  ];
}
