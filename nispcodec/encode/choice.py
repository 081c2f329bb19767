"""Networks, triangles, or some bodies as each: what takes the fewest bytes at equal errors."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

from nispcodec.core.document import Document, Field
from nispcodec.core.errors import FitError, TargetSizeError
from nispcodec.core.mesh_part import MeshPart
from nispcodec.encode.bodies import Sorted
from nispcodec.encode.config import EncodeConfig, Tuning
from nispcodec.encode.mesh_form import MeshForm
from nispcodec.encode.split import Split
from nispcodec.encode.targets import TRIAL
from nispcodec.format import own_bytes, pack
from nispcodec.simplify.errors import Errors
from nispcodec.simplify.ladder import Candidate
from nispcodec.train.config import TrainingBudget

Loss = Callable[[Document], float]
"""What is lost by a document, by whatever counts: the less, the better."""

Made = Callable[[Field | None, tuple[MeshPart, ...]], Document]
"""The document of a field and mesh parts, with the asset's materials and images."""


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

    With `geometry` "auto", a form that is estimated to be clearly larger is not made at all.
    `halves` makes two of an asset whose bodies are sorted; `split` are those that are to be made.
    `trial` makes networks of a short fit. `document` leaves room for whatever is measured of it
    later, which `written` knows.
    `loss`, where there is one, says which triangles are best, and which form, in the place of bytes
    and errors.
    """

    def __init__(
        self,
        form: MeshForm,
        config: EncodeConfig,
        tuning: Tuning,
        halves: Callable[[Sorted], Split | None],
        trial: Callable[[], Field],
        document: Made,
        written: Callable[[Chosen], Document],
        loss: Loss | None = None,
    ) -> None:
        self._form, self._config, self._tuning = form, config, tuning
        self._halves, self._trial, self._document, self._loss = halves, trial, document, loss
        self._written = written
        self._taken: Candidate | None = None
        # The least of triangles beside a trial; before one, nothing is known to cost more.
        self._triangle_cost = -math.inf
        self.split: Split | None = None
        self._forms = tuning.forms
        self._estimate, self._field_bytes = 0.0, 0.0

    def wants_field(self, size: float, probe_error: float) -> bool:
        """Whether networks of about so many bytes may be the better form of the whole asset.

        `probe_error` is the held-out error of the SDF's probe, normalized frame.
        """
        if not self._open or self._config.target_error:
            return True
        if self._config.target_size:
            return not self._surely_nearer(self._forms.fitted * probe_error)
        forms = self._forms
        self._field_bytes = size
        distance = forms.fitted * probe_error
        if self._worth > 1 and self._nearest < distance:
            most = self._worth * size
            if self._form.estimate(self._nearest, size, most) < most:
                return False
        fine = probe_error > self._tuning.training.sizing.fine
        few = (forms.surely_smaller_fine if fine else forms.surely_smaller) * size
        self._estimate = self._form.estimate(distance, few, forms.surely_larger * size)
        self.split = self._better_split(size, distance)
        if self.split:
            self._form.forget()
        if self.split or self._taken or self._estimate <= few:
            return False
        return not (self._doubtful and self._lost_by_trial())

    @property
    def _doubtful(self) -> bool:
        """Whether a trial may spare the fit: triangles may be smaller than what was foreseen."""
        near = self._estimate < self._forms.surely_larger * self._field_bytes
        return near and self._tries

    @property
    def _tries(self) -> bool:
        """Whether networks are tried before they are fitted."""
        return self._budget.trial > 0 and self._loss is None

    def _lost_by_trial(self) -> bool:
        """Whether triangles cost so much less than networks of a short fit that they are taken."""
        forms, tried = self._forms, self._document(self._trial(), ())
        size, errors = own_bytes(pack(tried)), self._form.errors(tried, stage=TRIAL)
        self._triangle_cost = min(forms.cost(each.size, each.errors) for each in self._form.made)
        if self._triangle_cost > forms.cost(size, errors) - forms.trial_gain:
            return False
        distance = forms.trial_left * errors.distance
        most = max(size, self._field_bytes)
        self._taken = self._form.nearer(self._form.about(distance), distance, most)
        self._field_bytes = size
        return True

    @property
    def settled(self) -> bool:
        """Whether triangles are better than networks can be, which then need no look.

        Those of the target size, as good as exact; or so few that no networks ever cost as little.
        """
        if not self._open or self._config.target_error or self._loss:
            return False
        if self._config.target_size:
            return self._surely_nearer(0.0)
        forms = self._forms
        if self._form.least_cost > forms.surely_best:
            return False
        most = math.exp(forms.surely_best - forms.foreseen_cost(1.0, 0.0))
        found = self._form.best(self._nearest, most)
        return (
            forms.is_sound(found.errors)
            and forms.cost(found.size, found.errors) <= forms.surely_best
        )

    def _surely_nearer(self, distance: float) -> bool:
        """Whether triangles of the target size need not be set against networks.

        Those are foreseen to have such a mean distance.
        """
        forms, found = self._forms, self._of_target_size
        near = max(forms.negligible, forms.surely_nearer * distance)
        fits = self._triangle_bytes <= (self._config.target_size or 0.0)
        return fits and forms.is_sound(found.errors) and found.errors.distance <= near

    @cached_property
    def _besides(self) -> int:
        """Bytes of a file of triangles besides these."""
        fewest = self._form.fewest()
        return own_bytes(pack(self._document(None, fewest.parts))) - fewest.size

    @cached_property
    def _of_target_size(self) -> Candidate:
        """Triangles of the target size; the smallest where that is too small."""
        return self._form.of_size((self._config.target_size or 0.0) - self._besides)

    @property
    def _triangle_bytes(self) -> int:
        """Bytes of a file of these, without its images."""
        return self._besides + self._of_target_size.size

    @property
    def _least_bytes(self) -> int:
        """The same, with what is measured of them in place of the room for it."""
        return own_bytes(pack(self._written(self._chosen(self._of_target_size))))

    def _chosen(self, found: Candidate) -> Chosen:
        return Chosen(self._document(None, found.parts), found.errors, self._field_bytes)

    def _better_split(self, size: float, distance: float) -> Split | None:
        """Halves that promise to take clearly fewer bytes than networks or triangles alone.

        The whole's networks take about so many bytes at such a distance.
        """
        forms, found = self._forms, self._form.sorted_bodies()
        triangles = found.dense_size + found.other_size
        hope = forms.least_networks + found.other_size
        few = not found.sheets and found.other_size < forms.notable_others * triangles
        if few or not found.other.any() or hope > forms.worth_mixing * min(size, triangles):
            return None
        split = self._halves(found)
        if split is None:
            return None
        networks, error = split.field.foreseen
        cost = forms.foreseen_cost
        mixed = cost(networks + found.other_size, forms.fitted * error)
        pure = min(cost(size, distance), cost(triangles, found.distance))
        if mixed >= pure + math.log(forms.worth_mixing):
            return None
        if not self._tries or not self._split_lost_by_trial(split, found):
            return split
        if self._estimate < size:
            self._taken = self._form.about(distance)
        return None

    def _split_lost_by_trial(self, split: Split, found: Sorted) -> bool:
        """Whether a short fit of one half shows both to be hardly better than triangles alone."""
        # While the asset's trees are there: a trial has no room for them.
        triangles = self._form.cheapest()
        self._form.forget()
        forms, tried = self._forms, self._document(split.field.trial(), ())
        networks = own_bytes(pack(tried))
        errors = split.dense.errors(tried, forms.tried_faces, TRIAL)
        other = found.other_size / (found.dense_size + found.other_size)
        mixed = min(
            forms.cost(networks + other * each.size, errors.beside(each.errors, 1 - split.share))
            for each in self._form.made
        )
        pure = forms.cost(triangles.size, triangles.errors)
        return mixed - forms.trial_gain >= pure + math.log(forms.worth_mixing_tried)

    def after_fit(self, field: Document, errors: Errors) -> Chosen:
        """The fitted document, whose surface has these errors, or triangles that are better."""
        if not self._open:
            return Chosen(field, errors, self._estimate)
        if self._loss:
            return self._of_less_loss(field, errors, self._loss)
        size = own_bytes(pack(field))
        if errors.made_up.share > self._forms.notable_far:
            instead = self._instead(field, size, errors)
            if instead:
                return instead
        less = self._forms.cost(size, errors) < self._triangle_cost
        if less or self._estimate > self._forms.surely_larger * self._worth * size:
            return Chosen(field, errors, self._estimate)
        found = self._rival(size, errors)
        if found is None:
            return Chosen(field, errors)
        meshes = replace(field, field=None, meshes=found.parts)
        other = own_bytes(pack(meshes))
        better = self._is_better((other, found.errors), (size, errors))
        return Chosen(meshes, found.errors, size) if better else Chosen(field, errors, other)

    def _is_better(self, triangles: tuple[int, Errors], networks: tuple[int, Errors]) -> bool:
        """Whether triangles of so many bytes and such errors are better than networks."""
        config, cost = self._config, self._forms.cost
        if config.target_error:
            return triangles[0] < networks[0]
        if config.target_size:
            fits, worse = triangles[0] <= config.target_size, self._forms.error_cost
            return fits and worse(triangles[1]) < worse(networks[1])
        if self._worth > 1 and triangles[1].distance <= self._nearest < networks[1].distance:
            return triangles[0] < self._worth * networks[0]
        return cost(*triangles) < cost(*networks)

    def _of_less_loss(self, field: Document, errors: Errors, loss: Loss) -> Chosen:
        """The fitted document, or the triangles of the least loss."""
        found = self._of_least_loss(loss)
        meshes = self._document(None, found.parts)
        if loss(meshes) < loss(field):
            return Chosen(meshes, found.errors, own_bytes(pack(field)))
        return Chosen(field, errors, own_bytes(pack(meshes)))

    def _of_least_loss(self, loss: Loss) -> Candidate:
        """Of all that were looked at; where none has a finite loss, those of the target size."""

        def lost(found: Candidate) -> float:
            return loss(self._document(None, found.parts))

        found = self._form.of_least_loss(lost)
        return self._wanted() if self._config.target_size and lost(found) == math.inf else found

    def _instead(self, field: Document, size: int, errors: Errors) -> Chosen | None:
        """Triangles in place of a field that makes up surface, unless they take many more bytes.

        The more it makes up, the more bytes.
        """
        made_up, target = errors.made_up.share, self._config.target_size
        most = target or size * min(self._forms.most_worth, made_up / self._forms.notable_far)
        if self._config.target_error:
            found = self._form.within(self._config.target_error, errors.uv)
        elif target:
            found = self._of_target_size
        else:
            found = self._sound_rival(errors, most)
        if found is None or not self._forms.is_sound(found.errors):
            return None
        meshes = replace(field, field=None, meshes=found.parts)
        fits = own_bytes(pack(meshes)) <= most
        return Chosen(meshes, found.errors, size, made_up) if fits else None

    def without_networks(self, refused: TargetSizeError) -> None:
        """Leave an asset whose networks do not fit the target size to triangles.

        Raises TargetSizeError, for the smaller of both, where these do not fit either, and that of
        the networks where only these were asked for.
        """
        if not self._open:
            raise refused
        least = self._least_bytes
        if least > refused.found:
            raise TargetSizeError(min(refused.least, least), refused.found) from refused

    def _sound_rival(self, errors: Errors, most: float) -> Candidate:
        """Triangles about as near as networks; nearer ones where those lose or make up surface too.

        Of so many bytes, if any. Where the preset pays for near ones, these at once.
        """
        if self._worth <= 1:
            found = self._form.about(errors.distance)
            if self._forms.is_sound(found.errors):
                return found
        return self._form.best(min(errors.distance, self._nearest), most)

    def triangles(self) -> Chosen:
        """The asset as triangles, as near as the preset or the target asks.

        Raises FitError for a target error that they miss, TargetSizeError for a target size that is
        too small.
        """
        found = self._of_least_loss(self._loss) if self._loss else self._taken or self._wanted()
        return self._chosen(found)

    def _rival(self, size: int, errors: Errors) -> Candidate | None:
        """Triangles to set against a fitted field, if some may be better, or as asked."""
        if self._config.target_size:
            return self._of_target_size
        if self._config.target_error:
            return self._form.within(self._config.target_error, errors.uv)
        return self._near_rival(size, errors) or self._like_rival(size, errors)

    def _near_rival(self, size: int, errors: Errors) -> Candidate | None:
        """Triangles nearer than the networks, where the preset has them take more bytes."""
        near, most = self._nearest, self._worth * size
        if self._worth <= 1 or near >= errors.distance:
            return None
        if self._form.estimate(near, size, most) >= most:
            return None
        found = self._form.best(near, most)
        return found if found.size < most and found.errors.distance <= near else None

    def _like_rival(self, size: int, errors: Errors) -> Candidate | None:
        """Triangles about as near as the networks, where these are large or ugly enough."""
        most = size * self._forms.worth(errors)
        if self._form.estimate(errors.distance, size, most) >= most:
            return None
        return self._form.about(errors.distance)

    def _wanted(self) -> Candidate:
        config = self._config
        if config.target_error:
            found = self._form.within(config.target_error, math.inf)
            if found is None:
                raise FitError(
                    f"target error: expected {config.target_error:g}, found no mesh as near"
                )
            return found
        if not config.target_size:
            return self._form.best(self._nearest, self._worth * self._field_bytes or math.inf)
        least = self._least_bytes
        if least > config.target_size:
            raise TargetSizeError(least, config.target_size)
        return self._of_target_size

    @property
    def _nearest(self) -> float:
        """The mean distance that triangles are to keep within, where bytes allow it."""
        return self._budget.mesh

    @property
    def _worth(self) -> float:
        """Times the bytes of networks that triangles within that distance may take."""
        if self._config.target_error or self._config.target_size:
            return 1.0
        return self._budget.worth

    @property
    def _budget(self) -> TrainingBudget:
        return self._tuning.training.budgets[self._config.preset]

    @property
    def _open(self) -> bool:
        config = self._config
        return config.geometry == "auto" and config.preset != "paper" and not config.prune
