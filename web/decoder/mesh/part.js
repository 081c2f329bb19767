/**
 * Where a copy of a part stands: a point goes to scale * R(rotation) (p, x negated where mirrored) + offset.
 * @typedef {object} Placement
 * @property {number[]} rotation quaternion, w first
 * @property {number[]} offset
 * @property {number} scale
 * @property {boolean} mirrored
 * @property {number[]} uvScale
 * @property {number[]} uvOffset
 * @property {Int32Array|null} materials of the charts; null: the part's
 */

/**
 * Triangles on integer grids, and the copies of them.
 * @typedef {object} MeshPart
 * @property {Int32Array} positions (3 n) normalized frame: times step, plus origin
 * @property {Int32Array} faces (3 m) side 3 f + i runs from corner i on
 * @property {Int32Array} uvs (2 t) asset's UV: times uvStep, plus uvOrigin
 * @property {Int32Array} uvFaces (3 m) -1 on faces without
 * @property {Int32Array} faceCharts (m)
 * @property {Int32Array} chartMaterials (k)
 * @property {boolean[]} chartHasUv (k)
 * @property {Uint8Array} creases (3 m) whether shading breaks at a side
 * @property {Uint8Array} sheet (m) faces that have no inside
 * @property {number} step
 * @property {number[]} origin
 * @property {number[]} uvStep
 * @property {number[]} uvOrigin
 * @property {Placement[]} placements
 */

/**
 * What assembly/part.ts gives away of a part, in its order: 8 numbers, lists; and of each placement 14
 * numbers, and materials where it has its own.
 * @typedef {{numbers: Float64Array, lists: Int32Array[]}} Given
 */

/** Numbers of the placement that a part has which says of none. */
const PLAIN = Float64Array.of(1, 0, 0, 0, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0);

/** @param {Given} given @param {Given[]} placements @returns {MeshPart} */
export function partOf({ numbers, lists }, placements) {
  const [step, ...others] = numbers;
  const [positions, uvs, uvFaces, faces, faceCharts, creases, sheet, chartMaterials, chartHasUv] = lists;
  return {
    positions,
    faces,
    uvs,
    uvFaces,
    faceCharts,
    chartMaterials,
    chartHasUv: Array.from(chartHasUv, Boolean),
    creases: Uint8Array.from(creases),
    sheet: Uint8Array.from(sheet),
    step,
    origin: others.slice(0, 3),
    uvStep: others.slice(3, 5),
    uvOrigin: others.slice(5),
    placements: (placements.length ? placements : [{ numbers: PLAIN, lists: [] }]).map(placementOf),
  };
}

/** @param {Given} given @returns {Placement} */
function placementOf({ numbers, lists }) {
  const all = [...numbers];
  return {
    rotation: all.slice(0, 4),
    offset: all.slice(4, 7),
    scale: all[7],
    mirrored: Boolean(all[8]),
    uvScale: all.slice(9, 11),
    uvOffset: all.slice(11, 13),
    materials: lists[0] ?? null,
  };
}
