"""The union of polygons that may overlap.

All rings are triangulated at once, with points at their crossings. The segments divide the plane into faces. A face
lies in a polygon if one of its points does. The outline of these faces is the outline of the union. It consists of
points of the triangulation, so no crossing is computed twice.
"""
from __future__ import annotations

from typing import List, Optional, Tuple

import numpy as np

from ._arrays import Array
from ._notes import warn
from ._rings import Polygon, areas_of

_MOST = 1 << 22  # pairs of points and edges in one step


def is_among(some: Array, segments: Array) -> Array:
    """Returns which of the pairs of points are segments, in either direction."""
    def keys(pairs: Array) -> Array:
        low, high = np.sort(pairs.astype(np.int64), axis=1).T
        return np.asarray(low << 32 | high)
    return np.isin(keys(some), keys(segments))


def faces_of(neighbors: Array, walls: Array) -> Array:
    """Returns the face of each triangle, named by one of its triangles. walls [m, 3]: which edges are segments."""
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
    """Returns which places lie in a ring, by the even-odd rule."""
    x, y = places[:, :1], places[:, 1:]
    a, b = ring, np.roll(ring, -1, axis=0)
    up = (a[:, 1] <= y) != (b[:, 1] <= y)
    side = (b[:, 0] - a[:, 0]) * (y - a[:, 1]) - (x - a[:, 0]) * (b[:, 1] - a[:, 1])
    return np.asarray(np.count_nonzero(up & ((side > 0) == (b[:, 1] > a[:, 1])), axis=1) % 2 == 1)


def _is_inside(places: Array, polygon: Polygon) -> Array:
    """Returns which places lie in a polygon: in its first ring, and in none of the others, its holes."""
    inside = _is_enclosed(places, polygon[0])
    for hole in polygon[1:]:
        inside[inside] = ~_is_enclosed(places[inside], hole)
    return inside


def last_around(places: Array, polygons: List[Polygon]) -> Array:
    """Returns the last of the polygons that contain each place; -1 if there is none."""
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
    """Returns which places lie in at least one of the polygons."""
    return last_around(places, polygons) >= 0


def _inlay_of(polygons: List[Polygon]) -> Optional[Tuple[int, int]]:
    """Finds a polygon that has all its corners in another one. Returns both, or None. Only the first thousand are
    searched as outer polygons."""
    places = np.array([polygon[0][0] if polygon and len(polygon[0]) else (np.nan, np.nan) for polygon in polygons])
    for k, polygon in enumerate(polygons[:1000]):
        for found in np.nonzero(inside_any(places, [polygon]))[0].tolist():
            if found != k and inside_any(polygons[found][0], [polygon]).all():
                return found, k
    return None


def warn_of_overlaps(polygons: List[Polygon], meshed: float, who: str) -> None:
    """Warns of overlaps if the areas of the polygons do not add up to the area that the even-odd rule has meshed."""
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
    """Returns for each triangle the largest triangle of its face."""
    order = np.lexsort((areas, label))
    last = np.append(label[order][1:] != label[order][:-1], True)
    largest = np.empty(len(label), int)
    largest[label[order][last]] = order[last]
    return largest[label]


def outline_of(points: Array, triangles: Array, neighbors: Array, walls: Array,
               polygons: List[Polygon]) -> Tuple[Array, Array]:
    """Returns points and segments of the border of the union, from a triangulation of all rings and their convex
    hull."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    areas = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    witness = largest_of(faces_of(neighbors, walls), areas)
    asked, of = np.unique(witness, return_inverse=True)
    inside = inside_any(((a + b + c) / 3)[asked], polygons)[of]
    outside_there = ~np.append(inside, False)[neighbors]  # index -1, no neighbor, is the last entry
    triangle, corner = np.nonzero(inside[:, None] & outside_there)
    ends = np.column_stack([triangles[triangle, (corner + 1) % 3], triangles[triangle, (corner + 2) % 3]])
    used, segments = np.unique(ends, return_inverse=True)
    return points[used], segments.reshape(-1, 2)
