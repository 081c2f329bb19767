import { demand } from "../errors.js";
import { bitLength } from "./integers.js";
import { MEMBER, PRIORS, SLOTS_END } from "./slots.js";

const LOW = [22, 36, 60, 98, 162, 267, 439, 720, 1179, 1921, 3108, 4972, 7812, 11955, 17625, 24743];
const KNOTS = [...LOW, 32768, ...LOW.map((share) => 65536 - share).reverse()];

/** A probability in 65536ths by its logarithmic odds. @param {number} x */
function squash(x) {
  const at = Math.min(Math.max(x, -2047), 2047) + 2048;
  const rest = at & 127;
  return (KNOTS[at >> 7] * (128 - rest) + KNOTS[(at >> 7) + 1] * rest + 64) >> 7;
}

/** The lowest odds whose probability is not below so many 4096ths. */
const STRETCH = new Int16Array(4096);
for (let p = 0, x = -2047; p < 4096; p++) {
  while (x < 2047 && squash(x) >> 4 < p) x++;
  STRETCH[p] = x;
}

/** Bytes of zeros that may follow those that are there. */
const PADDING = 4;

/** Decodes bits under probabilities that adapt to the bits before (section 15.1 of the specification). */
export class BitDecoder {
  /** @param {Uint8Array} data */
  constructor(data) {
    this.data = data;
    this.at = 0;
    this.range = 2 ** 32 - 1;
    this.code = 0;
    while (this.at < 4) this.code = this.code * 256 + (data[this.at++] ?? 0);
    /** Counters by slot and context, each a probability times 256 plus bits seen; 0 is a new one. @type {number[][]} */
    this.counters = Array.from({ length: 3 * SLOTS_END }, () => []);
    this.weights = new Float64Array(3 * SLOTS_END).fill(20000);
    this.longer = 0;
  }

  /** @param {unknown} holds @param {string} field @param {unknown} expected @param {unknown} [found] */
  demand(holds, field, expected, found) {
    demand(holds, "MESH", field, expected, found);
  }

  /** A bit that is 1 with a probability of so many 65536ths. @param {number} p */
  divide(p) {
    const bound = Math.floor((this.range * (65536 - p)) / 65536);
    const bit = this.code >= bound ? 1 : 0;
    this.code -= bit * bound;
    this.range = bit ? this.range - bound : bound;
    while (this.range < 2 ** 24) {
      this.demand(this.at < this.data.length + PADDING, "bytes", "as many as the parts need", this.data.length);
      this.range *= 256;
      this.code = this.code * 256 + (this.data[this.at++] ?? 0);
    }
    return bit;
  }

  /** @param {number} slot @param {number} [general] @param {number} [medium] @param {number} [special] contexts */
  bit(slot, general = 0, medium = 0, special = 0) {
    const at = 3 * slot;
    const { weights, counters } = this;
    const one = counters[at];
    const two = counters[at + 1];
    const three = counters[at + 2];
    const a = counterOf(one, general) || (PRIORS[slot] ? PRIORS[slot] * 65536 + 4 : 32768 * 256);
    const begun = a - (a & 255) + 1;
    const b = counterOf(two, medium) || begun;
    const c = counterOf(three, special) || begun;
    const x = STRETCH[a >> 12];
    const y = STRETCH[b >> 12];
    const z = STRETCH[c >> 12];
    const p = squash(Math.floor((weights[at] * x + weights[at + 1] * y + weights[at + 2] * z) / 65536));
    const bit = this.divide(p);
    const error = 65535 * bit - p;
    weights[at] += (x * error * 10 + 32768) >> 16;
    weights[at + 1] += (y * error * 10 + 32768) >> 16;
    weights[at + 2] += (z * error * 10 + 32768) >> 16;
    one[general] = moved(a, bit);
    two[medium] = moved(b, bit);
    three[special] = moved(c, bit);
    return bit;
  }

  /** An integer of even bits. @param {number} count */
  bits(count) {
    let value = 0;
    for (let i = 0; i < count; i++) value = 2 * value + this.divide(32768);
    return value;
  }

  /** @param {number} end @param {string} field */
  below(end, field) {
    const value = this.bits(bitLength(end - 1));
    this.demand(value < end, field, `below ${end}`, value);
    return value;
  }

  /** An integer from 0: how many bits it has, then these without the first. @param {number} most @param {string} field */
  number(most, field) {
    const length = this.bits(5);
    const value = length ? 2 ** (length - 1) + this.bits(length - 1) : 0;
    this.demand(value <= most, field, `at most ${most}`, value);
    return value;
  }

  /** A float32; 0 and 1 have bits of their own. @param {number} slot @param {string} field */
  single(slot, field) {
    if (this.bit(slot)) return 0;
    if (this.bit(slot + 1)) return 1;
    const value = new Float32Array(Uint32Array.of(this.bits(32)).buffer)[0];
    this.demand(Number.isFinite(value), field, "a finite number", value);
    return value;
  }

  /** @param {number} slot @param {number} count @param {string} field @returns {number[]} */
  singles(slot, count, field) {
    return Array.from({ length: count }, () => this.single(slot, field));
  }

  /** A number of so many bits, from the highest on. @param {number} bits @param {number} last the one before */
  member(bits, last) {
    let node = 1;
    for (let i = 0; i < bits; i++) node = 2 * node + this.bit(MEMBER, node, node, 8 * node + (last & 7));
    return node - 2 ** bits;
  }

  /**
   * An integer: whether it is longer or shorter than expected, its sign, its other digits.
   * @param {number} slot @param {number} expected bits @param {number} general @param {number} medium @param {number} special
   */
  signed(slot, expected, general, medium, special) {
    let length = expected;
    if (this.bit(slot + 2, general, medium, special)) {
      length++;
      while (this.bit(slot + 3 + Math.min(length - expected - 1, 15), general, medium, special)) {
        this.demand(++length <= 24, "number", "at most 24 bits", "more");
      }
    } else while (length > 0 && this.bit(slot + 20 + expected - length, general, medium, special)) length--;
    if (length === 0) return 0;
    const negative = this.bit(slot, 0, medium, special);
    let size = 1;
    if (length > 1) {
      const relative = Math.min(Math.max(length - expected + 4, 0), 8);
      size = 2 + this.bit(slot + 1, relative, (relative << 5) | length, relative);
      size = size * 2 ** (length - 2) + this.bits(length - 2);
    }
    return negative ? -size : size;
  }

  /**
   * An integer from 0 to `top`; `longer` is then how much longer than `length` its rest is, from 1 to 10.
   * @param {number} expected @param {number} top @param {number} slot @param {number} length
   * @param {number} general @param {number} medium @param {number} special
   */
  coordinate(expected, top, slot, length, general, medium, special) {
    const rest = this.signed(slot, length, general, medium, special);
    const value = Math.min(Math.max(expected, 0), top) + rest;
    this.demand(value >= 0 && value <= top, "coordinate", `0 to ${top}`, value);
    this.longer = Math.min(Math.max(bitLength(Math.abs(rest)) - length + 4, 1), 10);
    return value;
  }

  end() {
    const left = this.data.subarray(this.at);
    this.demand(!left.some(Boolean), "end", "zeros at most", `${left.length} bytes`);
  }
}

/** @param {number[]} counters @param {number} context */
function counterOf(counters, context) {
  while (counters.length <= context) counters.push(0);
  return counters[context];
}

/** A counter after one more bit. @param {number} counter @param {number} bit */
function moved(counter, bit) {
  const seen = counter & 255;
  const probability = counter >> 8;
  const step = ((65535 * bit - probability) * Math.floor(65536 / (seen + 2))) >> 16;
  return (probability + step) * 256 + Math.min(seen + 1, 255);
}
