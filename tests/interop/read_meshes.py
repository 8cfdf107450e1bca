"""read_meshes.py PROGRAM COMMAND: meshes as PROGRAM writes them, read by the command, against the mesh it was given."""
import os
import sys

from common import check, farthest, hsdm, in_folder, info, need_module, need_program, run
from write_meshes import prepare

# A cube of 40: what floats, and six digits of text, may move a vertex by.
FLOAT, DIGITS = 2e-6, 1e-4


def triangles_of(polygons):
    return [[f[0], f[i], f[i + 1]] for f in polygons for i in range(1, len(f) - 1)]


def expect(path, faces, tolerance):
    """The mesh of part.off, as whole as it is there, in so many facets; and its vertices are a cloud."""
    ours, theirs = info("part.off")["mesh"], info(path)["mesh"]
    check(theirs["faces"] == faces, f"{path} has {theirs['faces']} facets, expected {faces}")
    for what in ("vertices", "closed", "euler", "components", "manifold"):
        check(theirs[what] == ours[what], f"{path}: {what} is {theirs[what]}, expected {ours[what]}")
    check(abs(theirs["signed_volume"] - ours["signed_volume"]) < 1e-4 * ours["signed_volume"], f"{path}: its volume")
    off = farthest(path, "part.off")
    check(off <= tolerance, f"{path} is {off} off")
    hsdm("reconstruct", path, "--depth", "2", "-o", "again.off", "--quiet")


def assimp():
    program = need_program("assimp")
    _, polygons = prepare()
    for form, name in (("obj", "a.obj"), ("stl", "text.stl"), ("stlb", "a.stl"), ("ply", "text.ply"), ("plyb", "a.ply")):
        run(program, "export", "part.off", name, f"-f{form}")
        expect(name, len(triangles_of(polygons) if "stl" in form else polygons), DIGITS)


def meshio():
    module = need_module("meshio")
    positions, polygons = prepare()
    mesh = module.Mesh(positions, [("triangle", triangles_of(polygons))])
    for name, options in (("a.stl", {"binary": True}), ("text.stl", {"binary": False}), ("a.ply", {"binary": True}),
                          ("text.ply", {"binary": False}), ("a.obj", {}), ("a.off", {})):
        mesh.write(name, **options)
        expect(name, len(triangles_of(polygons)), FLOAT)


def vtk():
    data, core = need_module("vtkmodules.vtkCommonDataModel"), need_module("vtkmodules.vtkCommonCore")
    geometry, ply = need_module("vtkmodules.vtkIOGeometry"), need_module("vtkmodules.vtkIOPLY")
    positions, polygons = prepare()

    def written(name, writer, facets, text=None):
        points, cells = core.vtkPoints(), data.vtkCellArray()
        points.SetDataTypeToDouble()
        for p in positions:
            points.InsertNextPoint(p)
        for facet in facets:
            cells.InsertNextCell(len(facet), facet)
        mesh = data.vtkPolyData()
        mesh.SetPoints(points)
        mesh.SetPolys(cells)
        writer.SetInputData(mesh)
        writer.SetFileName(name)
        if text is not None:
            writer.SetFileTypeToASCII() if text else writer.SetFileTypeToBinary()
        writer.Write()
        expect(name, len(facets), DIGITS)

    for text in (False, True):
        written("a.stl", geometry.vtkSTLWriter(), triangles_of(polygons), text)
        written("a.ply", ply.vtkPLYWriter(), polygons, text)
    written("a.obj", geometry.vtkOBJWriter(), polygons)


def blender():
    program = need_program("blender")
    positions, polygons = prepare()
    script = ("import bpy; bpy.ops.wm.read_factory_settings(use_empty=True); m = bpy.data.meshes.new('m'); "
              f"m.from_pydata({positions!r}, [], {polygons!r}); o = bpy.data.objects.new('o', m); "
              "bpy.context.collection.objects.link(o); o.select_set(True); bpy.context.view_layer.objects.active = o; "
              "z = dict(axis_forward='Y', axis_up='Z'); bpy.ops.export_mesh.stl(filepath='a.stl', **z); "
              "bpy.ops.export_mesh.stl(filepath='text.stl', ascii=True, **z); "
              "bpy.ops.export_mesh.ply(filepath='a.ply', use_normals=False, **z); "
              "bpy.ops.export_mesh.ply(filepath='text.ply', use_ascii=True, use_normals=False, **z); "
              "bpy.ops.wm.obj_export(filepath='a.obj', forward_axis='Y', up_axis='Z')")
    with open("write.py", "w") as file:
        file.write(script)
    run(program, "-b", "--python-exit-code", "1", "--python", os.path.abspath("write.py"))
    for name in ("a.stl", "text.stl", "a.ply", "text.ply", "a.obj"):
        expect(name, len(triangles_of(polygons) if "stl" in name else polygons), DIGITS)


def meshlab():
    program, display = need_program("meshlabserver"), need_program("xvfb-run")
    _, polygons = prepare()
    for form in ("ply", "obj", "off", "stl"):
        run(display, "-a", program, "-i", "part.off", "-o", "a." + form)
        faces = info("a." + form)["mesh"]["faces"]
        check(faces in (len(polygons), len(triangles_of(polygons))), f"{form} has {faces} facets")
        expect("a." + form, faces, DIGITS)


def cloudcompare():
    program = need_program("CloudCompare", "cloudcompare.CloudCompare")
    _, polygons = prepare()
    for form in ("PLY", "OBJ", "OFF", "STL"):
        run(program, "-SILENT", "-O", "part.off", "-M_EXPORT_FMT", form, "-SAVE_MESHES", "FILE", "a." + form.lower(),
            env={**os.environ, "QT_QPA_PLATFORM": "offscreen"})
        expect("a." + form.lower(), len(triangles_of(polygons)), DIGITS)


if __name__ == "__main__":
    in_folder({"assimp": assimp, "meshio": meshio, "vtk": vtk, "blender": blender, "meshlab": meshlab,
               "cloudcompare": cloudcompare}[sys.argv[1]])
