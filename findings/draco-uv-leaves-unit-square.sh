#!/usr/bin/env bash
# Draco moves UVs of exactly 1 beyond 1, and gltf-transform's quantize then leaves them alone
#
# Versions:   npm @gltf-transform/core, extensions, functions 4.5.1, draco3dgltf 1.5.7
# Behavior:  Draco quantizes u and v with one step, the larger of their two ranges divided by 2^bits - 1, from each one's
#             minimum. Unless both ranges are equal, the maximum of the shorter does not fall on a step and may be
#             rounded up past 1. gltf-transform's quantize() and meshopt() skip UV sets with any value outside [0, 1]
#             (a warning in the log), so after Draco the whole set stays 32-bit floats.
# Output seen: u from 0.0208 to 1: after draco() and reading back max u = 1.000043 (12 bits); quantize() alone makes
#             UVs unsigned shorts, after Draco they stay floats
# One would guess: coordinates in [0, 1] stay there; at most the last digit moves.
# Who is hurt: whoever re-compresses Draco files from the web (files grow); whoever takes u modulo 1 (an atlas packer, a
#             baker): a corner at 1.00004 becomes 0.00004 and its triangle is smeared over the whole image; tools
#             that ask "does it tile?" by max > 1.
# Instead:    clamp to [0, 1] what is within a step of it after decoding, before anything asks.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-save --no-audit --no-fund --prefix . @gltf-transform/core@4.5.1 draco3dgltf@1.5.7 \
    @gltf-transform/extensions@4.5.1 @gltf-transform/functions@4.5.1
cat > run.mjs <<'EOF'
import assert from 'node:assert';
import { createRequire } from 'node:module';
import { Document, Logger, NodeIO } from '@gltf-transform/core';
import { ALL_EXTENSIONS } from '@gltf-transform/extensions';
import { draco, quantize } from '@gltf-transform/functions';
const draco3d = createRequire(import.meta.url)('draco3dgltf');

const io = new NodeIO().registerExtensions(ALL_EXTENSIONS).registerDependencies({
  'draco3d.encoder': await draco3d.createEncoderModule(), 'draco3d.decoder': await draco3d.createDecoderModule(),
});
function grid() {
  const document = new Document();
  document.setLogger(new Logger(Logger.Verbosity.ERROR));
  const buffer = document.createBuffer();
  const accessor = (type, array) => document.createAccessor().setType(type).setArray(array).setBuffer(buffer);
  const n = 25;
  const points = [], uvs = [], faces = [];
  for (let i = 0; i < n; i++) for (let j = 0; j < n; j++) {
    points.push(j / (n - 1), i / (n - 1), 0);
    uvs.push(0.0208 + (1 - 0.0208) * j / (n - 1), i / (n - 1));
    if (i && j) faces.push(i * n + j, i * n + j - 1, i * n + j - n - 1, i * n + j, i * n + j - n - 1, i * n + j - n);
  }
  const prim = document.createPrimitive().setIndices(accessor('SCALAR', new Uint16Array(faces)))
    .setAttribute('POSITION', accessor('VEC3', new Float32Array(points)))
    .setAttribute('TEXCOORD_0', accessor('VEC2', new Float32Array(uvs))).setMaterial(document.createMaterial());
  document.createScene().addChild(document.createNode().setMesh(document.createMesh().addPrimitive(prim)));
  return document;
}
const uvOf = (document) => document.getRoot().listMeshes()[0].listPrimitives()[0].getAttribute('TEXCOORD_0');
const show = (name, uv) => console.log(`${name}: max u ${uv.getMaxNormalized([])[0]}, stored as ${uv.getArray().constructor.name}`);

const plain = grid();
show('source', uvOf(plain));
await plain.transform(quantize());
show('quantize', uvOf(plain));
const coded = grid();
await coded.transform(draco());
const back = await io.readBinary(await io.writeBinary(coded));
back.setLogger(new Logger(Logger.Verbosity.ERROR));
const max = uvOf(back).getMax([])[0];
show('draco, read back', uvOf(back));
await back.transform(quantize({ cleanup: false }));
show('draco, read back, quantize', uvOf(back));
assert(uvOf(plain).getArray() instanceof Uint16Array);
assert(max > 1.00001 && max < 1.001, 'Draco stays in the unit square now');
assert(uvOf(back).getArray() instanceof Float32Array, 'quantize takes UVs a little outside now');
console.log('as described');
EOF
node run.mjs
