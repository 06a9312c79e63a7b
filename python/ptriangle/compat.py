"""Replaces the package `triangle` (PyPI): import ptriangle.compat as triangle.

Dictionaries have the same keys, types and shapes. Meshes differ: ptriangle refines them on all cores. Other
differences: faults that end the interpreter in `triangle` are exceptions here. Invalid input (NaN, numbers of points
that do not exist) is an error or is skipped. Common mistakes give warnings. The switch u needs the argument
`unsuitable`.
"""
from __future__ import annotations

import os
from ctypes import byref, c_void_p, string_at
from typing import Any, Callable, Dict, List, Mapping, Optional, Set, Tuple, Union

import numpy as np

from . import _library as lib
from ._arrays import as_int32
from ._calls import Calls
from ._compat_files import ENDINGS, load, loads
from ._compat_plot import compare, comparev, plot
from ._errors import InputError, exception_of
from ._library import TriangulateIO, TriangulateOptions, library
from ._notes import EmptyMeshWarning, IgnoredWarning, tell, warn

__version__ = "20250106"  # version of the package `triangle` that this module replaces
__all__ = ["EmptyMeshWarning", "IgnoredWarning", "compare", "comparev", "convex_hull", "delaunay", "get_data", "load",
           "loads", "plot", "show_data", "triangulate", "voronoi"]

# key: (type, list in the struct, count in the struct, columns: a number, or the name of their count)
Arrays = Dict[str, Any]
_Fields = Dict[str, Tuple[Any, str, str, Union[int, str]]]
_FIELDS: _Fields = {
    "vertices": (np.float64, "pointlist", "numberofpoints", 2),
    "vertex_attributes": (np.float64, "pointattributelist", "numberofpoints", "numberofpointattributes"),
    "vertex_markers": (np.int32, "pointmarkerlist", "numberofpoints", 1),
    "triangles": (np.int32, "trianglelist", "numberoftriangles", "numberofcorners"),
    "triangle_attributes": (np.float64, "triangleattributelist", "numberoftriangles", "numberoftriangleattributes"),
    "triangle_max_area": (np.float64, "trianglearealist", "numberoftriangles", 1),
    "neighbors": (np.int32, "neighborlist", "numberoftriangles", 3),
    "segments": (np.int32, "segmentlist", "numberofsegments", 2),
    "segment_markers": (np.int32, "segmentmarkerlist", "numberofsegments", 1),
    "holes": (np.float64, "holelist", "numberofholes", 2),
    "regions": (np.float64, "regionlist", "numberofregions", 4),
    "edges": (np.int32, "edgelist", "numberofedges", 2),
    "edge_markers": (np.int32, "edgemarkerlist", "numberofedges", 1),
}
_VORONOI: _Fields = {
    "edges": (np.int32, "edgelist", "numberofedges", 2),
    "directions": (np.float64, "normlist", "numberofedges", 2),
    "vertices": _FIELDS["vertices"],
}
_LISTS = [name for name, kind, *_ in TriangulateIO._fields_ if kind is c_void_p]


def _fill(io: TriangulateIO, key: str, given: Any) -> Any:
    """Sets the fields of one key. Returns the array that must live as long as the struct, or None."""
    dtype, list_name, count_name, width = _FIELDS[key]
    rows = as_int32(given, key) if dtype is np.int32 else np.asarray(given, dtype)
    if rows.size == 0:
        return None
    if rows.ndim == 1:
        rows = rows.reshape(-1, 1)
    if rows.ndim != 2 or (isinstance(width, int) and rows.shape[1] != width):
        raise InputError("%s: shape %s is not (n, %s)" % (key, np.shape(given), width))
    there = getattr(io, count_name)
    if there not in (0, len(rows)):
        raise InputError("%s: %d rows instead of %d" % (key, len(rows), there))
    rows = np.ascontiguousarray(rows)
    setattr(io, count_name, len(rows))
    if isinstance(width, str):
        setattr(io, width, rows.shape[1])
    setattr(io, list_name, rows.ctypes.data)
    return rows


def _taken(io: TriangulateIO, fields: _Fields) -> Arrays:
    """Returns copies of the arrays of a struct, without empty ones."""
    taken = {}
    for key, (dtype, list_name, count_name, width) in fields.items():
        address = getattr(io, list_name)
        if not address:
            continue
        columns, rows = width if isinstance(width, int) else getattr(io, width), getattr(io, count_name)
        if rows > 0 and columns > 0:
            text = string_at(address, rows * columns * np.dtype(dtype).itemsize)
            taken[key] = np.frombuffer(bytearray(text), dtype).reshape(rows, columns)
    return taken


def _release(io: TriangulateIO, borrowed: Set[Any]) -> None:
    """Frees the arrays that the library has allocated."""
    for name in _LISTS:
        address = getattr(io, name)
        if address and address not in borrowed:
            library.trifree(address)


def _options_of(unsuitable: Optional[Callable[..., Any]], placement: str, calls: Calls, words: List[str],
                notes: List[bytes]) -> TriangulateOptions:
    if placement not in ("lattice", "classic"):
        raise InputError('%s: placement: %r is not "lattice" or "classic"' % (calls.who, placement))
    options = TriangulateOptions(classic=placement == "classic")

    def hear(_user: Any, is_error: int, text: bytes) -> None:
        if is_error:
            words.append(text.decode("utf-8", "replace"))
        else:
            notes.append(text)

    def ask(_user: Any, a: Any, b: Any, c: Any, area: float) -> int:
        assert unsuitable is not None
        return int(bool(unsuitable((a[0], a[1]), (b[0], b[1]), (c[0], c[1]), area)))

    options.message = lib.Message(hear)
    if unsuitable is not None:
        options.unsuitable = lib.SizeTest(calls.guarded(ask, 0))
    options.stop = lib.StopTest(lambda _user: int(calls.fault is not None))
    return options


def _warn_of_no_effect(tri: Mapping[str, Any], switches: bytes, who: str) -> None:
    """Warns of a missing switch p, the most common mistake. Without it the library ignores these arrays."""
    names = ["segments"] if b"r" in switches else ["segments", "holes", "regions"]
    given = [name for name in names if b"p" not in switches and np.size(tri.get(name, ())) > 0]
    if given:
        warn("%s: ignored without the switch p" % ", ".join(given), who, IgnoredWarning)


def _call(tri: Mapping[str, Any], opts: Union[str, bytes],
          unsuitable: Optional[Callable[..., Any]] = None, placement: str = "lattice") -> Tuple[Arrays, Arrays]:
    """Returns the mesh and, with the switch v, its Voronoi diagram."""
    data, out, vorout, kept = TriangulateIO(), TriangulateIO(), TriangulateIO(), []
    words: List[str] = []
    notes: List[bytes] = []
    tri = {key: given for key, given in tri.items() if given is not None}
    if np.asarray(tri.get("vertices", ())).size < 6:
        raise InputError("Input must have at least three vertices.")
    for key, given in tri.items():
        if key not in _FIELDS:
            raise KeyError(key)
        if key not in ("edges", "edge_markers", "neighbors"):
            kept.append(_fill(data, key, given))
    opts = opts.encode() if isinstance(opts, str) else bytes(opts)
    calls = Calls("triangulate()")
    options = _options_of(unsuitable, placement, calls, words, notes)
    borrowed = {data.holelist, data.regionlist}  # `out` refers to these as well
    try:
        status = calls.run(library.triangulate_with, b"z" + opts, byref(data), byref(out), byref(vorout),
                           byref(options))
        if status:
            raise exception_of(status, words[-1] if words else "error %d" % status)
        tell(b"\n".join(notes), calls.who, IgnoredWarning)
        _warn_of_no_effect(tri, opts, calls.who)
        mesh = _taken(out, _FIELDS)
        return mesh, _taken(vorout, _VORONOI)
    finally:
        _release(out, borrowed)
        _release(vorout, borrowed)


def triangulate(tri: Mapping[str, Any], opts: Union[str, bytes] = "",
                unsuitable: Optional[Callable[..., Any]] = None, *, placement: str = "lattice") -> Arrays:
    """Triangulates a dictionary of arrays with the switches of Triangle. z is always set, and nothing is printed.

    Keys of `tri`: vertices [n, 2]; optional vertex_attributes, vertex_markers, segments [s, 2], segment_markers,
    holes [h, 2], regions [r, 4]; with r also triangles, triangle_attributes, triangle_max_area. The result has those of
    vertices, vertex_attributes, vertex_markers, triangles, triangle_attributes, neighbors (n), segments and
    segment_markers, holes and regions (p), edges and edge_markers (e) that are not empty; markers are [n, 1].

    unsuitable(a, b, c, area), for the switch u: returns True if this triangle must be refined.
    placement="classic": new points are placed as by the package `triangle`. By default, with the switch a and an angle
    bound up to 30 degrees, they lie in a hexagonal lattice, which needs a third fewer triangles.

    Mistakes are warnings of the class IgnoredWarning: a number with an exponent ("a%g" % 1e-5 is read as a1 and e;
    write "a%.20f"), segments, holes or regions without the switch p, duplicate points, an angle bound above 38 degrees.
    An empty mesh is an EmptyMeshWarning. warnings.filterwarnings("ignore", category=IgnoredWarning) silences them.
    """
    return _call(tri, opts, unsuitable, placement)[0]


def delaunay(pts: Any) -> Any:
    """Returns the triangles [m, 3] of the Delaunay triangulation of points."""
    return triangulate({"vertices": pts})["triangles"]


def convex_hull(pts: Any) -> Any:
    """Returns the segments [h, 2] of the convex hull of points, each in clockwise direction."""
    return triangulate({"vertices": pts}, "c")["segments"]


def voronoi(pts: Any) -> Tuple[Any, Any, Any, Any]:
    """Returns vertices [m, 2], edges [e, 2], numbers of the vertices at which rays begin [r], their directions [r,
    2]."""
    _, diagram = _call({"vertices": pts}, "v")
    ends = diagram.get("edges", np.empty((0, 2), np.int32))
    is_ray = ends[:, 1] == -1
    directions = diagram.get("directions", np.empty((0, 2)))
    return diagram.get("vertices", np.empty((0, 2))), ends[~is_ray], ends[is_ray, 0], directions[is_ray]


def get_data(name: str) -> Arrays:
    """Returns the arrays of an example (plate, ground or points) or of its mesh (plate.1 and so on).

    Other names raise InputError: the examples of the package `triangle` ("A", "face", ...) are not included.
    """
    directory = os.path.join(os.path.dirname(os.path.abspath(__file__)), "data")
    found = load(directory, name)
    if not found:
        names = {os.path.splitext(file)[0] for file in os.listdir(directory) if file.endswith(ENDINGS)}
        raise InputError("get_data(): there is no example %r, but %s; load(directory, %r) reads files of your own" % (
            name, ", ".join(sorted(names)), name))
    return found


def show_data(name: str) -> None:
    """Draws an example, and returns when the window is closed."""
    import matplotlib.pyplot as plt
    plot(plt.axes(), **get_data(name))
    plt.show()
