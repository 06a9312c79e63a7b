"""ptriangle.mesh: the checker of the library verifies the meshes."""
import pickle
import threading
import time
import warnings

import numpy as np
import pytest

import ptriangle

PLATE = np.array([[0, 0], [4, 0], [4, 3], [0, 3], [1, 1], [2, 1], [2, 2], [1, 2]], float)
RINGS = np.array([[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4]])


def areas(m):
    a, b, c = (m.points[m.triangles[:, k]] for k in range(3))
    return ((b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])) / 2


def plate(**wanted):
    return ptriangle.mesh(PLATE, RINGS, holes=[[1.5, 1.5]], **wanted)


def test_bounds_are_kept():
    m = plate(min_angle=30, max_area=0.05)
    assert m.check(min_angle=30, max_area=0.05)
    assert not m.check(max_area=0.001)
    assert m.points.dtype == np.float64 and m.triangles.dtype == np.int32
    assert areas(m).max() <= 0.05 and abs(areas(m).sum() - 11) < 1e-9
    assert m.bad(min_angle=30, max_area=0.05) == {} and m.bad(max_area=0.01)
    assert np.array_equal(m.points[:8], PLATE)
    assert m.counts["new_points"] + m.counts["new_points_on_segments"] == len(m.points) - 8


def test_arrays():
    m = plate(min_angle=20, segment_markers=[5, 5, 5, 5, 7, 7, 7, 7])
    n, t, e = len(m.points), len(m.triangles), len(m.edges)
    assert n - e + t == 0  # Euler, one hole
    assert m.neighbors.shape == (t, 3) and (m.neighbors == -1).sum() == len(m.segments)
    assert m.edges.shape == (e, 2) and np.count_nonzero(m.edge_markers) == len(m.segments)
    assert set(m.segment_markers) == {5, 7} and m.point_markers.shape == (n,)
    assert m.point_attributes.shape == (n, 0) and m.triangle_attributes.shape == (t, 0)


def test_arrays_outlive_the_mesh_and_are_not_copies():
    m = plate(max_area=0.01)
    points, again, triangles = m.points, m.points, m.triangles
    assert points.ctypes.data == again.ctypes.data and not points.flags.writeable
    with pytest.raises(ValueError):
        points[0] = 1
    before = points.copy(), triangles.copy()
    del m
    assert np.array_equal(points, before[0]) and np.array_equal(triangles, before[1])


def test_any_array_is_taken():
    a = plate(min_angle=30)
    wide = np.zeros((8, 5))
    wide[:, 1:3] = PLATE
    for points in (PLATE.tolist(), PLATE.astype(np.float32), wide[:, 1:3], np.asfortranarray(PLATE),
                   np.repeat(PLATE, 2, axis=0)[::2]):
        b = ptriangle.mesh(points, RINGS.tolist(), holes=np.array([[1.5, 1.5]]), min_angle=30)
        assert np.array_equal(a.points, b.points) and np.array_equal(a.triangles, b.triangles)
    one = ptriangle.mesh([[0, 0], [1, 0], [0, 1]])
    assert len(one.triangles) == 1


def test_regions_and_attributes():
    walls = np.vstack([RINGS, [[0, 4], [6, 2]]])
    m = ptriangle.mesh(PLATE, walls, holes=[[1.5, 1.5]], regions=[[0.1, 2.9, 7, 0.01], [3.9, 0.1, 8, 0]], min_angle=25,
                       point_attributes=PLATE.sum(axis=1))
    inside = m.triangle_attributes[:, 0]
    assert set(inside) == {7, 8} and areas(m)[inside == 7].max() <= 0.01 < areas(m)[inside == 8].max()
    assert np.allclose(m.point_attributes[:, 0], m.points.sum(axis=1))


def box(x, y, width, height):
    return [[x, y], [x + width, y], [x + width, y + height], [x, y + height]]


def test_polygons():
    rings = [box(0, 0, 8, 8), box(1, 1, 4, 4) + [[1, 1]], np.array(box(2, 2, 1, 1)), box(8, 0, 2, 4)]
    with pytest.warns(ptriangle.InputWarning, match="polygon 1 lies in polygon 0"):
        m = ptriangle.mesh(polygons=rings, min_angle=30)
    assert m.check(min_angle=30) and abs(areas(m).sum() - (64 - 16 + 1 + 8)) < 1e-9
    same = ptriangle.mesh(PLATE, RINGS, holes="auto", min_angle=30)
    assert np.array_equal(same.points, plate(min_angle=30).points)
    mixed = ptriangle.mesh(PLATE, RINGS, polygons=[box(1.25, 1.25, 0.5, 0.5)])
    assert abs(areas(mixed).sum() - 11.25) < 1e-9
    assert ptriangle.mesh(polygons=[rings[:2], *rings[2:]]).areas.sum() == pytest.approx(64 - 16 + 1 + 8)
    with pytest.raises(ptriangle.InputError, match="ring"):
        ptriangle.mesh(polygons=[[0, 1, 2]])
    with pytest.raises(ptriangle.InputError, match="auto"):
        ptriangle.mesh(PLATE, RINGS, holes="all")
    with pytest.raises(ptriangle.InputError, match="neither"):
        ptriangle.mesh()


def test_placement():
    def mesh(angle, placement, **wanted):
        m = plate(min_angle=angle, placement=placement, **wanted)
        assert m.check(min_angle=angle, max_area=wanted.get("max_area"))
        return m

    for wanted in dict(max_area=1e-3), dict(max_area=5e-4):
        lattice, classic = mesh(30, "lattice", **wanted), mesh(30, "classic", **wanted)
        assert 0.6 * len(classic.triangles) < len(lattice.triangles) < 0.8 * len(classic.triangles)
        assert np.array_equal(plate(min_angle=30, **wanted).points, lattice.points)
    for angle, wanted in (33, dict(max_area=1e-3)), (30, {}):
        assert np.array_equal(mesh(angle, "lattice", **wanted).points, mesh(angle, "classic", **wanted).points)


def test_unsuitable_and_gate():
    m = plate(unsuitable=lambda a, b, c, area: area > 0.1)
    assert areas(m).max() <= 0.1
    half = plate(max_area=0.01, gate=lambda x, y: x < 2)
    x = half.points[half.triangles].mean(axis=1)[:, 0]
    assert areas(half)[x < 1].max() <= 0.01 < areas(half)[x > 3].max()
    assert half.counts["gated"] > 0 and half.bad(max_area=0.01).keys() == {"deferred"}
    assert half.refine(max_area=0.01).bad(max_area=0.01) == {}


def test_refine():
    m = plate(min_angle=30, max_area=0.1)
    finer = m.refine(min_angle=30, max_area=0.02)
    assert finer.check(min_angle=30, max_area=0.02) and len(finer.triangles) > len(m.triangles)
    assert np.array_equal(finer.points[:len(m.points)], m.points)
    bounds = np.full(len(m.triangles), -1.0)
    bounds[0] = 1e-4
    local = ptriangle.mesh(m.points, m.segments, triangles=m.triangles, triangle_areas=bounds, min_angle=30)
    assert len(m.triangles) < len(local.triangles) < 3000


# --- points that no triangle uses

SPARE = np.array([[9, 9], [0, 0], [1, 0], [1, 0], [1, 1], [0.5, 3], [0, 1], [0, 0]], float)
SPARE_RING = [[1, 3], [2, 4], [4, 6], [6, 7]]


@pytest.mark.parametrize("wanted", [dict(min_angle=30, max_area=0.05), dict(max_area=0.05, order=2), {}])
def test_points_that_no_triangle_uses_are_dropped(wanted):
    values = SPARE.sum(axis=1)
    m = ptriangle.mesh(SPARE, SPARE_RING, point_attributes=values, **wanted)
    assert np.array_equal(np.unique(m.triangles), np.arange(len(m.points)))
    assert m.input_points.tolist() == [-1, 0, 1, 1, 2, -1, 3, 0]
    assert np.array_equal(m.points[m.input_points[m.input_points >= 0]], SPARE[m.input_points >= 0])
    assert np.allclose(m.point_attributes[:, 0], m.points.sum(axis=1)) and len(m.point_markers) == len(m.points)
    assert m.areas.sum() == pytest.approx(1) and not m.points.flags.writeable
    ends = np.unique(np.sort(m.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0)
    assert np.array_equal(np.unique(np.sort(m.edges, axis=1), axis=0), ends)
    assert set(map(frozenset, m.segments.tolist())) == set(map(frozenset, m.boundary.tolist()))
    again = pickle.loads(pickle.dumps(m))
    for other in (again, m.refine()):
        assert np.array_equal(np.sort(other.edges, axis=1), np.sort(m.edges, axis=1))
        assert np.array_equal(other.input_points, m.input_points)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert m.check()


def test_points_that_no_triangle_uses_may_stay():
    m = ptriangle.mesh(SPARE, SPARE_RING, max_area=0.05, keep_unused=True)
    assert np.array_equal(m.points[:8], SPARE) and m.input_points.tolist() == [0, 1, 2, 2, 4, 5, 6, 1]
    with pytest.warns(ptriangle.InputWarning, match=r"check\(\): 4 points are used by no triangle") as caught:
        assert m.check(max_area=0.05)
    assert caught[0].filename == __file__


def test_numbers_of_the_corners_of_polygons():
    m = ptriangle.mesh(polygons=[box(0, 0, 1, 1), box(1, 0, 1, 1)], max_area=0.05)
    assert np.array_equal(np.unique(m.triangles), np.arange(len(m.points)))
    assert m.input_points.tolist() == [0, 1, 2, 3, 1, 4, 5, 2]
    union = ptriangle.mesh([[0.5, 0.5], [7, 7]], polygons=[box(0, 0, 1, 1), box(1, 0, 1, 1)], union=True)
    assert union.input_points.tolist() == [0, -1]
    union = ptriangle.mesh([[0, 0], [.5, .5], [7, 7]], polygons=[box(0, 0, 1, 1), box(.5, 0, 2, 1)], union=True,
                           max_area=0.05)
    assert np.array_equal(np.unique(union.triangles), np.arange(len(union.points)))
    assert union.input_points.tolist() == [0, 1, -1]


def test_crossings_outside_are_dropped():
    cross = [[5, 5], [6, 6], [5, 6], [6, 5]]
    m = ptriangle.mesh(np.vstack([PLATE, cross]), np.vstack([RINGS, [[8, 9], [10, 11]]]), holes=[[1.5, 1.5]])
    assert m.counts["crossings"] == 1 and np.array_equal(np.unique(m.triangles), np.arange(len(m.points)))


# --- measurements

def test_interpolation_of_measurements():
    generator = np.random.default_rng(7)
    places = np.vstack([generator.random((3000, 2)) * [4, 3] - 1, generator.normal(1, 1e-5, (500, 2))])
    m = plate(min_angle=30, max_area=0.01)
    depths = m.interpolate(places, 3 * places[:, 0] - 2 * places[:, 1] + 5)
    plane = 3 * m.points[:, 0] - 2 * m.points[:, 1] + 5
    inside = np.all((m.points < 1.9) & (m.points > -0.9), axis=1)
    assert depths.shape == (len(m.points),) and np.allclose(depths[inside], plane[inside])
    two = m.interpolate(places, np.column_stack([places, places[:, :1] ** 2]), outside=np.nan)
    assert two.shape == (len(m.points), 3) and np.isnan(two[m.points[:, 0] == 4]).all()
    assert np.allclose(two[inside, :2], m.points[inside])
    assert np.abs(two[inside, 2] - m.points[inside, 0] ** 2).max() < 0.05


def test_interpolation_outside_takes_the_nearest_place_of_the_hull():
    m = ptriangle.mesh(PLATE[:4], RINGS[:4], max_area=0.01, order=2)
    inner = np.array([[1, 1], [3, 1], [3, 2], [1, 2], [2, 1.5], [2, 1.5]])
    depths = m.interpolate(inner, inner @ [10, 1])  # the second value at a place counts for nothing
    assert np.allclose(depths, np.clip(m.points, [1, 1], [3, 2]) @ [10, 1])
    for places, values in [([[0, 0], [1, 1], [2, 2]], [1, 2, 3]), (inner, [1, 2]), ([[0, 0], [1, 1]], [1, 2])]:
        with pytest.raises(ptriangle.InputError):
            m.interpolate(places, values)


@pytest.mark.parametrize("scale, far", [(1, 0), (1e4, 5e6)])
@pytest.mark.parametrize("inset", [0, 0.25])
def test_interpolation_at_slanted_borders(scale, far, inset):
    turn = np.array([[np.cos(0.3), -np.sin(0.3)], [np.sin(0.3), np.cos(0.3)]])
    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    along = np.linspace(0, 1, 50, endpoint=False)[:, None]
    square = np.vstack([a + along * (b - a) for a, b in zip(corners, np.roll(corners, -1, axis=0))])
    places = (inset + (1 - 2 * inset) * square) @ turn * scale + far
    m = ptriangle.mesh(polygons=[corners @ turn * scale + far], max_area=5e-4 * scale ** 2)
    nearest = np.clip((m.points - far) / scale @ turn.T, inset, 1 - inset)
    for values, slack in ((lambda at: at @ [3, -2], 1e-6), (lambda at: np.sin(9 * at[:, 0]), 0.01)):
        found = m.interpolate(places, values((places - far) / scale @ turn.T), outside=None if inset else np.nan)
        close = np.abs(found - values(nearest)) < slack
        assert close[np.unique(m.boundary)].all() and (slack == 0.01 or close.all())
    with pytest.raises(ptriangle.InputError, match="on one line"):
        m.interpolate(places[:50], places[:50, 0])


def test_interpolation_walks_through_flat_triangles():
    x = np.linspace(0, 4, 400)
    wavy, bent = np.column_stack([x, 1e-9 * np.sin(9 * x)]), np.column_stack([x, 3 + 1e-13 * x * x])
    places = np.vstack([wavy, bent, [[2, 1.5]]])
    m = plate(min_angle=30, max_area=0.01)
    assert np.allclose(m.interpolate(places, places @ [1, 1]), m.points @ [1, 1], atol=1e-8)


def test_threads_give_the_same_mesh():
    meshes = [plate(min_angle=30, max_area=1e-4, threads=n) for n in (1, 2, 3)]
    for other in meshes[1:]:
        assert np.array_equal(meshes[0].points, other.points)
        assert np.array_equal(meshes[0].triangles, other.triangles)


def test_errors_are_exceptions_with_the_words_of_the_library():
    with pytest.raises(ptriangle.InputError, match="at least three"):
        ptriangle.mesh([[0, 0], [1, 0]])
    with pytest.raises(ValueError, match="not finite"):
        ptriangle.mesh([[0, 0], [1, 0], [0, np.nan]])
    with pytest.raises(ptriangle.InputError, match="min_angle"):
        plate(min_angle=-1)
    with pytest.raises(ptriangle.InputError, match="segments"):
        ptriangle.mesh(PLATE, [[0, 1, 2]])
    with pytest.raises(ptriangle.InputError, match="integers"):
        ptriangle.mesh(PLATE, [[0.5, 1]])
    with pytest.raises(ptriangle.InputError, match="32 bits"):
        ptriangle.mesh(PLATE, [[0, 1 << 40]])
    with pytest.raises(ptriangle.InputError, match="rows"):
        plate(point_markers=[1, 2])
    with pytest.raises(MemoryError):
        plate(max_area=1e-30)
    with pytest.raises(TypeError):
        plate(maximum_area=1)
    with pytest.raises(OSError, match="nowhere"):
        ptriangle.read("nowhere.poly")


def test_exceptions_in_callbacks_end_the_work():
    def size(x, y):
        raise KeyError("mine")
    with pytest.raises(KeyError, match="mine"):
        plate(size=size)
    with pytest.raises(ptriangle.StoppedError):
        plate(max_area=1e-7, stop=lambda: True)


def test_other_threads_run_meanwhile():
    ticks, done = [], threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.monotonic())
            time.sleep(0.001)
    clock = threading.Thread(target=tick)
    clock.start()
    begin = time.monotonic()
    plate(max_area=1e-5)
    end = time.monotonic()
    done.set()
    clock.join()
    assert sum(begin < t < end for t in ticks) > 0


def test_meshes_by_many_threads():
    found = [None] * 4

    def work(k):
        found[k] = plate(min_angle=30, max_area=0.001)
    workers = [threading.Thread(target=work, args=(k,)) for k in range(4)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert all(np.array_equal(m.points, found[0].points) for m in found)


def test_files(tmp_path):
    m = plate(min_angle=30)
    m.write(tmp_path / "plate")
    read = ptriangle.read(tmp_path / "plate.ele")
    assert np.array_equal(read["points"], m.points) and np.array_equal(read["triangles"], m.triangles)
    again = ptriangle.mesh(**read)
    assert np.array_equal(again.points, m.points)
