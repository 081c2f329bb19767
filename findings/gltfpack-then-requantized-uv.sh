#!/usr/bin/env bash
# gltf-transform's dequantize and quantize after gltfpack leave 257 of 4,096 steps of UV: letters of a texture shift
#
# Versions:   npm gltfpack 1.3.0, @gltf-transform/core, extensions, functions 4.5.1
# Behavior:  gltfpack keeps 12-bit UVs as integers 0..4095 in a normalized short, which is 0..0.0625, and scales them back
#             by 16 with KHR_texture_transform. gltf-transform's quantize() rounds UVs to 1/4095 of [0, 1], whatever
#             texture transform follows, so its 12 bits are 8 once the transform is applied. dequantize() leaves the
#             transform where it is. Both tools say 12 bits and neither warns.
# Output seen: distinct u: source 4000, gltfpack 4000, then dequantize + quantize 257; largest error of u, as rendered,
#             1.3e-04 after gltfpack, 2.1e-03 after both: 8 texels of a 4096 texture
# One would guess: 12 bits twice stay about 12 bits.
# Who is hurt: pipelines that unpack other people's files, edit (weld, simplify, join) and compress again.
# Instead:    bake KHR_texture_transform into the UVs before quantizing, or quantizeTexcoord: 16 on such files.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-save --no-audit --no-fund --prefix . gltfpack@1.3.0 @gltf-transform/core@4.5.1 \
    @gltf-transform/extensions@4.5.1 @gltf-transform/functions@4.5.1
cat > run.mjs <<'EOF'
import assert from 'node:assert';
import { execFileSync } from 'node:child_process';
import { Document, Logger, NodeIO } from '@gltf-transform/core';
import { ALL_EXTENSIONS } from '@gltf-transform/extensions';
import { dequantize, quantize } from '@gltf-transform/functions';

const io = new NodeIO().registerExtensions(ALL_EXTENSIONS).setLogger(new Logger(Logger.Verbosity.WARN));
const PNG = Buffer.from('', 'base64'); // one pixel

// 2,000 thin triangles in a row; x of a vertex is its u, so that a reader can tell where each u belongs.
const count = 2000;
const position = new Float32Array(9 * count);
const uv = new Float32Array(6 * count);
for (let k = 0; k < 3 * count; k++) {
  const u = (Math.floor(k / 3) * 2 + (k % 3 === 1)) / (2 * count - 1);
  position.set([u, k % 3 === 2 ? 1 : 0, 0], 3 * k);
  uv.set([u, k % 3 === 2 ? 1 : 0], 2 * k);
}
const source = new Document();
const buffer = source.createBuffer();
const accessor = (type, array) => source.createAccessor().setType(type).setArray(array).setBuffer(buffer);
const image = source.createTexture().setImage(new Uint8Array(PNG)).setMimeType('image/png');
const prim = source.createPrimitive().setAttribute('POSITION', accessor('VEC3', position))
  .setAttribute('TEXCOORD_0', accessor('VEC2', uv)).setMaterial(source.createMaterial().setBaseColorTexture(image));
source.createScene().addChild(source.createNode().setMesh(source.createMesh().addPrimitive(prim)));
await io.write('source.glb', source);

/** Distinct u, and the largest error of u as a renderer sees it, x of the vertex being the truth. */
function measure(name, document) {
  const [node] = document.getRoot().listNodes().filter((n) => n.getMesh());
  const [scale, offset] = [node.getWorldScale()[0], node.getWorldTranslation()[0]];
  const prim = node.getMesh().listPrimitives()[0];
  const transform = prim.getMaterial().getBaseColorTextureInfo().getExtension('KHR_texture_transform');
  const [us, uo] = transform ? [transform.getScale()[0], transform.getOffset()[0]] : [1, 0];
  const distinct = new Set();
  let worst = 0;
  for (let i = 0; i < prim.getAttribute('POSITION').getCount(); i++) {
    const u = prim.getAttribute('TEXCOORD_0').getElement(i, [])[0];
    distinct.add(u);
    worst = Math.max(worst, Math.abs(u * us + uo - (prim.getAttribute('POSITION').getElement(i, [])[0] * scale + offset)));
  }
  console.log(`${name}: ${distinct.size} distinct u, largest error ${worst.toExponential(1)}`);
  return [distinct.size, worst];
}
measure('source', source);
const own = await io.read('source.glb');
await own.transform(quantize({ quantizePosition: 16 }));
const [, alone] = measure('gltf-transform quantize alone', own);
execFileSync('node_modules/.bin/gltfpack', ['-i', 'source.glb', '-o', 'packed.glb', '-vp', '16']);
const packed = await io.read('packed.glb');
const [steps, before] = measure('gltfpack', packed);
await packed.transform(dequantize(), quantize({ quantizePosition: 16 }));
const [left, after] = measure('gltfpack, dequantize, quantize', packed);
assert(steps > 1500 && before < 3e-4 && alone < 3e-4);
assert(left < 300 && after > 1e-3, 'quantize takes the texture transform into account now');
console.log('as described');
EOF
node run.mjs
