"""Cases are checked first. Then all of them run in turns, so that disturbances affect all cases equally."""
import statistics
from dataclasses import dataclass

from cases import Failure
from judge import count, judge
from settings import say


@dataclass
class Times:
    median: float
    least: float
    most: float
    n: int

    def text(self):
        spread = f" ({seconds_text(self.least)}–{seconds_text(self.most)})" if self.n > 1 else ""
        return seconds_text(self.median) + spread


def seconds_text(x):
    """Three digits, fewer below ten milliseconds, where clocks and caches dominate."""
    return f"{x:.1f}" if x >= 100 else f"{x:.2f}" if x >= 10 else f"{x:.3f}"


class Measured:
    def __init__(self, case):
        self.case, self.verdict, self.runs, self.reason = case, None, [], case.missing

    @property
    def good(self):
        return bool(self.runs)

    def _attempt(self, what, action):
        case = self.case
        try:
            return action()
        except Failure as failure:
            self.reason, self.runs = str(failure), []
            if case.ours or not failure.timed_out:
                case.settings.fail(f"{what} {case.name}, {case.domain.name} -{case.domain.switches}: {failure}")
            return None

    def judge(self):
        if self.reason:
            return
        judged = self._attempt("judging", lambda: judge(self.case) if self.case.judged else count(self.case))
        if judged:
            self.verdict, self.first = judged
            if not self.case.judged:
                self.runs.append(self.first)
            say(f"  {self.case.name}: {self.verdict.triangles:,} triangles, {self.verdict.text}")
            if self.verdict.faults and self.case.ours:
                self.reason = "faults: " + self.verdict.faults
                self.case.settings.fail(f"{self.case.name}, {self.case.domain.name}: {self.verdict.faults}")

    def sample(self):
        if self.reason:
            return
        run = self._attempt("timing", self.case.run)
        if run and run.identity != self.first.identity:
            self.reason, self.runs = "another mesh than the one judged", []
            self.case.settings.fail(f"{self.case.name}, {self.case.domain.name}: {self.reason}")
        elif run:
            self.runs.append(run)

    def times(self, stage):
        """Median seconds of a stage, or None if no run has them."""
        values = [r.seconds[stage] for r in self.runs if stage in r.seconds]
        return Times(statistics.median(values), min(values), max(values), len(values)) if values else None

    def median(self, stage):
        times = self.times(stage)
        return times.median if times else None

    def text(self, stage):
        times = self.times(stage)
        return times.text() if times else "missing" if self.reason else "–"

    @property
    def peak(self):
        return max(r.peak for r in self.runs)

    def typical(self, stage="memory"):
        """The run whose time is the median, or the next larger one."""
        return sorted(self.runs, key=lambda r: r.seconds[stage])[len(self.runs) // 2]

    def rows(self, part):
        """Rows for results.csv."""
        d, v = self.case.domain, self.verdict
        head = {"part": part, "input": d.name, "switches": getattr(self.case, "switches", "") + d.switches,
                "program": self.case.name, "threads": self.case.threads}
        if not self.good:
            return [head | {"judged": self.reason}]
        tail = {"vertices": v.vertices, "triangles": v.triangles, "smallest_angle": v.smallest_angle,
                "peak_bytes": self.peak, "judged": v.text}
        stages = [s for s in self.runs[0].seconds if self.median(s) is not None]
        times = {s: self.times(s) for s in stages}
        return [head | {"stage": s, "runs": t.n, "median_seconds": t.median, "min_seconds": t.least,
                        "max_seconds": t.most} | tail for s, t in times.items()]


def measure(title, cases, settings, repeats=None):
    """Measures the cases. Returns a list of Measured in the order of the cases."""
    say(title)
    measured = [Measured(case) for case in cases]
    for m in measured:
        m.judge()
    repeats = repeats or settings.repeats
    for _ in range(repeats):
        for m in measured:
            if len(m.runs) < repeats:
                m.sample()
    for m in measured:
        if m.reason:
            say(f"  without {m.case.name}: {m.reason}")
    return measured


def ratio(above, below, digits=1):
    return f"{above / below:.{digits}f}" if above is not None and below else "–"


def millions_per_second(triangles, seconds):
    return f"{triangles / seconds / 1e6:.2f}" if seconds else "–"


def table(head, rows):
    """A Markdown table."""
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows]) + "\n"
