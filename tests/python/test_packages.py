"""Meshes of other packages: meshio as it is installed, the others also by stand-ins of what they are called with."""

import importlib.util
import sys
import types

import numpy as np
import pytest

import hsdm

has_vtk = importlib.util.find_spec("vtkmodules") is not None


@pytest.fixture(scope="module")
def coloured(torus):
    points, normals = torus
    return hsdm.reconstruct(points, normals, np.abs(normals), max_error="1%", confidence=True)


def test_meshio_gets_all_faces_and_properties(coloured, tmp_path):
    meshio = pytest.importorskip("meshio")
    made = coloured.to_meshio()
    assert isinstance(made, meshio.Mesh)
    assert (made.points == coloured.vertices).all()
    assert sum(len(block.data) for block in made.cells) == coloured.face_count
    quads = [block.data for block in made.cells if block.type == "quad"]
    assert (quads[0] == coloured.quads).all()
    assert made.point_data["hsdm_normals"].shape == (len(coloured.vertices), 9)
    assert (made.point_data["colors"] == coloured.colors).all()


def test_meshio_gets_faces_of_five_vertices_as_polygons(tmp_path):
    meshio = pytest.importorskip("meshio")
    turn = np.arange(5) * 2 * np.pi / 5
    made = hsdm.Mesh(np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1), [[0, 1, 2, 3, 4]]).to_meshio()
    made.write(tmp_path / "five.vtu")
    (block,) = meshio.read(tmp_path / "five.vtu").cells
    assert block.type.startswith("polygon") and block.data.tolist() == [[0, 1, 2, 3, 4]]


def test_what_meshio_writes_hsdm_reads(box_mesh, tmp_path):
    pytest.importorskip("meshio")
    box_mesh.to_meshio().write(tmp_path / "box.ply", binary=False)
    again = hsdm.read_mesh(tmp_path / "box.ply")
    assert np.allclose(again.vertices, box_mesh.vertices, atol=1e-6)
    assert again.topology()["euler"] == 2 and len(again.quads) == len(box_mesh.quads)


def test_what_hsdm_writes_meshio_reads(box_mesh, tmp_path):
    meshio = pytest.importorskip("meshio")
    for name in ("box.ply", "box.obj"):
        box_mesh.write(tmp_path / name)
        again = meshio.read(tmp_path / name)
        assert np.allclose(again.points, box_mesh.vertices, atol=1e-12), name
        assert sum(len(block.data) for block in again.cells) == box_mesh.face_count, name


@pytest.mark.skipif(not has_vtk, reason="VTK is not installed")
def test_faces_for_pyvista_are_polygons_of_vtk(coloured, monkeypatch):
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

    class PolyData(vtkPolyData):
        def __init__(self, vertices, faces):
            points = vtkPoints()
            points.SetData(numpy_to_vtk(vertices, deep=True))
            cells = vtkCellArray()
            cells.ImportLegacyFormat(numpy_to_vtkIdTypeArray(faces, deep=True))
            self.SetPoints(points)
            self.SetPolys(cells)
            self.point_data = {}

    monkeypatch.setitem(sys.modules, "pyvista", types.SimpleNamespace(PolyData=PolyData))
    made = coloured.to_pyvista()
    assert made.GetNumberOfCells() == coloured.face_count
    for number, face in enumerate(coloured.faces()):
        cell = made.GetCell(number)
        assert [cell.GetPointId(i) for i in range(cell.GetNumberOfPoints())] == face.tolist()
    assert all(len(values) == made.GetNumberOfPoints() and values.ndim <= 2 for values in made.point_data.values())


def test_trimesh_is_asked_to_keep_vertices_as_they_are(coloured, monkeypatch):
    calls = []
    monkeypatch.setitem(sys.modules, "trimesh", types.SimpleNamespace(Trimesh=lambda **given: calls.append(given) or "made"))
    assert coloured.to_trimesh() == "made"
    (given,) = calls
    assert given["process"] is False
    assert (given["vertices"] == coloured.vertices).all() and given["vertices"].flags.writeable
    assert (given["faces"] == coloured.triangulated()).all()
    assert (given["vertex_colors"] == coloured.colors).all()
    assert "red" not in given["vertex_attributes"] and "hsdm_confidence" in given["vertex_attributes"]


def test_trimesh_itself_agrees_on_volume_and_topology(box_mesh):
    pytest.importorskip("trimesh")
    made = box_mesh.to_trimesh()
    assert made.is_watertight and made.euler_number == 2
    assert made.volume == pytest.approx(3)


def test_pyvista_itself_agrees_on_area(box_mesh):
    pytest.importorskip("pyvista")
    made = box_mesh.to_pyvista()
    assert made.n_cells == box_mesh.face_count and made.is_all_triangles is not True
    assert made.area == pytest.approx(13)


@pytest.mark.parametrize("name", ["trimesh", "pyvista", "meshio"])
def test_a_package_that_is_missing_is_named(box_mesh, monkeypatch, name):
    monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(ImportError, match=f"{name} is not installed.*pip install {name}"):
        getattr(box_mesh, f"to_{name}")()
