import { NISPError } from "./errors.js";

/** Reads little-endian bytes from front to back; throws NISPError at their end. */
export class ByteReader {
  /**
   * @param {Uint8Array} data
   * @param {string} section that errors name
   */
  constructor(data, section) {
    this.data = data;
    this.view = new DataView(data.buffer, data.byteOffset, data.byteLength);
    this.section = section;
    this.at = 0;
  }

  /** @param {string} field @param {unknown} expected @param {unknown} found @returns {NISPError} */
  error(field, expected, found) {
    return new NISPError(this.section, field, expected, found);
  }

  /** Where `count` bytes begin, which are then behind. @param {number} count */
  skip(count) {
    const left = this.data.length - this.at;
    if (count > left) throw this.error("length", `${count} more bytes`, left);
    this.at += count;
    return this.at - count;
  }

  /** @param {number} count @returns {Uint8Array} a view, no copy */
  bytes(count) {
    const start = this.skip(count);
    return this.data.subarray(start, start + count);
  }

  /** @returns {number} */
  uint8() {
    return this.view.getUint8(this.skip(1));
  }

  /** @returns {number} */
  uint16() {
    return this.view.getUint16(this.skip(2), true);
  }

  /** @returns {number} */
  uint32() {
    return this.view.getUint32(this.skip(4), true);
  }

  /** An unsigned LEB128 integer in the fewest bytes, five at most. @returns {number} */
  varint() {
    let value = 0;
    for (let i = 0; i < 5; i++) {
      const byte = this.uint8();
      value += (byte & 127) * 2 ** (7 * i);
      if (byte < 128) {
        if (byte === 0 && i > 0) throw this.error("varint", "the fewest bytes", "more");
        return value;
      }
    }
    throw this.error("varint", "five bytes at most", "more");
  }

  /**
   * Unsigned integers of the given widths (bits) from a bit string, whose spare bits must be 0.
   * @param {ArrayLike<number>} widths
   * @returns {Float64Array}
   */
  bits(widths) {
    let total = 0;
    for (let i = 0; i < widths.length; i++) total += widths[i];
    const data = this.bytes(Math.ceil(total / 8));
    const values = new Float64Array(widths.length);
    let bit = 0;
    for (let i = 0; i < widths.length; i++) {
      let value = 0;
      for (let k = 0; k < widths[i]; k++, bit++) value = 2 * value + bitOf(data, bit);
      values[i] = value;
    }
    for (; bit < 8 * data.length; bit++) {
      if (bitOf(data, bit)) throw this.error("bit string", "zeros in its last byte", "a set bit");
    }
    return values;
  }

  end() {
    const left = this.data.length - this.at;
    if (left) throw this.error("length", "nothing more", `${left} bytes`);
  }
}

/** @param {Uint8Array} data @param {number} bit counted from the most significant of the first */
export function bitOf(data, bit) {
  return (data[bit >> 3] >> (7 - (bit & 7))) & 1;
}

/**
 * The number that a float16's bits stand for.
 * @param {number} bits
 */
export function halfToNumber(bits) {
  const sign = bits & 0x8000 ? -1 : 1;
  const exponent = (bits >> 10) & 31;
  const fraction = bits & 1023;
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return sign * (exponent ? (1024 + fraction) * 2 ** (exponent - 25) : fraction * 2 ** -24);
}

const CRC_TABLE = Uint32Array.from({ length: 256 }, (_, byte) => {
  let value = byte;
  for (let i = 0; i < 8; i++) value = value & 1 ? 0xedb88320 ^ (value >>> 1) : value >>> 1;
  return value;
});

/**
 * CRC-32 of ISO 3309 over all parts, one after the other.
 * @param {...Uint8Array} parts
 */
export function crc32(...parts) {
  let crc = -1;
  for (const part of parts) {
    for (let i = 0; i < part.length; i++) crc = CRC_TABLE[(crc ^ part[i]) & 255] ^ (crc >>> 8);
  }
  return (crc ^ -1) >>> 0;
}
