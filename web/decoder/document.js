import { readContainer } from "./container.js";
import { demand } from "./errors.js";
import { MAX_CHARTS } from "./enumerations.js";
import { readMesh } from "./mesh/section.js";
import { readMetadata } from "./metadata.js";
import { readWeights } from "./weights.js";

/**
 * @typedef {{name: string, mime: string, data: Uint8Array}} Texture
 * @typedef {import("./metadata.js").Metadata} Metadata
 * @typedef {object} Document the content of a file, checked
 * @property {Metadata} metadata
 * @property {Map<string, import("./weights.js").Tensors>} tensors of each network
 * @property {import("./mesh/part.js").MeshPart[]} parts triangles, beside the field or in its place
 * @property {Int32Array} chartMaterials of all charts: those of the field, then those of each copy of each part
 * @property {boolean[]} chartHasUv of all charts
 * @property {Texture[]} images
 * @property {Map<string, number>} bytes what the file's bytes are spent on
 */

/** Sections that this decoder understands. A new critical section is a line here and one below. */
const KNOWN = ["MESH", "META", "NETS", "TXTR"];

/**
 * Parses and checks a file. Throws NISPError for a malformed one.
 * @param {Uint8Array} file
 * @returns {Document}
 */
export function parseNISP(file) {
  const sections = readContainer(file, KNOWN);
  const content = (/** @type {string} */ code) => {
    const section = sections.get(code);
    demand(section, code, "section", "present", "absent");
    return section.content;
  };
  const metadata = readMetadata(content("META"));
  const fitted = metadata.specs.size > 0;
  demand(fitted || !sections.has("NETS"), "NETS", "section", "absent without networks", "present");
  const { tensors, lengths } = fitted ? readWeights(content("NETS"), metadata.specs) : { tensors: new Map(), lengths: new Map() };
  const parts = sections.has("MESH") || !fitted ? readMesh(content("MESH")) : [];
  const charts = chartsOf(metadata, parts);
  const textured = metadata.textures.length > 0;
  demand(textured || !sections.has("TXTR"), "TXTR", "section", "absent without textures", "present");
  const images = textured ? readImages(content("TXTR"), metadata.textures) : [];
  const bytes = new Map([...sections].map(([code, section]) => [code, section.stored]));
  for (const [name, length] of lengths) bytes.set(`NETS.${name}`, length);
  return { metadata, tensors, parts, ...charts, images, bytes };
}

/** Materials, and whether with texture coordinates, of all charts. @param {Metadata} metadata @param {import("./mesh/part.js").MeshPart[]} parts */
function chartsOf(metadata, parts) {
  const count = parts.reduce((sum, part) => sum + part.placements.length * part.chartHasUv.length, metadata.charts);
  demand(count <= MAX_CHARTS, "MESH", "charts", `at most ${MAX_CHARTS} with all copies`, count);
  const chartMaterials = new Int32Array(count);
  chartMaterials.set(metadata.chartMaterials);
  const chartHasUv = metadata.chartHasUv.slice();
  for (const part of parts) {
    for (const { materials } of part.placements) {
      chartMaterials.set(materials ?? part.chartMaterials, chartHasUv.length);
      for (const dressed of part.chartHasUv) chartHasUv.push(dressed);
    }
  }
  const highest = chartMaterials.reduce((most, material) => Math.max(most, material), 0);
  demand(highest < metadata.materials.length, "MESH", "materials", `below ${metadata.materials.length}`, highest);
  return { chartMaterials, chartHasUv };
}

/**
 * @param {Uint8Array} data
 * @param {import("./metadata.js").TextureEntry[]} entries
 * @returns {Texture[]}
 */
function readImages(data, entries) {
  const others = entries.reduce((sum, entry) => sum + (entry.length ?? 0), 0);
  demand(others < data.length, "TXTR", "length", `more than ${others} bytes`, data.length);
  let at = 0;
  return entries.map(({ name, mime, length }) => {
    const end = length === undefined ? data.length : at + length;
    const image = { name, mime, data: data.subarray(at, end) };
    at = end;
    return image;
  });
}
