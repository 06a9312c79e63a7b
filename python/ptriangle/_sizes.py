"""Converts sizes, the desired lengths of edges, to struct tri_size_field of the library."""
from __future__ import annotations

from ctypes import POINTER, c_double, cast
from typing import Any, Callable, List, Mapping, Optional, Tuple, Union

import numpy as np

from ._arrays import Array, as_int32, from_numpy, numbers
from ._calls import Calls
from ._errors import InputError
from ._library import Ints, Reals, SizeArrays, SizeField
from ._notes import warn

Function = Callable[[Any, Any], Any]
Size = Union[float, Function, Tuple[Any, ...], List[Any]]
Near = Mapping[int, Union[float, Tuple[float, float]]]
NUMBER, RASTER, MESH, FUNCTION, NEAR = range(1, 6)  # enum tri_size_kind


def length(who: str, name: str, given: Any, least: float = 0) -> float:
    try:
        found = float(given)
    except (TypeError, ValueError):
        raise InputError("%s: %s is %r instead of a number" % (who, name, given)) from None
    if not found > least:
        raise InputError("%s: %s: %g is not > %g" % (who, name, found, least))
    return found


def _raster(who: str, values: Any, extent: Any, kept: List[Any]) -> SizeField:
    rows = numbers(values, who + ": size").astype(np.float64, copy=False)
    bounds = numbers(extent, who + ": size: extent").astype(np.float64).ravel()
    if rows.ndim != 2 or rows.size == 0 or len(bounds) != 4:
        raise InputError("%s: size: a pair is an array [rows, columns] and x_min, y_min, x_max, y_max" % who)
    steps = np.maximum(np.array(rows.shape[::-1]) - 1, 1)
    step = (bounds[2:] - bounds[:2]) / steps
    if not (np.isfinite(step).all() and (step > 0).all()):
        raise InputError("%s: size: extent %s is not x_min < x_max, y_min < y_max" % (who, tuple(bounds)))
    field = SizeField(kind=RASTER, origin=tuple(bounds[:2]), step=tuple(step))
    field.values, held = from_numpy(Reals, rows, who + ": size")
    kept.append(held)
    return field


def _mesh(who: str, points: Any, triangles: Any, values: Any, kept: List[Any]) -> SizeField:
    field = SizeField(kind=MESH)
    field.points, at = from_numpy(Reals, points, who + ": size: points", 2)
    field.triangles, corners = from_numpy(Ints, as_int32(triangles, who + ": size: triangles"),
                                          who + ": size: triangles", 3)
    field.values, held = from_numpy(Reals, values, who + ": size: values", 1)
    kept += [at, corners, held]
    return field


def _on_arrays(calls: Calls, function: Function) -> Callable[[Array, Array], Array]:
    """Makes a function of arrays. A function of single numbers is called for each place, with a warning."""
    name = str(getattr(function, "__name__", type(function).__name__))
    each: List[bool] = []

    def one(x: float, y: float) -> float:
        given = function(x, y)
        try:
            return float(given)
        except (TypeError, ValueError):
            raise TypeError("%s: size: %s(%r, %r) returned %r instead of a number"
                            % (calls.who, name, x, y, given)) from None

    def takes_arrays(x: Array, y: Array) -> Optional[Array]:
        try:
            found = np.asarray(function(x, y), np.float64)
        except (TypeError, ValueError):
            return None
        if found.size == x.size and len(x) > 1:
            return found.ravel()
        return np.broadcast_to(found, x.shape) if found.shape in ((), x.shape) else None

    def ask(x: Array, y: Array) -> Array:
        found = None if each else takes_arrays(x, y)
        if found is None:
            if not each:
                warn("size: %s takes no arrays, and is asked place by place, which is slow" % name, calls.who)
            each.append(True)
            found = np.array([one(float(a), float(b)) for a, b in zip(x, y)])
        return found
    return ask


def _function(calls: Calls, function: Function) -> SizeField:
    asked = _on_arrays(calls, function)

    def ask(_user: Any, n: int, at: Any, length: Any) -> None:
        places = np.ctypeslib.as_array(cast(at, POINTER(c_double)), (n, 2))
        np.ctypeslib.as_array(length, (n,))[:] = asked(places[:, 0].copy(), places[:, 1].copy())
    return SizeField(kind=FUNCTION, function=SizeArrays(calls.guarded(ask, None)))


def _field(calls: Calls, size: Any, kept: List[Any]) -> SizeField:
    if callable(size):
        return _function(calls, size)
    if isinstance(size, tuple) and len(size) == 2:
        return _raster(calls.who, *size, kept)
    if isinstance(size, tuple) and len(size) == 3:
        return _mesh(calls.who, *size, kept)
    return SizeField(kind=NUMBER, length=length(calls.who, "size", size))


def _near(who: str, marker: Any, given: Any) -> SizeField:
    pair = given if isinstance(given, (tuple, list)) else (given,)
    if len(pair) not in (1, 2):
        raise InputError("%s: size_near: %r is neither a length nor a length and its growth" % (who, given))
    growth = -1.0 if len(pair) == 1 else length(who, "size_near: growth", pair[1], -1e-300)
    found = int(as_int32([marker], who + ": size_near: marker")[0])
    return SizeField(kind=NEAR, marker=found, length=length(who, "size_near", pair[0]), growth=growth)


def fields(calls: Calls, size: Optional[Size], size_near: Optional[Near]) -> Tuple[Any, List[Any]]:
    """Returns an array of SizeField, and the objects that must live as long."""
    kept: List[Any] = []
    given = size if isinstance(size, list) else [] if size is None else [size]
    found = [_field(calls, one, kept) for one in given]
    if not isinstance(size_near, (dict, type(None))):
        raise InputError("%s: size_near is %r instead of a dict of markers" % (calls.who, size_near))
    found += [_near(calls.who, marker, one) for marker, one in (size_near or {}).items()]
    return (SizeField * len(found))(*found), [found, kept]
