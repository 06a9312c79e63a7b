"""Warnings of probable mistakes in the input, mostly with the text of the library."""
from __future__ import annotations

import sys
import warnings
from typing import Optional, Type


class InputWarning(UserWarning):
    """The input is probably a mistake: skipped segments, overlapping polygons, a size function that returned an invalid
    length. The text says which one, or where."""


class IgnoredWarning(InputWarning):
    """Part of a call has no effect: the exponent of a1e-5, segments without the switch p, an angle bound above 38."""


class EmptyMeshWarning(InputWarning):
    """The mesh has no triangles; the text says why: the outline is open at a point, a hole lies in the only face."""


def _depth() -> int:
    """Returns how many stack frames the caller of the package is above the caller of this function."""
    depth, frame = 1, sys._getframe(1)
    while frame.f_back is not None and frame.f_globals.get("__package__") == __package__:
        depth, frame = depth + 1, frame.f_back
    return depth


_KINDS = {"the mesh is empty": EmptyMeshWarning, "an angle bound of": IgnoredWarning}  # by the beginning of a line


def warn(text: str, who: str, kind: Type[InputWarning] = InputWarning) -> None:
    """Issues a warning at the line that called the package."""
    warnings.warn("%s: %s" % (who, text), kind, stacklevel=_depth())


def tell(notes: Optional[bytes], who: str, kind: Type[InputWarning] = InputWarning) -> None:
    """Issues a warning for each line of the library's notes."""
    for line in (notes or b"").decode("utf-8", "replace").splitlines():
        found = [_KINDS[begin] for begin in _KINDS if line.startswith(begin)]
        warn(line.replace("edge_length returned", "size returned"), who, found[0] if found else kind)
