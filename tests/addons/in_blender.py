"""Run by Blender's Python: install the extension, import a model, export it, say what there was.

python in_blender.py FOLDER NISP: FOLDER has extension.zip and model.nisp, and gets again.nisp and
seen.json. NISP is the environment of nispcodec.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import bpy

KEY = "bl_ext.user_default.nispcodec"


def main(folder: Path, nisp: str) -> None:
    """Everything, one after another, as a user would."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.extensions.package_install_files(
        filepath=str(folder / "extension.zip"), repo="user_default", enable_on_install=True
    )
    preferences = bpy.context.preferences.addons[KEY].preferences
    preferences.environment = nisp
    done = bpy.ops.import_scene.nisp(filepath=str(folder / "model.nisp"), resolution=24)
    seen: dict[str, Any] = {"version": bpy.app.version_string, "imported": sorted(done)}
    seen["objects"] = [mesh_of(each) for each in bpy.data.objects]
    seen["materials"] = {
        each.name: material_of(each) for each in bpy.data.materials if each.node_tree
    }
    bpy.ops.object.select_all(action="SELECT")
    done = bpy.ops.export_scene.nisp(filepath=str(folder / "again.nisp"), preset="fast")
    seen["exported"] = sorted(done)
    seen["errors"] = [error_of(each) for each in mistakes(folder, preferences)]
    bpy.ops.preferences.addon_disable(module=KEY)
    seen["left"] = hasattr(bpy.types, "IMPORT_SCENE_OT_nisp")
    (folder / "seen.json").write_text(json.dumps(seen))


def mesh_of(made: Any) -> dict[str, Any]:
    """What is there of a mesh object."""
    mesh = made.data
    return {
        "name": made.name,
        "mesh": mesh.name,
        "vertices": len(mesh.vertices),
        "faces": len(mesh.polygons),
        "materials": [each.name for each in mesh.materials],
        "uv_layers": len(mesh.uv_layers),
        "size": [round(each, 4) for each in made.dimensions],
        "place": [round(sum(corner[k] for corner in made.bound_box) / 8, 4) for k in range(3)],
    }


def material_of(material: Any) -> dict[str, Any]:
    """Factors of the principled shader, and what leads to each of its inputs."""
    (shader,) = (each for each in material.node_tree.nodes if each.type == "BSDF_PRINCIPLED")
    images = {each.name: images_behind(each) for each in shader.inputs if each.is_linked}
    names = ("Base Color", "Metallic", "Roughness", "Alpha", "Emission Color", "Emission Strength")
    values = {name: plain(shader.inputs[name].default_value) for name in names}
    return {
        "images": images,
        "values": values,
        "culled": material.use_backface_culling,
        "surface": material.surface_render_method,
        "nodes": sorted({each.type for each in material.node_tree.nodes}),
    }


def plain(value: Any) -> Any:
    """A number or a list of them."""
    try:
        return [round(each, 4) for each in value]
    except TypeError:
        return round(value, 4)


def images_behind(socket: Any) -> list[list[str]]:
    """[image, its color space, how it is repeated and filtered] of all that leads to a socket."""
    found: list[list[str]] = []
    for link in socket.links:
        node = link.from_node
        if node.type == "TEX_IMAGE":
            space = node.image.colorspace_settings.name
            found.append([node.image.name, space, node.extension, node.interpolation])
        for each in node.inputs:
            found += images_behind(each)
    return sorted(found)


def mistakes(folder: Path, preferences: Any) -> Iterator[Callable[[], object]]:
    """What a user may do wrong."""
    yield lambda: bpy.ops.import_scene.nisp(filepath=str(folder / "seen.json"))
    yield lambda: bpy.ops.import_scene.nisp(filepath=str(folder / "model.nisp"), faces=1)
    preferences.environment = str(folder)
    yield lambda: bpy.ops.import_scene.nisp(filepath=str(folder / "model.nisp"))
    bpy.ops.object.select_all(action="DESELECT")
    yield lambda: bpy.ops.export_scene.nisp(filepath=str(folder / "none.nisp"))


def error_of(mistake: Callable[[], object]) -> str:
    """What Blender says of it."""
    try:
        mistake()
    except RuntimeError as why:
        return str(why)
    return ""


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2])
    # bpy 4.2 crashes when Python ends after any operator of a script has run.
    os._exit(0)
