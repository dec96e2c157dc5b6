// Time slices as documents: what a band, its handles and its fields do to them. Pure functions.

/** The ends of a slice as numbers; open ends lie beyond the range. */
export const ends = (slice) => ({from: slice.from ?? -Infinity, to: slice.to ?? Infinity});

/** `fade` as [coming, going]. */
export function fades(slice) {
  const fade = slice.fade ?? 0;
  return Array.isArray(fade) ? [fade[0], fade[1]] : [fade, fade];
}

/** As short as the look writes it; no fade at all is left out. */
export function withFades(slice, [coming, going]) {
  const {fade, ...rest} = slice;
  if (coming === 0 && going === 0) return rest;
  return {...rest, fade: coming === going ? coming : [coming, going]};
}

/** Short enough to read: so many digits that steps of a thousandth of the range are told apart. */
export function rounded(x, range) {
  const digits = Math.max(0, 4 - Math.floor(Math.log10(range || 1)));
  return Number(x.toFixed(Math.min(digits, 15)));
}

/**
 * The slice after its `part` ("from", "to" or "both") was moved to or by `x`. Ends never cross; what is moved as a whole
 * keeps its length, and open ends stay open.
 */
export function moved(slice, part, x, range) {
  const {from, to} = ends(slice);
  const least = range / 1000;
  if (part === "from") return {...slice, from: rounded(Math.min(x, to - least), range)};
  if (part === "to") return {...slice, to: rounded(Math.max(x, from + least), range)};
  const out = {...slice};
  if (slice.from !== undefined) out.from = rounded(slice.from + x, range);
  if (slice.to !== undefined) out.to = rounded(slice.to + x, range);
  return out;
}

/** A new slice in the middle third of the histogram. */
export function fresh(channel, from, to) {
  const range = to - from;
  return {
    channel,
    from: rounded(from + range / 3, range),
    to: rounded(to - range / 3, range),
    texture: {type: "color", rgb: [1, 0.2, 0.2]},
  };
}

const hex = (x) => Math.round(255 * Math.min(1, Math.max(0, x))).toString(16).padStart(2, "0");
export const toHex = (rgb) => `#${rgb.map(hex).join("")}`;
export const fromHex = (text) => [1, 3, 5].map((i) => Number((parseInt(text.slice(i, i + 2), 16) / 255).toFixed(4)));

/** In words, for lists and screen readers. */
export function words(slice) {
  const out = [];
  const {texture, spectrum, intensity, blink} = slice;
  if (texture) out.push(texture.type === "color" ? `colour ${toHex(texture.rgb)}` : `texture ${texture.type}`);
  if (spectrum) out.push(spectrum.type === "black_body" ? `${spectrum.temperature_K} K` : `spectrum ${spectrum.type}`);
  if (intensity !== undefined) out.push(intensity === 0 ? "dark" : `intensity ${typeof intensity === "number" ? intensity : "by keyframes"}`);
  if (blink) out.push("blinks");
  return out.length ? out.join(", ") : "nothing changed";
}
