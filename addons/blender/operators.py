"""File > Import and File > Export: by way of a GLB, which Blender reads and writes itself.

Blender's own glTF add-on makes the materials, with normals, roughness, metallic, alpha and color
spaces as glTF has them; `nisp` makes the GLB, or encodes it.
"""

from pathlib import Path

import bpy
from bpy_extras.io_utils import ExportHelper, ImportHelper

from .nisp_process import NispFailed, decoding, encoding
from .preferences import command
from .running import RunsNisp

PRESETS = [
    ("fast", "Fast", "Soonest done"),
    ("balanced", "Balanced", "For most assets"),
    ("best", "Best", "Nearest to the original, several times as long"),
]


class ImportNISP(RunsNisp, bpy.types.Operator, ImportHelper):
    """Import a .nisp file as a mesh with its materials"""

    bl_idname = "import_scene.nisp"
    bl_label = "Import NISP"
    bl_options = {"UNDO"}
    filename_ext = ".nisp"

    filter_glob: bpy.props.StringProperty(default="*.nisp", options={"HIDDEN"})
    resolution: bpy.props.IntProperty(
        name="Resolution",
        description="Cells along the edge of the cube that fields are extracted on; 0: as it takes",
        default=0,
        min=0,
        max=2048,
    )
    faces: bpy.props.IntProperty(
        name="Faces",
        description="At most so many triangles; 0: as many as the eye needs",
        default=0,
        min=0,
    )

    def begin(self, context, mesh):
        """The command. Raises NispFailed for numbers that it would refuse."""
        if 0 < self.resolution < 8 or 0 < self.faces < 4:
            raise NispFailed("expected a resolution of 8 or more and 4 faces or more, or 0")
        return [command(context), *decoding(Path(self.filepath), mesh, self.resolution, self.faces)]

    def finish(self, mesh):
        """Read the mesh. Objects get the name of the file."""
        before = set(bpy.data.objects)
        bpy.ops.import_scene.gltf(filepath=str(mesh), merge_vertices=True)
        for made in set(bpy.data.objects) - before:
            if made.type == "MESH":
                made.name = made.data.name = Path(self.filepath).stem


class ExportNISP(RunsNisp, bpy.types.Operator, ExportHelper):
    """Encode the selected objects as one .nisp file"""

    bl_idname = "export_scene.nisp"
    bl_label = "Export NISP"
    filename_ext = ".nisp"

    filter_glob: bpy.props.StringProperty(default="*.nisp", options={"HIDDEN"})
    preset: bpy.props.EnumProperty(
        name="Preset", description="How long to learn", items=PRESETS, default="balanced"
    )

    @classmethod
    def poll(cls, context):
        """Whether there is something to export."""
        cls.poll_message_set("Select a mesh object")
        return any(each.type == "MESH" for each in context.selected_objects)

    def begin(self, context, mesh):
        """Write the selected objects as a mesh; the command that encodes it."""
        nisp = command(context)
        bpy.ops.export_scene.gltf(
            filepath=str(mesh),
            export_format="GLB",
            use_selection=True,
            export_apply=True,
            export_animations=False,
            export_morph=False,
            export_skins=False,
        )
        return [nisp, *encoding(mesh, Path(self.filepath), self.preset)]

    def finish(self, mesh):
        """Say how large it became."""
        size = Path(self.filepath).stat().st_size
        self.report({"INFO"}, f"{self.filepath}: {size:,} bytes")


def _import_entry(menu, context):
    menu.layout.operator(ImportNISP.bl_idname, text="NISP (.nisp)")


def _export_entry(menu, context):
    menu.layout.operator(ExportNISP.bl_idname, text="NISP (.nisp)")


def register() -> None:
    """For the extension's."""
    bpy.utils.register_class(ImportNISP)
    bpy.utils.register_class(ExportNISP)
    bpy.types.TOPBAR_MT_file_import.append(_import_entry)
    bpy.types.TOPBAR_MT_file_export.append(_export_entry)


def unregister() -> None:
    """For the extension's."""
    bpy.types.TOPBAR_MT_file_export.remove(_export_entry)
    bpy.types.TOPBAR_MT_file_import.remove(_import_entry)
    bpy.utils.unregister_class(ExportNISP)
    bpy.utils.unregister_class(ImportNISP)
