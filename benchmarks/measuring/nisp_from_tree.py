"""`nisp` from a source tree that is not installed: python nisp_from_tree.py TREE ARGUMENTS.

It runs by the interpreter, and with the sources, of another build, which may be years old: it
imports nothing of ours before the tree is the first place where Python looks.
"""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

COMMAND = "nispcodec_cli"


def command_of(tree: Path) -> Callable[[], None]:
    """The `nisp` command of a tree, whose folder `cli` an install would name nispcodec_cli.

    Raises ImportError when another nispcodec than the tree's would answer.
    """
    # In the place of this script's folder, whose modules must not hide any of the tree's.
    sys.path[0] = str(tree)
    found = importlib.util.find_spec("nispcodec")
    if found is None or found.origin is None or tree not in Path(found.origin).parents:
        where = found.origin if found else "nowhere"
        raise ImportError(f"nispcodec: expected below {tree}, found {where}")
    command: Callable[[], None] = _loaded(tree / "cli").main
    return command


def _loaded(folder: Path) -> ModuleType:
    start = folder / "__init__.py"
    spec = importlib.util.spec_from_file_location(
        COMMAND, start, submodule_search_locations=[str(folder)]
    )
    assert spec is not None
    assert spec.loader is not None
    sys.modules[COMMAND] = module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


if __name__ == "__main__":
    tree = Path(sys.argv.pop(1)).resolve()
    sys.argv[0] = "nisp"
    command_of(tree)()
