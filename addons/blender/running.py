"""Waiting for `nisp` in an operator of Blender."""

from pathlib import Path
from tempfile import TemporaryDirectory

import bpy

from .nisp_process import NispFailed, NispProcess

SECONDS = 0.2
"""From a look at the process to the next."""


class RunsNisp:
    """An operator that waits for `nisp` while Blender can be used; Esc cancels.

    Without a window, as in scripts, it waits. Subclasses have `begin(context, mesh)`, which gives
    the command, and `finish(mesh)`, which takes what came; `mesh` is the path of a GLB between
    Blender and nisp. What either raises, and what nisp says, is told to the user.
    """

    def execute(self, context):
        """Start the process."""
        self._folder = TemporaryDirectory(prefix="nisp-")
        self._mesh = Path(self._folder.name, "mesh.glb")
        try:
            self._process = NispProcess(self.begin(context, self._mesh))
        except (NispFailed, OSError, RuntimeError) as why:
            return self._failed(why)
        if bpy.app.background or context.window is None:
            return self._ended()
        manager = context.window_manager
        manager.progress_begin(0, 100)
        self._timer = manager.event_timer_add(SECONDS, window=context.window)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        """Show how far it is, until it has ended or Esc is pressed."""
        if event.type == "ESC" and event.value == "PRESS":
            self._process.cancel()
        elif event.type != "TIMER" or not self._process.ended:
            self._show(context)
            return {"PASS_THROUGH"}
        self._leave(context)
        return self._ended()

    def cancel(self, context):
        """Blender closes, or loads another file."""
        self._process.cancel()
        self._leave(context)
        self._folder.cleanup()

    def _show(self, context):
        context.window_manager.progress_update(100 * self._process.share)
        context.workspace.status_text_set(f"{self._process.line or self.bl_label}   (Esc cancels)")

    def _leave(self, context):
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)

    def _ended(self):
        try:
            self._process.wait()
            for warning in self._process.warnings:
                self.report({"WARNING"}, warning)
            self.finish(self._mesh)
        except (NispFailed, OSError, RuntimeError) as why:
            return self._failed(why)
        self._folder.cleanup()
        return {"FINISHED"}

    def _failed(self, why):
        self._folder.cleanup()
        process = getattr(self, "_process", None)
        level = "INFO" if process and process.cancelled else "ERROR"
        self.report({level}, str(why).strip())
        return {"CANCELLED"}
