"""Exact facts about a planar straight line graph, found without triangulating it.

Reads .node and .poly files (decimal numbers, with the lexical rules of the format). Computes the planar subdivision
that the segments span (vertices, crossings, faces), in rational arithmetic whenever floating point is uncertain.

The number of triangles follows from it. Consider a face whose boundary has h half-edges in b connected pieces (an
isolated vertex is a piece without half-edges). By Euler's formula, any triangulation that adds no vertex divides it
into h + 2 b - 4 triangles. So the counts in data/expected.txt depend on no mesh generator.

Uses only the standard library.
"""
from fractions import Fraction
from functools import cmp_to_key
import math
import re


class InputError(Exception):
    """The file is invalid, and a correct program refuses it."""


# --- reading

NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")


def records(data):
    """Yields the fields (strings that start like a number) of each line that has any."""
    for line in data.split("\n"):
        line = line.split("#", 1)[0]
        fields = []
        at = 0
        while True:
            start = re.compile(r"[0-9+\-.]").search(line, at)
            if not start:
                break
            end = start.start()
            while end < len(line) and line[end] not in " \t\r":
                end += 1
            fields.append(line[start.start():end])
            at = end
        if fields:
            yield fields


def real(text):
    match = NUMBER.match(text)
    value = float(match.group()) if match else 0.0
    if not math.isfinite(value):
        raise InputError("not finite: " + text)
    return value


def integer(text):
    match = re.match(r"[+-]?\d+", text)
    return int(match.group()) if match else 0


class Pslg:
    def __init__(self):
        self.base = 1
        self.points = []
        self.segments = []
        self.holes = []
        self.regions = []


def read(path):
    with open(path, "rb") as stream:
        lines = records(stream.read().decode("latin-1"))

    def line(least, what):
        fields = next(lines, None)
        if fields is None:
            raise InputError("file ends before " + what)
        if len(fields) < least:
            raise InputError(what + " is incomplete")
        return fields

    pslg = Pslg()
    header = line(1, "the vertex header")
    count = integer(header[0])
    dim = integer(header[1]) if len(header) > 1 else 2
    if count < 3:
        raise InputError("fewer than three vertices")
    if dim != 2:
        raise InputError("not two-dimensional")
    for k in range(count):
        fields = line(3, "vertex %d" % (k + 1))
        if k == 0 and integer(fields[0]) in (0, 1):
            pslg.base = integer(fields[0])
        pslg.points.append((real(fields[1]), real(fields[2])))
    if len(set(pslg.points)) == 1:
        raise InputError("all vertices are identical")
    if not str(path).endswith(".poly"):
        return pslg
    for k in range(integer(line(1, "the segment header")[0])):
        fields = line(3, "segment %d" % (k + 1))
        pslg.segments.append((integer(fields[1]) - pslg.base, integer(fields[2]) - pslg.base))
    for k in range(integer(line(1, "the hole header")[0])):
        fields = line(3, "hole %d" % (k + 1))
        pslg.holes.append((real(fields[1]), real(fields[2])))
    fields = next(lines, None)
    for k in range(integer(fields[0]) if fields else 0):
        fields = line(4, "region %d" % (k + 1))
        values = [real(f) for f in fields[1:5]]
        pslg.regions.append((*values[:3], values[-1]))  # a single value is both attribute and area bound
    return pslg


# --- predicates

def sign(value):
    return (value > 0) - (value < 0)


def orient(a, b, c):
    """Sign of twice the area of a b c, by a float filter, then exactly. Coordinates are floats, ints or Fractions."""
    if type(a[0]) is not Fraction and type(b[0]) is not Fraction and type(c[0]) is not Fraction:
        left = (a[0] - c[0]) * (b[1] - c[1])
        right = (a[1] - c[1]) * (b[0] - c[0])
        size = abs(left) + abs(right)
        if 1e-280 < size < 1e300 and abs(left - right) > 4e-16 * size:
            return 1 if left > right else -1
    ax, ay, bx, by, cx, cy = map(Fraction, (*a, *b, *c))
    return sign((ax - cx) * (by - cy) - (ay - cy) * (bx - cx))


def crossing(a, b, c, d):
    """The exact common point of the lines a b and c d."""
    ax, ay, bx, by, cx, cy, dx, dy = map(Fraction, (*a, *b, *c, *d))
    den = (bx - ax) * (dy - cy) - (by - ay) * (dx - cx)
    t = ((cx - ax) * (dy - cy) - (cy - ay) * (dx - cx)) / den
    return (ax + t * (bx - ax), ay + t * (by - ay))


# --- arrangement

class Arrangement:
    """Planar graph of a PSLG: every crossing or contact is a node, and every edge occurs once."""

    def __init__(self, points, segments):
        self.nodes = []              # exact coordinates
        self.node_of = {}            # coordinates -> node
        self.duplicates = 0
        for point in points:
            if point in self.node_of:
                self.duplicates += 1
            self.add_node(point)
        self.n_input = len(self.nodes)
        n = len(points)
        pairs = [(self.node_of[points[a]], self.node_of[points[b]]) for a, b in segments
                 if 0 <= a < n and 0 <= b < n]
        self.skipped = len(segments) - sum(1 for a, b in pairs if a != b)
        self.pairs = [(a, b) for a, b in pairs if a != b]
        self.crossings = self.touches = 0
        cuts = self.find_cuts()
        self.split(cuts)

    def add_node(self, point):
        node = self.node_of.setdefault(point, len(self.nodes))
        if node == len(self.nodes):
            self.nodes.append(point)
        return node

    def find_cuts(self):
        cuts = [[] for _ in self.pairs]
        nodes = self.nodes
        xs, ys = [p[0] for p in nodes], [p[1] for p in nodes]
        x0, y0 = min(xs), min(ys)
        width, height = max(xs) - x0, max(ys) - y0
        m = max(1, int(math.sqrt(len(nodes) + len(self.pairs))))

        def column(x):
            return min(m - 1, int((x - x0) / width * m)) if width else 0

        def row(y):
            return min(m - 1, int((y - y0) / height * m)) if height else 0

        cells = {}
        for k, (a, b) in enumerate(self.pairs):
            (i, j), (r, s) = sorted((column(xs[a]), column(xs[b]))), sorted((row(ys[a]), row(ys[b])))
            for u in range(i, j + 1):
                for v in range(r, s + 1):
                    cells.setdefault((u, v), []).append(k)
        boxes = [(min(xs[a], xs[b]), max(xs[a], xs[b]), min(ys[a], ys[b]), max(ys[a], ys[b])) for a, b in self.pairs]
        for node in range(self.n_input):
            x, y = nodes[node]
            for k in cells.get((column(x), row(y)), ()):
                a, b = self.pairs[k]
                left, right, low, high = boxes[k]
                if left <= x <= right and low <= y <= high and node not in (a, b) and \
                        orient(nodes[a], nodes[b], nodes[node]) == 0:
                    cuts[k].append(node)
                    self.touches += 1
        seen = set()
        for members in cells.values():
            for i, k in enumerate(members):
                left, right, low, high = boxes[k]
                for l in members[i + 1:]:
                    other = boxes[l]
                    if other[0] <= right and left <= other[1] and other[2] <= high and low <= other[3] and \
                            (k, l) not in seen:
                        seen.add((k, l))
                        self.cross(k, l, cuts)
        return cuts

    def cross(self, k, l, cuts):
        (a, b), (c, d) = self.pairs[k], self.pairs[l]
        if len({a, b, c, d}) < 4:
            return
        a, b, c, d = (self.nodes[i] for i in (a, b, c, d))
        if orient(a, b, c) * orient(a, b, d) < 0 and orient(c, d, a) * orient(c, d, b) < 0:
            node = self.add_node(crossing(a, b, c, d))
            cuts[k].append(node)
            cuts[l].append(node)
            self.crossings += 1

    def split(self, cuts):
        given = {}
        for (a, b), inner in zip(self.pairs, cuts):
            p, q = self.nodes[a], self.nodes[b]
            axis = 0 if abs(q[0] - p[0]) >= abs(q[1] - p[1]) else 1
            chain = sorted({a, b, *inner}, key=lambda i: Fraction(self.nodes[i][axis]))
            for u, v in zip(chain, chain[1:]):
                edge = (min(u, v), max(u, v))
                given[edge] = given.get(edge, 0) + 1
        self.edges = sorted(given)
        self.repeated = sum(1 for times in given.values() if times > 1)


# --- faces

def direction_order(nodes, origin):
    """Comparator of neighbours by the angle of the edge origin -> neighbour, in [0, 360) degrees, exact."""
    o = nodes[origin]

    def half(i):
        x, y = nodes[i]
        return 0 if (y > o[1] or (y == o[1] and x > o[0])) else 1

    def compare(i, j):
        if half(i) != half(j):
            return half(i) - half(j)
        return -orient(o, nodes[i], nodes[j])

    return cmp_to_key(compare)


class Subdivision:
    """Faces of an arrangement. Face 0 is the unbounded one."""

    def __init__(self, arrangement):
        self.nodes = arrangement.nodes
        self.edges = arrangement.edges
        self.rotation = [[] for _ in self.nodes]
        for u, v in self.edges:
            self.rotation[u].append(v)
            self.rotation[v].append(u)
        for u, around in enumerate(self.rotation):
            if len(around) > 2:
                around.sort(key=direction_order(self.nodes, u))
        self.trace()
        self.find_components()
        self.bin_edges()
        self.nest()

    def trace(self):
        self.walk_of = {}
        self.walks = []
        before = [{v: around[i - 1] for i, v in enumerate(around)} for around in self.rotation]
        for edge in self.edges:
            for u, v in (edge, edge[::-1]):
                if (u, v) in self.walk_of:
                    continue
                walk = []
                while (u, v) not in self.walk_of:
                    self.walk_of[u, v] = len(self.walks)
                    walk.append(u)
                    u, v = v, before[v][u]
                self.walks.append(walk)
        self.area2 = [self.twice_area(walk) for walk in self.walks]

    def twice_area(self, walk):
        points = [(Fraction(self.nodes[i][0]), Fraction(self.nodes[i][1])) for i in walk]
        return sum(p[0] * q[1] - p[1] * q[0] for p, q in zip(points, points[1:] + points[:1]))

    def find_components(self):
        self.component = [-1] * len(self.nodes)
        self.members = []
        for start in range(len(self.nodes)):
            if self.component[start] >= 0:
                continue
            self.component[start] = len(self.members)
            found = [start]
            for u in found:
                for v in self.rotation[u]:
                    if self.component[v] < 0:
                        self.component[v] = len(self.members)
                        found.append(v)
            self.members.append(found)

    def bin_edges(self):
        xs = [float(p[0]) for p in self.nodes]
        self.x0, self.width = min(xs), max(xs) - min(xs)
        self.bins = [[] for _ in range(max(1, min(1000, len(self.edges) // 4)))]
        for u, v in self.edges:
            if self.nodes[u][0] == self.nodes[v][0]:
                continue
            if self.nodes[u][0] > self.nodes[v][0]:
                u, v = v, u
            for k in range(self.bin(xs[u]), self.bin(xs[v]) + 1):
                self.bins[k].append((u, v))

    def bin(self, x):
        k = int((x - self.x0) / self.width * len(self.bins)) if self.width else 0
        return max(0, min(len(self.bins) - 1, k))

    def walk_above_edge_below(self, point):
        """The walk directly below the point (moved right by an infinitesimal step), or None."""
        best = None
        for u, v in self.bins[self.bin(float(point[0]))]:
            p, q = self.nodes[u], self.nodes[v]
            if p[0] <= point[0] < q[0] and orient(p, q, point) > 0:
                px, py, qx, qy = map(Fraction, (*p, *q))
                slope = (qy - py) / (qx - px)
                key = (py + slope * (Fraction(point[0]) - px), slope)
                if best is None or key > best[0]:
                    best = (key, self.walk_of[u, v])
        return None if best is None else best[1]

    def nest(self):
        """Assigns a face to every walk and component. The last node of a component is located only in larger
        components."""
        self.n_faces = 1
        self.face_of_walk = [-1] * len(self.walks)
        for k, area in enumerate(self.area2):
            if area > 0:
                self.face_of_walk[k] = self.n_faces
                self.n_faces += 1
        outer = {self.component[walk[0]]: k for k, walk in enumerate(self.walks) if self.area2[k] <= 0}
        last = [max(found, key=lambda i: self.nodes[i]) for found in self.members]
        self.face_of_component = [0] * len(self.members)
        for c in sorted(range(len(self.members)), key=lambda c: self.nodes[last[c]], reverse=True):
            walk = self.walk_above_edge_below(self.nodes[last[c]])
            face = 0 if walk is None else self.face_of_walk[walk]
            self.face_of_component[c] = face
            if c in outer:
                self.face_of_walk[outer[c]] = face

    def locate(self, point):
        walk = self.walk_above_edge_below(point)
        return 0 if walk is None else self.face_of_walk[walk]

    def triangles(self, eaten):
        """Number of triangles of the remaining faces."""
        halves, pieces = [0] * self.n_faces, [0] * self.n_faces
        for k, walk in enumerate(self.walks):
            halves[self.face_of_walk[k]] += len(walk)
        for face in range(1, self.n_faces):
            pieces[face] += 1
        for face in self.face_of_component:
            pieces[face] += 1
        return sum(halves[f] + 2 * pieces[f] - 4 for f in range(1, self.n_faces) if f not in eaten)

    def used_nodes(self, eaten):
        used = set()
        for k, walk in enumerate(self.walks):
            if self.face_of_walk[k] not in eaten:
                used.update(walk)
        for c, found in enumerate(self.members):
            if len(found) == 1 and self.face_of_component[c] not in eaten:
                used.update(found)
        return used

    def area(self, eaten):
        return sum(self.area2[k] for k in range(len(self.walks)) if self.face_of_walk[k] not in eaten) / 2

    def smallest_angle(self, eaten):
        """Smallest angle in degrees between two segments with domain in between; 360 if there is none."""
        least = 360.0
        for u, around in enumerate(self.rotation):
            for i, v in enumerate(around):
                w = around[i - 1]
                if len(around) > 1 and self.face_of_walk[self.walk_of[u, w]] not in eaten:
                    least = min(least, self.angle(w, u, v))
        return least

    def angle(self, w, u, v):
        wx, wy, ux, uy, vx, vy = map(Fraction, (*self.nodes[w], *self.nodes[u], *self.nodes[v]))
        wx, wy, vx, vy = wx - ux, wy - uy, vx - ux, vy - uy
        size = max(abs(wx), abs(wy)) * max(abs(vx), abs(vy))
        turn = math.degrees(math.atan2(float((wx * vy - wy * vx) / size), float((wx * vx + wy * vy) / size)))
        return turn if turn > 0 else turn + 360


def hull_edges(points):
    """Edges between consecutive points of the convex hull, collinear points included."""
    order = sorted(set(points))

    def chain(sequence):
        stack = []
        for p in sequence:
            while len(stack) > 1 and orient(stack[-2], stack[-1], p) < 0:
                stack.pop()
            stack.append(p)
        return stack

    ring = chain(order)[:-1] + chain(order[::-1])[:-1]
    return list(zip(ring, ring[1:] + ring[:1]))


class Facts:
    """Facts that hold for any correct triangulation of the input with the given switches."""

    def __init__(self, pslg, switches):
        points = pslg.points
        segments = list(pslg.segments) if "p" in switches else []
        plain = Arrangement(points, segments)
        shape = plain
        if "p" not in switches or "c" in switches:
            index = {p: i for i, p in reversed(list(enumerate(points)))}
            segments += [(index[a], index[b]) for a, b in hull_edges(points)]
            shape = Arrangement(points, segments)
        sub = Subdivision(shape)
        holes = pslg.holes if "p" in switches else []
        self.hole_faces = [sub.locate(h) for h in holes]
        eaten = {0, *self.hole_faces}
        self.duplicates, self.crossings = plain.duplicates, plain.crossings
        self.touches, self.repeated, self.skipped = plain.touches, plain.repeated, plain.skipped
        self.vertices = len(points) + len(shape.nodes) - shape.n_input
        self.used = len(sub.used_nodes(eaten))
        self.triangles = sub.triangles(eaten)
        self.area = sub.area(eaten)
        self.smallest_angle = sub.smallest_angle(eaten)
        self.faces = sub.n_faces - 1
        self.region_faces = [sub.locate(r) for r in pslg.regions] if "p" in switches else []
        self.subdivision, self.eaten = sub, eaten

    @property
    def valid(self):
        return not (self.duplicates or self.crossings or self.touches or self.repeated or self.skipped)
