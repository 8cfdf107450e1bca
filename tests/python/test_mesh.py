"""The mesh as Python has it."""

import pickle

import numpy as np
import pytest

import hsdm


def test_arrays_are_views_of_one_memory_that_outlives_the_mesh(box):
    mesh = hsdm.reconstruct(*box, depth=4)
    for name in ("vertices", "face_vertices", "face_offsets", "normals", "sharp_edges"):
        array = getattr(mesh, name)
        again = getattr(hsdm.Mesh._of(mesh._polygons), name)
        assert array.__array_interface__["data"][0] == again.__array_interface__["data"][0], name
        assert array.base is mesh._polygons, name
    vertices, copied = mesh.vertices, mesh.vertices.copy()
    del mesh, array, again
    hsdm.reconstruct(*box, depth=3)
    assert (vertices == copied).all()


def test_arrays_are_read_only(box_mesh):
    for array in (box_mesh.vertices, box_mesh.quads, box_mesh.colors, *box_mesh.properties.values()):
        if array is not None:
            with pytest.raises(ValueError, match="read-only"):
                array[0] = 0


def test_arrays_have_the_types_and_shapes_that_are_promised(adaptive_mesh):
    mesh, n = adaptive_mesh, len(adaptive_mesh.vertices)
    assert mesh.vertices.dtype == np.float64 and mesh.vertices.shape == (n, 3)
    assert mesh.normals.dtype == np.float64 and mesh.normals.shape == (n, 3)
    for array in (mesh.face_offsets, mesh.face_vertices, mesh.quads, mesh.triangles, mesh.sharp_edges):
        assert array.dtype == np.uint32
    assert mesh.vertex_classes.dtype == np.uint8 and mesh.vertex_classes.shape == (n,)
    assert mesh.crease_normals.shape == (n, 3, 3)
    assert mesh.colors is None and mesh.confidence is None and mesh.completed is None
    assert "hsdm_level" in mesh.properties


def test_faces_of_all_sizes_are_all_faces(adaptive_mesh):
    mesh = adaptive_mesh
    assert mesh.face_offsets[-1] == len(mesh.face_vertices)
    sizes = mesh.face_sizes
    assert sum(len(mesh.faces_of_size(size)) for size in np.unique(sizes)) == mesh.face_count
    by_hand = [face.tolist() for face in mesh.faces() if len(face) == 4]
    assert mesh.quads.tolist() == by_hand
    assert len(mesh.triangles) == mesh.report["mesh"]["triangles"]
    assert mesh.faces_of_size(99).shape == (0, 99)


def test_triangles_cover_the_faces(box_mesh):
    triangles = box_mesh.triangulated()
    assert len(triangles) == (box_mesh.face_sizes - 2).sum()
    a, b, c = box_mesh.vertices[triangles].transpose(1, 0, 2)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    assert area == pytest.approx(2 * (2 * 1 + 2 * 1.5 + 1 * 1.5), rel=1e-9)
    volume = (a * np.cross(b, c)).sum() / 6
    assert volume == pytest.approx(box_mesh.topology()["signed_volume"])


def test_sharp_edges_are_sides_of_faces(box_mesh):
    following = np.concatenate([np.roll(face, -1) for face in box_mesh.faces()])
    sides = {tuple(sorted(side)) for side in zip(box_mesh.face_vertices.tolist(), following.tolist())}
    assert {tuple(edge) for edge in box_mesh.sharp_edges.tolist()} <= sides
    assert len(box_mesh.sharp_edges) == box_mesh.report["features"]["sharp_edges"] > 0


def test_a_pickled_mesh_is_the_same(torus):
    points, normals = torus
    mesh = hsdm.reconstruct(points, normals, normals * 0.5 + 0.5, confidence=True, depth=4)
    again = pickle.loads(pickle.dumps(mesh))
    assert again.digest() == mesh.digest()
    assert again.report == mesh.report
    for name in ("normals", "sharp_edges", "colors", "crease_normals"):
        assert (getattr(again, name) == getattr(mesh, name)).all(), name
    assert list(again.properties) == list(mesh.properties)
    for name, values in mesh.properties.items():
        assert again.properties[name].dtype == values.dtype, name
        assert (again.properties[name] == values).all(), name


def test_a_mesh_is_made_of_arrays_of_ones_own():
    tetrahedron = hsdm.Mesh(
        [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
        [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
        properties={"weight": [1.5, 2, 3, 4], "mark": np.array([1, 2, 3, 4], np.uint8)},
        sharp_edges=[[1, 0]],
        report={"made": "here"},
    )
    topology = tetrahedron.topology()
    assert topology["closed"] and topology["signed_volume"] == pytest.approx(1 / 6)
    assert tetrahedron.sharp_edges.tolist() == [[0, 1]]
    assert tetrahedron.properties["weight"].tolist() == [1.5, 2, 3, 4]
    assert tetrahedron.properties["mark"].dtype == np.uint8
    assert tetrahedron.report == {"made": "here"}
    assert repr(tetrahedron) == "<hsdm.Mesh: 4 vertices, 4 faces>"


def test_a_mesh_without_faces_is_a_cloud():
    cloud = hsdm.Mesh(np.zeros((2, 3)), ())
    assert cloud.face_count == 0 and list(cloud.faces()) == []
    assert cloud.quads.shape == (0, 4) and cloud.triangulated().shape == (0, 3)


@pytest.mark.parametrize(
    "arguments, options, words",
    [
        (([[0, 0, 0]], [[0, 0, 1]]), {}, "a face refers to vertex 1, but there are 1"),
        (([[0, 0, 0]], [[0, 0]]), {}, "face 0 has fewer than three"),
        (([[0, 0, 0]], [0, 0, 0], [0, 2]), {}, "face_offsets must begin with 0 and end with 3"),
        (([[0, 0, 0]], [0, 0, 0], []), {}, "face_offsets must begin with 0"),
        (([[0, 0, 0]], [0, 0, 0], [0, 4, 3]), {}, "face 1 has fewer than three"),
        (([[0, 0, 0]], [0, 0, 0]), {}, r"face_vertices: shape \(3,\) came"),
        (([[0, 0, 0]], [[0, 0, -1]]), {}, "face_vertices: -1 to 0 came"),
        (([[0, 0, 0]], [[0, 0, 0]]), {"normals": np.zeros((2, 3))}, "normals: shape"),
        (([[0, 0, 0]], [[0, 0, 0]]), {"sharp_edges": [[0, 1]]}, "a sharp edge refers to vertex 1"),
        (([[0, 0, 0]], [[0, 0, 0]]), {"properties": {"a": [1, 2]}}, "property a: shape"),
    ],
)
def test_indices_that_lead_nowhere_and_arrays_that_do_not_fit_are_refused(arguments, options, words):
    with pytest.raises(ValueError, match=words):
        hsdm.Mesh(*arguments, **options)


def test_indices_that_are_no_integers_are_refused():
    with pytest.raises(TypeError, match="one of integers is wanted"):
        hsdm.Mesh(np.zeros((3, 3)), [[0.0, 1.0, 2.0]])


def test_stages_run_in_their_order_and_leave_another_mesh(torus):
    mesh = hsdm.reconstruct(*torus, depth=5)
    small = mesh.process("decimate:facets=500", "classify")
    assert small.face_count == pytest.approx(500, abs=2)
    assert small.topology()["genus"] == 1
    assert [stage["call"] for stage in small.report["stages"]] == ["decimate:facets=500", "classify"]
    assert mesh.report["stages"] == []


@pytest.mark.parametrize("stage", ["decimate:faces=500", "decimat", "", "transfer"])
def test_a_stage_that_there_is_not_is_named(box_mesh, stage):
    with pytest.raises(hsdm.OptionError, match=stage[:7]):
        box_mesh.process(stage)


def test_stages_refuse_what_is_no_2_manifold_or_too_large_to_be_measured(box_mesh):
    fin = hsdm.Mesh(np.eye(5, 3), [[0, 1, 2], [0, 1, 3], [0, 1, 4]])
    with pytest.raises(hsdm.CloudError, match="half-edge mesh cannot hold"):
        fin.process("classify")
    huge = hsdm.Mesh(box_mesh.vertices * 1e40, box_mesh.face_vertices, box_mesh.face_offsets)
    with pytest.raises(hsdm.CloudError, match="scale the mesh"):
        huge.process("classify")
