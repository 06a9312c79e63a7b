#!/usr/bin/env python3
"""Makes data/coast/ from Natural Earth (public domain) as packed in the npm package world-atlas 2.0.2.

  npm pack world-atlas@2.0.2 && tar xzf world-atlas-2.0.2.tgz
  python3 tools/make_coast.py package [data/coast]

Uses only the standard library. TopoJSON arcs are decoded, projected by a stereographic projection (conformal) about the
middle of the region and rounded to whole metres. So every test below is exact, and every coordinate is exact in the
file. Rounding can make rings touch. The planar arrangement of all segments is computed, edges that occur an even number
of times (spikes of zero width) are removed, and each face is classified as land or sea by the parity of the rings
around it. The output is therefore a valid PSLG without crossings, vertices on other segments, or duplicates, which is
asserted.
"""
import json
import math
import os
import sys
from fractions import Fraction

import pslg_facts

EARTH_RADIUS = 6371000.0  # metres


# --- TopoJSON

class Topology:
    def __init__(self, path):
        with open(path, encoding="utf-8") as stream:
            self.content = json.load(stream)
        (kx, ky), (tx, ty) = self.content["transform"]["scale"], self.content["transform"]["translate"]
        self.arcs = []
        for arc in self.content["arcs"]:
            x = y = 0
            points = []
            for dx, dy in arc:
                x, y = x + dx, y + dy
                points.append((tx + kx * x, ty + ky * y))
            self.arcs.append(points)

    def rings(self, name):
        """Yields (properties with id, ring as a list of signed arc indices)."""
        for geometry in self.content["objects"][name]["geometries"]:
            about = dict(geometry.get("properties") or {}, id=geometry.get("id"))
            polygons = geometry["arcs"] if geometry["type"] == "MultiPolygon" else [geometry["arcs"]]
            for polygon in polygons:
                for ring in polygon:
                    yield about, ring

    def points(self, ring):
        """The ring's points in degrees; the first is not repeated at the end."""
        result = []
        for index in ring:
            arc = self.arcs[index] if index >= 0 else self.arcs[~index][::-1]
            result.extend(arc[:-1])
        return result


def stereographic(longitude, latitude):
    """Projection about the given centre (degrees) to whole metres; conformal."""
    sin0, cos0 = math.sin(math.radians(latitude)), math.cos(math.radians(latitude))

    def project(point):
        lon, lat = math.radians(point[0] - longitude), math.radians(point[1])
        sin1, cos1 = math.sin(lat), math.cos(lat)
        scale = 2 * EARTH_RADIUS / (1 + sin0 * sin1 + cos0 * cos1 * math.cos(lon))
        return (round(scale * cos1 * math.sin(lon)), round(scale * (cos0 * sin1 - sin0 * cos1 * math.cos(lon))))

    return project


# --- clipping

def clip_segment(a, b, box):
    """The part of a b inside the box, ends rounded to integers, or None. The box has integer sides."""
    t0, t1 = Fraction(0), Fraction(1)
    d = (b[0] - a[0], b[1] - a[1])
    for axis in (0, 1):
        low, high = box[axis], box[axis + 2]
        if d[axis] == 0:
            if not low <= a[axis] <= high:
                return None
            continue
        enter, leave = sorted((Fraction(low - a[axis], d[axis]), Fraction(high - a[axis], d[axis])))
        t0, t1 = max(t0, enter), min(t1, leave)
    if t0 >= t1:
        return None
    return tuple(a if t == 0 else b if t == 1 else tuple(round(a[i] + t * d[i]) for i in (0, 1)) for t in (t0, t1))


def box_outline(box, step):
    """Boundary of the box as a list of points, each side cut into pieces of about the given length."""
    x0, y0, x1, y1 = box
    m, n = max(1, round((x1 - x0) / step)), max(1, round((y1 - y0) / step))
    assert (x1 - x0) % m == 0 and (y1 - y0) % n == 0
    dx, dy = (x1 - x0) // m, (y1 - y0) // n
    return ([(x0 + k * dx, y0) for k in range(m)] + [(x1, y0 + k * dy) for k in range(n)] +
            [(x1 - k * dx, y1) for k in range(m)] + [(x0, y1 - k * dy) for k in range(n)])


def thin(points, least):
    """Drops points of a closed ring that are closer than `least` metres to the last one kept."""
    kept = []
    for p in points:
        if not kept or (p[0] - kept[-1][0]) ** 2 + (p[1] - kept[-1][1]) ** 2 >= least * least:
            kept.append(p)
    return kept


def ring_edges(points):
    return [(a, b) for a, b in zip(points, points[1:] + points[:1]) if a != b]


def parity(edges):
    """Edges that occur an odd number of times."""
    odd = set()
    for a, b in edges:
        odd ^= {(min(a, b), max(a, b))}
    return sorted(odd)


# --- faces

def clean(edges):
    """Arrangement whose nodes are all integers. Crossings are rounded and the arrangement is computed again, until none
    is left."""
    while True:
        points = sorted({p for edge in edges for p in edge})
        index = {p: i for i, p in enumerate(points)}
        graph = pslg_facts.Arrangement(points, [(index[a], index[b]) for a, b in edges])
        nodes = [(round(x), round(y)) for x, y in graph.nodes]
        again = sorted({(min(nodes[u], nodes[v]), max(nodes[u], nodes[v])) for u, v in graph.edges
                        if nodes[u] != nodes[v]})
        if not (graph.crossings or graph.touches or graph.repeated):
            return again
        print("    cleaned: %d crossings, %d touchings, %d repeated" %
              (graph.crossings, graph.touches, graph.repeated))
        edges = again


def inside(rings):
    """Test by parity: is the (rational) point inside an odd number of the rings?"""
    edges = [(a, b) if a[1] < b[1] else (b, a) for ring in rings for a, b in zip(ring, ring[1:] + ring[:1])
             if a[1] != b[1]]

    def test(point):
        crossed = sum(1 for a, b in edges if a[1] <= point[1] < b[1] and pslg_facts.orient(a, b, point) > 0)
        return crossed % 2 == 1

    return test


class Faces:
    """Faces of a clean edge set with one interior point each."""

    def __init__(self, edges):
        self.points = sorted({p for edge in edges for p in edge})
        index = {p: i for i, p in enumerate(self.points)}
        self.graph = pslg_facts.Arrangement(self.points, [(index[a], index[b]) for a, b in edges])
        assert not (self.graph.crossings or self.graph.touches or self.graph.repeated)
        self.sub = pslg_facts.Subdivision(self.graph)
        assert self.graph.nodes == self.points
        self.walks = [[] for _ in range(self.sub.n_faces)]
        for walk, face in zip(self.sub.walks, self.sub.face_of_walk):
            self.walks[face].append(walk)
        self.inner = [None] + [self.interior(f) for f in range(1, self.sub.n_faces)]

    def interior(self, face):
        """A point well inside the face: the midpoint of the longest chord on one of several horizontal lines, in
        halves."""
        pieces = [(self.points[a], self.points[b]) for walk in self.walks[face]
                  for a, b in zip(walk, walk[1:] + walk[:1])]
        low, high = (f(p[1] for p, _ in pieces) for f in (min, max))
        best = (0, None)
        for k in range(1, 16):
            y = (2 * low * (16 - k) + 2 * high * k) // 16 // 2 + Fraction(1, 2)
            cuts = sorted(a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]) for a, b in pieces
                          if (a[1] < y) != (b[1] < y))
            for left, right in zip(cuts[::2], cuts[1::2]):
                best = max(best, (right - left, (Fraction(round(left + right), 2), y)))
        assert best[1] is not None and self.sub.locate(best[1]) == face, "no interior point"
        return best[1]

    def area(self, face):
        return sum(self.sub.area2[k] for k, f in enumerate(self.sub.face_of_walk) if f == face) / 2

    def edges_between(self, classes):
        """Edges whose two sides have different classes."""
        side = [classes[f] for f in self.sub.face_of_walk]
        return [(self.points[u], self.points[v]) for u, v in self.graph.edges
                if side[self.sub.walk_of[u, v]] != side[self.sub.walk_of[v, u]]]


# --- writing

def number(value):
    return str(int(value)) if value == int(value) else repr(float(value))


def write(path, about, edges, marker_of, holes, regions):
    points = sorted({p for edge in edges for p in edge})
    index = {p: i + 1 for i, p in enumerate(points)}
    marker = {}
    for edge in edges:
        for p in edge:
            marker[p] = max(marker.get(p, 0), marker_of(edge))
    rows = ["# " + line for line in about]
    rows.append("%d 2 0 1" % len(points))
    rows += ["%d %d %d %d" % (index[p], p[0], p[1], marker[p]) for p in points]
    rows.append("%d 1" % len(edges))
    rows += ["%d %d %d %d" % (k + 1, index[a], index[b], marker_of((a, b))) for k, (a, b) in enumerate(edges)]
    rows.append("%d" % len(holes))
    rows += ["%d %s %s" % (k + 1, number(x), number(y)) for k, (x, y) in enumerate(holes)]
    rows.append("%d" % len(regions))
    rows += ["%d %s %s %s %s" % (k + 1, *map(number, r)) for k, r in enumerate(regions)]
    with open(path, "w", encoding="ascii", newline="\n") as stream:
        stream.write("\n".join(rows) + "\n")
    facts = pslg_facts.Facts(pslg_facts.read(path), "-p")
    assert facts.valid and 0 not in facts.hole_faces and len(set(facts.hole_faces)) == len(holes)
    assert len(set(facts.region_faces)) == len(regions) and not facts.eaten & set(facts.region_faces)
    print("  %s: %d vertices, %d segments, %d holes, %d regions, smallest angle %.3g, %d triangles, %d bytes" % (
        path, facts.vertices, len(edges), len(holes), len(regions), facts.smallest_angle, facts.triangles,
        os.path.getsize(path)))


# --- the maps

def make_sea(topology, path, about, centre, box, step, least, smallest):
    """Box minus land. Rings are thinned to segments of `least` metres. Land or sea faces below `smallest` m2 are
    removed."""
    project = stereographic(*centre)
    kept = []
    for _, ring in topology.rings("land"):
        points = [project(p) for p in topology.points(ring)
                  if abs(p[0] - centre[0]) < 60 and abs(p[1] - centre[1]) < 40]
        low, high = ([f(p[i] for p in points) for i in (0, 1)] if points else (None, None) for f in (min, max))
        if points and low[0] < box[2] and high[0] > box[0] and low[1] < box[3] and high[1] > box[1]:
            points = thin(points, least)
            if len(points) > 2:
                kept.append(points)
    outline = box_outline(box, step)
    edges = [piece for ring in kept for a, b in parity(ring_edges(ring)) for piece in [clip_segment(a, b, box)]
             if piece and piece[0] != piece[1]]
    faces = Faces(clean(edges + ring_edges(outline)))
    is_land = inside(kept)
    sea = [False] + [not is_land(p) for p in faces.inner[1:]]
    for face in range(1, faces.sub.n_faces):
        if faces.area(face) < smallest:
            sea[face] = not sea[face]
    # The largest connected sea is the domain. Lakes, isolated lagoons and land become one class.
    faces = Faces(faces.edges_between(sea))
    biggest = max(range(1, faces.sub.n_faces), key=faces.area)
    wet = [face == biggest for face in range(faces.sub.n_faces)]
    edges = faces.edges_between(wet)
    faces = Faces(edges)
    biggest = max(range(1, faces.sub.n_faces), key=faces.area)
    holes = [faces.inner[f] for f in range(1, faces.sub.n_faces) if f != biggest]

    def on_box(edge):
        return any(edge[0][i % 2] == edge[1][i % 2] == box[i] for i in range(4))

    write(path, about, edges, lambda edge: 2 if on_box(edge) else 1, holes, [])


def chosen_rings(topology, project, ids, smallest):
    """Rings (signed arc indices) of the countries with these codes. Rings of smaller extent are left out."""
    rings = {}
    for country, ring in topology.rings("countries"):
        if country["id"] in ids:
            xs, ys = zip(*map(project, topology.points(ring)))
            if max(max(xs) - min(xs), max(ys) - min(ys)) >= smallest:
                rings.setdefault(country["id"], []).append(ring)
    return rings


def thin_arc(points, least):
    """Like thin(), but both ends are kept, because other arcs meet there."""
    body = thin(points[:-1], least)
    while points[0] != points[-1] and len(body) > 1 and math.dist(body[-1], points[-1]) < least:
        body.pop()
    return body + [points[-1]]


def owners(faces, rings, arcs):
    """The country that each face belongs to, or None."""
    owner = [None] * faces.sub.n_faces
    for country in sorted(rings):
        outlines = [[p for index in ring for p in (arcs[index] if index >= 0 else arcs[~index][::-1])[:-1]]
                    for ring in rings[country]]
        test = inside(outlines)
        for face in range(1, faces.sub.n_faces):
            if test(faces.inner[face]):
                owner[face] = country
    return owner


def make_borders(topology, path, about, centre, ids, least):
    """Countries with shared borders as single segments; region attribute = ISO 3166-1 numeric code."""
    project = stereographic(*centre)
    rings = chosen_rings(topology, project, ids, 4 * least)
    used = {index if index >= 0 else ~index for country in rings.values() for ring in country for index in ring}
    arcs = {arc: thin_arc([project(p) for p in topology.arcs[arc]], least) for arc in used}
    faces = Faces(clean([(a, b) for points in arcs.values() for a, b in zip(points, points[1:]) if a != b]))
    # Thinning can make slivers that belong to no country or split one country: only true borders are kept.
    edges = faces.edges_between(owners(faces, rings, arcs))
    faces = Faces(edges)
    owner = owners(faces, rings, arcs)
    holes = [faces.inner[f] for f in range(1, faces.sub.n_faces) if owner[f] is None]
    regions = [(*faces.inner[f], int(owner[f]), round(faces.area(f) / 40)) for f in range(1, faces.sub.n_faces)
               if owner[f] is not None]
    regions.sort(key=lambda r: (r[2], -r[3]))
    coast = set(faces.edges_between([o is None for o in owner]))
    write(path, about, edges, lambda edge: 1 if edge in coast else 2, holes, regions)


AFRICA = """
012 024 072 108 120 132 140 148 174 175 178 180 204 226 231 232 262 266 270 288 324 384 404 426 430 434 450 454
466 478 480 504 508 516 562 566 624 638 646 654 678 686 690 694 706 710 716 728 729 732 748 768 788 800 818 834 854
894""".split()

SOURCE = "Natural Earth (public domain), from the npm package world-atlas 2.0.2"


def main(package, folder):
    os.makedirs(folder, exist_ok=True)
    fine = Topology(os.path.join(package, "land-10m.json"))
    make_sea(fine, os.path.join(folder, "norway_sea.poly"),
             ["Sea around Norway with its fjords; box minus land, islands are holes. Markers: 1 coast, 2 open sea.",
              "Stereographic projection about 14 E 65 N, whole metres. " + SOURCE + "."],
             (14, 65), (-560000, -840000, 720000, 800000), 40000, 300, 400000)
    make_sea(Topology(os.path.join(package, "land-50m.json")), os.path.join(folder, "islands.poly"),
             ["Sea around the British Isles; box minus land, islands are holes. Markers: 1 coast, 2 open sea.",
              "Stereographic projection about 4 W 55 N, whole metres. " + SOURCE + "."],
             (-4, 55), (-520000, -640000, 480000, 720000), 40000, 500, 1000000)
    make_borders(Topology(os.path.join(package, "countries-50m.json")), os.path.join(folder, "borders.poly"),
                 ["Countries of Africa; shared borders are internal segments. Markers: 1 coast, 2 border.",
                  "Region attribute = ISO 3166-1 numeric code, area bound in m2 = area of the region / 40.",
                  "Stereographic projection about 18 E 2 N, whole metres. " + SOURCE + "."],
                 (18, 2), AFRICA, 2000)


if __name__ == "__main__":
    here = os.path.dirname(os.path.abspath(__file__))
    main(sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else os.path.join(here, "..", "data", "coast"))
