import { ByteReader, crc32 } from "./bytes.js";
import { MAX_FILE, MAX_METADATA, MAX_SECTIONS, MAX_UNPACKED } from "./enumerations.js";
import { demand } from "./errors.js";
import { unzstd } from "./zstd.js";

/**
 * One row of the section table, its payload unpacked where the section is known.
 * @typedef {{code: string, critical: boolean, packed: boolean, stored: number, content: Uint8Array}} Section
 */

const SIGNATURE = [0x89, 0x4e, 0x53, 0x50, 0x0d, 0x0a, 0x1a, 0x0a];
const HEADER = 16;
const ROW = 21;
const CRITICAL = 1;
const PACKED = 2;

/**
 * The sections of a file by code, checked (section 2 of the specification).
 * @param {Uint8Array} file
 * @param {string[]} known codes of the critical sections that the caller understands
 * @returns {Map<string, Section>}
 */
export function readContainer(file, known) {
  demand(file.length <= MAX_FILE, "header", "file length", `at most ${MAX_FILE}`, file.length);
  const reader = new ByteReader(file, "header");
  const count = readHeader(reader, file);
  const rows = Array.from({ length: count }, () => readRow(reader, file));
  checkOrder(rows, file);
  const unpacked = rows.reduce((sum, row) => sum + (row.flags & PACKED ? row.decoded : 0), 0);
  demand(unpacked <= MAX_UNPACKED, "header", "unpacked length", `at most ${MAX_UNPACKED}`, unpacked);
  for (const row of rows) checkCode(row, known);
  return new Map(rows.map((row) => [row.code, toSection(row, known)]));
}

/** How many sections there are. @param {ByteReader} reader @param {Uint8Array} file */
function readHeader(reader, file) {
  const signature = reader.bytes(SIGNATURE.length);
  demand(SIGNATURE.every((byte, i) => byte === signature[i]), "header", "signature", "that of a .nisp file");
  const major = reader.uint8();
  demand(major === 1, "header", "major version", 1, major);
  reader.uint8();
  const count = reader.uint16();
  demand(count >= 1 && count <= MAX_SECTIONS, "header", "section count", `1 to ${MAX_SECTIONS}`, count);
  const checksum = reader.uint32();
  const end = HEADER + ROW * count;
  demand(end <= file.length, "header", "section table", `${end} bytes`, file.length);
  const found = crc32(file.subarray(0, 12), file.subarray(HEADER, end));
  demand(checksum === found, "header", "checksum", checksum, found);
  return count;
}

/**
 * @typedef {{code: string, flags: number, offset: number, decoded: number, payload: Uint8Array}} Row
 * @param {ByteReader} reader
 * @param {Uint8Array} file
 * @returns {Row}
 */
function readRow(reader, file) {
  const code = String.fromCharCode(...reader.bytes(4));
  demand(/^[A-Z0-9]{4}$/.test(code), "header", "section code", "four of A-Z and 0-9", code);
  const flags = reader.uint8();
  demand(flags < 4, code, "flags", "0 to 3", flags);
  const [offset, stored, decoded, checksum] = [0, 0, 0, 0].map(() => reader.uint32());
  demand(offset + stored <= file.length, code, "stored length", "bytes of the file", stored);
  const payload = file.subarray(offset, offset + stored);
  demand(crc32(payload) === checksum, code, "checksum", checksum);
  const fits = flags & PACKED ? stored < decoded : stored === decoded;
  demand(fits, code, "decoded length", flags & PACKED ? "more than stored" : stored, decoded);
  return { code, flags, offset, decoded, payload };
}

/** @param {Row[]} rows @param {Uint8Array} file */
function checkOrder(rows, file) {
  let end = HEADER + ROW * rows.length;
  rows.forEach((row, i) => {
    demand(i === 0 || rows[i - 1].code < row.code, "header", "section order", "sorted codes", row.code);
    demand(row.offset === end, row.code, "offset", end, row.offset);
    end += row.payload.length;
  });
  demand(end === file.length, "header", "file length", end, file.length);
}

/** @param {Row} row @param {string[]} known */
function checkCode(row, known) {
  const critical = Boolean(row.flags & CRITICAL);
  const ours = known.includes(row.code);
  demand(ours || !critical, row.code, "section code", `a critical section of ${known.join(", ")}`, row.code);
  demand(critical || !ours, row.code, "flags", "critical", "ancillary");
  demand(row.code !== "META" || row.decoded <= MAX_METADATA, "META", "length", `at most ${MAX_METADATA}`, row.decoded);
}

/** What other sections hold is not looked at. @param {Row} row @param {string[]} known @returns {Section} */
function toSection({ code, flags, payload, decoded }, known) {
  const packed = Boolean(flags & PACKED);
  const content = packed && known.includes(code) ? unzstd(payload, decoded, code) : payload;
  return { code, critical: Boolean(flags & CRITICAL), packed, stored: payload.length, content };
}
