import { bitLength, product, quarterOf, rootOf, rounded, shortened, spreadOf, wayBetween } from "./integers.js";
import { DOWN, FLIP, UV, UV_SECOND, UV_START, UV_THIRD } from "./slots.js";
import { Stacking } from "./stacking.js";
import { visitAll } from "./visits.js";

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
  visitAll(corners, twin, places.length / 3, (visit) => reader.read(visit));
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
    this.stacking = new Stacking(bits, places.length / 3);
  }

  /** @param {import("./visits.js").Visit} visit */
  read({ node, hinges, near }) {
    const { stacking, numbers } = this;
    const sides = hinges.map((each) => (each < 0 ? -1 : numbers[each]));
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
    stacking.noteThirds(number, sides);
    this.noteEnds(node, hinges.length ? hinges.filter((_, i) => i % 3 < 2) : near >= 0 ? [near] : []);
  }

  /** @param {number} node @param {number[]} ends */
  noteEnds(node, ends) {
    const { stacking, numbers } = this;
    ends.sort((a, b) => a - b);
    ends.forEach((end, i) => {
      if (end === ends[i - 1]) return;
      const length = this.distance(node, end);
      stacking.noteNear(numbers[node], numbers[end], length);
      stacking.noteNear(numbers[end], numbers[node], length);
    });
  }

  /** @param {number} one @param {number} other */
  distance(one, other) {
    const way = wayBetween(this.places, one, other);
    return rootOf(product(way, 0, 0));
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

  /** @param {number} node @param {number[]} hinges */
  over(node, hinges) {
    const guesses = [];
    for (let i = 0; i < hinges.length; i += 3) guesses.push(this.guess(node, hinges[i], hinges[i + 1], hinges[i + 2]));
    const whole = guesses.filter((each) => each.whole);
    const used = whole.length ? whole : guesses;
    const expected = this.expected(used, !whole.length);
    const spreads = expected.map((value, axis) => {
      const [low, high] = spreadOf(this.found, 2, axis, hinges);
      return Math.max(value, high) - Math.min(value, low);
    });
    const widest = Math.max(spreads[0], spreads[1]);
    const lengths = spreads.map((each) => bitLength((3 * each + widest) >> 6));
    const differ = [spread(used.map(({ u }) => u)), spread(used.map(({ v }) => v))];
    const apart = differ.map((each, i) => Math.min(Math.max(bitLength(each) - lengths[i] + 4, 0), 7));
    return this.both(expected, UV, lengths, Math.min(whole.length, 3), apart);
  }

  /** The mean of guesses, on that side of edges where a bit says. @param {Guess[]} used @param {boolean} sided */
  expected(used, sided) {
    let [u, v, du, dv] = [0, 0, 0, 0];
    for (const each of used) {
      u += each.u;
      v += each.v;
      du += each.du;
      dv += each.dv;
    }
    const mean = (/** @type {number} */ sum) => Math.floor(sum / used.length);
    const [one, other] = [[mean(u + du), mean(v + dv)], [mean(u - du), mean(v - dv)]];
    if (!sided) return one;
    if (one[0] !== other[0] || one[1] !== other[1]) this.flip = this.bits.bit(FLIP, 0, this.flip, 0);
    return this.flip ? other : one;
  }

  /** @param {number} node @param {number} a @param {number} b @param {number} c @returns {Guess} */
  guess(node, a, b, c) {
    const { found, places } = this;
    const [ua, va] = [found[2 * a], found[2 * a + 1]];
    const [u, v] = [found[2 * b] - ua, found[2 * b + 1] - va];
    const beyond = c >= 0 ? c : a;
    const ways = shortened([...wayBetween(places, a, b), ...wayBetween(places, a, node), ...wayBetween(places, a, beyond)], 10);
    const square = product(ways, 0, 0);
    const height = (/** @type {number} */ at, /** @type {number} */ part) =>
      rootOf(Math.max(square * product(ways, at, at) - part * part, 0));
    const part = product(ways, 0, 3);
    if (Math.abs(part) > 16 * square || square === 0) return { u: ua, v: va, whole: false, du: 0, dv: 0 };
    const high = height(3, part);
    const [pu, pv] = [ua + rounded(u * part, square), va + rounded(v * part, square)];
    if (c >= 0) {
      const along = product(ways, 0, 6);
      const other = height(6, along);
      if (other && other * 4 >= high && Math.abs(along) <= 16 * square) {
        const du = rounded((rounded(u * along, square) - found[2 * c] + ua) * high, other);
        const dv = rounded((rounded(v * along, square) - found[2 * c + 1] + va) * high, other);
        return { u: pu + du, v: pv + dv, whole: true, du: 0, dv: 0 };
      }
    }
    return { u: pu, v: pv, whole: false, du: rounded(-v * high, square), dv: rounded(u * high, square) };
  }
}

/** @param {number[]} values */
function spread(values) {
  let [low, high] = [values[0], values[0]];
  for (const value of values) {
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  return high - low;
}
