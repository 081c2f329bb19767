/** The gates of each point, by number. */
import { Ints, ints, reserve } from "./memory";

const ROOM = 6;

let lists: Ints = changetype<Ints>(0);
let counts: Ints = changetype<Ints>(0);
let rooms: Ints = changetype<Ints>(0);
/** Of each gate, in the list of its point. */
let places: Ints = changetype<Ints>(0);

/** At most so many points, and gates. */
export function beginLists(points: i32): void {
  lists = ints(points);
  counts = ints(points);
  rooms = ints(points);
  places = ints(points);
}

/** The list grows by doubling. */
export function appendGate(point: i32, gate: i32): void {
  const count = counts[point];
  if (count === rooms[point]) {
    rooms[point] = max(2 * count, ROOM);
    const larger = reserve(rooms[point] << 2);
    memory.copy(larger, lists[point], count << 2);
    lists[point] = <i32>larger;
  }
  places[gate] = count;
  changetype<Ints>(lists[point])[count] = gate;
  counts[point]++;
}

/** Where it was the last one is now. */
export function dropGate(point: i32, gate: i32): void {
  const list = changetype<Ints>(lists[point]);
  const last = list[--counts[point]];
  list[places[gate]] = last;
  places[last] = places[gate];
}

export function gateCount(point: i32): i32 {
  return counts[point];
}

export function gateOf(point: i32, place: i32): i32 {
  return changetype<Ints>(lists[point])[place];
}
