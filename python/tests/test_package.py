"""Python conventions: signatures, error messages, copies, pictures, files, geometries of other packages."""
import copy
import inspect
import json
import os
import pickle
import subprocess
import sys
import xml.etree.ElementTree

import numpy as np
import pytest

import ptriangle

PLATE = np.array([[0, 0], [4, 0], [4, 3], [0, 3], [1, 1], [2, 1], [2, 2], [1, 2]], float)
RINGS = np.array([[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4]])
ARRAYS = ["points", "point_attributes", "point_markers", "triangles", "triangle_attributes", "segments",
          "segment_markers", "neighbors", "edges", "edge_markers", "boundary", "areas", "angles", "quality"]


def plate(**wanted):
    return ptriangle.mesh(PLATE, RINGS, holes=[[1.5, 1.5]], **wanted)


def box(x, y, width, height, *z):
    return [[x, y, *z], [x + width, y, *z], [x + width, y + height, *z], [x, y + height, *z]]


def same(a, b):
    return all(np.array_equal(getattr(a, name), getattr(b, name)) for name in ARRAYS)


# --- signatures and words

def test_signatures_and_docstrings():
    names = inspect.signature(ptriangle.mesh).parameters
    assert list(names)[:2] == ["points", "segments"] and names["min_angle"].kind is inspect.Parameter.KEYWORD_ONLY
    assert all(name in ptriangle.mesh.__doc__ for name in names)
    for name, member in inspect.getmembers(ptriangle.Mesh):
        assert name.startswith("_") or inspect.getdoc(member), name


@pytest.mark.parametrize("call, words", [
    (lambda: plate(minangle=3), r"mesh\(\) got an unexpected keyword 'minangle'; did you mean 'min_angle'\?"),
    (lambda: plate().refine(max_are=3), r"refine\(\) got an unexpected keyword 'max_are'; did you mean 'max_area'\?"),
    (lambda: plate(colour=3), r"mesh\(\) got an unexpected keyword 'colour'$")])
def test_unknown_keywords(call, words):
    with pytest.raises(TypeError, match=words):
        call()


@pytest.mark.parametrize("wanted, words", [
    (dict(min_angle=-1), r"^mesh\(\): min_angle is -1"), (dict(min_angle="big"), r"^mesh\(\): min_angle is 'big'"),
    (dict(size=0), r"^mesh\(\): size"), (dict(order=3), r"^mesh\(\): order is 3"),
    (dict(protect=0.5), "protect is 0.5"), (dict(protect=np.inf), "protect is inf instead of a whole"),
    (dict(protect=np.nan), "protect is nan instead of a whole"),
    (dict(protect=1 << 32), "protect is 4294967296: beyond"),
    (dict(threads=(1 << 32) + 1), "threads is 4294967297: beyond"),
    (dict(max_new_points=10 ** 400), "max_new_points is 1000"),
    (dict(max_new_points=1 << 63), "max_new_points is 9223372036854775808: beyond"), (dict(min_angle=np.nan), "is nan"),
    (dict(max_area=10 ** 400), "max_area is 1000"), (dict(stop=1), "stop is 1"), (dict(fence=(1, 2)), "fence has 2"),
    (dict(union=True), "union"), (dict(placement="hexagons"), r"^mesh\(\): placement: 'hexagons' is not"),
    (dict(placement=None), "placement: None is not"),
    (dict(regions=[[1, 2]]), r"^mesh\(\): regions: shape \(1, 2\)"), (dict(segment_markers="x"), "segment_markers")])
def test_errors_name_function_and_argument(wanted, words):
    with pytest.raises(ptriangle.InputError, match=words):
        plate(**wanted)


def test_errors_name_functions_of_the_caller():
    def my_size(x, y):
        return "small"
    with pytest.raises(TypeError, match=r"mesh\(\): size: my_size\(.*\) returned 'small'"):
        plate(size=my_size)


# --- copies

@pytest.mark.parametrize("wanted", [dict(min_angle=30), dict(max_area=0.1, order=2), {}])
def test_pickle(wanted):
    m = plate(regions=[[3, 2, 7, 0.1]], point_attributes=PLATE.sum(axis=1), segment_markers=range(5, 13), **wanted)
    again = pickle.loads(pickle.dumps(m))
    assert same(m, again) and again.counts == m.counts and repr(again) == repr(m)
    assert not again.points.flags.writeable and again.check()
    assert same(m.refine(max_area=0.01), again.refine(max_area=0.01))


def test_copies():
    m = plate(min_angle=30)
    assert same(m, copy.copy(m)) and same(m, copy.deepcopy(m))
    with pytest.warns(ptriangle.EmptyMeshWarning):
        empty = ptriangle.mesh(PLATE[:4], RINGS[:3])
    again = pickle.loads(pickle.dumps(empty))
    assert same(empty, again) and len(again.points) == 4 and again.bad(min_angle=3) == {} and again._repr_svg_()


# --- what is worked out

def test_measures():
    m = plate(min_angle=30)
    assert m.areas.sum() == pytest.approx(11) and np.allclose(m.angles.sum(axis=1), 180) and m.angles.min() >= 30
    assert 0.5 < m.quality.min() <= m.quality.max() <= 1
    equal = ptriangle.mesh([[0, 0], [1, 0], [0.5, np.sqrt(0.75)]])
    assert equal.quality[0] == pytest.approx(1) and equal.angles[0] == pytest.approx([60] * 3)
    a, b = m.points[m.boundary].transpose(1, 0, 2)
    assert ((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2).sum() == pytest.approx(11)  # Green, the mesh on the left
    assert set(map(frozenset, m.boundary.tolist())) == set(map(frozenset, m.segments.tolist()))


def test_second_order():
    m, first = plate(min_angle=30, order=2, point_attributes=PLATE), plate(min_angle=30)
    n, e = len(first.points), len(first.edges)
    assert m.order == 2 and m.points.shape == (n + e, 2) and m.triangles.shape == (len(first.triangles), 6)
    assert np.array_equal(m.triangles[:, :3], first.triangles) and np.array_equal(m.points[:n], first.points)
    for k, (i, j) in enumerate([(0, 1), (1, 2), (2, 0)]):
        corners = m.points[m.triangles]
        assert np.array_equal(corners[:, 3 + k], (corners[:, i] + corners[:, j]) / 2)
    for ends in (m.segments, m.boundary):
        assert np.array_equal(m.points[ends[:, 2]], m.points[ends[:, :2]].mean(axis=1))
    assert np.allclose(m.point_attributes, m.points) and np.array_equal(np.unique(m.triangles), np.arange(n + e))
    assert np.all(m.point_markers[np.unique(m.boundary)] == 1) and m.refine(max_area=0.1).order == 2
    assert m.check(min_angle=30) and np.array_equal(m.areas, first.areas)


@pytest.mark.parametrize("wanted", [dict(max_area=1e-5), dict(size=lambda x, y: 0.05), dict(min_angle=20)])
def test_progress(wanted):
    told = []
    m = plate(progress=lambda done, triangles: told.append((done, triangles)), **wanted)
    shares = [done for done, _ in told]
    assert shares == sorted(shares) and shares[-1] == 1 and told[-1][1] == len(m.triangles)
    assert all(0 <= done <= 1 for done in shares) and (len(m.triangles) < 1000 or len(told) > 5)
    assert same(m, plate(**wanted))


def test_progress_as_a_line(capsys):
    plate(max_area=1e-3, progress=True)
    assert capsys.readouterr().err.endswith(" triangles\n")


# --- pictures

@pytest.mark.parametrize("area", [0.1, 1e-4])
def test_picture_in_a_notebook(area):
    m = plate(max_area=area)
    root = xml.etree.ElementTree.fromstring(m._repr_svg_())
    paths = [path.get("d") for path in root if path.tag.endswith("path")]
    lines = len(m.segments) + (len(m.edges) if area == 0.1 else 0)
    assert sum(path.count("M") for path in paths) == lines and "triangles" in m._repr_svg_()
    assert len(m._repr_svg_()) < 2e6


def test_picture_in_ipython():
    formatters = pytest.importorskip("IPython.core.formatters")
    data, _ = formatters.DisplayFormatter().format(plate())
    assert data["image/svg+xml"].startswith("<svg") and data["text/plain"] == repr(plate())


def test_plot():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    _, ax = plt.subplots()
    m = plate(min_angle=30)
    assert m.plot(ax=ax) is ax and ax.get_xlim()[1] >= 4 and m.plot(segment_color=None) is ax
    ax.figure.canvas.draw()
    plt.close("all")


# --- geometries of others

OVERLAPPING = [box(0, 0, 4, 4), box(2, 2, 4, 4), box(5, 5, 3, 1), box(10, 0, 1, 1), box(0.5, 0.5, 1, 1)]
UNION = 16 + 16 - 4 + 3 - 1 + 1


def test_union():
    m = ptriangle.mesh(polygons=OVERLAPPING, union=True, min_angle=30)
    assert m.areas.sum() == pytest.approx(UNION) and m.check(min_angle=30)
    assert len(m.boundary) == len(m.segments)  # borders inside have vanished
    with pytest.warns(ptriangle.InputWarning, match="polygon 4 lies in polygon 0"):
        odd = ptriangle.mesh(polygons=OVERLAPPING)
    assert odd.areas.sum() == pytest.approx(16 + 16 - 8 + 3 - 2 + 1 - 1)
    holed = [[box(0, 0, 8, 8), box(2, 2, 4, 4)], [box(3, 3, 1, 1), box(3.25, 3.25, 0.5, 0.5)], box(1, 4, 2, 1)]
    assert ptriangle.mesh(polygons=holed, union=True).areas.sum() == pytest.approx(48 + 0.75 + 1)
    cells = [box(x, y, 1, 1) for x in range(9) for y in range(9)]
    grid = ptriangle.mesh(PLATE + 20, RINGS, polygons=cells, union=True)
    assert grid.areas.sum() == pytest.approx(81 + 11) and len(grid.points) < 60


def test_geojson():
    shapes = {"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates": [
            box(0, 0, 4, 4, 17.5) + [[0, 0, 17.5]], box(1, 1, 1, 1, 3)]}},
        {"type": "Feature", "properties": {}, "geometry": None},
        {"type": "Feature", "properties": {}, "geometry": {"type": "MultiPolygon", "coordinates": [
            [box(5, 0, 1, 1)], [box(7, 0, 2, 2)]]}}]}
    m = ptriangle.mesh(polygons=json.loads(json.dumps(shapes)), min_angle=20)
    assert m.areas.sum() == pytest.approx(15 + 1 + 4) and m.points.shape[1] == 2
    with pytest.raises(ptriangle.InputError, match=r"mesh\(\): polygons: a LineString is no polygon"):
        ptriangle.mesh(polygons={"type": "LineString", "coordinates": [[0, 0], [1, 1]]})
    with pytest.raises(ptriangle.InputError, match=r"mesh\(\): polygons\[1\]: a ring of shape"):
        ptriangle.mesh(polygons=[box(0, 0, 1, 1), [1, 2, 3]])


def test_shapely_and_geopandas():
    geometry = pytest.importorskip("shapely.geometry")
    holed = geometry.Polygon(box(0, 0, 4, 4, 9), [box(1, 1, 1, 1, 9)])
    several = geometry.MultiPolygon([geometry.box(5, 0, 6, 1), geometry.box(7, 0, 9, 2)])
    for given in ([holed, several], geometry.GeometryCollection([holed, several])):
        assert ptriangle.mesh(polygons=given).areas.sum() == pytest.approx(20)
    assert ptriangle.mesh(polygons=holed).areas.sum() == pytest.approx(15)
    many = [geometry.Polygon(ring) for ring in OVERLAPPING]
    assert ptriangle.mesh(polygons=many, union=True).areas.sum() == pytest.approx(UNION)
    geopandas = pytest.importorskip("geopandas")
    series = geopandas.GeoSeries([holed, several, None])
    assert ptriangle.mesh(polygons=series).areas.sum() == pytest.approx(20)
    frame = geopandas.GeoDataFrame({"name": ["a", "b", "c"]}, geometry=series)
    assert ptriangle.mesh(polygons=frame).areas.sum() == pytest.approx(20)


# --- files

@pytest.mark.parametrize("suffix", [".vtu", ".msh", ".2dm", ".14", ".grd", ".h5", ".vtkhdf", ".ele", ".poly"])
def test_formats(tmp_path, suffix):
    if suffix in (".h5", ".vtkhdf"):
        pytest.importorskip("h5py")
    m = plate(min_angle=30, regions=[[3, 2, 7, 0.1]], segment_markers=[2, 2, 2, 2, 3, 3, 3, 3])
    m.write(tmp_path / ("plate" + suffix))
    read = ptriangle.read(tmp_path / ("plate" + (".ele" if suffix == ".poly" else suffix)))
    assert np.array_equal(read["points"], m.points)
    assert sorted(map(sorted, read["triangles"].tolist())) == sorted(map(sorted, m.triangles.tolist()))
    again = ptriangle.mesh(**read)
    assert len(again.triangles) == len(m.triangles) and again.check(min_angle=30)
    assert sorted(map(sorted, again.segments.tolist())) == sorted(map(sorted, m.segments.tolist()))
    if suffix not in (".14", ".grd"):
        assert set(again.triangle_attributes[:, 0]) == {7} and set(again.segment_markers) == {2, 3}


def test_vtk_reads_its_own_suffix(tmp_path):
    pytest.importorskip("h5py")
    pyvista = pytest.importorskip("pyvista")
    m = plate(min_angle=30, regions=[[3, 2, 7, 0.1]], segment_markers=[2, 2, 2, 2, 3, 3, 3, 3])
    m.write(tmp_path / "plate.vtkhdf")
    read = pyvista.read(tmp_path / "plate.vtkhdf")
    assert np.array_equal(read.points[:, :2], m.points) and np.array_equal(read.cells_dict[5], m.triangles)
    assert read.area == pytest.approx(m.areas.sum())


def test_suffixes_that_do_not_exist(tmp_path):
    m = plate()
    for name in ("x.shp", "x.stl", "x.geojson"):
        with pytest.raises(ptriangle.InputError, match=r"write\(\): .*\.vtu, \.msh, \.2dm"):
            m.write(tmp_path / name)
    assert os.listdir(tmp_path) == []
    with pytest.raises(ptriangle.InputError, match="first is 4294967296: beyond"):
        m.write(tmp_path / "run.1", first=1 << 32)
    m.write(tmp_path / "run.1")
    assert sorted(os.listdir(tmp_path)) == ["run.1.ele", "run.1.node", "run.1.poly"]
    with pytest.raises(ptriangle.FileError, match=r"read\(\): .*cannot read '.geojson' files, but .*\.poly.*polygons="):
        ptriangle.read("greece.geojson")
    with pytest.raises(OSError, match="nowhere"):
        ptriangle.read(tmp_path / "nowhere.vtu")


@pytest.mark.parametrize("order", [1, 2])
def test_meshio(order, tmp_path):
    meshio = pytest.importorskip("meshio")
    m = plate(min_angle=30, order=order, regions=[[3, 2, 7, 0]])
    m.to_meshio().write(tmp_path / "plate.vtu")
    read = meshio.read(tmp_path / "plate.vtu")
    assert np.array_equal(read.cells[0].data, m.triangles) and np.array_equal(read.points[:, :2], m.points)
    assert read.cells[0].type == ("triangle", "triangle6")[order - 1] and set(read.cell_data["attribute_0"][0]) == {7}
    m.to_meshio().write(tmp_path / "plate.vtk")
    legacy = meshio.read(tmp_path / "plate.vtk")
    assert set(legacy.cell_data["attribute_0"][0].ravel()) == {7} and len(legacy.points) == len(m.points)


@pytest.mark.parametrize("suffix", [".vtu", ".msh", ".ele", ".14", ".h5", ".vtkhdf"])
def test_second_order_in_files(suffix, tmp_path):
    m = plate(min_angle=30, order=2)
    if suffix in (".14", ".h5", ".vtkhdf"):
        with pytest.raises(ptriangle.InputError, match="%s files hold no second-order" % suffix):
            m.write(tmp_path / ("plate" + suffix))
        assert os.listdir(tmp_path) == []
        return
    m.write(tmp_path / ("plate" + suffix), first=0)
    corners = ptriangle.read(tmp_path / ("plate" + suffix))
    assert np.array_equal(corners["points"], m.points) and np.array_equal(corners["triangles"], m.triangles[:, :3])
    if suffix == ".ele":
        rows = np.loadtxt(tmp_path / "plate.ele", skiprows=1, dtype=int)
        assert np.array_equal(rows[:, 1:], m.triangles[:, [0, 1, 2, 4, 5, 3]])
    else:
        meshio = pytest.importorskip("meshio")
        cells = meshio.read(tmp_path / ("plate" + suffix)).get_cells_type("triangle6")
        assert np.array_equal(cells, m.triangles)


# --- programs

@pytest.mark.parametrize("name", ["ptriangle", "trianglecheck", "meshplot"])
def test_programs(name):
    there = os.path.join(os.path.dirname(sys.executable), name)
    inside = os.path.join(os.path.dirname(ptriangle.__file__), "programs", name)
    if not os.path.exists(there) or not (os.path.exists(inside) or name == "trianglecheck"):
        pytest.skip("not installed by a wheel that has it")
    run = subprocess.run([there, "--version"], capture_output=True, text=True, timeout=60)
    assert run.returncode == 0 and run.stdout.split()[:2] == [name, ptriangle.__version__]
