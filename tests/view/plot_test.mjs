// Scales, ticks, summaries and the numbers behind bands, drags and steering: node --test tests/view/
import assert from "node:assert/strict";
import test from "node:test";

import * as drive from "../../apps/view/page/drive.js";
import {hitRows, rayRows} from "../../apps/view/page/inspect.js";
import {linearTicks, logTicks, newestWins, scaleOf, text} from "../../apps/view/page/plot.js";
import * as numbers from "../../apps/view/page/scene_numbers.js";
import * as slices from "../../apps/view/page/slices.js";
import {peak, plotRange, summary} from "../../apps/view/page/spectrum_plot.js";
import {reachedRate} from "../../apps/view/page/timeline.js";

const near = (actual, expected, tolerance) => assert.ok(Math.abs(actual - expected) <= tolerance, `${actual} is not ${expected}`);

test("scales run from 0 to the length, and stop there", () => {
  const linear = scaleOf({from: -2, to: 2}, 100), log = scaleOf({from: 1, to: 1e4, kind: "log"}, 100);
  assert.deepEqual([-3, -2, 0, 2, 9].map(linear), [0, 0, 50, 100, 100]);
  [[1, 0], [100, 50], [1e4, 100], [0, 0]].forEach(([x, place]) => near(log(x), place, 1e-9));
});

test("ticks are round, inside, and about as many as asked for", () => {
  assert.deepEqual(linearTicks(380, 750, 5), [400, 500, 600, 700]);
  assert.deepEqual(linearTicks(-0.31, 0.29, 6), [-0.3, -0.2, -0.1, 0, 0.1, 0.2]);
  assert.deepEqual(linearTicks(3, 3), [3]);
  assert.deepEqual(logTicks(0.02, 2000, 8), [0.1, 1, 10, 100, 1000]);
  assert.ok(logTicks(1e-30, 1e30, 5).length <= 6);
});

test("numbers as text keep their digits, and say where there are none", () => {
  assert.equal(text(-0.0123456), "−0.01235");
  assert.equal(text(1.5e9), "1.5e9");
  assert.equal(text(2e-7), "2e−7");
  assert.equal(text(1280), "1280");
  assert.equal(text(null), "not finite");
});

const planck = {object: "earth", g: 0.5, unit: "W", wavelength_nm: [400, 500, 600], emitted: [1, 3, 2], observed: [0, null, 0.5], lines: [{emitted_nm: 300, strength: 2, observed_nm: 600, observed_strength: 1}]};

test("a plot holds all samples and lines, and its summary names the peaks", () => {
  const range = plotRange(planck, false);
  assert.deepEqual([range.x.from, range.x.to, range.y.from], [300, 600, 0]);
  assert.ok(range.y.to > 3);
  assert.ok(plotRange(planck, true).y.from > 0);
  assert.deepEqual(peak([1, 2, 3], [0, 5, 4]), {wavelength_nm: 2, value: 5, edge: false});
  assert.equal(peak([1], [0]), null);
  const words = summary(planck);
  for (const part of ["earth, g 0.5", "greatest at 500 nm, 3 W", "600 nm (end of the plot)", "1 line: 300 nm seen at 600 nm"]) assert.ok(words.includes(part), words);
});

test("time slices: ends do not cross, wholes keep their length, open ends stay open", () => {
  const slice = {channel: "t", from: -2, to: -1, blink: {}};
  assert.deepEqual(slices.moved(slice, "from", -3, 10), {...slice, from: -3});
  assert.ok(slices.moved(slice, "from", 5, 10).from < -1);
  assert.ok(slices.moved(slice, "to", -9, 10).to > -2);
  const both = slices.moved(slice, "both", 0.25, 10);
  assert.deepEqual([both.from, both.to], [-1.75, -0.75]);
  assert.deepEqual(slices.moved({channel: "t", to: 1}, "both", 1, 10), {channel: "t", to: 2});
});

test("fades are written as short as they can be", () => {
  assert.deepEqual(slices.fades({fade: [1, 2]}), [1, 2]);
  assert.deepEqual(slices.fades({fade: 0.5}), [0.5, 0.5]);
  assert.deepEqual(slices.withFades({fade: 1, from: 0}, [0, 0]), {from: 0});
  assert.deepEqual(slices.withFades({}, [1, 1]), {fade: 1});
  assert.deepEqual(slices.withFades({}, [1, 0]), {fade: [1, 0]});
  assert.equal(slices.toHex(slices.fromHex("#12ab7f")), "#12ab7f");
});

test("records: one row a quantity, lamps by path; many rays in sum", () => {
  const rows = hitRows([{object: "a", shift: 0.5, uv: [0.1, null], lights: {sun: [{E: 1, shift: 1, t: 0, tau: 0}]}}, {object: "b", shift: 2}]);
  assert.deepEqual(rows.map(({name}) => name), ["g", "uv", "sun"]);
  assert.deepEqual(rows[0].cells, ["0.5", "2"]);
  assert.equal(rows[1].cells[0], "0.1, not finite");
  assert.equal(rows[2].cells[1], "none");
  const rays = rayRows([{sample: 0, status: "hit", error: 1}, {sample: 1, status: "sky", error: 3}, {sample: 2, status: "hit", error: 2}]);
  assert.deepEqual(rays, [["status", "hit × 2, sky × 1"], ["error, greatest", 3]]);
});

test("only the newest request is made while one is under way", async () => {
  const made = [];
  let release;
  const request = newestWins((n) => (made.push(n), new Promise((done) => (release = done))));
  const first = request(1);
  request(2);
  request(3);
  release();
  await first;
  assert.deepEqual(made, [1, 3]);
});

test("the reached rate is frames by time between the first and the last", () => {
  assert.equal(reachedRate([0, 50, 100]), 20);
  assert.equal(reachedRate([5]), 0);
});

const scene = {metric: {name: "goedel"}, observer: {event: [0, 1, 0, 0]}, camera: {type: "panorama", fov_deg: [360, 180], resolution: [720, 360]},
  objects: [{name: "earth", shape: {type: "sphere", radius: 0.2}, placing: {type: "local", worldline: {type: "static", event: [0, 4, 4, 0]}}},
    {name: "wall", shape: {type: "quad"}, placing: {type: "coordinate", centre: [1, 2, 3]}}, {name: "sky", shape: {type: "sky"}}]};

test("a scene's numbers have their defaults, and the sky has none", () => {
  const all = numbers.sceneNumbers(scene);
  assert.deepEqual(all.metric, {a: 1});
  assert.deepEqual(all.observer, {event: [0, 1, 0, 0], velocity: [0, 0, 0]});
  assert.deepEqual(all.objects, {earth: {event: [0, 4, 4, 0], velocity: [0, 0, 0], radius: 0.2}, wall: {event: [0, 1, 2, 3]}});
  assert.equal(numbers.extent(all), 5);
});

test("a drag turns the camera so that the scene goes with the pointer", () => {
  const {camera} = numbers.sceneNumbers(scene);
  const turned = numbers.lookedRound("panorama", camera, 20, 10);
  near(turned.azimuth_deg, 10, 1e-9);
  near(turned.elevation_deg, 5, 1e-9);
  const flat = {...camera, fov_deg: 90, resolution: [100, 100]};
  near(numbers.lookedRound("perspective", flat, 1, 0).azimuth_deg, (0.02 * 180) / Math.PI, 1e-9);
  const upside = numbers.lookedRound("panorama", {...camera, roll_deg: 180}, 20, 0);
  near(upside.azimuth_deg, -10, 1e-9);
});

test("the frame of a pixel looks where the camera does, and moves as the pixel does", () => {
  for (const [type, fov_deg] of [["perspective", 70], ["panorama", [200, 90]], ["fisheye", 240], ["cube_map"], ["tetrahedron_map"]]) {
    const camera = {azimuth_deg: 30, elevation_deg: 12, roll_deg: 5, fov_deg, resolution: [type === "cube_map" ? 600 : 200, 100]};
    const {look, right, down} = numbers.pixelFrame(type, camera, 150, 20);
    const later = numbers.pixelFrame(type, camera, 150.01, 20).look, below = numbers.pixelFrame(type, camera, 150, 20.01).look;
    for (let i = 0; i < 3; ++i) {
      // In perspective the displacement lies in the picture's plane: what it changes of the length does not show.
      const along = type === "perspective" ? right[0] * look[0] + right[1] * look[1] + right[2] * look[2] : 0;
      const fall = type === "perspective" ? down[0] * look[0] + down[1] * look[1] + down[2] * look[2] : 0;
      near((later[i] - look[i]) / 0.01, right[i] - along * look[i], 1e-5);
      near((below[i] - look[i]) / 0.01, down[i] - fall * look[i], 1e-5);
    }
  }
});

test("on a film an object moves by pixels, however far it is", () => {
  const camera = {azimuth_deg: 0, elevation_deg: 0, roll_deg: 0, extent: 4, resolution: [200, 100]};
  const {look, right, down, parallel} = numbers.pixelFrame("orthographic", camera, 150, 20);
  assert.ok(parallel);
  look.forEach((x, i) => near(x, [1, 0, 0][i], 1e-15));
  right.forEach((x, i) => near(x, [0, -0.02, 0][i], 1e-15));
  down.forEach((x, i) => near(x, [0, 0, -0.02][i], 1e-15));
  const {camera: read} = numbers.sceneNumbers({...scene, camera: {type: "orthographic", resolution: [6, 1], extent: 3}});
  assert.equal(read.extent, 3);
  assert.equal(numbers.lookedRound("orthographic", {...camera, ...read, resolution: [100, 50]}, 10, 0).azimuth_deg.toFixed(6), (0.1 * 180 / Math.PI).toFixed(6));
});

test("maps look where the tracer does", () => {
  const level = {azimuth_deg: 0, elevation_deg: 0, roll_deg: 0}, look = (type, camera, x, y) => numbers.pixelFrame(type, {...level, ...camera}, x, y).look;
  const same = (a, b) => a.forEach((x, i) => near(x, b[i], 1e-12));
  const cube = {resolution: [66, 11]}, centres = [[0, -1, 0], [0, 1, 0], [0, 0, 1], [0, 0, -1], [1, 0, 0], [-1, 0, 0]];
  centres.forEach((centre, face) => same(look("cube_map", cube, 11 * face + 5, 5), centre));
  near(look("cube_map", cube, 27, 10)[0], 10 / Math.hypot(10, 11), 1e-12); // the lower edge of up is the front's
  const dome = {resolution: [31, 21], fov_deg: 180};
  same(look("fisheye", dome, 15, 10), [1, 0, 0]);
  same(look("fisheye", dome, 15, 3), [Math.cos(Math.PI / 3), 0, Math.sin(Math.PI / 3)]);
  const tetrahedron = {resolution: [6, 3]}; // forward lies a third of the way along the first triangle
  same(look("tetrahedron_map", tetrahedron, 0.5, 1.5), [1, 0, 0]);
  near(look("tetrahedron_map", tetrahedron, 2.5, -0.5)[0], -1, 1e-12);
  const aimed = numbers.sceneNumbers({...scene, camera: {type: "cube_map", resolution: [6, 1], forward: [0, 3, 3], up: [1, 0, 0]}}).camera;
  near(aimed.azimuth_deg, 90, 1e-9), near(aimed.elevation_deg, 45, 1e-9), near(aimed.roll_deg, 90, 1e-9);
});

test("drags are traced as finely as is fast enough, without flickering", () => {
  assert.equal(numbers.dragScale(new Map(), 4, 40), 4);
  assert.equal(numbers.dragScale(new Map([[4, 20]]), 4, 40), 4);
  assert.equal(numbers.dragScale(new Map([[4, 6]]), 4, 40), 2);
  assert.equal(numbers.dragScale(new Map([[4, 1], [2, 7]]), 2, 40), 1);
  assert.equal(numbers.dragScale(new Map([[4, 9], [2, 36]]), 4, 40), 4); // not yet clearly faster
  assert.equal(numbers.dragScale(new Map([[4, 9], [2, 36]]), 2, 40), 2);
  assert.equal(numbers.dragScale(new Map([[2, 60]]), 2, 40), 4);
});

test("steering: a second of full thrust from rest is hyperbolic motion in the own clock", () => {
  const settings = {c: 10, acceleration: 5, level: true};
  let state = drive.begin({event: [7, 1, 2, 3], velocity: [0, 0, 0]}, {azimuth: 90, elevation: 30, roll: 0});
  for (let i = 0; i < 60; ++i) state = drive.advance(state, new Set(["w"]), 2 / 60, settings);
  const eta = 1; // a tau / c
  near(state.event[2] - 2, ((Math.cosh(eta) - 1) * 100) / 5, 1e-10);
  near(state.event[0] - 7, (Math.sinh(eta) * 100) / 5, 1e-10);
  near(state.event[3], 3, 1e-12);
  const {beta, gamma, own, street} = drive.readings(state);
  near(beta, Math.tanh(eta), 1e-12);
  near(gamma, Math.cosh(eta), 1e-12);
  near(own, 2, 1e-12);
  near(street, (Math.sinh(eta) * 10) / 5, 1e-12);
});

test("steering: brakes end at rest, turning is by the own clock, thrust aside turns the axes", () => {
  const settings = {c: 1, acceleration: 1, level: true};
  const moving = drive.begin({event: [0, 0, 0, 0], velocity: [0.6, 0, 0]}, {azimuth: 0, elevation: 0, roll: 0});
  assert.deepEqual(drive.advance(moving, new Set([" "]), 5, settings).u, [1, 0, 0, 0]);
  near(drive.advance(moving, new Set(["a"]), 0.5, settings).angles.azimuth, 30, 1e-9);
  const aside = drive.advance(moving, new Set(["q"]), 0.01, settings);
  // Thomas: gamma^2/(gamma + 1) v x dv/dt a second of the street, which is gamma/(gamma + 1) v a a second of the own clock.
  near(aside.angles.azimuth, (-(1.25 / 2.25) * 0.6 * 0.01 * 180) / Math.PI, 1e-5); // steps of 0.01
});
