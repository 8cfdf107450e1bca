#!/usr/bin/env python3
"""peers.py - hsdm beside the reconstructions that Debian packages: whole runs, from file to file, on the same scans.

    python3 apps/bench/peers.py                                 the tables and the plot of docs/performance.md
    python3 apps/bench/peers.py --inputs part:20000 --rounds 1  one small scan, to try it
    python3 apps/bench/peers.py --list                          which methods there are, and which are absent

Needs hsdm, hsdm_bench and hsdm_generate, built (sh cmake/bootstrap.sh build). Peers are those that are installed of

    apt-get install libcgal-dev g++ pcl-tools python3-open3d meshlab xvfb

and PoissonRecon, which Debian 12 does not package, if a program of that name is on the PATH; absent ones are named as such.
CGAL has no programs: apps/bench/peers/cgal_peers.cc is compiled in the folder of --work, once.

In every round all methods run once, one after the other, each as a process of its own; a run that takes longer than
--limit seconds is ended. Before every round Y is measured: seconds of std::sort over 8 million random 64-bit numbers. What
counts are medians, of the seconds and of the ratios to hsdm's seconds in the same round. Files are converted for those who
read or write other formats, outside of the seconds. The meshes are judged by `hsdm_bench judge`.
"""
import argparse
import array
import json
import math
import os
import re
import shutil
import signal
import statistics
import subprocess
import sys
import threading
import time

HOME = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
SOURCES = os.path.join(HOME, "apps", "bench", "peers")
EULER = {"torus": 0, "part": -4, "sphere": 2, "box": 2, "cylinder": 2, "cup": 2, "plate": 2, "wedge": 2, "fillet": 2}
SEED = 1
CGAL_FLAGS = ("-std=c++17 -O3 -DNDEBUG -frounding-math -DCGAL_EIGEN3_ENABLED -DCGAL_LINKED_WITH_TBB "
              "-isystem /usr/include/eigen3").split()
SCREENED_POISSON = """<!DOCTYPE FilterScript>
<FilterScript>
 <filter name="Surface Reconstruction: Screened Poisson">
  <Param type="RichBool" name="visibleLayer" value="false"/>
  <Param type="RichInt" name="depth" value="{depth}"/>
  <Param type="RichInt" name="fullDepth" value="5"/>
  <Param type="RichInt" name="cgDepth" value="0"/>
  <Param type="RichFloat" name="scale" value="1.1"/>
  <Param type="RichFloat" name="samplesPerNode" value="1.5"/>
  <Param type="RichFloat" name="pointWeight" value="4"/>
  <Param type="RichInt" name="iters" value="8"/>
  <Param type="RichBool" name="confidence" value="false"/>
  <Param type="RichBool" name="preClean" value="false"/>
 </filter>
</FilterScript>
"""
BALL = """ <filter name="Surface Reconstruction: Ball Pivoting">
  <Param type="RichAbsPerc" name="BallRadius" value="{radius}" min="0" max="{extent}"/>
  <Param type="RichFloat" name="Clustering" value="20"/>
  <Param type="RichFloat" name="CreaseThr" value="90"/>
  <Param type="RichBool" name="DeleteFaces" value="false"/>
 </filter>
"""
BALL_RADII = 1.5, 3  # spacings


class Scan:
    """A scan of a solid, in general pose, and the resolution that suits it."""

    def __init__(self, tools, text, noise, folder):
        self.shape, count = text.split(":")
        self.points = int(count)
        self.name = f"{self.shape}-{self.points}"
        self.ply = os.path.join(folder, self.name + ".ply")
        self.pcd = os.path.join(folder, self.name + ".pcd")
        subprocess.run([tools["hsdm_generate"], self.shape, "--points", count, "--turn", "--seed", str(SEED),
                        "--noise", str(noise), "-o", self.ply], check=True)
        told = subprocess.run([tools["hsdm"], "info", self.ply, "--json"], check=True, capture_output=True, text=True)
        info = json.loads(told.stdout)
        self.spacing = info["cloud"]["spacing"]
        self.extent = max(hi - lo for lo, hi in zip(info["bbox_min"], info["bbox_max"]))
        # The deepest octree whose voxels are three spacings wide or more, as `hsdm` takes for itself.
        self.depth = max(1, math.floor(math.log2(self.extent / (3 * self.spacing))))
        self.voxel = self.extent / 2 ** self.depth

    def write_pcd(self):
        """PCL's own format: floats. Once."""
        if os.path.exists(self.pcd) and os.path.getmtime(self.pcd) >= os.path.getmtime(self.ply):
            return
        with open(self.ply, "rb") as file:
            while file.readline() != b"end_header\n":
                pass
            doubles = array.array("d", file.read())
        if sys.byteorder == "big":
            doubles.byteswap()
        rows = len(doubles) // 6
        head = (f"VERSION 0.7\nFIELDS x y z normal_x normal_y normal_z\nSIZE 4 4 4 4 4 4\nTYPE F F F F F F\n"
                f"COUNT 1 1 1 1 1 1\nWIDTH {rows}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {rows}\nDATA binary\n")
        with open(self.pcd, "wb") as file:
            file.write(head.encode())
            file.write(array.array("f", doubles).tobytes())


class Method:
    """A reconstruction: who makes it, whether it is there, the command of a run, and what comes before and after it."""

    def __init__(self, name, package, command, absent=None, before=None, after=None, suffix="ply", start=None):
        self.name, self.package, self.command, self.absent = name, package, command, absent
        self.before, self.after, self.suffix = before, after, suffix
        self.start = start  # a command that does no more than what is due before any work, if that is much


def installed(package):
    told = subprocess.run(["dpkg-query", "-W", "-f", "${db:Status-Status} ${Version}", package],
                          capture_output=True, text=True)
    return told.stdout.split()[1] if told.stdout.startswith("installed ") else None


def program_missing(program, package):
    return None if shutil.which(program) else f"{package} is not installed"


def python_with_open3d():
    for python in dict.fromkeys((sys.executable, "/usr/bin/python3")):
        if os.path.exists(python) and subprocess.run([python, "-c", "import open3d"], capture_output=True).returncode == 0:
            return python
    return None


def cgal_missing():
    found = os.path.exists("/usr/include/CGAL/version.h") and shutil.which("g++")
    return None if found else "libcgal-dev is not installed, or g++"


def build_cgal_peers(program):
    """Once. Raises CalledProcessError."""
    source = os.path.join(SOURCES, "cgal_peers.cc")
    if not os.path.exists(program) or os.path.getmtime(program) < os.path.getmtime(source):
        print("peers: compiling cgal_peers.cc, a minute or two", file=sys.stderr)
        subprocess.run(["g++", *CGAL_FLAGS, source, "-o", program, "-lgmp", "-lmpfr", "-ltbb", "-lpthread"], check=True)


def write_text(path, text):
    with open(path, "w") as file:
        file.write(text)


def vtk_to_ply(source, target):
    subprocess.run(["pcl_vtk2ply", source, target], check=True, capture_output=True)


def all_methods(tools, folder):
    cgal = os.path.join(folder, "cgal_peers")
    python = python_with_open3d()
    no_open3d = None if python else "python3-open3d is not installed"
    open3d = os.path.join(SOURCES, "open3d_peers.py")
    no_meshlab = program_missing("meshlabserver", "meshlab")
    if not no_meshlab and "DISPLAY" not in os.environ:
        no_meshlab = program_missing("Xvfb", "xvfb, which MeshLab needs,")

    def cgal_run(method, value=None):
        return dict(command=lambda s, out: [cgal, method, s.ply, out] + ([str(value(s))] if value else []),
                    before=lambda s: build_cgal_peers(cgal), absent=cgal_missing())

    def open3d_run(method, *values):
        return dict(command=lambda s, out: [python, open3d, method, s.ply, out, *(str(value(s)) for value in values)],
                    absent=no_open3d,
                    start=[python, "-c", "import open3d"])

    def meshlab_run(script_of):
        path = os.path.join(folder, "script.mlx")
        return dict(command=lambda s, out: ["meshlabserver", "-i", s.ply, "-o", out, "-s", path], absent=no_meshlab,
                    before=lambda s: write_text(path, script_of(s)))

    def balls(s):
        filters = [BALL.format(radius=r * s.spacing, extent=s.extent) for r in BALL_RADII]
        return "".join(["<!DOCTYPE FilterScript>\n<FilterScript>\n", *filters, "</FilterScript>\n"])

    def pcl_run(*command):
        return dict(command=lambda s, out: [command[0], s.pcd, out] + [str(c(s)) if callable(c) else c for c in command[1:]],
                    before=Scan.write_pcd, after=vtk_to_ply, suffix="vtk",
                    absent=program_missing(command[0], "pcl-tools"))

    depth, voxel = (lambda s: s.depth), (lambda s: s.voxel)
    return [
        Method("hsdm", None,
               lambda s, out: [tools["hsdm"], "reconstruct", s.ply, "--depth", str(s.depth), "-o", out, "--quiet"]),
        Method("PoissonRecon", None,
               lambda s, out: ["PoissonRecon", "--in", s.ply, "--out", out, "--depth", str(s.depth)],
               absent=None if shutil.which("PoissonRecon") else "Debian 12 does not package it, and it is not on the PATH"),
        Method("Open3D, Poisson", "python3-open3d", **open3d_run("poisson", depth)),
        Method("MeshLab, screened Poisson", "meshlab", **meshlab_run(lambda s: SCREENED_POISSON.format(depth=s.depth))),
        Method("PCL, Poisson", "pcl-tools", **pcl_run("pcl_poisson_reconstruction", "-depth", depth)),
        Method("CGAL, Poisson", "libcgal-dev", **cgal_run("poisson", voxel)),
        Method("CGAL, advancing front", "libcgal-dev", **cgal_run("advancing-front")),
        Method("CGAL, scale space", "libcgal-dev", **cgal_run("scale-space")),
        Method("Open3D, ball pivoting", "python3-open3d", **open3d_run("ball-pivoting", *(lambda s, r=r: r * s.spacing for r in BALL_RADII))),
        Method("MeshLab, ball pivoting", "meshlab", **meshlab_run(balls)),
        Method("PCL, greedy triangulation", "pcl-tools",
               **pcl_run("pcl_gp3_surface", "-radius", lambda s: 5 * s.spacing, "-mu", "3")),
    ]


class Screen:
    """An X server without a screen for MeshLab, for as long as the measurement takes."""

    def __init__(self, methods):
        self.needed = any(m.package == "meshlab" for m in methods) and "DISPLAY" not in os.environ
        self.server = None

    def __enter__(self):
        if not self.needed:
            return self
        read, write = os.pipe()
        self.server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "640x480x24"], pass_fds=[write],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as told:
            os.environ["DISPLAY"] = ":" + told.readline().strip()
        return self

    def __exit__(self, *_):
        if self.server:
            self.server.terminate()
            self.server.wait()


def timed_run(command, limit, log):
    """Seconds on the clock and of processors, peak megabytes, and what went wrong."""
    with open(log, "wb") as file:
        start = time.monotonic()
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=file, stderr=file, start_new_session=True)
        late = threading.Event()

        def end():
            late.set()
            os.killpg(process.pid, signal.SIGKILL)

        timer = threading.Timer(limit, end)
        timer.start()
        _, status, usage = os.wait4(process.pid, 0)
        seconds = time.monotonic() - start
        timer.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
    fault = f"over {limit:g} s" if late.is_set() else f"status {process.returncode}" if process.returncode else None
    return {"seconds": seconds, "processor": usage.ru_utime + usage.ru_stime, "megabytes": usage.ru_maxrss * 1024 / 1e6,
            "fault": fault}


def run_method(method, scan, arguments):
    folder = arguments.work
    stem = os.path.join(folder, re.sub(r"\W+", "-", method.name) + "-" + scan.name)
    out = f"{stem}.{method.suffix}"
    if os.path.exists(out):
        os.remove(out)
    try:
        if method.before:
            method.before(scan)
    except subprocess.CalledProcessError as error:
        return {"seconds": 0, "processor": 0, "megabytes": 0, "fault": f"not made ready: {error}"}, out
    run = timed_run(method.command(scan, out), arguments.limit, stem + ".log")
    if not run["fault"] and not os.path.exists(out):
        run["fault"] = "no mesh"
    return run, out


def judge(method, scan, out, tools):
    """What came out of the last run."""
    mesh = out + ".ply" if method.after else out
    try:
        if method.after:
            method.after(out, mesh)
    except subprocess.CalledProcessError as error:
        return {"fault": f"not converted: {error}"}
    told = subprocess.run([tools["hsdm_bench"], "judge", scan.shape, scan.ply, mesh, "--turn", "--seed", str(SEED)],
                          capture_output=True, text=True)
    return json.loads(told.stdout) if told.returncode == 0 else {"fault": told.stderr.strip()}


def measure_yard(tools):
    told = subprocess.run([tools["hsdm_bench"], "yard", "--json", "--repeats", "1"], check=True, capture_output=True, text=True)
    return json.loads(told.stdout)


def measure(scan, methods, arguments, tools):
    """All rounds of one scan."""
    result = {"scan": scan.name, "shape": scan.shape, "points": scan.points, "depth": scan.depth, "voxel": scan.voxel,
              "spacing": scan.spacing, "yards": [], "methods": {m.name: {"runs": []} for m in methods}}
    for round_ in range(arguments.rounds):
        result["yards"].append(measure_yard(tools))
        for method in methods:
            known = result["methods"][method.name]
            runs = known["runs"]
            if runs and (runs[-1]["fault"] or runs[-1]["seconds"] > arguments.once_above):
                continue
            print(f"peers: {scan.name}, round {round_ + 1}: {method.name}", file=sys.stderr)
            run, out = run_method(method, scan, arguments)
            run["round"] = round_
            runs.append(run)
            if method.start and "start" not in known:
                known["start"] = timed_run(method.start, arguments.limit, os.devnull)["seconds"]
            if not run["fault"] and "mesh" not in known:
                known["mesh"] = judge(method, scan, out, tools)
    return result


def summary(result, name):
    """Medians of a method: seconds, of hsdm's, in Y, megabytes; None if no run was whole."""
    whole = [r for r in result["methods"][name]["runs"] if not r["fault"]]
    if not whole:
        return None
    ours = {r["round"]: r["seconds"] for r in result["methods"]["hsdm"]["runs"] if not r["fault"]}
    ratios = [r["seconds"] / ours[r["round"]] for r in whole if r["round"] in ours]
    middle = statistics.median
    return {"seconds": middle(r["seconds"] for r in whole), "megabytes": max(r["megabytes"] for r in whole),
            "ratio": middle(ratios) if ratios else None, "runs": len(whole),
            "yards": middle(r["seconds"] / result["yards"][r["round"]]["sort_seconds"] for r in whole)}


def number(value):
    if value is None:
        return ""
    return f"{value:.3g}" if value < 100 else f"{value:,.0f}"


def mesh_cells(mesh, voxel):
    if "fault" in mesh:
        return [mesh["fault"]] + [""] * 7
    share = lambda key: number(100 * mesh[key] / voxel)
    sound = "yes" if mesh["closed"] else f"no, {mesh['boundary_edges']:,} open edges"
    return [f"{mesh['facets']:,}", sound, "yes" if mesh["manifold"] else "no", f"{mesh['components']:,}",
            f"{mesh['euler']:,}", f"{share('points_to_mesh_mean')} / {share('points_to_mesh_max')}",
            f"{share('mesh_to_truth_mean')} / {share('mesh_to_truth_max')}",
            f"{share('truth_to_mesh_mean')} / {share('truth_to_mesh_max')}"]


def version_of(method, tools):
    if method.package:
        return installed(method.package) or ""
    if method.name != "hsdm":
        return ""
    return subprocess.run([tools["hsdm"], "--version"], capture_output=True, text=True).stdout.split()[-1]


def table(result, methods, tools):
    """Markdown."""
    yards = result["yards"]
    y = statistics.median(yard["sort_seconds"] for yard in yards)
    expected = EULER.get(result["shape"])
    lines = [f"### {result['shape']}, {result['points']:,} points, depth {result['depth']}", "",
             f"Y {y:.2f} s, copying {statistics.median(yard['copy_all_threads_gbs'] for yard in yards):.1f} GB/s, threads: "
             f"{yards[0]['threads']}; one component"
             + (f" of Euler characteristic {expected}" if expected is not None else "") + " is right. Distances in % of a voxel.", "",
             "| method | version | runs | seconds | in Y | of hsdm's | MB | facets | closed | manifold | components | Euler | "
             "points to mesh, mean / max | mesh to truth | truth to mesh |", "|" + "---|" * 15]
    for method in methods:
        known, told = result["methods"][method.name], summary(result, method.name)
        if told is None:
            cells = ["0", known["runs"][-1]["fault"] if known["runs"] else "not run"] + [""] * 11
        else:
            cells = [str(told["runs"]), number(told["seconds"]), number(told["yards"]), number(told["ratio"]),
                     number(told["megabytes"])] + mesh_cells(known["mesh"], result["voxel"])
        lines.append("| " + " | ".join([method.name, version_of(method, tools)] + cells) + " |")
    starts = {m.package: result["methods"][m.name].get("start") for m in methods if m.start}
    lines += [""] * bool(starts) + [f"Of the seconds of {package}, {number(seconds)} pass before its work starts."
                                     for package, seconds in starts.items() if seconds]
    return "\n".join(lines)


def plot(results, methods):
    """SVG: for every scan a group of bars, seconds over those of hsdm, to a logarithmic scale."""
    rows = []
    for result in results:
        rows.append((f"{result['shape']}, {result['points']:,} points", None))
        for method in methods:
            told = summary(result, method.name)
            if told and told["ratio"]:
                rows.append((method.name, told))
    ratios = [told["ratio"] for _, told in rows if told] or [1]
    least, most = min(0.5, 0.8 * min(ratios)), max(20, 1.3 * max(ratios))
    left, right, height = 190, 640, 17

    def across(ratio):
        return left + (right - left) * math.log(ratio / least) / math.log(most / least)

    bottom = 12 + height * len(rows)
    parts = []
    for tick in (t * 10 ** e for e in range(-1, 5) for t in (1, 2, 5)):
        if least <= tick <= most:
            parts.append(f"<path stroke='{'#888' if tick == 1 else '#ddd'}' d='M{across(tick):.1f} 6V{bottom}'/>"
                         f"<text x='{across(tick):.1f}' y='{bottom + 14}' text-anchor='middle'>{tick:g}</text>")
    for i, (name, told) in enumerate(rows):
        y = 12 + height * i
        weight = "" if told else " font-weight='bold'"
        parts.append(f"<text x='{left - 8}' y='{y + 10}' text-anchor='end'{weight}>{name}</text>")
        if told:
            one, end = across(min(1, told["ratio"])), across(max(1, told["ratio"]))
            colour = "#0072b2" if name == "hsdm" else "#e69f00"
            parts.append(f"<rect x='{one - 1:.1f}' y='{y + 1}' width='{end - one + 2:.1f}' height='{height - 5}' fill='{colour}'/>"
                         f"<text x='{end + 6:.1f}' y='{y + 10}'>{number(told['ratio'])} ({number(told['seconds'])} s)</text>")
    parts.append(f"<text x='{left}' y='{bottom + 32}'>seconds of a whole run over those of hsdm</text>")
    return (f"<svg xmlns='http://www.w3.org/2000/svg' width='760' height='{bottom + 42}' font-family='sans-serif' "
            f"font-size='11'>\n<rect width='760' height='{bottom + 42}' fill='white'/>\n" + "\n".join(parts) + "\n</svg>\n")


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--inputs", default="torus:100000,part:100000,torus:1000000,part:1000000",
                        help="SHAPE:POINTS, of hsdm_generate (%(default)s)")
    parser.add_argument("--noise", type=float, default=0, help="standard deviation along the normal, in the solid's units")
    parser.add_argument("--rounds", type=int, default=3, help="in each of which every method runs once (%(default)s)")
    parser.add_argument("--limit", type=float, default=600, help="seconds, after which a run is ended (%(default)g)")
    parser.add_argument("--once-above", type=float, default=60,
                        help="seconds: methods that take longer run in one round alone (%(default)g)")
    parser.add_argument("--only", default="", help="a regular expression: hsdm and the methods whose names match")
    parser.add_argument("--build", default=os.path.join(HOME, "build", "release"), help="where hsdm was built (%(default)s)")
    parser.add_argument("--hsdm", help="another hsdm than that of --build")
    parser.add_argument("--work", default=os.path.join(HOME, "build", "peers"), help="for scans and meshes (%(default)s)")
    parser.add_argument("--plot", help="an SVG file: seconds over those of hsdm")
    parser.add_argument("--json", help="a file for all that was measured; written after every scan")
    parser.add_argument("--list", action="store_true", help="only say which methods there are")
    return parser.parse_args()


def find_tools(arguments):
    tools = {"hsdm": arguments.hsdm or os.path.join(arguments.build, "apps", "hsdm", "hsdm"),
             "hsdm_bench": os.path.join(arguments.build, "apps", "bench", "hsdm_bench"),
             "hsdm_generate": os.path.join(arguments.build, "tests", "support", "hsdm_generate")}
    for name, path in tools.items():
        if not os.access(path, os.X_OK):
            sys.exit(f"peers: {path}: no {name}; build it (sh cmake/bootstrap.sh build) or say where by --build")
    return tools


def main():
    arguments = parse_arguments()
    if arguments.rounds < 1:
        sys.exit("peers: --rounds must be at least 1")
    tools = find_tools(arguments)
    os.makedirs(arguments.work, exist_ok=True)
    known = [m for m in all_methods(tools, arguments.work) if m.name == "hsdm" or re.search(arguments.only, m.name)]
    methods = [m for m in known if not m.absent]
    absent = [f"- absent: {m.name}: {m.absent}" for m in known if m.absent]
    if arguments.list:
        print("\n".join([f"- {m.name}" for m in methods] + absent))
        return
    results = []
    with Screen(methods):
        for text in arguments.inputs.split(","):
            scan = Scan(tools, text, arguments.noise, arguments.work)
            results.append(measure(scan, methods, arguments, tools))
            print(table(results[-1], methods, tools), end="\n\n", flush=True)
            if arguments.json:
                write_text(arguments.json, json.dumps(results, indent=1) + "\n")
    print("\n".join(absent))
    if arguments.plot:
        write_text(arguments.plot, plot(results, methods))


if __name__ == "__main__":
    main()
