"""Meshes of a hundred million triangles and more, in memory and within a memory bound: time, memory, and the verdict of
the checker."""
import json
import os
import re
import shutil
import subprocess
from dataclasses import dataclass

import machine
from cases import Ours
from inputs import Domain, shared_coasts, square
from measure import measure, millions_per_second, table
from part_table2 import parts_of
from process import execute
from settings import say

AREA = 1.5e-8
NEEDED = {"memory": 12e9, "disk": 12e9}  # bytes; the checker needs 8 GB, the text files 7.5 GB


def _lacking(settings):
    """Reason why the part cannot run here, or None."""
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
    yield "speed", millions_per_second(v.triangles, m.median("quality")) + " million triangles per second"
    yield "peak memory", f"{m.peak / 1e9:.2f} GB"
    yield "bytes per triangle", f"{m.peak / v.triangles:.1f}"
    yield "whole process with text files written", f"{m.first.seconds['process']:.1f} s (one run)"
    schedule, parts = report["schedule"], parts_of(report)
    if parts:
        yield "blocks", f"{schedule['columns']} x {schedule['rows']}; rounds: {schedule['rounds']}"
        yield "left to the last sequential call", f"{schedule['left_over']:,}"
        yield "overhead, waiting not counted", f"{schedule['overhead_percent']:.1f}%"


# --- within a memory bound


@dataclass
class Bounded:
    """A mesh that is swept or, without a bound, in memory. It is written and checked, or judged and discarded."""
    domain: Domain
    memory: float  # bytes; 0: no bound
    disk: float    # bytes that must be free; 0: no file


LIMIT = 4 * 3600  # time limit in seconds


def _bounded(settings):
    scale = 10 if settings.small else 1
    runs = [Bounded(square(settings, AREA), 0, 0), Bounded(square(settings, AREA), 1e9, 0),
            Bounded(square(settings, AREA), 1e9, 3e9), Bounded(square(settings, 1.73e-9), 4e9, 0),
            Bounded(square(settings, 1.73e-9), 4e9, 22e9)]
    runs += [Bounded(d, 4e9, 12e9) for d in shared_coasts(settings, 30, 0.00047)[-1:]]
    runs.append(Bounded(square(settings, 6.85e-10), 8e9, 0))
    return [Bounded(r.domain, r.memory / scale, r.disk / scale) for r in runs]


def _lacks(settings, run):
    needed = run.memory or NEEDED["memory"] / (100 if settings.small else 1)
    if machine.memory() < needed:
        return f"less than {needed / 1e9:.0f} GB of memory are free"
    if shutil.disk_usage(settings.work).free < run.disk:
        return f"less than {run.disk / 1e9:.0f} GB are free on disk"
    return None


def _stream_program(settings):
    program = os.path.join(settings.work, "stream")
    libraries = [os.path.join(settings.programs, f"lib{name}.a")
                 for name in ("ptriangle", "ptriangle-files", "triangle")]
    subprocess.run([os.environ.get("CC", "cc"), "-O2", "-I", os.path.join(settings.root, "include"),
                    os.path.join(settings.root, "bench", "stream_memory.c"), "-o", program,
                    *libraries, "-fopenmp", "-lm",
                    "-lstdc++", "-lpthread"], check=True)
    return program


def _streamed(settings, run):
    d = run.domain
    ended = execute([_stream_program(settings), d.path, repr(d.angle), repr(d.area), str(int(run.memory)),
                     str(settings.threads), settings.scratch], LIMIT, settings.scratch)
    found = re.match(r"(\d+) triangles", ended.output)
    if ended.code != 0 or not found:
        return ended, None, 0, ended.errors + ended.output
    verdict = "no fault, as it is streamed" if ", edges in pairs" in ended.output else "edges are not in pairs"
    return ended, int(found.group(1)), 0, verdict


REASONS = {"input_angle": "at small angles of the input", "narrow_gap": "between segments too near to each other",
           "protected": "for protected segments", "limit": "where vertices ran away",
           "precision": "at features too fine for the coordinates"}


def _told(report):
    """The program's messages about triangles below the bounds, and about a parked mesh."""
    with open(report, encoding="utf-8") as file:
        schedule = json.load(file)["schedule"]
    if not schedule:
        return []
    below = schedule["below_bounds"] or {}
    words = [f"{n:,} below the bounds {REASONS[reason]}" for reason, n in below.items() if n]
    parked = schedule["parked_bytes"]
    return words + ([f"{parked / 1e9:.2f} GB parked"] if parked else [])


def _judged(settings, run):
    """Triangles may be below the bounds only if the checker finds a small angle of the input there."""
    d, path = run.domain, os.path.join(settings.scratch, "large.h5")
    report = os.path.join(settings.scratch, "large.json")
    bound = f"{int(run.memory / 1e6)}M"
    try:
        ended = execute([settings.program("ptriangle"), "-Q", "-p", d.path, "--min-angle", repr(d.angle), "--max-area",
                         repr(d.area), "--memory", bound, "--threads", str(settings.threads), "--output", path,
                         "--report", report, "--scratch", settings.scratch], LIMIT, settings.scratch)
        if ended.code != 0:
            return ended, None, 0, ended.errors
        words = _told(report)
        said = execute([settings.program("trianglecheck"), path, "--json", "--no-markers", "--memory", bound, "--poly",
                        d.path, "--min-angle", repr(d.angle), "--max-area", repr(d.area)],
                       LIMIT, settings.scratch)
        if said.code not in (0, 1):
            return ended, None, 0, "the judge cannot read the mesh: " + said.errors.strip()
        verdict = json.loads(said.output)
        faults = "; ".join(f"{c['name']}: {c['count']}" for c in verdict["checks"] if c["state"] == "failed")
        return ended, verdict["triangles"], os.path.getsize(path), faults or "; ".join(["no fault", *words])
    finally:
        for name in (path, path.removesuffix(".h5") + ".xdmf", report):
            if os.path.exists(name):
                os.remove(name)


def _measure_bounded(settings, run):
    """One line of the table, and a row of results.csv."""
    d, bound = run.domain, f"{run.memory / 1e9:g} GB" if run.memory else "none"
    lacking = _lacks(settings, run)
    if lacking:
        return (f"{d.name} `-{d.switches}`", "", bound, "left out: " + lacking, "", "", "", ""), {}
    ended, triangles, size, verdict = (_judged if run.disk else _streamed)(settings, run)
    if triangles is None or not verdict.startswith("no fault"):
        settings.fail(f"{d.name} -{d.switches} within {bound}: {verdict or ended.errors}")
    say(f"  {d.name} -{d.switches}, {bound}: {triangles} triangles, {ended.wall:.1f} s, {verdict}")
    line = (f"{d.name} `-{d.switches}`", f"{triangles or 0:,}", bound, f"{ended.wall:.1f} s",
            f"{ended.processor:.1f} s", f"{ended.peak / 1e9:.2f} GB", f"{size / 1e9:.1f} GB" if size else "", verdict)
    row = {"part": "large", "input": d.name, "switches": d.switches, "program": "bounded by " + bound,
           "threads": settings.threads, "stage": "with file" if run.disk else "streamed", "runs": 1,
           "median_seconds": ended.wall, "min_seconds": ended.wall, "max_seconds": ended.wall, "triangles": triangles,
           "peak_bytes": ended.peak, "judged": verdict}
    return line, row


PAPER = ("the paper, Table 2: 121 processors", "873,500,000", "", "294 s", "", "", "", "")
HEAD = ("mesh", "triangles", "bound", "time", "processor time", "memory", "file", "judged")


def _run_bounded(settings):
    """Text and rows."""
    os.makedirs(settings.scratch, exist_ok=True)
    say("within a bound on memory")
    lines, rows = zip(*(_measure_bounded(settings, run) for run in _bounded(settings)))
    text = "\nWithin a bound on memory, once each; a file is closed and synced when the time ends:\n\n"
    return text + table(HEAD, [PAPER, *lines]), [row for row in rows if row]


def run(settings):
    title, lacking = "A hundred million triangles and more", _lacking(settings)
    bounded, rows = _run_bounded(settings)
    if lacking:
        yield {"title": title, "text": f"In memory left out: {lacking}.\n" + bounded, "rows": rows, "targets": []}
        return
    case = Ours(settings, square(settings, AREA), settings.threads)
    m, = measure("large", [case], settings, repeats=1)
    lines = list(_lines(m)) if m.good else [("missing", m.reason)]
    text = f"`ptriangle --threads {settings.threads} -{case.domain.switches}`, {case.domain.name}.\n\n"
    yield {"title": title, "text": text + table(("", ""), lines) + bounded, "rows": m.rows("large") + rows,
           "targets": []}
