"""`python -m hsdm` is the command."""

import json
import os
import pathlib
import signal
import subprocess
import sys

import numpy as np
import pytest

import hsdm

COMMAND = os.environ.get("HSDM_COMMAND") or str(pathlib.Path(hsdm.__file__).parent / "bin" / "hsdm")


def run(program, *arguments, **options):
    return subprocess.run([*program, *map(str, arguments)], capture_output=True, timeout=60, **options)


def as_module(*arguments, **options):
    return run([sys.executable, "-m", "hsdm"], *arguments, **options)


@pytest.fixture
def scan(tmp_path, torus):
    path = tmp_path / "scan.xyz"
    np.savetxt(path, np.concatenate(torus, axis=1), "%.17g")
    return path


@pytest.mark.parametrize(
    "arguments",
    [["--version"], ["--help"], ["reconstruct", "--help"], ["stages"], [], ["reconstruct", "none.ply", "-o", "x.off"], ["info", "--dept"]],
    ids=" ".join,
)
def test_arguments_output_and_status_are_the_commands(arguments, tmp_path):
    module, command = as_module(*arguments, cwd=tmp_path), run([COMMAND], *arguments, cwd=tmp_path)
    assert (module.returncode, module.stdout, module.stderr) == (command.returncode, command.stdout, command.stderr)


@pytest.mark.parametrize(
    "arguments, options",
    [
        (["--depth", "5"], {"depth": 5}),
        (["--max-error", "1%"], {"max_error": "1%"}),
        (["--method", "basic", "--depth", "4"], {"method": "basic", "depth": 4}),
        (["--normals", "estimate", "--crease-degrees", "30"], {"normal_source": "estimate", "crease_angle": np.radians(30)}),
    ],
)
def test_the_mesh_has_the_bits_of_the_commands(scan, tmp_path, arguments, options):
    crease = {"crease_angle": np.radians(35), **options}  # the library's own default is 0.61, a little less
    ended = as_module("reconstruct", scan, "-o", tmp_path / "command.ply", "--report", tmp_path / "report.json", *arguments)
    assert ended.returncode == 0, ended.stderr
    mesh = hsdm.reconstruct(hsdm.read_points(scan), **crease)
    mesh.write(tmp_path / "module.ply")
    assert (tmp_path / "module.ply").read_bytes() == (tmp_path / "command.ply").read_bytes()
    report = json.loads((tmp_path / "report.json").read_text())
    assert mesh.digest() == report["mesh"]["digest"]
    assert mesh.report["error"] == report["error"]
    assert mesh.report["features"] == report["features"]


def test_a_signal_ends_it_as_it_ends_the_command(tmp_path):
    os.mkfifo(tmp_path / "never.xyz")
    with subprocess.Popen(
        [sys.executable, "-m", "hsdm", "info", str(tmp_path / "never.xyz")], stderr=subprocess.PIPE, text=True
    ) as process:
        writer = os.open(tmp_path / "never.xyz", os.O_WRONLY)  # waits for the reader
        process.send_signal(signal.SIGINT)
        assert process.wait(10) == 130
        os.close(writer)
        assert "cancelled" in process.stderr.read()
