"""Points from files."""

import numpy as np

import bpy
import scans
from scans import attribute, numbers


class ImportTest(scans.BlenderTest):
    def imported(self, path, **arguments):
        self.assertEqual(bpy.ops.hsdm.import_points(filepath=path, **arguments), {"FINISHED"})
        return bpy.context.active_object

    def test_points_become_vertices_with_normals_and_colours(self):
        points, normals = scans.scan_of_box(500)
        colors = np.random.default_rng(2).integers(0, 256, (500, 3))
        owner = self.imported(scans.write_table("box.xyz", points, normals, colors))
        self.assertEqual(owner.name, "box")
        self.assertTrue(owner.select_get())
        self.assertEqual((len(owner.data.edges), len(owner.data.polygons)), (0, 0))
        np.testing.assert_array_equal(numbers(owner.data.vertices, "co", 3), points.astype(np.float32))
        np.testing.assert_array_equal(numbers(owner.data.attributes["hsdm_normal"].data, "vector", 3), normals)
        bytes_ = np.rint(255 * numbers(owner.data.color_attributes["Color"].data, "color_srgb", 4))
        np.testing.assert_array_equal(bytes_[:, :3], colors)

    def test_further_numbers_become_attributes_whatever_their_names(self):
        path = scans.path_of("named.ply")
        with open(path, "w") as file:
            file.write("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                       "property float intensity\nproperty float radius\nproperty float position\nend_header\n"
                       "0 0 0 0.5 1 4\n1 0 0 1.5 2 5\n0 1 0 2.5 3 6\n")
        owner = self.imported(path)
        np.testing.assert_array_equal(attribute(owner, "intensity"), [0.5, 1.5, 2.5])
        np.testing.assert_array_equal(attribute(owner, "scan_radius"), [1, 2, 3])
        np.testing.assert_array_equal(attribute(owner, "scan_position"), [4, 5, 6])

    def test_every_format_of_the_package_is_offered(self):
        import hsdm

        self.assertIn("ply", hsdm.point_formats)
        points, _ = scans.scan_of_box(50)
        ends = "".join(f"v {x} {y} {z}\n" for x, y, z in points)
        with open(scans.path_of("cloud.obj"), "w") as file:
            file.write(ends)
        self.assertEqual(len(self.imported(scans.path_of("cloud.obj")).data.vertices), 50)

    def test_where_the_scanner_stood_turns_the_normals(self):
        random = np.random.default_rng(3)
        sheet = np.column_stack([random.uniform(-1, 1, (4000, 2)), np.zeros(4000)])
        for height in (5, -5):
            head = (f"VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 4000\nHEIGHT 1\n"
                    f"VIEWPOINT 0 0 {height} 1 0 0 0\nPOINTS 4000\nDATA ascii\n")
            path = scans.path_of("sheet.pcd")
            with open(path, "w") as file:
                file.write(head + "".join("%.9g %.9g %.9g\n" % tuple(place) for place in sheet))
            self.imported(path)
            self.assertEqual(bpy.ops.hsdm.reconstruct(), {"FINISHED"})
            normals = numbers(bpy.context.active_object.data.polygons, "normal", 3)
            self.assertTrue((normals[:, 2] * height > 0).all())

    def test_several_files_become_an_object_each_and_a_bad_one_stops_none(self):
        points, _ = scans.scan_of_box(50)
        for name in ("one.xyz", "two.xyz"):
            scans.write_table(name, points)
        files = [{"name": name} for name in ("one.xyz", "absent.xyz", "two.xyz")]
        said = self.message(bpy.ops.hsdm.import_points, directory=scans.path_of(""), files=files)
        self.assertIn("absent.xyz", said)
        self.assertEqual(sorted(owner.name for owner in bpy.data.objects), ["one", "two"])

    def test_bad_files_are_refused_with_place_and_reason(self):
        with open(scans.path_of("bad.xyz"), "w") as file:
            file.write("0 0 0\n1 one 1\n")
        self.assertIn("bad.xyz:2: ", self.message(bpy.ops.hsdm.import_points, filepath=scans.path_of("bad.xyz")))
        self.assertIn("absent.ply", self.message(bpy.ops.hsdm.import_points, filepath=scans.path_of("absent.ply")))
        self.assertEqual(len(bpy.data.objects), 0)

    def test_clouds_far_from_the_origin_keep_their_shape_and_their_shift(self):
        points, _ = scans.scan_of_box(500)
        far = np.array([3512345.25, 5401234.5, 412.0])
        first = self.imported(scans.write_table("far.xyz", points + far))
        shift = np.array(first["hsdm_shift"])
        places = numbers(first.data.vertices, "co", 3).astype(np.float64) + shift
        self.assertLess(np.abs(places - (points + far)).max(), 1e-6)
        self.assertLess(np.abs(places - shift).max(), 10)
        # A second one of the same place is moved by the same: both lie as in their files.
        second = self.imported(scans.write_table("beside.xyz", points + far + [3, 0, 0]))
        np.testing.assert_array_equal(np.array(second["hsdm_shift"]), shift)
        near = self.imported(scans.write_table("near.xyz", points + 10))
        self.assertNotIn("hsdm_shift", near)

    def test_points_that_a_las_file_marks_as_withheld_are_told(self):
        import hsdm
        from hsdm_blender import operators

        points, _ = scans.scan_of_box(500)
        path = scans.write_las("box.las", points, {3, 4, 499})
        owner = self.imported(path)
        self.assertEqual(len(owner.data.vertices), 497)
        self.assertEqual(
            operators._said_of(owner, hsdm.read_points(path)),
            "box: 497 points, 3 that the file marks as withheld left out",
        )

    def test_points_that_are_not_finite_are_left_out(self):
        points, normals = scans.scan_of_box(500)
        points[7, 1] = np.nan
        owner = self.imported(scans.write_table("nan.xyz", points, normals))
        self.assertEqual(len(owner.data.vertices), 499)
        normals_read = numbers(owner.data.attributes["hsdm_normal"].data, "vector", 3)
        np.testing.assert_array_equal(normals_read, np.delete(normals, 7, axis=0))
