"""ptriangle.mesh: what comes out is judged by the library's checker."""
import threading
import time

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
    m = ptriangle.mesh(polygons=rings, min_angle=30)
    assert m.check(min_angle=30) and abs(areas(m).sum() - (64 - 16 + 1 + 8)) < 1e-9
    same = ptriangle.mesh(PLATE, RINGS, holes="auto", min_angle=30)
    assert np.array_equal(same.points, plate(min_angle=30).points)
    mixed = ptriangle.mesh(PLATE, RINGS, polygons=[box(1.25, 1.25, 0.5, 0.5)])
    assert abs(areas(mixed).sum() - 11.25) < 1e-9
    with pytest.raises(ptriangle.InputError, match="ring"):
        ptriangle.mesh(polygons=[[0, 1, 2]])
    with pytest.raises(ptriangle.InputError, match="auto"):
        ptriangle.mesh(PLATE, RINGS, holes="all")
    with pytest.raises(ptriangle.InputError, match="neither"):
        ptriangle.mesh()


def test_size():
    m = plate(min_angle=30, size=0.2)
    assert areas(m).max() <= np.sqrt(3) / 4 * 0.04 * (1 + 1e-12)
    graded = plate(min_angle=30, size=lambda x, y: 0.05 + 0.2 * x)
    x = graded.points[graded.triangles].mean(axis=1)[:, 0]
    assert areas(graded)[x < 1].max() < areas(graded)[x > 3].max() / 4
    compiled = ptriangle.SizeFunction(lambda user, at: 0.05 + 0.2 * at[0])
    same = plate(min_angle=30, size=compiled, threads=1)
    assert same.check(min_angle=30)


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
