"""One mesh of a hundred million triangles: time, memory, and the judge's word."""
import shutil

import machine
from cases import Ours
from inputs import square
from measure import measure, millions_per_second, table
from part_table2 import parts_of

AREA = 1.5e-8
NEEDED = {"memory": 12e9, "disk": 12e9}  # bytes; the judge holds 8 GB, the text files take 7.5 GB


def _lacking(settings):
    """Why it cannot run here, or None."""
    if settings.small:
        return None
    if machine.memory() < NEEDED["memory"]:
        return f"{machine.memory() / 1e9:.0f} GB of memory are free, {NEEDED['memory'] / 1e9:.0f} are needed"
    if shutil.disk_usage(settings.scratch).free < NEEDED["disk"]:
        return f"less than {NEEDED['disk'] / 1e9:.0f} GB are free on disk"
    return None


def _lines(m):
    report, v = m.typical("quality").facts, m.verdict
    yield "triangles", f"{v.triangles:,}"
    yield "smallest angle", f"{v.smallest_angle:.4f}"
    yield "mean area over bound", f"{v.total_area / v.triangles / m.case.domain.area:.4f}"
    yield "judged", v.text
    yield "Quality", m.text("quality") + " s"
    yield "numbering", m.text("number") + " s"
    yield "speed", millions_per_second(v.triangles, m.median("quality")) + " million triangles a second"
    yield "peak memory", f"{m.peak / 1e9:.2f} GB"
    yield "bytes a triangle", f"{m.peak / v.triangles:.1f}"
    yield "whole process with text files written", f"{m.first.seconds['process']:.1f} s (one run)"
    schedule, parts = report["schedule"], parts_of(report)
    if parts:
        yield "blocks", f"{schedule['columns']} x {schedule['rows']}; rounds: {schedule['rounds']}"
        yield "left to the last sequential call", f"{schedule['left_over']:,}"
        yield "overhead, waiting not counted", f"{schedule['overhead_percent']:.1f}%"


def run(settings):
    title, lacking = "A hundred million triangles", _lacking(settings)
    if lacking:
        return {"title": title, "text": f"Left out: {lacking}.\n", "rows": [], "targets": []}
    case = Ours(settings, square(settings, AREA), settings.threads)
    m, = measure("large", [case], settings, repeats=1)
    lines = list(_lines(m)) if m.good else [("missing", m.reason)]
    text = f"`ptriangle --threads {settings.threads} -{case.domain.switches}`, {case.domain.name}.\n\n"
    return {"title": title, "text": text + table(("", ""), lines), "rows": m.rows("large"), "targets": []}
