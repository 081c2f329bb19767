// Simplifies one mesh with vertices that move: reads the file IN, writes OUT, both little-endian.
//
//   node simplify_update.mjs LIBRARY IN OUT FACES UV_WEIGHT [FLAG ...]
//
// LIBRARY  the module of meshoptimizer; FLAG one of its simplifier's
// IN       n, m uint32; 3 m indices uint32; 3 n positions, 2 n UVs float32
// OUT      k uint32; 3 k indices uint32; 3 n positions, 2 n UVs float32
import fs from "fs";
import { pathToFileURL } from "url";

const [library, input, output, faces, weight, ...flags] = process.argv.slice(2);
const { MeshoptSimplifier } = await import(pathToFileURL(library));
await MeshoptSimplifier.ready;

const bytes = fs.readFileSync(input);
const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
const [n, m] = new Uint32Array(buffer, 0, 2);
const indices = new Uint32Array(buffer, 8, 3 * m);
const positions = new Float32Array(buffer, 8 + 12 * m, 3 * n);
const uvs = new Float32Array(buffer, 8 + 12 * m + 12 * n, 2 * n);
const weights = [Number(weight), Number(weight)];
const [count] = MeshoptSimplifier.simplifyWithUpdate(
  indices, positions, 3, uvs, 2, weights, null, 3 * Number(faces), 1.0, ["Prune", ...flags],
);
const parts = [new Uint32Array([count / 3]), indices.slice(0, count), positions, uvs];
fs.writeFileSync(output, Buffer.concat(parts.map((part) => Buffer.from(part.buffer, part.byteOffset, part.byteLength))));
