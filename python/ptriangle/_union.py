"""The union of polygons that may overlap.

All rings are triangulated at once, with points where they cross. What the segments divide the plane into are faces:
each lies in a polygon or not, as one point of it does. The outline of the faces that do is the union, made of points
that there are: nothing is computed twice in different ways.
"""
from __future__ import annotations

from typing import List, Optional, Tuple

import numpy as np

from ._arrays import Array
from ._notes import warn
from ._rings import Polygon, areas_of

_MOST = 1 << 22  # pairs of points and edges that are looked at together


def is_among(some: Array, segments: Array) -> Array:
    """Which of some pairs of points are segments, in either direction."""
    def keys(pairs: Array) -> Array:
        low, high = np.sort(pairs.astype(np.int64), axis=1).T
        return np.asarray(low << 32 | high)
    return np.isin(keys(some), keys(segments))


def faces_of(neighbors: Array, walls: Array) -> Array:
    """The face of each triangle, known by a triangle of it. walls [m, 3]: which edges are segments."""
    label = np.arange(len(neighbors))
    triangle, corner = np.nonzero((neighbors >= 0) & ~walls)
    beside = neighbors[triangle, corner]
    while True:
        least = np.minimum(label[triangle], label[beside])
        differ = label[triangle] != label[beside]
        if not differ.any():
            return label
        for ends in (triangle, beside):
            np.minimum.at(label, label[ends[differ]], least[differ])
        while not np.array_equal(label, label[label]):
            label = label[label]


def _is_enclosed(places: Array, ring: Array) -> Array:
    """Which places lie in a ring, by the even-odd rule."""
    x, y = places[:, :1], places[:, 1:]
    a, b = ring, np.roll(ring, -1, axis=0)
    up = (a[:, 1] <= y) != (b[:, 1] <= y)
    side = (b[:, 0] - a[:, 0]) * (y - a[:, 1]) - (x - a[:, 0]) * (b[:, 1] - a[:, 1])
    return np.asarray(np.count_nonzero(up & ((side > 0) == (b[:, 1] > a[:, 1])), axis=1) % 2 == 1)


def _is_inside(places: Array, polygon: Polygon) -> Array:
    """Which places lie in the outline of a polygon, its first ring, and in none of its holes."""
    inside = _is_enclosed(places, polygon[0])
    for hole in polygon[1:]:
        inside[inside] = ~_is_enclosed(places[inside], hole)
    return inside


def last_around(places: Array, polygons: List[Polygon]) -> Array:
    """The last of the polygons that each place lies in; -1 if it lies in none."""
    found = np.full(len(places), -1)
    order = np.argsort(places[:, 0])
    x, y = places[order].T
    for number in range(len(polygons) - 1, -1, -1):
        polygon = polygons[number]
        if not polygon or len(polygon[0]) == 0:
            continue
        low, high = polygon[0].min(axis=0), polygon[0].max(axis=0)
        near = slice(np.searchsorted(x, low[0]), np.searchsorted(x, high[0], "right"))
        which = order[near][(y[near] >= low[1]) & (y[near] <= high[1])]
        which = which[found[which] < 0]
        step = max(1, _MOST // max(map(len, polygon)))
        for k in range(0, len(which), step):
            some = which[k:k + step]
            found[some[_is_inside(places[some], polygon)]] = number
    return found


def inside_any(places: Array, polygons: List[Polygon]) -> Array:
    """Which places lie in one of the polygons."""
    return last_around(places, polygons) >= 0


def _inlay_of(polygons: List[Polygon]) -> Optional[Tuple[int, int]]:
    """(a polygon all of whose corners lie in another one, that one), the first of the first thousand that has any."""
    places = np.array([polygon[0][0] if polygon and len(polygon[0]) else (np.nan, np.nan) for polygon in polygons])
    for k, polygon in enumerate(polygons[:1000]):
        for found in np.nonzero(inside_any(places, [polygon]))[0].tolist():
            if found != k and inside_any(polygons[found][0], [polygon]).all():
                return found, k
    return None


def warn_of_overlaps(polygons: List[Polygon], meshed: float, who: str) -> None:
    """By the areas: those of valid polygons that do not overlap add up to what the even-odd rule has meshed."""
    meant = float(areas_of(polygons).sum())
    rings = [ring for polygon in polygons for ring in polygon if len(ring)]
    rounding = sum(np.spacing(np.abs(ring).max()) * np.abs(ring - np.roll(ring, 1, axis=0)).sum() for ring in rings)
    if abs(meshed - meant) <= 1e-12 * areas_of([ring] for ring in rings).sum() + 4 * rounding:
        return
    inlay = _inlay_of(polygons) if len(polygons) > 1 else None
    if inlay:
        text = "polygon %d lies in polygon %d (counted from 0) and is a hole of it by the even-odd rule. If you mean " \
               "a hole, make it a ring of its polygon: [outline, hole]" % inlay
    elif len(polygons) > 1:
        text = "polygons overlap, or their rings are not those of valid polygons"
    else:
        text = "the rings are not those of a valid polygon: holes overlap or lie outside, or rings cross"
    warn("%s. The even-odd rule meshes an area of %g; union=True meshes what lies in any polygon" % (text, meshed), who)


def largest_of(label: Array, areas: Array) -> Array:
    """For each triangle, the largest of its face."""
    order = np.lexsort((areas, label))
    last = np.append(label[order][1:] != label[order][:-1], True)
    largest = np.empty(len(label), int)
    largest[label[order][last]] = order[last]
    return largest[label]


def outline_of(points: Array, triangles: Array, neighbors: Array, walls: Array,
               polygons: List[Polygon]) -> Tuple[Array, Array]:
    """Points and segments of the union's border, of a triangulation of all rings that fills their convex hull."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    areas = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    witness = largest_of(faces_of(neighbors, walls), areas)
    asked, of = np.unique(witness, return_inverse=True)
    inside = inside_any(((a + b + c) / 3)[asked], polygons)[of]
    outside_there = ~np.append(inside, False)[neighbors]  # -1, nobody, is the last
    triangle, corner = np.nonzero(inside[:, None] & outside_there)
    ends = np.column_stack([triangles[triangle, (corner + 1) % 3], triangles[triangle, (corner + 2) % 3]])
    used, segments = np.unique(ends, return_inverse=True)
    return points[used], segments.reshape(-1, 2)
