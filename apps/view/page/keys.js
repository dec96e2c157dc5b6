// Keys that hold on the whole page, and the dialog that lists them.

import {make} from "./widgets.js";

/** @type {[string[], string][]} */
const kKeys = [
  [["Ctrl+Z"], "undo"],
  [["Ctrl+Shift+Z", "Ctrl+Y"], "redo"],
  [["+", "−"], "zoom in and out"],
  [["0"], "the whole picture"],
  [["1"], "one pixel of the picture for one of the screen"],
  [["Arrows"], "on the picture: from pixel to pixel; in a number: one step"],
  [["Shift+Arrows"], "ten at a time"],
  [["Page Up", "Page Down"], "in a number: ten steps"],
  [["Enter"], "on the picture: select the object there"],
  [["Esc"], "leave the pixel; give up what was typed"],
  [["Ctrl+S"], "save the look"],
  [["?"], "this list"],
];

const typing = (target) =>
  target.closest?.("input:not([type=range], [type=checkbox]), textarea, select, [contenteditable]");

/** `app.keys.add(["N"], "next image", handler?)`: other modules list theirs; with a handler for a single key it is called. */
export function setup(app) {
  const own = new Map();
  app.keys = {
    add(names, what, handler) {
      kKeys.push([names, what]);
      if (handler) for (const name of names) own.set(name.toLowerCase(), handler);
    },
  };
  const {store, picture} = app;
  const plain = {
    "+": () => picture.zoomBy(Math.SQRT2),
    "=": () => picture.zoomBy(Math.SQRT2),
    "-": () => picture.zoomBy(Math.SQRT1_2),
    0: () => picture.fit(),
    1: () => picture.zoomBy(1 / picture.zoom),
    "?": () => help(),
  };
  document.addEventListener("keydown", (event) => {
    if (event.defaultPrevented || document.querySelector("dialog[open]")) return;
    const key = event.key.toLowerCase();
    const action =
      event.ctrlKey || event.metaKey
        ? chord(event, key)
        : typing(event.target) || event.altKey
          ? null
          : (plain[key] ?? own.get(key));
    if (!action) return;
    event.preventDefault();
    action(event);
  });

  function chord(event, key) {
    if (key === "s" && !event.shiftKey) return () => app.share?.saveLook();
    // A field that is being typed in undoes its own typing.
    if (typing(event.target)?.matches("textarea") || !"zy".includes(key)) return null;
    return () => (key === "y" || event.shiftKey ? store.redo() : store.undo());
  }
  document.getElementById("help-button").addEventListener("click", help);
}

function help() {
  const dialog = document.getElementById("help");
  const rows = kKeys.map(([names, what]) =>
    make(
      "tr",
      {},
      make("th", {scope: "row"}, ...names.flatMap((name, at) => [at > 0 ? " " : "", make("kbd", {}, name)])),
      make("td", {}, what),
    ),
  );
  dialog.replaceChildren(
    make("h2", {id: "help-title"}, "Keys"),
    make("table", {}, make("tbody", {}, ...rows)),
    make(
      "p",
      {class: "hint"},
      "Drag pans the picture, the wheel and two fingers zoom it; a click selects the object. Drop a picture on an object to put it there as its texture.",
    ),
    make("form", {method: "dialog", class: "actions"}, make("button", {class: "primary"}, "Close")),
  );
  dialog.showModal();
}
