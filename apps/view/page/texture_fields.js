// Controls of an object's texture.

import {find} from "./look_patch.js";
import {putTexture} from "./textures.js";
import {make} from "./widgets.js";

const kTypes = ["color", "checkerboard", "image", "materials"];
const kAngles = {
  kind: "vector",
  label: "Rotation",
  labels: ["Rotate x", "Rotate y", "Rotate z"],
  unit: "°",
  min: -180,
  max: 180,
  step: 0.5,
  least: -1e9,
  most: 1e9,
  fallback: [0, 0, 0],
};

/** What a type begins with. */
const kBegin = {
  color: {rgb: [0.8, 0.8, 0.8]},
  checkerboard: {
    counts: [24, 12],
    colors: [
      [0.95, 0.95, 0.92],
      [0.12, 0.25, 0.5],
    ],
  },
};
const kGradient = {along: "u", from: [1, 0.9, 0], to: [0.1, 0.2, 1], dark: 0.3};

/** @param {object} app @param {string} pointer of the object @returns {import("./form.js").Field[]} */
export function textureFields(app, pointer) {
  const {store} = app;
  const texture = `${pointer}/texture`;
  const type = store.get(`${texture}/type`) ?? "none";
  const put = (next) => choose(app, pointer, texture, next);
  const types = store.words[`${texture}/type`] ?? kTypes;
  const select = {
    kind: "select",
    pointer: `${texture}/type`,
    label: "Texture",
    value: type,
    put,
    reset: () => store.reset(texture),
    options: [
      {value: "none", text: "none (flat colour)"},
      ...types.map((value) => ({value, text: value.replaceAll("_", " ")})),
    ],
  };
  return [select, ...(kFields[type]?.(app, pointer, texture) ?? []), fileField(app, pointer, texture, type)];
}

/** Without a file there is no image yet: the file's dialog is opened instead. */
function choose(app, pointer, texture, type) {
  const {store} = app;
  if (type === "none") return putTexture(app, pointer, undefined);
  if (type in kBegin) return putTexture(app, pointer, {type, ...structuredClone(kBegin[type])});
  const file = store.get(`${texture}/file`) ?? find(store.base, `${texture}/file`);
  if (file !== undefined) return putTexture(app, pointer, {type, file});
  app.textures.pick(pointer, type);
  store.dispatchEvent(new CustomEvent("full", {detail: {}})); // the select goes back until there is one
}

const placement = (texture, whole) => [
  {
    kind: "vector",
    pointer: `${texture}/offset`,
    label: "Offset",
    labels: ["Offset u", "Offset v"],
    min: -1,
    max: 1,
    step: 0.005,
    least: -1e4,
    most: 1e4,
    fallback: [0, 0],
  },
  {
    kind: "vector",
    pointer: `${texture}/scale`,
    label: "Scale",
    labels: ["Scale u", "Scale v"],
    min: -4,
    max: 4,
    step: 0.02,
    least: -1e4,
    most: 1e4,
    fallback: [1, 1],
  },
  whole && {...kAngles, pointer: `${texture}/rotate_deg`},
];

const filter = (texture) => ({
  kind: "select",
  pointer: `${texture}/filter`,
  label: "Filter",
  options: ["mipmap", "anisotropic", "bilinear"],
  fallback: "mipmap",
});

/** @type {Object<string, function(object, string, string): import("./form.js").Field[]>} */
const kFields = {
  color: (app, pointer, texture) => [
    {kind: "color", pointer: `${texture}/rgb`, label: "Colour", begin: kBegin.color.rgb},
  ],
  checkerboard: (app, pointer, texture) => [...board(app, texture), ...placement(texture, isRound(app, pointer))],
  image: (app, pointer, texture) => [
    filter(texture),
    {kind: "switch", pointer: `${texture}/alpha`, label: "Use alpha", fallback: false},
    ...placement(texture, isRound(app, pointer)),
    app.store.get(`${texture}/sequence`) && {kind: "json", pointer: `${texture}/sequence`, label: "Sequence"},
  ],
  materials: (app, pointer, texture) => [filter(texture), ...placement(texture, isRound(app, pointer))],
};

/** Whether rotations make sense. */
function isRound(app, pointer) {
  const name = pointer.split("/").at(-1);
  return (
    app.dataset.objects.find((object) => object.name === name)?.shape === "sphere" ||
    app.store.get(`${pointer}/texture/rotate_deg`) !== undefined
  );
}

function board({store}, texture) {
  const graded = store.get(`${texture}/gradient`) !== undefined;
  const squares = {whole: true, scale: "log", min: 1, max: 1000, least: 1, most: 100000};
  const pattern = (next) => {
    const {colors, gradient, ...rest} = store.get(texture);
    const other = next === "gradient" ? {gradient: kGradient} : {colors: kBegin.checkerboard.colors};
    store.set(texture, {...rest, ...structuredClone(other)});
  };
  return [
    {
      kind: "vector",
      pointer: `${texture}/counts`,
      label: "Squares",
      labels: ["Squares u", "Squares v"],
      begin: kBegin.checkerboard.counts,
      ...squares,
    },
    {
      kind: "select",
      label: "Colours",
      value: graded ? "gradient" : "two colours",
      options: ["two colours", "gradient"],
      put: pattern,
      reset: false,
    },
    ...(graded ? gradient(`${texture}/gradient`) : twoColors(store, `${texture}/colors`)),
  ];
}

function twoColors(store, pointer) {
  return [0, 1].map((at) => ({
    kind: "color",
    pointer: `${pointer}/${at}`,
    label: at === 0 ? "First" : "Second",
    begin: kBegin.checkerboard.colors[at],
    // A list as a whole: the look may not have one of its own yet.
    put: (rgb, live) =>
      store.set(
        pointer,
        store.get(pointer).map((color, i) => (i === at ? rgb : color)),
        {live},
      ),
  }));
}

const gradient = (pointer) => [
  {kind: "select", pointer: `${pointer}/along`, label: "Along", options: ["u", "v"], begin: "u"},
  {kind: "color", pointer: `${pointer}/from`, label: "From", begin: kGradient.from},
  {kind: "color", pointer: `${pointer}/to`, label: "To", begin: kGradient.to},
  {
    kind: "number",
    pointer: `${pointer}/dark`,
    label: "Dark squares",
    min: 0,
    max: 1,
    step: 0.01,
    least: 0,
    most: 1,
    fallback: 0.25,
  },
];

/** The file, and where another one is dropped. */
function fileField(app, pointer, texture, type) {
  const file = app.store.get(`${texture}/file`);
  const build = () => {
    const kind = type === "materials" ? "materials" : "image";
    const name = make("span", {class: "file", title: file ?? ""}, file?.split("/").at(-1) ?? "Drop a picture here");
    const button = make("button", {type: "button", click: () => app.textures.pick(pointer, kind)}, "Choose file…");
    const zone = make("div", {class: "drop-zone", role: "group", "aria-label": "Texture file"}, name, button);
    zone.dataset.pointer = `${texture}/file`;
    return zone;
  };
  return {kind: "node", key: `${pointer} ${type} ${file}`, make: build};
}
