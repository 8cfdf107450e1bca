"""write_meshes.py PROGRAM COMMAND: meshes as the command writes them, read by PROGRAM, against the same mesh as OFF."""
import ctypes
import json
import math
import os
import struct
import sys

from common import check, farthest, hsdm, in_folder, need_module, need_program, run, skip

COLORS = [[250, 10, 20], [10, 250, 20], [20, 30, 250], [250, 250, 10], [10, 250, 250], [128, 64, 3]]
FAR = (2600000.0, 1200000.0, 400.0)


def write_scan(path, shift=(0.0, 0.0, 0.0), size=40.0, count=12, closed=True):
    """A cube whose faces have colours, with a point in the middle of each of so many squares a side."""
    rows = []
    for face in range(6 if closed else 5):
        axis, side = face % 3, -1 if face < 3 else 1
        for i in range(count):
            for j in range(count):
                p = [(2 * k + 1 - count) / count * size / 2 for k in (i, j)]
                p.insert(axis, side * size / 2)
                n = [0.0, 0.0, 0.0]
                n[axis] = float(side)
                rows.append([*(x + s for x, s in zip(p, shift)), *n, *COLORS[face]])
    with open(path, "w") as file:
        file.write("x y z nx ny nz r g b\n" + "".join(" ".join(map(repr, row)) + "\n" for row in rows))


def reconstruct(output, *words, scan="scan.txt"):
    return hsdm("reconstruct", scan, "--depth", "3", "-o", output, *words)


def read_off(path):
    with open(path) as file:
        words = file.read().split()
    count, faces = int(words[1]), int(words[2])
    numbers = words[4:]
    positions = [tuple(map(float, numbers[3 * i:3 * i + 3])) for i in range(count)]
    at, polygons = 3 * count, []
    for _ in range(faces):
        corners = int(numbers[at])
        polygons.append(list(map(int, numbers[at + 1:at + 1 + corners])))
        at += 1 + corners
    return positions, polygons


def write_off(path, positions, polygons):
    with open(path, "w") as file:
        file.write(f"OFF\n{len(positions)} {len(polygons)} 0\n")
        file.writelines(" ".join(map(repr, p)) + "\n" for p in positions)
        file.writelines(" ".join(map(str, [len(f), *f])) + "\n" for f in polygons)


def y_up(positions, scale=1.0):
    """As glTF has it, where y points up and lengths are metres."""
    return [(x * scale, z * scale, -y * scale) for x, y, z in positions]


def prepare(shift=(0.0, 0.0, 0.0)):
    write_scan("scan.txt", shift)
    reconstruct("part.off", "--quiet")
    return read_off("part.off")


class Glb:
    """A file by the specification, glTF 2.0 section 4.4."""

    def __init__(self, path):
        data = open(path, "rb").read()
        magic, version, length, json_length, kind = struct.unpack("<4sIIII", data[:20])
        check((magic, version, length, kind) == (b"glTF", 2, len(data), 0x4E4F534A), "the GLB header")
        self.json = json.loads(data[20:20 + json_length])
        binary_length, kind = struct.unpack("<II", data[20 + json_length:28 + json_length])
        check(kind == 0x004E4942 and json_length % 4 == 0 and binary_length % 4 == 0, "the chunks")
        self.binary = data[28 + json_length:]
        check(len(self.binary) == binary_length == self.json["buffers"][0]["byteLength"], "the chunk's length")
        self.primitive = self.json["meshes"][0]["primitives"][0]

    def array(self, accessor):
        a = self.json["accessors"][accessor]
        view = self.json["bufferViews"][a["bufferView"]]
        kind, bits = {5126: ("f", 4), 5125: ("I", 4), 5123: ("H", 2)}[a["componentType"]]
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[a["type"]]
        check(view["byteOffset"] % 4 == 0 and view["byteLength"] == a["count"] * width * bits, "a view's length")
        flat = struct.unpack_from(f"<{a['count'] * width}{kind}", self.binary, view["byteOffset"])
        return [flat[i:i + width] for i in range(0, len(flat), width)]

    def attribute(self, name):
        return self.array(self.primitive["attributes"][name])

    def triangles(self):
        flat = [i for (i,) in self.array(self.primitive["indices"])]
        return [flat[i:i + 3] for i in range(0, len(flat), 3)]

    def world(self):
        """Positions, z up again, with the translation."""
        up, part = self.json["nodes"]
        half = math.sqrt(0.5)
        check(up["rotation"] == [-half, 0, 0, half] and up["children"] == [1], "the node that turns z up")
        shift = part.get("translation", [0, 0, 0])
        return [tuple(a + s for a, s in zip(p, shift)) for p in self.attribute("POSITION")]


def nearest(p, positions):
    return min(positions, key=lambda q: sum((a - b) ** 2 for a, b in zip(p, q)))


def distance(p, q):
    return math.sqrt(sum((a - b) ** 2 for a, b in zip(p, q)))


def srgb(light):
    x = light / 65535
    return round(255 * (12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055))


def check_glb(name, positions, scale, tolerance):
    glb = Glb(name)
    world = glb.world()
    bounds = glb.json["accessors"][glb.primitive["attributes"]["POSITION"]]
    stored = glb.attribute("POSITION")
    for k in range(3):
        check(bounds["min"][k] == min(p[k] for p in stored) and bounds["max"][k] == max(p[k] for p in stored), "bounds")
    for p in world:
        close = nearest(p, [tuple(x * scale for x in q) for q in positions])
        check(distance(p, close) <= tolerance, f"{name}: {p} is not {close}")
    check(max(max(t) for t in glb.triangles()) < len(world), "indices")
    return glb, world


def json_of_glb():
    positions, polygons = prepare()
    reconstruct("part.glb", "--quiet")
    glb, world = check_glb("part.glb", positions, 1, 1e-5)
    check(len(glb.triangles()) == sum(len(f) - 2 for f in polygons), "all triangles")
    check(len(world) > len(positions), "vertices on creases are there for each side")
    normals, colors = glb.attribute("NORMAL"), glb.attribute("COLOR_0")
    for a, b, c in glb.triangles():
        u, v = ([q - p for p, q in zip(world[a], world[other])] for other in (b, c))
        n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        for corner in (a, b, c):
            length = math.sqrt(sum(x * x for x in n))
            cosine = sum(x * y for x, y in zip(n, normals[corner])) / length
            check(cosine > 0.99, f"a normal of the cube's is {math.degrees(math.acos(min(1, cosine)))} degrees off")
    reconstruct("part.ply", "--ascii", "--quiet")
    with open("part.ply") as file:
        header, body = file.read().split("end_header\n")
    at = [line.split()[2] for line in header.splitlines() if line.startswith("property")].index("red")
    rows = [list(map(float, line.split())) for line in body.splitlines()[:len(positions)]]
    by_place = {tuple(row[:3]): row[at:at + 3] for row in rows}
    for p, color in zip(world, colors):
        wanted = by_place[nearest(p, list(by_place))]
        check([srgb(x) for x in color[:3]] == wanted and color[3] == 65535, f"colour {color} of {p}, not {wanted}")
    reconstruct("metres.glb", "--units", "mm", "--quiet")
    check_glb("metres.glb", positions, 0.001, 1e-8)
    positions, _ = prepare(FAR)
    reconstruct("far.glb", "--quiet")
    glb, _ = check_glb("far.glb", positions, 1, 1e-5)
    check(max(abs(x) for p in glb.attribute("POSITION") for x in p) < 100, "floats lie round the origin")
    reconstruct("plain.glb", "--plain", "--quiet")
    check(list(Glb("plain.glb").primitive["attributes"]) == ["POSITION"], "plain is positions alone")


def assimp():
    program = need_program("assimp")
    positions, polygons = prepare()
    write_off("up.off", y_up(positions), polygons)
    for form in ("glb", "3mf", "ply", "obj", "stl", "off"):
        for words in ([], ["--ascii"]) if form in ("ply", "stl") else ([],):
            reconstruct("part." + form, "--quiet", *words)
            run(program, "export", "part." + form, "read.ply", "-ptv")
            off = farthest("read.ply", "up.off" if form == "glb" else "part.off")
            check(off < 1e-4, f"{form} {words} is {off} off")


def vtk():
    vtk_io = need_module("vtkmodules.vtkIOGeometry")
    ply_io = need_module("vtkmodules.vtkIOPLY")
    positions, polygons = prepare()

    def read(reader, path):
        reader.SetFileName(path)
        reader.Update()
        return reader.GetOutput()

    triangles = sum(len(f) - 2 for f in polygons)
    for form, reader in (("stl", vtk_io.vtkSTLReader), ("obj", vtk_io.vtkOBJReader), ("ply", ply_io.vtkPLYReader)):
        reconstruct("part." + form, "--quiet")
        mesh = read(reader(), "part." + form)
        check(mesh.GetNumberOfCells() == (triangles if form == "stl" else len(polygons)), f"cells of {form}")
        if form != "obj":  # VTK splits these at texture coordinates and normals
            check(mesh.GetNumberOfPoints() == len(positions), f"points of {form}")
    reconstruct("part.glb", "--quiet")
    blocks = read(vtk_io.vtkGLTFReader(), "part.glb")
    while not hasattr(blocks, "GetPoints"):
        blocks = blocks.GetBlock(0)
    check(blocks.GetNumberOfCells() == triangles, "triangles of glb")
    check(blocks.GetPointData().GetNormals() is not None, "normals of glb")
    reconstruct("part.off", "--quiet", "--features", "lines.obj")
    reconstruct("part.off", "--quiet", "--features", "lines.txt")
    lines = read(vtk_io.vtkOBJReader(), "lines.obj")
    segments = [line for line in open("lines.txt") if line[0] != "c"]
    check(lines.GetNumberOfLines() == len(segments) > 0, "lines of obj")
    check(lines.GetNumberOfVerts() == 8, "corners of obj")


def meshio():
    module = need_module("meshio")
    positions, polygons = prepare()
    for form in ("ply", "obj", "stl"):  # of OFF its reader knows triangles alone
        for words in ([], ["--ascii"]) if form in ("ply", "stl") else ([],):
            reconstruct("part." + form, "--quiet", *words)
            mesh = module.read("part." + form)
            count = sum(len(block.data) for block in mesh.cells)
            check(count == (sum(len(f) - 2 for f in polygons) if form == "stl" else len(polygons)), f"cells of {form}")
            lowest = min(min(p) for p in mesh.points.tolist())
            check(abs(lowest - min(map(min, positions))) < 1e-5, f"points of {form}")
            if form == "ply":
                data = {name: values.tolist() for name, values in mesh.point_data.items()}
                check(mesh.points.tolist() == [list(p) for p in positions], "places to the last bit")
                check(sorted(set(data["hsdm_vertex_class"])) == [0, 1, 2], "classes")
                check(all(abs(sum(n * n for n in normal) - 1) < 1e-6 for normal in zip(data["nx"], data["ny"], data["nz"])),
                      "normals")
                check(data["hsdm_vertex_class"].count(2) == 8, "a cube has eight corners")


class Lib3mf:
    """The functions of its C interface that are needed."""

    def __init__(self):
        try:
            self.library = ctypes.CDLL("lib3MF.so.1")
        except OSError:
            skip("lib3MF.so.1")

    def call(self, name, *words):
        status = getattr(self.library, name)(*words)
        check(status == 0, f"{name}: {status:#x}")

    def read(self, path):
        """Unit, positions, triangles, whether it is a 2-manifold, warnings."""
        model, reader, meshes, mesh = (ctypes.c_void_p() for _ in range(4))
        self.call("lib3mf_createmodel", ctypes.byref(model))
        self.call("lib3mf_model_queryreader", model, b"3mf", ctypes.byref(reader))
        self.call("lib3mf_reader_readfromfileutf8", reader, path.encode())
        unit, warnings, more, count, triangles, manifold = (ctypes.c_uint32() for _ in range(6))
        self.call("lib3mf_reader_getwarningcount", reader, ctypes.byref(warnings))
        self.call("lib3mf_model_getunit", model, ctypes.byref(unit))
        self.call("lib3mf_model_getmeshobjects", model, ctypes.byref(meshes))
        self.call("lib3mf_resourceiterator_movenext", meshes, ctypes.byref(more))
        self.call("lib3mf_resourceiterator_getcurrent", meshes, ctypes.byref(mesh))
        self.call("lib3mf_meshobject_getvertexcount", mesh, ctypes.byref(count))
        self.call("lib3mf_meshobject_gettrianglecount", mesh, ctypes.byref(triangles))
        self.call("lib3mf_meshobject_ismanifoldandoriented", mesh, ctypes.byref(manifold))
        positions = (ctypes.c_float * 3 * count.value)()
        self.call("lib3mf_meshobject_getvertices", mesh, positions, count, None)
        return (unit.value, [tuple(p) for p in positions], triangles.value, manifold.value & 0xFF, warnings.value)


def lib3mf():
    library = Lib3mf()
    positions, polygons = prepare()
    for words, wanted in (([], 1), (["--units", "mm"], 1), (["--units", "cm"], 2), (["--units", "in"], 3), (["--units", "m"], 5)):
        reconstruct("part.3mf", "--quiet", *words)
        unit, read, triangles, manifold, warnings = library.read("part.3mf")
        check(unit == wanted, f"{words} became unit {unit}")
        check(triangles == sum(len(f) - 2 for f in polygons), "triangles")
        check(manifold == 1 and warnings == 0, f"manifold: {manifold}, warnings: {warnings}")
        check(len(read) == len(positions) and all(distance(p, q) < 1e-5 for p, q in zip(read, positions)), "positions")
    first = open("part.3mf", "rb").read()
    reconstruct("part.3mf", "--quiet", "--units", "m", "--threads", "1")
    check(open("part.3mf", "rb").read() == first, "the same bytes at another time")
    write_scan("open.txt", closed=False)
    reconstruct("open.3mf", "--quiet", "--holes", "keep", scan="open.txt")
    check(len(library.read("open.3mf")[1]) > 0, "a surface that is open")


def ezdxf():
    module = need_module("ezdxf")
    prepare()
    reconstruct("part.off", "--quiet", "--features", "lines.txt")
    reconstruct("part.off", "--quiet", "--features", "lines.dxf", "--units", "mm")
    text = open("lines.txt").read().splitlines()
    document = module.readfile("lines.dxf")
    check(not document.audit().has_errors, "the DXF file has no errors")
    space = document.modelspace()
    lines = [[*line.dxf.start, *line.dxf.end] for line in space.query("LINE")]
    check(lines == [list(map(float, row.split())) for row in text if row[0] != "c"], "lines")
    corners = [list(point.dxf.location) for point in space.query("POINT")]
    check(corners == [list(map(float, row.split()[1:])) for row in text if row[0] == "c"], "corners")
    check(len(lines) > 0 and len(corners) == 8, "a cube has edges and eight corners")
    check({line.dxf.layer for line in space.query("LINE")} == {"SHARP_EDGES"}, "layers")


def blender():
    program = need_program("blender")
    positions, polygons = prepare(FAR)
    reconstruct("part.glb", "--quiet")
    # Blender 3.4's importer asks NumPy for a name that 1.24 has no more.
    script = ("import bpy, numpy; numpy.bool = bool; bpy.ops.wm.read_factory_settings(use_empty=True); "
              "bpy.ops.import_scene.gltf(filepath='part.glb'); "
              "o = [o for o in bpy.data.objects if o.type == 'MESH'][0]; "
              "print('read', len(o.data.polygons), *(o.matrix_world @ o.data.vertices[0].co))")
    words = run(program, "-b", "--python-expr", script).split("read ")[1].split()
    check(int(words[0]) == sum(len(f) - 2 for f in polygons), "triangles")
    p = tuple(map(float, words[1:4]))
    check(distance(p, nearest(p, positions)) < 1, f"{p} is where the scan is, to Blender's floats")
    prepare()
    reconstruct("part.off", "--quiet", "--features", "lines.obj")
    script = ("import bpy; bpy.ops.wm.read_factory_settings(use_empty=True); bpy.ops.wm.obj_import(filepath='lines.obj'); "
              "print('read', *(len(o.data.edges) for o in bpy.data.objects))")
    lines = sum(line.startswith("l ") for line in open("lines.obj"))
    words = run(program, "-b", "--python-expr", script).split("read ")[1].split()
    check(int(words[0]) == lines > 0, f"{words[0]} lines of {lines}")


if __name__ == "__main__":
    in_folder({"json": json_of_glb, "assimp": assimp, "vtk": vtk, "meshio": meshio, "lib3mf": lib3mf, "ezdxf": ezdxf,
               "blender": blender}[sys.argv[1]])
