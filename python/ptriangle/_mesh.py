"""Meshes as Python has them: made by mesh(), refined, judged, written."""
import math
import os
import threading
from ctypes import byref, c_double, c_int64, c_void_p

import numpy as np

from . import _library as lib
from . import _notes
from ._library import Demands, ErrorDetail, Figure, InputError, Ints, Reals, Settings, VerdictDetail, library

_PARALLEL = hasattr(library, "par_mesh_new")
_SHAPES = {  # of a figure: the library's kind, and the width of a row
    "points": (Reals, 2), "point_attributes": (Reals, None), "point_markers": (Ints, 1), "segments": (Ints, 2),
    "segment_markers": (Ints, 1), "holes": (Reals, 2), "regions": (Reals, 4), "triangles": (Ints, 3),
    "triangle_attributes": (Reals, None), "triangle_areas": (Reals, 1)}
_COUNTS = ("duplicates", "crossings", "skipped_segments", "new_points", "new_points_on_segments", "gated", "fenced")
_REASONS = ("input_angle", "narrow_gap", "protected", "limit", "precision", "deferred")


def _figure_of(arrays):
    figure, kept = Figure(), []
    for name, given in arrays.items():
        kind, width = _SHAPES[name]
        array, owner = lib.from_numpy(kind, given, name, width)
        setattr(figure, name, array)
        kept.append(owner)
    return figure, kept


class _Callbacks:
    """Python functions that the library calls. The first exception in one ends the work, and is raised after it."""

    def __init__(self):
        self.fault = None
        self.main = threading.current_thread() is threading.main_thread()

    def guarded(self, function, otherwise):
        def call(*arguments):
            if self.fault is not None:
                return otherwise
            try:
                return function(*arguments)
            except BaseException as fault:  # KeyboardInterrupt, too
                self.fault = fault
                return otherwise
        return call

    def stop(self, function):
        def asked(_user):
            return self.fault is not None or (function is not None and bool(function()))
        guarded = self.guarded(asked, True)
        return lib.Stop(lambda user: self.fault is not None or guarded(user))


def _callbacks_of(settings, size, unsuitable, gate, stop):
    calls = _Callbacks()
    if isinstance(size, lib.Length):
        settings.edge_length = size
        settings.callbacks_in_parallel = unsuitable is None
    elif callable(size):
        settings.edge_length = lib.Length(calls.guarded(lambda _, at: float(size(at[0], at[1])), math.inf))
    elif size is not None:
        size = float(size)
        if not size > 0:
            raise InputError("size: %g is not > 0" % size, 3)
        area = math.sqrt(3) / 4 * size * size
        settings.max_area = min(settings.max_area, area) if settings.max_area > 0 else area
    if unsuitable is not None:
        settings.unsuitable = lib.Unsuitable(calls.guarded(
            lambda _, a, b, c, area: int(bool(unsuitable((a[0], a[1]), (b[0], b[1]), (c[0], c[1]), area))), 0))
    if gate is not None:
        settings.gate = lib.Gate(calls.guarded(lambda _, at: bool(gate(at[0], at[1])), False))
    settings.stop = calls.stop(stop)
    return calls


def _settings_of(min_angle=0, max_area=None, size=None, unsuitable=None, conforming=False, keep_hull=False, protect=0,
                 max_new_points=None, gate=None, fence=None, threads=None, stop=None):
    settings = Settings(min_angle=float(min_angle or 0), max_area=float(max_area or 0), conforming=bool(conforming),
                        keep_hull=bool(keep_hull), protect=int(protect), most_new_points=int(max_new_points or 0),
                        threads=int(threads or 0))
    if fence is not None:
        settings.fence = (c_double * 4)(*map(float, fence))
    return settings, _callbacks_of(settings, size, unsuitable, gate, stop)


def _run(function, calls, *arguments):
    """Calls the library, which needs no lock of the interpreter meanwhile."""
    error = ErrorDetail()
    status = function(*arguments, byref(error))
    if calls is not None and calls.fault is not None:
        raise calls.fault
    lib.check(status, error)


class _Handle:
    """The library's mesh, deleted with the last array that looks into it."""

    def __init__(self):
        self.mesh = c_void_p()

    def __del__(self, delete=library.tri_mesh_delete):
        delete(self.mesh)
        self.mesh = None


class Verdict:
    """What check() found. Truth value: the mesh is as it should be."""

    def __init__(self, detail):
        for name, _ in VerdictDetail._fields_:
            value = getattr(detail, name)
            setattr(self, name, value.decode("utf-8", "replace") if isinstance(value, bytes) else value)

    def __bool__(self):
        return self.n_faults == 0

    def __repr__(self):
        return "<Verdict: %s>" % ("sound" if self else "%d faults: %s" % (self.n_faults, self.text))


class Mesh:
    """A triangle mesh. Arrays are numpy's, read-only, and see the library's memory without a copy.

    points [n, 2] float64            triangles [m, 3] int32, counter-clockwise
    point_markers [n] int32          triangle_attributes [m, k] float64, k 0 where there are none
    point_attributes [n, k] float64  neighbors [m, 3] int32, opposite each corner; -1: none
    segments [s, 2] int32            edges [e, 2] int32
    segment_markers [s] int32        edge_markers [e] int32
    """

    def __init__(self, handle):
        self._handle = handle

    def _rows(self, name):
        return lib.to_numpy(getattr(library, "tri_mesh_" + name)(self._handle.mesh), self._handle)

    def _values(self, name, of):
        """The same, with a row of no columns for each where there are none."""
        rows = self._rows(name)
        return rows if len(rows) else np.empty((len(of), 0))

    points = property(lambda self: self._rows("points"))
    point_attributes = property(lambda self: self._values("point_attributes", self.points))
    point_markers = property(lambda self: self._rows("point_markers")[:, 0])
    triangles = property(lambda self: self._rows("triangles"))
    triangle_attributes = property(lambda self: self._values("triangle_attributes", self.triangles))
    segments = property(lambda self: self._rows("segments"))
    segment_markers = property(lambda self: self._rows("segment_markers")[:, 0])

    @property
    def neighbors(self):
        found = Ints()
        _run(library.tri_mesh_neighbors, None, self._handle.mesh, byref(found))
        return lib.to_numpy(found, self._handle)

    def _edges(self):
        edges, markers = Ints(), Ints()
        _run(library.tri_mesh_edges, None, self._handle.mesh, byref(edges), byref(markers))
        return lib.to_numpy(edges, self._handle), lib.to_numpy(markers, self._handle)[:, 0]

    edges = property(lambda self: self._edges()[0])
    edge_markers = property(lambda self: self._edges()[1])

    @property
    def counts(self):
        """What was odd about the input, and what the last refinement did."""
        return {name: library.tri_mesh_count(self._handle.mesh, k) for k, name in enumerate(_COUNTS)}

    def _figure(self):
        figure = Figure()
        library.tri_mesh_figure(self._handle.mesh, byref(figure))
        return figure

    def refine(self, **wanted):
        """A finer mesh, by the keywords of mesh(); this one stays as it is.

        Bounds that came with regions count no more. New ones for each triangle:
        mesh(m.points, m.segments, triangles=m.triangles, triangle_areas=...)."""
        return _make(self._figure(), wanted)

    def bad(self, **wanted):
        """How many triangles do not keep the bounds, by reason; keywords as those of mesh()."""
        settings, calls = _settings_of(**wanted)
        count = (c_int64 * len(_REASONS))()
        if library.tri_mesh_count_bad(self._handle.mesh, byref(settings), count, len(_REASONS)) < 0:
            raise InputError("settings without meaning", 3)
        if calls.fault is not None:
            raise calls.fault
        return {name: count[k] for k, name in enumerate(_REASONS) if count[k]}

    def check(self, min_angle=0, max_area=None, conforming=False):
        """A judgement by exact arithmetic, independent of the mesher."""
        detail = VerdictDetail()
        demands = Demands(min_angle=float(min_angle or 0), max_area=float(max_area or 0), delaunay=int(conforming))
        figure = self._figure()
        _run(library.tri_check_figure, None, byref(figure), None, byref(demands), byref(detail))
        return Verdict(detail)

    def write(self, base, first=1):
        """base.node, base.ele and base.poly."""
        figure = self._figure()
        _run(library.tri_file_write, None, os.fsencode(base), byref(figure), int(first))

    def __repr__(self):
        return "<Mesh: %d points, %d triangles>" % (len(self.points), len(self.triangles))


def _make(figure, wanted, even_odd=False):
    settings, calls = _settings_of(**wanted)
    settings.even_odd = even_odd
    handle = _Handle()
    function = library.par_mesh_new if _PARALLEL else library.tri_mesh_new
    _run(function, calls, byref(handle.mesh), byref(figure), byref(settings))
    _notes.tell(library.tri_mesh_notes(handle.mesh), stacklevel=3)
    return Mesh(handle)


def _with_polygons(points, segments, polygons):
    """Points and segments with those of rings behind them."""
    points = np.empty((0, 2)) if points is None else np.asarray(points, float).reshape(-1, 2)
    segments = np.empty((0, 2), int) if segments is None else np.asarray(segments).reshape(-1, 2)
    first, all_points, all_segments = len(points), [points], [segments]
    for ring in polygons:
        ring = np.asarray(ring, float)
        if ring.ndim != 2 or ring.shape[1] != 2:
            raise InputError("polygons: a ring of shape %s instead of (n, 2)" % (ring.shape,), 3)
        if len(ring) > 1 and np.array_equal(ring[0], ring[-1]):
            ring = ring[:-1]
        number = np.arange(first, first + len(ring))
        all_points.append(ring)
        all_segments.append(np.column_stack([number, np.roll(number, -1)]))
        first += len(ring)
    return np.concatenate(all_points), np.concatenate(all_segments)


def mesh(points=None, segments=None, *, polygons=None, holes=None, regions=None, point_attributes=None,
         point_markers=None, segment_markers=None, triangles=None, triangle_attributes=None,
         triangle_areas=None, **wanted):
    """A triangle mesh of a planar figure; see help(ptriangle)."""
    even_odd = polygons is not None or isinstance(holes, str)
    if polygons is not None:
        points, segments = _with_polygons(points, segments, polygons)
    if points is None:
        raise InputError("neither points nor polygons are given", 3)
    if isinstance(holes, str):
        if holes != "auto":
            raise InputError('holes: %r is neither "auto" nor places' % holes, 3)
        holes = None
    arrays = dict(points=points, segments=segments, holes=holes, regions=regions, point_attributes=point_attributes,
                  point_markers=point_markers, segment_markers=segment_markers, triangles=triangles,
                  triangle_attributes=triangle_attributes, triangle_areas=triangle_areas)
    figure, kept = _figure_of(arrays)
    made = _make(figure, wanted, even_odd)
    del kept  # which the library has looked at until here
    return made


def read(path):
    """The arrays of x.poly, x.node or x.ele (with its points, segments and area bounds), as keywords of mesh()."""
    figure = Figure()
    _run(library.tri_file_read, None, os.fsencode(path), byref(figure))
    try:
        return {name: np.array(lib.to_numpy(getattr(figure, name), None)) for name in _SHAPES
                if getattr(figure, name).n > 0}
    finally:
        library.tri_file_free(byref(figure))
