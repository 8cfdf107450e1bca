"""Meshes of points: what arrives in Blender, and where."""

import inspect
import json
import os
import re

import bpy
import hsdm
import numpy as np
import scans
from mathutils import Euler, Matrix, Vector
from scans import attribute, numbers


def sharp_ends(mesh):
    """The two ends of each sharp edge, n x 2 x 3."""
    sharp = numbers(mesh.edges, "use_edge_sharp", 1, bool)
    return numbers(mesh.vertices, "co", 3)[numbers(mesh.edges, "vertices", 2, np.int32)[sharp]]


class ReconstructTest(scans.BlenderTest):
    def test_a_box_becomes_closed_quads_with_its_edges_sharp(self):
        size = np.array([2.0, 1.0, 1.5])
        self.add_points(*scans.scan_of_box(size=size))
        self.options.resolution, self.options.depth = "DEPTH", 4
        owner = self.reconstruct()
        mesh = owner.data
        self.assertFalse(mesh.validate())  # nothing to mend
        self.assertEqual(len(mesh.vertices) - len(mesh.edges) + len(mesh.polygons), 2)
        corners = numbers(mesh.loops, "edge_index", 1, np.int32)
        np.testing.assert_array_equal(np.bincount(corners), 2)  # two facets at each edge
        sizes = numbers(mesh.polygons, "loop_total", 1, np.int32)
        self.assertGreater(np.count_nonzero(sizes == 4), 0.95 * len(sizes))
        # Sharp edges lie on the box's twelve, and are as long together.
        ends = sharp_ends(mesh)
        at_side = np.abs(np.abs(ends) - size / 2) < 0.01
        self.assertTrue((at_side.sum(axis=2) >= 2).all())
        self.assertAlmostEqual(np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).sum(), 4 * size.sum(), delta=0.1)
        self.assertEqual(np.bincount(attribute(owner, "hsdm_class", np.int32))[2], 8)

    def test_facets_face_outward_and_shading_breaks_at_sharp_edges_alone(self):
        self.add_points(*scans.scan_of_box())
        mesh = self.reconstruct().data
        self.assertTrue(mesh.use_auto_smooth)
        self.assertTrue(numbers(mesh.polygons, "use_smooth", 1, bool).all())
        centres, normals = numbers(mesh.polygons, "center", 3), numbers(mesh.polygons, "normal", 3)
        self.assertTrue(((centres * normals).sum(axis=1) > 0).all())
        mesh.calc_normals_split()
        shaded = numbers(mesh.loops, "normal", 3)
        facet_of = np.repeat(np.arange(len(mesh.polygons)), numbers(mesh.polygons, "loop_total", 1, np.int32))
        self.assertGreater((shaded * normals[facet_of]).sum(axis=1).min(), 0.99)

    def test_few_facets_keep_an_error_and_all_their_corners(self):
        self.add_points(*scans.scan_of_box())
        self.options.resolution, self.options.error_share = "ERROR", 0.5
        owner = self.reconstruct()
        self.assertEqual(len(owner.data.polygons), 6)
        self.assertEqual(len(sharp_ends(owner.data)), 12)

    def test_facets_edges_and_vertices_are_those_of_the_package_bit_for_bit(self):
        points, normals = (array.astype(np.float32) for array in scans.scan_of_box())
        self.add_points(points, normals)
        self.options.resolution, self.options.depth = "DEPTH", 4
        mesh = self.reconstruct().data
        made = hsdm.reconstruct(points, normals, depth=4, crease_angle=self.options.crease_angle)
        np.testing.assert_array_equal(numbers(mesh.vertices, "co", 3), made.vertices.astype(np.float32))
        np.testing.assert_array_equal(numbers(mesh.loops, "vertex_index", 1, np.int32), made.face_vertices)
        np.testing.assert_array_equal(numbers(mesh.polygons, "loop_start", 1, np.int32), made.face_offsets[:-1])
        sharp = numbers(mesh.edges, "vertices", 2, np.int32)[numbers(mesh.edges, "use_edge_sharp", 1, bool)]
        ends = {frozenset(edge) for edge in sharp.tolist()}
        self.assertEqual(ends, {frozenset(edge) for edge in made.sharp_edges.tolist()})

    def test_facets_of_many_corners_stay_one(self):
        from hsdm_blender import meshes

        turn = np.arange(7) * 2 * np.pi / 7
        ring = np.column_stack([np.cos(turn), np.sin(turn), 0 * turn])
        walls = [corner for i in range(7) for corner in (i, (i + 1) % 7, 7 + (i + 1) % 7, 7 + i)]
        facets = [*range(6, -1, -1), *range(7, 14), *walls]
        offsets = [0, 7, *range(14, 43, 4)]
        prism = hsdm.Mesh(np.concatenate([ring, ring + [0, 0, 1]]), facets, offsets, sharp_edges=[(6, 0), (7, 8)])
        mesh = meshes.add_mesh("prism", prism, None, False).data
        self.assertFalse(mesh.validate())
        self.assertEqual(numbers(mesh.polygons, "loop_total", 1, np.int32).tolist(), [7, 7, *[4] * 7])
        self.assertEqual(len(sharp_ends(mesh)), 2)

    def test_numbers_and_colours_of_points_arrive_on_vertices(self):
        points, normals = scans.scan_of_box()
        owner = self.add_points(points, normals)
        from hsdm_blender import clouds

        clouds.add_attribute(owner.data, "height", "FLOAT", points[:, 2])
        clouds.add_attribute(owner.data, "side", "INT", np.where(points[:, 0] > 0, 5, 3))
        red = np.tile(np.array([[200, 10, 20, 255]], np.uint8), (len(points), 1))
        clouds.add_colors(owner.data, red)
        made = self.reconstruct()
        places = numbers(made.data.vertices, "co", 3)
        self.assertLess(np.abs(attribute(made, "height") - places[:, 2]).max(), 0.15)
        self.assertEqual(set(attribute(made, "side", np.int32)), {3, 5})
        shown = np.rint(255 * numbers(made.data.color_attributes["Color"].data, "color_srgb", 4))
        np.testing.assert_array_equal(shown, np.tile([200, 10, 20, 255], (len(shown), 1)))
        confidence = attribute(made, "hsdm_confidence")
        self.assertTrue((confidence >= 0).all() and (confidence <= 1).all() and confidence.mean() > 0.5)

    def test_the_mesh_lies_where_the_points_do_however_their_object_is_moved(self):
        points, normals = scans.scan_of_box()
        owner = self.add_points(points, normals)
        plain = numbers(self.reconstruct().data.vertices, "co", 3)
        owner.matrix_world = Matrix.LocRotScale(Vector((3, 4, 5)), Euler((0.3, 0.5, 0.7)), Vector((2, 2, 2)))
        bpy.context.view_layer.objects.active = owner
        bpy.context.view_layer.update()
        moved = self.reconstruct()
        np.testing.assert_array_equal(numbers(moved.data.vertices, "co", 3), plain)
        np.testing.assert_allclose(np.array(moved.matrix_world), np.array(owner.matrix_world), atol=1e-6)
        self.assertEqual(moved.users_collection, owner.users_collection)

    def test_a_mesh_is_made_anew_of_the_points_it_was_made_of_while_they_are_there(self):
        owner = self.add_points(*scans.scan_of_box())
        self.options.resolution, self.options.depth = "DEPTH", 3
        coarse = self.reconstruct()
        self.options.depth = 4
        fine = self.reconstruct()
        self.assertEqual(json.loads(fine["hsdm_report"])["input"]["points"], len(owner.data.vertices))
        bpy.context.view_layer.objects.active = coarse
        bpy.data.objects.remove(owner)
        self.options.depth = 2
        of_itself = self.reconstruct()
        self.assertEqual(json.loads(of_itself["hsdm_report"])["input"]["points"], len(coarse.data.vertices))

    def test_points_are_taken_as_modifiers_leave_them(self):
        owner = self.add_points(*scans.scan_of_box())
        owner.modifiers.new("moved", "DISPLACE").strength = 0.0
        owner.modifiers["moved"].mid_level = 0.0
        owner.modifiers["moved"].direction = "X"
        owner.modifiers["moved"].strength = 7.0
        places = numbers(self.reconstruct().data.vertices, "co", 3)
        self.assertAlmostEqual(float(places[:, 0].mean()), 7.0, delta=0.1)

    def test_a_file_gives_what_its_points_give_and_far_ones_their_shift(self):
        points, normals = scans.scan_of_box()
        far = np.array([1e6, 2e6, 0])
        path = scans.write_table("scan.xyz", points + far, normals)
        of_file = self.reconstruct(filepath=path)
        np.testing.assert_array_equal(np.array(of_file["hsdm_shift"]), far)
        bpy.ops.hsdm.import_points(filepath=path)
        of_object = self.reconstruct()
        np.testing.assert_array_equal(np.array(of_object["hsdm_shift"]), far)
        self.assertEqual(len(of_object.data.polygons), len(of_file.data.polygons))
        self.assertLess(np.abs(numbers(of_file.data.vertices, "co", 3)).max(), 2)

    def test_points_of_a_file_that_are_not_finite_are_counted(self):
        points, _ = scans.scan_of_box()
        points[:7, 1] = np.nan
        owner = self.reconstruct(filepath=scans.write_table("holes.xyz", points))
        from hsdm_blender import findings

        self.assertIn("points without coordinates: 7", findings.lines(findings.parsed(owner["hsdm_report"])))

    def test_options_of_the_panel_are_those_of_the_package(self):
        from hsdm_blender import settings

        known = inspect.signature(hsdm.reconstruct).parameters
        for resolution in ("AUTO", "DEPTH", "VOXEL", "ERROR"):
            for components in ("ALL", "LARGEST", "SHARE", "FACETS"):
                self.options.resolution, self.options.components = resolution, components
                self.assertLessEqual(set(settings.keywords(self.options)), set(known))
        for name in ("normals", "holes", "method", "grid"):
            for item in self.options.bl_rna.properties[name].enum_items:
                setattr(self.options, name, item.identifier)
                hsdm._options.options_of(**settings.keywords(self.options))  # refuses words it does not know

    def test_holes_are_completed_and_marked(self):
        self.add_points(*scans.scan_of_bowl())
        self.options.resolution, self.options.depth = "DEPTH", 4
        open_ = self.reconstruct()
        self.assertGreater(json.loads(open_["hsdm_report"])["mesh"]["boundary_loops"], 0)
        bpy.context.view_layer.objects.active = bpy.data.objects["scan"]
        self.options.holes = "complete"
        closed = self.reconstruct()
        self.assertTrue(json.loads(closed["hsdm_report"])["mesh"]["closed"])
        heights = numbers(closed.data.vertices, "co", 3)[:, 2]
        completed = attribute(closed, "hsdm_completed", np.int32) != 0
        self.assertTrue(completed.any())
        self.assertGreater(heights[completed].min(), 0.4)

    def test_doubtful_places_are_selected_for_editing(self):
        self.add_points(*scans.scan_of_bowl())
        self.options.resolution, self.options.depth, self.options.holes = "DEPTH", 4, "complete"
        owner = self.reconstruct()
        self.assertEqual(bpy.ops.hsdm.select_doubtful(), {"FINISHED"})
        self.assertEqual(bpy.context.mode, "EDIT_MESH")
        bpy.ops.object.mode_set(mode="OBJECT")
        selected = numbers(owner.data.vertices, "select", 1, bool)
        wanted = (attribute(owner, "hsdm_completed", np.int32) != 0) | (attribute(owner, "hsdm_confidence") < 0.3)
        np.testing.assert_array_equal(selected, wanted)
        self.assertTrue(selected.any() and not selected.all())
        self.assertTrue(numbers(owner.data.polygons, "select", 1, bool).any())

    def test_doubts_of_a_mesh_without_such_attributes_are_refused(self):
        self.add_points(*scans.scan_of_box(50))
        self.assertFalse(bpy.ops.hsdm.select_doubtful.poll())

    def test_edges_get_a_crease_where_that_is_wanted(self):
        self.add_points(*scans.scan_of_box())
        self.options.resolution, self.options.depth, self.options.crease = "DEPTH", 4, True
        mesh = self.reconstruct().data
        np.testing.assert_array_equal(numbers(mesh.edges, "crease"), numbers(mesh.edges, "use_edge_sharp", 1, bool))

    def test_the_report_is_told_in_words(self):
        from hsdm_blender import findings

        self.add_points(*scans.scan_of_box())
        self.options.resolution, self.options.depth = "DEPTH", 4
        lines = findings.lines(findings.parsed(self.reconstruct()["hsdm_report"]))
        self.assertRegex(lines[0], r"^\d+ facets$")
        self.assertRegex(lines[1], r"^\d+ quads$")
        self.assertEqual(findings.counts({"faces": 6, "quads": 6, "vertices": 8}), ["6 quads", "8 vertices"])
        self.assertIn("1 part, closed, genus 0", lines)
        self.assertTrue(any(line.endswith("8 corners") for line in lines))
        self.assertTrue(any(line.startswith("mean error ") for line in lines))
        self.assertEqual(findings.parsed("no report"), {})
        self.assertTrue(findings.lines({}))
        thin = {"what": "thin", "where": [1, 2, 3], "how_much": 2.0}
        self.assertEqual(findings.warnings({"warnings": [thin]}), [("thin: 2", (1, 2, 3))])


class DocumentTest(scans.BlenderTest):
    def test_the_scripts_of_the_page_do_what_it_says(self):
        points, normals = scans.scan_of_box()
        np.savetxt(scans.path_of("scan.xyz"), np.column_stack([points, normals]))
        page = os.path.join(os.path.dirname(__file__), "..", "..", "docs", "blender.md")
        with open(page, encoding="utf-8") as file:
            blocks = re.findall(r"```python\n(.*?)```", file.read(), re.DOTALL)
        (script,) = [block for block in blocks if "reconstruct" in block]
        names = {}
        exec(script.replace("scan.ply", scans.path_of("scan.xyz")), names)
        self.assertEqual(len(names["part"].data.polygons), 6)


class RefusalTest(scans.BlenderTest):
    def test_what_cannot_be_reconstructed_is_refused_with_a_reason_and_nothing_is_made(self):
        reconstruct = bpy.ops.hsdm.reconstruct
        self.assertIn("No mesh is active", self.message(reconstruct))
        self.add_points(np.zeros((0, 3)))
        self.assertIn("has no vertices", self.message(reconstruct))
        self.add_points(np.zeros((100, 3)))
        self.assertIn("point", self.message(reconstruct))
        self.add_points(*scans.scan_of_box())
        before = len(bpy.data.objects), len(bpy.data.meshes)
        self.options.resolution, self.options.voxel_size = "VOXEL", 0
        self.assertIn("voxel_size", self.message(reconstruct))
        self.assertIn("absent.ply", self.message(reconstruct, filepath="/nowhere/absent.ply"))
        self.options.resolution, self.options.normals = "AUTO", "given"
        bpy.context.active_object.data.attributes.remove(bpy.context.active_object.data.attributes["hsdm_normal"])
        self.assertIn("normals", self.message(reconstruct))
        self.assertEqual((len(bpy.data.objects), len(bpy.data.meshes)), before)

    def test_in_edit_mode_it_waits(self):
        self.add_points(*scans.scan_of_box(50))
        bpy.ops.object.mode_set(mode="EDIT")
        self.assertFalse(bpy.ops.hsdm.reconstruct.poll())
