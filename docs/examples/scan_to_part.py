"""A scan becomes a part, step by step: python3 scan_to_part.py. The cells are a notebook's, where that is preferred."""

# %% A scan: 60,000 noisy points of a shaft with a collar. Yours comes by hsdm.read_points("scan.ply").
import numpy as np

import hsdm

random = np.random.default_rng(1)


def turned(radii, heights, points):
    """Points on what a line from (radius, height) to (radius, height) leaves as it turns, and their normals."""
    (r0, r1), (z0, z1) = radii, heights
    along = random.random(points)
    if r0 != r1:  # even over the area
        along = (np.sqrt(r0**2 + along * (r1**2 - r0**2)) - r0) / (r1 - r0)
    turn = random.uniform(0, 2 * np.pi, points)
    radius, height = r0 + along * (r1 - r0), z0 + along * (z1 - z0)
    out, up = np.array([z1 - z0, r0 - r1]) / np.hypot(r1 - r0, z1 - z0)
    circle = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    places = np.column_stack([radius[:, None] * circle, height])
    return places, np.column_stack([out * circle, np.full(points, up)])


profile = [(0, -2), (0.5, -2), (0.5, -0.3), (1, -0.3), (1, 0.3), (0.5, 0.3), (0.5, 2), (0, 2)]
areas = np.array([abs(r0 + r1) * np.hypot(r1 - r0, z1 - z0) for (r0, z0), (r1, z1) in zip(profile, profile[1:])])
shares = (60000 * areas / areas.sum()).astype(int)
pieces = [turned((r0, r1), (z0, z1), n) for (r0, z0), (r1, z1), n in zip(profile, profile[1:], shares)]
points, normals = (np.concatenate(arrays) for arrays in zip(*pieces))
points += random.normal(0, 0.002, points.shape)

# %% The part: as few facets as keep within 0.5 % of the diagonal.
part = hsdm.reconstruct(points, normals, max_error="0.5%", progress=lambda phase, done: print(f"{phase} {done:.0%}"))
print(part)

# %% What it is: a closed surface without handles, its edges marked.
topology = part.topology()
print("closed" if topology["closed"] else "open", "genus", topology["genus"], "volume", topology["signed_volume"])
begins, ends = part.vertices[part.sharp_edges].transpose(1, 0, 2)
print(f"{len(part.sharp_edges)} sharp edges, {np.linalg.norm(ends - begins, axis=1).sum():.2f} long")
print(f"{len(part.quads)} quads, {len(part.triangles)} triangles, {part.face_count} facets in all")

# %% How near it is to the points.
for name, length in hsdm.compare(points, part)["a_to_b"].items():
    print(f"{name:>6} {length:.5f}")
for warning in part.report["warnings"]:
    print("warning", warning["what"], warning["how_much"], "first at", warning["where"])

# %% Files: triangles to print, polygons with their properties to work on.
part.write("part.stl")
part.write("part.ply")
