"""Warnings of input that was hardly meant so, in the words of the library."""
import warnings


class InputWarning(UserWarning):
    """Segments are skipped, or a size function returned what is no length; the text says which or where."""


class EmptyMeshWarning(InputWarning):
    """The mesh has no triangles; the text says why: the outline is open at a point, a hole lies in the only face."""


def tell(notes, stacklevel):
    """A warning for each line (bytes, or None) of the library's notes."""
    for line in (notes or b"").decode("utf-8", "replace").splitlines():
        kind = EmptyMeshWarning if line.startswith("the mesh is empty") else InputWarning
        warnings.warn(line, kind, stacklevel=stacklevel + 1)
