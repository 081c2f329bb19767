import { MAX_GRID_BITS } from "../enumerations.js";
import { DisjointSets } from "../groups.js";
import { Growth, readVertices } from "./connectivity.js";
import { bendsOf, readEdges } from "./edges.js";
import { sideAfter } from "./integers.js";
import { readPlacements } from "./placements.js";
import { readPositions } from "./positions.js";
import { BORDER_CREASE, CREASE, HAS_CREASES, HAS_SEAMS, HAS_UV, ORIGIN, SEAM, SHEET, STEP, UV_ORIGIN, UV_STEP } from "./slots.js";
import { readUvs } from "./uvs.js";

const MATERIAL_BITS = 16;

/**
 * Triangles on integer grids, and the copies of them.
 * @typedef {object} MeshPart
 * @property {Int32Array} positions (3 n) normalized frame: times step, plus origin
 * @property {Int32Array} faces (3 m)
 * @property {Int32Array} uvs (2 t) asset's UV: times uvStep, plus uvOrigin
 * @property {Int32Array} uvFaces (3 m) -1 on faces without
 * @property {Int32Array} twin (3 m) the side that each meets, or -1; side 3 f + i runs from corner i on
 * @property {Int32Array} faceCharts (m)
 * @property {Int32Array} chartMaterials (k)
 * @property {boolean[]} chartHasUv (k)
 * @property {Uint8Array} creases (3 m) whether shading breaks at a side
 * @property {Uint8Array} sheet (m) faces that have no inside
 * @property {number} step
 * @property {number[]} origin
 * @property {number[]} uvStep
 * @property {number[]} uvOrigin
 * @property {import("./placements.js").Placement[]} placements
 */

/**
 * A part, and how many faces, placements and materials may follow.
 * @param {import("./bits.js").BitDecoder} bits
 * @param {number} most
 * @returns {{part: MeshPart, left: number}}
 */
export function readPart(bits, most) {
  const count = bits.number(most, "faces");
  bits.demand(count > 0, "faces", "at least one", 0);
  const [size, uvSize] = ["position_bits", "uv_bits"].map((field) => {
    const found = bits.bits(5);
    bits.demand(found <= MAX_GRID_BITS, field, `at most ${MAX_GRID_BITS}`, found);
    return found;
  });
  const step = bits.single(STEP, "step");
  bits.demand(step > 0, "step", "above 0", step);
  const origin = bits.singles(ORIGIN, 3, "origin");
  const uvStep = bits.singles(UV_STEP, 2, "uv_step");
  const uvOrigin = bits.singles(UV_ORIGIN, 2, "uv_origin");
  const { corners: points, twin, degree } = new Growth(bits, count);
  const vertices = readVertices(bits, degree.length);
  const faces = points.map((point) => vertices[point]);
  checkFaces(bits, faces);
  const vertexCount = vertices.reduce((most, vertex) => Math.max(most, vertex), 0) + 1;
  const positions = readPositions(bits, faces, twin, vertexCount, size);
  const sheet = readSheets(bits, twin);
  const { seams, creases } = readLines(bits, points, twin, bendsOf(faces, twin, positions));
  const joined = twin.map((other, side) => (seams[side] ? -1 : other));
  const faceCharts = faceGroups(joined);
  const charts = readCharts(bits, faceCharts);
  const { uvs, uvFaces } = readTexture(bits, faces, joined, positions, faceCharts, charts.hasUv, uvSize);
  const { placements, left } = readPlacements(bits, charts.hasUv.length, charts.materialBits, most - count);
  const [chartMaterials, chartHasUv] = [Int32Array.from(charts.materials), charts.hasUv.map(Boolean)];
  const numbers = { step, origin, uvStep, uvOrigin, placements };
  return { part: { positions, faces, uvs, uvFaces, twin, faceCharts, chartMaterials, chartHasUv, creases, sheet, ...numbers }, left };
}

/** @param {import("./bits.js").BitDecoder} bits @param {Int32Array} faces */
function checkFaces(bits, faces) {
  for (let at = 0; at < faces.length; at += 3) {
    const [a, b, c] = faces.subarray(at, at + 3);
    bits.demand(a !== b && b !== c && c !== a, "faces", "three vertices each", [a, b, c]);
  }
}

/** What hangs together: a number for each face. @param {Int32Array} twin */
function faceGroups(twin) {
  const sets = new DisjointSets(twin.length / 3);
  twin.forEach((other, side) => {
    if (other >= 0) sets.join(Math.floor(side / 3), Math.floor(other / 3));
  });
  return sets.labels().labels;
}

/** Which faces are of sheets. @param {import("./bits.js").BitDecoder} bits @param {Int32Array} twin */
function readSheets(bits, twin) {
  const bodies = faceGroups(twin);
  const count = bodies.reduce((most, body) => Math.max(most, body), 0) + 1;
  let last = 0;
  const sheets = Array.from({ length: count }, () => (last = bits.bit(SHEET, last, last, last)));
  return new Uint8Array(bodies.map((body) => sheets[body]));
}

/**
 * Seams and creases, one flag a side.
 * @param {import("./bits.js").BitDecoder} bits @param {Int32Array} points @param {Int32Array} twin @param {Uint8Array} bends
 */
function readLines(bits, points, twin, bends) {
  const seams = new Uint8Array(twin.map((other) => (other < 0 ? 1 : 0)));
  const creases = new Uint8Array(twin.length);
  if (bits.bit(HAS_SEAMS)) readEdges(bits, SEAM, points, twin, bends, seams);
  if (bits.bit(HAS_CREASES)) {
    twin.forEach((other, side) => {
      if (other < 0) creases[side] = bits.bit(BORDER_CREASE);
    });
    readEdges(bits, CREASE, points, twin, bends, creases);
  }
  return { seams, creases };
}

/** @param {import("./bits.js").BitDecoder} bits @param {Int32Array} faceCharts */
function readCharts(bits, faceCharts) {
  const materialBits = bits.bits(5);
  bits.demand(materialBits <= MATERIAL_BITS, "material_bits", `at most ${MATERIAL_BITS}`, materialBits);
  const count = faceCharts.reduce((most, chart) => Math.max(most, chart), 0) + 1;
  /** @type {number[]} */ const hasUv = [];
  /** @type {number[]} */ const materials = [];
  let [dressed, material] = [1, 0];
  for (let chart = 0; chart < count; chart++) {
    hasUv.push((dressed = bits.bit(HAS_UV, dressed, dressed, dressed)));
    materials.push((material = bits.member(materialBits, material)));
  }
  return { hasUv, materials, materialBits };
}

/**
 * Texture coordinates of nodes: corners that no seam parts are one.
 * @param {import("./bits.js").BitDecoder} bits @param {Int32Array} faces @param {Int32Array} joined @param {Int32Array} positions
 * @param {Int32Array} faceCharts @param {number[]} hasUv @param {number} size
 */
function readTexture(bits, faces, joined, positions, faceCharts, hasUv, size) {
  const dressed = faces.map((_, corner) => corner).filter((corner) => hasUv[faceCharts[Math.floor(corner / 3)]]);
  const fans = new DisjointSets(faces.length);
  joined.forEach((other, side) => {
    if (other >= 0) fans.join(side, sideAfter(other));
  });
  const number = new Int32Array(faces.length).fill(-1);
  const at = new Int32Array(faces.length).fill(-1);
  /** @type {number[]} */
  const places = [];
  const nodes = dressed.map((corner, i) => {
    at[corner] = i;
    const fan = fans.root(corner);
    if (number[fan] < 0) {
      number[fan] = places.length / 3;
      const vertex = 3 * faces[corner];
      places.push(positions[vertex], positions[vertex + 1], positions[vertex + 2]);
    }
    return number[fan];
  });
  const inside = dressed.map((corner) => (joined[corner] >= 0 ? at[joined[corner]] : -1));
  const uvs = readUvs(bits, nodes, inside, Int32Array.from(places), size);
  const uvFaces = new Int32Array(faces.length).fill(-1);
  dressed.forEach((corner, i) => (uvFaces[corner] = nodes[i]));
  return { uvs, uvFaces };
}
