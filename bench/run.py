#!/usr/bin/env python3
"""Runs parts of the benchmark; see Makefile.bench. Each part is a module part_<name> with run(settings), which
repeatedly yields its results so far: title, text (Markdown), rows (for results.csv) and targets. All results are kept,
so an interrupted run loses little. Exit code 1 if one of our meshes has a fault, or a program that exists fails."""
import importlib
import json
import sys
import time

import machine
import meshfiles
import report
import settings as options


def measure(settings, part):
    start, others, where = time.perf_counter(), machine.Others(), machine.describe(settings)
    for result in importlib.import_module("part_" + part).run(settings):
        disturbance = others.average()
        where["others"] = "unknown" if disturbance is None else f"{disturbance:.2f}"
        result["machine"] = where
        with meshfiles.whole_file(report.path_of(settings, part)) as file:
            json.dump(result, file, indent=1)
        report.write(settings)
    options.say(f"{part}: {time.perf_counter() - start:.0f} s")


def main():
    settings = options.from_arguments()
    for part in settings.parts:
        if part == "report":
            report.write(settings)
        else:
            measure(settings, part)
    if settings.failures:
        print("bench: failures:", *settings.failures, sep="\n  ")
    return 1 if settings.failures else 0


sys.exit(main())
