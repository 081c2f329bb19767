/** Parts of MESH: triangles on integer grids, and copies of them (sections 15.5 and 15.7 of the specification). */
import { bit, bits, member, number } from "./bits";
import { corners as points, pointCount, readConnectivity, readVertices, twin } from "./connectivity";
import { bendsOf, readEdges } from "./edges";
import { alone, faceGroups, rootOf, unite } from "./groups";
import { demand, FACE_OF_THREE, FACES, giveFloats, giveInts, GRID_BITS, MATERIAL_BITS, STEP_ABOVE, UV_GRID_BITS } from "./host";
import { sideAfter } from "./integers";
import { filled, floats, greatest, Ints, ints, mark, release } from "./memory";
import { readPlacements, readSingles } from "./placements";
import { readPositions } from "./positions";
import { BORDER_CREASE, CREASE, HAS_CREASES, HAS_SEAMS, HAS_UV, ORIGIN, SEAM, SHEET, STEP, UV_ORIGIN, UV_STEP } from "./slots";
import { readUvs } from "./uvs";

const MOST_GRID_BITS = 20;
const MOST_MATERIAL_BITS = 16;
/** Step and origin, of positions and of UVs. */
const NUMBERS = 8;

/** Of the last part. */
export let faceCount = 0;
let sides = 0;
let faces: Ints = changetype<Ints>(0);
let positions: Ints = changetype<Ints>(0);
/** The side that each meets over no seam, or -1. */
let joined: Ints = changetype<Ints>(0);
let faceCharts: Ints = changetype<Ints>(0);
let chartHasUv: Ints = changetype<Ints>(0);

/**
 * Reads a part, and gives it away: numbers, then positions, UVs, UVs of faces, faces, charts of
 * faces, creases, sheets, materials of charts and whether they have UVs; then its placements, where
 * it has more than the plain one. How many faces, placements and materials may follow, of `most`.
 */
export function readPart(most: i32): i32 {
  const start = mark();
  faceCount = number(most, FACES);
  sides = 3 * faceCount;
  const size = readGridBits(GRID_BITS);
  const uvSize = readGridBits(UV_GRID_BITS);
  readNumbers();
  readConnectivity(faceCount);
  const vertices = readFaces();
  positions = readPositions(faces, twin, sides, vertices, size);
  giveInts(changetype<usize>(positions), 3 * vertices);
  const sheets = readSheets();
  const creases = readLines();
  faceCharts = faceGroups(joined, faceCount);
  const charts = greatest(faceCharts, faceCount) + 1;
  const materialBits = bits(5);
  demand(materialBits <= MOST_MATERIAL_BITS, MATERIAL_BITS, MOST_MATERIAL_BITS, materialBits);
  const materials = readCharts(charts, materialBits);
  readTexture(uvSize);
  giveInts(changetype<usize>(faces), sides);
  giveInts(changetype<usize>(faceCharts), faceCount);
  giveInts(changetype<usize>(creases), sides);
  giveInts(changetype<usize>(sheets), faceCount);
  giveInts(changetype<usize>(materials), charts);
  giveInts(changetype<usize>(chartHasUv), charts);
  const left = readPlacements(charts, materialBits, most - faceCount);
  release(start);
  return left;
}

function readGridBits(what: i32): i32 {
  const found = bits(5);
  demand(found <= MOST_GRID_BITS, what, MOST_GRID_BITS, found);
  return found;
}

function readNumbers(): void {
  const numbers = floats(NUMBERS);
  readSingles(STEP, numbers, 0, 1);
  demand(numbers[0] > 0, STEP_ABOVE);
  readSingles(ORIGIN, numbers, 1, 3);
  readSingles(UV_STEP, numbers, 4, 2);
  readSingles(UV_ORIGIN, numbers, 6, 2);
  giveFloats(changetype<usize>(numbers), NUMBERS);
}

/** Reads the vertices of faces; how many vertices there are. */
function readFaces(): i32 {
  const vertices = readVertices();
  faces = ints(sides);
  for (let corner = 0; corner < sides; corner++) faces[corner] = vertices[points[corner]];
  for (let at = 0; at < sides; at += 3) {
    const a = faces[at];
    const b = faces[at + 1];
    const c = faces[at + 2];
    demand(a !== b && b !== c && c !== a, FACE_OF_THREE);
  }
  return greatest(faces, sides) + 1;
}

/** Which faces are of sheets. */
function readSheets(): Ints {
  const sheets = faceGroups(twin, faceCount);
  const bodies = greatest(sheets, faceCount) + 1;
  const flags = ints(bodies);
  let last = 0;
  for (let body = 0; body < bodies; body++) flags[body] = last = bit(SHEET, last, last, last);
  for (let face = 0; face < faceCount; face++) sheets[face] = flags[sheets[face]];
  return sheets;
}

/** Reads `joined`, and creases, one flag a side. */
function readLines(): Ints {
  const bends = bendsOf(faces, twin, sides, positions);
  const creases = ints(sides);
  joined = ints(sides);
  const seams = ints(sides);
  for (let side = 0; side < sides; side++) seams[side] = <i32>(twin[side] < 0);
  if (bit(HAS_SEAMS)) readEdges(SEAM, points, twin, sides, pointCount, bends, seams);
  if (bit(HAS_CREASES)) {
    for (let side = 0; side < sides; side++) if (twin[side] < 0) creases[side] = bit(BORDER_CREASE);
    readEdges(CREASE, points, twin, sides, pointCount, bends, creases);
  }
  for (let side = 0; side < sides; side++) joined[side] = seams[side] ? -1 : twin[side];
  return creases;
}

/** Reads `chartHasUv`, and materials. */
function readCharts(charts: i32, materialBits: i32): Ints {
  const materials = ints(charts);
  chartHasUv = ints(charts);
  let hasUv = 1;
  let material = 0;
  for (let chart = 0; chart < charts; chart++) {
    chartHasUv[chart] = hasUv = bit(HAS_UV, hasUv, hasUv, hasUv);
    materials[chart] = material = member(materialBits, material);
  }
  return materials;
}

/** Texture coordinates of nodes: corners that no seam parts are one. */
function readTexture(size: i32): void {
  const start = mark();
  const fans = alone(sides);
  for (let side = 0; side < sides; side++) if (joined[side] >= 0) unite(fans, side, sideAfter(joined[side]));
  // Of corners with UVs: their nodes, and their number among these corners.
  const nodes = filled(sides, -1);
  const places = filled(sides, -1);
  const dressed = ints(sides);
  let count = 0;
  let nodeCount = 0;
  for (let corner = 0; corner < sides; corner++) {
    if (!chartHasUv[faceCharts[corner / 3]]) continue;
    const fan = rootOf(fans, corner);
    nodes[corner] = fan === corner ? nodeCount++ : nodes[fan];
    dressed[count] = nodes[corner];
    places[corner] = count++;
  }
  const meets = ints(count);
  const nodePositions = ints(3 * nodeCount);
  for (let corner = 0; corner < sides; corner++) {
    if (places[corner] < 0) continue;
    meets[places[corner]] = joined[corner] < 0 ? -1 : places[joined[corner]];
    const at = 3 * nodes[corner];
    const from = 3 * faces[corner];
    for (let axis = 0; axis < 3; axis++) nodePositions[at + axis] = positions[from + axis];
  }
  const uvs = readUvs(dressed, meets, count, nodePositions, nodeCount, size);
  giveInts(changetype<usize>(uvs), 2 * nodeCount);
  giveInts(changetype<usize>(nodes), sides);
  release(start);
}
