"""Table 2 of the paper, scaled speedup: the problem grows with the number of workers."""
import machine
from cases import Ours
from inputs import square
from measure import measure, seconds_text, table

# From the paper: workers; total; million elements; pre-refinement; refinement; communication and synchronisation;
# filling in and merging; area bound in 1e-8.
PAPER = (
    (4, 293.7, 23.8, 0.24, 218.7, 32.7, 39.9, 5.00), (9, 294.7, 58.8, 0.44, 220.0, 35.4, 40.3, 2.22),
    (16, 295.4, 109.3, 0.71, 218.8, 37.1, 40.0, 1.25), (25, 296.8, 175.4, 1.05, 219.1, 39.1, 40.8, 0.80),
    (36, 293.4, 255.0, 1.43, 218.6, 36.1, 40.0, 0.56), (49, 294.5, 352.6, 1.88, 217.7, 37.5, 40.7, 0.41),
    (64, 300.1, 470.7, 2.49, 221.0, 40.7, 41.5, 0.31), (81, 296.2, 587.8, 3.04, 216.6, 46.2, 41.1, 0.25),
    (100, 300.3, 738.9, 3.69, 218.4, 46.5, 41.5, 0.20), (121, 293.7, 873.5, 4.42, 210.3, 53.6, 40.9, 0.17))
HEAD = ("program", "workers", "total, s", "elements, millions", "pre-refinement, s", "refinement, s",
        "communication and synchronisation, s", "filling in and merging, s", "area bound",
        "elements a second and worker", "overhead", "numbering, s")
NOTE = """\
Unit square with 1,000 random points, 20 degrees, about the same number of triangles per worker in every row. The
paper's workers are processors of 650 and 900 MHz that run Triangle; ours are threads. Seconds are those of one worker.
Ours: refinement is the mean over workers of the time inside blocks. Communication and synchronisation consists of
waiting for the last block of a phase, finding bad triangles, cutting into blocks, and distributing worklists and room.
Merging consists of closing gaps and the last sequential call. Numbering along a curve comes after that; the paper's
program does not do it. Median run of {}.

"""
AREA = 2e-7              # times number of workers: the paper's 5e-8 for four
BYTES_A_TRIANGLE = 100   # including the checker, which needs most


def _line(name, workers, total, elements, parts, area, numbering):
    overhead = (parts[2] + parts[3]) / total
    return (name, workers, seconds_text(total), f"{elements / 1e6:.1f}", *map(seconds_text, parts), f"{area:g}",
            f"{elements / total / workers:,.0f}", f"{100 * overhead:.1f}%", numbering)


def parts_of(report):
    """Total without numbering and, of it, for one worker: pre-refinement, refinement, communication and
    synchronisation, merging. Waiting for the slowest block of a phase is synchronisation. None if the mesh was too
    small for a schedule."""
    schedule = report["schedule"]
    if not schedule or not schedule["blocks"]:
        return None
    s = schedule["seconds"]
    own = min(s["refine"], sum(b["seconds"] for b in schedule["blocks"]) / report["threads"])
    merging, total = s["merge"] + s["last"], s["total"] - s["number"]
    return total, (s["prerefine"], own, max(0.0, total - s["prerefine"] - own - merging), merging)


def _measured(settings, workers):
    """One line of the table, and rows of results.csv."""
    domain = square(settings, AREA / workers)
    if 1.55 / domain.area * BYTES_A_TRIANGLE > machine.memory():
        return ("ours", workers, "left out: too little memory", *[""] * 9), []
    m, = measure(f"table2: {workers} threads", [Ours(settings, domain, workers)], settings)
    parts = parts_of(m.typical("quality").facts) if m.good else None
    if not parts:
        return ("ours", workers, m.reason or "too small for the schedule", *[""] * 9), m.rows("table2")
    return (_line("ours", workers, parts[0], m.verdict.triangles, parts[1], domain.area, m.text("number")),
            m.rows("table2"))


def run(settings):
    lines, rows = [_line("paper", r[0], r[1], 1e6 * r[2], r[3:7], 1e-8 * r[7], "–") for r in PAPER], []
    for workers in settings.thread_counts():
        line, more_rows = _measured(settings, workers)
        lines.append(line)
        rows += more_rows
        text = NOTE.format(settings.repeats) + table(HEAD, lines)
        yield {"title": "Table 2 of the paper: scaled speedup", "text": text, "rows": rows, "targets": []}
