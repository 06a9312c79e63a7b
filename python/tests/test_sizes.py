"""Sizes: edges have the length of the field, in all forms of a field."""
import warnings

import numpy as np
import ptriangle
import pytest

SQUARE = np.array([[0, 0], [4, 0], [4, 3], [0, 3]], float)
RING = [[0, 1], [1, 2], [2, 3], [3, 0]]
X, Y = np.linspace(-1, 5, 61), np.linspace(-1, 4, 51)


def h(x, y):
    return 0.05 + 0.05 * np.abs(x - 1)


def made(**wanted):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        m = ptriangle.mesh(SQUARE, RING, segment_markers=[1, 2, 3, 4], **dict(dict(min_angle=25), **wanted))
    assert m.check(min_angle=25)
    return m


def ratios(m, field):
    """Returns the lengths of edges divided by the desired lengths at their midpoints."""
    a, b = m.points[m.edges[:, 0]], m.points[m.edges[:, 1]]
    middle = (a + b) / 2
    return np.hypot(*(b - a).T) / field(*middle.T)


def asked(m, field):
    """Returns how many equilateral triangles with these edges fill the domain."""
    middle = m.points[m.triangles].mean(axis=1)
    return (m.areas / (np.sqrt(3) / 4 * field(*middle.T) ** 2)).sum()


def follows(m, field):
    found = ratios(m, field)
    assert 0.95 < np.median(found) < 1.05 and ((found > 0.7) & (found < 1.4)).mean() > 0.95
    assert 0.97 < len(m.triangles) / asked(m, field) < 1.08  # of so few the boundary has many
    return True


def background():
    x, y = np.meshgrid(X, Y)
    cloud = ptriangle.mesh(np.column_stack([x.ravel(), y.ravel()]))
    return cloud.points, cloud.triangles, h(*cloud.points.T)


FORMS = {"function": h, "raster": (h(*np.meshgrid(X, Y)), (-1, -1, 5, 4)), "mesh": background()}


@pytest.mark.parametrize("form", FORMS)
def test_edges_follow_the_field(form):
    m = made(size=FORMS[form])
    assert follows(m, h) and not m.bad(size=FORMS[form])
    assert np.array_equal(m.points, made(size=FORMS[form], threads=1).points)


def test_one_length():
    for placement in "lattice", "front":
        assert follows(made(size=0.05, placement=placement), lambda x, y: 0.05 + 0 * x)


def test_functions_of_numbers_work_and_say_that_they_are_slow():
    def scalar(x, y):
        return 0.3 if x > 2 else 0.4
    with pytest.warns(ptriangle.InputWarning, match="size: scalar takes no arrays"):
        slow = ptriangle.mesh(SQUARE, RING, min_angle=25, size=scalar)
    quick = made(size=lambda x, y: np.where(x > 2, 0.3, 0.4))
    assert np.array_equal(slow.points, quick.points)


def test_the_least_of_several_counts():
    both = made(size=[0.2, lambda x, y: 0.1 + 0.1 * x], gradation=np.inf)
    assert follows(both, lambda x, y: np.minimum(0.2, 0.1 + 0.1 * x))
    assert follows(made(size=FORMS["raster"], min_size=0.1, max_size=0.15), lambda x, y: np.clip(h(x, y), 0.1, 0.15))


def test_near_a_marker():
    assert follows(made(size_near={4: (0.03, 0.15)}), lambda x, y: 0.03 + 0.15 * x)
    assert follows(made(size_near={4: 0.03}, gradation=0.1), lambda x, y: 0.03 + 0.1 * x)
    assert follows(made(size_near={4: 0.03, 2: (0.05, 0.1)}, max_size=0.2),
                   lambda x, y: np.minimum(np.minimum(0.03 + 0.2 * x, 0.05 + 0.1 * (4 - x)), 0.2))


def test_gradation():
    values = np.full((51, 61), 0.5)
    values[25, 30] = 0.02
    m = made(size=(values, (-1, -1, 5, 4)), gradation=0.15)
    assert follows(m, lambda x, y: np.minimum(0.5, 0.02 + 0.15 * np.hypot(x - 2, y - 1.5)))


def test_no_data():
    values = h(*np.meshgrid(X, Y))
    values[::7, ::5] = np.nan
    assert follows(made(size=(values, (-1, -1, 5, 4)), gradation=np.inf), h)
    assert follows(made(size=lambda x, y: np.where(x < 2, 0.1, np.inf), gradation=0.1),
                   lambda x, y: 0.1 + 0.1 * np.maximum(x - 2, 0))


@pytest.mark.parametrize("wanted, words", [
    (dict(size=0), "size: 0 is not > 0"), (dict(size="x"), "size is 'x' instead of a number"),
    (dict(size=([[1.0]], (0, 0, 0, 1))), "extent"), (dict(size=(1, 2)), "a pair is an array"),
    (dict(size=([[np.nan, np.nan], [np.nan, np.nan]], (0, 0, 1, 1))), "no value is above 0"),
    (dict(size=([[0, 0], [1, 0], [0, 1]], [[0, 1, 5]], [1, 1, 1])), "5"), (dict(size_near={9: 0.1}), "9"),
    (dict(size_near={1: (1, 2, 3)}), "size_near"),
    (dict(size_near={1: -1}), "size_near"), (dict(size_near=[1]), "a dict"),
    (dict(size=1, optimise=1001), "1001"),
    (dict(size=1, gradation=-1), "gradation"), (dict(max_size=0), "max_size")])
def test_errors(wanted, words):
    with pytest.raises(ptriangle.InputError, match=r"^mesh\(\): .*" + words):
        made(**wanted)


def test_channels_and_curves():
    x = np.linspace(1, 3, 21)
    walls = np.vstack([np.column_stack([x, 1 + 0 * x]), np.column_stack([x[::-1], 1.2 + 0 * x])])
    ring = [[k, (k + 1) % 42] for k in range(42)]
    wide, narrow = (ptriangle.mesh(walls, ring, min_angle=25, max_size=0.5, elements_across=n) for n in (1, 8))
    assert len(narrow.triangles) > 4 * len(wide.triangles)
    turn = np.linspace(0, 2 * np.pi, 200, endpoint=False)
    circle = np.column_stack([np.cos(turn), np.sin(turn)])
    sides = np.column_stack([np.arange(200), (np.arange(200) + 1) % 200])
    m = ptriangle.mesh(circle, sides, min_angle=25, per_circle=600, max_size=1)
    assert 400 <= len(m.boundary) <= 800


def test_smoothing():
    rough, once, often = (made(size=h, optimise=n) for n in (0, 1, 5))
    assert rough.quality.mean() < once.quality.mean() < often.quality.mean()
    assert len(once.triangles) == len(rough.triangles)
    assert np.array_equal(np.unique(once.points[np.unique(once.boundary)], axis=0),
                          np.unique(rough.points[np.unique(rough.boundary)], axis=0))
    assert np.array_equal(made(size=h).points, once.points)
