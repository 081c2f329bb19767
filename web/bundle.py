"""ES modules as one classic script, without tools of JavaScript: a wheel writes pages by itself.

Our modules import by name, without renaming, at the start of lines, and have comments only where a
line begins with one or as JSDoc. That is all that this understands.
"""

from __future__ import annotations

import re
from pathlib import Path

_IMPORT = re.compile(r'^import \{([^}]*)\} from "([^"]+)";$', re.MULTILINE)
_EXPORT = re.compile(r"^export ((?:async )?(?:function|class|const)\*? )(\w+)", re.MULTILINE)
_JSDOC = re.compile(r"/\*\*.*?\*/", re.DOTALL)


def bundled(entry: Path) -> str:
    """The script of a module and of all that it imports, each in a function of its own.

    Raises ValueError for an import or export of another form, and for modules in a circle.
    """
    names: dict[Path, str] = {}
    parts: list[str] = []
    _add(entry.resolve(), names, parts, ())
    return '"use strict";\n' + "\n".join(parts) + "\n"


def _add(path: Path, names: dict[Path, str], parts: list[str], above: tuple[Path, ...]) -> None:
    """Adds the module to `parts` behind those that it imports, and its name to `names`."""
    if path in above:
        raise ValueError(f"{path}: expected no import in a circle, found one")
    if path in names:
        return
    source = path.read_text(encoding="utf-8")
    for _, target in _IMPORT.findall(source):
        _add((path.parent / target).resolve(), names, parts, (*above, path))
    names[path] = f"m{len(names)}"
    parts.append(f"const {names[path]} = (() => {{\n{_body(source, path, names)}\n}})();")


def _body(source: str, path: Path, names: dict[Path, str]) -> str:
    """The module's code with what it imports as constants, returning what it exports."""

    def taken(found: re.Match[str]) -> str:
        return f"const {{{found[1]}}} = {names[(path.parent / found[2]).resolve()]};"

    code = _EXPORT.sub(r"\1\2", _IMPORT.sub(taken, _JSDOC.sub("", source)))
    if wrong := re.search(r"^(import|export)\b.*", code, re.MULTILINE):
        raise ValueError(f"{path}: expected imports and exports by name, found {wrong[0]}")
    exported = ", ".join(name for _, name in _EXPORT.findall(source))
    return f"{_without_comments(code)}\nreturn {{ {exported} }};"


def _without_comments(code: str) -> str:
    """No lines that are comments or empty, no indentation."""
    lines = (line.strip() for line in code.splitlines())
    return "\n".join(line for line in lines if line and not line.startswith("//"))
