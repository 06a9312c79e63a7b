"""trianglecheck checks every mesh before its time is reported."""
import json
import os
import zlib
from dataclasses import dataclass

from cases import Failure, remove
from process import execute


@dataclass
class Verdict:
    faults: str       # empty: no fault
    vertices: int
    triangles: int
    subsegments: int
    smallest_angle: float
    total_area: float
    checksum: int     # of the files; 0: not checked
    seconds: float    # processor seconds of the checker

    @property
    def text(self):
        return self.faults or ("no fault" if self.checksum else "not judged")


def _checksum(base):
    """Checksum of a file without comments, since they contain the command."""
    value = 0
    for suffix in (".node", ".ele", ".poly"):
        if os.path.exists(base + suffix):
            with open(base + suffix, "rb") as file:
                while lines := file.readlines(1 << 22):
                    value = zlib.crc32(b"".join(line for line in lines if not line.startswith(b"#")), value)
    return value


def _command(case, base):
    domain, command = case.domain, [case.settings.program("trianglecheck"), base, "--json", "--no-markers", *case.check]
    if case.compare_input:
        command += ["--poly", domain.path]
    if "c" in domain.switches:
        command += ["--keep-hull"]
    if domain.path.endswith(".node") and not domain.angle:  # vertices inserted on the hull are rounded
        command += ["--convex"]
    if domain.angle and case.bounds_area:
        command += ["--min-angle", repr(domain.angle)]
    if domain.area and case.bounds_area:
        command += ["--max-area", repr(domain.area)]
    return command


def count(case):
    """Runs the case once, without files. Returns (Verdict, Run); raises Failure."""
    run = case.run()
    made = run.facts
    return Verdict("", made["vertices"], made["triangles"], made["subsegments"], 0.0, 0.0, 0, 0.0), run


def judge(case):
    """Runs the case once, with files. Returns (Verdict, Run); raises Failure."""
    scratch = os.path.join(case.settings.scratch, "judged")
    remove(scratch)  # files of a stopped run
    try:
        base, run = case.write(scratch)
        ended = execute(_command(case, base), 3600, case.settings.scratch)
        if ended.code not in (0, 1) or not ended.output:
            raise Failure("trianglecheck cannot read the mesh: " + ended.errors.strip())
        said = json.loads(ended.output)
        faults = "; ".join(f"{c['name']}: {c['count']}" for c in said["checks"] if c["state"] == "failed")
        return Verdict(faults, said["vertices"], said["triangles"], said["subsegments"], said["smallest_angle"] or 0.0,
                       said["total_area"] or 0.0, _checksum(base), ended.processor), run
    finally:
        remove(scratch)
