"""Triangle meshes of plane figures, with a guarantee on every angle.

    import ptriangle
    m = ptriangle.mesh([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1], [1, 2], [2, 3], [3, 0]], min_angle=30, size=0.1)
    m.points, m.triangles

help(ptriangle.mesh) tells all that can be given and wanted, help(ptriangle.Mesh) what comes out.

The mesh depends on the input alone, not on the number of threads. While the library works, other threads of Python run.
Errors are exceptions with the library's words: InputError (a ValueError), TooLargeError (a MemoryError), FileError (an
OSError), StoppedError; all are Error. Input that was hardly meant so is an InputWarning: skipped segments, polygons
that overlap, sizes that are no lengths. EmptyMeshWarning, a kind of it, says why a mesh has no triangles;
IgnoredWarning, another kind, says that part of a call has no effect.

ptriangle.compat stands in for the package `triangle`.
"""
from . import _library
from ._errors import Error, FileError, InputError, StoppedError, TooLargeError
from ._make import mesh, read
from ._mesh import Mesh
from ._notes import EmptyMeshWarning, IgnoredWarning, InputWarning
from ._verdict import Verdict

__version__: str = _library.library.tri_version().decode()
__all__ = ["EmptyMeshWarning", "Error", "FileError", "IgnoredWarning", "InputError", "InputWarning", "Mesh",
           "StoppedError", "TooLargeError", "Verdict", "mesh", "read"]
