import { ByteReader, crc32 } from "./bytes.js";
import { MAX_FILE, MAX_METADATA, MAX_SECTIONS, MAX_UNPACKED } from "./enumerations.js";
import { Place } from "./errors.js";
import { unzstd } from "./zstd.js";

/**
 * One row of the section table, its payload unpacked where the section is known.
 * @typedef {{stored: number, content: Uint8Array}} Section
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
  const reader = new ByteReader(file, "header");
  reader.limit("file length", file.length, MAX_FILE);
  const count = readHeader(reader, file);
  const rows = Array.from({ length: count }, () => readRow(reader, file));
  checkOrder(rows, reader);
  const unpacked = rows.reduce((sum, row) => sum + (row.flags & PACKED ? row.decoded : 0), 0);
  reader.limit("unpacked length", unpacked, MAX_UNPACKED);
  for (const row of rows) checkCode(row, known);
  return new Map(rows.map((row) => [row.code, toSection(row, known)]));
}

/** How many sections there are. @param {ByteReader} reader @param {Uint8Array} file */
function readHeader(reader, file) {
  const signature = reader.bytes(SIGNATURE.length);
  reader.demand(SIGNATURE.every((byte, i) => byte === signature[i]), "signature", "that of a .nisp file");
  const major = reader.uint(1);
  reader.demand(major === 1, "major version", 1, major);
  reader.uint(1);
  const count = reader.uint(2);
  reader.limit("section count", count, MAX_SECTIONS, 1);
  const checksum = reader.uint(4);
  const end = HEADER + ROW * count;
  reader.demand(end <= file.length, "section table", `${end} bytes`, file.length);
  const found = crc32(file.subarray(0, 12), file.subarray(HEADER, end));
  reader.demand(checksum === found, "checksum", checksum, found);
  return count;
}

/**
 * @typedef {{code: string, place: Place, flags: number, offset: number, decoded: number, payload: Uint8Array}} Row
 * @param {ByteReader} reader
 * @param {Uint8Array} file
 * @returns {Row}
 */
function readRow(reader, file) {
  const code = String.fromCharCode(...reader.bytes(4));
  reader.demand(/^[A-Z0-9]{4}$/.test(code), "section code", "four of A-Z and 0-9", code);
  const place = new Place(code);
  const flags = reader.uint(1);
  place.limit("flags", flags, CRITICAL | PACKED);
  const [offset, stored, decoded, checksum] = [0, 0, 0, 0].map(() => reader.uint(4));
  place.demand(offset + stored <= file.length, "stored length", "bytes of the file", stored);
  const payload = file.subarray(offset, offset + stored);
  place.demand(crc32(payload) === checksum, "checksum", checksum);
  const fits = flags & PACKED ? stored < decoded : stored === decoded;
  place.demand(fits, "decoded length", flags & PACKED ? "more than stored" : stored, decoded);
  return { code, place, flags, offset, decoded, payload };
}

/** @param {Row[]} rows @param {ByteReader} reader */
function checkOrder(rows, reader) {
  let end = HEADER + ROW * rows.length;
  rows.forEach((row, i) => {
    reader.demand(i === 0 || rows[i - 1].code < row.code, "section order", "sorted codes", row.code);
    row.place.demand(row.offset === end, "offset", end, row.offset);
    end += row.payload.length;
  });
  reader.demand(end === reader.data.length, "file length", end, reader.data.length);
}

/** @param {Row} row @param {string[]} known */
function checkCode({ code, place, flags, decoded }, known) {
  const critical = Boolean(flags & CRITICAL);
  const ours = known.includes(code);
  place.demand(ours || !critical, "section code", `a critical section of ${known.join(", ")}`, code);
  place.demand(critical || !ours, "flags", "critical", "ancillary");
  if (code === "META") place.limit("length", decoded, MAX_METADATA);
}

/** What other sections hold is not looked at. @param {Row} row @param {string[]} known @returns {Section} */
function toSection({ code, flags, payload, decoded }, known) {
  const packed = flags & PACKED && known.includes(code);
  return { stored: payload.length, content: packed ? unzstd(payload, decoded, code) : payload };
}
