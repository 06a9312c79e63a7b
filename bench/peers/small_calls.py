"""Processor time of calls of triangulate() on small inputs, repeated in one process:

  small_calls.py CALLS LIBRARY SECONDS INPUT SWITCHES [INPUT SWITCHES ...]

CALLS is bench/calls.c as a shared library. LIBRARY is that of the PyPI package `triangle`, or `ours`. Prints a line of
JSON: the seconds of a call and the number of triangles, for each input and switches.
"""
import ctypes
import json
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import triangle_call  # noqa: E402


def main():
    calls, library, seconds = sys.argv[1:4]
    timed = ctypes.CDLL(calls).seconds_of_call
    timed.restype = ctypes.c_double
    function = None if library == "ours" else ctypes.cast(ctypes.CDLL(library).triangulate, ctypes.c_void_p)
    found = []
    for path, switches in zip(sys.argv[4::2], sys.argv[5::2]):
        pslg, given = triangle_call.given(path, switches)
        n = ctypes.c_int()
        took = timed(function, (switches + "zQ").encode(), ctypes.byref(given), ctypes.c_double(float(seconds)),
                     ctypes.byref(n))
        found.append((took, n.value))
    print(json.dumps(found), flush=True)


main()
