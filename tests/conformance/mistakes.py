"""Mistakes that a reader may make, each caught by a file: `python -m tests.conformance.mistakes`.

A mistake, of those in `mistakes.toml`, is a change to the text of the independent reader: to the
Python blocks of `format_spec.md`, or to `independent.py`, `independent_mesh.py` or
`independent_meta.py`. A file catches
it when the changed reader answers it wrongly, refuses it though it is sound, or reads it though it
is malformed.
"""

from __future__ import annotations

import json
import sys
import tomllib
import types
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tests.conformance.described import described
from tests.format import spec

HERE = Path(__file__).parent
TOLERANCE = json.loads((HERE / "tolerance.json").read_text())


class Mistake(NamedTuple):
    """What was right, what stands there instead, and a file that tells."""

    right: str
    wrong: str
    caught_by: str


def changed_reader(mistake: Mistake) -> Any:
    """The class of the independent reader with the mistake in it.

    Raises ValueError where the text that it changes is not there exactly once.
    """
    sources = _sources()
    places = [name for name, text in sources for _ in range(text.count(mistake.right))]
    if len(places) != 1:
        raise ValueError(f"{mistake.right!r} is in {places or 'no text'}, expected one place")
    decoder: dict[str, Any] = {}
    meta, mesh, module = map(types.ModuleType, ("meta", "mesh", "independent"))
    names = {
        "spec": decoder,
        "independent_meta": vars(meta),
        "independent_mesh": vars(mesh),
        "independent": vars(module),
    }
    for name, text in sources:
        exec(_compiled(text.replace(mistake.right, mistake.wrong)), names[name])
    vars(module).update(DECODER=decoder, independent_meta=meta, independent_mesh=mesh)
    return module.Reader


@cache
def _sources() -> list[tuple[str, str]]:
    """The texts that a reader is made of, each with where its names go."""
    files = ("independent_meta", "independent_mesh", "independent")
    blocks = [("spec", block) for block in spec.blocks("python")]
    return [*blocks, *((name, (HERE / f"{name}.py").read_text()) for name in files)]


@cache
def _compiled(text: str) -> types.CodeType:
    """The code of a text; a mistake changes one of many."""
    return compile(text, "<reader>", "exec")


def is_caught(reader: Any, stem: str) -> bool:
    """Whether a file, by its name or as `malformed/name`, shows that the reader is wrong."""
    file = (HERE / f"{stem}.nisp").read_bytes()
    if stem.startswith("malformed/"):
        try:
            reader(file)
        except Exception:
            return False
        return True
    wanted = json.loads((HERE / f"{stem}.json").read_text())
    try:
        return not _answers(reader(file), wanted)
    except Exception:
        return True


def _answers(read: Any, wanted: dict[str, Any]) -> bool:
    """Whether all answers are right."""
    if described(read) != wanted["document"]:
        return False
    scale = np.maximum(np.abs(read.meta["uv_map"][2:]), 1)
    sdf = TOLERANCE["sdf"] if read.specs else TOLERANCE["mesh_sdf"]
    for row, point in enumerate(wanted["points"]):
        chart = wanted["chart"][row]
        right = (
            read.chart(point) == chart
            and _close(read.distance(point), wanted["sdf"][row], sdf)
            and _close(read.uv(point, chart), wanted["uv"][row], TOLERANCE["uv"] * scale)
            and _close(read.color(point), wanted["color"][row], TOLERANCE["color"])
            and _elsewhere(read, point, wanted, row)
        )
        if not right:
            return False
    return True


def _elsewhere(read: Any, point: Any, wanted: dict[str, Any], row: int) -> bool:
    """Whether the UV on a chart that is not the nearest is right, where one is told."""
    if "other_chart" not in wanted:
        return True
    found = read.uv(point, wanted["other_chart"][row])
    return _close(found, wanted["other_uv"][row], TOLERANCE["uv"])


def _close(found: Any, wanted: Any, tolerance: Any) -> bool:
    numbers = np.array(wanted, np.float64)
    same = np.isclose(np.asarray(found), numbers, rtol=0, atol=tolerance, equal_nan=True)
    return bool(same.all())


def catching(mistake: Mistake) -> list[str]:
    """All files that catch a mistake."""
    reader = changed_reader(mistake)
    files = sorted([*HERE.glob("*.nisp"), *HERE.glob("malformed/*.nisp")])
    stems = [str(path.relative_to(HERE).with_suffix("")) for path in files]
    return [stem for stem in stems if is_caught(reader, stem)]


def score() -> tuple[int, int]:
    """How many mistakes the file that each of them names catches, and how many there are."""
    caught = [is_caught(changed_reader(each), each.caught_by) for each in MISTAKES.values()]
    return sum(caught), len(caught)


MISTAKES = {
    each.pop("name"): Mistake(**each)
    for each in tomllib.loads((HERE / "mistakes.toml").read_text())["mistake"]
}


def main(arguments: list[str]) -> int:
    """Print the score, or with words of a mistake's name all files that catch it."""
    for name, mistake in MISTAKES.items():
        if arguments and " ".join(arguments) in name:
            print(f"{name}: {', '.join(catching(mistake)) or 'nothing'}")
    caught, count = score()
    print(f"{caught} of {count} mistakes caught: {100 * caught / count:.0f} %")
    return int(caught < count)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
