"""Scanned points to CAD-ready meshes in Blender: the door of the package hsdm, which does the work.

Files: `package` finds hsdm; `clouds` and `meshes` are points and meshes in Blender; `settings` the options; `job` a
reconstruction beside Blender's own work; `operators` and `panels` what people see; `findings` the report in words,
`wording` how they are broken into lines.
"""

bl_info = {
    "name": "hsdm: scanned points to CAD-ready meshes",
    "author": "the hsdm developers",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "File > Import > Scanned points (hsdm); 3D viewport > Sidebar > hsdm",
    "description": "Reconstructs scanned points: quads, sharp edges marked, a 2-manifold every time",
    "category": "Mesh",
}

from . import operators, package, panels, settings

_PARTS = (package, settings, operators, panels)


def register():
    for part in _PARTS:
        part.register()


def unregister():
    for part in reversed(_PARTS):
        part.unregister()
