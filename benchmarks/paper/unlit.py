"""Assets that shine in their base color, so that pictures show it without light, as the paper's."""

from __future__ import annotations

from dataclasses import replace

from nispcodec.core.asset import Material, TexturedMesh
from nispcodec.model import NispModel


def unlit_mesh(mesh: TexturedMesh) -> TexturedMesh:
    """The mesh, unlit."""
    return replace(mesh, materials=_all(mesh.materials))


def unlit_model(model: NispModel) -> NispModel:
    """The model, unlit."""
    return NispModel(replace(model.document, materials=_all(model.document.materials)))


def _all(materials: tuple[Material, ...]) -> tuple[Material, ...]:
    return tuple(map(_shining, materials))


def _shining(material: Material) -> Material:
    """Its base color emitted, and none of the light that falls on it reflected."""
    red, green, blue, alpha = material.base_color
    base = material.maps.get("base_color")
    return replace(
        material,
        base_color=(0.0, 0.0, 0.0, alpha),
        metallic=1.0,
        emissive=(red, green, blue),
        maps={"base_color": base, "emissive": base} if base else {},
    )
