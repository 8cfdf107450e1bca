"""What people call: import, reconstruct, and look at what is doubtful."""

from dataclasses import dataclass
import os

import bpy
import numpy as np
from bpy.props import CollectionProperty, FloatProperty, FloatVectorProperty, StringProperty
from bpy.utils import register_class, unregister_class
from bpy_extras.io_utils import ImportHelper
from mathutils import Matrix, Vector

from . import clouds, findings, meshes, package, settings
from .job import Job, ScanFile

_INTERVAL = 0.1  # seconds between two looks at a job: what is shown is as fresh as that

_runs = []


@dataclass
class _Run:
    """A job and what shows it."""

    job: Job
    timer: bpy.types.Timer
    told: str = ""


def running():
    """The job that runs, or None."""
    return _runs[0].job if _runs else None


def _loaded(operator):
    try:
        return package.load()
    except package.Missing as missing:
        operator.report({"ERROR"}, f"The Python package hsdm is missing ({missing}); the panel says how to get it")
        return None


def _one_line(error):
    """An exception as people read it; of one without a text its kind is all there is."""
    return " ".join(str(error).split()) or type(error).__name__


class _ScanFile(ImportHelper):
    """A file browser for the formats that hsdm reads."""

    filter_glob: StringProperty(options={"HIDDEN"})
    columns: StringProperty(
        name="Columns",
        description="What the columns of a table are, such as x,y,z,nx,ny,nz,r,g,b,_; told from their values if empty",
    )

    def invoke(self, context, event):
        hsdm = _loaded(self)
        if hsdm is None:
            return {"CANCELLED"}
        self.filter_glob = ";".join(f"*.{extension}" for extension in hsdm.point_formats)
        return ImportHelper.invoke(self, context, event)


class HSDM_OT_import_points(bpy.types.Operator, _ScanFile):
    """Reads scanned points as a mesh of vertices, with normals, colours and other numbers as attributes"""

    bl_idname = "hsdm.import_points"
    bl_label = "Import Scanned Points"
    bl_options = {"REGISTER", "UNDO"}

    files: CollectionProperty(type=bpy.types.OperatorFileListElement, options={"HIDDEN", "SKIP_SAVE"})
    directory: StringProperty(subtype="DIR_PATH", options={"HIDDEN", "SKIP_SAVE"})

    def execute(self, context):
        hsdm = _loaded(self)
        if hsdm is None:
            return {"CANCELLED"}
        done = [self._read(hsdm, context, path) for path in self._paths()]
        return {"FINISHED"} if any(done) else {"CANCELLED"}

    def _paths(self):
        if self.directory and any(one.name for one in self.files):
            return [os.path.join(self.directory, one.name) for one in self.files]
        return [self.filepath]

    def _read(self, hsdm, context, path):
        try:
            points = hsdm.read_points(bpy.path.abspath(path), columns=self.columns)
        except (hsdm.Error, MemoryError) as error:
            self.report({"ERROR"}, _one_line(error))
            return False
        cloud = clouds.finite_part(clouds.cloud_of_points(points, clouds.known_shifts()))
        if len(cloud.positions) == 0:
            self.report({"ERROR"}, f"{path}: no point has finite coordinates")
            return False
        made = clouds.add_cloud(_name_of(path), cloud, context.collection)
        _make_active(context, made)
        self.report({"INFO"}, _said_of(made, points))
        return True


def _said_of(made, points):
    said = f"{made.name}: {len(made.data.vertices):,} points"
    left_out = len(points.positions) - len(made.data.vertices) + points.nonfinite
    if left_out:
        said += f", {left_out:,} without coordinates left out"
    if points.withheld:
        said += f", {points.withheld:,} that the file marks as withheld left out"
    if points.faces:
        said += f", {points.faces:,} faces left out"
    if points.columns:
        said += f", columns {points.columns}"
    if clouds.SHIFT in made:
        said += ", moved by {:.15g} {:.15g} {:.15g} to the origin (property hsdm_shift)".format(*made[clouds.SHIFT])
    return said


class HSDM_OT_reconstruct(bpy.types.Operator):
    """Reconstructs the surface of the active object's points, or of those that it was itself made of, as a new object"""

    bl_idname = "hsdm.reconstruct"
    bl_label = "Reconstruct"
    bl_options = {"UNDO"}

    filepath: StringProperty(
        name="File",
        description="A file of points, in place of the active object",
        subtype="FILE_PATH",
        options={"SKIP_SAVE"},
    )
    columns: StringProperty(name="Columns", description="What the columns of the file are", options={"SKIP_SAVE"})

    @classmethod
    def poll(cls, context):
        if context.mode != "OBJECT":
            cls.poll_message_set("Leave edit mode first")
            return False
        if running() is not None:
            cls.poll_message_set("A reconstruction is running")
            return False
        return True

    def execute(self, context):
        """At once, for scripts."""
        job = self._prepared(context)
        if job is None:
            return {"CANCELLED"}
        job.run()
        return self._finished(context, job)

    def invoke(self, context, event):
        """Beside Blender's own work."""
        job = self._prepared(context)
        if job is None:
            return {"CANCELLED"}
        job.start()
        manager = context.window_manager
        manager.progress_begin(0, 100)
        self._run = _Run(job, manager.event_timer_add(_INTERVAL, window=context.window))
        _runs.append(self._run)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        job = self._run.job
        if event.type == "ESC" and event.value == "PRESS":
            job.cancel()
            return {"RUNNING_MODAL"}  # nothing else is to see it
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        if not job.is_done():
            _tell(context, self._run)
            return {"PASS_THROUGH"}
        _end(context, self._run)
        return self._finished(context, job)

    def cancel(self, context):
        """Blender ends it: another file is opened, or none any more."""
        self._run.job.cancel()
        _end(context, self._run)

    def _prepared(self, context):
        """The job, and what is to be known of the object when it is done, by value: the object may be gone then."""
        hsdm = _loaded(self)
        if hsdm is None:
            return None
        options = settings.keywords(context.scene.hsdm)
        if self.filepath:
            self._name, self._source, self._matrix = _name_of(self.filepath), None, Matrix()
            self._collections = []
            source = ScanFile(bpy.path.abspath(self.filepath), self.columns, clouds.known_shifts())
            return Job(hsdm, source, options)
        owner = context.active_object
        if owner is None or owner.type != "MESH":
            self.report({"ERROR"}, "No mesh is active: import scanned points, or select an object that has vertices")
            return None
        owner = points_behind(owner)
        cloud = clouds.cloud_of_object(owner, context.evaluated_depsgraph_get())
        if len(cloud.positions) == 0:
            self.report({"ERROR"}, f"{owner.name}: has no vertices to take for points")
            return None
        self._name, self._source, self._matrix = owner.name, owner.name, owner.matrix_world.copy()
        scale = [abs(one) for one in self._matrix.to_scale()]
        if max(scale) > 1.01 * min(scale):
            said = f"{owner.name}: is scaled unevenly; apply its scale for voxels that are cubes as you see it"
            self.report({"WARNING"}, said)
        self._collections = [one.name for one in owner.users_collection]
        return Job(hsdm, cloud, options)

    def _finished(self, context, job):
        if job.was_cancelled:
            self.report({"WARNING"}, "Cancelled; nothing was made")
            return {"CANCELLED"}
        if job.error is not None:
            self.report({"ERROR"}, _one_line(job.error))
            return {"CANCELLED"}
        made = meshes.add_mesh(f"{self._name} mesh", job.mesh, job.shift, context.scene.hsdm.crease)
        if self._source is not None:
            made[meshes.SOURCE] = self._source
        self._collection(context).objects.link(made)
        made.matrix_world = self._matrix
        _make_active(context, made)
        self.report({"INFO"}, f"{made.name}: " + ", ".join(findings.summary(job.mesh.report)))
        for text, _ in findings.warnings(job.mesh.report):
            self.report({"WARNING"}, text)
        return {"FINISHED"}

    def _collection(self, context):
        """The first that the points' object lies in and that the view shows, else the active one."""
        shown = {context.scene.collection, *context.scene.collection.children_recursive}
        known = [bpy.data.collections.get(name) for name in self._collections]
        return next((one for one in known if one in shown), context.collection)


class HSDM_OT_reconstruct_file(bpy.types.Operator, _ScanFile):
    """Reconstructs the points of a file as a new object, without an object of the points"""

    bl_idname = "hsdm.reconstruct_file"
    bl_label = "Reconstruct File"

    @classmethod
    def poll(cls, context):
        return HSDM_OT_reconstruct.poll(context)

    def execute(self, context):
        # A file browser's operator ends with it, and cannot go on as a modal one.
        way = "EXEC_DEFAULT" if bpy.app.background else "INVOKE_DEFAULT"
        try:
            bpy.ops.hsdm.reconstruct(way, filepath=self.filepath, columns=self.columns)
        except RuntimeError as error:  # what it reported
            self.report({"ERROR"}, _one_line(error).removeprefix("Error: "))
            return {"CANCELLED"}
        return {"FINISHED"}


class HSDM_OT_cancel(bpy.types.Operator):
    """Ends the reconstruction that is running; nothing is made"""

    bl_idname = "hsdm.cancel"
    bl_label = "Cancel"

    @classmethod
    def poll(cls, context):
        return running() is not None

    def execute(self, context):
        running().cancel()
        return {"FINISHED"}


class HSDM_OT_select_doubtful(bpy.types.Operator):
    """Selects the vertices that few points show, and those that were completed, in edit mode"""

    bl_idname = "hsdm.select_doubtful"
    bl_label = "Select Doubtful Places"
    bl_options = {"REGISTER", "UNDO"}

    confidence: FloatProperty(
        name="Below", description="Vertices of less confidence than this", subtype="FACTOR", min=0, max=1, default=0.3
    )

    @classmethod
    def poll(cls, context):
        owner = context.active_object
        names = owner.data.attributes if owner is not None and owner.type == "MESH" else ()
        if meshes.CONFIDENCE in names or meshes.COMPLETED in names:
            return True
        cls.poll_message_set("The active object is no mesh with hsdm_confidence or hsdm_completed")
        return False

    def execute(self, context):
        owner = context.active_object
        if context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")  # where attributes are written back, and selections read
        found = meshes.doubtful(owner.data, self.confidence)
        if found is None:
            self.report({"ERROR"}, f"{owner.name}: its attributes are not those of vertices")
            return {"CANCELLED"}
        meshes.select(owner.data, found)
        context.tool_settings.mesh_select_mode = (True, False, False)
        bpy.ops.object.mode_set(mode="EDIT")
        count = int(np.count_nonzero(found))
        self.report({"INFO"}, f"{count:,} of {len(found):,} vertices are doubtful")
        return {"FINISHED"}


class HSDM_OT_show_place(bpy.types.Operator):
    """Puts the 3D cursor at the place of a warning"""

    bl_idname = "hsdm.show_place"
    bl_label = "Show Place"
    bl_options = {"REGISTER", "UNDO"}

    place: FloatVectorProperty(
        description="In the active object's own coordinates", subtype="XYZ", options={"SKIP_SAVE"}
    )

    @classmethod
    def poll(cls, context):
        return context.active_object is not None

    def execute(self, context):
        context.scene.cursor.location = context.active_object.matrix_world @ Vector(self.place)
        return {"FINISHED"}


def points_behind(owner):
    """The object of the points that a mesh was made of, so that one can try other options; else the object itself."""
    source = bpy.data.objects.get(str(owner.get(meshes.SOURCE, "")))
    is_there = source is not None and source.type == "MESH" and source.users_scene
    return source if is_there else owner


def _name_of(path):
    return os.path.splitext(bpy.path.display_name_from_filepath(path))[0] or "scan"


def _make_active(context, made):
    if context.mode != "OBJECT":  # entered while the job ran: what is edited stays active
        return
    for other in context.selected_objects:
        other.select_set(False)
    if made.name in context.view_layer.objects:  # not where its collection is excluded
        made.select_set(True)
        context.view_layer.objects.active = made


def _tell(context, run):
    """What the job does, where that has changed."""
    told = f"hsdm: {run.job.phase} {run.job.share:.0%}    Esc: cancel"
    if told != run.told:
        run.told = told
        context.window_manager.progress_update(100 * run.job.share)
        _show(context, told)


def _end(context, run):
    """Nothing shows the job any more."""
    _runs.remove(run)
    context.window_manager.event_timer_remove(run.timer)
    context.window_manager.progress_end()
    _show(context, None)


def _show(context, text):
    """Text in the status bar, or None for Blender's own, and the sidebars drawn anew, for a view of many points is dear."""
    if context.workspace is not None:
        context.workspace.status_text_set(text)
    for area in context.screen.areas if context.screen is not None else ():
        for region in area.regions:
            if area.type == "VIEW_3D" and region.type == "UI":
                region.tag_redraw()


def _draw_import(self, context):
    self.layout.operator(HSDM_OT_import_points.bl_idname, text="Scanned points (hsdm)")


_CLASSES = (
    HSDM_OT_import_points,
    HSDM_OT_reconstruct,
    HSDM_OT_reconstruct_file,
    HSDM_OT_cancel,
    HSDM_OT_select_doubtful,
    HSDM_OT_show_place,
)


def register():
    for one in _CLASSES:
        register_class(one)
    bpy.types.TOPBAR_MT_file_import.append(_draw_import)


def unregister():
    for run in list(_runs):  # Blender drops the operator without a word
        run.job.cancel()
        _end(bpy.context, run)
    bpy.types.TOPBAR_MT_file_import.remove(_draw_import)
    for one in reversed(_CLASSES):
        unregister_class(one)
