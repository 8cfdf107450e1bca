"""The package hsdm, wherever it is: it may be missing, and the add-on must be able to say so."""

import importlib
import os
import sys

import bpy
from bpy.utils import register_class, unregister_class

from . import wording

ADVICE = (
    "Install it for /usr/bin/python3, by its Debian package or by pip as root, or name the folder that holds it in the "
    "add-on's preferences: build/release/python of hsdm's sources, or site-packages of a virtual environment."
)

_added = []


class Missing(Exception):
    """The package cannot be imported; the text is Python's reason."""


def load():
    """The package. Raises Missing."""
    try:
        return importlib.import_module("hsdm")
    except ImportError as error:  # also a package that was built for another Python
        raise Missing(str(error)) from error


def reason_missing():
    """Why the package cannot be had, or "" where it can."""
    try:
        load()
    except Missing as missing:
        return str(missing)
    return ""


def look_in(folder):
    """Looks for the package in this folder from now on, and in no other that was named before."""
    for old in _added:
        if old in sys.path:
            sys.path.remove(old)
    _added.clear()
    if folder:
        path = os.path.abspath(bpy.path.abspath(folder))
        sys.path.append(path)
        _added.append(path)
    importlib.invalidate_caches()


class HSDM_Preferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    folder: bpy.props.StringProperty(
        name="Folder of the package",
        description="Folder that holds the folder hsdm, where Blender's Python does not find it by itself: "
        "build/release/python of the sources, or site-packages of a virtual environment",
        subtype="DIR_PATH",
        update=lambda self, context: look_in(self.folder),
    )

    def draw(self, context):
        self.layout.prop(self, "folder")
        reason = reason_missing()
        if reason:
            self.layout.label(text=f"The Python package hsdm is missing: {reason}", icon="ERROR")
            wording.draw(self.layout, context, ADVICE)
        else:
            self.layout.label(text=f"hsdm {load().__version__} of {os.path.dirname(load().__file__)}", icon="CHECKMARK")


def register():
    register_class(HSDM_Preferences)
    addon = bpy.context.preferences.addons.get(__package__)  # none where only the module was registered
    if addon is not None and addon.preferences.folder:
        look_in(addon.preferences.folder)


def unregister():
    look_in("")
    unregister_class(HSDM_Preferences)
