"""MeshPy with this project's library in it: cases beyond its own tests. pytest runs this file."""
import meshpy.triangle as triangle


def square():
    info = triangle.MeshInfo()
    info.set_points([(0, 0), (4, 0), (4, 4), (0, 4)])
    info.set_facets([(0, 1), (1, 2), (2, 3), (3, 0)])
    return info


def areas(mesh):
    at = [mesh.points[k] for k in range(len(mesh.points))]
    for a, b, c in ([at[k] for k in corners] for corners in mesh.elements):
        yield ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2


def test_refine_by_a_function():
    """inducer/meshpy 10: refine() passes razjqQun without a list of areas."""
    mesh = triangle.build(square(), max_volume=1.0)
    finer = triangle.refine(mesh, refinement_func=lambda corners, area: area > 0.1)
    found = list(areas(finer))
    assert len(found) > len(mesh.elements) >= 16 and max(found) <= 0.1 and abs(sum(found) - 16) < 1e-9
