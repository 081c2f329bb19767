import { cornerOrder, matrixOf, placer } from "../evaluate/placed.js";
import { EXTRACTION } from "./config.js";
import { DisjointSets } from "./groups.js";

/**
 * @typedef {import("../decoder/mesh/part.js").MeshPart} MeshPart
 * @typedef {import("../decoder/mesh/part.js").Placement} Placement
 * @typedef {object} SplitPart a part with one vertex for each position, normal and texture coordinate that meet
 * @property {Int32Array} vertices (3 m) of the corners
 * @property {number[]} sources a corner of each vertex
 * @property {Float64Array} normals (3 v) unit, in the part's frame
 */

/**
 * All copies of all mesh parts as one mesh: triangles, seams and creases as the file has them.
 * @param {import("../decoder/document.js").Document} document
 * @returns {import("./mesh.js").MeshData}
 */
export function partsMesh(document) {
  const split = document.parts.map(splitPart);
  const copies = document.parts.map((part) => part.placements.length);
  const count = split.reduce((sum, { sources }, i) => sum + sources.length * copies[i], 0);
  const mesh = { positions: new Float32Array(3 * count), normals: new Float32Array(3 * count), uvs: new Float32Array(2 * count), charts: new Float32Array(count) };
  const grouped = new GroupedFaces(document);
  let [vertex, chart] = [0, document.metadata.charts];
  document.parts.forEach((part, i) => {
    for (const placement of part.placements) {
      putVertices(part, placement, split[i], mesh, vertex, chart);
      grouped.add(part, placement, split[i].vertices, vertex, chart);
      vertex += split[i].sources.length;
      chart += part.chartHasUv.length;
    }
  });
  return { ...mesh, ...grouped.finish(), dropped: 0 };
}

/** @param {MeshPart} part @returns {SplitPart} */
function splitPart(part) {
  const { faces, uvFaces, faceCharts } = part;
  const smooth = smoothGroups(part);
  const sums = normalSums(part, smooth);
  /** @type {Map<number, number>} */
  const numbers = new Map();
  /** @type {number[]} */
  const sources = [];
  const most = 2 * faces.length;
  const vertices = faces.map((_, corner) => {
    // A texture coordinate is of one chart.
    const look = uvFaces[corner] >= 0 ? uvFaces[corner] : faces.length + faceCharts[Math.floor(corner / 3)];
    const key = smooth[corner] * most + look;
    let number = numbers.get(key);
    if (number === undefined) {
      number = sources.push(corner) - 1;
      numbers.set(key, number);
    }
    return number;
  });
  const normals = new Float64Array(3 * sources.length);
  sources.forEach((corner, i) => normals.set(sums.subarray(3 * smooth[corner], 3 * smooth[corner] + 3), 3 * i));
  return { vertices, sources, normals };
}

/** A number for the corners (3 m) at a vertex that no crease parts. @param {MeshPart} part */
function smoothGroups(part) {
  const { faces } = part;
  const pairs = sidePairs(faces);
  const cosines = pairCosines(part, pairs);
  const creases = part.creases.some(Boolean) ? part.creases : sharpSides(faces.length, pairs, cosines);
  const others = new Int32Array(faces.length);
  for (const [mine] of pairs) others[mine]++;
  const sets = new DisjointSets(faces.length);
  pairs.forEach(([mine, other], i) => {
    // Of several sheets in one edge those go on into each other that face one way.
    if (creases[mine] || creases[other] || (others[mine] > 1 && cosines[i] <= 0)) return;
    const [first, second] = faces[mine] === faces[other] ? [other, sideAfter(other)] : [sideAfter(other), other];
    sets.join(mine, first);
    sets.join(sideAfter(mine), second);
  });
  return sets.labels().labels;
}

/** All pairs of sides of one edge, both ways, but of faces back to back. @param {Int32Array} faces @returns {[number, number][]} */
function sidePairs(faces) {
  /** @type {Map<number, number[]>} */
  const edges = new Map();
  faces.forEach((vertex, side) => {
    const other = faces[sideAfter(side)];
    const key = Math.min(vertex, other) * 2 ** 26 + Math.max(vertex, other);
    const sides = edges.get(key);
    if (sides) sides.push(side);
    else edges.set(key, [side]);
  });
  /** @type {[number, number][]} */
  const pairs = [];
  for (const sides of edges.values()) {
    for (let turn = 1; turn < Math.min(sides.length, EXTRACTION.edgeSides); turn++) {
      sides.forEach((mine, i) => {
        const other = sides[(i + turn) % sides.length];
        if (faces[sideAfter(mine, 2)] !== faces[sideAfter(other, 2)]) pairs.push([mine, other]);
      });
    }
  }
  return pairs;
}

/** Of the normals of both faces; 0 where one has no area. @param {MeshPart} part @param {[number, number][]} pairs */
function pairCosines({ faces, positions }, pairs) {
  const normals = Array.from({ length: faces.length / 3 }, (_, face) => faceNormal(faces, positions, 3 * face));
  const lengths = normals.map((normal) => Math.hypot(...normal));
  return pairs.map(([mine, other]) => {
    const [one, two] = [Math.floor(mine / 3), Math.floor(other / 3)];
    return dot(normals[one], normals[two]) / (lengths[one] * lengths[two] || 1);
  });
}

/** Sides where the surface turns sharply, for parts that say nothing about creases. @param {number} count @param {[number, number][]} pairs @param {number[]} cosines */
function sharpSides(count, pairs, cosines) {
  const sharp = new Uint8Array(count);
  for (const [mine] of pairs) sharp[mine] = 1;
  pairs.forEach(([mine], i) => {
    if (cosines[i] >= EXTRACTION.smoothCosine) sharp[mine] = 0;
  });
  return sharp;
}

/** The side of the same face so many steps on. @param {number} side @param {number} [steps] 1 or 2 */
function sideAfter(side, steps = 1) {
  const place = side % 3;
  return side - place + ((place + steps) % 3);
}

/** @param {number[]} a @param {number[]} b */
function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

/** As long as twice the face's area, in units of the grid. @param {Int32Array} faces @param {Int32Array} positions @param {number} corner the face's first */
function faceNormal(faces, positions, corner) {
  const at = (/** @type {number} */ i, /** @type {number} */ axis) => positions[3 * faces[corner + i] + axis];
  const [u, v] = [1, 2].map((i) => [0, 1, 2].map((axis) => at(i, axis) - at(0, axis)));
  return cross(u, v);
}

/** Normals of groups of corners, weighted by area times angle, of unit length; +z where they cancel. @param {MeshPart} part @param {Int32Array} groups */
function normalSums({ faces, positions }, groups) {
  const sums = new Float64Array(3 * faces.length);
  for (let corner = 0; corner < faces.length; corner += 3) {
    const normal = faceNormal(faces, positions, corner);
    for (let i = 0; i < 3; i++) {
      const share = angleAt(faces, positions, corner + i);
      normal.forEach((value, axis) => (sums[3 * groups[corner + i] + axis] += share * value));
    }
  }
  for (let i = 0; i < sums.length; i += 3) {
    const length = Math.hypot(sums[i], sums[i + 1], sums[i + 2]);
    if (!length) sums[i + 2] = 1;
    for (let axis = 0; axis < 3 && length; axis++) sums[i + axis] /= length;
  }
  return sums;
}

/** A face's angle at a corner: however a flat surface is cut into triangles, it counts the same. @param {Int32Array} faces @param {Int32Array} positions @param {number} corner */
function angleAt(faces, positions, corner) {
  const [u, v] = [1, 2].map((steps) =>
    [0, 1, 2].map((axis) => positions[3 * faces[sideAfter(corner, steps)] + axis] - positions[3 * faces[corner] + axis]),
  );
  return Math.atan2(Math.hypot(...cross(u, v)), dot(u, v));
}

/**
 * The vertices of one copy, from `first` on.
 * @param {MeshPart} part @param {Placement} placement @param {SplitPart} split
 * @param {{positions: Float32Array, normals: Float32Array, uvs: Float32Array, charts: Float32Array}} mesh
 * @param {number} first @param {number} chart the copy's first
 */
function putVertices(part, placement, { sources, normals }, mesh, first, chart) {
  const { positions, faces, uvs, uvFaces, uvStep, uvOrigin, faceCharts } = part;
  const put = placer(part, placement);
  const turn = matrixOf(placement).map((value) => value / placement.scale);
  sources.forEach((corner, i) => {
    const at = first + i;
    const place = 3 * faces[corner];
    put(positions[place], positions[place + 1], positions[place + 2], mesh.positions, 3 * at);
    for (let row = 0; row < 3; row++) {
      mesh.normals[3 * at + row] = turn[3 * row] * normals[3 * i] + turn[3 * row + 1] * normals[3 * i + 1] + turn[3 * row + 2] * normals[3 * i + 2];
    }
    const node = uvFaces[corner];
    for (let axis = 0; axis < 2 && node >= 0; axis++) {
      const value = uvs[2 * node + axis] * uvStep[axis] + uvOrigin[axis];
      mesh.uvs[2 * at + axis] = value * placement.uvScale[axis] + placement.uvOffset[axis];
    }
    mesh.charts[at] = chart + faceCharts[Math.floor(corner / 3)];
  });
}

/** Faces by material, and whether they have texture coordinates. */
class GroupedFaces {
  /** @param {import("../decoder/document.js").Document} document */
  constructor({ chartMaterials, chartHasUv }) {
    this.keys = chartMaterials.map((material, chart) => 2 * material + (chartHasUv[chart] ? 1 : 0));
    /** @type {Map<number, number[]>} */
    this.corners = new Map();
  }

  /** @param {MeshPart} part @param {Placement} placement @param {Int32Array} vertices @param {number} first @param {number} chart */
  add(part, placement, vertices, first, chart) {
    const order = cornerOrder(placement.mirrored);
    part.faceCharts.forEach((own, face) => {
      const key = this.keys[chart + own];
      let list = this.corners.get(key);
      if (!list) this.corners.set(key, (list = []));
      for (const corner of order) list.push(first + vertices[3 * face + corner]);
    });
  }

  finish() {
    const lists = [...this.corners].sort(([a], [b]) => a - b);
    const indices = new Uint32Array(lists.reduce((sum, [, list]) => sum + list.length, 0));
    let start = 0;
    const groups = lists.map(([key, list]) => {
      indices.set(list, start);
      start += list.length;
      return { start: start - list.length, count: list.length, material: key >> 1, textured: Boolean(key & 1), fitted: false };
    });
    return { indices, groups };
  }
}

/** @param {number[]} a @param {number[]} b */
function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
