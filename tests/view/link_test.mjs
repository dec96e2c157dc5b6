// Which format pictures come in, by what was measured of the link.
import assert from "node:assert/strict";
import test from "node:test";

import {Link, speed} from "../../apps/view/page/link.js";

const kPixels = 1280 * 1024;
const kDrag = {lossless: false, pixels: kPixels / 4},
  kStill = {lossless: true, pixels: kPixels};

/** `count` answers of `bytes` over a link of `rate` bytes/ms. */
function receive(link, rate, bytes, count = 20) {
  for (let i = 0; i < count; ++i) link.received(bytes, bytes / rate);
}

test("memory's speed: raw", () => {
  const link = new Link("127.0.0.1");
  receive(link, 1e6, 4 * kPixels);
  assert.equal(link.choose(kDrag), "raw");
  assert.equal(link.choose(kStill), "raw");
});

test("a slow link: lossy while dragging, lossless after", () => {
  const link = new Link("127.0.0.1");
  receive(link, 500, 2e5); // 500 kB/s
  assert.ok(["jpeg", "webp"].includes(link.choose(kDrag)));
  assert.equal(link.choose(kStill), "png");
  assert.match(link.reason, /png \(lossless\) after: the fastest at 500 kB\/s measured/);
});

test("small answers tell that a link is slow, never that it is fast", () => {
  const link = new Link("127.0.0.1");
  receive(link, 1e6, 4 * kPixels);
  const before = link.rate;
  receive(link, 100, 4000);
  assert.ok(link.rate < 1000);
  receive(link, 1e6, 4000);
  assert.ok(link.rate < 1000);
  receive(link, 1e6, 4 * kPixels);
  assert.ok(link.rate > before / 2);
});

test("what the user pins holds", () => {
  const link = new Link("127.0.0.1");
  link.pinned = "webp";
  receive(link, 1e6, 4 * kPixels);
  assert.equal(link.choose(kStill), "webp");
  assert.match(link.reason, /^webp was chosen by hand/);
});

test("formats that two measurements tell hardly apart do not take turns", () => {
  const link = new Link("127.0.0.1");
  const chosen = new Set();
  link.rate = 1e6;
  link.telling = true;
  const first = link.choose(kStill);
  for (let i = 0; i < 50; ++i) {
    link.formats.png.encode = 0;
    link.formats.png.decode = 0;
    // Costs are alike, within a tenth.
    link.formats.png.bytes = 4 * (i % 2 === 0 ? 0.95 : 1.05);
    link.formats.raw = {...link.formats.raw, encode: 0, decode: 0};
    chosen.add(link.choose(kStill));
  }
  assert.deepEqual([...chosen], [first]);
});

test("what encoding takes is learnt", () => {
  const link = new Link("127.0.0.1");
  receive(link, 5e4, 4 * kPixels); // 50 MB/s: 105 ms raw
  const frame = {
    format: "png",
    bytes: kPixels / 4,
    width: 1280,
    height: 1024,
    times: {render: 10, encode: 20},
    decoded: 5,
  };
  for (let i = 0; i < 10; ++i) link.measured(frame);
  assert.equal(link.choose(kStill), "png");
  for (let i = 0; i < 20; ++i) link.measured({...frame, times: {render: 10, encode: 300}});
  assert.equal(link.choose(kStill), "raw");
});

test("rates as text", () => {
  assert.equal(speed(1.2e6), "1.2 GB/s");
  assert.equal(speed(86400), "86 MB/s");
  assert.equal(speed(309.4), "309 kB/s");
});
