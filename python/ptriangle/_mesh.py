"""The class Mesh: arrays of a mesh, and quantities that are computed from them on demand."""
from __future__ import annotations

from ctypes import byref, c_int64, c_void_p
from functools import cached_property
from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence, Tuple

import numpy as np
import numpy.typing as npt

from . import _files, _interpolate, _picture, _second_order
from ._arrays import Array, freeze, numbers, to_numpy
from ._calls import Calls
from ._errors import InputError
from ._figure import figure_of
from ._library import Demands, Figure, Ints, Settings, VerdictDetail, library
from ._notes import tell, warn
from ._settings import Progress, Unsuitable, Wanted, settings_of
from ._signature import explained
from ._sizes import Near, Size
from ._verdict import Verdict

Reals = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int32]

PARALLEL = hasattr(library, "par_mesh_new")
_COUNTS = ("duplicates", "crossings", "skipped_segments", "new_points", "new_points_on_segments", "gated", "fenced")
_REASONS = ("input_angle", "narrow_gap", "protected", "limit", "precision", "deferred")
_NAMES = ("points", "point_attributes", "point_markers", "triangles", "triangle_attributes", "segments",
          "segment_markers")


class Handle:
    """Owns a mesh of the library, and deletes it after the last array that refers to its memory."""

    def __init__(self) -> None:
        self.mesh = c_void_p()

    def __del__(self, delete: Any = library.tri_mesh_delete) -> None:
        delete(self.mesh)
        self.mesh = None  # type: ignore[assignment]


def made(figure: Figure, settings: Settings, calls: Calls) -> Handle:
    handle = Handle()
    calls.run_checked(library.par_mesh_new if PARALLEL else library.tri_mesh_new, byref(handle.mesh), byref(figure),
                      byref(settings))
    return handle


class _Arrays(Dict[str, Array]):
    """The arrays of a mesh of the library by name. Each is made when it is first read."""

    def __init__(self, handle: Handle) -> None:
        super().__init__()
        self._handle, self._figure = handle, Figure()
        library.tri_mesh_figure(handle.mesh, byref(self._figure))

    def __missing__(self, name: str) -> Array:
        rows = to_numpy(getattr(self._figure, name), self._handle)
        if name.endswith("_markers"):
            rows = rows[:, 0]
        elif name.endswith("_attributes") and len(rows) == 0:  # no attributes: one row without columns for each
            rows = np.empty((getattr(self._figure, name[:-len("_attributes")] + "s").n, 0))
        self[name] = rows
        return rows


def _used(arrays: Mapping[str, Array], n_input: int, crossings: int) -> Array:
    """Marks the points that are corners of triangles or ends of segments. All new points are, except crossings."""
    corners, n = arrays["triangles"].ravel(), len(arrays["points"])
    first_new = n if crossings else n_input
    used = np.zeros(n, bool)
    used[first_new:] = True
    used[corners[corners < first_new] if first_new < n else corners] = True
    used[arrays["segments"].ravel()] = True
    return used


def _firsts(points: Array) -> Array:
    """Returns for each point the first point at the same place."""
    places = points[:, 0] + 1j * points[:, 1]
    _, first, group = np.unique(places, return_index=True, return_inverse=True)
    return first[group.reshape(-1)]


class Mesh:
    """A triangle mesh, made by ptriangle.mesh(). It does not change; refine() returns a new one.

    The arrays are read-only numpy arrays, which refer to the memory of the library without a copy. Points are numbered
    from 0. A mesh can be pickled and copied. Notebooks display it as a picture.
    """

    def __init__(self, handle: Handle, order: int = 1) -> None:
        self._handle: Optional[Handle] = handle
        self._numbers: Optional[Array] = None  # numbers of the remaining points in the library; None if all remain
        self._input_points: Array = np.empty(0, np.int32)
        self._polygons: Optional[Array] = None  # the polygon of each triangle; None without overlay
        self._order = order
        self._arrays: Dict[str, Array] = _Arrays(handle)

    def _settle_points(self, n_input: int, n_told: Optional[int], keep_unused: bool) -> None:
        """Finds the new numbers of the first n_told of the n_input points (None: all), and removes points that no
        triangle uses. A mesh without triangles keeps its points."""
        arrays = self._arrays
        self._input_points = np.arange(n_input, dtype=np.int32)[:n_told]
        used = _used(arrays, n_input, library.tri_mesh_count(self._library_mesh().mesh, _COUNTS.index("crossings")))
        if len(arrays["triangles"]) > 0 and not used.all():
            kept = np.ones(len(used), bool) if keep_unused else used
            numbers = np.where(kept, np.cumsum(kept) - 1, -1).astype(np.int32)
            self._input_points = numbers[_firsts(arrays["points"][:n_input])][:n_told]
            if not keep_unused:
                self._numbers = numbers
                arrays.update({name: arrays[name][kept] for name in _NAMES[:3]})
                arrays.update({name: numbers[arrays[name]] for name in ("triangles", "segments")})
                freeze(arrays.values())
        freeze([self._input_points])

    def _settle_polygons(self, attributes: Optional[Array] = None) -> None:
        """Moves the last attribute, the number of the polygon counted from 1, to triangle_polygons. attributes: one
        value for each polygon, which replaces it."""
        rows = self._arrays["triangle_attributes"]
        polygons = rows[:, -1].astype(np.int32) - 1 if rows.shape[1] else np.full(len(rows), -1, np.int32)
        if attributes is not None:
            rows = np.append(np.nan_to_num(attributes), 0)[polygons][:, None]
        self._polygons, self._arrays["triangle_attributes"] = polygons, rows
        freeze([polygons, rows])

    # --- arrays

    @property
    def points(self) -> Reals:
        """Coordinates, [n, 2]: the input points in their order, then new points, then with order 2 the midpoints of the
        edges. Input points that no triangle uses are left out, unless mesh() was called with keep_unused."""
        return self._nodes["points"]

    @property
    def input_points(self) -> Integers:
        """For each point given to mesh(), and then for each corner of polygons, its number in `points`. A duplicate has
        the number of the first point at its place. -1: the point was left out. With union=True the corners of polygons
        are not listed. refine() keeps these numbers."""
        return self._input_points

    @property
    def point_attributes(self) -> Reals:
        """Attributes of the points, [n, k]; k is 0 if none were given. At new points they are interpolated linearly in
        the triangulation of the input."""
        return self._nodes["point_attributes"]

    @property
    def point_markers(self) -> Integers:
        """Markers of the points, [n]: as given, otherwise that of a segment at the point, otherwise 1 on the boundary
        and 0 inside."""
        return self._nodes["point_markers"]

    @property
    def triangles(self) -> Integers:
        """Points of the triangles, counter-clockwise, [m, 3]; with order 2 [m, 6]: corners a, b, c, then the midpoints
        of ab, bc and ca, in the order of VTK, Gmsh and meshio."""
        return self._nodes["triangles"]

    @property
    def triangle_attributes(self) -> Reals:
        """Attributes of the triangles, [m, k]: those of their regions; k is 0 if there are none."""
        return np.asarray(self._arrays["triangle_attributes"])

    @property
    def triangle_polygons(self) -> Integers:
        """With mesh(overlay=True) the polygon of each triangle, [m], as a number in `polygons`, counted from 0; -1 if
        there is none. refine() keeps it."""
        return np.full(len(self._arrays["triangles"]), -1, np.int32) if self._polygons is None else self._polygons

    @property
    def segments(self) -> Integers:
        """Subsegments of the input segments, and edges of the boundary, [s, 2]; with order 2 [s, 3], the midpoint
        last."""
        return self._with_middles(self._arrays["segments"])

    @property
    def segment_markers(self) -> Integers:
        """Markers of the segments, [s]: as given, otherwise 1 on the boundary and 0 inside."""
        return np.asarray(self._arrays["segment_markers"])

    @property
    def neighbors(self) -> Integers:
        """The triangle opposite each corner of each triangle, [m, 3]; -1 if there is none."""
        return self._neighbors

    @property
    def edges(self) -> Integers:
        """Ends of all edges, [e, 2]. With order 2 the midpoint of edge i is point len(points) - len(edges) + i."""
        return self._edges[0]

    @property
    def edge_markers(self) -> Integers:
        """Markers of the edges, [e]: that of the segment on this edge, otherwise 0."""
        return self._edges[1]

    @property
    def boundary(self) -> Integers:
        """Edges with a triangle on one side only, [b, 2]; the triangle lies to their left. With order 2 [b, 3], the
        midpoint last. np.unique(m.boundary) returns the points of the boundary."""
        corners = self._arrays["triangles"]
        triangle, k = np.nonzero(self.neighbors < 0)
        return self._with_middles(np.column_stack([corners[triangle, (k + 1) % 3], corners[triangle, (k + 2) % 3]]))

    @property
    def order(self) -> int:
        """1: triangles consist of their corners; 2: they also have the midpoints of their edges."""
        return self._order

    @property
    def areas(self) -> Reals:
        """Areas of the triangles, [m]."""
        a, b, c = self._corners
        return np.asarray(((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2)

    @property
    def angles(self) -> Reals:
        """Angles of the triangles at their corners in degrees, [m, 3]."""
        a, b, c = self._corners
        sides = [(b - a, c - a), (c - b, a - b), (a - c, b - c)]
        return np.asarray(np.degrees([np.arctan2(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0], (u * v).sum(axis=1))
                                      for u, v in sides]).T)

    @property
    def quality(self) -> Reals:
        """Quality of the triangles, [m]: twice the radius of the inscribed circle divided by the radius of the
        circumcircle. It is 1 for an equilateral triangle and 0 for a flat one."""
        sines = np.sin(np.radians(self.angles) / 2)
        return np.asarray(8 * sines.prod(axis=1))

    @property
    def counts(self) -> Dict[str, int]:
        """Counts for the input (duplicates, crossings, skipped_segments) and for refinement (new_points,
        new_points_on_segments, gated, fenced)."""
        return dict(self._counts)

    # --- construction

    def _all_arrays(self) -> Dict[str, Array]:
        return {name: self._arrays[name] for name in _NAMES}

    @cached_property
    def _counts(self) -> Dict[str, int]:
        mesh = self._library_mesh().mesh
        return {name: int(library.tri_mesh_count(mesh, k)) for k, name in enumerate(_COUNTS)}

    @property
    def _nodes(self) -> Dict[str, Array]:
        """Arrays of points and triangles, with order 2 with the midpoints of edges."""
        return self._arrays if self._order == 1 else self._with_midpoints

    @cached_property
    def _with_midpoints(self) -> Dict[str, Array]:
        points, attributes, markers, triangles = (self._arrays[name] for name in _NAMES[:4])
        found = (*_second_order.points_of(points, attributes, markers, self.edges, self.edge_markers),
                 _second_order.triangles_of(triangles, self.edges, len(points)))
        freeze(found)
        return dict(zip(_NAMES, found))

    def _with_middles(self, ends: Array) -> Array:
        if self._order == 1:
            return ends
        return _second_order.with_middles(ends, self.edges, len(self._arrays["points"]))

    @property
    def _corners(self) -> List[Array]:
        return [self._arrays["points"][self._arrays["triangles"][:, k]] for k in range(3)]

    @cached_property
    def _neighbors(self) -> Array:
        if len(self._arrays["triangles"]) == 0:
            return np.empty((0, 3), np.int32)
        found, handle = Ints(), self._library_mesh()
        Calls("neighbors").run_checked(library.tri_mesh_neighbors, handle.mesh, byref(found))
        return to_numpy(found, handle)

    @cached_property
    def _edges(self) -> Tuple[Array, Array]:
        if len(self._arrays["triangles"]) == 0:
            return np.empty((0, 2), np.int32), np.empty(0, np.int32)
        edges, markers, handle = Ints(), Ints(), self._library_mesh()
        Calls("edges").run_checked(library.tri_mesh_edges, handle.mesh, byref(edges), byref(markers))
        ends = to_numpy(edges, handle)
        if self._numbers is not None:
            ends = self._numbers[ends]
            freeze([ends])
        return ends, to_numpy(markers, handle)[:, 0]

    def _library_mesh(self) -> Handle:
        """The mesh of the library. After unpickling it is rebuilt with the same numbers."""
        if self._handle is None:
            calls = Calls("Mesh")
            figure, kept = figure_of(self._all_arrays(), calls.who)
            self._handle = made(figure, Settings(), calls)
            del kept
        return self._handle

    def __getstate__(self) -> Mapping[str, Any]:
        return {"order": self._order, "arrays": {name: np.array(rows) for name, rows in self._all_arrays().items()},
                "counts": self._counts, "input_points": self._input_points, "polygons": self._polygons}

    def __setstate__(self, state: Mapping[str, Any]) -> None:
        self._handle = self._numbers = None
        self._order, self._arrays, self._counts = state["order"], dict(state["arrays"]), state["counts"]
        self._input_points, self._polygons = state["input_points"], state["polygons"]
        freeze([*self._arrays.values(), self._input_points])

    def __copy__(self) -> "Mesh":
        return self  # it does not change

    def __deepcopy__(self, memo: Dict[int, Any]) -> "Mesh":
        return self

    # --- operations

    @explained
    def refine(self, *, min_angle: Optional[float] = None, max_area: Optional[float] = None,
               size: Optional[Size] = None, unsuitable: Optional[Unsuitable] = None,
               triangle_areas: Optional[npt.ArrayLike] = None, conforming: bool = False, protect: int = 0,
               max_new_points: Optional[int] = None, gate: Optional[Callable[[float, float], Any]] = None,
               fence: Optional[Sequence[float]] = None, order: Optional[int] = None, threads: Optional[int] = None,
               stop: Optional[Callable[[], Any]] = None, progress: Optional[Progress] = None,
               placement: str = "lattice", size_near: Optional[Near] = None, gradation: Optional[float] = None,
               min_size: Optional[float] = None, max_size: Optional[float] = None,
               optimise: Optional[int] = None, elements_across: Optional[float] = None,
               per_circle: Optional[float] = None) -> "Mesh":
        """Returns a finer mesh. The keywords are those of ptriangle.mesh(). This mesh does not change.

        Area bounds of regions no longer apply; triangle_areas, [m], sets a new bound for each triangle. The default of
        order is that of this mesh.
        """
        settings, calls = settings_of("refine()", Wanted(min_angle, max_area, size, unsuitable, conforming, False,
                                                         protect, max_new_points, gate, fence, threads, stop, progress,
                                                         placement, size_near, gradation, min_size, max_size,
                                                         optimise, elements_across, per_circle))
        arrays: Dict[str, Any] = dict(self._all_arrays(), triangle_areas=triangle_areas)
        if self._polygons is not None:  # it comes back with the finer triangles
            arrays["triangle_attributes"] = np.column_stack([self.triangle_attributes, self._polygons + 1])
        figure, kept = figure_of(arrays, calls.who)
        finer = finished(made(figure, settings, calls), self._order if order is None else order, calls)
        finer._input_points = self._input_points
        if self._polygons is not None:
            finer._settle_polygons()
            finer._arrays["triangle_attributes"] = finer._arrays["triangle_attributes"][:, :-1]
        del kept
        return finer

    @explained
    def interpolate(self, points: npt.ArrayLike, values: npt.ArrayLike, outside: Optional[float] = None) -> Reals:
        """Interpolates measurements, such as depths or heights, at the points of this mesh.

        points [k, 2], values [k] or [k, w]; the result is [n] or [n, w]. Interpolation is linear in the Delaunay
        triangulation of the measurements. If several have the same place, the first counts. Points of this mesh outside
        the convex hull of the measurements have the value of the nearest place on the hull, or `outside` (such as
        numpy.nan).
        """
        who, at = "interpolate()", np.asarray(self.points)
        given = numbers(values, who + ": values").astype(np.float64)
        figure, kept = figure_of({"points": points}, who)
        if given.ndim not in (1, 2) or len(given) != figure.points.n:
            raise InputError("%s: values of shape %s for %d points" % (who, given.shape, figure.points.n))
        cloud = Mesh(made(figure, Settings(), Calls(who)))
        del kept
        triangles, neighbors = _interpolate.without_flat_rim(cloud.points, cloud.triangles, cloud.neighbors)
        if len(triangles) == 0:
            raise InputError("%s: all points lie on one line" % who)
        found, inside = _interpolate.interpolated(cloud.points, triangles, neighbors, given, at)
        if outside is not None:
            found[~inside] = outside
        return found

    @explained
    def bad(self, *, min_angle: Optional[float] = None, max_area: Optional[float] = None, size: Optional[Size] = None,
            unsuitable: Optional[Unsuitable] = None, conforming: bool = False, protect: int = 0,
            max_new_points: Optional[int] = None, gate: Optional[Callable[[float, float], Any]] = None,
            fence: Optional[Sequence[float]] = None, size_near: Optional[Near] = None,
            gradation: Optional[float] = None, min_size: Optional[float] = None,
            max_size: Optional[float] = None) -> Dict[str, int]:
        """Counts the triangles that violate the bounds, by reason. The keywords are those of ptriangle.mesh().

        Reasons: input_angle (a small angle of the input), narrow_gap (between segments), protected, limit (of new
        points, or the bound would need an endless number of points), precision (of the coordinates), deferred (by gate
        or fence, or not refined with these bounds yet).
        """
        settings, calls = settings_of("bad()", Wanted(min_angle, max_area, size, unsuitable, conforming, False, protect,
                                                      max_new_points, gate, fence, size_near=size_near,
                                                      gradation=gradation, min_size=min_size, max_size=max_size))
        if len(self._arrays["triangles"]) == 0:
            return {}
        count = (c_int64 * len(_REASONS))()
        if calls.run(library.tri_mesh_count_bad, self._library_mesh().mesh, byref(settings), count, len(_REASONS)) < 0:
            raise InputError("bad(): bounds without meaning")
        return {name: count[k] for k, name in enumerate(_REASONS) if count[k]}

    @explained
    def check(self, min_angle: Optional[float] = None, max_area: Optional[float] = None,
              conforming: bool = False) -> Verdict:
        """Verifies the mesh in exact arithmetic, and that it keeps these bounds. The checker is independent of the
        mesher.

        Points that no triangle uses are not a fault. They give an InputWarning."""
        detail, calls = VerdictDetail(), Calls("check()")
        demands = Demands(min_angle=float(min_angle or 0), max_area=float(max_area or 0), delaunay=int(conforming))
        figure, kept = figure_of(self._all_arrays(), calls.who)
        calls.run_checked(library.tri_check_figure, byref(figure), None, byref(demands), byref(detail))
        del kept
        found, n = Verdict(detail), len(self._arrays["points"])
        if 0 < found.n_points < n:
            warn("%d points are used by no triangle: a finite-element matrix is singular with them" %
                 (n - found.n_points), calls.who)
        return found

    @explained
    def write(self, path: Any, first: int = 1) -> None:
        """Writes the mesh. The suffix selects the format: x.vtu (VTK), x.msh (Gmsh), x.h5 or x.vtkhdf (HDF5, needs
        h5py), x.2dm (SMS), x.14 or x.grd (ADCIRC). x.poly, x.ele, x.node, and x without suffix write x.node, x.ele and
        x.poly, with numbers that count from `first`, 0 or 1. All formats except .h5, .vtkhdf and .14 support order
        2."""
        arrays = self._all_arrays()
        if self._order == 2:
            arrays.update(self._nodes)
        _files.write_arrays(path, arrays, first, "write()")

    def to_meshio(self) -> Any:
        """Returns a meshio.Mesh with triangles (triangle6 with order 2), then segments (line, line3). Markers are the
        cell data `marker`, attributes are `attribute_0`, ...; z is 0."""
        try:
            import meshio  # type: ignore[import-untyped, unused-ignore]
        except ImportError:
            raise ImportError("to_meshio() needs meshio: pip install meshio") from None
        points = np.column_stack([self.points, np.zeros(len(self.points))])
        kinds = ("triangle", "line") if self._order == 1 else ("triangle6", "line3")
        cells = [(kinds[0], self.triangles), (kinds[1], self.segments)]
        cell_data: Dict[str, List[Array]] = {"marker": [np.zeros(len(self.triangles), np.int32), self.segment_markers]}
        for k, column in enumerate(self.triangle_attributes.T):
            cell_data["attribute_%d" % k] = [column, np.zeros(len(self.segments))]
        point_data: Dict[str, Array] = {"marker": self.point_markers}
        for k, column in enumerate(self.point_attributes.T):
            point_data["attribute_%d" % k] = column
        return meshio.Mesh(points, cells, point_data=point_data, cell_data=cell_data)

    def plot(self, ax: Any = None, *, color: Any = "tab:blue", segment_color: Any = "black",
             linewidth: float = 0.5) -> Any:
        """Draws the mesh with matplotlib on `ax`, or on the current axes if ax is None, and returns the axes.
        segment_color=None leaves out the segments."""
        return _picture.plot(self._arrays["points"], self._arrays["triangles"], self._arrays["segments"], ax, color,
                             segment_color, linewidth)

    def _repr_svg_(self) -> str:
        """Returns the picture for notebooks."""
        return _picture.svg(self._arrays["points"], self.edges, self._arrays["segments"], self._words())

    def _words(self) -> str:
        order = "" if self._order == 1 else ", order %d" % self._order
        return "%d points, %d triangles, %d segments%s" % (len(self.points), len(self.triangles),
                                                           len(self._arrays["segments"]), order)

    def __repr__(self) -> str:
        return "<Mesh: %s>" % self._words()


def finished(handle: Handle, order: int, calls: Calls) -> Mesh:
    """Returns the mesh of a completed call, and issues its warnings."""
    if order not in (1, 2):
        raise InputError("%s: order is %r instead of 1 or 2" % (calls.who, order))
    tell(library.tri_mesh_notes(handle.mesh), calls.who)
    return Mesh(handle, order)
