import { MAX_MESH_FACES, MAX_PLACED_FACES, MESH_FACES_PER_BYTE } from "../enumerations.js";
import { BitDecoder } from "./bits.js";
import { readPart } from "./part.js";

/**
 * The parts of MESH (section 15 of the specification).
 * @param {Uint8Array} data
 * @returns {import("./part.js").MeshPart[]}
 */
export function readMesh(data) {
  const bits = new BitDecoder(data);
  let left = Math.min(MAX_MESH_FACES, MESH_FACES_PER_BYTE * data.length);
  const count = bits.number(left, "parts");
  bits.demand(count > 0, "parts", "at least one", 0);
  let placed = 0;
  const parts = [];
  for (let i = 0; i < count; i++) {
    const found = readPart(bits, left);
    placed += found.part.faceCharts.length * found.part.placements.length;
    bits.demand(placed <= MAX_PLACED_FACES, "placed_faces", `at most ${MAX_PLACED_FACES}`, placed);
    parts.push(found.part);
    left = found.left;
  }
  bits.end();
  return parts;
}
