"""``python -m hsdm ...``: the command, with its arguments, output and exit status."""

from __future__ import annotations

import os
import sys
from typing import NoReturn


def main() -> NoReturn:
    """Becomes the command that was built with this package, which lies in it.

    It takes this process's place, for it is its own master of signals and memory: another program in the
    process, such as an interpreter with threads, would have a say in both.
    """
    command = os.path.join(os.path.dirname(os.path.abspath(__file__)), "bin", "hsdm")
    try:
        os.execv(command, ["hsdm", *sys.argv[1:]])
    except OSError as error:
        sys.exit(f"hsdm: {command}: {error.strerror}; the command is not installed with this package")


if __name__ == "__main__":
    main()
