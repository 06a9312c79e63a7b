"""A client with type hints, for mypy --strict; it also runs."""
from __future__ import annotations

from typing import Dict, List, Tuple

import numpy as np
import numpy.typing as npt

import ptriangle

Square = Tuple[npt.NDArray[np.float64], List[List[int]]]


def square() -> Square:
    return np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float), [[0, 1], [1, 2], [2, 3], [3, 0]]


def finer_near(x: npt.NDArray[np.float64], y: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    return np.asarray(0.05 + 0.1 * x)


def follow(done: float, triangles: int) -> None:
    assert 0 <= done <= 1 <= triangles


def make() -> ptriangle.Mesh:
    points, segments = square()
    m: ptriangle.Mesh = ptriangle.mesh(points, segments, min_angle=30, size=finer_near, progress=follow, order=2)
    return m.refine(max_area=0.001, threads=2)


def use(m: ptriangle.Mesh) -> npt.NDArray[np.float64]:
    corners: npt.NDArray[np.int32] = m.triangles[:, :3]
    counts: Dict[str, int] = m.counts
    verdict: ptriangle.Verdict = m.check(min_angle=20)
    assert verdict and counts["new_points"] > 0 and verdict.n_faults == 0 and not m.bad(max_area=0.001)
    text: str = m._repr_svg_() + repr(m) + ptriangle.__version__
    assert text
    centroids: npt.NDArray[np.float64] = m.points[corners].mean(axis=1)
    return centroids


def files(path: str) -> ptriangle.Mesh:
    points, segments = square()
    ptriangle.mesh(points, segments, min_angle=20).write(path)
    return ptriangle.mesh(**ptriangle.read(path), min_angle=25)


def polygons() -> ptriangle.Mesh:
    try:
        return ptriangle.mesh(polygons=[[(0, 0), (1, 0), (1, 1)]], union=True, gate=lambda x, y: x < 0.5,
                              size=[0.1, ([[0.1, 0.2], [0.1, 0.2]], (0, 0, 1, 1))], size_near={1: (0.1, 0.2)},
                              stop=lambda: False)
    except ptriangle.InputError as error:
        assert error.status == 3
        raise


if __name__ == "__main__":
    import os
    import tempfile
    print(make(), use(make()).shape, polygons())
    with tempfile.TemporaryDirectory() as folder:
        print(files(os.path.join(folder, "x.msh")))
