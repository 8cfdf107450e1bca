"""read_points.py PROGRAM COMMAND: clouds as PROGRAM writes them, read by the command, against the same points as text."""
import os
import struct
import sys

from common import (check, farthest, hsdm, in_folder, info, need_module, need_program, run, sphere, write_xyz)

FLOAT = 3e-7  # what a float may move a point of the unit sphere by


def expect(path, tolerance, reference="ref.xyz", normals=None, colors=None, scalars=None):
    """The cloud holds the reference's points, and what is said of it."""
    cloud = info(path)["cloud"]
    check(farthest(path, reference) <= tolerance, f"{path} is {farthest(path, reference)} off")
    check(normals is None or cloud["has_normals"] == normals, f"{path} has normals: {cloud['has_normals']}")
    check(colors is None or cloud["has_colors"] == colors, f"{path} has colours: {cloud['has_colors']}")
    check(scalars is None or cloud["scalars"] == scalars, f"{path} has scalars {cloud['scalars']}")
    if colors:
        expect_color(path)


def expect_color(path):
    """The colour of all points is that of all vertices."""
    hsdm("reconstruct", path, "--depth", "3", "-o", "colored.ply", "--ascii", "--quiet")
    with open("colored.ply") as file:
        header, body = file.read().split("end_header\n")
    words = [line.split() for line in header.splitlines()]
    names = [w[2] for w in words if w[0] == "property" and w[1] != "list"]
    count = next(int(w[2]) for w in words if w[:2] == ["element", "vertex"])
    at = names.index("red")
    colors = {tuple(line.split()[at:at + 3]) for line in body.splitlines()[:count]}
    check(colors == {("200", "100", "50")}, f"{path} has colours {sorted(colors)[:5]}")


# ASPRS LAS 1.4 R15, tables 2 to 21: what stands in the records of each format behind the first 20 or 22 bytes.
GPS, RGB, NIR, WAVE = "d", "3H", "H", "BQIffff"
FORMATS = [[], [GPS], [RGB], [GPS, RGB], [GPS, WAVE], [GPS, RGB, WAVE],
           [GPS], [GPS, RGB], [GPS, RGB, NIR], [GPS, WAVE], [GPS, RGB, NIR, WAVE]]
SIZES = [20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67]


def las_point(form, xyz, color, withheld=False):
    record = struct.pack("<3iH", *xyz, 77)
    if form < 6:
        record += struct.pack("<BBbBH", 0b00001001, 2 | withheld << 7, -5, 1, 4)
    else:
        record += struct.pack("<BBBBhH", 0b00010001, withheld << 2, 2, 1, -500, 4)
    for part in FORMATS[form]:
        values = {GPS: [1e5], RGB: [257 * c for c in color], NIR: [1], WAVE: [1, 2, 3, 0.5, 0.1, 0.2, 0.3]}[part]
        record += struct.pack("<" + part, *values)
    check(len(record) == SIZES[form], f"record of format {form}")
    return record


def las_file(path, minor, form, points, colors, scale, offset, withheld=()):
    size = {2: 227, 3: 235, 4: 375}[minor]
    vlr = struct.pack("<H16sHH32s", 0, b"LASF_Projection", 34735, 8, b"keys") + b"\0" * 8
    evlr = struct.pack("<H16sHQ32s", 0, b"someone", 1, 5, b"behind") + b"12345" if minor == 4 else b""
    body = b"".join(las_point(form, [round((x - o) / s) for x, s, o in zip(p, scale, offset)], c, i in withheld)
                    for i, (p, c) in enumerate(zip(points, colors)))
    count = len(points)
    header = struct.pack("<4sHHIHH8sBB32s32sHHHIIBHI5I", b"LASF", 1, 0, 0, 0, 0, b"", 1, minor, b"OTHER", b"test", 1,
                         2026, size, size + len(vlr), 1, form, SIZES[form], count if minor < 4 else 0,
                         *(5 * [0]))
    header += struct.pack("<12d", *scale, *offset, *(6 * [0.0]))
    if minor >= 3:
        header += struct.pack("<Q", 0)
    if minor == 4:
        header += struct.pack("<QIQ15Q", size + len(vlr) + len(body), 1, count, *(15 * [0]))
    check(len(header) == size, f"header of version 1.{minor}")
    with open(path, "wb") as file:
        file.write(header + vlr + body + evlr)


def las():
    points, _, colors = sphere(shift=(2600000.0, 1200000.0, 400.0))
    scale, offset = [1e-4, 1e-4, 1e-3], [2600000.0, 1200000.0, 0.0]
    exact = [[round((x - o) / s) * s + o for x, s, o in zip(p, scale, offset)] for p in points]
    write_xyz("ref.xyz", exact)
    for minor in (2, 3, 4):
        for form in range(11 if minor == 4 else 6 if minor == 3 else 4):
            name = f"v{minor}_{form}.las"
            las_file(name, minor, form, points, colors, scale, offset)
            colored = form in (2, 3, 5, 7, 8, 10)
            scalars = ["intensity", "classification", "point_source_id"]
            cloud = info(name)["cloud"]
            check(farthest(name, "ref.xyz") == 0, f"{name} is not exact")
            check((cloud["has_colors"], cloud["scalars"]) == (colored, scalars), f"{name}: {cloud}")
    for minor, form in ((2, 1), (4, 6)):
        las_file("withheld.las", minor, form, points, colors, scale, offset, withheld={0, 7, 399})
        check(info("withheld.las")["cloud"]["withheld"] == 3, "withheld points are counted")
        check("withheld: 3" in hsdm("reconstruct", "withheld.las", "--depth", "3", "-o", "a.off"), "and told")
    expect_color("v4_7.las")
    expect_color("v2_2.las")


def numpy():
    np = need_module("numpy")
    points, normals, colors = sphere()
    write_xyz("ref.xyz", points)
    p, n, c = np.array(points), np.array(normals), np.array(colors)
    np.save("p.npy", p)
    expect("p.npy", 0, normals=False, colors=False)
    np.save("fortran.npy", np.asfortranarray(np.hstack([p, n])))
    expect("fortran.npy", 0, normals=True, colors=False)
    np.save("nine.npy", np.hstack([p, n, c]))
    expect("nine.npy", 0, normals=True, colors=True)
    np.save("big.npy", np.hstack([p, n, c]).astype(">f4"))
    expect("big.npy", FLOAT, normals=True, colors=True)
    np.save("grid.npy", p.reshape(20, 20, 3).astype(np.float32))
    expect("grid.npy", FLOAT)
    whole = np.rint(p * 1000).astype(np.int16)
    write_xyz("whole.xyz", whole.tolist())
    for kind in (np.int16, np.int32, np.int64, ">i4"):
        np.save("whole.npy", whole.astype(kind))
        expect("whole.npy", 0, reference="whole.xyz")
    kind = np.dtype([("label", "i8"), ("xyz", "f8", 3), ("normals", "f4", 3), ("rgb", "u1", 3), ("who", "U3")], align=True)
    table = np.zeros(len(p), kind)
    table["xyz"], table["normals"], table["rgb"] = p, n, c
    np.save("table.npy", table)
    expect("table.npy", 0, normals=True, colors=True, scalars=["label"])
    fields = np.core.records.fromarrays([*p.T, *n.T.astype(">f4")], names="x,y,z,nx,ny,nz")
    np.save("fields.npy", fields)
    expect("fields.npy", 0, normals=True)
    for save in (np.savez, np.savez_compressed):
        save("a.npz", points=p, normals=n.astype(np.float32), colors=c.astype(np.uint8), label=np.arange(len(p)))
        expect("a.npz", 0, normals=True, colors=True, scalars=["label"])
        save("a.npz", p)
        expect("a.npz", 0, normals=False)
        save("a.npz", pos=p, rgb=c / 255.0, weight=np.ones((len(p), 1)), name=np.array("a part"))
        expect("a.npz", 0, colors=True, scalars=["weight"])
        save("a.npz", table=table)
        expect("a.npz", 0, normals=True, colors=True)


def open3d():
    o3d, np = need_module("open3d"), need_module("numpy")
    points, normals, colors = sphere()
    write_xyz("ref.xyz", points)
    cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(points))
    cloud.normals = o3d.utility.Vector3dVector(normals)
    cloud.colors = o3d.utility.Vector3dVector(np.array(colors) / 255.0)
    for form, tolerance, has_normals, has_colors in (("pcd", FLOAT, True, True), ("ply", 1e-5, True, True),
                                                     ("xyz", 1e-9, False, False), ("xyzn", 1e-9, True, False),
                                                     ("xyzrgb", 1e-9, False, True), ("pts", 1e-9, False, True)):
        for text in (False, True):
            for packed in (False, True):
                check(o3d.io.write_point_cloud("a." + form, cloud, write_ascii=text, compressed=packed), form)
                expect("a." + form, tolerance, normals=has_normals, colors=has_colors)
    tensors = o3d.t.geometry.PointCloud(o3d.core.Tensor(np.array(points, np.float32)))
    tensors.point["normals"] = o3d.core.Tensor(np.array(normals, np.float32))
    tensors.point["colors"] = o3d.core.Tensor(np.array(colors, np.uint8))
    tensors.point["weight"] = o3d.core.Tensor(np.ones((len(points), 1), np.float32))
    for form in ("pcd", "ply", "npz"):
        check(o3d.t.io.write_point_cloud("t." + form, tensors), form)
        expect("t." + form, FLOAT, normals=True, colors=True, scalars=["weight"])


def write_pcd(path, points, normals, colors, width=None):
    """As text, organised if `width` is given, with pixels that saw nothing."""
    rows = []
    for p, n, c in zip(points, normals, colors):
        packed = struct.unpack("<f", struct.pack("<I", c[0] << 16 | c[1] << 8 | c[2]))[0]
        rows.append(" ".join(map(repr, [*p, packed, *n, 0.5])))
    if width:
        rows[width::7] = ["nan nan nan 0 nan nan nan nan"] * len(rows[width::7])
    with open(path, "w") as file:
        file.write("# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb normal_x normal_y normal_z curvature\n"
                   "SIZE 4 4 4 4 4 4 4 4\nTYPE F F F F F F F F\nCOUNT 1 1 1 1 1 1 1 1\n"
                   f"WIDTH {width or len(rows)}\nHEIGHT {len(rows) // width if width else 1}\n"
                   f"VIEWPOINT 1 2 3 1 0 0 0\nPOINTS {len(rows)}\nDATA ascii\n" + "\n".join(rows) + "\n")
    return [p for p, row in zip(points, rows) if not row.startswith("nan")]


def pcl():
    convert = need_program("pcl_convert_pcd_ascii_binary")
    points, normals, colors = sphere()
    write_xyz("ref.xyz", points)
    write_pcd("a.pcd", points, normals, colors)
    write_xyz("seen.xyz", write_pcd("grid.pcd", points, normals, colors, width=20))
    for form in ("0", "1", "2"):
        run(convert, "a.pcd", "b.pcd", form)
        expect("b.pcd", 1e-6, normals=True, colors=True, scalars=["curvature"])
        check(info("b.pcd")["cloud"]["sensor"] == [1, 2, 3], "the viewpoint")
        run(convert, "grid.pcd", "c.pcd", form)
        expect("c.pcd", 1e-6, reference="seen.xyz", normals=True, colors=True)
        check(info("c.pcd")["cloud"]["dropped_nonfinite"] == 55, "pixels without a point")
        # Of text PCL takes the packed colour for an integer, of which its PLY files have one where they announce three.
        for camera in ("0", "1") if form != "0" else ():
            for binary in ("0", "1"):
                run("pcl_pcd2ply", "-format", binary, "-use_camera", camera, "b.pcd", "b.ply")
                expect("b.ply", 2e-6, normals=True, colors=True)


def without_display(*words):
    return run(*words, env={**os.environ, "QT_QPA_PLATFORM": "offscreen"})


def cloudcompare():
    program = need_program("CloudCompare", "cloudcompare.CloudCompare")
    points, normals, colors = sphere()
    write_xyz("ref.xyz", points)
    with open("in.txt", "w") as file:
        for p, n, c in zip(points, normals, colors):
            file.write(" ".join(map(repr, [*p, *c, *n])) + "\n")
    for encoding in ("ASCII", "BINARY_LE", "BINARY_BE"):
        without_display(program, "-SILENT", "-O", "in.txt", "-C_EXPORT_FMT", "PLY", "-PLY_EXPORT_FMT", encoding, "-COORD_TO_SF",
                        "Z", "-SAVE_CLOUDS", "FILE", "out.ply")
        expect("out.ply", 1e-5, colors=True, scalars=["scalar_Coord._Z"])
    without_display(program, "-SILENT", "-O", "in.txt", "-C_EXPORT_FMT", "ASC", "-PREC", "12", "-SAVE_CLOUDS", "FILE", "out.asc")
    expect("out.asc", FLOAT, colors=True)
    far, _, _ = sphere(shift=(2600000.0, 1200000.0, 400.0))
    write_xyz("far.xyz", far)
    for form in ("PLY", "ASC"):
        without_display(program, "-SILENT", "-O", "-GLOBAL_SHIFT", "AUTO", "far.xyz", "-C_EXPORT_FMT", form, "-PREC", "12",
                        "-SAVE_CLOUDS", "FILE", "far." + form.lower())
        # Floats of coordinates that are less a shift of whole hundreds.
        expect("far." + form.lower(), 3e-5, reference="far.xyz")


def meshlab():
    program, display = need_program("meshlabserver"), need_program("xvfb-run")
    points, normals, colors = sphere()
    write_xyz("ref.xyz", points)
    write_pcd("in.pcd", points, normals, colors)
    with open("in.ply", "w") as file:
        file.write(f"ply\nformat ascii 1.0\nelement vertex {len(points)}\n"
                   + "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
                   + "".join(f"property uchar {name}\n" for name in ("red", "green", "blue")) + "end_header\n")
        for p, n, c in zip(points, normals, colors):
            file.write(" ".join(map(repr, [*p, *n, *c])) + "\n")
    for form, has_colors in (("ply", True), ("xyz", False), ("obj", True), ("off", True)):
        run(display, "-a", program, "-i", "in.ply", "-o", "out." + form, "-m", "vc", "vn", "vq")
        expect("out." + form, 2e-6, normals=form != "off", colors=has_colors)


if __name__ == "__main__":
    in_folder({"las": las, "numpy": numpy, "open3d": open3d, "pcl": pcl, "cloudcompare": cloudcompare,
               "meshlab": meshlab}[sys.argv[1]])
