// The address of a view: "#look=" and what the look differs by, deflated and in base64url; "&data=" and "&frame=".

const kLargest = 4 << 20; // bytes of a look that is unpacked

const toBase64Url = (bytes) => {
  let text = "";
  for (let at = 0; at < bytes.length; at += 0x8000) text += String.fromCharCode(...bytes.subarray(at, at + 0x8000));
  return btoa(text).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
};
const fromBase64Url = (text) =>
  Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), (c) => c.charCodeAt(0));

/** @param {object} patch @returns {Promise<string>} */
export async function packed(patch) {
  const stream = new Blob([JSON.stringify(patch)]).stream().pipeThrough(new CompressionStream("deflate-raw"));
  return toBase64Url(new Uint8Array(await new Response(stream).arrayBuffer()));
}

/** @param {string} text @returns {Promise<object>} */
export async function unpacked(text) {
  const stream = new Blob([fromBase64Url(text)]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  const reader = stream.getReader(),
    parts = [];
  let size = 0;
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    size += part.value.length;
    if (size > kLargest) throw new Error("too large");
    parts.push(part.value);
  }
  return JSON.parse(await new Blob(parts).text());
}

/** "" for what the page shows without. @param {{patch: object, data: number, frame: number}} view */
export async function writeFragment({patch, data, frame}) {
  const parts = [];
  if (Object.keys(patch).length > 0) parts.push(`look=${await packed(patch)}`);
  if (data > 0) parts.push(`data=${data}`);
  if (frame > 0) parts.push(`frame=${frame}`);
  return parts.length > 0 ? `#${parts.join("&")}` : "";
}

/** @param {string} fragment @returns {Promise<{patch: ?object, data: ?number, frame: ?number}>} */
export async function readFragment(fragment) {
  const given = new URLSearchParams(fragment.replace(/^#/, ""));
  const count = (name) => (/^\d{1,9}$/.test(given.get(name) ?? "") ? Number(given.get(name)) : undefined);
  const out = {data: count("data"), frame: count("frame")};
  if (!given.has("look")) return out;
  try {
    out.patch = await unpacked(given.get("look"));
  } catch {
    throw new Error("the look in the page's address is damaged; shown is the one to begin with");
  }
  return out;
}
