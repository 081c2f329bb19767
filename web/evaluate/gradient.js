import { networkGradient } from "./network_gradient.js";
import { areaNormal, CLOSEST, closestTo } from "./triangle.js";

/**
 * @typedef {import("./meshes.js").MeshQueries} MeshQueries
 * @typedef {{values: Float32Array, gradients: Float32Array}} Slopes
 */

/** Nearer than this, in radii, float32 does not tell which way a point is off. */
const ON_SURFACE = 1e-6;

/**
 * Signed distances (n) and their gradients (3 n), normalized frame.
 * @param {import("./model.js").NISPModel} model
 * @param {Float32Array} points
 * @returns {Slopes}
 */
export function gradient({ field, meshes }, points) {
  const found = field && networkGradient(field.sdfNetwork, points);
  const other = meshes && meshGradient(meshes, points);
  if (!found || !other) return /** @type {Slopes} */ (found ?? other);
  other.values.forEach((value, i) => {
    if (value >= found.values[i]) return;
    found.values[i] = value;
    found.gradients.set(other.gradients.subarray(3 * i, 3 * i + 3), 3 * i);
  });
  return found;
}

/** On the surface it is the normal. @param {MeshQueries} meshes @param {Float32Array} points @returns {Slopes} */
function meshGradient(meshes, points) {
  const values = meshes.sdf(points);
  const gradients = new Float32Array(points.length);
  values.forEach((value, i) => gradients.set(direction(meshes, points[3 * i], points[3 * i + 1], points[3 * i + 2], value), 3 * i));
  return { values, gradients };
}

/** @param {MeshQueries} meshes @param {number} x @param {number} y @param {number} z @param {number} value */
function direction({ search, triangles }, x, y, z, value) {
  const { corners } = triangles;
  search.closest(x, y, z);
  const at = 9 * search.face;
  if (Math.abs(value) < ON_SURFACE) return outwards(search, areaNormal(corners, at), x, y, z);
  closestTo(corners, at, x, y, z);
  const [a, b, c] = CLOSEST.weights;
  return [x, y, z].map((place, axis) => (place - (a * corners[at + axis] + b * corners[at + 3 + axis] + c * corners[at + 6 + axis])) / value);
}

/** A face's normal, turned where inside is before it, not behind. @param {MeshQueries["search"]} search @param {number[]} normal @param {number} x @param {number} y @param {number} z */
function outwards(search, normal, x, y, z) {
  const length = Math.hypot(...normal) || 1;
  const [u, v, w] = normal.map((part) => part / length);
  const [before, behind] = [ON_SURFACE, -ON_SURFACE].map((step) => search.inside(x + step * u, y + step * v, z + step * w));
  const sign = before && !behind ? -1 : 1;
  return [sign * u, sign * v, sign * w];
}
