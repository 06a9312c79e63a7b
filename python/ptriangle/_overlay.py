"""Polygons as regions of a map, in which later polygons cover earlier ones.

All borders are triangulated at once, so that the library finds crossings and overlaps. The segments divide the plane
into faces. A face belongs to the last polygon that contains the centroid of its largest triangle. A border remains if
the polygons on its sides differ. The same centroid is the seed of the face for the library, because it lies far from
all borders.
"""
from __future__ import annotations

from typing import Any, List, NamedTuple, Optional, Tuple

import numpy as np

from . import _rings, _union
from ._arrays import Array
from ._calls import Calls
from ._errors import InputError
from ._figure import figure_of
from ._library import Settings
from ._mesh import Mesh, made
from ._notes import warn

_NARROW = 1e-3  # share of the root of the mean area: narrower faces are probably not intended


class Overlay(NamedTuple):
    """A figure of regions. The attribute of a region is the number of its polygon, counted from 1."""

    points: Array           # [n, 2]
    segments: Array         # [s, 2]
    markers: Array          # [s] markers of given segments; 0 on borders of polygons
    holes: Array            # [h, 2] in gaps that polygons enclose
    seeds: Array            # [f, 2]
    owners: Array           # [f] the polygon of each seed


def arrangement(points: Array, segments: Array, markers: Array, calls: Calls) -> Tuple[Mesh, Array, Array]:
    """Returns the triangulation of the convex hull, with points at crossings; the edges opposite the corners,
    [m, 3, 2]; and which of them are segments, [m, 3]."""
    figure, kept = figure_of({"points": points, "segments": segments, "segment_markers": markers}, calls.who)
    whole = Mesh(made(figure, Settings(keep_hull=True), calls))
    del kept
    corners = whole.triangles
    sides = np.stack([corners[:, [1, 2]], corners[:, [2, 0]], corners[:, [0, 1]]], axis=1)
    return whole, sides, _union.is_among(sides.reshape(-1, 2), whole.segments).reshape(-1, 3)


def _snapped(polygons: List[_rings.Polygon], grid: float, who: str) -> Tuple[Array, Array]:
    """Returns points and segments of the rings, snapped to a grid."""
    try:
        import shapely  # type: ignore[import-untyped, import-not-found, unused-ignore]
    except ImportError:
        raise ImportError("%s: grid= needs shapely: pip install shapely" % who) from None
    rings = [shapely.LineString([*ring, ring[0]]) for polygon in polygons for ring in polygon if len(ring) > 1]
    lines = shapely.get_parts(shapely.unary_union(rings, grid_size=grid))
    points, line = shapely.get_coordinates(lines, return_index=True)
    first = np.nonzero(line[1:] == line[:-1])[0]
    return points, np.column_stack([first, first + 1])


class _Faces:
    """Faces between borders: for each triangle the owner (-1: none) and the face."""

    def __init__(self, whole: Mesh, walls: Array, kept: Array) -> None:
        """kept: edges that remain borders regardless of the owners of their sides."""
        self.whole, self.walls, self.kept, self.neighbors = whole, walls, kept, whole.neighbors
        self.owner = np.empty(0, int)

    def own(self, polygons: List[_rings.Polygon], item: Array) -> None:
        places = self.whole.points[self.whole.triangles].mean(axis=1)
        witness = _union.largest_of(_union.faces_of(self.neighbors, self.walls), self.whole.areas)
        asked, of = np.unique(witness, return_inverse=True)
        self.owner = np.append(item, -1)[_union.last_around(places[asked], polygons)][of]

    def merge(self) -> None:
        """Merges adjacent faces of the same owner. Returns their widths, and which of them are open to the outside."""
        self.borders = self.kept | (self.owner[:, None] != np.append(self.owner, -1)[self.neighbors])
        self.label = _union.faces_of(self.neighbors, self.borders)
        corners = self.whole.points[self.whole.triangles]
        self.lengths = np.hypot(*np.moveaxis(np.roll(corners, -1, 1) - np.roll(corners, -2, 1), 2, 0))
        n = len(self.label)
        perimeter = np.bincount(self.label, (self.lengths * self.borders).sum(axis=1), n)
        self.width = 2 * np.bincount(self.label, self.whole.areas, n) / np.where(perimeter > 0, perimeter, np.inf)
        self.open = np.zeros(n, bool)
        self.open[self.label[((self.neighbors < 0) & ~self.borders).any(axis=1)]] = True

    def absorb(self, width: float) -> None:
        """Gives faces no wider than this to the owner of the face with which they share the longest border."""
        thin = (self.width[self.label] <= width) & ~self.open[self.label]
        triangle, corner = np.nonzero(thin[:, None] & self.borders & ~self.kept & (self.neighbors >= 0))
        other = self.neighbors[triangle, corner]
        wide = ~thin[other]
        face, to, length = self.label[triangle[wide]], self.owner[other[wide]], self.lengths[triangle, corner][wide]
        pairs, of = np.unique(np.column_stack([face, to]), axis=0, return_inverse=True)
        order = np.argsort(np.bincount(of.reshape(-1), length, len(pairs)), kind="stable")
        heir = np.full(len(self.label), -2)
        heir[pairs[order, 0]] = pairs[order, 1]  # the longest is the last
        inherits = heir[self.label] > -2
        self.owner[inherits] = heir[self.label[inherits]]

    def warn_of_slivers(self, who: str, grid: Optional[float]) -> None:
        faces = np.unique(self.label)
        faces = faces[~self.open[faces]]
        areas = np.bincount(self.label, self.whole.areas, len(self.label))[faces]
        owned = self.owner[faces] >= 0
        limit = _NARROW * np.sqrt(areas[owned].mean()) if owned.any() else 0
        narrow = faces[self.width[faces] < limit]
        if len(narrow):
            least = narrow[self.width[narrow].argmin()]
            x, y = self.whole.points[self.whole.triangles[least]].mean(axis=0)
            warn("polygons: %d faces are narrower than %.3g: polygons hardly overlap, or leave a gap. The narrowest is "
                 "about %.2g wide, at (%.12g, %.12g). %s" %
                 (len(narrow), limit, self.width[least], x, y, "A larger grid= snaps more borders together" if grid else
                  "grid=%.1g snaps borders to a grid" % (10 * self.width[narrow].max())), who)


def laid(points: Array, segments: Array, segment_markers: Optional[Array], items: List[List[_rings.Polygon]],
         grid: Optional[float], keep_hull: bool, calls: Calls) -> Overlay:
    """Returns the figure of the polygons of each item, together with given points and segments."""
    polygons, item = [p for parts in items for p in parts], np.repeat(np.arange(len(items)), list(map(len, items)))
    if grid is not None and not grid > 0:
        raise InputError("%s: grid: %r is not > 0" % (calls.who, grid))
    ring_points, ring_segments = _snapped(polygons, grid, calls.who) if grid else _rings.segments_of(polygons, 0)
    given = len(segments)
    every = np.concatenate([points, ring_points])
    # Given segments come first, so that of several along one line a given one marks the piece: by its number, plus 2.
    number = np.concatenate([np.arange(2, given + 2), np.zeros(len(ring_segments))]).astype(np.int32)
    whole, sides, walls = arrangement(every, np.concatenate([segments, ring_segments + len(points)]), number, calls)
    if len(whole.triangles) == 0:
        none = np.empty((0, 2))
        return Overlay(every, np.empty((0, 2), int), np.empty(0, np.int32), none, none, np.empty(0, int))
    pieces = whole.segment_markers >= 2
    corners, neighbors = whole.triangles, whole.neighbors
    faces = _Faces(whole, walls, _union.is_among(sides.reshape(-1, 2), whole.segments[pieces]).reshape(-1, 3))
    faces.own(polygons, item)
    faces.merge()
    faces.absorb(max(grid or 0, 16 * np.spacing(np.abs(every).max())))
    faces.merge()
    faces.warn_of_slivers(calls.who, grid)
    triangle, corner = np.nonzero(faces.borders & ~faces.kept & (neighbors < np.arange(len(neighbors))[:, None]))
    ends = np.concatenate([whole.segments[pieces], sides[triangle, corner]])
    used, ends = np.unique(ends, return_inverse=True)
    own = np.zeros(given, np.int32) if segment_markers is None else segment_markers
    markers = np.append(own[whole.segment_markers[pieces] - 2], np.zeros(len(triangle), np.int32)).astype(np.int32)
    seed = np.unique(_union.largest_of(faces.label, whole.areas))
    places, owners = whole.points[corners[seed]].mean(axis=1), faces.owner[seed]
    gaps = (owners < 0) & ~faces.open[faces.label[seed]] & (not keep_hull)
    return Overlay(np.concatenate([points, whole.points[used]]), ends.reshape(-1, 2) + len(points), markers,
                   places[gaps], places[owners >= 0], owners[owners >= 0])


def background(overlay: Overlay, sizes: Array, calls: Calls) -> Optional[Tuple[Array, Array, Array]]:
    """Returns a size field from a length for each polygon: a mesh with the least length of the polygons around each
    point. Its edges are at most about three times as long."""
    known = np.isfinite(sizes) & (sizes > 0)
    if not known[overlay.owners].any():
        return None
    areas = np.where(known, 2 * np.sqrt(3) * sizes ** 2, 0)[overlay.owners]
    figure, kept = figure_of({"points": overlay.points, "segments": overlay.segments, "holes": overlay.holes,
                              "regions": regions(overlay, areas)}, calls.who)
    coarse = Mesh(made(figure, Settings(min_angle=10), calls))
    del kept
    of = coarse.triangle_attributes[:, 0].astype(int) - 1
    lengths = np.append(np.where(known, sizes, np.inf), np.inf)[of]
    values = np.full(len(coarse.points), np.inf)
    np.minimum.at(values, coarse.triangles, lengths[:, None])
    return coarse.points, coarse.triangles, values


def regions(overlay: Overlay, areas: Any) -> Array:
    """Returns the rows of regions for the library: place, attribute, largest area (0: no bound)."""
    return np.column_stack([overlay.seeds, overlay.owners + 1, np.broadcast_to(areas, len(overlay.seeds))])
