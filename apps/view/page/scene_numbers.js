// The numbers of a scene that tracing may change, and how the camera looks at them. Pure functions.

import {isMap, mapAngles, mapFrame} from "./map_cameras.js";
import {cameraAngles, cameraAxes, cross, dot, scaled, sum, unit} from "./relativity.js";

const kMetric = {goedel: {a: 1}}; // what a scene may leave out
const kRadians = Math.PI / 180;

/** Those of one object, or null where it has no place (a sky), or one of its own. */
function objectNumbers({shape, placing}) {
  if (!placing) return null;
  const out = {};
  if (placing.type === "coordinate") {
    out.event = [0, ...placing.centre];
  } else {
    const {type, event, velocity = [0, 0, 0]} = placing.worldline;
    if (type !== "static" && type !== "geodesic") return null; // a way that is not to be steered
    Object.assign(out, {event: [...event], velocity: [...velocity]});
  }
  if (shape.type === "sphere") out.radius = shape.radius;
  return out;
}

/** The angles of a camera, also of one that is given by directions. */
function cameraOrientation({azimuth_deg = 0, elevation_deg = 0, roll_deg = 0, forward, up = [0, 0, 1]}) {
  if (!forward) return {azimuth_deg, elevation_deg, roll_deg};
  const ahead = unit(forward), left = unit(cross(unit(up), ahead));
  return fromAngles(cameraAngles({forward: ahead, left, up: cross(ahead, left)}));
}

/** In the form of the changes that api/trace takes, with all that may be changed. @param {object} scene */
export function sceneNumbers(scene) {
  const {name, ...given} = scene.metric;
  const metric = {...kMetric[name]};
  for (const [key, value] of Object.entries(given)) if (typeof value === "number") metric[key] = value;
  const {event, velocity = [0, 0, 0]} = scene.observer;
  const {fov_deg, extent: film, resolution} = scene.camera, {azimuth_deg, elevation_deg, roll_deg} = cameraOrientation(scene.camera);
  const objects = {};
  for (const object of scene.objects) {
    const numbers = objectNumbers(object);
    if (numbers) objects[object.name] = numbers;
  }
  const camera = {azimuth_deg, elevation_deg, roll_deg, resolution: [...resolution]};
  if (fov_deg !== undefined) camera.fov_deg = fov_deg;
  if (film !== undefined) camera.extent = film;
  return {metric, observer: {event: [...event], velocity: [...velocity]}, camera, objects};
}

/** Lengths that are far in this scene: for the range of sliders and the pace of keys. */
export function extent(numbers) {
  const at = numbers.observer.event;
  const far = Object.values(numbers.objects).map(({event}) => Math.hypot(...[1, 2, 3].map((i) => event[i] - at[i])));
  const seen = far.filter((x) => x > 0);
  return seen.length > 0 ? Math.max(...seen) : 1;
}

export const angles = ({azimuth_deg, elevation_deg, roll_deg}) => ({azimuth: azimuth_deg, elevation: elevation_deg, roll: roll_deg});
export const fromAngles = ({azimuth, elevation, roll}) => ({azimuth_deg: tidy(azimuth), elevation_deg: tidy(elevation), roll_deg: tidy(roll)});

/** Without the last digits, which are rounding; azimuths within half a turn. */
export function tidy(degrees) {
  const turned = degrees - 360 * Math.round(degrees / 360);
  return Math.abs(turned) < 1e-9 ? 0 : Number(turned.toFixed(9));
}

/** Radians a pixel of the picture, to the left and upwards, at its centre; of a film, as seen from as far as it is wide. */
export function pixelAngles(type, {fov_deg, resolution: [width, height]}) {
  if (isMap(type)) return mapAngles(type, {fov_deg, resolution: [width, height]});
  if (type === "orthographic") return [1 / width, 1 / width];
  if (type === "sphere") return [2 * Math.PI / width, Math.PI / height];
  if (type === "panorama") return [fov_deg[0] * kRadians / width, fov_deg[1] * kRadians / height];
  const both = 2 * Math.tan(fov_deg * kRadians / 2) / width;
  return [both, both];
}

/** The camera after its picture was dragged by so many of its pixels, to the right and down. */
export function lookedRound(type, camera, dx, dy) {
  const [across, along] = pixelAngles(type, camera), {azimuth, elevation, roll} = angles(camera);
  const a = dx * across, b = dy * along, c = Math.cos(roll * kRadians), s = Math.sin(roll * kRadians);
  const level = Math.max(Math.cos(elevation * kRadians), 0.2);
  const turned = {azimuth: azimuth + (a * c - b * s) / level / kRadians, elevation: elevation + (a * s + b * c) / kRadians, roll};
  turned.elevation = Math.min(90, Math.max(-90, turned.elevation));
  return {...camera, ...fromAngles(turned)};
}

/**
 * Unit look direction of a pixel, and the displacements at the distance 1 (of a film, where rays are `parallel`, at any) that move
 * by one pixel right and down.
 */
export function pixelFrame(type, camera, x, y) {
  const {forward, left, up} = cameraAxes(angles(camera)), [across, along] = pixelAngles(type, camera);
  const inFrame = (v) => sum(scaled(forward, v[0]), sum(scaled(left, v[1]), scaled(up, v[2])));
  if (isMap(type)) {
    const {look, right, down} = mapFrame(type, camera, x, y);
    return {look: inFrame(look), right: inFrame(right), down: inFrame(down)};
  }
  if (type === "orthographic") {
    const step = -camera.extent / camera.resolution[0];
    return {look: forward, right: scaled(left, step), down: scaled(up, step), parallel: true};
  }
  const [width, height] = camera.resolution, h = (width / 2 - x - 0.5) * across, v = (height / 2 - y - 0.5) * along;
  if (type === "perspective") {
    const look = unit(sum(forward, sum(scaled(left, h), scaled(up, v))));
    const depth = dot(look, forward);
    return {look, right: scaled(left, -across * depth), down: scaled(up, -along * depth)};
  }
  const look = sum(scaled(sum(scaled(forward, Math.cos(h)), scaled(left, Math.sin(h))), Math.cos(v)), scaled(up, Math.sin(v)));
  const aside = sum(scaled(forward, -Math.sin(h)), scaled(left, Math.cos(h)));
  return {look, right: scaled(aside, -across * Math.cos(v)), down: scaled(cross(look, aside), -along)};
}

/**
 * How coarse to trace for `most` ms a frame: of 1, 2 and 4 the finest that is fast enough, by the ms a frame of each scale took
 * last (or what others tell of it). It stays as it is while that is about right.
 * @param {Map<number, number>} took ms by scale
 */
export function dragScale(took, present, most) {
  const guess = (scale) => {
    if (took.has(scale)) return took.get(scale);
    const known = [2, 4, 1].find((other) => took.has(other));
    return known === undefined ? Infinity : took.get(known) * (known / scale) ** 2;
  };
  const fits = (scale) => guess(scale) <= (scale < present ? 0.8 : 1) * most;
  return [1, 2].find(fits) ?? 4;
}
