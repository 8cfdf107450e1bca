"""Scans that tests share, from seeds."""

import os
import sys

import numpy as np
import pytest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
from box_scan import scan_of_box


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
