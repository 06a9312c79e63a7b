"""Linear interpolation in a Delaunay triangulation: of scattered measurements onto the points of a mesh.

Each place walks from triangle to triangle, across the edge that it lies farthest behind, all of them at once. In a
Delaunay triangulation such walks end. Rounding may catch one between flat triangles; it is then compared with all.
"""
from __future__ import annotations

from typing import Tuple

import numpy as np

from ._arrays import Array

_INSIDE = -1e-12    # a share of a triangle's area that counts as none
_MOST = 1 << 22     # pairs of places and triangles or edges that are looked at together


def _shares(corners: Array, at: Array) -> Array:
    """Barycentric coordinates of places in triangles, [..., 3]. corners [..., 3, 2]; at [..., 2]"""
    to = corners - at[..., None, :]
    x, y = to[..., 0], to[..., 1]
    areas = np.roll(x, -1, -1) * np.roll(y, -2, -1) - np.roll(x, -2, -1) * np.roll(y, -1, -1)
    total = areas.sum(axis=-1, keepdims=True)
    return np.asarray(areas / np.where(total == 0, 1, total))


def _starts(centres: Array, at: Array) -> Array:
    """A triangle near each place: one whose centre lies in the same cell of a grid, or before it."""
    low, high = centres.min(axis=0), centres.max(axis=0)
    n = max(1, int(np.sqrt(len(centres))))

    def cell(places: Array) -> Array:
        column = np.clip((places - low) / np.maximum(high - low, 1e-300) * n, 0, n - 1).astype(np.int64)
        return np.asarray(column[:, 0] * n + column[:, 1])
    order = np.argsort(cell(centres), kind="stable")
    return order[np.minimum(np.searchsorted(cell(centres)[order], cell(at)), len(order) - 1)]


def _best_of_all(corners: Array, at: Array) -> Array:
    """The triangle in which each place lies, or nearly so, by looking at all."""
    step = max(1, _MOST // len(corners))
    parts = [np.argmax(_shares(corners[None], at[k:k + step, None]).min(axis=-1), axis=1)
             for k in range(0, len(at), step)]
    return np.concatenate(parts)


def locate(corners: Array, neighbors: Array, at: Array) -> Tuple[Array, Array]:
    """(the triangle of each place, is it inside). Outside it is a triangle at the border."""
    triangle, inside = _starts(corners.mean(axis=1), at), np.zeros(len(at), bool)
    walking = np.arange(len(at))
    for _ in range(200 + 8 * int(np.sqrt(len(corners)))):
        if len(walking) == 0:
            return triangle, inside
        shares = _shares(corners[triangle[walking]], at[walking])
        worst = shares.argmin(axis=1)
        arrived = shares[np.arange(len(walking)), worst] >= _INSIDE
        beyond = neighbors[triangle[walking], worst]
        inside[walking[arrived]] = True
        goes_on = ~arrived & (beyond >= 0)
        triangle[walking[goes_on]] = beyond[goes_on]
        walking = walking[goes_on]
    triangle[walking], inside[walking] = _best_of_all(corners, at[walking]), True
    return triangle, inside


def onto_border(points: Array, border: Array, at: Array) -> Array:
    """The nearest place of the border [b, 2] to each of some places."""
    a, along = points[border[:, 0]], points[border[:, 1]] - points[border[:, 0]]
    length2 = (along * along).sum(axis=1)
    step, found = max(1, _MOST // len(border)), [np.empty((0, 2))]
    for k in range(0, len(at), step):
        some = at[k:k + step, None]
        share = np.clip(((some - a) * along).sum(axis=-1) / length2, 0, 1)
        nearest = a + share[..., None] * along
        best = ((some - nearest) ** 2).sum(axis=-1).argmin(axis=1)
        found.append(nearest[np.arange(len(best)), best])
    return np.concatenate(found)


def interpolated(corners: Array, values: Array, triangle: Array, at: Array) -> Array:
    """Values [k, ...] of places in triangles. values [t, 3, ...] at the corners."""
    shares = np.clip(_shares(corners[triangle], at), 0, 1)
    shares /= shares.sum(axis=1, keepdims=True)
    return np.asarray(np.einsum("ij,ij...->i...", shares, values[triangle]))
