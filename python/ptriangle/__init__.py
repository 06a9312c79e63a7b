"""Triangle meshes of plane figures, with a guarantee on every angle.

    import ptriangle
    m = ptriangle.mesh([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1], [1, 2], [2, 3], [3, 0]], min_angle=30, size=0.1)
    m.points, m.triangles

help(ptriangle.mesh) lists the input and all options, and help(ptriangle.Mesh) describes the result.

The mesh depends only on the input, not on the number of threads. Other Python threads run while the library works.
Errors are exceptions with the message of the library: InputError (a ValueError), TooLargeError (a MemoryError),
FileError (an OSError) and StoppedError. All are subclasses of Error. An InputWarning reports input that is probably a
mistake, such as skipped segments, overlapping polygons or invalid sizes. It has two subclasses: EmptyMeshWarning says
why a mesh has no triangles, and IgnoredWarning says that part of a call has no effect.

ptriangle.compat replaces the package `triangle`.
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
