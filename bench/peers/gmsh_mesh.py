"""Meshes a plain .poly file with gmsh: gmsh_mesh.py INPUT SIZE ALGORITHM [BASE].

SIZE: edge length everywhere (gmsh bounds neither angles nor areas); edges of the input may make it shorter. Or
H,GROWTH: H at the segments, growing by GROWTH for a distance of 1, independent of the lengths of the input's edges.
ALGORITHM: Mesh.Algorithm, 5 Delaunay, 6 frontal-Delaunay. Prints the seconds for meshing curves and surface, after the
geometry is complete. BASE: writes the mesh there.
"""
import json
import os
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import gmsh  # noqa: E402
import meshfiles  # noqa: E402


def loops_of(segments):
    """Closed chains of segment numbers. Each vertex has two segments or none."""
    at = {}
    for i in range(len(segments) // 2):
        for v in segments[2 * i:2 * i + 2]:
            at.setdefault(v, []).append(i)
    unused, loops = set(range(len(segments) // 2)), []
    while unused:
        loop, i = [], min(unused)
        v = segments[2 * i]
        while i in unused:
            unused.remove(i)
            forward = segments[2 * i] == v
            loop.append((i + 1) if forward else -(i + 1))
            v = segments[2 * i + 1] if forward else segments[2 * i]
            i = next((j for j in at[v] if j in unused), i)
        loops.append(loop)
    return loops


def area_of(loop, pslg):
    total = 0.0
    for signed in loop:
        a, b = pslg.segments[2 * abs(signed) - 2:2 * abs(signed)]
        a, b = (a, b) if signed > 0 else (b, a)
        total += pslg.points[2 * a] * pslg.points[2 * b + 1] - pslg.points[2 * b] * pslg.points[2 * a + 1]
    return total / 2


def has_inside(loop, pslg, v):
    """Does the loop enclose the point?"""
    x, y = pslg.points[2 * v:2 * v + 2]
    inside = False
    for signed in loop:
        a, b = pslg.segments[2 * abs(signed) - 2:2 * abs(signed)]
        (ax, ay), (bx, by) = pslg.points[2 * a:2 * a + 2], pslg.points[2 * b:2 * b + 2]
        if (ay > y) != (by > y) and x < ax + (y - ay) / (by - ay) * (bx - ax):
            inside = not inside
    return inside


def build(pslg, size):
    """The outline is the loop with the largest area. Loops inside are holes, others further parts without holes. Free
    points are embedded."""
    geo = gmsh.model.geo
    for i in range(len(pslg.points) // 2):
        geo.addPoint(pslg.points[2 * i], pslg.points[2 * i + 1], 0, size, i + 1)
    for i in range(len(pslg.segments) // 2):
        geo.addLine(pslg.segments[2 * i] + 1, pslg.segments[2 * i + 1] + 1, i + 1)
    loops = sorted(loops_of(pslg.segments), key=lambda loop: -abs(area_of(loop, pslg)))
    first = [pslg.segments[2 * abs(loop[0]) - 2] for loop in loops]
    parts = [loop for loop, v in zip(loops, first) if loop is loops[0] or not has_inside(loops[0], pslg, v)]
    holes = [geo.addCurveLoop(loop) for loop in loops if loop not in parts]
    for loop in reversed(parts):  # triangles have the orientation of the outline
        outline = loop if area_of(loop, pslg) > 0 else [-i for i in reversed(loop)]
        surface = geo.addPlaneSurface([geo.addCurveLoop(outline), *(holes if loop is loops[0] else [])])
    geo.synchronize()
    free = sorted(set(range(len(pslg.points) // 2)) - set(pslg.segments))
    if free:
        gmsh.model.mesh.embed(0, [i + 1 for i in free], 2, surface)


def write(base):
    tags, xyz, _ = gmsh.model.mesh.getNodes()
    number, points = {int(t): i for i, t in enumerate(tags)}, []
    for i in range(len(tags)):
        points.extend(map(float, xyz[3 * i:3 * i + 2]))

    def corners(kind):
        return [number[int(t)] for t in gmsh.model.mesh.getElementsByType(kind)[1]]
    meshfiles.write_mesh(base, points, corners(2), corners(1))


def grow(pslg, size, growth):
    """Sets sizes by a field alone, of distances from points on all lines, spaced as finely as `size` requires."""
    field, p, s = gmsh.model.mesh.field, pslg.points, pslg.segments
    longest = max((abs(p[2 * a] - p[2 * b]) + abs(p[2 * a + 1] - p[2 * b + 1]) for a, b in zip(s[::2], s[1::2])))
    field.add("Distance", 1)
    field.setNumbers(1, "CurvesList", list(range(1, len(s) // 2 + 1)))
    field.setNumber(1, "Sampling", min(200, max(3, int(longest / size))))
    field.add("MathEval", 2)
    field.setString(2, "F", f"{size!r}+{growth!r}*F1")
    field.setAsBackgroundMesh(2)
    for name in ("ExtendFromBoundary", "FromPoints", "FromCurvature"):
        gmsh.option.setNumber("Mesh.MeshSize" + name, 0)


def main():
    path, size, algorithm = sys.argv[1:4]
    size, growth = map(float, (size + ",nan").split(",")[:2])
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    gmsh.option.setNumber("Mesh.Algorithm", int(algorithm))
    pslg = meshfiles.read(path)
    build(pslg, size)
    if growth >= 0:
        grow(pslg, size, growth)
    start = time.perf_counter()
    gmsh.model.mesh.generate(2)
    print(json.dumps({"seconds": time.perf_counter() - start}), flush=True)
    if len(sys.argv) > 4:
        write(sys.argv[4])
    gmsh.finalize()


main()
