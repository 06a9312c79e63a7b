"""Table 1 of the paper: the letter A at 20 degrees, from 29 points with three area bounds. Then the mesh of 1.3 million
triangles is refined further, once reconstructed from its triangles and once triangulated again from its points."""
import os

import meshfiles
from cases import Failure, Ours, Triangle
from inputs import Domain, letter
from judge import judge
from measure import measure, table

# From the paper: input triangles, points and segments; bound; triangles, points and segments made; seconds.
PAPER = (
    ("0 / 29 / 29", 1e-6, "130,405 / 66,647 / 2,889", "0.000", "–", "0.643"),
    ("0 / 29 / 29", 2.5e-8, "5,232,435 / 2,625,249 / 18,063", "0.000", "–", "24.641"),
    ("0 / 29 / 29", 1e-7, "1,307,048 / 658,062 / 9,076", "0.000", "–", "6.253"),
    ("1,307,048 / 658,062 / 9,076", 2.5e-8, "5,195,468 / 2,606,427 / 17,386", "–", "42.367", "19.988"),
    ("0 / 658,062 / 9,076", 2.5e-8, "5,194,174 / 2,605,776 / 17,378", "7.038", "–", "19.395"))
HEAD = ("given: triangles / points / segments", "area bound", "program", "made: triangles / points / segments",
        "Delaunay, s", "Reconstruct, s", "Quality, s", "process, s")
NOTE = """\
Input: {}, 20 degrees. Median (least–most) of {} runs in turns. Triangle 1.6 makes triangulation and mesh in one call.
Its first column is a call without bounds, and Quality the difference between the two calls; no output arrays are
requested. Our columns are stages of one run. The process column includes reading the input from text files and writes
nothing. Rows four and five start from our mesh of row three. Triangle's meshes are counted but not checked here.

"""


def _cases(settings, domain, switches=""):
    threads = sorted({1, settings.threads})
    return [Triangle(settings, domain, switches, judged=False), *(Ours(settings, domain, n, switches) for n in threads)]


def _coarse_mesh(settings):
    """Files of the third row's mesh, from which both programs start. None: it could not be made."""
    base = os.path.join(settings.work, "inputs", "refined_small" if settings.small else "refined")
    case = Ours(settings, letter(settings, 1e-7), settings.threads)
    try:
        verdict, _ = judge(case)
        case.write(base)
    except Failure as failure:
        settings.fail(f"table1, the mesh that is refined further: {failure}")
        return None
    return base + ".poly", verdict


def _further_jobs(settings, figure):
    """The mesh refined further: description of the input, domain, switches."""
    made = _coarse_mesh(settings)
    if not made:
        return []
    path, coarse = made
    fine, mesh = Domain("its mesh refined further", path, 20, figure.area), _counts(coarse)
    return [(mesh, fine, "r"), ("0" + mesh[mesh.index(" /"):], fine, "")]


def _counts(v):
    return f"{v.triangles:,} / {v.vertices:,} / {v.subsegments:,}"


def _lines(i, given, domain, measured, reconstructed):
    paper = PAPER[i]
    lines = [(paper[0], f"{paper[1]:g}", "Triangle, the paper's", *paper[2:], "–")]
    for m in measured:
        first = m.text("delaunay")
        stages = ("–", first) if reconstructed else (first, "–")
        made = _counts(m.verdict) if m.good else "missing: " + m.reason
        lines.append((given, f"{domain.area:g}", m.case.name, made, *stages, m.text("quality"), m.text("process")))
    return lines


def run(settings):
    lines, rows = [], []
    plain = [letter(settings, PAPER[i][1]) for i in range(3)]
    pslg = meshfiles.read(plain[0].path)
    start = f"0 / {len(pslg.points) // 2} / {len(pslg.segments) // 2}"
    jobs = [(start, d, "") for d in plain] + _further_jobs(settings, letter(settings, 2.5e-8))
    for number, (given, domain, switches) in enumerate(jobs):
        title = f"table1: {domain.name}, -{switches}{domain.switches}"
        measured = measure(title, _cases(settings, domain, switches), settings)
        lines += _lines(number, given, domain, measured, switches == "r")
        rows += [row for m in measured for row in m.rows("table1")]
        text = NOTE.format(plain[0].name, settings.repeats) + table(HEAD, lines)
        yield {"title": "Table 1 of the paper: one letter, refined three ways", "text": text, "rows": rows,
               "targets": []}
