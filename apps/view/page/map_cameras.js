// Look directions of cameras whose pictures are a circle or faces of a polyhedron (core/base/projections.h and faces.h have
// the same). Components along forward, left and up; pure functions.

import {scaled, sum, unit} from "./relativity.js";

const kRadians = Math.PI / 180;

/** Of the cells of a row: top left corner, and what leads across the cell to the right and down. */
const kCube = [
  [[1, -1, 1], [-2, 0, 0], [0, 0, -2]], [[-1, 1, 1], [2, 0, 0], [0, 0, -2]], [[-1, 1, 1], [0, -2, 0], [2, 0, 0]],
  [[1, 1, -1], [0, -2, 0], [-2, 0, 0]], [[1, 1, 1], [0, -2, 0], [0, 0, -2]], [[-1, -1, 1], [0, 2, 0], [0, 0, -2]],
];

const r2 = Math.SQRT2 / 3, r6 = Math.sqrt(6) / 3;
const [A, B, C, D] = [[1 / 3, r6, -r2], [1 / 3, 0, 2 * r2], [1 / 3, -r6, -r2], [-1, 0, 0]];
const from = (a, b) => sum(b, scaled(a, -1));
/** Below and above the diagonal of the first square, then of the second. */
const kTetrahedron = [
  [B, from(A, C), from(B, A)], [B, from(B, D), from(D, C)], [D, from(C, A), from(D, C)], [D, from(D, B), from(B, A)],
];

const kCells = {cube_map: 6, tetrahedron_map: 2};
export const isMap = (type) => type === "fisheye" || type in kCells;

/** Look direction at picture coordinates (x + dx, y + dy), on the face to which (x, y) belongs. */
function lookAt(type, {fov_deg, resolution: [width, height]}, x, y, dx, dy) {
  if (type === "fisheye") {
    const radius = Math.min(width, height) / 2, l = (width / 2 - x - dx) / radius, u = (height / 2 - y - dy) / radius;
    const distance = Math.hypot(l, u), angle = distance * fov_deg * kRadians / 2, aside = Math.sin(angle) / Math.max(distance, 1e-300);
    return [Math.cos(angle), aside * l, aside * u];
  }
  const cells = kCells[type], across = x * cells / width, cell = Math.min(cells - 1, Math.max(0, Math.floor(across)));
  const faces = cells === 6 ? kCube : kTetrahedron;
  const [corner, right, down] = faces[cells === 6 ? cell : 2 * cell + (across - cell > y / height ? 1 : 0)];
  return unit(sum(corner, sum(scaled(right, across + dx * cells / width - cell), scaled(down, (y + dy) / height))));
}

/** Of the centre of a pixel: the unit look direction, and its changes from pixel to pixel to the right and down. */
export function mapFrame(type, camera, x, y) {
  const at = (dx, dy) => lookAt(type, camera, x + 0.5, y + 0.5, dx, dy), step = 1 / 16;
  const change = (dx, dy) => scaled(from(at(-dx, -dy), at(dx, dy)), 0.5 / step);
  return {look: at(0, 0), right: change(step, 0), down: change(0, step)};
}

/** Radians a pixel, to the left and upwards, straight ahead. */
export function mapAngles(type, {fov_deg, resolution: [width, height]}) {
  if (type === "fisheye") return [0, 0].fill(fov_deg * kRadians / Math.min(width, height));
  return type === "cube_map" ? [2 / height, 2 / height] : [6 * r6 / height, 9 * r2 / height];
}
