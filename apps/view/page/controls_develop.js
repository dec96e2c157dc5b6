// How light becomes a picture: exposure, tone curve, colours, pixels.

import {formPanel} from "./form.js";
import {make} from "./widgets.js";

export function setup(app) {
  formPanel(app, "exposure", "Exposure and tone", () => [...exposure(app), ...tone(app)], {open: true});
  formPanel(app, "colour", "Colour and pixels", () => [...colour(app), ...pixels()]);
  app.frames.addEventListener("shown", ({detail: {frame}}) => showWhite(frame.white));
}

// --- Exposure ---

let white = null,
  note = null; // of the last frame

/** What `auto` came to; 1 where nothing has a physical unit. */
function showWhite(next) {
  white = next === 1 ? null : next;
  if (note) note.textContent = white === null ? "" : `White of this picture: ${white.toPrecision(4)} cd/m²`;
}

const kWhites = {
  percentile: () => ({auto: "percentile", percentile: 99}),
  log_average: () => ({auto: "log_average", key: 0.18}),
  fixed: () => Number((white ?? 1e9).toPrecision(4)),
};

function exposure({store}) {
  const pointer = "/exposure/white_cd_m2";
  const value = store.get(pointer) ?? "auto";
  const mode = value === "auto" ? "auto" : (value.auto ?? "fixed");
  const choose = {
    kind: "select",
    pointer,
    label: "White",
    value: mode,
    put: (next) => store.set(pointer, kWhites[next]?.() ?? "auto"),
    options: [
      {value: "auto", text: "automatic"},
      {value: "percentile", text: "percentile"},
      {value: "log_average", text: "log average"},
      {value: "fixed", text: "fixed luminance"},
    ],
  };
  const byMode = {
    percentile: {
      kind: "number",
      pointer: `${pointer}/percentile`,
      label: "Percentile",
      unit: "%",
      min: 50,
      max: 100,
      step: 0.1,
      least: 0,
      most: 100,
      begin: 99,
    },
    log_average: {
      kind: "number",
      pointer: `${pointer}/key`,
      label: "Key",
      scale: "log",
      min: 0.01,
      max: 1,
      least: 0,
      fallback: 0.18,
    },
    fixed: {
      kind: "number",
      pointer,
      label: "Luminance",
      unit: "cd/m²",
      scale: "log",
      min: 1e-3,
      max: 1e14,
      least: 1e-20,
      most: 1e20,
    },
  };
  const build = () => {
    note = make("p", {class: "hint"});
    showWhite(white);
    return note;
  };
  return [
    {
      kind: "number",
      pointer: "/exposure/ev",
      label: "Exposure",
      unit: "EV",
      min: -10,
      max: 10,
      step: 0.05,
      least: -64,
      most: 64,
      fallback: 0,
    },
    choose,
    byMode[mode],
    {kind: "node", key: "white", make: build},
  ];
}

// --- Tone ---

const kCurves = {
  exponential: {k: 1},
  filmic: {white: 5.6},
  table: {
    points: [
      [0.18, 0.35],
      [1, 0.8],
      [8, 1],
    ],
  },
};
const kCurveFields = {
  exponential: [{key: "k", kind: "number", label: "k", scale: "log", min: 0.01, max: 100, least: 1e-12, fallback: 1}],
  filmic: [
    {key: "white", kind: "number", label: "Its white", scale: "log", min: 0.1, max: 100, least: 1e-12, fallback: 5.6},
  ],
  table: [
    {key: "points", kind: "json", label: "Points", title: "[luminance, what is shown], ..."},
    {key: "interpolation", kind: "select", label: "Between them", options: ["linear", "smooth"], fallback: "linear"},
  ],
};

function tone({store}) {
  const curve = store.get("/tone/curve") ?? "linear";
  const put = (next) => store.set("/tone", {curve: next, ...structuredClone(kCurves[next] ?? {})});
  const fields = (kCurveFields[curve] ?? []).filter(
    ({key}) => key !== "points" || store.get("/tone/file") === undefined,
  );
  return [
    {kind: "group", label: "Tone curve"},
    {
      kind: "select",
      pointer: "/tone/curve",
      label: "Curve",
      put,
      reset: () => store.reset("/tone"),
      fallback: "linear",
      options: store.words["/tone/curve"] ?? ["linear", "exponential", "filmic", "table"],
    },
    ...fields.map(({key, ...field}) => ({...field, pointer: `/tone/${key}`})),
  ];
}

// --- Colour ---

const kWhitePoints = {temperature: {temperature_K: 3000}, chromaticity: {xy: [0.3127, 0.329]}};

function whitePoint({store}) {
  const pointer = "/white_point";
  const value = store.get(pointer) ?? "D65";
  const mode = typeof value === "string" ? value : "xy" in value ? "chromaticity" : "temperature";
  const put = (next) => store.set(pointer, structuredClone(kWhitePoints[next] ?? next));
  const fields = {
    temperature: {
      kind: "number",
      pointer: `${pointer}/temperature_K`,
      label: "Temperature",
      unit: "K",
      scale: "log",
      min: 1000,
      max: 40000,
      least: 1000,
      digits: 5,
      begin: 3000,
    },
    chromaticity: {
      kind: "vector",
      pointer: `${pointer}/xy`,
      label: "xy",
      labels: ["x", "y"],
      min: 0,
      max: 0.8,
      step: 0.001,
      begin: [0.3127, 0.329],
    },
  };
  const options = [
    {value: "D65", text: "D65"},
    {value: "equal_energy", text: "equal energy"},
    {value: "temperature", text: "temperature"},
    {value: "chromaticity", text: "chromaticity x, y"},
  ];
  return [{kind: "select", pointer, label: "White point", value: mode, options, put}, fields[mode]];
}

function colour(app) {
  const {store} = app;
  const gamuts = store.words["/gamut"] ?? ["hue_preserving", "clip"];
  const sensors = [...new Set([...(store.words["/sensor"] ?? []), "cie1931", "rods", "ccd", "infrared"])];
  return [
    {kind: "select", pointer: "/sensor", label: "Sensor", options: sensors, fallback: "cie1931"},
    ...whitePoint(app),
    {kind: "select", pointer: "/gamut", label: "Gamut", options: gamuts, fallback: "hue_preserving"},
    {kind: "color", pointer: "/background", label: "Background", fallback: [0, 0, 0]},
  ];
}

function pixels() {
  return [
    {kind: "group", label: "Pixel filter"},
    {
      kind: "select",
      pointer: "/pixel_filter/type",
      label: "Filter",
      options: ["box", "gaussian", "mitchell"],
      fallback: "box",
    },
    {
      kind: "number",
      pointer: "/pixel_filter/width",
      label: "Width",
      unit: "pixels",
      min: 1,
      max: 8,
      step: 0.1,
      least: 1,
      most: 32,
      fallback: 1,
    },
  ];
}
