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
  const reader = new CanonicalReader(data, section);
  const value = reader.value(1);
  reader.finish();
  return value;
}

class CanonicalReader extends ByteReader {
  /** Values so far. */
  count = 0;

  /** @param {number} depth @returns {unknown} */
  value(depth) {
    this.limit("nesting", depth, MAX_DEPTH);
    this.limit("values", ++this.count, MAX_VALUES);
    const tag = this.uint(1);
    if (tag < 0x80) return tag;
    if (tag < 0x90) return this.#map(tag & 15, depth);
    if (tag < 0xa0) return this.#array(tag & 15, depth);
    if (tag < 0xc0) return this.#text(tag & 31);
    if (tag >= 0xe0) return tag - 256;
    return this.#tagged(tag, depth);
  }

  /** @param {number} tag @param {number} depth @returns {unknown} */
  #tagged(tag, depth) {
    switch (tag) {
      case 0xc2:
      case 0xc3:
        return tag === 0xc3;
      case 0xc4:
      case 0xc5:
      case 0xc6:
        return this.bytes(this.#sized(tag - 0xc4, 0));
      case 0xca:
        return this.#real(this.view.getFloat32(this.skip(4)), true);
      case 0xcb:
        return this.#real(this.view.getFloat64(this.skip(8)), false);
      case 0xcc:
      case 0xcd:
      case 0xce:
      case 0xcf:
        return this.#sized(tag - 0xcc, 128);
      case 0xd0:
      case 0xd1:
      case 0xd2:
      case 0xd3:
        return this.#negative(tag - 0xd0);
      case 0xd9:
      case 0xda:
      case 0xdb:
        return this.#text(this.#sized(tag - 0xd9, 32));
      case 0xdc:
      case 0xdd:
        return this.#array(this.#sized(tag - 0xdb, 16, 1), depth);
      case 0xde:
      case 0xdf:
        return this.#map(this.#sized(tag - 0xdd, 16, 1), depth);
    }
    this.demand(false, "type", "one of the format", `0x${tag.toString(16)}`);
  }

  /** A big-endian integer of 1, 2, 4 or 8 bytes: two to a power. @param {number} power @param {boolean} [signed] @returns {number} */
  #integer(power, signed = false) {
    if (power === 3) return this.#integer(2, signed) * 2 ** 32 + this.#integer(2);
    const bytes = this.bytes(1 << power);
    return bytes.reduce((value, byte) => value * 256 + byte, signed && bytes[0] > 127 ? -1 : 0);
  }

  /**
   * An integer from 0 that no shorter form could hold.
   * @param {number} power
   * @param {number} least that the shortest form holds
   * @param {number} [shortest] power of that form
   */
  #sized(power, least, shortest = 0) {
    const value = this.#integer(power);
    this.#inFewest(value >= (power > shortest ? 2 ** (4 << power) : least));
    return value;
  }

  /** @param {number} power */
  #negative(power) {
    const value = this.#integer(power, true);
    this.#inFewest(-value > (power ? 2 ** ((4 << power) - 1) : 32));
    return value;
  }

  /** @param {boolean} holds */
  #inFewest(holds) {
    this.demand(holds, "integer", "the fewest bytes");
  }

  /** @param {number} value @param {boolean} single */
  #real(value, single) {
    this.demand(Number.isFinite(value), "float", "finite", value);
    this.demand(single || Math.fround(value) !== value, "float", "float32", "float64");
    return new Float(value);
  }

  /** @param {number} length */
  #text(length) {
    this.limit("bytes of text", length, MAX_TEXT);
    try {
      return UTF8.decode(this.bytes(length));
    } catch (why) {
      this.demand(!(why instanceof TypeError), "text", "UTF-8");
      throw why;
    }
  }

  /** @param {number} length @param {number} depth */
  #array(length, depth) {
    this.limit("members of an array", length, MAX_ITEMS);
    const values = [];
    for (let i = 0; i < length; i++) values.push(this.value(depth + 1));
    return values;
  }

  /** @param {number} length @param {number} depth */
  #map(length, depth) {
    this.limit("pairs of a map", length, MAX_ITEMS);
    const map = new Map();
    let before = new Uint8Array(0);
    for (let i = 0; i < length; i++) {
      const start = this.at;
      const key = this.value(depth + 1);
      this.demand(typeof key === "number" || typeof key === "string", "map key", "an integer or text", key);
      const bytes = this.data.subarray(start, this.at);
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
