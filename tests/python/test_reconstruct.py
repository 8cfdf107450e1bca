"""What comes out of a reconstruction, whatever way its points come in."""

import numpy as np
import pytest

import hsdm
from conftest import scan_of_torus


def directed_edges(mesh):
    ends = np.concatenate([np.roll(face, -1) for face in mesh.faces()])
    return mesh.face_vertices, ends


def test_a_box_is_closed_and_has_the_euler_characteristic_of_a_sphere(box_mesh):
    begins, ends = directed_edges(box_mesh)
    sides = set(zip(begins.tolist(), ends.tolist()))
    assert len(sides) == len(begins)
    assert all((end, begin) in sides for begin, end in sides)
    assert len(box_mesh.vertices) - len(sides) // 2 + box_mesh.face_count == 2
    assert box_mesh.report["mesh"]["closed"] is True
    assert box_mesh.report["mesh"]["euler"] == 2


def test_a_torus_has_genus_one_and_its_volume(torus):
    points, normals = torus
    mesh = hsdm.reconstruct(points, normals, depth=5)
    topology = mesh.topology()
    assert (topology["euler"], topology["genus"], topology["closed"]) == (0, 1, True)
    assert topology["signed_volume"] == pytest.approx(2 * np.pi**2 * 0.4**2, rel=0.02)


def test_a_box_has_its_edges_corners_and_normals(box_mesh):
    corners = box_mesh.vertices[box_mesh.vertex_classes == 2]
    assert len(corners) == 8
    assert np.abs(np.abs(corners) - [1, 0.5, 0.75]).max() < 1e-9
    sharp = box_mesh.vertices[box_mesh.sharp_edges]
    length = np.linalg.norm(sharp[:, 0] - sharp[:, 1], axis=1).sum()
    assert length == pytest.approx(4 * (2 + 1 + 1.5), rel=1e-9)
    smooth = box_mesh.vertex_classes == 0
    assert np.abs(box_mesh.normals[smooth]).max(axis=1) == pytest.approx(1)
    count = box_mesh.properties["hsdm_normal_count"]
    assert (count[box_mesh.vertex_classes == 2] == 3).all()
    lengths = np.linalg.norm(box_mesh.crease_normals, axis=2)
    assert np.allclose(lengths, np.arange(3) < count[:, None], atol=1e-6)


def test_points_normals_and_options_reach_the_library(box):
    points, normals = box
    report = hsdm.reconstruct(points, normals, depth=3, method="basic", holes="keep").report
    assert report["input"]["points"] == len(points)
    assert report["input"]["has_normals"] is True
    assert report["grid"]["depth"] == 3
    assert report["options"]["method"] == "basic"
    assert report["options"]["holes"] == "keep"


@pytest.mark.parametrize(
    "options, key, value",
    [
        ({"voxel_size": 0.25}, ("grid", "voxel_size"), 0.25),
        ({"max_error": 0.01}, ("grid", "max_error"), 0.01),
        ({"grid": "adaptive"}, ("grid", "kind"), "adaptive"),
        ({"grid": "uniform"}, ("grid", "kind"), "uniform"),
        ({"threads": 1}, ("threads",), 1),
        ({"measure": False}, ("mesh", "faces"), 0),
        ({"classify": False}, ("features", "sharp_edges"), 0),
    ],
)
def test_each_option_does_what_it_says(torus, options, key, value):
    found = hsdm.reconstruct(*torus, **({} if "voxel_size" in options or "max_error" in options else {"depth": 4}), **options).report
    for part in key:
        found = found[part]
    assert found == value


def test_a_percentage_is_a_share_of_the_diagonal(torus):
    by_text = hsdm.reconstruct(*torus, max_error="1%")
    by_flag = hsdm.reconstruct(*torus, max_error=0.01, max_error_of_diagonal=True)
    assert by_text.digest() == by_flag.digest()
    box_of = by_text.report["input"]
    diagonal = np.linalg.norm(np.subtract(box_of["bbox_max"], box_of["bbox_min"]))
    assert by_text.report["grid"]["max_error"] == pytest.approx(diagonal / 100)


def test_small_components_are_dropped_if_asked_for(torus):
    small = scan_of_torus(4000, seed=2)
    points = np.concatenate([torus[0], small[0] * 0.3 + [3, 0, 0]])
    normals = np.concatenate([torus[1], small[1]])
    both = hsdm.reconstruct(points, normals, voxel_size=0.06)
    one = hsdm.reconstruct(points, normals, voxel_size=0.06, min_component="50%")
    same = hsdm.reconstruct(points, normals, voxel_size=0.06, min_component=0.5, min_component_of_largest=True)
    assert both.topology()["components"] == 2
    assert one.topology()["components"] == 1
    assert one.digest() == same.digest()


def test_confidence_and_completion_are_marked_on_vertices(torus):
    points, normals = torus
    seen = points[:, 0] < 0.9
    mesh = hsdm.reconstruct(points[seen], normals[seen], depth=4, holes="complete", confidence=True)
    assert mesh.topology()["closed"]
    assert mesh.confidence.min() >= 0 and mesh.confidence.max() <= 1
    assert set(np.unique(mesh.completed)) == {0, 1}
    assert mesh.confidence[mesh.completed == 1].mean() < mesh.confidence[mesh.completed == 0].mean()
    trimmed = hsdm.reconstruct(points[seen], normals[seen], depth=4, holes="complete", trim=0.3)
    assert not trimmed.topology()["closed"]


def test_colours_scalars_and_labels_become_values_of_vertices(torus):
    points, normals = torus
    colors = np.zeros((len(points), 3))
    colors[:, 0] = points[:, 2] > 0
    height = points[:, 2].astype(np.float32)
    side = np.where(points[:, 0] > 0, 7, -3)
    mesh = hsdm.reconstruct(points, normals, colors, scalars={"height": height}, labels={"side": side}, depth=5)
    assert mesh.colors.shape == (len(mesh.vertices), 4) and mesh.colors.dtype == np.uint8
    top = mesh.vertices[:, 2] > 0.1
    assert (mesh.colors[top] == [255, 0, 0, 255]).all()
    assert (mesh.colors[mesh.vertices[:, 2] < -0.1] == [0, 0, 0, 255]).all()
    assert np.abs(mesh.properties["height"] - mesh.vertices[:, 2]).max() < np.sqrt(3) * mesh.report["grid"]["voxel_size"]
    assert set(np.unique(mesh.properties["side"])) == {-3, 7}
    assert mesh.properties["side"].dtype == np.int32
    as_bytes = hsdm.reconstruct(points, normals, (colors * 255).astype(np.uint8), depth=5)
    assert (as_bytes.colors == mesh.colors).all()


def test_normals_are_estimated_where_there_are_none_and_turned_to_a_sensor(torus):
    points, _ = torus
    mesh = hsdm.reconstruct(points, sensor=(0, 0, 10), depth=4)
    assert mesh.report["input"]["has_normals"] is False
    assert mesh.topology()["closed"] and mesh.topology()["signed_volume"] > 0


def test_several_sensors_come_with_a_number_for_each_point(torus):
    points, normals = torus
    places = [(0, 0, 10), (0, 0, -10)]
    number = np.where(normals[:, 2] > 0, 0, 1)
    mesh = hsdm.reconstruct(points, sensors=places, sensor_of=number, depth=4)
    assert mesh.topology()["signed_volume"] > 0
    with pytest.raises(hsdm.CloudError, match="sensors"):
        hsdm.reconstruct(points, sensors=places, depth=4)


def test_one_octree_gives_a_mesh_for_each_level(box):
    meshes = hsdm.reconstruct_levels(box[0], 3, 5, box[1])
    assert [mesh.report["grid"]["depth"] for mesh in meshes] == [3, 4, 5]
    assert meshes[0].face_count < meshes[1].face_count < meshes[2].face_count
    assert all(mesh.topology()["euler"] == 2 for mesh in meshes)


def test_points_that_are_not_finite_are_skipped_and_counted(box):
    points, normals = (np.concatenate([array[:5000], array[:1]]) for array in box)
    points[-1] = np.nan
    report = hsdm.reconstruct(points, normals, depth=3).report
    assert report["input"]["dropped_nonfinite"] == 1
    assert report["input"]["first_nonfinite"] == 5000


def test_phases_are_written_to_a_folder(box, tmp_path):
    hsdm.reconstruct(*box, depth=3, debug_dir=tmp_path / "phases")
    assert any((tmp_path / "phases").rglob("*"))


def test_the_bits_depend_neither_on_threads_nor_on_the_order_of_points(torus):
    points, normals = torus
    order = np.random.default_rng(3).permutation(len(points))
    digests = {
        hsdm.reconstruct(points, normals, depth=5, threads=1).digest(),
        hsdm.reconstruct(points, normals, depth=5, threads=2).digest(),
        hsdm.reconstruct(points[order], normals[order], depth=5).digest(),
    }
    assert len(digests) == 1


def test_a_scaled_cloud_gives_the_scaled_mesh(torus):
    points, normals = torus
    mesh = hsdm.reconstruct(points, normals, depth=4)
    scaled = hsdm.reconstruct(points * 8, normals, depth=4)
    assert (scaled.vertices == mesh.vertices * 8).all()
    assert (scaled.face_vertices == mesh.face_vertices).all()


def test_compare_tells_how_far_apart_two_are(torus, box_mesh):
    points, normals = torus
    mesh = hsdm.reconstruct(points, normals, depth=5)
    assert hsdm.compare(mesh, mesh)["hausdorff"] == pytest.approx(0, abs=1e-12)
    result = hsdm.compare(points, mesh)
    assert result["a_to_b"]["max"] == pytest.approx(mesh.report["error"]["points_to_mesh_max"], rel=1e-6)
    assert result["a_to_b"]["median"] <= result["a_to_b"]["p95"] <= result["a_to_b"]["p99"]
    with pytest.raises(hsdm.OptionError, match="samples -1"):
        hsdm.compare(mesh, points, samples=-1)
    shifted = hsdm.Mesh(box_mesh.vertices + [0, 0, 10], box_mesh.face_vertices, box_mesh.face_offsets)
    assert hsdm.compare(box_mesh, shifted)["hausdorff"] == pytest.approx(10)
