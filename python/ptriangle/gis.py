"""From maps to meshes and back: coasts and regions from files, sizes from depths, files for solvers.

Coordinates must be lengths: read(path, crs="utm") projects degrees to metres. Each function imports the packages that
it needs: shapely by sea(), cleaned(), figure() and sampled(), geopandas by read(), rasterio by raster() (not for .asc),
scipy by write() for .nc.

    python -m ptriangle.gis MAP FILE.poly      # a figure with a region for each polygon of the map
"""
from __future__ import annotations

import importlib
import os
from typing import Any, Dict, List, Optional, Sequence, Tuple

import numpy as np
import numpy.typing as npt

from . import _files, _make, _rings
from ._arrays import Array, as_int32, numbers
from ._errors import FileError, InputError
from ._mesh import Mesh
from ._notes import warn
from ._sizes import length

Raster = Tuple[Array, Tuple[float, float, float, float]]
"""Values [rows, columns], the lowest row first, NaN for no data; and x_min, y_min, x_max, y_max of the outer values."""

_GRAVITY = 9.81
_HEAD = ("ncols", "nrows", "xllcorner", "yllcorner", "xllcenter", "yllcenter", "cellsize", "dx", "dy", "nodata_value")


def _need(package: str, who: str) -> Any:
    try:
        return importlib.import_module(package)
    except ImportError:
        name = package.split(".")[0]
        raise ImportError("%s needs %s: pip install %s" % (who, name, name)) from None


def read(path: Any, crs: Any = None, **wanted: Any) -> Any:
    """The GeoDataFrame of a shapefile, GeoPackage or GeoJSON file, in the coordinate system `crs`: any name of pyproj
    ("EPSG:3035"), or "utm" for the UTM zone of the data. wanted: keywords of geopandas.read_file (layer, bbox, ..)."""
    frame = _need("geopandas", "gis.read()").read_file(path, **wanted)
    return frame if crs is None else frame.to_crs(frame.estimate_utm_crs() if crs == "utm" else crs)


def _shapes(given: Any, who: str) -> List[Any]:
    """Returns the shapely geometry of each item; None is skipped."""
    shapely = _need("shapely", who)
    shapes = given.geometry.to_numpy() if hasattr(given, "geometry") and hasattr(given.geometry, "to_numpy") else \
        given if isinstance(given, (list, tuple, np.ndarray)) else [given]
    if all(shape is None or isinstance(shape, shapely.Geometry) for shape in shapes):
        return [shape for shape in shapes if shape is not None]
    items = _rings.items_of(given, who)[0]
    return [shapely.MultiPolygon([(rings[0], rings[1:]) for rings in item]) for item in items]


def _areas(given: Any, who: str) -> List[Any]:
    """Returns the shapes, each as one or several valid polygons. Lines and points are left out."""
    shapely = _need("shapely", who)
    return [shape if shape.is_valid and "Polygon" in shape.geom_type else
            shapely.union_all(shapely.make_valid(shapely.get_parts(shape))).buffer(0) for shape in _shapes(given, who)]


def cleaned(polygons: Any, min_edge: float) -> List[Any]:
    """Returns shapely polygons with less detail. An InputWarning reports the changes.

    The method of Visvalingam and Whyatt removes corners whose triangle has an area below min_edge^2 / 2. On shared
    borders it removes them from both polygons. No new crossings or contacts arise. Islands and lakes smaller than
    min_edge^2 are removed. Polygons must not overlap."""
    who = "gis.cleaned()"
    shapely, before, min_edge = _need("shapely", who), _areas(polygons, who), length(who, "min_edge", min_edge)
    if not hasattr(shapely, "coverage_simplify"):
        raise ImportError("%s needs shapely 2.1, and there is %s" % (who, shapely.__version__))

    def rings_of(polygon: Any) -> Any:
        holes = [hole for hole in polygon.interiors if shapely.Polygon(hole).area >= min_edge ** 2]
        return shapely.Polygon(polygon.exterior, holes)

    def kept(shape: Any) -> Any:
        parts = [rings_of(part) for part in shapely.get_parts(shape) if shapely.Polygon(part.exterior).area
                 >= min_edge ** 2]
        return parts[0] if len(parts) == 1 else shapely.MultiPolygon(parts)
    after = [kept(shape) for shape in shapely.coverage_simplify([kept(shape) for shape in before], min_edge / 2 ** 0.5)]

    def count(shapes: Any) -> Tuple[int, int, float]:
        rings = shapely.get_rings(shapely.get_parts(shapes))
        return int(shapely.get_num_coordinates(rings).sum()) - len(rings), len(rings), float(shapely.area(shapes).sum())
    old, new = count(before), count(after)
    warn("of %d corners %d are left, of %d rings %d; the area changes by %.2g%%%s" % (
        old[0], new[0], old[1], new[1], 100 * abs(new[2] - old[2]) / old[2] if old[2] else 0,
        "" if new[1] or not old[1] else ". No polygon is left: is min_edge a length in their coordinates?"), who)
    return after


def figure(shapes: Any, markers: Any = None) -> Dict[str, Any]:
    """Polygons and lines, in any mixture, as keywords of mesh(): points, segments, segment_markers, and holes="auto"
    (which makes holes of rings in rings). markers: for each shape the marker of its segments; an array, or the name of
    a column."""
    who = "gis.figure()"
    shapely, items = _need("shapely", who), np.array(_shapes(shapes, who), object)
    if isinstance(markers, str):
        markers = shapes[markers].to_numpy()[shapes.geometry.notna().to_numpy()]
    flat, item = shapely.get_parts(items, return_index=True)
    polygonal = shapely.get_dimensions(flat) == 2
    rings, of = shapely.get_rings(flat[polygonal], return_index=True)
    lines = np.concatenate([rings, flat[~polygonal]])
    owner = np.concatenate([item[polygonal][of], item[~polygonal]])
    points, line = shapely.get_coordinates(lines, return_index=True)
    first = np.nonzero(line[1:] == line[:-1])[0]
    own = np.zeros(len(items), np.int32) if markers is None else as_int32(markers, who + ": markers")
    return {"points": points, "segments": np.column_stack([first, first + 1]), "holes": "auto",
            "segment_markers": np.broadcast_to(own, len(items))[owner[line[first]]]}


def sea(land: Any, bounds: Sequence[float], *, min_edge: Optional[float] = None, coast: int = 1,
        open_boundary: int = 2, largest: bool = True) -> Dict[str, Any]:
    """Returns the sea in a box as keywords of mesh(): points, segments, their markers, and holes="auto".

    land: polygons, which may overlap. bounds: x_min, y_min, x_max, y_max. min_edge: simplifies the land with cleaned()
    first. coast, open_boundary: markers of the coast and of the sides of the box. largest: keeps only the largest
    connected sea.
    """
    who = "gis.sea()"
    shapely = _need("shapely", who)
    if np.shape(bounds) != (4,) or not np.isfinite(numbers(bounds, who + ": bounds")).all():
        raise InputError("%s: bounds: %r instead of four finite numbers" % (who, bounds))
    box, solid = shapely.box(*bounds), shapely.union_all(_areas(land, who))
    if not solid.intersects(box):
        warn("no land in the box %s: is it in the coordinates of the land (crs=)?" % (tuple(bounds),), who)
    if min_edge is not None:
        solid = shapely.union_all(cleaned([solid], min_edge))
    parts = shapely.get_parts(box.difference(solid))
    parts = parts[shapely.area(parts) > 0]
    if len(parts) == 0:
        raise InputError("%s: no sea in the box %s" % (who, tuple(bounds)))
    found = figure(parts[[shapely.area(parts).argmax()]] if largest else parts)
    middle = found["points"][found["segments"]].mean(axis=1)
    away = shapely.distance(shapely.points(middle), box.exterior)
    found["segment_markers"] = np.where(away <= 1e-9 * box.length, open_boundary, coast).astype(np.int32)
    return found


def _read_asc(path: str) -> Raster:
    """Reads an ESRI ASCII grid."""
    head: Dict[str, float] = {}
    try:
        with open(path, encoding="utf-8-sig") as file:
            words = file.read().split()
        while words and words[0].lower() in _HEAD:
            head[words[0].lower()], words = float(words[1]), words[2:]
        rows = np.array(words, float).reshape(int(head["nrows"]), int(head["ncols"]))[::-1].copy()
        step = [head.get("cellsize") or head["d" + axis] for axis in "xy"]
        low = [head[axis + "llcenter"] if axis + "llcenter" in head else head[axis + "llcorner"] + size / 2
               for axis, size in zip("xy", step)]
    except (LookupError, ValueError) as fault:
        raise FileError("%s: no ESRI ASCII grid (%s)" % (path, fault)) from None
    rows[rows == head.get("nodata_value", -9999)] = np.nan
    return rows, (low[0], low[1], low[0] + (rows.shape[1] - 1) * step[0], low[1] + (rows.shape[0] - 1) * step[1])


def raster(path: Any, crs: Any = None, band: int = 1) -> Raster:
    """Returns values and extent of a raster in the form of mesh(size=). An ESRI ASCII grid (.asc) needs no package.
    GeoTIFF, NetCDF and the other formats of GDAL need rasterio. crs: the coordinate system of the result."""
    path = os.fspath(path)
    if path.lower().endswith(".asc") and crs is None:
        return _read_asc(path)
    rasterio, vrt = _need("rasterio", "gis.raster()"), _need("rasterio.vrt", "gis.raster()")
    with rasterio.open(path) as file:
        if crs is not None and file.crs is None:
            raise InputError("gis.raster(): %s: the file does not name its coordinates: crs= has no meaning" % path)
        with vrt.WarpedVRT(file, crs=crs or file.crs, resampling=rasterio.enums.Resampling.bilinear,
                           dtype="float64", nodata=np.nan) as warped:
            rows, (x_min, y_min, x_max, y_max) = warped.read(band)[::-1].copy(), warped.bounds
    x, y = (x_max - x_min) / rows.shape[1] / 2, (y_max - y_min) / rows.shape[0] / 2
    return rows, (x_min + x, y_min + y, x_max - x, y_max - y)


def sampled(values: Raster, points: npt.ArrayLike) -> Array:
    """Returns values of a raster at places [n, 2]: bilinear between known values, otherwise the nearest known value."""
    who = "gis.sampled()"
    rows, (x_min, y_min, x_max, y_max) = numbers(values[0], who).astype(np.float64), values[1]
    at = numbers(points, who + ": points").astype(np.float64)
    if rows.ndim != 2 or at.ndim != 2 or at.shape[1] != 2:
        raise InputError("%s: values of shape %s and points of shape %s" % (who, rows.shape, at.shape))
    high = np.array(rows.shape[::-1]) - 1
    step = np.array([x_max - x_min, y_max - y_min]) / np.maximum(high, 1)
    place = (at - [x_min, y_min]) / np.where(step > 0, step, 1)
    inside = ((place >= 0) & (place <= high)).all(axis=1)
    low = np.clip(np.floor(place), 0, np.maximum(high - 1, 0)).astype(int)
    share = np.clip(place - low, 0, 1)
    known, weights = np.zeros(len(at)), np.zeros(len(at))
    for corner in ((0, 0), (1, 0), (0, 1), (1, 1)):
        column, row = np.minimum(low + corner, high).T
        weight = np.where(np.array(corner) == 1, share, 1 - share).prod(axis=1) * np.isfinite(rows[row, column])
        known += weight * np.nan_to_num(rows[row, column])
        weights += weight
    missing = ~inside | (weights < 1e-9)
    found = known / np.where(missing, 1, weights)
    if missing.any():
        padded = np.pad(np.isfinite(rows), 1)  # known values next to missing ones: one of these is the nearest
        rim = padded[1:-1, 1:-1] & ~(padded[:-2, 1:-1] & padded[2:, 1:-1] & padded[1:-1, :-2] & padded[1:-1, 2:])
        shapely, (row, column) = _need("shapely", who), np.nonzero(rim)
        if len(row) == 0:
            raise InputError("%s: the raster has no values" % who)
        tree = shapely.STRtree(shapely.points(np.column_stack([column, row]) * step + [x_min, y_min]))
        nearest = tree.nearest(shapely.points(at[missing]))
        found[missing] = rows[row[nearest], column[nearest]]
    return found


def wave_sizes(depths: Raster, period: float, n: float = 20, min_depth: float = 1) -> Raster:
    """Returns edge lengths such that n edges fit into a wavelength for this period (seconds): sqrt(g depth) period / n.
    Depths are in metres, positive downwards. Shallower places count as min_depth."""
    period, n = (length("gis.wave_sizes()", name, given) for name, given in (("period", period), ("n", n)))
    return np.sqrt(_GRAVITY * np.maximum(depths[0], min_depth)) * period / n, depths[1]


def slope_sizes(depths: Raster, n: float = 15, min_depth: float = 1) -> Raster:
    """Returns edge lengths at slopes of the bottom: 2 pi depth / (n |gradient of depth|); infinite at flat places."""
    rows, (x_min, y_min, x_max, y_max) = np.maximum(depths[0], min_depth), depths[1]
    along_y, along_x = np.gradient(rows, (y_max - y_min) / (rows.shape[0] - 1), (x_max - x_min) / (rows.shape[1] - 1))
    slope = np.hypot(along_x, along_y)
    return np.where(slope > 0, 2 * np.pi * rows / n / np.where(slope > 0, slope, 1),
                    np.where(np.isnan(slope), np.nan, np.inf)), depths[1]


def _write_ugrid(path: str, points: Array, triangles: Array, depths: Optional[Array], metres: bool) -> None:
    """Writes NetCDF by the conventions of UGRID 1.0. metres: points are in metres; if False, no unit is written."""
    with _need("scipy.io", "gis.write() of .nc").netcdf_file(path, "w", version=2) as file:
        file.Conventions = "CF-1.8 UGRID-1.0"
        for name, length in (("node", len(points)), ("face", len(triangles)), ("corner", 3)):
            file.createDimension(name, length)

        def add(name: str, kind: str, dimensions: Tuple[str, ...], values: Any, **about: Any) -> None:
            variable = file.createVariable(name, kind, dimensions)
            variable[...] = values
            for key, value in about.items():
                setattr(variable, key, value)
        add("mesh2d", "i", (), 0, cf_role="mesh_topology", topology_dimension=np.int32(2), face_dimension="face",
            node_coordinates="node_x node_y", face_node_connectivity="face_nodes")
        add("face_nodes", "i", ("face", "corner"), triangles, cf_role="face_node_connectivity", start_index=np.int32(0))
        for axis, values in zip("xy", points.T):
            add("node_" + axis, "d", ("node",), values, **(
                {"standard_name": "projection_%s_coordinate" % axis, "units": "m"} if metres else {}))
        if depths is not None:
            add("depth", "d", ("node",), depths, standard_name="sea_floor_depth_below_geoid", units="m",
                positive="down", mesh="mesh2d", location="node")


def write(mesh: Mesh, path: Any, depths: Optional[npt.ArrayLike] = None,
          points: Optional[npt.ArrayLike] = None) -> None:
    """Writes a mesh with depths at its points: x.14 or x.grd (ADCIRC, SCHISM), x.2dm (SMS, QGIS), x.msh (Gmsh), x.nc
    (UGRID), and all formats of Mesh.write(). points: other coordinates [n, 2], such as longitudes and latitudes."""
    who = "gis.write()"
    path, arrays = os.fspath(path), mesh._all_arrays()
    if mesh.order != 1:
        raise InputError("%s: a mesh of second order" % who)
    for name, key, given, shape in (("points", "points", points, (len(mesh.points), 2)),
                                    ("depths", "point_attributes", depths, (len(mesh.points),))):
        if given is not None:
            rows = numbers(given, who + ": " + name).astype(np.float64)
            if rows.shape != shape or not np.isfinite(rows).all():
                raise InputError("%s: %s of shape %s for %d points, %d of them not finite" % (
                    who, name, rows.shape, len(mesh.points), np.count_nonzero(~np.isfinite(rows))))
            arrays[key] = rows.reshape(len(rows), -1)
    if path.lower().endswith(".nc"):
        _write_ugrid(path, arrays["points"], arrays["triangles"],
                     None if depths is None else arrays["point_attributes"][:, 0], points is None)
    else:
        _files.write_arrays(path, arrays, 1, who)


def write_figure(polygons: Any, path: Any, *, attributes: Any = None, areas: Any = None,
                 grid: Optional[float] = None) -> None:
    """Writes a .poly file with a region for each polygon, as in mesh(overlay=True)."""
    who = "gis.write_figure()"
    if not os.fspath(path).lower().endswith(".poly"):
        raise InputError("%s: %s: the name does not end in .poly" % (who, path))
    given: Dict[str, Any] = dict.fromkeys(("points", "segments", "segment_markers", "holes", "regions", "triangles"))
    found, told = _make._laid(given, polygons, {"attributes": attributes, "areas": areas}, grid, False, who)
    if "attributes" in told:
        given["regions"][:, 2] = np.nan_to_num(told["attributes"])[found.owners]
    _files.write_arrays(path, dict(given, triangles=np.empty((0, 3), np.int32)), 1, who)


def _main() -> None:
    import argparse
    parser = argparse.ArgumentParser(prog="python -m ptriangle.gis", description="Writes a .poly file of a map.")
    parser.add_argument("map", help="a shapefile, GeoPackage or GeoJSON file")
    parser.add_argument("poly", help="the .poly file to write")
    parser.add_argument("--attributes", metavar="COLUMN", help="attributes of the regions (default: their numbers)")
    parser.add_argument("--areas", metavar="COLUMN", help="bounds on the areas of triangles")
    parser.add_argument("--grid", type=float, help="snaps borders to a grid of this width")
    parser.add_argument("--crs", help='coordinates, such as EPSG:3035, or utm')
    told = parser.parse_args()
    try:
        write_figure(read(told.map, told.crs), told.poly, attributes=told.attributes, areas=told.areas, grid=told.grid)
    except Exception as fault:
        parser.error(str(fault))


if __name__ == "__main__":
    _main()
