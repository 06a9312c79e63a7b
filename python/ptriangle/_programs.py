"""The programs that a wheel carries, as commands: ptriangle, trianglecheck, meshplot."""
from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path


def _become(name: str) -> int:
    """Runs the program and returns its exit code. On POSIX it replaces this process."""
    windows = os.name == "nt"
    path = Path(__file__).resolve().parent / "programs" / (name + ".exe" * windows)
    if not path.exists():
        print("%s: this build of the Python package has no such program" % name, file=sys.stderr)
        return 1
    try:
        if windows:  # on Windows the shell would not wait for a program that replaces this process
            return subprocess.call([str(path), *sys.argv[1:]])
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
