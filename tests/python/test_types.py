"""Annotations are complete, and stubs are those of the module that is built."""

import os
import pathlib
import subprocess
import sys

import pytest

import hsdm

PACKAGE = pathlib.Path(hsdm.__file__).parent
IS_INSTALLED = PACKAGE.parent.name in ("site-packages", "dist-packages")

USER = '''
from typing import Optional
import numpy as np
import numpy.typing as npt
import hsdm

def progress(phase: str, done: float) -> Optional[bool]:
    return done < 1

points: npt.NDArray[np.float32] = np.zeros((5, 3), np.float32)
mesh: hsdm.Mesh = hsdm.reconstruct(points, normals=points, depth=5, max_error="1%", progress=progress)
corners: npt.NDArray[np.float64] = mesh.vertices
quads: npt.NDArray[np.uint32] = mesh.quads
hsdm.reconstruct(points, depth="five")
mesh.vertexes
'''


def checked(tmp_path, *arguments):
    pytest.importorskip("mypy")
    return subprocess.run(
        [sys.executable, "-m", *arguments],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env={
            **os.environ,
            "MYPYPATH": "" if IS_INSTALLED else str(PACKAGE.parent),
            "MYPY_CACHE_DIR": str(tmp_path / "cache"),
        },
    )


def test_a_users_mistakes_are_found_and_nothing_else(tmp_path):
    (tmp_path / "user.py").write_text(USER)
    # What is installed mypy finds itself, and looks at no more than the types that it tells.
    own = [] if IS_INSTALLED else [str(PACKAGE)]
    ended = checked(tmp_path, "mypy", "--strict", "user.py", *own)
    errors = [line for line in ended.stdout.splitlines() if ": error:" in line]
    assert len(errors) == 2, ended.stdout
    assert 'user.py:14' in errors[0] and '"depth"' in errors[0]
    assert 'user.py:15' in errors[1] and '"vertexes"' in errors[1]


def test_everything_public_has_a_docstring():
    missing = []
    for name in hsdm.__all__:
        item = getattr(hsdm, name)
        if isinstance(item, type) or callable(item):
            if not item.__doc__:
                missing.append(name)
        if isinstance(item, type) and item.__module__.startswith("hsdm"):
            for part, value in vars(item).items():
                if not part.startswith("_") and not getattr(value, "__doc__", None):
                    missing.append(f"{name}.{part}")
    assert missing == []


def test_the_stub_of_the_core_names_what_the_core_has():
    import ast

    stub = ast.parse((PACKAGE / "_core.pyi").read_text())
    told = {}
    for node in stub.body:
        if isinstance(node, ast.ClassDef):
            told[node.name] = {getattr(part, "name", None) or part.target.id for part in node.body}
        elif isinstance(node, ast.FunctionDef):
            told[node.name] = set()
        elif isinstance(node, ast.AnnAssign):
            told[node.target.id] = set()
    from hsdm import _core

    there = {name for name in vars(_core) if not name.startswith("__")}
    assert there == set(told) - {"_Enumeration"}
    for name, parts in told.items():
        item = getattr(_core, name, None)
        if isinstance(item, type):
            own = {part for part in vars(item) if not part.startswith("_")}
            assert own - {"name", "value"} == parts - {"__init__"}, name
