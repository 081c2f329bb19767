import { EXTRACTION } from "./config.js";
import { ontoSurface } from "./newton.js";
import { PagedCube } from "./paged_cube.js";
import { layoutOf, surfaceBlocks } from "./surface_blocks.js";

/**
 * Triangles in the normalized frame.
 * @typedef {{positions: Float32Array, faces: Int32Array, cell: number}} Surface (3 n), (3 m)
 * @typedef {import("./surface_blocks.js").GridLayout} GridLayout
 * @typedef {import("../evaluate/network.js").NetworkEvaluator} NetworkEvaluator
 */

/**
 * The zero set of an SDF network by surface nets (Gibson 1998): a vertex for each cell that the
 * surface passes, moved onto it, and a quad for each edge of the grid that crosses it. Work grows
 * with the surface.
 * @param {NetworkEvaluator} network
 * @param {number} resolution cells along an edge of the cube
 * @returns {Surface}
 */
export function extractSurface(network, resolution) {
  const layout = layoutOf(resolution);
  const field = new SampledField(network, layout);
  const blocks = field.sampleAndFollow(surfaceBlocks(network, layout));
  const { vertices, positions } = cellVertices(field, blocks, layout);
  const moved = ontoSurface(network, positions, layout.cell / 2, EXTRACTION.newtonSteps);
  return { positions: moved, faces: quads(field, blocks, vertices, layout, moved), cell: layout.cell };
}

/** The field on the grid points of blocks, each point evaluated once. */
class SampledField {
  /** @param {NetworkEvaluator} network @param {GridLayout} layout */
  constructor(network, layout) {
    this.network = network;
    this.layout = layout;
    this.values = new PagedCube(layout.cells + 1, NaN, (count) => new Float32Array(count));
    this.seen = new Uint8Array(layout.across ** 3);
  }

  /** Samples blocks (3 n) and all that the surface goes on into; returns them all. @param {number[]} blocks */
  sampleAndFollow(blocks) {
    /** @type {number[]} */
    const all = [];
    let next = this.unseen(blocks);
    while (next.length) {
      this.sample(next);
      for (const place of next) all.push(place);
      next = this.unseen(this.behind(next));
    }
    return all;
  }

  /** Those inside the cube that were not seen before. @param {number[]} blocks */
  unseen(blocks) {
    const { across } = this.layout;
    /** @type {number[]} */
    const found = [];
    for (let i = 0; i < blocks.length; i += 3) {
      const [x, y, z] = [blocks[i], blocks[i + 1], blocks[i + 2]];
      if (Math.min(x, y, z) < 0 || Math.max(x, y, z) >= across) continue;
      const number = (x * across + y) * across + z;
      if (this.seen[number]) continue;
      this.seen[number] = 1;
      found.push(x, y, z);
    }
    return found;
  }

  /** @param {number[]} blocks */
  sample(blocks) {
    /** @type {number[]} */
    const places = [];
    for (let i = 0; i < blocks.length; i += 3) {
      const [x, y, z] = [2 * blocks[i], 2 * blocks[i + 1], 2 * blocks[i + 2]];
      for (let dx = 0; dx < 3; dx++) {
        for (let dy = 0; dy < 3; dy++) {
          for (let dz = 0; dz < 3; dz++) {
            // NaN: not known yet.
            if (this.values.get(x + dx, y + dy, z + dz) <= Infinity) continue;
            this.values.set(x + dx, y + dy, z + dz, 0);
            places.push(x + dx, y + dy, z + dz);
          }
        }
      }
    }
    const { cell } = this.layout;
    const found = this.network.evaluate(Float32Array.from(places, (place) => place * cell - EXTRACTION.cube));
    found.forEach((value, i) => {
      // What overflowed is no surface.
      this.values.set(places[3 * i], places[3 * i + 1], places[3 * i + 2], Number.isNaN(value) ? 1 : value);
    });
  }

  /** Neighbors (3 n) of blocks behind faces that the surface crosses. @param {number[]} blocks */
  behind(blocks) {
    /** @type {number[]} */
    const found = [];
    for (let i = 0; i < blocks.length; i += 3) {
      const [x, y, z] = [blocks[i], blocks[i + 1], blocks[i + 2]];
      const inside = this.insideBits(2 * x, 2 * y, 2 * z);
      if (inside === 0 || inside === ALL_POINTS) continue;
      FACES.forEach(({ bits, dx, dy, dz }) => {
        const there = inside & bits;
        if (there !== 0 && there !== bits) found.push(x + dx, y + dy, z + dz);
      });
    }
    return found;
  }

  /** Which of a block's 27 points are inside, as bits. @param {number} x @param {number} y @param {number} z */
  insideBits(x, y, z) {
    let bits = 0;
    for (let k = 0, dx = 0; dx < 3; dx++) {
      for (let dy = 0; dy < 3; dy++) {
        for (let dz = 0; dz < 3; dz++, k++) if (this.values.get(x + dx, y + dy, z + dz) < 0) bits |= 1 << k;
      }
    }
    return bits;
  }
}

const ALL_POINTS = 2 ** 27 - 1;

/** Faces of a block: which of its points they have, and where the neighbor behind is. */
const FACES = [0, 1, 2].flatMap((axis) =>
  [0, 2].map((side) => {
    let bits = 0;
    for (let k = 0; k < 27; k++) if ([Math.floor(k / 9), Math.floor(k / 3) % 3, k % 3][axis] === side) bits |= 1 << k;
    const [dx, dy, dz] = [0, 1, 2].map((each) => (each === axis ? side - 1 : 0));
    return { bits, dx, dy, dz };
  }),
);

/** Corners of a cell: bits 2, 1, 0 are x, y, z. Its edges, by their ends. */
const EDGE_ENDS = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((low) =>
  [1, 2, 4].filter((bit) => !(low & bit)).map((bit) => [low, low | bit]),
);

/**
 * @param {SampledField} field @param {number[]} blocks @param {GridLayout} layout
 * @returns {{vertices: PagedCube, positions: Float32Array}}
 */
function cellVertices(field, blocks, { cells, cell }) {
  const vertices = new PagedCube(cells, -1, (count) => new Int32Array(count));
  /** @type {number[]} */
  const positions = [];
  const corners = new Float64Array(8);
  forEachCell(blocks, (x, y, z) => {
    let inside = 0;
    for (let k = 0; k < 8; k++) {
      corners[k] = field.values.get(x + (k >> 2), y + ((k >> 1) & 1), z + (k & 1));
      if (corners[k] < 0) inside++;
    }
    if (inside === 0 || inside === 8) return;
    vertices.set(x, y, z, positions.length / 3);
    const middle = crossingsMean(corners);
    positions.push(...[x, y, z].map((place, axis) => (place + middle[axis]) * cell - EXTRACTION.cube));
  });
  return { vertices, positions: Float32Array.from(positions) };
}

/** @param {number[]} blocks @param {(x: number, y: number, z: number) => void} use */
function forEachCell(blocks, use) {
  for (let i = 0; i < blocks.length; i += 3) {
    for (let k = 0; k < 8; k++) {
      use(2 * blocks[i] + (k >> 2), 2 * blocks[i + 1] + ((k >> 1) & 1), 2 * blocks[i + 2] + (k & 1));
    }
  }
}

/** Mean of where the surface crosses the edges of a cell. @param {Float64Array} corners */
function crossingsMean(corners) {
  const sum = [0, 0, 0];
  let count = 0;
  for (const [low, high] of EDGE_ENDS) {
    if (corners[low] < 0 === corners[high] < 0) continue;
    const share = corners[low] / (corners[low] - corners[high]);
    for (let axis = 0; axis < 3; axis++) {
      const bit = 4 >> axis;
      sum[axis] += (low & bit ? 1 : 0) + ((low ^ high) & bit ? share : 0);
    }
    count++;
  }
  return sum.map((each) => each / count);
}

/**
 * @param {SampledField} field @param {number[]} blocks @param {PagedCube} vertices
 * @param {GridLayout} layout @param {Float32Array} positions
 */
function quads(field, blocks, vertices, { cells }, positions) {
  /** @type {number[]} */
  const faces = [];
  forEachCell(blocks, (x, y, z) => {
    if (vertices.get(x, y, z) < 0) return;
    const inside = field.values.get(x, y, z) < 0;
    for (let axis = 0; axis < 3; axis++) {
      const [dx, dy, dz] = [axis === 0 ? 1 : 0, axis === 1 ? 1 : 0, axis === 2 ? 1 : 0];
      if (field.values.get(x + dx, y + dy, z + dz) < 0 === inside) continue;
      // One step back along the two other axes, in turn.
      const [bx, by, bz] = [dz, dx, dy];
      const [cx, cy, cz] = [dy, dz, dx];
      if (Math.min(x - bx - cx, y - by - cy, z - bz - cz) < 0) continue;
      const ring = [
        vertices.get(x - bx - cx, y - by - cy, z - bz - cz),
        vertices.get(x - cx, y - cy, z - cz),
        vertices.get(x, y, z),
        vertices.get(x - bx, y - by, z - bz),
      ];
      if (Math.min(...ring) >= 0) addQuad(faces, inside ? ring : ring.reverse(), positions);
    }
  });
  return Int32Array.from(faces);
}

/** Two triangles, divided along the shorter diagonal. @param {number[]} faces @param {number[]} ring @param {Float32Array} positions */
function addQuad(faces, [a, b, c, d], positions) {
  if (distance(positions, a, c) <= distance(positions, b, d)) faces.push(a, b, c, a, c, d);
  else faces.push(a, b, d, b, c, d);
}

/** @param {Float32Array} positions @param {number} a @param {number} b */
export function distance(positions, a, b) {
  return Math.hypot(
    positions[3 * a] - positions[3 * b],
    positions[3 * a + 1] - positions[3 * b + 1],
    positions[3 * a + 2] - positions[3 * b + 2],
  );
}
