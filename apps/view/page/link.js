// How pictures come over the link between page and server: what each format would take, from what was measured, and so
// which one is the fastest.

/** To begin with: bytes a pixel, and ms a million pixels to encode and to decode. */
const kFormats = {
  raw: {bytes: 4, encode: 1, decode: 2, lossless: true},
  png: {bytes: 1, encode: 30, decode: 20, lossless: true},
  jpeg: {bytes: 0.3, encode: 6, decode: 8, lossless: false},
  webp: {bytes: 0.15, encode: 60, decode: 12, lossless: false},
};
const kLocal = 4e5, kRemote = 5e3; // bytes/ms before anything was measured
const kTelling = 2e4;              // bytes from which an answer tells the link's speed
const kHold = 0.85;                // another format must be that much faster

const mean = (before, now, share = 0.3) => (1 - share) * before + share * now;

export class Link {
  /** @param {string} host */
  constructor(host) {
    const local = /^(localhost|127\..*|\[::1\])$/.test(host);
    this.rate = local ? kLocal : kRemote; // bytes/ms
    this.latency = 0;                     // ms to and fro, without work
    this.serverTime = 0;                  // ms of work a frame
    this.pinned = null;                   // the user's own choice
    this.formats = structuredClone(kFormats);
    this.last = {true: null, false: null};
    this.telling = false;                 // whether the rate was measured
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

  /** @param {{format: string, bytes: number, width: number, height: number, times: object, ms: number}} frame */
  measured(frame) {
    const {format, bytes, times} = frame;
    const known = this.formats[format];
    if (known === undefined) return;
    const pixels = frame.width * frame.height;
    const encode = times.encode ?? 0;
    const work = Object.values(times).reduce((sum, ms) => sum + ms, 0);
    known.bytes = mean(known.bytes, bytes / pixels);
    known.encode = mean(known.encode, (encode / pixels) * 1e6);
    this.serverTime = this.serverTime === 0 ? work : mean(this.serverTime, work);
    const way = Math.max(frame.arrived - work, 0.2);
    if (bytes < kTelling) {
      this.latency = this.latency === 0 ? way : Math.min(this.latency, way);
      return;
    }
    const rate = bytes / Math.max(way - this.latency, 0.2);
    this.rate = this.telling ? mean(this.rate, rate) : rate;
    this.telling = true;
    if (frame.decoded !== undefined) known.decode = mean(known.decode, (frame.decoded / pixels) * 1e6);
  }

  /** Why the format is what it is. */
  get reason() {
    const rate = `${speed(this.rate)} measured`;
    if (this.pinned !== null) return `${this.pinned} was chosen by hand; ${rate}`;
    const still = this.last[true] ?? "raw", moving = this.last[false];
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
