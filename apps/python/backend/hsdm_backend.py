"""The build backend of pyproject.toml: that of setuptools, with scikit-build from where it is.

pip builds in an environment that hides the system's packages, and would fetch scikit-build from an index. Where the
distribution has it, it is taken from there, so that `pip install .` needs no network.
"""

import importlib.util
import os
import sys

_DEBIAN = "/usr/lib/python3/dist-packages"
_needed = ["scikit-build>=0.16", "setuptools>=61", "wheel"]


def _is_here(*modules):
    return all(importlib.util.find_spec(module) for module in modules)


if not _is_here("skbuild", "setuptools", "wheel") and os.path.isdir(os.path.join(_DEBIAN, "skbuild")):
    # In front: of setuptools, scikit-build and wheel, those fit each other.
    sys.path.insert(0, _DEBIAN)
    importlib.invalidate_caches()
_is_complete = _is_here("skbuild", "setuptools", "wheel")


def get_requires_for_build_wheel(config_settings=None):
    """What is not here, for an index to give."""
    return [] if _is_complete else _needed


get_requires_for_build_sdist = get_requires_for_build_wheel


def _backend():
    from setuptools import build_meta

    return build_meta


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """As PEP 517 says."""
    return _backend().build_wheel(wheel_directory, config_settings, metadata_directory)


def build_sdist(sdist_directory, config_settings=None):
    """As PEP 517 says."""
    return _backend().build_sdist(sdist_directory, config_settings)
