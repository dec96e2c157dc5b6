// The command line that makes the same picture. Pure functions.

import {isObject, settings} from "./look_patch.js";

/** One word of a POSIX shell. @param {string} word */
export function quoted(word) {
  if (/^[\w@%+=:,./-]+$/.test(word) && !word.startsWith("=")) return word;
  return `'${word.replaceAll("'", "'\\''")}'`;
}

/**
 * @param {{path: string, lookFile?: ?string, given?: string[], base: object, look: object, frame?: number,
 *   picture?: string, bits?: number}} what `given`: settings the viewer was started with
 */
export function commandLine({path, lookFile, given = [], base, look, frame = 0, picture = "picture.png", bits}) {
  const words = ["nullcone-postrender", path.startsWith("-") ? `./${path}` : path];
  if (lookFile) words.push("--look", lookFile);
  for (const setting of [...given, ...settings(base, look)]) words.push("--set", setting);
  if (frame > 0) words.push("--frame", String(frame));
  if (bits) words.push("--bits", String(bits));
  words.push("-o", picture);
  return words.map(quoted).join(" ");
}

/** Names of files in a look, in their order. */
export function filesOf(look) {
  const out = new Set();
  const walk = (value) => {
    if (Array.isArray(value)) value.forEach(walk);
    if (!isObject(value)) return;
    for (const [key, inner] of Object.entries(value)) {
      if (key === "file" && typeof inner === "string") out.add(inner);
      else walk(inner);
    }
  };
  walk(look);
  return [...out];
}
