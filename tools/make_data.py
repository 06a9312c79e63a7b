#!/usr/bin/env python3
"""Makes the project's own inputs in data/, with data/README.md and data/expected.txt.

    python3 tools/make_data.py [data]

Python 3 standard library only; every run gives the same bytes. Numbers are the shortest decimals that read back as the
same double. Results of sin, cos and similar functions are rounded to a few decimals, so they do not depend on the
mathematics library. data/coast/ comes from make_coast.py, and a part of data/regress/ from elsewhere: these are read
here for the tables, and not written.

Each input is one function with the decorator @case, which states the purpose of the file and the expected behaviour.
"""
import argparse
import math
import os
import random

import pslg_facts

CASES = []


class Case:
    def __init__(self, name, build, what, right, runs):
        self.name, self.build, self.what, self.right, self.runs = name, build, what, right, runs


def case(name, what, right, runs=("-p",)):
    """Registers a builder. It returns a Poly, or bytes for files that are written unchanged."""
    def register(build):
        CASES.append(Case(name, build, what, right, runs))
        return build
    return register


# --- Poly, and writing

def number(value):
    return repr(value)[:-2] if isinstance(value, float) and repr(value).endswith(".0") else repr(value)


class Poly:
    """Collects points, segments, holes and regions. Equal points given to point() become one vertex."""

    def __init__(self, base=1, with_markers=True):
        self.base, self.with_markers = base, with_markers
        self.points, self.attributes, self.markers = [], [], []
        self.segments, self.holes, self.regions = [], [], []
        self.index = {}

    def new_point(self, x, y, marker=0, attributes=()):
        self.points.append((x, y))
        self.attributes.append(attributes)
        self.markers.append(marker)
        return len(self.points) - 1

    def point(self, x, y, marker=0, attributes=()):
        if (x, y) not in self.index:
            self.index[x, y] = self.new_point(x, y, marker, attributes)
        k = self.index[x, y]
        self.markers[k] = self.markers[k] or marker
        return k

    def segment(self, a, b, marker=0):
        self.segments.append((a, b, marker))

    def path(self, points, marker=0):
        ids = [self.point(x, y, marker) for x, y in points]
        for a, b in zip(ids, ids[1:]):
            self.segment(a, b, marker)

    def ring(self, points, marker=0):
        self.path(list(points) + [points[0]], marker)

    def box(self, x0, y0, x1, y1, marker=0):
        self.ring([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], marker)

    def hole(self, x, y):
        self.holes.append((x, y))

    def region(self, x, y, attribute, area=-1):
        self.regions.append((x, y, attribute, area))

    def rows(self, is_poly):
        base, marked = self.base, self.with_markers
        columns = max(map(len, self.attributes), default=0)
        yield "%d 2 %d %d" % (len(self.points), columns, marked)
        for k, (p, a, m) in enumerate(zip(self.points, self.attributes, self.markers)):
            yield " ".join([str(k + base), *map(number, (*p, *a)), *([str(m)] if marked else [])])
        if not is_poly:
            return
        yield "%d %d" % (len(self.segments), marked)
        for k, (a, b, m) in enumerate(self.segments):
            yield " ".join([str(k + base), str(a + base), str(b + base), *([str(m)] if marked else [])])
        for rows in (self.holes, self.regions):
            yield "%d" % len(rows)
            for k, row in enumerate(rows):
                yield " ".join([str(k + base), *map(number, row)])

    def text(self, title, is_poly):
        return "\n".join(["# " + title, *self.rows(is_poly)]) + "\n"


def cloud(points):
    """A vertex set without markers, for .node files."""
    poly = Poly(with_markers=False)
    for p in points:
        poly.new_point(*p)
    return poly


# --- helpers

def circle(x, y, radius, count, turn=0.0, digits=6):
    """Counterclockwise regular polygon, first corner at angle turn * 360 / count degrees."""
    angles = [2 * math.pi * (k + turn) / count for k in range(count)]
    return [(round(x + radius * math.cos(t), digits), round(y + radius * math.sin(t), digits)) for t in angles]


def arc(x, y, radius, start, stop, count, digits=6):
    """Points on a circle from angle start to stop (degrees), both included."""
    angles = [math.radians(start + (stop - start) * k / (count - 1)) for k in range(count)]
    return [(round(x + radius * math.cos(t), digits), round(y + radius * math.sin(t), digits)) for t in angles]


# --- shapes and sections

def letter_outline():
    bowl = arc(5.25, 10.25, 3.75, -60, 90, 21)
    outline = [(1.0, 0.0), (5.0, 0.0), (5.0, 0.75), (4.25, 1.25), (4.25, 6.5), (5.0, 6.5), (7.25, 1.25), (6.75, 0.75),
               (6.75, 0.0), (10.5, 0.0), (10.5, 0.75), (9.75, 1.25), *bowl,
               (1.0, 14.0), (1.0, 13.25), (1.75, 12.75), (1.75, 1.25), (1.0, 0.75)]
    counter = [(4.25, 8.0), *arc(5.25, 10.25, 2.25, -90, 90, 17), (4.25, 12.5)]
    return outline, counter


@case("letter.poly", "a slab-serif letter R; one attribute column (height above the base line, 0..1), one hole",
      "interpolates the attribute at new vertices: it stays y / 14 within 1e-6")
def letter():
    poly = Poly()
    outline, counter = letter_outline()
    for ring, marker in ((outline, 1), (counter, 2)):
        for x, y in ring:
            poly.point(x, y, marker, (round(y / 14, 6),))
        poly.ring(ring, marker)
    poly.hole(5.0, 10.25)
    return poly


@case("square.poly", "the unit square",
      "two triangles: the smallest valid run")
def square():
    poly = Poly()
    poly.box(0, 0, 1, 1, 1)
    return poly


@case("square_random1000.poly", "the unit square with 1000 random points inside", "keeps every input vertex")
def square_random():
    poly = square()
    numbers = random.Random(1000)
    for _ in range(1000):
        poly.point(numbers.random(), numbers.random())
    return poly


@case("box_hole.poly", "box with an off-centre hole; markers 1..4 on the sides, 5 on the hole",
      "passes the markers on to split segments and new vertices")
def box_hole():
    poly = Poly()
    corners = [(0, 0), (4, 0), (4, 3), (0, 3)]
    for k in range(4):
        poly.path([corners[k], corners[(k + 1) % 4]], k + 1)
    poly.ring([(2.5, 1), (3.25, 1.25), (3, 2), (2.25, 2.25), (1.75, 1.5)], 5)
    poly.hole(2.5, 1.5)
    return poly


@case("section.poly",
      "retaining wall on layered ground, metres: rock 1, clay 2, sand 3, concrete 4, backfill 5, gravel 6, steel "
      "sheet pile 7 (1/8 m thick), asphalt 8, tunnel lining 9; a tunnel as hole; area bound per region",
      "-pqaA: attributes and area bounds are correct on both sides of shared interfaces")
def section():
    poly = Poly()
    poly.path([(0, -16), (40, -16)], 1)
    poly.path([(40, -16), (40, -10), (40, -3), (40, -0.5), (40, 7.75), (40, 8)], 2)
    poly.path([(40, 8), (19, 8), (17, 8), (16.5, 8), (16, 8), (16, 0), (0, 0)], 3)
    poly.path([(0, 0), (0, -3), (0, -11), (0, -16)], 2)
    poly.path([(0, -11), (12, -10.5), (24, -9), (40, -10)], 10)
    poly.path([(0, -3), (16, -3)], 10)
    poly.path([(16.125, -3), (40, -3)], 10)
    poly.path([(16, 0), (16, -0.5), (14, -0.5), (14, -1.5), (16, -1.5), (16.125, -1.5), (21, -1.5), (21, -0.5),
               (18, -0.5), (17.5, -0.5), (16.5, 8)], 11)
    poly.path([(21, -0.5), (40, -0.5)], 10)
    poly.path([(18, -0.5), (17, 8)], 12)
    poly.path([(16, -1.5), (16, -3), (16, -6.5), (16.125, -6.5), (16.125, -3), (16.125, -1.5)], 13)
    poly.path([(19, 8), (19, 7.75), (40, 7.75)], 14)
    poly.ring(circle(30, -6.5, 1.5, 24), 15)
    poly.ring(circle(30, -6.5, 1.25, 24, 0.5), 20)
    poly.hole(30, -6.5)
    for x, y, attribute, area in ((20, -14, 1, 8), (5, -6, 2, 4), (5, -1.5, 3, 2), (16.5, 2, 4, 0.25), (30, 3, 5, 3),
                                  (17.5, 2, 6, 0.125), (16.0625, -5, 7, 0.0078125), (30, 7.875, 8, 0.0625),
                                  (30, -1.5, 3, 2), (31.375, -6.5, 9, 0.0625)):
        poly.region(x, y, attribute, area)
    return poly


def involute(angle):
    return math.tan(angle) - angle


def gear_tooth(teeth, module, k):
    """Counterclockwise points of tooth k and of the root before it; pressure angle 20 degrees."""
    pitch, alpha = teeth * module / 2, math.radians(20)
    base, tip, root = pitch * math.cos(alpha), pitch + module, pitch - 1.25 * module
    middle = 2 * math.pi * k / teeth
    flank = []
    for i in range(7):
        radius = base + (tip - base) * i / 6
        flank.append((radius, math.pi / (2 * teeth) + involute(alpha) - involute(math.acos(min(1.0, base / radius)))))
    foot = flank[0][1]
    gap = 2 * math.pi / teeth - 2 * foot
    polar = [(root, middle - foot - gap / 2), (root, middle - foot), *((r, middle - a) for r, a in flank),
             (tip, middle), *((r, middle + a) for r, a in reversed(flank)), (root, middle + foot)]
    return [(round(r * math.cos(t), 6), round(r * math.sin(t), 6)) for r, t in polar]


@case("gear.poly", "involute spur gear, 24 teeth, module 2 mm; bore with keyway, six lightening holes",
      "carves seven holes; handles short root segments beside long flanks")
def gear():
    poly = Poly()
    poly.ring([p for k in range(24) for p in gear_tooth(24, 2, k)], 1)
    key = arc(0, 0, 6, 110, 430, 41)
    poly.ring(key + [(key[-1][0], 8.25), (key[0][0], 8.25)], 2)
    poly.hole(0, 0)
    for k in range(6):
        x, y = circle(0, 0, 13.5, 6, 0.25)[k]
        poly.ring(circle(x, y, 3, 24), 3)
        poly.hole(x, y)
    return poly


def naca4(camber, position, thickness, count):
    """Airfoil of chord 1 with closed trailing edge; counterclockwise from the trailing edge over the upper side."""
    def surface(x, side):
        half = 5 * thickness * (0.2969 * math.sqrt(x) - 0.1260 * x - 0.3516 * x ** 2 + 0.2843 * x ** 3 -
                                0.1036 * x ** 4)
        front = x < position
        scale = camber / (position ** 2 if front else (1 - position) ** 2)
        mean = scale * ((0 if front else 1 - 2 * position) + 2 * position * x - x * x)
        slope = 2 * scale * (position - x)
        length = math.sqrt(1 + slope * slope)
        return (round(x - side * half * slope / length, 9), round(mean + side * half / length, 9))

    stations = [(1 - math.cos(math.pi * k / count)) / 2 for k in range(1, count)]
    return [(1, 0), *(surface(x, 1) for x in reversed(stations)), (0, 0), *(surface(x, -1) for x in stations)]


@case("naca2412_box.poly", "NACA 2412 airfoil (closed trailing edge, 200 points, cosine spacing) as hole in a box",
      "edge lengths grow from 2e-4 at the nose to the size of the box")
def naca():
    poly = Poly()
    poly.box(-1.5, -1.5, 3, 1.5, 1)
    poly.ring(naca4(0.02, 0.4, 0.12, 100), 2)
    poly.hole(0.5, 0.02)
    return poly


def koch(level, scale):
    """Koch snowflake, counterclockwise, about the origin."""
    height = math.sqrt(3) / 2
    ring = [(-0.5, -height / 3), (0.5, -height / 3), (0.0, 2 * height / 3)]
    for _ in range(level):
        finer = []
        for (ax, ay), (bx, by) in zip(ring, ring[1:] + ring[:1]):
            dx, dy = (bx - ax) / 3, (by - ay) / 3
            finer += [(ax, ay), (ax + dx, ay + dy),
                      (ax + 1.5 * dx + height * dy, ay + 1.5 * dy - height * dx), (ax + 2 * dx, ay + 2 * dy)]
        ring = finer
    return [(round(scale * x, 9), round(scale * y, 9)) for x, y in ring]


@case("koch_lake.poly", "lake bounded by a Koch snowflake of level 5 with an island of level 3",
      "3264 boundary segments; all corners have 60 or 240 degrees")
def koch_lake():
    poly = Poly()
    poly.ring(koch(5, 1.0), 1)
    poly.ring(koch(3, 0.4), 2)
    poly.hole(0, 0)
    return poly


@case("perforated.poly", "plate with 400 round holes of random size (dodecagons)",
      "carves 400 holes")
def perforated():
    poly = Poly()
    numbers = random.Random(400)
    poly.box(0, 0, 25, 16, 1)
    for i in range(25):
        for j in range(16):
            poly.ring(circle(i + 0.5, j + 0.5, 0.125 + 0.25 * numbers.random(), 12, numbers.random(), 4), 2)
            poly.hole(i + 0.5, j + 0.5)
    return poly


@case("cracked_plate.poly",
      "plate with a round hole and dangling segments: a crack from the edge, a branched one from the hole, one with "
      "both tips inside",
      "triangles on both sides of a crack stay; crack tips are vertices")
def cracked_plate():
    poly = Poly()
    poly.ring([(0, 0), (10, 0), (10, 6), (0, 6), (0, 3)], 1)
    rim = circle(7, 3.5, 1, 32)
    poly.ring(rim, 2)
    poly.hole(7, 3.5)
    poly.path([(0, 3), (1.5, 3.125), (2.25, 2.875), (3, 3)], 3)
    poly.path([rim[20], (5.5, 2.25), (5.25, 1.5), (5.75, 1)], 4)
    poly.path([(5.25, 1.5), (4.5, 1.25)], 4)
    poly.path([(3.5, 4.5), (4.25, 4.75), (4.875, 4.625)], 5)
    return poly


@case("thin_channel.poly", "channel of 1 x 1e-3; markers inlet 1, outlet 2, walls 3",
      "-pq20: about 1000 triangles, no more than the thickness requires")
def thin_channel():
    poly = Poly()
    poly.path([(0, 0), (1, 0)], 3)
    poly.path([(1, 0), (1, 0.001)], 2)
    poly.path([(1, 0.001), (0, 0.001)], 3)
    poly.path([(0, 0.001), (0, 0)], 1)
    return poly


# --- small and narrow angles

def fan(points):
    poly = Poly()
    poly.ring([(0, 0), *points], 1)
    for p in points[1:-1]:
        poly.path([(0, 0), p])
    return poly


SHELLS = "ends; only angles forced by small input angles are below the bound"


@case("nasty/fan_1deg.poly", "20 wedges of 1 degree at one vertex", SHELLS)
def fan_1deg():
    return fan(arc(0, 0, 1, 0, 20, 21, 12))


@case("nasty/fan_1e-3deg.poly", "20 wedges of 1e-3 degree at one vertex", SHELLS)
def fan_1e3():
    return fan([(1, k * 1.7453292519943e-05) for k in range(21)])


@case("nasty/fan_1e-6deg.poly", "20 wedges of 1e-6 degree at one vertex", SHELLS)
def fan_1e6():
    return fan([(1, k * 1.7453292519943e-08) for k in range(21)])


@case("nasty/needle_1e-9.poly", "one triangle with an angle of 1e-9 degree", SHELLS)
def needle():
    return fan([(1, 0), (1, 1.7453292519943e-11)])


@case("nasty/spike.poly",
      "square with a cape and an inlet out and back along nearly one line, tips of 1e-11 degree, as real coastlines "
      "have",
      "ends; makes no splits near the tips that are finer than the resolution of doubles")
def spike():
    poly = Poly()
    e = 1.7453e-13
    poly.ring([(0, 0), (2, 0), (2, 1 - e), (3, 1 - e / 2), (4, 1), (3.5, 1 + e / 4), (2, 1 + e), (2, 2), (0, 2),
               (0, 1 + e), (1, 1 + e / 2), (2 - 0.5, 1), (0.75, 1 - e / 2), (0, 1 - e)], 1)
    return poly


@case("nasty/spike_flat.poly",
      "square whose outline runs out and back over the same vertices: two segments given twice",
      "ignores the flat part, which encloses no area; 2 of 7 vertices remain unused")
def spike_flat():
    poly = Poly()
    poly.ring([(0, 0), (2, 0), (2, 1), (3, 1.25), (4, 1), (3, 1.25), (2, 1), (2, 2), (0, 2)], 1)
    return poly


@case("nasty/slit_1e-9.poly", "two parallel segments of length 0.5 at distance 1e-9 in the unit square",
      "-pq20 would need about 1e9 triangles: stops at a limit or gives up the slit, without a crash")
def slit():
    poly = square()
    poly.path([(0.25, 0.5), (0.75, 0.5)], 2)
    poly.path([(0.25, 0.500000001), (0.75, 0.500000001)], 2)
    return poly


@case("nasty/aspect_1e8.poly", "rectangle of 1e8 x 1",
      "-pq20 would need 1e8 triangles: stops at a limit, without a crash")
def aspect():
    poly = Poly()
    poly.box(0, 0, 1e8, 1, 1)
    return poly


@case("nasty/tiny_feature.poly", "unit square with a triangle of size 1e-12 inside",
      "edge lengths grow over 12 decades")
def tiny_feature():
    poly = square()
    poly.ring([(0.5, 0.5), (0.500000000001, 0.5), (0.5, 0.500000000001)], 2)
    return poly


@case("nasty/dense_parallel.poly", "eight zigzag chains, each one ulp above the last, in the unit square",
      "-p is exact; -q stops at the resolution of doubles")
def dense_parallel():
    poly = square()
    for k in range(8):
        poly.path([((j + 1) / 22, 0.625 + (j % 3) / 64 + k * 2.0 ** -53) for j in range(21)], 2)
    return poly


# --- point sets

PLAIN = ("-Q",)


@case("nasty/cocircular_grid.node", "integer grid of 101 x 101: each cell is cocircular",
      "20000 triangles; every run breaks ties in the same way", PLAIN)
def cocircular_grid():
    return cloud((i, j) for j in range(101) for i in range(101))


@case("nasty/grid_rotated.node", "grid of 41 x 41 turned by the angle of the 3-4-5 triangle and rounded",
      "hull and cells are almost collinear and cocircular; Triangle crashes on such a file with -q",
      PLAIN)
def grid_rotated():
    return cloud((0.8 * i - 0.6 * j, 0.6 * i + 0.8 * j) for j in range(41) for i in range(41))


@case("nasty/cocircular_ring.node", "all 252 integer points on the circle of radius 27625", "250 triangles", PLAIN)
def cocircular_ring():
    radius = 27625
    points = []
    for x in range(-radius, radius + 1):
        y = math.isqrt(radius * radius - x * x)
        if x * x + y * y == radius * radius:
            points += [(x, y), (x, -y)] if y else [(x, 0)]
    return cloud(points)


@case("nasty/collinear.node", "100 points exactly on one line", "0 triangles, exit 0, also with -q", PLAIN)
def collinear():
    return cloud((k, 2 * k) for k in range(100))


@case("nasty/near_collinear.node", "400 points on y = 0.3 x + 0.1, rounded: off the line by at most an ulp",
      "exact predicates find all triangles", PLAIN)
def near_collinear():
    numbers = random.Random(300)
    xs = sorted(numbers.random() for _ in range(400))
    return cloud((x, 0.3 * x + 0.1) for x in xs)


@case("nasty/collinear.poly", "chain of segments on one line", "0 triangles, exit 0", ("-p", "-pc"))
def collinear_poly():
    poly = Poly()
    poly.path([(k, 3 * k) for k in range(10)], 1)
    return poly


@case("nasty/duplicates.node", "500 random points, every second one twice",
      "uses the copy with the lowest number",
      PLAIN)
def duplicates_node():
    numbers = random.Random(500)
    points = [(numbers.random(), numbers.random()) for _ in range(500)]
    points += points[::2]
    numbers.shuffle(points)
    return cloud(points)


@case("nasty/identical.node", "five times the same point", "error: all vertices are identical", PLAIN)
def identical():
    return cloud([(1.5, 2.5)] * 5)


# --- segments that meet incorrectly

@case("nasty/duplicates.poly", "square with a diagonal chain; most segments name second or third copies of the points",
      "moves segments to the copy with the lowest number; does not crash")
def duplicates_poly():
    poly = Poly()
    corners = [(0, 0), (4, 0), (4, 4), (0, 4)]
    first = [poly.new_point(x, y, 1) for x, y in corners]
    second = [poly.new_point(x, y, 1) for x, y in corners]
    middle = [poly.new_point(2, 2.5) for _ in range(3)]
    poly.segment(first[0], second[1], 1)
    poly.segment(second[1], first[2], 1)
    poly.segment(second[2], second[3], 1)
    poly.segment(first[3], second[0], 1)
    poly.segment(second[0], middle[1], 2)
    poly.segment(middle[2], first[2], 2)
    poly.segment(middle[0], middle[2], 3)
    return poly


@case("nasty/crossing.poly", "12 + 12 + 12 crossing segments in a box; all crossings are exact doubles",
      "makes a new vertex at every crossing, also with plain -p")
def crossing():
    poly = Poly()
    poly.box(0, 0, 12, 12, 1)
    for k in range(12):
        poly.path([(0.25, k + 0.5), (11.75, k + 0.5)], 2)
        poly.path([(k + 0.5, 0.25), (k + 0.5, 11.75)], 3)
    for k in range(-6, 6):
        x0, x1 = max(0.125, 0.125 - k - 0.25), min(11.875, 11.875 - k - 0.25)
        poly.path([(x0, x0 + k + 0.25), (x1, x1 + k + 0.25)], 4)
    return poly


@case("nasty/crossing_triple.poly", "as crossing.poly, but three segments pass through each crossing on the diagonals",
      "one vertex for each triple crossing, no sliver triangles")
def crossing_triple():
    poly = Poly()
    poly.box(0, 0, 8, 8, 1)
    for k in range(8):
        poly.path([(0.25, k + 0.5), (7.75, k + 0.5)], 2)
        poly.path([(k + 0.5, 0.25), (k + 0.5, 7.75)], 3)
    for k in range(-3, 4):
        poly.path([(max(0, -k) + 0.125, max(0, k) + 0.125), (8 - max(0, k) - 0.125, 8 - max(0, -k) - 0.125)], 4)
    return poly


@case("nasty/crossing_random.poly", "60 random segments in the unit square; crossings are rounded",
      "finds as many crossings as exact arithmetic")
def crossing_random():
    poly = square()
    numbers = random.Random(60)
    for _ in range(60):
        poly.path([(numbers.random(), numbers.random()), (numbers.random(), numbers.random())], 2)
    return poly


@case("nasty/bowtie.poly", "quadrilateral that crosses itself",
      "two triangles that meet at a new vertex in the middle")
def bowtie():
    poly = Poly()
    poly.ring([(0, 0), (4, 4), (4, 0), (0, 4)], 1)
    return poly


@case("nasty/overlap.poly", "collinear segments that overlap, contain or repeat each other, points on segments, a "
      "segment on the side of the box", "each piece is one subsegment; the first non-zero marker wins")
def overlap():
    poly = Poly()
    poly.box(0, 0, 8, 8, 1)
    for k, (p, q) in enumerate((((1, 1), (5, 1)), ((3, 1), (7, 1)), ((2, 2), (6, 2)), ((3, 2), (5, 2)),
                                ((6, 2), (2, 2)), ((2, 0), (6, 0)), ((1, 3), (5, 7)), ((2, 4), (4, 6)),
                                ((7, 3), (7, 7)), ((7, 3), (7, 5)))):
        poly.path([p, q], k + 2)
    for p in ((3, 5), (4, 8), (4, 1), (7, 6), (8, 0.5)):
        poly.point(*p)
    return poly


@case("nasty/tjunction.poly", "segments end in the middle of other segments, exactly",
      "splits the other segments there; makes no new vertex")
def tjunction():
    poly = Poly()
    poly.box(0, 0, 8, 8, 1)
    for p, q in (((0, 4), (8, 4)), ((4, 4), (4, 8)), ((2, 0), (2, 4)), ((6, 4), (6, 2)), ((0, 5), (3, 8)),
                 ((1.5, 6.5), (4, 6.5))):
        poly.path([p, q], 2)
    return poly


@case("nasty/self_touch.poly",
      "outline touching itself at a vertex, a hole touching the outline at a corner, two holes sharing a corner",
      "accepts a vertex with several separate fans")
def self_touch():
    poly = Poly()
    poly.ring([(0, 0), (8, 0), (8, 8), (4, 4), (0, 8)], 1)
    poly.ring([(4, 4), (6, 12), (2, 12)], 1)
    poly.ring([(0, 0), (2, 1), (1, 2)], 2)
    poly.ring([(4, 1), (5, 2), (4, 3), (3, 2)], 3)
    poly.ring([(5, 2), (6, 1), (7, 2), (6, 3)], 3)
    for x, y in ((1, 1), (4, 2), (6, 2)):
        poly.hole(x, y)
    return poly


@case("nasty/nested_holes.poly", "seven nested squares, every second ring-shaped face a hole",
      "a hole ends at the next ring; islands inside holes remain")
def nested_holes():
    poly = Poly()
    for k in range(7):
        poly.box(k, k, 16 - k, 16 - k, k + 1)
    for k in (1, 3, 5):
        poly.hole(k + 0.5, 8)
    return poly


@case("nasty/hole_eats_all.poly", "square with a hole point in its middle", "0 triangles, exit 0", ("-p", "-pc"))
def hole_eats_all():
    poly = square()
    poly.hole(0.5, 0.375)
    return poly


@case("nasty/open_boundary.poly", "three sides of a square",
      "-p: removes all triangles, exit 0; -pc: two triangles",
      ("-p", "-pc"))
def open_boundary():
    poly = Poly()
    poly.path([(0, 0), (1, 0), (1, 1), (0, 1)], 1)
    return poly


@case("nasty/badindex.poly", "square and a diagonal; further segments name vertices 0, 9 and -3 or twice the same one",
      "skips these four segments with a warning each, exit 0")
def badindex():
    poly = square()
    poly.segment(0, 2, 2)
    for a, b in ((0, 8), (-1, 2), (1, -4), (3, 3)):
        poly.segment(a, b, 3)
    return poly


# --- scale, base

def small_shape(move, base=1):
    poly = Poly(base)
    poly.ring([move(*p) for p in ((0.125, 0.25), (0.875, 0.125), (0.75, 0.625), (0.9375, 0.875), (0.25, 0.8125))], 1)
    poly.ring([move(*p) for p in ((0.375, 0.375), (0.625, 0.3125), (0.5625, 0.5625), (0.4375, 0.625))], 2)
    poly.hole(*move(0.5, 0.5))
    return poly


SAME = "the mesh of base1.poly, translated or scaled"


@case("base1.poly", "pentagon with a quadrilateral hole, numbers from 1",
      "numbers in the output begin at 1")
def base1():
    return small_shape(lambda x, y: (x, y))


@case("base0.poly", "the same with numbers from 0",
      "numbers in the output begin at 0, without -z")
def base0():
    return small_shape(lambda x, y: (x, y), 0)


@case("nasty/huge_offset.poly", "the shape of base1.poly with 1e7 added", SAME)
def huge_offset():
    return small_shape(lambda x, y: (x + 1e7, y + 1e7))


@case("nasty/tiny_scale.poly", "the shape of base1.poly times 1e-300: products of coordinates underflow",
      SAME + "; Triangle gives 0 triangles without a message")
def tiny_scale():
    return small_shape(lambda x, y: (x * 1e-300, y * 1e-300))


@case("nasty/huge_scale.poly", "the shape of base1.poly times 1e150: fourth powers overflow", SAME)
def huge_scale():
    return small_shape(lambda x, y: (x * 1e150, y * 1e150))


def lexical(base):
    long_blank = " " * 1500
    rows = ["# comment before anything", "", "\t  \t", "7 2 1 1   extra fields 99 # vertices", "",
            "vertex %d: +0.0e0\t-0 , 1.5 ; 1" % base, "%d, 4. , .0 , 25e-1, 1# no blank before this" % (base + 1),
            "#5 6 7", "77 = (4 ; +4.0E+0) 3 1", "%d\t\t00.0 4 %s4.5 1 1 1 1" % (base + 3, long_blank),
            "no number in this line", "%d 1 1" % (base + 4), "-1 3 1 0.5", "%d 2 3 -7e-2 0" % base,
            "7 1 " + "# " + "long " * 500, "1, %d, %d, 11" % (base, base + 1), "2 %d %d +12" % (base + 1, base + 2),
            "3 from %d to %d" % (base + 2, base + 3), "", "4 (%d , %d , 14 )" % (base + 3, base),
            "5 %d %d 2" % (base + 4, base + 5), "6 %d %d 2 # hole" % (base + 5, base + 6),
            "7 %d %d 2" % (base + 6, base + 4), "1 hole", "1 , 2 , 1.5", "# regions", "1", "1 0.5 0.5 8"]
    ends = ["\r\n", "\n", " \r\n", "\t\n"]
    return "".join(row + ends[k % 4] for k, row in enumerate(rows))[:-1].encode("ascii")


LEXICAL = "square with a triangular hole written badly: CRLF, commas, words, comments, tabs, signs, wrong record " \
    "numbers, missing and extra fields, lines over 2000 characters, no end of line at the end"


@case("lexical.poly", LEXICAL, "reads it like a clean file; numbers from 1")
def lexical1():
    return lexical(1)


@case("lexical_base0.poly", "the same with numbers from 0", "numbers from 0")
def lexical0():
    return lexical(0)


# --- malformed files

def malformed(name, what, content, runs):
    case(name, what, "error with file and line, exit 1, no output", runs)(
        lambda: content if isinstance(content, bytes) else content.encode("ascii"))


SQUARE = "4 2 0 0\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n"
SIDES = "4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n"

for _name, _what, _content in (
        ("two_points.node", "two vertices", "2 2 0 0\n1 0 0\n2 1 0\n"),
        ("nan.node", "a coordinate that is nan", "4 2 0 0\n1 0 0\n2 1 0\n3 nan 1\n4 0 1\n"),
        ("inf.node", "a coordinate too large for a double", "4 2 0 0\n1 0 0\n2 1 0\n3 1e400 1\n4 0 1\n"),
        ("inf_word.node", "a coordinate that is inf", "4 2 0 0\n1 0 0\n2 1 0\n3 1 inf\n4 0 1\n"),
        ("missing_y.node", "a vertex without y", "4 2 0 0\n1 0 0\n2 1\n3 1 1\n4 0 1\n"),
        ("truncated.node", "ten vertices announced, four there", SQUARE.replace("4 2", "10 2", 1)),
        ("count_huge.node", "4e9 vertices announced: no memory may be taken for them",
         SQUARE.replace("4 2", "4000000000 2", 1)),
        ("count_negative.node", "-4 vertices announced", SQUARE.replace("4 2", "-4 2", 1)),
        ("dim3.node", "three-dimensional", "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n"),
        ("empty.node", "an empty file", ""),
        ("comments_only.node", "nothing but comments", "# 4 2 0 0\n\n# 1 0 0\n"),
        ("rubbish.node", "4096 random bytes", random.Random(4096).randbytes(4096))):
    malformed("nasty/" + _name, _what, _content, PLAIN)
for _name, _what, _content in (
        ("truncated.poly", "ends in the middle of a segment", SQUARE + "4 0\n1 1 2\n2 2 3\n3 3"),
        ("no_hole_count.poly", "ends before the line with the number of holes", SQUARE + SIDES),
        ("missing_endpoint.poly", "a segment with one end", SQUARE + SIDES.replace("3 3 4", "3 3") + "0\n"),
        ("missing_hole_y.poly", "a hole without y", SQUARE + SIDES + "1\n1 0.5\n"),
        ("rubbish.poly", "a valid vertex section, then random bytes",
         SQUARE.encode("ascii") + random.Random(77).randbytes(1000))):
    malformed("nasty/" + _name, _what, _content, ("-p",))
malformed("nasty/region_no_value.poly", "a region with neither attribute nor area",
          SQUARE + SIDES + "0\n1\n1 0.5 0.5\n", ("-pA",))


@case("nasty/badindex_mesh.node", "vertices for badindex_mesh.ele, whose second triangle names vertex 7 of 4",
      "error, exit 1, no output", ("-r",))
def badindex_mesh():
    return SQUARE.encode("ascii")


EXTRA_FILES = {"nasty/badindex_mesh.ele": "2 3 0\n1 1 2 3\n2 1 3 7\n"}


# --- coordinates from public bug reports

OUTSIDE = """
2.1948854485272875 0.2233940429716767 2.210334747734508 0.2045690176995104 2.23101526067872 0.19170904853717624
2.2547319630849922 0.18617908927292653 2.2789675703171275 0.18856608834740984 2.301149721315429 0.1986166902985606
2.3189240083317504 0.21526412684456825 2.3304038731566465 0.23674144339235967 2.334370845917945 0.2607690431393805
2.333798685834391 0.27 2.1854430073431304 0.27 2.184870847259575 0.26076904313938054
2.1874178917967892 0.24142231941101294"""


@case("regress/hole_outside.poly",
      "hole point outside the outline but inside its box (github drufat/triangle issue 2)",
      "ignores the hole: 11 triangles; Triangle crashes")
def hole_outside():
    poly = Poly(0)
    numbers = list(map(float, OUTSIDE.split()))
    poly.ring(list(zip(numbers[::2], numbers[1::2])), 1)
    poly.hole(2.194746831368343, 0.22198663923314035)
    return poly


@case("regress/near_collinear_repeat.poly",
      "nearly collinear segments that cross, one given twice (github qnzhou/trianglelite issue 1)",
      "ends; Triangle loops for ever", ("-p", "-pc"))
def near_collinear_repeat():
    poly = Poly(1, False)
    for x, y in ((6.899643741648033, 10.556739733611963), (6.8743893086546723, 10.577559204153792),
                 (6.8990280198173055, 10.557055643048765), (6.8994694525740767, 10.556817827203695),
                 (6.8996252478389311, 10.556759464230709), (6.899537086138448, 10.5566972172105)):
        poly.point(x, y)
    for a, b in ((0, 1), (2, 3), (3, 4), (4, 3)):
        poly.segment(a, b)
    return poly


@case("regress/overlap_path.poly",
      "path through the points of a slanted line in an order that goes to and fro, a crossing segment",
      "makes each elementary piece once; the time does not grow with the sum of the lengths", ("-pc",))
def overlap_path():
    poly = Poly(0)
    for i in range(31):
        poly.point(11 * i % 31, 2 * (11 * i % 31))
    for x, y in ((0, 60), (30, 0), (-1, 30), (32, 31)):
        poly.point(x, y)
    for i in range(30):
        poly.segment(i, i + 1, i % 3)
    poly.segment(33, 34, 9)
    return poly


@case("regress/touching_squares.poly",
      "two squares that share a corner given as two vertices (github wo80/Triangle issue 10)",
      "7 used vertices, 4 triangles; Triangle may crash")
def touching_squares():
    poly = Poly(0)
    for low, high in ((0, 10), (10, 15)):
        ids = [poly.new_point(x, y) for x, y in ((low, low), (high, low), (high, high), (low, high))]
        for a, b in zip(ids, ids[1:] + ids[:1]):
            poly.segment(a, b)
    return poly


@case("regress/within_rounding.poly", "segments within rounding of each other (github Stoeoef/spade issue 111)",
      "finds two crossings; keeps the flat triangles between them", ("-pc",))
def within_rounding():
    poly = Poly(0, False)
    for x, y in ((18.69314193725586, 19.589109420776367), (18.69314193725586, 20.40362548828125),
                 (19.507659912109375, 20.40362548828125), (17.878625869750977, 18.774595260620117),
                 (20.322175979614258, 21.218143463134766), (15.435077667236328, 16.331045150756836)):
        poly.new_point(x, y)
    for a, b in ((0, 1), (2, 3), (4, 5)):
        poly.segment(a, b)
    return poly


@case("regress/pentagon_repeat.poly",
      "pentagon whose last two vertices are the same point (github drufat/triangle issue 4)",
      "2 triangles, 4 subsegments; Triangle may crash")
def pentagon_repeat():
    poly = Poly(0)
    ids = [poly.new_point(x, y) for x, y in ((5, -5), (5, 0), (0, 0), (0, -2), (0, -2))]
    for a, b in zip(ids, ids[1:] + ids[:1]):
        poly.segment(a, b)
    return poly


def figure(points, segments):
    poly = Poly(1, False)
    for x, y in points:
        poly.new_point(x, y)
    for a, b in segments:
        poly.segment(a, b)
    return poly


def outline(points):
    return figure(points, [(k, (k + 1) % len(points)) for k in range(len(points))])


@case("regress/needles.poly", "five segments that meet at small angles, in a box",
      "-D: a conforming mesh of some 80 triangles; an earlier version left 88 circles that were not empty")
def needles():
    return figure(((-1.5, -1.5), (1.5, -1.5), (1.5, 1.5), (-1.5, 1.5), (0, 0), (1, 0), (0.83, 0.001), (0.47, 0.002),
                   (0.91, 0.012), (0.3, 0.1)),
                  ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (4, 6), (4, 7), (4, 8), (4, 9)))


@case("regress/ulps_apart.poly", "four segments a few units in the last place from one line, in a square",
      "-a0.0002: keeps the area bound; an earlier version left triangles beside the slivers twice as large")
def ulps_apart():
    return figure(((0, 0), (1, 0), (1, 1), (0, 1), (0.24, 0.370000000000003), (0.83, 0.665000000000003),
                   (0.33, 0.414999999999999), (0.38, 0.440000000000003), (0.21, 0.354999999999997),
                   (0.24, 0.370000000000002), (0.15, 0.32500000000000195), (0.22, 0.360000000000003)),
                  ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (6, 7), (8, 9), (10, 11)))


@case("regress/outline_repeat.poly",
      "outline whose last two vertices are the same point (github drufat/triangle issue 70)",
      "3 triangles; Triangle sometimes crashes")
def outline_repeat():
    return outline(((1383, 171), (1998, 0), (2378, 750), (660, 1483), (0, 551), (0, 551)))


@case("regress/arrow.poly", "quadrilateral with a reflex corner (github mrkkrj/TrianglePP, test 6.4)",
      "2 triangles; -pq ends, Triangle has been seen to loop")
def arrow():
    return figure(((305, 56), (283, 138), (292, 68), (211, 59)), ((0, 1), (1, 3), (3, 2), (2, 0)))


@case("regress/ulp_apart.poly",
      "two vertices one ulp apart that a segment joins to others (github kninnug/Constrainautor issue 15)",
      "-pc: ends; endless flips in the program of that report", ("-pc",))
def ulp_apart():
    return figure(((0, 0), (0.05626429153399996, 0), (0.024093852080076722, 4.80267923973791e-18),
                   (0.01379050745122589, 0.1463775332929564), (0.05177587092034522, 0.015468457826306506),
                   (0.024093852080076705, -5.204170427930421e-18)), ((0, 5), (5, 2)))


@case("regress/near_cocircular.poly", "polygon of nearly cocircular corners (github mapbox/earcut pull 205)",
      "7 triangles; endless flips in the program of that report")
def near_cocircular():
    return outline(((127.65906365022843, 9.336137742499535), (124.21725103117963, 30.888097161477972),
                    (91.35514946628345, 89.65621376119454), (40.10446780041529, 121.5550560957686),
                    (-110.83205604043928, 64.03323632184248), (-127.20394987965459, -14.253249980770189),
                    (61.074962259031416, -112.48932831632469), (127.37846573978545, -12.598669206638515),
                    (127.77010311801033, -7.668164657400608)))


QUADRILATERAL = ((0, 0), (1, 0), (1, 1), (0.1, 1.3))


def far_places(points, holes, region):
    poly = outline(points)
    poly.new_point(0.51 * points[2][0] / 0.93, 0.47 * points[2][1] / 1.11)
    for x, y in holes:
        poly.hole(x, y)
    poly.region(*region, 5)
    return poly


@case("regress/far_hole.poly", "quadrilateral with a hole point at (1e300, 1e300)",
      "ignores the hole, since places beyond the range of exact arithmetic are outside; an earlier version removed "
      "all triangles")
def far_hole():
    poly = outline(QUADRILATERAL)
    poly.hole(1e300, 1e300)
    return poly


@case("regress/far_places.poly", "holes and a region near the largest double",
      "ignores them; in an earlier version exact arithmetic exceeded its arrays")
def far_places_of_one():
    return far_places(((0.1, 0.23), (1.07, 0.31), (0.93, 1.11), (0.07, 0.97)),
                      ((1e300, -1e308), (1.3e308, 1.1e307)), (1e300, 1.1e307))


@case("regress/far_places_tiny.poly", "the same of size 1e-301, with holes and a region at 1", "ignores them")
def far_places_tiny():
    return far_places(((1e-302, 2.3e-302), (1.07e-301, 3.1e-302), (9.3e-302, 1.11e-301), (7e-303, 9.7e-302)),
                      ((1.234567, 2.345678), (7.1, -3.3)), (1.234567, -3.3))


@case("regress/far_region.poly", "nasty/tiny_scale.poly, its hole beyond the least double, with a region at 10",
      "ignores the region")
def far_region():
    poly = tiny_scale()
    poly.holes[:] = [(5e-301, 0)]
    poly.region(10.739473, 0.767105, 1, 23)
    return poly


@case("regress/long_gap.poly", "two walls side by side, 2,750 times as long as the gap between them, in a box",
      "-q32 in blocks: about as many triangles as in one call; an earlier version made 2.3 times as many, with cuts "
      "along the gap")
def long_gap():
    return figure(((0, 0), (4, 0), (4, 13), (0, 13), (2, 1), (2, 12), (2.004, 1), (2.004, 12)),
                  ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (6, 7)))


@case("regress/flat_hull.poly", "slanted square, ten segments on each side",
      "-pcq20: flat triangles between segments and hull remain (docs/limits.md)")
def flat_hull():
    c, s = 0.96, 0.28
    square = ([(k, 0) for k in range(10)] + [(10, k) for k in range(10)] + [(10 - k, 10) for k in range(10)] +
              [(0, 10 - k) for k in range(10)])
    return outline([(c * x - s * y, s * x + c * y) for x, y in square])


@case("regress/ring_levels.poly", "star of 60 narrow spikes of random length in a box",
      "-q22D in cells of 60 and 250 triangles: up to twice as many triangles as in one call (docs/limits.md)")
def ring_levels():
    numbers = random.Random(6)
    star = []
    for k in range(120):
        r, angle = 8 if k % 2 else 50 + 50 * numbers.random(), 2 * math.pi * k / 120
        star.append((round(r * math.cos(angle), 4), round(r * math.sin(angle), 4)))
    box = [(-150, -150), (150, -150), (150, 150), (-150, 150)]
    sides = [(k, (k + 1) % 120) for k in range(120)]
    return figure(star + box, sides + [(120 + k, 120 + (k + 1) % 4) for k in range(4)])


# --- defects of earlier versions, found elsewhere: files are read here for the tables and not written;
# tests/cli/regress.sh explains them

FOUND = [
    Case("regress/doubled_lines.poly", None, "two lines that cross, each given two or three times, 10^-12 apart",
         "-D: fewer than 24 triangles; an earlier version split for ever across the doubled lines", ()),
    Case("regress/lost_segment.poly", None,
         "segments that nearly overlap and cross a third; coordinates have one decimal",
         "keeps the course of each segment; an earlier version led one through a distant vertex", ()),
    Case("regress/lost_overlay.poly", None,
         "three segments of an overlay, one of them nearly through the ends of another (libgeos/geos issue 1034)",
         "keeps all segments; an earlier version lost one", ()),
    Case("regress/lost_ladder.poly", None, "two overlaid strips whose sides nearly coincide (libgeos/geos issue 1046)",
         "keeps all segments; an earlier version lost one", ()),
    Case("regress/lost_overlay_vertex.poly", None,
         "the same strips and two segments across them (libgeos/geos issue 1046)",
         "keeps all vertices; in an earlier version one was no corner", ()),
    Case("regress/lost_vertex.poly", None, "rotated grid, random segments along and across its lines",
         "-q34D: keeps all vertices; an earlier version lost one", ()),
    Case("regress/overlap_rings.poly", None,
         "two triangles with a common side up to one ulp, from overlap_water.poly (OpenStreetMap contributors)",
         "-q20: no overlapping triangles; refinement in an earlier version made some", ()),
    Case("regress/overlap_water.poly", None, "lakes with common shores up to one ulp (OpenStreetMap contributors)",
         "-q20: no overlapping triangles; refinement in an earlier version made some", ()),
    Case("regress/overlap_ulp.poly", None, "rotated grid, random segments along its lines",
         "-a0.0915136812: no overlapping triangles; in an earlier version the boundary crossed itself by one ulp", ()),
    Case("regress/overlap_spikes.poly", None, "star of spikes far from the origin",
         "-q31: no overlapping triangles; refinement in an earlier version made some", ()),
    Case("regress/same_place.poly", None, "rotated grid, random segments, two attributes",
         "-q32D: all vertices differ; an earlier version put two vertices at one place", ()),
    Case("regress/marker_bend.poly", None, "a chain of segments on nearly one line (libgeos/geos issue 275)",
         "passes the markers on to bent segments", ()),
    Case("regress/marker_precincts.poly", None, "borders of precincts that nearly coincide",
         "passes the markers on to bent segments", ()),
    Case("regress/slit.poly", None, "a wall between two rooms that ends one ulp below the roof",
         "the hole in one room does not empty the other: a segment that is already an edge also runs through the "
         "near vertex", ()),
    Case("regress/hole_on_segment.poly", None, "a hole point on a segment",
         "-pcq24a0.26: removes no triangles; rounded split points may move the hole point inside by an ulp", ()),
    Case("regress/hole_at_vertex.poly", None, "a hole point at a vertex that is one ulp off a side of the outline",
         "removes no triangles; an earlier version removed all, since the side runs through the vertex", ()),
    Case("regress/hole_in_chain.poly", None,
         "rotated grid, a hole point at a vertex that is one ulp off a long segment",
         "removes no triangles; an earlier version emptied a room, and the checker reported it", ()),
    Case("regress/flat_on_both_sides.poly", None,
         "segments one ulp apart, one of them with vertices in its circle on both sides",
         "-pq33D: the checker counts as many subsegments as the mesher", ()),
    Case("regress/endless_q36_small.poly", None, "five points, two of them close together",
         "-q36: at most some thousand triangles; an earlier version used all memory", ()),
    Case("regress/endless_q36_fan.poly", None,
         "points and segments that become denser towards one place, with two attributes",
         "-q36: at most some thousand triangles", ()),
    Case("regress/endless_q35_graded.poly", None, "points that become denser towards one place",
         "-q38: at most some thousand triangles", ()),
    Case("regress/slow_q41D_2369.poly", None, "rings of size 1e-205 and smaller, with two attributes",
         "-q38AD: at most 200,000 triangles", ()),
    Case("regress/graded_1899.poly", None, "graded points with two attributes",
         "-cq25D in cells of 60 triangles: the work does not double with every phase", ()),
    Case("regress/ranaway30.poly", None, "shore of a lake (OpenStreetMap contributors)",
         "-q30: at most 40,000 triangles; in an earlier version vertices ran away at one place", ()),
    Case("regress/ranaway_fan.poly", None, "fan of segments that are bent far from its centre",
         "-cq33: at most 10,000 triangles; an earlier version made 229,779", ()),
    Case("regress/ranaway_zigzag.poly", None, "zigzag with small angles",
         "-cq34: at most 64 times the 328 triangles for 25 degrees", ()),
    Case("regress/credit_grid.poly", None, "rotated grid of few points",
         "-cq34: at most 1,000 triangles (43 at 28 degrees); an earlier version made 5,356", ()),
    Case("regress/ulp_beside.poly", None, "rotated grid, two of its vertices one ulp off the convex hull",
         "-cq34 in cells of 60 triangles: at most 4,000 triangles; an earlier version made 4,958 (torture, seed "
         "13101813)", ()),
    Case("regress/credit_wedge.poly", None, "two segments that end one ulp apart, in a rotated grid of few points",
         "-cq34: at most 500 triangles (36 at 28 degrees); an earlier version made 5,693", ()),
    Case("regress/slits_by_seams.poly", None, "comb of eight teeth with slits 0.01 wide",
         "-cq30 to -cq34 in cells of 250 triangles: about as many triangles as in one call; earlier versions made "
         "1.3 and 1.8 times as many", ()),
    Case("regress/star_by_seams.poly", None, "star of twelve spikes around a small centre",
         "-cq30 to -cq33 with -D in cells of 60 triangles: up to twice as many triangles as in one call "
         "(docs/limits.md)", ()),
    Case("regress/credit_star.poly", None, "star of 14 spikes that meet at a centre",
         "-q33: at least as many triangles as with -q28; an earlier version made 5,400 instead of 8,706, and 2,228 "
         "of them were bad", ()),
    Case("regress/walls_stay.poly", None, "two parabolas that nearly touch in a box",
         "-q30Y: at most 60 triangles below the bound, all beside the box; in an earlier version a third of the mesh",
         ()),
    Case("regress/layered_world.poly", None, "layers of ground around a round body",
         "any bound: the number of triangles is in proportion to the features", ()),
    Case("regress/tangle.poly", None, "closed chain that crosses itself",
         "any bound: the number of triangles is in proportion to the features", ()),
    Case("regress/thin_comb.poly", None, "comb of long bars that nearly touch, on an equally thin base",
         "-q33: at most 10,000 triangles; each bar is a narrow space that no edge of the triangulation bridges", ()),
    Case("regress/denormal_coordinate.poly", None,
         "segments from a point with the least positive double as coordinate",
         "-pc: mesher and checker treat that coordinate as 0", ()),
    Case("regress/below_dxf.poly", None, "outline from a drawing, almost a rectangle",
         "-q20: no angle below the bound; an earlier version left two triangles without need", ()),
    Case("regress/drifted_chain.poly", None,
         "a figure 2000 times as high as wide, with segments some ulps apart",
         "-q33: only small input angles are below the bound; an earlier version left 145 triangles beside a "
         "subsegment that could not be split", ()),
    Case("regress/spike_levels.poly", None, "spike 8e-9 wide at its mouth, on a house in a triangle",
         "-q25D: at most 1,000 triangles; an earlier version cut the sides into parts too short to improve the "
         "angles beside them", ()),
    Case("regress/flat_hole.poly", None, "a hole that is a sliver: its short side lies nearly along the long ones",
         "-q33: no angle below the bound beside the hole; an earlier version treated the triangle at the short side "
         "as part of the sliver",
         ()),
    Case("regress/bundle_levels.poly", None,
         "segments side by side; their ends are closer than the segments themselves",
         "-a0.00065D: some thousand triangles; in an earlier version each new point in the bundle requested more "
         "points, without end", ()),
    Case("regress/carved_fan.poly", None,
         "a fan that crosses a segment within rounding; faces between them are carved (`--holes auto`)",
         "the checker reports no fault of a marker", ()),
    Case("regress/chord_within.poly", None, "a high, narrow wall and segments that cross it",
         "-q30D: all circles are empty; in an earlier version the boundary moved inwards until it had no place to "
         "split", ()),
    Case("regress/high_kite.poly", None, "a polygon 200 wide and 8e6 high with corners nearly on its lines",
         "-q37a312819811.76D, then -rq20D: all circles are empty; in an earlier version the boundary moved inwards "
         "until it had no place to split, by units of the larger coordinate (torture, seed 25014125)", ()),
    Case("regress/bent_strip.poly", None,
         "a strip 1 wide and 11,000 high with corners about five units inside its sides",
         "-D, then -rq20D: all circles are empty; an earlier version left 154, at vertices that were farther inside "
         "than split points may be", ()),
    Case("regress/bent_valley.poly", None, "a polygon 4,100 wide and 1,000 high with two sides side by side",
         "-D: all circles are empty; an earlier version left five", ()),
    Case("regress/shifted_square.poly", None, "a square and a copy of it, shifted by 10^-6",
         "-cq25D in cells of 60 triangles, with a size test: 2,391 triangles; an earlier version made 8,788, "
         "because of sizes beside edges that had run away", ()),
    Case("regress/near_path.poly", None, "a path to and fro through points that lie on one line up to rounding",
         "-pc: one chain in n steps for n vertices, not n * n steps", ()),
    Case("regress/side_ulp_off.poly", None, "a segment along 200 vertices whose end is one ulp off their line",
         "-pc: one chain in n steps for n vertices, not n * n steps", ()),
    Case("regress/wide_fans.poly", None, "segments nearly on one line, two decimals, in a figure with long walls",
         "-cq31 in blocks: the number of steps is proportional to the number of triangles; in an earlier version "
         "each triangle of a fan at a fence searched all others",
         ()),
    Case("regress/ulp_lattice.poly", None, "three segments that cross within a few units in the last place",
         "keeps all segments; in an earlier version they led each other to and fro, and one was lost", ()),
    Case("regress/to_and_fro.poly", None,
         "segments between seven points, three of which differ only in the last place",
         "keeps all segments; in an earlier version two led each other to and fro, and one was lost", ()),
    Case("regress/no_room_to_cross.poly", None, "segments nearly on one line in an equally thin hull",
         "keeps all segments; in an earlier version a crossing found no place in the hull, and one was lost", ()),
    Case("regress/hidden_gap.poly", None, "two walls side by side; three vertices hide the space between them",
         "-q20: some hundred triangles; an earlier version filled the space without end", ()),
    Case("regress/hatching.poly", None,
         "two hatchings of three lines at a slope of 1/1000 that nearly cross at their ends",
         "-cq30: some ten thousand triangles; an earlier version made 457,770, since it ignored the narrow ends of "
         "wedges", ()),
    Case("regress/cut_wedge.poly", None, "a wedge of slope 1/25,000 whose tip is cut off at a width of 1e-12",
         "-q30: a thousand triangles; an earlier version made 1.9 million, since it "
         "ignored the narrow ends of wedges", ()),
    Case("regress/near_wall.poly", None, "a ground plan with a corner 115 units in the last place from a wall",
         "-q20D: keeps the bound, and all circles are empty; an earlier version left 13 triangles at the corner", ()),
    Case("regress/subnormal.poly", None, "a square of one subnormal number, with its diagonals",
         "rejected; in an earlier version its vertices coincided", ()),
    Case("regress/nearly_straight.poly", None, "a polygon with one side in five pieces, 1e-5 off their common line",
         "-cq20: some ten triangles; an earlier version made 3.3 million, since it "
         "ignored the narrow ends of wedges", ()),
]


# --- the coast

COAST = [
    Case("coast/norway_sea.poly", None,
         "sea around Norway: fjords, islands as holes; metres; markers coast 1, open sea 2",
         "a real domain with several thousand boundary segments", ("-p",)),
    Case("coast/islands.poly", None, "sea around the British Isles; metres; markers coast 1, open sea 2",
         "a real domain that is small enough for every test", ("-p",)),
    Case("coast/borders.poly", None,
         "the countries of Africa; borders are internal segments, given once; region attribute = ISO 3166-1 numeric "
         "code, area bound = area / 40; markers coast 1, border 2",
         "-pqaA: each triangle has the code of its country", ("-p",)),
]


# --- tables and main

EXPECTED_HEAD = """\
# The results of a correct program for the inputs. One run per line:
#   file  switches  vertices  triangles  used  area
# vertices   in the output .node file without -j: those of the input and one per crossing of segments
# triangles  fact of the input: Euler's formula for the faces that remain
# used       vertices that are corners of triangles
# area       sum of the areas of the triangles, the exact value rounded to a double
# -1 everywhere: the input is rejected with an error (exit 1, no output).
# Found by tools/make_data.py in exact arithmetic, without a mesh generator.
"""

README_HEAD = """\
# Inputs

Small inputs made for this project: shapes, engineering sections, real coasts, and hard cases that a mesh generator must
survive.

- `tools/make_data.py` writes all files except `coast/`, `yardstick.txt`, and the inputs with no number of triangles in
  the table below. Every run writes the same bytes (Python 3.9, no packages).
- `tools/make_coast.py` writes `coast/` from Natural Earth (`npm pack world-atlas@2.0.2`).
- `expected.txt` lists the numbers that a correct program gets for each run of each input. The tests read it.
- `yardstick.txt` lists the sizes of the quality meshes that Triangle 1.6 makes of them (`tools/make_yardstick.py`).
- `tools/pslg_facts.py` computes the numbers of `expected.txt` by exact arithmetic on the planar subdivision, without
  triangulating.

Origin and licence: `coast/` is Natural Earth, public domain. The coordinates in `regress/` come from public bug
reports, which the table names, or from random numbers. A few lake shores in `regress/` are (c) OpenStreetMap
contributors, ODbL. All other inputs are computed from formulas in this repository and have the licence of the project,
MIT. Random points come from Python's generator with fixed seeds.

Columns:

- vertices, segments, holes, regions: their numbers in the file
- triangles: their number with the first run of `expected.txt`; "error" means that the file is rejected
- angle: the smallest angle in degrees between two segments with part of the domain in between
- valid: no duplicate vertices, no crossings, no vertex on another segment, no repeated or invalid segment
- what it is: the contents of the file
- expected behaviour: the result of a correct program. "Triangle" is Triangle 1.6; "an earlier version" is an earlier
  version of this project, so the input guards against that defect
"""


def expected_line(name, run, facts):
    fields = (facts.vertices, facts.triangles, facts.used, number(float(facts.area))) if facts else (-1,) * 4
    return " ".join(map(str, (name, run, *fields)))


def table_row(entry, pslg, facts):
    if pslg is None:
        cells = ["", "", "", "", "error", "", ""]
    else:
        cells = [len(pslg.points), len(pslg.segments), len(pslg.holes), len(pslg.regions), "", "", ""]
    if facts is not None:
        angle = "%.4g" % facts.smallest_angle if pslg.segments and facts.smallest_angle < 180 else ""
        cells[4:] = [facts.triangles, angle, "yes" if facts.valid else "no"]
    return "| " + " | ".join(map(str, [entry.name, *cells, entry.what, entry.right])) + " |"


def examine(folder, entry):
    """Facts of each run of an input: (pslg, facts, lines). pslg and facts are None if the input is refused, facts is
    None if there is no run."""
    pslg, first, lines = None, None, []
    if not entry.runs:
        pslg = pslg_facts.read(os.path.join(folder, entry.name))
    for run in entry.runs:
        try:
            facts = None
            if run not in ("-r", "-pA"):
                pslg = pslg_facts.read(os.path.join(folder, entry.name))
                facts = pslg_facts.Facts(pslg, run)
        except pslg_facts.InputError:
            pass
        assert (facts is None) == entry.right.startswith("error"), (entry.name, run)
        first = first or facts
        lines.append(expected_line(entry.name, run, facts))
    return pslg, first, lines


def write(path, content):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as stream:
        stream.write(content if isinstance(content, bytes) else content.encode("ascii"))


def main(folder):
    for entry in CASES:
        content = entry.build()
        if isinstance(content, Poly):
            content = content.text(entry.what, entry.name.endswith(".poly"))
        write(os.path.join(folder, entry.name), content)
    for name, content in EXTRA_FILES.items():
        write(os.path.join(folder, name), content)
    write(os.path.join(folder, ".gitattributes"), "# Line ends are part of the inputs.\n* -text\n")
    table = ["| file | vertices | segments | holes | regions | triangles | angle | valid | what it is | "
             "expected behaviour |", "|---|---|---|---|---|---|---|---|---|---|"]
    expected = []
    for entry in CASES + [c for c in FOUND + COAST if os.path.exists(os.path.join(folder, c.name))]:
        pslg, facts, lines = examine(folder, entry)
        table.append(table_row(entry, pslg, facts))
        expected += lines
    write(os.path.join(folder, "expected.txt"), EXPECTED_HEAD + "\n".join(expected) + "\n")
    write(os.path.join(folder, "README.md"), README_HEAD + "\n" + "\n".join(table) + "\n")


if __name__ == "__main__":
    here = os.path.dirname(os.path.abspath(__file__))
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("folder", nargs="?", default=os.path.join(here, "..", "data"))
    main(words.parse_args().folder)
