// What all controls have: label, unit, reset, and what is wrong.

let count = 0;

/** An element with attributes (functions: listeners) and children. */
export function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") element.addEventListener(name, value);
    else if (name in element && typeof value !== "string") element[name] = value;
    else element.setAttribute(name, value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

/** The frame that all controls have. `parts` follow the label; `main` is what the label is of. */
export function control(kind, {label, unit, title, reset, pointer}, main, ...parts) {
  const id = (main.id ||= `control-${++count}`);
  const name = make("label", {for: id, class: "name"}, label);
  if (unit) name.append(" ", make("span", {class: "unit"}, unit));
  if (title) name.title = title;
  const fault = make("p", {class: "fault", id: `${id}-fault`, role: "alert", hidden: true});
  const undo = make(
    "button",
    {type: "button", class: "reset", "aria-label": `Reset ${label}`, title: "Reset", click: () => reset?.()},
    "↺",
  );
  undo.hidden = !reset;
  const element = make("div", {class: `control ${kind}`}, name, ...parts, undo, fault);
  if (pointer) element.dataset.pointer = pointer;
  /** @param {string} text what is wrong; "" for nothing */
  element.fault = (text) => {
    fault.textContent = text;
    fault.hidden = text === "";
    const state = {"aria-invalid": "true", "aria-describedby": fault.id};
    for (const [name, value] of Object.entries(state)) {
      if (text === "") main.removeAttribute(name);
      else main.setAttribute(name, value);
    }
  };
  element.focus = () => main.focus();
  /** Whether reset would change anything. */
  element.changed = (on) => undo.classList.toggle("idle", !on);
  return element;
}

/** Gives the element its `value`. */
export const asValue = (element, get, set) => Object.defineProperty(element, "value", {get, set});
