"""Files of points and meshes."""

from __future__ import annotations

import os
from functools import cached_property
from typing import Optional, Sequence, TypeVar, Union

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._mesh import Mesh

_Number = TypeVar("_Number", bound=np.generic)
Path = Union[str, "os.PathLike[str]"]


class Points:
    """The points of a file, with what it says of each; `reconstruct` takes all of it. Arrays are read-only."""

    def __init__(self, cloud: _core.Cloud) -> None:
        """For `read_points` alone."""
        self._cloud = cloud

    def __len__(self) -> int:
        return len(self.positions)

    def __repr__(self) -> str:
        has = [name for name in ("normals", "colors") if getattr(self, name) is not None]
        extra = ", ".join([*has, *self.scalars, *self.labels])
        return f"<hsdm.Points: {len(self):,} points{' with ' + extra if extra else ''}>"

    @cached_property
    def positions(self) -> npt.NDArray[np.float64]:
        """``n x 3``, in the file's units; some may not be finite."""
        return self._cloud.positions

    @cached_property
    def normals(self) -> Optional[npt.NDArray[np.float64]]:
        """``n x 3`` as the file has them, or None."""
        return _if_any(self._cloud.normals)

    @cached_property
    def colors(self) -> Optional[npt.NDArray[np.uint8]]:
        """Red, green, blue and alpha, ``n x 4`` bytes, or None."""
        return _if_any(self._cloud.colors)

    @cached_property
    def scalars(self) -> dict[str, npt.NDArray[np.float64]]:
        """Further numbers of each point by the name that the file gives them."""
        return self._cloud.scalars

    @cached_property
    def labels(self) -> dict[str, npt.NDArray[np.float64]]:
        """The same of integers that must not be averaged."""
        return self._cloud.labels

    @property
    def sensor(self) -> Optional[tuple[float, float, float]]:
        """Where the scanner stood, if the file says."""
        return self._cloud.sensor

    @cached_property
    def sensors(self) -> Optional[npt.NDArray[np.float64]]:
        """Where several scanners stood, ``m x 3``, or None."""
        return _if_any(self._cloud.sensors)

    @cached_property
    def sensor_of(self) -> Optional[npt.NDArray[np.int32]]:
        """Which of them saw each point, or None."""
        return _if_any(self._cloud.sensor_of)

    @property
    def format(self) -> str:
        """The format found, one of `point_formats`."""
        return self._cloud.format

    @property
    def faces(self) -> int:
        """Faces of the file, which were skipped."""
        return self._cloud.faces

    @property
    def nonfinite(self) -> int:
        """Pixels and rays without a return, which were left out."""
        return self._cloud.nonfinite

    @property
    def withheld(self) -> int:
        """Points that a LAS file marks as withheld, which is how it deletes them; they were left out."""
        return self._cloud.withheld

    @property
    def first_withheld(self) -> Optional[tuple[float, float, float]]:
        """Where the first of them was, or None."""
        return self._cloud.first_withheld

    @property
    def columns(self) -> str:
        """What the columns of a table were taken for, where nothing but their values told."""
        return self._cloud.columns


def _if_any(array: npt.NDArray[_Number]) -> Optional[npt.NDArray[_Number]]:
    return array if len(array) else None


def read_points(
    path: Path,
    *,
    format: str = "",
    columns: str = "",
    sensors: Sequence[Sequence[float]] = (),
    sensor_column: str = "",
) -> Points:
    """Reads a cloud: PLY, PCD, XYZ and other tables, PTS, PTX, PWN, or the vertices of OFF, OBJ, STL, .om.

    ``format`` is one of `point_formats`, by default told by the content, then the extension; ``columns`` says what
    those of a table are, such as ``"x,y,z,nx,ny,nz,r,g,b,_"``. ``sensors`` are places of scanners instead of the
    file's, ``sensor_column`` the name of the column that numbers them. ``"-"`` is standard input. Raises
    FileError ``FILE:LINE: what, and what to do``, OptionError.
    """
    places = [_arrays.place("sensors", place) for place in sensors]
    return Points(_core.read_points(os.fsencode(path), format, columns, places, sensor_column))


def read_mesh(path: Path) -> Mesh:
    """Reads the polygons of OFF, STL, PLY, OBJ or .om with their normals and properties; of .om sharp edges too.

    Corners of STL at one place become one vertex. Raises FileError.
    """
    return Mesh._of(_core.read_mesh(os.fsencode(path)))
