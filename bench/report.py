"""Writes results.csv and results.md from the results of the parts, each from its last run."""
import csv
import json
import os

from measure import table
from meshfiles import whole_file
from settings import PARTS

COLUMNS = ("part", "input", "switches", "program", "threads", "stage", "runs", "median_seconds", "min_seconds",
           "max_seconds", "triangles", "vertices", "smallest_angle", "peak_bytes", "judged", "commit", "compiler",
           "processor", "cores", "load", "others")
NOTE = """\
Made by `make -f Makefile.bench`. trianglecheck checked every mesh before its time was measured. `others`: average
number of cores kept busy by other work; above 0.1 the times are distorted. M/s: million triangles per second.
"""
SMALL = "A hundredth of the size, to test that all parts work: THE TIMES ARE MEANINGLESS.\n"


def path_of(settings, part):
    return os.path.join(settings.measurements, part + ".json")


def _load(settings):
    found = {}
    for part in PARTS:
        if os.path.exists(path_of(settings, part)):
            with open(path_of(settings, part)) as file:
                found[part] = json.load(file)
    return found


def _write_csv(path, parts):
    with whole_file(path) as file:
        writer = csv.DictWriter(file, COLUMNS, extrasaction="ignore", lineterminator="\n")
        writer.writeheader()
        for part in parts.values():
            writer.writerows({**part["machine"], **row} for row in part["rows"])


def _machine_table(parts):
    """Facts that differ between the parts are listed for each part. Parts of an earlier version may lack some."""
    lines = []
    for key in dict.fromkeys(key for part in parts.values() for key in part["machine"]):
        values = {name: str(part["machine"].get(key, "unknown")) for name, part in parts.items()}
        same = len(set(values.values())) == 1
        lines.append((key, next(iter(values.values())) if same else ", ".join(f"{v} ({n})" for n, v in values.items())))
    return table(("", ""), lines)


def _bound(target):
    return f"at least {target['least']:g}" if "least" in target else f"at most {target['most']:g}"


def _reached(target):
    reached = target["reached"]
    if reached is None:
        return "missing", ""
    good = reached >= target["least"] if "least" in target else reached <= target["most"]
    return f"{reached:.3g}", "yes" if good else "NO"


def _targets(parts):
    lines = []
    for part in parts.values():
        for t in part["targets"]:
            lines.append((t["asked"], _bound(t), *_reached(t)))
    return table(("target", "required", "reached", ""), lines)


def write(settings):
    parts = _load(settings)
    if not parts:
        return
    missing = [name for name in PARTS if name not in parts]
    text = ["# Measurements\n", NOTE, *([SMALL] if settings.small else []), _machine_table(parts)]
    text += [f"Not measured: {', '.join(missing)}.\n"] if missing else []
    text += [f"## {part['title']}\n\n{part['text']}" for part in parts.values()]
    text += ["## Targets\n", "Time of Triangle 1.6 divided by ours, unless a target says otherwise.\n", _targets(parts)]
    _write_csv(os.path.join(settings.results, "results.csv"), parts)
    with whole_file(os.path.join(settings.results, "results.md")) as file:
        file.write("\n".join(text))
