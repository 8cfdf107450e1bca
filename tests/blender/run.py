"""python3 run.py ADDON.zip TEST...: the tests, inside Blender with the add-on installed from its archive.

Status 77, which CTest takes for skipped, where Blender or what a test needs is missing.
"""

import os
import shutil
import subprocess
import sys
import tempfile

FOLDER = os.path.dirname(os.path.abspath(__file__))
SKIPPED = 77


def call(blender, home, *arguments, display=()):
    """Blender with nothing of the user's, and its output as it comes."""
    environment = {**os.environ, "BLENDER_USER_RESOURCES": home, "TMPDIR": home, "HSDM_TEST_HOME": home}
    # Blender takes for its own the libraries of the first python3.11 in PATH, which may be another than Debian's.
    environment["PATH"] = f"/usr/bin:{environment['PATH']}"
    command = [*display, blender, "--factory-startup", "--python-exit-code", "1", *arguments]
    return subprocess.run(command, env=environment, stdin=subprocess.DEVNULL, timeout=240).returncode


def main(addon, tests):
    blender = shutil.which("blender")
    if blender is None:
        print("skipped: no blender here; apt-get install --no-install-recommends blender")
        return SKIPPED
    display = ()
    if tests == ["interactive"]:
        if shutil.which("xvfb-run") is None:
            print("skipped: no xvfb-run here; apt-get install xvfb xauth")
            return SKIPPED
        display = ("xvfb-run", "-a", "-s", "-screen 0 1280x800x24")
    with tempfile.TemporaryDirectory() as home:
        if tests == ["interactive"]:
            way = ("--enable-event-simulate", "--python", os.path.join(FOLDER, "interactive.py"), "--", addon)
            return call(blender, home, *way, display=display)
        return call(blender, home, "-b", "--python", os.path.join(FOLDER, "suite.py"), "--", addon, *tests)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
