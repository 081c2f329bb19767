"""Build sdist and wheel, and try them in a clean virtual environment of every Python that is there.

python .ci/package.py     exits with 1 where an install fails, does not do what it should, or is
                          larger than LIMIT

The sdist is tried too. A wheel that holds compiled code may be for one Python: where it does not
fit, the sdist is what users get.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parent.parent
DIST = ROOT / "build" / "dist"
MODEL = ROOT / "tests" / "conformance" / "uv-map.nisp"
# The minor versions of Python 3 that are supported.
VERSIONS = range(11, 15)
# Bytes of everything in the environment, Python's own installer included.
LIMIT = 150_000_000
# Pins what is installed to build with, too.
PINNED = {**os.environ, "PIP_CONSTRAINT": str(ROOT / "constraints.txt"), "PIP_NO_INPUT": "1"}


class Failed(Exception):
    """A command failed, or said something else than it should."""


def main() -> int:
    """Build and try; returns the exit code."""
    try:
        build()
        tried = [try_version(version) for version in VERSIONS]
    except Failed as why:
        print(f"package: {why}")
        return 1
    return 0 if any(tried) else 1


def build() -> None:
    """An sdist, and a wheel made from it alone, into DIST."""
    shutil.rmtree(DIST, ignore_errors=True)
    run(sys.executable, "-m", "build", "--outdir", str(DIST), str(ROOT))
    for path in sorted(DIST.iterdir()):
        print(f"{path.relative_to(ROOT)}: {path.stat().st_size:,} bytes")


def try_version(version: int) -> bool:
    """Install and use it with Python 3.`version`, or print why not; whether it was tried.

    Raises Failed.
    """
    python = interpreter(version)
    if python is None:
        print(f"python3.{version}: not tried, neither on the path nor in pyenv")
        return False
    for package in packages_for(version):
        try_package(python, version, package)
    return True


def try_package(python: str, version: int, package: Path) -> None:
    """Install and use it in a clean environment, and print its size. Raises Failed."""
    started = time.monotonic()
    with tempfile.TemporaryDirectory() as name:
        environment = Path(name, "venv")
        run(python, "-m", "venv", str(environment))
        pip = environment / "bin" / "pip"
        run(str(pip), "install", "--disable-pip-version-check", "-q", str(package))
        size = sum(path.lstat().st_size for path in environment.rglob("*") if path.is_file())
        use(environment / "bin" / "nisp", Path(name))
    seconds = time.monotonic() - started
    print(f"python3.{version}: {package.name}, {size / 1e6:.1f} MB, works, {seconds:.0f} s")
    if size > LIMIT:
        raise Failed(f"expected {LIMIT / 1e6:.0f} MB or less, found {size / 1e6:.1f}")


def use(nisp: Path, folder: Path) -> None:
    """Decode, verify and show a file; encoding wants an extra, and says so. Raises Failed."""
    mesh = folder / "out.glb"
    run(str(nisp), "verify", str(MODEL))
    run(str(nisp), "decode", str(MODEL), "-o", str(mesh), "--resolution", "32")
    run(str(nisp), "view", str(MODEL), "-o", str(folder / "page.html"), "--original", str(mesh))
    asked = subprocess.run(
        [str(nisp), "encode", str(mesh), "-o", str(folder / "out.nisp")],
        capture_output=True,
        text=True,
    )
    if asked.returncode != 2 or "pip install 'nispcodec[encode]'" not in asked.stderr:
        raise Failed(f"nisp encode: expected what to install, found {asked.stderr}")
    version = re.search(r'^__version__ = "(.*)"', source_of_version(), re.MULTILINE)
    said = run(str(nisp), "--version").split()
    if version is None or said != ["nisp", version[1]]:
        raise Failed(f"nisp --version: expected {version and version[1]}, found {said}")


def source_of_version() -> str:
    """The module that says the version."""
    return (ROOT / "nispcodec" / "__init__.py").read_text(encoding="utf-8")


def packages_for(version: int) -> list[Path]:
    """The wheel where it is for Python 3.`version`, the sdist where not, and for this Python."""
    wheel, sdist = next(DIST.glob("*.whl")), next(DIST.glob("*.tar.gz"))
    fits = wheel.stem.split("-")[2] in ("py3", f"cp3{version}")
    return [wheel] * fits + [sdist] * (not fits or version == sys.version_info[1])


def interpreter(version: int) -> str | None:
    """A Python 3.`version` that makes virtual environments, or None."""
    return next((path for path in candidates(version) if answers(path, version)), None)


def candidates(version: int) -> Iterator[str]:
    """Where a Python 3.`version` may be: this one, on the path, in pyenv."""
    yield sys.executable
    if found := shutil.which(f"python3.{version}"):
        yield found
    pyenv = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv"), "versions")
    yield from (str(path) for path in sorted(pyenv.glob(f"3.{version}.*/bin/python")))


def answers(path: str, version: int) -> bool:
    """Whether it runs, is of that version, and can make virtual environments with pip."""
    asked = subprocess.run(
        [path, "-c", "import ensurepip, sys, venv; print(sys.version_info[1])"],
        capture_output=True,
        text=True,
    )
    return asked.returncode == 0 and asked.stdout.strip() == str(version)


def run(*command: str) -> str:
    """What a command prints. Raises Failed with all it said when it fails."""
    done = subprocess.run(
        command, capture_output=True, text=True, env=PINNED, cwd=tempfile.gettempdir()
    )
    if done.returncode:
        raise Failed(f"{' '.join(command)}\n{done.stdout}{done.stderr}")
    return done.stdout


if __name__ == "__main__":
    sys.exit(main())
