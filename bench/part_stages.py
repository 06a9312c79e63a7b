"""Times by stage, compared with Triangle 1.6 on the same input in the same turns, and the targets for them."""
import os
import statistics

from cases import Failure, Ours, Sequential, Triangle
from inputs import Domain, letter, norway, random_points, shared_coasts, square
from measure import measure, millions_per_second, ratio, table
from prediction import on_threads

HEAD = ("program", "triangles", "smallest angle", "Delaunay, s", "Quality, s", "numbering, s", "all, s",
        "M/s in Quality", "Triangle's Quality over it", "Triangle's all over it", "bytes per triangle")
FILES_HEAD = ("program", "read, s", "Delaunay, s", "Quality, s", "numbering, s", "write, s", "process, s",
              "Triangle's call over it")
NOTE = """\
In memory, without files. Triangle 1.6: Delaunay is a call of its library function without bounds, All is a call with
bounds, and Quality the difference. The calls request no output arrays, and all conversion of input is outside the
clock. Ours on one core: `triangle`; all others: `ptriangle`, which finally numbers the mesh along a curve (unless
`--numbering blocks` is given). Triangle and `triangle` leave their triangles in the order in which they were made.
Bytes per triangle: peak resident memory of the whole process divided by triangles, including input and, for Triangle,
Python. Triangle's meshes are counted but not checked here. Median (least–most) of {} runs in turns.

"""
TRIANGLE, SEQUENTIAL, ONE, MOST = range(4)


def _cases(settings, domain):
    return [Triangle(settings, domain, judged=False), Sequential(settings, domain), Ours(settings, domain, 1),
            Ours(settings, domain, settings.threads)]


def _line(m, other):
    if not m.good:
        return (m.case.name, "missing: " + m.reason, *["–"] * 9)
    v, smallest = m.verdict, f"{m.verdict.smallest_angle:.2f}" if m.case.judged else "–"
    return (m.case.name, f"{v.triangles:,}", smallest, m.text("delaunay"), m.text("quality"), m.text("number"),
            m.text("memory"), millions_per_second(v.triangles, m.median("quality")),
            ratio(other.median("quality"), m.median("quality")), ratio(other.median("memory"), m.median("memory")),
            f"{m.peak / v.triangles:.0f}")


def _ratio_target(asked, least, above, below, stage, of_above=None):
    """Quotient of the seconds of two cases."""
    reached = above.median(of_above or stage) / below.median(stage) if above.good and below.good else None
    return {"asked": asked, "least": least, "reached": reached}


def _share_target(asked, most, shares):
    return {"asked": asked, "most": most, "reached": statistics.median(shares) if shares else None}


def _sequential_shares(m, threads=64):
    for run in m.runs:
        for predicted in on_threads(run.facts) if run.facts["schedule"] else ():
            if predicted["threads"] == threads:
                yield predicted["sequential_share"]


def _targets(domain, goals, measured):
    """goals: for refinement with one thread (`triangle` or `ptriangle --threads 1`), with all threads, and for the
    quotient of both. 0: none is set."""
    targets, most, triangle = [], measured[MOST], measured[TRIANGLE]
    for goal, indices in ((goals[0], (SEQUENTIAL, ONE)), (goals[1], (MOST,))):
        for i in indices if goal else ():
            asked = f"refinement, {domain.name}, {measured[i].case.name}"
            targets.append(_ratio_target(asked, goal, triangle, measured[i], "quality"))
    if goals[2]:
        targets.append(_ratio_target(f"one thread over all, refinement, {domain.name}", goals[2], measured[ONE], most,
                                     "quality"))
    if domain.angle:
        targets.append(_share_target(f"numbering over refinement, {domain.name}, {most.case.name}", 0.1,
                                     [r.seconds["number"] / r.seconds["quality"] for r in most.runs]))
        targets.append(_ratio_target(f"`triangle` over ours on one thread, {domain.name}", 0.95, measured[SEQUENTIAL],
                                     measured[ONE], "quality"))
        targets.append(_share_target(f"sequential share predicted at 64 threads, {domain.name}", 0.05,
                                     list(_sequential_shares(measured[ONE]))))
    return targets


def _mean_area(domain, m):
    reached = m.verdict.total_area / m.verdict.triangles / domain.area if m.verdict else None
    return {"asked": f"mean area over bound, {domain.name}, {m.case.name}", "least": 0.66, "reached": reached}


# --- whole processes


def _files(settings, domain, goals):
    """From text files to text files, and to HDF5."""
    cases = [Triangle(settings, domain, judged=False), Ours(settings, domain, 1, files="text"),
             Ours(settings, domain, settings.threads, files="text"),
             Ours(settings, domain, settings.threads, files="text", options=("--numbering", "blocks")),
             Ours(settings, domain, settings.threads, files="HDF5")]
    measured = measure(f"stages: {domain.name} -{domain.switches}, with files", cases, settings)
    call, ours = measured[0], measured[1:]
    lines = [(m.case.name, m.text("read"), m.text("delaunay"), m.text("quality"), m.text("number"), m.text("write"),
              m.text("process"), ratio(call.median("memory"), m.median("process"))) for m in ours]
    text = (f"### {domain.name}, -{domain.switches}: the whole process, with files\n\nTriangle 1.6: "
            f"{call.text('memory')} s for its call alone, without reading, writing or filling an output array: the "
            "least a process could take.\n\n" + table(FILES_HEAD, lines))
    targets = [_ratio_target(f"whole process, {domain.name}, {m.case.name}", goal, call, m, "process", "memory")
               for goal, m in zip(goals, (measured[2], measured[4]))]
    return text, [row for m in measured for row in m.rows("stages with files")], targets


def _again(settings, domain):
    """A mesh is read from text files and refined further, with hardly any refinement work."""
    base = os.path.join(settings.work, "inputs", "again_small" if settings.small else "again")
    try:
        Ours(settings, domain, settings.threads).write(base)
    except Failure as failure:
        settings.fail(f"stages, the mesh that is read again: {failure}")
        return f"### {domain.name}, its mesh again\n\nmissing: {failure}\n", [], []
    again = Domain("its mesh, `-r` to the same bounds", base + ".poly", domain.angle, domain.area)
    cases = [Ours(settings, again, n, "r") for n in sorted({1, settings.threads})]
    measured = measure(f"stages: {again.name}", cases, settings)
    lines = [(m.case.name, m.text("read"), m.text("delaunay"), m.text("quality"), m.text("number"), m.text("write"),
              m.text("process"), "–") for m in measured]
    text = f"### {domain.name}, {again.name}: the whole process without writing\n\n" + table(FILES_HEAD, lines)
    target = _ratio_target(f"one thread over all, whole process, {again.name}", 1.8, measured[0], measured[-1],
                           "process")
    return text, [row for m in measured for row in m.rows("stages again")], [target]


# --- all stages


def _jobs(settings):
    coasts = [norway(settings, 30, 2.2e5), *shared_coasts(settings, 30, 0.016)[-1:]]
    yield letter(settings, 2.5e-8), (9, 16, 0)
    yield square(settings, 1e-7), (4.8, 9, 0)
    yield random_points(settings, 30), (0, 0, 0)
    for coast in coasts:
        yield coast, (0, 0, 1.9)


def _stages(settings, domain, goals):
    measured = measure(f"stages: {domain.name} -{domain.switches}", _cases(settings, domain), settings)
    text = f"### {domain.name}, `-{domain.switches}`\n\n" + table(HEAD, [_line(m, measured[0]) for m in measured])
    targets, most = _targets(domain, goals, measured), measured[MOST]
    if domain.name.startswith("unit square"):
        targets += [_mean_area(domain, m) for m in measured[SEQUENTIAL:]]
    elif domain.path.endswith(".node"):
        targets.append(_ratio_target(f"all, {domain.name}, {most.case.name}", 7, measured[TRIANGLE], most, "memory"))
    return text, [row for m in measured for row in m.rows("stages")], targets


def _triangulation(settings, domain):
    """A case with so many points that reading and checking dominate: the target is at most twice the time."""
    cases = [Triangle(settings, domain, judged=False), Ours(settings, domain, 1),
             Ours(settings, domain, settings.threads)]
    measured = measure(f"stages: {domain.name}", cases, settings, min(2, settings.repeats))
    text = f"### {domain.name}\n\n" + table(HEAD, [_line(m, measured[0]) for m in measured])
    targets = [_ratio_target(f"triangulation, {domain.name}, {measured[2].case.name}", 5, measured[0], measured[2],
                             "delaunay"),
               _ratio_target(f"one thread over all, triangulation, {domain.name}", 1.85, measured[1], measured[2],
                             "delaunay")]
    return text, [row for m in measured for row in m.rows("stages")], targets


def run(settings):
    figure = letter(settings, 2.5e-8)
    steps = [(_files, figure, (9, 12)), *((_stages, *job) for job in _jobs(settings)), (_again, figure),
             (_triangulation, random_points(settings, 0, 10_000_000))]
    texts, rows, targets = [], [], []
    for step, *what in steps:
        text, more_rows, more_targets = step(settings, *what)
        texts.append(text)
        rows += more_rows
        targets += more_targets
        yield {"title": "Stages, beside Triangle 1.6", "text": NOTE.format(settings.repeats) + "\n".join(texts),
               "rows": rows, "targets": targets}
