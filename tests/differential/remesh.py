"""Meshes as input for -r, made from our plain meshes with other attributes and area bounds.

Each part of the mesh between constrained edges has its own attribute and area bound, so that the values that new
triangles must inherit are determined.
"""
from cases import Case, table

# First without refinement, so that everything is determined, then with it.
PLAIN = ("r", "rp", "renv", "rpenvc", "rc", "rpB", "rpo2e", "rpj", "rpV", "rpA", "rpqS0", "rpO", "rpi", "re", "rpcC")
REFINED = ("rpq", "rq", "rpaen", "rpqa", "ra", "rpqYYe", "rpq30a{area}", "rpqD")


class MeshCase(Case):
    """The files case.node, .ele, .poly and .area. Elements are passed to -r unchanged, including their orientation."""

    def __init__(self, name, plain, mesh):
        Case.__init__(self, name, plain.base, plain.traits - {"points", "duplicates"})
        self.points, self.attributes, self.markers = mesh.points, mesh.attributes or [], mesh.markers
        self.segments, self.segment_markers = mesh.segments or [], mesh.segment_markers or []
        self.holes, self.regions = [tuple(h) for h in plain.holes], []
        self.triangles = [tuple(t) for t in mesh.triangles]
        self.mesh, part = mesh, parts(mesh)
        self.triangle_attributes = [(p + 0.5, -p) for p in part]
        self.areas = [(0.0, -1.0, 0.3, 0.11)[p % 4] for p in part]

    def files(self):
        rows = [[v + self.base for v in t] + list(a) for t, a in zip(self.triangles, self.triangle_attributes)]
        return {"node": self.vertices(), "poly": "0 2 0 0\n" + self.figure(),
                "ele": table([len(rows), len(self.triangles[0]), 2], rows, self.base),
                "area": table([len(rows)], [[a] for a in self.areas], self.base)}

    def word(self):
        return "case"

    def judge(self, switches):
        """Without p the segments are not read, and the edges that they forced into the mesh are not Delaunay."""
        return ["--refined", "--poly"] + (["case.poly"] if "p" in switches else ["case.node", "--no-delaunay"])

    def as_dict(self):
        return {**Case.as_dict(self), "triangles": self.triangles, "triangle_attributes": self.triangle_attributes,
                "areas": [[a] for a in self.areas]}


def parts(mesh):
    """For each triangle, the number of its part between constrained edges."""
    fixed = {tuple(sorted(s)) for s in mesh.segments or ()}
    beside, part, n_parts = mesh.sides(), [None] * len(mesh.triangles), 0
    for seed in range(len(part)):
        stack = [seed] if part[seed] is None else []
        n_parts += len(stack)
        while stack:
            t = stack.pop()
            if part[t] is None:
                part[t] = n_parts - 1
                corners = mesh.corners()[t]
                sides = [tuple(sorted((corners[k], corners[k - 1]))) for k in range(3)]
                stack += [u for side in sides if side not in fixed for u in beside[side]]
    return part
