#!/usr/bin/env python3
"""roofline.py - the phases of a reconstruction under the machine's two roofs: what it copies, and what it computes.

    python3 apps/bench/roofline.py [--points N] [--plot FILE]

On one thread. Seconds and bytes are those of `hsdm_bench phases`, instructions are counted by callgrind, exactly, so no
counters of the processor are needed: Debian's valgrind, installed before hsdm_bench is built, as that takes its header. The
roofs: bytes that copying large arrays reads and writes in a second, and instructions of a loop of independent additions.
"""
import argparse
import glob
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile

HOME = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))


def count_instructions(bench, options):
    """Per phase."""
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "callgrind")
        subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=" + out, bench, "phases", "--bare", *options],
                       check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        counts = {}
        for path in glob.glob(out + ".*"):
            with open(path) as file:
                text = file.read()
            name = re.search(r"^desc: Trigger: Client Request: (.+)$", text, re.M)
            if name:
                counts[name[1]] = int(re.search(r"^summary: (\d+)", text, re.M)[1])
    if not counts:
        sys.exit("roofline: hsdm_bench was built without valgrind's header: install valgrind and build it again")
    return counts


def with_rests(told, counts):
    """Phases with their instructions; of a whole what its parts leave."""
    rows = [dict(phase, instructions=counts[phase["name"]]) for phase in told["phases"]]
    parts = [row for row in rows if row["role"] == "part"]
    for row in rows:
        if row["role"] == "whole":
            row["name"] = "facets, the rest"
            for key in ("seconds", "instructions"):
                row[key] = max(row[key] - sum(part[key] for part in parts), 1e-9)
    return rows


def table(rows, told):
    points, bandwidth, peak = told["points"], told["copy_bytes_per_second"], told["additions_per_second"]
    lines = ["| phase | instructions per point | instructions per byte | 10^9 instructions/s | % of the roof | which |", "|" + "---|" * 6]
    for row in rows:
        if row["role"] == "whole":  # its rest has no bytes of its own
            lines.append(f"| {row['name']} | {row['instructions'] / points:,.0f} | | {row['instructions'] / row['seconds'] / 1e9:.2f} | | |")
            continue
        intensity, rate = row["instructions"] / row["bytes"], row["instructions"] / row["seconds"]
        roof = min(peak, intensity * bandwidth)
        lines.append(f"| {row['name']} | {row['instructions'] / points:,.0f} | {intensity:.2g} | {rate / 1e9:.2f} | "
                     f"{100 * rate / roof:.0f} | {'computing' if roof == peak else 'copying'} |")
    total, seconds = sum(row["instructions"] for row in rows), sum(row["seconds"] for row in rows)
    lines.append(f"| all | {total / points:,.0f} | | {total / seconds / 1e9:.2f} | | |")
    return "\n".join(lines)


def plot(rows, told):
    bandwidth, peak = told["copy_bytes_per_second"], told["additions_per_second"]
    left, right, top, bottom = 60, 700, 14, 380
    xs, ys = (0.3, 300), (0.5, 50)

    def across(x):
        return left + (right - left) * math.log(min(max(x, xs[0]), xs[1]) / xs[0]) / math.log(xs[1] / xs[0])

    def down(y):
        return bottom - (bottom - top) * math.log(min(max(y, ys[0]), ys[1]) / ys[0]) / math.log(ys[1] / ys[0])

    labels = []

    def free_height(x, y, name):
        """The nearest height at which the name covers no other."""
        width = 6 * len(name)
        for i in range(60):
            height = y + (-4 if i % 2 else 4) * ((i + 1) // 2)
            if all(abs(height - b) >= 11 or x >= a + w or a >= x + width for a, b, w in labels):
                break
        labels.append((x, height, width))
        return height

    parts = []
    for tick in (1, 10, 100):
        parts.append(f"<path stroke='#ddd' d='M{across(tick):.1f} {top}V{bottom}'/><text x='{across(tick) - 8:.1f}' y='{bottom + 16}'>{tick:g}</text>")
    for tick in (0.5, 1, 2, 5, 10, 20, 50):
        parts.append(f"<path stroke='#ddd' d='M{left} {down(tick):.1f}H{right}'/><text x='28' y='{down(tick) + 4:.1f}'>{tick:g}</text>")
    knee = peak / bandwidth
    foot = max(xs[0], ys[0] * 1e9 / bandwidth)
    parts.append(f"<path stroke='#d55e00' stroke-width='2' fill='none' d='M{across(foot):.1f} {down(foot * bandwidth / 1e9):.1f}"
                 f"L{across(knee):.1f} {down(peak / 1e9):.1f}H{right}'/>")
    parts.append(f"<text fill='#d55e00' x='{right - 260}' y='{down(peak / 1e9) - 6:.1f}'>copying {bandwidth / 1e9:.1f} GB/s, then "
                 f"{peak / 1e9:.1f} billion additions a second</text>")
    for row in rows:
        if row["role"] == "whole":
            continue
        x, y = across(row["instructions"] / row["bytes"]), down(row["instructions"] / row["seconds"] / 1e9)
        size = 2 + 10 * math.sqrt(row["seconds"] / sum(r["seconds"] for r in rows))
        parts.append(f"<circle cx='{x:.1f}' cy='{y:.1f}' r='{size:.1f}' fill='#0072b2' fill-opacity='0.6'/>"
                     f"<text x='{x + size + 2:.1f}' y='{free_height(x + size + 2, y + 4, row['name']):.1f}'>{row['name']}</text>")
    parts.append(f"<text x='{left}' y='{bottom + 34}'>instructions per byte read and made (areas of the dots: seconds)</text>"
                 f"<text transform='translate(14 {bottom}) rotate(-90)'>billion instructions a second</text>")
    return (f"<svg xmlns='http://www.w3.org/2000/svg' width='800' height='{bottom + 44}' font-family='sans-serif' font-size='11'>\n"
            f"<rect width='800' height='{bottom + 44}' fill='white'/>\n" + "\n".join(parts) + "\n</svg>\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--points", type=int, default=1000000, help="(%(default)s)")
    parser.add_argument("--shape", default="torus", help="of hsdm_generate (%(default)s)")
    parser.add_argument("--repeats", type=int, default=5, help="the fastest of so many runs counts (%(default)s)")
    parser.add_argument("--build", default=os.path.join(HOME, "build", "release"), help="where hsdm was built (%(default)s)")
    parser.add_argument("--plot", help="an SVG file")
    arguments = parser.parse_args()
    bench = os.path.join(arguments.build, "apps", "bench", "hsdm_bench")
    if not os.access(bench, os.X_OK):
        sys.exit(f"roofline: {bench}: no hsdm_bench; build it (sh cmake/bootstrap.sh build) or say where by --build")
    if not shutil.which("valgrind"):
        sys.exit("roofline: valgrind is not installed")
    options = ["--points", str(arguments.points), "--shape", arguments.shape, "--threads", "1"]
    told = json.loads(subprocess.run([bench, "phases", "--json", "--repeats", str(arguments.repeats), *options], check=True,
                                     capture_output=True, text=True).stdout)
    rows = with_rests(told, count_instructions(bench, options))
    print(table(rows, told))
    if arguments.plot:
        with open(arguments.plot, "w") as file:
            file.write(plot(rows, told))


main()
