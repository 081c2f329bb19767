"""USDZ: a binary USD stage and its images in one package, for iOS, Omniverse and film tools.

The package: https://openusd.org/release/spec_usdz.html
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import numpy as np

from nispcodec.core.arrays import Float32Array, IndexArray
from nispcodec.core.asset import Texture, TexturedMesh
from nispcodec.core.errors import NispError
from nispcodec.core.extras import require
from nispcodec.core.texture import srgb_to_linear
from nispcodec.io.write.plain_images import plain_image
from nispcodec.io.write.usd_material import define_material, identifiers
from nispcodec.io.write.vertices import (
    Normals,
    Vertices,
    groups,
    origin,
    shading_normals,
    split_vertices,
)

if TYPE_CHECKING:
    from pxr import Usd, UsdGeom

SUFFIXES = {"image/png": ".png", "image/jpeg": ".jpg"}
"""Of the images that every reader of USDZ knows: readers go by the suffix."""


def usdz_bytes(mesh: TexturedMesh, colors: Float32Array | None = None) -> bytes:
    """The mesh as the bytes of a USDZ file: right-handed, Y up, a unit is a meter as in glTF.

    One USD mesh for each material. A mesh far from the origin gets its place from a transform.
    Colors (n, 4), sRGB-encoded RGBA of each position, become displayColor in linear light. Images
    other than PNG and JPEG become PNG. Raises NispError without the extra `usd`, and where there is
    no room for temporary files.
    """
    require("pxr", extra="usd", what_for="writing USDZ")
    from pxr import Tf

    try:
        with TemporaryDirectory() as folder:
            return _packaged(Path(folder), mesh, colors)
    except (OSError, Tf.ErrorException) as why:
        raise NispError(f"USDZ: cannot be made in a temporary folder: {why}") from why


def _packaged(folder: Path, mesh: TexturedMesh, colors: Float32Array | None) -> bytes:
    """The package, made in a folder."""
    from pxr import Usd, UsdUtils

    names = _write_images(folder, mesh.textures)
    stage = Usd.Stage.CreateNew(str(folder / "scene.usdc"))
    _Scene(stage, mesh, colors, names).define()
    stage.GetRootLayer().Save()
    UsdUtils.CreateNewUsdzPackage(str(folder / "scene.usdc"), str(folder / "scene.usdz"))
    return (folder / "scene.usdz").read_bytes()


def _write_images(folder: Path, textures: Sequence[Texture]) -> list[str]:
    """Write an image for each texture -> their names."""
    images = [plain_image(each, SUFFIXES) for each in textures]
    stems = identifiers(Path(each.name).stem for each in images)
    names = [f"{stem}{SUFFIXES[each.mime]}" for stem, each in zip(stems, images, strict=True)]
    for name, image in zip(names, images, strict=True):
        (folder / name).write_bytes(image.data)
    return names


@dataclass(frozen=True)
class _Scene:
    """A mesh that is to be defined on a stage; `images`: a file name for each texture."""

    stage: Usd.Stage
    mesh: TexturedMesh
    colors: Float32Array | None
    images: Sequence[str]

    def define(self) -> None:
        """A model with a mesh and a material for each material that faces have."""
        from pxr import Gf, Kind, Usd, UsdGeom

        UsdGeom.SetStageUpAxis(self.stage, UsdGeom.Tokens.y)
        UsdGeom.SetStageMetersPerUnit(self.stage, 1.0)
        (name,) = identifiers([self.mesh.name])
        model = UsdGeom.Xform.Define(self.stage, f"/{name}")
        Usd.ModelAPI(model).SetKind(Kind.Tokens.component)
        self.stage.SetDefaultPrim(model.GetPrim())
        if origin(self.mesh).any():
            place = model.AddTranslateOp(UsdGeom.XformOp.PrecisionDouble)
            place.Set(Gf.Vec3d(*origin(self.mesh).tolist()))
        self.parts(f"/{name}")

    def parts(self, model: str) -> None:
        """Define the meshes and the materials below a model."""
        from pxr import UsdGeom

        for scope in ("geometry", "materials"):
            UsdGeom.Scope.Define(self.stage, f"{model}/{scope}")
        normals, parts = shading_normals(self.mesh), list(groups(self.mesh))
        names = identifiers(self.mesh.materials[number].name for number, _, _ in parts)
        for name, (material, has_uv, faces) in zip(names, parts, strict=True):
            geometry = self.geometry(f"{model}/geometry/{name}", faces, normals, has_uv)
            self.dress(geometry, f"{model}/materials/{name}", material, has_uv)

    def geometry(
        self, path: str, faces: IndexArray, normals: Normals, has_uv: bool
    ) -> UsdGeom.Mesh:
        """Define the mesh of some faces, with the normals that it is shaded with."""
        from pxr import UsdGeom, Vt

        vertices = split_vertices(self.mesh, faces, normals)
        points = (vertices.positions - origin(self.mesh)).astype(np.float32)
        geometry = UsdGeom.Mesh.Define(self.stage, path)
        geometry.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
        geometry.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(points))
        ends = np.stack([points.min(axis=0), points.max(axis=0)])
        geometry.CreateExtentAttr(Vt.Vec3fArray.FromNumpy(ends))
        counts = np.full(len(vertices.faces), 3, np.int32)
        geometry.CreateFaceVertexCountsAttr(Vt.IntArray.FromNumpy(counts))
        corners = vertices.faces.ravel().astype(np.int32)
        geometry.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(corners))
        geometry.CreateNormalsAttr(Vt.Vec3fArray.FromNumpy(vertices.normals))
        geometry.SetNormalsInterpolation(UsdGeom.Tokens.vertex)
        self.vary(geometry, vertices, has_uv)
        return geometry

    def vary(self, geometry: UsdGeom.Mesh, vertices: Vertices, has_uv: bool) -> None:
        """Give vertices their UVs and their colors."""
        from pxr import Sdf, UsdGeom, Vt

        vertex = UsdGeom.Tokens.vertex
        if has_uv:
            kind = Sdf.ValueTypeNames.TexCoord2fArray
            uvs = UsdGeom.PrimvarsAPI(geometry).CreatePrimvar("st", kind, vertex)
            uvs.Set(Vt.Vec2fArray.FromNumpy(vertices.uvs))
        if self.colors is not None:
            colors = self.colors[vertices.sources]
            linear = srgb_to_linear(colors[:, :3]).astype(np.float32)
            geometry.CreateDisplayColorPrimvar(vertex).Set(Vt.Vec3fArray.FromNumpy(linear))
            opacity = np.ascontiguousarray(colors[:, 3])
            geometry.CreateDisplayOpacityPrimvar(vertex).Set(Vt.FloatArray.FromNumpy(opacity))

    def dress(self, geometry: UsdGeom.Mesh, path: str, number: int, has_uv: bool) -> None:
        """Bind a mesh to its material."""
        from pxr import UsdShade

        material = self.mesh.materials[number]
        geometry.CreateDoubleSidedAttr(material.double_sided)
        images = self.images if has_uv else ()
        made = define_material(self.stage, path, material, images, self.colors is not None)
        UsdShade.MaterialBindingAPI.Apply(geometry.GetPrim()).Bind(made)
