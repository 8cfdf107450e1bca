#!/usr/bin/env python3
"""benchmarks.py NAME BUILD SOURCE MICROBENCH - one test of the benchmarks: what they print is whole and agrees with itself."""
import json
import os
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

SKIPPED = 77
CUBE = [(x, y, z) for z in (-0.5, 0.5) for y in (-0.5, 0.5) for x in (-0.5, 0.5)]
SIDES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]


def fail(what):
    sys.exit(f"failed: {what}")


def expect(is_so, what):
    if not is_so:
        fail(what)


class Tools:
    def __init__(self, build, source, microbench):
        self.build, self.source, self.microbench = build, source, microbench

    def run(self, *command, status=0):
        told = subprocess.run([str(c) for c in command], capture_output=True, text=True)
        expect(told.returncode == status, f"{command}: status {told.returncode}: {told.stderr}")
        return told.stdout

    def bench(self, *arguments, status=0):
        return self.run(os.path.join(self.build, "apps", "bench", "hsdm_bench"), *arguments, status=status)

    def peers(self, *arguments):
        return self.run(sys.executable, os.path.join(self.source, "apps", "bench", "peers.py"), "--build", self.build, *arguments)


def rows_of(markdown):
    """Cells of the table's rows without its head."""
    lines = [line for line in markdown.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]


def write_off(path, sides):
    lines = ["OFF", f"{len(CUBE)} {len(sides)} 0"] + ["%g %g %g" % p for p in CUBE]
    with open(path, "w") as file:
        file.write("\n".join(lines + ["4 " + " ".join(map(str, side)) for side in sides]) + "\n")


def judge(tools, folder):
    """The solid's own surface is right to the judge; a side that is missing is told, and how far the points are then."""
    scan, mesh = os.path.join(folder, "scan.ply"), os.path.join(folder, "cube.off")
    tools.run(os.path.join(tools.build, "tests", "support", "hsdm_generate"), "box", "--points", 2000, "-o", scan)
    write_off(mesh, SIDES)
    whole = json.loads(tools.bench("judge", "box", scan, mesh, "--samples", 5000))
    expect(whole["closed"] and whole["manifold"] and whole["euler"] == 2 and whole["components"] == 1, whole)
    for key in ("points_to_mesh_max", "mesh_to_truth_max", "truth_to_mesh_max"):
        expect(whole[key] < 1e-12, f"{key}: {whole}")
    write_off(mesh, SIDES[:5])
    open_ = json.loads(tools.bench("judge", "box", scan, mesh, "--samples", 5000))
    expect(not open_["closed"] and open_["boundary_edges"] == 4 and open_["boundary_loops"] == 1, open_)
    expect(0.4 < open_["points_to_mesh_max"] <= 0.5 and open_["mesh_to_truth_max"] < 1e-12, open_)
    moved = json.loads(tools.bench("judge", "box", scan, mesh, "--turn", "--samples", 5000))
    expect(moved["mesh_to_truth_max"] > 0.01, f"the solid is turned: {moved}")
    tools.bench("judge", "box", scan, mesh + ".none", status=1)
    write_off(mesh, [])
    tools.bench("judge", "box", scan, mesh, status=1)


def phases(tools, folder):
    """The rows are all phases, their shares add up, and the plot is XML."""
    plot = os.path.join(folder, "phases.svg")
    rows = rows_of(tools.bench("phases", "--points", 3000, "--repeats", 1, "--plot", plot))
    names = [row[0] for row in rows]
    for name in ("reading", "octree", "sets", "grid points", "crossings", "signs", "links", "vertices", "facets", "error",
                 "features", "writing", "all"):
        expect(name in names, f"{name} in {names}")
    shares = sum(float(row[3]) for row in rows[:-1])
    expect(98 < shares < 102, f"shares: {shares}")
    reading = rows[names.index("reading")]
    expect(96 <= float(reading[6]) < 97, f"48 bytes of a point in the file, 48 in memory, and the file's head: {reading}")
    xml.etree.ElementTree.parse(plot)
    tools.bench("phases", "--points", 3000, "--repeats", 1, "--plot", os.path.join(folder, "none", "x.svg"), status=1)
    told = json.loads(tools.bench("phases", "--points", 3000, "--repeats", 1, "--json"))
    expect([p["name"] for p in told["phases"] if p["role"] == "whole"] == ["facets, whole"], told)
    expect(all(p["bytes"] > 0 for p in told["phases"]) and told["additions_per_second"] > 0, told)


def threads(tools, folder):
    """A column for each number of threads, and the ratio of the last."""
    plot = os.path.join(folder, "threads.svg")
    rows = rows_of(tools.bench("threads", "--points", 3000, "--repeats", 1, "--threads", "1,2,3", "--plot", plot))
    expect(rows[-1][0] == "all" and all(len(row) == 5 for row in rows), rows)
    first, last, ratio = (float(rows[-1][i]) for i in (1, 3, 4))
    expect(abs(ratio - first / last) < 0.1 * ratio + 0.01, rows[-1])
    xml.etree.ElementTree.parse(plot)


def growth(tools, folder):
    """A row for each size, with as many points a voxel as asked for."""
    plot = os.path.join(folder, "growth.svg")
    rows = rows_of(tools.bench("growth", "--sizes", "2000,8000", "--repeats", 1, "--points-per-voxel", 10, "--plot", plot))
    expect([row[0] for row in rows] == ["2000", "8000"], rows)
    for row in rows:
        expect(7 < float(row[0]) / float(row[1]) < 14, f"points of a voxel: {row}")
    xml.etree.ElementTree.parse(plot)


def yard(tools, _):
    """Programs and people are told the same things."""
    told = json.loads(tools.bench("yard", "--json", "--repeats", 1))
    expect(all(told[key] > 0 for key in ("sort_seconds", "copy_1_thread_gbs", "copy_all_threads_gbs", "threads")), told)
    expect(len(rows_of(tools.bench("yard", "--repeats", 1))[0]) == 3, "three yardsticks")


def microbench(tools, _):
    """Every phase that hsdm_bench knows is under google-benchmark; what is no size is refused."""
    if not tools.microbench:
        print("skipped: built without google-benchmark")
        sys.exit(SKIPPED)
    names = tools.run(tools.microbench, 2000, "--benchmark_list_tests").split("\n")
    expect("octree/2000/manual_time" in names and "writing/2000/manual_time" in names, names)
    told = tools.run(tools.microbench, 2000, "--benchmark_filter=signs", "--benchmark_min_time=0.01", "--benchmark_format=json")
    run = json.loads(told)["benchmarks"][0]
    expect(run["bytes"] > 0 and run["bytes/s"] > 0 and run["of copying"] > 0, run)
    tools.run(tools.microbench, "many", status=2)


def roofline(tools, folder):
    """Callgrind has counted every phase, and the plot is XML."""
    plot = os.path.join(folder, "roofline.svg")
    script = os.path.join(tools.source, "apps", "bench", "roofline.py")
    told = subprocess.run([sys.executable, script, "--build", tools.build, "--points", "2000", "--repeats", "1", "--plot", plot],
                          capture_output=True, text=True)
    if "valgrind" in told.stderr:
        print("skipped: " + told.stderr)
        sys.exit(SKIPPED)
    expect(told.returncode == 0, told.stderr)
    rows = rows_of(told.stdout)
    counted = [float(row[1].replace(",", "")) for row in rows if not row[0].endswith("the rest")] # a difference, maybe 0
    expect(len(rows) > 20 and all(count > 0 for count in counted), told.stdout)
    xml.etree.ElementTree.parse(plot)


def peers(tools, folder):
    """The table has hsdm's closed mesh and the right topology; methods that are not asked for are left out."""
    plot, kept = os.path.join(folder, "peers.svg"), os.path.join(folder, "peers.json")
    told = tools.peers("--only", "no such method", "--inputs", "torus:3000,part:20000", "--rounds", 2, "--work", folder,
                       "--plot", plot, "--json", kept)
    rows = [row for row in rows_of(told) if row[0] == "hsdm"]
    expect([(row[2], row[5], row[8], row[9], row[11]) for row in rows] == [("2", "1", "yes", "yes", "0"), ("2", "1", "yes", "yes", "-4")],
           told)
    xml.etree.ElementTree.parse(plot)
    with open(kept) as file:
        expect(len(json.load(file)) == 2, kept)


def limits(tools, folder):
    """A run that takes too long is ended and told, as are one that makes no mesh and a file that is none."""
    for name, body, limit, fault in (("slow", "sleep 60", 0.5, "over 0.5 s"), ("idle", "exit 0", 60, "no mesh"),
                                     ("bad", "exit 3", 60, "status 3"),
                                     ("odd", 'echo OFF >"$6"', 60, "| hsdm_bench judge: ")):
        program = os.path.join(folder, name)
        with open(program, "w") as file:
            real = os.path.join(tools.build, "apps", "hsdm", "hsdm")
            file.write(f'#!/bin/sh\n[ "$1" = reconstruct ] || exec {real} "$@"\n{body}\n')
        os.chmod(program, 0o755)
        told = tools.peers("--only", "no such method", "--inputs", "torus:1000", "--rounds", 1, "--work", folder, "--hsdm", program,
                           "--limit", limit)
        expect(fault in told, told)


def main():
    name, build, source, microbench_ = sys.argv[1:]
    tests = {t.__name__: t for t in (judge, phases, threads, growth, yard, microbench, roofline, peers, limits)}
    with tempfile.TemporaryDirectory() as folder:
        tests[name](Tools(build, source, microbench_), folder)


main()
