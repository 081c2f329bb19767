import { toFloat } from "./bytes.js";
import { MAX_CELLS, MAX_SYMBOL } from "./enumerations.js";
import { readNumberKind } from "./matrices.js";

/**
 * @typedef {import("./bytes.js").ByteReader} Bytes
 * @typedef {{narrowness: number, tail: number, zeros: number}} FrequencyModel
 * @typedef {object} RunHeader
 * @property {number} count of values
 * @property {string|null} kind of number; null for symbols
 * @property {number} top
 * @property {number} limit
 * @property {FrequencyModel|null} model
 */

const SCALE_BITS = 14;
const SCALE = 1 << SCALE_BITS;

/**
 * @param {Bytes} reader
 * @param {number} count
 * @param {boolean} symbols
 * @returns {RunHeader}
 */
export function readRunHeader(reader, count, symbols) {
  const kind = symbols ? null : readNumberKind(reader, ["float32", "float16"]);
  const top = symbols ? MAX_SYMBOL : reader.varint();
  const most = symbols ? MAX_SYMBOL : kind === "float32" ? 0x7f7fffff : 0x7bff;
  reader.limit("top", top, most);
  const limit = reader.varint();
  reader.limit("limit", limit, top);
  return { count, kind, top, limit, model: limit > 0 ? readModel(reader) : null };
}

/** @param {Bytes} reader @returns {FrequencyModel} */
function readModel(reader) {
  const byte = reader.uint(1);
  const zeros = byte & 128 ? reader.uint(1) : 0;
  reader.demand(byte < 128 || zeros, "zeros", "above 0", 0);
  return { narrowness: byte & 31, tail: (byte >> 5) & 3, zeros };
}

/**
 * Values of each record of the stream (section 5.4), and the bits that they take there.
 * @param {Bytes} reader
 * @param {RunHeader[]} headers
 * @returns {{values: Float64Array, bits: number}[]}
 */
export function readStream(reader, headers) {
  const runs = headers.map(({ count, limit, model }) => {
    const cells = cellsOf(limit).cells;
    return { count: model ? count : 0, cells, table: model ? frequencies(cells, model) : [] };
  });
  const tokens = readTokens(reader, runs);
  return headers.map((header, i) => {
    const integers = header.model ? readIntegers(reader, tokens[i], header.limit) : new Float64Array(header.count);
    const { kind, top } = header;
    const values = kind ? integers.map((n) => n && Math.sign(n) * toFloat(kind, top + 1 - Math.abs(n))) : integers;
    return { values, bits: bitsOf(tokens[i], runs[i], header.limit) };
  });
}

/** Tokens on either side of zero, and open bits. @param {number} limit */
function cellsOf(limit) {
  let open = 0;
  while (limit > MAX_CELLS * 2 ** open) open++;
  return { cells: Math.ceil(limit / 2 ** open), open };
}

/**
 * Integers that sum to 2^14, one for each token from -cells to cells.
 * Every number stays below 2^53, and every quotient below that of its gap: doubles are exact.
 * @param {number} cells
 * @param {FrequencyModel} model
 */
function frequencies(cells, { narrowness, tail, zeros }) {
  const ratio = (2 + (narrowness % 2)) * 2 ** (narrowness >> 1);
  const wide = 4 * cells * cells * 2 ** tail;
  const heights = Array.from({ length: cells + 1 }, (_, c) => {
    let height = Math.floor((wide * 2 ** 24) / (wide + ratio * c * c));
    for (let i = 0; i < tail; i++) height = Math.floor((height * height) / 2 ** 24);
    return height + 1;
  });
  if (zeros) heights[0] = 0;
  const total = heights.reduce((sum, height) => sum + 2 * height, -heights[0]);
  const free = SCALE - (2 * cells + 1);
  const shared = free - ((free * zeros) >> 8);
  const above = heights.slice(1).map((height) => 1 + Math.floor((height * shared) / total));
  const middle = SCALE - 2 * above.reduce((sum, each) => sum + each, 0);
  return [...above.toReversed(), middle, ...above];
}

/**
 * Signed tokens of each run.
 * @param {Bytes} reader
 * @param {{count: number, cells: number, table: number[]}[]} runs
 * @returns {Int32Array[]}
 */
function readTokens(reader, runs) {
  const total = runs.reduce((sum, run) => sum + run.count, 0);
  const lanes = total === 0 ? 0 : total < SCALE ? 1 : total >> 9;
  const states = Float64Array.from({ length: lanes }, () => reader.uint(2) * 65536 + reader.uint(2));
  reader.demand(states.every((state) => state >= 65536), "first_state", "2^16 or more");
  let lane = 0;
  const found = runs.map(({ count, cells, table }) => {
    const { slots, starts } = slotTable(table);
    const tokens = new Int32Array(count);
    for (let i = 0; i < count; i++) {
      const state = states[lane];
      const slot = state % SCALE;
      const token = slots[slot];
      tokens[i] = token - cells;
      const next = table[token] * Math.floor(state / SCALE) + slot - starts[token];
      states[lane] = next < 65536 ? next * 65536 + reader.uint(2) : next;
      if (++lane === lanes) lane = 0;
    }
    return tokens;
  });
  reader.demand(states.every((state) => state === 65536), "stream", "states of 2^16 at its end");
  return found;
}

/** What an ideal coder takes for tokens and their open bits. @param {Int32Array} tokens @param {{cells: number, table: number[]}} run @param {number} limit */
function bitsOf(tokens, { cells, table }, limit) {
  const { open } = cellsOf(limit);
  const costs = table.map((frequency, token) => SCALE_BITS - Math.log2(frequency) + (token === cells ? 0 : open));
  return tokens.reduce((sum, token) => sum + costs[token + cells], 0);
}

/** Which token has each slot, and where tokens start. @param {number[]} table */
function slotTable(table) {
  const slots = new Uint16Array(table.length ? SCALE : 0);
  let start = 0;
  const starts = table.map((frequency, token) => {
    slots.fill(token, start, start + frequency);
    start += frequency;
    return start - frequency;
  });
  return { slots, starts };
}

/** @param {Bytes} reader @param {Int32Array} tokens @param {number} limit */
function readIntegers(reader, tokens, limit) {
  const { open } = cellsOf(limit);
  const rest = reader.bits(tokens.reduce((count, token) => count + (token ? 1 : 0), 0), open);
  const integers = new Float64Array(tokens.length);
  let next = 0;
  tokens.forEach((token, i) => {
    if (token === 0) return;
    const size = (Math.abs(token) - 1) * 2 ** open + rest[next++] + 1;
    reader.limit("magnitude", size, limit);
    integers[i] = token < 0 ? -size : size;
  });
  return integers;
}
