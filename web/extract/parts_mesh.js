import { placer } from "../evaluate/placed.js";
import { EXTRACTION } from "./config.js";
import { DisjointSets } from "./groups.js";

/**
 * @typedef {import("../decoder/mesh/part.js").MeshPart} MeshPart
 * @typedef {import("../decoder/mesh/part.js").Placement} Placement
 * @typedef {object} Copies all copies of all parts, in the normalized frame
 * @property {Float64Array} positions (3 n)
 * @property {Int32Array} faces (3 m) numbers of positions: ends of borders that meet have one
 * @property {Float64Array} uvs (2 t)
 * @property {Int32Array} uvFaces (3 m) -1 for none
 * @property {Int32Array} charts (m)
 * @property {Uint8Array} creases (3 m)
 * @property {Uint8Array} silent (m) of parts that say of no edge that it is a crease
 */

/**
 * All copies of all mesh parts as one mesh: triangles, seams and creases as the file has them.
 * @param {import("../decoder/document.js").Document} document
 * @returns {import("./mesh.js").MeshData}
 */
export function partsMesh(document) {
  const copies = placedCopies(document);
  if (document.parts.length > 1 || document.parts[0].placements.length > 1) joinBorders(copies);
  const { vertices, sources, normals } = split(copies);
  const count = sources.length;
  const mesh = { positions: new Float32Array(3 * count), normals, uvs: new Float32Array(2 * count), charts: new Float32Array(count) };
  const { positions, faces, uvs, uvFaces, charts } = copies;
  sources.forEach((corner, i) => {
    const [place, node] = [3 * faces[corner], 2 * uvFaces[corner]];
    mesh.positions.set(positions.subarray(place, place + 3), 3 * i);
    if (node >= 0) mesh.uvs.set(uvs.subarray(node, node + 2), 2 * i);
    mesh.charts[i] = charts[Math.floor(corner / 3)];
  });
  return { ...mesh, ...byMaterial(document, charts, vertices), dropped: 0 };
}

/** @param {import("../decoder/document.js").Document} document @returns {Copies} */
function placedCopies({ parts, metadata }) {
  const sum = (/** @type {(part: MeshPart) => number} */ of) => parts.reduce((total, part) => total + of(part) * part.placements.length, 0);
  const faces = sum((part) => part.faceCharts.length);
  const copies = {
    positions: new Float64Array(sum((part) => part.positions.length)),
    faces: new Int32Array(3 * faces),
    uvs: new Float64Array(sum((part) => part.uvs.length)),
    uvFaces: new Int32Array(3 * faces),
    charts: new Int32Array(faces),
    creases: new Uint8Array(3 * faces),
    silent: new Uint8Array(faces),
  };
  let at = { face: 0, position: 0, uv: 0, chart: metadata.charts };
  for (const part of parts) {
    const silent = part.creases.some(Boolean) ? 0 : 1;
    for (const placement of part.placements) {
      putCopy(part, placement, silent, copies, at);
      at = {
        face: at.face + part.faceCharts.length,
        position: at.position + part.positions.length / 3,
        uv: at.uv + part.uvs.length / 2,
        chart: at.chart + part.chartHasUv.length,
      };
    }
  }
  return copies;
}

/**
 * One copy of a part, from the numbers in `at` on.
 * @param {MeshPart} part @param {Placement} placement @param {number} silent @param {Copies} copies
 * @param {{face: number, position: number, uv: number, chart: number}} at
 */
function putCopy(part, placement, silent, copies, at) {
  const put = placer(part, placement);
  for (let i = 0; i < part.positions.length; i += 3) {
    put(part.positions[i], part.positions[i + 1], part.positions[i + 2], copies.positions, 3 * at.position + i);
  }
  part.uvs.forEach((value, i) => {
    const axis = i % 2;
    const own = value * part.uvStep[axis] + part.uvOrigin[axis];
    copies.uvs[2 * at.uv + i] = own * placement.uvScale[axis] + placement.uvOffset[axis];
  });
  // Sides go from each corner to the next: the other way round the last one comes first.
  const [corners, sides] = placement.mirrored ? [[0, 2, 1], [2, 1, 0]] : [[0, 1, 2], [0, 1, 2]];
  part.faceCharts.forEach((chart, face) => {
    copies.charts[at.face + face] = at.chart + chart;
    copies.silent[at.face + face] = silent;
    for (let i = 0; i < 3; i++) {
      const [to, from] = [3 * (at.face + face) + i, 3 * face + corners[i]];
      copies.faces[to] = at.position + part.faces[from];
      copies.uvFaces[to] = part.uvFaces[from] < 0 ? -1 : at.uv + part.uvFaces[from];
      copies.creases[to] = part.creases[3 * face + sides[i]];
    }
  });
}

/** Gives the ends of borders that lie on each other one number. @param {Copies} copies */
function joinBorders({ positions, faces }) {
  const ends = new Set(borderSides(faces).flatMap((side) => [faces[side], faces[sideAfter(side)]]));
  const vertices = Int32Array.from(ends);
  const runs = [0, 1, 2].map((axis) => runsOf(vertices, (vertex) => positions[3 * vertex + axis]));
  /** @type {Map<string, number>} */
  const places = new Map();
  /** @type {Map<number, number>} */
  const firsts = new Map();
  for (const vertex of vertices) {
    const key = runs.map((run) => run.get(vertex)).join();
    if (!places.has(key)) places.set(key, vertex);
    firsts.set(vertex, /** @type {number} */ (places.get(key)));
  }
  faces.forEach((vertex, corner) => (faces[corner] = firsts.get(vertex) ?? vertex));
}

/** A number for each run of vertices whose values are near the next one's. @param {Int32Array} vertices @param {(vertex: number) => number} value */
function runsOf(vertices, value) {
  const order = vertices.slice().sort((a, b) => value(a) - value(b));
  let run = 0;
  return new Map(Array.from(order, (vertex, i) => [vertex, i && value(vertex) - value(order[i - 1]) > EXTRACTION.meeting ? ++run : run]));
}

/** Sides of edges that have no other. @param {Int32Array} faces */
function borderSides(faces) {
  return [...edgesOf(faces).values()].filter((sides) => sides.length === 1).flat();
}

/**
 * One vertex for each position, normal and texture coordinate that meet.
 * @param {Copies} copies
 * @returns {{vertices: Int32Array, sources: number[], normals: Float32Array}} of the corners (3 m), a corner of each vertex, unit
 */
function split(copies) {
  const { faces, uvFaces, charts } = copies;
  const smooth = smoothGroups(copies);
  const sums = normalSums(copies, smooth);
  /** @type {Map<number, number>} */
  const numbers = new Map();
  /** @type {number[]} */
  const sources = [];
  const most = 2 * faces.length;
  const vertices = faces.map((_, corner) => {
    // A texture coordinate is of one chart.
    const look = uvFaces[corner] >= 0 ? uvFaces[corner] : faces.length + charts[Math.floor(corner / 3)];
    const key = smooth[corner] * most + look;
    let number = numbers.get(key);
    if (number === undefined) {
      number = sources.push(corner) - 1;
      numbers.set(key, number);
    }
    return number;
  });
  const normals = new Float32Array(3 * sources.length);
  sources.forEach((corner, i) => normals.set(sums.subarray(3 * smooth[corner], 3 * smooth[corner] + 3), 3 * i));
  return { vertices, sources, normals };
}

/** A number for the corners (3 m) at a vertex that no crease parts. @param {Copies} copies */
function smoothGroups(copies) {
  const { faces, silent } = copies;
  const pairs = sidePairs(faces);
  const cosines = pairCosines(copies, pairs);
  const sharp = sharpSides(faces.length, pairs, cosines);
  const creases = copies.creases.map((crease, side) => (silent[Math.floor(side / 3)] ? sharp[side] : crease));
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

/** The sides of each edge. @param {Int32Array} faces */
function edgesOf(faces) {
  /** @type {Map<number, number[]>} */
  const edges = new Map();
  faces.forEach((vertex, side) => {
    const other = faces[sideAfter(side)];
    const key = Math.min(vertex, other) * 2 ** 26 + Math.max(vertex, other);
    const sides = edges.get(key);
    if (sides) sides.push(side);
    else edges.set(key, [side]);
  });
  return edges;
}

/** All pairs of sides of one edge, both ways, but of faces back to back. @param {Int32Array} faces @returns {[number, number][]} */
function sidePairs(faces) {
  /** @type {[number, number][]} */
  const pairs = [];
  for (const sides of edgesOf(faces).values()) {
    for (let turn = 1; turn < Math.min(sides.length, EXTRACTION.edgeSides); turn++) {
      sides.forEach((mine, i) => {
        const other = sides[(i + turn) % sides.length];
        if (faces[sideAfter(mine, 2)] !== faces[sideAfter(other, 2)]) pairs.push([mine, other]);
      });
    }
  }
  return pairs;
}

/** Of the normals of both faces; 0 where one has no area. @param {Copies} copies @param {[number, number][]} pairs */
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

/** As long as twice the face's area. @param {Int32Array} faces @param {Float64Array} positions @param {number} corner the face's first */
function faceNormal(faces, positions, corner) {
  const at = (/** @type {number} */ i, /** @type {number} */ axis) => positions[3 * faces[corner + i] + axis];
  const [u, v] = [1, 2].map((i) => [0, 1, 2].map((axis) => at(i, axis) - at(0, axis)));
  return cross(u, v);
}

/** Normals of groups of corners, weighted by area times angle, of unit length; +z where they cancel. @param {Copies} copies @param {Int32Array} groups */
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

/** A face's angle at a corner: however a flat surface is cut into triangles, it counts the same. @param {Int32Array} faces @param {Float64Array} positions @param {number} corner */
function angleAt(faces, positions, corner) {
  const [u, v] = [1, 2].map((steps) =>
    [0, 1, 2].map((axis) => positions[3 * faces[sideAfter(corner, steps)] + axis] - positions[3 * faces[corner] + axis]),
  );
  return Math.atan2(Math.hypot(...cross(u, v)), dot(u, v));
}

/**
 * The faces' vertices by material, and whether they have texture coordinates.
 * @param {import("../decoder/document.js").Document} document @param {Int32Array} charts (m) @param {Int32Array} vertices (3 m)
 */
function byMaterial({ chartMaterials, chartHasUv }, charts, vertices) {
  const keys = chartMaterials.map((material, chart) => 2 * material + (chartHasUv[chart] ? 1 : 0));
  /** @type {Map<number, number[]>} */
  const corners = new Map();
  charts.forEach((chart, face) => {
    let list = corners.get(keys[chart]);
    if (!list) corners.set(keys[chart], (list = []));
    list.push(vertices[3 * face], vertices[3 * face + 1], vertices[3 * face + 2]);
  });
  const lists = [...corners].sort(([a], [b]) => a - b);
  const indices = new Uint32Array(vertices.length);
  let start = 0;
  const groups = lists.map(([key, list]) => {
    indices.set(list, start);
    start += list.length;
    return { start: start - list.length, count: list.length, material: key >> 1, textured: Boolean(key & 1), fitted: false };
  });
  return { indices, groups };
}

/** @param {number[]} a @param {number[]} b */
function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
