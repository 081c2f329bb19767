"""Neural codec for textured 3D assets: one mesh in, a few kilobytes of network weights out.

    import nispcodec

    model = nispcodec.encode("model.obj")       fit networks to an asset
    nispcodec.save(model, "model.nisp")
    model = nispcodec.load("model.nisp")        queries, meshes and pictures
    model.sdf(points), model.uv(points), model.color(points)
    nispcodec.write_mesh(model.to_mesh(), "out.glb")

Everything that is public is here; what stands in the submodules may move.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

# `nispcodec.render` is a function here, and the folder has the same name: importing it later would
# put the module in the function's place.
import nispcodec.render  # noqa: F401
from nispcodec.core.asset import Material, Texture, TexturedMesh, TextureMap
from nispcodec.core.errors import (
    FitError,
    FormatError,
    MeshError,
    NispError,
    NispWarning,
    QueryError,
)
from nispcodec.core.extras import require
from nispcodec.core.progress import Listener, Progress, warn, warning_listener
from nispcodec.encode.config import EncodeConfig

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from nispcodec.catalogue.config import BatchConfig
    from nispcodec.catalogue.job import Result
    from nispcodec.core.arrays import Float32Array
    from nispcodec.encode.config import Tuning
    from nispcodec.metrics.compare import Report
    from nispcodec.model import NispModel

__all__ = [
    "BatchConfig",
    "EncodeConfig",
    "FitError",
    "FormatError",
    "Material",
    "MeshError",
    "NispError",
    "NispModel",
    "NispWarning",
    "Progress",
    "QueryError",
    "Texture",
    "TextureMap",
    "TexturedMesh",
    "compare",
    "encode",
    "encode_many",
    "load",
    "load_mesh",
    "register_trimesh",
    "render",
    "retexture",
    "save",
    "write_mesh",
]

__version__ = "0.1.0"


def load_mesh(path: str | Path) -> TexturedMesh:
    """Read OBJ, glTF, GLB, PLY, STL or OFF with its materials and textures, cleaned up.

    Positions are in the world frame, in the file's units; UVs have their origin bottom-left.
    `warnings` of the mesh say what was left out or guessed. Raises MeshError, naming the file and
    the place in it, for whatever cannot be read.
    """
    from nispcodec.io.load import load_mesh as read

    return read(path)


def write_mesh(mesh: TexturedMesh, path: str | Path) -> list[Path]:
    """Write GLB, glTF, OBJ, PLY, STL or USDZ, by the path's suffix -> the files, `path` last.

    A glTF has its buffer and images beside it, an OBJ its MTL and images, a PLY its images. Each
    file is written whole or not at all. What the format cannot hold is left out, and warned of as
    `NispWarning`. Raises MeshError for an unknown suffix or a mesh without faces, NispError when
    writing fails.
    """
    return mesh.save(path)


def encode(
    mesh: TexturedMesh | str | Path,
    config: EncodeConfig | None = None,
    progress: Listener | None = None,
    tuning: Tuning | None = None,
) -> NispModel:
    """Fit networks to a mesh, or to the mesh in a file. Needs `pip install 'nispcodec[encode]'`.

    `config` holds what a user chooses, by default `EncodeConfig()`. `progress` is called with each
    `Progress`. `tuning` holds numbers that are not meant to be chosen by users
    (`nispcodec.encode.config`).

    What was left out of a file is warned of by Python's `warnings`, as `NispWarning`; so is what
    was done about a mesh and its fit, unless a `progress` hears it as `Progress.warning`.

    Ctrl-C and errors leave nothing behind. Raises TypeError for what is neither mesh nor path,
    MeshError for a file that cannot be read and when nothing of the mesh can be held by a signed
    distance, FitError when a network does not converge or the device is not there, NispError for a
    target that cannot be met and for a package that is missing.
    """
    require("scipy", "igl", "embreex", extra="encode", what_for="encoding")
    from nispcodec.encode import recipe

    asset = _mesh(mesh)
    if asset is not mesh:
        warn(asset.warnings)
    return recipe.encode(asset, config, progress or warning_listener, tuning)


def encode_many(
    inputs: str | Path | Iterable[str | Path],
    output: str | Path,
    config: EncodeConfig | None = None,
    batch: BatchConfig | None = None,
) -> Iterator[Result]:
    """Encode mesh files into a folder, side by side, and yield each asset's result as it comes.

    `inputs` are mesh files, folders, globs and manifests, as `nisp batch` takes them; `output` is a
    folder, which gets `catalogue.jsonl` and `catalogue.html` too. Both may be URLs, with `pip
    install 'nispcodec[remote]'`. What an earlier call has done is kept, and told (`Result.kept`);
    an asset that fails is a result like others (`Result.record`). Closing the iterator stops the
    work, and a later call goes on. `batch` holds how many at a time, timeouts, memory and engine.

    Raises NispError where another process works in the folder, and for a package that is missing.
    """
    from nispcodec.catalogue.many import encode_many as run

    return run(inputs, output, config, batch)


def load(path: str | Path) -> NispModel:
    """Read a `.nisp` file. Raises FormatError for a malformed one, NispError if unreadable."""
    from nispcodec.format import read
    from nispcodec.model import NispModel

    return NispModel(read(path))


def save(model: NispModel, path: str | Path) -> None:
    """Write a `.nisp` file: whole, or not at all. Raises NispError when it cannot be written."""
    from nispcodec.core.atomic_write import write_atomic
    from nispcodec.format import pack

    write_atomic(Path(path), pack(model.document))


def compare(
    original: TexturedMesh | str | Path, decoded: NispModel | TexturedMesh | str | Path
) -> Report:
    """Distortion of a decode: distance, UV, color, charts, in the original's normalized frame.

    A model is decoded as `NispModel.to_mesh` does, and asked for its charts too; see
    `nispcodec.metrics.compare`. Needs `pip install 'nispcodec[render]'`. Raises TypeError for what
    is neither mesh nor path, MeshError for a file that cannot be read and for a mesh without a
    surface, NispError without the extra.
    """
    require("igl", extra="render", what_for="comparing")
    from nispcodec.metrics.compare import compare as compared
    from nispcodec.model import NispModel

    if isinstance(decoded, NispModel):
        return compared(_mesh(original), decoded.to_mesh(), model=decoded)
    return compared(_mesh(original), _mesh(decoded))


def render(asset: NispModel | TexturedMesh, view: str = "30,20", size: int = 512) -> Float32Array:
    """A picture (size, size, 4) float32 in [0, 1]: sRGB-encoded RGB, straight alpha, top row first.

    A model is sphere-traced, a mesh is hit by rays; it is transparent where nothing is hit. `view`
    is "front", "back", "left", "right", "top", "bottom" or "azimuth,elevation" in degrees; `size`
    is in pixels. Needs `pip install 'nispcodec[render]'`. Raises QueryError for another view,
    MeshError for a mesh without a surface and for a texture that does not decode, NispError without
    the extra.
    """
    from nispcodec.render.camera import view as camera
    from nispcodec.render.views import render_views

    return render_views(asset, [camera(view)], size)[0]


def retexture(
    model: NispModel, slot: str, image: str | Path, material: str | None = None
) -> NispModel:
    """The model with an image file in a slot of a material; its networks stay as they are.

    `slot` is "base_color", "normal", "metallic_roughness", "occlusion" or "emissive". `material` is
    a name; without it the image goes to the materials that have a texture there, which must share
    it. What is done about the image is warned of. Raises NispError for a slot or material that is
    not there, and for an unreadable image.
    """
    from nispcodec.edit.retexture import retextured
    from nispcodec.model import NispModel

    path = Path(image)
    try:
        data = path.read_bytes()
    except OSError as why:
        raise NispError(f"{path}: cannot be read: {why.strerror}") from why
    document, said = retextured(model.document, slot, data, path.name, material)
    warn(said)
    return NispModel(document)


def register_trimesh() -> None:
    """Let `trimesh.load`, `load_scene` and `load_mesh` read `.nisp` files, in this process.

    They take the arguments of `NispModel.to_mesh`: `trimesh.load("model.nisp", faces=20_000)`. The
    first two give a scene, as for GLB. trimesh looks for no plugins, so that it has to be told.
    Needs `pip install 'nispcodec[trimesh]'`; raises NispError without.
    """
    require("trimesh", extra="trimesh", what_for="reading by trimesh")
    from nispcodec import trimesh_loader

    trimesh_loader.register()


def _mesh(given: object) -> TexturedMesh:
    if isinstance(given, str | Path):
        return load_mesh(given)
    if not isinstance(given, TexturedMesh):
        found = type(given).__name__
        raise TypeError(f"expected a TexturedMesh or the path of a mesh file, found {found}")
    return given


def __getattr__(name: str) -> object:
    if name == "NispModel":
        from nispcodec.model import NispModel

        return NispModel
    if name == "BatchConfig":
        from nispcodec.catalogue.config import BatchConfig

        return BatchConfig
    raise AttributeError(f"module 'nispcodec' has no attribute {name!r}")
