"""What is raised, and that it is what programs catch."""

import subprocess
import sys

import numpy as np
import pytest

import hsdm


def test_exceptions_are_of_the_kinds_that_python_programs_catch():
    kinds = {
        hsdm.OptionError: ValueError,
        hsdm.CloudError: ValueError,
        hsdm.FileError: OSError,
        hsdm.OutOfMemory: MemoryError,
        hsdm.Cancelled: Exception,
    }
    for kind, base in kinds.items():
        assert issubclass(kind, base) and issubclass(kind, hsdm.Error)


@pytest.mark.parametrize(
    "options, words",
    [
        ({"depth": 40}, "depth 40: must lie in"),
        ({"depth": 2**70}, "depth .*out of range"),
        ({"depth": 4, "voxel_size": 1.0}, "voxel_size"),
        ({"voxel_size": -1}, "voxel_size"),
        ({"voxel_size": float("nan")}, "voxel_size"),
        ({"max_error": 0}, "max_error"),
        ({"max_error": "a lot"}, "max_error 'a lot': a number, or a percentage"),
        ({"max_error": "nan%"}, "max_error 'nan%'"),
        ({"method": "best"}, "method 'best': must be one of automatic, basic, extended"),
        ({"grid": "hexagonal"}, "grid 'hexagonal': must be one of automatic, uniform, adaptive"),
        ({"holes": "fill"}, "holes 'fill': must be one of automatic, keep, close, complete"),
        ({"normal_source": "none"}, "normal_source 'none': must be one of automatic, given, estimate"),
        ({"trim": 2}, "trim"),
        ({"crease_angle": 35}, "crease_angle"),
        ({"normal_smoothing": -1}, "normal_smoothing"),
        ({"threads": -1}, "threads"),
        ({"min_component": -1}, "min_component"),
    ],
)
def test_an_option_out_of_range_is_named(box, options, words):
    with pytest.raises(hsdm.OptionError, match=words):
        hsdm.reconstruct(*box, **options)


@pytest.mark.parametrize(
    "options, words",
    [
        ({"depth": "six"}, "depth: a whole number is wanted, str came"),
        ({"depth": 6.0}, "depth: a whole number is wanted, float came"),
        ({"depth": True}, "depth: a whole number is wanted, bool came"),
        ({"voxel_size": "1"}, "voxel_size: a number is wanted, str came"),
        ({"method": 1}, "method: a str is wanted, int came"),
        ({"confidence": 1}, "confidence: True or False is wanted, int came"),
        ({"progress": 1}, "progress: a callable is wanted, int came"),
        ({"debug_dir": 1}, "PathLike"),
        ({"dept": 5}, "dept"),
    ],
)
def test_an_option_of_another_kind_is_a_type_error(box, options, words):
    with pytest.raises(TypeError, match=words):
        hsdm.reconstruct(*box, **options)


def test_numbers_of_numpy_are_numbers(box):
    mesh = hsdm.reconstruct(*box, depth=np.int64(3), crease_angle=np.float32(0.6), confidence=np.True_)
    assert mesh.report["grid"]["depth"] == 3


@pytest.mark.parametrize("points", [np.zeros((0, 3)), np.zeros((1, 3)), np.full((9, 3), np.nan)])
def test_points_without_a_surface_are_a_cloud_error(points):
    with pytest.raises(hsdm.CloudError):
        hsdm.reconstruct(points)


def test_a_file_that_cannot_be_read_is_named(tmp_path):
    missing = tmp_path / "none.ply"
    with pytest.raises(OSError, match="none.ply") as caught:
        hsdm.read_points(missing)
    assert isinstance(caught.value, hsdm.FileError) and caught.value.filename == str(missing)
    bad = tmp_path / "bad.xyz"
    bad.write_text("0 0 0\n1 1 one\n")
    with pytest.raises(hsdm.FileError, match=r"bad.xyz:2: "):
        hsdm.read_points(bad)
    with pytest.raises(hsdm.FileError, match="none.off"):
        hsdm.read_mesh(tmp_path / "none.off")


def test_a_file_that_cannot_be_written_is_named_and_the_old_one_stays(tmp_path, box_mesh):
    old = tmp_path / "part.abc"
    old.write_text("old")
    with pytest.raises(hsdm.FileError, match="no mesh format has the extension"):
        box_mesh.write(old)
    assert old.read_text() == "old"
    with pytest.raises(hsdm.FileError):
        box_mesh.write(tmp_path / "no folder" / "part.off")
    assert sorted(tmp_path.iterdir()) == [old]


OUT_OF_MEMORY = """
import resource, sys
import numpy as np
import hsdm
points = np.random.default_rng(1).random((300000, 3))
hsdm.reconstruct(points[:1000], depth=3)  # threads are there
used = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (used + 24_000_000,) * 2)
try:
    hsdm.reconstruct(points, points, depth=9)
except MemoryError as error:
    print(type(error).__name__, error)
"""


def test_the_end_of_memory_is_a_memory_error_that_says_what_to_do():
    ended = subprocess.run([sys.executable, "-c", OUT_OF_MEMORY], capture_output=True, text=True, timeout=60)
    assert ended.stdout.startswith("OutOfMemory out of memory; use a smaller depth"), ended.stderr
