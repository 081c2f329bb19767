import { BESIDE, RANK, SEEN, STACKED } from "./slots.js";

/** Faces over one pair of coordinates, and neighbors of one, that are remembered. */
const MOST = 16;

/**
 * Texture coordinates that were there before, and what was beside them: charts may lie over others
 * (section 15.6 of the specification). Each has a number, by when it came first.
 */
export class Stacking {
  /** @param {import("./bits.js").BitDecoder} bits @param {number} most numbers */
  constructor(bits, most) {
    this.bits = bits;
    /** Coordinates by number, u * 2^20 + v. @type {number[]} */ this.values = [];
    /** @type {Map<number, number>} */ this.numbers = new Map();
    /** @type {Map<number, number[]>} */ this.thirds = new Map();
    // How many neighbors each has, which they are, and lengths to them.
    this.neighbors = new Uint8Array(most);
    this.near = new Int32Array(MOST * most);
    this.lengths = new Float64Array(MOST * most);
    this.hits = 0;
  }

  /** Any that was there, or -1. */
  anywhere() {
    const count = this.values.length;
    return count && this.bits.bit(SEEN) ? this.bits.below(count, "seen") : -1;
  }

  /** One that was beside another at about this length, or -1. @param {number} start @param {number} length */
  beside(start, length) {
    const { values, near, lengths } = this;
    if (!this.neighbors[start] || !this.bits.bit(BESIDE)) return -1;
    const off = (/** @type {number} */ place) => Math.abs(lengths[place] - length);
    const order = Array.from({ length: this.neighbors[start] }, (_, i) => MOST * start + i);
    order.sort((a, b) => off(a) - off(b) || values[near[a]] - values[near[b]]);
    const rank = this.bits.signed(RANK, 0, 0, 0, 0);
    this.bits.demand(rank >= 0 && rank < order.length, "uv_rank", `0 to ${order.length - 1}`, rank);
    return near[order[rank]];
  }

  /** The one that went with most of these edges, or -1. @param {number[]} sides three numbers each: ends and the third of the face known */
  beyond(sides) {
    /** @type {Map<number, number>} */
    const votes = new Map();
    for (let i = 0; i < sides.length; i += 3) {
      for (const third of this.thirds.get(edgeKey(sides[i], sides[i + 1])) ?? []) {
        if (third !== sides[i + 2]) votes.set(third, (votes.get(third) ?? 0) + 1);
      }
    }
    if (!votes.size) return -1;
    let [best, most] = [-1, 0];
    votes.forEach((count, third) => {
      if (count > most || (count === most && this.values[third] > this.values[best])) [best, most] = [third, count];
    });
    const hit = this.bits.bit(STACKED, 0, this.hits, Math.min(most, 3));
    this.hits = ((this.hits << 1) | hit) & 7;
    return hit ? best : -1;
  }

  /** The number of coordinates. @param {number} u @param {number} v */
  numberOf(u, v) {
    const value = u * 2 ** 20 + v;
    let number = this.numbers.get(value);
    if (number === undefined) {
      number = this.values.push(value) - 1;
      this.numbers.set(value, number);
    }
    return number;
  }

  /** @param {number} number @param {number[]} sides */
  noteThirds(number, sides) {
    for (let i = 0; i < sides.length; i += 3) {
      const [one, other] = [sides[i], sides[i + 1]];
      this.noteThird(one, other, number);
      this.noteThird(other, number, one);
      this.noteThird(number, one, other);
    }
  }

  /** @param {number} number @param {number} other what is beside it @param {number} length */
  noteNear(number, other, length) {
    const { near, neighbors } = this;
    if (neighbors[number] === MOST) return;
    const end = MOST * number + neighbors[number];
    let place = MOST * number;
    while (place < end && near[place] !== other) place++;
    if (place === end) neighbors[number]++;
    near[place] = other;
    this.lengths[place] = length;
  }

  /** @param {number} a @param {number} b @param {number} third */
  noteThird(a, b, third) {
    const key = edgeKey(a, b);
    const thirds = this.thirds.get(key);
    if (!thirds) this.thirds.set(key, [third]);
    else if (thirds.length < MOST) thirds.push(third);
  }
}

/** @param {number} a @param {number} b */
function edgeKey(a, b) {
  return Math.min(a, b) * 2 ** 20 + Math.max(a, b);
}
