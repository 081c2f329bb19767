import { readContainer } from "./container.js";
import { ByteReader } from "./bytes.js";
import { Place } from "./errors.js";
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
const NO_BYTES = new Uint8Array(0);

/**
 * Parses and checks a file. Throws NISPError for a malformed one.
 * @param {Uint8Array} file
 * @returns {Document}
 */
export function parseNISP(file) {
  const sections = readContainer(file, KNOWN);
  /** Of a section that must be there exactly where there is what it is for. */
  const content = (/** @type {string} */ code, /** @type {boolean} */ wanted, users = "") => {
    const section = sections.get(code);
    new Place(code).demand(!section !== wanted, "section", wanted ? "present" : `absent without ${users}`, section ? "present" : "absent");
    return section?.content ?? NO_BYTES;
  };
  const metadata = readMetadata(content("META", true));
  const fitted = metadata.specs.size > 0;
  const { tensors, lengths } = readWeights(content("NETS", fitted, "networks"), metadata.specs);
  const parts = sections.has("MESH") || !fitted ? readMesh(content("MESH", true)) : [];
  const charts = chartsOf(metadata, parts);
  const textured = metadata.textures.length > 0;
  const images = readImages(content("TXTR", textured, "textures"), metadata.textures);
  const bytes = new Map([...sections].map(([code, section]) => [code, section.stored]));
  for (const [name, length] of lengths) bytes.set(`NETS.${name}`, length);
  return { metadata, tensors, parts, ...charts, images, bytes };
}

/** Materials, and whether with texture coordinates, of all charts. @param {Metadata} metadata @param {import("./mesh/part.js").MeshPart[]} parts */
function chartsOf(metadata, parts) {
  const count = parts.reduce((sum, part) => sum + part.placements.length * part.chartHasUv.length, metadata.charts);
  const place = new Place("MESH");
  place.limit("charts of all copies", count, MAX_CHARTS);
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
  place.limit("materials", highest, metadata.materials.length - 1);
  return { chartMaterials, chartHasUv };
}

/**
 * @param {Uint8Array} data
 * @param {import("./metadata.js").TextureEntry[]} entries
 * @returns {Texture[]}
 */
function readImages(data, entries) {
  const others = entries.reduce((sum, entry) => sum + (entry.length ?? 0), 0);
  const reader = new ByteReader(data, "TXTR");
  reader.demand(others < data.length || !entries.length, "bytes", `more than ${others}`, data.length);
  return entries.map(({ name, mime, length = data.length - others }) => ({ name, mime, data: reader.bytes(length) }));
}
