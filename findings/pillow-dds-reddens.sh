#!/usr/bin/env bash
# Pillow: a texture saved as DXT1 or DXT5 turns redder, and a step in a BC5 normal map or DXT5 alpha loses 40 % of its height
#
# Versions:   Pillow 13.0.0, numpy 2.4.6
# Behavior:  a block's two end colors are the least and greatest of its packed 16-bit numbers, in which red stands highest: green
#             and blue hardly count. A pixel is then placed by each channel's distance from the lesser end without sign,
#             which pulls it to the redder one. For alpha and for both channels of BC5 the two ends are stored, but no pixel
#             ever takes them: all lie between 1/5 and 4/5 of the block's range, but for exactly 0 and 255.
# Output seen: mean error of red, green, blue for a smooth random texture: DXT1 and DXT5 +14.9 +1.1 -1.0, rms 28.5; a plain
#             encoder of twenty lines 0.1 0.0 0.0, rms 15.9; red and blue exchanged first: again red, +16.3. BC5 of a
#             checkerboard of 64 and 192, and DXT5 alpha of the same: 89 and 166, where the format holds both exactly
# One would guess: a lossy codec errs alike in all channels, and two values in a block are the easy case.
# Who is hurt: whoever writes game textures or normal maps from Python: a warm cast over the whole image, bumps flattened; codec
#             comparisons that take Pillow's DXT as the baseline.
# Instead:    pixel_format=None (uncompressed), or a real encoder (texconv, bc7enc, compressonator, basisu) and Pillow to read.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv env
env/bin/pip install -q --disable-pip-version-check Pillow==13.0.0 numpy==2.4.6
env/bin/python - <<'EOF'
import numpy as np
from PIL import Image

def saved(pixels, kind):
    Image.fromarray(pixels).save("a.dds", pixel_format=kind)
    return np.asarray(Image.open("a.dds"))[..., :pixels.shape[2]].astype(int)

def plain_bc1(pixels):
    """What BC1 holds with end colors on the main axis of each block, rounded to 565, and the nearest of four for each pixel."""
    h, w, _ = pixels.shape
    blocks = pixels.reshape(h // 4, 4, w // 4, 4, 3).swapaxes(1, 2).reshape(-1, 16, 3).astype(float)
    mean = blocks.mean(1, keepdims=True)
    axis = np.linalg.svd(blocks - mean)[2][:, :1]
    along = ((blocks - mean) * axis).sum(-1)
    levels = np.array([31, 63, 31])
    ends = [np.round(np.clip(mean[:, 0] + axis[:, 0] * t[:, None], 0, 255) / 255 * levels) / levels * 255
            for t in (along.min(1), along.max(1))]
    four = np.stack([(ends[0] * (3 - k) + ends[1] * k) / 3 for k in range(4)], 1)
    nearest = ((blocks[:, :, None] - four[:, None]) ** 2).sum(-1).argmin(-1)
    out = np.take_along_axis(four, nearest[..., None], 1)
    return out.reshape(h // 4, w // 4, 4, 4, 3).swapaxes(1, 2).reshape(h, w, 3)

def report(name, found, pixels):
    error = found[..., :3] - pixels.astype(float)
    bias, rms = error.mean((0, 1)), float(np.sqrt((error ** 2).mean()))
    print(f"{name}: mean error of red, green, blue {bias.round(1).tolist()}, rms {rms:.1f}")
    return bias, rms

coarse = np.random.default_rng(0).integers(0, 256, (32, 32, 3)).astype(np.uint8)
texture = np.asarray(Image.fromarray(coarse).resize((128, 128), Image.Resampling.BICUBIC))
bias, rms = report("plain BC1", plain_bc1(texture), texture)
assert abs(bias).max() < 1 and rms < 17
for name, pixels in (("texture", texture), ("red and blue exchanged", texture[..., ::-1].copy())):
    bias, rms = report("DXT1, " + name, saved(pixels, "DXT1"), pixels)
    assert bias[0] > 8 and abs(bias[1:]).max() < 5, "no longer redder"
opaque = np.dstack([texture, np.full((128, 128), 255, np.uint8)])
bias, _ = report("DXT5, texture", saved(opaque, "DXT5"), texture)
assert bias[0] > 8, "no longer redder"

i = np.arange(64)
board = np.where((i[:, None] + i) % 2, 192, 64).astype(np.uint8)
normals = saved(np.dstack([board, board.T, np.full_like(board, 255)]), "BC5")
alpha = saved(np.dstack([board] * 4), "DXT5")[..., 3]
print("64 and 192: BC5", *np.unique(normals[..., :2]), "DXT5 alpha", *np.unique(alpha))
for found in (normals[..., 0], normals[..., 1], alpha):
    assert np.unique(found).tolist() == [89, 166], "steps keep their height now"
print("as described")
EOF
