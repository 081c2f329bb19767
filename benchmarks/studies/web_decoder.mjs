/**
 * Times of the JavaScript decoder in node: node web_decoder.mjs MODEL.nisp; JSON on standard output.
 *
 * Processor time of this process, the least of several runs: other programs change it little.
 */
import { readFileSync } from "node:fs";
import { parseNISP } from "../../web/decoder/document.js";
import { Arithmetic } from "../../web/evaluate/arithmetic.js";
import { gradient } from "../../web/evaluate/gradient.js";
import { NISPModel } from "../../web/evaluate/model.js";
import { extractMesh } from "../../web/extract/mesh.js";

const REPEATS = 7;
const POINTS = 100_000;

/** The least processor time in seconds, and that of the first run. */
function timed(work, repeats = REPEATS) {
  const times = [];
  for (let i = 0; i < repeats; i++) {
    const before = process.cpuUsage();
    work();
    const { user, system } = process.cpuUsage(before);
    times.push((user + system) / 1e6);
  }
  return { first: times[0], least: Math.min(...times) };
}

/** A network of sine layers as one writes it first: a loop for each point, layer, row and column. */
function plainLoops({ spec, layers }, points) {
  const found = new Float32Array(points.length / 3);
  for (let p = 0; p < found.length; p++) {
    let values = [0, 1, 2].map((axis) => {
      const value = points[3 * p + axis];
      return (spec.mirror >> axis) & 1 ? Math.abs(value) : value;
    });
    for (let axis = 0; axis < 3; axis++) if ((spec.mirror >> (3 + axis)) & 1) values.push(points[3 * p + axis]);
    for (let l = 0; l < layers.length; l++) {
      const { weight, bias } = layers[l];
      const next = new Array(bias.length);
      for (let i = 0; i < bias.length; i++) {
        let sum = bias[i];
        for (let j = 0; j < values.length; j++) sum += weight[i * values.length + j] * values[j];
        next[i] = l + 1 < layers.length ? Math.sin(spec.w0 * sum) : sum;
      }
      values = next;
    }
    found[p] = values[0];
  }
  return found;
}

const file = new Uint8Array(readFileSync(process.argv[2]));
const parse = timed(() => parseNISP(file), 30);
const document = parseNISP(file);
const points = new Float32Array(3 * POINTS).map(() => Math.random() * 2 - 1);
const models = { wasm: new NISPModel(document, new Arithmetic("wasm")), blocks: new NISPModel(document, new Arithmetic("plain")) };
const rate = (work) => Math.round(POINTS / timed(work).least);

/** Queries a second of a field: by plain loops, and by either kernel. */
function fieldQueries() {
  const spec = document.metadata.specs.get("sdf");
  const tensors = document.tensors.get("sdf");
  const layers = [...spec.hidden, 1].map((_, i) => ({ weight: tensors.get(`weight.${i}`).values, bias: tensors.get(`bias.${i}`).values }));
  const wanted = plainLoops({ spec, layers }, points);
  const off = models.wasm.sdf(points).reduce((most, value, i) => Math.max(most, Math.abs(value - wanted[i])), 0);
  const queries = {
    loops: rate(() => plainLoops({ spec, layers }, points)),
    blocks: rate(() => models.blocks.sdf(points)),
    wasm: rate(() => models.wasm.sdf(points)),
    wasm_gradient: rate(() => gradient(models.wasm, points)),
  };
  return { sdf_layers: [3, ...spec.hidden, 1], sdf_points_per_second: queries, wasm_over_loops: queries.wasm / queries.loops, wasm_less_loops: off };
}

/** Queries a second of triangles, few of them: they take a search each. */
function triangleQueries() {
  const few = points.subarray(0, (3 * POINTS) / 20);
  const triangles = document.parts.reduce((sum, part) => sum + part.faceCharts.length, 0);
  return { triangles, sdf_points_per_second: { triangles: Math.round(POINTS / 20 / timed(() => models.wasm.sdf(few)).least) } };
}

const meshes = Object.fromEntries(
  [128, 256].map((resolution) => {
    let mesh;
    const { first, least } = timed(() => (mesh = extractMesh(models.wasm, resolution)), 4);
    return [resolution, { first_seconds: first, seconds: least, triangles: mesh.indices.length / 3 }];
  }),
);
console.log(
  JSON.stringify({
    bytes: file.length,
    parse_seconds: { first: parse.first, least: parse.least },
    ...(document.metadata.specs.size ? fieldQueries() : triangleQueries()),
    meshes,
  }),
);
