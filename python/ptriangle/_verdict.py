"""The result of Mesh.check()."""
from __future__ import annotations

from ._library import VerdictDetail


class Verdict:
    """The result of a check in exact arithmetic. It is true if the mesh passed."""

    n_faults: int           #: 0: the mesh passed
    text: str               #: the first fault, with the numbers of its triangles, edges or points; "" if there is none
    n_points: int           #: points that are corners of triangles
    n_edges: int
    n_boundary_edges: int
    smallest_angle: float   #: degrees
    largest_angle: float
    smallest_area: float
    largest_area: float
    total_area: float
    n_small: int            #: triangles with an angle below min_angle
    n_small_explained: int  #: those of them that a small angle of the input explains

    def __init__(self, detail: VerdictDetail) -> None:
        for name, *_ in VerdictDetail._fields_:
            value = getattr(detail, name)
            setattr(self, name, value.decode("utf-8", "replace") if isinstance(value, bytes) else value)

    def __bool__(self) -> bool:
        return self.n_faults == 0

    def __repr__(self) -> str:
        return "<Verdict: %s>" % ("sound" if self else "%d faults: %s" % (self.n_faults, self.text))
