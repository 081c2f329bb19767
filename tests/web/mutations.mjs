/**
 * Files with some bytes changed and checksums made right again, through the decoder:
 *
 *     node mutations.mjs RUNS SEED FILE.nisp ...
 *
 * JSON on standard output: how many parsed, how many were refused, and what else was thrown.
 */
import { readFileSync } from "node:fs";
import { crc32 } from "../../web/decoder/bytes.js";
import { parseNISP } from "../../web/decoder/document.js";
import { NISPError } from "../../web/decoder/errors.js";
import { withoutOrientation } from "../../web/evaluate/images.js";

const HEADER = 16;
const ROW = 21;
const MOST_BYTES = 4;
const HEADERS_OF = 12;

const [runs, seed, ...paths] = process.argv.slice(2);
const files = paths.map((path) => new Uint8Array(readFileSync(path)));
let state = Number(seed);

/** An integer from 0, below `end`. */
function random(end) {
  state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
  return Math.floor((state / 2 ** 32) * end);
}

function viewOf(file) {
  return new DataView(file.buffer, file.byteOffset, file.byteLength);
}

/** Where a section's row of the table is, and its payload; cut off at the end of the file. */
function rowsOf(file) {
  const view = viewOf(file);
  const count = Math.min(view.getUint16(10, true), Math.floor((file.length - HEADER) / ROW));
  return Array.from({ length: count }, (_, i) => {
    const at = HEADER + ROW * i;
    const offset = view.getUint32(at + 5, true);
    return { at, offset, payload: file.subarray(offset, offset + view.getUint32(at + 9, true)) };
  });
}

function makeSound(file) {
  const rows = rowsOf(file);
  for (const { at, payload } of rows) viewOf(file).setUint32(at + 17, crc32(payload), true);
  viewOf(file).setUint32(12, crc32(file.subarray(0, 12), file.subarray(HEADER, HEADER + ROW * rows.length)), true);
}

/** Bytes of one section, or now and then of the header, become others. */
function mutated(source) {
  const file = source.slice();
  const rows = rowsOf(file);
  const row = rows[random(rows.length)];
  const [start, length] = random(HEADERS_OF) ? [row.offset, row.payload.length] : [0, HEADER + ROW * rows.length];
  for (let left = 1 + random(MOST_BYTES); left > 0; left--) {
    const at = start + random(length);
    file[at] = [file[at] ^ (1 << random(8)), random(256), 255, file[at] + 1][random(4)];
  }
  makeSound(file);
  return file;
}

const found = { parsed: 0, refused: 0, others: [] };
for (let i = 0; i < Number(runs); i++) {
  const file = mutated(files[random(files.length)]);
  try {
    for (const { mime, data } of parseNISP(file).images) withoutOrientation(mime, data);
    found.parsed++;
  } catch (why) {
    if (why instanceof NISPError) found.refused++;
    else found.others.push(String(why.stack));
  }
}
process.stdout.write(JSON.stringify(found));
