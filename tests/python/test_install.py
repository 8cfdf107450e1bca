"""What `cmake --install` puts into a prefix."""

import os
import subprocess
import sys

import pytest

TREE = os.environ.get("HSDM_BINARY_DIR")


@pytest.mark.skipif(not TREE, reason="HSDM_BINARY_DIR does not say where the build tree is")
def test_the_installed_package_reconstructs_and_runs_the_installed_command(tmp_path):
    for component in ("python", "runtime"):
        subprocess.run(
            ["cmake", "--install", TREE, "--component", component, "--prefix", tmp_path], check=True, capture_output=True
        )
    packages = tmp_path / "lib/python3/dist-packages"
    environment = {**os.environ, "PYTHONPATH": str(packages)}
    program = (
        "import hsdm, numpy as np; p = np.random.default_rng(1).normal(size=(5000, 3));"
        "p /= np.linalg.norm(p, axis=1)[:, None];"
        "print(hsdm.__file__, hsdm.reconstruct(p, p, depth=3).topology()['closed'])"
    )
    ended = subprocess.run(
        [sys.executable, "-c", program], env=environment, capture_output=True, text=True, check=True, cwd=tmp_path
    )
    assert ended.stdout == f"{packages}/hsdm/__init__.py True\n"
    command = packages / "hsdm/bin/hsdm"
    assert os.path.realpath(command) == str(tmp_path / "bin/hsdm")
    version = subprocess.run(
        [sys.executable, "-m", "hsdm", "--version"], env=environment, capture_output=True, text=True, cwd=tmp_path
    )
    assert version.stdout.startswith("hsdm ") and version.returncode == 0
    assert {"py.typed", "_core.pyi"} <= {file.name for file in (packages / "hsdm").iterdir()}
