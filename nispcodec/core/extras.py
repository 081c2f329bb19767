"""The packages that only some uses need, and the sentence that says what to install for them.

`pip install nispcodec` decodes, queries, verifies and converts. Whatever else imports a package of
an extra asks for it at its door with `require`, so that who lacks it reads one sentence.
"""

from __future__ import annotations

from importlib.util import find_spec

from nispcodec.core.errors import NispError

# Packages that are installed by another name than they are imported by.
DISTRIBUTIONS = {
    "igl": "libigl",
    "skimage": "scikit-image",
    "opengl_basisu": "opengl-basisu",
    "pxr": "usd-core",
}


def require(*packages: str, extra: str, what_for: str) -> None:
    """Raises NispError, a sentence that says what to install, when one of the packages is missing.

    packages: as they are imported; they are looked for, not loaded. extra: the one of nispcodec
    that has them. what_for: "encoding", "comparing": the sentence begins with it.
    """
    missing = [DISTRIBUTIONS.get(name, name) for name in packages if find_spec(name) is None]
    if missing:
        which = "which is" if len(missing) == 1 else "which are"
        raise NispError(
            f"{what_for} needs {' and '.join(missing)}, {which} not installed: "
            f"pip install 'nispcodec[{extra}]'"
        )
