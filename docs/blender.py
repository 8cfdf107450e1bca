"""The picture of docs/blender.md, by docs/blender.sh: the add-on in Blender's window, with a scan and its mesh."""

import math
import os
import sys

import bpy
from mathutils import Euler

TAB = (1030, 420)  # of a window of 1040 x 660, from its lower left

addon, scan, picture = sys.argv[sys.argv.index("--") + 1 :]
bpy.ops.preferences.addon_install(filepath=addon)
bpy.ops.preferences.addon_enable(module="hsdm_blender")
bpy.context.preferences.view.show_splash = False


def in_view(kind="WINDOW"):
    window = bpy.context.window_manager.windows[0]
    area = next(one for one in window.screen.areas if one.type == "VIEW_3D")
    region = next(one for one in area.regions if one.type == kind)
    return bpy.context.temp_override(window=window, screen=window.screen, area=area, region=region)


def make():
    for one in list(bpy.data.objects):
        bpy.data.objects.remove(one)
    with in_view():
        bpy.ops.screen.screen_full_area()  # the 3D viewport alone
    return 0.5


def fill():
    with in_view():
        bpy.ops.hsdm.import_points(filepath=scan)
        points = bpy.context.active_object
        bpy.context.scene.hsdm.resolution = "DEPTH"
        bpy.context.scene.hsdm.depth = 5
        bpy.ops.hsdm.reconstruct()
        mesh = bpy.context.active_object
        points.location.x -= 1.1 * mesh.dimensions.x
        points.select_set(True)
        mesh.data.vertices.foreach_set("select", [False] * len(mesh.data.vertices))
        mesh.data.edges.foreach_set("select", [False] * len(mesh.data.edges))
        mesh.data.polygons.foreach_set("select", [False] * len(mesh.data.polygons))
        bpy.context.tool_settings.mesh_select_mode = (False, True, False)
        view = bpy.context.area.spaces.active
        view.show_region_ui = True
        view.overlay.show_floor = view.overlay.show_axis_x = view.overlay.show_axis_y = False
        view.region_3d.view_rotation = Euler((math.radians(62), 0, math.radians(28))).to_quaternion()
        view.shading.light = "STUDIO"
        bpy.ops.view3d.view_selected()
        points.select_set(False)
        bpy.ops.object.mode_set(mode="EDIT")  # which shows sharp edges
    return 0.5


def tab():
    """Clicks on the sidebar's tab: no property says which one is shown."""
    window = bpy.context.window_manager.windows[0]
    x, y = TAB
    window.event_simulate(type="MOUSEMOVE", value="NOTHING", x=x, y=y)
    for value in ("PRESS", "RELEASE"):
        window.event_simulate(type="LEFTMOUSE", value=value, x=x, y=y)
    return 1.0


def shoot():
    with in_view():
        bpy.ops.screen.screenshot(filepath=picture)
    os._exit(0)


steps = iter((make, fill, tab, shoot))


def go_on():
    try:
        return next(steps)()
    except Exception:
        import traceback

        traceback.print_exc()
        sys.stderr.flush()
        os._exit(1)


bpy.app.timers.register(go_on, first_interval=0.5)
