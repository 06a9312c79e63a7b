"""Inputs of the worst kind at growing size: time divided by size should hardly grow."""
import os
from dataclasses import dataclass

import meshfiles
import worst
from cases import Sequential
from inputs import Domain
from measure import measure, table

NOTE = """\
Microseconds of processor time, of the whole process, a vertex of the input: `triangle`, without writing of files; in
brackets those of `trianglecheck` on the mesh, its files read. Median of {} runs.

"""


@dataclass(frozen=True)
class Worst(Domain):
    bundle: str = ""

    @property
    def switches(self):
        return self.bundle


def _domain(settings, build, n):
    path = os.path.join(settings.work, "inputs", f"worst_{build.__name__}_{n}.poly")
    figure, bundle = build(n)
    meshfiles.write(path, figure)
    return Worst(build.__name__.replace("_", " "), path, 0, 0, bundle)


def _measured(settings, build, n):
    domain = _domain(settings, build, n)
    measured, = measure(f"worst: {domain.name}, {n:,}", [Sequential(settings, domain)], settings)
    os.remove(domain.path)
    return measured


def _cell(measured, n):
    if not measured.good:
        return "missing: " + measured.reason
    return f"{measured.median('processor') / n * 1e6:.2f} ({measured.verdict.seconds / n * 1e6:.2f})"


def run(settings):
    sizes = (1_000, 10_000) if settings.small else (10_000, 100_000, 1_000_000)
    head = ("input", "switches", *(f"{n:,} vertices" for n in sizes))
    lines, rows = [], []
    for builders, largest in ((worst.TRIANGULATION, sizes[-1]), (worst.DEARER, sizes[-2])):
        for build in builders:
            taken = [n for n in sizes if n <= largest]
            measured = [_measured(settings, build, n) for n in taken]
            domain = measured[0].case.domain
            cells = [_cell(m, n) for m, n in zip(measured, taken)]
            lines.append((domain.name, f"`-{domain.switches}`", *cells, *["–"] * (len(sizes) - len(cells))))
            rows += [{**row, "input": f"{row['input']}, {n}"}
                     for m, n in zip(measured, taken) for row in m.rows("worst")]
            yield {"title": "Inputs of the worst kind", "text": NOTE.format(settings.repeats) + table(head, lines),
                   "rows": rows, "targets": []}
