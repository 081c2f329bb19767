#!/usr/bin/env bash
# three.js PLYLoader: dark vertex colors of a PLY fall together: of 256 shades 183 are left, the darkest seven are black
#
# Versions:   three 0.187.0
# Behavior:  PLYLoader turns sRGB colors into linear light and, for `uchar`, rounds the result to whole bytes again, in a
#             Uint8Array: 8 bits of linear light have no room for dark shades. Colors of each face are not even rounded but
#             cut down. The same values as `float` come exact, and OBJLoader keeps floats.
# Output seen: grey 0 to 255, back in sRGB: 0 .. 6 become 0, 7 .. 17 become 13, 18 .. 25 become 22; 183 shades are left, off by
#             up to 6; by faces 0 .. 12 become 0; as float 256 shades, off by 0
# One would guess: eight bits in, the same eight bits on screen.
# Who is hurt: scans with vertex colors: shadows and dark cloth band and turn black; and once exported again it is for good.
# Instead:    write float colors into the PLY; or an OBJ; or read the bytes into an attribute of floats by oneself.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-save --no-audit --no-fund --prefix . three@0.187.0
cat > run.mjs <<'EOF'
import assert from 'node:assert';
import { Color, SRGBColorSpace } from 'three';
import { OBJLoader } from 'three/addons/loaders/OBJLoader.js';
import { PLYLoader } from 'three/addons/loaders/PLYLoader.js';

const greys = Array.from({ length: 256 }, (_, i) => i);
const position = ['x', 'y', 'z'].map((name) => `property float ${name}`).join('\n');
const color = (type) => ['red', 'green', 'blue'].map((name) => `property ${type} ${name}`).join('\n');
const list = 'property list uchar int vertex_indices';
/** A point for each grey, or three points and a face for each. */
const byVertex = (type, scale) => `ply\nformat ascii 1.0\nelement vertex 256\n${position}\n${color(type)}\nend_header\n`
  + greys.map((i) => `${i} 0 0 ${[0, 0, 0].fill(i / scale).join(' ')}\n`).join('');
const byFace = `ply\nformat ascii 1.0\nelement vertex 3\n${position}\nelement face 256\n${list}\n${color('uchar')}\nend_header\n`
  + '0 0 0\n1 0 0\n0 1 0\n' + greys.map((i) => `3 0 1 2 ${i} ${i} ${i}\n`).join('');
const obj = greys.map((i) => `v ${i} 0 0 ${[0, 0, 0].fill(i / 255).join(' ')}\n`).join('')
  + Array.from({ length: 254 }, (_, i) => `f ${i + 1} ${i + 2} ${i + 3}\n`).join('');

/** The shade in sRGB that an attribute has at each index, of 255. */
function shades(attribute, at) {
  const one = new Color();
  return greys.map((i) => Math.round(255 * one.fromBufferAttribute(attribute, at(i)).getRGB({}, SRGBColorSpace).r));
}
const parse = (text) => new PLYLoader().parse(text).attributes.color;
const found = {
  uchar: shades(parse(byVertex('uchar', 1)), (i) => i),
  face: shades(parse(byFace), (i) => 3 * i),
  float: shades(parse(byVertex('float', 255)), (i) => i),
  obj: shades(new OBJLoader().parse(obj).children[0].geometry.attributes.color, (i) => (i < 254 ? 3 * i : 3 * 253 + i - 253)),
};
const off = (name) => Math.max(...found[name].map((x, i) => Math.abs(x - i)));
for (const name in found) {
  console.log(`${name}: ${new Set(found[name]).size} shades, off by up to ${off(name)}; the first 26: ${found[name].slice(0, 26).join(' ')}`);
}
assert.equal(off('float'), 0);
assert.equal(off('obj'), 0);
assert.ok(new Set(found.uchar).size < 200 && off('uchar') > 5, 'PLYLoader keeps dark shades now');
assert.ok(found.uchar.slice(0, 7).every((x) => x === 0) && found.uchar[7] === 13 && found.uchar[17] === 13);
assert.ok(found.face.slice(0, 10).every((x) => x === 0), 'colors of faces keep dark shades now');
console.log('as described');
EOF
node run.mjs
