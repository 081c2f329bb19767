"""What to install when an optional package is missing."""

from __future__ import annotations

import re
from importlib import metadata

DISTRIBUTIONS = {"igl": "libigl", "skimage": "scikit-image", "PIL": "Pillow"}
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


def needed_extra(error: ImportError, command: str) -> str | None:
    """One sentence that says what to install; None where no optional package is missing."""
    package = (error.name or "").partition(".")[0]
    if package not in OPTIONAL:
        return None
    distribution = DISTRIBUTIONS.get(package, package)
    found = "none" if isinstance(error, ModuleNotFoundError) else f"one that fails: {error}"
    return f"nisp {command} needs {distribution}, found {found}: {install_line(distribution)}"


def install_line(distribution: str) -> str:
    """The `pip install` that brings a distribution: by the extra of ours that has it, if any.

    `all` comes last, where a smaller one does.
    """
    extras = sorted(_extras(distribution), key="all".__eq__)
    wanted = f"'nispcodec[{extras[0]}]'" if extras else distribution
    return f"pip install {wanted}"


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
