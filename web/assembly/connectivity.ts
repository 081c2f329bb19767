/**
 * How faces hang together: a border of gates that grows over the surface, face by face (section 15.2
 * of the specification).
 */
import { below, bit, signed } from "./bits";
import { appendGate, beginLists, dropGate, gateCount, gateOf } from "./gate_lists";
import { COPY, COPY_OF, demand, GATE, GATE_STEPS, GATE_THERE, POINT, THIRD_POINT } from "./host";
import { filled, Ints, ints, mark, release } from "./memory";
import { BACK, BORDER, FAR, HAS_COPIES, IS_COPY, LEFT, NEW, PAIR, RIGHT, STEPS } from "./slots";
import { beginStacks, pop, push } from "./stacks";

/** What a gate is: gone, open, or one over which there is no face. */
const GONE = 0;
const OPEN = 1;
const DEAD = 2;
const BUCKETS = 16;
const MOST_STEPS = 255;
/** The action that is no other: any gate's start is the third point. */
const SPLIT = 3;

/** Points of faces (3 m). */
export let corners: Ints = changetype<Ints>(0);
/** The side that each side meets (3 m), or -1; side 3 f + i runs from corner i on. */
export let twin: Ints = changetype<Ints>(0);
export let pointCount = 0;
/** Faces at each point. */
let degree: Ints = changetype<Ints>(0);
let end = 0;
let gates = 0;
let origin: Ints = changetype<Ints>(0);
let after: Ints = changetype<Ints>(0);
let before: Ints = changetype<Ints>(0);
let side: Ints = changetype<Ints>(0);
let state: Ints = changetype<Ints>(0);
/** The last four actions. */
let history = 0;

/** Reads `corners`, `twin` and `pointCount` of so many faces. */
export function readConnectivity(faces: i32): void {
  const sides = 3 * faces;
  corners = ints(sides);
  twin = filled(sides, -1);
  const start = mark();
  degree = ints(sides);
  // A face makes three gates at most.
  origin = ints(sides);
  after = ints(sides);
  before = ints(sides);
  side = ints(sides);
  state = ints(sides);
  beginLists(sides);
  beginStacks(BUCKETS, 4 * faces);
  end = pointCount = gates = history = 0;
  while (end < sides) {
    const gate = best();
    if (gate < 0) beginComponent();
    else grow(gate);
  }
  release(start);
}

/** A new face's first side. */
function addFace(a: i32, b: i32, c: i32): i32 {
  addCorner(a);
  addCorner(b);
  addCorner(c);
  return end - 3;
}

function addCorner(point: i32): void {
  corners[end++] = point;
  degree[point]++;
}

function addGate(start: i32, ofSide: i32): i32 {
  origin[gates] = start;
  side[gates] = ofSide;
  state[gates] = OPEN;
  appendGate(start, gates);
  return gates++;
}

function join(gate: i32, next: i32): void {
  after[gate] = next;
  before[next] = gate;
}

function remove(gate: i32): void {
  state[gate] = GONE;
  dropGate(origin[gate], gate);
}

/** Two sides are one edge. */
function meet(one: i32, other: i32): void {
  twin[one] = other;
  twin[other] = one;
}

function close(gate: i32, other: i32): void {
  meet(side[gate], side[other]);
  remove(gate);
  remove(other);
}

function touch(gate: i32): void {
  if (state[gate] !== OPEN) return;
  const most = max(degree[origin[gate]], degree[origin[after[gate]]]);
  push(min(most, BUCKETS - 1), gate);
}

/** The open gate at the points with most faces, -1 without one. */
function best(): i32 {
  for (let i = BUCKETS - 1; i >= 0; i--) {
    for (let gate = pop(i); gate >= 0; gate = pop(i)) if (state[gate] === OPEN) return gate;
  }
  return -1;
}

/** The first face of a component. */
function beginComponent(): void {
  const x = pointCount;
  pointCount += 3;
  const first = addFace(x, x + 1, x + 2);
  const one = addGate(x + 1, first);
  const two = addGate(x, first + 2);
  const three = addGate(x + 2, first + 1);
  join(one, two);
  join(two, three);
  join(three, one);
  touch(one);
  touch(two);
  touch(three);
}

/** The face over a gate, or none. */
function grow(gate: i32): void {
  const action = readAction(gate);
  if (action === BORDER) {
    state[gate] = DEAD;
    return;
  }
  history = ((history << 2) | action) & 255;
  const third = action === NEW ? -1 : readThird(gate, action);
  const next = after[gate];
  const previous = before[gate];
  const u = origin[gate];
  const w = origin[next];
  const t = third < 0 ? pointCount++ : origin[third];
  demand(t !== u && t !== w, THIRD_POINT, 0, t);
  const first = addFace(u, w, t);
  meet(first, side[gate]);
  remove(gate);
  const left = addGate(u, first + 2);
  const right = addGate(t, first + 1);
  join(third < 0 ? left : before[third], right);
  if (third >= 0) join(left, third);
  join(previous, left);
  join(right, next);
  touch(previous);
  touch(left);
  touch(right);
  touch(next);
  if (action === RIGHT) zip(right, left);
  if (action === LEFT) zip(left, right);
}

/** Closes a gate with the next; and another with its next where both are a loop. */
function zip(closed: i32, other: i32): void {
  close(closed, after[closed]);
  const last = after[other];
  if (after[last] === other && state[last] === OPEN && bit(PAIR)) close(other, last);
}

function readAction(gate: i32): i32 {
  const next = after[gate];
  const previous = before[gate];
  const u = min(degree[origin[gate]], 10);
  const w = min(degree[origin[next]], 10);
  const open = (state[next] === OPEN ? 2 : 0) + (state[previous] === OPEN ? 1 : 0);
  const far = min(degree[origin[previous]], 9) * 10 + min(degree[origin[after[next]]], 9);
  const special = (min(u + w, 16) * 100 + far) * 4 + open;
  if (bit(NEW, u * 11 + w, history, special)) return NEW;
  if (open & 2 && bit(RIGHT, u * 11 + w, history, special)) return RIGHT;
  if (open & 1 && bit(LEFT, u * 11 + w, history, special)) return LEFT;
  return bit(BORDER, open, history, special) ? BORDER : SPLIT;
}

/** The gate that begins at the third point. */
function readThird(gate: i32, action: i32): i32 {
  if (action === RIGHT) return after[after[gate]];
  if (action === LEFT) return before[gate];
  if (bit(FAR)) {
    const point = below(pointCount, POINT);
    demand(gateCount(point) > 0, GATE_THERE);
    return gateOf(point, below(gateCount(point), GATE));
  }
  const links = bit(BACK) ? before : after;
  const steps = signed(STEPS, 0, 0, 0, 0);
  demand(steps > 0 && steps <= MOST_STEPS, GATE_STEPS, 0, steps);
  for (let i = 0; i < steps; i++) gate = links[gate];
  return gate;
}

/** The vertex of each point. */
export function readVertices(): Ints {
  const found = ints(pointCount);
  const copied = bit(HAS_COPIES);
  let count = 0;
  let copy = 0;
  for (let point = 0; point < pointCount; point++) {
    if (copied) copy = bit(IS_COPY, copy, copy, copy);
    demand(count || !copy, COPY_OF);
    found[point] = copy ? below(count, COPY) : count++;
  }
  return found;
}
