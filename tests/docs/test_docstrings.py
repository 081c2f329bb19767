"""The rules of docstrings: every public thing has one, and it says what is raised."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "nispcodec"
PATHS = sorted(PACKAGE.rglob("*.py"))
# A class's docstring speaks for these, too.
MAKERS = ("__init__", "__post_init__")

Function = ast.FunctionDef | ast.AsyncFunctionDef
Documented = ast.Module | ast.ClassDef | Function


@dataclass(frozen=True)
class Item:
    """A module, class or function: its place, and the class that it stands in."""

    place: str
    node: Documented
    owner: ast.ClassDef | None = None

    @property
    def docstring(self) -> str:
        return ast.get_docstring(self.node) or ""


def items(tree: ast.Module, place: str) -> list[Item]:
    """The module and all that is public in it."""
    return [Item(place, tree), *_members(tree, place, None)]


def _members(
    owner: ast.Module | ast.ClassDef, place: str, within: ast.ClassDef | None
) -> Iterator[Item]:
    for node in owner.body:
        if not isinstance(node, ast.ClassDef | Function):
            continue
        if node.name.startswith("_") and not (within and node.name in MAKERS):
            continue
        item = Item(f"{place}:{node.lineno} {node.name}", node, within)
        yield item
        if isinstance(node, ast.ClassDef):
            yield from _members(node, place, node)


def errors() -> set[str]:
    """The names of the project's errors."""
    tree = ast.parse((PACKAGE / "core" / "errors.py").read_text(encoding="utf-8"))
    return {node.name for node in tree.body if isinstance(node, ast.ClassDef)}


def makers_of_errors(trees: list[ast.Module], names: set[str]) -> set[str]:
    """Functions that return one of the errors, for their caller to raise."""
    return {
        node.name
        for tree in trees
        for node in ast.walk(tree)
        if isinstance(node, Function)
        and isinstance(node.returns, ast.Name)
        and node.returns.id in names
    }


def raised(function: Function) -> set[str]:
    """The last names of all that the function's own body raises, not that of functions in it."""
    found: set[str] = set()
    left: list[ast.AST] = list(function.body)
    while left:
        node = left.pop()
        if isinstance(node, Function | ast.ClassDef | ast.Lambda):
            continue
        if isinstance(node, ast.Raise) and node.exc is not None:
            thrown = node.exc.func if isinstance(node.exc, ast.Call) else node.exc
            if isinstance(thrown, ast.Name):
                found.add(thrown.id)
            elif isinstance(thrown, ast.Attribute):
                found.add(thrown.attr)
        left.extend(ast.iter_child_nodes(node))
    return found


def silent(item: Item, names: set[str]) -> bool:
    """Whether a function raises one of these, and neither it nor its class says so."""
    if not isinstance(item.node, Function) or not raised(item.node) & names:
        return False
    said = item.docstring + (ast.get_docstring(item.owner) or "" if item.owner else "")
    return "Raises" not in said


def parsed(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


TREES = {path.relative_to(ROOT).as_posix(): parsed(path) for path in PATHS}
ITEMS = [item for place, tree in TREES.items() for item in items(tree, place)]
RAISED = errors() | makers_of_errors(list(TREES.values()), errors())


def test_every_public_thing_has_a_docstring() -> None:
    bare = [item.place for item in ITEMS if not item.docstring]
    assert not [place for place in bare if not place.endswith(MAKERS)]


def test_no_docstring_begins_with_of_or_what() -> None:
    assert not [item.place for item in ITEMS if re.match(r"(Of|What)\b", item.docstring)]


def test_what_is_raised_is_said() -> None:
    assert not [item.place for item in ITEMS if silent(item, RAISED)]


def test_errors_and_their_makers_are_known() -> None:
    assert {"NispError", "MeshError", "FormatError", "error"} <= RAISED


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ('def f():\n    "Reads."\n    raise MeshError("no")', True),
        ('def f():\n    "Reads. Raises MeshError."\n    raise MeshError("no")', False),
        ('def f():\n    "Reads."\n    raise reader.error("no")', True),
        ('def f():\n    "Reads."\n    raise KeyError("no")', False),
        ('def f():\n    "Reads."\n    def g():\n        raise MeshError\n    return g', False),
        ('class C:\n    "C. Raises MeshError."\n    def f(self):\n        raise MeshError', False),
        ('class C:\n    "C."\n    def __init__(self):\n        raise MeshError', True),
        ('def _f():\n    raise MeshError("no")', False),
    ],
)
def test_the_rule_finds_what_it_is_for(source: str, expected: bool) -> None:
    found = items(ast.parse(source), "here")
    assert any(silent(item, {"MeshError", "error"}) for item in found) is expected
