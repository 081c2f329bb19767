import { areaNormal, CLOSEST, closestTo, solidAngle } from "./triangle.js";

/**
 * faces in a leaf at most; radii away from where a box's faces count as one (Barill et al. 2018); how
 * near to a half the winding number is taken again, with faces counting as one this much farther away.
 */
const SEARCH = Object.freeze({ leaf: 4, away: 4, doubt: 0.2, again: 4 });

/** Numbers of a box: its lower and upper corner; half the sum of its faces' normals, their middle, area and radius. */
const BOX = 14;
const NORMAL = 6;
const MIDDLE = 9;
const AREA = 12;
const RADIUS = 13;

/** Boxes around faces that lie together, halved down to leaves: box i has the halves 2 i and 2 i + 1. */
export class TriangleSearch {
  /**
   * @param {Float64Array} corners of triangles (9 f)
   * @param {Int32Array} faces those to search, at least one
   * @param {Uint8Array} sheet (f) triangles that bound no inside
   */
  constructor(corners, faces, sheet) {
    this.corners = corners;
    this.sheet = sheet;
    this.faces = inSpace(corners, faces);
    this.leaves = 2 ** Math.max(0, Math.ceil(Math.log2(faces.length / SEARCH.leaf)));
    this.boxes = new Float64Array(BOX * 2 * this.leaves);
    for (let box = 2 * this.leaves - 1; box > 0; box--) this.#measure(box);
    this.stack = new Int32Array(64);
    this.face = 0;
    this.squared = 0;
  }

  /** Calls `use` with each face of a leaf. @param {number} box @param {(face: number) => void} use */
  #eachFace(box, use) {
    const end = this.#begin(box + 1);
    for (let i = this.#begin(box); i < end; i++) use(this.faces[i]);
  }

  /** @param {number} box a leaf */
  #begin(box) {
    return Math.floor(((box - this.leaves) * this.faces.length) / this.leaves);
  }

  /** @param {number} box */
  #measure(box) {
    const { boxes } = this;
    const at = BOX * box;
    boxes.fill(Infinity, at, at + 3).fill(-Infinity, at + 3, at + 6);
    if (box < this.leaves) for (const half of [2 * box, 2 * box + 1]) this.#addHalf(at, BOX * half);
    else this.#eachFace(box, (face) => this.#addFace(at, face));
    let far = 0;
    for (let axis = 0; axis < 3; axis++) {
      const [low, high] = [boxes[at + axis], boxes[at + 3 + axis]];
      const area = boxes[at + AREA];
      const middle = area ? boxes[at + MIDDLE + axis] / area : (low + high) / 2;
      boxes[at + MIDDLE + axis] = middle;
      far += Math.max(high - middle, middle - low) ** 2;
    }
    boxes[at + RADIUS] = Math.sqrt(far);
  }

  /** @param {number} at @param {number} half */
  #addHalf(at, half) {
    const { boxes } = this;
    const area = boxes[half + AREA];
    for (let axis = 0; axis < 3; axis++) {
      boxes[at + axis] = Math.min(boxes[at + axis], boxes[half + axis]);
      boxes[at + 3 + axis] = Math.max(boxes[at + 3 + axis], boxes[half + 3 + axis]);
      boxes[at + NORMAL + axis] += boxes[half + NORMAL + axis];
      boxes[at + MIDDLE + axis] += boxes[half + MIDDLE + axis] * area;
    }
    boxes[at + AREA] += area;
  }

  /** @param {number} at @param {number} face */
  #addFace(at, face) {
    const { boxes, corners } = this;
    const normal = areaNormal(corners, 9 * face);
    const area = this.sheet[face] ? 0 : Math.hypot(...normal) / 2;
    for (let axis = 0; axis < 3; axis++) {
      const [a, b, c] = [0, 3, 6].map((corner) => corners[9 * face + corner + axis]);
      boxes[at + axis] = Math.min(boxes[at + axis], a, b, c);
      boxes[at + 3 + axis] = Math.max(boxes[at + 3 + axis], a, b, c);
      if (area) boxes[at + NORMAL + axis] += normal[axis] / 2;
      boxes[at + MIDDLE + axis] += ((a + b + c) / 3) * area;
    }
    boxes[at + AREA] += area;
  }

  /** The squared distance of a box. @param {number} box @param {number} x @param {number} y @param {number} z */
  #distance(box, x, y, z) {
    const { boxes } = this;
    const at = BOX * box;
    const dx = Math.max(boxes[at] - x, x - boxes[at + 3], 0);
    const dy = Math.max(boxes[at + 1] - y, y - boxes[at + 4], 0);
    const dz = Math.max(boxes[at + 2] - z, z - boxes[at + 5], 0);
    return dx * dx + dy * dy + dz * dz;
  }

  /** Finds the nearest face, of those equally near that of the lowest number, and its squared distance. @param {number} x @param {number} y @param {number} z */
  closest(x, y, z) {
    const { stack, corners } = this;
    this.squared = Infinity;
    this.face = -1;
    const look = (/** @type {number} */ face) => {
      closestTo(corners, 9 * face, x, y, z);
      if (CLOSEST.squared > this.squared || (CLOSEST.squared === this.squared && face > this.face)) return;
      this.squared = CLOSEST.squared;
      this.face = face;
    };
    let depth = 0;
    stack[depth++] = 1;
    while (depth) {
      const box = stack[--depth];
      // Rounding of a face's distance must not hide one that is equally near.
      if (this.#distance(box, x, y, z) > this.squared * (1 + 1e-12)) continue;
      if (box >= this.leaves) {
        this.#eachFace(box, look);
        continue;
      }
      const turned = this.#distance(2 * box, x, y, z) < this.#distance(2 * box + 1, x, y, z) ? 1 : 0;
      stack[depth++] = 2 * box + turned;
      stack[depth++] = 2 * box + 1 - turned;
    }
  }

  /** Whether the winding number is over a half, of either sign. @param {number} x @param {number} y @param {number} z */
  inside(x, y, z) {
    const rough = Math.abs(this.#winding(x, y, z, SEARCH.away));
    if (Math.abs(rough - 0.5) > SEARCH.doubt) return rough > 0.5;
    return Math.abs(this.#winding(x, y, z, SEARCH.away * SEARCH.again)) > 0.5;
  }

  /** @param {number} x @param {number} y @param {number} z @param {number} away radii from where faces count as one */
  #winding(x, y, z, away) {
    const { stack, boxes, corners, sheet } = this;
    let [sum, depth] = [0, 0];
    const add = (/** @type {number} */ face) => {
      if (!sheet[face]) sum += solidAngle(corners, 9 * face, x, y, z);
    };
    stack[depth++] = 1;
    while (depth) {
      const box = stack[--depth];
      const at = BOX * box;
      if (!boxes[at + AREA]) continue;
      const [dx, dy, dz] = [boxes[at + MIDDLE] - x, boxes[at + MIDDLE + 1] - y, boxes[at + MIDDLE + 2] - z];
      const squared = dx * dx + dy * dy + dz * dz;
      if (squared > (away * boxes[at + RADIUS]) ** 2) {
        const facing = dx * boxes[at + NORMAL] + dy * boxes[at + NORMAL + 1] + dz * boxes[at + NORMAL + 2];
        sum += facing / (squared * Math.sqrt(squared));
      } else if (box >= this.leaves) this.#eachFace(box, add);
      else {
        stack[depth++] = 2 * box;
        stack[depth++] = 2 * box + 1;
      }
    }
    return sum / (4 * Math.PI);
  }
}

/** Cells of the curve along an edge, and numbers that a face's may have. */
const CELLS = 2 ** 10;
const NUMBERS = 2 ** 21;

/** Faces in the order of a curve that fills space (Morton), so that neighbors are near. @param {Float64Array} corners @param {Int32Array} faces */
function inSpace(corners, faces) {
  const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  const middle = (/** @type {number} */ face, /** @type {number} */ axis) =>
    corners[9 * face + axis] + corners[9 * face + 3 + axis] + corners[9 * face + 6 + axis];
  for (const face of faces) {
    for (let axis = 0; axis < 3; axis++) {
      low[axis] = Math.min(low[axis], middle(face, axis));
      high[axis] = Math.max(high[axis], middle(face, axis));
    }
  }
  const size = Math.max(high[0] - low[0], high[1] - low[1], high[2] - low[2]) || 1;
  const keys = Float64Array.from(faces, (face, i) => {
    const cell = (/** @type {number} */ axis) => spaced(Math.min(Math.floor(((middle(face, axis) - low[axis]) / size) * CELLS), CELLS - 1));
    return (cell(0) * 4 + cell(1) * 2 + cell(2)) * NUMBERS + i;
  }).sort();
  return Int32Array.from(keys, (key) => faces[key % NUMBERS]);
}

/** Ten bits with two zeros before each. @param {number} value */
function spaced(value) {
  value = (value | (value << 16)) & 0x30000ff;
  value = (value | (value << 8)) & 0x300f00f;
  value = (value | (value << 4)) & 0x30c30c3;
  return (value | (value << 2)) & 0x9249249;
}
