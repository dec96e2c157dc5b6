// Looks as documents: JSON pointers (RFC 6901), merge patches (RFC 7386), and both as words of a command line.
// Pure functions; documents are never changed, but copied as far as they differ.

/** @param {*} value */
export const isObject = (value) => typeof value === "object" && value !== null && !Array.isArray(value);

/** @param {string} pointer @returns {string[]} */
export function steps(pointer) {
  return pointer
    .split("/")
    .slice(1)
    .map((step) => step.replaceAll("~1", "/").replaceAll("~0", "~"));
}

/** @param {string[]} keys */
export function pointerTo(...keys) {
  return keys.map((key) => "/" + String(key).replaceAll("~", "~0").replaceAll("/", "~1")).join("");
}

/** What stands at `pointer`; undefined where nothing does. */
export function find(document, pointer) {
  let at = document;
  for (const key of steps(pointer)) {
    if (at === null || typeof at !== "object" || !Object.hasOwn(at, key)) return undefined;
    at = at[key];
  }
  return at;
}

/** `document` with `value` at `pointer`, made on the way as far as it lacks; undefined removes the entry. */
export function changed(document, pointer, value) {
  const put = (at, keys) => {
    if (keys.length === 0) return value;
    const [key, ...rest] = keys;
    const copy = Array.isArray(at) ? [...at] : isObject(at) ? {...at} : {};
    if (value === undefined && !Object.hasOwn(copy, key)) return copy;
    const inner = put(copy[key], rest);
    if (inner === undefined) delete copy[key];
    else define(copy, key, inner);
    return copy;
  };
  return put(document, steps(pointer)) ?? {};
}

/** Also where the key is `__proto__`. */
function define(object, key, value) {
  Object.defineProperty(object, key, {value, enumerable: true, configurable: true, writable: true});
}

export function same(a, b) {
  if (a === b) return true;
  if (Array.isArray(a) && Array.isArray(b)) return a.length === b.length && a.every((item, i) => same(item, b[i]));
  if (!isObject(a) || !isObject(b)) return false;
  const keys = Object.keys(a);
  return keys.length === Object.keys(b).length && keys.every((key) => Object.hasOwn(b, key) && same(a[key], b[key]));
}

/** The merge patch that makes `look` of `base`: entries that differ, and null for those that are gone. */
export function difference(base, look) {
  const patch = {};
  for (const key of Object.keys(base)) if (!Object.hasOwn(look, key)) define(patch, key, null);
  for (const [key, value] of Object.entries(look)) {
    const before = Object.hasOwn(base, key) ? base[key] : undefined;
    if (same(before, value)) continue;
    define(patch, key, isObject(before) && isObject(value) ? difference(before, value) : value);
  }
  return patch;
}

/** `base` with a merge patch applied. */
export function merged(base, patch) {
  if (!isObject(patch)) return patch;
  const out = isObject(base) ? {...base} : {};
  for (const [key, value] of Object.entries(patch)) {
    if (value === null) delete out[key];
    else define(out, key, merged(Object.hasOwn(out, key) ? out[key] : undefined, value));
  }
  return out;
}

/** The same as `--set`s, "path=value" each: one an entry that differs, so that each can be read and changed. */
export function settings(base, look) {
  const out = [];
  const walk = (before, after, keys) => {
    if (same(before, after)) return;
    if (!isObject(before) || !isObject(after)) {
      out.push(`${path(keys)}=${after === undefined ? "null" : text(after)}`);
      return;
    }
    for (const key of new Set([...Object.keys(before), ...Object.keys(after)]))
      walk(own(before, key), own(after, key), [...keys, key]);
  };
  walk(base, look, []);
  return out;
}

const own = (object, key) => (Object.hasOwn(object, key) ? object[key] : undefined);

/** Over dots where that is clear, else a JSON pointer. */
function path(keys) {
  return keys.every((key) => /^[^./=]+$/.test(key)) ? keys.join(".") : pointerTo(...keys);
}

/** Texts as they are, unless they would be read as JSON. */
function text(value) {
  if (typeof value !== "string") return JSON.stringify(value);
  try {
    JSON.parse(value);
  } catch {
    return value;
  }
  return JSON.stringify(value);
}
