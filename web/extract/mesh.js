import { fieldMesh } from "./field_mesh.js";
import { partsMesh } from "./parts_mesh.js";

/**
 * A textured mesh in the normalized frame, a vertex for each position, normal and chart that meet.
 * @typedef {object} MeshData
 * @property {Float32Array} positions (3 n)
 * @property {Float32Array} normals (3 n) unit, outwards
 * @property {Float32Array} uvs (2 n) origin bottom-left; 0 on charts without
 * @property {Float32Array} charts (n)
 * @property {Uint32Array} indices (3 m)
 * @property {{start: number, count: number, material: number, textured: boolean, fitted: boolean}[]} groups of
 *     indices; fitted: of the field's surface, not triangles of the file
 * @property {number} dropped components that were noise
 */

/**
 * The surface of a model as a textured mesh: that of the field, cut along its seams, and the triangles
 * of the file as they are.
 * @param {import("../evaluate/model.js").NISPModel} model
 * @param {number} resolution cells along an edge of the cube, for the field
 * @returns {MeshData}
 */
export function extractMesh({ field, document }, resolution) {
  const own = field && fieldMesh(field, resolution);
  const parts = document.parts.length ? partsMesh(document) : null;
  return own && parts ? joined(own, parts) : /** @type {MeshData} */ (own ?? parts);
}

/** @param {MeshData} a @param {MeshData} b @returns {MeshData} */
function joined(a, b) {
  const vertices = a.positions.length / 3;
  const floats = (/** @type {"positions"|"normals"|"uvs"|"charts"} */ name) => {
    const all = new Float32Array(a[name].length + b[name].length);
    all.set(a[name]);
    all.set(b[name], a[name].length);
    return all;
  };
  const indices = new Uint32Array(a.indices.length + b.indices.length);
  indices.set(a.indices);
  b.indices.forEach((vertex, i) => (indices[a.indices.length + i] = vertices + vertex));
  const groups = [...a.groups, ...b.groups.map((group) => ({ ...group, start: a.indices.length + group.start }))];
  const arrays = { positions: floats("positions"), normals: floats("normals"), uvs: floats("uvs"), charts: floats("charts") };
  return { ...arrays, indices, groups, dropped: a.dropped };
}
