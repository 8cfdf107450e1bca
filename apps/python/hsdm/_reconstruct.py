"""Points in, meshes out."""

from __future__ import annotations

import os
from typing import Any, Callable, Mapping, Optional, Sequence, Union

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._errors import OptionError
from ._files import Points
from ._mesh import Mesh
from ._options import options_of, whole

Progress = Callable[[str, float], Optional[bool]]


def reconstruct(
    points: Union[npt.ArrayLike, Points],
    normals: Optional[npt.ArrayLike] = None,
    colors: Optional[npt.ArrayLike] = None,
    *,
    scalars: Optional[Mapping[str, npt.ArrayLike]] = None,
    labels: Optional[Mapping[str, npt.ArrayLike]] = None,
    sensor: Optional[Sequence[float]] = None,
    sensors: Optional[npt.ArrayLike] = None,
    sensor_of: Optional[npt.ArrayLike] = None,
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
    progress: Optional[Progress] = None,
) -> Mesh:
    """The surface of scanned points.

    Arrays of float32 and float64 are read where they are, whatever the distance from row to row; others are
    converted first. They must not change meanwhile, for the interpreter's lock is released. Points whose
    coordinates are not all finite are skipped and counted in the report.

    points: ``n x 3`` in any units, or what `read_points` returned, with all that it holds; then arrays given here
        go before its own.
    normals: ``n x 3``, of any length, into or out of the object; estimated if there are none.
    colors: ``n x 3`` or ``n x 4``, bytes or floats from 0 to 1; vertices get their means.
    scalars, labels: further numbers of each point by name, ``n``; vertices get means, or the majority's label.
    sensor; sensors, sensor_of: where the scanner stood, or several did, and the number of each point's.

    Options, in the points' units and radians:

    depth, voxel_size, max_error: the resolution, at most one of them; by default it follows from the points'
        spacing and noise. ``depth`` is the octree's, 1 to 16; ``voxel_size`` a length; ``max_error`` the distance
        that points may be off, kept with as few faces as it takes: a length, ``"0.1%"`` of the diagonal of the
        points' box, or its share with ``max_error_of_diagonal``.
    grid: "uniform", "adaptive" or "automatic": adaptive with ``max_error``.
    method: "extended" with normals, "basic" by positions alone; "automatic" is extended.
    normal_source: "given", "estimate" or "automatic": the points' if they have some. (The library's ``normals``.)
    holes: "keep"; "close" over their border's vertices; "complete" by the surface that is missing; "automatic":
        what is small against the sampling.
    merge_layers: sheets less than a voxel apart that face one way are one surface.
    min_component: components of fewer faces are dropped; ``"1%"`` of the largest one's area, or its share with
        ``min_component_of_largest``.
    confidence: vertices get ``hsdm_confidence``, 0 to 1; trim: faces of less are cut off.
    crease_angle: the dihedral angle above which an edge is sharp.
    normal_smoothing: rounds of smoothing of normals.
    threads: at most so many; 0: all. The result does not depend on it.
    classify, vertex_normals, measure: sharp edges and classes; normals; the report's mesh and error. False saves
        their time.
    debug_dir: a folder for the phases as files.
    progress: called some twenty times a second with the phase and the share done, 0 to 1; False cancels, and what
        it raises is raised here. It must not reconstruct.

    Raises OptionError for options out of range, before any work; CloudError for points without a surface in them;
    ValueError and TypeError for arrays and options of other shapes and kinds; Cancelled; OutOfMemory. Ctrl-C raises
    KeyboardInterrupt in the main thread.
    """
    options = options_of(
        depth=depth,
        voxel_size=voxel_size,
        max_error=max_error,
        max_error_of_diagonal=max_error_of_diagonal,
        grid=grid,
        method=method,
        normal_source=normal_source,
        holes=holes,
        merge_layers=merge_layers,
        min_component=min_component,
        min_component_of_largest=min_component_of_largest,
        confidence=confidence,
        trim=trim,
        crease_angle=crease_angle,
        normal_smoothing=normal_smoothing,
        threads=threads,
        classify=classify,
        vertex_normals=vertex_normals,
        measure=measure,
        debug_dir=debug_dir,
    )
    _check_callable(progress)
    view = _view_of(points, normals, colors, scalars, labels, sensor, sensors, sensor_of)
    return Mesh._of(*_core.reconstruct(view, options, progress))


def reconstruct_levels(
    points: Union[npt.ArrayLike, Points],
    first_depth: int,
    last_depth: int,
    normals: Optional[npt.ArrayLike] = None,
    colors: Optional[npt.ArrayLike] = None,
    *,
    scalars: Optional[Mapping[str, npt.ArrayLike]] = None,
    labels: Optional[Mapping[str, npt.ArrayLike]] = None,
    sensor: Optional[Sequence[float]] = None,
    sensors: Optional[npt.ArrayLike] = None,
    sensor_of: Optional[npt.ArrayLike] = None,
    progress: Optional[Progress] = None,
    **options: Any,
) -> list[Mesh]:
    """One mesh for each depth from ``first_depth`` to ``last_depth``, of one octree.

    Arrays, options (but for the resolution) and exceptions are those of `reconstruct`. A depth of which no mesh
    comes does not stop the others: its mesh has no faces, and the reason is ``report["failure"]``.
    """
    known = options_of(**options)
    _check_callable(progress)
    depths = whole("first_depth", first_depth), whole("last_depth", last_depth)
    view = _view_of(points, normals, colors, scalars, labels, sensor, sensors, sensor_of)
    return [Mesh._of(*made) for made in _core.reconstruct_levels(view, *depths, known, progress)]


def compare(
    a: Union[Mesh, Points, npt.ArrayLike], b: Union[Mesh, Points, npt.ArrayLike], *, samples: int = 200000
) -> dict[str, Any]:
    """How far two meshes or clouds are apart: ``a_to_b``, ``b_to_a``, ``hausdorff`` and the ``diagonal`` of both.

    Each way has ``max``, ``mean``, ``rms``, ``median``, ``p95`` and ``p99`` of the distances of all points of a cloud,
    or of ``samples`` points spread over a mesh, from the other. Raises CloudError, OptionError.
    """
    count = whole("samples", samples)
    if count < 1:
        raise OptionError(f"samples {count}: must be above 0")
    return _core.compare(_polygons_of("a", a), _polygons_of("b", b), count)


def _check_callable(progress: object) -> None:
    if progress is not None and not callable(progress):
        raise TypeError(f"progress: a callable is wanted, {type(progress).__name__} came")


def _polygons_of(name: str, given: Union[Mesh, Points, npt.ArrayLike]) -> _core.Polygons:
    if isinstance(given, Mesh):
        return given._polygons
    positions = given.positions if isinstance(given, Points) else _arrays.vectors(name, given)
    return Mesh(positions, ())._polygons


def _view_of(
    points: Union[npt.ArrayLike, Points],
    normals: Optional[npt.ArrayLike],
    colors: Optional[npt.ArrayLike],
    scalars: Optional[Mapping[str, npt.ArrayLike]],
    labels: Optional[Mapping[str, npt.ArrayLike]],
    sensor: Optional[Sequence[float]],
    sensors: Optional[npt.ArrayLike],
    sensor_of: Optional[npt.ArrayLike],
) -> _core.View:
    numbers, marks = dict(scalars or {}), dict(labels or {})
    read_numbers: Mapping[str, npt.NDArray[np.float64]] = {}
    read_marks: Mapping[str, npt.NDArray[np.float64]] = {}
    file: Optional[_core.Cloud] = None
    if isinstance(points, Points):
        normals = points.normals if normals is None else normals
        colors = points.colors if colors is None else colors
        if sensor is None and sensors is None:
            sensor, sensors, sensor_of = points.sensor, points.sensors, points.sensor_of
        given = {**numbers, **marks}
        read_numbers = {name: values for name, values in points.scalars.items() if name not in given}
        read_marks = {name: values for name, values in points.labels.items() if name not in given}
        file = points._cloud
        points = points.positions
    positions = _arrays.vectors("points", points)
    rows = len(positions)
    view = _core.View(
        positions,
        None if normals is None else _arrays.vectors("normals", normals, rows),
        None if colors is None else _arrays.colors(colors, rows),
        None if sensor is None else _arrays.place("sensor", sensor),
        None if sensors is None else _arrays.vectors("sensors", sensors).tolist(),
        None if sensor_of is None else _arrays.labels("sensor_of", sensor_of, rows).astype(np.int32),
    )
    if file is not None:
        view.note_file(file)
    for name, values in numbers.items():
        view.add_scalar(_arrays.property_name(name), _arrays.scalars(f"scalars {name}", values, rows), False)
    for name, values in read_numbers.items():
        view.add_scalar(os.fsencode(name), values, False)
    for name, values in read_marks.items():
        view.add_scalar(os.fsencode(name), values, True)
    for name, values in marks.items():
        view.add_scalar(_arrays.property_name(name), _arrays.labels(f"labels {name}", values, rows), True)
    return view
