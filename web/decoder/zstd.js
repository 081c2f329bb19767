/**
 * One Zstandard frame (RFC 8878), without dictionary, of a known content size.
 *
 * Our own, because a page that `nisp view -o` writes must work from a Python wheel alone, without
 * npm: small rather than fast.
 */
import { NISPError } from "./errors.js";

const MAGIC = 0xfd2fb528;
const MAX_BLOCK = 1 << 17;
const LITERAL_LENGTHS = codeTable("0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15", [1, 1, 1, 1, 2, 2, 3, 3, 4, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16]);
const MATCH_LENGTHS = codeTable(
  "3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31 32 33 34",
  [1, 1, 1, 1, 2, 2, 3, 3, 4, 4, 5, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16],
);
const DEFAULT_LITERAL_LENGTHS = [4, 3, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 1, 1, 1, 2, 2, 2, 2, 2, 2, 2, 2, 2, 3, 2, 1, 1, 1, 1, 1, -1, -1, -1, -1];
const DEFAULT_MATCH_LENGTHS = [
  1, 4, 3, 2, 2, 2, 2, 2, 2, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, -1, -1, -1, -1,
  -1, -1, -1,
];
const DEFAULT_OFFSETS = [1, 1, 1, 1, 1, 1, 2, 2, 2, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, -1, -1, -1, -1, -1];

/**
 * The codes of a length: those that are their own value, then one for each number of extra bits.
 * @param {string} plain
 * @param {number[]} extra
 */
function codeTable(plain, extra) {
  const base = plain.split(" ").map(Number);
  const bits = base.map(() => 0);
  let next = base[base.length - 1] + 1;
  for (const width of extra) {
    base.push(next);
    bits.push(width);
    next += 2 ** width;
  }
  return { base, bits };
}

/**
 * @param {Uint8Array} data the frame, and nothing after it
 * @param {number} size of the content, which the frame must state
 * @param {string} section that errors name
 */
export function unzstd(data, size, section) {
  try {
    return new Frame(data, size).decode();
  } catch (why) {
    if (!(why instanceof Malformed || why instanceof RangeError)) throw why;
    throw new NISPError(section, "zstd frame", `one sound frame of ${size} bytes`, why.message);
  }
}

class Malformed extends Error {}

/** @param {unknown} holds @param {string} found @returns {asserts holds} */
function sound(holds, found) {
  if (!holds) throw new Malformed(found);
}

/** @typedef {{bits: number, symbol: Uint8Array, width: Uint8Array, base: Uint16Array}} FSETable */

class Frame {
  /** @param {Uint8Array} data @param {number} size */
  constructor(data, size) {
    this.data = data;
    this.view = new DataView(data.buffer, data.byteOffset, data.byteLength);
    this.size = size;
    this.at = 0;
    this.out = new Uint8Array(size);
    this.written = 0;
    this.offsets = [1, 4, 8];
    /** @type {{bits: number, symbol: Uint8Array, width: Uint8Array}|null} */
    this.huffman = null;
    /** @type {(FSETable|null)[]} */
    this.tables = [null, null, null];
  }

  decode() {
    this.header();
    let last = 0;
    while (!last) last = this.block();
    sound(this.written === this.size, `${this.written} bytes of content`);
    sound(this.at === this.data.length, "bytes after it");
    return this.out;
  }

  header() {
    sound(this.view.getUint32(0, true) === MAGIC, "another magic number");
    const descriptor = this.view.getUint8(4);
    const single = descriptor & 32;
    const form = descriptor >> 6;
    this.at = 5;
    sound(!(descriptor & 8), "a reserved bit");
    if (!single) this.at++;
    sound(!(descriptor & 7), "a dictionary or a checksum");
    sound(form || single, "no content size");
    const stated = [
      () => this.view.getUint8(this.at),
      () => this.view.getUint16(this.at, true) + 256,
      () => this.view.getUint32(this.at, true),
      () => Number(this.view.getBigUint64(this.at, true)),
    ][form]();
    this.at += 1 << form;
    sound(stated === this.size, `a content size of ${stated}`);
  }

  /** Decodes one block; whether it was the last. */
  block() {
    const head = this.view.getUint16(this.at, true) | (this.view.getUint8(this.at + 2) << 16);
    const size = head >> 3;
    const kind = (head >> 1) & 3;
    this.at += 3;
    sound(size <= MAX_BLOCK, "a block that is too large");
    sound(this.at + (kind === 1 ? 1 : size) <= this.data.length, "a block that is cut off");
    if (kind === 0) this.put(this.data.subarray(this.at, this.at + size));
    else if (kind === 1) this.put(new Uint8Array(size).fill(this.data[this.at]));
    else {
      sound(kind === 2, "a reserved block type");
      this.compressed(this.at, this.at + size);
    }
    this.at += kind === 1 ? 1 : size;
    return head & 1;
  }

  /** @param {Uint8Array} bytes */
  put(bytes) {
    sound(this.written + bytes.length <= this.size, "more content than stated");
    this.out.set(bytes, this.written);
    this.written += bytes.length;
  }

  /** @param {number} at @param {number} end */
  compressed(at, end) {
    const literals = this.literals(at, end);
    at = literals.end;
    let count = this.data[at++];
    if (count === 255) {
      count = this.data[at] + (this.data[at + 1] << 8) + 0x7f00;
      at += 2;
    } else if (count > 127) count = ((count - 128) << 8) + this.data[at++];
    sound(at <= end, "a block that is cut off");
    if (count === 0) {
      sound(at === end, "bytes after a block");
      this.put(literals.bytes);
      return;
    }
    const modes = this.data[at++];
    sound(!(modes & 3), "reserved modes");
    const kinds = [
      { most: 35, log: 9, plain: DEFAULT_LITERAL_LENGTHS, bits: 6 },
      { most: 31, log: 8, plain: DEFAULT_OFFSETS, bits: 5 },
      { most: 52, log: 9, plain: DEFAULT_MATCH_LENGTHS, bits: 6 },
    ];
    kinds.forEach((kind, i) => {
      at = this.sequenceTable(i, (modes >> (6 - 2 * i)) & 3, kind, at, end);
    });
    this.sequences(count, literals.bytes, new BackwardBits(this.data, at, end));
  }

  /**
   * @param {number} number 0 literal lengths, 1 offsets, 2 match lengths
   * @param {number} mode
   * @param {{most: number, log: number, plain: number[], bits: number}} kind
   * @param {number} at
   * @param {number} end
   */
  sequenceTable(number, mode, kind, at, end) {
    if (mode === 0) this.tables[number] = fseTable(kind.plain, kind.bits);
    if (mode === 1) {
      sound(at < end && this.data[at] <= kind.most, "an unknown symbol");
      this.tables[number] = fseTable(oneSymbol(this.data[at++]), 0);
    }
    if (mode === 2) {
      const found = readFSE(this.data, at, end, kind.log, kind.most);
      this.tables[number] = found.table;
      at = found.end;
    }
    sound(this.tables[number], "a table to repeat that is not there");
    return at;
  }

  /** @param {number} count @param {Uint8Array} literals @param {BackwardBits} bits */
  sequences(count, literals, bits) {
    const tables = /** @type {FSETable[]} */ (this.tables);
    const states = tables.map((table) => bits.read(table.bits));
    let from = 0;
    for (let i = 0; i < count; i++) {
      const [literal, offset, match] = tables.map((table, k) => table.symbol[states[k]]);
      const distance = 2 ** offset + bits.read(offset);
      const length = MATCH_LENGTHS.base[match] + bits.read(MATCH_LENGTHS.bits[match]);
      const run = LITERAL_LENGTHS.base[literal] + bits.read(LITERAL_LENGTHS.bits[literal]);
      sound(from + run <= literals.length, "too few literals");
      this.put(literals.subarray(from, from + run));
      from += run;
      this.copy(this.offset(distance, run), length);
      if (i + 1 < count) {
        for (const k of [0, 2, 1]) states[k] = tables[k].base[states[k]] + bits.read(tables[k].width[states[k]]);
      }
    }
    sound(bits.left === 0, "bits after the sequences");
    this.put(literals.subarray(from));
  }

  /** The distance that an offset value means, by the last three. @param {number} value @param {number} run */
  offset(value, run) {
    const known = this.offsets;
    if (value > 3) {
      this.offsets = [value - 3, known[0], known[1]];
      return value - 3;
    }
    const place = value - 1 + (run === 0 ? 1 : 0);
    if (place === 0) return known[0];
    const found = place === 3 ? known[0] - 1 : known[place];
    this.offsets = place === 1 ? [found, known[0], known[2]] : [found, known[0], known[1]];
    return found;
  }

  /** @param {number} distance @param {number} length */
  copy(distance, length) {
    sound(distance > 0 && distance <= this.written, "an offset before the start");
    sound(this.written + length <= this.size, "more content than stated");
    const { out } = this;
    for (let i = 0; i < length; i++, this.written++) out[this.written] = out[this.written - distance];
  }

  /** @param {number} at @param {number} end @returns {{bytes: Uint8Array, end: number}} */
  literals(at, end) {
    const kind = this.data[at] & 3;
    const form = (this.data[at] >> 2) & 3;
    if (kind > 1) return this.huffmanLiterals(kind, form, at, end);
    const width = form === 3 ? 3 : form === 1 ? 2 : 1;
    let size = 0;
    for (let i = width; i-- > 0; ) size = size * 256 + this.data[at + i];
    size = Math.floor(size / (width === 1 ? 8 : 16));
    at += width;
    const stored = kind === 0 ? size : 1;
    sound(size <= MAX_BLOCK && at + stored <= end, "literals that are cut off");
    const bytes = kind === 0 ? this.data.subarray(at, at + size) : new Uint8Array(size).fill(this.data[at]);
    return { bytes, end: at + stored };
  }

  /** @param {number} kind @param {number} form @param {number} at @param {number} end */
  huffmanLiterals(kind, form, at, end) {
    const width = form < 2 ? 3 : form + 2;
    const bits = form < 2 ? 10 : form === 2 ? 14 : 18;
    sound(at + width <= end, "literals that are cut off");
    let head = 0;
    for (let i = width; i-- > 0; ) head = head * 256 + this.data[at + i];
    head = Math.floor(head / 16);
    const size = head % 2 ** bits;
    const stop = at + width + Math.floor(head / 2 ** bits);
    sound(stop <= end && size <= MAX_BLOCK, "literals that are cut off");
    at += width;
    if (kind === 2) at = this.huffmanTable(at, stop);
    sound(this.huffman, "a Huffman table to repeat that is not there");
    const bytes = new Uint8Array(size);
    if (form === 0) this.huffmanStream(bytes, at, stop);
    else this.fourStreams(bytes, at, stop);
    return { bytes, end: stop };
  }

  /** @param {Uint8Array} bytes @param {number} at @param {number} stop */
  fourStreams(bytes, at, stop) {
    sound(at + 6 <= stop, "streams that are cut off");
    const share = Math.ceil(bytes.length / 4);
    sound(3 * share <= bytes.length, "too few literals for four streams");
    let start = at + 6;
    for (let i = 0; i < 4; i++) {
      const end = i < 3 ? start + this.view.getUint16(at + 2 * i, true) : stop;
      sound(end <= stop, "streams that are cut off");
      this.huffmanStream(bytes.subarray(i * share, i < 3 ? (i + 1) * share : bytes.length), start, end);
      start = end;
    }
  }

  /** @param {Uint8Array} bytes @param {number} at @param {number} stop */
  huffmanStream(bytes, at, stop) {
    const { bits: most, symbol, width } = /** @type {NonNullable<typeof this.huffman>} */ (this.huffman);
    const bits = new BackwardBits(this.data, at, stop);
    for (let i = 0; i < bytes.length; i++) {
      const code = bits.peek(most);
      bytes[i] = symbol[code];
      bits.skip(width[code]);
    }
    sound(bits.left === 0, "bits after the literals");
  }

  /** Reads the weights of a Huffman code; where they end. @param {number} at @param {number} stop */
  huffmanTable(at, stop) {
    const head = this.data[at++];
    const end = head < 128 ? at + head : at + ((head - 126) >> 1);
    sound(end <= stop, "a Huffman table that is cut off");
    const weights = head < 128 ? fseWeights(this.data, at, end) : [];
    for (let i = 0; i < head - 127; i++) weights.push((this.data[at + (i >> 1)] >> (i & 1 ? 0 : 4)) & 15);
    this.huffman = huffmanTable(weights);
    return end;
  }
}

/** Bits from the last byte to the first; what is asked for beyond the start is 0 and counts. */
class BackwardBits {
  /** @param {Uint8Array} data @param {number} start @param {number} end */
  constructor(data, start, end) {
    sound(end > start && data[end - 1], "a bit string without its mark");
    this.data = data;
    this.start = start;
    this.left = 8 * (end - start) - Math.clz32(data[end - 1]) + 23;
  }

  /** @param {number} count @returns {number} */
  read(count) {
    let value = 0;
    for (let rest = count; rest > 0; ) {
      const part = Math.min(rest, 16);
      value = value * 2 ** part + this.peek(part);
      this.skip(part);
      rest -= part;
    }
    sound(this.left >= 0, "a bit string that is cut off");
    return value;
  }

  /** The next bits, at most 16. @param {number} count */
  peek(count) {
    const { data } = this;
    const low = this.left - count;
    const byte = this.start + (low >> 3);
    let word = 0;
    if (low >= 0) word = data[byte] | (data[byte + 1] << 8) | (data[byte + 2] << 16);
    else for (let i = 2; i >= 0; i--) word = (word << 8) | (byte + i >= this.start ? data[byte + i] : 0);
    return (word >> (low & 7)) & ((1 << count) - 1);
  }

  /** @param {number} count */
  skip(count) {
    this.left -= count;
  }
}

/** @param {number} symbol */
function oneSymbol(symbol) {
  const counts = new Array(symbol + 1).fill(0);
  counts[symbol] = 1;
  return counts;
}

/**
 * A decoding table; counts of -1 are symbols of less than one.
 * @param {number[]} counts they sum to 2^bits
 * @param {number} bits
 * @returns {FSETable}
 */
function fseTable(counts, bits) {
  const size = 1 << bits;
  const symbol = new Uint8Array(size);
  let high = size;
  counts.forEach((count, i) => {
    if (count === -1) symbol[--high] = i;
  });
  const step = (size >> 1) + (size >> 3) + 3;
  let place = 0;
  counts.forEach((count, i) => {
    for (let k = 0; k < count; k++) {
      symbol[place] = i;
      do place = (place + step) & (size - 1);
      while (place >= high && size > 1);
    }
  });
  const next = counts.map(Math.abs);
  const width = new Uint8Array(size);
  const base = new Uint16Array(size);
  for (let i = 0; i < size; i++) {
    const state = next[symbol[i]]++;
    width[i] = bits - 31 + Math.clz32(state);
    base[i] = (state << width[i]) - size;
  }
  return { bits, symbol, width, base };
}

/**
 * A table description, which is read from the front.
 * @param {Uint8Array} data
 * @param {number} start
 * @param {number} end
 * @param {number} most bits of the table
 * @param {number} last symbol
 */
function readFSE(data, start, end, most, last) {
  let bit = 8 * start;
  const peek = (/** @type {number} */ count) => {
    let value = 0;
    for (let i = 0; i < count; i++) {
      const at = bit + i;
      if (at >> 3 < end) value |= ((data[at >> 3] >> (at & 7)) & 1) << i;
    }
    return value;
  };
  const bits = 5 + peek(4);
  bit += 4;
  sound(bits <= most, "a table that is too large");
  /** @type {number[]} */
  const counts = [];
  let left = (1 << bits) + 1;
  while (left > 1) {
    sound(counts.length <= last && bit <= 8 * end, "a table of too many symbols");
    const width = 32 - Math.clz32(left);
    const short = (1 << width) - 1 - left;
    const low = peek(width - 1);
    let value = low;
    if (low < short) bit += width - 1;
    else {
      value = peek(width);
      if (value >= 1 << (width - 1)) value -= short;
      bit += width;
    }
    counts.push(value - 1);
    left -= Math.abs(value - 1);
    if (value !== 1) continue;
    for (let more = 3; more === 3; ) {
      more = peek(2);
      bit += 2;
      for (let i = 0; i < more; i++) counts.push(0);
      sound(counts.length <= last + 1, "a table of too many symbols");
    }
  }
  const stop = (bit + 7) >> 3;
  sound(left === 1 && stop <= end, "a table that does not sum");
  return { table: fseTable(counts, bits), end: stop };
}

/** Weights of a Huffman code by two states that take turns. @param {Uint8Array} data @param {number} at @param {number} end */
function fseWeights(data, at, end) {
  const { table, end: start } = readFSE(data, at, end, 6, 255);
  const bits = new BackwardBits(data, start, end);
  const states = [bits.read(table.bits), bits.read(table.bits)];
  /** @type {number[]} */
  const weights = [];
  for (let turn = 0; ; turn ^= 1) {
    const state = states[turn];
    weights.push(table.symbol[state]);
    sound(weights.length < 256, "too many weights");
    if (bits.left < table.width[state]) {
      weights.push(table.symbol[states[turn ^ 1]]);
      return weights;
    }
    states[turn] = table.base[state] + bits.read(table.width[state]);
  }
}

/** @param {number[]} weights of all symbols but the last, whose weight follows from them */
function huffmanTable(weights) {
  const sum = weights.reduce((total, weight) => total + (weight ? 1 << (weight - 1) : 0), 0);
  sound(sum > 0, "a Huffman code without symbols");
  const bits = 32 - Math.clz32(sum);
  const rest = (1 << bits) - sum;
  sound(bits <= 11 && (rest & (rest - 1)) === 0 && weights.length < 256, "a Huffman code that does not sum");
  const all = [...weights, 32 - Math.clz32(rest)];
  const symbol = new Uint8Array(1 << bits);
  const width = new Uint8Array(1 << bits);
  let place = 0;
  for (let weight = 1; weight <= bits; weight++) {
    all.forEach((found, i) => {
      if (found !== weight) return;
      const end = place + (1 << (weight - 1));
      symbol.fill(i, place, end);
      width.fill(bits + 1 - weight, place, end);
      place = end;
    });
  }
  return { bits, symbol, width };
}
