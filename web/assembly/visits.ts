/** The order in which values of nodes come, and what is known around each (section 15.3 of the specification). */
import { sideAfter } from "./integers";
import { Ints, ints } from "./memory";
import { beginStacks, pop, push } from "./stacks";

/** Faces around a node that tell where it is, at most. */
const MOST_HINGES = 16;
const STACKS = 4;

let corners: Ints = changetype<Ints>(0);
let twin: Ints = changetype<Ints>(0);
let sides = 0;
/** The corners of each node, one after the other, from where each begins. */
let first: Ints = changetype<Ints>(0);
let list: Ints = changetype<Ints>(0);
let known: Ints = changetype<Ints>(0);
let ready: Ints = changetype<Ints>(0);
let full: Ints = changetype<Ints>(0);
/** The side whose node a component may begin with. */
let begin = 0;

/** The node whose value comes next. */
export let node = -1;
/** Known ends a and b of edges, and the node c beyond each or -1. */
export const hinges = ints(3 * MOST_HINGES);
/** How many numbers of hinges there are, three each. */
export let hingeEnd = 0;
/** A known node where there is no hinge, or -1. */
export let near = -1;

/** Begins with all of so many nodes unknown; a list has the node of each corner, another the side that each side meets. */
export function beginVisits(nodes: Ints, meets: Ints, sideCount: i32, count: i32): void {
  corners = nodes;
  twin = meets;
  sides = sideCount;
  known = ints(count);
  ready = ints(count);
  full = ints(sides / 3);
  beginStacks(STACKS, sides);
  listCorners(count);
  begin = 0;
  node = -1;
}

function listCorners(count: i32): void {
  first = ints(count + 2);
  list = ints(sides);
  // Ends of lists begin two places on, and are beginnings of the next when all is listed.
  for (let corner = 0; corner < sides; corner++) first[corners[corner] + 2]++;
  for (let i = 2; i <= count; i++) first[i] += first[i - 1];
  for (let corner = 0; corner < sides; corner++) list[first[corners[corner] + 1]++] = corner;
}

/** Goes on to the next node, as the value of the last is known; whether there is one. */
export function nextVisit(): bool {
  if (node >= 0) know();
  do {
    node = popNode();
    while (node < 0 && begin < sides) {
      if (!known[corners[begin]]) node = corners[begin];
      begin++;
    }
    if (node < 0) return false;
  } while (known[node]);
  look();
  return true;
}

function popNode(): i32 {
  for (let i = STACKS - 1; i >= 0; i--) {
    const found = pop(i);
    if (found >= 0) return found;
  }
  return -1;
}

/** The node's faces, where one corner is left, make that ready. */
function know(): void {
  known[node] = 1;
  for (let i = first[node]; i < first[node + 1]; i++) {
    const face = list[i] / 3;
    if (++full[face] !== 2) continue;
    for (let at = 3 * face; at < 3 * face + 3; at++) {
      const other = corners[at];
      if (known[other]) continue;
      ready[other] = min(ready[other] + 1, STACKS - 1);
      push(ready[other], other);
    }
  }
}

/** Finds the node's hinges, or what is near. */
function look(): void {
  hingeEnd = 0;
  near = -1;
  for (let i = first[node]; i < first[node + 1]; i++) {
    const side = sideAfter(list[i]);
    const a = corners[side];
    const b = corners[sideAfter(side)];
    if (known[a] && known[b]) {
      if (hingeEnd === 3 * MOST_HINGES) break;
      const other = twin[side];
      const c = other < 0 ? -1 : corners[sideAfter(other, 2)];
      hinges[hingeEnd] = a;
      hinges[hingeEnd + 1] = b;
      hinges[hingeEnd + 2] = c >= 0 && known[c] ? c : -1;
      hingeEnd += 3;
    } else if (known[a] || known[b]) near = known[a] ? a : b;
  }
}
