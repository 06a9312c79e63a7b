"""FloPy's Triangle utility (MODFLOW) runs the program `triangle` given in PTRIANGLE_PROGRAM. pytest tests the way from
its input files to its grids.
"""
import os

import numpy as np
import pytest
from flopy.utils.triangle import Triangle

PROGRAM = os.environ["PTRIANGLE_PROGRAM"]


def build(folder, maximum_area):
    tri = Triangle(model_ws=str(folder), exe_name=PROGRAM, angle=30, maximum_area=maximum_area)
    tri.add_polygon([(0, 0), (20, 0), (20, 10), (0, 10)])
    tri.add_polygon([(12, 4), (15, 4), (15, 7), (12, 7)])
    tri.add_hole((13, 5))
    tri.add_polygon([(2, 2), (8, 2), (8, 8), (2, 8)])
    tri.add_region((1, 1), attribute=1, maximum_area=4)
    tri.add_region((5, 5), attribute=2, maximum_area=0.5)
    tri.build()
    return tri


def size(corners):
    (ax, ay), (bx, by), (cx, cy) = corners
    return ((bx - ax) * (cy - ay) - (cx - ax) * (by - ay)) / 2


# One bound for all regions (-a1.5), or the bounds of the regions (-a).
@pytest.mark.parametrize("maximum_area, outer, inner", [(1.5, 1.5, 1.5), (None, 4, 0.5)])
def test_cells(tmp_path, maximum_area, outer, inner):
    mesh = build(tmp_path, maximum_area)
    vertices, cells = mesh.get_vertices(), mesh.get_cell2d()
    assert mesh.ncpl == len(cells) > 100 and mesh.nvert == len(vertices) > 60
    assert [row[0] for row in vertices] == list(range(mesh.nvert))
    assert [row[0] for row in cells] == list(range(mesh.ncpl))
    place = np.array([row[1:3] for row in vertices])
    corners = np.array([place[list(row[4:7])] for row in cells])
    sizes = np.abs([size(c) for c in corners])
    within = np.array([2 < row[1] < 8 and 2 < row[2] < 8 for row in cells])
    assert abs(sizes.sum() - (200 - 9)) < 1e-9
    assert sizes[within].max() <= inner * (1 + 1e-9) and sizes[~within].max() <= outer * (1 + 1e-9)
    assert abs(sizes[within].sum() - 36) < 1e-9
    assert (mesh.get_attribute_array() == np.where(within, 2, 1)).all()
    assert np.allclose(mesh.get_xcyc(), corners.mean(1))
    for c in corners:
        for k in range(3):
            u, v = c[(k + 1) % 3] - c[k], c[(k + 2) % 3] - c[k]
            assert np.degrees(np.arccos(u @ v / np.sqrt((u @ u) * (v @ v)))) >= 30 - 1e-9


# FloPy numbers the sides of its polygons from 1 and uses the numbers as boundary markers.
def test_boundary(tmp_path):
    mesh = build(tmp_path, 1.5)
    lengths = [20, 10, 20, 10, 3, 3, 3, 3, 6, 6, 6, 6]
    for marker, length in enumerate(lengths, 1):
        cells = mesh.get_edge_cells(marker)
        sides = 1 if marker <= 8 else 2  # sides of the inner region have cells on both sides
        assert abs(sum(mesh.get_cell_edge_length(n, marker) for n in cells) - sides * length) < 1e-9
    assert (mesh.get_boundary_marker_array() > 0).sum() > 30


def test_neighbours(tmp_path):
    mesh = build(tmp_path, 1.5)
    assert len(mesh.neigh) == mesh.ncpl
    for n, row in enumerate(mesh.neigh):
        for other in list(row)[1:]:
            if other != -1:
                assert n in list(mesh.neigh[other])[1:]
                assert len(set(mesh.iverts[n]) & set(mesh.iverts[other])) == 2
