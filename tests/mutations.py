#!/usr/bin/env python3
"""mutations.py BINARIES: damages a valid mesh in many ways. trianglecheck must name each fault, and must print exactly
the same when it has almost no memory.

BINARIES is the folder of triangle and trianglecheck. The undamaged mesh must pass."""
import copy
import math
import pathlib
import subprocess
import sys
import tempfile

POINTS = [[0, 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0],  # a square,
          [3, 3, 0], [5, 3, 0], [5, 5, 0], [3, 5, 0],      # a square hole in it,
          [6, 7, 9], [9, 8, 0],                            # a segment with a marker,
          [6, 1, 0], [9, 1, 0], [9, 3, 0], [6, 3, 0],      # a face of its own,
          [2, 8, 0],                                       # a point,
          [8, 10, 0], [10, 9, 0]]                          # and a corner cut off
SEGMENTS = [[0, 1, 2], [1, 2, 3], [2, 3, 0], [3, 0, 0], [4, 5, 0], [5, 6, 0], [6, 7, 0], [7, 4, 0], [8, 9, 7],
            [10, 11, 4], [11, 12, 4], [12, 13, 4], [13, 10, 4], [15, 16, 5]]
HOLES = [[4, 4]]
REGIONS = [[9.5, 9.75, 3], [7, 2, 1], [8, 2, 2]]  # the corner, and the face twice


class Mesh:
    """Points and segments with a marker each, triangles, and their neighbours (or None). Also the input that the mesh
    is checked against."""

    def __init__(self, base):
        self.points = [[float(r[0]), float(r[1]), int(r[-1])] for r in rows(base, ".node")]
        self.triangles = [[int(x) for x in r[:3]] for r in rows(base, ".ele")]
        self.attributes = [float(r[3]) for r in rows(base, ".ele")]
        self.neighbors = [[int(x) for x in r[:3]] for r in rows(base, ".neigh")]
        segments = numbers(base, ".poly")
        count = int(segments[1][0])
        self.segments = [[int(x) for x in r[1:4]] for r in segments[2:2 + count]]
        self.input_points, self.input_segments, self.holes = map(copy.deepcopy, (POINTS, SEGMENTS, HOLES))

    def corners(self, t):
        return [self.points[v][:2] for v in self.triangles[t]]

    def center(self, t):
        return [sum(p[k] for p in self.corners(t)) / 3 for k in (0, 1)]

    def in_face(self, t):
        x, y = self.center(t)
        return 6 < x < 9 and 1 < y < 3

    def in_corner(self, t):
        x, y = self.center(t)
        return x + 2 * y > 28

    def edges(self):
        """{(a, b): triangle on the left}"""
        return {(c[k], c[k - 2]): t for t, c in enumerate(self.triangles) for k in range(3)}

    def inner(self):
        """Returns a triangle without subsegments."""
        walls, edges = {frozenset(s[:2]) for s in self.segments}, self.edges()
        return next(t for t, c in enumerate(self.triangles)
                    if all(frozenset((c[k], c[k - 2])) not in walls and (c[k - 2], c[k]) in edges for k in range(3)))

    def free(self):
        """Returns a vertex that is neither an input vertex nor on a subsegment."""
        walls = {v for s in self.segments for v in s[:2]}
        return next(v for c in self.triangles for v in c if v >= len(POINTS) and v not in walls)

    def wall(self, marker):
        """Returns a subsegment with that marker."""
        return next(k for k, s in enumerate(self.segments) if s[2] == marker)

    def remove(self, triangles):
        """Also makes the boundary edges subsegments, as a careless mesher would."""
        self.triangles = [c for t, c in enumerate(self.triangles) if t not in triangles]
        self.attributes = [a for t, a in enumerate(self.attributes) if t not in triangles]
        self.list_border()

    def list_border(self):
        edges, used = self.edges(), {v for c in self.triangles for v in c}
        there = {frozenset(e) for e in edges}
        self.neighbors = None
        self.segments = [s for s in self.segments if frozenset(s[:2]) in there and set(s[:2]) <= used]
        walls = {frozenset(s[:2]) for s in self.segments}
        self.segments += [[a, b, 1] for a, b in edges if (b, a) not in edges and frozenset((a, b)) not in walls]

    def write(self, base):
        write(base, ".node", [f"{len(self.points)} 2 0 1"], self.points)
        attributes = self.attributes + [0.0] * (len(self.triangles) - len(self.attributes))
        write(base, ".ele", [f"{len(self.triangles)} 3 1"], [[*c, a] for c, a in zip(self.triangles, attributes)])
        pathlib.Path(base + ".neigh").unlink(missing_ok=True)
        if self.neighbors is not None:
            write(base, ".neigh", [f"{len(self.neighbors)} 3"], self.neighbors)
        write(base, ".poly", ["0 2 0 1", f"{len(self.segments)} 1"], self.segments, ["0"])
        write_input(base + "_input", self.input_points, self.input_segments, self.holes)


def numbers(base, suffix):
    lines = (line.split("#")[0].split() for line in pathlib.Path(base + suffix).read_text().splitlines())
    return [words for words in lines if words]


def rows(base, suffix):
    return [words[1:] for words in numbers(base, suffix)[1:]]


def write(base, suffix, head, table, tail=()):
    lines = [" ".join([str(i)] + [repr(x) for x in row]) for i, row in enumerate(table)]
    pathlib.Path(base + suffix).write_text("\n".join([*head, *lines, *tail]) + "\n")


def write_input(base, points, segments, holes):
    lines = [f"{len(points)} 2 0 1"] + [f"{i} {p[0]!r} {p[1]!r} {p[2]}" for i, p in enumerate(points)]
    lines += [f"{len(segments)} 1"] + [f"{i} {s[0]} {s[1]} {s[2]}" for i, s in enumerate(segments)]
    lines += [str(len(holes))] + [f"{i} {h[0]!r} {h[1]!r}" for i, h in enumerate(holes)]
    lines += [str(len(REGIONS))] + [f"{i} {r[0]!r} {r[1]!r} {r[2]} -1" for i, r in enumerate(REGIONS)]
    pathlib.Path(base + ".poly").write_text("\n".join(lines) + "\n")


# --- ways to damage a mesh: each returns None, or further options for the checker

MUTATIONS = []


def mutation(kind):
    def note(function):
        MUTATIONS.append((kind, function))
        return function
    return note


@mutation("boundary is subsegments")
def triangle_dropped(m):
    t = m.inner()
    m.triangles.pop(t)
    m.attributes.pop(t)
    m.neighbors = None


@mutation("boundary along the input")
def triangle_dropped_and_its_edges_listed(m):
    m.remove({m.inner()})


@mutation("boundary along the input")
def triangle_at_the_boundary_dropped(m):
    edges = m.edges()
    m.remove({next(t for e, t in edges.items() if e[::-1] not in edges)})


@mutation("edges in pairs")
def triangle_twice(m):
    m.triangles.append(list(m.triangles[m.inner()]))
    m.neighbors = None


@mutation("orientation")
def triangle_clockwise(m):
    m.triangles[5].reverse()


@mutation("edges in pairs")
def triangle_clockwise_seen_by_its_edges(m):
    m.triangles[m.inner()].reverse()


@mutation("orientation")
def corner_twice(m):
    m.triangles[21][1] = m.triangles[21][0]


@mutation("orientation")
def vertex_moved_across_an_edge(m):
    v = m.free()
    t = next(t for t, c in enumerate(m.triangles) if v in c)
    for k in (0, 1):
        m.points[v][k] = sum(p[k] for p in m.corners(t)) - 2 * m.points[v][k]


@mutation("orientation")
def vertex_moved_onto_an_edge(m):
    v = m.free()
    a, b = (m.points[u] for u in next(c for c in m.triangles if v in c) if u != v)
    m.points[v][:2] = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2]


@mutation("orientation")
def vertex_at_another_vertex(m):
    v = m.free()
    a = next(u for u in next(c for c in m.triangles if v in c) if u != v)
    m.points[v][:2] = m.points[a][:2]


@mutation("input vertices")
def input_vertex_moved_by_an_ulp(m):
    m.points[8][0] = math.nextafter(m.points[8][0], 7)


@mutation("input vertices")
def input_vertices_swapped_in_number(m):
    m.points[8], m.points[9] = m.points[9], m.points[8]
    m.triangles = [[{8: 9, 9: 8}.get(v, v) for v in c] for c in m.triangles]
    m.segments = [[{8: 9, 9: 8}.get(s[0], s[0]), {8: 9, 9: 8}.get(s[1], s[1]), s[2]] for s in m.segments]


@mutation("input segments")
def vertex_moved_off_its_segment(m):
    v = next(v for s in m.segments if s[2] == 7 for v in s[:2] if v >= len(POINTS))
    m.points[v][1] += 1e-12


@mutation("segment markers")
def marker_of_another_segment(m):
    m.segments[m.wall(7)][2] = 4


@mutation("segment markers")
def marker_lost(m):
    m.segments[m.wall(7)][2] = 0


@mutation("segment markers")
def marker_of_the_boundary_lost(m):
    m.segments[m.wall(1)][2] = 0


@mutation("vertex markers")
def inner_vertex_marked(m):
    m.points[m.free()][2] = 1


@mutation("vertex markers")
def own_marker_lost(m):
    m.points[8][2] = 7


@mutation("vertex markers")
def marker_of_a_boundary_vertex_lost(m):
    m.points[2][2] = 0


@mutation("vertex markers")
def marker_on_a_segment_lost(m):
    m.points[9][2] = 0


@mutation("input segments")
def inner_subsegment_missing(m):
    m.segments.pop(m.wall(7))


@mutation("input segments")
def inner_segment_missing(m):
    m.segments = [s for s in m.segments if s[2] != 7]


@mutation("boundary is subsegments")
def boundary_subsegment_missing(m):
    m.segments.pop(m.wall(2))


@mutation("subsegments are edges")
def subsegment_twice(m):
    m.segments.append(list(m.segments[3]))


@mutation("subsegments are edges")
def subsegment_across(m):
    m.segments.append([0, 2, 0])


@mutation("subsegments are edges")
def subsegment_at_one_vertex(m):
    m.segments.append([2, 2, 0])


@mutation("neighbors")
def neighbor_wrong(m):
    m.neighbors[3][0] = (m.neighbors[3][0] + 7) % len(m.triangles)


@mutation("neighbors")
def neighbors_swapped(m):
    n = m.neighbors[m.inner()]
    n[0], n[1] = n[1], n[0]


@mutation("neighbors")
def neighbor_lost(m):
    m.neighbors[m.inner()][2] = -1


@mutation("neighbors")
def corners_turned_but_not_the_neighbors(m):
    c = m.triangles[m.inner()]
    c.append(c.pop(0))


@mutation("holes")
def hole_filled(m):
    center, border = len(m.points), {e for e in m.edges() if e[::-1] not in m.edges()}
    m.points.append([4.0, 4.0, 0])
    m.triangles += [[b, a, center] for a, b in border if all(3 <= x <= 5 for v in (a, b) for x in m.points[v][:2])]
    m.neighbors = None


@mutation("boundary along the input")
def hole_extended(m):
    edges = m.edges()
    m.remove({next(t for (a, b), t in edges.items() if (b, a) not in edges and
                   all(3 <= x <= 5 for v in (a, b) for x in m.points[v][:2]))})


@mutation("no unexpected holes")
def face_emptied(m):
    m.remove({t for t in range(len(m.triangles)) if m.in_face(t)})


@mutation("no unexpected holes")
def face_cut_off_with_its_outer_segments(m):
    m.remove({t for t in range(len(m.triangles)) if m.in_corner(t)})


@mutation("no unexpected holes")
def outline_beside_the_others_lost(m):
    n = len(m.input_points)
    m.input_points += [[20.0, 0.0, 0], [21.0, 0.0, 0], [20.0, 1.0, 0]]
    m.input_segments += [[n, n + 1, 0], [n + 1, n + 2, 0], [n + 2, n, 0]]


@mutation("vertex markers")
def inner_vertex_marked_while_refining(m):
    m.points[m.free()][2] = 1
    return ["--refined"]


@mutation("regions")
def attribute_of_one_triangle_changed(m):
    m.attributes[m.inner()] += 1


@mutation("regions")
def attribute_of_a_face_lost(m):
    m.attributes = [0.0 if m.in_corner(t) else a for t, a in enumerate(m.attributes)]


@mutation("regions")
def attribute_of_the_first_of_two_points(m):
    m.attributes = [1.0 if m.in_face(t) else a for t, a in enumerate(m.attributes)]


@mutation("regions")
def attribute_where_no_region_is(m):
    m.attributes = [a if m.in_face(t) or m.in_corner(t) else 3.0 for t, a in enumerate(m.attributes)]


@mutation("boundary is subsegments")
def triangle_outside(m):
    m.points.append([5.0, -1.0, 0])
    a, b = m.segments[m.wall(2)][:2]
    a, b = (a, b) if (a, b) in m.edges() else (b, a)
    m.triangles.append([b, a, len(m.points) - 1])
    m.neighbors = None


@mutation("boundary along the input")
def triangle_outside_and_listed(m):
    triangle_outside(m)
    m.list_border()


@mutation("no overlap")
def mesh_twice(m):
    n = len(m.points)
    m.points += [[x + 0.3, y + 0.2, k] for x, y, k in m.points]
    m.triangles += [[v + n for v in c] for c in m.triangles]
    m.segments += [[a + n, b + n, k] for a, b, k in m.segments]
    m.neighbors = None


@mutation("no overlap")
def torn_at_a_vertex(m):
    """A triangle at a boundary vertex gets a copy of the vertex."""
    v = m.segments[m.wall(1)][0]
    t = next(t for t, c in enumerate(m.triangles) if v in c)
    m.points.append(list(m.points[v]))
    m.triangles[t] = [len(m.points) - 1 if u == v else u for u in m.triangles[t]]
    m.list_border()


@mutation("Delaunay")
def edge_flipped(m):
    """Returns the first edge whose quadrilateral is strictly convex."""
    edges, walls = m.edges(), {frozenset(s[:2]) for s in m.segments}

    def turn(p, q, r):
        (ax, ay), (bx, by), (cx, cy) = (m.points[v][:2] for v in (p, q, r))
        return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    for (a, b), t in edges.items():
        if (b, a) not in edges or frozenset((a, b)) in walls:
            continue
        s = edges[b, a]
        c, d = sum(m.triangles[t]) - a - b, sum(m.triangles[s]) - a - b
        if turn(a, d, c) > 1e-6 and turn(d, b, c) > 1e-6:
            m.triangles[t], m.triangles[s], m.neighbors = [a, d, c], [d, b, c], None
            return


@mutation("diametral circles")
def bound_of_a_segment_not_kept(m):
    return ["--conforming"]


@mutation("convex hull")
def hole_in_what_should_be_convex(m):
    return ["--convex"]


@mutation("areas")
def area_above_the_bound(m):
    return ["-a", repr(largest(m) * (1 - 1e-9))]


@mutation("angles")
def angle_below_the_bound(m):
    return ["-q", repr(smallest(m) + 1e-6), "--small-input-angle", "1"]


@mutation("input vertices")
def point_of_the_input_missing(m):
    m.input_points.append([7.0, 5.125, 0])


@mutation("no lost vertices")
def point_of_the_input_lost(m):
    m.input_points.append([7.0, 5.125, 0])
    return ["--jettisoned"]


@mutation("input segments")
def segment_of_the_input_missing(m):
    m.input_segments.append([8, 14, 0])


@mutation("holes")
def hole_of_the_input_missing(m):
    m.holes.append([1.0, 1.0])


@mutation("no unexpected holes")
def hole_that_the_input_has_not(m):
    m.holes.clear()


def largest(m):
    areas = []
    for t in range(len(m.triangles)):
        (ax, ay), (bx, by), (cx, cy) = m.corners(t)
        areas.append(((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / 2)
    return max(areas)


def smallest(m):
    def angle(p, q, r):
        u, v = math.atan2(q[1] - p[1], q[0] - p[0]), math.atan2(r[1] - p[1], r[0] - p[0])
        return math.degrees((v - u) % (2 * math.pi))
    return min(angle(c[k], c[k - 2], c[k - 1]) for c in map(m.corners, range(len(m.triangles))) for k in range(3))


def faults(binaries, base, options):
    """Returns the names of the kinds of fault found, or None if the files were refused."""
    command = [binaries / "trianglecheck", base, "--poly", base + "_input.poly", *options]
    run, again = (subprocess.run(command + more, capture_output=True, text=True, timeout=60)
                  for more in ([], ["--memory", "1", "--scratch", pathlib.Path(base).parent]))
    if (run.returncode, run.stdout) != (again.returncode, again.stdout):
        return [f"one thing in memory:\n{run.stdout}another in parts:\n{again.stdout}{again.stderr}"]
    if run.returncode == 2:
        return None
    return [line[4:].split(":")[0].strip() for line in run.stdout.splitlines() if line.startswith("FAIL")]


def main():
    binaries, failures = pathlib.Path(sys.argv[1]).resolve(), 0
    with tempfile.TemporaryDirectory() as folder:
        base = str(pathlib.Path(folder) / "figure")
        write_input(base, POINTS, SEGMENTS, HOLES)
        subprocess.run([binaries / "triangle", "-zpqa0.8nAQ", base], check=True, timeout=60)
        sound = Mesh(base + ".1")
        for kind, change in [(None, lambda m: None), *MUTATIONS]:
            mesh = copy.deepcopy(sound)
            options = change(mesh) or []
            mesh.write(base + ".2")
            found = faults(binaries, base + ".2", options)
            if found == [] if kind is None else found and kind in found:
                continue
            failures += 1
            print(f"{change.__name__}: {kind or 'no fault'} expected, found {found}")
    print(f"{len(MUTATIONS)} mutations, {failures} not detected")
    return failures > 0


if __name__ == "__main__":
    sys.exit(main())
