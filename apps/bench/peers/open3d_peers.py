#!/usr/bin/env python3
"""open3d_peers.py ball-pivoting|poisson POINTS MESH VALUE... - the reconstructions of Open3D that docs/performance.md compares with.

POINTS is a PLY file with normals, MESH a PLY file. The value of `poisson` is the octree's depth, those of `ball-pivoting` the
radii of the balls.
"""
import sys

import open3d


def main():
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    method, source, target, *values = sys.argv[1:]
    open3d.utility.set_verbosity_level(open3d.utility.VerbosityLevel.Error)
    points = open3d.io.read_point_cloud(source)
    geometry = open3d.geometry.TriangleMesh
    if method == "poisson":
        mesh, _ = geometry.create_from_point_cloud_poisson(points, depth=int(values[0]))
    elif method == "ball-pivoting":
        radii = open3d.utility.DoubleVector([float(value) for value in values])
        mesh = geometry.create_from_point_cloud_ball_pivoting(points, radii)
    else:
        sys.exit(__doc__)
    if not open3d.io.write_triangle_mesh(target, mesh):
        sys.exit(f"{target}: cannot be written")


main()
