"""Write build/api, the page of the public names: everything in `nispcodec.__all__`, by docstring.

python docs/api.py     exits with 1 where pdoc warns, or where a public name has no docstring
"""

from __future__ import annotations

import re
import sys
import warnings
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import numpy.typing
from pdoc import doc, render

FOLDER = Path(__file__).parent.parent / "build" / "api"
ALIASES = Path(__file__).parent.parent / "nispcodec" / "core" / "arrays.py"
# A name or several, as the docstring of a class lists its fields, and what is said of them.
FIELD = re.compile(r"(?P<names>\w+(?:, \w+)*) +(?P<text>\S.*)")


def main() -> int:
    """Write the page; returns the exit code."""
    warnings.simplefilter("error")
    module = public_module()
    for each in classes(module):
        tell_fields(each)
    if wrong := [f"{name}: no docstring" for name in undocumented(module)]:
        print(*wrong, sep="\n")
        return 1
    write(module)
    return 0


def public_module() -> doc.Module:
    """nispcodec, with what it loads late, and arrays called what the code calls them.

    Written out, the type of one array takes three lines of a signature.
    """
    names = re.findall(r"^(\w+) = ", ALIASES.read_text(encoding="utf-8"), re.MULTILINE)
    aliases = ModuleType("nispcodec.core.arrays")
    vars(aliases).update({name: stand_in(name) for name in names})
    sys.modules[aliases.__name__] = aliases
    vars(numpy.typing)["ArrayLike"] = stand_in("ArrayLike")
    import nispcodec

    vars(nispcodec).update({name: getattr(nispcodec, name) for name in nispcodec.__all__})
    return doc.Module(nispcodec)


def stand_in(name: str) -> type:
    """A type that signatures show by its bare name."""
    return type(name, (), {"__module__": "builtins"})


def classes(module: doc.Module) -> Iterator[doc.Class]:
    """The public classes."""
    return (each for each in module.members.values() if isinstance(each, doc.Class))


def tell_fields(described: doc.Class) -> None:
    """Move what the docstring of a class says of its fields, in a table, to these fields.

    Markdown would run the lines of the table together.
    """
    kept = []
    for paragraph in described.docstring.split("\n\n"):
        lines = re.split(r"\n(?! )", paragraph)
        found = [FIELD.fullmatch(re.sub(r"\n +", " ", line)) for line in lines]
        told = {name: each["text"] for each in found if each for name in each["names"].split(", ")}
        if all(found) and told.keys() <= described.members.keys():
            for name, text in told.items():
                described.members[name].docstring = text
        else:
            kept.append(paragraph)
    described.docstring = "\n\n".join(kept)


def undocumented(module: doc.Module) -> Iterator[str]:
    """Public names, and methods of public classes, that say nothing of themselves."""
    methods = (each for owner in classes(module) for each in owner.methods)
    for each in (*module.members.values(), *methods):
        if not each.docstring and not each.name.startswith("_"):
            yield each.fullname


def write(module: doc.Module) -> None:
    """The page, and an index that leads to it."""
    modules = {module.fullname: module}
    render.configure(show_source=False, footer_text=f"nispcodec {module.obj.__version__}")
    FOLDER.mkdir(parents=True, exist_ok=True)
    page = FOLDER / f"{module.fullname}.html"
    page.write_text(render.html_module(module, modules), encoding="utf-8")
    (FOLDER / "index.html").write_text(render.html_index(modules), encoding="utf-8")
    (FOLDER / "search.js").write_text(render.search_index(modules), encoding="utf-8")
    print(f"{page}: {len(module.members)} names")


if __name__ == "__main__":
    sys.exit(main())
