"""Inside Blender: installs the add-on and runs the tests named behind `--`."""

import importlib
import os
import sys
import unittest

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
addon, *names = sys.argv[sys.argv.index("--") + 1 :]

bpy.ops.preferences.addon_install(filepath=addon)
bpy.ops.preferences.addon_enable(module="hsdm_blender")

tests = unittest.TestSuite(
    unittest.defaultTestLoader.loadTestsFromModule(importlib.import_module(f"test_{name}")) for name in names
)
result = unittest.TextTestRunner(stream=sys.stdout, verbosity=2).run(tests)
sys.stdout.flush()
sys.exit(0 if result.wasSuccessful() and result.testsRun else 1)
