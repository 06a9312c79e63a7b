"""Converts between arrays of the library and of numpy."""
from __future__ import annotations

from typing import Any, Iterable, Optional, Tuple, Type, Union

import numpy as np
import numpy.typing as npt

from ._errors import InputError
from ._library import Ints, Reals

Array = npt.NDArray[Any]


class _View:
    """The array interface of an array of the library, with a reference to its owner."""

    def __init__(self, array: Union[Reals, Ints], owner: object) -> None:
        size = array.dtype.itemsize
        self.owner = owner
        self.__array_interface__ = {
            "version": 3, "typestr": array.dtype.str, "data": (array.at, True),
            "shape": (array.n, array.width), "strides": (array.stride * size, size)}


def to_numpy(array: Union[Reals, Ints], owner: object) -> Array:
    """Returns a read-only array [n][width] without a copy. It keeps its owner alive."""
    if array.n == 0:
        return np.empty((0, array.width), array.dtype)
    return np.asarray(_View(array, owner))


def freeze(arrays: Iterable[Array]) -> None:
    """Makes arrays read-only."""
    for rows in arrays:
        rows.flags.writeable = False


def _refuse_other_ints(rows: Array, name: str) -> None:
    if rows.dtype.kind not in "iub":
        raise InputError("%s: %s instead of integers" % (name, rows.dtype))
    if rows.max() > np.iinfo(np.int32).max or rows.min() < np.iinfo(np.int32).min:
        raise InputError("%s: beyond the range of 32 bits" % name)


def as_int32(given: Any, name: str) -> Array:
    """Converts to 32-bit integers. Values that do not fit are errors."""
    rows = numbers(given, name)
    if rows.dtype == np.int32:
        return rows
    if rows.size and not (rows.max() <= np.iinfo(np.int32).max and rows.min() >= np.iinfo(np.int32).min):
        raise InputError("%s: beyond the range of 32 bits" % name)
    return rows.astype(np.int32, copy=False)


def numbers(given: Any, name: str) -> Array:
    """Converts any input to an array of numbers."""
    try:
        rows = np.asarray(given)
        return rows if rows.dtype.kind in "fiub" else rows.astype(np.float64)
    except (TypeError, ValueError) as fault:
        raise InputError("%s: no array of numbers (%s)" % (name, fault)) from None


def from_numpy(kind: Union[Type[Reals], Type[Ints]], given: Any, name: str,
               width: Optional[int] = None) -> Tuple[Union[Reals, Ints], Optional[Array]]:
    """Returns (array of the library, numpy array that must live as long). Rows of equal steps are not copied."""
    rows = numbers(given, name)
    if rows.size == 0:
        return kind(), None
    if kind is Ints and rows.dtype != kind.dtype:
        _refuse_other_ints(rows, name)
    rows = rows.astype(kind.dtype, copy=False)
    if rows.ndim == 1 and width in (None, 1):
        rows = rows.reshape(-1, 1)
    if rows.ndim != 2 or (width is not None and rows.shape[1] != width):
        raise InputError("%s: shape %s instead of (n, %s)" % (name, rows.shape, "any" if width is None else width))
    step, item = rows.strides
    n, width = rows.shape
    if item != rows.itemsize or step % item or step < width * item or not rows.flags.aligned:
        rows, step = np.ascontiguousarray(rows), width * rows.itemsize
    return kind(rows.ctypes.data, n, width, step // rows.itemsize), rows
