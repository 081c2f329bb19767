from __future__ import annotations

import base64
import io
from importlib.machinery import ModuleSpec
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import PIL.Image
import pytest

from nispcodec.core import extras
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.errors import MeshError
from nispcodec.io.ktx2 import is_ktx2, png_of_ktx2
from tests.io.files import image
from tests.io.test_gltf import textured

# 8 x 4 pixels, red on the left and blue on the right, by Basis Universal 2.10.
FILES = {
    "etc1s": base64.b64decode(
        "q0tUWCAyMLsNChoKAAAAAAEAAAAIAAAABAAAAAAAAAAAAAAAAQAAAAEAAAABAAAAaAAAACwAAACUAAAAJAAAALgAAA"
        "AAAAAAhAAAAAAAAAA8AQAAAAAAAAEAAAAAAAAAAAAAAAAAAAAsAAAAAAAAAAIAKACjAQIAAwMAAAgAAAAAAAAAAAA"
        "/AAAAAAAAAAAA/////x8AAABLVFh3cml0ZXIAQmFzaXMgVW5pdmVyc2FsIDIuMTAAAAIAAQAsAAAABQAAACsAAAAAAAAA"
        "AAAAAAAAAAABAAAAAAAAAAAAAAAWwEQAAAAAAABiwgQwAwAAAAAAgKTHAEwEAAAAAAAgAQiACQABAAAAACSdAFRVVVUFA"
        "MFEAAAAAAAA8l9NAJgAEAAAAABAFAAmAAQAAAAAEAOACQAAAAAAAAQQAAA="
    ),
    "uastc": base64.b64decode(
        "q0tUWCAyMLsNChoKAAAAAAEAAAAIAAAABAAAAAAAAAAAAAAAAQAAAAEAAAAAAAAAaAAAACwAAACUAAAALAAAAAAAAA"
        "AAAAAAAAAAAAAAAADAAAAAAAAAACAAAAAAAAAAIAAAAAAAAAAsAAAAAAAAAAIAKACmAQIAAwMAABAAAAAAAAAAAAB"
        "/AAAAAAAAAAAA/////x8AAABLVFh3cml0ZXIAQmFzaXMgVW5pdmVyc2FsIDIuMTAAAAQAAAB/fwAAF9nD499cIQAAAAAA"
        "AAAAANfDA/nfDGEBAAAAAAAAAAA="
    ),
}


def pixels(data: bytes) -> Any:
    return np.asarray(PIL.Image.open(io.BytesIO(data))).astype(int)


@pytest.mark.parametrize("codec", list(FILES))
def test_images_of_both_codecs_become_png(codec: str) -> None:
    assert is_ktx2(FILES[codec])
    found = pixels(png_of_ktx2(FILES[codec], "a"))
    assert found.shape == (4, 8, 3)
    assert np.abs(found[:, :4] - (200, 30, 30)).max() <= 8
    assert np.abs(found[:, 4:] - (30, 30, 200)).max() <= 8


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (FILES["uastc"][:20], "expected the header of a KTX2 image, found 20 bytes"),
        (FILES["uastc"][:90], "expected a KTX2 image of Basis Universal, found: "),
        (FILES["uastc"][:20] + b"\0\0\1\0" * 2 + bytes(60), "pixels, found 65536 x 65536"),
    ],
)
def test_errors_name_the_place(data: bytes, said: str) -> None:
    with pytest.raises(MeshError, match=f"^a: .*{said}"):
        png_of_ktx2(data, "a")


def with_images(folder: Path, source: bytes | None, basisu: bytes) -> TexturedMesh:
    """A triangle whose texture is in KTX2, and perhaps in another format too."""
    gltf = textured()
    texture: dict[str, Any] = {"extensions": {"KHR_texture_basisu": {"source": 1}}}
    gltf.json["images"].append({"name": "wood", "bufferView": gltf.view(basisu)})
    if source is not None:
        gltf.json["images"][0]["bufferView"] = gltf.view(source)
        texture["source"] = 0
    gltf.json["textures"] = [texture]
    gltf.json["extensionsRequired"] = ["KHR_texture_basisu"]
    return gltf.load(folder)


def test_a_texture_in_ktx2_alone(tmp_path: Path) -> None:
    mesh = with_images(tmp_path, None, FILES["etc1s"])
    assert [(each.name, each.mime) for each in mesh.textures] == [("wood.png", "image/png")]
    assert mesh.warnings == ("a.glb: images[1] (wood): a KTX2 image, converted to PNG",)


def test_another_format_is_taken_where_there_is_one(tmp_path: Path) -> None:
    mesh = with_images(tmp_path, image(), FILES["etc1s"])
    assert mesh.textures[0].data == image()
    assert mesh.warnings == ()


def test_an_image_that_cannot_be_read_gives_way_to_the_other(tmp_path: Path) -> None:
    mesh = with_images(tmp_path, b"nothing", FILES["etc1s"])
    assert mesh.textures[0].name == "wood.png"
    assert "images[0] (image_0): expected an image" in mesh.warnings[0]


def test_without_the_package_the_image_is_named(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def find(name: str) -> ModuleSpec | None:
        return None if name == "opengl_basisu" else find_spec(name)

    monkeypatch.setattr(extras, "find_spec", find)
    mesh = with_images(tmp_path, None, FILES["etc1s"])
    assert mesh.materials[0].maps == {}
    (warning,) = mesh.warnings
    assert warning.startswith("a.glb: images[1] (wood): reading KTX2 needs opengl-basisu")
    assert warning.endswith("pip install 'nispcodec[gltf]': left out")
