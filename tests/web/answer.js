import { parseNISP } from "../../web/decoder/document.js";
import { Arithmetic } from "../../web/evaluate/arithmetic.js";
import { gradient } from "../../web/evaluate/gradient.js";
import { NISPModel } from "../../web/evaluate/model.js";

/**
 * What the decoder says of a file: answers at points, or why it refuses it.
 * @param {Uint8Array} file
 * @param {number[][]} points
 * @param {string} kernel
 * @param {(images: any[]) => Promise<any[]>} decode images to pixels
 */
export async function answer(file, points, kernel, decode) {
  let document;
  try {
    document = parseNISP(file);
  } catch (why) {
    return { error: why.name, section: why.section, field: why.field, message: why.message };
  }
  const model = new NISPModel(document, new Arithmetic(kernel));
  const asked = Float32Array.from(points.flat());
  return {
    sdf: [...model.sdf(asked)],
    chart: [...model.charts(asked)],
    uv: [...model.uv(asked)],
    color: [...model.color(asked, await decode(document.images))],
    bytes: Object.fromEntries(document.bytes),
    gradient: [...gradient(model, asked).gradients],
  };
}

/** JSON has no infinities, and weights may overflow on purpose. */
export function written(answers) {
  return JSON.stringify(answers, (_, value) => (typeof value === "number" && !Number.isFinite(value) ? String(value) : value));
}
