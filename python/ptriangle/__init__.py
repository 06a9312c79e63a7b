"""Triangle meshes of plane figures, with a guarantee on every angle.

    import ptriangle
    m = ptriangle.mesh([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1], [1, 2], [2, 3], [3, 0]], min_angle=30, size=0.1)
    m.points, m.triangles

mesh(points=None, segments=None, ...) -> Mesh

What is given (anything that numpy makes an array of; arrays of the right type and equal steps are not copied):
    points [n, 2]; segments [s, 2], point numbers from 0 (without: the convex hull is meshed)
    polygons: rings [k, 2], closed or not, one in the other as they are: what lies in an odd number of them is meshed
    holes [h, 2], or "auto": the segments are such rings; regions [r, 4]: x, y, attribute, largest area (<= 0: any)
    point_attributes [n, k], point_markers [n], segment_markers [s]
    triangles [m, 3]: a mesh that is there, to be refined; triangle_attributes [m, k], triangle_areas [m]
What is wanted:
    min_angle   degrees, up to 34; above best effort
    max_area    of a triangle
    size        length of edges: a number, or a function of x and y, which is asked at corners and centroids
    unsuitable  function of a, b, c and area: must this triangle be refined?
    conforming, keep_hull, protect (1: no points on the boundary, 2: nor on any segment), max_new_points
    gate        function of x and y: may a point be put here now? fence: x_min, y_min, x_max, y_max
    threads     default: OMP_NUM_THREADS, else one for each core. stop: function, asked often: True ends the work

The mesh depends on the input alone, not on the number of threads. While the library works, other threads of Python run;
functions that are given are called under the lock, by one thread. size may be a ptriangle.SizeFunction
(double (void *, const double[2])) of compiled code, say of numba.cfunc: then several threads call it at once.

Errors are exceptions with the library's words: InputError (a ValueError), TooLargeError (a MemoryError), FileError (an
OSError), StoppedError; all are Error. A mesh without triangles is an EmptyMeshWarning that says why; segments that are
skipped, and sizes that are no lengths, are InputWarning, of which it is one.

ptriangle.compat stands in for the package `triangle`.
"""
from . import _library
from ._library import Error, FileError, InputError, StoppedError, TooLargeError
from ._library import Length as SizeFunction
from ._mesh import Mesh, Verdict, mesh, read
from ._notes import EmptyMeshWarning, InputWarning

__version__ = _library.library.tri_version().decode()
__all__ = ["EmptyMeshWarning", "Error", "FileError", "InputError", "InputWarning", "Mesh", "SizeFunction",
           "StoppedError", "TooLargeError", "Verdict", "mesh", "read"]
