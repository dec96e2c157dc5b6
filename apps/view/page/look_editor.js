// The whole look as JSON, for what has no control.

import {same} from "./look_patch.js";
import {make} from "./widgets.js";

const text = (look) => JSON.stringify(look, null, 2);

export function setup(app) {
  const {store} = app;
  const {element, body} = app.panel("look", "Look as JSON");
  const fault = make("p", {class: "fault", id: "look-fault", role: "alert", hidden: true});
  const area = make("textarea", {
    rows: 18,
    spellcheck: "false",
    autocomplete: "off",
    "aria-label": "Look as JSON",
    "aria-describedby": "look-fault",
  });
  const full = make("input", {type: "checkbox"});
  const apply = make("button", {type: "button", class: "primary", click: () => take()}, "Apply");
  const revert = make("button", {type: "button", click: () => show()}, "Revert");
  const begin = make("button", {type: "button", click: () => store.replace(store.base)}, "As to begin with");
  body.append(
    area,
    fault,
    make("div", {class: "row"}, apply, revert, begin, make("label", {}, full, " with defaults")),
    make("p", {class: "hint"}, "Ctrl+Enter applies it. The server checks every entry."),
  );

  const say = (message) => {
    fault.textContent = message;
    fault.hidden = message === "";
    area.setAttribute("aria-invalid", String(message !== ""));
  };
  const show = () => {
    area.value = text(full.checked ? store.full : store.look);
    say("");
  };
  /** Only what the server finds right becomes the look. */
  const take = async () => {
    try {
      const look = JSON.parse(area.value);
      const {data, frame} = app.view;
      await app.api.json("api/look", {query: {data, frame}, body: area.value});
      if (same(look, store.look)) return say("");
      store.replace(look);
      show();
    } catch (error) {
      say(error.message);
    }
  };
  area.addEventListener("keydown", (event) => {
    if (event.key !== "Enter" || !(event.ctrlKey || event.metaKey)) return;
    event.preventDefault();
    take();
  });
  full.addEventListener("change", show);
  element.addEventListener("toggle", show);
  store.addEventListener("history", () => element.open && document.activeElement !== area && show());
  store.addEventListener("full", () => element.open && full.checked && document.activeElement !== area && show());
}
