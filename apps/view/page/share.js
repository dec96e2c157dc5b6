// What leaves the page: its address, look.json, pictures, and the command line.

import {difference, merged} from "./look_patch.js";
import {readFragment, writeFragment} from "./fragment.js";
import {commandLine, filesOf} from "./shell.js";
import {make} from "./widgets.js";

const kPictures = [
  {value: "png 8", text: "PNG, 8 bit"},
  {value: "png 16", text: "PNG, 16 bit"},
  {value: "jpg 8", text: "JPEG"},
  {value: "tif 8", text: "TIFF, 8 bit"},
  {value: "tif 16", text: "TIFF, 16 bit"},
  {value: "tif 32", text: "TIFF, float"},
  {value: "exr 32", text: "OpenEXR, float"},
  {value: "exr 16", text: "OpenEXR, half"},
];

/** `app.share`: saveLook(), savePicture(format, bits), commandLine(), address(), download(blob, name), copy(text, what). */
export function setup(app) {
  app.share = {
    saveLook: () => saveLook(app),
    savePicture: (format, bits) => savePicture(app, format, bits),
    commandLine: (picture) => command(app, picture),
    address: () => address(app),
    download,
    copy: (text, what) => copy(app, text, what),
  };
  keepAddress(app);
  menu(app);
}

// --- Address ---

const patchOf = ({store}) => difference(store.base, store.look);

async function address(app) {
  const {data, frame} = app.view;
  const fragment = await writeFragment({patch: patchOf(app), data: typeof data === "number" ? data : 0, frame});
  return location.href.replace(/#.*$/, "") + fragment;
}

function keepAddress(app) {
  let last = 0;
  const write = async () => {
    const number = ++last;
    const to = await address(app).catch(() => location.href); // browsers that cannot deflate
    if (number === last && to !== location.href) history.replaceState(null, "", to);
  };
  app.store.addEventListener("history", write);
  app.addEventListener("view", write);
  addEventListener("hashchange", async () => {
    ++last; // what was being written is out of date
    try {
      const {patch, data = 0, frame} = await readFragment(location.hash);
      if (data < app.state.datasets.length) await app.show({data, frame: frame ?? app.state.datasets[data].frame ?? 0});
      app.store.replace(merged(app.store.base, patch ?? {}));
    } catch (error) {
      app.say(error.message, {error: true});
    }
  });
}

// --- Files ---

const stem = (app) => app.dataset.name.replace(/\.exr$/i, "");

export function download(blob, name) {
  const url = URL.createObjectURL(blob);
  const link = make("a", {href: url, download: name});
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 60000);
}

function saveLook(app) {
  download(new Blob([`${JSON.stringify(app.store.look, null, 2)}\n`], {type: "application/json"}), "look.json");
  app.say(`look.json saved. ${fileNote(app) || ""}`);
}

/** Relative names are looked for beside the file that has them. */
function fileNote(app) {
  const files = filesOf(app.store.look).filter((file) => !file.startsWith("/"));
  return files.length === 0
    ? ""
    : `It names ${files.join(", ")}: look.json looks for ${files.length === 1 ? "it" : "them"} beside itself.`;
}

async function savePicture(app, format, bits) {
  app.say("Making the picture…");
  try {
    const {data, frame} = app.view;
    const answer = await app.api.request("api/picture", {query: {data, frame, format, bits}, body: app.store.look});
    const name = `${stem(app)}.${format}`;
    download(await answer.blob(), name);
    app.say(`${name} saved.`);
  } catch (error) {
    app.say(error.message, {error: true});
  }
}

// --- Command line ---

function command(app, picture = {}) {
  const {state, dataset, store, view} = app;
  return commandLine({
    path: dataset.path,
    lookFile: state.look_file,
    given: state.settings,
    base: store.base,
    look: store.look,
    frame: view.frame,
    ...picture,
  });
}

async function copy(app, text, what) {
  try {
    await navigator.clipboard.writeText(text);
    app.say(`${what} copied.`);
    return true;
  } catch {
    app.say(`The browser does not let the page copy; the ${what.toLowerCase()} is selected, press Ctrl+C.`);
    return false;
  }
}

// --- Menu ---

function menu(app) {
  const details = document.getElementById("save-menu"),
    items = document.getElementById("save-items");
  const format = make(
    "select",
    {"aria-label": "Kind of picture"},
    ...kPictures.map(({value, text}) => make("option", {value}, text)),
  );
  const chosen = () => {
    const [kind, bits] = format.value.split(" ");
    return {kind, bits};
  };
  const line = field("Command line"),
    url = field("Address");
  const lookNote = make("p", {class: "hint"}),
    lineNote = make("p", {class: "hint"});
  const show = async () => {
    if (!details.open) return;
    const {kind, bits} = chosen();
    const usual = {png: "8", jpg: "8", tif: "8", exr: "32"}[kind];
    line.value = command(app, {picture: `picture.${kind}`, bits: bits === usual ? undefined : bits});
    lookNote.textContent = fileNote(app);
    lineNote.textContent = noteOnFiles(app);
    url.value = await address(app);
  };
  const copyFrom = (area, what) => async () => {
    area.select();
    await copy(app, area.value, what);
  };
  const button = (text, click, title = "") => make("button", {type: "button", click, title}, text);
  items.append(
    make("h2", {}, "Picture, as nullcone-postrender writes it"),
    make(
      "div",
      {class: "row"},
      format,
      button("Save picture", () => savePicture(app, chosen().kind, chosen().bits)),
    ),
    make("h2", {}, "Look"),
    make(
      "div",
      {class: "row"},
      button("Save look.json", () => saveLook(app), "Ctrl+S"),
    ),
    lookNote,
    make("h2", {}, "Command line that makes this picture"),
    line,
    lineNote,
    make("div", {class: "row"}, button("Copy command line", copyFrom(line, "Command line"))),
    make("h2", {}, "Address of this view"),
    url,
    make("p", {class: "hint"}, "For a colleague whose nullcone-view shows the same dataset."),
    make("div", {class: "row"}, button("Copy address", copyFrom(url, "Address"))),
  );
  details.addEventListener("toggle", show);
  format.addEventListener("change", show);
  app.store.addEventListener("history", show);
  closeOutside(details);
}

const field = (label) =>
  make("textarea", {readOnly: true, rows: 3, "aria-label": label, class: "code", spellcheck: "false"});

function noteOnFiles(app) {
  if (app.view.data === "live")
    return "The scene has changed since it was traced: save it as a dataset first, and put that in the place of the path.";
  const before = new Set(filesOf(app.store.base));
  const files = filesOf(app.store.look).filter((file) => !before.has(file));
  const place = app.state.look_file ? "the file of --look" : "the dataset";
  return files.length === 0 ? "" : `${files.join(", ")} must stand beside ${place}, or be given with a path.`;
}

function closeOutside(details) {
  document.addEventListener("pointerdown", (event) => details.contains(event.target) || (details.open = false));
  details.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || !details.open) return;
    details.open = false;
    details.querySelector("summary").focus();
  });
}
