"""Reads polygons in many forms: rings, lists of rings, shapely geometries, series of geopandas, GeoJSON."""
from __future__ import annotations

from typing import Any, Iterable, Iterator, List, Mapping, Tuple

import numpy as np

from ._arrays import Array, numbers
from ._errors import InputError

Polygon = List[Array]  # an outline and its holes: rings [k, 2], without the first point repeated at the end


def _ring(given: Any, name: str) -> Array:
    ring = numbers(given, name).astype(np.float64, copy=False)
    if ring.ndim != 2 or ring.shape[1] not in (2, 3, 4):
        raise InputError("%s: a ring of shape %s instead of (n, 2)" % (name, ring.shape))
    ring = ring[:, :2]  # ignores z
    return ring[:-1] if len(ring) > 1 and np.array_equal(ring[0], ring[-1]) else ring


def _of_mapping(geometry: Mapping[str, Any], name: str) -> Iterator[Polygon]:
    """Reads a GeoJSON object, such as one of __geo_interface__."""
    kind = geometry.get("type")
    if kind in ("FeatureCollection", "GeometryCollection"):
        for part in geometry["features" if kind == "FeatureCollection" else "geometries"]:
            yield from _of_mapping(part, name)
    elif kind == "Feature":
        if geometry["geometry"] is not None:
            yield from _of_mapping(geometry["geometry"], name)
    elif kind in ("Polygon", "MultiPolygon"):
        for rings in [geometry["coordinates"]] if kind == "Polygon" else geometry["coordinates"]:
            yield [_ring(ring, name) for ring in rings if len(ring) > 0]
    elif kind == "LinearRing":
        yield [_ring(geometry["coordinates"], name)]
    else:
        raise InputError("%s: a %s is no polygon" % (name, kind))


def _is_list_of_rings(given: Any) -> bool:
    """Returns True for [outer, hole, ..], False for one ring."""
    return isinstance(given, (list, tuple)) and len(given) > 0 and np.ndim(given[0]) == 2


def _of_any(given: Any, name: str) -> Iterator[Polygon]:
    geometry = getattr(given, "__geo_interface__", given)
    if isinstance(geometry, Mapping):
        yield from _of_mapping(geometry, name)
    elif _is_list_of_rings(given):
        yield [_ring(ring, name) for ring in given]
    elif given is not None:
        yield [_ring(given, name)]


def items_of(given: Any, name: str) -> Tuple[List[List[Polygon]], List[Mapping[str, Any]]]:
    """Returns the polygons of each item (a feature, a shape, a list of rings), and its properties by name."""
    geometry, one = getattr(given, "__geo_interface__", given), False
    if isinstance(geometry, Mapping):
        kind = geometry.get("type")
        one = kind not in ("FeatureCollection", "GeometryCollection")
        given = [geometry] if one else geometry["features" if kind == "FeatureCollection" else "geometries"]
    elif not isinstance(given, Iterable):
        raise InputError("%s: %r instead of a list of rings or polygons" % (name, type(given).__name__))
    items = list(given)
    return ([list(_of_any(item, name if one else "%s[%d]" % (name, k))) for k, item in enumerate(items)],
            [(item.get("properties") or {}) if isinstance(item, Mapping) else {} for item in items])


def column_of(given: Any, properties: List[Mapping[str, Any]], name: str) -> Array:
    """Returns a number for each item. It is given for each, for all, or as the name of a property; NaN if missing."""
    if isinstance(given, str):
        known = ", ".join(sorted({key for item in properties for key in item}))
        if not any(given in item for item in properties):
            raise InputError("%s: no polygon has the property %r%s" % (name, given, known and ", but " + known))
        given = [item.get(given) for item in properties]
        given = [np.nan if value is None else value for value in given]
    values = numbers(given, name).astype(np.float64)
    if values.shape not in ((), (len(properties),)):
        raise InputError("%s: shape %s for %d polygons" % (name, values.shape, len(properties)))
    return np.broadcast_to(values, len(properties)).copy()


def _area(ring: Array) -> float:
    """Returns the area of a ring that does not cross itself."""
    if len(ring) < 3:
        return 0.0
    x, y = (ring - ring[0]).T
    return float(abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2)


def areas_of(polygons: Iterable[Polygon]) -> Array:
    """Returns the areas [n] of valid polygons."""
    return np.array([_area(polygon[0]) - sum(map(_area, polygon[1:])) if polygon else 0.0 for polygon in polygons])


def segments_of(polygons: Iterable[Polygon], first: int) -> Tuple[Array, Array]:
    """Returns points and segments of all rings. Numbers begin with `first`."""
    points, segments = [np.empty((0, 2))], [np.empty((0, 2), np.int64)]
    for ring in (ring for polygon in polygons for ring in polygon):
        number = np.arange(first, first + len(ring))
        points.append(ring)
        segments.append(np.column_stack([number, np.roll(number, -1)]))
        first += len(ring)
    return np.concatenate(points), np.concatenate(segments)
