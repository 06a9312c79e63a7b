"""Reads and writes files of meshes and figures. The suffix selects the format.

The library handles most formats. Formats handled in Python are entries of _READERS and _WRITERS: .h5 and .vtkhdf, with
h5py (docs/formats.md).
"""
from __future__ import annotations

import os
from ctypes import byref
from typing import Any, Callable, Dict, List, Tuple

import numpy as np

from . import _library as lib
from ._arrays import Array, from_numpy, to_numpy
from ._calls import Calls
from ._errors import FileError, InputError
from ._figure import SHAPES, figure_of
from ._library import library
from ._settings import whole

Arrays = Dict[str, Array]


def _h5py(who: str) -> Any:
    try:
        import h5py  # type: ignore[import-untyped, unused-ignore]
    except ImportError:
        raise ImportError("%s: files .h5 and .vtkhdf need h5py: pip install h5py" % who) from None
    return h5py


def _read_h5(path: str, who: str) -> Arrays:
    h5py = _h5py(who)
    try:
        with h5py.File(path, "r") as file:
            if "about" not in file or file["about"].attrs.get("format") not in ("ptriangle mesh", b"ptriangle mesh"):
                raise FileError("%s: no mesh of ptriangle's" % path)
            arrays = {name: file[name][()] for name in SHAPES if name in file}
    except OSError as fault:
        raise fault if isinstance(fault, FileError) else FileError("%s: %s" % (path, fault)) from None
    return {name: rows.astype(SHAPES[name][0].dtype) for name, rows in arrays.items() if len(rows)}


def _add_vtk(file: Any, arrays: Arrays) -> None:
    """Adds the grid for VTK and ParaView: triangles, then segments as lines."""
    points, triangles, segments = (arrays[name] for name in ("points", "triangles", "segments"))
    m, s = len(triangles), len(segments)
    grid = file.create_group("VTKHDF")
    grid.attrs.update({"Version": np.array([2, 0]), "Type": np.bytes_("UnstructuredGrid")})
    rows = {"Points": np.column_stack([points, np.zeros(len(points))]),
            "Connectivity": np.concatenate([triangles.ravel(), segments.ravel()]),
            "Offsets": np.append(np.arange(0, 3 * m + 1, 3), 3 * m + np.arange(2, 2 * s + 1, 2)),
            "Types": np.repeat(np.array([5, 3], np.uint8), [m, s]), "NumberOfPoints": np.array([len(points)]),
            "NumberOfCells": np.array([m + s]), "NumberOfConnectivityIds": np.array([3 * m + 2 * s]),
            "PointData/marker": arrays["point_markers"], "PointData/attributes": arrays["point_attributes"],
            "CellData/marker": np.append(np.zeros(m, np.int32), arrays["segment_markers"]),
            "CellData/attributes": np.pad(arrays["triangle_attributes"], ((0, s), (0, 0)))}
    for name, some in rows.items():
        if some.size:
            grid.create_dataset(name, data=some, track_times=False)


def _write_h5(path: str, arrays: Arrays, who: str) -> None:
    points, triangles = arrays["points"], arrays["triangles"]
    if triangles.shape[1] != 3:
        raise InputError("%s: %s: %s files hold no second-order triangles" % (who, path, _suffix(path)))
    h5py, temporary = _h5py(who), path + ".part"
    corners = points[np.unique(triangles)] if len(triangles) else points
    bounds = np.concatenate([corners.min(axis=0), corners.max(axis=0)]) if len(corners) else np.zeros(4)
    about = {"format": "ptriangle mesh", "version": np.int64(1), "bounds": bounds,
             "program": "ptriangle " + library.tri_version().decode(), "input_points": np.int64(len(points)),
             **{name: np.int64(len(arrays[name])) for name in ("points", "triangles", "segments")}}
    try:
        with h5py.File(temporary, "w") as file:
            for name in ("points", "point_markers", "point_attributes", "triangles", "triangle_attributes", "segments",
                         "segment_markers"):
                if arrays[name].size:
                    file.create_dataset(name, data=arrays[name], track_times=False)
            file.create_group("about").attrs.update(about)
            if _suffix(path) == ".vtkhdf":
                _add_vtk(file, arrays)
        os.replace(temporary, path)
    except OSError as fault:
        raise FileError("%s: %s" % (path, fault), 5) from None
    finally:
        if os.path.exists(temporary):
            os.remove(temporary)


_READERS: Dict[str, Callable[[str, str], Arrays]] = {".h5": _read_h5, ".vtkhdf": _read_h5}
_WRITERS: Dict[str, Callable[[str, Arrays, str], None]] = {".h5": _write_h5, ".vtkhdf": _write_h5}
_OF_THE_LIBRARY: List[str] = [".node", ".ele", ".poly", ".vtu", ".msh", ".2dm", ".14", ".grd"]


def _suffix(path: str) -> str:
    return os.path.splitext(path)[1].lower()


def _known(table: Dict[str, Any]) -> str:
    return ", ".join(_OF_THE_LIBRARY + list(table))


def read_arrays(path: Any, who: str) -> Arrays:
    path = os.fspath(path)
    suffix = _suffix(path)
    if suffix in _READERS:
        return _READERS[suffix](path, who)
    if suffix not in _OF_THE_LIBRARY:
        raise FileError("%s: %s: cannot read %r files, but %s%s" % (
            who, path, suffix, _known(_READERS),
            "; give mesh(polygons=json.load(file)) what lies in it" if suffix in (".geojson", ".json") else
            "; meshio and geopandas read many others"))
    figure = lib.Figure()
    Calls(who).run_checked(library.tri_file_read, os.fsencode(path), byref(figure))
    try:
        return {name: np.array(to_numpy(getattr(figure, name), None)) for name in SHAPES
                if getattr(figure, name).n > 0}
    finally:
        library.tri_file_free(byref(figure))


def write_arrays(path: Any, arrays: Arrays, first: int, who: str) -> None:
    path = os.fspath(path)
    suffix = _suffix(path)
    if suffix in _WRITERS:
        _WRITERS[suffix](path, arrays, who)
        return
    if suffix[1:].isalpha() and suffix not in _OF_THE_LIBRARY:
        raise InputError("%s: %s: cannot write %r files, but %s" % (who, path, suffix, _known(_WRITERS)))
    triangles = arrays["triangles"]
    figure, kept = figure_of(dict(arrays, triangles=None), who)
    if triangles.shape[1] == 6:  # in the library midpoints lie opposite the corners
        triangles = triangles[:, [0, 1, 2, 4, 5, 3]]
    figure.triangles, owner = from_numpy(lib.Ints, triangles, who + ": triangles")
    Calls(who).run_checked(library.tri_file_write, os.fsencode(path), byref(figure), whole(who, "first", first))
    del kept, owner  # the library uses these arrays up to this line
