"""Converts arrays to a figure of the library."""
from __future__ import annotations

from typing import Any, Dict, List, Mapping, Tuple

from ._arrays import from_numpy
from ._library import Figure, Ints, Reals

SHAPES: Dict[str, Tuple[Any, Any]] = {  # type in the library, and width of a row
    "points": (Reals, 2), "point_attributes": (Reals, None), "point_markers": (Ints, 1), "segments": (Ints, 2),
    "segment_markers": (Ints, 1), "holes": (Reals, 2), "regions": (Reals, 4), "triangles": (Ints, 3),
    "triangle_attributes": (Reals, None), "triangle_areas": (Reals, 1)}


def figure_of(arrays: Mapping[str, Any], who: str) -> Tuple[Figure, List[Any]]:
    """Returns the figure, and the arrays that must live as long."""
    figure, kept = Figure(), []
    for name, given in arrays.items():
        if given is None:
            continue
        kind, width = SHAPES[name]
        array, owner = from_numpy(kind, given, "%s: %s" % (who, name), width)
        setattr(figure, name, array)
        kept.append(owner)
    return figure, kept
