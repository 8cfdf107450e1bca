"""python3 run.py TEST...: pytest over them; status 77, which CTest takes for skipped, where pytest or NumPy is missing."""

import importlib.util
import sys


def main() -> int:
    missing = [name for name in ("numpy", "pytest") if importlib.util.find_spec(name) is None]
    if missing:
        print(f"skipped: {sys.executable} has no {' and no '.join(missing)}")
        return 77
    import pytest

    return int(pytest.main(["-q", "-rs", "-p", "no:cacheprovider", *sys.argv[1:]]))


if __name__ == "__main__":  # not again in the processes that tests spawn
    sys.exit(main())
