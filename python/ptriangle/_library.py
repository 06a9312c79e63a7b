"""The shared library, by ctypes: its structs, as ptriangle/tri.h and triangle.h declare them, and its functions.

The library lies beside this file. PTRIANGLE_LIBRARY names another one.
"""
from __future__ import annotations

import ctypes
import ctypes.util
import os
from ctypes import (CFUNCTYPE, POINTER, Structure, byref, c_bool, c_char, c_char_p, c_double, c_int, c_int32, c_int64,
                    c_size_t, c_void_p, sizeof)
from pathlib import Path
from typing import Any, Iterator

import numpy as np


class Reals(Structure):
    _fields_ = [("at", c_void_p), ("n", c_int64), ("width", c_int64), ("stride", c_int64)]
    dtype = np.dtype(np.float64)


class Ints(Structure):
    _fields_ = [("at", c_void_p), ("n", c_int64), ("width", c_int64), ("stride", c_int64)]
    dtype = np.dtype(np.int32)


class ErrorDetail(Structure):
    _fields_ = [("status", c_int), ("file", c_char * 1024), ("line", c_int64), ("text", c_char * 512)]


class Sized(Structure):
    """A struct that begins with its size. Other members are 0 initially."""

    def __init__(self, **fields: Any) -> None:
        super().__init__(size=sizeof(self), **fields)


class Figure(Sized):
    _fields_ = [("size", c_size_t), ("points", Reals), ("point_attributes", Reals), ("point_markers", Ints),
                ("segments", Ints), ("segment_markers", Ints), ("holes", Reals), ("regions", Reals),
                ("triangles", Ints), ("triangle_attributes", Reals), ("triangle_areas", Reals)]


Unsuitable = CFUNCTYPE(c_int, c_void_p, POINTER(c_double), POINTER(c_double), POINTER(c_double), c_double)
Gate = CFUNCTYPE(c_bool, c_void_p, POINTER(c_double))
Stop = CFUNCTYPE(c_bool, c_void_p)
Note = CFUNCTYPE(None, c_void_p, c_char_p)
Progress = CFUNCTYPE(None, c_void_p, c_double, c_int64)


SizeArrays = CFUNCTYPE(None, c_void_p, c_int64, c_void_p, POINTER(c_double))


class SizeField(Structure):
    _fields_ = [("kind", c_int), ("length", c_double), ("growth", c_double), ("marker", c_int32), ("values", Reals),
                ("origin", c_double * 2), ("step", c_double * 2), ("points", Reals), ("triangles", Ints),
                ("function", SizeArrays), ("user", c_void_p)]


class Settings(Sized):
    kept: Any = None  # objects that the pointers refer to
    _fields_ = [("size", c_size_t), ("min_angle", c_double), ("max_area", c_double), ("conforming", c_bool),
                ("keep_hull", c_bool), ("protect", c_int), ("most_new_points", c_int64),
                ("edge_length", c_void_p), ("edge_length_user", c_void_p),
                ("unsuitable", Unsuitable), ("unsuitable_user", c_void_p),
                ("gate", Gate), ("gate_user", c_void_p), ("fence", POINTER(c_double)),
                ("stop", Stop), ("stop_user", c_void_p),
                ("threads", c_int), ("callbacks_in_parallel", c_bool), ("numbered_by_block", c_bool),
                ("even_odd", c_bool),
                ("note", Note), ("note_user", c_void_p), ("progress", Progress), ("progress_user", c_void_p),
                ("placement", c_int), ("sizes", POINTER(SizeField)), ("n_sizes", c_int64), ("gradation", c_double),
                ("min_size", c_double), ("max_size", c_double),
                ("elements_across", c_double), ("per_circle", c_double), ("optimise", c_int)]


class Demands(Sized):
    _fields_ = [("size", c_size_t), ("min_angle", c_double), ("max_area", c_double), ("delaunay", c_int),
                ("convex", c_bool), ("ignore_holes", c_bool), ("renumbered", c_bool),
                ("keep_hull", c_bool)]


class VerdictDetail(Structure):
    _fields_ = [("n_faults", c_int64), ("text", c_char * 256), ("n_points", c_int64), ("n_edges", c_int64),
                ("n_boundary_edges", c_int64), ("smallest_angle", c_double), ("largest_angle", c_double),
                ("smallest_area", c_double), ("largest_area", c_double), ("total_area", c_double),
                ("n_small", c_int64), ("n_small_explained", c_int64)]


class TriangulateIO(Structure):
    """struct triangulateio of triangle.h"""
    _fields_ = [("pointlist", c_void_p), ("pointattributelist", c_void_p), ("pointmarkerlist", c_void_p),
                ("numberofpoints", c_int), ("numberofpointattributes", c_int),
                ("trianglelist", c_void_p), ("triangleattributelist", c_void_p), ("trianglearealist", c_void_p),
                ("neighborlist", c_void_p), ("numberoftriangles", c_int), ("numberofcorners", c_int),
                ("numberoftriangleattributes", c_int),
                ("segmentlist", c_void_p), ("segmentmarkerlist", c_void_p), ("numberofsegments", c_int),
                ("holelist", c_void_p), ("numberofholes", c_int), ("regionlist", c_void_p), ("numberofregions", c_int),
                ("edgelist", c_void_p), ("edgemarkerlist", c_void_p), ("normlist", c_void_p), ("numberofedges", c_int)]


SizeTest = CFUNCTYPE(c_int, c_void_p, POINTER(c_double), POINTER(c_double), POINTER(c_double), c_double)
Message = CFUNCTYPE(None, c_void_p, c_int, c_char_p)
StopTest = CFUNCTYPE(c_int, c_void_p)


class TriangulateOptions(Structure):
    _fields_ = [("unsuitable", SizeTest), ("unsuitable_user", c_void_p), ("unsuitable_in_parallel", c_int),
                ("threads", c_int), ("message", Message), ("message_user", c_void_p),
                ("stop", StopTest), ("stop_user", c_void_p), ("classic", c_int)]


def _candidates() -> Iterator[str]:
    if os.environ.get("PTRIANGLE_LIBRARY"):
        yield os.environ["PTRIANGLE_LIBRARY"]
        return
    here = Path(__file__).resolve().parent
    for name in ("libptriangle_python.so", "libptriangle_python.dylib", "libptriangle_python.dll"):
        if (here / name).exists():
            yield str(here / name)
    found = ctypes.util.find_library("ptriangle")
    if found:
        yield found


def _load() -> ctypes.CDLL:
    faults = []
    for name in _candidates():
        try:
            return ctypes.CDLL(name)
        except OSError as fault:
            faults.append(str(fault))
    raise ImportError("ptriangle: the shared library cannot be loaded: " + ("; ".join(faults) or "there is none"))


library = _load()


def _declare(name: str, result: Any, *arguments: Any) -> None:
    function = getattr(library, name, None)
    if function is not None:
        function.restype = result
        function.argtypes = arguments


_mesh, _error = c_void_p, POINTER(ErrorDetail)
for _way in ("tri", "par"):
    _declare(_way + "_mesh_new", c_int, POINTER(_mesh), POINTER(Figure), POINTER(Settings), _error)
    _declare(_way + "_mesh_refine", c_int, _mesh, POINTER(Settings), _error)
_declare("tri_mesh_delete", None, _mesh)
_declare("tri_mesh_neighbors", c_int, _mesh, POINTER(Ints), _error)
_declare("tri_mesh_edges", c_int, _mesh, POINTER(Ints), POINTER(Ints), _error)
_declare("tri_mesh_figure", None, _mesh, POINTER(Figure))
_declare("tri_mesh_count", c_int64, _mesh, c_int)
_declare("tri_mesh_count_bad", c_int64, _mesh, POINTER(Settings), POINTER(c_int64), c_int)
_declare("tri_mesh_notes", c_char_p, _mesh)
_declare("tri_version", c_char_p)
_declare("tri_check_figure", c_int, POINTER(Figure), POINTER(Figure), POINTER(Demands), POINTER(VerdictDetail), _error)
_declare("tri_file_read", c_int, c_char_p, POINTER(Figure), _error)
_declare("tri_file_free", None, POINTER(Figure))
_declare("tri_file_write", c_int, c_char_p, POINTER(Figure), c_int, _error)
_declare("triangulate_with", c_int, c_char_p, POINTER(TriangulateIO), POINTER(TriangulateIO), POINTER(TriangulateIO),
         POINTER(TriangulateOptions))
_declare("trifree", None, c_void_p)
