"""One self-contained page that shows a `.nisp` file: decoder, viewer and file, no network."""

from __future__ import annotations

import html
import json
import zlib
from base64 import b64encode
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .bundle import bundled

if TYPE_CHECKING:
    from nispcodec.core.asset import Material, TexturedMesh
    from nispcodec.core.document import Frame

VIEWER = Path(__file__).parent / "viewer"


def viewer_page(file: bytes, title: str, original: dict[str, Any] | None = None) -> str:
    """The page's HTML. `file` is a sound `.nisp`; `original` comes from `original_data`."""
    style = (VIEWER / "page.css").read_text(encoding="utf-8")
    boot = (VIEWER / "boot.js").read_text(encoding="utf-8")
    script = bundled(VIEWER / "main.js")
    filled = {
        "policy": _policy((boot, script), style),
        "title": html.escape(title),
        "style": style,
        "file": b64encode(file).decode(),
        # Nothing in it may end the element that holds it.
        "original": json.dumps(original).replace("<", "\\u003c") if original else "",
        "packed": b64encode(_deflated(script)).decode(),
        "boot": boot,
    }
    page = (VIEWER / "page.html").read_text(encoding="utf-8")
    first, *rest = page.split("{{")
    pieces = (piece.split("}}", 1) for piece in rest)
    return first + "".join(filled[name] + text for name, text in pieces)


def _policy(scripts: tuple[str, ...], style: str) -> str:
    """The content security policy: these scripts and style, workers of its own, no network."""
    hashes = " ".join(f"'{_hash(script)}'" for script in scripts)
    return "; ".join(
        (
            "default-src 'none'",
            f"script-src {hashes} 'wasm-unsafe-eval'",
            f"style-src '{_hash(style)}'",
            "img-src blob:",
            "worker-src blob:",
            "base-uri 'none'",
            "form-action 'none'",
        )
    )


def _deflated(text: str) -> bytes:
    """As DecompressionStream's deflate-raw takes it: a page is half as large."""
    packer = zlib.compressobj(9, zlib.DEFLATED, -zlib.MAX_WBITS)
    return packer.compress(text.encode()) + packer.flush()


def _hash(text: str) -> str:
    return f"sha256-{b64encode(sha256(text.encode()).digest()).decode()}"


def original_data(mesh: TexturedMesh, frame: Frame) -> dict[str, Any]:
    """A mesh as viewer/original.js reads it: in the normalized frame, arrays in base64."""
    import numpy as np

    from nispcodec.io.write.vertices import shading_normals, split_vertices

    normals, start = shading_normals(mesh), 0
    parts: list[tuple[Any, ...]] = []
    groups: list[dict[str, Any]] = []
    keys = 2 * mesh.face_materials + mesh.has_uv
    for key in np.unique(keys).tolist():
        part = split_vertices(mesh, np.flatnonzero(keys == key), normals)
        faces = part.faces.ravel() + sum(len(each[0]) for each in parts)
        parts.append((frame.to_normalized(part.positions), part.normals, part.uvs, faces))
        group = {"start": start, "count": faces.size, "material": key // 2}
        groups.append({**group, "textured": bool(key % 2)})
        start += faces.size
    positions, bent, uvs, faces = (np.concatenate(each) for each in zip(*parts, strict=True))
    return {
        "materials": [_material(each) for each in mesh.materials],
        "images": [
            {"name": each.name, "mime": each.mime, "data": _base64(each.data)}
            for each in mesh.textures
        ],
        "mesh": {
            "positions": _base64(positions.astype("<f4").tobytes()),
            "normals": _base64(bent.astype("<f4").tobytes()),
            "uvs": _base64(uvs.astype("<f4").tobytes()),
            "charts": _base64(np.zeros(len(positions), "<f4").tobytes()),
            "indices": _base64(faces.astype("<u4").tobytes()),
            "groups": groups,
        },
    }


def _base64(data: bytes) -> str:
    return b64encode(data).decode()


def _material(material: Material) -> dict[str, Any]:
    """As decoder/metadata.js has them."""
    return {
        "name": material.name,
        "baseColor": material.base_color,
        "metallic": material.metallic,
        "roughness": material.roughness,
        "emissive": material.emissive,
        "alphaMode": material.alpha_mode,
        "alphaCutoff": material.alpha_cutoff,
        "doubleSided": material.double_sided,
        "maps": {
            slot: {
                "texture": used.texture,
                "wrapU": used.wrap[0],
                "wrapV": used.wrap[1],
                "filter": used.filter,
                "strength": used.strength,
            }
            for slot, used in material.maps.items()
        },
    }
