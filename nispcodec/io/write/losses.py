"""The losses of an asset in each format that is written, in words."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from nispcodec.core.asset import Material, TexturedMesh, TextureMap
from nispcodec.core.slots import BY_NAME, SLOTS

# Positions rounded by more than this share of the extent are seen.
ROUGH = 1e-4


def gltf_losses(mesh: TexturedMesh) -> Iterator[str]:
    """The sentences of a glTF or GLB: all but AVIF is kept."""
    yield from _formats(mesh)


def obj_losses(mesh: TexturedMesh) -> Iterator[str]:
    """Those of an OBJ with its MTL."""
    yield from _formats(mesh)
    yield from _maps(mesh, [slot for slot in SLOTS if BY_NAME[slot].mtl_write])
    if any(_is_masked(each) for each in mesh.materials):
        yield "alpha modes: MTL has none"
    wraps = {("repeat", "repeat"), ("clamp", "clamp")}
    yield from _sampling(mesh.materials, wraps, "MTL repeats or clamps in both directions")


def ply_losses(mesh: TexturedMesh) -> Iterator[str]:
    """Those of a PLY with its images."""
    yield from _formats(mesh)
    yield from _maps(mesh, ["base_color"])
    if any(_factors(each) != _factors(Material()) for each in mesh.materials):
        yield "factors of materials: PLY has none"
    if any(_is_masked(each) for each in mesh.materials):
        yield "alpha modes: PLY has none"
    yield from _sampling(mesh.materials, {("repeat", "repeat")}, "PLY repeats images")


def stl_losses(mesh: TexturedMesh) -> Iterator[str]:
    """Those of an STL."""
    plain = _factors(Material())
    if mesh.has_uv.any() or any(each.maps or _factors(each) != plain for each in mesh.materials):
        yield "texture coordinates, materials and images: STL holds geometry alone"
    yield from _rounding(mesh)


def usdz_losses(mesh: TexturedMesh) -> Iterator[str]:
    """Those of a USDZ."""
    if any(texture.mime not in ("image/png", "image/jpeg") for texture in mesh.textures):
        yield "the format of images that are neither PNG nor JPEG: they are converted to PNG"
    yield from _filters(mesh.materials)


def trimesh_losses(mesh: TexturedMesh) -> Iterator[str]:
    """Those of `NispModel.to_trimesh`."""
    if any(each.strength != 1 for each in _used(mesh.materials)):
        yield "strengths of maps: trimesh has none"
    yield from _sampling(mesh.materials, {("repeat", "repeat")}, "trimesh repeats images")


def _rounding(mesh: TexturedMesh) -> Iterator[str]:
    """STL has no place for an offset, as GLB and USDZ have, and no float64, as OBJ and PLY have."""
    extent = float(np.ptp(mesh.positions, axis=0).max()) if len(mesh.positions) else 0.0
    rounded = mesh.positions.astype(np.float32)
    most = float(np.abs(mesh.positions - rounded).max(initial=0.0))
    if most > ROUGH * extent:
        yield (
            f"digits of positions: STL rounds them by up to {most:.2g}, where the extent is "
            f"{extent:.3g}: move the asset to the origin, or write GLB, OBJ or PLY, which keep them"
        )


def _formats(mesh: TexturedMesh) -> Iterator[str]:
    if any(texture.mime == "image/avif" for texture in mesh.textures):
        yield "the AVIF of images, which are converted to PNG: few other programs know it"


def _maps(mesh: TexturedMesh, held: list[str]) -> Iterator[str]:
    used = {slot for each in mesh.materials for slot in each.maps}
    lost = [slot for slot in SLOTS if slot in used and slot not in held]
    if lost:
        yield f"maps: {', '.join(lost)}"


def _sampling(
    materials: Iterable[Material], wraps: set[tuple[str, str]], rule: str
) -> Iterator[str]:
    if any(each.wrap not in wraps for each in _used(materials)):
        yield f"wraps: {rule}"
    yield from _filters(materials)


def _filters(materials: Iterable[Material]) -> Iterator[str]:
    if any(each.filter == "nearest" for each in _used(materials)):
        yield "the filter nearest: images are shown smoothly"


def _used(materials: Iterable[Material]) -> list[TextureMap]:
    return [each for made in materials for each in made.maps.values()]


def _is_masked(material: Material) -> bool:
    """Whether its alpha mode is no consequence of its factor's alpha."""
    return material.alpha_mode != ("blend" if material.base_color[3] < 1 else "opaque")


def _factors(material: Material) -> tuple[object, ...]:
    return material.base_color, material.metallic, material.roughness, material.emissive
