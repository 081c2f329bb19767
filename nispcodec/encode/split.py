"""An asset in two: dense, smooth bodies as networks, the rest as triangles."""

from __future__ import annotations

from dataclasses import dataclass, replace

from nispcodec.core.arrays import BoolArray
from nispcodec.core.document import Document
from nispcodec.core.mesh_part import MeshPart
from nispcodec.encode.bodies import Sorted
from nispcodec.encode.field_form import FieldForm
from nispcodec.encode.mesh_form import MeshForm, Rest
from nispcodec.format import own_bytes, pack
from nispcodec.geometry.analysis import Analysis, analyze
from nispcodec.geometry.triangles import area


@dataclass(frozen=True)
class Split:
    """A half for networks, and one for triangles.

    dense   the half for networks, as triangles: what networks are measured against
    meshes  the other half, which has such a `share` of the area that both have by themselves
    """

    field: FieldForm
    dense: MeshForm
    meshes: MeshForm
    share: float

    def parts(self, fitted: Document) -> tuple[MeshPart, ...]:
        """The triangles that are best beside fitted networks, for the asset as a whole."""
        rest = Rest(own_bytes(pack(fitted)), self.dense.errors(fitted), self.share)
        return self.meshes.best_beside(rest).parts


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
    others.field.forget()
    return Split(
        field=replace(whole, analysis=dense),
        dense=MeshForm(dense, seed, config, whole.progress),
        meshes=MeshForm(others, seed, config, whole.progress),
        share=_outer_area(others) / (_outer_area(dense) + _outer_area(others)),
    )


def _open_share(analysis: Analysis, faces: BoolArray) -> float:
    """The part of the area of some faces (m,) bool that an analysis has as open surfaces."""
    solid = analysis.solid
    own = faces[solid.parents]
    sizes = area(solid.pieces[own])
    return float(sizes[solid.open_surface[own]].sum() / sizes.sum())


def _outer_area(analysis: Analysis) -> float:
    """The area that an analysis does not have as hidden."""
    return float(area(analysis.solid.pieces).sum())
