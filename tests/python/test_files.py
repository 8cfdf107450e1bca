"""Files in and out, by the library's readers and writers."""

import json
import os
import pickle
import struct
import zipfile

import numpy as np
import pytest

import hsdm


@pytest.fixture
def scan(tmp_path, torus):
    points, normals = torus
    path = tmp_path / "scan.xyz"
    rows = np.concatenate([points, normals], axis=1)
    np.savetxt(path, rows, "%.17g")
    return path


def test_points_that_are_read_give_the_mesh_of_the_arrays(scan, torus):
    cloud = hsdm.read_points(scan)
    assert len(cloud) == len(torus[0]) and cloud.format == "xyz" and cloud.columns == "x,y,z,nx,ny,nz"
    assert (cloud.positions == torus[0]).all() and (cloud.normals == torus[1]).all()
    assert cloud.colors is None and cloud.sensor is None and cloud.sensors is None
    assert hsdm.reconstruct(cloud, depth=4).digest() == hsdm.reconstruct(*torus, depth=4).digest()
    assert repr(cloud) == "<hsdm.Points: 20,000 points with normals>"


def test_columns_say_what_a_table_holds(tmp_path, torus):
    points, normals = torus
    side = (points[:, 0] > 0).astype(int)
    path = tmp_path / "scan.csv"
    rows = np.column_stack([points, normals, side * 200, side * 100, side, side + 5, points[:, 2]])
    header = "x,y,z,nx,ny,nz,red,green,blue,classification,height"
    np.savetxt(path, rows, "%.9g", delimiter=",", header=header, comments="")
    cloud = hsdm.read_points(str(path))
    assert cloud.colors.shape == (len(points), 4)
    assert list(cloud.scalars) == ["height"] and list(cloud.labels) == ["classification"]
    mesh = hsdm.reconstruct(cloud, depth=4)
    assert set(np.unique(mesh.properties["classification"])) == {5, 6}
    assert np.abs(mesh.properties["height"] - mesh.vertices[:, 2]).max() < np.sqrt(3) * mesh.report["grid"]["voxel_size"]
    other = hsdm.reconstruct(cloud, labels={"classification": side + 1}, depth=4)
    assert set(np.unique(other.properties["classification"])) == {1, 2}
    plain = hsdm.read_points(path, columns="x,y,z,_,_,_,_,_,_,_,_")
    assert plain.normals is None and not plain.scalars
    with pytest.raises(hsdm.OptionError):
        hsdm.read_points(path, format="docx")


@pytest.mark.parametrize("name", ["part.off", "part.ply", "part.obj", "part.om"])
def test_a_mesh_that_is_written_reads_back_to_the_same_bits(tmp_path, adaptive_mesh, name):
    adaptive_mesh.write(tmp_path / name)
    again = hsdm.read_mesh(tmp_path / name)
    assert again.digest() == adaptive_mesh.digest()
    if name != "part.off":
        assert np.allclose(again.normals, adaptive_mesh.normals, atol=1e-12)
    if name in ("part.ply", "part.om"):
        assert (again.vertex_classes == adaptive_mesh.vertex_classes).all()
        assert (again.crease_normals == adaptive_mesh.crease_normals).all()
    if name == "part.om":
        assert sorted(again.sharp_edges.tolist()) == sorted(adaptive_mesh.sharp_edges.tolist())


def las_file(path, places, withheld):
    """LAS 1.2, point format 0, steps of a thousandth."""
    head = bytearray(227)
    head[0:4], head[24:26] = b"LASF", b"\x01\x02"
    struct.pack_into("<HIIBHI", head, 94, 227, 227, 0, 0, 20, len(places))
    struct.pack_into("<3d", head, 131, *[0.001] * 3)
    points = b"".join(
        struct.pack("<iiiHBBbBH", *(round(1000 * x) for x in place), 0, 9, 128 * (i in withheld), 0, 0, 0)
        for i, place in enumerate(places)
    )
    path.write_bytes(bytes(head) + points)


def test_points_that_a_las_file_marks_as_withheld_are_counted(tmp_path):
    places = [(0, 0, 0), (1, 2, 3), (4, 5, 6), (7, 8, 9)]
    las_file(tmp_path / "some.las", places, {1, 2})
    some = hsdm.read_points(tmp_path / "some.las")
    assert len(some) == 2 and some.withheld == 2 and some.first_withheld == pytest.approx((1, 2, 3))
    las_file(tmp_path / "none.las", places, ())
    none = hsdm.read_points(tmp_path / "none.las")
    assert len(none) == 4 and none.withheld == 0 and none.first_withheld is None


def test_the_report_tells_the_points_that_a_file_marks_as_withheld(tmp_path):
    angles = [(a, b) for a in np.arange(0, 6.2, 0.2) for b in np.arange(0.1, 3.1, 0.2)]
    around = [(np.cos(a) * np.sin(b), np.sin(a) * np.sin(b), np.cos(b)) for a, b in angles]
    las_file(tmp_path / "ball.las", around, {5, 7})
    points = hsdm.read_points(tmp_path / "ball.las")
    meshes = [hsdm.reconstruct(points, depth=3), *hsdm.reconstruct_levels(points, 2, 3)]
    for mesh in meshes:
        (told,) = mesh.report["dropped"]
        assert told["what"] == "points that the file marks as withheld" and told["count"] == 2
        assert told["where"] == pytest.approx(around[5], abs=0.001)
    assert hsdm.reconstruct(points.positions, depth=3).report["dropped"] == []


def test_glb_is_scaled_to_metres_and_3mf_says_its_unit(tmp_path, box_mesh):
    size = np.ptp(box_mesh.vertices, axis=0)
    for units, metres in ((None, 1), ("mm", 0.001), ("cm", 0.01), ("m", 1), ("in", 0.0254)):
        box_mesh.write(tmp_path / "part.glb", units=units)
        content = (tmp_path / "part.glb").read_bytes()
        scene = json.loads(content[20 : 20 + struct.unpack_from("<I", content, 12)[0]])
        (box,) = (one for one in scene["accessors"] if one["type"] == "VEC3" and "max" in one)
        extent = np.subtract(box["max"], box["min"]) * scene["nodes"][0].get("scale", [1, 1, 1])
        assert sorted(extent) == pytest.approx(sorted(size * metres), rel=1e-5), units
    for units, name in ((None, "millimeter"), ("in", "inch")):
        box_mesh.write(tmp_path / "part.3mf", units=units)
        with zipfile.ZipFile(tmp_path / "part.3mf") as parts:
            assert f'unit="{name}"'.encode() in parts.read("3D/3dmodel.model")
    with pytest.raises(hsdm.OptionError, match="units 'ft': must be None or one of mm, cm, m, in"):
        box_mesh.write(tmp_path / "other.glb", units="ft")
    assert not (tmp_path / "other.glb").exists()


def test_a_mesh_far_from_the_origin_is_written_round_it_and_the_shift_returned(tmp_path, box_mesh):
    far = hsdm.Mesh(box_mesh.vertices + [5e6, 0, -2e6], box_mesh.face_vertices, box_mesh.face_offsets)
    assert far.write(tmp_path / "as_it_is.off") == (0, 0, 0)
    shift = far.write(tmp_path / "round.off", recentre=True)
    again = hsdm.read_mesh(tmp_path / "round.off")
    assert np.abs(again.vertices).max() < 100
    assert np.abs(again.vertices + shift - far.vertices).max() < 1e-6


def test_stl_has_the_triangles(tmp_path, box_mesh):
    box_mesh.write(tmp_path / "part.stl")
    again = hsdm.read_mesh(tmp_path / "part.stl")
    assert len(again.triangles) == len(box_mesh.triangulated())
    assert again.topology()["closed"]
    box_mesh.write(tmp_path / "text.stl", ascii=True)
    assert (tmp_path / "text.stl").read_bytes().startswith(b"solid")


def test_names_need_not_be_utf_8(tmp_path, torus, box_mesh):
    folder = os.fsencode(tmp_path)
    path = folder + b"/caf\xe9.csv"
    with open(path, "wb") as file:
        file.write(b"x,y,z,nx,ny,nz,h\xf6he\n")
        np.savetxt(file, np.column_stack([*torus, torus[0][:, 2]]), "%.9g", delimiter=",")
    cloud = hsdm.read_points(path)
    (name,) = cloud.scalars
    assert os.fsencode(name) == b"h\xf6he"
    mesh = hsdm.reconstruct(cloud, depth=3, debug_dir=folder + b"/\xe9")
    assert name in mesh.properties and pickle.loads(pickle.dumps(mesh)).properties.keys() == mesh.properties.keys()
    mesh.write(os.fsdecode(folder + b"/\xfcber.ply"))
    assert name in hsdm.read_mesh(folder + b"/\xfcber.ply").properties
    with pytest.raises(hsdm.FileError) as caught:
        hsdm.read_points(folder + b"/\xff.ply")
    assert os.fsencode(caught.value.filename) == folder + b"/\xff.ply"


def test_every_format_that_is_named_is_known(tmp_path):
    assert {"ply", "pcd", "xyz", "pts", "om"} <= set(hsdm.point_formats)
    for name in hsdm.point_formats:
        with pytest.raises(hsdm.FileError, match="none"):
            hsdm.read_points(tmp_path / "none", format=name)
