"""The add-on as such: registered, installed, without its package."""

import json
import os
import subprocess
import sys

import bpy
import scans

TWICE = """
import addon_utils, bpy, sys
for _ in range(2):
    assert addon_utils.enable("hsdm_blender"), "not enabled"
    assert hasattr(bpy.types.Scene, "hsdm") and hasattr(bpy.types, "HSDM_PT_reconstruct")
    addon_utils.disable("hsdm_blender")
    assert not hasattr(bpy.types.Scene, "hsdm") and not hasattr(bpy.types, "HSDM_PT_reconstruct")
print("twice")
"""


class Layout:
    """Stands in for Blender's, which only a window has: it remembers what is said."""

    def __init__(self, said=None):
        self.said = [] if said is None else said

    def label(self, text="", icon=""):
        self.said.append(text)

    def prop(self, owner, name, text=None):
        if not name.startswith("["):
            assert name in owner.bl_rna.properties, name
        self.said.append(name)

    def operator(self, name, text="", icon=""):
        self.said.append(name)
        return type("Properties", (), {})()

    def column(self, align=False):
        return Layout(self.said)

    row = column


def drawn(panel):
    """What a panel says now."""
    class Drawn:
        layout = Layout()

    panel.draw(Drawn, bpy.context)
    return Drawn.layout.said


class AddonTest(scans.BlenderTest):
    def test_it_registers_and_unregisters_twice_and_blender_says_nothing(self):
        command = [bpy.app.binary_path, "-b", "--factory-startup", "--python-exit-code", "1", "--python-expr", TWICE]
        ran = subprocess.run(command, capture_output=True, text=True, timeout=120)
        self.assertEqual(ran.returncode, 0, ran.stdout + ran.stderr)
        self.assertEqual(ran.stderr, "")
        said = [line for line in ran.stdout.splitlines() if line and not line.startswith("Blender ")]
        self.assertEqual(said, ["twice"])

    def test_its_version_is_that_of_the_package(self):
        import hsdm
        import hsdm_blender

        self.assertEqual(".".join(map(str, hsdm_blender.bl_info["version"])), hsdm.__version__)

    def test_the_archive_holds_the_licence(self):
        import hsdm_blender

        self.assertIn("LICENSE", os.listdir(os.path.dirname(hsdm_blender.__file__)))

    def test_without_the_package_panel_and_operators_say_how_to_get_it(self):
        from hsdm_blender import package, panels

        hidden = {name: sys.modules.pop(name) for name in list(sys.modules) if name.split(".")[0] == "hsdm"}
        sys.modules["hsdm"] = None  # what Python takes for a package that is not there
        try:
            said = " ".join(drawn(panels.HSDM_PT_reconstruct))
            self.assertIn("is missing", said)
            self.assertIn("preferences", said)
            self.assertNotIn("hsdm.reconstruct", said)
            for call in (bpy.ops.hsdm.import_points, bpy.ops.hsdm.reconstruct):
                self.assertIn("the panel says how", self.message(call, filepath="scan.ply"))
        finally:
            sys.modules.update(hidden)
        self.assertEqual(package.reason_missing(), "")

    def test_a_folder_of_the_preferences_is_looked_in_until_another_is(self):
        preferences = bpy.context.preferences.addons["hsdm_blender"].preferences
        for folder in ("/nowhere/one", "/nowhere/two"):
            preferences.folder = folder
            self.assertEqual([path for path in sys.path if path.startswith("/nowhere")], [folder])
        preferences.folder = ""
        self.assertEqual([path for path in sys.path if path.startswith("/nowhere")], [])

    def test_every_option_of_the_panel_is_one_of_the_scene(self):
        from hsdm_blender import panels

        for resolution in ("AUTO", "DEPTH", "VOXEL", "ERROR"):
            self.options.resolution = resolution
            self.assertIn("hsdm.reconstruct", drawn(panels.HSDM_PT_reconstruct))
        for components in ("ALL", "LARGEST", "SHARE", "FACETS"):
            self.options.components = components
            self.assertIn("method", drawn(panels.HSDM_PT_more))

    def test_the_result_tells_counts_warnings_with_their_places_and_the_shift(self):
        from hsdm_blender import panels

        owner = self.add_points(*scans.scan_of_box(8))
        self.assertFalse(panels.HSDM_PT_result.poll(bpy.context))
        what = "walls or gaps too narrow for the points there, and further words of a long text"
        warning = {"what": what, "where": [1.0, 2.0, 3.0], "how_much": 5}
        owner["hsdm_report"] = json.dumps({"mesh": {"quads": 6, "faces": 6}, "warnings": [warning]})
        owner["hsdm_shift"] = [1e6, 2e6, 0.0]
        self.assertTrue(panels.HSDM_PT_result.poll(bpy.context))
        said = drawn(panels.HSDM_PT_result)
        self.assertEqual(said[0], "6 quads")
        self.assertIn(f"{what}: 5", " ".join(said))
        self.assertTrue(all(len(line) < 50 for line in said))
        self.assertIn('["hsdm_shift"]', said)
        owner.location = (10, 0, 0)
        bpy.context.view_layer.update()
        self.assertEqual(bpy.ops.hsdm.show_place(place=(1, 2, 3)), {"FINISHED"})
        self.assertEqual(tuple(bpy.context.scene.cursor.location), (11, 2, 3))
