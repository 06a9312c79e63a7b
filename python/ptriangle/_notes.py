"""Warnings of input that was hardly meant so, in the words of the library."""
from __future__ import annotations

import sys
import warnings
from typing import Optional


class InputWarning(UserWarning):
    """Segments are skipped, or a size function returned what is no length; the text says which or where."""


class EmptyMeshWarning(InputWarning):
    """The mesh has no triangles; the text says why: the outline is open at a point, a hole lies in the only face."""


def _depth() -> int:
    """How far up the line is that called the package, seen from who calls this."""
    depth, frame = 1, sys._getframe(1)
    while frame.f_back is not None and frame.f_globals.get("__package__") == __package__:
        depth, frame = depth + 1, frame.f_back
    return depth


def tell(notes: Optional[bytes], who: str) -> None:
    """A warning for each line of the library's notes, given where the package was called."""
    for line in (notes or b"").decode("utf-8", "replace").splitlines():
        kind = EmptyMeshWarning if line.startswith("the mesh is empty") else InputWarning
        warnings.warn("%s: %s" % (who, line.replace("edge_length returned", "size returned")), kind,
                      stacklevel=_depth())
