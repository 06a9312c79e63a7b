"""mesh() and read(): where everything begins."""
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
        """What a file holds, by the keywords of mesh()."""

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
    """Points and segments of the polygons' union."""
    points, segments = _rings.segments_of(polygons, 0)
    if len(points) < 3:
        return points, segments
    all_of_it, _, walls = _overlay.arrangement(points, segments, np.zeros(len(segments), np.int32), calls)
    return _union.outline_of(all_of_it.points, all_of_it.triangles, all_of_it.neighbors, walls, polygons)


def _given(points: Any, segments: Any, who: str) -> Tuple[Array, Array]:
    """Points and segments that are given beside polygons. Segments end at given points."""
    places = np.empty((0, 2)) if points is None else numbers(points, who + ": points").reshape(-1, 2)
    ends = np.empty((0, 2), int) if segments is None else numbers(segments, who + ": segments").reshape(-1, 2)
    if ends.size and not (ends.min() >= 0 and ends.max() < len(places)):
        raise InputError("%s: segments: numbers from %g to %g for %d given points" % (
            who, ends.min(), ends.max(), len(places)))
    return places, ends


def _with_polygons(points: Any, segments: Any, polygons: List[_rings.Polygon], union: bool,
                   who: str) -> Tuple[Array, Array, int]:
    """Points and segments with those of polygons behind them; how many of the points were given as they are."""
    points, segments = _given(points, segments, who)
    behind = _outline(polygons, Calls(who)) if union else _rings.segments_of(polygons, 0)
    all_points = np.concatenate([points, behind[0]])
    return all_points, np.concatenate([segments, behind[1] + len(points)]), len(points if union else all_points)


def _laid(given: Dict[str, Any], polygons: Any, columns: Mapping[str, Any], grid: Optional[float], keep_hull: bool,
          who: str) -> Tuple[_overlay.Overlay, Dict[str, Array]]:
    """Turns what mesh() was given into a figure of regions. Returns also the columns that are there, as numbers."""
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
    """A triangle mesh of a plane figure.

    What is given, anything that numpy makes an array of (arrays of the right type are not copied):

    points [n, 2]; segments [s, 2]: point numbers from 0. Without segments the convex hull is meshed.
    polygons: a list of polygons: lists of rings [k, 2], closed or not (an outline and its holes), single rings, or
        shapely's; a GeoSeries of geopandas, or GeoJSON. Places in an odd number of rings are meshed (the even-odd
        rule). An InputWarning says if polygons overlap, or lie in one another, or are not valid. z is dropped.
    union: places in any polygon are meshed: in its outline and in none of its holes. Borders inside vanish.
    overlay: each polygon is a region, as on a map: later polygons lie on top of earlier ones, gaps between polygons are
        not meshed, and borders are edges of the mesh. Mesh.triangle_polygons says which polygon each triangle lies in.
        The next four keywords imply overlay. A feature, or a shape of several polygons, counts as one polygon.
    polygon_attributes, polygon_sizes, polygon_areas: for each polygon an attribute of its triangles (default: its
        number, counted from 1), the length of its edges, and the largest area of its triangles. An array [polygons], a
        number, or the name of a column of geopandas or of a property of GeoJSON. None, or not above 0: no bound.
    grid: borders are snapped to a grid of this width (by shapely), and faces that are narrower go to a neighbor.
    holes [h, 2]: places; or "auto": the segments are rings as above.
    regions [r, 4]: x, y, attribute, largest area (<= 0: any).
    point_attributes [n, k], point_markers [n], segment_markers [s].
    triangles [m, 3]: a mesh that is there, to be kept and refined; triangle_attributes [m, k], triangle_areas [m].

    What is wanted; without bounds it is the constrained Delaunay triangulation:

    min_angle: degrees. Use 30 unless you have a reason: of 133 real inputs 101 keep 36, 31 keep 38. A bound above 38 is
        treated as 38, conforming above 36 as 36, with an IgnoredWarning.
    max_area: of a triangle.
    size: how long edges shall be. A number; a function of the arrays x and y that returns an array (inf: any length);
        a raster (values [rows, columns], (x_min, y_min, x_max, y_max)), whose first row lies at y_min and whose outer
        nodes lie on these bounds; a mesh (points, triangles, values). A list of several: the least counts. A value that
        is nan, or not above 0, is no data. A function of numbers works too, slowly, with an InputWarning.
    size_near: {marker: length} or {marker: (length, growth)}: edges at the segments with this marker have this length,
        which grows by growth (default: gradation) for a distance of 1.
    gradation: sizes grow by no more than this for a distance of 1 (default 0.2; inf: any growth).
    min_size, max_size: bounds on all sizes.
    elements_across: room for so many lengths between boundaries, or borders of regions, that face each other: channels.
    per_circle: where segments follow a curve, so many lengths go around a circle of its curvature.
    optimise: passes of smoothing at the end, which move new points inside regions to where triangles are best. Default:
        1 where sizes are given, else 0. Not with max_area, areas of regions, unsuitable, conforming, max_new_points,
        gate or fence.
    unsuitable: function of a, b, c and area: must this triangle be refined?
    conforming: every triangle is Delaunay, no point lies in the circle over a segment.
    keep_hull: the convex hull is meshed, whatever the segments enclose.
    protect: 1: no points on the boundary; 2: nor on any segment.
    max_new_points: then refinement ends.
    gate: function of x and y: may a point be put here now? fence: x_min, y_min, x_max, y_max: changes stay within.
    placement: "lattice": if one length, max_area, or areas of regions alone set the size, and min_angle is at most 30,
        new points lie in a hexagonal lattice: a third fewer triangles. "classic": no lattice; edges have no common
        directions. "front": points are placed row by row from the boundary inwards, at the distance that size asks
        for. Sizes that vary in space use it in place of the lattice.
    order: 2: points amid the edges, too.
    keep_unused: points that no triangle uses (duplicates, points outside) stay. Otherwise they are dropped;
        Mesh.input_points holds the new number of each point.
    threads: else OMP_NUM_THREADS, else one for each core. The mesh does not depend on it.
    stop: function that is asked often, by any thread: True ends the work with StoppedError.
    progress: True: a line on standard error; or a function of the share that is done, 0 to 1, and of the number of
        triangles so far.

    Functions are called under the interpreter's lock, `stop` by any thread, the others by the calling one; an exception
    in one ends the work, and so does Ctrl-C.
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
    del kept  # which the library has looked at until here
    found._settle_points(figure.points.n, n_told, keep_unused)
    if laid:
        found._settle_polygons(columns.get("attributes"))
    elif shapes and segments is None and holes is None and triangles is None and not (union or keep_hull) \
            and len(found.triangles) > 0:
        _union.warn_of_overlaps(shapes, float(found.areas.sum()), who)
    return found


@explained
def read(path: Any) -> "Arrays":
    """The arrays of a file, as keywords of mesh(): mesh(**read("plate.poly"), min_angle=30).

    Figures: x.poly, x.node. Meshes, which mesh() keeps, and refines where it is asked for more: x.ele (with its points,
    segments and area bounds), x.vtu, x.msh, x.2dm, x.14, x.grd, x.h5 and
    x.vtkhdf (by h5py).
    """
    return _files.read_arrays(path, "read()")  # type: ignore[return-value]
