// What plots and panels share: scales, ticks, numbers as text, elements and requests. The first three are pure.

/** From a value to a place in [0, length]; `kind` "linear" or "log". Clamped to the ends. */
export function scaleOf({ from, to, kind = "linear" }, length) {
  const f = kind === "log" ? (x) => Math.log(Math.max(x, Number.MIN_VALUE)) : (x) => x;
  const span = f(to) - f(from) || 1;
  return (x) => Math.min(1, Math.max(0, (f(x) - f(from)) / span)) * length;
}

/** Round numbers in [from, to], about `count` of them, 1, 2 or 5 times a power of ten apart. */
export function linearTicks(from, to, count = 5) {
  if (!(to > from)) return [from];
  const rough = (to - from) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].find((f) => f * power >= rough * 0.999) * power;
  const out = [];
  for (let i = Math.ceil(from / step - 1e-9); i * step <= to + 1e-9 * step; ++i)
    out.push(Number((i * step).toPrecision(12)));
  return out;
}

/** Powers of ten in [from, to], every n-th so that there are at most `count`. */
export function logTicks(from, to, count = 5) {
  const first = Math.ceil(Math.log10(from) - 1e-9), last = Math.floor(Math.log10(to) + 1e-9);
  const every = Math.max(1, Math.ceil((last - first + 1) / count));
  const out = [];
  for (let i = first; i <= last; i += every) out.push(Number(`1e${i}`));
  return out;
}

/** A number as text with so many digits, with a true minus sign; what is no number (JSON null) as "not finite". */
export function text(x, digits = 4) {
  if (x === null || x === undefined || !Number.isFinite(x)) return "not finite";
  if (Number.isInteger(x) && Math.abs(x) < 1e6) return String(x).replace("-", "−");
  const size = Math.abs(x);
  const out = size >= 1e5 || size < 1e-3 ? x.toExponential(digits - 1) : String(Number(x.toPrecision(digits)));
  return out.replace(/\.?0+e/, "e").replace("e+", "e").replaceAll("-", "−");
}

function build(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes ?? {})) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value === true ? "" : value);
  }
  element.append(...children.filter((c) => c !== undefined && c !== null));
  return element;
}

/** <tag attributes>children</tag>; attributes "onclick" and so on are listeners. */
export const html = (tag, attributes, ...children) => build(document.createElement(tag), attributes, children);
export const svg = (tag, attributes, ...children) =>
  build(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);

/** Calls at most once at a time, always with the newest arguments; `call` returns a promise. */
export function newestWins(call) {
  let running = false, waiting = null;
  return async function request(...args) {
    if (running) {
      waiting = args;
      return;
    }
    running = true;
    try {
      await call(...args);
    } finally {
      running = false;
      const next = waiting;
      waiting = null;
      if (next) request(...next);
    }
  };
}

/** Line of the whole picture at which the canvas begins; what is traced live is whole. */
export const firstLine = (app) => (app.view.data === "live" ? 0 : app.dataset.first_line ?? 0);

/** All that is known of a pixel of the canvas. What is traced while something moves may be coarser than that. */
export function pixelRecords(app, x, y) {
  const {data, frame} = app.view, {width, height} = app.picture;
  const query = {data, frame, x, y: y + firstLine(app), ...(data === "live" ? {width, height} : {})};
  return app.api.json("api/pixel", {query, body: app.store.look});
}

/** The names of the dataset's objects; chosen stays what was, or becomes what the page has selected. */
export function fillObjects(select, app) {
  const names = app.dataset.objects.map(({name}) => name), before = select.value;
  select.replaceChildren(...names.map((name) => html("option", {value: name}, name)));
  select.value = names.includes(before) ? before : app.selected ?? names[0] ?? "";
}
