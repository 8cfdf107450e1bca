"""What both directions need: the command, a folder, and how a test is left out."""
import json
import math
import os
import random
import shutil
import subprocess
import sys
import tempfile

SKIPPED = 77  # CTest's SKIP_RETURN_CODE
COMMAND = sys.argv[2]


def skip(what):
    print(f"skipped: {what} is not installed")
    sys.exit(SKIPPED)


def need_program(*names):
    for name in names:
        if shutil.which(name):
            return name
    skip(names[0])


def need_module(name):
    try:
        return __import__(name, fromlist=["*"])
    except ImportError:
        skip(name)


def run(*words, **options):
    done = subprocess.run([str(word) for word in words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          timeout=120, **options)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, words))}: status {done.returncode}\n{done.stdout[-2000:]}")
    return done.stdout


def hsdm(*words):
    return run(COMMAND, *words)


def info(path):
    return json.loads(hsdm("info", path, "--json"))


def farthest(a, b):
    """The greatest distance between two clouds or meshes, both ways."""
    result = json.loads(hsdm("compare", a, b, "--json"))
    return max(result["a_to_b"]["max"], result["b_to_a"]["max"])


def check(condition, what):
    if not condition:
        raise SystemExit(f"failed: {what}")


def sphere(count=400, shift=(0.0, 0.0, 0.0)):
    """Points of the unit sphere, their normals, and colours that are the same in every tenth of it."""
    chance = random.Random(1)
    points, normals, colors = [], [], []
    while len(points) < count:
        v = [chance.gauss(0, 1) for _ in range(3)]
        length = math.sqrt(sum(x * x for x in v))
        n = [x / length for x in v]
        points.append([x + s for x, s in zip(n, shift)])
        normals.append(n)
        colors.append([200, 100, 50])
    return points, normals, colors


def write_xyz(path, points):
    with open(path, "w") as file:
        for p in points:
            file.write(" ".join(map(repr, p)) + "\n")


def in_folder(action):
    """Calls action() in a folder of its own, which is removed."""
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            action()
        finally:
            os.chdir("/")
