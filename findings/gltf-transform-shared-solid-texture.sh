#!/usr/bin/env bash
# gltf-transform prune and optimize: materials that share a one-color texture multiply into each other, down to black
#
# Versions:   npm @gltf-transform/cli, core 4.5.1
# Behavior:  prune turns a texture of one color into material factors (on by default, in optimize too). For base color the
#             product is written back into the texture's own color, so the next material that uses the same texture is
#             multiplied by the factors of all before it. The log says `Removed types... Texture (1)`, no more.
# Output seen: one white 4 x 4 texture, factors red [1, .1, .1], green [.1, 1, .1], blue [.1, .1, 1], grey [.5, .5, .5], each
#             with alpha .5: after prune or optimize red stays, green is [.1, .1, .01, .25], blue [.01, .01, .01, .125],
#             grey [.005, .005, .005, .0625]; with --keep-solid-textures true all stay
# One would guess: white times a factor is the factor.
# Who is hurt: exporters that give every untextured material one shared white pixel: the first material is right, the later
#             ones darken in order of their place in the file and vanish where they blend.
# Instead:    prune --keep-solid-textures true, optimize --prune-solid-textures false; or one texture for each material.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-save --no-audit --no-fund --prefix . @gltf-transform/cli@4.5.1 @gltf-transform/core@4.5.1
cat > run.mjs <<'EOF'
import assert from 'node:assert';
import { execFileSync } from 'node:child_process';
import { Document, NodeIO } from '@gltf-transform/core';

// Four by four white pixels.
const PNG = Buffer.from('iVBORw0KGgoAAAANSUhEUgAAAAQAAAAECAIAAAAmkwkpAAAAD0lEQVR42mP4jwQYiOMAANuQL9HXPgz1AAAAAElFTkSuQmCC', 'base64');
const factors = { red: [1, 0.1, 0.1, 0.5], green: [0.1, 1, 0.1, 0.5], blue: [0.1, 0.1, 1, 0.5], grey: [0.5, 0.5, 0.5, 0.5] };
const document = new Document();
const buffer = document.createBuffer();
const accessor = (type, array) => document.createAccessor().setType(type).setArray(array).setBuffer(buffer);
const white = document.createTexture('white').setImage(new Uint8Array(PNG)).setMimeType('image/png');
const mesh = document.createMesh();
Object.entries(factors).forEach(([name, factor], i) => mesh.addPrimitive(document.createPrimitive()
  .setAttribute('POSITION', accessor('VEC3', new Float32Array([i, 0, 0, i + 1, 0, 0, i, 1, 0])))
  .setAttribute('TEXCOORD_0', accessor('VEC2', new Float32Array([0, 0, 1, 0, 0, 1])))
  .setMaterial(document.createMaterial(name).setBaseColorFactor(factor).setBaseColorTexture(white).setAlphaMode('BLEND'))));
document.createScene().addChild(document.createNode().setMesh(mesh));
const io = new NodeIO();
await io.write('source.glb', document);

/** By material, the base color that a command leaves; the texture is white or gone. */
async function run(...args) {
  execFileSync('node_modules/.bin/gltf-transform', [args[0], 'source.glb', 'out.glb', ...args.slice(1)], { stdio: 'ignore' });
  const found = {};
  for (const material of (await io.read('out.glb')).getRoot().listMaterials()) {
    found[material.getName()] = material.getBaseColorFactor().map((x) => Number(x.toFixed(4)));
  }
  console.log(args.join(' '));
  for (const name in factors) console.log(`    ${name}: ${factors[name]} -> ${found[name]}`);
  return found;
}
assert.deepEqual(await run('prune', '--keep-solid-textures', 'true'), factors);
const plain = ['--compress', 'false', '--palette', 'false'];
assert.deepEqual(await run('optimize', '--prune-solid-textures', 'false', ...plain), factors);
for (const args of [['prune'], ['optimize', ...plain]]) {
  const found = await run(...args);
  assert.deepEqual(found.red, factors.red);
  assert.deepEqual(found.green, [0.1, 0.1, 0.01, 0.25], 'the texture keeps its color now');
  assert.deepEqual(found.grey, [0.005, 0.005, 0.005, 0.0625], 'the texture keeps its color now');
}
console.log('as described');
EOF
node run.mjs
