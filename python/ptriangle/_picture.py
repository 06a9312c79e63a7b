"""Pictures of meshes: as SVG for notebooks without any library, or on axes of matplotlib if it is installed."""
from __future__ import annotations

from typing import Any

import numpy as np

from ._arrays import Array

_WIDTH, _MOST_LINES = 480.0, 30000


def _path(ends: Array, style: str) -> str:
    numbers = np.round(ends.reshape(-1, 4), 1)
    return '<path d="%s" %s/>' % ("".join("M%g %gL%g %g" % tuple(line) for line in numbers.tolist()), style)


def svg(points: Array, edges: Array, segments: Array, caption: str) -> str:
    """Returns all edges; in a large mesh only segments; if there are very many, every second, third, ... of them."""
    used = points[np.unique(np.concatenate([edges, segments]))] if len(edges) + len(segments) else points[:0]
    low, high = (used.min(axis=0), used.max(axis=0)) if len(used) else (np.zeros(2), np.ones(2))
    width, height = np.maximum(high - low, 1e-300)
    scale = _WIDTH / max(width, height)
    at = (points - [low[0], high[1]]) * [scale, -scale] + 4
    parts = []
    if len(edges) <= _MOST_LINES:
        parts.append(_path(at[edges], 'stroke="#8aa4c8" stroke-width="0.5" fill="none"'))
    some = segments[::1 + len(segments) // _MOST_LINES]
    parts.append(_path(at[some], 'stroke="#1f3b66" stroke-width="1" fill="none"'))
    box = "%.1f %.1f" % (max(width * scale, 160) + 8, height * scale + 28)
    text = '<text x="4" y="%.1f" font-family="sans-serif" font-size="12" fill="#555">%s</text>' % (
        height * scale + 22, caption)
    return '<svg xmlns="http://www.w3.org/2000/svg" width="%s" height="%s" viewBox="0 0 %s">%s%s</svg>' % (
        *box.split(), box, "".join(parts), text)


def plot(points: Array, triangles: Array, segments: Array, ax: Any, color: Any, segment_color: Any,
         linewidth: float) -> Any:
    try:
        import matplotlib.pyplot as plt
        from matplotlib.collections import LineCollection
    except ImportError:
        raise ImportError("plot() needs matplotlib: pip install matplotlib") from None
    if ax is None:
        ax = plt.gca()
    if len(triangles):
        ax.triplot(points[:, 0], points[:, 1], triangles, color=color, linewidth=linewidth)
    if segment_color is not None:
        ax.add_collection(LineCollection(list(points[segments]), colors=segment_color, linewidths=2 * linewidth))
    ax.set_aspect("equal")
    ax.autoscale_view()
    return ax
