// The words between the page and its server.

/** What the server refused, or that it does not answer (status 0). */
export class ApiError extends Error {
  constructor(status, message) {
    super(message);
    this.status = status;
  }
}

/** Whether asking again later may help. */
export const isLost = ({status}) => status === 0 || status >= 502;

const kAgain = [100, 250, 500, 1000, 2000]; // ms to wait when the server is busy

/** 16 hex digits: this page, whose renderers the server keeps. */
function viewer() {
  const bytes = crypto.getRandomValues(new Uint8Array(8));
  return [...bytes].map((byte) => byte.toString(16).padStart(2, "0")).join("");
}

const wait = (ms) => new Promise((done) => setTimeout(done, ms));

export class Api {
  #viewer = viewer();

  /**
   * The answer to a request, once it is good.
   * @param {string} path "api/look" @param {{query?: object, body?: *, type?: string, signal?: AbortSignal}} [request]
   * @returns {Promise<Response>}
   */
  async request(path, {query = {}, body, type = "application/json", signal} = {}) {
    const given = Object.entries(query).filter(([, value]) => value !== undefined && value !== null);
    const target = given.length > 0 ? `${path}?${new URLSearchParams(given)}` : path;
    const headers = {"X-Nullcone-Viewer": this.#viewer};
    const raw = body instanceof Blob || body instanceof ArrayBuffer || ArrayBuffer.isView(body);
    if (body !== undefined) headers["Content-Type"] = raw ? "application/octet-stream" : type;
    const init = {method: body === undefined ? "GET" : "POST", headers, signal, cache: "no-store"};
    if (body !== undefined) init.body = raw || typeof body === "string" ? body : JSON.stringify(body);
    for (let attempt = 0; ; ++attempt) {
      const answer = await this.#fetched(target, init);
      if (answer.ok) return answer;
      if (answer.status === 429 && attempt < kAgain.length) await wait(kAgain[attempt]);
      else throw await refusal(answer);
    }
  }

  async #fetched(target, init) {
    try {
      return await fetch(target, init);
    } catch (error) {
      if (error.name === "AbortError") throw error;
      throw new ApiError(0, "no answer from nullcone-view; is it still running?");
    }
  }

  /** @returns {Promise<*>} */
  async json(path, request) {
    return (await this.request(path, request)).json();
  }

  /**
   * A picture, with what it took: `rgba` of raw ones, else a `bitmap`. `path` is api/frame, api/trace or api/channel.
   * @returns {Promise<{width: number, height: number, rgba?: Uint8ClampedArray, bitmap?: ImageBitmap, white: ?number,
   *   times: object, notes: string[], format: string, bytes: number, ms: number, headers: Headers}>} times in ms
   */
  async frame(query, body, path = "api/frame") {
    const begin = performance.now();
    const answer = await this.request(path, {query, body});
    const buffer = await answer.arrayBuffer();
    const [width, height] = answer.headers.get("X-Nullcone-Size").split("x").map(Number);
    const frame = {width, height, format: query.format ?? "raw", bytes: buffer.byteLength, headers: answer.headers};
    frame.arrived = performance.now() - begin; // ms
    frame.times = times(answer.headers.get("X-Nullcone-Times"));
    frame.white = Number(answer.headers.get("X-Nullcone-White")) || null;
    frame.notes = JSON.parse(answer.headers.get("X-Nullcone-Notes") ?? "[]");
    if (frame.format === "raw") frame.rgba = new Uint8ClampedArray(buffer);
    else frame.bitmap = await decoded(buffer, answer.headers.get("Content-Type"));
    frame.ms = performance.now() - begin;
    frame.decoded = frame.ms - frame.arrived;
    return frame;
  }

  /** A file for the look; its name is the one under which looks may use it. */
  async upload(file) {
    return this.json("api/texture", {query: {name: file.name}, body: file});
  }
}

/** As they are: no colour management between the server's numbers and the canvas. */
function decoded(buffer, type) {
  const blob = new Blob([buffer], {type});
  return createImageBitmap(blob, {colorSpaceConversion: "none", premultiplyAlpha: "none"});
}

/** "render=9.1;encode=0.5" in ms. */
function times(text) {
  const out = {};
  for (const part of (text ?? "").split(";")) {
    const [name, value] = part.split("=");
    if (value !== undefined) out[name.trim()] = Number(value);
  }
  return out;
}

async function refusal(answer) {
  const text = await answer.text();
  try {
    return new ApiError(answer.status, JSON.parse(text).error ?? text);
  } catch {
    return new ApiError(answer.status, text || `the server answered ${answer.status}`);
  }
}
