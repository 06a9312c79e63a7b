"""mesh() and read(), which make a mesh and read a file."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, Dict, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _files, _overlay, _rings, _union
from ._arrays import Array, as_int32, numbers
from ._calls import Calls
from ._errors import InputError
from ._figure import figure_of
from ._mesh import Mesh, finished, made
from ._settings import Progress, Unsuitable, Wanted, settings_of
from ._signature import explained
from ._sizes import Near, Size

if TYPE_CHECKING:
    from typing import TypedDict

    class Arrays(TypedDict, total=False):
        """The contents of a file, as keywords of mesh()."""

        points: npt.NDArray[np.float64]
        point_attributes: npt.NDArray[np.float64]
        point_markers: npt.NDArray[np.int32]
        segments: npt.NDArray[np.int32]
        segment_markers: npt.NDArray[np.int32]
        holes: npt.NDArray[np.float64]
        regions: npt.NDArray[np.float64]
        triangles: npt.NDArray[np.int32]
        triangle_attributes: npt.NDArray[np.float64]
        triangle_areas: npt.NDArray[np.float64]
else:
    Arrays = dict


def _outline(polygons: Any, calls: Calls) -> Tuple[Array, Array]:
    """Returns points and segments of the union of the polygons."""
    points, segments = _rings.segments_of(polygons, 0)
    if len(points) < 3:
        return points, segments
    all_of_it, _, walls = _overlay.arrangement(points, segments, np.zeros(len(segments), np.int32), calls)
    return _union.outline_of(all_of_it.points, all_of_it.triangles, all_of_it.neighbors, walls, polygons)


def _given(points: Any, segments: Any, who: str) -> Tuple[Array, Array]:
    """Returns the points and segments that the caller passed with polygons. Segments must end at these points."""
    places = np.empty((0, 2)) if points is None else numbers(points, who + ": points").reshape(-1, 2)
    ends = np.empty((0, 2), int) if segments is None else numbers(segments, who + ": segments").reshape(-1, 2)
    if ends.size and not (ends.min() >= 0 and ends.max() < len(places)):
        raise InputError("%s: segments: numbers from %g to %g for %d given points" % (
            who, ends.min(), ends.max(), len(places)))
    return places, ends


def _with_polygons(points: Any, segments: Any, polygons: List[_rings.Polygon], union: bool,
                   who: str) -> Tuple[Array, Array, int]:
    """Appends points and segments of polygons to the given ones. Also returns the number of points that are
    unchanged."""
    points, segments = _given(points, segments, who)
    behind = _outline(polygons, Calls(who)) if union else _rings.segments_of(polygons, 0)
    all_points = np.concatenate([points, behind[0]])
    return all_points, np.concatenate([segments, behind[1] + len(points)]), len(points if union else all_points)


def _laid(given: Dict[str, Any], polygons: Any, columns: Mapping[str, Any], grid: Optional[float], keep_hull: bool,
          who: str) -> Tuple[_overlay.Overlay, Dict[str, Array]]:
    """Turns the arguments of mesh() into a figure of regions. Also returns the given columns as numbers."""
    for name in ("regions", "triangles", "point_attributes", "point_markers", "triangle_attributes", "triangle_areas"):
        if given.get(name) is not None:
            raise InputError("%s: %s= beside polygons that are regions (overlay)" % (who, name))
    items, properties = _rings.items_of(polygons, who + ": polygons")
    if not any(items):
        raise InputError("%s: no polygons" % who)
    told = {name: _rings.column_of(column, properties, "%s: polygon_%s" % (who, name))
            for name, column in columns.items() if column is not None}
    markers = given["segment_markers"]
    markers = None if markers is None else as_int32(markers, who + ": segment_markers").ravel()
    points, segments = _given(given["points"], given["segments"], who)
    if markers is not None and len(markers) != len(segments):
        raise InputError("%s: %d segment_markers for %d segments" % (who, len(markers), len(segments)))
    found = _overlay.laid(points, segments, markers, items, grid, keep_hull, Calls(who))
    areas = told.get("areas", np.zeros(len(items)))
    holes = numbers([] if given["holes"] is None else given["holes"], who + ": holes").reshape(-1, 2)
    given.update(points=found.points, segments=found.segments, segment_markers=found.markers,
                 holes=np.concatenate([holes, found.holes]),
                 regions=_overlay.regions(found, np.where(areas > 0, np.minimum(areas, 1e300), 0)[found.owners]))
    return found, told


@explained
def mesh(points: Optional[npt.ArrayLike] = None, segments: Optional[npt.ArrayLike] = None, *, polygons: Any = None,
         union: bool = False, overlay: bool = False, polygon_attributes: Union[str, npt.ArrayLike, None] = None,
         polygon_sizes: Union[str, npt.ArrayLike, None] = None, polygon_areas: Union[str, npt.ArrayLike, None] = None,
         grid: Optional[float] = None, holes: Any = None, regions: Optional[npt.ArrayLike] = None,
         point_attributes: Optional[npt.ArrayLike] = None, point_markers: Optional[npt.ArrayLike] = None,
         segment_markers: Optional[npt.ArrayLike] = None, triangles: Optional[npt.ArrayLike] = None,
         triangle_attributes: Optional[npt.ArrayLike] = None, triangle_areas: Optional[npt.ArrayLike] = None,
         min_angle: Optional[float] = None, max_area: Optional[float] = None, size: Optional[Size] = None,
         unsuitable: Optional[Unsuitable] = None, conforming: bool = False, keep_hull: bool = False, protect: int = 0,
         max_new_points: Optional[int] = None, gate: Optional[Callable[[float, float], Any]] = None,
         fence: Optional[Sequence[float]] = None, order: int = 1, keep_unused: bool = False,
         threads: Optional[int] = None, stop: Optional[Callable[[], Any]] = None,
         progress: Optional[Progress] = None, placement: str = "lattice", size_near: Optional[Near] = None,
         gradation: Optional[float] = None, min_size: Optional[float] = None,
         max_size: Optional[float] = None, optimise: Optional[int] = None,
         elements_across: Optional[float] = None, per_circle: Optional[float] = None) -> Mesh:
    """Makes a triangle mesh of a plane figure.

    Input. Arrays may be anything that numpy converts to an array; arrays of the right type are not copied.

    points [n, 2]; segments [s, 2]: point numbers from 0. Without segments the convex hull is meshed.
    polygons: a list of polygons. Each is a list of rings [k, 2] (an outline and its holes), a single ring, or a polygon
        of shapely. Rings may be closed or not. A GeoSeries of geopandas and GeoJSON are accepted as well. Points inside
        an odd number of rings are in the domain (the even-odd rule). An InputWarning reports polygons that overlap, lie
        in one another, or are invalid. z coordinates are ignored.
    union: the domain is the union of all polygons, without their holes. Borders inside the union are removed.
    overlay: each polygon is a region, as on a map. Later polygons cover earlier ones, gaps between polygons are not
        meshed, and borders are edges of the mesh. Mesh.triangle_polygons is the polygon of each triangle. The next four
        keywords imply overlay. A feature, or a shape of several polygons, counts as one polygon.
    polygon_attributes, polygon_sizes, polygon_areas: for each polygon the attribute of its triangles (default: its
        number, counted from 1), the length of its edges, and the largest area of its triangles. Give an array
        [polygons], a number, or the name of a column of geopandas or of a property of GeoJSON. None, 0 or a negative
        value sets no bound.
    grid: snaps borders to a grid of this width (with shapely). Faces narrower than this are merged with a neighbor.
    holes [h, 2]: a place in each hole; or "auto": the segments are rings under the even-odd rule.
    regions [r, 4]: x, y, attribute, largest area (<= 0: no bound).
    point_attributes [n, k], point_markers [n], segment_markers [s].
    triangles [m, 3]: an existing mesh to keep and refine; triangle_attributes [m, k], triangle_areas [m].

    Bounds and options. Without bounds the result is the constrained Delaunay triangulation.

    min_angle: degrees. Use 30 unless you have a reason. Of 133 real inputs, 101 reach 36 degrees and 31 reach 38. A
        bound above 38 is treated as 38. With conforming, a bound above 36 is treated as 36. Both give an
        IgnoredWarning.
    max_area: largest area of a triangle.
    size: desired length of edges: a number; a function of the arrays x and y that returns an array (inf: no bound); a
        raster (values [rows, columns], (x_min, y_min, x_max, y_max)), whose first row lies at y_min and whose outer
        nodes lie on these bounds; or a mesh (points, triangles, values). In a list of several the least length counts.
        nan, 0 and negative values mean "no data". A function of single numbers works as well, but it is slow and gives
        an InputWarning.
    size_near: {marker: length} or {marker: (length, growth)}: the length of edges at the segments with this marker.
        Away from them the length grows by growth (default: gradation) per unit of distance.
    gradation: largest growth of sizes per unit of distance (default 0.2; inf: no limit).
    min_size, max_size: bounds on all sizes.
    elements_across: fits this number of edge lengths across channels, that is, between boundaries, or borders of
        regions, that face each other.
    per_circle: on curved boundaries, fits this number of lengths around a circle of the same curvature.
    optimise: passes of smoothing at the end, which move new points inside regions to improve the triangles. Default: 1
        with sizes, otherwise 0. Not with max_area, areas of regions, unsuitable, conforming, max_new_points, gate or
        fence.
    unsuitable: function of a, b, c and area that returns True if this triangle must be refined.
    conforming: every triangle is Delaunay, and diametral circles of subsegments are empty.
    keep_hull: meshes the convex hull, even if segments enclose less.
    protect: 1: no new points on the boundary; 2: no new points on any segment.
    max_new_points: refinement stops after this number of new points.
    gate: function of x and y that returns whether a point may be inserted there now.
    fence: x_min, y_min, x_max, y_max. Only triangles inside this box are changed.
    placement: "lattice": new points lie in a hexagonal lattice, which needs a third fewer triangles. It applies if one
        length, max_area, or areas of regions alone set the size, and min_angle is at most 30. "classic": no lattice, so
        edges have no common directions. "front": points advance in rows from the boundary inwards, at the distance
        that size requests. If sizes vary in space, "lattice" means "front".
    order: 2: also adds the midpoints of edges (second-order triangles).
    keep_unused: keeps points that no triangle uses (duplicates, points outside). Otherwise they are removed, and
        Mesh.input_points holds the new number of each point.
    threads: number of threads. Default: OMP_NUM_THREADS, otherwise one for each core. The mesh is the same for any
        number.
    stop: function that any thread calls often. If it returns True, the call ends with StoppedError.
    progress: True prints a line on standard error. A function receives the share of work that is done, from 0 to 1,
        and the current number of triangles.

    Functions are called under the interpreter's lock, `stop` on any thread, the others on the calling thread. An
    exception in a function ends the call, and so does Ctrl-C.
    """
    who = "mesh()"
    overlay = overlay or any(given is not None for given in (polygon_attributes, polygon_sizes, polygon_areas, grid))
    if (union or overlay) and polygons is None:
        raise InputError("%s: union, overlay, polygon_..= or grid= without polygons" % who)
    if union and overlay:
        raise InputError("%s: union=True drops the borders that overlay=True keeps" % who)
    if isinstance(holes, str):
        if holes != "auto" or overlay:
            raise InputError("%s: holes: %r instead of %s" % (who, holes, "places" if overlay else '"auto" or places'))
    given = dict(points=points, segments=segments, holes=None if isinstance(holes, str) else holes, regions=regions,
                 point_attributes=point_attributes, point_markers=point_markers, segment_markers=segment_markers,
                 triangles=triangles, triangle_attributes=triangle_attributes, triangle_areas=triangle_areas)
    shapes: List[_rings.Polygon] = []
    laid, n_told = None, None
    if overlay:
        laid, columns = _laid(given, polygons, {"attributes": polygon_attributes, "sizes": polygon_sizes,
                                                "areas": polygon_areas}, grid, keep_hull, who)
        n_told = 0 if points is None else np.size(points) // 2
        field = _overlay.background(laid, columns["sizes"], Calls(who)) if "sizes" in columns else None
        if field:
            size = [*(size if isinstance(size, list) else [] if size is None else [size]), field]
    elif polygons is not None:
        shapes = [polygon for item in _rings.items_of(polygons, who + ": polygons")[0] for polygon in item]
        given["points"], given["segments"], n_told = _with_polygons(points, segments, shapes, union, who)
    if given["points"] is None or (polygons is not None and np.size(given["points"]) == 0):
        raise InputError("%s: neither points nor polygons are given" % who)
    settings, calls = settings_of(who, Wanted(min_angle, max_area, size, unsuitable, conforming, keep_hull, protect,
                                              max_new_points, gate, fence, threads, stop, progress, placement,
                                              size_near, gradation, min_size, max_size, optimise,
                                              elements_across, per_circle))
    settings.even_odd = not overlay and (polygons is not None or isinstance(holes, str))
    figure, kept = figure_of(given, who)
    found = finished(made(figure, settings, calls), order, calls)
    del kept  # the library uses these arrays up to this line
    found._settle_points(figure.points.n, n_told, keep_unused)
    if laid:
        found._settle_polygons(columns.get("attributes"))
    elif shapes and segments is None and holes is None and triangles is None and not (union or keep_hull) \
            and len(found.triangles) > 0:
        _union.warn_of_overlaps(shapes, float(found.areas.sum()), who)
    return found


@explained
def read(path: Any) -> "Arrays":
    """Returns the arrays of a file as keywords of mesh(): mesh(**read("plate.poly"), min_angle=30).

    Figures: x.poly and x.node. Meshes: x.ele (with its points, segments and area bounds), x.vtu, x.msh, x.2dm, x.14,
    x.grd, x.h5 and x.vtkhdf (the last two need h5py). mesh() keeps the triangles of a mesh, and refines them if bounds
    are given.
    """
    return _files.read_arrays(path, "read()")  # type: ignore[return-value]
