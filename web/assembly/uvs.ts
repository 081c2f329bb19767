/** The texture coordinates of nodes on their grid (section 15.6 of the specification). */
import { bit, coordinate, longer, signed } from "./bits";
import { demand, UV_VALUE } from "./host";
import { bitLength, product, quarterOf, rounded, shorten, wayBetween } from "./integers";
import { floats, Ints, ints } from "./memory";
import { DOWN, FLIP, UV, UV_SECOND, UV_START, UV_THIRD } from "./slots";
import { beginStacking, coordinates, noteNear, noteThirds, readAnywhere, readBeside, readBeyond } from "./stacking";
import { beginVisits, hingeEnd, hinges, near, nextVisit, node } from "./visits";

/** Faces of a hinge at most. */
const GUESSES = 16;
const DIGITS = 10;
/** How many times longer than an edge what is beside it may be, along it. */
const STRETCHED = 16;

let places: Ints = changetype<Ints>(0);
let found: Ints = changetype<Ints>(0);
/** Of each node its coordinates' number. */
let numbers: Ints = changetype<Ints>(0);
let size = 0;
let top = 0;
let last = -1;
let flip = 0;
/** Sums of lengths of edges, in space and in the texture. */
let far: f64 = 1;
let wide: f64 = 1;
/** Coordinates as read. */
let u = 0;
let v = 0;

/** The hinges as numbers. */
const sides = ints(3 * GUESSES);
/** Where faces over hinges may have their node, u and v (2 g); the part across the edge where no face beyond says its side. */
const guesses = floats(2 * GUESSES);
const turns = floats(2 * GUESSES);
const whole = ints(GUESSES);
/** From a hinge's end to its other, to the node, and to what is beyond. */
const ways = floats(9);
const expected = floats(2);
const spreads = floats(2);

/** Texture coordinates (2 count), so many bits each; corners are nodes (3 m) at `positions` (3 count). */
export function readUvs(corners: Ints, twin: Ints, sideCount: i32, positions: Ints, count: i32, bits: i32): Ints {
  places = positions;
  found = ints(2 * count);
  numbers = ints(count);
  size = bits;
  top = (1 << bits) - 1;
  last = -1;
  flip = 0;
  far = wide = 1;
  beginStacking(count, sideCount);
  beginVisits(corners, twin, sideCount, count);
  while (nextVisit()) readNode();
  return found;
}

function readNode(): void {
  for (let i = 0; i < hingeEnd; i++) sides[i] = hinges[i] < 0 ? -1 : numbers[hinges[i]];
  let number = readKnown();
  if (number < 0) {
    if (hingeEnd) readOver();
    else if (near >= 0) readSecond();
    else readStart();
    number = coordinates.add(u, v);
  }
  found[2 * node] = coordinates.ones[number];
  found[2 * node + 1] = coordinates.others[number];
  numbers[node] = number;
  last = node;
  noteThirds(number, sides);
  noteEnds();
}

/** The number of coordinates that were there, or -1. */
function readKnown(): i32 {
  if (hingeEnd) return readBeyond(sides);
  return near >= 0 ? readBeside(numbers[near], distance(node, near)) : readAnywhere();
}

/** Notes the edges to the hinges' ends, each once and from the lowest node on, or to what is near. */
function noteEnds(): void {
  if (!hingeEnd) {
    if (near >= 0) noteEdge(near);
    return;
  }
  for (let end = nextEnd(-1); end < i32.MAX_VALUE; end = nextEnd(end)) noteEdge(end);
}

/** The lowest end of the hinges above one. */
function nextEnd(above: i32): i32 {
  let lowest = i32.MAX_VALUE;
  for (let i = 0; i < hingeEnd; i++) if (i % 3 < 2 && hinges[i] > above) lowest = min(lowest, hinges[i]);
  return lowest;
}

function noteEdge(end: i32): void {
  const length = distance(node, end);
  noteNear(numbers[node], numbers[end], length);
  noteNear(numbers[end], numbers[node], length);
}

function distance(one: i32, other: i32): i32 {
  wayBetween(places, one, other, ways, 0);
  return <i32>floor(sqrt(product(ways, 0, 0)));
}

/** Reads u and v near what is expected. */
function readBoth(slot: i32, one: i32, other: i32, sources: i32, apart: i32, otherApart: i32): void {
  u = coordinate(expected[0], top, slot, one, sources, apart * 4 + sources, sources);
  v = coordinate(expected[1], top, slot, other, sources, otherApart * 4 + sources, longer * 4 + sources);
}

/** The first node of a chart. */
function readStart(): void {
  for (let axis = 0; axis < 2; axis++) expected[axis] = last >= 0 ? found[2 * last + axis] : top >> 1;
  const length = max(size - 3, 0);
  readBoth(UV_START, length, length, 0, 0, 0);
}

/** One about as far from another as edges of its length are. */
function readSecond(): void {
  const u0 = found[2 * near];
  const v0 = found[2 * near + 1];
  const length = distance(node, near);
  const most: i32 = 4 << size;
  const scale = <i32>min(floor((wide * length) / far), most);
  const quarter = quarterOf(scale);
  u = coordinate(u0, top, UV_SECOND, bitLength(scale), 0, quarter, 0);
  const across = <f64>(u - u0);
  const left = <i32>floor(sqrt(max(<f64>scale * scale - across * across, 0)));
  const down = bit(DOWN);
  const steep = <i32>min(floor((8 * <f64>left) / (scale + 1)), 7);
  const rise = left + signed(UV_THIRD, bitLength(scale >> 3), 0, steep, quarter);
  v = v0 + (down ? -rise : rise);
  demand(v >= 0 && v <= top, UV_VALUE, top, v);
  if (!length) return;
  far += 16 * <f64>length - floor(far / 4);
  wide += 16 * floor(sqrt(across * across + <f64>rise * rise)) - floor(wide / 4);
}

/** By its hinges: by those that know their side of the edge, if any do. */
function readOver(): void {
  const count = hingeEnd / 3;
  let wholes = 0;
  for (let i = 0; i < count; i++) {
    guess(i);
    wholes += whole[i];
  }
  findExpected(count, wholes);
  let widest: f64 = 0;
  for (let axis = 0; axis < 2; axis++) {
    spreads[axis] = spreadWith(axis);
    widest = max(widest, spreads[axis]);
  }
  const one = bitLength(floor((3 * spreads[0] + widest) / 64));
  const other = bitLength(floor((3 * spreads[1] + widest) / 64));
  readBoth(UV, one, other, min(wholes, 3), apartOf(0, count, wholes, one), apartOf(1, count, wholes, other));
}

/** From the least to the greatest of the hinges' coordinates and what is expected. */
function spreadWith(axis: i32): f64 {
  let low = expected[axis];
  let high = low;
  for (let i = 0; i < hingeEnd; i++) {
    if (hinges[i] < 0) continue;
    low = min(low, found[2 * hinges[i] + axis]);
    high = max(high, found[2 * hinges[i] + axis]);
  }
  return high - low;
}

/** How much longer than a length the spread of guesses is, from 0 to 7. */
function apartOf(axis: i32, count: i32, wholes: i32, length: i32): i32 {
  let low = Infinity;
  let high = -Infinity;
  for (let i = 0; i < count; i++) {
    if (wholes && !whole[i]) continue;
    low = min(low, guesses[2 * i + axis]);
    high = max(high, guesses[2 * i + axis]);
  }
  return min(max(bitLength(high - low) - length + 4, 0), 7);
}

/** The mean of guesses, on that side of edges where a bit says if none knows. */
function findExpected(count: i32, wholes: i32): void {
  const used = <f64>(wholes || count);
  let differ = false;
  for (let axis = 0; axis < 2; axis++) {
    let sum: f64 = 0;
    let turn: f64 = 0;
    for (let i = 0; i < count; i++) {
      if (wholes && !whole[i]) continue;
      sum += guesses[2 * i + axis];
      turn += turns[2 * i + axis];
    }
    expected[axis] = floor((sum + turn) / used);
    spreads[axis] = floor((sum - turn) / used);
    differ = differ || expected[axis] !== spreads[axis];
  }
  if (wholes) return;
  if (differ) flip = bit(FLIP, 0, flip, 0);
  if (flip) for (let axis = 0; axis < 2; axis++) expected[axis] = spreads[axis];
}

/** Makes the guess of one hinge. */
function guess(i: i32): void {
  const a = hinges[3 * i];
  const b = hinges[3 * i + 1];
  const c = hinges[3 * i + 2];
  whole[i] = 0;
  wayBetween(places, a, b, ways, 0);
  wayBetween(places, a, node, ways, 3);
  wayBetween(places, a, c >= 0 ? c : a, ways, 6);
  shorten(ways, 9, DIGITS);
  const square = product(ways, 0, 0);
  const part = product(ways, 0, 3);
  const ua = <f64>found[2 * a];
  const va = <f64>found[2 * a + 1];
  const du = found[2 * b] - ua;
  const dv = found[2 * b + 1] - va;
  if (square === 0 || abs(part) > STRETCHED * square) {
    setGuess(i, ua, va, 0, 0);
    return;
  }
  const high = height(3, square, part);
  const pu = ua + rounded(du * part, square);
  const pv = va + rounded(dv * part, square);
  if (c >= 0) {
    const along = product(ways, 0, 6);
    const other = height(6, square, along);
    if (other > 0 && other * 4 >= high && abs(along) <= STRETCHED * square) {
      const across = rounded((rounded(du * along, square) - found[2 * c] + ua) * high, other);
      const rise = rounded((rounded(dv * along, square) - found[2 * c + 1] + va) * high, other);
      whole[i] = 1;
      setGuess(i, pu + across, pv + rise, 0, 0);
      return;
    }
  }
  setGuess(i, pu, pv, rounded(-dv * high, square), rounded(du * high, square));
}

function setGuess(i: i32, u: f64, v: f64, du: f64, dv: f64): void {
  guesses[2 * i] = u;
  guesses[2 * i + 1] = v;
  turns[2 * i] = du;
  turns[2 * i + 1] = dv;
}

/** How far from an edge a way ends, times the edge's length. */
function height(at: i32, square: f64, part: f64): f64 {
  return floor(sqrt(max(square * product(ways, at, at) - part * part, 0)));
}
