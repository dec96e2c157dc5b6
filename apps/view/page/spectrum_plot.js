// A spectrum as it was emitted and as it is observed: a plot, and the same in words.
import {html, linearTicks, logTicks, scaleOf, svg, text} from "./plot.js";

const kWidth = 320, kHeight = 190;
const kLeft = 46, kRight = 8, kTop = 8, kBottom = 34;
const kDecades = 6; // of a logarithmic axis, below the greatest value
const kVisible = [380, 750];
/** Rough colours of the visible range, for orientation only. */
const kColours = ["#7a00b0", "#3030ff", "#00b0ff", "#00c040", "#c0d000", "#ff9000", "#ff2000", "#a00000"];

const finite = (list) => list.filter((x) => Number.isFinite(x));

/** What the axes have to hold. */
export function plotRange(spectrum, logarithmic) {
  const lines = spectrum.lines ?? [];
  const x = finite([...spectrum.wavelength_nm, ...lines.flatMap((l) => [l.emitted_nm, l.observed_nm])]);
  const y = finite([...spectrum.emitted, ...spectrum.observed]).filter((v) => v > 0);
  const most = y.length ? Math.max(...y) : 1;
  return {
    x: {from: x.length ? Math.min(...x) : 360, to: x.length ? Math.max(...x) : 830},
    y: logarithmic
      ? {from: Math.max(most * 10 ** -kDecades, Math.min(...y, most / 10)), to: most * 1.2, kind: "log"}
      : {from: 0, to: most * 1.05},
  };
}

/** The wavelength of the greatest value, or null where all is dark. */
export function peak(wavelengths, values) {
  let best = null;
  values.forEach((v, i) => {
    if (Number.isFinite(v) && v > 0 && (best === null || v > values[best])) best = i;
  });
  return best === null ? null : {wavelength_nm: wavelengths[best], value: values[best], edge: best === 0 || best === values.length - 1};
}

const peakWords = (name, at, unit) =>
  at === null ? `${name}: dark.` : `${name}: greatest at ${text(at.wavelength_nm)} nm${at.edge ? " (end of the plot)" : ""}, ${text(at.value, 3)} ${unit}.`;

export function summary(spectrum) {
  const {wavelength_nm: at, emitted, observed, lines = []} = spectrum, unit = unitText(spectrum.unit);
  const words = [`${spectrum.object}, g ${text(spectrum.g)}.`];
  if (at.length) words.push(peakWords("Emitted", peak(at, emitted), unit), peakWords("Observed", peak(at, observed), unit));
  const strongest = [...lines].sort((a, b) => b.strength - a.strength).slice(0, 3);
  if (lines.length)
    words.push(`${lines.length} ${lines.length === 1 ? "line" : "lines"}: ` +
      strongest.map((l) => `${text(l.emitted_nm)} nm seen at ${text(l.observed_nm)} nm`).join(", ") + (lines.length > 3 ? ", …" : "") + ".");
  return words.join(" ");
}

/** Points of a polyline; gaps where a value is not finite. */
function path(wavelengths, values, x, y, least) {
  let out = "", drawing = false;
  values.forEach((v, i) => {
    const there = Number.isFinite(v) && v >= least;
    if (there || drawing) out += `${drawing ? "L" : "M"}${x(wavelengths[i]).toFixed(1)},${y(Math.max(v ?? 0, least)).toFixed(1)}`;
    drawing = there;
  });
  return out;
}

/** "W m^-2 nm^-1" with raised exponents. */
export const unitText = (unit = "") =>
  unit.replace(/\^(-?)(\d+)/g, (_, sign, digits) => (sign ? "⁻" : "") + [...digits].map((d) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[d]).join(""));

let plots = 0;

function visibleBand(range, x, height) {
  const from = Math.max(kVisible[0], range.from), to = Math.min(kVisible[1], range.to);
  if (to <= from) return [];
  const id = `visible-${++plots}`;
  const stops = kColours.map((colour, i) => svg("stop", {offset: i / (kColours.length - 1), "stop-color": colour}));
  return [
    svg("linearGradient", {id, gradientUnits: "userSpaceOnUse", x1: x(kVisible[0]), x2: x(kVisible[1]), y1: 0, y2: 0}, ...stops),
    svg("rect", {x: x(from), width: x(to) - x(from), y: 0, height, fill: `url(#${id})`, class: "plot-visible"}),
  ];
}

function axes(range, x, y, width, height, logarithmic) {
  const out = [svg("path", {d: `M0,0V${height}H${width}`, class: "plot-axis"})];
  for (const value of linearTicks(range.x.from, range.x.to, 5)) {
    out.push(svg("path", {d: `M${x(value)},${height}v4`, class: "plot-axis"}));
    out.push(svg("text", {x: x(value), y: height + 15, class: "plot-number plot-middle"}, text(value)));
  }
  for (const value of logarithmic ? logTicks(range.y.from, range.y.to, 4) : linearTicks(range.y.from, range.y.to, 4)) {
    out.push(svg("path", {d: `M0,${height - y(value)}h${width}`, class: "plot-grid"}));
    out.push(svg("text", {x: -4, y: height - y(value) + 3.5, class: "plot-number plot-end"}, text(value, 3)));
  }
  out.push(svg("text", {x: width / 2, y: height + 29, class: "plot-number plot-middle"}, "wavelength in nm"));
  return out;
}

/** Lines as sticks, by their share of the strongest one of both kinds. */
function sticks(lines, x, height) {
  const most = Math.max(...finite(lines.flatMap((l) => [l.strength, l.observed_strength])), 1e-300);
  return lines.flatMap((l) => [
    svg("path", {d: `M${x(l.emitted_nm)},${height}V${height * (1 - (0.95 * l.strength) / most)}`, class: "plot-emitted plot-stick"}),
    svg("path", {d: `M${x(l.observed_nm)},${height}V${height * (1 - (0.95 * l.observed_strength) / most)}`, class: "plot-observed plot-stick"}),
  ]);
}

/** A <figure> of an entry of `spectra` of api/pixel. */
export function spectrumPlot(spectrum, {logarithmic = false} = {}) {
  const width = kWidth - kLeft - kRight, height = kHeight - kTop - kBottom;
  const range = plotRange(spectrum, logarithmic);
  const x = scaleOf(range.x, width), up = scaleOf(range.y, height), y = (v) => height - up(v);
  const least = logarithmic ? range.y.from : -Infinity;
  const words = summary(spectrum);
  const drawing = svg("svg", {viewBox: `0 0 ${kWidth} ${kHeight}`, class: "plot", role: "img", "aria-label": `Spectrum of ${words}` },
    svg("g", {transform: `translate(${kLeft} ${kTop})` },
      ...visibleBand(range.x, x, height),
      ...axes(range, x, up, width, height, logarithmic),
      svg("path", {d: path(spectrum.wavelength_nm, spectrum.emitted, x, y, least), class: "plot-line plot-emitted"}),
      svg("path", {d: path(spectrum.wavelength_nm, spectrum.observed, x, y, least), class: "plot-line plot-observed"}),
      ...sticks(spectrum.lines ?? [], x, height)));
  const key = html("p", {class: "plot-key", "aria-hidden": "true"},
    html("span", {class: "plot-emitted"}, "— emitted"), " ", html("span", {class: "plot-observed"}, "– – observed"),
    ` in ${unitText(spectrum.unit)}`);
  return html("figure", {class: "spectrum"}, drawing, key, html("figcaption", {class: "plot-words"}, words));
}
