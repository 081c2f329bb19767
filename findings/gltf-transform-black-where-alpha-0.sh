#!/usr/bin/env bash
# gltf-transform + sharp: resizing, JPEG or *lossless* WebP paint an opaque texture black where its alpha is 0
#
# Versions:   npm sharp 0.35.5, @gltf-transform/core + functions 4.5.1; beside it Pillow 13.0.0
# Behavior:  glTF ignores the alpha of base colour in a material of alphaMode OPAQUE, and artists keep other things in it.
#             textureCompress() knows the material yet hands the image to sharp as RGBA, and sharp multiplies by alpha to
#             resize, lays on black for JPEG, and lets lossless WebP drop colours under alpha 0 (lossy WebP keeps them).
#             Pillow's resize, thumbnail, reduce and rotate do the same to an RGBA image.
# Output seen: texel (200, 100, 50, alpha 0): resize 0 0 0; JPEG 0 0 0; lossless WebP 0 0 0; lossy WebP 201 100 50;
#             AVIF 200 100 50; Pillow resize 0 0 0
# One would guess: lossless is lossless; an OPAQUE material looks the same afterwards; lossy loses more than lossless.
# Who is hurt: opaque assets whose alpha holds smoothness or a mask, or is an empty leftover: large black areas.
# Instead:    take alpha off where the material is OPAQUE (sharp: .removeAlpha(); Pillow: .convert("RGB")) before anything.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv env
env/bin/pip install -q --disable-pip-version-check Pillow==13.0.0
npm install --silent --no-save --no-audit --no-fund --prefix . sharp@0.35.5 @gltf-transform/core@4.5.1 \
    @gltf-transform/extensions@4.5.1 @gltf-transform/functions@4.5.1
cat > run.mjs <<'EOF'
import assert from 'node:assert';
import { Document, Logger } from '@gltf-transform/core';
import { textureCompress } from '@gltf-transform/functions';
import sharp from 'sharp';

const side = 64;
const pixels = Buffer.alloc(side * side * 4);
for (let i = 0; i < side * side; i++) pixels.set([200, 100, 50, i < side * side / 2 ? 255 : 0], 4 * i);
const png = await sharp(pixels, { raw: { width: side, height: side, channels: 4 } }).png().toBuffer();

/** The colour of a texel in the lower half, where alpha is 0. */
async function colour(image) {
  const { data, info } = await sharp(image).raw().toBuffer({ resolveWithObject: true });
  const at = ((info.height - 4) * info.width + 8) * info.channels;
  return [...data.subarray(at, at + 3)];
}
async function through(name, options) {
  const document = new Document().setLogger(new Logger(Logger.Verbosity.ERROR));
  const texture = document.createTexture().setImage(new Uint8Array(png)).setMimeType('image/png');
  document.createMaterial().setBaseColorTexture(texture).setAlphaMode('OPAQUE');
  await document.transform(textureCompress({ encoder: sharp, ...options }));
  const found = await colour(Buffer.from(texture.getImage()));
  console.log(`${name}: ${found}`);
  return found;
}
const near = (a) => Math.abs(a[0] - 200) < 6 && Math.abs(a[1] - 100) < 6 && Math.abs(a[2] - 50) < 6;
const black = (a) => Math.max(...a) === 0;
assert(near(await colour(png)));
assert(black(await through('resize', { targetFormat: 'png', resize: [32, 32] })), 'resize keeps colours now');
assert(black(await through('jpeg', { targetFormat: 'jpeg' })), 'JPEG keeps colours now');
assert(black(await through('webp, lossless', { targetFormat: 'webp', lossless: true })), 'lossless is lossless now');
assert(near(await through('webp, lossy', { targetFormat: 'webp' })));
assert(near(await through('avif', { targetFormat: 'avif' })));
EOF
node run.mjs
env/bin/python - <<'EOF'
from PIL import Image

image = Image.new("RGBA", (64, 64), (200, 100, 50, 0))
found = image.resize((32, 32)).getpixel((8, 8))
print("Pillow resize:", found)
assert found == (0, 0, 0, 0), "Pillow keeps colours now"
print("as described")
EOF
