"""The scan of a box that tests of the Python package and of the Blender add-on share, from seeds."""

import numpy as np


def scan_of_box(points=12000, seed=1, size=(2.0, 1.0, 1.5)):
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
