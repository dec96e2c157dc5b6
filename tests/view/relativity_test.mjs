// The steered observer against closed forms: node --test tests/view/
import assert from "node:assert/strict";
import test from "node:test";

import * as sr from "../../apps/view/page/relativity.js";

const near = (actual, expected, tolerance, what) =>
  assert.ok(Math.abs(actual - expected) <= tolerance, `${what ?? ""} ${actual} is not ${expected}`);
const velocities = [[0, 0, 0], [0.8, 0, 0], [0.3, -0.5, 0.2], [0, 0, 0.99], [-0.6, 0.6, 0.5]];
/** mulberry32: the same numbers in every run. */
function random(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

test("velocities become 4-velocities of norm 1 and come back", () => {
  for (const beta of velocities) {
    const u = sr.fourVelocity(beta);
    near(sr.norm(u), 1, 1e-12);
    near(u[0], 1 / Math.sqrt(1 - sr.dot(beta, beta)), 1e-12 * u[0]);
    sr.velocity(u).forEach((b, i) => near(b, beta[i], 1e-15));
  }
});

test("a boost and its inverse give the vector back, and the rest frame's time axis is u", () => {
  for (const beta of velocities) {
    const u = sr.fourVelocity(beta);
    sr.fromRest(u, [1, 0, 0, 0]).forEach((x, i) => near(x, u[i], 1e-14 * u[0]));
    const x = [0.3, -1.2, 0.4, 2];
    sr.toRest(u, sr.fromRest(u, x)).forEach((y, i) => near(y, x[i], 1e-12));
  }
});

test("speeds along a line add by Einstein's law", () => {
  const u = sr.compose(sr.fourVelocity([0.6, 0, 0]), sr.fourVelocity([0.7, 0, 0]));
  near(sr.velocity(u)[0], 1.3 / 1.42, 1e-15);
});

test("constant proper acceleration from rest: x = (cosh a tau - 1)/a, t = sinh(a tau)/a", () => {
  for (const [a, tau, steps] of [[1, 2, 1000], [0.01, 50, 300], [3, 1, 7]]) {
    let u = [1, 0, 0, 0];
    const place = [0, 0, 0, 0];
    for (let i = 0; i < steps; ++i) {
      const step = sr.hyperbolicStep(u, [0.6, 0.8, 0], a, tau / steps);
      u = step.u;
      step.displacement.forEach((d, k) => (place[k] += d));
    }
    const x = (Math.cosh(a * tau) - 1) / a;
    near(place[1], 0.6 * x, 1e-12 * x);
    near(place[2], 0.8 * x, 1e-12 * x);
    near(place[0], Math.sinh(a * tau) / a, 1e-12 * place[0]);
    near(u[0], Math.cosh(a * tau), 1e-12 * u[0]);
  }
});

test("a step without acceleration is gamma tau (1, beta), and small ones go over into it", () => {
  const u = sr.fourVelocity([0.3, 0.4, 0]);
  for (const a of [0, 1e-12])
    sr.hyperbolicStep(u, [0, 0, 1], a, 2).displacement.forEach((d, i) => near(d, 2 * u[i], 1e-11));
});

test("whatever is pressed, the speed stays below 1 and the norm 1", () => {
  const next = random(7);
  let u = [1, 0, 0, 0], fastest = 0;
  for (let i = 0; i < 20000; ++i) {
    const n = sr.unit([next() - 0.3, next() - 0.4, next() - 0.5]);
    u = sr.boundedStep(u, n, 40 * next(), 0.1).u;
    const speed = sr.length(sr.velocity(u));
    assert.ok(speed < 1, `speed ${speed} after ${i} steps`);
    near(sr.norm(u), 1, 1e-15 * u[0] * u[0]);  // the rounding of gamma itself
    fastest = Math.max(fastest, sr.rapidity(u));
  }
  assert.ok(fastest > sr.MOST_RAPIDITY - 4 && fastest <= sr.MOST_RAPIDITY);
});

test("braking ends at rest after rapidity/a, and not beyond", () => {
  const u = sr.fourVelocity([0.5, 0.2, -0.1]);
  const eta = sr.rapidity(u);
  near(sr.brakeStep(u, 2, eta / 4).u[0], Math.cosh(eta / 2), 1e-14);
  const done = sr.brakeStep(u, 2, eta);
  assert.deepEqual(done.u, [1, 0, 0, 0]);
  near(done.displacement[0], Math.sinh(eta) / 2 + eta / 2, 1e-14);
  near(sr.length(done.displacement.slice(1)), (Math.cosh(eta) - 1) / 2, 1e-14);
  near(sr.length(done.rotation), 0, 1e-15);
});

test("Wigner's rotation is what two boosts have besides their boost", () => {
  const next = random(3);
  for (let i = 0; i < 200; ++i) {
    const draw = () => sr.fourVelocity(sr.scaled(sr.unit([next() - 0.5, next() - 0.5, next() - 0.5]), 0.98 * next()));
    const u = draw(), d = draw(), r = sr.wignerRotation(u, d), both = sr.compose(u, d);
    for (const x of [[1, 0, 0], [0, 1, 0], [0, 0, 1]]) {
      const expected = sr.toRest(both, sr.fromRest(u, sr.fromRest(d, [0, ...x])));
      near(expected[0], 0, 1e-10);
      sr.rotated(r, x).forEach((y, k) => near(y, expected[k + 1], 1e-10));
    }
  }
});

test("perpendicular boosts: cos of the angle is (g1 + g2)/(1 + g1 g2), about -w1 x w2", () => {
  for (const [b1, b2] of [[0.5, 0.5], [0.8, 0.6], [0.99, 0.3], [1e-4, 1e-4]]) {
    const u = sr.fourVelocity([b1, 0, 0]), d = sr.fourVelocity([0, b2, 0]);
    const r = sr.wignerRotation(u, d), angle = sr.rotationAngle(r);
    near(Math.sin(angle), (u[0] * d[0] * b1 * b2) / (1 + u[0] * d[0]), 1e-14);
    near(Math.cos(angle), (u[0] + d[0]) / (1 + u[0] * d[0]), 1e-14);
    assert.ok(r[2] < 0 && r[0] === 0 && r[1] === 0);
  }
});

test("a circle turns gyroscopes by -2 pi (gamma - 1) a turn (Thomas)", () => {
  for (const beta of [0.1, 0.6, 0.9]) {
    const steps = 20000, at = (i) => sr.fourVelocity([beta * Math.cos((2 * Math.PI * i) / steps), beta * Math.sin((2 * Math.PI * i) / steps), 0]);
    let angle = 0;
    for (let i = 0; i < steps; ++i) angle += 2 * Math.atan(sr.wignerRotation(at(i), sr.toRest(at(i), at(i + 1)))[2]);
    const gamma = at(0)[0];
    near(angle, -2 * Math.PI * (gamma - 1), 1e-6 * gamma * gamma);
  }
});

test("the camera turns with Thomas: azimuth by the angle in the plane, no roll", () => {
  const before = { azimuth: 20, elevation: 7, roll: 0 };
  const r = sr.wignerRotation(sr.fourVelocity([0.6, 0, 0]), sr.fourVelocity([0, 0.5, 0]));
  const after = sr.turnedCamera(before, r);
  near(after.azimuth, 20 - (sr.rotationAngle(r) * 180) / Math.PI, 1e-12);
  near(after.elevation, 7, 1e-12);
  near(after.roll, 0, 1e-12);
});

test("camera angles and axes are each other's inverse", () => {
  for (const angles of [{ azimuth: 130, elevation: -40, roll: 25 }, { azimuth: -170, elevation: 80, roll: -120 }]) {
    const back = sr.cameraAngles(sr.cameraAxes(angles));
    for (const key of ["azimuth", "elevation", "roll"]) near(back[key], angles[key], 1e-10, key);
  }
  const { forward, left, up } = sr.cameraAxes({ azimuth: 90, elevation: 0, roll: 0 });
  [...forward, ...left, ...up].forEach((x, i) => near(x, [0, 1, 0, -1, 0, 0, 0, 0, 1][i], 1e-15));
});

test("Doppler factor: sqrt((1+b)/(1-b)) ahead, its inverse behind, 1/gamma across", () => {
  const u = sr.fourVelocity([0.8, 0, 0]);
  near(sr.dopplerFactor(u, [1, 0, 0]), 3, 1e-14);
  near(sr.dopplerFactor(u, [-1, 0, 0]), 1 / 3, 1e-15);
  near(sr.dopplerFactor(u, [0, 1, 0]), 0.6, 1e-15);
});
