"""The Python package `triangle` (PyPI, 20200424) with this project's library in it. pytest runs this file.

The package's doctests fix the order of triangles and edges, which is arbitrary. Here the same calls are compared as
sets. The data come from the package.
"""
import math

import numpy as np
import pytest
import triangle as tr


def rotated(row):
    row = [int(i) for i in row]
    k = row.index(min(row))
    return tuple(row[k:] + row[:k])


def triangles(mesh):
    return sorted(rotated(row) for row in (mesh["triangles"] if isinstance(mesh, dict) else mesh))


def undirected(rows):
    return sorted(tuple(sorted(int(i) for i in row)) for row in rows)


def areas(mesh):
    a, b, c = (mesh["vertices"][mesh["triangles"][:, k]] for k in range(3))
    return ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2


def smallest_angle(mesh):
    p = mesh["vertices"][mesh["triangles"]]
    least = math.pi
    for k in range(3):
        u, v = p[:, (k + 1) % 3] - p[:, k], p[:, (k + 2) % 3] - p[:, k]
        cosine = (u * v).sum(1) / np.sqrt((u * u).sum(1) * (v * v).sum(1))
        least = min(least, np.arccos(np.clip(cosine, -1, 1)).min())
    return math.degrees(least)


# --- the package's doctests

def test_triangulate():
    mesh = tr.triangulate({"vertices": [[0, 0], [0, 1], [1, 1], [1, 0]]}, "a0.2")
    new = [[0.5, 0.5], [0, 0.5], [0.5, 0], [1, 0.5], [0.5, 1]]  # in an order that the mesher chooses
    assert mesh["vertices"][:4].tolist() == [[0, 0], [0, 1], [1, 1], [1, 0]]
    assert mesh["vertices"][4].tolist() == new[0] and sorted(mesh["vertices"][4:].tolist()) == sorted(new)
    assert mesh["vertex_markers"].tolist() == [[1], [1], [1], [1], [0], [1], [1], [1], [1]]
    assert len(mesh["triangles"]) == 8 and areas(mesh).max() <= 0.2 and areas(mesh).sum() == 1


def test_delaunay():
    found = tr.delaunay([[0, 0], [0, 1], [0.5, 0.5], [1, 1], [1, 0]])
    assert triangles(found) == triangles([[1, 0, 2], [2, 4, 3], [4, 2, 0], [2, 3, 1]])


def test_convex_hull():
    found = tr.convex_hull([[0, 0], [0, 1], [1, 1], [1, 0]])
    assert undirected(found) == undirected([[3, 0], [2, 3], [1, 2], [0, 1]])


def test_voronoi():
    points, edges, origins, directions = tr.voronoi([[0, 0], [0, 1], [0.5, 0.5], [1, 1], [1, 0]])
    assert sorted(points.tolist()) == [[0, 0.5], [0.5, 0], [0.5, 1], [1, 0.5]]
    assert len(edges) == 4 and all(0.7 < np.linalg.norm(points[i] - points[j]) < 0.71 for i, j in edges)
    assert sorted(origins.tolist()) == [0, 1, 2, 3]
    for i, direction in zip(origins, directions):
        assert (direction == 2 * (points[i] - [0.5, 0.5])).all()


# --- its data: triangulations, for which Triangle's counts are the only correct ones (la itself has an angle of 4
# degrees)

@pytest.mark.parametrize("name, switches, n_vertices, n_triangles", [
    ("A", "p", 29, 29), ("A", "pc", 29, 47), ("face", "p", 26, 36), ("face", "pc", 26, 38), ("la", "p", 141, 265),
    ("box", "pc", 8, 8), ("box", "pcO", 8, 10), ("spiral", "", 15, None), ("dots", "", 100, 187),
    ("double_hex", "p", 96, 98), ("square_circle_hole", "p", 826, 1517), ("greenland", "", 33343, 66647)])
def test_counts(name, switches, n_vertices, n_triangles):
    mesh = tr.triangulate(tr.get_data(name), switches)
    assert len(mesh["vertices"]) == n_vertices
    assert n_triangles is None or len(mesh["triangles"]) == n_triangles
    assert areas(mesh).min() > 0


@pytest.mark.parametrize("name, switches, angle, area", [
    ("A", "pq", 20, 0), ("A", "pq30", 30, 0), ("face", "pq10", 10, 0), ("face", "pq30", 30, 0), ("la", "pq", 4, 0),
    ("la", "pqa", 4, 3), ("la", "pq30a.05", 4, 0.05), ("spiral", "q32.5", 32.5, 0), ("spiral", "a.2", 0, 0.2),
    ("double_hex", "pq", 20, 0), ("dots", "qa0.01", 20, 0.01), ("A", "pq0D", 0, 0), ("box", "pcqa.2", 20, 0.2)])
def test_quality(name, switches, angle, area):
    data = tr.get_data(name)
    mesh, plain = tr.triangulate(data, switches), tr.triangulate(data, switches.split("q")[0].split("a")[0])
    assert smallest_angle(mesh) >= angle * (1 - 1e-9)
    assert not area or areas(mesh).max() <= area * (1 + 1e-9)
    assert math.isclose(areas(mesh).sum(), areas(plain).sum(), rel_tol=1e-9)
    assert (mesh["vertices"][:len(plain["vertices"])] == plain["vertices"]).all()


def test_refined_again():
    mesh = tr.get_data("bbox.1")
    for area in (0.2, 0.05, 0.0125):
        before = len(mesh["triangles"])
        mesh = tr.triangulate(mesh, "rpa%g" % area)
        assert areas(mesh).max() <= area * (1 + 1e-9) and len(mesh["triangles"]) > before
    single = tr.triangulate(tr.get_data("bbox.1"), "rpa")
    assert len(single["triangles"]) > len(tr.get_data("bbox.1")["triangles"])


def test_hull_of_a_mesh():
    face = tr.get_data("face.1")
    assert len(tr.triangulate(face, "rc")["segments"]) > 0
    assert len(tr.triangulate(face, "rpc")["segments"]) >= len(tr.triangulate(face, "rc")["segments"])


# --- input that crashed it (its issues 2, 4, 68, 70), and meaningless input

def test_hole_outside():
    angle = np.linspace(0, 2 * np.pi, 13, endpoint=False)
    points = np.column_stack((np.cos(angle), np.sin(angle)))
    ring = [[i, (i + 1) % 13] for i in range(13)]
    mesh = tr.triangulate({"vertices": points, "segments": ring, "holes": [[0.99, 0.99]]}, "p")
    assert len(mesh["triangles"]) == 11


def test_duplicates():
    points = [[0, 0], [10, 0], [10, 10], [0, 10], [10, 10], [15, 10], [15, 15], [10, 15]]
    ring = [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4]]
    mesh = tr.triangulate({"vertices": points, "segments": ring}, "pe")
    assert len(mesh["triangles"]) == 4 and len(mesh["edges"]) == 10 and len(mesh["segments"]) == 8


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_no_meaning(bad):
    mesh = tr.triangulate({"vertices": [[0, 0], [1, bad], [1, 1], [0, 1]]}, "")
    assert mesh == {}  # the package ignores the return value of triangulate()
    assert tr.triangulate({"vertices": [[1, 1]] * 5}, "") == {}
