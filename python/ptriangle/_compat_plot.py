"""Draws meshes with matplotlib, like the package `triangle`: all given arrays are drawn."""
from __future__ import annotations

from typing import Any, Mapping, Tuple

import numpy as np


def _lines(ax: Any, ends: Any, **style: Any) -> None:
    from matplotlib.collections import LineCollection
    ax.add_collection(LineCollection(ends, **style))


def _rays(ax: Any, origins: Any, directions: Any) -> None:
    """Draws rays as long as the width of the figure."""
    length = np.ptp(np.asarray(ax.dataLim.get_points(), float)).max() if ax.has_data() else 1.0
    norms = np.linalg.norm(directions, axis=1, keepdims=True)
    tips = origins + length * directions / np.where(norms > 0, norms, 1)
    _lines(ax, np.stack([origins, tips], axis=1), colors="black", linestyles="dashed", linewidths=0.8)


def _numbers(ax: Any, places: Any, markers: Any) -> None:
    for (x, y), marker in zip(places, np.ravel(markers)):
        ax.annotate(str(int(marker)), (x, y), textcoords="offset points", xytext=(3, 3), fontsize=7)


def _triangles(ax: Any, at: Any, kw: Mapping[str, Any]) -> None:
    corners = np.asarray(kw["triangles"])[:, :3]
    ax.triplot(at[:, 0], at[:, 1], corners, color="black", linewidth=0.7)
    if "triangle_attributes" in kw:
        _numbers(ax, at[corners].mean(axis=1), np.asarray(kw["triangle_attributes"])[:, 0])


def plot(ax: Any, **kw: Any) -> None:
    """Draws on axes of matplotlib: the arrays of triangulate(), or those of voronoi() (vertices, edges, ray_origins and
    ray_directions)."""
    at = np.asarray(kw["vertices"], float)
    if "triangles" in kw:
        _triangles(ax, at, kw)
    if "edges" in kw and "triangles" not in kw:
        _lines(ax, at[np.asarray(kw["edges"])], colors="black", linewidths=0.8)
    if "segments" in kw:
        _lines(ax, at[np.asarray(kw["segments"])], colors="tab:red", linewidths=1.4)
    ax.plot(at[:, 0], at[:, 1], "o", color="tab:blue", markersize=3)
    if "holes" in kw:
        holes = np.asarray(kw["holes"], float)
        ax.plot(holes[:, 0], holes[:, 1], "x", color="tab:red", markersize=7)
    if "regions" in kw:
        regions = np.asarray(kw["regions"], float)
        _numbers(ax, regions[:, :2], regions[:, 2])
    if "ray_origins" in kw:
        _rays(ax, at[np.asarray(kw["ray_origins"])], np.asarray(kw["ray_directions"], float))
    ax.set_aspect("equal")
    ax.get_xaxis().set_visible(False)
    ax.get_yaxis().set_visible(False)


def _side_by_side(plt: Any, rows: int, columns: int, figures: Tuple[Any, Any], figsize: Tuple[float, float]) -> None:
    plt.figure(figsize=figsize)
    first = None
    for k, figure in enumerate(figures):
        first = plt.subplot(rows, columns, k + 1, sharex=first, sharey=first)
        plot(first, **figure)
    plt.tight_layout()


def compare(plt: Any, A: Any, B: Any, figsize: Tuple[float, float] = (6, 3)) -> None:
    """Draws two figures side by side."""
    _side_by_side(plt, 1, 2, (A, B), figsize)


def comparev(plt: Any, A: Any, B: Any, figsize: Tuple[float, float] = (3, 6)) -> None:
    """Draws two figures, one above the other."""
    _side_by_side(plt, 2, 1, (A, B), figsize)
