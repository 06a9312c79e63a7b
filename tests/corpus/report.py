#!/usr/bin/env python3
"""Compares triangles and bad triangles of inputs collected from users with those of the last release (baseline.txt).

  tests/corpus/report.py build/release/bin                # by family, by switches, the largest single ratios
  tests/corpus/report.py build/release/bin --renew        # for a release: writes a new baseline

Inputs: data/ without nasty/ and regress/, whose figures have other purposes, and, if it exists, a folder of more inputs
beside the repository (--more), without nasty ones and results of searches for faults. Inputs that are empty with -p,
such as open drawings, are meshed with -pc.

A triangle below the angle bound is bad. Ratios are numbers of triangles divided by those of the baseline; means are
geometric. Exit code 1, with a line for each reason: a run fails or takes too long; trianglecheck finds faults in a
mesh, or counts other bad triangles than `triangle` reports; numbers of triangles or bad triangles exceed the limits
below.
"""
import argparse
import concurrent.futures
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile

SWITCHES = "q20", "q30", "q33", "q34", "q20D"
SECONDS, POINTS = 60, 1500000  # limits: seconds of each program; points of each mesh, above which it is skipped
LARGEST = 1500000  # largest input in bytes
SINGLE, FEW = 1.3, 100  # limits on ratio and increase of triangles unless fewer are bad, and vice versa
MEAN, BAD = 1.01, 1.05  # largest mean ratio of triangles, and ratio of all bad triangles

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
HEAD = """\
# Meshes of the last release (report.py --renew), a line for each input: triangles/bad ones, with -p or -pc and
#   %s
# 0/0: nothing to mesh; -: too many points. What is not below data/ is not part of the repository.
""" % " ".join(SWITCHES)


def inputs(folder, without, prefix):
    """Names and paths of the inputs in a folder: .poly files, and .node files without segments."""
    found = {}
    for path, folders, files in os.walk(folder):
        folders[:] = sorted(name for name in folders if not re.match(without, name))
        for name in sorted(name for name in files if not re.match(without, name)):
            base, suffix = os.path.splitext(os.path.join(path, name))
            alone = not os.path.exists(base + ".poly") and not os.path.exists(base + ".ele")
            if (suffix == ".poly" or suffix == ".node" and alone) and os.path.getsize(base + suffix) <= LARGEST:
                found[prefix + os.path.relpath(base + suffix, folder)] = base + suffix
    return found


def family(name):
    """Family of an input: data/coast/x.poly: data/coast; more/hard/gis2_x.poly: more/hard/gis; more/peers_x/y.poly:
    more/peers."""
    return re.match("data/[a-z]+/|data/|more/hard/[a-z]+|more/[a-z]+", name).group().rstrip("/")


def run(words, folder):
    done = subprocess.run(words, cwd=folder, capture_output=True, timeout=SECONDS, check=False, text=True)
    if done.returncode not in ((0, 1) if "--json" in words else (0,)):
        raise RuntimeError("exit code %d: %s" % (done.returncode, (done.stderr.splitlines() or [""])[0]))
    return done.stdout


def number(pattern, text):
    match = re.search(pattern, text, re.MULTILINE)
    return int(match.group(1)) if match else 0


def judge(bin_dir, folder, given, switches, said, bad):
    """Raises an error if the mesh, or the report about it, is wrong."""
    more = (["--keep-hull"] if "c" in switches else []) + (["--conforming"] if "D" in switches else [])
    words = ["--json", "--poly", given, "--min-angle", re.search("[0-9]+", switches).group(), "--max-bad", "1000000000"]
    report = json.loads(run([bin_dir + "/trianglecheck", *words, *more, "--threads", "1", "x.1"], folder))
    failed = {check["name"]: check for check in report["checks"] if check["state"] == "failed"}
    circles = number(r"^(\d+) subsegments? keeps? a vertex in", said)
    if circles and failed.get("diametral circles", {"count": 0})["count"] == circles:  # all of them were counted
        failed = {name: check for name, check in failed.items() if name not in ("diametral circles", "Delaunay")}
    if failed or report["below_min_angle"] != bad:
        raise RuntimeError("%d bad triangles, trianglecheck: %d, %s" % (bad, report["below_min_angle"], failed))


def mesh(bin_dir, path, switches):
    """Triangles and bad triangles, or None if there are too many points."""
    with tempfile.TemporaryDirectory() as folder:
        base, suffix = os.path.splitext(path)
        for part in {".node", suffix}:
            if os.path.exists(base + part):
                shutil.copy(base + part, os.path.join(folder, "x" + part))
        for kind in ("-p", "-pc") if suffix == ".poly" else ("-",):
            said = run([bin_dir + "/triangle", "%s%sS%d" % (kind, switches, POINTS), "x" + suffix], folder)
            if "for the limit of -S" in said:
                return None
            triangles, bad = number(r"^  Mesh triangles: (\d+)$", said), number(r"^(\d+) triangles? stays? below", said)
            if triangles:
                judge(bin_dir, folder, "x" + suffix, kind + switches, said, bad)
                return triangles, bad
    return 0, 0


def measure(bin_dir, found, faults):
    """{name: [(triangles, bad ones), ...]}, with None for runs that failed or had too many points."""
    def one(task):
        try:
            return mesh(bin_dir, found[task[0]], task[1])
        except (RuntimeError, subprocess.TimeoutExpired, ValueError) as problem:
            faults.append("%s -%s: %s" % (*task, problem))
            return None
    tasks = [(name, switches) for name in found for switches in SWITCHES]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(one, tasks))
    return {name: results[i * len(SWITCHES):(i + 1) * len(SWITCHES)] for i, name in enumerate(found)}


def read_baseline(path):
    with open(path, encoding="ascii") as stream:
        lines = [line.split() for line in stream if not line.startswith("#")]
    return {name: [tuple(map(int, run.split("/"))) if run != "-" else None for run in runs] for name, *runs in lines}


def write_baseline(path, made):
    """Writes the baseline. Lines of inputs that do not exist here, or were not selected, are kept."""
    lines = read_baseline(path) if os.path.exists(path) else {}
    lines.update(made)
    with open(path, "w", encoding="ascii", newline="\n") as stream:
        stream.write(HEAD)
        for name in sorted(lines):
            stream.write(" ".join([name] + ["%d/%d" % pair if pair else "-" for pair in lines[name]]) + "\n")


def compare(made, baseline):
    """[(name, switches, now, before)] for the meshes in the baseline. now may be None, or (0, 0)."""
    return [(name, switches, now, before) for name, runs in made.items() if name in baseline
            for switches, now, before in zip(SWITCHES, runs, baseline[name]) if before and before[0]]


def mean(pairs):
    return math.exp(sum(math.log(now[0] / before[0]) for _, _, now, before in pairs) / max(len(pairs), 1))


def total(pairs):
    """Triangles now and before, bad triangles now and before."""
    return tuple(sum(pair[when][what] for pair in pairs) for what in (0, 1) for when in (2, 3))


def tell(pairs):
    print("%-14s%7s" % ("mean, bad, before", "inputs") + "".join("%20s" % ("-p" + switches) for switches in SWITCHES))
    for kind in sorted({family(pair[0]) for pair in pairs}):
        rows = [pair for pair in pairs if family(pair[0]) == kind]
        line = "%-17s%7d" % (kind, len({pair[0] for pair in rows}))
        for switches in SWITCHES:
            some = [pair for pair in rows if pair[1] == switches]
            line += "  %6.3f%6d%6d" % (mean(some), *total(some)[2:])
        print(line)
    print("\nswitches  meshes   mean   triangles    before       bad    before")
    for switches in (*SWITCHES, "all"):
        some = [pair for pair in pairs if switches in (pair[1], "all")]
        print("%-8s%8d %6.3f%12d%10d%10d%10d" % (switches, len(some), mean(some), *total(some)))
    print("\nratio   triangles    before       bad    before")
    for pair in sorted(pairs, key=lambda pair: pair[3][0] / pair[2][0])[:10]:
        print("%5.2f%12d%10d%10d%10d  %s -%s" % (mean([pair]), *total([pair]), *pair[:2]))


def worse(pairs):
    for name, switches, now, before in pairs:
        for what, word in enumerate(("triangles", "bad ones")):
            if now[what] > SINGLE * before[what] + FEW and now[1 - what] >= before[1 - what]:
                yield "%s -%s: %d %s, %d before" % (name, switches, now[what], word, before[what])
    if mean(pairs) > MEAN:
        yield "all: %.3f times the triangles in the mean" % mean(pairs)
    if total(pairs)[2] > BAD * total(pairs)[3]:
        yield "all: %d bad ones, %d before" % total(pairs)[2:]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=os.path.abspath, help="folder of triangle and trianglecheck")
    parser.add_argument("--baseline", default=ROOT + "/tests/corpus/baseline.txt", help="another file to compare with")
    parser.add_argument("--more", default=ROOT + "/../shared/data", help="more inputs; may be absent")
    parser.add_argument("--only", default="", help="inputs whose names hold this")
    parser.add_argument("--renew", action="store_true", help="write the baseline")
    asked = parser.parse_args()
    found, faults = inputs(ROOT + "/data", "nasty|regress", "data/"), []
    found.update(inputs(asked.more, "nasty|found", "more/"))
    made = measure(asked.bin, {name: path for name, path in found.items() if asked.only in name}, faults)
    if asked.renew:
        write_baseline(asked.baseline, made)
    else:
        pairs = compare(made, read_baseline(asked.baseline))
        lost = [pair for pair in pairs if not pair[2] or not pair[2][0]]
        faults += ["%s -%s: no mesh, %d triangles before" % (*pair[:2], pair[3][0]) for pair in lost]
        pairs = [pair for pair in pairs if pair not in lost]
        tell(pairs)
        faults += worse(pairs)
    print("".join("WORSE %s\n" % fault for fault in sorted(faults)), end="")
    return 1 if faults or not made else 0


if __name__ == "__main__":
    sys.exit(main())
