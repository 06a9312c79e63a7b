"""Measures how well a mesh meets sizes, and its value for a solver: size_judge.py BASE POLY H GROWTH.

Lengths are H at the segments of POLY and grow by GROWTH for a distance of 1. Prints JSON:

  quality   the mean of 4 sqrt(3) area / sum of squared edges
  wanted    triangles divided by the number of equilateral ones that the lengths request
  within    the share of edges that are 0.7 to 1.4 times as long as their length
  unknowns  of linear elements for Poisson's equation with u = sin(k x) sin(k y), u given on the boundary
  error     root mean square error over the domain
"""
import json
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import meshfiles  # noqa: E402
import numpy as np  # noqa: E402
from scipy.sparse import coo_matrix  # noqa: E402
from scipy.sparse.linalg import spsolve  # noqa: E402
from scipy.spatial import cKDTree  # noqa: E402

WAVES = 3  # periods of u across the larger side of the domain


def lengths(at, pslg, h, growth):
    """Target lengths at places, from points on the segments that are at most h / 4 apart."""
    if growth == 0:
        return np.full(len(at), h)
    a, b = np.array(pslg.points).reshape(-1, 2)[np.array(pslg.segments).reshape(-1, 2)].transpose(1, 0, 2)
    n = np.maximum(2, np.ceil(np.hypot(*(b - a).T) / (h / 4)).astype(int) + 1)
    share = np.concatenate([np.linspace(0, 1, k) for k in n])[:, None]
    places = np.repeat(a, n, axis=0) * (1 - share) + np.repeat(b, n, axis=0) * share
    return h + growth * cKDTree(places).query(at)[0]


def poisson(points, triangles, areas):
    """(unknowns, error) by three points in each triangle, exact for quadratic functions."""
    k = 2 * np.pi * WAVES / np.ptp(points, axis=0).max()

    def exact(at):
        return np.sin(k * at[..., 0]) * np.sin(k * at[..., 1])
    corners = points[triangles]
    opposite = np.roll(corners, -2, 1) - np.roll(corners, -1, 1)
    stiff = np.einsum("tik,tjk->tij", opposite, opposite) / (4 * areas[:, None, None])
    n = len(points)
    rows, columns = np.repeat(triangles, 3, axis=1).ravel(), np.tile(triangles, (1, 3)).ravel()
    matrix = coo_matrix((stiff.ravel(), (rows, columns)), (n, n)).tocsr()
    middles = (np.roll(corners, -1, 1) + np.roll(corners, -2, 1)) / 2
    source = 2 * k * k * exact(middles)  # at the midpoint opposite each corner, where the functions are 0, 1/2 and 1/2
    load = np.bincount(triangles.ravel(), ((source.sum(axis=1)[:, None] - source) / 6 * areas[:, None]).ravel(), n)
    edges = np.sort(np.concatenate([triangles[:, [1, 2]], triangles[:, [2, 0]], triangles[:, [0, 1]]]), axis=1)
    edges, times = np.unique(edges, axis=0, return_counts=True)
    free = np.ones(n, bool)
    free[edges[times == 1].ravel()] = False
    u = exact(points)
    u[free] = spsolve(matrix[free][:, free], load[free] - matrix[free][:, ~free] @ u[~free])
    at_middles = (np.roll(u[triangles], -1, 1) + np.roll(u[triangles], -2, 1)) / 2
    squared = ((at_middles - exact(middles)) ** 2).mean(axis=1) @ areas
    return int(free.sum()), float(np.sqrt(squared / areas.sum()))


def main():
    base, poly, h, growth = sys.argv[1], sys.argv[2], float(sys.argv[3]), float(sys.argv[4])
    mesh, pslg = meshfiles.read_mesh(base + ".node"), meshfiles.read(poly)
    if growth > 0 and not len(pslg.segments):
        sys.exit(f"{poly}: no segments, from which lengths could grow")
    triangles = np.array(mesh.triangles).reshape(-1, 3)
    used, triangles = np.unique(triangles, return_inverse=True)
    points, triangles = np.array(mesh.points).reshape(-1, 2)[used], triangles.reshape(-1, 3)
    corners = points[triangles]
    sides = np.roll(corners, -1, 1) - corners
    areas = (sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]) / 2
    quality = 4 * np.sqrt(3) * areas / (sides ** 2).sum(axis=(1, 2))
    wanted = (areas / (np.sqrt(3) / 4 * lengths(corners.mean(axis=1), pslg, h, growth) ** 2)).sum()
    ends = np.unique(np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
    a, b = points[ends[:, 0]], points[ends[:, 1]]
    ratio = np.hypot(*(b - a).T) / lengths((a + b) / 2, pslg, h, growth)
    unknowns, error = poisson(points, triangles, areas)
    print(json.dumps({"quality": float(quality.mean()), "wanted": len(triangles) / float(wanted),
                      "within": float(((ratio > 0.7) & (ratio < 1.4)).mean()), "unknowns": unknowns, "error": error}))


main()
