"""Builds the package by CMake: the module hsdm._core and the command, beside the files of apps/python/hsdm."""

import pathlib
import re
import sys

from skbuild import setup

_cmake = pathlib.Path("CMakeLists.txt").read_text(encoding="utf-8")
_version = re.search(r"project\(hsdm VERSION ([0-9.]+)", _cmake)
assert _version, "CMakeLists.txt gives the version"

setup(
    version=_version[1],
    packages=["hsdm"],
    package_dir={"hsdm": "apps/python/hsdm"},
    package_data={"hsdm": ["*.pyi", "py.typed"]},
    cmake_install_dir="apps/python/hsdm",
    cmake_args=[
        "-DCMAKE_BUILD_TYPE=Release",
        "-DHSDM_BUILD_BENCHMARKS=OFF",
        "-DHSDM_BUILD_PLUGINS=OFF",
        "-DHSDM_BUILD_PYTHON=ON",
        "-DHSDM_BUILD_TESTS=OFF",
        "-DHSDM_INSTALL=OFF",
        "-DHSDM_UNITY=ON",
        f"-DPython_EXECUTABLE={sys.executable}",
    ],
)
