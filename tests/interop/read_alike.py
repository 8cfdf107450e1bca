"""read_alike.py PROGRAM COMMAND: files of formats that no program at hand writes, read by PROGRAM and the command alike."""
import glob
import json
import math
import os
import subprocess
import sys

from common import check, farthest, in_folder, info, need_program, run, skip, sphere, write_xyz
from read_points import las_file

# Reads a LAS file as loaders.gl does and prints it as JSON. The module is looked for in NODE_PATH.
LOADER = """
(async () => {
    let core, las;
    try {
        [core, las] = [require('@loaders.gl/core'), require('@loaders.gl/las')];
    } catch (error) {
        process.exit(77);
    }
    const bytes = require('fs').readFileSync(process.argv[2]);
    const content = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
    const read = await core.parse(content, las.LASLoader, {worker: false, las: {fp64: true, colorDepth: 'auto'}});
    const all = Object.entries(read.attributes).map(([name, one]) => [name, Array.from(one.value)]);
    console.log(JSON.stringify(Object.fromEntries(all)));
})();
"""


def loaders():
    node = need_program("node")
    with open("read.cjs", "w") as file:
        file.write(LOADER)
    points, _, colors = sphere(shift=(2600000.0, 1200000.0, 400.0))
    for minor in (2, 3):  # it knows no 1.4
        for form in range(4):
            las_file("a.las", minor, form, points, colors, [1e-4, 1e-4, 1e-3], [2600000.0, 1200000.0, 0.0])
            done = subprocess.run([node, "read.cjs", "a.las"], stdout=subprocess.PIPE, text=True, timeout=60, check=False)
            if done.returncode == 77:
                skip("@loaders.gl/las (npm, by NODE_PATH)")
            read = json.loads(done.stdout)
            numbers = read["POSITION"]
            write_xyz("theirs.xyz", [numbers[i:i + 3] for i in range(0, len(numbers), 3)])
            check(len(numbers) == 3 * len(points) and farthest("a.las", "theirs.xyz") == 0, f"positions of 1.{minor}, {form}")
            check(set(read["intensity"]) == {77} and set(read["classification"]) == {2}, "intensity and class")
            check(form < 2 or read["COLOR_0"][:4] == [200, 100, 50, 255], "colours")


def scan_of_ptx(rays, angle, place, color):
    """A grid of rays, of which every seventh hit nothing."""
    c, s = math.cos(angle), math.sin(angle)
    axes = [[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]
    lines = [[12], [len(rays) // 12], place, *axes, *([*axis, 0] for axis in axes), [*place, 1]]
    for i, ray in enumerate(rays):
        lines.append(([0, 0, 0, 0.5] if i % 7 == 0 else [*ray, 0.25]) + color)
    return "".join(" ".join(map(repr, line)) + "\n" for line in lines)


def cloudcompare():
    program = need_program("CloudCompare", "cloudcompare.CloudCompare")
    rays, _, _ = sphere(240)
    for color in ([], [200, 100, 50]):
        first = scan_of_ptx(rays[:120], 0.3, [10.0, 20.0, 30.0], color)
        second = scan_of_ptx(rays[120:], -1.2, [12.0, 20.0, 31.0], color)
        for content, points in ((first, 102), (first + second, 204)):
            for left in glob.glob("*.asc"):
                os.remove(left)
            with open("a.ptx", "w") as file:
                file.write(content)
            run(program, "-SILENT", "-O", "a.ptx", "-C_EXPORT_FMT", "ASC", "-PREC", "12",
                *(["-MERGE_CLOUDS"] if points > 102 else ["-SAVE_CLOUDS"]), env={**os.environ, "QT_QPA_PLATFORM": "offscreen"})
            (theirs,) = glob.glob("*.asc")
            ours = info("a.ptx")["cloud"]
            check((ours["points"], ours["has_colors"]) == (points, bool(color)), f"{ours}")
            check(info(theirs)["cloud"]["points"] == points, "as many points")
            check(farthest("a.ptx", theirs) < 2e-6, "at the same places, to floats")  # beside a shift


if __name__ == "__main__":
    in_folder({"loaders": loaders, "cloudcompare": cloudcompare}[sys.argv[1]])
