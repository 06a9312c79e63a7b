"""Warnings of probable mistakes in the input."""
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


@pytest.mark.parametrize("call", [lambda: ptriangle.mesh(SQUARE, RING, min_angle=40),
                                  lambda: ptriangle.mesh(SQUARE, RING).refine(min_angle=40)])
def test_an_angle_that_is_lowered(call):
    with pytest.warns(ptriangle.IgnoredWarning, match="an angle bound of 40 degrees is above 38") as caught:
        call()
    assert len(caught) == 1 and caught[0].filename == __file__


def ring(x, y, width, height):
    return [[x, y], [x + width, y], [x + width, y + height], [x, y + height]]


@pytest.mark.parametrize("polygons, even_odd, union, words", [
    ([[ring(0, 0, 1, 1), ring(5, 0, 1, 1)]], 2, 1, "the rings are not those of a valid polygon"),
    ([[ring(-1, -1, 10, 10), ring(0, 0, 2, 2), ring(1, 1, 2, 2)]], 94, 93, "the rings are not those of a valid"),
    ([[[[0, 0], [2, 2], [2, 0], [0, 2]]]], 2, 2, "the rings are not those of a valid"),
    ([ring(0, 0, 4, 4), ring(1, 1, 2, 2)], 12, 16, "polygon 1 lies in polygon 0 .* by the even-odd rule"),
    ([ring(0, 0, 1e5, 1e5), ring(5, 5, 1, 1)], 1e10 - 1, 1e10, "polygon 1 lies in polygon 0"),
    ([ring(1, 1, 2, 2), [ring(0, 0, 4, 4)]], 12, 16, "polygon 0 lies in polygon 1"),
    ([ring(0, 0, 2, 2), ring(1, 0, 2, 2)], 4, 6, "polygons overlap, or their rings")])
def test_polygons_that_overlap_or_are_not_valid(polygons, even_odd, union, words):
    with pytest.warns(ptriangle.InputWarning, match=words) as caught:
        m = ptriangle.mesh(polygons=polygons, min_angle=20)
    assert len(caught) == 1 and caught[0].filename == __file__ and m.areas.sum() == pytest.approx(even_odd)
    geometry = {"type": "GeometryCollection", "geometries": [
        {"type": "Polygon", "coordinates": rings if np.ndim(rings[0]) == 2 else [rings]} for rings in polygons]}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for given in (polygons, geometry):
            assert ptriangle.mesh(polygons=given, union=True).areas.sum() == pytest.approx(union)


def test_polygons_that_are_fine():
    far = np.array([500000, 5600000])
    cells = [far + np.array(ring(x, y, 1, 1)) / 3 for x in range(20) for y in range(20)]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ptriangle.mesh(polygons=cells, min_angle=20)
        holed = [ring(0, 0, 8, 8), ring(1, 1, 3, 3), ring(5, 5, 1, 1)]
        ptriangle.mesh(polygons=[holed, ring(2, 2, 1, 1)], max_area=0.1)
        ptriangle.mesh(SQUARE, RING, polygons=[ring(1, 1, 1, 1)])


def test_silence():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ptriangle.mesh(SQUARE, RING, min_angle=30, size=lambda x, y: math.inf)


def test_the_package_triangle_is_told_too():
    with pytest.warns(ptriangle.EmptyMeshWarning, match="the outline is open at points 0 and 3") as caught:
        ptriangle.compat.triangulate({"vertices": SQUARE, "segments": RING[:3]}, "p")
    assert caught[0].filename == __file__
