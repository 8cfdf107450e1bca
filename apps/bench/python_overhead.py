"""What calling from Python costs: PYTHONPATH=build/release/python python3 apps/bench/python_overhead.py [POINTS [RUNS]]

The report's total is the time of the library's own call, measured in it. All else is the module's: options, views of the
arrays, asking for signals, polygons and report as Python's objects.
"""

import statistics
import sys
import time

import numpy as np

import hsdm


def scan(points):
    random = np.random.default_rng(1)
    around, along = random.uniform(0, 2 * np.pi, (2, points))
    normals = np.stack([np.cos(around) * np.cos(along), np.cos(around) * np.sin(along), np.sin(around)], axis=1)
    centres = np.stack([np.cos(along), np.sin(along), np.zeros(points)], axis=1)
    return centres + 0.4 * normals, normals


def main():
    points = int(sys.argv[1]) if len(sys.argv) > 1 else 1000000
    runs = int(sys.argv[2]) if len(sys.argv) > 2 else 9
    places, normals = scan(points)
    hsdm.reconstruct(places[:10000], normals[:10000], depth=4)  # threads, pages
    for name, arrays, progress in (
        ("float64", (places, normals), None),
        ("float32 structs", structs(places, normals), None),
        ("float64, progress", (places, normals), lambda phase, done: True),
    ):
        calls, outside = [], []
        for _ in range(runs):
            begun = time.perf_counter()
            mesh = hsdm.reconstruct(*arrays, progress=progress)
            mesh.vertices, mesh.face_vertices, mesh.face_offsets, mesh.normals, mesh.report
            calls.append(time.perf_counter() - begun)
            outside.append(calls[-1] - mesh.report["seconds"]["total"])
        library = statistics.median(c - o for c, o in zip(calls, outside))
        print(f"{name:>18}: {points:,} points, {mesh.face_count:,} faces, library {library:.3f} s, "
              f"beside it {statistics.median(outside) * 1000:.1f} ms, {statistics.median(outside) / library:.2%}")


def structs(places, normals):
    hits = np.zeros(len(places), [("place", np.float32, 3), ("normal", np.float32, 3)])
    hits["place"], hits["normal"] = places, normals
    return hits["place"], hits["normal"]


if __name__ == "__main__":
    main()
