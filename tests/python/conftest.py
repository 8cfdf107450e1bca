"""Scans that tests share, from seeds."""

import numpy as np
import pytest


def scan_of_box(points, seed=1, size=(2.0, 1.0, 1.5)):
    """Points and outward normals of an axis-aligned box round the origin."""
    random = np.random.default_rng(seed)
    half = np.asarray(size) / 2
    areas = np.array([half[1] * half[2], half[0] * half[2], half[0] * half[1]])
    axis = random.choice(3, points, p=areas / areas.sum())
    sign = random.choice([-1.0, 1.0], points)
    places = random.uniform(-half, half, (points, 3))
    rows = np.arange(points)
    places[rows, axis] = sign * half[axis]
    normals = np.zeros((points, 3))
    normals[rows, axis] = sign
    return places, normals


def scan_of_torus(points, seed=1):
    """Points and outward normals of a torus of radii 1 and 0.4."""
    random = np.random.default_rng(seed)
    around, along = random.uniform(0, 2 * np.pi, (2, points))
    normals = np.stack(
        [np.cos(around) * np.cos(along), np.cos(around) * np.sin(along), np.sin(around)], axis=1
    )
    centres = np.stack([np.cos(along), np.sin(along), np.zeros(points)], axis=1)
    return centres + 0.4 * normals, normals


@pytest.fixture(scope="session")
def box():
    return scan_of_box(20000)


@pytest.fixture(scope="session")
def torus():
    return scan_of_torus(20000)


@pytest.fixture(scope="session")
def box_mesh(box):
    import hsdm

    points, normals = box
    return hsdm.reconstruct(points, normals, depth=4)


@pytest.fixture(scope="session")
def adaptive_mesh(box):
    import hsdm

    points, normals = box
    return hsdm.reconstruct(points, normals, max_error="0.5%")
