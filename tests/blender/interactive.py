"""In Blender's window, with events: Escape, undo, and closing Blender while points are reconstructed.

Each step of `steps` runs when Blender has handled the events of the one before; it yields to wait.
"""

import os
import sys
import time
import traceback

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import scans

(addon,) = sys.argv[sys.argv.index("--") + 1 :]
bpy.ops.preferences.addon_install(filepath=addon)
bpy.ops.preferences.addon_enable(module="hsdm_blender")

from hsdm_blender import clouds, operators


def names():
    return sorted(one.name for one in bpy.data.objects)


def in_view():
    """The context of the 3D viewport, which timers do not have."""
    window = bpy.context.window_manager.windows[0]
    area = next(one for one in window.screen.areas if one.type == "VIEW_3D")
    region = next(one for one in area.regions if one.type == "WINDOW")
    return bpy.context.temp_override(window=window, area=area, region=region)


def begin(depth):
    bpy.context.scene.hsdm.resolution = "DEPTH"
    bpy.context.scene.hsdm.depth = depth
    with in_view():
        assert bpy.ops.hsdm.reconstruct("INVOKE_DEFAULT") == {"RUNNING_MODAL"}


def begin_held():
    """A reconstruction that goes on until it is asked to end, however fast it would be."""
    goes_on = operators.Job._goes_on

    def held(*arguments):
        while goes_on(*arguments):
            time.sleep(0.01)
        return False

    operators.Job._goes_on = held
    begin(depth=10)
    yield from until(lambda: operators.running().phase != "reading", 100)
    operators.Job._goes_on = goes_on


def begin_on(points, normals):
    with in_view():
        owner = clouds.add_cloud("scan", clouds.Cloud(points, normals), bpy.context.collection)
        bpy.context.view_layer.objects.active = owner
    yield from begin_held()


def until(condition, seconds):
    """Lets Blender go on until something is so; says after how long."""
    begun = time.monotonic()
    while not condition():
        assert time.monotonic() - begun < seconds, "waited in vain"
        yield
    print(f"  after {time.monotonic() - begun:.2f} s")


def press(key):
    for value in ("PRESS", "RELEASE"):
        bpy.context.window_manager.windows[0].event_simulate(type=key, value=value, x=600, y=400)


def steps():
    for one in list(bpy.data.objects):
        bpy.data.objects.remove(one)
    points, normals = scans.scan_of_box(150000)
    with in_view():
        owner = clouds.add_cloud("scan", clouds.Cloud(points, normals), bpy.context.collection)
        bpy.context.view_layer.objects.active = owner
        bpy.ops.ed.undo_push(message="scan")

    print("Escape ends it, and nothing is made")
    yield from begin_held()
    assert not bpy.ops.hsdm.reconstruct.poll()  # one at a time
    press("ESC")
    yield from until(lambda: operators.running() is None, 30)
    assert names() == ["scan"], names()

    print("it ends with a new object, and undo takes that back")
    begin(depth=4)
    yield from until(lambda: operators.running() is None, 100)
    assert names() == ["scan", "scan mesh"], names()
    with in_view():
        bpy.ops.ed.undo()
    yield
    assert names() == ["scan"], names()
    with in_view():
        bpy.ops.ed.redo()
    yield
    assert names() == ["scan", "scan mesh"], names()

    print("its points may be removed meanwhile")
    with in_view():
        bpy.context.view_layer.objects.active = bpy.data.objects["scan"]
    begin(depth=5)
    bpy.data.objects.remove(bpy.data.objects["scan"])
    yield from until(lambda: operators.running() is None, 100)
    assert names() == ["scan mesh", "scan mesh.001"], names()

    print("a file goes the same way, whatever the file browser does")
    path = scans.write_table("file.xyz", *scans.scan_of_box())
    with in_view():
        assert bpy.ops.hsdm.reconstruct_file(filepath=path) == {"FINISHED"}
    yield from until(lambda: operators.running() is None, 100)
    assert names() == ["file mesh", "scan mesh", "scan mesh.001"], names()

    print("the add-on is disabled meanwhile")
    yield from begin_on(points, normals)
    job = operators.running()
    bpy.ops.preferences.addon_disable(module="hsdm_blender")
    assert operators.running() is None
    yield from until(job.is_done, 30)
    assert job.was_cancelled
    bpy.ops.preferences.addon_enable(module="hsdm_blender")

    print("another file is opened meanwhile")
    yield from begin_on(points, normals)
    job = operators.running()
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    yield from until(job.is_done, 30)
    assert job.was_cancelled and operators.running() is None and names() == [], names()

    print("Blender is closed meanwhile")
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    yield
    bpy.ops.preferences.addon_enable(module="hsdm_blender")
    yield from begin_on(points, normals)
    with in_view():
        bpy.ops.wm.quit_blender()
    yield


running = steps()


def go_on():
    try:
        next(running)
        sys.stdout.flush()
        return 0.05
    except Exception:
        traceback.print_exc()
        sys.stderr.flush()
        os._exit(1)


bpy.app.timers.register(go_on, first_interval=0.5, persistent=True)  # also when another file is opened
