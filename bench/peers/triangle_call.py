"""Times one call of the library function triangulate() of Triangle 1.6, from the PyPI package `triangle`:

  triangle_call.py LIBRARY INPUT SWITCHES [BASE]

INPUT is a .poly or .node file. With `r` among the switches, the mesh beside the .poly file is read as well. All input
is in arrays before the clock starts. The package's own conversions (lists, dictionaries, numpy) are not used. BASE:
writes the mesh there. Prints a line of JSON.
"""
import ctypes
import json
import os
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import meshfiles  # noqa: E402

REAL_P, INT_P, INT = ctypes.POINTER(ctypes.c_double), ctypes.POINTER(ctypes.c_int), ctypes.c_int


class Triangulateio(ctypes.Structure):
    """Triangle's struct. The order of the fields is its binary interface."""
    _fields_ = [
        ("points", REAL_P), ("point_attributes", REAL_P), ("point_markers", INT_P), ("n_points", INT),
        ("n_point_attributes", INT),
        ("triangles", INT_P), ("triangle_attributes", REAL_P), ("triangle_areas", REAL_P), ("neighbors", INT_P),
        ("n_triangles", INT), ("n_corners", INT), ("n_triangle_attributes", INT),
        ("segments", INT_P), ("segment_markers", INT_P), ("n_segments", INT),
        ("holes", REAL_P), ("n_holes", INT), ("regions", REAL_P), ("n_regions", INT),
        ("edges", INT_P), ("edge_markers", INT_P), ("normals", REAL_P), ("n_edges", INT)]


def pointer(values, kind):
    """Pointer to the array's own memory. The array must stay alive."""
    return ctypes.cast(values.buffer_info()[0], kind) if len(values) else None


def given(path, switches):
    """The input, whose arrays must stay alive, and the struct that triangulate() gets."""
    pslg = meshfiles.read_mesh(path) if "r" in switches else meshfiles.read(path)
    io = Triangulateio()
    io.points, io.n_points = pointer(pslg.points, REAL_P), len(pslg.points) // 2
    if "p" in switches:
        io.segments, io.n_segments = pointer(pslg.segments, INT_P), len(pslg.segments) // 2
        io.holes, io.n_holes = pointer(pslg.holes, REAL_P), len(pslg.holes) // 2
    if "r" in switches:
        io.triangles, io.n_triangles = pointer(pslg.triangles, INT_P), len(pslg.triangles) // 3
        io.n_corners = 3
    return pslg, io


def main():
    library, path, switches = sys.argv[1:4]
    _pslg, io = given(path, switches)
    made, voronoi = Triangulateio(), Triangulateio()
    triangulate = ctypes.CDLL(library).triangulate
    text = (switches + "zQ").encode()
    start = time.perf_counter()
    triangulate(text, ctypes.byref(io), ctypes.byref(made), ctypes.byref(voronoi))
    seconds = time.perf_counter() - start
    print(json.dumps({"seconds": seconds, "counts": [made.n_points, made.n_triangles, made.n_segments]}), flush=True)
    if len(sys.argv) > 4:
        meshfiles.write_mesh(sys.argv[4], made.points[:2 * made.n_points], made.triangles[:3 * made.n_triangles],
                             made.segments[:2 * made.n_segments] if "p" in switches else [])


if __name__ == "__main__":
    main()
