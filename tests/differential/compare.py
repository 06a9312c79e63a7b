"""Compares our mesh with the oracle's, in everything that input and switches determine without refinement.

Vertices have common names. An input vertex is named by the lowest number at its position, since the surviving copy is
not determined. A vertex at a crossing is named by the nearest of our vertices.
"""
from geometry import extent
from meshes import histograms, pair, statistics


def names_of_input(case):
    first = {}
    return [first.setdefault(p, k) for k, p in enumerate(case.points)]


def nearest(points, place, begin):
    return min(range(begin, len(points)), key=lambda v: (points[v][0] - place[0]) ** 2 + (points[v][1] - place[1]) ** 2)


def names(mesh, ours, case, jettisoned):
    """Common name of each corner of a mesh, None for other vertices. Returns None if a corner has no counterpart in
    ours."""
    tolerance = 1e-9 * extent(case.points)
    at_input = {} if jettisoned else dict(enumerate(names_of_input(case)))
    found, used = [], mesh.used()
    for v, place in enumerate(mesh.points):
        name = at_input.get(v)
        if name is None and v in used:
            name = nearest(ours.points, place, len(at_input))
            if extent([place, ours.points[name]]) > tolerance and place != ours.points[name]:
                return None
        found.append(name)
    return found


def constrained(mesh):
    return {pair(*s) for s in mesh.segments or ()} | mesh.boundary()


def table(ends, markers, name, leave):
    """{ends by common names: marker}, without the entries in `leave`."""
    markers = markers or [None] * len(ends)
    return {pair(name[a], name[b]): m for (a, b), m in zip(ends, markers) if pair(a, b) not in leave}


def differences(what, ours, theirs):
    """The differences of two dictionaries."""
    for key in sorted(set(ours) | set(theirs)):
        a, b = ours.get(key, "nothing"), theirs.get(key, "nothing")
        if a != b:
            yield f"{what} {key}: {a} instead of {b}"


def vertices(ours, theirs, case, switches):
    if len(ours.points) != len(theirs.points) and (ours.triangles or "j" not in switches):
        yield f"{len(ours.points)} vertices instead of {len(theirs.points)}"
    n = len(case.points) if ours.triangles and not ("j" in switches and "duplicates" in case.traits) else 0
    if ours.points[:n] != theirs.points[:n]:
        yield "input vertices differ in position or order"
    if "duplicates" not in case.traits:
        if (ours.attributes or theirs.attributes) and ours.attributes[:n] != theirs.attributes[:n]:
            yield "attributes of input vertices differ"


def tables(ours, theirs, our_names, their_names, given):
    """With -r the triangles are given, so ties leave no choice."""
    leave = [set() if given else m.ties(constrained(m)) for m in (ours, theirs)]
    yield from differences("cell", ours.cells(leave[0], our_names), theirs.cells(leave[1], their_names))
    for what in ("edge", "segment"):
        ends = [getattr(m, what + "s") or [] for m in (ours, theirs)]
        marks = [getattr(m, what + "_markers") for m in (ours, theirs)]
        yield from differences(what, table(ends[0], marks[0], our_names, leave[0]),
                               table(ends[1], marks[1], their_names, leave[1]))


def columns(ours, theirs):
    """Names of the arrays present, and their numbers of records."""
    for name in ("attributes", "markers", "triangles", "triangle_attributes", "segments", "segment_markers", "edges",
                 "edge_markers", "neighbours", "voronoi_points", "voronoi_edges"):
        a, b = (len(getattr(m, name) or ()) for m in (ours, theirs))
        if a != b:
            yield f"{a} {name} instead of {b}"


def new_vertices(ours, theirs, our_names, their_names, n):
    """At crossings, marker and attributes are those of the segment that was inserted first."""
    at = {name: v for v, name in enumerate(our_names) if name is not None}
    for v in theirs.used():
        w = at[their_names[v]]
        if v < n:
            continue
        if ours.markers and theirs.markers and ours.markers[w] != theirs.markers[v]:
            yield f"vertex {w} has marker {ours.markers[w]} instead of {theirs.markers[v]}"
        if ours.attributes and any(abs(a - b) > 1e-7 for a, b in zip(ours.attributes[w], theirs.attributes[v])):
            yield f"vertex {w} has attributes {ours.attributes[w]} instead of {theirs.attributes[v]}"


def counted(mesh):
    """Points on a line have no triangles. Triangle counts the vertices all the same, and its extremes are not
    numbers."""
    return [line for line in statistics(mesh.printed) if mesh.triangles or "Mesh vertices" not in line]


def summaries(ours, theirs, case, switches):
    if "Q" in switches:
        return
    if counted(ours) != counted(theirs):
        yield f"statistics: {counted(ours)} instead of {counted(theirs)}"
    comparable = ours.triangles and not ours.ties(constrained(ours)) and "needles" not in case.traits
    if "V" in switches and comparable and histograms(ours.printed) != histograms(theirs.printed):
        yield "\n".join(["histograms:"] + histograms(ours.printed) + ["instead of"] + histograms(theirs.printed))


FIELDS = ("points", "attributes", "markers", "triangles", "triangle_attributes", "segments", "segment_markers", "edges",
          "edge_markers", "neighbours", "voronoi_points", "voronoi_attributes", "voronoi_edges")


def agreement(files, library):
    """The output of our program equals the result of our library, number for number."""
    for name in FIELDS:
        a, b = ([tuple(x) if isinstance(x, list) else x for x in getattr(m, name) or ()] for m in (files, library))
        if a != b:
            yield f"the library's {name} differ from the files'"
    rays = [r for r in library.voronoi_rays or () if r != (0, 0)]
    if rays != [r for r in files.voronoi_rays or () if r]:
        yield "the library's rays differ from the file's"


def compare(ours, theirs, case, switches):
    """Returns sentences about the differences."""
    found = list(columns(ours, theirs)) + list(vertices(ours, theirs, case, switches))
    found += summaries(ours, theirs, case, switches)
    if found:
        return found
    jettisoned = "j" in switches
    our_names, their_names = names(ours, ours, case, jettisoned), names(theirs, ours, case, jettisoned)
    if their_names is None:
        return ["a vertex has no counterpart in our mesh"]
    found += tables(ours, theirs, our_names, their_names, "r" in switches)
    if not jettisoned:
        found += new_vertices(ours, theirs, our_names, their_names, len(case.points))
    return found
