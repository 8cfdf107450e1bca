"""Meshes of other packages, where these are installed."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from ._mesh import Mesh


def _package(name: str) -> Any:
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise ImportError(
            f"{name} is not installed, and to_{name}() makes one of its meshes; try: pip install {name}",
            name=name,
        ) from error


def _attributes(mesh: Mesh) -> dict[str, Any]:
    """Properties but the channels of colours, in arrays that may be written to."""
    channels = ("red", "green", "blue", "alpha") if mesh.colors is not None else ()
    return {name: np.array(values) for name, values in mesh.properties.items() if name not in channels}


def to_trimesh(mesh: Mesh) -> Any:
    """See Mesh.to_trimesh."""
    trimesh = _package("trimesh")
    return trimesh.Trimesh(
        vertices=np.array(mesh.vertices),
        faces=mesh.triangulated().astype(np.int64),
        vertex_normals=None if mesh.normals is None else np.array(mesh.normals),
        vertex_colors=None if mesh.colors is None else np.array(mesh.colors),
        vertex_attributes=_attributes(mesh),
        process=False,  # which would merge and renumber vertices
    )


def to_pyvista(mesh: Mesh) -> Any:
    """See Mesh.to_pyvista."""
    pyvista = _package("pyvista")
    # Each face is its number of vertices and then these.
    faces = np.insert(mesh.face_vertices.astype(np.int64), mesh.face_offsets[:-1].astype(np.int64), mesh.face_sizes)
    made = pyvista.PolyData(np.array(mesh.vertices), faces)
    for name, values in _attributes(mesh).items():
        made.point_data[name] = values.reshape(len(values), -1) if values.ndim > 1 else values
    if mesh.normals is not None:
        made.point_data["Normals"] = np.array(mesh.normals)
    if mesh.colors is not None:
        made.point_data["colors"] = np.array(mesh.colors)
    return made


def to_meshio(mesh: Mesh) -> Any:
    """See Mesh.to_meshio."""
    meshio = _package("meshio")
    names = {3: "triangle", 4: "quad"}
    cells = []
    for size in np.unique(mesh.face_sizes).tolist():
        cells.append((names.get(size, "polygon"), mesh.faces_of_size(size).astype(np.int64)))
    data = {name: values.reshape(len(values), -1) if values.ndim > 1 else values
            for name, values in _attributes(mesh).items()}
    if mesh.normals is not None:
        data["normals"] = np.array(mesh.normals)
    if mesh.colors is not None:
        data["colors"] = np.array(mesh.colors)
    return meshio.Mesh(np.array(mesh.vertices), cells, point_data=data)
