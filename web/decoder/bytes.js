import { Place } from "./errors.js";

/** Reads little-endian bytes, all or a part, from front to back; throws NISPError at their end. */
export class ByteReader extends Place {
  /**
   * @param {Uint8Array} data
   * @param {string} section that errors name
   * @param {string} [path] in it
   */
  constructor(data, section, path) {
    super(section, path);
    this.at = 0;
    this.data = data;
    /** Where what is read ends. */
    this.end = data.length;
    this.view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  }

  /** Where `count` bytes begin, which are then behind. @param {number} count */
  skip(count) {
    const left = this.end - this.at;
    this.demand(count <= left, "bytes", `${count} more`, left);
    this.at += count;
    return this.at - count;
  }

  /** @param {number} count @returns {Uint8Array} a view, no copy */
  bytes(count) {
    const start = this.skip(count);
    return this.data.subarray(start, start + count);
  }

  /** @param {number} width in bytes */
  uint(width) {
    const start = this.skip(width);
    let value = 0;
    while (width--) value = value * 256 + this.data[start + width];
    return value;
  }

  /** @param {string} kind "float16" or "float32" */
  float(kind) {
    return toFloat(kind, this.uint(kind === "float16" ? 2 : 4));
  }

  /** An unsigned LEB128 integer in the fewest bytes, five at most. @returns {number} */
  varint() {
    let [value, bits, byte] = [0, 0, 128];
    for (; byte > 127; bits += 7) {
      byte = this.uint(1);
      value += (byte & 127) * 2 ** bits;
      this.demand((byte || !bits) && (byte < 128 || bits < 28), "varint", "the fewest bytes, five at most");
    }
    return value;
  }

  /**
   * Unsigned integers of so many bits each from a bit string, whose spare bits must be 0.
   * @param {number} count @param {number} width
   * @returns {Float64Array}
   */
  bits(count, width) {
    const data = this.bytes(Math.ceil((count * width) / 8));
    const values = new Float64Array(count);
    let bit = 0;
    for (let i = 0; i < count; i++) {
      for (let k = 0; k < width; k++, bit++) values[i] = 2 * values[i] + bitOf(data, bit);
    }
    for (; bit < 8 * data.length; bit++) {
      this.demand(!bitOf(data, bit), "bit string", "zeros in its last byte");
    }
    return values;
  }

  /** Throws unless all is read. */
  finish() {
    const left = this.end - this.at;
    this.demand(!left, "bytes", "no more", left);
  }
}

/** @param {Uint8Array} data @param {number} bit counted from the most significant of the first */
function bitOf(data, bit) {
  return (data[bit >> 3] >> (7 - (bit & 7))) & 1;
}

const SINGLE = new DataView(new ArrayBuffer(4));

/** The number that the bits of a float stand for. @param {string} kind "float16" or "float32" @param {number} bits */
export function toFloat(kind, bits) {
  if (kind === "float16") return halfToNumber(bits);
  SINGLE.setUint32(0, bits);
  return SINGLE.getFloat32(0);
}

/** @param {number} bits */
function halfToNumber(bits) {
  const sign = bits & 0x8000 ? -1 : 1;
  const exponent = (bits >> 10) & 31;
  const fraction = bits & 1023;
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return sign * (exponent ? (1024 + fraction) * 2 ** (exponent - 25) : fraction * 2 ** -24);
}

/** What a byte does to a CRC-32; from 256 k on, with k bytes of zeros behind. */
const CRC_TABLE = new Uint32Array(2048);
for (let i = 0; i < 2048; i++) {
  let value = i < 256 ? i : CRC_TABLE[i - 256];
  for (let bit = 0; bit < 8; bit++) value = value & 1 ? 0xedb88320 ^ (value >>> 1) : value >>> 1;
  CRC_TABLE[i] = value;
}

/** What four bytes do, little-endian, with 0 or 4 bytes of zeros behind. @param {number} word @param {number} zeros times 256 */
function crcOf(word, zeros) {
  const [a, b, c, d] = [word & 255, (word >> 8) & 255, (word >> 16) & 255, word >>> 24];
  return CRC_TABLE[zeros + 768 + a] ^ CRC_TABLE[zeros + 512 + b] ^ CRC_TABLE[zeros + 256 + c] ^ CRC_TABLE[zeros + d];
}

/**
 * CRC-32 of ISO 3309 over all parts, one after the other.
 * @param {...Uint8Array} parts
 */
export function crc32(...parts) {
  let crc = -1;
  for (const part of parts) {
    const view = new DataView(part.buffer, part.byteOffset, part.length);
    let i = 0;
    // Eight at once take less than half of the time.
    for (; i + 8 <= part.length; i += 8) crc = crcOf(crc ^ view.getInt32(i, true), 1024) ^ crcOf(view.getInt32(i + 4, true), 0);
    for (; i < part.length; i++) crc = CRC_TABLE[(crc ^ part[i]) & 255] ^ (crc >>> 8);
  }
  return (crc ^ -1) >>> 0;
}
