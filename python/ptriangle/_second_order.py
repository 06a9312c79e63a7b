"""Second-order triangles. In a mesh of n points the midpoint of edge i becomes point n + i."""
from __future__ import annotations

from typing import Tuple

import numpy as np

from ._arrays import Array


def _keys(ends: Array) -> Array:
    """Returns one number for each edge, regardless of its direction."""
    low, high = np.sort(ends.astype(np.int64), axis=1).T
    return np.asarray(low << 32 | high)


def numbers_of(edges: Array, some: Array) -> Array:
    """Returns the index of each of `some` edges in the list of all."""
    keys = _keys(edges)
    order = np.argsort(keys)
    return order[np.searchsorted(keys, _keys(some), sorter=order)]


def with_middles(some: Array, edges: Array, n_points: int) -> Array:
    """Returns segments [s, 3]: two ends and the midpoint."""
    return np.column_stack([some, n_points + numbers_of(edges, some)]).astype(np.int32)


def triangles_of(triangles: Array, edges: Array, n_points: int) -> Array:
    """Returns triangles [m, 6]: corners a, b, c, then the midpoints of ab, bc and ca."""
    sides = [triangles[:, ends] for ends in ([0, 1], [1, 2], [2, 0])]
    middles = numbers_of(edges, np.concatenate(sides)).reshape(3, -1).T
    return np.column_stack([triangles, n_points + middles]).astype(np.int32)


def points_of(points: Array, attributes: Array, markers: Array, edges: Array,
              edge_markers: Array) -> Tuple[Array, Array, Array]:
    """Appends the midpoints to points, attributes and markers."""
    def behind(rows: Array) -> Array:
        return np.concatenate([rows, (rows[edges[:, 0]] + rows[edges[:, 1]]) / 2])
    return behind(points), behind(attributes), np.concatenate([markers, edge_markers])
