// Special relativity for a steered observer: c = 1, u = [gamma, gamma beta] in the static tetrad. Pure functions.
// The observer's axes are the static ones boosted without rotation (docs/scene.md), L(u) e_a.

/** Rapidity beyond which thrust no longer counts: gamma 1490, where no street is left to be seen. */
export const MOST_RAPIDITY = 8;

export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const scaled = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
export const sum = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const length = (a) => Math.hypot(a[0], a[1], a[2]);
export const unit = (a) => {
  const l = length(a);
  return l > 0 ? scaled(a, 1 / l) : [0, 0, 0];
};
const spatial = (u) => [u[1], u[2], u[3]];

/** The 4-velocity whose spatial part is w = gamma beta: its norm is 1 by construction. */
export const withSpatial = (w) => [Math.hypot(1, w[0], w[1], w[2]), ...w];

export function fourVelocity(beta) {
  const speed = length(beta);
  return withSpatial(scaled(beta, 1 / Math.sqrt((1 - speed) * (1 + speed))));
}

export const velocity = (u) => scaled(spatial(u), 1 / u[0]);

/** u.u = 1, with little cancellation. */
export function norm(u) {
  const w = length(spatial(u));
  return (u[0] - w) * (u[0] + w);
}

/** L(u) x: the static components of what has the components x in the rest frame of u. */
export function fromRest(u, x) {
  const w = spatial(u);
  const along = dot(w, spatial(x));
  return [u[0] * x[0] + along, ...sum(spatial(x), scaled(w, x[0] + along / (1 + u[0])))];
}

/** The inverse: components in the rest frame of u. */
export const toRest = (u, x) => fromRest([u[0], -u[1], -u[2], -u[3]], x);

/** The 4-velocity of what moves with d in the rest frame of u. */
export const compose = (u, d) => withSpatial(spatial(fromRest(u, d)));

/**
 * Wigner's rotation R in L(u) L(d) = L(compose(u, d)) R, as axis times tangent of half the angle. With boosts as
 * (1 + gamma + w.sigma)/sqrt(2 + 2 gamma), R is what the product has besides a boost.
 */
export function wignerRotation(u, d) {
  const w = spatial(u), v = spatial(d);
  return scaled(cross(w, v), -1 / ((1 + u[0]) * (1 + d[0]) + dot(w, v)));
}

/** Angle of a rotation that is given as axis times tangent of half the angle. */
export const rotationAngle = (r) => 2 * Math.atan(length(r));

export function rotated(r, x) {
  const turn = cross(r, x);
  return sum(x, scaled(sum(turn, cross(r, turn)), 2 / (1 + dot(r, r))));
}

/**
 * Constant proper acceleration a along the direction n (unit, axes of the rest frame at the start) for the proper
 * time tau: the new 4-velocity, the displacement [t, x, y, z] in the static frame, and Wigner's rotation.
 */
export function hyperbolicStep(u, n, a, tau) {
  const eta = a * tau;
  const d = [Math.cosh(eta), ...scaled(n, Math.sinh(eta))];
  const half = Math.sinh(eta / 2);
  const ahead = Math.abs(eta) < 1e-8 ? 0.5 * eta * tau : (2 * half * half) / a;
  const time = Math.abs(eta) < 1e-8 ? tau : Math.sinh(eta) / a;
  return {
    u: compose(u, d),
    displacement: fromRest(u, [time, ...scaled(n, ahead)]),
    rotation: wignerRotation(u, d),
  };
}

export const rapidity = (u) => Math.asinh(length(spatial(u)));

/** Frequency ratio observed/emitted of what rests in the static frame and is seen in the direction m. */
export const dopplerFactor = (u, m) => 1 / (u[0] - dot(spatial(u), m));

/** Proper acceleration along n cut to what keeps the rapidity below MOST_RAPIDITY; `tau` long. */
export function boundedStep(u, n, a, tau) {
  const step = hyperbolicStep(u, n, a, tau);
  return rapidity(step.u) <= MOST_RAPIDITY || rapidity(step.u) < rapidity(u) ? step : hyperbolicStep(u, n, 0, tau);
}

/** Against the motion with the proper acceleration a for tau: it ends at rest, and stays there. */
export function brakeStep(u, a, tau) {
  const eta = rapidity(u);
  const needed = a > 0 ? eta / a : Infinity;
  const n = scaled(unit(spatial(u)), -1);
  if (needed > tau) return hyperbolicStep(u, n, a, tau);
  const last = hyperbolicStep(u, n, a, needed);
  const rest = tau - needed;
  return {u: [1, 0, 0, 0], displacement: sum4(last.displacement, [rest, 0, 0, 0]), rotation: last.rotation};
}

const sum4 = (a, b) => a.map((x, i) => x + b[i]);

/** Camera axes as scenes have them: azimuth from e1 to e2, elevation towards e3, then roll. Degrees. */
export function cameraAxes({azimuth, elevation, roll}) {
  const [a, e, r] = [azimuth, elevation, roll].map((x) => (x * Math.PI) / 180);
  const forward = [Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e)];
  const level = [-Math.sin(a), Math.cos(a), 0];
  const upright = cross(forward, level);
  return {
    forward,
    left: sum(scaled(level, Math.cos(r)), scaled(upright, Math.sin(r))),
    up: sum(scaled(upright, Math.cos(r)), scaled(level, -Math.sin(r))),
  };
}

export function cameraAngles({forward, left, up}) {
  const degrees = 180 / Math.PI;
  const flat = Math.hypot(forward[0], forward[1]);
  const elevation = Math.atan2(forward[2], flat) * degrees;
  // Straight up or down azimuth and roll are one: all of it is azimuth.
  if (flat < 1e-9) return {azimuth: Math.atan2(-left[0], left[1]) * degrees, elevation, roll: 0};
  return {
    azimuth: Math.atan2(forward[1], forward[0]) * degrees,
    elevation,
    roll: Math.atan2(left[2], up[2]) * degrees,
  };
}

/** The angles of a camera after the rotation r of its axes. */
export function turnedCamera(angles, r) {
  const {forward, left, up} = cameraAxes(angles);
  return cameraAngles({forward: rotated(r, forward), left: rotated(r, left), up: rotated(r, up)});
}
