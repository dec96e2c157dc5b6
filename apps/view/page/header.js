// The header and the bar below the picture: name, history, transport, zoom, theme.

import {make} from "./widgets.js";
import {speed} from "./link.js";

const $ = (id) => document.getElementById(id);
const kFew = 16;
const kThemes = ["system", "light", "dark"];

export function setup(app) {
  const name = () => {
    $("dataset-name").textContent = app.dataset.name;
    $("dataset-name").title = app.dataset.path;
    document.title = `${app.dataset.name} – Nullcone`;
    const {width, height, metric, objects} = app.dataset;
    app.picture.element.setAttribute(
      "aria-label",
      `Picture of ${app.dataset.name}: ${width} by ${height} pixels, ` +
        `${metric?.name ?? metric ?? "spacetime"}, ${objects.map((object) => object.name).join(", ")}`,
    );
  };
  app.addEventListener("dataset", name);
  name();
  chooseDataset(app);
  history(app);
  transport(app);
  zoom(app);
  theme();
}

function chooseDataset(app) {
  const {length} = app.state.datasets;
  if (length < 2 || length > kFew) return; // more are frames, which the time line shows
  const options = app.state.datasets.map(({name}, at) => make("option", {value: String(at)}, name));
  const select = make(
    "select",
    {"aria-label": "Dataset", change: () => app.show({data: Number(select.value)})},
    ...options,
  );
  select.value = String(app.view.data);
  app.addEventListener("view", () => (select.value = String(app.view.data)));
  $("header-slot").append(select);
}

function history(app) {
  const {store} = app;
  const show = () => {
    $("undo").disabled = !store.canUndo;
    $("redo").disabled = !store.canRedo;
  };
  $("undo").addEventListener("click", () => store.undo());
  $("redo").addEventListener("click", () => store.redo());
  store.addEventListener("history", show);
  show();
}

function transport(app) {
  const {frames} = app,
    select = $("format");
  for (const option of [...select.options])
    if (option.value !== "" && !app.state.formats.includes(option.value)) option.remove();
  const title = () => ($("transport").title = `Pictures come as ${frames.link.reason}.`);
  select.addEventListener("change", () => {
    frames.link.pinned = select.value === "" ? null : select.value;
    frames.refresh();
  });
  frames.addEventListener("shown", ({detail: {frame, ms}}) => {
    const rate = frames.link.telling ? speed(frames.link.rate) : "–";
    $("frame-time").textContent = `${frame.format} ${ms.toFixed(0)} ms · ${rate}`;
    title();
    showNotes(frame.notes ?? []);
  });
  title();
}

function showNotes(notes) {
  $("notes").hidden = notes.length === 0;
  if (notes.length === 0) return;
  $("notes").querySelector("summary").textContent = notes.length === 1 ? "1 note" : `${notes.length} notes`;
  $("notes")
    .querySelector("ul")
    .replaceChildren(...notes.map((note) => make("li", {}, note)));
}

function zoom(app) {
  const {picture} = app;
  const show = () => ($("zoom").textContent = `${Number((picture.zoom * 100).toPrecision(3))} %`);
  picture.addEventListener("zoom", show);
  $("zoom-in").addEventListener("click", () => picture.zoomBy(Math.SQRT2));
  $("zoom-out").addEventListener("click", () => picture.zoomBy(Math.SQRT1_2));
  $("zoom-fit").addEventListener("click", () => picture.fit());
  picture.addEventListener("pixel", ({detail: {x, y, inside}}) => {
    $("pixel").textContent = inside ? `x ${x}  y ${y + (app.dataset.first_line ?? 0)}` : "";
  });
  show();
}

/** Kept where the browser keeps such things, if it does. */
function theme() {
  const button = $("theme");
  let at = 0;
  const show = () => {
    const name = kThemes[at];
    if (at === 0) delete document.documentElement.dataset.theme;
    else document.documentElement.dataset.theme = name;
    button.replaceChildren(make("span", {class: "wide-only"}, "Theme: "), name);
  };
  try {
    at = Math.max(kThemes.indexOf(localStorage.getItem("nullcone-theme")), 0);
  } catch {} // storage is switched off
  button.addEventListener("click", () => {
    at = (at + 1) % kThemes.length;
    show();
    try {
      localStorage.setItem("nullcone-theme", kThemes[at]);
    } catch {}
  });
  show();
}
