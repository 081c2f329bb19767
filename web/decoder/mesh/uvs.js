import { bitLength, dot, quarterOf, rootOf, rounded, shortened } from "./integers.js";
import { DOWN, FLIP, UV, UV_SECOND, UV_START, UV_THIRD } from "./slots.js";
import { Stacking } from "./stacking.js";
import { visitsOf } from "./visits.js";

/**
 * Where a face over an edge may have its node: u and v, whether a face beyond said how to go on, else
 * the part of u and v across the edge.
 * @typedef {{u: number, v: number, whole: boolean, du: number, dv: number}} Guess
 */

/**
 * The texture coordinates of nodes on their grid (section 15.6 of the specification).
 * @param {import("./bits.js").BitDecoder} bits
 * @param {Int32Array} corners nodes (3 m)
 * @param {Int32Array} twin (3 m)
 * @param {Int32Array} places positions of the nodes (3 n)
 * @param {number} size bits of a coordinate
 * @returns {Int32Array} (2 n)
 */
export function readUvs(bits, corners, twin, places, size) {
  const reader = new UvReader(bits, places, size);
  for (const visit of visitsOf(corners, twin, places.length / 3)) reader.read(visit);
  return reader.found;
}

class UvReader {
  /** @param {import("./bits.js").BitDecoder} bits @param {Int32Array} places @param {number} size */
  constructor(bits, places, size) {
    this.bits = bits;
    this.places = places;
    this.size = size;
    this.top = 2 ** size - 1;
    this.last = -1;
    this.flip = 0;
    // Sums of lengths of edges, in space and in the texture.
    this.far = 1;
    this.wide = 1;
    this.found = new Int32Array((2 * places.length) / 3);
    this.numbers = new Int32Array(places.length / 3);
    this.stacking = new Stacking(bits);
  }

  /** @param {import("./visits.js").Visit} visit */
  read({ node, hinges, near }) {
    const { stacking, numbers } = this;
    const sides = hinges.map(([a, b, c]) => [numbers[a], numbers[b], c >= 0 ? numbers[c] : -1]);
    let number = -1;
    if (hinges.length) number = stacking.beyond(sides);
    else if (near >= 0) number = stacking.beside(numbers[near], this.distance(node, near));
    else number = stacking.anywhere();
    if (number < 0) {
      const [u, v] = hinges.length ? this.over(node, hinges) : near >= 0 ? this.second(node, near) : this.start();
      number = stacking.numberOf(u, v);
    }
    const value = stacking.values[number];
    this.found[2 * node] = Math.floor(value / 2 ** 20);
    this.found[2 * node + 1] = value % 2 ** 20;
    numbers[node] = number;
    this.last = node;
    this.note(node, hinges, near, sides);
  }

  /** @param {number} node @param {number[][]} hinges @param {number} near @param {number[][]} sides */
  note(node, hinges, near, sides) {
    const ends = new Set(hinges.flatMap(([a, b]) => [a, b]));
    if (!hinges.length && near >= 0) ends.add(near);
    const ordered = [...ends].sort((a, b) => a - b);
    this.stacking.note(this.numbers[node], sides, ordered.map((end) => [this.numbers[end], this.distance(node, end)]));
  }

  /** @param {number} one @param {number} other */
  distance(one, other) {
    const way = this.way(one, other);
    return rootOf(dot(way, way));
  }

  /** @param {number} from @param {number} to */
  way(from, to) {
    return [0, 1, 2].map((axis) => this.places[3 * to + axis] - this.places[3 * from + axis]);
  }

  /** @param {number[]} expected @param {number} slot @param {number[]} lengths @param {number} sources @param {number[]} apart */
  both(expected, slot, lengths, sources, apart) {
    let before = 0;
    return expected.map((value, axis) => {
      const [medium, special] = [apart[axis] * 4 + sources, before * 4 + sources];
      const made = this.bits.coordinate(value, this.top, slot, lengths[axis], sources, medium, special);
      before = this.bits.longer;
      return made;
    });
  }

  /** The first node of a chart. */
  start() {
    const { last, found } = this;
    const expected = last >= 0 ? [found[2 * last], found[2 * last + 1]] : [this.top >> 1, this.top >> 1];
    const length = Math.max(this.size - 3, 0);
    return this.both(expected, UV_START, [length, length], 0, [0, 0]);
  }

  /** One about as far from another as edges of its length are. @param {number} node @param {number} near */
  second(node, near) {
    const { bits, top } = this;
    const [u0, v0] = [this.found[2 * near], this.found[2 * near + 1]];
    const length = this.distance(node, near);
    const scale = Math.min(Math.floor((this.wide * length) / this.far), 4 * 2 ** this.size);
    const quarter = quarterOf(scale);
    const u = bits.coordinate(u0, top, UV_SECOND, bitLength(scale), 0, quarter, 0);
    const left = rootOf(Math.max(scale * scale - (u - u0) ** 2, 0));
    const down = bits.bit(DOWN);
    const steep = Math.min(Math.floor((8 * left) / (scale + 1)), 7);
    const rise = left + bits.signed(UV_THIRD, bitLength(scale >> 3), 0, steep, quarter);
    const v = v0 + (down ? -rise : rise);
    bits.demand(v >= 0 && v <= top, "uv", `0 to ${top}`, v);
    if (length) {
      this.far += 16 * length - Math.floor(this.far / 4);
      this.wide += 16 * rootOf((u - u0) ** 2 + rise * rise) - Math.floor(this.wide / 4);
    }
    return [u, v];
  }

  /** @param {number} node @param {number[][]} hinges */
  over(node, hinges) {
    const guesses = hinges.map(([a, b, c]) => this.guess(node, a, b, c));
    const whole = guesses.filter((each) => each.whole);
    const used = whole.length ? whole : guesses;
    const expected = this.expected(used, !whole.length);
    const around = [expected, ...hinges.flat().filter((each) => each >= 0).map((each) => this.found.subarray(2 * each, 2 * each + 2))];
    const spreads = [0, 1].map((axis) => spread(around.map((each) => each[axis])));
    const lengths = spreads.map((each) => bitLength(Math.floor((3 * each + Math.max(...spreads)) / 64)));
    const differ = [spread(used.map(({ u }) => u)), spread(used.map(({ v }) => v))];
    const apart = differ.map((each, i) => Math.min(Math.max(bitLength(each) - lengths[i] + 4, 0), 7));
    return this.both(expected, UV, lengths, Math.min(whole.length, 3), apart);
  }

  /** The mean of guesses, on that side of edges where a bit says. @param {Guess[]} used @param {boolean} sided */
  expected(used, sided) {
    const mean = (/** @type {number} */ sign) => [
      Math.floor(used.reduce((sum, { u, du }) => sum + u + sign * du, 0) / used.length),
      Math.floor(used.reduce((sum, { v, dv }) => sum + v + sign * dv, 0) / used.length),
    ];
    const [one, other] = [mean(1), mean(-1)];
    if (!sided) return one;
    if (one[0] !== other[0] || one[1] !== other[1]) this.flip = this.bits.bit(FLIP, 0, this.flip, 0);
    return this.flip ? other : one;
  }

  /** @param {number} node @param {number} a @param {number} b @param {number} c @returns {Guess} */
  guess(node, a, b, c) {
    const { found } = this;
    const [ua, va] = [found[2 * a], found[2 * a + 1]];
    const [u, v] = [found[2 * b] - ua, found[2 * b + 1] - va];
    const e = shortened([b, node, c >= 0 ? c : a].flatMap((each) => this.way(a, each)), 10);
    const edge = e.slice(0, 3);
    const square = dot(edge, edge);
    const foot = (/** @type {number[]} */ point) => {
      const part = dot(edge, point);
      return [part, rootOf(Math.max(square * dot(point, point) - part * part, 0))];
    };
    const [part, height] = foot(e.slice(3, 6));
    if (Math.abs(part) > 16 * square || square === 0) return { u: ua, v: va, whole: false, du: 0, dv: 0 };
    const [pu, pv] = [ua + rounded(u * part, square), va + rounded(v * part, square)];
    if (c >= 0) {
      const [beyond, other] = foot(e.slice(6));
      if (other && other * 4 >= height && Math.abs(beyond) <= 16 * square) {
        const du = rounded((rounded(u * beyond, square) - found[2 * c] + ua) * height, other);
        const dv = rounded((rounded(v * beyond, square) - found[2 * c + 1] + va) * height, other);
        return { u: pu + du, v: pv + dv, whole: true, du: 0, dv: 0 };
      }
    }
    return { u: pu, v: pv, whole: false, du: rounded(-v * height, square), dv: rounded(u * height, square) };
  }
}

/** @param {number[]} values */
function spread(values) {
  return Math.max(...values) - Math.min(...values);
}
