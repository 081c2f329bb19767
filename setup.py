"""Builds the native kernels, where there is a compiler for them; all else: pyproject.toml.

One library for each instruction set, which Python loads by ctypes: so they are for any Python, and
the wheel is for a platform, but not for a Python. Without them training takes torch and queries of
mesh parts take numpy, so nothing that goes wrong here may keep anyone from installing.
"""

from __future__ import annotations

import platform
import sys
from pathlib import Path
from typing import Any

from setuptools import Extension, setup
from setuptools.command.bdist_wheel import bdist_wheel
from setuptools.command.build_ext import build_ext

# Packages with the folder `kernel`, and what else the compiler is told: searches of a mesh give the
# same distances to the last bit as numpy, which has no fused operations.
PACKAGES = {
    "nispcodec.train.backend.native": ["-ffp-contract=fast"],
    "nispcodec.infer.native": ["-ffp-contract=off"],
}
EXPORTS = "nispcodec/core/kernel/exports.h"
# -ffast-math is not wanted: kernel/vectors.h says why.
COMPILE = [
    *("-std=c++17", "-O3", "-fno-math-errno", "-fno-trapping-math"),
    *("-fvisibility=hidden", "-Wall", "-Wextra", "-Wno-psabi", "-pthread", "-g0"),
]
# Name of the instruction set: floats in a vector, and what the compiler is told.
INSTRUCTION_SETS = {
    "x86_64": {
        "v2": (4, ["-march=x86-64-v2"]),
        "v3": (8, ["-march=x86-64-v3"]),
        "v4": (16, ["-march=x86-64-v4"]),
    },
    "arm64": {"neon": (4, [])},
}
MACHINES = {"AMD64": "x86_64", "aarch64": "arm64"}


def kernels() -> list[Extension]:
    """Those for this machine; none for one that is not known."""
    machine = MACHINES.get(platform.machine(), platform.machine())
    return [
        kernel(package, isa, length, [*COMPILE, *of_package, *told])
        for package, of_package in PACKAGES.items()
        for isa, (length, told) in INSTRUCTION_SETS.get(machine, {}).items()
    ]


def kernel(package: str, isa: str, length: int, told: list[str]) -> Extension:
    """A package's library for an instruction set with vectors of `length` floats."""
    folder = f"{package.replace('.', '/')}/kernel"
    return Extension(
        f"{package}._kernel_{isa}",
        [f"{folder}/interface.cpp"],
        depends=[EXPORTS, *(str(path) for path in sorted(Path(folder).glob("*.h")))],
        define_macros=[("NISP_VECTOR_LENGTH", str(length))],
        extra_compile_args=told,
        extra_link_args=["-pthread"],
        language="c++",
        optional=True,
    )


class BuildKernels(build_ext):
    """Builds what it can, and says in one line what it cannot."""

    failure = ""

    def run(self) -> None:
        """Build all kernels, whatever happens."""
        try:
            super().run()
        except Exception as why:
            self.failure = self.failure or str(why)
        if self.failure:
            consequence = "no kernel was built, so training takes torch, queries of meshes numpy"
            sys.stdout.write(f"warning: {consequence}: {self.failure}\n")

    def build_extension(self, ext: Extension) -> None:
        """Build one, unless one before it failed."""
        if self.failure:
            return
        try:
            # Each has objects of its own: the source is the same.
            self.build_temp, kept = str(Path(self.build_temp, ext.name)), self.build_temp
            super().build_extension(ext)
            self.build_temp = kept
        except Exception as why:
            self.failure = " ".join(str(why).split())

    def get_ext_filename(self, fullname: str) -> str:
        """A plain name: no Python's ABI is in it."""
        return str(Path(*fullname.split("."))) + ".so"

    def get_export_symbols(self, ext: Extension) -> list[str]:
        """None of Python's."""
        return list(ext.export_symbols)


class Wheel(bdist_wheel):
    """For any Python 3, and for any platform where no kernel was built."""

    def get_tag(self) -> tuple[str, str, str]:
        """Tags of Python, ABI and platform."""
        kernels_are_there = any(Path(self.bdist_dir).rglob("_kernel_*.so"))
        return "py3", "none", super().get_tag()[2] if kernels_are_there else "any"


if __name__ == "__main__":
    commands: dict[str, Any] = {"build_ext": BuildKernels, "bdist_wheel": Wheel}
    setup(ext_modules=[] if sys.platform == "win32" else kernels(), cmdclass=commands)
