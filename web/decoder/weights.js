import { ByteReader } from "./bytes.js";
import { CODINGS, MAX_SYMBOL, MAX_WEIGHTS, STEPS } from "./enumerations.js";
import { initialWeights } from "./initial_weights.js";
import { readMatrix } from "./matrices.js";
import { readRunHeader, readStream } from "./stream.js";
import { shapesOf } from "./topology.js";

/**
 * @typedef {import("./topology.js").Spec} Spec
 * @typedef {import("./topology.js").Shape} Shape
 * @typedef {object} WeightRecord one record of NETS
 * @property {Shape[]} held tensors
 * @property {number} count of values
 * @property {number} bits that they take in the stream
 * @property {number|null} step
 * @property {Float64Array} values none yet where they are in the stream
 * @property {import("./stream.js").RunHeader} [header] where they are in the stream
 * @property {Float64Array} [predicted]
 * @property {Uint8Array|null} shifts of each value's row
 * @typedef {Map<string, {shape: Shape, values: Float32Array}>} Tensors
 */

/**
 * The weights of all networks (section 5 of the specification), and how many bytes each takes: its
 * records, and of the stream, which is one for all, what its bits are of all bits.
 * @param {Uint8Array} data
 * @param {Map<string, Spec>} specs in file order
 * @returns {{tensors: Map<string, Tensors>, lengths: Map<string, number>}}
 */
export function readWeights(data, specs) {
  const shapes = new Map([...specs].map(([name, spec]) => [name, shapesOf(spec)]));
  const total = [...shapes.values()].flat().reduce((sum, { rows, columns }) => sum + rows * columns, 0);
  const reader = new ByteReader(data, "NETS");
  reader.limit("weights", total, MAX_WEIGHTS);
  /** @type {Map<string, number>} */
  const lengths = new Map();
  const records = [...specs].map(([name, spec]) => {
    const start = reader.at;
    const found = readRecords(reader, shapes.get(name) ?? [], spec.initSeed);
    lengths.set(name, reader.at - start);
    return found;
  });
  const start = reader.at;
  fillFromStream(reader, records.flat());
  reader.finish();
  const bits = records.map((found) => found.reduce((sum, record) => sum + record.bits, 0));
  const all = bits.reduce((sum, each) => sum + each, 0) || 1;
  let [before, end] = [0, 0];
  [...lengths].forEach(([name, length], i) => {
    end += ((reader.at - start) * bits[i]) / all;
    lengths.set(name, length + Math.round(end) - Math.round(before));
    before = end;
  });
  const tensors = new Map([...specs.keys()].map((name, i) => [name, toTensors(reader, records[i])]));
  return { tensors, lengths };
}

/** Gives the records that are in the stream their values. @param {ByteReader} reader @param {WeightRecord[]} records */
function fillFromStream(reader, records) {
  const coded = records.filter((record) => record.header);
  const found = readStream(reader, coded.map((record) => /** @type {any} */ (record.header)));
  coded.forEach((record, i) => Object.assign(record, found[i]));
}

/** @param {ByteReader} reader @param {Shape[]} shapes @param {number} seed @returns {WeightRecord[]} */
function readRecords(reader, shapes, seed) {
  const records = [];
  let step = null;
  let place = 0;
  for (let at = 0; at < shapes.length; ) {
    const record = readRecord(reader, shapes.slice(at), step, seed, place);
    records.push(record);
    step = record.step;
    place += record.count;
    at += record.held.length;
  }
  return records;
}

/**
 * @param {ByteReader} reader
 * @param {Shape[]} left tensors that are still to come
 * @param {number|null} before the step of the record before
 * @param {number} seed
 * @param {number} place of the record's first value in the network
 * @returns {WeightRecord}
 */
function readRecord(reader, left, before, seed, place) {
  const { coding, form, joined } = readTag(reader, left.length);
  const held = left.slice(0, 1 + joined);
  const step = form === null ? null : readStep(reader, form, before);
  const shifts = form?.startsWith("rows") ? readRowShifts(reader, Number(form[4]), held) : null;
  const count = held.reduce((sum, { rows, columns }) => sum + rows * columns, 0);
  const record = { held, count, bits: 0, step, values: new Float64Array(0), shifts };
  if (coding === "delta_init") {
    reader.demand(step !== null, "step", "one with delta_init", "none");
    return { ...record, ...readDeltas(reader, record, seed, place) };
  }
  if (coding === "entropy") return { ...record, header: readRunHeader(reader, count, step !== null) };
  return { ...record, values: readMatrix(reader, coding, held[0].rows, held[0].columns, step !== null) };
}

/** @param {ByteReader} reader @param {number} left */
function readTag(reader, left) {
  const tag = reader.uint(1);
  // A tag of 0 is a wide one: what does not fit in the bits of one.
  const [number, form, joined] = tag ? [tag & 7, (tag >> 3) & 7, tag >> 6] : reader.bytes(3);
  const coding = CODINGS[number - 1];
  const fitting = number <= 7 && form <= 7 && joined <= 3;
  reader.demand(coding && form <= STEPS.length && (tag || !fitting), "coding", "a known coding and step, in the fewest bytes", number);
  const joinable = coding === "entropy" || coding === "delta_init";
  const fits = joined < left && (joinable || joined === 0);
  reader.demand(fits, "joined", "tensors that follow, in a coding that joins", joined);
  return { coding, form: form ? STEPS[form - 1] : null, joined };
}

/** @param {ByteReader} reader @param {string} form @param {number|null} before */
function readStep(reader, form, before) {
  const step = readRawStep(reader, form, before);
  reader.demand(step !== null && step > 0 && step < Infinity, "step", "finite and above 0", step);
  return /** @type {number} */ (step);
}

/** @param {ByteReader} reader @param {string} form @param {number|null} before */
function readRawStep(reader, form, before) {
  if (form === "same") return before;
  if (form.startsWith("float")) return reader.float(form);
  const byte = reader.uint(1);
  return (8 + (byte % 8)) * 2 ** ((byte >> 3) - 30);
}

/** The row shift of every value. @param {ByteReader} reader @param {number} bits @param {Shape[]} held */
function readRowShifts(reader, bits, held) {
  const rows = held.flatMap(({ rows, columns }) => new Array(rows).fill(columns));
  const shifts = reader.bits(rows.length, bits);
  const found = new Uint8Array(rows.reduce((sum, columns) => sum + columns, 0));
  let at = 0;
  rows.forEach((columns, row) => {
    found.fill(shifts[row], at, at + columns);
    at += columns;
  });
  return found;
}

/** @param {ByteReader} reader @param {WeightRecord} record @param {number} seed @param {number} place */
function readDeltas(reader, { held, count, shifts }, seed, place) {
  const predicted = new Float64Array(count);
  const initial = initialWeights(seed, place, count);
  let at = 0;
  for (const { rows, columns } of held) {
    const scale = reader.varint();
    reader.limit("initial scale", scale, MAX_SYMBOL);
    for (const end = at + rows * columns; at < end; at++) {
      const shift = shifts?.[at] ?? 0;
      predicted[at] = Math.floor((scale * initial[at] + 2 ** (22 + shift)) / 2 ** (23 + shift));
    }
  }
  return { predicted, header: readRunHeader(reader, count, true) };
}

/** @param {ByteReader} reader @param {WeightRecord[]} records @returns {Tensors} */
function toTensors(reader, records) {
  /** @type {Tensors} */
  const tensors = new Map();
  for (const record of records) {
    const weights = toWeights(reader, record);
    let at = 0;
    for (const shape of record.held) {
      const size = shape.rows * shape.columns;
      tensors.set(shape.name, { shape, values: weights.subarray(at, at + size) });
      at += size;
    }
  }
  return tensors;
}

/** @param {ByteReader} reader @param {WeightRecord} record */
function toWeights(reader, { values, step, predicted, shifts, count }) {
  const weights = new Float32Array(count);
  const rounded = step === null ? 1 : Math.fround(step);
  for (let i = 0; i < count; i++) {
    let value = values[i];
    if (step !== null) {
      value = (value + (predicted?.[i] ?? 0)) * 2 ** (shifts?.[i] ?? 0);
      reader.limit("symbol", value, MAX_SYMBOL, -MAX_SYMBOL);
    }
    // Adding 0 turns a negative zero into 0.
    weights[i] = Math.fround(value) * rounded + 0;
    reader.demand(Number.isFinite(weights[i]), "weight", "finite", weights[i]);
  }
  return weights;
}
