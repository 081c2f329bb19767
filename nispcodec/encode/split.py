"""An asset in two: dense, smooth bodies as networks, the rest as triangles."""

from __future__ import annotations

from dataclasses import dataclass, replace

from nispcodec.core.arrays import BoolArray
from nispcodec.core.mesh_part import MeshPart
from nispcodec.encode.bodies import Sorted
from nispcodec.encode.field_form import FieldForm
from nispcodec.encode.mesh_form import MeshForm
from nispcodec.geometry.analysis import Analysis, analyze
from nispcodec.geometry.triangles import area


@dataclass(frozen=True)
class Split:
    """A half for networks, and one for triangles, which take about `other_size` bytes."""

    field: FieldForm
    meshes: MeshForm
    other_size: float

    def parts(self) -> tuple[MeshPart, ...]:
        """The triangles: as near as the networks will be, or of twice the foreseen bytes."""
        _, error = self.field.foreseen
        distance = self.field.tuning.forms.fitted * error
        return self.meshes.best(distance, 2 * self.other_size).parts


def split(whole: FieldForm, found: Sorted) -> Split | None:
    """An asset whose bodies are sorted, in two, in the frame that it has as a whole.

    Each half is analyzed for itself: neither hides faces of the other, as each decodes by itself.
    None where bodies for networks are open unless the others close them.
    """
    analysis, config, seed = whole.analysis, whole.tuning.forms, whole.config.seed
    mesh, frame, geometry = analysis.mesh, analysis.frame, analysis.config
    dense = analyze(mesh.only(found.dense), seed, geometry, frame)
    before = _open_share(analysis, found.dense)
    if dense.solid.open_surface_share > before + whole.tuning.notable_open:
        return None
    # Charts are merged for networks alone.
    others = analyze(mesh.only(found.other), seed, replace(geometry, merging=None), frame)
    meshes = MeshForm(others, seed, config, whole.progress)
    return Split(replace(whole, analysis=dense), meshes, found.other_size)


def _open_share(analysis: Analysis, faces: BoolArray) -> float:
    """The part of the area of some faces (m,) bool that an analysis has as open surfaces."""
    solid = analysis.solid
    own = faces[solid.parents]
    sizes = area(solid.pieces[own])
    return float(sizes[solid.open_surface[own]].sum() / sizes.sum())
