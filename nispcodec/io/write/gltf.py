"""glTF 2.0 as text, with its buffer and images in files beside it."""

from __future__ import annotations

import json

from nispcodec.core.arrays import Float32Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.io.write.gltf_compression import compressed
from nispcodec.io.write.gltf_tree import gltf_tree, uri
from nispcodec.io.write.images_beside import ImagesBeside


def gltf_files(
    mesh: TexturedMesh,
    stem: str,
    images: ImagesBeside,
    colors: Float32Array | None = None,
    compress: str | None = None,
) -> dict[str, bytes]:
    """File name -> bytes of STEM.gltf, STEM.bin and `images` for every texture in use.

    The document and its colors are those of `gltf_tree`. `compress` is one of
    `gltf_compression.COMPRESSIONS`, or None.
    """
    tree, binary = gltf_tree(mesh, colors, images.names)
    if compress:
        tree, binary = compressed(tree, binary, compress)
    tree["buffers"][0]["uri"] = uri(f"{stem}.bin")
    used = {each.texture for material in mesh.materials for each in material.maps.values()}
    text = json.dumps(tree, indent=1).encode()
    return images.files(mesh, sorted(used)) | {f"{stem}.bin": binary, f"{stem}.gltf": text}
