"""Points in Blender: a mesh of vertices alone, with what a scan says of each as attributes.

Blender's coordinates are floats. A cloud far from the origin is therefore moved beside it by a shift, which is kept in
doubles in the object's property `hsdm_shift`: the coordinates of the file are the object's own plus the shift.
"""

from dataclasses import dataclass, field
from typing import Optional

import bpy
import numpy as np

SHIFT = "hsdm_shift"
NORMAL = "hsdm_normal"
COLOR = "Color"
_SENSORS = "hsdm_sensors"
_SENSOR_OF = "hsdm_sensor_of"

# Floats have 24 bits: a cloud within so many of its diagonals of the origin is rounded by at most a millionth of one.
_NEAR = 16.0

# What Blender has under these names is something else, and it does not give them away.
_TAKEN = frozenset(("position", "normal", "material_index", "shade_smooth", "crease", "id", "radius"))


@dataclass
class Cloud:
    """Points near the origin, with all that is known of each: the arguments of hsdm.reconstruct."""

    positions: np.ndarray
    normals: Optional[np.ndarray] = None
    colors: Optional[np.ndarray] = None
    scalars: dict = field(default_factory=dict)
    labels: dict = field(default_factory=dict)
    sensors: Optional[np.ndarray] = None
    sensor_of: Optional[np.ndarray] = None
    shift: Optional[tuple] = None

    def arguments(self):
        names = ("normals", "colors", "scalars", "labels")
        made = {"points": self.positions, **{name: getattr(self, name) for name in names}}
        if self.sensor_of is not None:
            return {**made, "sensors": self.sensors, "sensor_of": self.sensor_of}
        return {**made, "sensor": None if self.sensors is None else self.sensors[0]}


def cloud_of_points(points, shifts):
    """The Cloud of what hsdm.read_points returned; see shift_for."""
    positions = points.positions
    sensors = points.sensors
    if sensors is None and points.sensor is not None:
        sensors = np.array([points.sensor])
    shift = shift_for(positions[np.isfinite(positions).all(axis=1)], shifts)
    if shift is not None:
        positions = positions - shift
        sensors = None if sensors is None else sensors - shift
    # Numbers from 2^31 on become negative: labels stay apart.
    labels = {name: values.astype(np.int64).astype(np.int32) for name, values in points.labels.items()}
    return Cloud(positions, points.normals, points.colors, points.scalars, labels, sensors, points.sensor_of, shift)


def finite_part(cloud):
    """The cloud without the points that have no finite coordinates, which Blender could not show."""
    finite = np.isfinite(cloud.positions).all(axis=1)
    if finite.all():
        return cloud

    def kept(values):
        return None if values is None else values[finite]

    return Cloud(
        kept(cloud.positions),
        kept(cloud.normals),
        kept(cloud.colors),
        {name: kept(values) for name, values in cloud.scalars.items()},
        {name: kept(values) for name, values in cloud.labels.items()},
        cloud.sensors,
        kept(cloud.sensor_of),
        cloud.shift,
    )


def known_shifts():
    """The shifts that objects of this file have."""
    return [tuple(one[SHIFT]) for one in bpy.data.objects if SHIFT in one]


def shift_for(positions, shifts):
    """What to move these points by, or None where floats can tell them apart well enough as they are.

    One of `shifts`, those that other objects have, is taken if it will do: then both lie as they do in their files.
    """
    if len(positions) == 0:
        return None
    low, high = positions.min(axis=0), positions.max(axis=0)
    reach = _NEAR * max(float(np.linalg.norm(high - low)), np.finfo(np.float64).tiny)

    def is_near(shift):
        return max(np.abs(low - shift).max(), np.abs(high - shift).max()) <= reach

    if is_near(np.zeros(3)):
        return None
    for shift in shifts:
        if is_near(np.array(shift)):
            return shift
    # A round number, that people can read and type.
    step = 10.0 ** np.floor(np.log10(reach / _NEAR))
    return tuple((np.round((low + high) / 2 / step) * step).tolist())


def add_cloud(name, cloud, collection):
    """A new object of these points, in the collection."""
    mesh = bpy.data.meshes.new(name)
    mesh.vertices.add(len(cloud.positions))
    set_vectors(mesh.vertices, "co", cloud.positions)
    if cloud.normals is not None:
        add_attribute(mesh, NORMAL, "FLOAT_VECTOR", cloud.normals)
    if cloud.colors is not None:
        add_colors(mesh, cloud.colors)
    for label, values in cloud.scalars.items():
        add_attribute(mesh, label, "FLOAT", values)
    for label, values in cloud.labels.items():
        add_attribute(mesh, label, "INT", values)
    if cloud.sensors is not None:
        mesh[_SENSORS] = cloud.sensors.reshape(-1).tolist()
    if cloud.sensor_of is not None:
        add_attribute(mesh, _SENSOR_OF, "INT", cloud.sensor_of)
    mesh.update()
    made = bpy.data.objects.new(name, mesh)
    if cloud.shift is not None:
        made[SHIFT] = list(cloud.shift)
    collection.objects.link(made)
    return made


def cloud_of_object(owner, depsgraph):
    """The points of an object, as its modifiers leave them, in its own coordinates."""
    evaluated = owner.evaluated_get(depsgraph)
    mesh = evaluated.to_mesh()
    try:
        return _cloud_of_mesh(mesh, owner)
    finally:
        evaluated.to_mesh_clear()


def _cloud_of_mesh(mesh, owner):
    cloud = Cloud(get_numbers(mesh.vertices, "co", 3, np.float32))
    for attribute in mesh.attributes:
        if attribute.domain != "POINT" or attribute.name.startswith("."):
            continue
        if attribute.name == NORMAL and attribute.data_type == "FLOAT_VECTOR":
            cloud.normals = get_numbers(attribute.data, "vector", 3, np.float32)
        elif attribute.name == _SENSOR_OF and attribute.data_type == "INT":
            cloud.sensor_of = get_numbers(attribute.data, "value", 1, np.int32)
        elif attribute.data_type == "FLOAT" and not attribute.name.startswith("hsdm_"):
            cloud.scalars[attribute.name] = get_numbers(attribute.data, "value", 1, np.float32)
        elif attribute.data_type == "INT" and not attribute.name.startswith("hsdm_"):
            cloud.labels[attribute.name] = get_numbers(attribute.data, "value", 1, np.int32)
    cloud.colors = _colors_of(mesh)
    if _SENSORS in owner.data:
        cloud.sensors = np.array(owner.data[_SENSORS], np.float64).reshape(-1, 3)
    if SHIFT in owner:
        cloud.shift = tuple(owner[SHIFT])
    return cloud


def _colors_of(mesh):
    """Colours of the vertices: those shown, else the first ones."""
    found = [one for one in mesh.color_attributes if one.domain == "POINT"]
    if not found:
        return None
    shown = mesh.color_attributes.active_color
    chosen = next((one for one in found if shown is not None and one.name == shown.name), found[0])
    if chosen.data_type != "BYTE_COLOR":
        return np.clip(get_numbers(chosen.data, "color", 4, np.float32), 0, 1)
    # Bytes are what the scan had; their linear values would be other numbers.
    return np.rint(255 * get_numbers(chosen.data, "color_srgb", 4, np.float32)).astype(np.uint8)


def add_attribute(mesh, name, kind, values):
    """A number or a vector for each vertex; a name that Blender keeps for itself gets `scan_` before it."""
    free = f"scan_{name}" if name in _TAKEN or not name or name.startswith(".") else name
    attribute = mesh.attributes.new(free, kind, "POINT")
    wanted = np.int32 if kind == "INT" else np.float32
    field_name = "vector" if kind == "FLOAT_VECTOR" else "value"
    attribute.data.foreach_set(field_name, np.ascontiguousarray(values, wanted).reshape(-1))
    return attribute


def add_colors(mesh, colors):
    """Bytes of red, green, blue and alpha for each vertex."""
    made = mesh.color_attributes.new(name=COLOR, type="BYTE_COLOR", domain="POINT")
    made.data.foreach_set("color_srgb", (colors.astype(np.float32) / 255).reshape(-1))
    mesh.color_attributes.active_color = made


def set_vectors(items, name, values):
    items.foreach_set(name, np.ascontiguousarray(values, np.float32).reshape(-1))


def get_numbers(items, name, columns, kind):
    numbers = np.empty(len(items) * columns, kind)
    items.foreach_get(name, numbers)
    return numbers if columns == 1 else numbers.reshape(-1, columns)
