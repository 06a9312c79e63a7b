"""Lengths of edges: how well they are met compared with gmsh, and how many unknowns a solver needs for the same
error."""
import json
import math
import os
from array import array

import inputs
import meshfiles
from cases import Failure, Gmsh, Ours, peer, python, remove
from inputs import Domain
from measure import measure, table

HEAD = ("program", "triangles", "of those requested", "edges within 0.7 to 1.4", "mean quality", "smallest angle",
        "seconds", "unknowns", "error", "unknowns for the error of `-a`")
NOTE = """\
Lengths are H at the boundary and grow by 0.15 for a distance of 1, or are the same everywhere. "Of those requested":
triangles divided by the number of equilateral triangles of these lengths that fill the domain. Quality is 4 sqrt(3)
area / sum of squared edges. gmsh measures distances from points on the boundary. Unknowns and error (root mean square)
are those of linear elements for Poisson's equation. The error falls as 1 / unknowns. So the last column is (unknowns
times error) divided by that of `-a` with `--placement classic`, whose lengths are the same everywhere. Seconds from
points and segments in memory to the mesh in memory, on one thread, median of {} runs.

"""
GROWTH, CORNERS = 0.15, 720


class Sized(Gmsh):
    def __init__(self, settings, domain, algorithm, name, h, growth):
        super().__init__(settings, domain, algorithm, name)
        self.h, self.growth, self.limit = h, growth, 300

    def command(self):
        return (python(self.settings), peer("gmsh_mesh.py"), self.domain.path, f"{self.h!r},{self.growth!r}",
                str(self.algorithm))


def _circle(settings):
    path, pslg = os.path.join(settings.work, "inputs", "circle.poly"), meshfiles.Pslg()
    n = CORNERS // 10 if settings.small else CORNERS
    for i in range(n):
        pslg.points.extend((math.cos(2 * math.pi * i / n), math.sin(2 * math.pi * i / n)))
        pslg.segments.extend((i, (i + 1) % n))
    pslg.holes = array("d")
    meshfiles.write(path, pslg)
    return Domain("circle", path, 20, 0)


def _greece(settings):
    source = os.path.join(settings.shared, "coast_ne10m_greece_sea.poly")
    if not os.path.exists(source):
        return []
    path = os.path.join(settings.work, "inputs", "greece.poly")
    meshfiles.write(path, meshfiles.read(source))
    return [Domain("sea off Greece", path, 20, 0)]


def _judged(settings, case, h, growth):
    """Measures a mesh. None: numpy or scipy is missing, or the case failed."""
    base = os.path.join(settings.scratch, "sized")
    try:
        written, _ = case.write(base)
        return json.loads(case.execute(python(settings), peer("size_judge.py"), written, case.domain.path, repr(h),
                                       repr(growth)).output)
    except Failure as failure:
        print(f"bench: {case.name}: not judged by sizes: {failure}")
        return None
    finally:
        remove(base)


def _cases(settings, domain, h, growth):
    sizes = ("--size-near", f"1:{h!r},{growth!r}") if growth else ("--size", repr(h))
    ours = [Ours(settings, domain, 1, options=sizes),
            Ours(settings, domain, 1, options=(*sizes, "--optimise", "6"))]
    if not growth:
        # Classic placement makes triangles of 0.66 of the bound on average. This bound gives the requested mean area.
        area = f"-a{0.66 ** -1 * 3 ** 0.5 / 4 * h * h:.12f}"
        ours.append(Ours(settings, domain, 1, options=("--placement", "classic", area)))
    peers = ((5, "Delaunay"),) if settings.small else ((5, "Delaunay"), (6, "frontal-Delaunay"))
    return [*ours, *(Sized(settings, domain, algorithm, f"gmsh, {name}", h, growth) for algorithm, name in peers)]


def _lines(measured, judged):
    costs = [j["unknowns"] * j["error"] if j else None for j in judged]
    classic = [c for c, m in zip(costs, measured) if "classic" in m.case.name]
    for m, j, cost in zip(measured, judged, costs):
        if not (m.good and j):
            yield (m.case.name, *["–"] * 5, m.reason or "not judged", *["–"] * 3)
            continue
        yield (m.case.name, f"{m.verdict.triangles:,}", f"{j['wanted']:.3f}", f"{j['within']:.1%}",
               f"{j['quality']:.4f}", f"{m.verdict.smallest_angle:.1f}", m.text("memory"), f"{j['unknowns']:,}",
               f"{j['error']:.3g}", f"{cost / classic[0]:.2f}" if classic and classic[0] else "–")


def run(settings):
    norway = inputs.norway(settings, 20, 0)
    wanted = [(_circle(settings), 0.05, 0.0), (norway, 1e4, GROWTH)] if settings.small else [
        (_circle(settings), 0.01, 0.0), (norway, 4e3, 0.0), (norway, 1e3, GROWTH),
        *((domain, 0.004, GROWTH) for domain in _greece(settings))]
    texts, rows, repeats = [], [], min(3, settings.repeats)
    for domain, h, growth in wanted:
        title = f"{domain.name}, " + (f"{h:g} at the boundary, growing by {growth}" if growth else f"{h:g} everywhere")
        measured = measure("sizes: " + title, _cases(settings, domain, h, growth), settings, repeats)
        judged = [_judged(settings, m.case, h, growth) if m.good else None for m in measured]
        texts.append(f"### {title}\n\n" + table(HEAD, list(_lines(measured, judged))))
        rows += [row for m in measured for row in m.rows("sizes")]
        yield {"title": "Sizes", "text": NOTE.format(repeats) + "\n".join(texts), "rows": rows, "targets": []}
