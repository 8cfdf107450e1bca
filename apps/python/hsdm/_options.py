"""Keyword arguments to the library's ReconstructOptions; what is out of range the library says itself."""

from __future__ import annotations

import math
import operator
import os
from typing import Any, Optional, TypeVar, Union

from . import _core
from ._errors import OptionError

_Choice = TypeVar("_Choice")


def whole(name: str, given: Any) -> int:
    """An int, or what acts as one."""
    try:
        if isinstance(given, bool):
            raise TypeError
        number = operator.index(given)
    except TypeError:
        raise TypeError(f"{name}: a whole number is wanted, {type(given).__name__} came") from None
    if not -(2**31) <= number < 2**31:
        raise OptionError(f"{name} {number}: is out of range")
    return number


def number(name: str, given: Any) -> float:
    """A float, or what acts as one."""
    try:
        if isinstance(given, (bool, str, bytes)):
            raise TypeError
        return float(given)
    except (TypeError, ValueError):
        raise TypeError(f"{name}: a number is wanted, {type(given).__name__} came") from None


def flag(name: str, given: Any) -> bool:
    """True or False; a number is a mistake."""
    if type(given).__name__ not in ("bool", "bool_"):
        raise TypeError(f"{name}: True or False is wanted, {type(given).__name__} came")
    return bool(given)


def choice(name: str, given: Any, kind: type[_Choice]) -> _Choice:
    """A word of one of the library's enumerations; `auto` for `automatic`, as the command has it."""
    if not isinstance(given, str):
        raise TypeError(f"{name}: a str is wanted, {type(given).__name__} came")
    known: dict[str, _Choice] = kind.__members__  # type: ignore[attr-defined]
    word = "automatic" if given == "auto" else given
    if word not in known:
        raise OptionError(f"{name} {given!r}: must be one of {', '.join(known)}")
    return known[word]


def amount(name: str, given: Union[float, str], of_whole: bool) -> tuple[float, bool]:
    """A number and whether it is a share: `"0.1%"` is (0.001, True)."""
    if not isinstance(given, str):
        return number(name, given), flag(f"{name}: the share", of_whole)
    try:
        if not given.endswith("%") or of_whole:
            raise ValueError
        share = float(given[:-1]) / 100
        if not math.isfinite(share):
            raise ValueError
    except ValueError:
        raise OptionError(f"{name} {given!r}: a number, or a percentage such as '0.1%', is wanted") from None
    return share, True


def options_of(
    *,
    depth: Optional[int] = None,
    voxel_size: Optional[float] = None,
    max_error: Union[float, str, None] = None,
    max_error_of_diagonal: bool = False,
    grid: str = "automatic",
    method: str = "automatic",
    normal_source: str = "automatic",
    holes: str = "automatic",
    merge_layers: bool = False,
    min_component: Union[float, str, None] = None,
    min_component_of_largest: bool = False,
    confidence: bool = False,
    trim: float = 0.0,
    crease_angle: float = 0.61,
    normal_smoothing: int = 3,
    threads: int = 0,
    classify: bool = True,
    vertex_normals: bool = True,
    measure: bool = True,
    debug_dir: Union[str, "os.PathLike[str]"] = "",
) -> _core.ReconstructOptions:
    """The library's options of keyword arguments. Raises TypeError for a value of another kind, OptionError."""
    options = _core.ReconstructOptions()
    if depth is not None:
        options.depth = whole("depth", depth)
    if voxel_size is not None:
        options.voxel_size = number("voxel_size", voxel_size)
    if max_error is not None:
        options.set_max_error(*amount("max_error", max_error, max_error_of_diagonal))
    if min_component is not None:
        options.set_min_component(*amount("min_component", min_component, min_component_of_largest))
    options.grid = choice("grid", grid, _core.Grid)
    options.method = choice("method", method, _core.Method)
    options.normals = choice("normal_source", normal_source, _core.NormalSource)
    options.holes = choice("holes", holes, _core.Holes)
    options.merge_layers = flag("merge_layers", merge_layers)
    options.confidence = flag("confidence", confidence)
    options.trim = number("trim", trim)
    options.crease_angle = number("crease_angle", crease_angle)
    options.normal_smoothing = whole("normal_smoothing", normal_smoothing)
    options.threads = whole("threads", threads)
    options.classify = flag("classify", classify)
    options.vertex_normals = flag("vertex_normals", vertex_normals)
    options.measure = flag("measure", measure)
    options.set_debug_dir(os.fsencode(debug_dir))
    return options
