"""The tab hsdm of the 3D viewport's sidebar."""

import bpy
from bpy.utils import register_class, unregister_class

from . import clouds, findings, meshes, operators, package, wording


class _Tab:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "hsdm"


class HSDM_PT_reconstruct(_Tab, bpy.types.Panel):
    bl_label = "Reconstruct"

    def draw(self, context):
        layout = self.layout
        reason = package.reason_missing()
        if reason:
            _draw_missing(layout, context, reason)
            return
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.operator("hsdm.import_points", icon="IMPORT")
        _draw_options(layout.column(), context.scene.hsdm)
        _draw_run(layout, context)


def _draw_missing(layout, context, reason):
    wording.draw(layout, context, "The Python package hsdm is missing", icon="ERROR")
    wording.draw(layout, context, reason)
    wording.draw(layout, context, package.ADVICE)
    layout.operator("preferences.addon_show", text="Preferences").module = package.__package__


def _draw_options(column, options):
    column.prop(options, "resolution")
    if options.resolution == "DEPTH":
        column.prop(options, "depth")
    elif options.resolution == "VOXEL":
        column.prop(options, "voxel_size")
    elif options.resolution == "ERROR":
        column.prop(options, "error_share" if options.error_is_share else "error_length")
        column.prop(options, "error_is_share")
    column.prop(options, "normals")
    column.prop(options, "holes")
    column.prop(options, "crease_angle")


def _draw_run(layout, context):
    job = operators.running()
    if job is not None:
        layout.label(text=f"{job.phase} {job.share:.0%}", icon="TIME")
        layout.operator("hsdm.cancel", icon="CANCEL")
        return
    column = layout.column(align=True)
    column.scale_y = 1.3
    column.operator("hsdm.reconstruct", text=f"Reconstruct {_points_of(context.active_object)}", icon="MESH_GRID")
    column.operator("hsdm.reconstruct_file", text="Reconstruct File...", icon="FILE")


def _points_of(owner):
    if owner is None or owner.type != "MESH":
        return "Active Object"
    return f"{len(operators.points_behind(owner).data.vertices):,} Points"


class HSDM_PT_more(_Tab, bpy.types.Panel):
    bl_label = "More"
    bl_parent_id = "HSDM_PT_reconstruct"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return not package.reason_missing()

    def draw(self, context):
        layout, options = self.layout, context.scene.hsdm
        layout.use_property_split = True
        layout.use_property_decorate = False
        for name in ("method", "grid", "smoothing", "merge_layers"):
            layout.prop(options, name)
        layout.prop(options, "components")
        if options.components == "SHARE":
            layout.prop(options, "component_share")
        elif options.components == "FACETS":
            layout.prop(options, "component_facets")
        for name in ("confidence", "trim", "crease", "threads"):
            layout.prop(options, name)


class HSDM_PT_result(_Tab, bpy.types.Panel):
    bl_label = "Result"

    @classmethod
    def poll(cls, context):
        owner = context.active_object
        return owner is not None and (meshes.REPORT in owner or clouds.SHIFT in owner)

    def draw(self, context):
        layout, owner = self.layout, context.active_object
        if meshes.REPORT in owner:
            _draw_report(layout, context, findings.parsed(str(owner[meshes.REPORT])))
            layout.operator("hsdm.select_doubtful", icon="RESTRICT_SELECT_OFF")
        if clouds.SHIFT in owner:
            wording.draw(layout, context, "Moved to the origin; the file has this more in x, y and z:")
            layout.prop(owner, f'["{clouds.SHIFT}"]', text="")


def _draw_report(layout, context, report):
    column = layout.column(align=True)
    for line in findings.lines(report):
        wording.draw(column, context, line)
    for text, place in findings.warnings(report):
        row = layout.row()
        wording.draw(row, context, text, icon="ERROR", beside=5)
        row.operator("hsdm.show_place", text="", icon="PIVOT_CURSOR").place = place


_CLASSES = (HSDM_PT_reconstruct, HSDM_PT_more, HSDM_PT_result)


def register():
    for one in _CLASSES:
        register_class(one)


def unregister():
    for one in reversed(_CLASSES):
        unregister_class(one)
