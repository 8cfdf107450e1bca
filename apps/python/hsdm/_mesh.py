"""The mesh that hsdm returns."""

from __future__ import annotations

import json
import os
from functools import cached_property
from typing import Any, Iterator, Mapping, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _arrays, _convert, _core
from ._errors import OptionError

_NORMALS = "hsdm_normals"
_COMPONENTS = tuple(f"{_NORMALS}_{normal}_{axis}" for normal in range(3) for axis in "xyz")
_COLORS = ("red", "green", "blue", "alpha")
_SMALL = (np.dtype(np.uint8), np.dtype(np.int32), np.dtype(np.float32))


class Mesh:
    """Polygons over shared vertices, mostly quads and triangles, with their properties.

    Nothing changes a mesh once it is made: arrays are read-only views of its memory, which live as long as
    any of them does. To change one, copy it and make a new mesh.

    Face ``f`` has the vertices ``face_vertices[face_offsets[f]:face_offsets[f + 1]]``, counterclockwise seen
    from outside.
    """

    def __init__(
        self,
        vertices: npt.ArrayLike,
        face_vertices: npt.ArrayLike,
        face_offsets: Optional[npt.ArrayLike] = None,
        *,
        normals: Optional[npt.ArrayLike] = None,
        sharp_edges: Optional[npt.ArrayLike] = None,
        properties: Optional[Mapping[str, npt.ArrayLike]] = None,
        report: Optional[Mapping[str, Any]] = None,
    ) -> None:
        """A mesh of arrays of one's own, which are copied.

        ``face_vertices`` has a row of vertices for each face, or is one row of all with ``face_offsets`` saying
        where each begins, and at the end how many there are. ``properties`` are numbers for each vertex by name:
        uint8, int32 and float32 are kept as such, others become float64. Raises ValueError for arrays that do not
        fit each other and indices that lead nowhere, TypeError for other kinds of arrays.
        """
        places = np.ascontiguousarray(_arrays.vectors("vertices", vertices), np.float64)
        corners, first = _facets(face_vertices, face_offsets)
        directions = np.zeros((0, 3)) if normals is None else _arrays.vectors("normals", normals, len(places))
        edges = _arrays.indices("sharp_edges", () if sharp_edges is None else sharp_edges, 2)
        self._polygons = _core.Polygons(
            places,
            corners,
            first,
            np.ascontiguousarray(directions, np.float64),
            edges,
            _split_properties(properties or {}, len(places)),
        )
        self._report = json.dumps(dict(report or {}))

    @classmethod
    def _of(cls, polygons: _core.Polygons, report: str = "{}") -> Mesh:
        mesh = cls.__new__(cls)
        mesh._polygons = polygons
        mesh._report = report
        return mesh

    def __repr__(self) -> str:
        return f"<hsdm.Mesh: {len(self.vertices):,} vertices, {self.face_count:,} faces>"

    def __reduce__(self) -> tuple[Any, ...]:
        normals = None if self.normals is None else np.array(self.normals)
        state = (np.array(self.vertices), np.array(self.face_vertices), np.array(self.face_offsets), normals)
        properties = {name: np.array(values) for name, values in self.properties.items()}
        return _unpickled, (*state, np.array(self.sharp_edges), properties, self._report)

    @cached_property
    def vertices(self) -> npt.NDArray[np.float64]:
        """Positions, ``n x 3``, in the cloud's units."""
        return self._polygons.positions

    @cached_property
    def face_offsets(self) -> npt.NDArray[np.uint32]:
        """Where each face begins in ``face_vertices``, and at the end its length: one more than there are faces."""
        return self._polygons.first

    @cached_property
    def face_vertices(self) -> npt.NDArray[np.uint32]:
        """The vertices of all faces, one face after the other."""
        return self._polygons.corners

    @property
    def face_count(self) -> int:
        """Number of faces."""
        return len(self.face_offsets) - 1

    @cached_property
    def face_sizes(self) -> npt.NDArray[np.uint32]:
        """How many vertices each face has."""
        return _read_only(np.diff(self.face_offsets))

    def faces(self) -> Iterator[npt.NDArray[np.uint32]]:
        """The vertices of each face, in order; for loops over few faces, the arrays are faster."""
        for begin, end in zip(self.face_offsets[:-1], self.face_offsets[1:]):
            yield self.face_vertices[begin:end]

    def faces_of_size(self, size: int) -> npt.NDArray[np.uint32]:
        """The faces of so many vertices, a row each, in order."""
        begins = self.face_offsets[:-1][self.face_sizes == size]
        rows: npt.NDArray[np.uint32] = self.face_vertices[begins[:, None].astype(np.intp) + np.arange(size)]
        return rows

    @cached_property
    def quads(self) -> npt.NDArray[np.uint32]:
        """The faces of four vertices, ``q x 4``."""
        return _read_only(self.faces_of_size(4))

    @cached_property
    def triangles(self) -> npt.NDArray[np.uint32]:
        """The faces of three vertices, ``t x 3``; for all faces as triangles see `triangulated`."""
        return _read_only(self.faces_of_size(3))

    def triangulated(self) -> npt.NDArray[np.uint32]:
        """All faces cut into triangles, ``m x 3``, face by face: quads along their shorter diagonal."""
        return self._polygons.triangles()

    @cached_property
    def normals(self) -> Optional[npt.NDArray[np.float64]]:
        """Unit normals of the vertices, ``n x 3``, or None. On a sharp edge the mean; see `crease_normals`."""
        normals = self._polygons.normals
        return normals if len(normals) == len(self.vertices) and len(normals) > 0 else None

    @cached_property
    def sharp_edges(self) -> npt.NDArray[np.uint32]:
        """The sharp edges, ``k x 2`` vertices, the lower first."""
        return self._polygons.sharp_edges

    @cached_property
    def properties(self) -> dict[str, npt.NDArray[Any]]:
        """Numbers of each vertex by name: ``hsdm_vertex_class``, ``hsdm_level``, scalars of the cloud and so on."""
        given = self._polygons.properties()
        if all(name in given for name in _COMPONENTS):
            parts = [given.pop(name) for name in _COMPONENTS]
            given[_NORMALS] = _read_only(np.stack(parts, axis=1).reshape(-1, 3, 3))
        return given

    @property
    def vertex_classes(self) -> Optional[npt.NDArray[np.uint8]]:
        """0 on a smooth surface, 1 on a sharp edge, 2 at a corner; None if they were not asked for."""
        return self.properties.get("hsdm_vertex_class")

    @property
    def crease_normals(self) -> Optional[npt.NDArray[np.float32]]:
        """One to three unit normals of each vertex, ``n x 3 x 3``, those beyond its ``hsdm_normal_count`` zero."""
        return self.properties.get(_NORMALS)

    @cached_property
    def colors(self) -> Optional[npt.NDArray[np.uint8]]:
        """Red, green, blue and alpha of each vertex, ``n x 4`` bytes: means of the points' colours; or None."""
        if not all(name in self.properties for name in _COLORS[:3]):
            return None
        opaque = np.full(len(self.vertices), 255, np.uint8)
        channels = [self.properties.get(name, opaque) for name in _COLORS]
        return _read_only(np.stack(channels, axis=1).astype(np.uint8))

    @property
    def confidence(self) -> Optional[npt.NDArray[Any]]:
        """How much of the surface around a vertex points show, 0 to 1; None without the option ``confidence``."""
        return self.properties.get("hsdm_confidence")

    @property
    def completed(self) -> Optional[npt.NDArray[np.uint8]]:
        """1 for vertices that no point showed; None but with ``holes="complete"``."""
        return self.properties.get("hsdm_completed")

    @cached_property
    def report(self) -> dict[str, Any]:
        """What the reconstruction did: counts, errors, warnings, seconds; the keys are in docs/command.md."""
        report: dict[str, Any] = json.loads(self._report)
        return report

    def topology(self) -> dict[str, Any]:
        """Counts of edges, components, boundary loops, ``euler``, ``genus``, ``closed``, ``signed_volume`` ..."""
        return _core.topology(self._polygons)

    def digest(self) -> str:
        """16 hexadecimal digits that stand for all bits of positions and faces, as the report's ``mesh.digest``."""
        return self._polygons.digest()

    def process(self, *stages: str) -> Mesh:
        """The mesh that stages leave, which run in the order given: ``mesh.process("decimate:facets=500")``.

        They are those of ``python -m hsdm stages``. What each did is appended to the report's ``stages``; its
        other parts stay those of the mesh before. Raises OptionError for what no stage is or takes, CloudError for a
        mesh that is no 2-manifold.
        """
        polygons, summaries = _core.process(self._polygons, [os.fsencode(stage) for stage in stages])
        report = json.loads(self._report)
        done = [{"call": call, "summary": summary} for call, summary in zip(stages, summaries)]
        report["stages"] = report.get("stages", []) + done
        return Mesh._of(polygons, json.dumps(report))

    def write(
        self,
        path: Union[str, "os.PathLike[str]"],
        *,
        ascii: bool = False,
        units: Optional[str] = None,
        recentre: bool = False,
    ) -> tuple[float, float, float]:
        """Writes an OFF, STL, PLY, OBJ, .om, GLB or 3MF file, as the extension says; STL, GLB and 3MF get triangles.

        PLY and .om hold the properties, .om the sharp edges too. Either the whole file is there afterwards or the
        old one still is.

        ascii: PLY and STL as text.
        units: what lengths are in, "mm", "cm", "m" or "in": GLB is scaled to metres by it, 3MF says it (without, mm
            are taken), other formats have no place for it.
        recentre: coordinates less a shift, so that a mesh far from the origin lies round it.

        Returns the shift, to be added to the file's coordinates for the mesh's own; zeros without ``recentre``.
        Raises FileError, OptionError for other units.
        """
        if units is not None and units not in _core.length_units:
            raise OptionError(f"units {units!r}: must be None or one of {', '.join(_core.length_units)}")
        return self._polygons.write(os.fsencode(path), bool(ascii), units or "", bool(recentre))

    def to_trimesh(self) -> Any:
        """A trimesh.Trimesh of the faces as triangles; vertices keep their numbers, normals and colours."""
        return _convert.to_trimesh(self)

    def to_pyvista(self) -> Any:
        """A pyvista.PolyData of the faces as they are, with the properties as point data."""
        return _convert.to_pyvista(self)

    def to_meshio(self) -> Any:
        """A meshio.Mesh with a block of cells for each size of faces, and the properties as point data."""
        return _convert.to_meshio(self)


def _unpickled(
    vertices: npt.NDArray[np.float64],
    face_vertices: npt.NDArray[np.uint32],
    face_offsets: npt.NDArray[np.uint32],
    normals: Optional[npt.NDArray[np.float64]],
    sharp_edges: npt.NDArray[np.uint32],
    properties: dict[str, npt.NDArray[Any]],
    report: str,
) -> Mesh:
    mesh = Mesh(
        vertices, face_vertices, face_offsets, normals=normals, sharp_edges=sharp_edges, properties=properties
    )
    mesh._report = report
    return mesh


def _read_only(array: npt.NDArray[Any]) -> npt.NDArray[Any]:
    array.setflags(write=False)
    return array


def _facets(
    face_vertices: npt.ArrayLike, face_offsets: Optional[npt.ArrayLike]
) -> tuple[npt.NDArray[np.uint32], npt.NDArray[np.uint32]]:
    """All faces' vertices in a row, and where each face begins."""
    if face_offsets is not None:
        return _arrays.indices("face_vertices", face_vertices), _arrays.indices("face_offsets", face_offsets)
    rows = np.asarray(face_vertices)
    if rows.size == 0:
        return np.zeros(0, np.uint32), np.zeros(1, np.uint32)
    if rows.ndim != 2:
        raise ValueError(
            f"face_vertices: shape {rows.shape} came; a row for each face, or face_offsets beside them, are wanted"
        )
    size = rows.shape[1]
    return _arrays.indices("face_vertices", rows, size).reshape(-1), np.arange(
        0, rows.size + 1, size, dtype=np.uint32
    )


def _split_properties(given: Mapping[str, npt.ArrayLike], vertices: int) -> dict[bytes, npt.NDArray[Any]]:
    """Properties as the library has them, each a number for each vertex."""
    split: dict[bytes, npt.NDArray[Any]] = {}
    for name, values in given.items():
        array = np.asarray(values)
        if name == _NORMALS and array.shape == (vertices, 3, 3):
            parts = array.reshape(vertices, 9).astype(np.float32)
            split.update({os.fsencode(part): np.ascontiguousarray(parts[:, i]) for i, part in enumerate(_COMPONENTS)})
            continue
        column = _arrays.scalars(f"property {name}", array, vertices)
        split[_arrays.property_name(name)] = np.ascontiguousarray(column, column.dtype if column.dtype in _SMALL else np.float64)
    return split
