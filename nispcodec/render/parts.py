"""All parts of a model to look at: its field sphere-traced, its meshes hit by rays."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nispcodec.core.arrays import Float32Array, IndexArray
from nispcodec.core.asset import Material, Texture
from nispcodec.core.document import Document, Field, Frame
from nispcodec.extract.mesh_parts import face_charts, joined
from nispcodec.infer.field import FieldQueries
from nispcodec.render.field import FieldScene
from nispcodec.render.fragments import Cast, Fragments, Scene
from nispcodec.render.raycast import MeshScene

# Behind a surface that was crossed, the side is asked for this much further on (normalized frame).
BEHIND = np.float32(1e-3)


def model_scene(document: Document) -> Scene:
    """The document as a scene: its field, its meshes, or both."""
    if document.field is None:
        return _mesh_scene(document)
    field = FieldScene(document, document.field)
    return _Both(field, _mesh_scene(document), document.field) if document.meshes else field


def _mesh_scene(document: Document) -> MeshScene:
    return MeshScene(joined(document, None), document.frame, face_charts(document))


class _Both:
    """The first hit of either scene; materials are those of the field's, which has one more."""

    def __init__(self, field: FieldScene, meshes: MeshScene, networks: Field) -> None:
        self._field, self._meshes = field, meshes
        self._queries = FieldQueries(networks)

    @property
    def frame(self) -> Frame:
        """The document's frame."""
        return self._field.frame

    @property
    def materials(self) -> tuple[Material, ...]:
        """The document's materials, and one that is invisible."""
        return self._field.materials

    @property
    def textures(self) -> tuple[Texture, ...]:
        """The document's textures."""
        return self._field.textures

    def cast(self, origins: Float32Array, directions: Float32Array, layer: int = 0) -> Cast:
        """Cast rays (n, 3), (n, 3); see `Scene.cast`."""
        meshes = self._meshes.cast(origins, directions, layer)
        field = self._field_cast(origins, directions, layer)
        first = np.full(len(origins), np.inf, np.float32)
        first[meshes.fragments.rays] = meshes.fragments.distances
        other = np.full(len(origins), np.inf, np.float32)
        other[field.fragments.rays] = field.fragments.distances
        nearer = (first <= other)[meshes.fragments.rays]
        beyond = (other < first)[field.fragments.rays]
        fragments = _merged(meshes.fragments[nearer], field.fragments[beyond])
        return Cast(fragments, field.steps, field.lost & ~np.isfinite(first))

    def _field_cast(self, origins: Float32Array, directions: Float32Array, layer: int) -> Cast:
        """What was crossed may have been a mesh: the field says itself on which side rays begin."""
        if layer == 0:
            return self._field.cast(origins, directions, 0)
        inside = self._queries.sdf(origins + BEHIND * directions) < 0
        return _together(
            len(origins),
            [
                (rays, self._field.cast(origins[rays], directions[rays], side))
                for side, rays in enumerate((np.flatnonzero(~inside), np.flatnonzero(inside)))
            ],
        )


def _together(count: int, casts: list[tuple[IndexArray, Cast]]) -> Cast:
    steps, lost = np.zeros(count, np.int32), np.zeros(count, np.bool_)
    found = []
    for rays, cast in casts:
        steps[rays], lost[rays] = cast.steps, cast.lost
        found.append(replace(cast.fragments, rays=rays[cast.fragments.rays]))
    return Cast(_merged(*found), steps, lost)


def _merged(first: Fragments, second: Fragments) -> Fragments:
    """Both, in the order of their rays."""
    order = np.argsort(np.concatenate([first.rays, second.rays]), kind="stable")
    names = Fragments.__dataclass_fields__
    both = {name: np.concatenate([getattr(first, name), getattr(second, name)]) for name in names}
    return Fragments(**{name: values[order] for name, values in both.items()})
