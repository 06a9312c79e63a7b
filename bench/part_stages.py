"""Where the time goes, stage by stage, beside Triangle 1.6 on the same input in the same turns; and the targets
that speak of it."""
from cases import Ours, Sequential, Triangle
from inputs import letter, norway, plate, random_points, shared_coasts, square
from measure import measure, millions_per_second, ratio, table

HEAD = ("program", "triangles", "smallest angle", "Delaunay, s", "Quality, s", "numbering, s", "all, s",
        "M/s in Quality", "Triangle's Quality over it", "Triangle's all over it", "bytes a triangle")
FILES_HEAD = ("program", "read, s", "Delaunay, s", "Quality, s", "numbering, s", "write, s", "process, s",
              "Triangle's call over it")
NOTE = """\
In memory, without files. Triangle 1.6: Delaunay is a call of its library function without bounds, all a call with
them, Quality the difference; the calls ask for no output arrays, and all conversion of input is outside the clock.
Ours, sequential: `triangle`; else `ptriangle`, which numbers the mesh along a curve when it is done (unless told
`--numbering blocks`); Triangle and `triangle` leave their triangles in the order in which they came about. Bytes a
triangle: resident peak of the whole process over triangles made, input and, for Triangle, Python included. Median
(least–most) of {} runs in turns.

"""
TRIANGLE, SEQUENTIAL, ONE, MOST = range(4)


def _cases(settings, domain):
    return [Triangle(settings, domain), Sequential(settings, domain), Ours(settings, domain, 1),
            Ours(settings, domain, settings.threads)]


def _line(m, other):
    if not m.good:
        return (m.case.name, "missing: " + m.reason, *["–"] * 9)
    v = m.verdict
    return (m.case.name, f"{v.triangles:,}", f"{v.smallest_angle:.2f}", m.text("delaunay"), m.text("quality"),
            m.text("number"), m.text("memory"), millions_per_second(v.triangles, m.median("quality")),
            ratio(other.median("quality"), m.median("quality")), ratio(other.median("memory"), m.median("memory")),
            f"{m.peak / v.triangles:.0f}")


def _with_files(settings, domain):
    """The whole process, from text files to text files."""
    cases = [Triangle(settings, domain), Ours(settings, domain, 1, files=True),
             Ours(settings, domain, settings.threads, files=True),
             Ours(settings, domain, settings.threads, files=True, options=("--numbering", "blocks"))]
    measured = measure(f"stages: {domain.name} -{domain.switches}, with files", cases, settings)
    call, ours = measured[0], measured[1:]
    lines = [(m.case.name, m.text("read"), m.text("delaunay"), m.text("quality"), m.text("number"), m.text("write"),
              m.text("process"), ratio(call.median("memory"), m.median("process"))) for m in ours]
    text = (f"### {domain.name}, -{domain.switches}: the whole process, with text files\n\nTriangle 1.6: "
            f"{call.text('memory')} s for its call alone, without reading, writing or filling an output array: the "
            "least a process could take.\n\n" + table(FILES_HEAD, lines))
    return text, measured


def _target(asked, least, measured, other, stage, against="memory"):
    reached = other.median(against) / measured.median(stage) if other.good and measured.good else None
    return {"asked": asked, "least": least, "reached": reached}


def _quality_targets(name, goals, measured):
    """goals: what is asked of one thread and of two; one thread is `triangle` or `ptriangle --threads 1`."""
    targets = []
    for goal, indices in zip(goals, ((SEQUENTIAL, ONE), (MOST,))):
        for i in indices if goal else ():
            asked = f"refinement, {name}, {measured[i].case.name}"
            targets.append(_target(asked, goal, measured[i], measured[TRIANGLE], "quality", "quality"))
    return targets


def _mean_area(domain, m):
    reached = m.verdict.total_area / m.verdict.triangles / domain.area if m.verdict else None
    return {"asked": f"mean area over bound, {domain.name}, {m.case.name}", "least": 0.66, "reached": reached}


def run(settings):
    points = random_points(settings, 30)
    coasts = [norway(settings, 30, 2.2e5), *shared_coasts(settings, 30, 0.016)]
    jobs = [(letter(settings, 2.5e-8), (6, 11)), (square(settings, 1e-7), (4.5, 8)), *((c, (0, 6)) for c in coasts),
            (plate(settings, 1e-4), (0, 0)), (points, (0, 6)), (points.without_bounds(), (0, 0))]
    texts, rows, targets = [], [], []
    for domain, goals in jobs:
        measured = measure(f"stages: {domain.name} -{domain.switches}", _cases(settings, domain), settings)
        lines = [_line(m, measured[TRIANGLE]) for m in measured]
        texts.append(f"### {domain.name}, `-{domain.switches}`\n\n" + table(HEAD, lines))
        rows += [row for m in measured for row in m.rows("stages")]
        targets += _quality_targets(domain.name, goals, measured)
        if domain.name.startswith("unit square"):
            targets += [_mean_area(domain, m) for m in measured[SEQUENTIAL:]]
        elif domain is points:
            targets.append(_target(f"triangulation and refinement, {domain.name}, {measured[MOST].case.name}", 6,
                                   measured[MOST], measured[TRIANGLE], "memory"))
        elif not domain.angle:
            targets.append(_target(f"triangulation, {domain.name}, {measured[MOST].case.name}", 2.5, measured[MOST],
                                   measured[TRIANGLE], "delaunay"))
    text, measured = _with_files(settings, jobs[0][0])
    rows += [row for m in measured for row in m.rows("stages with files")]
    targets += [_target(f"whole process with text files, {jobs[0][0].name}, {m.case.name}", 7, m, measured[0],
                        "process") for m in measured[2:]]
    text = NOTE.format(settings.repeats) + "\n".join([*texts, text])
    return {"title": "Stages, beside Triangle 1.6", "text": text, "rows": rows, "targets": targets}
