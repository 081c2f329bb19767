import { readContainer } from "./container.js";
import { demand } from "./errors.js";
import { readMetadata } from "./metadata.js";
import { readWeights } from "./weights.js";

/**
 * @typedef {{name: string, mime: string, data: Uint8Array}} Texture
 * @typedef {import("./metadata.js").Metadata} Metadata
 * @typedef {object} Document the content of a file, checked
 * @property {Metadata} metadata
 * @property {Map<string, import("./weights.js").Tensors>} tensors of each network
 * @property {Texture[]} images
 * @property {Map<string, number>} bytes what the file's bytes are spent on
 */

/** Sections that this decoder understands. A new critical section is a line here and one below. */
const KNOWN = ["META", "NETS", "TXTR"];

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
  const { tensors, lengths } = readWeights(content("NETS"), metadata.specs);
  const textured = metadata.textures.length > 0;
  demand(textured || !sections.has("TXTR"), "TXTR", "section", "absent without textures", "present");
  const images = textured ? readImages(content("TXTR"), metadata.textures) : [];
  const bytes = new Map([...sections].map(([code, section]) => [code, section.stored]));
  for (const [name, length] of lengths) bytes.set(`NETS.${name}`, length);
  return { metadata, tensors, images, bytes };
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
