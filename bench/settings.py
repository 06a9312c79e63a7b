"""Settings of one run of the benchmark, and the locations of files."""
import argparse
import os
from dataclasses import dataclass, field

import machine

PARTS = ("table1", "table2", "stages", "peers", "scaling", "calls", "worst", "sizes", "large")


@dataclass
class Settings:
    programs: str  # build folder of our programs
    work: str      # scratch, inputs, peers, measurements
    shared: str    # further inputs; need not exist
    repeats: int
    threads: int   # largest number of threads
    small: bool
    parts: list
    failures: list = field(default_factory=list)  # unexpected failures

    @property
    def root(self):
        return os.path.dirname(os.path.dirname(os.path.abspath(__file__)))

    @property
    def measurements(self):
        return os.path.join(self.work, "small" if self.small else "full")

    @property
    def results(self):
        """Folder of results.csv and results.md. Small runs have a folder of their own, since their results mean
        little."""
        return self.measurements if self.small else os.path.join(self.root, "bench")

    @property
    def scratch(self):
        return os.path.join(self.work, "scratch")

    def program(self, name):
        return os.path.join(self.programs, "bin", name)

    def bound(self, area):
        """The area bound of a full run. For a small run, a bound that gives a hundredth of the triangles."""
        return float(f"{area * 100:.12g}") if self.small else area

    def thread_counts(self):
        """1, 2, 4 and so on, and the largest number."""
        return sorted({1 << k for k in range(10) if 1 << k < self.threads} | {self.threads})

    def fail(self, what):
        self.failures.append(what)


def say(text):
    print("bench: " + text, flush=True)


def from_arguments():
    parser = argparse.ArgumentParser(description="Measures; see Makefile.bench.")
    parser.add_argument("--programs", required=True)
    parser.add_argument("--work", required=True)
    parser.add_argument("--shared", required=True)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--threads", type=int, default=machine.cores())
    parser.add_argument("--small", action="store_true")
    parser.add_argument("parts", nargs="+", choices=(*PARTS, "report"))
    a = parser.parse_args()
    settings = Settings(*map(os.path.abspath, (a.programs, a.work, a.shared)), a.repeats, a.threads, a.small, a.parts)
    for folder in (settings.measurements, settings.scratch, os.path.join(settings.work, "inputs")):
        os.makedirs(folder, exist_ok=True)
    return settings
