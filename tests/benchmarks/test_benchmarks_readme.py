from __future__ import annotations

from pathlib import Path

from benchmarks.measuring.build import HERE
from benchmarks.report.committed import RESULTS

BENCHMARKS = HERE / "benchmarks"
# What other commands start.
INSIDE = {"rate_distortion.command", "paper.command", "studies.extraction_probe"}


def text_of(path: Path) -> str:
    return path.read_text(encoding="utf-8")


def test_the_readme_lists_every_command_and_every_result() -> None:
    text = text_of(BENCHMARKS / "README.md")
    modules = [path for path in BENCHMARKS.glob("*/*.py") if "@click.command" in text_of(path)]
    names = {f"{path.parent.name}.{path.stem}" for path in modules}
    assert {"headline.encode_time", "studies.curve"} | INSIDE <= names
    assert not [name for name in names - INSIDE if f"`{name}" not in text]
    assert not [result.file for result in RESULTS if f"`{result.file}`" not in text]
