"""Reads STEM.vtu, .msh, .2dm, .14 and .h5 with readers of other projects, and compares them with STEM.node, .ele,
.poly.

Usage: formats.py STEM ORDER      ORDER is 1 or 2 (with -o2 there is no .14 and no .h5)

The files count from 1. Vertices and triangles have one attribute each."""
import os
import sys

import meshio
import numpy as np

stem, order = sys.argv[1], int(sys.argv[2])


def table(name, skip=0):
    lines = [line.split("#")[0].split() for line in open(name)]
    return [line for line in lines if line][skip:]


node = table(stem + ".node")
points = np.array([[float(x) for x in row[1:3]] for row in node[1:]])
attributes = np.array([float(row[3]) for row in node[1:]])
markers = np.array([int(row[4]) for row in node[1:]])
ele = table(stem + ".ele")
triangles = np.array([[int(x) - 1 for x in row[1:4]] for row in ele[1:]])
regions = np.array([float(row[-1]) for row in ele[1:]])
poly = table(stem + ".poly")
segments = np.array([[int(x) for x in row[1:4]] for row in poly[2:2 + int(poly[1][0])]])
segments[:, :2] -= 1
assert len(triangles) > 100 and len(set(regions)) > 1 and len(set(segments[:, 2])) > 1


def same(what, a, b):
    assert np.array_equal(np.asarray(a), np.asarray(b)), what


def middles_lie_amid(nodes, at):
    """Second-order nodes, in the order of the edges from corner to corner."""
    for k in range(3):
        middle = (at[nodes[:, k]] + at[nodes[:, (k + 1) % 3]]) / 2
        assert np.allclose(at[nodes[:, 3 + k]], middle, atol=1e-9), "middle nodes"


def by_meshio(name, attribute):
    mesh = meshio.read(name)
    kind = "triangle" if order == 1 else "triangle6"
    cells = {block.type: [] for block in mesh.cells}
    for i, block in enumerate(mesh.cells):
        cells[block.type].append((block.data, {k: v[i] for k, v in mesh.cell_data.items()}))
    same("points", mesh.points[:, :2], points)
    same("markers", np.ravel(mesh.point_data["marker"]), markers)
    same("attributes", np.ravel(mesh.point_data[attribute]), attributes)
    corner = np.vstack([data for data, _ in cells[kind]])
    region = np.concatenate([np.ravel(values[attribute]) for _, values in cells[kind]])
    line = np.vstack([data for data, _ in cells["line"]])
    marker = np.concatenate([np.ravel(values["marker"]) for _, values in cells["line"]])
    if order == 2:
        middles_lie_amid(corner, mesh.points[:, :2])
    found = sorted(map(tuple, np.column_stack([corner[:, :3], region]).tolist()))
    same("triangles", found, sorted(map(tuple, np.column_stack([triangles, regions]).tolist())))
    found = sorted(map(tuple, np.column_stack([line, marker]).astype(int).tolist()))
    same("segments", found, sorted(map(tuple, segments.tolist())))
    return mesh


def names_by_meshio(mesh):
    """Groups by name, from which scikit-fem finds boundaries. Names have no blanks, since meshio's writer of .vtk
    refuses blanks."""
    for kind, dim, values in (("marker", 1, segments[:, 2]), ("region", 2, regions)):
        for value in set(values):
            name = "%s_%.17g" % (kind, value)
            assert mesh.field_data[name][1] == dim
            n = sum(len(rows) for rows in mesh.cell_sets[name] if rows is not None)
            assert n == sum(values == value), name
    meshio.write("names.vtk", mesh)
    os.remove("names.vtk")


def by_vtk():
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
    from vtkmodules.util.numpy_support import vtk_to_numpy
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(stem + ".vtu")
    reader.Update()
    grid = reader.GetOutput()
    same("points", vtk_to_numpy(grid.GetPoints().GetData())[:, :2], points)
    assert grid.GetNumberOfCells() == len(triangles) + len(segments)
    same("first", [grid.GetCell(0).GetPointId(k) for k in range(3)], triangles[0])
    same("last", [grid.GetCell(grid.GetNumberOfCells() - 1).GetPointId(k) for k in range(2)], segments[-1][:2])
    same("regions", vtk_to_numpy(grid.GetCellData().GetArray("attributes"))[:len(triangles)], regions)


def by_gmsh():
    try:
        import gmsh
    except OSError as lacking:  # its library needs graphics libraries
        print("formats: Gmsh cannot be loaded here:", lacking)
        return
    gmsh.initialize(["gmsh", "-v", "0"])
    gmsh.open(stem + ".msh")
    tags, at, _ = gmsh.model.mesh.getNodes()
    same("points", at.reshape(-1, 3)[np.argsort(tags), :2], points)
    groups = gmsh.model.getPhysicalGroups()
    assert set(r for r in regions if r >= 1) <= set(tag for dim, tag in groups if dim == 2)
    assert set(m for m in segments[:, 2] if m > 0) <= set(tag for dim, tag in groups if dim == 1)
    for dim, tag in groups:
        if tag not in (regions if dim == 2 else segments[:, 2]):
            continue
        n = sum(len(gmsh.model.mesh.getElements(dim, entity)[1][0])
                for entity in gmsh.model.getEntitiesForPhysicalGroup(dim, tag))
        assert n == (sum(regions == tag) if dim == 2 else sum(segments[:, 2] == tag)), (dim, tag)
    gmsh.finalize()


def elements_of(gmsh):
    """{tag: physical tags, parts, nodes}"""
    found = {}
    for dim, entity in gmsh.model.getEntities():
        physical = tuple(gmsh.model.getPhysicalGroupsForEntity(dim, entity).tolist())
        parts = tuple(gmsh.model.getPartitions(dim, entity).tolist())
        for _, tags, nodes in zip(*gmsh.model.mesh.getElements(dim, entity)):
            for tag, ends in zip(tags.tolist(), nodes.reshape(len(tags), -1).tolist()):
                assert tag not in found
                found[tag] = physical, parts, ends
    return found


def nodes_of(gmsh):
    tags, at, _ = gmsh.model.mesh.getNodes()
    return {tag: tuple(x) for tag, x in zip(tags.tolist(), at.reshape(-1, 3).tolist())}


def parts_by_gmsh(n):
    """Each part, and all of them together: the elements and nodes of the whole file, with the same tags."""
    try:
        import gmsh
    except OSError:
        return
    gmsh.initialize(["gmsh", "-v", "0"])
    gmsh.open(stem + ".msh")
    nodes, elements = nodes_of(gmsh), elements_of(gmsh)
    names = [f"{stem}{n}_{part + 1}.msh" for part in range(n)]
    seen, users = {}, {}
    for part, name in enumerate(names):
        gmsh.logger.start()
        gmsh.open(name)
        assert not [line for line in gmsh.logger.get() if line.startswith(("Warning", "Error"))], name
        gmsh.logger.stop()
        assert gmsh.model.getNumberOfPartitions() == n
        own, at = elements_of(gmsh), nodes_of(gmsh)
        assert not seen.keys() & own.keys() and all(parts == (part + 1,) for _, parts, _ in own.values())
        assert set(at) == {node for _, _, ends in own.values() for node in ends}
        assert all(nodes[node] == x for node, x in at.items())
        seen.update(own)
        for dim, entity in gmsh.model.getEntities():
            for node in gmsh.model.mesh.getNodes(dim, entity)[0].tolist():
                users.setdefault(node, []).append((part + 1, tuple(gmsh.model.getPartitions(dim, entity).tolist())))
    assert {t: (p, e) for t, (p, _, e) in seen.items()} == {t: (p, e) for t, (p, _, e) in elements.items()}
    assert set(users) == set(nodes)
    for told in users.values():  # each part lists the parts that share a node
        assert all(parts == tuple(part for part, _ in told) for _, parts in told)
    gmsh.clear()
    for name in names:
        gmsh.merge(name)
    assert nodes_of(gmsh) == nodes and elements_of(gmsh).keys() == elements.keys()
    gmsh.finalize()


def boundary():
    """Edges of one triangle, with the triangle on their left."""
    edges = [tuple(t[[k, (k + 1) % 3]]) for t in triangles for k in range(3)]
    all_of_them = set(edges)
    return sorted((int(a), int(b)) for a, b in edges if (b, a) not in all_of_them)


def by_py2dm():
    import py2dm
    with py2dm.Reader(stem + ".2dm") as mesh:
        same("points", [n.pos for n in mesh.iter_nodes()], np.column_stack([points, attributes]))
        elements = list(mesh.iter_elements())
        corner = np.array([e.nodes for e in elements]) - 1
        if order == 2:
            middles_lie_amid(corner[:, [0, 2, 4, 1, 3, 5]], points)
            corner = corner[:, [0, 2, 4]]
        same("triangles", corner, triangles)
        same("materials", [e.materials[0] for e in elements], np.where(regions >= 1, regions, 1))
        edges = []
        for string in mesh.iter_node_strings():
            edges += [(a - 1, b - 1) for a, b in zip(string.nodes, string.nodes[1:])]
    same("boundary", sorted(edges), boundary())


def by_words():
    """fort.14, parsed like ADCIRC: numbers at the beginning of each line."""
    lines = [line.split() for line in open(stem + ".14")][1:]
    n, m = int(lines[0][0]), int(lines[0][1])
    same("points", [[float(x) for x in row[1:4]] for row in lines[1:1 + m]], np.column_stack([points, attributes]))
    same("triangles", [[int(x) - 1 for x in row[2:5]] for row in lines[1 + m:1 + m + n]], triangles)
    rest = [int(line[0]) if len(line) < 2 or line[1] == "=" else [int(x) for x in line] for line in lines[1 + m + n:]]
    marker = {frozenset(s[:2].tolist()): s[2] for s in segments}
    edges = []
    for open_ones in (True, False):
        pieces, total = rest[:2]
        del rest[:2]
        for _ in range(pieces):
            length, kind = rest[0]
            nodes = [x - 1 for x in rest[1:1 + length]]
            del rest[:1 + length]
            total -= length
            if kind == 1 and not open_ones:
                nodes.append(nodes[0])
            edges += list(zip(nodes, nodes[1:]))
            for a, b in zip(nodes, nodes[1:]):
                assert kind == 1 or (marker[frozenset((a, b))] == 2) == open_ones, "open boundary"
        assert total == 0
    same("boundary", sorted(edges), boundary())
    assert not rest


def by_h5py():
    import h5py
    with h5py.File(stem + ".h5") as f:
        same("points", f["points"], points)
        same("attributes", np.ravel(f["point_attributes"]), attributes)
        same("markers", f["point_markers"], markers)
        same("triangles", f["triangles"], triangles)
        same("regions", np.ravel(f["triangle_attributes"]), regions)
        same("segments", np.column_stack([f["segments"], f["segment_markers"]]), segments)
        same("counts", [f["about"].attrs[k] for k in ("points", "triangles", "segments")],
             [len(points), len(triangles), len(segments)])
        same("bounds", f["about"].attrs["bounds"], [*points.min(0), *points.max(0)])


def by_xdmf():
    mesh = meshio.read(stem + ".xdmf")
    same("points", mesh.points[:, :2], points)
    same("triangles", mesh.get_cells_type("triangle"), triangles)
    same("regions", np.ravel(mesh.get_cell_data("attributes", "triangle")), regions)
    same("markers", mesh.point_data["marker"], markers)


def by_vtkhdf():
    from vtkmodules.vtkIOHDF import vtkHDFReader
    from vtkmodules.util.numpy_support import vtk_to_numpy
    reader = vtkHDFReader()
    reader.SetFileName(stem + ".h5")
    reader.Update()
    grid = reader.GetOutputDataObject(0)
    at = vtk_to_numpy(grid.GetPoints().GetData())
    same("points", at[:, :2], points)
    same("z", at[:, 2], 0 * at[:, 2])
    n = len(triangles)
    assert grid.GetNumberOfCells() == n + len(segments)
    same("corners", vtk_to_numpy(grid.GetCells().GetConnectivityArray()),
         np.concatenate([triangles.ravel(), segments[:, :2].ravel()]))
    kinds = [grid.GetCellType(i) for i in range(grid.GetNumberOfCells())]
    same("kinds", kinds, [5] * n + [3] * len(segments))
    same("regions", vtk_to_numpy(grid.GetCellData().GetArray("attributes")).ravel()[:n], regions)
    same("marker", vtk_to_numpy(grid.GetCellData().GetArray("marker")), [0] * n + segments[:, 2].tolist())
    same("markers", vtk_to_numpy(grid.GetPointData().GetArray("marker")), markers)


by_meshio(stem + ".vtu", "attributes")
names_by_meshio(by_meshio(stem + ".msh", "attribute_0"))
by_vtk()
by_gmsh()
for n in (1, 3, 40) if order == 1 else (3,):
    parts_by_gmsh(n)
by_py2dm()
if order == 1:
    by_words()
if os.path.exists(stem + ".h5"):
    by_h5py()
    by_xdmf()
    by_vtkhdf()
print("formats:", stem, len(points), "points,", len(triangles), "triangles: the readers agree")
