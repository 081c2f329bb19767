/**
 * One Zstandard frame (RFC 8878), without dictionary, of a known content size.
 *
 * Our own, because a page that `nisp view -o` writes must work from a Python wheel alone, without
 * npm: small rather than fast.
 */
import { ByteReader } from "./bytes.js";

const MAGIC = 0xfd2fb528;
const MAX_BLOCK = 1 << 17;

const CUT_OFF = "one that is cut off";
const LEFT_OVER = "bytes left over";
const RESERVED = "a reserved value";
const UNEVEN = "a code that does not sum";
const OTHER_SIZE = "another size";
const NO_TABLE = "a table to repeat that is not there";

/** @typedef {{bits: number, symbol: ArrayLike<number>, width: ArrayLike<number>, base: ArrayLike<number>}} FSETable */

/** Literal lengths, offsets, match lengths: the last symbol, the bits of a table at most, of the default one, and its counts. */
const KINDS = [
  { most: 35, log: 9, bits: 6, plain: [4, 3, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 1, 1, 1, 2, 2, 2, 2, 2, 2, 2, 2, 2, 3, 2, 1, 1, 1, 1, 1, -1, -1, -1, -1] },
  { most: 31, log: 8, bits: 5, plain: [1, 1, 1, 1, 1, 1, 2, 2, 2, ...ones(15), -1, -1, -1, -1, -1] },
  { most: 52, log: 9, bits: 6, plain: [1, 4, 3, 2, 2, 2, 2, 2, 2, ...ones(37), -1, -1, -1, -1, -1, -1, -1] },
];

/** @param {number} count */
function ones(count) {
  return new Array(count).fill(1);
}

const LITERAL_LENGTHS = codeTable(0, 16, [1, 1, 1, 1, 2, 2, 3, 3, 4, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16]);
const MATCH_LENGTHS = codeTable(3, 32, [1, 1, 1, 1, 2, 2, 3, 3, 4, 4, 5, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16]);

/** The codes of a length: some without extra bits, then one for each number of them. @param {number} next @param {number} plain @param {number[]} extra */
function codeTable(next, plain, extra) {
  const bits = [...new Array(plain).fill(0), ...extra];
  return { bits, base: bits.map((width) => (next += 2 ** width) - 2 ** width) };
}

/**
 * @param {Uint8Array} data the frame, and nothing after it
 * @param {number} size of the content, which the frame must state
 * @param {string} section that errors name
 */
export function unzstd(data, size, section) {
  return new Frame(data, size, section).decode();
}

class Frame extends ByteReader {
  /** @param {Uint8Array} data @param {number} size @param {string} section */
  constructor(data, size, section) {
    super(data, section, "zstd frame: ");
    this.out = new Uint8Array(size);
    this.written = 0;
    this.offsets = [1, 4, 8];
    /** @type {{bits: number, symbol: Uint8Array, width: Uint8Array}|null} */
    this.huffman = null;
    /** @type {FSETable[]} */
    this.tables = [];
  }

  /** @param {unknown} holds @param {string} found */
  sound(holds, found) {
    if (!holds) this.demand(false, "content", `${this.out.length} sound bytes`, found);
  }

  decode() {
    this.#header();
    while (!this.#block());
    this.sound(this.written === this.out.length, OTHER_SIZE);
    this.finish();
    return this.out;
  }

  #header() {
    this.sound(this.uint(4) === MAGIC, "another magic number");
    const descriptor = this.uint(1);
    const form = descriptor >> 6;
    this.sound(!(descriptor & 15), "a dictionary, a checksum or a reserved bit");
    if (!(descriptor & 32)) {
      this.sound(form, "no content size");
      this.skip(1);
    }
    this.sound(this.uint(1 << form) + (form === 1 ? 256 : 0) === this.out.length, OTHER_SIZE);
  }

  /** Decodes one block; whether it was the last. */
  #block() {
    const head = this.uint(3);
    const size = head >> 3;
    const kind = (head >> 1) & 3;
    this.sound(kind < 3 && size <= MAX_BLOCK, RESERVED);
    const start = this.skip(kind === 1 ? 1 : size);
    if (kind === 2) this.#within(start, this.at, () => this.#compressed());
    else this.#put(this.#repeated(kind, start, size));
    return head & 1;
  }

  /** Bytes as they are, or one of them so many times. @param {number} kind @param {number} start @param {number} size */
  #repeated(kind, start, size) {
    return kind ? new Uint8Array(size).fill(this.data[start]) : this.data.subarray(start, start + size);
  }

  /** Reads a part, which must end where it says. @template T @param {number} start @param {number} end @param {() => T} read */
  #within(start, end, read) {
    const outer = this.end;
    [this.at, this.end] = [start, end];
    const found = read();
    this.finish();
    this.end = outer;
    return found;
  }

  /** @param {Uint8Array} bytes */
  #put(bytes) {
    this.sound(this.written + bytes.length <= this.out.length, OTHER_SIZE);
    this.out.set(bytes, this.written);
    this.written += bytes.length;
  }

  #compressed() {
    const literals = this.#literals();
    let count = this.uint(1);
    if (count > 127) count = count < 255 ? (count - 128) * 256 + this.uint(1) : this.uint(2) + 0x7f00;
    if (!count) return this.#put(literals);
    const modes = this.uint(1);
    this.sound(!(modes & 3), RESERVED);
    KINDS.forEach((kind, i) => this.#sequenceTable(i, (modes >> (6 - 2 * i)) & 3, kind));
    this.#sequences(count, literals, this.#backwards());
  }

  /** @param {number} number of the kind @param {number} mode @param {typeof KINDS[0]} kind */
  #sequenceTable(number, mode, { plain, bits, log, most }) {
    if (mode === 0) this.tables[number] = fseTable(plain, bits);
    if (mode === 1) {
      const symbol = this.uint(1);
      this.sound(symbol <= most, RESERVED);
      this.tables[number] = { bits: 0, symbol: [symbol], width: [0], base: [0] };
    }
    if (mode === 2) this.tables[number] = this.#readFSE(log, most);
    this.sound(this.tables[number], NO_TABLE);
  }

  /** What is left of the part, as bits from its end. */
  #backwards() {
    const start = this.at;
    return new BackwardBits(this, start, (this.at = this.end));
  }

  /** @param {number} count @param {Uint8Array} literals @param {BackwardBits} bits */
  #sequences(count, literals, bits) {
    const { tables } = this;
    const states = tables.map((table) => bits.read(table.bits));
    let from = 0;
    while (count--) {
      const [literal, offset, match] = tables.map((table, k) => table.symbol[states[k]]);
      const distance = 2 ** offset + bits.read(offset);
      const length = MATCH_LENGTHS.base[match] + bits.read(MATCH_LENGTHS.bits[match]);
      const run = LITERAL_LENGTHS.base[literal] + bits.read(LITERAL_LENGTHS.bits[literal]);
      this.sound(from + run <= literals.length, CUT_OFF);
      this.#put(literals.subarray(from, (from += run)));
      this.#copy(this.#offset(distance, run), length);
      if (count) for (const k of [0, 2, 1]) states[k] = tables[k].base[states[k]] + bits.read(tables[k].width[states[k]]);
    }
    this.sound(!bits.left, LEFT_OVER);
    this.#put(literals.subarray(from));
  }

  /** The distance that an offset value means, by the last three. @param {number} value @param {number} run */
  #offset(value, run) {
    const known = this.offsets;
    const place = value > 3 ? 3 : value - (run ? 1 : 0);
    const found = value > 3 ? value - 3 : place < 3 ? known[place] : known[0] - 1;
    known.splice(Math.min(place, 2), 1);
    known.unshift(found);
    return found;
  }

  /** @param {number} distance @param {number} length */
  #copy(distance, length) {
    this.sound(distance > 0 && distance <= this.written, "an offset before the start");
    this.sound(this.written + length <= this.out.length, OTHER_SIZE);
    const { out } = this;
    for (let i = 0; i < length; i++, this.written++) out[this.written] = out[this.written - distance];
  }

  #literals() {
    const head = this.data[this.at];
    const [kind, form] = [head & 3, (head >> 2) & 3];
    if (kind > 1) return this.#huffmanLiterals(kind, form);
    const size = form & 1 ? this.uint(form === 1 ? 2 : 3) >> 4 : this.uint(1) >> 3;
    this.sound(size <= MAX_BLOCK, RESERVED);
    return this.#repeated(kind, this.skip(kind ? 1 : size), size);
  }

  /** @param {number} kind @param {number} form */
  #huffmanLiterals(kind, form) {
    const long = Math.max(form - 1, 0);
    const head = Math.floor(this.uint(3 + long) / 16);
    const range = 2 ** (10 + 4 * long);
    const size = head % range;
    this.sound(size <= MAX_BLOCK, RESERVED);
    const start = this.skip(Math.floor(head / range));
    const bytes = new Uint8Array(size);
    this.#within(start, this.at, () => {
      if (kind === 2) this.#huffmanTable();
      this.sound(this.huffman, NO_TABLE);
      if (form) this.#fourStreams(bytes);
      else this.#huffmanStream(bytes);
    });
    return bytes;
  }

  /** @param {Uint8Array} bytes */
  #fourStreams(bytes) {
    const lengths = [2, 2, 2].map((width) => this.uint(width));
    const share = Math.ceil(bytes.length / 4);
    this.sound(3 * share <= bytes.length, OTHER_SIZE);
    lengths.forEach((length, i) => {
      const start = this.skip(length);
      this.#within(start, this.at, () => this.#huffmanStream(bytes.subarray(i * share, (i + 1) * share)));
    });
    this.#huffmanStream(bytes.subarray(3 * share));
  }

  /** @param {Uint8Array} bytes */
  #huffmanStream(bytes) {
    const { bits: most, symbol, width } = /** @type {NonNullable<typeof this.huffman>} */ (this.huffman);
    const bits = this.#backwards();
    for (let i = 0; i < bytes.length; i++) {
      const code = bits.peek(most);
      bytes[i] = symbol[code];
      bits.left -= width[code];
    }
    this.sound(!bits.left, LEFT_OVER);
  }

  #huffmanTable() {
    const head = this.uint(1);
    const start = this.skip(head < 128 ? head : (head - 126) >> 1);
    const weights = head < 128 ? this.#within(start, this.at, () => this.#fseWeights()) : [];
    for (let i = 0; i < head - 127; i++) weights.push((this.data[start + (i >> 1)] >> (i & 1 ? 0 : 4)) & 15);
    this.huffman = this.#huffmanCode(weights);
  }

  /** @param {number[]} weights of all symbols but the last, whose weight follows from them */
  #huffmanCode(weights) {
    const sum = weights.reduce((total, weight) => total + ((1 << weight) >> 1), 0);
    const bits = 32 - Math.clz32(sum);
    const rest = (1 << bits) - sum;
    this.sound(sum && bits <= 11 && !(rest & (rest - 1)) && weights.length < 256, UNEVEN);
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

  /** Weights of a Huffman code by two states that take turns. */
  #fseWeights() {
    const { bits: size, symbol, width, base } = this.#readFSE(6, 255);
    const bits = this.#backwards();
    const states = [bits.read(size), bits.read(size)];
    /** @type {number[]} */
    const weights = [];
    for (let turn = 0; ; turn ^= 1) {
      this.sound(weights.length < 255, UNEVEN);
      const state = states[turn];
      weights.push(symbol[state]);
      if (bits.left < width[state]) return [...weights, symbol[states[turn ^ 1]]];
      states[turn] = base[state] + bits.read(width[state]);
    }
  }

  /** A table description, bits from the front. @param {number} most bits of the table @param {number} last symbol */
  #readFSE(most, last) {
    const { data, end } = this;
    let bit = 8 * this.at;
    const peek = (/** @type {number} */ count) => {
      let value = 0;
      for (let at = bit + count; at-- > bit; ) value = 2 * value + (at < 8 * end ? (data[at >> 3] >> (at & 7)) & 1 : 0);
      return value;
    };
    const bits = 5 + peek(4);
    bit += 4;
    this.sound(bits <= most, RESERVED);
    /** @type {number[]} */
    const counts = [];
    for (let left = (1 << bits) + 1; left > 1; ) {
      const width = 31 - Math.clz32(left);
      const short = 2 ** (width + 1) - 1 - left;
      let value = peek(width);
      if (value < short) bit += width;
      else {
        value = peek(width + 1);
        if (value >= 2 ** width) value -= short;
        bit += width + 1;
      }
      counts.push(value - 1);
      left -= Math.abs(value - 1);
      this.sound(left > 0, UNEVEN);
      for (let more = value === 1 ? 3 : 0; more === 3; ) {
        more = peek(2);
        bit += 2;
        for (let i = 0; i < more; i++) counts.push(0);
      }
      this.sound(counts.length <= last + 1 && bit <= 8 * end, UNEVEN);
    }
    this.at = (bit + 7) >> 3;
    return fseTable(counts, bits);
  }
}

/** Bits from the last byte to the first; what is asked for beyond the start is 0 and counts. */
class BackwardBits {
  /** @param {Frame} frame @param {number} start @param {number} end */
  constructor(frame, start, end) {
    const { data } = frame;
    frame.sound(end > start && data[end - 1], CUT_OFF);
    this.frame = frame;
    this.data = data;
    this.start = start;
    this.left = 8 * (end - start) - Math.clz32(data[end - 1]) + 23;
  }

  /** @param {number} count @returns {number} */
  read(count) {
    if (count > 16) return this.read(count - 16) * 65536 + this.read(16);
    const value = this.peek(count);
    this.left -= count;
    this.frame.sound(this.left >= 0, CUT_OFF);
    return value;
  }

  /** The next bits, at most 16. @param {number} count */
  peek(count) {
    const low = this.left - count;
    let word = 0;
    for (let i = (low >> 3) + 2; i >= low >> 3; i--) word = (word << 8) | (i < 0 ? 0 : this.data[this.start + i]);
    return (word >> (low & 7)) & ((1 << count) - 1);
  }
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
    if (count < 0) symbol[--high] = i;
  });
  let place = 0;
  counts.forEach((count, i) => {
    for (; count > 0; count--) {
      symbol[place] = i;
      do place = (place + (size >> 1) + (size >> 3) + 3) & (size - 1);
      while (place >= high);
    }
  });
  const next = counts.map(Math.abs);
  const states = Array.from(symbol, (each) => next[each]++);
  const width = states.map((state) => bits - 31 + Math.clz32(state));
  return { bits, symbol, width, base: states.map((state, i) => (state << width[i]) - size) };
}
