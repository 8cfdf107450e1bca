"""Arrays as the library reads them: as they are where their layout and type allow, else converted."""

from __future__ import annotations

import os
from typing import Any, Optional, Sequence

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[Any]

_FLOATS = (np.dtype(np.float32), np.dtype(np.float64))
_BYTE = np.dtype(np.uint8)


def _number_array(name: str, given: npt.ArrayLike, wanted: str) -> Array:
    """Anything as an array of real numbers."""
    try:
        array = np.asarray(given)
    except ValueError:  # rows of several lengths
        raise ValueError(f"{name}: rows of several lengths came, {wanted} is wanted") from None
    if array.dtype.kind not in "iuf":
        raise TypeError(f"{name}: {_words_of(given, array)} came, {wanted} is wanted")
    return array


def _words_of(given: object, array: Array) -> str:
    if isinstance(given, np.ndarray) or array.ndim > 0:
        return f"an array of {array.dtype}"
    return type(given).__name__


def _is_readable(array: Array) -> bool:
    """Whether rows stand one behind the other, and the numbers of a row side by side."""
    if not array.dtype.isnative:
        return False
    if array.ndim == 1:
        return len(array) < 2 or array.strides[0] >= array.itemsize
    side_by_side = array.strides[1] == array.itemsize
    return side_by_side and (len(array) < 2 or array.strides[0] >= array.shape[1] * array.itemsize)


def vectors(name: str, given: npt.ArrayLike, rows: Optional[int] = None) -> Array:
    """``n x 3`` numbers, float32 or float64: the array itself where it can be read in place."""
    wanted = f"shape {'(n, 3)' if rows is None else (rows, 3)}"
    array = _number_array(name, given, wanted)
    if array.ndim != 2 or array.shape[1] != 3 or rows not in (None, len(array)):
        raise ValueError(f"{name}: shape {array.shape} came, {wanted} is wanted")
    if array.dtype in _FLOATS and _is_readable(array):
        return array
    return np.ascontiguousarray(array, np.float32 if array.dtype == np.float32 else np.float64)


def colors(given: npt.ArrayLike, rows: int) -> Array:
    """``n x 3`` or ``n x 4``: bytes, or floats from 0 to 1; other integers are taken for bytes."""
    wanted = f"shape ({rows}, 3) or ({rows}, 4)"
    array = _number_array("colors", given, wanted)
    if array.ndim != 2 or array.shape[1] not in (3, 4) or len(array) != rows:
        raise ValueError(f"colors: shape {array.shape} came, {wanted} is wanted")
    if array.dtype.kind in "iu":
        return _bytes(array)
    if array.dtype in _FLOATS and _is_readable(array):
        return array
    return np.ascontiguousarray(array, np.float64)


def _bytes(array: Array) -> Array:
    if array.dtype == _BYTE:
        return array if _is_readable(array) else np.ascontiguousarray(array)
    if array.size and (array.min() < 0 or array.max() > 255):
        raise ValueError(
            f"colors: integers from {array.min()} to {array.max()} came; 0 to 255, or floats from 0 to 1, are wanted"
        )
    return np.ascontiguousarray(array, np.uint8)


def _column(name: str, given: npt.ArrayLike, rows: int) -> Array:
    wanted = f"shape ({rows},)"
    array = _number_array(name, given, wanted)
    if array.shape != (rows,):
        raise ValueError(f"{name}: shape {array.shape} came, {wanted} is wanted")
    return array


def scalars(name: str, given: npt.ArrayLike, rows: int) -> Array:
    """One number for each point."""
    array = _column(name, given, rows)
    in_place = array.dtype in _FLOATS or array.dtype in (_BYTE, np.uint16, np.int32)
    return array if in_place and _is_readable(array) else np.ascontiguousarray(array, np.float64)


def labels(name: str, given: npt.ArrayLike, rows: int) -> Array:
    """One integer of 32 bits for each point; floats that are whole numbers, too."""
    array = _column(name, given, rows)
    if array.dtype in (_BYTE, np.uint16, np.int32) and _is_readable(array):
        return array
    numbers = array.astype(np.int32) if _fits_int32(array) else None
    if numbers is None or not np.array_equal(numbers, array):
        raise ValueError(f"{name}: whole numbers of 32 bits are wanted")
    return numbers


def _fits_int32(array: Array) -> bool:
    limits = np.iinfo(np.int32)
    return not array.size or bool(array.min() >= limits.min and array.max() <= limits.max)


def property_name(given: object) -> bytes:
    """A name as files have it: a word that is not one of the coordinates'."""
    if not isinstance(given, str):
        raise TypeError(f"a property's name: a str is wanted, {type(given).__name__} came")
    is_word = given.split() == [given] and min(given) > " "
    if not is_word or given in ("x", "y", "z", "nx", "ny", "nz"):
        raise ValueError(f"a property's name: {given!r} came, a word other than x, y, z, nx, ny, nz is wanted")
    return os.fsencode(given)


def place(name: str, given: Sequence[float]) -> tuple[float, float, float]:
    """Three finite numbers."""
    array = _number_array(name, given, "three numbers")
    if array.shape != (3,) or not np.isfinite(array).all():
        raise ValueError(f"{name}: {given!r} came, three finite numbers are wanted")
    return (float(array[0]), float(array[1]), float(array[2]))


def indices(name: str, given: npt.ArrayLike, columns: Optional[int] = None) -> npt.NDArray[np.uint32]:
    """Whole numbers from 0 on, in one dimension or in rows of so many."""
    wanted = "shape (n,)" if columns is None else f"shape (n, {columns})"
    array = np.asarray(given)
    if array.size == 0:
        return np.zeros((0,) if columns is None else (0, columns), np.uint32)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{name}: an array of {array.dtype} came, one of integers is wanted")
    if array.ndim != (1 if columns is None else 2) or (columns is not None and array.shape[1] != columns):
        raise ValueError(f"{name}: shape {array.shape} came, {wanted} is wanted")
    if array.min() < 0 or array.max() > np.iinfo(np.uint32).max:
        raise ValueError(f"{name}: {array.min()} to {array.max()} came, numbers from 0 to 2^32 - 1 are wanted")
    return np.ascontiguousarray(array, np.uint32)
