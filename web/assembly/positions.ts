/** The positions of vertices on their grid (section 15.4 of the specification). */
import { coordinate, longer } from "./bits";
import { bitLength, cross, quarterOf, rounded, shorten, wayBetween } from "./integers";
import { filled, floats, Ints, ints, mark, release } from "./memory";
import { NORMAL, POSITION, POSITION_START } from "./slots";
import { beginVisits, hingeEnd, hinges, near, nextVisit, node } from "./visits";

/** How far a vertex is from the nodes beyond, and towards the chain's ends; by the number of hinges, in 16ths. */
const FROM_BEYOND = memory.data<u8>([10, 9, 8]);
const TO_ENDS = memory.data<u8>([0, 7, 5]);
const NORMAL_BITS = 20;
/** Of `longer` before there is one. */
const AVERAGE = 4;

let found: Ints = changetype<Ints>(0);
let size = 0;
let top = 0;
let last = -1;
/** How much longer than expected coordinates were, along the surface and across it. */
let along: Ints = changetype<Ints>(0);
let across: Ints = changetype<Ints>(0);
/** Two sides of a face beyond, and their cross product; the sum of these. */
const ways = floats(9);
const normal = floats(3);
const spreads = ints(3);
/** Sums of positions, three numbers each. */
const ENDS = 0;
const OUTER = 3;
const BEYOND = 6;
const SUMS = 9;
const sums = floats(SUMS);
let outerCount = 0;
let beyondCount = 0;

/** Positions (3 count), so many bits each; corners are vertices (3 m). */
export function readPositions(corners: Ints, twin: Ints, sides: i32, count: i32, bits: i32): Ints {
  found = ints(3 * count);
  const start = mark();
  size = bits;
  top = (1 << bits) - 1;
  last = -1;
  along = filled(count, AVERAGE);
  across = filled(count, AVERAGE);
  beginVisits(corners, twin, sides, count);
  while (nextVisit()) {
    if (hingeEnd) readOver();
    else readStart(near >= 0 ? near : last, near < 0 ? 1 : 0);
    last = node;
  }
  release(start);
  return found;
}

/** By another node, or -1. */
function readStart(source: i32, kind: i32): void {
  const length = max(size - 2 + kind, 0);
  let longest = 0;
  for (let axis = 0; axis < 3; axis++) {
    const expected = source >= 0 ? found[3 * source + axis] : top >> 1;
    found[3 * node + axis] = coordinate(expected, top, POSITION_START, length, kind, longest * 2 + kind, axis);
    longest = max(longest, longer);
  }
}

/** By its hinges. */
function readOver(): void {
  const many = min(hingeEnd / 3, 3);
  const folded = findPlane();
  sumUp();
  let widest = 0;
  let level = 0;
  for (let axis = 0; axis < 3; axis++) {
    spreads[axis] = spreadOf(found, 3, axis);
    widest = max(widest, spreads[axis]);
    if (abs(normal[axis]) > abs(normal[level])) level = axis;
  }
  const rough = meanOf(along);
  let tilt: f64 = 0;
  let longest = 0;
  for (let axis = 0; axis < 3; axis++) {
    if (axis === level) continue;
    const scale = 3 * spreads[axis] + widest;
    const middle = expectedOn(axis, many);
    const made = coordinate(middle, top, POSITION, lengthOf(scale, 5), many, quarterOf(scale) * 16 + longest, rough);
    found[3 * node + axis] = made;
    tilt += normal[axis] * (made - middle);
    longest = max(longest, longer);
  }
  const scale = 3 * spreads[level] + widest;
  const flat = expectedOn(level, many) - (normal[level] !== 0 ? rounded(tilt, normal[level]) : 0);
  const special = folded * 16 + meanOf(across);
  found[3 * node + level] = coordinate(flat, top, NORMAL, lengthOf(scale, 6), many, quarterOf(scale) * 16 + longest, special);
  along[node] = longest;
  across[node] = longer;
}

function lengthOf(scale: i32, fine: i32): i32 {
  return bitLength(scale >> fine);
}

/** From the least to the greatest of the hinges' values along an axis. */
export function spreadOf(values: Ints, width: i32, axis: i32): i32 {
  let low = i32.MAX_VALUE;
  let high = i32.MIN_VALUE;
  for (let i = 0; i < hingeEnd; i++) {
    if (hinges[i] < 0) continue;
    const value = values[width * hinges[i] + axis];
    low = min(low, value);
    high = max(high, value);
  }
  return high - low;
}

/** Finds sums of positions: of the hinges' ends, of those of one edge alone, of nodes beyond. */
function sumUp(): void {
  outerCount = beyondCount = 0;
  for (let i = 0; i < SUMS; i++) sums[i] = 0;
  for (let i = 0; i < hingeEnd; i++) {
    if (hinges[i] < 0) continue;
    if (i % 3 === 2) {
      addTo(BEYOND, hinges[i]);
      beyondCount++;
      continue;
    }
    addTo(ENDS, hinges[i]);
    if (!isThereOnce(hinges[i])) continue;
    addTo(OUTER, hinges[i]);
    outerCount++;
  }
}

function addTo(sum: i32, vertex: i32): void {
  for (let axis = 0; axis < 3; axis++) sums[sum + axis] += found[3 * vertex + axis];
}

/** What a coordinate may be: the middle of the hinges' edges, moved away from what is beyond, and to the ends of their chain. */
function expectedOn(axis: i32, many: i32): f64 {
  const middle = meanIn16ths(sums[ENDS + axis], (2 * hingeEnd) / 3);
  let moved = middle;
  if (beyondCount) moved += rounded(<f64>load<u8>(FROM_BEYOND + many - 1) * (middle - meanIn16ths(sums[BEYOND + axis], beyondCount)), 16);
  if (outerCount) moved += rounded(<f64>load<u8>(TO_ENDS + many - 1) * (meanIn16ths(sums[OUTER + axis], outerCount) - middle), 16);
  return floor((moved + 8) / 16);
}

/** Whether one edge alone of the hinges ends at a node. */
function isThereOnce(end: i32): bool {
  let times = 0;
  for (let i = 0; i < hingeEnd; i++) times += <i32>(i % 3 < 2 && hinges[i] === end);
  return times === 1;
}

function meanIn16ths(sum: f64, count: i32): f64 {
  return rounded(16 * sum, count);
}

/** The mean of a table at the hinges' ends. */
function meanOf(table: Ints): i32 {
  let sum = 0;
  for (let i = 0; i < hingeEnd; i++) if (i % 3 < 2) sum += table[hinges[i]];
  return sum / ((2 * hingeEnd) / 3);
}

/** Finds the normal of the faces beyond; how folded they are. */
function findPlane(): i32 {
  let whole: f64 = 0;
  for (let axis = 0; axis < 3; axis++) normal[axis] = 0;
  for (let i = 0; i < hingeEnd; i += 3) {
    if (hinges[i + 2] < 0) continue;
    wayBetween(found, hinges[i], hinges[i + 1], ways, 0);
    wayBetween(found, hinges[i], hinges[i + 2], ways, 3);
    cross(ways);
    for (let axis = 0; axis < 3; axis++) {
      normal[axis] += ways[6 + axis];
      whole += abs(ways[6 + axis]);
    }
  }
  const left = whole - abs(normal[0]) - abs(normal[1]) - abs(normal[2]);
  shorten(normal, 3, NORMAL_BITS);
  return whole > 0 ? <i32>min(floor((8 * left) / whole), 7) : 7;
}
