import { bitLength, cross, quarterOf, rounded, shortened } from "./integers.js";
import { NORMAL, POSITION, POSITION_START } from "./slots.js";
import { visitsOf } from "./visits.js";

/** How far a vertex is from the nodes beyond, and towards the chain's ends; by the number of hinges, in 16ths. */
const FROM_BEYOND = [10, 9, 8];
const TO_ENDS = [0, 7, 5];

/**
 * The positions of vertices on their grid (section 15.4 of the specification).
 * @param {import("./bits.js").BitDecoder} bits
 * @param {Int32Array} corners vertices (3 m)
 * @param {Int32Array} twin (3 m)
 * @param {number} count of vertices
 * @param {number} size bits of a coordinate
 * @returns {Int32Array} (3 count)
 */
export function readPositions(bits, corners, twin, count, size) {
  const reader = new PositionReader(bits, count, size);
  for (const visit of visitsOf(corners, twin, count)) reader.read(visit);
  return reader.found;
}

class PositionReader {
  /** @param {import("./bits.js").BitDecoder} bits @param {number} count @param {number} size */
  constructor(bits, count, size) {
    this.bits = bits;
    this.size = size;
    this.top = 2 ** size - 1;
    this.last = -1;
    this.found = new Int32Array(3 * count);
    // How much longer than expected coordinates were, along the surface and across it.
    this.along = new Uint8Array(count).fill(4);
    this.across = new Uint8Array(count).fill(4);
  }

  /** @param {number} node */
  at(node) {
    return [this.found[3 * node], this.found[3 * node + 1], this.found[3 * node + 2]];
  }

  /** @param {import("./visits.js").Visit} visit */
  read({ node, hinges, near }) {
    const made = hinges.length ? this.over(node, hinges) : this.start(near);
    this.found.set(made, 3 * node);
    this.last = node;
  }

  /** @param {number} near */
  start(near) {
    const source = near >= 0 ? near : this.last;
    const expected = source >= 0 ? this.at(source) : [0, 0, 0].fill(this.top >> 1);
    const kind = near < 0 ? 1 : 0;
    const length = Math.max(this.size - 2 + kind, 0);
    let longest = 0;
    return expected.map((value, axis) => {
      const made = this.bits.coordinate(value, this.top, POSITION_START, length, kind, longest * 2 + kind, axis);
      longest = Math.max(longest, this.bits.longer);
      return made;
    });
  }

  /** @param {number} node @param {number[][]} hinges */
  over(node, hinges) {
    const { bits, top } = this;
    const ends = hinges.flatMap(([a, b]) => [a, b]);
    const many = Math.min(hinges.length, 3);
    const expected = this.expected(hinges, ends, many);
    const { normal, folded } = this.plane(hinges);
    const spreads = this.spreads(hinges.flat().filter((each) => each >= 0));
    const scales = spreads.map((spread) => 3 * spread + Math.max(...spreads));
    const rough = [this.along, this.across].map((table) => Math.floor(ends.reduce((sum, end) => sum + table[end], 0) / ends.length));
    const steep = normal.map(Math.abs);
    const level = steep.indexOf(Math.max(...steep));
    const made = [0, 0, 0];
    let [tilt, longest] = [0, 0];
    for (let axis = 0; axis < 3; axis++) {
      if (axis === level) continue;
      const medium = quarterOf(scales[axis]) * 16 + longest;
      made[axis] = bits.coordinate(expected[axis], top, POSITION, bitLength(scales[axis] >> 5), many, medium, rough[0]);
      tilt += normal[axis] * (made[axis] - expected[axis]);
      longest = Math.max(longest, bits.longer);
    }
    const flat = expected[level] - (normal[level] ? rounded(tilt, normal[level]) : 0);
    const medium = quarterOf(scales[level]) * 16 + longest;
    made[level] = bits.coordinate(flat, top, NORMAL, bitLength(scales[level] >> 6), many, medium, folded * 16 + rough[1]);
    this.along[node] = longest;
    this.across[node] = bits.longer;
    return made;
  }

  /** @param {number[][]} hinges @param {number[]} ends @param {number} many */
  expected(hinges, ends, many) {
    const beyond = hinges.map(([, , c]) => c).filter((c) => c >= 0);
    const outer = ends.filter((end) => ends.indexOf(end) === ends.lastIndexOf(end));
    return [0, 1, 2].map((axis) => {
      const mean = (/** @type {number[]} */ nodes) =>
        rounded(16 * nodes.reduce((sum, each) => sum + this.found[3 * each + axis], 0), nodes.length);
      const middle = mean(ends);
      let moved = middle;
      if (beyond.length) moved += rounded(FROM_BEYOND[many - 1] * (middle - mean(beyond)), 16);
      if (outer.length) moved += rounded(TO_ENDS[many - 1] * (mean(outer) - middle), 16);
      return Math.floor((moved + 8) / 16);
    });
  }

  /** The normal of the faces beyond, and how folded they are. @param {number[][]} hinges */
  plane(hinges) {
    let [normal, whole] = [[0, 0, 0], 0];
    const size = (/** @type {number[]} */ each) => Math.abs(each[0]) + Math.abs(each[1]) + Math.abs(each[2]);
    for (const [a, b, c] of hinges) {
      if (c < 0) continue;
      const [p, q, r] = [this.at(a), this.at(b), this.at(c)];
      const one = cross(q.map((x, i) => x - p[i]), r.map((x, i) => x - p[i]));
      normal = normal.map((x, i) => x + one[i]);
      whole += size(one);
    }
    const folded = whole ? Math.min(Math.floor((8 * (whole - size(normal))) / whole), 7) : 7;
    return { normal: shortened(normal, 20), folded };
  }

  /** @param {number[]} nodes */
  spreads(nodes) {
    return [0, 1, 2].map((axis) => {
      const values = nodes.map((node) => this.found[3 * node + axis]);
      return Math.max(...values) - Math.min(...values);
    });
  }
}
