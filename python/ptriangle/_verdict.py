"""What Mesh.check() found."""
from __future__ import annotations

from ._library import VerdictDetail


class Verdict:
    """A judgement by exact arithmetic. Truth value: the mesh is as it should be."""

    n_faults: int           #: 0: the mesh is as it should be
    text: str               #: the first fault, with the numbers of what is concerned; "" if there is none
    n_points: int           #: points that are corners of triangles
    n_edges: int
    n_boundary_edges: int
    smallest_angle: float   #: degrees
    largest_angle: float
    smallest_area: float
    largest_area: float
    total_area: float
    n_small: int            #: triangles below min_angle, ..
    n_small_explained: int  #: .. and those of them that a small angle of the input explains

    def __init__(self, detail: VerdictDetail) -> None:
        for name, *_ in VerdictDetail._fields_:
            value = getattr(detail, name)
            setattr(self, name, value.decode("utf-8", "replace") if isinstance(value, bytes) else value)

    def __bool__(self) -> bool:
        return self.n_faults == 0

    def __repr__(self) -> str:
        return "<Verdict: %s>" % ("sound" if self else "%d faults: %s" % (self.n_faults, self.text))
