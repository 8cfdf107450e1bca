#!/usr/bin/env python3
"""performance.py - measures the tables and plots of docs/performance.md anew.

    python3 docs/performance.py              all of them: an hour or two, most of it for the slowest of the others
    python3 docs/performance.py yard growth  those whose commands have one of these words
    python3 docs/performance.py --list       the commands

Each stands in the page as `<!-- measured: COMMAND -->` and ends with `<!-- end -->`: the command is run from the top of the
repository, and what it prints, and the plot that it draws, take the place of what is between. Needs what was built by
`sh cmake/bootstrap.sh build`, a quiet machine, and for all of it what apps/bench/peers.py and apps/bench/roofline.py name.
"""
import os
import re
import shlex
import subprocess
import sys

HOME = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
PAGE = os.path.join(HOME, "docs", "performance.md")
BLOCK = re.compile(r"<!-- measured: (.+?) -->\n(.*?)<!-- end -->", re.S)


def measured(command):
    """What stands in the page for it: what it prints, and its plot."""
    print("performance:", command, file=sys.stderr)
    words = shlex.split(command)
    told = subprocess.run(words, cwd=HOME, stdout=subprocess.PIPE, text=True)
    if told.returncode:
        sys.exit(f"performance: {command}: status {told.returncode}; the page stays as it is")
    text = f"```sh\n{command}\n```\n\n{told.stdout.strip()}\n\n"
    if "--plot" in words:
        plot = os.path.relpath(words[words.index("--plot") + 1], "docs")
        name = os.path.splitext(os.path.basename(plot))[0].replace("performance-", "")
        text += f"![{name.capitalize()}]({plot})\n\n"
    return text


def main():
    words = [word for word in sys.argv[1:] if word != "--list"]
    with open(PAGE) as file:
        page = file.read()
    for block in BLOCK.finditer(page):
        command = block[1]
        if words and not any(word in command for word in words):
            continue
        if "--list" in sys.argv:
            print(command)
            continue
        page = page.replace(block[0], f"<!-- measured: {command} -->\n{measured(command)}<!-- end -->")
        with open(PAGE, "w") as file: # after each, so that nothing is lost
            file.write(page)


main()
