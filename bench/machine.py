"""The machine, and whether it was idle. Linux reports most facts; on other systems they stay unknown."""
import os
import re
import resource
import subprocess
import time


def _output(*command, cwd=None):
    try:
        done = subprocess.run(command, cwd=cwd, capture_output=True, text=True, timeout=60)
        return done.stdout.strip() if done.returncode == 0 else "unknown"
    except (OSError, subprocess.TimeoutExpired):
        return "unknown"


def _lines(path):
    try:
        with open(path) as file:
            return file.read().splitlines()
    except OSError:
        return []


def _first(path, pattern, default="unknown"):
    for line in _lines(path):
        found = re.match(pattern, line)
        if found:
            return found.group(1).strip()
    return default


def commit(root):
    text = _output("git", "-C", root, "rev-parse", "--short=12", "HEAD")
    changed = _output("git", "-C", root, "status", "--porcelain", "--untracked-files=no")
    return text + (" with changes" if changed and text != "unknown" else "")


def _flags(programs):
    path = os.path.join(programs, "compile_commands.json")
    for line in _lines(path):
        if "triangle/refine/refine.c" in line and '"command"' in line:
            return " ".join(w for w in line.split() if re.match(r"-(O|std|f|m|g|DNDEBUG)", w))
    return "unknown"


def memory(field="MemAvailable"):
    """In bytes; 0 if unknown."""
    return 1024 * int(_first("/proc/meminfo", field + r":\s*(\d+)", "0"))


def cores():
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def describe(settings):
    cache = os.path.join(settings.programs, "CMakeCache.txt")
    compiler = _first(cache, r"CMAKE_C_COMPILER:[^=]*=(.*)")
    caches = [f"{'/'.join(_lines(os.path.join(d, 'size')))} level {'/'.join(_lines(os.path.join(d, 'level')))}"
              for d in sorted(f"/sys/devices/system/cpu/cpu0/cache/index{i}" for i in range(5)) if os.path.isdir(d)]
    return {
        "commit": commit(settings.root),
        "compiler": _output(compiler, "--version").splitlines()[0],
        "flags": _flags(settings.programs),
        "processor": _first("/proc/cpuinfo", r"model name\s*:(.*)"),
        "cores": cores(),
        "caches": ", ".join(caches) or "unknown",
        "memory": f"{memory('MemTotal') / 2**30:.0f} GiB",
        "system": " ".join((os.uname().sysname, os.uname().release)),
        "load": f"{os.getloadavg()[0]:.2f}",
    }


class Others:
    """Average number of cores that other processes kept busy since this object was made."""

    def __init__(self):
        self.start, self.busy, self.ours = time.perf_counter(), self._busy(), self._ours()

    @staticmethod
    def _busy():
        """Seconds of all cores that were neither idle nor waiting for input. Includes time used by the host."""
        stat = _lines("/proc/stat")
        if not stat:
            return None
        user, nice, system, _, _, irq, softirq, steal = map(int, stat[0].split()[1:9])
        return (user + nice + system + irq + softirq + steal) / os.sysconf("SC_CLK_TCK")

    @staticmethod
    def _ours():
        return sum(sum(resource.getrusage(who)[:2]) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))

    def average(self):
        if self.busy is None:
            return None
        seconds = time.perf_counter() - self.start
        return max(0.0, (self._busy() - self.busy - self._ours() + self.ours) / seconds)
