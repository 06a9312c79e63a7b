"""Polygons as regions: shapely confirms the polygon of every triangle."""
import pickle
import re
import warnings

import numpy as np
import ptriangle
import pytest

shapely = pytest.importorskip("shapely")


def last_around(m, shapes):
    """Returns the last shape that contains the centroid of each triangle, by shapely."""
    at = shapely.points(m.points[m.triangles].mean(axis=1))
    triangle, shape = shapely.STRtree(shapes).query(at, predicate="within")
    found = np.full(len(at), -1)
    np.maximum.at(found, triangle, shape)
    return found


def laid(shapes, **wanted):
    """Makes a mesh, and checks that every triangle lies in its polygon and that areas of polygons are right."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        m = ptriangle.mesh(polygons=shapes, **dict(dict(overlay=True, min_angle=25), **wanted))
    assert m.check() and np.array_equal(m.triangle_polygons, last_around(m, shapes))
    return m


def areas_of(m, n):
    return np.bincount(m.triangle_polygons, m.areas, n)


def box(x, y, width, height):
    return shapely.box(x, y, x + width, y + height)


def jagged(a, b, random, depth=4):
    """Returns a line between two places whose parts are displaced by at most a tenth of their length."""
    if depth == 0:
        return [a]
    along = b - a
    middle = (a + b) / 2 + random.uniform(-0.1, 0.1) * np.array([-along[1], along[0]])
    return jagged(a, middle, random, depth - 1) + jagged(middle, b, random, depth - 1)


def municipalities(n):
    """Returns n^2 / 2 cells of a jittered net of hexagons with jagged borders. Neighbouring cells have the same
    coordinates on a border. Every tenth cell has a lake."""
    random = np.random.default_rng(7)
    place = {(i, j): np.array([i + 0.3 * ((i + j) % 2) + random.uniform(-0.1, 0.1), j + random.uniform(-0.15, 0.15)])
             for i in range(n + 2) for j in range(n + 2)}
    borders = {}

    def border(a, b):
        if (b, a) in borders:
            return [place[a], *borders[b, a][:0:-1]]
        if (a, b) not in borders:
            borders[a, b] = jagged(place[a], place[b], random)
        return borders[a, b]
    shapes = []
    for i in range(n):
        for j in range(i % 2, n - 1, 2):
            ring = [(i, j), (i + 1, j), (i + 1, j + 1), (i + 1, j + 2), (i, j + 2), (i, j + 1)]
            corners = [at for k in range(6) for at in border(ring[k], ring[(k + 1) % 6])]
            middle = place[i, j + 1] * 0.5 + place[i + 1, j + 1] * 0.5
            lake = middle + 0.05 * np.array([[1, 0], [0, 1], [-1, 0], [0, -1]])
            shapes.append(shapely.Polygon(corners, [lake] if len(shapes) % 10 == 0 else []))
    return shapes


def test_an_atlas():
    shapes = municipalities(46)
    assert len(shapes) >= 1000 and all(shape.is_valid for shape in shapes)
    m = laid(shapes, max_area=0.02)
    assert m.check(min_angle=0, max_area=0.02)
    np.testing.assert_allclose(areas_of(m, len(shapes)), shapely.area(shapes), rtol=1e-9)
    corners = np.unique(shapely.get_coordinates(shapes), axis=0)
    plain = laid(shapes, min_angle=None)
    assert len(plain.points) == len(corners)  # shared borders are there once
    several = [shapely.MultiPolygon(shapes[k::500]) for k in range(500)]
    merged = ptriangle.mesh(polygons=several, overlay=True, min_angle=25, max_area=0.02)
    assert np.array_equal(merged.triangle_polygons, last_around(m, shapes) % 500)


def test_later_polygons_lie_on_top():
    shapes = [box(0, 0, 4, 4), box(2, 2, 4, 4), box(3, 3, 1, 1), box(0, 0, 1, 1)]
    m = laid(shapes)
    assert areas_of(m, 4) == pytest.approx([16 - 4 - 1, 16 - 1, 1, 1])
    assert m.triangle_attributes[:, 0].tolist() == (m.triangle_polygons + 1).tolist()
    back = laid(shapes[::-1])
    assert areas_of(back, 4) == pytest.approx([0, 0, 12, 16])
    assert not np.isin(back.points, [[1, 1]]).all(axis=1).any()  # nothing of what lies beneath


def test_islands_gaps_and_rings_that_touch():
    lake = shapely.Polygon(box(0, 0, 9, 9).exterior, [box(1, 1, 7, 7).exterior])
    island = shapely.Polygon(box(3, 3, 3, 3).exterior, [box(4, 4, 1, 1).exterior])
    m = laid([lake, island, box(9, 9, 2, 2), box(9, 0, 1, 1)])
    assert areas_of(m, 4) == pytest.approx([81 - 49, 8, 4, 1])
    touching = shapely.Polygon(box(0, 0, 4, 4).exterior, [[(0, 0), (2, 1), (1, 2)], [(2, 1), (3, 1), (3, 2)]])
    assert areas_of(laid([touching, box(-4, 0, 4, 4)]), 2) == pytest.approx([touching.area, 16])
    ring = [box(0, 0, 3, 1), box(0, 2, 3, 1), box(0, 1, 1, 1), box(2, 1, 1, 1)]
    assert laid(ring).areas.sum() == pytest.approx(8)  # a gap that four polygons enclose
    wide = ptriangle.mesh(polygons=ring, overlay=True, keep_hull=True)
    assert np.bincount(wide.triangle_polygons + 1, wide.areas) == pytest.approx([1, 3, 3, 1, 1])


def test_duplicates_and_empty_ones():
    several = shapely.MultiPolygon([box(5, 0, 1, 1), box(7, 0, 2, 2)])
    shapes = [box(0, 0, 1, 1), box(0, 0, 1, 1), shapely.Polygon(), several, box(0, 0, 1, 1)]
    assert areas_of(laid(shapes), 5) == pytest.approx([0, 0, 0, 5, 1])
    with pytest.warns(ptriangle.EmptyMeshWarning):
        assert len(ptriangle.mesh(polygons=[[(0, 0), (1, 1), (2, 2)]], overlay=True).triangles) == 0


def test_properties_and_columns():
    def feature(shape, **properties):
        return {"type": "Feature", "properties": properties, "geometry": shapely.geometry.mapping(shape)}
    shapes = [box(0, 0, 4, 4), box(4, 0, 4, 4), box(0, 4, 8, 1)]
    features = {"type": "FeatureCollection", "features": [
        feature(shapes[0], code=7, h=0.1), feature(shapes[1], code=-3.5, h=None, most=0.05), feature(shapes[2])]}
    m = ptriangle.mesh(polygons=features, polygon_attributes="code", polygon_sizes="h", polygon_areas="most",
                       min_angle=25, size=1, gradation=0.3)
    assert np.array_equal(m.triangle_polygons, last_around(m, shapes))
    assert np.array_equal(m.triangle_attributes[:, 0], np.array([7, -3.5, 0])[m.triangle_polygons])
    n = np.bincount(m.triangle_polygons)
    assert n[0] == pytest.approx(16 / (np.sqrt(3) / 4 * 0.01), rel=0.05)
    assert m.areas[m.triangle_polygons == 1].max() <= 0.05 < m.areas[m.triangle_polygons == 2].max()
    again = ptriangle.mesh(polygons=shapes, polygon_attributes=[7, -3.5, 0], polygon_sizes=[0.1, 0, np.nan],
                           polygon_areas=[0, 0.05, -1], min_angle=25, size=1, gradation=0.3)
    assert np.array_equal(m.points, again.points)
    for finer in (m.refine(max_area=0.01), pickle.loads(pickle.dumps(m)).refine(max_area=0.01)):
        assert np.array_equal(finer.triangle_polygons, last_around(finer, shapes))
        assert np.array_equal(finer.triangle_attributes[:, 0], np.array([7, -3.5, 0])[finer.triangle_polygons])
    with pytest.raises(ptriangle.InputError, match="no polygon has the property 'hh', but code, h, most"):
        ptriangle.mesh(polygons=features, polygon_sizes="hh")


def test_frames():
    geopandas = pytest.importorskip("geopandas")
    frame = geopandas.GeoDataFrame({"code": [5, 6], "name": ["a", "b"]}, geometry=[box(0, 0, 2, 2), box(1, 1, 2, 2)])
    m = laid(list(frame.geometry), max_area=0.1)
    same = ptriangle.mesh(polygons=frame, polygon_attributes="code", min_angle=25, max_area=0.1)
    assert np.array_equal(m.points, same.points)
    assert np.array_equal(same.triangle_attributes[:, 0], frame["code"].to_numpy()[same.triangle_polygons])


def test_segments_and_holes_beside_polygons():
    shapes = [box(0, 0, 4, 4), box(4, 0, 4, 4)]
    river = [[-1, 2], [5, 3], [5, 1]]
    m = laid(shapes, points=[*river, [1, 1]], segments=[[0, 1], [1, 2]], segment_markers=[8, 9], min_angle=20)
    a, b = (m.points[m.segments[:, k]] for k in (0, 1))
    length = np.hypot(*(b - a).T)
    assert length[m.segment_markers == 8].sum() == pytest.approx(5 * np.hypot(1, 1 / 6))  # its part inside
    assert length[m.segment_markers == 9].sum() == pytest.approx(2)
    assert length[m.segment_markers == 1].sum() == pytest.approx(24)  # the boundary
    assert m.points[m.input_points[3]].tolist() == [1, 1] and m.input_points.tolist()[0] == -1
    less = ptriangle.mesh(polygons=[*shapes, box(1, 1, 1, 1)], overlay=True, holes=[[1.5, 1.5]])
    assert areas_of(less, 3) == pytest.approx([15, 16, 0])


def test_slivers_are_told_and_snapped():
    turn = np.linspace(0, 3, 40)
    border = np.column_stack([2 + 0.3 * np.sin(9 * turn), turn])
    noise = np.random.default_rng(3).uniform(-1e-5, 1e-5, border.shape) * [1, 0]
    left = shapely.Polygon([*border, (0, 3), (0, 0)])
    right = shapely.Polygon([*(border + noise), (4, 3), (4, 0)])
    with pytest.warns(ptriangle.InputWarning, match=r"\d+ faces are narrower than .* grid=") as caught:
        rough = ptriangle.mesh(polygons=[left, right], overlay=True, min_angle=25, max_area=0.01)
    advised = float(re.search("grid=([^ ]*) ", str(caught[0].message))[1])
    assert advised > 2e-5
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ptriangle.mesh(polygons=[left, right], grid=advised)
        m = ptriangle.mesh(polygons=[left, right], grid=1e-3, min_angle=25, max_area=0.01)
    assert m.check(min_angle=20) and m.areas.sum() == pytest.approx(12, abs=1e-9)
    assert max(len(m.triangles), len(rough.triangles)) < 4000
    wrong = m.areas[m.triangle_polygons != last_around(m, [left, right])].sum()
    assert wrong < 0.01 and (m.triangle_polygons >= 0).all()


@pytest.mark.parametrize("seed", range(20))
def test_polygons_at_random(seed):
    random = np.random.default_rng(seed)
    shapes = []
    for k in range(30):
        at, radius = random.uniform(0, 10, 2), random.uniform(0.2, 3)
        shape = shapely.Point(*at).buffer(radius, quad_segs=random.integers(1, 9))
        if seed % 2:  # corners on a net: borders that partly run along each other, rings that touch
            shape = shapely.box(*np.round(at), *(np.round(at) + random.integers(1, 4, 2)))
        if k % 3 == 0:
            shape = shape.difference(shapely.box(*np.round(at - 0.5), *np.round(at + 0.5)))
        shapes.append(shape)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ptriangle.InputWarning)
        m = ptriangle.mesh(polygons=shapes, overlay=True, min_angle=20)
    assert m.check() and np.array_equal(m.triangle_polygons, last_around(m, shapes))
    left = [shape.difference(shapely.union_all(shapes[k + 1:])).area for k, shape in enumerate(shapes)]
    np.testing.assert_allclose(areas_of(m, 30), left, atol=1e-9)


@pytest.mark.parametrize("wanted, words", [
    (dict(polygons=None, points=[[0, 0]]), "without polygons"), (dict(union=True), "union"),
    (dict(holes="auto"), "holes"), (dict(regions=[[0, 0, 1, 0]]), "regions="), (dict(grid=0), "grid"),
    (dict(polygon_sizes=[1, 2]), r"polygon_sizes: shape \(2,\) for 1"), (dict(polygon_areas=["x"]), "polygon_areas"),
    (dict(points=[[0, 0], [1, 1]], segments=[[0, 1]], segment_markers=[1, 2]), "2 segment_markers for 1"),
    (dict(points=[[0.1, 0.1]], segments=[[0, 1]]), "segments: numbers from 0 to 1 for 1"),
    (dict(points=[[0.1, 0.1]], segments=[[0, -1]]), "segments"), (dict(polygons=[None]), "no polygons"),
    (dict(points=[[0.1, 0.1]], segments=[[0, 1]], overlay=False), "segments"),
    (dict(points=[[0.1, 0.1]], point_attributes=[[1]]), "point_attributes="),
    (dict(polygon_sizes="zz"), "no polygon has the property 'zz'$")])
def test_errors(wanted, words):
    with pytest.raises(ptriangle.InputError, match=r"^mesh\(\): .*" + words):
        ptriangle.mesh(**dict(dict(polygons=[box(0, 0, 1, 1)], overlay=True), **wanted))


def test_borders_that_differ_by_rounding_are_one():
    t = np.linspace(0, 1, 50)[1:-1, None]
    ends = np.array([[0.1, 0.2], [3.7, 2.9]])
    between = ends[0] + t * (ends[1] - ends[0])  # on the border, but for rounding
    shapes = [shapely.Polygon([*ends, (0, 3)]), shapely.Polygon([ends[0], *between, ends[1], (3, 0)])]
    for order in shapes, shapes[::-1]:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            m = ptriangle.mesh(polygons=order, overlay=True, max_area=0.01, min_angle=25)
        at = m.points[m.boundary].mean(axis=1)
        inner = np.abs((at - ends[0]) @ [-2.7, 3.6]) < 1e-9
        assert not inner.any() and (m.triangle_polygons >= 0).all()
