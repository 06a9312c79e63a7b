"""ptriangle.compat: keys, types and shapes of the package `triangle`, and its documented examples."""
import warnings

import numpy as np
import pytest

import ptriangle
import ptriangle.compat as triangle

NAMES = ["plate", "plate.1", "points", "ground", "ground.1"]


def shapes(data):
    return {key: (rows.dtype.str[1:], rows.shape[1]) for key, rows in data.items()}


def assert_mesh(data, keys):
    assert set(data) == set(keys.split())
    for key, (dtype, columns) in shapes(data).items():
        assert dtype == ("i4" if key in ("triangles", "segments", "edges", "neighbors") or "markers" in key else "f8")
        assert columns == {"triangles": 3, "neighbors": 3, "regions": 4}.get(key, 1 if key.endswith(("s", "a")) and (
            "markers" in key or "attributes" in key or "area" in key) else 2)


BASE = "vertices vertex_markers triangles"
PSLG = BASE + " segments segment_markers holes"


@pytest.mark.parametrize("switches, keys", [
    ("", BASE), ("e", BASE + " edges edge_markers"), ("n", BASE + " neighbors"), ("p", PSLG), ("pq30", PSLG),
    ("pqa0.1", PSLG), ("pD", PSLG), ("pen", PSLG + " edges edge_markers neighbors"), ("pP", BASE),
    ("pB", "vertices triangles segments holes"), ("pN", "triangles segments segment_markers holes"),
    ("pE", "vertices vertex_markers segments segment_markers holes")])
def test_keys(switches, keys):
    assert_mesh(triangle.triangulate(triangle.get_data("plate"), switches), keys)


def test_keys_of_regions():
    ground = triangle.get_data("ground")
    with_regions = BASE + " segments segment_markers regions"
    assert_mesh(triangle.triangulate(ground, "pq"), with_regions)
    mesh = triangle.triangulate(ground, "pqAa")
    assert_mesh(mesh, with_regions + " triangle_attributes")
    assert set(mesh["triangle_attributes"].ravel()) == set(ground["regions"][:, 2])


def test_second_order():
    mesh = triangle.triangulate(triangle.get_data("points"), "o2")
    assert mesh["triangles"].shape[1] == 6


@pytest.mark.parametrize("switches", ["r", "rp", "rpq30", "rpqa0.05"])
def test_refine(switches):
    given = triangle.get_data("plate.1")
    mesh = triangle.triangulate(given, switches)
    assert_mesh(mesh, PSLG if "p" in switches else BASE)
    assert (len(mesh["triangles"]) > len(given["triangles"])) == ("q" in switches)


def test_area_bounds_of_triangles():
    given = {"vertices": [[0, 0], [1, 0], [0, 1]], "triangles": [[0, 1, 2]], "triangle_attributes": [[3.0]],
             "triangle_max_area": [[0.1]]}
    mesh = triangle.triangulate(given, "ra")
    assert set(mesh["triangle_attributes"].ravel()) == {3.0} and len(mesh["triangles"]) >= 5


def test_attributes_and_markers_may_be_flat():
    mesh = triangle.triangulate({"vertices": np.array([[0, 0], [1, 0], [0, 1]], "f4"), "vertex_attributes": [1, 2, 3],
                                 "vertex_markers": [4, 5, 6]})
    assert mesh["vertex_attributes"].tolist() == [[1], [2], [3]]
    assert mesh["vertex_markers"].tolist() == [[4], [5], [6]]


def test_documented_examples():
    five = [[0, 0], [0, 1], [0.5, 0.5], [1, 1], [1, 0]]
    assert {frozenset(t) for t in triangle.delaunay(five).tolist()} == {
        frozenset(t) for t in ([1, 0, 2], [2, 4, 3], [4, 2, 0], [2, 3, 1])}
    hull = triangle.convex_hull([[0, 0], [0, 1], [1, 1], [1, 0]])
    assert {frozenset(s) for s in hull.tolist()} == {frozenset(s) for s in ([3, 0], [2, 3], [1, 2], [0, 1])}
    points, edges, origins, directions = triangle.voronoi(five)
    assert sorted(points.tolist()) == [[0.0, 0.5], [0.5, 0.0], [0.5, 1.0], [1.0, 0.5]]
    assert edges.shape == (4, 2) and edges.dtype == origins.dtype == np.int32 and origins.shape == (4,)
    for at, way in zip(points[origins], directions):
        assert np.allclose(np.sign(way), np.sign(at - 0.5))
    square = triangle.triangulate({"vertices": [[0, 0], [0, 1], [1, 1], [1, 0]]}, "a0.2")
    assert square["vertex_markers"].shape == (len(square["vertices"]), 1) and len(square["triangles"]) >= 6


def test_voronoi_without_inner_edges():
    points, edges, origins, directions = triangle.voronoi([[0, 0], [1, 0], [0, 1]])
    assert points.tolist() == [[0.5, 0.5]] and edges.shape == (0, 2) and edges.dtype == np.int32
    assert origins.tolist() == [0, 0, 0] and directions.shape == (3, 2)


def test_errors():
    with pytest.raises(ValueError, match="at least three"):
        triangle.triangulate({})
    with pytest.raises(KeyError):
        triangle.triangulate({"vertices": [[0, 0], [1, 0], [0, 1]], "foo": 3})
    with pytest.raises(ValueError, match="not finite"):
        triangle.triangulate({"vertices": [[0, 0], [1, 0], [0, np.nan]]})
    with pytest.raises(ValueError, match="rows"):
        triangle.triangulate({"vertices": [[0, 0], [1, 0], [0, 1]], "vertex_markers": [1, 2]})
    with pytest.raises(ValueError, match="switch u"):
        triangle.triangulate({"vertices": [[0, 0], [1, 0], [0, 1]]}, "u")


SQUARE = {"vertices": [[0, 0], [1, 0], [1, 1], [0, 1]]}
RING = [[0, 1], [1, 2], [2, 3], [3, 0]]


@pytest.mark.parametrize("more, switches, words", [
    ({}, "a%g" % 1e-5, r"-a1e-05: numbers of switches have no exponent; the e is taken for a switch$"),
    ({}, "a1e-05Q", r"-a1e-05: numbers"),
    ({}, "q40", r"an angle bound of 40 degrees is above 38: triangles are made for 38$"),
    (dict(segments=RING), "q", r"segments: ignored without the switch p$"),
    (dict(segments=RING, holes=[[9, 9]], regions=[[0.5, 0.5, 1, 0.1]]), "qAa",
     r"segments, holes, regions: ignored without the switch p$"),
    (dict(segments=RING, triangles=[[0, 1, 2], [0, 2, 3]], holes=[[9, 9]]), "r", r"segments: ignored without"),
    (dict(vertices=SQUARE["vertices"] + [[1, 1]]), "", r"1 point coincides with a point of lower number and is not"),
    (dict(vertices=SQUARE["vertices"] + [[1, 1]] * 2), "", r"2 points coincide with points of lower number")])
def test_mistakes_are_warnings(more, switches, words):
    with pytest.warns(ptriangle.IgnoredWarning, match=r"^triangulate\(\): " + words) as caught:
        triangle.triangulate({**SQUARE, **more}, switches)
    assert len(caught) == 1 and caught[0].filename == __file__


def test_what_is_no_mistake():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        triangle.triangulate({**SQUARE, "segments": None, "vertex_markers": None})
        triangle.triangulate(SQUARE, "qa0.00001")
        triangle.triangulate({**SQUARE, "segments": RING, "holes": [[9, 9]]}, "pq30")
        triangle.triangulate({**SQUARE, "segments": []})
        warnings.simplefilter("ignore", category=triangle.IgnoredWarning)
        triangle.triangulate({**SQUARE, "segments": RING}, "a1e-5")


@pytest.mark.parametrize("key, rows", [("vertex_markers", [1, 2, 3, 1 << 40]), ("segments", [[0, (1 << 32) + 1]]),
                                       ("vertex_markers", np.array([1, 2, 3, -1 << 33])),
                                       ("segment_markers", [np.inf]), ("vertex_markers", [0, 1, 2, np.nan])])
def test_numbers_that_do_not_fit_are_refused(key, rows):
    with pytest.raises(ptriangle.InputError, match="%s: beyond the range of 32 bits" % key):
        triangle.triangulate({**SQUARE, "segments": RING[:1], key: rows}, "p")


def test_area_bounds_may_be_left_out():
    mesh = triangle.triangulate({**SQUARE, "triangles": [[0, 1, 2], [0, 2, 3]]}, "rau",
                                unsuitable=lambda a, b, c, area: area > 0.1)
    assert len(mesh["triangles"]) >= 10


def test_size_test():
    def unsuitable(a, b, c, area):
        return area > 0.01
    mesh = triangle.triangulate({"vertices": [[0, 0], [1, 0], [1, 1], [0, 1]]}, "qu", unsuitable=unsuitable)
    assert len(mesh["triangles"]) >= 100

    def broken(a, b, c, area):
        raise RuntimeError("mine")
    with pytest.raises(RuntimeError, match="mine"):
        triangle.triangulate({"vertices": [[0, 0], [1, 0], [1, 1], [0, 1]]}, "qu", unsuitable=broken)


def test_placement():
    figure = {"vertices": [[0, 0], [1, 0.1], [1.3, 1], [0.2, 0.8]]}

    def count(**wanted):
        return len(triangle.triangulate(figure, "qa0.001", **wanted)["triangles"])
    assert count() == count(placement="lattice") < 0.8 * count(placement="classic")
    with pytest.raises(ptriangle.InputError, match="placement: 'front'"):
        count(placement="front")


def test_examples_are_there():
    for name in NAMES:
        data = triangle.get_data(name)
        assert "vertices" in data
        triangle.triangulate(data, "rpq" if name.endswith(".1") else "pq" if "segments" in data else "q")
    with pytest.raises(ptriangle.InputError, match="no example 'A', but ground, ground.1, plate, .*load"):
        triangle.get_data("A")


def test_loads():
    data = triangle.loads(node="3 2 1 1\n1 0 0 7 2 # first\n\n2 1 0 8 3\n3 0 1 9 4\n", ele="1 3 1\n1 1 2 3 5.5\n",
                          area="1\n1 0.5\n", poly="0 2 0 1\n1 1\n1 1 2 9\n0\n", edge="1 1\n1 1 2 9\n",
                          neigh="1 3\n1 -1 -1 -1\n")
    assert data["triangles"].tolist() == [[0, 1, 2]] and data["triangle_attributes"].tolist() == [[5.5]]
    assert data["segments"].tolist() == [[0, 1]] and data["segment_markers"].tolist() == [[9]]
    assert data["edges"].tolist() == [[0, 1]] and data["neighbors"].tolist() == [[-1, -1, -1]]
    assert data["vertex_attributes"].tolist() == [[7], [8], [9]] and data["triangle_max_area"].tolist() == [[0.5]]
    from_zero = triangle.loads(node="3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n", ele="1 3 0\n0 0 1 2\n")
    assert from_zero["triangles"].tolist() == [[0, 1, 2]]


def test_pictures():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    plate = triangle.get_data("plate")
    triangle.compare(plt, plate, triangle.triangulate(plate, "pq"))
    triangle.comparev(plt, triangle.get_data("ground"), triangle.triangulate(triangle.get_data("ground"), "pqA"))
    points, edges, origins, directions = triangle.voronoi(triangle.get_data("points")["vertices"])
    triangle.plot(plt.axes(), vertices=points, edges=edges, ray_origins=origins, ray_directions=directions)
    plt.close("all")
