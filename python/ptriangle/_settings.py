"""Converts keywords of mesh() to settings of the library."""
from __future__ import annotations

import math
from ctypes import c_double
from dataclasses import dataclass
from typing import Any, Callable, Optional, Sequence, Tuple, Union

from . import _library as lib
from ._calls import Calls
from ._errors import InputError
from ._library import Settings
from ._progress import follow
from ._sizes import Near, Size, fields, length

Place = Tuple[float, float]
Unsuitable = Callable[[Place, Place, Place, float], Any]
Progress = Union[bool, Callable[[float, int], Any]]
PLACEMENTS = ("lattice", "classic", "front")  # enum tri_placement


def number(who: str, name: str, given: Any) -> float:
    try:
        return float(given)
    except (TypeError, ValueError, OverflowError):
        raise InputError("%s: %s is %r instead of a number" % (who, name, given)) from None


def whole(who: str, name: str, given: Any, bits: int = 32) -> int:
    """Converts to a signed integer with this number of bits; None is 0."""
    value = number(who, name, 0 if given is None else given)
    if not math.isfinite(value) or value != math.floor(value):
        raise InputError("%s: %s is %r instead of a whole number" % (who, name, given))
    found = given if isinstance(given, int) else int(value)
    if not -1 << (bits - 1) <= found < 1 << (bits - 1):
        raise InputError("%s: %s is %r: beyond the range of %d bits" % (who, name, given, bits))
    return found


def _refuse(who: str, name: str, given: Any) -> None:
    if given is not None and not callable(given):
        raise InputError("%s: %s is %r instead of a function" % (who, name, given))


def _take_sizes(settings: Settings, calls: Calls, wanted: "Wanted") -> None:
    if wanted.size is not None or wanted.size_near is not None:
        found, settings.kept = fields(calls, wanted.size, wanted.size_near)  # kept: the library uses these arrays
        settings.sizes, settings.n_sizes = found, len(found)
    for name in ("gradation", "min_size", "max_size", "elements_across", "per_circle"):
        if getattr(wanted, name) is not None:
            setattr(settings, name, length(calls.who, name, getattr(wanted, name)))


def _take_functions(settings: Settings, calls: Calls, unsuitable: Any, gate: Any, stop: Any) -> None:
    for name, function in (("unsuitable", unsuitable), ("gate", gate), ("stop", stop)):
        _refuse(calls.who, name, function)
    if unsuitable is not None:
        settings.unsuitable = lib.Unsuitable(calls.guarded(
            lambda _, a, b, c, area: int(bool(unsuitable((a[0], a[1]), (b[0], b[1]), (c[0], c[1]), area))), 0))
    if gate is not None:
        settings.gate = lib.Gate(calls.guarded(lambda _, at: bool(gate(at[0], at[1])), False))
    settings.stop = calls.stop(stop)


@dataclass
class Wanted:
    """The keywords that mesh(), refine() and bad() share; mesh() explains them."""

    min_angle: Optional[float] = None
    max_area: Optional[float] = None
    size: Optional[Size] = None
    unsuitable: Optional[Unsuitable] = None
    conforming: bool = False
    keep_hull: bool = False
    protect: int = 0
    max_new_points: Optional[int] = None
    gate: Optional[Callable[[float, float], Any]] = None
    fence: Optional[Sequence[float]] = None
    threads: Optional[int] = None
    stop: Optional[Callable[[], Any]] = None
    progress: Optional[Progress] = None
    placement: str = "lattice"
    size_near: Optional[Near] = None
    gradation: Optional[float] = None
    min_size: Optional[float] = None
    max_size: Optional[float] = None
    optimise: Optional[int] = None
    elements_across: Optional[float] = None
    per_circle: Optional[float] = None


def _placement(who: str, given: Any) -> int:
    if given not in PLACEMENTS:
        raise InputError('%s: placement: %r is not "lattice", "classic" or "front"' % (who, given))
    return PLACEMENTS.index(given)


def settings_of(who: str, wanted: Wanted) -> Tuple[Settings, Calls]:
    """Returns the settings of the library for a call of `who`, the name at the beginning of error messages."""
    calls = Calls(who)
    settings = Settings(min_angle=number(who, "min_angle", wanted.min_angle or 0),
                        max_area=number(who, "max_area", wanted.max_area or 0), conforming=bool(wanted.conforming),
                        keep_hull=bool(wanted.keep_hull), protect=whole(who, "protect", wanted.protect),
                        most_new_points=whole(who, "max_new_points", wanted.max_new_points, 64),
                        threads=whole(who, "threads", wanted.threads),
                        placement=_placement(who, wanted.placement))
    if wanted.fence is not None:
        if len(wanted.fence) != 4:
            raise InputError("%s: fence has %d numbers instead of 4" % (who, len(wanted.fence)))
        settings.fence = (c_double * 4)(*(number(who, "fence", value) for value in wanted.fence))
    _take_sizes(settings, calls, wanted)
    if wanted.optimise is not None:
        settings.optimise = whole(who, "optimise", wanted.optimise) or -1  # 0: none, which the library calls -1
    _take_functions(settings, calls, wanted.unsuitable, wanted.gate, wanted.stop)
    if wanted.progress:
        settings.progress = follow(calls, wanted.progress)
    return settings, calls
