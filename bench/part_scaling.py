"""The same mesh made by increasing numbers of threads, and predictions for more threads from the report of one."""
from cases import Ours
from inputs import letter, norway, random_points, square
from measure import measure, ratio, seconds_text, table
from prediction import on_threads

HEAD = ("threads", "Delaunay, s", "Quality, s", "speedup of Quality", "efficiency", "predicted Quality, s",
        "predicted speedup")
NOTE = """\
`ptriangle` on one to all cores. Efficiency is speedup divided by threads. Predicted times are computed from the run on
one thread: list scheduling of its blocks, equal shares of the search for bad triangles, and all other work sequential.
Median (least–most) of {} runs in turns.

"""


def _predictions(m):
    """Seconds of the stage Quality by number of threads."""
    report = m.typical("quality").facts if m.good else None
    return {p["threads"]: p["quality_seconds"] for p in on_threads(report)} if report and report["schedule"] else {}


def _lines(measured):
    one, predicted = measured[0], _predictions(measured[0])
    times = {m.case.threads: m for m in measured}
    for n in sorted({*times, *predicted}):
        m = times.get(n)
        speed = one.median("quality") / m.median("quality") if m and m.good and one.good else None
        guess = predicted.get(n)
        yield (n, m.text("delaunay") if m else "–", m.text("quality") if m else "–", f"{speed:.2f}" if speed else "–",
               f"{100 * speed / n:.0f}%" if speed else "–", seconds_text(guess) if guess else "–",
               ratio(predicted.get(1), guess, 2))


def _same(measured, settings):
    """Compares the files of all numbers of threads by their checksums."""
    sums = [m.verdict.checksum for m in measured if m.verdict]
    if len(set(sums)) > 1:
        settings.fail("scaling: the files differ with the number of threads")
        return "THE FILES DIFFER."
    if len(sums) < len(measured):
        return f"Only {len(sums)} of {len(measured)} numbers of threads made files, and these are equal."
    return "Same files, byte for byte, for all numbers of threads."


def run(settings):
    domains = [square(settings, 1e-7), letter(settings, 2.5e-8), norway(settings, 30, 2.2e5),
               random_points(settings, 30)]
    texts, rows = [], []
    for domain in domains:
        cases = [Ours(settings, domain, n) for n in settings.thread_counts()]
        measured = measure(f"scaling: {domain.name} -{domain.switches}", cases, settings)
        size = f"{measured[0].verdict.triangles:,} triangles. " if measured[0].verdict else ""
        texts.append(f"### {domain.name}, `-{domain.switches}`\n\n{size}{_same(measured, settings)}\n\n"
                     + table(HEAD, _lines(measured)))
        rows += [row for m in measured for row in m.rows("scaling")]
        text = NOTE.format(settings.repeats) + "\n".join(texts)
        yield {"title": "Scaling", "text": text, "rows": rows, "targets": []}
