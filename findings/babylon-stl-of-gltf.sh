#!/usr/bin/env bash
# Babylon.js: every glTF exported as STL is inside out, and the export turns the model in the scene into its mirror image
#
# Versions:   @babylonjs/core, loaders, serializers 9.28.0
# Behavior:  in a scene of Babylon's own (left) handedness the glTF loader hangs a model under a __root__ with a scale of
#             -1. STLExport.CreateSTL bakes the world matrix into the vertices of the scene's own meshes, clears only their
#             own transform and leaves __root__ in place: what is seen is then mirrored once too often, and so is the next
#             export. It swaps y and z of each vertex whatever the handedness, and heeds no side orientation: faces point
#             inward, and in a right-handed scene the shape is mirrored too. OBJExport of the same meshes is right.
# Output seen: a closed corner of 1 x 2 x 3 from a GLB, left-handed scene: STL volume -1 with the shape as made; the model in
#             the scene moves from x -1 .. 0 to 0 .. 1; the second STL is mirrored, the third as the first. Right-handed scene:
#             mirrored and -1 at once. OBJ: as made and +1
# One would guess: an exporter leaves the scene as it was, gives the same file twice, and what was closed and outward stays so.
# Who is hurt: viewers with a button for 3D printing: text reads backwards from the second press on, slicers see holes.
# Instead:    load into a left-handed scene and pass supportInstancedMeshes = true, which bakes copies (also right here);
#             or OBJExport.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-save --no-audit --no-fund --prefix . @babylonjs/core@9.28.0 @babylonjs/loaders@9.28.0 \
  @babylonjs/serializers@9.28.0
cat > run.mjs <<'EOF'
import assert from 'node:assert';
import { ImportMeshAsync } from '@babylonjs/core/Loading/sceneLoader.js';
import { Logger, NullEngine, Scene, Vector3 } from '@babylonjs/core/index.js';
import '@babylonjs/loaders/glTF/2.0/index.js';
import { OBJExport } from '@babylonjs/serializers/OBJ/index.js';
import { STLExport } from '@babylonjs/serializers/stl/index.js';

Logger.LogLevels = Logger.NoneLogLevel;
// A corner with edges of 1, 2 and 3 along x, y and z; its faces point outward.
const points = new Float32Array([0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3]);
const faces = new Uint16Array([0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]);
const bytes = Buffer.concat([Buffer.from(points.buffer), Buffer.from(faces.buffer)]);
const gltf = {
  asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }],
  meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 1 }] }],
  accessors: [{ bufferView: 0, componentType: 5126, count: 4, type: 'VEC3', min: [0, 0, 0], max: [1, 2, 3] },
    { bufferView: 1, componentType: 5123, count: 12, type: 'SCALAR' }],
  bufferViews: [{ buffer: 0, byteLength: 48 }, { buffer: 0, byteOffset: 48, byteLength: 24 }], buffers: [{ byteLength: 72 }],
};
const json = Buffer.from(JSON.stringify(gltf).padEnd(2048));
const glb = Buffer.alloc(28 + 2048 + 72);
[0x46546c67, 2, glb.length, 2048, 0x4e4f534a].forEach((x, i) => glb.writeUInt32LE(x, 4 * i));
json.copy(glb, 20);
[72, 0x004e4942].forEach((x, i) => glb.writeUInt32LE(x, 2068 + 4 * i));
bytes.copy(glb, 2076);

const det = (a, b, c) => a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
/** Whether the three edges at the corner turn as they were made, and the volume by the faces: positive where they point outward. */
function look(triangles) {
  const corners = triangles.flat().sort((a, b) => Math.hypot(...a) - Math.hypot(...b));
  const edges = [1, 2, 3].map((length) => corners.find((p) => Math.abs(Math.hypot(...p) - length) < 1e-6));
  const volume = triangles.reduce((sum, t) => sum + det(...t) / 6, 0);
  return `${det(...edges) > 0 ? 'as made' : 'mirrored'}, volume ${Math.round(1e3 * volume) / 1e3}`;
}
function stl(meshes, instanced = false) {
  const text = STLExport.CreateSTL(meshes, false, 'x', false, true, false, instanced);
  const p = [...text.matchAll(/vertex (\S+) (\S+) (\S+)/g)].map((m) => m.slice(1).map(Number));
  return look(Array.from({ length: p.length / 3 }, (_, i) => p.slice(3 * i, 3 * i + 3)));
}
function obj(meshes) {
  const rows = OBJExport.OBJ(meshes, false, 'x', true).split('\n').map((line) => line.split(' '));
  const v = rows.filter((row) => row[0] === 'v').map((row) => row.slice(1).map(Number));
  return look(rows.filter((row) => row[0] === 'f').map((row) => row.slice(1).map((word) => v[parseInt(word) - 1])));
}
/** The range of x in the scene: the vertices by the world matrix, as they are drawn. */
function seen(meshes) {
  const world = meshes[0].computeWorldMatrix(true);
  const p = meshes[0].getVerticesData('position');
  const x = [0, 3, 6, 9].map((i) => Math.round(Vector3.TransformCoordinates(Vector3.FromArray(p, i), world).x));
  return `x ${Math.min(...x)} .. ${Math.max(...x)}`;
}
async function load(rightHanded) {
  const scene = new Scene(new NullEngine());
  scene.useRightHandedSystem = rightHanded;
  const { meshes } = await ImportMeshAsync(new Uint8Array(glb), scene, { pluginExtension: '.glb' });
  return meshes.filter((mesh) => mesh.getTotalVertices() > 0);
}
const found = {};
for (const rightHanded of [false, true]) {
  const name = rightHanded ? 'right' : 'left';
  const meshes = await load(rightHanded);
  found[name] = { obj: obj(meshes), before: seen(meshes), stl: [], after: [] };
  for (let i = 0; i < 3; i++) {
    found[name].stl.push(stl(meshes));
    found[name].after.push(seen(meshes));
  }
  const fresh = await load(rightHanded);
  found[name].instanced = [stl(fresh, true), stl(fresh, true)];
}
console.log(JSON.stringify(found, null, 2));

assert.equal(found.left.obj, 'as made, volume 1');
assert.equal(found.right.obj, 'as made, volume 1');
assert.deepEqual(found.left.instanced, ['as made, volume 1', 'as made, volume 1']);
assert.deepEqual(found.left.stl, ['as made, volume -1', 'mirrored, volume -1', 'as made, volume -1'], 'STL is right now');
assert.equal(found.left.before, 'x -1 .. 0');
assert.deepEqual(found.left.after, ['x 0 .. 1', 'x -1 .. 0', 'x 0 .. 1'], 'the scene stays as it was now');
assert.equal(found.right.stl[0], 'mirrored, volume -1', 'STL of a right-handed scene is right now');
console.log('as described');
EOF
node run.mjs
