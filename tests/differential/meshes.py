"""A mesh read from output files or received from the oracle, and the parts of it that are determined.

If empty circles pass through more than three vertices, the triangles are not determined, but the cells are. A cell is a
polygon that remains when edges between cocircular triangles are removed; constrained edges remain. Two constrained
Delaunay triangulations of one input have the same cells, and therefore the same number of triangles.
"""
import re

from geometry import incircle

LABELS = re.compile(r"  (Input|Mesh) [a-z ]+(\(constrained edges\))?: \d+$")
NUMBER = r"[-+.0-9e]+"
HISTOGRAM = (re.compile(r"  [A-Z][a-z]+ [a-z ]+: +%s   \|  [A-Z][a-z]+ [a-z ]+: +%s$" % (NUMBER, NUMBER)),
             re.compile(r" +[.0-9]+ - +[.0-9]+ +: *\d+    \| +[.0-9]+ - *[.0-9]* *: *\d+$"),
             re.compile(r" +\d+ - +\d+ degrees: *\d+    \| +\d+ - +\d+ degrees: *\d+$"))


def statistics(printed):
    return [line for line in printed.split("\n") if LABELS.match(line)]


def histograms(printed):
    return [line for line in printed.split("\n") if any(h.match(line) for h in HISTOGRAM)]


def pair(a, b):
    return (a, b) if a < b else (b, a)


class Mesh:
    """Lists as in the files, with indices from 0. None if a file or column is missing."""

    points = attributes = markers = triangles = triangle_attributes = segments = segment_markers = None
    edges = edge_markers = neighbours = voronoi_points = voronoi_attributes = voronoi_edges = voronoi_rays = None
    holes = regions = None
    printed = ""

    def sides(self):
        """{(a, b): triangles beside this edge}, with a < b."""
        found = {}
        for t, (a, b, c) in enumerate(self.corners()):
            for side in (pair(a, b), pair(b, c), pair(c, a)):
                found.setdefault(side, []).append(t)
        return found

    def corners(self):
        return [tuple(t[:3]) for t in self.triangles]

    def boundary(self):
        return {side for side, beside in self.sides().items() if len(beside) == 1}

    def used(self):
        return {v for t in self.corners() for v in t}

    def is_tie(self, side, beside):
        """Do two triangles have the same circumcircle?"""
        t, u = (self.corners()[k] for k in beside)
        far = next(v for v in u if v not in side)
        return incircle(*[self.points[v] for v in t], self.points[far]) == 0

    def ties(self, constrained):
        return {side for side, beside in self.sides().items()
                if len(beside) == 2 and side not in constrained and self.is_tie(side, beside)}

    def cells(self, ties, name):
        """Maps each cell to its attributes. The key is the sorted tuple of the names name[v] of its vertices v."""
        group = list(range(len(self.triangles)))

        def root(t):
            while group[t] != t:
                t = group[t]
            return t
        sides = self.sides()
        for side in ties:
            t, u = sides[side]
            group[root(t)] = root(u)
        vertices = {}
        for t, corners in enumerate(self.corners()):
            vertices.setdefault(root(t), set()).update(name[v] for v in corners)
        attributes = self.triangle_attributes or [()] * len(group)
        return {tuple(sorted(found)): tuple(attributes[t]) for t, found in vertices.items()}


# --- from files

def rows(path):
    """Records as lists of words."""
    with open(path, encoding="ascii") as file:
        lines = (line.split("#")[0].split() for line in file)
        return [line for line in lines if line]


def whole(words, base=0):
    """Parses indices. -1 means none, for every base."""
    return [int(w) - base if int(w) >= 0 else -1 for w in words]


def reals(words):
    return [float(w) for w in words]


def read_node(mesh, path, prefix=""):
    records = rows(path)
    n, _, n_attributes, n_markers = map(int, records[0])
    body = records[1:n + 1]
    assert len(records) == n + 1 and all(len(r) == 3 + n_attributes + n_markers for r in body), path
    setattr(mesh, prefix + "points", [tuple(reals(r[1:3])) for r in body])
    setattr(mesh, prefix + "attributes", [reals(r[3:3 + n_attributes]) for r in body] if n_attributes else None)
    if not prefix:
        mesh.markers = [int(r[-1]) for r in body] if n_markers else None


def read_ele(mesh, path, base):
    records = rows(path)
    n, corners, n_attributes = map(int, records[0])
    assert len(records) == n + 1 and all(len(r) == 1 + corners + n_attributes for r in records[1:]), path
    mesh.triangles = [whole(r[1:1 + corners], base) for r in records[1:]]
    mesh.triangle_attributes = [tuple(reals(r[1 + corners:])) for r in records[1:]] if n_attributes else None


def read_pairs(records, base):
    """Ends and markers of a table of segments or edges, its header, and the remaining records."""
    n, has_markers = int(records[0][0]), int(records[0][1])
    body = records[1:n + 1]
    assert len(body) == n and all(len(r) == 3 + has_markers for r in body)
    ends = [tuple(whole(r[1:3], base)) for r in body]
    return ends, [int(r[3]) for r in body] if has_markers else None, records[n + 1:]


def read_poly(mesh, path, base):
    records = rows(path)
    assert records[0][0] == "0"
    mesh.segments, mesh.segment_markers, rest = read_pairs(records[1:], base)
    n = int(rest[0][0])
    mesh.holes = [tuple(reals(r[1:])) for r in rest[1:n + 1]]
    rest = rest[n + 1:]
    mesh.regions = [tuple(reals(r[1:])) for r in rest[1:]]
    assert len(mesh.holes) == n and (not rest or len(mesh.regions) == int(rest[0][0]) > 0)


def read_voronoi(mesh, stem, base):
    read_node(mesh, stem + ".v.node", "voronoi_")
    records = rows(stem + ".v.edge")
    mesh.voronoi_edges = [tuple(whole(r[1:3], base)) for r in records[1:]]
    mesh.voronoi_rays = [tuple(reals(r[3:])) for r in records[1:]]
    assert len(records) == int(records[0][0]) + 1


def from_files(stem, base, written, printed):
    """Reads the files stem.node and so on, for the suffixes in `written`."""
    mesh = Mesh()
    mesh.printed = printed
    read_node(mesh, stem + ".node")
    read_ele(mesh, stem + ".ele", base)
    if "poly" in written:
        read_poly(mesh, stem + ".poly", base)
    if "edge" in written:
        mesh.edges, mesh.edge_markers, rest = read_pairs(rows(stem + ".edge"), base)
        assert not rest
    if "neigh" in written:
        mesh.neighbours = [tuple(whole(r[1:], base)) for r in rows(stem + ".neigh")[1:]]
    if "v.node" in written:
        read_voronoi(mesh, stem, base)
    return mesh


# --- from the oracle

def flat(column):
    return None if column is None else [row[0] for row in column]


def tuples(table):
    return None if table is None else [tuple(row) for row in table]


def from_oracle(answer):
    mesh = Mesh()
    mesh.points = tuples(answer.get("pointlist")) or []
    mesh.attributes = answer.get("pointattributelist")
    mesh.markers = flat(answer.get("pointmarkerlist"))
    mesh.triangles = answer.get("trianglelist") or []
    mesh.triangle_attributes = tuples(answer.get("triangleattributelist"))
    mesh.segments, mesh.segment_markers = tuples(answer.get("segmentlist")), flat(answer.get("segmentmarkerlist"))
    mesh.edges, mesh.edge_markers = tuples(answer.get("edgelist")), flat(answer.get("edgemarkerlist"))
    mesh.neighbours = tuples(answer.get("neighborlist"))
    mesh.voronoi_points = tuples(answer.get("voronoi_pointlist"))
    mesh.voronoi_attributes = answer.get("voronoi_pointattributelist")
    mesh.voronoi_edges, mesh.voronoi_rays = (tuples(answer.get("voronoi_" + k)) for k in ("edgelist", "normlist"))
    mesh.printed = answer["printed"]
    return mesh
