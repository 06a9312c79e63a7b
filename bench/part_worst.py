"""Worst-case inputs of increasing size: time divided by size should hardly grow."""
import os
from dataclasses import dataclass

import meshfiles
import worst
from cases import Sequential
from inputs import Domain
from measure import measure, table

NOTE = """\
Microseconds of processor time of the whole process, per vertex of the input and triangle of the mesh: `triangle`
without writing files. In brackets: `trianglecheck` on the mesh, including reading its files. Then triangles per vertex
of the input. Median of {} runs.

"""


@dataclass(frozen=True)
class Worst(Domain):
    bundle: str = ""

    @property
    def switches(self):
        return self.bundle


def _domain(settings, case, n):
    name, switches = case.build.__name__, case.switches.format(n=n)
    path = os.path.join(settings.work, "inputs", f"worst_{name}_{n}.poly")
    meshfiles.write(path, case.build(n))
    return Worst(name.replace("_", " "), path, 0, 0, switches)


def _measured(settings, case, n):
    domain = _domain(settings, case, n)
    measured, = measure(f"worst: {domain.name}, -{domain.switches}, {n:,}", [Sequential(settings, domain)], settings)
    os.remove(domain.path)
    return measured


def _cell(measured, n):
    if not measured.good:
        return "missing: " + measured.reason
    triangles = measured.verdict.triangles
    made, judged = measured.median("processor") / (n + triangles), measured.verdict.seconds / (n + triangles)
    return f"{made * 1e6:.2f} ({judged * 1e6:.2f}), {triangles / n:.3g}"


def run(settings):
    sizes = (500, 2_000) if settings.small else (10_000, 100_000, 1_000_000)
    head = ("input", "switches", *(f"{n:,} vertices" for n in sizes))
    lines, rows = [], []
    for case in worst.CASES:
        taken = [n for n in sizes if n <= case.largest]
        measured = [_measured(settings, case, n) for n in taken]
        cells = [_cell(m, n) for m, n in zip(measured, taken)]
        lines.append((measured[0].case.domain.name, f"`-{case.switches}`", *cells,
                      *["–"] * (len(sizes) - len(cells))))
        rows += [{**row, "input": f"{row['input']}, -{case.switches}, {n}"}
                 for m, n in zip(measured, taken) for row in m.rows("worst")]
        yield {"title": "Inputs of the worst kind", "text": NOTE.format(settings.repeats) + table(head, lines),
               "rows": rows, "targets": []}
