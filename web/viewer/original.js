import { fromBase64 } from "./base64.js";

/**
 * The original mesh as nispcodec_web.page writes it: MeshData with base64 in place of arrays, its
 * materials as META has them, and its images.
 * @param {any} data
 * @returns {{materials: import("../decoder/metadata.js").Material[], images: import("../decoder/document.js").Texture[], mesh: import("../extract/mesh.js").MeshData}}
 */
export function readOriginal({ materials, images, mesh }) {
  const floats = (/** @type {string} */ text) => new Float32Array(fromBase64(text).buffer);
  return {
    materials,
    images: images.map((/** @type {any} */ image) => ({ ...image, data: fromBase64(image.data) })),
    mesh: {
      positions: floats(mesh.positions),
      normals: floats(mesh.normals),
      uvs: floats(mesh.uvs),
      charts: floats(mesh.charts),
      indices: new Uint32Array(fromBase64(mesh.indices).buffer),
      groups: mesh.groups.map((/** @type {any} */ group) => ({ ...group, fitted: false })),
      dropped: 0,
    },
  };
}
