/** Disjoint sets of the numbers from 0: union by smaller root, paths halved. */
import { Ints, ints, mark, release } from "./memory";

/** The root of each, itself at first. */
export function alone(count: i32): Ints {
  const roots = ints(count);
  for (let i = 0; i < count; i++) roots[i] = i;
  return roots;
}

export function rootOf(roots: Ints, i: i32): i32 {
  while (roots[i] !== i) {
    roots[i] = roots[roots[i]];
    i = roots[i];
  }
  return i;
}

export function unite(roots: Ints, one: i32, other: i32): void {
  const first = rootOf(roots, one);
  const second = rootOf(roots, other);
  roots[max(first, second)] = min(first, second);
}

/** What hangs together over sides that meet: the number of each face's group, by its first. */
export function faceGroups(twin: Ints, faces: i32): Ints {
  const labels = ints(faces);
  const start = mark();
  const roots = alone(faces);
  for (let side = 0; side < 3 * faces; side++) if (twin[side] >= 0) unite(roots, side / 3, twin[side] / 3);
  let count = 0;
  for (let face = 0; face < faces; face++) {
    const root = rootOf(roots, face);
    labels[face] = root === face ? count++ : labels[root];
  }
  release(start);
  return labels;
}
