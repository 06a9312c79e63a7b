"""The programs that a wheel carries, as commands: ptriangle, trianglecheck, meshplot."""
from __future__ import annotations

import os
import sys
from pathlib import Path


def _become(name: str) -> int:
    """Only comes back where there is no such program."""
    path = Path(__file__).resolve().parent / "programs" / name
    if not path.exists():
        print("%s: this build of the Python package has no such program" % name, file=sys.stderr)
        return 1
    try:
        os.execv(path, [name, *sys.argv[1:]])
    except OSError as fault:
        print("%s: cannot be started: %s" % (name, fault), file=sys.stderr)
    return 1


def ptriangle() -> int:
    return _become("ptriangle")


def trianglecheck() -> int:
    return _become("trianglecheck")


def meshplot() -> int:
    return _become("meshplot")
