"""Processor time of calls from Python on small inputs, repeated in one process:

  python_calls.py WAY LIBRARY SECONDS INPUT SWITCHES [INPUT SWITCHES ...]

WAY: `package` (the PyPI package `triangle`), `compat` (ptriangle.compat) or `mesh` (ptriangle.mesh() with the angle
bound of the switches, including reading points and triangles). LIBRARY is that of our package. Prints a line of JSON:
the seconds of a call and the number of triangles, for each input and switches.
"""
import json
import os
import re
import sys
import time

import numpy as np

BENCH = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path[:0] = BENCH, os.path.join(os.path.dirname(BENCH), "python")
import meshfiles  # noqa: E402


def call_of(way, figure, switches):
    """A function that makes the mesh and returns its triangles."""
    if way == "mesh":
        import ptriangle
        angle = re.search(r"q(\d+)", switches)

        def triangles():
            made = ptriangle.mesh(figure["vertices"], figure["segments"], holes=figure["holes"],
                                  min_angle=float(angle[1]) if angle else None)
            return made.points is not None and made.triangles
        return triangles
    if way == "compat":
        import ptriangle.compat as triangle
    else:
        import triangle
        figure = {key: rows for key, rows in figure.items() if len(rows)}
    return lambda: triangle.triangulate(figure, switches)["triangles"]


def seconds_of(call, seconds):
    start = now = time.process_time()
    n = 0
    while now - start < seconds:
        for _ in range(8):
            call()
        n, now = n + 8, time.process_time()
    return (now - start) / n


def main():
    way, os.environ["PTRIANGLE_LIBRARY"], seconds = sys.argv[1:4]
    found = []
    for path, switches in zip(sys.argv[4::2], sys.argv[5::2]):
        pslg = meshfiles.read(path)
        figure = {"vertices": np.array(pslg.points).reshape(-1, 2),
                  "segments": np.array(pslg.segments, np.int32).reshape(-1, 2),
                  "holes": np.array(pslg.holes).reshape(-1, 2)}
        call = call_of(way, figure, switches)
        n = len(call())
        found.append((seconds_of(call, float(seconds)), n))
    print(json.dumps(found), flush=True)


main()
