"""Scanned points in, a CAD-ready mesh out: quad-dominant, a 2-manifold, with its sharp edges marked.

>>> import hsdm
>>> part = hsdm.reconstruct(points)                 # n x 3 numbers, or hsdm.read_points("scan.ply")
>>> part.vertices, part.quads, part.sharp_edges     # NumPy arrays
>>> part.write("part.stl")

``python -m hsdm`` is the command.
"""

from __future__ import annotations

from ._core import point_formats as point_formats
from ._core import version as __version__
from ._errors import CloudError, Cancelled, Error, FileError, OptionError, OutOfMemory
from ._files import Points, read_mesh, read_points
from ._mesh import Mesh
from ._reconstruct import compare, reconstruct, reconstruct_levels

__all__ = [
    "CloudError",
    "Cancelled",
    "Error",
    "FileError",
    "Mesh",
    "OptionError",
    "OutOfMemory",
    "Points",
    "__version__",
    "compare",
    "point_formats",
    "read_mesh",
    "read_points",
    "reconstruct",
    "reconstruct_levels",
]
