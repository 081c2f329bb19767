import { NISPError } from "../errors.js";
import { unzstd } from "../zstd.js";
import { Interpreter } from "./interpreter.js";
import { MODULE, MODULE_BYTES } from "./module.js";
import { partOf } from "./part.js";

const FLOATS = ["step", "origin", "uv_step", "uv_origin", "rotation", "offset", "scale", "uv_scale", "uv_offset"];

/** What may be wrong, what is expected, where # is a limit, and what is found if no number; by the numbers of assembly/host.ts. */
const WRONG = [
  ["bytes", "as many as the parts need"],
  ["bits of a number", "0 to 24", "more"],
  ["coordinate", "0 to #"],
  ["end", "zeros at most"],
  ["third_point", "another than the gate's"],
  ["point", "below #"],
  ["gate", "one at the point", "none"],
  ["gate", "below #"],
  ["steps", "1 to 255"],
  ["copy", "a vertex before it", "none"],
  ["copy", "below #"],
  ["uv_rank", "0 to #"],
  ["seen", "below #"],
  ["uv", "0 to #"],
  ["parts", "1 to #"],
  ["faces", "1 to #"],
  ["position_bits", "0 to #"],
  ["uv_bits", "0 to #"],
  ["step", "above 0", "less"],
  ["faces", "three vertices each", "fewer"],
  ["material_bits", "0 to #"],
  ["placements", "1 to #"],
  ["placement_materials", "0 to # more"],
  ["rotation", "a unit quaternion", "another"],
  ["scale", "above 0", "less"],
  ["placed_faces", "0 to #"],
  ...FLOATS.map((field) => [field, "finite", "another"]),
];

/** Memory in bytes that is kept for the next file at most. */
const KEPT = 2 ** 26;
/** Numbers of a part; placements have others. */
const NUMBERS_OF_PART = 8;

/** @typedef {import("./part.js").Given} Given */

/**
 * What assembly/index.ts exports.
 * @typedef {{begin: (length: number, one: number, other: number) => number, read: (length: number) => void, memory: {buffer: ArrayBuffer}}} Decoder
 * @type {Decoder|null}
 */
let kept = null;
let memory = /** @type {Decoder["memory"]} */ ({ buffer: new ArrayBuffer(0) });
/** Parts, each with its placements behind it. @type {Given[][]} */
let given = [];

const IMPORTS = {
  /** @param {number} what @param {number} limit @param {number} found */
  refuse(what, limit, found) {
    const [field, expected, other] = WRONG[what];
    throw new NISPError("MESH", field, expected.replace("#", String(limit)), other ?? found);
  },
  /** @param {number} start @param {number} count */
  giveFloats(start, count) {
    if (count === NUMBERS_OF_PART) given.push([]);
    given[given.length - 1].push({ numbers: new Float64Array(memory.buffer, start, count).slice(), lists: [] });
  },
  /** @param {number} start @param {number} count */
  giveInts(start, count) {
    const of = given[given.length - 1];
    of[of.length - 1].lists.push(new Int32Array(memory.buffer, start, count).slice());
  },
};

/**
 * The parts of MESH (section 15 of the specification).
 * @param {Uint8Array} data
 * @returns {import("./part.js").MeshPart[]}
 */
export function readMesh(data) {
  const decoder = (kept ??= newDecoder());
  memory = decoder.memory;
  given = [];
  const start = decoder.begin(data.length, random(), random());
  new Uint8Array(memory.buffer).set(data, start);
  try {
    decoder.read(data.length);
    return given.map(([part, ...placements]) => partOf(part, placements));
  } finally {
    given = [];
    if (memory.buffer.byteLength > KEPT) kept = null;
  }
}

function random() {
  return Math.floor(Math.random() * 2 ** 32);
}

/** assembly/ as WebAssembly, or interpreted where a security policy forbids that. @returns {Decoder} */
function newDecoder() {
  const bytes = Uint8Array.from(atob(MODULE), (letter) => letter.charCodeAt(0));
  const module = unzstd(bytes, MODULE_BYTES, "MESH");
  try {
    const instance = new WebAssembly.Instance(new WebAssembly.Module(module), { nisp: IMPORTS });
    return /** @type {any} */ (instance.exports);
  } catch {
    return /** @type {any} */ (new Interpreter(module, IMPORTS).exports);
  }
}
