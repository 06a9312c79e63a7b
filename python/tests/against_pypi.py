"""ptriangle.compat beside the package `triangle` from PyPI: keys, types and shapes of results on all its examples.

Usage: against_pypi.py. Each call of the package runs in a process of its own, under a time limit, since it may crash.
"""
import json
import os
import subprocess
import sys

SWITCHES = ["", "p", "pq", "pq30", "pqa1", "pe", "pn", "pen", "pc", "pD", "pA", "pqAa", "pj", "pB", "pP", "pN",
            "pE", "po2", "pv", "e", "n", "o2", "c", "pY", "pqS5", "r", "rp", "rpq", "rpa", "rqen"]

KNOWN = {("la.1", None): "its reader takes five numbers of each region there"}

CASES = """
import json, os, sys
import numpy as np
import {module} as triangle
def form(data):
    return {{k: [v.dtype.str[1:], v.ndim, list(v.shape[1:])] for k, v in data.items()}}
directory = sys.argv[1]
def run(name, switches):
    data = triangle.load(directory, name)
    if switches is None:
        return {{k: [v.dtype.str[1:], list(v.shape), np.asarray(v, float).round(9).tolist()[:3]]
                for k, v in data.items()}}
    if ("p" in switches) != ("segments" in data) or ("r" in switches) != ("triangles" in data):
        return None
    return form(triangle.triangulate(data, switches))
for line in sys.stdin:
    name, switches = json.loads(line)
    try:
        found = run(name, switches)
    except Exception as fault:
        found = type(fault).__name__
    print(json.dumps([name, switches, found]), flush=True)
"""


def ask(module, directory, cases):
    """Returns the results of all cases. If a process dies, its current case is lost, and a new process continues."""
    found, cases = {}, list(cases)
    while cases:
        text = "".join(json.dumps(case) + "\n" for case in cases)
        try:
            done = subprocess.run([sys.executable, "-c", CASES.format(module=module), directory], input=text,
                                  capture_output=True, text=True, timeout=60).stdout
        except subprocess.TimeoutExpired as late:
            done = (late.stdout or b"").decode()
        lines = [json.loads(line) for line in done.splitlines() if line.startswith("[")]
        for name, switches, result in lines:
            found[name, switches] = result
        if len(lines) < len(cases):
            found[tuple(cases[len(lines)])] = "crash"
        cases = cases[len(lines) + 1:]
    return found


def main():
    import triangle
    directory = os.path.join(os.path.dirname(triangle.__file__), "data")
    names = sorted({name.rsplit(".", 1)[0] for name in os.listdir(directory) if ".v." not in name})
    cases = [(name, switches) for name in names for switches in [None] + SWITCHES]
    theirs = ask("triangle", directory, cases)
    ours = ask("ptriangle.compat", directory, cases)
    same = different = crashes = 0
    for case in cases:
        if theirs[case] == "crash" and ours[case] != "crash":
            crashes += 1
        elif theirs[case] == ours[case] or case in KNOWN:
            same += theirs[case] is not None
        else:
            different += 1
            print("%s, switches %s:\n  package: %s\n  compat:  %s" % (*case, theirs[case], ours[case]))
    print("against_pypi: %d data sets, %d results alike, %d not; %d crashes of the package" %
          (len(names), same, different, crashes))
    return different


if __name__ == "__main__":
    sys.exit(1 if main() else 0)
