import { placedTriangles } from "./placed.js";
import { CLOSEST, closestTo } from "./triangle.js";
import { TriangleSearch } from "./triangle_search.js";

/** All copies of a file's mesh parts, to be asked at points: Float32Array (3 n) of the normalized frame. */
export class MeshQueries {
  /** @param {import("../decoder/mesh/part.js").MeshPart[]} parts at least one */
  constructor(parts) {
    this.triangles = placedTriangles(parts);
    const { corners, charts, sheet } = this.triangles;
    this.search = new TriangleSearch(corners, Int32Array.from(charts.keys()), sheet);
    /** Searches of single charts. @type {Map<number, TriangleSearch>} */
    this.searches = new Map();
  }

  get chartCount() {
    return this.triangles.chartCount;
  }

  /** Signed distances (n). @param {Float32Array} points */
  sdf(points) {
    const { search } = this;
    return eachPoint(points, (x, y, z) => {
      search.closest(x, y, z);
      const distance = Math.sqrt(search.squared);
      return distance && search.inside(x, y, z) ? -distance : distance;
    });
  }

  /** The charts (n) of the closest triangles. @param {Float32Array} points */
  charts(points) {
    const found = eachPoint(points, (x, y, z) => {
      this.search.closest(x, y, z);
      return this.triangles.charts[this.search.face];
    });
    return Int32Array.from(found);
  }

  /** Texture coordinates (2 n) at the closest points on charts (n). @param {Float32Array} points @param {Int32Array} charts */
  uv(points, charts) {
    const { uvs, corners } = this.triangles;
    const found = new Float32Array(2 * charts.length);
    charts.forEach((chart, i) => {
      const [x, y, z] = points.subarray(3 * i, 3 * i + 3);
      const face = this.#faceOn(chart, x, y, z);
      closestTo(corners, 9 * face, x, y, z);
      const [a, b, c] = CLOSEST.weights;
      for (let axis = 0; axis < 2; axis++) {
        const at = 6 * face + axis;
        found[2 * i + axis] = a * uvs[at] + b * uvs[at + 2] + c * uvs[at + 4];
      }
    });
    return found;
  }

  /** The closest face of a chart. @param {number} chart @param {number} x @param {number} y @param {number} z */
  #faceOn(chart, x, y, z) {
    const { charts, corners, sheet } = this.triangles;
    this.search.closest(x, y, z);
    if (charts[this.search.face] === chart) return this.search.face;
    let search = this.searches.get(chart);
    if (!search) {
      search = new TriangleSearch(corners, Int32Array.from(charts.keys()).filter((face) => charts[face] === chart), sheet);
      this.searches.set(chart, search);
    }
    search.closest(x, y, z);
    return search.face;
  }
}

/** A number for each point. @param {Float32Array} points @param {(x: number, y: number, z: number) => number} ask */
function eachPoint(points, ask) {
  const found = new Float32Array(points.length / 3);
  for (let i = 0; i < found.length; i++) found[i] = ask(points[3 * i], points[3 * i + 1], points[3 * i + 2]);
  return found;
}
