/**
 * What the JavaScript decoder makes of contents of MESH: node meshes.mjs CONTENTS.json, base64 each;
 * and of whole files: node meshes.mjs --extract FILE.... JSON on standard output.
 */
import { readFileSync } from "node:fs";
import { parseNISP } from "../../web/decoder/document.js";
import { readMesh } from "../../web/decoder/mesh/section.js";
import { NISPModel } from "../../web/evaluate/model.js";
import { extractMesh } from "../../web/extract/mesh.js";

const plain = (_, value) => (ArrayBuffer.isView(value) ? [...value] : value);

function decoded(text) {
  try {
    return readMesh(new Uint8Array(Buffer.from(text, "base64")));
  } catch (why) {
    if (why.name !== "NISPError") throw why;
    return { section: why.section, field: why.field };
  }
}

const [first, ...others] = process.argv.slice(2);
const extracted = (path) => extractMesh(new NISPModel(parseNISP(new Uint8Array(readFileSync(path)))), 32);
const found = first === "--extract" ? others.map(extracted) : JSON.parse(readFileSync(first, "utf8")).map(decoded);
process.stdout.write(JSON.stringify(found, plain));
