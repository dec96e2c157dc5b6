// How pictures come over the link between page and server: what each format would take, from what was measured, and so
// which one is the fastest.

/** To begin with: bytes a pixel, and ms a million pixels to encode and to decode. */
const kFormats = {
  raw: {bytes: 4, encode: 1, decode: 2, lossless: true},
  png: {bytes: 1, encode: 30, decode: 20, lossless: true},
  jpeg: {bytes: 0.3, encode: 6, decode: 8, lossless: false},
  webp: {bytes: 0.15, encode: 60, decode: 12, lossless: false},
};
const kLocal = 4e5,
  kRemote = 5e3; // bytes/ms before anything was measured
const kTelling = 5e4; // bytes from which an answer tells the link's speed
const kLeast = 2e3,
  kSlow = 10; // bytes, ms
const kTellingPixels = 0.05; // million pixels from which one tells what formats cost
const kClock = 0.2; // ms that clocks of browsers tell apart
const kHold = 0.85; // another format must be that much faster

const mean = (before, now, share = 0.3) => (1 - share) * before + share * now;

export class Link {
  /** @param {string} host */
  constructor(host) {
    const local = /^(localhost|127\..*|\[::1\])$/.test(host);
    this.rate = local ? kLocal : kRemote; // bytes/ms
    this.serverTime = 0; // ms of work a frame
    this.pinned = null; // the user's own choice
    this.formats = structuredClone(kFormats);
    this.last = {true: null, false: null}; // by lossless
    this.telling = false; // whether the rate was measured
    this.#observe();
  }

  /** ms that a frame takes, but for what all formats have alike. */
  #cost(name, pixels) {
    const format = this.formats[name];
    return (format.bytes * pixels) / this.rate + (pixels / 1e6) * (format.encode + format.decode);
  }

  /** The format to ask for. @param {{lossless: boolean, pixels: number}} frame */
  choose({lossless, pixels}) {
    if (this.pinned !== null) return this.pinned;
    const names = Object.keys(this.formats).filter((name) => !lossless || this.formats[name].lossless);
    const best = names.reduce((a, b) => (this.#cost(b, pixels) < this.#cost(a, pixels) ? b : a));
    const held = this.last[lossless];
    const change = held === null || this.#cost(best, pixels) < kHold * this.#cost(held, pixels);
    return (this.last[lossless] = change ? best : held);
  }

  /** What a frame took, in ms and bytes. @param {object} frame as Api.frame() gives it */
  measured({format, bytes, width, height, times, decoded}) {
    const known = this.formats[format];
    if (known === undefined) return;
    const share = (width * height) / 1e6;
    const work = Object.values(times).reduce((sum, ms) => sum + ms, 0);
    this.serverTime = this.serverTime === 0 ? work : mean(this.serverTime, work);
    known.bytes = mean(known.bytes, bytes / (share * 1e6));
    if (share < kTellingPixels) return; // the rest is mostly what any frame takes
    known.encode = mean(known.encode, (times.encode ?? 0) / share);
    if (decoded !== undefined) known.decode = mean(known.decode, decoded / share);
  }

  /** Measures what arrives, by the browser's own clock of its network: the page may be busy. */
  #observe() {
    if (typeof PerformanceObserver === "undefined") return;
    new PerformanceObserver((list) => {
      for (const {name, encodedBodySize, responseStart, responseEnd} of list.getEntries())
        if (/\/api\/(frame|trace|channel)\b/.test(name)) this.received(encodedBodySize, responseEnd - responseStart);
    }).observe({type: "resource"});
  }

  /** @param {number} bytes @param {number} ms from the first byte to the last */
  received(bytes, ms) {
    if (!(ms >= 0) || bytes < kLeast) return;
    const rate = bytes / Math.max(ms, kClock);
    // A small answer tells only that the link is slow, if it is.
    if (bytes < kTelling && (ms < kSlow || rate > this.rate)) return;
    const share = bytes < kTelling ? 0.15 : Math.min(0.3 + ms / 500, 0.9);
    this.rate = this.telling ? Math.exp(mean(Math.log(this.rate), Math.log(rate), share)) : rate;
    this.telling = true;
  }

  /** Why the format is what it is. */
  get reason() {
    const rate = this.telling ? `${speed(this.rate)} measured` : "a rate that is still to be measured";
    if (this.pinned !== null) return `${this.pinned} was chosen by hand; ${rate}`;
    const still = this.last[true] ?? "raw",
      moving = this.last[false];
    const both = moving === null || moving === still ? still : `${moving} while dragging, ${still} (lossless) after`;
    return `${both}: the fastest at ${rate}`;
  }
}

/** @param {number} rate in bytes/ms */
export function speed(rate) {
  const bytes = rate * 1000;
  if (bytes >= 1e9) return `${(bytes / 1e9).toPrecision(2)} GB/s`;
  if (bytes >= 1e6) return `${Number((bytes / 1e6).toPrecision(2))} MB/s`;
  return `${Math.max(1, Math.round(bytes / 1e3))} kB/s`;
}
