"""Generated planar straight line graphs, identical in every run: families of inputs, each member with its own seed.

Only random.Random.random() is used, which returns the same numbers in every version of Python. Vertices count from 0
here; `base` is the first number in the input file. The first vertex attribute, if any, is the affine function `field`
of the position, so that linear interpolation must reproduce it. The second is random.
"""
import math
import random

from geometry import meet, on_segment


def table(header, rows, base):
    """Numbered records."""
    lines = [header] + [[k + base, *row] for k, row in enumerate(rows)]
    return "".join(" ".join(map(repr, line)) + "\n" for line in lines)


class Case:
    """One input. `traits` lists which results are not determined: see families below."""

    def __init__(self, name, base, traits):
        self.name, self.base, self.traits = name, base, traits
        self.points, self.markers, self.attributes = [], [], []
        self.segments, self.segment_markers = [], []
        self.holes, self.regions = [], []

    def point(self, x, y, marker=0):
        self.points.append((float(x), float(y)))
        self.markers.append(marker)
        return len(self.points) - 1

    def segment(self, a, b, marker=0):
        self.segments.append((a, b))
        self.segment_markers.append(marker)

    def ring(self, corners, marker=0, vertex_marker=0):
        ids = [self.point(x, y, vertex_marker) for x, y in corners]
        for k, a in enumerate(ids):
            self.segment(a, ids[(k + 1) % len(ids)], marker)
        return ids

    def files(self):
        """Suffix -> text of the input files."""
        if "points" in self.traits:
            return {"node": self.vertices()}
        return {"poly": self.vertices() + self.figure()}

    def word(self):
        """The input file for the command line."""
        return "case." + "".join(self.files())

    def judge(self, _):
        """Arguments of trianglecheck: the file to compare with."""
        return ["--poly", self.word()]

    def vertices(self):
        columns = self.attributes or [()] * len(self.points)
        rows = [[*p, *a, m] for p, a, m in zip(self.points, columns, self.markers)]
        return table([len(rows), 2, len(columns[0]), 1], rows, self.base)

    def figure(self):
        """The rest of a .poly file, after the vertices."""
        rows = [[a + self.base, b + self.base, m] for (a, b), m in zip(self.segments, self.segment_markers)]
        return (table([len(rows), 1], rows, self.base) + table([len(self.holes)], self.holes, self.base)
                + table([len(self.regions)], self.regions, self.base))

    def as_dict(self):
        """The input for the oracle."""
        return {"points": self.points, "markers": self.markers, "attributes": self.attributes,
                "segments": self.segments, "segment_markers": self.segment_markers, "holes": self.holes,
                "regions": self.regions}


def field(x, y):
    return 0.75 * x - 0.5 * y + 3


def whole(rng, n):
    """A random integer of 0 .. n - 1."""
    return int(rng.random() * n)


def marker(rng):
    """A random marker: often 0, sometimes negative."""
    return (0, 0, 2, 3, 5, -4)[whole(rng, 6)]


# --- pieces

def scatter(case, rng, n, x0=0.0, y0=0.0, size=1.0):
    for _ in range(n):
        case.point(x0 + size * rng.random(), y0 + size * rng.random(), marker(rng))


def star(rng, n, x, y, low, high):
    """Corners of a polygon that is star-shaped around (x, y), counter-clockwise."""
    corners = []
    for k in range(n):
        angle = 2 * math.pi * (k + 0.8 * rng.random()) / n
        radius = low + (high - low) * rng.random()
        corners.append((round(x + radius * math.cos(angle), 9), round(y + radius * math.sin(angle), 9)))
    return corners


def disjoint_segments(case, rng, n):
    """Up to n segments between existing vertices. They meet only at common ends and pass through no vertex."""
    for _ in range(4 * n):
        a, b = whole(rng, len(case.points)), whole(rng, len(case.points))
        if a == b or len(case.segments) >= n:
            continue
        p, q = case.points[a], case.points[b]
        foreign = [k for k in range(len(case.points)) if k not in (a, b)]
        if any(on_segment(case.points[k], p, q) for k in foreign) or p == q:
            continue
        others = [(c, d) for c, d in case.segments if not {a, b} & {c, d}]
        same = any({a, b} == {c, d} for c, d in case.segments)
        if not same and not any(meet(p, q, case.points[c], case.points[d]) for c, d in others):
            case.segment(a, b, marker(rng))


def square(case, x0, y0, x1, y1, mark=0):
    return case.ring([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], mark)


# --- families. Traits: "points": no segments; "crossing": vertices are made at crossings of segments; "duplicates": the
# copy that survives is not determined; "sharp": small angles, at which Triangle's refinement may not end; "needles":
# triangles of zero area up to rounding.

FAMILIES = []


def family(count, *traits):
    def register(build):
        FAMILIES.append((build.__name__, build, count, frozenset(traits)))
        return build
    return register


@family(16, "points")
def random_points(case, rng):
    scatter(case, rng, 3 + whole(rng, 50), 0, 0, 10)


@family(10, "points")
def grid_points(case, rng):
    columns, rows = 2 + whole(rng, 5), 2 + whole(rng, 5)
    for k in range(columns * rows):
        if rng.random() < 0.9 or k < 3:
            case.point(k % columns, k // columns, marker(rng))
    case.point(columns, rows)


@family(6, "points")
def circle_points(case, rng):
    corners = [(5, 0), (4, 3), (3, 4), (0, 5), (-3, 4), (-4, 3), (-5, 0), (-4, -3), (-3, -4), (0, -5), (3, -4), (4, -3)]
    for x, y in corners[:4 + whole(rng, 9)]:
        case.point(x, y, marker(rng))
    if rng.random() < 0.5:
        case.point(0.125, 0.25)


@family(8, "points", "duplicates")
def repeated_points(case, rng):
    scatter(case, rng, 8 + whole(rng, 25))
    for _ in range(5):
        case.point(*case.points[whole(rng, len(case.points))])


@family(5, "points")
def points_on_a_line(case, rng):
    for k in range(3 + whole(rng, 8)):
        case.point(k, 2 * k)
    if rng.random() < 0.4:
        case.point(1, 7)


@family(6, "points", "needles")
def rounded_line(case, rng):
    """Points that are off the line by at most an ulp."""
    for _ in range(6 + whole(rng, 20)):
        x = rng.random()
        case.point(x, 0.3 * x + 0.1)


@family(14)
def loose_segments(case, rng):
    """Dangling segments among points, without an outline."""
    scatter(case, rng, 6 + whole(rng, 30), 0, 0, 8)
    disjoint_segments(case, rng, 4 + whole(rng, 12))


@family(16)
def polygon(case, rng):
    case.ring(star(rng, 5 + whole(rng, 14), 0, 0, 1, 3), marker(rng))
    scatter(case, rng, whole(rng, 8), -0.5, -0.5, 1)


@family(14)
def nested(case, rng):
    """Nested rings; every second face is a hole, the others are regions."""
    depth = 2 + whole(rng, 3)
    for level in range(depth):
        outer = 10.0 / 2 ** level
        case.ring(star(rng, 7 + whole(rng, 6), 1, 2, 0.75 * outer, 0.95 * outer), marker(rng), marker(rng))
        at = (1 + 0.55 * outer, 2.0) if level < depth - 1 else (1.01, 2.02)
        if level % 2:
            case.holes.append(at)
        else:
            case.regions.append((*at, level + 1.5, 8 * 0.4 ** level))


@family(16)
def rooms(case, rng):
    """A house with displaced corners. Each room has its own attribute; some rooms have an area bound of their own."""
    columns, rows = 1 + whole(rng, 3), 1 + whole(rng, 3)
    corner = {}
    for i in range(columns + 1):
        for j in range(rows + 1):
            corner[i, j] = case.point(4 * i + rng.random(), 4 * j + rng.random(), marker(rng))
    for i, j in corner:
        for other in ((i + 1, j), (i, j + 1)):
            if other in corner:
                case.segment(corner[i, j], corner[other], marker(rng))
    for i in range(columns):
        for j in range(rows):
            if rng.random() < 0.75:
                case.regions.append((4 * i + 2.5, 4 * j + 2.5, whole(rng, 9) - 2, (-1, 0, 2.5, 0.7)[whole(rng, 4)]))


@family(12)
def house_with_doors(case, rng):
    """Regions that spread into each other through gaps: the last region point wins."""
    square(case, 0, 0, 12, 6, 3)
    for x in (4, 8):
        a, b = case.point(x, 0.5 + rng.random()), case.point(x + 0.25, 5 + 0.5 * rng.random())
        case.segment(a, b, marker(rng))
    for k in range(3):
        case.regions.append((4 * k + 2 + 0.3 * rng.random(), 3 + rng.random(), k + 1, 0.5 + rng.random()))
    scatter(case, rng, whole(rng, 6), 5, 2, 2)


@family(12)
def on_lattice(case, rng):
    """Many vertices exactly on segments, many empty circles through more than three points."""
    square(case, 0, 0, 6, 4, marker(rng))
    for _ in range(4 + whole(rng, 14)):
        x, y = whole(rng, 7), whole(rng, 5)
        if (x, y) not in case.points:
            case.point(x, y, marker(rng))
    walls = [k for k in range(4, len(case.points)) if case.points[k][0] == 3.0]
    for a, b in zip(walls, walls[1:]):
        case.segment(a, b, marker(rng))


@family(12)
def overlaps(case, rng):
    """Segments that contain, repeat and overlap each other on three lines, with conflicting markers."""
    square(case, 0, 0, 8, 8, marker(rng))
    at = {}
    for y in (2, 5):
        for x in range(1, 8):
            at[x, y] = case.point(x, y)
    for _ in range(7):
        y = (2, 5)[whole(rng, 2)]
        a, b = 1 + whole(rng, 7), 1 + whole(rng, 7)
        if a != b:
            case.segment(at[a, y], at[b, y], marker(rng))
    case.segment(case.point(2, 0), case.point(6, 0), marker(rng))


@family(14, "crossing")
def crossings(case, rng):
    case.ring([(-1, -1), (11, -1.5), (11.5, 11), (-1.25, 11.25)], marker(rng))
    for _ in range(2 + whole(rng, 6)):
        a, b = [case.point(10 * rng.random(), 10 * rng.random(), marker(rng)) for _ in range(2)]
        case.segment(a, b, marker(rng))


@family(6, "crossing")
def whole_crossings(case, rng):
    """All crossings are integer points, and no three segments meet in one point."""
    square(case, 0, 0, 12, 12, 7)
    for k in range(2 + whole(rng, 3)):
        case.segment(case.point(2 * k + 2, 1), case.point(2 * k + 2, 11), marker(rng))
    for k in range(1 + whole(rng, 3)):
        case.segment(case.point(1, 3 * k + 2), case.point(11, 3 * k + 2), marker(rng))


@family(10, "sharp")
def spikes(case, rng):
    """Rays from one vertex at small angles, and an outline with a narrow cape."""
    case.ring([(0, 0), (10, 0), (10, 5), (30, 5 + 0.02 * rng.random()), (10, 5.25), (10, 10), (0, 10)], 4)
    centre = case.point(2, 5)
    for k in range(3 + whole(rng, 4)):
        case.segment(centre, case.point(8 - rng.random(), 3 + 0.4 * k + 0.1 * rng.random()), marker(rng))


@family(6, "sharp")
def out_and_back(case, rng):
    """The outline runs out and back over the same vertices."""
    ids = square(case, 0, 0, 4, 4, marker(rng))
    tip, amid = case.point(7, 2 + rng.random()), case.point(5.5, 1.5)
    for a, b in ((ids[1], amid), (amid, tip), (tip, amid), (amid, ids[1])):
        case.segment(a, b, marker(rng))
    scatter(case, rng, 5, 1, 1, 2)


@family(10, "duplicates")
def repeated_corners(case, rng):
    """Each polygon has its own copies of shared corners."""
    for k in range(2 + whole(rng, 3)):
        square(case, 5 * k, 5 * k, 5 * k + 5, 5 * k + 5, marker(rng))
    corners = star(rng, 6, 2.5, 2.5, 0.5, 2)
    ids = case.ring(corners + corners[-1:], marker(rng))
    case.point(*case.points[ids[0]])


@family(8)
def islands(case, rng):
    """Several components; hole and region points that lie in none of them."""
    for k in range(2 + whole(rng, 3)):
        case.ring(star(rng, 4 + whole(rng, 6), 8 * k, 3 * (k % 2), 1.5, 2.9), marker(rng))
    case.ring(star(rng, 5, 0, 0, 0.3, 0.8))
    case.holes += [(0.01, 0.02), (4.0, 9.0)]
    case.regions += [(8.1, 3.1, 4, 0.3), (100, 100, 9, 0.1)]


@family(8)
def touching_holes(case, rng):
    """Holes that share a corner with each other and with the outline."""
    outline = square(case, 0, 0, 10, 10, marker(rng))
    amid = case.point(5, 5)
    for corners, at in (([(1 + rng.random(), 6), (3, 8 + rng.random())], (3, 6.5)),
                        ([(9 - rng.random(), 6), (8, 3 + rng.random())], (7.3, 4.75))):
        a, b = [case.point(*c) for c in corners]
        for p, q in ((amid, a), (a, b), (b, amid)):
            case.segment(p, q, marker(rng))
        case.holes.append(at)
    a, b = case.point(3, 1), case.point(1, 3)
    for p, q in ((outline[0], a), (a, b), (b, outline[0])):
        case.segment(p, q, 6)
    case.holes.append((1.25, 1.375))


@family(6)
def far_away(case, rng):
    """A small figure at large coordinates."""
    x, y = 1e6 + 10 * rng.random(), -3e6 + 10 * rng.random()
    case.ring([(x + 4 * u, y + 4 * v) for u, v in star(rng, 9, 0, 0, 1, 2)], 2)
    case.ring(star(rng, 4, x, y, 1, 2), marker(rng))
    case.regions += [(x, y, 5, 1.5)]


@family(6)
def bad_segments(case, rng):
    """Segments with missing ends or equal ends are skipped with a warning."""
    ids = case.ring(star(rng, 6 + whole(rng, 5), 0, 0, 2, 3), 3)
    for a, b in ((ids[0], 77), (-9, ids[1]), (ids[2], ids[2])):
        case.segment(a, b, 8)
    scatter(case, rng, 4, -0.5, -0.5, 1)


@family(5)
def nothing_left(case, rng):
    """Open outlines, and holes that remove everything."""
    ids = square(case, 0, 0, 3 + whole(rng, 3), 2)
    scatter(case, rng, whole(rng, 5), 0.5, 0.5, 1)
    if rng.random() < 0.5:
        case.segments.pop()
        case.segment_markers.pop()
    else:
        case.holes.append((1.01, 0.43))
    assert len(ids) == 4


def finish(case, rng, n_attributes):
    for x, y in case.points:
        case.attributes.append([field(x, y), rng.random()][:n_attributes])
    if n_attributes == 0:
        case.attributes = []
    if "duplicates" in case.traits:  # equal points get equal values, so the surviving copy does not matter
        first = {}
        for k, p in enumerate(case.points):
            j = first.setdefault(p, k)
            if case.attributes:
                case.attributes[k] = case.attributes[j]
            case.markers[k] = case.markers[j]


def all_cases():
    cases = []
    for name, build, count, traits in FAMILIES:
        for k in range(count):
            rng = random.Random(1000 * len(cases) + 7)
            case = Case(f"{name}_{k}", len(cases) % 2, traits)
            build(case, rng)
            finish(case, rng, k % 3)
            cases.append(case)
    return cases
