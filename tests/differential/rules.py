"""Rules for a mesh of any program: markers, attributes, neighbours, Voronoi diagram, midpoints of edges.

Each function yields sentences about faults. The rules are also applied to the oracle's meshes, because a rule that
Triangle's own mesh breaks is not a rule of the formats.
"""
from cases import field
from geometry import area, circumcentre, extent, near_segment, on_segment
from meshes import pair

TOLERANCE = 1e-9  # relative to the extent: the largest distance of computed positions from their exact ones


def bare_area(switches):
    """Do the switches contain an `a` without a number?"""
    return any(k == "a" and not d.isdigit() for k, d in zip(switches, switches[1:] + " "))


class Given:
    """The input from the rules' point of view: the segments that count, and the vertices on them."""

    def __init__(self, case, switches):
        self.case = case
        n = len(case.points)
        rows = zip(case.segments, case.segment_markers) if "p" in switches else ()
        self.segments = [(case.points[a], case.points[b], m) for (a, b), m in rows
                         if 0 <= a < n and 0 <= b < n and case.points[a] != case.points[b]]
        reads_regions = "p" in switches and "r" not in switches and ("A" in switches or bare_area(switches))
        self.holes = [tuple(h) for h in case.holes] if "p" in switches else []
        self.regions = [tuple(r) for r in case.regions] if reads_regions else []
        self.tolerance = TOLERANCE * extent(case.points)
        self.place = {p: k for k, p in reversed(list(enumerate(case.points)))} if "j" in switches else None

    def input_vertex(self, mesh, v):
        """Number of a vertex in the input, or None for a new vertex."""
        if self.place is not None:
            return self.place.get(mesh.points[v])
        return v if v < len(self.case.points) else None

    def markers_at(self, point, exact):
        """Markers of the segments through a position, in input order."""
        return [m for a, b, m in self.segments
                if (on_segment(point, a, b) if exact else near_segment(point, a, b, self.tolerance))]

    def markers_along(self, a, b):
        """Markers of the segments that contain the piece ab."""
        return [m for p, q, m in self.segments
                if near_segment(a, p, q, self.tolerance) and near_segment(b, p, q, self.tolerance)]

    def rank(self, a, b):
        """Number of the first segment that contains the piece ab. If there is none, a number after all segments."""
        for k, (p, q, _) in enumerate(self.segments):
            if on_segment(a, p, q) and on_segment(b, p, q):
                return k
        return len(self.segments)


def or_boundary(markers, is_boundary):
    """Allowed markers of a vertex: those of its segments, nonzero ones first; without segments, 1 on the boundary."""
    return {m for m in markers if m} or {int(is_boundary)}


def vertex_markers(mesh, given):
    rim = {v for side in mesh.boundary() for v in side}
    used = mesh.used()
    for v, found in enumerate(mesh.markers or ()):
        k = given.input_vertex(mesh, v)
        own = given.case.markers[k] if k is not None else 0
        if own:
            allowed = {own}
        elif v not in used:
            continue  # vertices used only before carving have undetermined markers
        elif k is not None:
            allowed = or_boundary(given.markers_at(mesh.points[v], True), v in rim)
        else:  # crossings and midpoints of edges get the marker of one segment, even if it is 0
            markers = given.markers_at(mesh.points[v], False)
            allowed = set(markers) | or_boundary(markers, v in rim) if len(set(markers)) > 1 else \
                or_boundary(markers, v in rim)
        if found not in allowed:
            yield f"vertex {v} has marker {found}, allowed: {sorted(allowed)}"


def edge_marker_faults(mesh, given, ends, markers, what):
    """The first nonzero marker of the segments that contain the edge. Without one, 1 on the boundary and 0 inside."""
    rim = mesh.boundary()
    for (a, b), found in zip(ends, markers or ()):
        along = [m for m in given.markers_along(mesh.points[a], mesh.points[b]) if m]
        expected = along[0] if along else int(pair(a, b) in rim)
        if found != expected:
            yield f"{what} {a} {b} has marker {found} instead of {expected}"


def edges(mesh, given):
    if mesh.edges is None:
        return
    if sorted(pair(*e) for e in mesh.edges) != sorted(mesh.sides()):
        yield "the edges differ from those of the triangles"
    yield from edge_marker_faults(mesh, given, mesh.edges, mesh.edge_markers, "edge")


def segments(mesh, given):
    if mesh.segments is None:
        return
    sides = mesh.sides()
    if any(pair(*s) not in sides for s in mesh.segments):
        yield "a subsegment is not an edge"
    if len({pair(*s) for s in mesh.segments}) != len(mesh.segments):
        yield "a subsegment occurs twice"
    if not mesh.boundary() <= {pair(*s) for s in mesh.segments}:
        yield "a boundary edge is not a subsegment"
    yield from edge_marker_faults(mesh, given, mesh.segments, mesh.segment_markers, "subsegment")


def segment_order(mesh, given):
    """Pieces follow the order of the input segments; hull edges come last. Skipped if segments are cut or split."""
    if mesh.segments is None or len(mesh.points) > len(given.case.points):
        return
    ranks = [given.rank(mesh.points[a], mesh.points[b]) for a, b in mesh.segments]
    if ranks != sorted(ranks):
        yield f"subsegments are not in input order: {ranks}"


def echoes(mesh, given):
    """Hole points are unchanged, and regions as well if their section was read."""
    if mesh.holes is not None:
        if mesh.holes != given.holes:
            yield f"holes {mesh.holes} instead of {given.holes}"
        if mesh.regions != given.regions:
            yield f"regions {mesh.regions} instead of {given.regions}"


def orientation(mesh, _):
    for t, corners in enumerate(mesh.corners()):
        if area(*[mesh.points[v] for v in corners]) < 0:
            yield f"triangle {t} is clockwise"


def neighbours(mesh, _):
    """Neighbour k of a triangle lies opposite its corner k."""
    sides = mesh.sides()
    for t, found in enumerate(mesh.neighbours or ()):
        a, b, c = mesh.corners()[t]
        expected = tuple(sum(u for u in sides[side] if u != t) if len(sides[side]) == 2 else -1
                         for side in (pair(b, c), pair(c, a), pair(a, b)))
        if found != expected:
            yield f"triangle {t} has neighbours {found} instead of {expected}"


def close(p, q, size, tolerance=1e-7):
    return all(abs(x - y) <= tolerance * size for x, y in zip(p, q))


def voronoi_vertices(mesh, given):
    for t, corners in enumerate(mesh.corners()):
        places = [mesh.points[v] for v in corners]
        if area(*places) <= 1e-7 * extent(places) ** 2:
            continue  # the centre of a sliver has no correct digits
        centre = circumcentre(*places)
        size = extent(places + [centre]) + abs(centre[0]) * 1e-6 + abs(centre[1]) * 1e-6
        if not close(mesh.voronoi_points[t], centre, size):
            yield f"Voronoi vertex {t} is at {mesh.voronoi_points[t]} instead of {centre}"
        if mesh.voronoi_attributes:
            value = field(*centre)
            if given.case.attributes and abs(mesh.voronoi_attributes[t][0] - value) > 1e-6 * (size + abs(value)):
                yield f"Voronoi vertex {t} has attribute {mesh.voronoi_attributes[t][0]} instead of {value}"


def on_the_left(corners, a, b):
    return (a, b) in (corners[0:2], corners[1:3], (corners[2], corners[0]))


def voronoi_edges(mesh, _):
    """Voronoi edges are dual to the edges of the same number. They run from the triangle on the edge's left to the one
    on its right, or to infinity on the right."""
    sides = mesh.sides()
    if len(mesh.voronoi_edges) != len(mesh.edges):
        yield "the numbers of Voronoi edges and edges differ"
    for k, ((a, b), (left, right)) in enumerate(zip(mesh.edges, mesh.voronoi_edges)):
        beside = set(sides[pair(a, b)])
        if {left, right} - {-1} != beside or left < 0 or not on_the_left(mesh.corners()[left], a, b):
            yield f"Voronoi edge {k} is between {left} and {right}; the edge {a} {b} between {sorted(beside)}"
        elif right < 0:
            (ax, ay), (bx, by) = mesh.points[a], mesh.points[b]
            if not close(mesh.voronoi_rays[k], (by - ay, ax - bx), extent([(ax, ay), (bx, by)]), 1e-12):
                yield f"Voronoi edge {k} leads to {mesh.voronoi_rays[k]}"


def voronoi(mesh, given):
    if mesh.voronoi_points is None:
        return
    if len(mesh.voronoi_points) != len(mesh.triangles):
        yield "the numbers of Voronoi vertices and triangles differ"
        return
    yield from voronoi_vertices(mesh, given)
    if mesh.edges is not None:
        yield from voronoi_edges(mesh, given)


def middles(mesh, _):
    """Nodes 4, 5, 6 are midpoints of the sides opposite corners 1, 2, 3. Their attributes are means."""
    for t, nodes in enumerate(mesh.triangles):
        for k in range(3 if len(nodes) == 6 else 0):
            a, b, m = nodes[(k + 1) % 3], nodes[(k + 2) % 3], nodes[3 + k]
            middle = [(x + y) / 2 for x, y in zip(mesh.points[a], mesh.points[b])]
            if not close(mesh.points[m], middle, extent(mesh.points), 1e-12):
                yield f"node {k + 4} of triangle {t} is not the midpoint of its side"
            if mesh.attributes and any(abs(u + v - 2 * w) > 1e-12 * (abs(u) + abs(v) + 1) for u, v, w in
                                       zip(mesh.attributes[a], mesh.attributes[b], mesh.attributes[m])):
                yield f"node {k + 4} of triangle {t} does not have the mean attributes"


def attributes(mesh, given):
    """The first attribute is an affine function, so interpolation reproduces it."""
    if not mesh.attributes:
        return
    scale = max(abs(field(*p)) for p in given.case.points) + 1
    for v in mesh.used():
        value = mesh.attributes[v][0]
        if abs(value - field(*mesh.points[v])) > 1e-7 * scale:
            yield f"vertex {v} has attribute {value} instead of {field(*mesh.points[v])}"


RULES = (vertex_markers, edges, segments, segment_order, echoes, orientation, neighbours, voronoi, middles, attributes)


def breaches(mesh, case, switches):
    given = Given(case, switches)
    return [f"{rule.__name__}: {text}" for rule in RULES for text in rule(mesh, given)]
