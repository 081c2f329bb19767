"""What a user sets once: where nispcodec is installed."""

import bpy

from .nisp_process import NispFailed, nisp_command


class NispPreferences(bpy.types.AddonPreferences):
    """The preferences of the extension."""

    bl_idname = __package__

    environment: bpy.props.StringProperty(
        name="Environment",
        subtype="FILE_PATH",
        description="Where nispcodec is installed, or its command nisp; empty: that on PATH",
    )

    def draw(self, context: bpy.types.Context) -> None:
        """The setting, and what it finds."""
        self.layout.prop(self, "environment")
        try:
            self.layout.label(text=f"Found: {nisp_command(self.path)}", icon="CHECKMARK")
        except NispFailed as why:
            self.layout.label(text=str(why), icon="ERROR")

    @property
    def path(self) -> str:
        """The setting as an absolute path, or ""."""
        return bpy.path.abspath(self.environment)


def command(context: bpy.types.Context) -> str:
    """The path of nisp. Raises NispFailed where there is none."""
    return nisp_command(context.preferences.addons[__package__].preferences.path)


def register() -> None:
    """For the extension's."""
    bpy.utils.register_class(NispPreferences)


def unregister() -> None:
    """For the extension's."""
    bpy.utils.unregister_class(NispPreferences)
