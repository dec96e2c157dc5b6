// A steered observer in flat space, by its own clock: what keys do to place, 4-velocity and camera. Pure functions.

import {boundedStep, brakeStep, cameraAxes, dopplerFactor, fourVelocity, length, rapidity, scaled, sum, turnedCamera, unit, velocity} from "./relativity.js";

const kTurn = 60; // degrees a second of the own clock

/**
 * @param {{event: number[], velocity: number[]}} observer @param {{azimuth: number, elevation: number, roll: number}} angles
 */
export const begin = (observer, angles) =>
  ({u: fourVelocity(observer.velocity), event: [...observer.event], angles, own: 0, street: 0});

/** Which way the thrust goes, in the observer's axes; [0, 0, 0] for none. `level`: at the same height. */
export function thrust(held, angles, level) {
  const {forward, left, up} = cameraAxes(level ? {azimuth: angles.azimuth, elevation: 0, roll: 0} : angles);
  const along = (plus, minus) => Number(held.has(plus)) - Number(held.has(minus));
  const lift = level ? 0 : along("r", "f");
  return unit(sum(sum(scaled(forward, along("w", "s")), scaled(left, along("q", "e"))), scaled(up, lift)));
}

/**
 * The state `seconds` of the observer's own clock later. The speed of light is `c` scene lengths a second, `acceleration` in
 * lengths/s^2; the scene's own unit of time is a length.
 * @param {Set<string>} held keys: w s q e r f thrust, a d turn, " " brakes to rest
 */
export function advance(state, held, seconds, {c, acceleration, level}) {
  const tau = c * seconds, a = acceleration / (c * c);
  const turn = (Number(held.has("a")) - Number(held.has("d"))) * kTurn * seconds;
  const angles = {...state.angles, azimuth: state.angles.azimuth + turn};
  const n = thrust(held, angles, level), thrusts = length(n) > 0;
  const step = held.has(" ") ? brakeStep(state.u, a, tau) : boundedStep(state.u, thrusts ? n : [1, 0, 0], thrusts ? a : 0, tau);
  return {
    u: step.u,
    event: state.event.map((x, i) => x + step.displacement[i]),
    angles: turnedCamera(angles, step.rotation), // gyroscopes turn against the boosted axes
    own: state.own + seconds,
    street: state.street + step.displacement[0] / c,
  };
}

/** What the instruments show. */
export function readings({u, angles, own, street}) {
  const {forward} = cameraAxes(angles);
  return {beta: Math.tanh(rapidity(u)), gamma: u[0], own, street, ahead: dopplerFactor(u, forward)};
}

/** The numbers of the scene. */
export const asScene = ({u, event, angles}) => ({observer: {event, velocity: velocity(u)}, angles});
