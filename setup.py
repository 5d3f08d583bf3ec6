# SPDX-License-Identifier: BSD-3-Clause
"""Builds the Python module and the command by CMake, for pip.

CMAKE_ARGS adds options to those of CMake, CMAKE_GENERATOR and CMAKE_CXX_COMPILER_LAUNCHER are CMake's
own; CMAKE_BUILD_PARALLEL_LEVEL says how many compilers run at once (default: all cores).
"""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parent


def project_version() -> str:
    """The one of the project, which CMake is told."""
    found = re.search(r"project\(spherule VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())
    if found is None:
        raise SystemExit("CMakeLists.txt names no version")
    return found.group(1)


class BuildByCMake(build_ext):
    """Compiles and installs the parts of the package that CMake makes."""

    def build_extension(self, ext: Extension) -> None:
        package = Path(self.get_ext_fullpath(ext.name)).resolve().parent
        build = Path(self.build_temp).resolve()
        build.mkdir(parents=True, exist_ok=True)
        options = [
            "-DCMAKE_BUILD_TYPE=Release",
            f"-DPython_EXECUTABLE={sys.executable}",
            "-DSPHERULE_PYTHON=ON",
            *shlex.split(os.environ.get("CMAKE_ARGS", "")),
        ]
        jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", str(os.cpu_count() or 1))
        subprocess.run(["cmake", "-S", str(ROOT), "-B", str(build), *options], check=True)
        targets = ["--target", "spherule_python"]
        subprocess.run(["cmake", "--build", str(build), "--parallel", jobs, *targets], check=True)
        for part in ("python", "python_command"):
            install = ["--component", part, "--prefix", str(package), "--strip"]
            subprocess.run(["cmake", "--install", str(build), *install], check=True)


setup(
    version=project_version(),
    ext_modules=[Extension("spherule._core", sources=[])],
    cmdclass={"build_ext": BuildByCMake},
    package_data={"spherule": ["*.pyi", "py.typed"]},
)
