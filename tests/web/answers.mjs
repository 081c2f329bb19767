/**
 * Answers of the JavaScript decoder in node: node answers.mjs REQUESTS.json, where each request names
 * a file and has points, pixels of its images and which kernel to use; JSON on standard output.
 */
import { readFileSync } from "node:fs";
import { answer, written } from "./answer.js";

function pixels({ width, height, floats }) {
  const bytes = Buffer.from(floats, "base64");
  return { width, height, data: new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length)) };
}

const requests = JSON.parse(readFileSync(process.argv[2], "utf8"));
// As where a security policy forbids it.
if (requests.some(({ kernel }) => kernel === "plain")) delete globalThis.WebAssembly;
const answers = [];
for (const { path, points, images, kernel } of requests) {
  answers.push(await answer(new Uint8Array(readFileSync(path)), points, kernel, async () => images.map(pixels)));
}
process.stdout.write(written(answers));
