import { MAX_MESH_PLACEMENTS } from "../enumerations.js";
import { HAS_MATERIALS, MIRRORED, OFFSET, ONE_PLACE, ROTATION, SCALE, UV_OFFSET, UV_SCALE } from "./slots.js";

/** How far from 1 the squared length of a rotation may be. */
const UNIT_TOLERANCE = 1e-3;

/**
 * Where a copy of a part stands: a point goes to scale * R(rotation) (p, x negated where mirrored) + offset.
 * @typedef {object} Placement
 * @property {number[]} rotation quaternion, w first
 * @property {number[]} offset
 * @property {number} scale
 * @property {boolean} mirrored
 * @property {number[]} uvScale
 * @property {number[]} uvOffset
 * @property {Int32Array|null} materials of the charts; null: the part's
 */

/**
 * @param {import("./bits.js").BitDecoder} bits
 * @param {number} charts
 * @param {number} materialBits
 * @param {number} left placements and materials that may follow
 * @returns {{placements: Placement[], left: number}}
 */
export function readPlacements(bits, charts, materialBits, left) {
  if (bits.bit(ONE_PLACE)) return { placements: [plain()], left };
  const count = bits.number(Math.min(MAX_MESH_PLACEMENTS, left), "placements");
  bits.demand(count > 0, "placements", "at least one", 0);
  left -= count;
  const placements = [];
  for (let i = 0; i < count; i++) {
    const placement = readPlace(bits);
    if (bits.bit(HAS_MATERIALS)) {
      bits.demand(charts <= left, "placement_materials", `at most ${left} more`, charts);
      left -= charts;
      let last = 0;
      placement.materials = Int32Array.from({ length: charts }, () => (last = bits.member(materialBits, last)));
    }
    placements.push(placement);
  }
  return { placements, left };
}

/** @returns {Placement} */
function plain() {
  return { rotation: [1, 0, 0, 0], offset: [0, 0, 0], scale: 1, mirrored: false, uvScale: [1, 1], uvOffset: [0, 0], materials: null };
}

/** @param {import("./bits.js").BitDecoder} bits @returns {Placement} */
function readPlace(bits) {
  const rotation = bits.singles(ROTATION, 4, "rotation");
  const offset = bits.singles(OFFSET, 3, "offset");
  const scale = bits.single(SCALE, "scale");
  const length = rotation.reduce((sum, part) => sum + part * part, 0);
  bits.demand(Math.abs(length - 1) <= UNIT_TOLERANCE, "rotation", "a unit quaternion", rotation);
  bits.demand(scale > 0, "scale", "above 0", scale);
  const mirrored = Boolean(bits.bit(MIRRORED));
  const uvScale = bits.singles(UV_SCALE, 2, "uv_scale");
  const uvOffset = bits.singles(UV_OFFSET, 2, "uv_offset");
  return { rotation, offset, scale, mirrored, uvScale, uvOffset, materials: null };
}
