import {
  ACTIVATIONS,
  CONDITIONINGS,
  ENCODINGS,
  MAX_HIDDEN_LAYERS,
  MAX_INIT_SEED,
  MAX_WIDTH,
  OUTPUTS,
} from "./enumerations.js";

/**
 * A network's topology.
 * @typedef {object} Spec
 * @property {number[]} hidden widths
 * @property {string} encoding
 * @property {number} levels
 * @property {string} conditioning
 * @property {number} embedding numbers a chart
 * @property {string} activation
 * @property {number} w0
 * @property {string} output
 * @property {number} mirror bits
 * @property {number} initSeed
 * @property {number} outputs
 * @property {number} charts
 */

/**
 * A tensor as its file has it: a matrix of rows and columns.
 * @typedef {{name: string, rows: number, columns: number}} Shape
 */

/**
 * @param {import("./record.js").Record} record
 * @param {string} name of the network
 * @param {number} outputs
 * @param {number} charts
 * @returns {Spec}
 */
export function readSpec(record, name, outputs, charts) {
  const hidden = readHidden(record);
  const encoding = record.choice(2, "encoding", ENCODINGS, "identity");
  const levels = record.integer(3, "levels", 0, 16, 0);
  const conditioning = record.choice(4, "conditioning", CONDITIONINGS, "none");
  const embedding = record.integer(5, "embedding", 0, 64, 0);
  const spec = {
    hidden,
    encoding,
    levels,
    conditioning,
    embedding,
    activation: record.choice(6, "activation", ACTIVATIONS, "sine"),
    w0: record.float(7, "w0", 30),
    output: record.choice(8, "output", OUTPUTS, "identity"),
    mirror: record.integer(9, "mirror", 0, 63, 0),
    initSeed: record.integer(10, "init_seed", 0, MAX_INIT_SEED, 0),
    outputs,
    charts,
  };
  record.finish();
  checkSpec(record, name, spec);
  return spec;
}

/** @param {import("./record.js").Record} record @returns {number[]} */
function readHidden(record) {
  const widths = record.array(1, "hidden", false) ?? [];
  record.limit("hidden layers", widths.length, MAX_HIDDEN_LAYERS);
  return widths.map((width) => {
    record.demand(typeof width === "number", "hidden", "integers", typeof width);
    record.limit("hidden", /** @type {number} */ (width), MAX_WIDTH, 1);
    return /** @type {number} */ (width);
  });
}

/** @param {import("./record.js").Record} record @param {string} name @param {Spec} spec */
function checkSpec(record, name, spec) {
  const fourier = spec.encoding === "fourier";
  record.demand(fourier === spec.levels > 0, "levels", "above 0 exactly for fourier", spec.levels);
  const none = spec.conditioning === "none";
  record.demand(none || name === "uv", "conditioning", "none but for uv", spec.conditioning);
  const embedded = spec.conditioning === "chart_affine";
  record.demand(embedded === spec.embedding > 0, "embedding", "above 0 exactly with one", spec.embedding);
  record.demand(spec.w0 > 0 && spec.w0 <= 1000, "w0", "above 0, at most 1000", spec.w0);
  record.demand(!((spec.mirror >> 3) & ~spec.mirror), "mirror", "a mirror where a side follows", spec.mirror);
}

/** How many coordinates enter, before encoding. @param {Spec} spec */
export function coordinateCount({ mirror, conditioning }) {
  const followers = [3, 4, 5].filter((bit) => (mirror >> bit) & 1).length;
  return 3 + followers + (conditioning === "scalar" ? 1 : 0);
}

/** Inputs of the first layer. @param {Spec} spec */
export function inputCount(spec) {
  return coordinateCount(spec) * (spec.encoding === "fourier" ? 2 * spec.levels : 1) + spec.embedding;
}

/** The tensors of a network, in file order. @param {Spec} spec @returns {Shape[]} */
export function shapesOf(spec) {
  const shapes = [];
  if (spec.conditioning === "chart_affine") {
    shapes.push({ name: "embedding", rows: spec.charts, columns: spec.embedding });
    shapes.push({ name: "slopes", rows: spec.charts, columns: spec.outputs * coordinateCount(spec) });
    shapes.push({ name: "offsets", rows: spec.charts, columns: spec.outputs });
  }
  const widths = [inputCount(spec), ...spec.hidden, spec.outputs];
  for (let i = 1; i < widths.length; i++) {
    shapes.push({ name: `weight.${i - 1}`, rows: widths[i], columns: widths[i - 1] });
    shapes.push({ name: `bias.${i - 1}`, rows: 1, columns: widths[i] });
  }
  return shapes;
}
