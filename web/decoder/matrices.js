import { NUMBERS } from "./enumerations.js";

/** @typedef {import("./bytes.js").ByteReader} Bytes */

/**
 * The rows * columns values of a tensor, row by row, in one of the codings dense to dia.
 * @param {Bytes} reader
 * @param {string} coding
 * @param {number} rows
 * @param {number} columns
 * @param {boolean} symbols whether the values are integers
 * @returns {Float64Array}
 */
export function readMatrix(reader, coding, rows, columns, symbols) {
  if (coding === "dense") return readValues(reader, rows * columns, symbols);
  if (coding === "csc") return transposed(readMatrix(reader, "csr", columns, rows, symbols), columns, rows);
  const find = { coo: cooPlaces, csr: csrPlaces, dia: diaPlaces }[/** @type {"coo"|"csr"|"dia"} */ (coding)];
  const places = find(reader, rows, columns);
  const values = readValues(reader, places.length, symbols);
  const matrix = new Float64Array(rows * columns);
  places.forEach((place, i) => (matrix[place] = values[i]));
  return matrix;
}

/** @param {Float64Array} matrix @param {number} rows @param {number} columns */
function transposed(matrix, rows, columns) {
  const turned = new Float64Array(matrix.length);
  for (let i = 0; i < rows; i++) {
    for (let j = 0; j < columns; j++) turned[j * rows + i] = matrix[i * columns + j];
  }
  return turned;
}

/** @param {Bytes} reader @param {number} count @param {boolean} symbols */
function readValues(reader, count, symbols) {
  const kind = readNumberKind(reader, symbols ? ["int8", "int16", "int32"] : ["float32", "float16"]);
  const size = { int8: 1, int16: 2, int32: 4 }[kind];
  return Float64Array.from({ length: count }, () => (size ? signed(reader.uint(size), size) : reader.float(kind)));
}

/** @param {number} value without its sign @param {number} size in bytes */
function signed(value, size) {
  const unused = 32 - 8 * size;
  return (value << unused) >> unused;
}

/** @param {Bytes} reader @param {string[]} allowed @returns {string} */
export function readNumberKind(reader, allowed) {
  const number = reader.uint(1);
  const kind = NUMBERS[number - 1];
  reader.demand(allowed.includes(kind), "number kind", allowed.join(" or "), kind ?? number);
  return kind;
}

/** A list of indices of 0 to `most`. @param {Bytes} reader @param {number} count @param {number} most @param {string} field */
function readIndices(reader, count, most, field) {
  const size = most < 2 ** 8 ? 1 : most < 2 ** 16 ? 2 : 4;
  return Array.from({ length: count }, () => {
    const index = reader.uint(size);
    reader.limit(field, index, most);
    return index;
  });
}

/** @param {Bytes} reader @param {number} rows @param {number} columns */
function cooPlaces(reader, rows, columns) {
  const count = reader.varint();
  reader.limit("count", count, rows * columns);
  let row = 0;
  const numbers = readIndices(reader, count, rows - 1, "row step").map((step) => (row += step));
  reader.limit("row", row, rows - 1);
  return placesOf(reader, numbers, columns);
}

/** @param {Bytes} reader @param {number} rows @param {number} columns */
function csrPlaces(reader, rows, columns) {
  const counts = readIndices(reader, rows, columns, "row count");
  const numbers = counts.flatMap((count, row) => new Array(count).fill(row));
  return placesOf(reader, numbers, columns);
}

/** @param {Bytes} reader @param {number[]} rowNumbers of the values @param {number} columns */
function placesOf(reader, rowNumbers, columns) {
  const gaps = readIndices(reader, rowNumbers.length, columns - 1, "column gap");
  let column = 0;
  return rowNumbers.map((row, i) => {
    column = i > 0 && row === rowNumbers[i - 1] ? column + 1 + gaps[i] : gaps[i];
    reader.limit("column", column, columns - 1);
    return row * columns + column;
  });
}

/** @param {Bytes} reader @param {number} rows @param {number} columns */
function diaPlaces(reader, rows, columns) {
  const count = reader.varint();
  const most = rows + columns - 2;
  reader.limit("count", count, most + 1);
  /** @type {number[]} */
  const places = [];
  let diagonal = -1;
  for (const gap of readIndices(reader, count, most, "diagonal gap")) {
    diagonal += gap + 1;
    reader.limit("diagonal", diagonal, most);
    for (let row = 0; row < rows; row++) {
      const column = diagonal - (rows - 1) + row;
      if (column >= 0 && column < columns) places.push(row * columns + column);
    }
  }
  return places;
}
