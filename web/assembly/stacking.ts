/**
 * Texture coordinates that were there before, and what was beside them: charts may lie over others
 * (section 15.6 of the specification). Each pair has a number, by when it came first.
 */
import { below, bit, signed } from "./bits";
import { demand, SEEN_BEFORE, UV_RANK } from "./host";
import { Ints, ints } from "./memory";
import { PairTable } from "./pair_table";
import { BESIDE, RANK, SEEN, STACKED } from "./slots";
import { hingeEnd } from "./visits";

/** Faces over one pair of coordinates, and neighbors of one, that are remembered. */
const MOST = 16;
/** The last three hits. */
const HISTORY = 7;

/** Coordinates by number. */
export let coordinates: PairTable = changetype<PairTable>(0);
/** How many neighbors each has, which they are, and lengths to them. */
let neighbors: Ints = changetype<Ints>(0);
let near: Ints = changetype<Ints>(0);
let lengths: Ints = changetype<Ints>(0);
/** Edges between numbers: the lower, the higher. How many thirds each has, and the last note of one. */
let edges: PairTable = changetype<PairTable>(0);
let thirdCounts: Ints = changetype<Ints>(0);
let lastNotes: Ints = changetype<Ints>(0);
/** Notes of thirds, and the one before each at the same edge. */
let notes = 0;
let thirds: Ints = changetype<Ints>(0);
let earlier: Ints = changetype<Ints>(0);
/** How many edges each number went with; all 0 but while they are counted. */
let votes: Ints = changetype<Ints>(0);
let hits = 0;
const order = ints(MOST);

/** Begins with nothing there, for so many nodes and sides. */
export function beginStacking(nodes: i32, sides: i32): void {
  coordinates = PairTable.begin(nodes);
  neighbors = ints(nodes);
  near = ints(MOST * nodes);
  lengths = ints(MOST * nodes);
  // A face is a hinge once, and has three edges.
  edges = PairTable.begin(sides);
  thirdCounts = ints(sides);
  lastNotes = ints(sides);
  notes = hits = 0;
  thirds = ints(sides);
  earlier = ints(sides);
  votes = ints(nodes);
}

/** Any that was there, or -1. */
export function readAnywhere(): i32 {
  return coordinates.count && bit(SEEN) ? below(coordinates.count, SEEN_BEFORE) : -1;
}

/** One that was beside another at about this length, or -1. */
export function readBeside(start: i32, length: i32): i32 {
  const count = neighbors[start];
  if (!count || !bit(BESIDE)) return -1;
  for (let i = 0; i < count; i++) {
    const place = MOST * start + i;
    let rank = i;
    for (; rank > 0 && isFirst(place, order[rank - 1], length); rank--) order[rank] = order[rank - 1];
    order[rank] = place;
  }
  const rank = signed(RANK, 0, 0, 0, 0);
  demand(rank >= 0 && rank < count, UV_RANK, count - 1, rank);
  return near[order[rank]];
}

/** Whether a neighbor is nearer to a length than another, or as near and lower. */
function isFirst(place: i32, other: i32, length: i32): bool {
  const off = abs(lengths[place] - length) - abs(lengths[other] - length);
  return off ? off < 0 : isLower(near[place], near[other]);
}

function isLower(number: i32, other: i32): bool {
  const ones = coordinates.ones;
  const others = coordinates.others;
  return ones[number] === ones[other] ? others[number] < others[other] : ones[number] < ones[other];
}

/** The one that went with most of the hinges, or -1. `sides` are these as numbers: ends, and the third of the face known. */
export function readBeyond(sides: Ints): i32 {
  let best = -1;
  let most = 0;
  for (let i = 0; i < hingeEnd; i += 3) {
    for (let note = lastNote(sides[i], sides[i + 1]); note >= 0; note = earlier[note]) {
      const third = thirds[note];
      if (third === sides[i + 2]) continue;
      const count = ++votes[third];
      if (count < most || (count === most && isLower(third, best))) continue;
      best = third;
      most = count;
    }
  }
  if (best < 0) return -1;
  for (let i = 0; i < hingeEnd; i += 3) {
    for (let note = lastNote(sides[i], sides[i + 1]); note >= 0; note = earlier[note]) votes[thirds[note]] = 0;
  }
  const hit = bit(STACKED, 0, hits, min(most, 3));
  hits = ((hits << 1) | hit) & HISTORY;
  return hit ? best : -1;
}

/** The last note at an edge, or -1. */
function lastNote(one: i32, other: i32): i32 {
  const edge = edges.find(min(one, other), max(one, other));
  return edge < 0 ? -1 : lastNotes[edge];
}

/** Notes what is beyond the edges of the hinges' faces, now that the number is known. */
export function noteThirds(number: i32, sides: Ints): void {
  for (let i = 0; i < hingeEnd; i += 3) {
    const one = sides[i];
    const other = sides[i + 1];
    noteThird(one, other, number);
    noteThird(other, number, one);
    noteThird(number, one, other);
  }
}

function noteThird(one: i32, other: i32, third: i32): void {
  const edge = edges.add(min(one, other), max(one, other));
  const count = thirdCounts[edge];
  if (count === MOST) return;
  thirds[notes] = third;
  earlier[notes] = count ? lastNotes[edge] : -1;
  lastNotes[edge] = notes++;
  thirdCounts[edge] = count + 1;
}

/** Notes what is beside a number, at a length. */
export function noteNear(number: i32, other: i32, length: i32): void {
  const count = neighbors[number];
  if (count === MOST) return;
  const end = MOST * number + count;
  let place = MOST * number;
  while (place < end && near[place] !== other) place++;
  if (place === end) neighbors[number] = count + 1;
  near[place] = other;
  lengths[place] = length;
}
