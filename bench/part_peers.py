"""Other mesh generators on the same domains with comparable bounds: speed, smallest angle, mesh size, memory."""
from cases import Cgal, Gmsh, Ours, Sequential, Spade, Triangle
from inputs import letter, norway, plate, random_points, square
from measure import measure, millions_per_second, table

HEAD = ("program", "triangles", "smallest angle", "seconds", "M/s", "peak memory, MB", "judged")
NOTE = """\
Seconds from points and segments in memory to the mesh in memory. Bounds are 20 degrees and the given area, also for
CGAL (Delaunay mesher with criteria of ours) and spade. gmsh has neither bound: it gets the edge length of equilateral
triangles of 0.66 of the area bound, has its geometry before the clock starts, and is not checked for the Delaunay
property. Only `ptriangle` uses more than one thread. Peak memory is that of the process (including Python for Triangle
and gmsh). Median (least–most) of {} runs in turns.

"""
LIMIT, SMALL_LIMIT = 120, 20  # seconds of one run
REPEATS = 3                   # at most; some generators need a minute


def _cases(settings, domain):
    cases = [Ours(settings, domain, settings.threads), Ours(settings, domain, 1), Sequential(settings, domain),
             Triangle(settings, domain), Cgal(settings, domain), Spade(settings, domain)]
    if domain.angle:
        cases.append(Gmsh(settings, domain, 5, "gmsh, Delaunay"))
        if not settings.small:
            cases.append(Gmsh(settings, domain, 6, "gmsh, frontal-Delaunay"))
    for case in cases:
        case.limit = SMALL_LIMIT if settings.small else LIMIT
    return cases


def _judged(m, area):
    """A mesh that does not cover the domain is a mesh of another domain, regardless of other faults. area: 0,
    unknown."""
    wrong = area and abs(m.verdict.total_area / area - 1) > 1e-9
    return f"covers {m.verdict.total_area / area:.6f} of the domain" if wrong else m.verdict.text


def _line(m, area):
    if not m.good:
        return (m.case.name, "–", "–", m.reason, "–", "–", "–")
    n = m.verdict.triangles
    return (m.case.name, f"{n:,}", f"{m.verdict.smallest_angle:.2f}", m.text("memory"),
            millions_per_second(n, m.median("memory")), f"{m.peak / 1e6:.0f}", _judged(m, area))


def run(settings):
    domains = [letter(settings, 1e-7), square(settings, 1e-6), norway(settings, 20, 1e6), plate(settings, 4e-4),
               random_points(settings, 0)]
    texts, rows, repeats = [], [], min(REPEATS, settings.repeats)
    for domain in domains:
        measured = measure(f"peers: {domain.name} -{domain.switches}", _cases(settings, domain), settings, repeats)
        lines = [_line(m, measured[0].verdict.total_area if measured[0].verdict else 0) for m in measured]
        texts.append(f"### {domain.name}, `-{domain.switches}`\n\n" + table(HEAD, lines))
        rows += [row for m in measured for row in m.rows("peers")]
        text = NOTE.format(repeats) + "\n".join(texts)
        yield {"title": "Other mesh generators", "text": text, "rows": rows, "targets": []}
