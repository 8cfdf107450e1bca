"""What the documentation shows runs."""

import pathlib
import re
import runpy

import numpy as np
import pytest

import hsdm

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture
def scan_here(tmp_path, monkeypatch, box):
    monkeypatch.chdir(tmp_path)
    np.savetxt("scan.xyz", np.concatenate(box, axis=1), "%.17g")
    rows = np.concatenate(box, axis=1)
    header = "ply\nformat ascii 1.0\nelement vertex %d\n%send_header\n"
    properties = "".join(f"property double {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
    with open("scan.ply", "w", encoding="ascii") as file:
        file.write(header % (len(rows), properties))
        np.savetxt(file, rows, "%.17g")


def blocks_of(page):
    return re.findall(r"^```python\n(.*?)^```$", (ROOT / page).read_text(encoding="utf-8"), re.M | re.S)


@pytest.mark.parametrize("page, count", [("docs/python.md", 5), ("README.md", 1)])
def test_the_blocks_of_a_page_run_one_after_the_other(page, count, scan_here):
    blocks = blocks_of(page)
    assert len(blocks) == count
    names = {}
    for block in blocks:
        exec(compile(block, page, "exec"), names)
    assert hsdm.read_mesh("part.stl").topology()["closed"]


def test_what_the_page_shows_of_the_example_stands_in_it():
    def bare(text):
        return [line for line in text.splitlines() if line.strip() and not line.startswith("#")]

    page = (ROOT / "docs/python.md").read_text(encoding="utf-8")
    (shown,) = re.findall(r"^```py\n(.*?)^```$", page, re.M | re.S)
    script = bare((ROOT / "docs/examples/scan_to_part.py").read_text(encoding="utf-8"))
    begin = script.index(bare(shown)[0])
    assert script[begin : begin + len(bare(shown))] == bare(shown)


def test_the_example_makes_a_closed_part_of_its_size(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    names = runpy.run_path(str(ROOT / "docs/examples/scan_to_part.py"))
    part = names["part"]
    topology = part.topology()
    assert topology["closed"] and topology["genus"] == 0
    assert topology["signed_volume"] == pytest.approx(np.pi * (0.25 * 3.4 + 0.6), rel=0.01)
    assert hsdm.read_mesh("part.ply").digest() == part.digest()
    lines = capsys.readouterr().out.splitlines()
    assert any(line.startswith("closed genus 0") for line in lines)
    # Six circles.
    ends = part.vertices[part.sharp_edges]
    length = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).sum()
    assert length == pytest.approx(2 * np.pi * (4 * 0.5 + 2 * 1), rel=0.02)


def test_the_page_names_everything_public_and_every_option():
    import inspect

    page = re.sub(r"^```.*?^```$", "", (ROOT / "docs/python.md").read_text(encoding="utf-8"), flags=re.M | re.S)
    named = set(re.findall(r"\w+", " ".join(re.findall(r"`[^`]+`", page))))
    wanted = set(hsdm.__all__) - {"Error", "__version__"} | set(inspect.signature(hsdm.reconstruct).parameters)
    for kind in (hsdm.Mesh, hsdm.Points):
        wanted |= {name for name in vars(kind) if not name.startswith("_")}
    assert wanted - named == set()
