/** Disjoint sets of the numbers from 0 (union by smaller root, paths halved). */
export class DisjointSets {
  /** @param {number} count */
  constructor(count) {
    this.parent = new Int32Array(count).map((_, i) => i);
  }

  /** @param {number} i */
  root(i) {
    const { parent } = this;
    while (parent[i] !== i) {
      parent[i] = parent[parent[i]];
      i = parent[i];
    }
    return i;
  }

  /** @param {number} a @param {number} b */
  join(a, b) {
    const [first, second] = [this.root(a), this.root(b)];
    this.parent[Math.max(first, second)] = Math.min(first, second);
  }

  /** Numbers of the sets from 0, and how many members each has. */
  labels() {
    const labels = new Int32Array(this.parent.length);
    /** @type {number[]} */
    const sizes = [];
    for (let i = 0; i < labels.length; i++) {
      const root = this.root(i);
      labels[i] = root === i ? sizes.push(0) - 1 : labels[root];
      sizes[labels[i]]++;
    }
    return { labels, sizes };
  }
}
