"""What hsdm returns as a mesh of Blender: facets as they are, sharp edges marked, numbers of vertices as attributes."""

import json

import bpy
import numpy as np

from . import clouds

CLASS = "hsdm_class"
CONFIDENCE = "hsdm_confidence"
COMPLETED = "hsdm_completed"
REPORT = "hsdm_report"
SOURCE = "hsdm_source"  # name of the object of the points

_COLORS = ("red", "green", "blue", "alpha")


def add_mesh(name, made, shift, crease):
    """A new object of a reconstruction, in no collection yet; `crease` also gives sharp edges a crease of 1."""
    mesh = bpy.data.meshes.new(name)
    _set_facets(mesh, made)
    _mark_sharp(mesh, made, crease)
    _add_properties(mesh, made)
    new = bpy.data.objects.new(name, mesh)
    new[REPORT] = json.dumps(made.report)
    if shift is not None:
        new[clouds.SHIFT] = list(shift)
    return new


def _set_facets(mesh, made):
    mesh.vertices.add(len(made.vertices))
    clouds.set_vectors(mesh.vertices, "co", made.vertices)
    mesh.loops.add(len(made.face_vertices))
    mesh.loops.foreach_set("vertex_index", made.face_vertices.astype(np.int32))
    mesh.polygons.add(made.face_count)
    mesh.polygons.foreach_set("loop_start", made.face_offsets[:-1].astype(np.int32))
    mesh.polygons.foreach_set("loop_total", made.face_sizes.astype(np.int32))
    mesh.polygons.foreach_set("use_smooth", np.ones(made.face_count, bool))
    mesh.update(calc_edges=True)


def _mark_sharp(mesh, made, crease):
    """Marks the sharp edges; where they are, and nowhere else, shading has a crease."""
    mesh.use_auto_smooth = True
    mesh.auto_smooth_angle = np.pi
    ends = np.sort(clouds.get_numbers(mesh.edges, "vertices", 2, np.int32), axis=1).astype(np.int64)
    sharp = np.sort(made.sharp_edges, axis=1).astype(np.int64)
    count = len(made.vertices)
    is_sharp = np.isin(ends[:, 0] * count + ends[:, 1], sharp[:, 0] * count + sharp[:, 1])
    mesh.edges.foreach_set("use_edge_sharp", is_sharp)
    if crease:
        mesh.edges.foreach_set("crease", is_sharp.astype(np.float32))


def _add_properties(mesh, made):
    for name, values in made.properties.items():
        if values.ndim != 1 or (name in _COLORS and made.colors is not None):
            continue
        kind = "INT" if values.dtype.kind in "iu" else "FLOAT"
        clouds.add_attribute(mesh, CLASS if name == "hsdm_vertex_class" else name, kind, values)
    if made.colors is not None:
        clouds.add_colors(mesh, made.colors)


def doubtful(mesh, least):
    """Which vertices of a mesh have less confidence than that or were completed; None where it knows of neither."""
    found = None
    for name, test in ((CONFIDENCE, lambda values: values < least), (COMPLETED, lambda values: values != 0)):
        attribute = mesh.attributes.get(name)
        if attribute is None or attribute.domain != "POINT":
            continue
        values = clouds.get_numbers(attribute.data, "value", 1, np.float32)
        found = test(values) if found is None else found | test(values)
    return found


def select(mesh, vertices):
    """Selects these vertices, with the edges and facets that have no others, outside of edit mode."""
    mesh.vertices.foreach_set("select", vertices)
    ends = clouds.get_numbers(mesh.edges, "vertices", 2, np.int32)
    mesh.edges.foreach_set("select", vertices[ends].all(axis=1))
    corners = clouds.get_numbers(mesh.loops, "vertex_index", 1, np.int32)
    starts = clouds.get_numbers(mesh.polygons, "loop_start", 1, np.int32)
    if len(starts):
        mesh.polygons.foreach_set("select", np.logical_and.reduceat(vertices[corners], starts))
    mesh.update()
