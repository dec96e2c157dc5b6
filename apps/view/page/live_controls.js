// The numbers of a live scene as controls.

import {html} from "./plot.js";
import {extent} from "./scene_numbers.js";
import {numberControl} from "./widgets.js";

/** @param {import("./live.js").Live} live */
export function liveControls(live) {
  const {scene} = live, {metric, camera, objects} = scene.base;
  const far = extent(scene.base), all = [];
  const number = (pointer, label, options) => {
    const control = sceneNumber(scene, pointer, label, options);
    all.push(control);
    return control;
  };
  const group = (title, ...controls) => html("fieldset", {}, html("legend", {}, title), ...controls);
  const event = (at, pointer) => ["t", "x", "y", "z"].map((name, i) =>
    pointer !== "/observer" && !scene.get(`${pointer}/velocity`) && i === 0 ? null : number(`${pointer}/event/${i}`, name, {min: at[i] - far, max: at[i] + far}));
  const velocity = (pointer) => ["x", "y", "z"].map((name, i) =>
    number(`${pointer}/velocity/${i}`, `Velocity ${name}`, {min: -0.99, max: 0.99, least: -0.9999999, most: 0.9999999}));

  const element = html("div", {},
    group("Observer", ...event(scene.base.observer.event, "/observer"), ...velocity("/observer"), pace(live)),
    group("Camera",
      number("/camera/azimuth_deg", "Azimuth", {min: -180, max: 180, unit: "°"}),
      number("/camera/elevation_deg", "Elevation", {min: -90, max: 90, least: -90, most: 90, unit: "°"}),
      number("/camera/roll_deg", "Roll", {min: -180, max: 180, unit: "°"}),
      ...fields(camera, number),
      number("/camera/resolution/0", "Width", {min: 64, max: 4096, least: 16, whole: true, slider: false, unit: "px"}),
      number("/camera/resolution/1", "Height", {min: 64, max: 4096, least: 16, whole: true, slider: false, unit: "px"})),
    ...(Object.keys(metric).length > 0 ? [group("Spacetime", ...Object.keys(metric).map((name) =>
      number(`/metric/${name}`, name, {min: metric[name] / 10, max: metric[name] * 10, least: 1e-6, scale: "log"})))] : []));

  for (const [name, numbers] of Object.entries(objects)) {
    // Of many objects few are opened: controls are made then.
    const details = html("details", {class: "live-object"}, html("summary", {}, name));
    details.addEventListener("toggle", () => {
      const pointer = `/objects/${name}`;
      details.append(...event(numbers.event, pointer).filter(Boolean), ...(numbers.velocity ? velocity(pointer) : []),
        ...(numbers.radius ? [number(`${pointer}/radius`, "Radius", {min: numbers.radius / 10, max: numbers.radius * 10, least: 1e-9, scale: "log"})] : []));
      all.forEach((control) => control.update());
    }, {once: true});
    element.append(details);
  }
  const update = () => all.forEach((control) => control.update());
  scene.addEventListener("change", update);
  update();
  return element;
}

function fields({fov_deg, extent: film}, number) {
  if (film !== undefined) return [number("/camera/extent", "Extent", {min: film / 10, max: film * 10, least: 1e-9, scale: "log"})];
  const range = {min: 1, max: 179, least: 0.001, most: 360, unit: "°"};
  if (fov_deg === undefined) return [];
  if (typeof fov_deg === "number") return [number("/camera/fov_deg", "Field of view", range)];
  return [number("/camera/fov_deg/0", "Field of view", {...range, max: 360}), number("/camera/fov_deg/1", "Its height", {...range, max: 180})];
}

/** In lengths a second. */
function pace(live) {
  const {hand} = live, value = hand.pace;
  const control = numberControl({label: "Pace of keys", value, min: value / 20, max: value * 20, scale: "log", digits: 3,
    reset: () => take(value), onInput: (x) => take(x)});
  const take = (x) => {
    control.value = hand.pace = x;
    control.changed?.(x !== value);
  };
  take(value);
  return control;
}

function sceneNumber(scene, pointer, label, options) {
  const control = numberControl({label, pointer, digits: 6, value: scene.get(pointer), ...options,
    reset: () => scene.reset(pointer), onInput: (x) => scene.set(pointer, x, {live: true}), onChange: (x) => scene.set(pointer, x)});
  control.update = () => {
    control.value = scene.get(pointer);
    control.changed?.(scene.differs(pointer));
  };
  return control;
}
