#!/usr/bin/env python3
"""Measures the sizes of the meshes that Triangle 1.6 makes of the inputs: data/yardstick.txt.

  python3 -m venv v && v/bin/pip install triangle==20250106 && v/bin/python tools/make_yardstick.py [data]

The PyPI package `triangle` is used as a black box, one process per run with a time limit, because it crashes and hangs.
With -p the triangle counts are compared with data/expected.txt.
"""
import os
import resource
import subprocess
import sys

import pslg_facts

LIMIT = 10  # seconds of CPU
HEAD = """\
# Mesh sizes of Triangle 1.6 (PyPI package triangle 20250106, black box), a yardstick: ours are to be no larger.
#   file  switches  vertices  triangles     (vertices that are corners of triangles)
# Runs that crashed, failed or used more than %d s, or whose -p run is wrong already, are comments.
""" % LIMIT


def measure(path, switches):
    """Runs in the child process: prints the numbers of used vertices and of triangles."""
    import triangle
    pslg = pslg_facts.read(path)
    content = {"vertices": pslg.points}
    if pslg.segments:
        content["segments"] = pslg.segments
    for name in ("holes", "regions"):
        if getattr(pslg, name):
            content[name] = getattr(pslg, name)
    made = triangle.triangulate(content, switches).get("triangles", [])
    print("counts", len({int(v) for t in made for v in t}), len(made))


def run(path, switches):
    def limits():
        resource.setrlimit(resource.RLIMIT_CPU, (LIMIT, LIMIT))
        resource.setrlimit(resource.RLIMIT_AS, (2 << 30, 2 << 30))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    done = subprocess.run([sys.executable, __file__, "--measure", path, switches], capture_output=True, text=True,
                          preexec_fn=limits, check=False)
    counts = [line.split()[1:] for line in done.stdout.splitlines() if line.startswith("counts ")]
    if done.returncode == 0 and counts:
        return tuple(map(int, counts[0]))
    return {-9: "no end", -24: "no end"}.get(done.returncode, "crash" if done.returncode < 0 else "failure")


def quality_runs(path, switches):
    runs = ["q20", "q33"]
    if path.endswith(".poly"):
        runs = ["pq20", "pq33"] + (["pq20aA"] if any(r[3] > 0 for r in pslg_facts.read(path).regions) else [])
    return [run + ("c" if "c" in switches else "") for run in runs]


def main(folder):
    rows = []
    with open(os.path.join(folder, "expected.txt"), encoding="ascii") as stream:
        expected = [line.split() for line in stream if not line.startswith("#")]
    for name, switches, _, triangles, used, _ in expected:
        if triangles == "-1":
            continue
        path = os.path.join(folder, name)
        plain = run(path, switches.strip("-"))
        right = plain == (int(used), int(triangles))
        if not right:
            print("%s %s: expected %s vertices, %s triangles; Triangle: %s" % (name, switches, used, triangles, plain))
        if triangles == "0":
            continue
        for quality in quality_runs(path, switches):
            made = run(path, quality) if right else "wrong or no result with " + switches
            text = "%d %d" % made if isinstance(made, tuple) else made
            rows.append("%s%s -%s %s" % ("" if isinstance(made, tuple) else "# ", name, quality, text))
    with open(os.path.join(folder, "yardstick.txt"), "w", encoding="ascii", newline="\n") as stream:
        stream.write(HEAD + "\n".join(rows) + "\n")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--measure"]:
        measure(*sys.argv[2:4])
    else:
        here = os.path.dirname(os.path.abspath(__file__))
        main(sys.argv[1] if len(sys.argv) > 1 else os.path.join(here, "..", "data"))
