/**
 * Answers of the JavaScript decoder: node answers.mjs REQUEST.json, where the request names files
 * and has points, pixels of their images and which kernel to use; JSON on standard output.
 */
import { readFileSync } from "node:fs";
import { parseNISP } from "../../web/decoder/document.js";
import { Arithmetic } from "../../web/evaluate/arithmetic.js";
import { NISPModel } from "../../web/evaluate/model.js";

function pixels({ width, height, floats }) {
  const bytes = Buffer.from(floats, "base64");
  return { width, height, data: new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length)) };
}

function answer({ path, points, images, kernel }) {
  let document;
  try {
    document = parseNISP(new Uint8Array(readFileSync(path)));
  } catch (why) {
    return { error: why.name, section: why.section, field: why.field, message: why.message };
  }
  const model = new NISPModel(document, new Arithmetic(kernel));
  const asked = Float32Array.from(points.flat());
  const { gradients } = model.gradient(asked);
  return {
    sdf: [...model.sdf(asked)],
    chart: [...model.charts(asked)],
    uv: [...model.uv(asked)],
    color: [...model.color(asked, images.map(pixels))],
    gradient: [...gradients],
  };
}

const requests = JSON.parse(readFileSync(process.argv[2], "utf8"));
// Weights may overflow on purpose, and JSON has no infinities.
const text = JSON.stringify(requests.map(answer), (_, value) => (Number.isFinite(value) || typeof value !== "number" ? value : String(value)));
process.stdout.write(text);
