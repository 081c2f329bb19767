import { networkGradient } from "../evaluate/network_gradient.js";
import { componentsOf, kept, withoutNoise } from "./components.js";
import { EXTRACTION } from "./config.js";
import { extractSurface } from "./isosurface.js";
import { cutAlongSeams } from "./seams.js";
import { vertexCharts } from "./vertex_charts.js";

/**
 * The surface of a field as a textured mesh, cut along its seams.
 * @param {FieldQueries} field
 * @param {number} resolution cells along an edge of the cube
 * @returns {MeshData}
 */
export function fieldMesh(field, resolution) {
  const found = withoutNoise(field.sdfNetwork, extractSurface(field.sdfNetwork, resolution));
  const cut = withoutOpenings(field, cutOf(field, found.surface));
  return { ...dressed(field, cut), dropped: found.dropped };
}

/**
 * @typedef {import("./seams.js").CutSurface} CutSurface
 * @typedef {import("../evaluate/field.js").FieldQueries} FieldQueries
 * @typedef {import("./mesh.js").MeshData} MeshData
 */

/** @param {FieldQueries} field @param {import("./isosurface.js").Surface} surface @returns {CutSurface} */
function cutOf({ sdfNetwork, chartNetwork }, surface) {
  if (!chartNetwork) return { surface, charts: new Int32Array(surface.faces.length / 3) };
  return cutAlongSeams(sdfNetwork, chartNetwork, surface, vertexCharts(chartNetwork, surface));
}

/**
 * Without what closes openings, and islands in it: small pieces of another chart on its rim.
 * @param {FieldQueries} field @param {CutSurface} cut @returns {CutSurface}
 */
function withoutOpenings({ metadata }, { surface, charts }) {
  if (!metadata.openings) return { surface, charts };
  const opening = metadata.charts - 1;
  const { positions, faces, cell } = surface;
  const rim = new Set(faces.filter((_, i) => charts[Math.floor(i / 3)] === opening));
  const open = Int32Array.from(charts.keys()).filter((face) => charts[face] !== opening);
  const left = { positions, faces: facesOf(faces, open), cell };
  const { labels, sizes } = componentsOf(left);
  const touching = new Set(left.faces.filter((vertex) => rim.has(vertex)).map((vertex) => labels[vertex]));
  const stays = (/** @type {number} */ vertex) => {
    const label = labels[vertex];
    return sizes[label] * cell ** 2 >= EXTRACTION.smallArea || !touching.has(label);
  };
  const staying = open.filter((face) => stays(faces[3 * face]));
  return { surface: kept({ positions, faces: facesOf(faces, staying), cell }, () => true), charts: staying.map((face) => charts[face]) };
}

/** @param {Int32Array} faces @param {Int32Array} chosen */
function facesOf(faces, chosen) {
  return Int32Array.from({ length: 3 * chosen.length }, (_, i) => faces[3 * chosen[Math.floor(i / 3)] + (i % 3)]);
}

/** @param {FieldQueries} field @param {CutSurface} cut */
function dressed(field, { surface, charts }) {
  const { metadata } = field;
  const order = Array.from(charts.keys()).sort((a, b) => groupOf(metadata, charts[a]) - groupOf(metadata, charts[b]));
  const { indices, vertices, owners } = splitVertices(surface.faces, charts, order, metadata.charts);
  const positions = new Float32Array(3 * vertices.length);
  vertices.forEach((vertex, i) => positions.set(surface.positions.subarray(3 * vertex, 3 * vertex + 3), 3 * i));
  const uvs = field.uv(positions, Int32Array.from(owners));
  const groups = groupsOf(metadata, order.map((face) => charts[face]));
  return { positions, normals: normalsAt(field, positions), uvs, charts: Float32Array.from(owners), indices, groups };
}

/** Material and whether it has texture coordinates, as one number. @param {import("../decoder/metadata.js").Metadata} metadata @param {number} chart */
function groupOf({ chartMaterials, chartHasUv }, chart) {
  return 2 * chartMaterials[chart] + (chartHasUv[chart] ? 1 : 0);
}

/** @param {Int32Array} faces @param {Int32Array} charts @param {number[]} order @param {number} count */
function splitVertices(faces, charts, order, count) {
  /** @type {Map<number, number>} */
  const numbers = new Map();
  /** @type {number[]} */
  const vertices = [];
  /** @type {number[]} */
  const owners = [];
  const indices = new Uint32Array(3 * order.length);
  order.forEach((face, i) => {
    for (let k = 0; k < 3; k++) {
      const vertex = faces[3 * face + k];
      const key = vertex * count + charts[face];
      let number = numbers.get(key);
      if (number === undefined) {
        number = vertices.push(vertex) - 1;
        owners.push(charts[face]);
        numbers.set(key, number);
      }
      indices[3 * i + k] = number;
    }
  });
  return { indices, vertices, owners };
}

/** @param {import("../decoder/metadata.js").Metadata} metadata @param {number[]} charts of the faces, in order */
function groupsOf(metadata, charts) {
  /** @type {MeshData["groups"]} */
  const groups = [];
  let before = -1;
  charts.forEach((chart, face) => {
    const group = groupOf(metadata, chart);
    if (group !== before) groups.push({ start: 3 * face, count: 0, material: group >> 1, textured: Boolean(group & 1), fitted: true });
    groups[groups.length - 1].count += 3;
    before = group;
  });
  return groups;
}

/** Unit normals (3 n) by the gradient. @param {FieldQueries} field @param {Float32Array} positions */
function normalsAt(field, positions) {
  const { gradients } = networkGradient(field.sdfNetwork, positions);
  for (let i = 0; i < gradients.length; i += 3) {
    const length = Math.hypot(gradients[i], gradients[i + 1], gradients[i + 2]) || 1;
    for (let k = 0; k < 3; k++) gradients[i + k] /= length;
  }
  return gradients;
}
