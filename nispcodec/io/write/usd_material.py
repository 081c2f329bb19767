"""A material as a network of UsdPreviewSurface, UsdUVTexture and readers of primvars.

https://openusd.org/release/spec_usdpreviewsurface.html
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import chain, count
from typing import TYPE_CHECKING

from nispcodec.core.asset import Material, TextureMap
from nispcodec.core.slots import BY_NAME

if TYPE_CHECKING:
    from pxr import Usd, UsdShade

Four = tuple[float, float, float, float]

# Slot -> inputs of the surface, and the channels of the image that they take.
READS = {
    "base_color": {"diffuseColor": "rgb", "opacity": "a"},
    "normal": {"normal": "rgb"},
    "metallic_roughness": {"roughness": "g", "metallic": "b"},
    "occlusion": {"occlusion": "r"},
    "emissive": {"emissiveColor": "rgb"},
}
# The types of inputs that are no floats.
TYPES = {
    "diffuseColor": "Color3f",
    "emissiveColor": "Color3f",
    "normal": "Normal3f",
    "st": "Float2",
}


def identifiers(names: Iterable[str]) -> list[str]:
    """A name that a prim may have for each name: "_" for what is not allowed, no two alike."""
    from pxr import Tf

    found: list[str] = []
    for name in names:
        first = Tf.MakeValidIdentifier(name.encode("utf-8", "replace").decode())
        tried = chain([first], (f"{first}_{number}" for number in count(2)))
        found.append(next(each for each in tried if each not in found))
    return found


def define_material(
    stage: Usd.Stage,
    path: str,
    material: Material,
    images: Sequence[str],
    colored: bool,
) -> UsdShade.Material:
    """Define a material at a path of a stage.

    images: a file name for each texture; none where faces have no UVs, and factors alone count.
    colored: its color is that of vertices.
    """
    return _Network(stage, path, material).define(images, colored)


@dataclass(frozen=True)
class _Network:
    """A material's shaders, under its path."""

    stage: Usd.Stage
    path: str
    material: Material

    def define(self, images: Sequence[str], colored: bool) -> UsdShade.Material:
        from pxr import UsdShade

        made = UsdShade.Material.Define(self.stage, self.path)
        surface = self.shader("surface", "UsdPreviewSurface")
        made.CreateSurfaceOutput().ConnectToSource(surface.ConnectableAPI(), "surface")
        for name, value in self.factors().items():
            _input(surface, name).Set(value)
        if colored:
            self.connect(surface, "diffuseColor", self.primvar("displayColor", "Float3"), "result")
            if "opacity" in self.factors():
                opacity = self.primvar("displayOpacity", "Float")
                self.connect(surface, "opacity", opacity, "result")
        if images and self.material.maps:
            uvs = self.primvar("st", "Float2")
            for slot, used in self.material.maps.items():
                self.dress(surface, slot, self.texture(slot, used, images[used.texture], uvs))
        return made

    def shader(self, name: str, kind: str) -> UsdShade.Shader:
        from pxr import UsdShade

        shader = UsdShade.Shader.Define(self.stage, f"{self.path}/{name}")
        shader.CreateIdAttr(kind)
        return shader

    def factors(self) -> dict[str, object]:
        """The surface's inputs without images."""
        from pxr import Gf

        material = self.material
        found = {
            "diffuseColor": Gf.Vec3f(*material.base_color[:3]),
            "metallic": material.metallic,
            "roughness": material.roughness,
            "emissiveColor": Gf.Vec3f(*material.emissive),
        }
        if material.alpha_mode != "opaque":
            found["opacity"] = material.base_color[3]
        if material.alpha_mode == "mask":
            found["opacityThreshold"] = material.alpha_cutoff
        return found

    def primvar(self, name: str, kind: str) -> UsdShade.Shader:
        """What reads a value of vertices, `kind` as in the names of its shader and its output."""
        from pxr import Sdf

        reader = self.shader(name, f"UsdPrimvarReader_{kind.lower()}")
        reader.CreateInput("varname", Sdf.ValueTypeNames.String).Set(name)
        reader.CreateOutput("result", getattr(Sdf.ValueTypeNames, kind))
        return reader

    def texture(
        self, slot: str, used: TextureMap, image: str, uvs: UsdShade.Shader
    ) -> UsdShade.Shader:
        """What reads an image; scale and bias make of its channels what the surface takes."""
        from pxr import Gf, Sdf

        texture, kinds = self.shader(slot, "UsdUVTexture"), Sdf.ValueTypeNames
        texture.CreateInput("file", kinds.Asset).Set(f"./{image}")
        space = "sRGB" if BY_NAME[slot].srgb else "raw"
        texture.CreateInput("sourceColorSpace", kinds.Token).Set(space)
        for name, wrap in zip(("wrapS", "wrapT"), used.wrap, strict=True):
            texture.CreateInput(name, kinds.Token).Set(wrap)
        scale, bias = self.scaled(slot, used.strength)
        texture.CreateInput("scale", kinds.Float4).Set(Gf.Vec4f(*scale))
        texture.CreateInput("bias", kinds.Float4).Set(Gf.Vec4f(*bias))
        self.connect(texture, "st", uvs, "result")
        return texture

    def scaled(self, slot: str, strength: float) -> tuple[Four, Four]:
        """Scale and bias of the channels of an image."""
        material = self.material
        scales: dict[str, Four] = {
            "base_color": material.base_color,
            "metallic_roughness": (1, material.roughness, material.metallic, 1),
            "emissive": (*material.emissive, 1),
            "occlusion": (strength,) * 4,
            "normal": (2 * strength, 2 * strength, 2, 1),
        }
        biases: dict[str, Four] = {
            "occlusion": (1 - strength,) * 4,
            "normal": (-strength, -strength, -1, 0),
        }
        return scales[slot], biases.get(slot, (0, 0, 0, 0))

    def dress(self, surface: UsdShade.Shader, slot: str, texture: UsdShade.Shader) -> None:
        """Let the surface take an image's channels."""
        from pxr import Sdf

        for name, channels in READS[slot].items():
            if name == "opacity" and self.material.alpha_mode == "opaque":
                continue
            kind = "Float3" if channels == "rgb" else "Float"
            texture.CreateOutput(channels, getattr(Sdf.ValueTypeNames, kind))
            self.connect(surface, name, texture, channels)

    def connect(
        self, shader: UsdShade.Shader, name: str, source: UsdShade.Shader, output: str
    ) -> None:
        """Let an input of a shader have the value of another's output."""
        _input(shader, name).ConnectToSource(source.ConnectableAPI(), output)


def _input(shader: UsdShade.Shader, name: str) -> UsdShade.Input:
    from pxr import Sdf

    return shader.CreateInput(name, getattr(Sdf.ValueTypeNames, TYPES.get(name, "Float")))
