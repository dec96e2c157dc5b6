// Numbers as text, and on a slider. Pure functions.

const kNotches = 1000; // of a slider

/** Short, but nothing that matters is lost: "5800", "3.1e9", "0.0025". */
export function numberText(value, digits = 6) {
  if (!Number.isFinite(value)) return String(value);
  const size = Math.abs(value);
  const plain = size === 0 || (size >= 1e-4 && size < 1e7);
  const rounded = Number(value.toPrecision(digits));
  return plain ? String(rounded) : rounded.toExponential().replace("e+", "e");
}

/** What was typed; NaN for what is no number. Decimal commas are taken, too. */
export function typedNumber(text) {
  const trimmed = text
    .trim()
    .replace("\u2212", "-")
    .replace(/[\u00a0\u202f\u2009 ](?=\d)/g, "");
  const dotted = /^[^.]*,[^.,]*$/.test(trimmed) ? trimmed.replace(",", ".") : trimmed;
  return dotted === "" ? NaN : Number(dotted);
}

/** @param {{min: number, max: number, step?: number, scale?: "linear" | "log"}} range */
export function notches({min, max, step, scale}) {
  return scale !== "log" && step > 0 ? Math.round((max - min) / step) : kNotches;
}

/** Where on the slider a number lies, from 0 to notches(range). */
export function toNotch(value, range) {
  const {min, max, scale} = range;
  const share = scale === "log" ? Math.log(value / min) / Math.log(max / min) : (value - min) / (max - min);
  return Math.round(Math.min(Math.max(Number.isNaN(share) ? 0 : share, 0), 1) * notches(range));
}

/** The number of a place on the slider, in as many digits as its notches tell apart. */
export function fromNotch(notch, range) {
  const {min, max, scale} = range;
  const share = notch / notches(range);
  if (scale === "log") return Number((min * (max / min) ** share).toPrecision(4));
  const size = Math.max(Math.abs(min), Math.abs(max), Number.MIN_VALUE);
  const fine = (max - min) / notches(range);
  const decimals = Math.min(Math.max(Math.ceil(-Math.log10(fine) + 0.3), 0), 100);
  return size < 1e-12 ? min + (max - min) * share : Number((min + (max - min) * share).toFixed(decimals));
}

/** One step of an arrow key in the field: of the last place of two digits on a log scale, else `step`. */
export function nudged(value, count, {min, max, step, scale, digits = 6}) {
  if (scale !== "log") {
    const by = step ?? (max - min) / 100;
    return Number((value + count * by).toPrecision(Math.max(digits, 6)));
  }
  return Number((value * 1.01 ** count).toPrecision(4));
}
