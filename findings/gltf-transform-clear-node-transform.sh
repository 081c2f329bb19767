#!/usr/bin/env bash
# gltf-transform clearNodeTransform: children of a scaled or turned node land elsewhere, and quantized normals become zero
#
# Versions:   npm @gltf-transform/core, functions 4.5.1
# Behavior:  the node's matrix is handed to its children as child x parent, where parent x child is meant: a parent that only
#             translates is right. The mesh's own vertices are multiplied rightly, but normals stored as normalized integers are
#             written back with the decoder for the encoder: 0.7 becomes 0.7 / 127, truncated to 0 (transformMesh and
#             transformPrimitive too). Nothing is raised or logged.
# Output seen: child 1 along x of a parent scaled by 2: world position before 2 0 0, after 1 0 0; parent turned by 90 degrees about
#             z: 0 1 0, after 1 0 0; parent moved by 5: 6 0 0 both. int8 normals under a scale of 1 3 1: 0 0 0
# One would guess: the function is named after keeping everything where it is while the transform goes.
# Who is hurt: scripts that "apply transforms" before measuring, merging or exporting: parts of a hierarchy fly apart; files from
#             gltfpack or meshopt lose their shading.
# Instead:    flatten() or clearNodeParent() on the children first, so that no node with a transform has any; dequantize() before.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-save --no-audit --no-fund --prefix . @gltf-transform/core@4.5.1 @gltf-transform/functions@4.5.1
cat > run.mjs <<'EOF'
import assert from 'node:assert';
import { Document } from '@gltf-transform/core';
import { clearNodeTransform } from '@gltf-transform/functions';

const document = new Document();
const buffer = document.createBuffer();
const accessor = (array) => document.createAccessor().setType('VEC3').setArray(array).setBuffer(buffer);
const rounded = (array) => array.map((x) => Number(x.toFixed(3)) + 0).join(' ');

/** World position of a child at [1, 0, 0] before and after its parent's transform is cleared. */
function child(name, change) {
  const node = document.createNode().setTranslation([1, 0, 0]);
  const parent = change(document.createNode()).addChild(node);
  const before = rounded(node.getWorldTranslation());
  clearNodeTransform(parent);
  const after = rounded(node.getWorldTranslation());
  console.log(`parent ${name}: child at ${before}, then ${after}`);
  return [before, after];
}
assert.deepEqual(child('moved by 5', (n) => n.setTranslation([5, 0, 0])), ['6 0 0', '6 0 0']);
assert.deepEqual(child('scaled by 2', (n) => n.setScale([2, 2, 2])), ['2 0 0', '1 0 0'], 'children stay now');
const quarter = [0, 0, Math.SQRT1_2, Math.SQRT1_2];
assert.deepEqual(child('turned by 90', (n) => n.setRotation(quarter)), ['0 1 0', '1 0 0'], 'children stay now');

/** The first normal after a scale of [1, 3, 1] is cleared. */
function normal(name, normals) {
  const prim = document.createPrimitive().setAttribute('NORMAL', normals)
    .setAttribute('POSITION', accessor(new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0])));
  const mesh = document.createMesh().addPrimitive(prim);
  const node = clearNodeTransform(document.createNode().setMesh(mesh).setScale([1, 3, 1]));
  const found = rounded(node.getMesh().listPrimitives()[0].getAttribute('NORMAL').getElement(0, []));
  console.log(`${name} normals: ${found}`);
  return found;
}
const s = Math.SQRT1_2;
assert.equal(normal('float', accessor(new Float32Array([s, s, 0, s, s, 0, s, s, 0]))), '0.949 0.316 0');
const bytes = accessor(new Int8Array([90, 90, 0, 90, 90, 0, 90, 90, 0])).setNormalized(true);
assert.equal(normal('int8', bytes), '0 0 0', 'quantized normals are kept now');
console.log('as described');
EOF
node run.mjs
