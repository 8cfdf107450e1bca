"""Scans that tests share, from seeds, and Blender as tests want it."""

import os
import struct
import sys
import unittest

import bpy
import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
from box_scan import scan_of_box


def scan_of_bowl(points=12000, seed=1):
    """Points and outward normals of a sphere of radius 1, but for what is above 0.6."""
    random = np.random.default_rng(seed)
    places = random.normal(size=(points, 3))
    places /= np.linalg.norm(places, axis=1)[:, None]
    places = places[places[:, 2] < 0.6]
    return places, places


def path_of(name):
    """A file that is removed with the test's home."""
    return os.path.join(os.environ["HSDM_TEST_HOME"], name)


def write_table(name, *columns):
    """A text file of these columns, side by side; its path."""
    path = path_of(name)
    np.savetxt(path, np.column_stack(columns), fmt="%.17g")
    return path


def write_las(name, places, withheld):
    """LAS 1.2, point format 0, steps of a thousandth; its path. The points of these numbers are marked as withheld."""
    head = bytearray(227)
    head[0:4], head[24:26] = b"LASF", b"\x01\x02"
    struct.pack_into("<HIIBHI", head, 94, 227, 227, 0, 0, 20, len(places))
    struct.pack_into("<3d", head, 131, *[0.001] * 3)
    path = path_of(name)
    with open(path, "wb") as file:
        file.write(head)
        for i, place in enumerate(places):
            steps = [round(1000 * x) for x in place]
            file.write(struct.pack("<iiiHBBbBH", *steps, 0, 9, 128 * (i in withheld), 0, 0, 0))
    return path


def numbers(items, name, columns=1, kind=np.float32):
    """What foreach_get has of items."""
    values = np.empty(len(items) * columns, kind)
    items.foreach_get(name, values)
    return values if columns == 1 else values.reshape(-1, columns)


def attribute(owner, name, kind=np.float32):
    """An attribute of vertices, a number each."""
    found = owner.data.attributes[name]
    assert found.domain == "POINT"
    return numbers(found.data, "value", 1, kind)


class BlenderTest(unittest.TestCase):
    """Each test begins with an empty scene and the options as they are at first."""

    def setUp(self):
        if bpy.context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        for owner in list(bpy.data.objects):
            bpy.data.objects.remove(owner)
        for name in self.options.bl_rna.properties.keys():
            if name not in ("rna_type", "name"):
                self.options.property_unset(name)

    @property
    def options(self):
        return bpy.context.scene.hsdm

    def add_points(self, points, normals=None):
        """An object of these points, active."""
        from hsdm_blender import clouds

        owner = clouds.add_cloud("scan", clouds.Cloud(points, normals), bpy.context.collection)
        bpy.context.view_layer.objects.active = owner
        return owner

    def reconstruct(self, **arguments):
        """The object that the operator makes."""
        self.assertEqual(bpy.ops.hsdm.reconstruct(**arguments), {"FINISHED"})
        return bpy.context.active_object

    def message(self, call, *arguments, **named):
        """What an operator says when it refuses."""
        with self.assertRaises(RuntimeError) as caught:
            call(*arguments, **named)
        return str(caught.exception)
