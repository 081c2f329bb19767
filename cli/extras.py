"""What to install when an optional package is missing."""

from __future__ import annotations

import re
from importlib import import_module, metadata

DISTRIBUTIONS = {"igl": "libigl", "skimage": "scikit-image"}
"""Where the name that is imported is not the one that is installed."""

OPTIONAL = (
    "torch",
    "igl",
    "skimage",
    "scipy",
    "fast_simplification",
    "embreex",
    "xatlas",
    "rich",
)


def expect_installed(*packages: str) -> None:
    """Raises ImportError, before the work, when one of the packages is missing."""
    for package in packages:
        import_module(package)


def needed_extra(error: ImportError, command: str) -> str | None:
    """One sentence that says what to install; None where no optional package is missing.

    `command` is the subcommand that wants it.
    """
    package = (error.name or "").partition(".")[0]
    if package not in OPTIONAL:
        return None
    distribution = DISTRIBUTIONS.get(package, package)
    missing = isinstance(error, ModuleNotFoundError)
    state = "is not installed" if missing else f"fails to load ({error})"
    wanted = _installed_by(distribution, command)
    return f"nisp {command} needs {distribution}, which {state}: pip install {wanted}"


def _installed_by(distribution: str, command: str) -> str:
    """What `pip install` wants for a distribution: an extra of ours that has it, if any.

    Of several that of the command, and never more than is needed.
    """
    first = "encode" if command == "encode" else "render"
    extras = sorted(_extras(distribution), key=lambda name: (name != first, name == "all"))
    return f"'nispcodec[{extras[0]}]'" if extras else distribution


def _extras(distribution: str) -> list[str]:
    """Our extras that ask for a distribution, in the order of pyproject.toml."""
    try:
        required = metadata.requires("nispcodec") or []
    except metadata.PackageNotFoundError:
        return []
    asked = [re.match(r"([\w.-]+).*\bextra == ['\"]([\w-]+)['\"]", line) for line in required]
    return [each[2] for each in asked if each and _plain(each[1]) == _plain(distribution)]


def _plain(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()
