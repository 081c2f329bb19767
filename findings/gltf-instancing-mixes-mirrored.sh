#!/usr/bin/env bash
# gltf-transform optimize and gltfpack -mi put mirrored and plain parts into one instanced batch; three.js cannot draw both
#
# Versions:   npm @gltf-transform/cli 4.5.1, gltfpack 1.3.0, three 0.187.0
# Behavior:  `optimize` turns a mesh used by five or more nodes into EXT_mesh_gpu_instancing by default, gltfpack does with
#             -mi, both whatever the signs of the nodes' scales. A GPU draws a batch with one winding: three.js chooses it
#             by the object's own matrix, so the mirrored instances show their insides. As nodes of their own they are
#             right. three.js calls negative scales of instances unsupported; the extension does not forbid them.
# Output seen: source: 8 nodes, 4 mirrored; optimize: one batch of 8, signs + - + - + - + -; gltfpack -mi: the same;
#             in three.js one InstancedMesh whose own determinant is +1. gltf-validator: no error, no warning
# One would guess: an optimizer keeps the picture; mirrored nodes are kept apart as glTF's winding rule asks.
# Who is hurt: chairs, wheels, windows, leaves placed by mirroring: half of them inside out in the browser.
# Instead:    optimize --instance false where any node has a negative determinant, or split by sign before.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-save --no-audit --no-fund --prefix . @gltf-transform/cli@4.5.1 gltfpack@1.3.0 three@0.187.0 \
    gltf-validator@2.0.0-dev.3.10
cat > run.mjs <<'EOF'
import assert from 'node:assert';
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { Document, NodeIO } from '@gltf-transform/core';
import validator from 'gltf-validator';
import * as THREE from 'three';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';

// A closed tetrahedron, placed eight times, every second one mirrored.
const document = new Document();
const buffer = document.createBuffer();
const accessor = (type, array) => document.createAccessor().setType(type).setArray(array).setBuffer(buffer);
const prim = document.createPrimitive()
  .setAttribute('POSITION', accessor('VEC3', new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1])))
  .setIndices(accessor('SCALAR', new Uint16Array([0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3])));
const mesh = document.createMesh('part').addPrimitive(prim);
const scene = document.createScene();
for (let i = 0; i < 8; i++) {
  scene.addChild(document.createNode().setMesh(mesh).setTranslation([3 * i, 0, 0]).setScale([i % 2 ? -1 : 1, 1, 1]));
}
await new NodeIO().write('source.glb', document);

/** For each mesh as three.js has it: the sign of its own matrix, and of its instances' matrices. */
async function load(path) {
  const bytes = new Uint8Array(readFileSync(path));
  const { issues } = await validator.validateBytes(bytes);
  assert.equal(issues.numErrors + issues.numWarnings, 0);
  const found = [];
  const { scene } = await new GLTFLoader().parseAsync(bytes.buffer, '');
  scene.updateMatrixWorld(true);
  scene.traverse((object) => {
    if (!object.isMesh) return;
    const instances = [];
    const matrix = new THREE.Matrix4();
    for (let i = 0; i < (object.isInstancedMesh ? object.count : 0); i++) {
      object.getMatrixAt(i, matrix);
      instances.push(Math.sign(matrix.determinant()));
    }
    found.push({ own: Math.sign(object.matrixWorld.determinant()), instances });
  });
  console.log(`${path}: ${found.length} drawn; ` + found.map((f) => `${f.own} (${f.instances})`).join(' '));
  return found;
}
globalThis.self = globalThis;
const source = await load('source.glb');
assert.equal(source.filter((f) => f.own < 0).length, 4);
execFileSync('node_modules/.bin/gltf-transform', ['optimize', 'source.glb', 'optimized.glb', '--compress', 'false'], { stdio: 'ignore' });
execFileSync('node_modules/.bin/gltfpack', ['-i', 'source.glb', '-o', 'packed.glb', '-mi', '-noq']);
for (const path of ['optimized.glb', 'packed.glb']) {
  const found = await load(path);
  assert.equal(found.length, 1, `${path}: mirrored parts are kept apart now`);
  assert(found[0].own > 0 && found[0].instances.filter((s) => s < 0).length === 4, `${path}: signs have changed`);
}
console.log('as described');
EOF
node run.mjs
