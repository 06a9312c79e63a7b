"""Inputs on which a careless triangulator takes quadratic time, of any size n: about so many vertices. Each builder
returns (Pslg, switches)."""
import math
import random

import meshfiles


class Figure(meshfiles.Pslg):
    def point(self, x, y):
        self.points.extend((x, y))
        return len(self.points) // 2 - 1

    def segment(self, a, b):
        self.segments.extend((a, b))

    def ring(self, places):
        ids = [self.point(x, y) for x, y in places]
        for a, b in zip(ids, ids[1:] + ids[:1]):
            self.segment(a, b)
        return ids


def circle(n, radius=lambda k: 1):
    return [(radius(k) * math.cos(0.1 + 2 * math.pi * k / n), radius(k) * math.sin(0.1 + 2 * math.pi * k / n))
            for k in range(n)]


def hub(n):
    """Spokes from one vertex, of two lengths, in random order: the shortest edge of many triangles ends at the hub."""
    figure, order = Figure(), random.Random(1)
    centre = figure.point(0, 0)
    rim = [figure.point(x, y) for x, y in circle(n, lambda k: 1 + 2 * (k % 2))]
    order.shuffle(rim)
    for end in rim:
        figure.segment(centre, end)
    return figure, "pc"


def two_hubs(n):
    """Two vertices near to each other, each with half of the spokes."""
    figure = Figure()
    left, right = figure.point(-1e-4, 0), figure.point(1e-4, 0)
    for x, y in circle(n):
        figure.segment(left if x < 0 else right, figure.point(x, y))
    return figure, "pc"


def _rooms(n, what):
    """High and narrow rooms side by side, with a point in each, in random order."""
    figure, places, height = Figure(), [], n // 4 + 1
    for k in range(n // 4):
        figure.ring(((k + 0.25, 1), (k + 0.75, 1), (k + 0.75, height), (k + 0.25, height)))
        places.append((k + 0.5, height / 2))
    figure.ring(((-1, 0), (height, 0), (height, height + 1), (-1, height + 1)))
    random.Random(1).shuffle(places)
    for x, y in places:
        what(figure).extend((x, y))
    return figure


def holes(n):
    """Thin slots."""
    return _rooms(n, lambda figure: figure.holes), "p"


def circle_diameters(n):
    """Two diameters that cross in a circle whose corners are nearly cocircular: cavities of all triangles."""
    figure = Figure()
    ids = figure.ring(circle(n))
    figure.segment(ids[0], ids[n // 2])
    figure.segment(ids[n // 4], ids[3 * n // 4])
    return figure, "p"


def facing_curves(n):
    """Two parabolas that bulge towards a segment between them: flips would be n * n."""
    figure, k = Figure(), n // 2
    for i in range(k):
        x = 2 * i / (k - 1) - 1
        figure.point(x, 1e-3 + x * x)
        figure.point(x, -1e-3 - x * x)
    figure.segment(figure.point(-2, 0), figure.point(2, 0))
    return figure, "pc"


def on_a_segment(n):
    """A box with n vertices on one side of it."""
    figure = Figure()
    ids = [figure.point(k, 0) for k in range(n)]
    corners = [ids[0], ids[-1], figure.point(n - 1, 9), figure.point(0, 9)]
    for a, b in zip(corners, corners[1:] + corners[:1]):
        figure.segment(a, b)
    return figure, "p"


def overlaps(n):
    """Segments of all lengths from one vertex along one line."""
    figure = Figure()
    ids = [figure.point(k, 0) for k in range(n)]
    for x, y in ((0, 5), (n, 5), (0, -5), (n, -5)):
        figure.point(x, y)
    for end in ids[1:]:
        figure.segment(ids[0], end)
    return figure, "pc"


def overlapping_path(n):
    """A path through the points of a line in random order: its segments are a third of the line long on average."""
    figure, places = Figure(), list(range(n))
    random.Random(1).shuffle(places)
    ids = [figure.point(x, x) for x in places]
    for a, b in zip(ids, ids[1:]):
        figure.segment(a, b)
    figure.point(0, n)
    figure.point(n, 0)
    return figure, "pc"


def rounded_path(n):
    """The same beside the line, as near to it as rounding lets points be."""
    figure, places = Figure(), list(range(n))
    random.Random(1).shuffle(places)
    ids = [figure.point(x * math.cos(0.3), x * math.sin(0.3)) for x in places]
    for a, b in zip(ids, ids[1:]):
        figure.segment(a, b)
    figure.point(0, n)
    figure.point(n, 0)
    return figure, "pc"


def long_crossing(n):
    """One segment across the triangles of n random points in a long strip."""
    figure, source = Figure(), random.Random(1)
    for _ in range(n):
        figure.point(source.random() * n / 4, source.random() - 0.5)
    figure.segment(figure.point(-1, 0), figure.point(n / 4 + 1, 0))
    return figure, "pc"


def circle_diameter_quality(n):
    figure = Figure()
    ids = figure.ring(circle(n))
    figure.segment(ids[0], ids[n // 2])
    return figure, "pq20"


def needles(n):
    """A box with needles on it, of width 1e-9 and height 1/2."""
    figure = Figure()
    places = [p for k in range(n // 3) for p in ((k, 0), (k + 5e-10, 0.5), (k + 1e-9, 0))]
    figure.ring([*places, (n // 3, 0), (n // 3, -1), (-1, -1), (-1, 0)])
    return figure, "pq20"


def slits(n):
    """Short segments at random places, which cross."""
    figure, source, k = Figure(), random.Random(1), n // 2
    for _ in range(k):
        x, y = source.random(), source.random()
        figure.segment(figure.point(x, y), figure.point(x + 2 / math.sqrt(k), y + 1e-9 * source.random()))
    return figure, "pcq20"


TRIANGULATION = (hub, two_hubs, holes, circle_diameters, facing_curves, on_a_segment, overlaps, overlapping_path,
                 rounded_path, long_crossing)
DEARER = (circle_diameter_quality, needles, slits)
