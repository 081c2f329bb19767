import { NISPError } from "../decoder/errors.js";

/**
 * Triangles of all copies of all parts, in the normalized frame: part after part, copy after copy.
 * @typedef {object} PlacedTriangles
 * @property {Float64Array} corners (9 f) a mirrored copy's triangles turn the other way round
 * @property {Float64Array} uvs (6 f) the asset's; 0 without
 * @property {Int32Array} charts (f) numbered through, from 0 for the first part's first copy
 * @property {Uint8Array} sheet (f)
 * @property {number} chartCount
 */

/** Coordinates, in radii of the asset, whose products are far from what doubles hold. */
const FAR = 1e6;

/**
 * Where a copy has a point of its part, as a function of points of the part's grid.
 * @param {import("../decoder/mesh/part.js").MeshPart} part
 * @param {import("../decoder/mesh/part.js").Placement} placement
 * @returns {(x: number, y: number, z: number, found: Float64Array|Float32Array, at: number) => void}
 */
export function placer({ step, origin }, placement) {
  const [m, offset] = [matrixOf(placement), placement.offset];
  return (x, y, z, found, at) => {
    const [px, py, pz] = [x * step + origin[0], y * step + origin[1], z * step + origin[2]];
    for (let row = 0; row < 3; row++) {
      const place = m[3 * row] * px + m[3 * row + 1] * py + m[3 * row + 2] * pz + offset[row];
      if (!(Math.abs(place) <= FAR)) throw new NISPError("MESH", "placements", `coordinates up to ${FAR}`, place);
      found[at + row] = place;
    }
  };
}

/** Scale, rotation and mirror, row by row (9). @param {import("../decoder/mesh/part.js").Placement} placement */
function matrixOf({ rotation, scale, mirrored }) {
  const length = Math.hypot(...rotation);
  const [w, x, y, z] = rotation.map((part) => part / length);
  const sign = mirrored ? -scale : scale;
  return [
    sign * (1 - 2 * (y * y + z * z)), scale * 2 * (x * y - w * z), scale * 2 * (x * z + w * y),
    sign * 2 * (x * y + w * z), scale * (1 - 2 * (x * x + z * z)), scale * 2 * (y * z - w * x),
    sign * 2 * (x * z - w * y), scale * 2 * (y * z + w * x), scale * (1 - 2 * (x * x + y * y)),
  ];
}

/** The order of a triangle's corners in a copy. @param {boolean} mirrored */
function cornerOrder(mirrored) {
  return mirrored ? [0, 2, 1] : [0, 1, 2];
}

/**
 * @param {import("../decoder/mesh/part.js").MeshPart[]} parts
 * @returns {PlacedTriangles}
 */
export function placedTriangles(parts) {
  const count = parts.reduce((sum, part) => sum + part.faceCharts.length * part.placements.length, 0);
  const all = {
    corners: new Float64Array(9 * count),
    uvs: new Float64Array(6 * count),
    charts: new Int32Array(count),
    sheet: new Uint8Array(count),
    chartCount: 0,
  };
  let face = 0;
  for (const part of parts) {
    for (const placement of part.placements) {
      place(part, placement, all, face);
      face += part.faceCharts.length;
      all.chartCount += part.chartHasUv.length;
    }
  }
  return all;
}

/**
 * One copy, from a face on.
 * @param {import("../decoder/mesh/part.js").MeshPart} part
 * @param {import("../decoder/mesh/part.js").Placement} placement
 * @param {PlacedTriangles} all
 * @param {number} first
 */
function place(part, placement, all, first) {
  const put = placer(part, placement);
  const order = cornerOrder(placement.mirrored);
  const { positions, faces, uvs, uvFaces, uvStep, uvOrigin } = part;
  part.faceCharts.forEach((chart, face) => {
    all.charts[first + face] = all.chartCount + chart;
    all.sheet[first + face] = part.sheet[face];
    order.forEach((from, to) => {
      const vertex = 3 * faces[3 * face + from];
      put(positions[vertex], positions[vertex + 1], positions[vertex + 2], all.corners, 9 * (first + face) + 3 * to);
      const node = uvFaces[3 * face + from];
      for (let axis = 0; axis < 2 && node >= 0; axis++) {
        const value = uvs[2 * node + axis] * uvStep[axis] + uvOrigin[axis];
        all.uvs[6 * (first + face) + 2 * to + axis] = value * placement.uvScale[axis] + placement.uvOffset[axis];
      }
    });
  });
}
