import { ByteReader } from "./bytes.js";
import { MAX_DEPTH, MAX_ITEMS, MAX_TEXT, MAX_VALUES } from "./enumerations.js";

/** A float, so that it can be told from an integer. */
export class Float {
  /** @param {number} value */
  constructor(value) {
    this.value = value;
  }
}

/** @typedef {number|boolean|string|Float|Uint8Array|unknown[]|Map<number|string, unknown>} Value */

const UTF8 = new TextDecoder("utf-8", { fatal: true, ignoreBOM: true });

/**
 * The one value in `data`, in the canonical form of section 3: map keys are integers or text.
 * @param {Uint8Array} data
 * @param {string} section
 * @returns {unknown}
 */
export function readCanonical(data, section) {
  const decoder = new CanonicalDecoder(new ByteReader(data, section));
  const value = decoder.value(1);
  decoder.reader.end();
  return value;
}

class CanonicalDecoder {
  /** @param {ByteReader} reader */
  constructor(reader) {
    this.reader = reader;
    this.count = 0;
  }

  /** @param {boolean} holds @param {string} field @param {unknown} expected @param {unknown} found */
  demand(holds, field, expected, found) {
    if (!holds) throw this.reader.error(field, expected, found);
  }

  /** @param {number} depth @returns {unknown} */
  value(depth) {
    this.demand(depth <= MAX_DEPTH, "nesting", `at most ${MAX_DEPTH}`, depth);
    this.demand(++this.count <= MAX_VALUES, "values", `at most ${MAX_VALUES}`, this.count);
    const tag = this.reader.uint8();
    if (tag < 0x80) return tag;
    if (tag < 0x90) return this.map(tag & 15, depth);
    if (tag < 0xa0) return this.array(tag & 15, depth);
    if (tag < 0xc0) return this.text(tag & 31);
    if (tag >= 0xe0) return tag - 256;
    return this.tagged(tag, depth);
  }

  /** @param {number} tag @param {number} depth @returns {unknown} */
  tagged(tag, depth) {
    switch (tag) {
      case 0xc2:
      case 0xc3:
        return tag === 0xc3;
      case 0xc4:
      case 0xc5:
      case 0xc6:
        return this.reader.bytes(this.sized(tag - 0xc4, 0));
      case 0xca:
        return this.float(this.reader.view.getFloat32(this.reader.skip(4)), true);
      case 0xcb:
        return this.float(this.reader.view.getFloat64(this.reader.skip(8)), false);
      case 0xcc:
      case 0xcd:
      case 0xce:
        return this.sized(tag - 0xcc, 0x80);
      case 0xcf:
        return this.unsigned64();
      case 0xd0:
      case 0xd1:
      case 0xd2:
      case 0xd3:
        return this.negative(tag - 0xd0);
      case 0xd9:
      case 0xda:
      case 0xdb:
        return this.text(this.sized(tag - 0xd9, 32));
      case 0xdc:
      case 0xdd:
        return this.array(this.sized(tag - 0xdb, 16), depth);
      case 0xde:
      case 0xdf:
        return this.map(this.sized(tag - 0xdd, 16), depth);
    }
    throw this.reader.error("type", "a type of the format", `0x${tag.toString(16)}`);
  }

  /**
   * A big-endian uint of 1, 2 or 4 bytes (power 0 to 2) that no shorter form could hold.
   * @param {number} power
   * @param {number} least that the shortest form with a length byte holds
   */
  sized(power, least) {
    const { view } = this.reader;
    const at = this.reader.skip(1 << power);
    const value = power === 0 ? view.getUint8(at) : power === 1 ? view.getUint16(at) : view.getUint32(at);
    // Arrays and maps have no form of one byte.
    const needed = power === 0 ? least : power === 1 ? (least === 16 ? 16 : 0x100) : 0x10000;
    this.demand(value >= needed, "length", "the fewest bytes", "more");
    return value;
  }

  unsigned64() {
    const value = this.reader.view.getBigUint64(this.reader.skip(8));
    this.demand(value > 0xffffffffn, "integer", "the fewest bytes", "more");
    return Number(value);
  }

  /** @param {number} power */
  negative(power) {
    const { view } = this.reader;
    const at = this.reader.skip(1 << power);
    const value = [
      () => view.getInt8(at),
      () => view.getInt16(at),
      () => view.getInt32(at),
      () => Number(view.getBigInt64(at)),
    ][power]();
    const most = [-33, -129, -32769, -2147483649][power];
    this.demand(value <= most, "integer", "the fewest bytes", "more");
    return value;
  }

  /** @param {number} value @param {boolean} single */
  float(value, single) {
    this.demand(Number.isFinite(value), "float", "finite", value);
    this.demand(single || Math.fround(value) !== value, "float", "float32", "float64");
    return new Float(value);
  }

  /** @param {number} length */
  text(length) {
    this.demand(length <= MAX_TEXT, "text", `at most ${MAX_TEXT} bytes`, length);
    try {
      return UTF8.decode(this.reader.bytes(length));
    } catch (why) {
      if (why instanceof TypeError) throw this.reader.error("text", "UTF-8", "other bytes");
      throw why;
    }
  }

  /** @param {number} length @param {number} depth */
  array(length, depth) {
    this.demand(length <= MAX_ITEMS, "array", `at most ${MAX_ITEMS} members`, length);
    const values = [];
    for (let i = 0; i < length; i++) values.push(this.value(depth + 1));
    return values;
  }

  /** @param {number} length @param {number} depth */
  map(length, depth) {
    this.demand(length <= MAX_ITEMS, "map", `at most ${MAX_ITEMS} pairs`, length);
    const map = new Map();
    let before = new Uint8Array(0);
    for (let i = 0; i < length; i++) {
      const start = this.reader.at;
      const key = this.value(depth + 1);
      this.demand(typeof key === "number" || typeof key === "string", "map key", "an integer or text", key);
      const bytes = this.reader.data.subarray(start, this.reader.at);
      this.demand(i === 0 || precedes(before, bytes), "map key", "sorted keys, each once", key);
      map.set(key, this.value(depth + 1));
      before = bytes;
    }
    return map;
  }
}

/** Whether `a` comes before `b`, byte by byte. @param {Uint8Array} a @param {Uint8Array} b */
function precedes(a, b) {
  for (let i = 0; i < Math.min(a.length, b.length); i++) {
    if (a[i] !== b[i]) return a[i] < b[i];
  }
  return a.length < b.length;
}
