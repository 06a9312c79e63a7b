"""Calls our C interface as the Python package `triangle` calls the original's, with dictionaries of lists.

The structure is defined here a second time, with the layout that clients without a header rely on.
"""
import ctypes
from ctypes import POINTER, Structure, c_char_p, c_double, c_int

REALS, INTS = POINTER(c_double), POINTER(c_int)

# Name, type, columns, and the field with the number of rows. The number of columns may itself be a field.
ARRAYS = (("pointlist", REALS, 2, "numberofpoints"),
          ("pointattributelist", REALS, "numberofpointattributes", "numberofpoints"),
          ("pointmarkerlist", INTS, 1, "numberofpoints"),
          ("trianglelist", INTS, "numberofcorners", "numberoftriangles"),
          ("triangleattributelist", REALS, "numberoftriangleattributes", "numberoftriangles"),
          ("trianglearealist", REALS, 1, "numberoftriangles"), ("neighborlist", INTS, 3, "numberoftriangles"),
          ("segmentlist", INTS, 2, "numberofsegments"), ("segmentmarkerlist", INTS, 1, "numberofsegments"),
          ("holelist", REALS, 2, "numberofholes"), ("regionlist", REALS, 4, "numberofregions"),
          ("edgelist", INTS, 2, "numberofedges"), ("edgemarkerlist", INTS, 1, "numberofedges"),
          ("normlist", REALS, 2, "numberofedges"))
BORROWED = ("holelist", "regionlist")  # output arrays that are the input's own


class TriangulateIO(Structure):
    _fields_ = [("pointlist", REALS), ("pointattributelist", REALS), ("pointmarkerlist", INTS),
                ("numberofpoints", c_int), ("numberofpointattributes", c_int),
                ("trianglelist", INTS), ("triangleattributelist", REALS),
                ("trianglearealist", REALS), ("neighborlist", INTS), ("numberoftriangles", c_int),
                ("numberofcorners", c_int), ("numberoftriangleattributes", c_int), ("segmentlist", INTS),
                ("segmentmarkerlist", INTS), ("numberofsegments", c_int), ("holelist", REALS), ("numberofholes", c_int),
                ("regionlist", REALS), ("numberofregions", c_int), ("edgelist", INTS), ("edgemarkerlist", INTS),
                ("normlist", REALS), ("numberofedges", c_int)]


assert ctypes.sizeof(TriangulateIO) == 168


def filled(data):
    """Builds the input. The arrays belong to the returned structure."""
    io = TriangulateIO()
    for name, kind, columns, rows in ARRAYS:
        table = data.get(name)
        if table:
            flat = [x for row in table for x in (row if isinstance(row, (list, tuple)) else [row])]
            setattr(io, name, (kind._type_ * len(flat))(*flat))
            setattr(io, rows, len(table))
            if isinstance(columns, str):
                setattr(io, columns, len(table[0]))
    return io


def taken(io, free):
    """Returns the output as lists and frees its arrays."""
    data = {}
    for name, _, columns, rows in ARRAYS:
        array = getattr(io, name)
        if array:
            n, m = getattr(io, rows), getattr(io, columns) if isinstance(columns, str) else columns
            data[name] = [array[k * m:k * m + m] for k in range(n)]
            if name not in BORROWED:
                free(array)
    return data


def triang_of(path):
    """The function triang() of a shared library that exports our triangulate() as `run`."""
    run = ctypes.CDLL(path).run
    run.argtypes = [c_char_p] + 3 * [POINTER(TriangulateIO)]
    free = ctypes.CDLL(None).free
    free.argtypes = [ctypes.c_void_p]

    def triang(data, switches):
        given, out, voronoi = filled(data), TriangulateIO(), TriangulateIO()
        status = run(switches.encode(), given, out, voronoi)
        if status != 0:
            raise RuntimeError(f"status {status}")
        return taken(out, free), taken(voronoi, free)
    return triang
