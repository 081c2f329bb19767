#!/usr/bin/env bash
# loaders.gl: vertex colors of an OBJ come from the wrong vertices once faces have UVs or normals
#
# Versions:   npm @loaders.gl/core 4.5.4, @loaders.gl/obj 4.5.2; beside it three 0.187.0
# Behavior:  the loader looks a corner's color up with the index that it resolved last: the normal's if the face has one, else
#             the UV's. Both count in their own lists, and a UV's offset is two numbers a vertex where a color has three. Only
#             `f 1 2 3` is right. Where the list of UVs is longer than that of vertices, colors are NaN.
# Output seen: red, green, blue corners: `f 1 2 3` red green blue; with `1/1 2/2 3/3` red blue red, as offset 2 reads the end of
#             red and the start of green; with one normal for all (`1//1 2//1 3//1`) red red red; with six UVs (`1/4 2/5 3/6`)
#             blue, then NaN; three's OBJLoader: red green blue each time
# One would guess: a color stands on the v line, so it goes with the first index, whatever follows.
# Who is hurt: scans and sculpts that have both colors and UVs or normals, as MeshLab, Blender and trimesh write them, in
#             deck.gl and whoever loads OBJ by loaders.gl: a shuffle of the model's own colors looks like noise or bad light.
# Instead:    write colored OBJ files without vt and vn, or PLY or GLB; or three's OBJLoader.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-save --no-audit --no-fund --prefix . @loaders.gl/core@4.5.4 @loaders.gl/obj@4.5.2 three@0.187.0
cat > run.mjs <<'EOF'
import assert from 'node:assert';
import { parse } from '@loaders.gl/core';
import { OBJLoader } from '@loaders.gl/obj';
import { OBJLoader as ThreeLoader } from 'three/examples/jsm/loaders/OBJLoader.js';

const vertices = 'v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\n'; // red, green, blue
const uvs = 'vt 0 0\nvt 1 0\nvt 0 1\n';
const cases = {
  'no UVs': 'f 1 2 3\n',
  'a UV for each vertex': uvs + 'f 1/1 2/2 3/3\n',
  'one normal': 'vn 0 0 1\nf 1//1 2//1 3//1\n',
  'more UVs than vertices': uvs + uvs + 'f 1/4 2/5 3/6\n',
};
const triples = (array) => [0, 3, 6].map((i) => [...array.slice(i, i + 3)].join(','));
const right = ['1,0,0', '0,1,0', '0,0,1'];
const found = {};
for (const [name, faces] of Object.entries(cases)) {
  const mesh = await parse(new TextEncoder().encode(vertices + faces).buffer, OBJLoader);
  assert.deepEqual(triples(mesh.attributes.POSITION.value), ['0,0,0', '1,0,0', '0,1,0']);
  found[name] = triples(mesh.attributes.COLOR_0.value);
  const three = new ThreeLoader().parse(vertices + faces).children[0].geometry.getAttribute('color').array;
  console.log(`${name}: loaders.gl ${found[name].join(' ')}; three ${triples(three).join(' ')}`);
  assert.deepEqual(triples(three), right);
}
assert.deepEqual(found['no UVs'], right);
assert.deepEqual(found['a UV for each vertex'], ['1,0,0', '0,0,1', '1,0,0'], 'colors go with their vertices now');
assert.deepEqual(found['one normal'], ['1,0,0', '1,0,0', '1,0,0'], 'colors go with their vertices now');
assert(found['more UVs than vertices'][2].includes('NaN'), 'colors go with their vertices now');
console.log('as described');
EOF
node run.mjs
