"""Which arrays are read in place, which are converted, and which are refused."""

import numpy as np
import pytest

import hsdm
from hsdm import _arrays, _core

STRUCT = np.dtype([("position", np.float32, 3), ("intensity", np.uint16), ("normal", np.float32, 3), ("rgb", np.uint8, 3)])


def address_read(points):
    """Where the library reads positions that Python was given."""
    return _core.View(_arrays.vectors("points", points), None, None, None, None, None).address()


def in_place_layouts():
    plain = np.arange(30.0).reshape(10, 3)
    wide = np.arange(80.0).reshape(10, 8)
    hits = np.zeros(10, STRUCT)
    unaligned = np.zeros(10 * 25 + 1, np.uint8)[1:].view(np.dtype((np.void, 25)))
    odd = np.ndarray((10, 3), np.float32, unaligned.data, 1, (25, 4))
    frozen = plain.copy()
    frozen.setflags(write=False)
    return {
        "doubles": plain,
        "floats": plain.astype(np.float32),
        "columns of a table": wide[:, 2:5],
        "every second row": plain[::2],
        "a field of structs": hits["position"],
        "unaligned": odd,
        "read-only": frozen,
        "one row": plain[3:4],
    }


@pytest.mark.parametrize("layout", in_place_layouts())
def test_an_array_is_read_where_it_is(layout):
    array = in_place_layouts()[layout]
    assert address_read(array) == array.__array_interface__["data"][0]


@pytest.mark.parametrize(
    "change",
    [
        lambda a: a[::-1],
        lambda a: np.asfortranarray(a),
        lambda a: a.astype(np.int64),
        lambda a: a.astype(np.float16),
        lambda a: a.astype(">f8"),
        lambda a: a[:, ::-1],
        lambda a: a.tolist(),
        lambda a: np.broadcast_to(a[0], a.shape),
    ],
    ids=["reversed rows", "columns", "integers", "halves", "big-endian", "reversed", "lists", "one row for all"],
)
def test_other_layouts_are_converted_to_the_same_numbers(change):
    given = change(np.arange(30.0).reshape(10, 3))
    read = _arrays.vectors("points", given)
    assert (read == np.asarray(given)).all()
    assert read.flags.c_contiguous and read.dtype == np.float64


def test_structs_columns_and_copies_give_the_same_bits(torus):
    points, normals = (array.astype(np.float32) for array in torus)
    hits = np.zeros(len(points), STRUCT)
    hits["position"], hits["normal"] = points, normals
    table = np.concatenate([points, normals, points], axis=1)
    meshes = [
        hsdm.reconstruct(points, normals, depth=4),
        hsdm.reconstruct(hits["position"], hits["normal"], depth=4),
        hsdm.reconstruct(table[:, :3], table[:, 3:6], depth=4),
        hsdm.reconstruct(points.astype(float), np.asfortranarray(normals), depth=4),
        hsdm.reconstruct(points.tolist(), normals.tolist(), depth=4),
    ]
    assert len({mesh.digest() for mesh in meshes}) == 1


def test_the_callers_arrays_stay_as_they_are(torus):
    points, normals = (array.copy() for array in torus)
    hsdm.reconstruct(points, normals, depth=4)
    assert (points == torus[0]).all() and (normals == torus[1]).all()


@pytest.mark.parametrize(
    "arrays, error, words",
    [
        ({"points": np.zeros(5)}, ValueError, r"points: shape \(5,\) came, shape \(n, 3\) is wanted"),
        ({"points": np.zeros((5, 2))}, ValueError, r"points: shape \(5, 2\) came"),
        ({"points": np.zeros((5, 3), complex)}, TypeError, "points: an array of complex128 came"),
        ({"points": "scan.ply"}, TypeError, "points: str came"),
        ({"points": None}, TypeError, "points: NoneType came"),
        ({"points": [[1, 2, 3], [4, 5]]}, (TypeError, ValueError), "points: "),
        ({"points": np.zeros((5, 3), bool)}, TypeError, "points: an array of bool came"),
        ({"normals": np.zeros((4, 3))}, ValueError, r"normals: shape \(4, 3\) came, shape \(5, 3\) is wanted"),
        ({"colors": np.zeros((5, 2))}, ValueError, r"colors: shape \(5, 2\) came, shape \(5, 3\) or \(5, 4\)"),
        ({"colors": np.full((5, 3), 256)}, ValueError, "colors: integers from 256 to 256 came"),
        ({"scalars": {"a": np.zeros(4)}}, ValueError, r"scalars a: shape \(4,\) came, shape \(5,\) is wanted"),
        ({"labels": {"a": np.full(5, 0.5)}}, ValueError, "labels a: whole numbers of 32 bits"),
        ({"labels": {"a": np.full(5, 2**40)}}, ValueError, "labels a: whole numbers of 32 bits"),
        ({"labels": {"a": np.full(5, np.nan)}}, ValueError, "labels a: whole numbers of 32 bits"),
        ({"scalars": {"a b": np.zeros(5)}}, ValueError, "a property's name: 'a b' came"),
        ({"scalars": {"": np.zeros(5)}}, ValueError, "a property's name: '' came"),
        ({"labels": {"nx": np.zeros(5)}}, ValueError, "a property's name: 'nx' came"),
        ({"scalars": {1: np.zeros(5)}}, TypeError, "a property's name: a str is wanted, int came"),
        ({"sensor": (1, 2)}, ValueError, "sensor: .* three finite numbers"),
        ({"sensor": (1, 2, np.inf)}, ValueError, "sensor: .* three finite numbers"),
    ],
)
def test_arrays_that_do_not_fit_are_refused_with_what_came_and_what_is_wanted(arrays, error, words):
    with pytest.raises(error, match=words):
        hsdm.reconstruct(**{"points": np.random.default_rng(1).random((5, 3)), **arrays})


def test_the_core_itself_refuses_rows_that_it_would_misread():
    for bad in (np.zeros((4, 2)), np.zeros((4, 3), order="F"), np.zeros((4, 3), np.int64), np.zeros(3)):
        with pytest.raises((TypeError, ValueError)):
            _core.View(bad, None, None, None, None, None)
