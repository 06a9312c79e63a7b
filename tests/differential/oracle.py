"""A child process that runs Triangle 1.6 (the PyPI package `triangle`), and the parent's handle for it.

Triangle crashes, hangs or ends its process on inputs that it should refuse. So a separate process runs many cases one
after the other, with limits. After a crash or a timeout the next case starts a new process. Each case is one line of
JSON in and one line out, which contains the arrays and Triangle's printed text. Indices count from 0 in both.

Run as a program, this file is the child, and only the child needs the packages `triangle` and `numpy`. With the path of
a shared library it runs our C interface (library.py) instead.
"""
import ctypes
import json
import os
import resource
import select
import subprocess
import sys
import tempfile
import time

from library import triang_of

FIELDS = (("points", "pointlist"), ("attributes", "pointattributelist"), ("markers", "pointmarkerlist"),
          ("segments", "segmentlist"), ("segment_markers", "segmentmarkerlist"), ("holes", "holelist"),
          ("regions", "regionlist"), ("triangles", "trianglelist"), ("triangle_attributes", "triangleattributelist"),
          ("areas", "trianglearealist"))


class Oracle:
    """Runs cases. An answer is the child's dictionary, or a string that describes Triangle's failure."""

    def __init__(self, python, seconds, *library):
        self.words, self.seconds = [python, os.path.abspath(__file__), *library], seconds
        self.child, self.pending = None, b""

    def start(self):
        self.child = subprocess.Popen(self.words, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                      stderr=subprocess.DEVNULL)
        self.pending = b""
        return self.read_line(60) == b"ready\n"

    def stop(self):
        if self.child:
            self.child.kill()
            self.child.communicate()
        self.child = None

    def read_line(self, seconds):
        """One line of the child. None: timeout; b"": the child has ended."""
        deadline = time.monotonic() + seconds
        while b"\n" not in self.pending:
            ready = select.select([self.child.stdout], [], [], max(0, deadline - time.monotonic()))[0]
            if not ready:
                return None
            data = os.read(self.child.stdout.fileno(), 1 << 16)
            if not data:
                return b""
            self.pending += data
        line, _, self.pending = self.pending.partition(b"\n")
        return line + b"\n"

    def ask(self, switches, case):
        if not self.child and not self.start():
            self.stop()
            return "does not start"
        try:
            self.child.stdin.write(json.dumps([switches, case]).encode() + b"\n")
            self.child.stdin.flush()
        except BrokenPipeError:
            self.stop()
            return "crashes"
        line = self.read_line(self.seconds)
        if not line:
            self.stop()
            return "hangs" if line is None else "crashes"
        answer = json.loads(line)
        return answer if isinstance(answer, dict) else "refuses: " + answer


# --- the child

def printed_since(log):
    """Flushes the C library, which has its own buffer for Triangle's output."""
    ctypes.CDLL(None).fflush(None)
    log.seek(0)
    text = log.read().decode()
    log.seek(0)
    log.truncate()
    return text


def as_list(array):
    return array if isinstance(array, list) else array.tolist()


def run(triang, switches, case, log):
    data = {name: case[key] for key, name in FIELDS if case.get(key)}
    try:
        out, voronoi = triang(data, switches)
    except (RuntimeError, ValueError) as error:
        printed_since(log)
        return str(error) or "error"
    answer = {name: as_list(array) for name, array in out.items()}
    answer.update({"voronoi_" + name: as_list(array) for name, array in voronoi.items()})
    answer["printed"] = printed_since(log)
    return answer


def serve(library=None):
    if library:
        triang = triang_of(library)
    else:
        from triangle.core import triang
    replies = os.fdopen(os.dup(1), "w")
    log = tempfile.TemporaryFile()
    os.dup2(log.fileno(), 1)
    resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))
    resource.setrlimit(resource.RLIMIT_FSIZE, (64 << 20, 64 << 20))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    print("ready", file=replies, flush=True)
    for line in sys.stdin:
        switches, case = json.loads(line)
        print(json.dumps(run(triang, switches, case, log)), file=replies, flush=True)


if __name__ == "__main__":
    serve(*sys.argv[1:])
