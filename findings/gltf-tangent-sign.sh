#!/usr/bin/env bash
# gltfpack -gt and three.js' computeTangents write glTF tangents with the handedness reversed: bumps turn into dents
#
# Versions:   npm gltfpack 1.3.0, three 0.187.0, @gltf-transform/core + functions 4.5.1, mikktspace 1.1.1
# Behavior:  in glTF v runs down the image and green of a normal map points up it, so an unmirrored chart has
#             TANGENT.w = +1 (bitangent = cross(normal, tangent) * w points where v decreases). gltf-transform's
#             tangents() turns over the sign that MikkTSpace gives. gltfpack's new option -gt does not; nor does
#             BufferGeometry.computeTangents(), whose tangents GLTFExporter writes as they are.
# Output seen: gltf-transform w = +1, bitangent +y; gltfpack -gt w = -1, bitangent -y; three w = -1, bitangent -y
# One would guess: a glTF tool writes tangents in glTF's convention.
# Who is hurt: whoever adds tangents so that a normal map is shaded alike everywhere: its y is inverted everywhere,
#             and only where tangents are present, so the file without them looks right.
# Instead:    gltf-transform's tangents() with mikktspace; three: computeMikkTSpaceTangents of BufferGeometryUtils; or
#             negate w after -gt.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-save --no-audit --no-fund --prefix . gltfpack@1.3.0 three@0.187.0 @gltf-transform/core@4.5.1 \
    @gltf-transform/extensions@4.5.1 @gltf-transform/functions@4.5.1 mikktspace@1.1.1
cat > run.mjs <<'EOF'
import assert from 'node:assert';
import { execFileSync } from 'node:child_process';
import { writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { Document, NodeIO } from '@gltf-transform/core';
import { tangents, unweld } from '@gltf-transform/functions';
import * as THREE from 'three';
const { generateTangents } = createRequire(import.meta.url)('mikktspace');

// A square seen from +z, the top row of the image (v = 0) at y = 1: nothing is mirrored.
const points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]];
const position = new Float32Array(points.flat());
const normal = new Float32Array(points.flatMap(() => [0, 0, 1]));
const uv = new Float32Array(points.flatMap(([x, y]) => [x, 1 - y]));
const index = new Uint16Array([0, 1, 2, 0, 2, 3]);
// One pixel of PNG, the flat normal.
const PNG = Buffer.from('iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGNoaPgPAAODAgAApfuJAAAAAElFTkSuQmCC', 'base64');

function square() {
  const document = new Document();
  const buffer = document.createBuffer();
  const accessor = (type, array) => document.createAccessor().setType(type).setArray(array).setBuffer(buffer);
  const image = document.createTexture().setImage(new Uint8Array(PNG)).setMimeType('image/png');
  const prim = document.createPrimitive().setIndices(accessor('SCALAR', index))
    .setAttribute('POSITION', accessor('VEC3', position)).setAttribute('NORMAL', accessor('VEC3', normal))
    .setAttribute('TEXCOORD_0', accessor('VEC2', uv))
    .setMaterial(document.createMaterial().setNormalTexture(image));
  document.createScene().addChild(document.createNode().setMesh(document.createMesh().addPrimitive(prim)));
  return document;
}
const tangentOf = (document) =>
  document.getRoot().listMeshes()[0].listPrimitives()[0].getAttribute('TANGENT').getElement(0, []).map(Math.round);

const io = new NodeIO();
const found = {};
await io.write('square.glb', square());
const written = square();
await written.transform(unweld(), tangents({ generateTangents }));
found['gltf-transform'] = tangentOf(written);
execFileSync('node_modules/.bin/gltfpack', ['-i', 'square.glb', '-o', 'packed.glb', '-gt', '-noq']);
found['gltfpack -gt'] = tangentOf(await io.read('packed.glb'));

// three.js: the same geometry, as GLTFLoader would give it, through GLTFExporter.
globalThis.FileReader = class {
  readAsDataURL(blob) {
    blob.arrayBuffer().then((b) => { this.result = 'data:application/octet-stream;base64,' + Buffer.from(b).toString('base64'); this.onloadend(); });
  }
};
const { GLTFExporter } = await import('three/examples/jsm/exporters/GLTFExporter.js');
const geometry = new THREE.BufferGeometry().setIndex([...index]);
geometry.setAttribute('position', new THREE.BufferAttribute(position, 3));
geometry.setAttribute('normal', new THREE.BufferAttribute(normal, 3));
geometry.setAttribute('uv', new THREE.BufferAttribute(uv, 2));
geometry.computeTangents();
writeFileSync('three.gltf', JSON.stringify(await new GLTFExporter().parseAsync(new THREE.Mesh(geometry))));
found.three = tangentOf(await io.read('three.gltf'));

for (const [name, [tx, ty, tz, w]] of Object.entries(found)) {
  const y = tx * w; // y of cross([0, 0, 1], tangent) * w: where the green of a normal map points
  console.log(`${name}: tangent ${[tx, ty, tz]}, w ${w}; green of the normal map points to ${y > 0 ? 'the top' : 'the bottom'} of the image`);
}
assert.deepEqual(found['gltf-transform'], [1, 0, 0, 1]);
assert.deepEqual(found['gltfpack -gt'], [1, 0, 0, -1], 'gltfpack has changed');
assert.deepEqual(found.three, [1, 0, 0, -1], 'three.js has changed');
console.log('as described');
EOF
node run.mjs
