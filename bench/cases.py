"""Cases: a program on a domain. Each case can run in memory, without writing a file, and can write its mesh for the
checker. Both runs make the same mesh, which is verified by the numbers that the run prints.

Wall seconds of a run, by stage:

  delaunay  points and segments in memory to the (constrained) Delaunay triangulation without outside and holes
  quality   from there to the refined mesh
  number    renumbering along a curve, if the program does that
  memory    the sum of these three
  process   the whole process, including reading and, if the case says so, writing files
  processor its processor time

and further stages that a program reports.
"""
import glob
import json
import os
import re
import sys

from process import execute

LIMIT = 900  # seconds


class Failure(Exception):
    """A run without a result; `timed_out`: because of the time limit."""

    def __init__(self, text, timed_out=False):
        super().__init__(text)
        self.timed_out = timed_out


class Run:
    def __init__(self, seconds, ended, identity, facts=None):
        self.seconds = seconds    # stage: seconds
        self.peak = ended.peak
        self.identity = identity  # numbers that the program prints about its mesh; None: none
        self.facts = facts or {}


class Case:
    """ours: a failure or fault counts against our programs. check: options of trianglecheck besides bounds and input.
    judged: by trianglecheck; otherwise only the number of triangles that the program prints is used."""
    ours, threads, check, limit, judged = True, 1, (), LIMIT, True
    compare_input, bounds_area = True, True

    def __init__(self, settings, domain):
        self.settings, self.domain = settings, domain

    def run(self):
        """One timed run."""
        raise NotImplementedError

    def write(self, base):
        """Writes the mesh and returns (base name of its files, Run)."""
        raise NotImplementedError

    def execute(self, *command):
        ended = execute(command, self.limit, self.settings.scratch)
        if ended.timed_out:
            raise Failure(f"not finished in {self.limit:g} s", True)
        if ended.code:
            lines = (ended.errors.strip() or ended.output.strip()).splitlines()
            raise Failure(f"exit code {ended.code}: {lines[-1][:200] if lines else ''}")
        return ended

    @property
    def missing(self):
        """Reason why the case cannot run here, or None."""
        return None


class Ours(Case):
    """ptriangle. `switches`: besides those of the domain; with `r`, a mesh lies beside its .poly file."""

    def __init__(self, settings, domain, threads, switches="", files="", options=()):
        """files: "" for none, "text", or "HDF5"."""
        super().__init__(settings, domain)
        self.threads, self.switches, self.files, self.options = threads, switches, files, options
        words = ["ours", f"{threads} thread{'s' if threads > 1 else ''}"]
        if files:
            words.append(f"with {files} files")
        if options:
            words.append(" ".join(options))
        self.name = ", ".join(words)
        if "r" in switches:
            self.check = ("--refined",)

    def _execute(self, *extra):
        return self.execute(self.settings.program("ptriangle"), "--threads", str(self.threads), *self.options, *extra,
                            "-Q" + self.switches + self.domain.switches, self.domain.path)

    def _call(self, *extra):
        report = os.path.join(self.settings.scratch, "report.json")
        ended = self._execute("--report", report, *extra)
        with open(report) as file:
            facts = json.load(file)
        s = facts["seconds"]
        seconds = {k: s[k] for k in s if k != "total"}
        seconds["delaunay"] = s["delaunay"] + s["segments"] + s["holes"]  # with -r: reconstruction
        seconds["memory"] = seconds["delaunay"] + s["quality"] + s["number"]
        seconds["process"] = ended.wall
        return Run(seconds, ended, json.dumps(facts["mesh"]), facts)

    def run(self):
        """With files: the stages come from one run, and the process time from another without a report."""
        if not self.files:
            return self._call("-NEP")
        base = os.path.join(self.settings.scratch, "timed")
        output = base + (".h5" if self.files == "HDF5" else "")
        run = self._call("--output", output)
        remove(base)
        run.seconds["process"] = self._execute("--output", output).wall
        remove(base)
        return run

    def write(self, base):
        return base, self._call("--output", base)


class Sequential(Case):
    """Our `triangle`, which uses one thread. It prints milliseconds."""
    name = "ours, sequential"

    def _call(self, path, extra=()):
        ended = self.execute(self.settings.program("triangle"), *extra, "-" + self.domain.switches, path)

        def milliseconds(*names):
            found = [re.search(rf"^{n} milliseconds: +(\d+)", ended.output, re.M) for n in names]
            return sum(int(f.group(1)) for f in found if f) / 1000
        seconds = {"delaunay": milliseconds("Delaunay", "Segment", "Hole"), "quality": milliseconds("Quality"),
                   "process": ended.wall, "processor": ended.processor}
        seconds["memory"] = seconds["delaunay"] + seconds["quality"]
        return Run(seconds, ended, str(re.findall(r"^  Mesh \S+:.*", ended.output, re.M)))

    def run(self):
        return self._call(self.domain.path, ("-NEP",))

    def write(self, base):
        suffix = os.path.splitext(self.domain.path)[1]
        for end in (".poly", ".node", ".ele") if suffix == ".poly" else (suffix,):
            source = self.domain.path[:-len(suffix)] + end
            if os.path.exists(source):
                os.symlink(source, base + end)
        return base + ".1", self._call(base + suffix)


class Triangle(Case):
    """Triangle 1.6 from PyPI; only its library function is timed. It makes triangulation and mesh in one call. So
    `delaunay` is the time of a call without bounds, and `quality` the difference. Timed calls request no output (N, E,
    P), so the time excludes filling its arrays."""
    ours, name = False, "Triangle 1.6"

    def __init__(self, settings, domain, switches="", judged=True):
        super().__init__(settings, domain)
        self.switches, self.judged = switches, judged
        if "r" in switches:
            self.check = ("--refined",)

    @property
    def library(self):
        packages = os.path.join(self.settings.work, "python", "lib", "python*", "site-packages")
        found = glob.glob(os.path.join(packages, "triangle", "core*.so"))
        return found[0] if found else ""

    @property
    def missing(self):
        return None if self.library else "the PyPI package triangle is not installed"

    def _call(self, switches, *base):
        ended = self.execute(python(self.settings), peer("triangle_call.py"), self.library, self.domain.path,
                             self.switches + switches, *base)
        said = json.loads(ended.output)
        return said["seconds"], said["counts"], ended

    def run(self):
        first, counts, ended = self._call(self.domain.plain_switches + "NEP")
        seconds = {"delaunay": first, "memory": first}
        if self.domain.angle:
            seconds["memory"], counts, ended = self._call(self.domain.switches + "NEP")
            seconds["quality"] = seconds["memory"] - first
        vertices, triangles, subsegments = counts
        return Run(seconds, ended, str(counts), {"vertices": vertices, "triangles": triangles,
                                                 "subsegments": subsegments})

    def write(self, base):
        seconds, counts, ended = self._call(self.domain.switches, base)
        return base, Run({"memory": seconds}, ended, str(counts))


class Peer(Case):
    """A program of bench/peers that is called with INPUT and bounds. It prints {"seconds": from input in memory to mesh
    in memory}, and writes the mesh if a base name follows."""
    ours, compare_input = False, False

    def command(self):
        raise NotImplementedError

    def _call(self, *base):
        ended = self.execute(*self.command(), *base)
        return Run({"memory": json.loads(ended.output.splitlines()[-1])["seconds"]}, ended, None)

    def run(self):
        return self._call()

    def write(self, base):
        return base, self._call(base)


class Cgal(Peer):
    name = "CGAL"

    @property
    def _program(self):
        return os.path.join(self.settings.work, "cgal_mesh")

    @property
    def missing(self):
        return None if os.path.exists(self._program) else "the CGAL headers are not installed (libcgal-dev)"

    def command(self):
        return self._program, self.domain.path, f"{self.domain.angle:g}", repr(self.domain.area)


class Spade(Cgal):
    name = "spade"

    @property
    def _program(self):
        return os.path.join(self.settings.work, "spade", "release", "spade_mesh")

    @property
    def missing(self):
        return None if os.path.exists(self._program) else "cargo is not installed, or cannot build spade"


class Gmsh(Peer):
    """gmsh has no bounds. It gets the edge length of equilateral triangles whose area is 0.66 of the bound, our mean
    area. Its meshes are not Delaunay after its own smoothing."""
    check, bounds_area = ("--no-delaunay",), False

    def __init__(self, settings, domain, algorithm, name):
        super().__init__(settings, domain)
        self.algorithm, self.name = algorithm, name

    @property
    def missing(self):
        installed = glob.glob(os.path.join(self.settings.work, "python", "gmsh-*"))
        return None if installed else "the PyPI package gmsh is not installed, or does not run"

    def command(self):
        size = (0.66 * self.domain.area * 4 / 3 ** 0.5) ** 0.5
        return python(self.settings), peer("gmsh_mesh.py"), self.domain.path, repr(size), str(self.algorithm)


def python(settings):
    """The Python for which the packages were installed."""
    own = os.path.join(settings.work, "python", "bin", "python")
    return own if os.path.exists(own) else sys.executable


def peer(name):
    return os.path.join(os.path.dirname(os.path.abspath(__file__)), "peers", name)


def remove(base):
    """Removes a mesh and the files linked beside it."""
    for path in glob.glob(glob.escape(base) + ".*"):
        os.remove(path)
