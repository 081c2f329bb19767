/** The gates of each point, by number. */
import { Ints, ints, reserve } from "./memory";

const ROOM = 6;

let lists: Ints = changetype<Ints>(0);
let counts: Ints = changetype<Ints>(0);
let rooms: Ints = changetype<Ints>(0);

export function beginLists(points: i32): void {
  lists = ints(points);
  counts = ints(points);
  rooms = ints(points);
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
  changetype<Ints>(lists[point])[count] = gate;
  counts[point]++;
}

export function dropGate(point: i32, gate: i32): void {
  const list = changetype<Ints>(lists[point]);
  let low = 0;
  let high = --counts[point];
  const last = high;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (list[middle] < gate) low = middle + 1;
    else high = middle;
  }
  const place = lists[point] + (low << 2);
  memory.copy(place, place + 4, (last - low) << 2);
}

export function gateCount(point: i32): i32 {
  return counts[point];
}

export function gateOf(point: i32, place: i32): i32 {
  return changetype<Ints>(lists[point])[place];
}
