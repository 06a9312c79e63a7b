"""Small meshes made repeatedly in one process: the time of a call of triangulate(), compared with Triangle's, and of a
call from Python, compared with the PyPI package `triangle`."""
import glob
import json
import os
import statistics
import subprocess

from cases import Triangle, peer, python
from inputs import letter, random_points, wavy_circle
from measure import table
from process import execute
from settings import say

HEAD = ("input", "switches", "triangles", "ours, µs", "Triangle 1.6, µs", "Triangle over ours")
NOTE = """\
Processor time of one call of the library function, including freeing its output, in a process that makes many calls.
Median of {} runs in turns. Points and segments are in arrays before the call, the mesh after it. These meshes are not
checked here.

"""
PYTHON_HEAD = ("input", "switches", "triangles", "package, µs", "compat, µs", "mesh(), µs", "compat over package",
               "mesh() over package")
PYTHON_NOTE = """
The same from Python, with numpy arrays: the PyPI package `triangle`, `ptriangle.compat` in its place, and
`ptriangle.mesh()`, whose points and triangles are read.

"""
PYTHON_POINTS = (100, 1_000)
LETTER = ("p", "pq20", "pa0.001", "pq30a0.0001", "pq30a0.00001")
POINTS = (10, 100, 1_000)
LIMIT = 60


def _harness(settings):
    """Builds bench/calls.c with our library."""
    made = os.path.join(settings.work, "calls.so")
    subprocess.run([os.environ.get("CC", "cc"), "-O2", "-fPIC", "-shared", "-D_POSIX_C_SOURCE=200809L",
                    "-I", os.path.join(settings.root, "triangle", "dropin"),
                    os.path.join(settings.root, "bench", "calls.c"), "-o", made,
                    os.path.join(settings.programs, "libtriangle.a"), "-lm"], check=True)
    return made


def _run(settings, what, given, script, *arguments):
    ended = execute([python(settings), peer(script), *arguments, "0.01" if settings.small else "0.1",
                     *(word for path, switches in given for word in (path, switches))], LIMIT, settings.scratch)
    if ended.code != 0:
        settings.fail(f"calls of {what}: exit code {ended.code}: {ended.errors[-200:]}")
        return None
    return json.loads(ended.output)


def _medians(runs):
    """For each input: seconds and triangles."""
    return [(statistics.median(took for took, _ in of_one), of_one[0][1]) for of_one in zip(*runs)]


def run(settings):
    domains = [(letter(settings, 1), switches) for switches in LETTER]
    scale = 100 if settings.small else 1
    domains += [(random_points(settings, 0, n * scale), "") for n in POINTS]
    given = [(domain.path, switches) for domain, switches in domains]
    library = Triangle(settings, domains[0][0]).library
    say("calls: small meshes")
    harness, runs = _harness(settings), {}
    for _ in range(settings.repeats):
        for name in ("ours", library) if library else ("ours",):
            found = _run(settings, name, given, "small_calls.py", harness, name)
            if found:
                runs.setdefault(name, []).append(found)
    ours, theirs = _medians(runs.get("ours", [])), _medians(runs.get(library, []))
    lines, rows = [], []
    for i, (domain, switches) in enumerate(domains if ours else []):
        (took, n), other = ours[i], theirs[i][0] if theirs else None
        lines.append((domain.name, f"-{switches}" if switches else "", f"{n:,}", f"{took * 1e6:.1f}",
                      f"{other * 1e6:.1f}" if other else "missing", f"{other / took:.2f}" if other else "–"))
        rows += [{"part": "calls", "input": domain.name, "switches": switches, "program": name, "threads": 1,
                  "stage": "call", "runs": len(runs[key]), "median_seconds": of[i][0], "triangles": of[i][1]}
                 for name, key, of in (("ours", "ours", ours), ("Triangle 1.6", library, theirs)) if of]
    text, more = _from_python(settings, bool(library))
    yield {"title": "Small meshes", "text": NOTE.format(settings.repeats) + table(HEAD, lines) + text,
           "rows": rows + more, "targets": []}


def _from_python(settings, has_package):
    """A table, and rows for results.csv."""
    scale = 10 if settings.small else 1
    domains = [(letter(settings, 1), "p"), *((wavy_circle(settings, n // scale), "pq30") for n in PYTHON_POINTS)]
    given = [(domain.path, switches) for domain, switches in domains]
    has_numpy = glob.glob(os.path.join(settings.work, "python", "numpy-*"))
    library = has_numpy and glob.glob(os.path.join(settings.programs, "libptriangle_python.*"))
    runs = {}
    for _ in range(settings.repeats):
        for way in ("package", "compat", "mesh") if has_package else ("compat", "mesh"):
            found = library and _run(settings, f"Python, {way}", given, "python_calls.py", way, library[0])
            if found:
                runs.setdefault(way, []).append(found)
    package, compat, mesh = (_medians(runs.get(way, [])) for way in ("package", "compat", "mesh"))
    lines, rows = [], []
    for i, (domain, switches) in enumerate(domains if compat and mesh else []):
        took = [of[i][0] if of else None for of in (package, compat, mesh)]
        lines.append((domain.name, f"-{switches}", f"{compat[i][1]:,}",
                      *(f"{t * 1e6:.0f}" if t else "missing" for t in took),
                      *(f"{t / took[0]:.2f}" if took[0] else "–" for t in took[1:])))
        rows += [{"part": "calls", "input": domain.name, "switches": switches, "program": name, "threads": 1,
                  "stage": "call from Python", "runs": settings.repeats, "median_seconds": of[i][0],
                  "triangles": of[i][1]}
                 for name, of in (("package triangle", package), ("compat", compat), ("mesh()", mesh)) if of]
    return PYTHON_NOTE + table(PYTHON_HEAD, lines), rows
