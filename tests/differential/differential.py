"""Compares our `triangle` with Triangle 1.6 on the same generated inputs.

  python3 differential.py BIN_DIR WORK_DIR ORACLE_PYTHON LIBRARY|"" [CASE [SWITCHES]]

Results that input and switches determine are compared (compare.py). Others are checked by rules that Triangle's own
meshes obey (rules.py) and by `trianglecheck`. If the original crashes, hangs or refuses, ours must still succeed. The
shared library LIBRARY contains our C interface, which must return the same data as the program writes.

Prints one line per fault, with the command that repeats it. Exit code 1 if there is any. With CASE, only that case
runs.
"""
import math
import os
import subprocess
import sys

import cases
import compare
import geometry
import meshes
import remesh
import rules
from oracle import Oracle

SECONDS = 20  # time limit for one run of ours
ORACLE_SECONDS = 3
MOST_TRIANGLES = 1.05  # largest geometric mean of triangles in refined meshes, relative to the original

POINTS = (("", "env", "c"), ("o2env", "j", "Ben", "i", "F", "l", "V", "X", "w", "q0env", "cjo2", "aS0", "VC"))
FIGURES = (("p", "pcenv", "penvA"),
           ("pO", "pcO", "pBe", "po2env", "pj", "pA", "pV", "pYY", "pi", "pF", "pl", "pqS0", "pq0", "pz", "pAjn", "pcA",
            "paS0", "pX", "pw", "pcj", "pcB", "pcV", "pOAo2"))
REFINED = ("pq", "pqaAenv", "pq30", "pqYYen", "pD", "pqY", "pq25aA", "pqDe", "pqo2en", "pqS7", "pq33jA", "pa{area}",
           "pqa{area}", "pcqAa", "pqOBe")


class Count:
    """Results of the whole run."""

    def __init__(self):
        self.runs = self.compared = self.faults = 0
        self.failures = {}  # failures of the original: {kind: number}
        self.free = 0  # number of meshes that only rules could check
        self.ratios = []  # logarithms of the ratio of triangles in refined meshes, ours to theirs


def in_turn(switches, index, n):
    return [switches[(n * index + k) % len(switches)] for k in range(n)]


def with_area(switches, case):
    """An area bound for a few hundred triangles."""
    size = geometry.extent(case.points)
    return [s.replace("{area}", f"{size * size / 300:.6f}") for s in switches]


def switches_of(case, index):
    """Sets of switches: the first ones for every case, some of the others in turn."""
    if isinstance(case, remesh.MeshCase):
        return with_area(in_turn(remesh.PLAIN, index, 3) + in_turn(remesh.REFINED, index, 2), case)
    always, others = POINTS if "points" in case.traits else FIGURES
    refined = () if "points" in case.traits else REFINED
    return with_area(list(always) + in_turn(others, index, 4) + (in_turn(refined, index, 2) if refined else []), case)


def refines(switches):
    return any(k in switches for k in "qaD") and not ("S0" in switches or "q0" in switches)


# --- ours

def write_input(case, folder):
    for name in os.listdir(folder):
        os.remove(os.path.join(folder, name))
    for suffix, text in case.files().items():
        with open(os.path.join(folder, "case." + suffix), "w", encoding="ascii") as file:
            file.write(text)


def call(words, folder):
    try:
        done = subprocess.run(words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=SECONDS,
                              check=False, encoding="utf-8", errors="replace")
        return done.returncode, done.stdout
    except subprocess.TimeoutExpired:
        return -1, f"no end within {SECONDS} s"


def judge_words(case, switches):
    """Options of trianglecheck. Angles below the bound because of -Y, -S or sharp input are not checked here."""
    words = case.judge(switches)
    whole = "points" in case.traits or ("c" in switches and ("O" in switches or not case.holes))
    # if a hull edge is split at a rounded point, it has a corner there in exact arithmetic
    if whole and "r" not in switches and not refines(switches):
        words.append("--convex")
    words += ["--keep-hull"] * ("c" in switches and "r" not in switches)
    words += ["--keep-holes"] * ("O" in switches) + ["--jettisoned"] * ("j" in switches)
    words += ["--conforming"] * ("D" in switches and "Y" not in switches and "sharp" not in case.traits)
    if "q" in switches and refines(switches) and not any(k in switches for k in "YS"):
        digits = switches.split("q")[1][:2]
        words += ["--min-angle", digits if digits.isdigit() else "20"]
        words += ["--max-bad", "100000"] * ("sharp" in case.traits)
    return words


def ours(case, switches, bin_dir, folder):
    """Our mesh, and sentences about its faults."""
    write_input(case, folder)
    code, printed = call([os.path.join(bin_dir, "triangle"), "-" + switches, case.word()], folder)
    if code != 0:
        return None, [f"exit code {code}: {printed.strip().splitlines()[-1:]}"]
    written = {f[len("case.1."):] for f in os.listdir(folder) if f.startswith("case.1.")}
    mesh = meshes.from_files(os.path.join(folder, "case.1"), case.base, written, printed)
    if not mesh.triangles:
        return mesh, []
    code, verdict = call([os.path.join(bin_dir, "trianglecheck"), "--quiet"] + judge_words(case, switches) + ["case.1"],
                         folder)
    return mesh, [f"trianglecheck: {verdict.strip()}"] if code != 0 else []


# --- theirs

def without_copies(case):
    """The same figure with one vertex per position: the original should have treated the case like this."""
    data = dict(case.as_dict())
    name = compare.names_of_input(case)
    data["segments"] = [(name[a], name[b]) for a, b in case.segments]
    keep = [k for k, a in enumerate(name) if a == k]
    place = {k: i for i, k in enumerate(keep)}
    for column in ("points", "markers", "attributes"):
        data[column] = [data[column][k] for k in keep] if data[column] else []
    data["segments"] = [(place[a], place[b]) for a, b in data["segments"]]
    return data, keep


def put_back(mesh, case, keep):
    """Replaces the numbers in the mesh of without_copies by those of the case."""
    n = len(case.points)
    number = keep + list(range(n, n + len(mesh.points) - len(keep)))
    extra = len(keep)
    mesh.points = case.points + mesh.points[extra:]
    if mesh.attributes:
        mesh.attributes = case.attributes + mesh.attributes[extra:]
    if mesh.markers:
        mesh.markers = [dict(zip(keep, mesh.markers)).get(v, case.markers[v]) for v in range(n)] + mesh.markers[extra:]
    for what in ("triangles", "segments", "edges"):
        if getattr(mesh, what):
            setattr(mesh, what, [tuple(number[v] for v in row) for row in getattr(mesh, what)])
    mesh.printed = mesh.printed.replace(f"Input vertices: {len(keep)}\n", f"Input vertices: {n}\n")
    return mesh


def theirs(case, switches, oracle, count):
    """The oracle's mesh, or None. Failures of the original are counted."""
    answer = oracle.ask("z" + switches, case.as_dict())
    if isinstance(answer, str):
        count.failures[answer] = count.failures.get(answer, 0) + 1
    if "duplicates" in case.traits and "points" not in case.traits and "j" not in switches:
        data, keep = without_copies(case)
        answer = oracle.ask("z" + switches, data)
        return None if isinstance(answer, str) else put_back(meshes.from_oracle(answer), case, keep)
    return None if isinstance(answer, str) else meshes.from_oracle(answer)


# --- refined meshes: by rule

def place_in(plain, point):
    """The triangle of a mesh that contains a point, or None."""
    for t, (a, b, c) in enumerate(plain.corners()):
        p, q, r = (plain.points[v] for v in (a, b, c))
        if min(geometry.orient(u, v, point) for u, v in ((p, q), (q, r), (r, p))) >= 0:
            return t
    return None


def inherited(case, plain):
    """Area bound and attributes of each triangle of the plain mesh: those of the last region point that reaches it."""
    if isinstance(case, remesh.MeshCase):
        return case.areas, case.triangle_attributes
    sides, fixed = plain.sides(), compare.constrained(plain)
    bounds, values = [0.0] * len(plain.triangles), [(0.0,)] * len(plain.triangles)
    for x, y, value, bound in case.regions:
        seed = place_in(plain, (x, y))
        stack, seen = [seed] if seed is not None else [], set()
        while stack:
            t = stack.pop()
            if t in seen:
                continue
            seen.add(t)
            bounds[t], values[t] = bound, (value,)
            a, b, c = plain.corners()[t]
            for side in (meshes.pair(a, b), meshes.pair(b, c), meshes.pair(c, a)):
                stack += [u for u in sides[side] if side not in fixed]
    return bounds, values


def regions(case, switches, mesh, plain):
    """Each triangle has the attributes and meets the area bound of its part."""
    bounds, values = inherited(case, plain)
    bounded = rules.bare_area(switches) and "S" not in switches and "Y" not in switches
    for t, corners in enumerate(mesh.corners()):
        places = [mesh.points[v] for v in corners]
        at = place_in(plain, tuple(sum(p[k] for p in places) / 3 for k in (0, 1)))
        if at is None:
            continue  # on a side, up to rounding
        if mesh.triangle_attributes and tuple(mesh.triangle_attributes[t]) != values[at]:
            yield f"triangle {t} has attributes {mesh.triangle_attributes[t]} instead of {values[at]}"
        if bounded and bounds[at] > 0 and geometry.area(*places) > bounds[at] * (1 + 1e-12):
            yield f"triangle {t} has area {geometry.area(*places)}, the bound of its part is {bounds[at]}"


def chain_counts(case, switches, mesh, plain):
    """-Y, -YY and -S: protected segments are as in the plain mesh."""
    if "S7" in switches and len(mesh.points) > len(plain.points) + 7:
        yield f"{len(mesh.points) - len(plain.points)} new vertices"
    if "YY" in switches and compare.constrained(mesh) != compare.constrained(plain):
        yield "a segment is split"
    elif "Y" in switches and mesh.boundary() != plain.boundary():
        yield "the boundary is split"


def refined_faults(case, switches, mesh, bin_dir, folder):
    if "crossing" in case.traits and "Y" in switches:
        return []
    if isinstance(case, remesh.MeshCase):
        plain, faults = case.mesh, []
        if "p" not in switches:
            return []  # without segments there are no parts
    else:
        plain, faults = ours(case, "p" + "".join(k for k in "cO" if k in switches), bin_dir, folder)
    return faults + list(regions(case, switches, mesh, plain)) + list(chain_counts(case, switches, mesh, plain))


# --- all checks

def library_faults(case, switches, mesh, library):
    answer = library.ask("z" + switches, case.as_dict())
    if isinstance(answer, str):
        return ["the library " + answer]
    return list(compare.agreement(mesh, meshes.from_oracle(answer)))


def examine(case, switches, bin_dir, folder, oracle, library, count):
    if "needles" in case.traits and any(k in switches for k in "Xq"):
        return []  # the original rounds here
    count.runs += 1
    mesh, faults = ours(case, switches, bin_dir, folder)
    if mesh is None:
        return faults
    faults += rules.breaches(mesh, case, switches)
    faults += library_faults(case, switches, mesh, library) if library else []
    other = theirs(case, switches, oracle, count)
    if other is None:
        count.free += 1
        return faults
    if refines(switches):
        faults += refined_faults(case, switches, mesh, bin_dir, folder)
        if mesh.triangles and other.triangles and "S" not in switches and "Y" not in switches:
            count.ratios.append(math.log(len(mesh.triangles) / len(other.triangles)))
    else:
        count.compared += 1
        faults += compare.compare(mesh, other, case, switches)
    other.holes = None  # the oracle returns its own input
    return faults + ["the original's mesh: " + text for text in rules.breaches(other, case, switches)]


def report(case, switches, faults, count):
    count.faults += 1
    print(f"differential: {case.name} {switches!r}: " + "; ".join(faults[:3])
          + (f"; and {len(faults) - 3} more" if len(faults) > 3 else ""), flush=True)


def with_meshes(bin_dir, folder):
    """The generated cases, each followed by its plain mesh as a case, if there is one."""
    for index, case in enumerate(cases.all_cases()):
        yield index, case
        mesh, _ = ours(case, "j" if "points" in case.traits else "pj", bin_dir, folder)
        if mesh and mesh.triangles:
            yield index, remesh.MeshCase(case.name + "_mesh", case, mesh)


def main(bin_dir, folder, python, shared, only=None, only_switches=None):
    os.makedirs(folder, exist_ok=True)
    oracle, library, count = Oracle(python, ORACLE_SECONDS), None, Count()
    if shared:
        library = Oracle(sys.executable, SECONDS, os.path.abspath(shared))
    for index, case in with_meshes(bin_dir, folder):
        if only not in (None, case.name):
            continue
        for switches in [only_switches] if only_switches is not None else switches_of(case, index):
            faults = examine(case, switches, bin_dir, folder, oracle, library, count)
            if faults:
                report(case, switches, faults, count)
    oracle.stop()
    if library:
        library.stop()
    failed = ", ".join(f"{how} {times} times" for how, times in sorted(count.failures.items())) or "never fails"
    print(f"differential: {count.runs} runs, {count.compared} compared, {count.faults} faults; the original {failed}, "
          f"{count.free} runs have no mesh of it")
    ratio = math.exp(sum(count.ratios) / max(1, len(count.ratios)))
    print(f"differential: refined meshes have {ratio:.3f} of the original's triangles (geometric mean of "
          f"{len(count.ratios)}; at most {MOST_TRIANGLES})")
    return 0 if count.runs and not count.faults and ratio <= MOST_TRIANGLES else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
