"""glTF 2.0 as text, with its buffer and images in files beside it."""

from __future__ import annotations

import json

from nispcodec.core.arrays import Float32Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.io.write.gltf_compression import compressed
from nispcodec.io.write.gltf_tree import gltf_tree, uri
from nispcodec.io.write.names import image_names
from nispcodec.io.write.plain_images import MIMES, plain_image


def gltf_files(
    mesh: TexturedMesh,
    stem: str,
    colors: Float32Array | None = None,
    compress: str | None = None,
) -> dict[str, bytes]:
    """File name -> bytes of STEM.gltf, STEM.bin and one STEM_NAME for every texture in use.

    The document and its colors are those of `gltf_tree`. `compress` is one of
    `gltf_compression.COMPRESSIONS`, or None.
    """
    names = image_names(stem, mesh.textures)
    tree, binary = gltf_tree(mesh, colors, names)
    if compress:
        tree, binary = compressed(tree, binary, compress)
    tree["buffers"][0]["uri"] = uri(f"{stem}.bin")
    used = {each.texture for material in mesh.materials for each in material.maps.values()}
    shown = {names[number]: plain_image(mesh.textures[number], MIMES) for number in sorted(used)}
    images = {name: image.data for name, image in shown.items()}
    text = json.dumps(tree, indent=1).encode()
    return images | {f"{stem}.bin": binary, f"{stem}.gltf": text}
