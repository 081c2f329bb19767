/**
 * A triangle as seen from a point: where it is closest, and how large it looks. What two triangles
 * share gives both the same distance to the last bit, so that numbers decide between them.
 */

/** The squared distance that closestTo found, and the weights of the corners there. */
export const CLOSEST = { squared: 0, weights: new Float64Array(3) };

/** Corners as seen from the point (9), their squared distances (3). */
const ways = new Float64Array(9);
const corners = new Float64Array(3);

/**
 * Finds the closest point of a triangle.
 * @param {Float64Array} all corners of triangles (9 f) @param {number} at the triangle's
 * @param {number} x @param {number} y @param {number} z
 */
export function closestTo(all, at, x, y, z) {
  CLOSEST.squared = Infinity;
  for (let i = 0; i < 9; i += 3) {
    ways[i] = all[at + i] - x;
    ways[i + 1] = all[at + i + 1] - y;
    ways[i + 2] = all[at + i + 2] - z;
    corners[i / 3] = product(ways, i, ways, i);
  }
  for (let i = 0; i < 3; i++) toEdge(i, (i + 1) % 3);
  toInside();
}

/** @param {Float64Array} a @param {number} i @param {Float64Array} b @param {number} j */
function product(a, i, b, j) {
  return a[i] * b[j] + a[i + 1] * b[j + 1] + a[i + 2] * b[j + 2];
}

const edge = new Float64Array(3);
const both = new Float64Array(3);

/** From the edge's middle, so that it does not matter which end is the start. @param {number} start @param {number} end corners */
function toEdge(start, end) {
  for (let axis = 0; axis < 3; axis++) {
    edge[axis] = ways[3 * end + axis] - ways[3 * start + axis];
    both[axis] = ways[3 * end + axis] + ways[3 * start + axis];
  }
  const inverse = 1 / product(edge, 0, edge, 0);
  const along = inverse < Infinity ? Math.min(Math.max(-product(both, 0, edge, 0) * inverse, -1), 1) : 0;
  for (let axis = 0; axis < 3; axis++) both[axis] += edge[axis] * along;
  const squared = along <= -1 ? corners[start] : along >= 1 ? corners[end] : product(both, 0, both, 0) / 4;
  if (squared >= CLOSEST.squared) return;
  CLOSEST.squared = squared;
  CLOSEST.weights.fill(0);
  CLOSEST.weights[start] = (1 - along) / 2;
  CLOSEST.weights[end] = (1 + along) / 2;
}

const ab = new Float64Array(3);
const ac = new Float64Array(3);

function toInside() {
  for (let axis = 0; axis < 3; axis++) {
    ab[axis] = ways[3 + axis] - ways[axis];
    ac[axis] = ways[6 + axis] - ways[axis];
  }
  const [bb, bc, cc] = [product(ab, 0, ab, 0), product(ab, 0, ac, 0), product(ac, 0, ac, 0)];
  const area = bb * cc - bc * bc;
  if (!(area > 0)) return;
  const [b, c] = [-product(ways, 0, ab, 0), -product(ways, 0, ac, 0)];
  const [v, w] = [(cc * b - bc * c) / area, (bb * c - bc * b) / area];
  if (!(v > 0 && w > 0 && v + w < 1)) return;
  for (let axis = 0; axis < 3; axis++) both[axis] = ways[axis] + ab[axis] * v + ac[axis] * w;
  const squared = product(both, 0, both, 0);
  if (squared >= CLOSEST.squared) return;
  CLOSEST.squared = squared;
  CLOSEST.weights[0] = 1 - v - w;
  CLOSEST.weights[1] = v;
  CLOSEST.weights[2] = w;
}

/**
 * The signed angle that a triangle fills, 4 pi all around; 0 from its plane (Van Oosterom and
 * Strackee 1983).
 * @param {Float64Array} all @param {number} at @param {number} x @param {number} y @param {number} z
 */
export function solidAngle(all, at, x, y, z) {
  const [ax, ay, az] = [all[at] - x, all[at + 1] - y, all[at + 2] - z];
  const [bx, by, bz] = [all[at + 3] - x, all[at + 4] - y, all[at + 5] - z];
  const [cx, cy, cz] = [all[at + 6] - x, all[at + 7] - y, all[at + 8] - z];
  const volume = ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx);
  if (volume === 0) return 0;
  const a = Math.sqrt(ax * ax + ay * ay + az * az);
  const b = Math.sqrt(bx * bx + by * by + bz * bz);
  const c = Math.sqrt(cx * cx + cy * cy + cz * cz);
  const rest = (ax * bx + ay * by + az * bz) * c + (bx * cx + by * cy + bz * cz) * a + (cx * ax + cy * ay + cz * az) * b;
  return 2 * Math.atan2(volume, a * b * c + rest);
}

/** A triangle's normal, as long as twice its area. @param {Float64Array} all @param {number} at @returns {number[]} */
export function areaNormal(all, at) {
  const [ux, uy, uz] = [all[at + 3] - all[at], all[at + 4] - all[at + 1], all[at + 5] - all[at + 2]];
  const [vx, vy, vz] = [all[at + 6] - all[at], all[at + 7] - all[at + 1], all[at + 8] - all[at + 2]];
  return [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
}
