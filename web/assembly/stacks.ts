/** Stacks of integers from 0, one set of them at a time. */
import { filled, Ints, ints } from "./memory";

/** The highest entry of each stack, or -1. */
let tops: Ints = changetype<Ints>(0);
let values: Ints = changetype<Ints>(0);
/** The entry below each. */
let lower: Ints = changetype<Ints>(0);
let entries = 0;

/** Begins with empty ones, onto which so many values are pushed in all at most. */
export function beginStacks(count: i32, pushes: i32): void {
  tops = filled(count, -1);
  values = ints(pushes);
  lower = ints(pushes);
  entries = 0;
}

export function push(stack: i32, value: i32): void {
  values[entries] = value;
  lower[entries] = tops[stack];
  tops[stack] = entries++;
}

/** The last value of a stack, which is then without; -1 of an empty one. */
export function pop(stack: i32): i32 {
  const top = tops[stack];
  if (top < 0) return -1;
  tops[stack] = lower[top];
  return values[top];
}
