#!/usr/bin/env python3
"""Makes the examples of ptriangle.compat, python/ptriangle/data/: new figures, meshed by the package itself.

Usage: tools/make_examples.py, in an environment where `import ptriangle` works.
"""
import math
from pathlib import Path

import numpy as np

import ptriangle.compat as triangle

FOLDER = Path(__file__).resolve().parent.parent / "python" / "ptriangle" / "data"


def lines(rows, form):
    return ["%d %s" % (k + 1, " ".join(form % value for value in row)) for k, row in enumerate(rows)]


def write(name, data):
    """Writes name.node or name.poly, and name.ele."""
    points, markers = data["vertices"], data.get("vertex_markers")
    rows = ["%d 2 0 %d" % (len(points), markers is not None)]
    for k, (x, y) in enumerate(points):
        rows.append("%d %.17g %.17g" % (k + 1, x, y) + (" %d" % markers[k, 0] if markers is not None else ""))
    if "segments" in data:
        marked = data.get("segment_markers")
        rows.append("%d %d" % (len(data["segments"]), marked is not None))
        for k, (a, b) in enumerate(data["segments"]):
            rows.append("%d %d %d" % (k + 1, a + 1, b + 1) + (" %d" % marked[k, 0] if marked is not None else ""))
        for key in ("holes", "regions"):
            rows += [str(len(data.get(key, ())))] + lines(data.get(key, ()), "%.17g")
    ending = ".poly" if "segments" in data else ".node"
    (FOLDER / (name + ending)).write_text("\n".join(rows) + "\n", encoding="ascii")
    if "triangles" in data:
        rows = ["%d 3 0" % len(data["triangles"])] + lines(data["triangles"] + 1, "%d")
        (FOLDER / (name + ".ele")).write_text("\n".join(rows) + "\n", encoding="ascii")


def ring(first, n):
    return [[first + k, first + (k + 1) % n] for k in range(n)]


def plate():
    """A plate with a round hole and a square one."""
    circle = [[1 + 0.5 * math.cos(k * math.pi / 8), 1 + 0.5 * math.sin(k * math.pi / 8)] for k in range(16)]
    points = [[0, 0], [4, 0], [4, 2], [0, 2]] + circle + [[2.5, 0.5], [3.5, 0.5], [3.5, 1.5], [2.5, 1.5]]
    segments = ring(0, 4) + ring(4, 16) + ring(20, 4)
    markers = [1] * 4 + [2] * 16 + [3] * 4
    return {"vertices": np.array(points), "segments": np.array(segments), "segment_markers": np.array([markers]).T,
            "vertex_markers": np.array([markers]).T, "holes": np.array([[1.0, 1.0], [3.0, 1.0]])}


def ground():
    """Two layers of soil, each with an area bound."""
    points = [[0, 0], [6, 0], [6, 1], [6, 2], [3, 2.5], [0, 2], [0, 1.2], [3, 0.8]]
    segments = ring(0, 7) + [[6, 7], [7, 2]]
    return {"vertices": np.array(points, float), "segments": np.array(segments),
            "segment_markers": np.array([[1] * 7 + [2] * 2]).T, "vertex_markers": np.array([[1] * 7 + [2]]).T,
            "regions": np.array([[3, 0.2, 1, 0.2], [3, 2, 2, 0.05]])}


def points():
    """A sunflower's seeds."""
    angle = math.pi * (3 - math.sqrt(5))
    at = [[math.sqrt(k + 0.5) * math.cos(k * angle), math.sqrt(k + 0.5) * math.sin(k * angle)] for k in range(60)]
    return {"vertices": np.round(at, 6)}


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    for figure, switches in ((plate, "pq"), (ground, "pqa0.5"), (points, "")):
        data = figure()
        write(figure.__name__, data)
        write(figure.__name__ + ".1", triangle.triangulate(data, switches))


if __name__ == "__main__":
    main()
