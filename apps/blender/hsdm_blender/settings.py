"""The options of a reconstruction that a scene keeps, and what they are as hsdm's keyword arguments."""

import math

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty
from bpy.utils import register_class, unregister_class


class HSDM_Settings(bpy.types.PropertyGroup):
    resolution: EnumProperty(
        name="Resolution",
        items=(
            ("AUTO", "Automatic", "Voxels of three spacings of the points, or twice their noise"),
            ("DEPTH", "Depth", "Voxels of the largest extent over two to the power of this"),
            ("VOXEL", "Voxel size", "Edge of a voxel, in the object's own units"),
            ("ERROR", "Largest error", "As few facets as keep within this of the points"),
        ),
        default="AUTO",
    )
    depth: IntProperty(name="Depth", description="Of the octree", min=1, max=16, soft_max=10, default=6)
    voxel_size: FloatProperty(
        name="Voxel size",
        description="In the object's own units, before its scale",
        min=0,
        soft_min=1e-4,
        default=0.1,
        precision=4,
    )
    error_is_share: BoolProperty(
        name="Of diagonal", description="The error is a share of the diagonal of the points' box", default=True
    )
    error_share: FloatProperty(
        name="Within",
        description="Share of the diagonal of the points' box",
        subtype="PERCENTAGE",
        min=0,
        max=100,
        soft_max=5,
        default=0.5,
        precision=3,
    )
    error_length: FloatProperty(
        name="Within", description="In the object's own units, before its scale", min=0, default=0.01, precision=4
    )
    normals: EnumProperty(
        name="Normals",
        items=(
            ("automatic", "Automatic", "Those of the points if they have some, else estimated"),
            ("given", "Given", "Those of the points; an error where there are none"),
            ("estimate", "Estimated", "Estimated even where the points have some"),
        ),
        default="automatic",
    )
    holes: EnumProperty(
        name="Holes",
        items=(
            ("automatic", "Close small", "Close what is small against the sampling, keep real borders"),
            ("keep", "Keep", "Close nothing"),
            ("complete", "Complete", "Close all by the surface that is missing, and mark it"),
            ("close", "Close flat", "Close all by facets over the vertices of the border"),
        ),
        default="automatic",
    )
    components: EnumProperty(
        name="Parts",
        items=(
            ("ALL", "All", "Keep all parts but splinters"),
            ("LARGEST", "The largest", "Keep the largest part alone"),
            ("SHARE", "By area", "Keep parts of at least this share of the largest one's area"),
            ("FACETS", "By facets", "Keep parts of at least so many facets"),
        ),
        default="ALL",
    )
    component_share: FloatProperty(
        name="At least", description="Share of the largest part's area", subtype="PERCENTAGE", min=0, max=100, default=1
    )
    component_facets: IntProperty(name="At least", description="Facets of a part", min=1, default=200)
    crease_angle: FloatProperty(
        name="Sharp from",
        description="Edges whose facets meet at more than this angle are sharp",
        subtype="ANGLE",
        min=0,
        max=math.pi,
        default=math.radians(35),
    )
    smoothing: IntProperty(
        name="Smoothing",
        description="Rounds of smoothing of normals, not across sharp edges",
        min=0,
        soft_max=20,
        default=3,
    )
    confidence: BoolProperty(
        name="Confidence",
        description="Measure for each vertex how much of the surface around it the points show",
        default=True,
    )
    trim: FloatProperty(
        name="Trim below",
        description="Cut off facets of less confidence than this; 0 cuts off nothing",
        subtype="FACTOR",
        min=0,
        max=1,
        default=0,
    )
    method: EnumProperty(
        name="Method",
        items=(
            ("automatic", "Extended", "With normals: sharp edges and thin parts"),
            ("basic", "Basic", "Positions alone: a vertex for each voxel"),
        ),
        default="automatic",
    )
    grid: EnumProperty(
        name="Grid",
        items=(
            ("automatic", "Automatic", "Adaptive with a largest error, else uniform"),
            ("uniform", "Uniform", "Voxels of one size"),
            ("adaptive", "Adaptive", "Few facets where the surface is plain"),
        ),
        default="automatic",
    )
    merge_layers: BoolProperty(
        name="Merge layers",
        description="Scans that do not register: sheets of one voxel that face the same way become one",
    )
    crease: BoolProperty(
        name="Crease edges",
        description="Also give sharp edges a crease of 1, so that a Subdivision Surface modifier keeps them",
    )
    threads: IntProperty(name="Threads", description="0 takes all; the mesh does not depend on it", min=0, default=0)


def keywords(given):
    """The keyword arguments of hsdm.reconstruct, without points and progress."""
    made = {
        "normal_source": given.normals,
        "holes": given.holes,
        "crease_angle": given.crease_angle,
        "normal_smoothing": given.smoothing,
        "confidence": given.confidence,
        "trim": given.trim,
        "method": given.method,
        "grid": given.grid,
        "merge_layers": given.merge_layers,
        "threads": given.threads,
    }
    made.update(_resolution(given))
    if given.components != "ALL":
        made["min_component"] = {
            "LARGEST": "100%",
            "SHARE": f"{given.component_share}%",
            "FACETS": given.component_facets,
        }[given.components]
    return made


def _resolution(given):
    if given.resolution == "DEPTH":
        return {"depth": given.depth}
    if given.resolution == "VOXEL":
        return {"voxel_size": given.voxel_size}
    if given.resolution == "ERROR":
        return {"max_error": f"{given.error_share}%" if given.error_is_share else given.error_length}
    return {}


def register():
    register_class(HSDM_Settings)
    bpy.types.Scene.hsdm = PointerProperty(type=HSDM_Settings)


def unregister():
    del bpy.types.Scene.hsdm
    unregister_class(HSDM_Settings)
