"""The slots of a material: what a map is for, and what other formats call it. A new one is a line.

The order is that of the numbers in a `.nisp` file, counted from 1.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Slot:
    """One use of an image.

    srgb           its texels are sRGB-encoded colors, and no data
    gltf_owner     the object of a glTF material that holds it: "" for the material itself
    gltf_key       its textureInfo there
    gltf_strength  the member of that which scales it, "" for none
    mtl_read       MTL statements that mean it, the first one that is there winning
    mtl_write      MTL statements that it is written as; none: MTL has no word for it
    blank          RGBA of a material without a map
    """

    name: str
    srgb: bool
    gltf_owner: str
    gltf_key: str
    gltf_strength: str = ""
    mtl_read: tuple[str, ...] = ()
    mtl_write: tuple[str, ...] = ()
    blank: tuple[float, float, float, float] = (1.0, 1.0, 1.0, 1.0)


SLOT_TABLE = (
    Slot(
        "base_color",
        srgb=True,
        gltf_owner="pbrMetallicRoughness",
        gltf_key="baseColorTexture",
        mtl_read=("map_kd",),
        mtl_write=("map_Kd",),
    ),
    Slot(
        "normal",
        srgb=False,
        gltf_owner="",
        gltf_key="normalTexture",
        gltf_strength="scale",
        mtl_read=("norm", "map_bump", "bump"),
        mtl_write=("norm", "map_Bump"),
        blank=(0.5, 0.5, 1.0, 1.0),
    ),
    # Occlusion and metallic-roughness share one image in glTF; MTL has no words for that.
    Slot(
        "metallic_roughness",
        srgb=False,
        gltf_owner="pbrMetallicRoughness",
        gltf_key="metallicRoughnessTexture",
    ),
    Slot(
        "occlusion",
        srgb=False,
        gltf_owner="",
        gltf_key="occlusionTexture",
        gltf_strength="strength",
    ),
    Slot(
        "emissive",
        srgb=True,
        gltf_owner="",
        gltf_key="emissiveTexture",
        mtl_read=("map_ke",),
        mtl_write=("map_Ke",),
    ),
)
SLOTS = tuple(slot.name for slot in SLOT_TABLE)
BY_NAME = {slot.name: slot for slot in SLOT_TABLE}
"""The names in the order of their numbers, and the slots by name."""
