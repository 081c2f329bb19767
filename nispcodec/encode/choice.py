"""Networks or triangles: whichever takes fewer bytes at equal errors."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from nispcodec.core.document import Document
from nispcodec.core.errors import FitError, NispError
from nispcodec.core.mesh_part import MeshPart
from nispcodec.encode.config import EncodeConfig, Tuning
from nispcodec.encode.mesh_form import MeshForm
from nispcodec.format import inspect, pack
from nispcodec.format.constants import TXTR
from nispcodec.simplify.errors import Errors
from nispcodec.simplify.ladder import Candidate


@dataclass(frozen=True)
class Chosen:
    """A document, what its surface is off, and about how many bytes the other form would take.

    other_bytes    0 where only one form was asked for
    other_made_up  share of the other form's surface that is made up, where it lost for that
    """

    document: Document
    errors: Errors
    other_bytes: float = 0.0
    other_made_up: float = 0.0


class Choice:
    """The form of one asset: asked before a fit, when the size of networks is known, and after it.

    With `geometry` "auto", the form that is estimated to be clearly larger is not made at all.
    """

    def __init__(self, form: MeshForm, config: EncodeConfig, tuning: Tuning) -> None:
        self._form, self._config, self._tuning = form, config, tuning
        self._forms = tuning.forms
        self._estimate, self._field_bytes = 0.0, 0.0

    def wants_field(self, size: float, probe_error: float) -> bool:
        """Whether networks of about so many bytes may be the better form.

        `probe_error` is the held-out error of the SDF's probe, normalized frame.
        """
        if not self._open or self._config.target_size or self._config.target_error:
            return True
        forms = self._forms
        self._field_bytes = size
        distance = forms.fitted * probe_error
        few, many = forms.surely_smaller * size, forms.surely_larger * size
        self._estimate = self._form.estimate(distance, few, many)
        return self._estimate > forms.surely_smaller * size

    def after_fit(self, field: Document, errors: Errors) -> Chosen:
        """The fitted field, whose surface has these errors, or triangles that are better."""
        size = own_bytes(field)
        if self._open and errors.made_up.share > self._forms.notable_far:
            instead = self._instead(field, size, errors)
            if instead:
                return instead
        if not self._open or self._estimate > self._forms.surely_larger * size:
            return Chosen(field, errors, self._estimate)
        found = self._rival(size, errors)
        if found is None:
            return Chosen(field, errors)
        meshes = replace(field, field=None, meshes=found.parts)
        other = own_bytes(meshes)
        target = self._config.target_size
        better = other < size
        if target:
            better = other <= target and found.errors.distance < errors.distance
        return Chosen(meshes, found.errors, size) if better else Chosen(field, errors, other)

    def _instead(self, field: Document, size: int, errors: Errors) -> Chosen | None:
        """Triangles in place of a field that makes up surface, unless they take many more bytes."""
        made_up, target = errors.made_up.share, self._config.target_size
        most = target or self._forms.worth * size
        if self._config.target_error:
            found = self._form.within(self._config.target_error, errors.uv)
        elif target:
            found = self._form.of_size(size)
        else:
            found = self._form.best(min(errors.distance, self._nearest), most)
        if found is None or not self._forms.is_sound(found.errors):
            return None
        meshes = replace(field, field=None, meshes=found.parts)
        fits = own_bytes(meshes) <= most
        return Chosen(meshes, found.errors, size, made_up) if fits else None

    def triangles(self, document: Callable[[tuple[MeshPart, ...]], Document]) -> Chosen:
        """The asset as triangles, as near as the preset or the target asks.

        Raises FitError for a target error that they miss, NispError for a target size that is too
        small.
        """
        found = self._wanted(document)
        return Chosen(document(found.parts), found.errors, self._field_bytes)

    def _rival(self, size: int, errors: Errors) -> Candidate | None:
        """Triangles to set against a fitted field: no worse, or of no more bytes."""
        if self._config.target_size:
            return self._form.of_size(size)
        if self._config.target_error:
            return self._form.within(self._config.target_error, errors.uv)
        if self._form.estimate(errors.distance, size, size) >= size:
            return None
        found = self._form.best(min(errors.distance, self._nearest), size)
        return found if found.size < size else self._form.best(errors.distance, size)

    def _wanted(self, document: Callable[[tuple[MeshPart, ...]], Document]) -> Candidate:
        config = self._config
        if config.target_error:
            found = self._form.within(config.target_error, math.inf)
            if found is None:
                raise FitError(
                    f"target error: expected {config.target_error:g}, found no mesh as near"
                )
            return found
        if not config.target_size:
            return self._form.best(self._nearest, self._field_bytes or math.inf)
        fewest = self._form.fewest()
        besides = own_bytes(document(fewest.parts)) - fewest.size
        found = self._form.of_size(config.target_size - besides)
        if besides + found.size > config.target_size:
            raise NispError(
                f"target size: expected at least {besides + found.size:,} bytes for this asset's "
                f"triangles, found {config.target_size:,.0f}"
            )
        return found

    @property
    def _nearest(self) -> float:
        """The mean distance that triangles are to keep within, where bytes allow it."""
        return self._tuning.training.budgets[self._config.preset].mesh

    @property
    def _open(self) -> bool:
        config = self._config
        return config.geometry == "auto" and config.preset != "paper" and not config.prune


def own_bytes(document: Document) -> int:
    """Bytes of a file, without its images."""
    data = pack(document)
    return len(data) - sum(each.stored_length for each in inspect(data) if each.code == TXTR)
