"""Runs one process: its output, wall time and peak memory, with a time limit."""
import os
import subprocess
import tempfile
import threading
import time
from dataclasses import dataclass


@dataclass
class Ended:
    code: int
    output: str
    errors: str
    wall: float      # wall seconds
    processor: float # seconds of processor time, of user and system
    peak: int        # peak resident bytes; includes the size of the program itself
    timed_out: bool


def execute(command, limit, cwd):
    """Waits by wait4, since only wait4 reports the memory of this child alone."""
    with tempfile.TemporaryFile("w+") as output, tempfile.TemporaryFile("w+") as errors:
        start = time.perf_counter()
        child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=output, stderr=errors, cwd=cwd)
        timed_out = threading.Event()
        timer = threading.Timer(limit, lambda: (timed_out.set(), child.kill()))
        timer.start()
        _, status, usage = os.wait4(child.pid, 0)
        wall = time.perf_counter() - start
        timer.cancel()
        child.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        errors.seek(0)
        return Ended(child.returncode, output.read(), errors.read(), wall,
                     usage.ru_utime + usage.ru_stime, 1024 * usage.ru_maxrss, timed_out.is_set())
