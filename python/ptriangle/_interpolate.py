"""Linear interpolation of scattered measurements, in their Delaunay triangulation, at the points of a mesh.

The search for each place walks from triangle to triangle, across the edge that the place is farthest beyond. All places
walk at once. In a Delaunay triangulation such walks end. A place outside has the value of the nearest place on the
border.
"""
from __future__ import annotations

from typing import Any, Tuple

import numpy as np

from ._arrays import Array

_INSIDE = -1e-12    # share of the area of a triangle that counts as zero
_FLAT = 1e-9        # height of a triangle, as a share of its longest edge, that counts as zero
_MOST = 1 << 15     # pairs of places and edges in one step: they fit in the cache of a core


def _shares(corners: Array, at: Array) -> Array:
    """Barycentric coordinates of places in triangles, [..., 3]. corners [..., 3, 2]; at [..., 2]"""
    to = corners - at[..., None, :]
    x, y = to[..., 0], to[..., 1]
    areas = np.roll(x, -1, -1) * np.roll(y, -2, -1) - np.roll(x, -2, -1) * np.roll(y, -1, -1)
    total = areas.sum(axis=-1, keepdims=True)
    return np.asarray(areas / np.where(total == 0, 1, total))


def _starts(centres: Array, at: Array) -> Array:
    """Returns a triangle near each place: its centre lies in the same cell of a grid, or in an earlier one."""
    low, high = centres.min(axis=0), centres.max(axis=0)
    n = max(1, int(np.sqrt(len(centres))))

    def cell(places: Array) -> Array:
        column = np.clip((places - low) / np.maximum(high - low, 1e-300) * n, 0, n - 1).astype(np.int64)
        return np.asarray(column[:, 0] * n + column[:, 1])
    order = np.argsort(cell(centres), kind="stable")
    return order[np.minimum(np.searchsorted(cell(centres)[order], cell(at)), len(order) - 1)]


def _rounding(points: Array, length: Any) -> Any:
    """Returns the distance from an edge of this length that counts as zero."""
    return _FLAT * length + 8 * np.spacing(np.abs(points).max())


def without_flat_rim(points: Array, triangles: Array, neighbors: Array) -> Tuple[Array, Array]:
    """Removes flat triangles, which rounding makes from points on a slanted line of the hull. A flat triangle is
    removed if its longest edge is in the hull, or belongs to another removed one. If all points lie on a line, no
    triangle remains. Returns triangles and neighbors."""
    edges = points[triangles[:, [2, 0, 1]]] - points[triangles[:, [1, 2, 0]]]
    length2, n, rows = (edges * edges).sum(axis=-1), len(triangles), np.arange(len(triangles))
    longest = length2.argmax(axis=1)
    length = np.sqrt(length2[rows, longest])
    areas2 = edges[:, 0, 0] * edges[:, 1, 1] - edges[:, 0, 1] * edges[:, 1, 0]
    flat = areas2 <= length * _rounding(points, length)
    up = np.append(np.where(flat, neighbors[rows, longest], rows), n)  # n: outside
    up[up < 0] = n
    for _ in range(n.bit_length()):
        up = up[up]
    kept = (up[:n] != n) & ~flat.all()
    number = np.append(np.where(kept, np.cumsum(kept) - 1, -1), -1)
    return triangles[kept], number[neighbors[kept]]


def _locate(corners: Array, neighbors: Array, at: Array) -> Tuple[Array, Array]:
    """Returns (the triangle of each place, whether the place is inside). Outside it is a triangle at the border."""
    triangle, inside = _starts(corners.mean(axis=1), at), np.ones(len(at), bool)
    walking = np.arange(len(at))
    for _ in range(len(corners)):  # except for rounding, no walk visits a triangle twice
        if len(walking) == 0:
            break
        shares = _shares(corners[triangle[walking]], at[walking])
        worst = shares.argmin(axis=1)
        arrived = shares[np.arange(len(walking)), worst] >= _INSIDE
        beyond = neighbors[triangle[walking], worst]
        inside[walking] = arrived | (beyond >= 0)
        goes_on = ~arrived & (beyond >= 0)
        triangle[walking[goes_on]] = beyond[goes_on]
        walking = walking[goes_on]
    return triangle, inside


def _onto_border(points: Array, border: Array, at: Array) -> Tuple[Array, Array, Array]:
    """Returns for each place (the nearest edge of the border [b, 2], the position on this edge from 0 to 1, the
    distance)."""
    a, (u, v) = points[border[:, 0]], (points[border[:, 1]] - points[border[:, 0]]).T
    length2 = u * u + v * v
    edge, share, distance = np.empty(len(at), int), np.empty(len(at)), np.empty(len(at))
    step = max(1, _MOST // len(border))
    for k in range(0, len(at), step):
        x, y = at[k:k + step, :1] - a[:, 0], at[k:k + step, 1:] - a[:, 1]
        shares = np.clip((x * u + y * v) / length2, 0, 1)
        distance2 = (x - shares * u) ** 2 + (y - shares * v) ** 2
        best = distance2.argmin(axis=1)
        rows = np.arange(len(best))
        edge[k:k + step], share[k:k + step] = best, shares[rows, best]
        distance[k:k + step] = np.sqrt(distance2[rows, best])
    return edge, share, distance


def interpolated(points: Array, triangles: Array, neighbors: Array, values: Array, at: Array) -> Tuple[Array, Array]:
    """Returns (values [k, ...] at places, which of them are inside up to rounding). values [n, ...] at the points."""
    corners = points[triangles]
    triangle, inside = _locate(corners, neighbors, at)
    shares = np.clip(_shares(corners[triangle], at), 0, 1)
    shares /= shares.sum(axis=1, keepdims=True)
    found = np.asarray(np.einsum("ij,ij...->i...", shares, values[triangles[triangle]]))
    outside, (beside, corner) = np.nonzero(~inside)[0], np.nonzero(neighbors < 0)
    border = np.column_stack([triangles[beside, (corner + 1) % 3], triangles[beside, (corner + 2) % 3]])
    edge, share, distance = _onto_border(points, border, at[outside])
    ends = np.column_stack([1 - share, share])
    found[outside] = np.einsum("ij,ij...->i...", ends, values[border[edge]])
    inside[outside] = distance <= _rounding(points, 4 * np.ptp(points))
    return found, inside
