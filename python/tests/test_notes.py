"""Warnings of what was hardly meant so."""
import math
import warnings

import numpy as np
import pytest

import ptriangle
import ptriangle.compat

SQUARE = np.array([[0, 0], [4, 0], [4, 4], [0, 4]], float)
RING = [[0, 1], [1, 2], [2, 3], [3, 0]]
EMPTY = [
    (dict(segments=RING[:3]), r"the outline is open at points 0 and 3$"),
    (dict(segments=np.array(RING) + 1), r"segment 2 names point 4 of 4: numbers count from 0 here"),
    (dict(segments=[[0, 99]]), r"segment 0 names point 99 of 4: numbers count from 0 here"),
    (dict(segments=RING, holes=[[2, 2]]), r"hole 0 lies in the only face$"),
    (dict(polygons=[SQUARE, SQUARE[::-1]]), r"segments lie on one another in pairs, and cancel by the even-odd rule$")]


@pytest.mark.parametrize("given, words", EMPTY)
def test_an_empty_mesh_says_why(given, words):
    with pytest.warns(ptriangle.EmptyMeshWarning, match=r"^mesh\(\): the mesh is empty: " + words) as caught:
        m = ptriangle.mesh(None if "polygons" in given else SQUARE, min_angle=20, **given)
    assert len(m.triangles) == 0 and len(caught) == 1 and caught[0].filename == __file__


def test_segments_that_are_skipped():
    with pytest.warns(ptriangle.InputWarning, match="segment 4 names point 7 of 4: .*; it is skipped") as caught:
        assert len(ptriangle.mesh(SQUARE, RING + [[0, 7]]).triangles) == 2
    assert caught[0].category is ptriangle.InputWarning


@pytest.mark.parametrize("odd", [0, -1, math.nan])
def test_sizes_that_are_no_lengths(odd):
    with pytest.warns(ptriangle.InputWarning, match=r"size returned %g at \([23].*\)" % odd) as caught:
        ptriangle.mesh(SQUARE, RING, size=lambda x, y: odd if x > 2 else 0.5)
    assert len(caught) == 1


def test_silence():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ptriangle.mesh(SQUARE, RING, min_angle=30, size=lambda x, y: math.inf)


def test_the_package_triangle_is_told_too():
    with pytest.warns(ptriangle.EmptyMeshWarning, match="the outline is open at points 0 and 3") as caught:
        ptriangle.compat.triangulate({"vertices": SQUARE, "segments": RING[:3]}, "p")
    assert caught[0].filename == __file__
