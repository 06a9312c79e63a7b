"""Inputs on which a naive triangulator takes quadratic time, of any size n, which is the approximate number of
vertices."""
import math
import random
from dataclasses import dataclass
from typing import Callable

import meshfiles


class Figure(meshfiles.Pslg):
    def point(self, x, y):
        self.points.extend((x, y))
        return len(self.points) // 2 - 1

    def put(self, places):
        return [self.point(x, y) for x, y in places]

    def segment(self, a, b):
        self.segments.extend((a, b))

    def path(self, ids):
        for a, b in zip(ids, ids[1:]):
            self.segment(a, b)

    def ring(self, places):
        ids = self.put(places)
        self.path(ids + ids[:1])
        return ids

    def box(self, low, high):
        return self.ring(((low, low), (high, low), (high, high), (low, high)))

    def spokes(self, centre, ends):
        for end in ends:
            self.segment(centre, end)

    def across(self, width):
        """A segment along the x axis."""
        self.segment(self.point(-width, 0), self.point(width, 0))


def polar(radius, angle):
    return radius * math.cos(angle), radius * math.sin(angle)


def round_places(n, radius=lambda k: 1, first=0.1):
    return [polar(radius(k), first + 2 * math.pi * k / n) for k in range(n)]


def row(n, low, high, height):
    """n points over an interval: (x, height(x))."""
    return [(x, height(x)) for x in (low + (high - low) * i / (n - 1) for i in range(n))]


def random_places(n):
    source = random.Random(1)
    return [(source.random(), source.random()) for _ in range(n)]


def shuffled(items):
    items = list(items)
    random.Random(1).shuffle(items)
    return items


# --- only points

def _points(places):
    figure = Figure()
    figure.put(places)
    return figure


def random_points(n):
    return _points(random_places(n))


def cocircular(n):
    return _points(round_places(n))


def cocircular_with_centre(n):
    return _points([*round_places(n), (0, 0)])


def parabola(n):
    return _points(row(n, -1, 1, lambda x: x * x))


def two_parallel_rows(n):
    return _points([*row(n // 2, 0, 1, lambda x: 0), *row(n // 2, 0, 1, lambda x: 1e-3)])


def two_rows_at_right_angles(n):
    return _points([*row(n // 2, 0, 1, lambda x: 0), *((2, x) for x, _ in row(n // 2, 0, 1, lambda x: 0))])


def grid(n):
    side = math.isqrt(n)
    return _points((i % side, i // side) for i in range(side * side))


def duplicates(n):
    return _points([(0, 0), (1, 0), (0, 1), *[(0.25, 0.25)] * (n - 3)])


def crowded_centre(n):
    """Distances from the centre spread evenly over twelve decades."""
    source = random.Random(1)
    return _points(polar(10 ** (-12 * source.random()), 2 * math.pi * source.random()) for _ in range(n))


def small_clusters(n):
    source = random.Random(1)
    return _points((x + 1e-7 * source.random(), y + 1e-7 * source.random())
                   for x, y in random_places(n // 17) for _ in range(17))


def far_points(n):
    """Two points twelve decades away from all others."""
    return _points([*((1e-6 * x, 1e-6 * y) for x, y in random_places(n)), (1e6, 1e6), (-1e6, 1e5)])


def far_points_and_a_row(n):
    return _points([*row(n, 0, 1e-6, lambda x: x * x), (1e6, 1e6), (-1e6, 1e5)])


def halving_row(n):
    """Coordinates are halved two hundred times, which gives deep cells in any space-filling curve."""
    source = random.Random(1)
    places = [2.0 ** (-i % 200) * 2.0 ** -200 * (1 + 1e-3 * source.random()) for i in range(n)]
    return _points((x, x * x * source.random()) for x in places)


# --- spokes

def hub(n, radius=lambda k: 1, order=shuffled):
    """Spokes from one vertex."""
    figure = Figure()
    centre = figure.point(0, 0)
    figure.spokes(centre, order(figure.put(round_places(n, radius))))
    return figure


def hub_in_order(n):
    return hub(n, order=list)


def hub_of_two_lengths(n):
    """The shortest edge of many triangles ends at the hub."""
    return hub(n, lambda k: 1 + 2 * (k % 2))


def narrow_hub(n):
    """All spokes within 1e-5 radians."""
    figure = Figure()
    centre = figure.point(0, 0)
    figure.spokes(centre, figure.put(polar(1, 1e-5 * k / n) for k in range(n)))
    return figure


def two_hubs(n):
    """Two nearby vertices, each with half of the spokes."""
    figure = Figure()
    left, right = figure.point(-1e-4, 0), figure.point(1e-4, 0)
    for x, y in round_places(n):
        figure.segment(left if x < 0 else right, figure.point(x, y))
    return figure


# --- rings

def circle(n):
    figure = Figure()
    figure.ring(round_places(n))
    return figure


def half_circle(n):
    figure = Figure()
    figure.ring([polar(1, math.pi * k / (n - 1)) for k in range(n)])
    return figure


def circle_with_chords(n, chords=30):
    """Chords near the centre. The corners are nearly cocircular, so cavities contain all triangles."""
    figure = Figure()
    ids = figure.ring(round_places(n))
    for k in range(chords):
        first = k * (n // (2 * chords))
        figure.segment(ids[first], ids[first + n // 2])
    return figure


def circle_with_diameter(n):
    return circle_with_chords(n, 1)


def circle_with_two_diameters(n):
    return circle_with_chords(n, 2)


def star(n, inner=0.5):
    figure = Figure()
    figure.ring(round_places(n, lambda k: 1 if k % 2 else inner))
    return figure


def thin_star(n):
    return star(n, 0.01)


def spiral(n):
    figure = Figure()
    turns = row(n, 1, math.sqrt(n), lambda x: 0)
    figure.path(figure.put(polar(t, t) for t, _ in turns))
    return figure


def nested_triangles(n):
    figure = Figure()
    for k in range(n // 3):
        figure.ring(round_places(3, lambda _, k=k: 1 + 0.001 * k, 0))
    return figure


def crossing_octagons(n):
    """Each ring is larger by 1 and rotated: there are about n * n / 150 crossings."""
    figure = Figure()
    for k in range(n // 8):
        figure.ring(round_places(8, lambda _, k=k: 1 + k, 0.1 * k))
    return figure


# --- teeth, rooms, points inside them

def comb(n, height=1e5, base=1):
    figure, k = Figure(), n // 2
    teeth = [place for x in range(k) for place in ((x, 0), (x + 0.5, height))]
    figure.ring([*teeth, (k, 0), (k, -base), (0, -base)])
    return figure


def thin_comb(n):
    return comb(n, 1, 1e-5)


def needles(n):
    """A box with needles on it, of width 1e-9 and height 1/2."""
    figure, k = Figure(), n // 3
    places = [p for x in range(k) for p in ((x, 0), (x + 5e-10, 0.5), (x + 1e-9, 0))]
    figure.ring([*places, (k, 0), (k, -1), (-1, -1), (-1, 0)])
    return figure


def slots(n, order=shuffled):
    """Thin holes side by side, whose points come in random order."""
    figure, k = Figure(), n // 4
    for x in range(k):
        figure.ring(((x + 0.25, 1), (x + 0.75, 1), (x + 0.75, k + 1), (x + 0.25, k + 1)))
    figure.box(-1, k + 2)
    for x in order(range(k)):
        figure.holes.extend((x + 0.5, k / 2))
    return figure


def slots_in_order(n):
    return slots(n, list)


def strips(n):
    """Thin regions side by side, in random order."""
    figure, k = Figure(), n // 2
    low, high = figure.put((x, 0) for x in range(k)), figure.put((x, k) for x in range(k))
    figure.path(low)
    figure.path(high)
    for a, b in zip(low, high):
        figure.segment(a, b)
    for x in shuffled(range(k - 1)):
        figure.regions.extend((x + 0.5, k / 2, x + 1, -1))
    return figure


def _points_in_a_box(n):
    figure = _points(random_places(n))
    figure.box(-1, 2)
    return figure


def holes_inside(n):
    """The points of all holes lie in the same box."""
    figure = _points_in_a_box(n)
    figure.holes.extend(0.25 + 0.5 * c for place in random_places(n) for c in place)
    return figure


def holes_outside(n):
    """Hole points that lie nowhere in the figure."""
    figure = _points_in_a_box(n)
    figure.holes.extend(5 + c for place in random_places(n) for c in place)
    return figure


def regions_at_one_place(n):
    figure = _points_in_a_box(n)
    for k, (x, y) in enumerate(random_places(n)):
        figure.regions.extend((x, y, k, -1))
    return figure


# --- segments across

def long_crossing(n):
    """One segment across the triangles of n random points in a long strip."""
    figure = _points((n / 4 * (2 * x - 1), y - 0.5) for x, y in random_places(n))
    figure.across(n / 4 + 1)
    return figure


def thirty_crossings(n):
    figure, source = _points(random_places(n)), random.Random(2)
    for _ in range(30):
        figure.segment(figure.point(-0.1, source.random()), figure.point(1.1, source.random()))
    return figure


def facing_curves(n):
    """Two parabolas that bulge towards a segment between them, which would need n * n flips."""
    figure = _points(p for x, y in row(n // 2, -1, 1, lambda x: 1e-3 + x * x) for p in ((x, y), (x, -y)))
    figure.across(2)
    return figure


def lens(n):
    """Two parabolas that bulge away from it."""
    figure = _points(p for x, y in row(n // 2, -1, 1, lambda x: 1.1 - x * x) for p in ((x, y), (x, -y)))
    figure.across(1.2)
    return figure


def _curve_and_point(n, height):
    figure = _points([*row(n, -1, 1, height), (0, -50)])
    figure.across(2)
    return figure


def curve_and_point(n):
    """A curve on one side, one point on the other."""
    return _curve_and_point(n, lambda x: 1e-2 + x * x)


def cap_and_point(n):
    return _curve_and_point(n, lambda x: 1.5 - x * x)


def saws(n):
    """Teeth above and below a segment."""
    figure, k = Figure(), n // 2
    for x in range(k):
        figure.point(x - k / 2, 1 + 5 * (x % 2))
        figure.point(x - k / 2 + 0.3, -1 - 4 * (x % 3))
    figure.across(k / 2 + 5)
    return figure


def lattice_of_segments(n):
    """About n crossings."""
    figure, source, k = Figure(), random.Random(1), math.isqrt(n)
    for i in range(k):
        a, b, c, d = (i + 0.1 * source.random() for _ in range(4))
        figure.segment(figure.point(-1, a), figure.point(k, b))
        figure.segment(figure.point(c, -1), figure.point(d, k))
    return figure


def slits(n):
    """Short segments at random positions, which cross."""
    figure, source, k = Figure(), random.Random(2), n // 2
    for x, y in random_places(k):
        figure.segment(figure.point(x, y), figure.point(x + 2 / math.sqrt(k), y + 1e-9 * source.random()))
    return figure


def parallels(n):
    """Long parallels below a finely sampled curve, in the order of their heights, like strata."""
    figure, k = Figure(), n // 3
    figure.put((i / k, 1 + 0.2 * math.sin(math.pi * i / k)) for i in range(k))
    for y in ((i + 1) / (k + 1) for i in range(k)):
        x = 1 + y * (1 - y)
        figure.segment(figure.point(-x, y), figure.point(1 + x, y))
    return figure


# --- segments along

def on_a_segment(n):
    """A box with n vertices on one side of it."""
    figure = Figure()
    ids = figure.put((k, 0) for k in range(n))
    corners = [ids[0], ids[-1], figure.point(n - 1, 9), figure.point(0, 9)]
    figure.path(corners + corners[:1])
    return figure


def _around(figure, n):
    figure.put(((0, 5), (n, 5), (0, -5), (n, -5)))
    return figure


def one_segment_again(n):
    """The same segment along three hundred vertices, repeated."""
    figure = Figure()
    ids = figure.put((k, 0) for k in range(300))
    for _ in range(n):
        figure.segment(ids[0], ids[-1])
    return _around(figure, 300)


def overlaps(n):
    """Segments of all lengths from one vertex along one line."""
    figure = Figure()
    ids = figure.put((k, 0) for k in range(n))
    figure.spokes(ids[0], ids[1:])
    return _around(figure, n)


def overlapping_path(n, place=lambda x: (x, x)):
    """A path through the points of a line in random order: its segments are a third of the line long on average."""
    figure = Figure()
    figure.path(figure.put(place(x) for x in shuffled(range(n))))
    figure.put(((0, n), (n, 0)))
    return figure


def rounded_path(n):
    """The same beside the line, as close to it as rounding allows."""
    return overlapping_path(n, lambda x: polar(x, 0.3))


@dataclass(frozen=True)
class Case:
    build: Callable
    switches: str             # {n}: the number of vertices
    largest: int = 1_000_000  # number of vertices; smaller if meshes are much larger than inputs, or grow faster


POINTS = (random_points, cocircular, cocircular_with_centre, parabola, two_parallel_rows, two_rows_at_right_angles,
          grid, duplicates, crowded_centre, small_clusters, far_points, far_points_and_a_row, halving_row)
OPEN = (hub, hub_in_order, hub_of_two_lengths, two_hubs, spiral, long_crossing, thirty_crossings, facing_curves, lens,
        curve_and_point, cap_and_point, saws, lattice_of_segments, slits, parallels, one_segment_again, overlaps,
        overlapping_path, rounded_path)
CLOSED = (circle, circle_with_two_diameters, circle_with_chords, star, thin_star, nested_triangles, comb, slots,
          slots_in_order, holes_outside, on_a_segment)
CASES = (
    *(Case(build, "pc") for build in POINTS + OPEN + (holes_inside,)),
    *(Case(build, "p") for build in CLOSED),
    *(Case(build, "pA") for build in (strips, regions_at_one_place)),
    Case(circle, "pD"),
    *(Case(build, "pcq30") for build in (random_points, crowded_centre)),
    Case(parabola, "pcq30S{n}"),
    *(Case(build, "pcq20") for build in (hub, two_hubs)),
    Case(narrow_hub, "pcq25"),
    *(Case(build, "pq20") for build in (circle, half_circle, circle_with_diameter, star)),
    *(Case(build, "pcq20", 100_000) for build in (hub_of_two_lengths, slits)),
    *(Case(build, "pq20", 100_000) for build in (thin_comb, needles)),
    *(Case(crossing_octagons, switches, 10_000) for switches in ("p", "pq20")),
)
