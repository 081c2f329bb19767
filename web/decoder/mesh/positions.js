import { bitLength, cross, quarterOf, rounded, shortened, spreadOf, wayBetween } from "./integers.js";
import { NORMAL, POSITION, POSITION_START } from "./slots.js";
import { visitAll } from "./visits.js";

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
  visitAll(corners, twin, count, (visit) => reader.read(visit));
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

  /** @param {import("./visits.js").Visit} visit */
  read({ node, hinges, near }) {
    if (hinges.length) this.over(node, hinges);
    else this.start(node, near >= 0 ? near : this.last, near < 0 ? 1 : 0);
    this.last = node;
  }

  /** @param {number} node @param {number} source a node, or -1 @param {number} kind */
  start(node, source, kind) {
    const { bits, found, top } = this;
    const length = Math.max(this.size - 2 + kind, 0);
    let longest = 0;
    for (let axis = 0; axis < 3; axis++) {
      const expected = source >= 0 ? found[3 * source + axis] : top >> 1;
      found[3 * node + axis] = bits.coordinate(expected, top, POSITION_START, length, kind, longest * 2 + kind, axis);
      longest = Math.max(longest, bits.longer);
    }
  }

  /** @param {number} node @param {number[]} hinges */
  over(node, hinges) {
    const { bits, found, top } = this;
    const { ends, outer, beyond } = nodesOf(hinges);
    const many = Math.min(hinges.length / 3, 3);
    const { normal, folded } = this.plane(hinges);
    const spreads = [0, 1, 2].map((axis) => {
      const [low, high] = spreadOf(found, 3, axis, hinges);
      return high - low;
    });
    const widest = Math.max(spreads[0], spreads[1], spreads[2]);
    const steep = normal.map(Math.abs);
    const level = steep.indexOf(Math.max(steep[0], steep[1], steep[2]));
    let [tilt, longest] = [0, 0];
    const read = (/** @type {number} */ axis, /** @type {number} */ expected, /** @type {number} */ slot, /** @type {number} */ fine, /** @type {number} */ special) => {
      const scale = 3 * spreads[axis] + widest;
      const made = bits.coordinate(expected, top, slot, bitLength(scale >> fine), many, quarterOf(scale) * 16 + longest, special);
      found[3 * node + axis] = made;
      return made - expected;
    };
    const rough = meanOf(this.along, ends);
    for (let axis = 0; axis < 3; axis++) {
      if (axis === level) continue;
      tilt += normal[axis] * read(axis, this.expected(axis, many, ends, outer, beyond), POSITION, 5, rough);
      longest = Math.max(longest, bits.longer);
    }
    const flat = this.expected(level, many, ends, outer, beyond) - (normal[level] ? rounded(tilt, normal[level]) : 0);
    read(level, flat, NORMAL, 6, folded * 16 + meanOf(this.across, ends));
    this.along[node] = longest;
    this.across[node] = bits.longer;
  }

  /** @param {number} axis @param {number} many @param {number[]} ends @param {number[]} outer @param {number[]} beyond */
  expected(axis, many, ends, outer, beyond) {
    const middle = this.mean(ends, axis);
    let moved = middle;
    if (beyond.length) moved += rounded(FROM_BEYOND[many - 1] * (middle - this.mean(beyond, axis)), 16);
    if (outer.length) moved += rounded(TO_ENDS[many - 1] * (this.mean(outer, axis) - middle), 16);
    return (moved + 8) >> 4;
  }

  /** In 16ths. @param {number[]} nodes @param {number} axis */
  mean(nodes, axis) {
    let sum = 0;
    for (let i = 0; i < nodes.length; i++) sum += this.found[3 * nodes[i] + axis];
    return rounded(16 * sum, nodes.length);
  }

  /** The normal of the faces beyond, and how folded they are. @param {number[]} hinges */
  plane(hinges) {
    const { found } = this;
    let [normal, whole] = [[0, 0, 0], 0];
    for (let i = 0; i < hinges.length; i += 3) {
      const [a, b, c] = [hinges[i], hinges[i + 1], hinges[i + 2]];
      if (c < 0) continue;
      const one = cross(wayBetween(found, a, b), wayBetween(found, a, c));
      for (let axis = 0; axis < 3; axis++) normal[axis] += one[axis];
      whole += sizeOf(one);
    }
    const folded = whole ? Math.min(Math.floor((8 * (whole - sizeOf(normal))) / whole), 7) : 7;
    return { normal: shortened(normal, 20), folded };
  }
}

/** The ends of hinges, those of them that are there once, and the nodes beyond. @param {number[]} hinges */
function nodesOf(hinges) {
  const ends = hinges.filter((_, i) => i % 3 < 2);
  const outer = ends.filter((end) => ends.indexOf(end) === ends.lastIndexOf(end));
  const beyond = hinges.filter((node, i) => i % 3 === 2 && node >= 0);
  return { ends, outer, beyond };
}

/** @param {Uint8Array} table @param {number[]} nodes */
function meanOf(table, nodes) {
  let sum = 0;
  for (let i = 0; i < nodes.length; i++) sum += table[nodes[i]];
  return Math.floor(sum / nodes.length);
}

/** @param {number[]} way */
function sizeOf(way) {
  return Math.abs(way[0]) + Math.abs(way[1]) + Math.abs(way[2]);
}
