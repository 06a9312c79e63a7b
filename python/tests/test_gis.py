"""Maps and rasters to figures and sizes, and meshes with depths to files."""
import json
import subprocess
import sys
import warnings

import numpy as np
import ptriangle
import pytest
from ptriangle import gis

shapely = pytest.importorskip("shapely")


def box(x, y, width, height):
    return shapely.box(x, y, x + width, y + height)


def wavy(x, y, radius, n=400):
    turn = np.linspace(0, 2 * np.pi, n, endpoint=False)
    r = radius * (1 + 0.1 * np.sin(7 * turn) + 0.01 * np.sin(60 * turn))
    return shapely.Polygon(np.column_stack([x + r * np.cos(turn), y + r * np.sin(turn)]))


LAND = [box(-10, -10, 12, 120), wavy(40, 50, 10), wavy(70, 30, 0.5)]
BOUNDS = (0, 0, 100, 100)


def test_the_sea():
    for land in (LAND, [json.loads(json.dumps(shapely.geometry.mapping(shape))) for shape in LAND]):
        found = gis.sea(land, BOUNDS)
        m = ptriangle.mesh(**found, min_angle=25)
        assert m.check(min_angle=25)
        assert m.areas.sum() == pytest.approx(box(*BOUNDS).difference(shapely.union_all(LAND)).area)
        a, b = (m.points[m.segments[:, k]] for k in (0, 1))
        middle, length = (a + b) / 2, np.hypot(*(b - a).T)
        assert length[m.segment_markers == 2].sum() == pytest.approx(98 + 98 + 100)
        assert not ((middle[:, 0] < 2.001) & (m.segment_markers == 2) & (middle[:, 1] > 1) & (middle[:, 1] < 99)).any()
    split = [box(50, -10, 1, 120)]
    assert ptriangle.mesh(**gis.sea(split, BOUNDS)).areas.sum() == pytest.approx(5000)
    assert ptriangle.mesh(**gis.sea(split, BOUNDS, largest=False)).areas.sum() == pytest.approx(9900)
    with pytest.raises(ptriangle.InputError, match="no sea"):
        gis.sea([box(-1, -1, 200, 200)], BOUNDS)


@pytest.mark.skipif(not hasattr(shapely, "coverage_simplify"), reason="shapely before 2.1")
def test_cleaned_coasts():
    shared = [shapely.union(LAND[1], box(40, 40, 10, 20)), box(60, 0, 30, 90)]
    shared.append(box(0, 0, 100, 100).difference(shapely.union_all(shared)))
    with pytest.warns(ptriangle.InputWarning, match=r"of \d+ corners \d+ are left"):
        after = gis.cleaned(shared, 2)
    assert shapely.coverage_is_valid(after) and sum(shapely.area(after)) == pytest.approx(10000, rel=0.01)
    assert shapely.get_num_coordinates(after).sum() < shapely.get_num_coordinates(shared).sum() / 2
    with pytest.warns(ptriangle.InputWarning, match="of 3 rings 2"):
        found = gis.sea(LAND, BOUNDS, min_edge=2)
    coast = found["segments"][found["segment_markers"] == 1]
    a, b = (found["points"][coast[:, k]] for k in (0, 1))
    assert np.median(np.hypot(*(b - a).T)) > 2 and (np.hypot(*(b - a).T) < 1).mean() < 0.05
    assert np.abs(found["points"] - [70, 30]).sum(axis=1).min() > 2  # the small island is removed


def test_figures_with_markers():
    river = shapely.LineString([(0, 2), (2, 2), (4, 3)])
    found = gis.figure([box(0, 0, 4, 4), box(1, 0.5, 1, 1), river], markers=[5, 6, 7])
    m = ptriangle.mesh(**found, min_angle=20)
    a, b = (m.points[m.segments[:, k]] for k in (0, 1))
    length = np.bincount(m.segment_markers, np.hypot(*(b - a).T), 8)
    assert length[5:] == pytest.approx([16, 4, 2 + np.sqrt(5)]) and m.areas.sum() == pytest.approx(15)
    geopandas = pytest.importorskip("geopandas")
    frame = geopandas.GeoDataFrame({"kind": [5, 6, 7]}, geometry=[box(0, 0, 4, 4), box(1, 0.5, 1, 1), river])
    same = gis.figure(frame, "kind")
    assert np.array_equal(same["segment_markers"], found["segment_markers"])


ASC = "ncols 4\nnrows 3\nxllcorner -5\nyllcorner 0\ncellsize 10\nNODATA_value -9999\n" \
      "20 21 22 23\n10 11 -9999 13\n0 1 2 3\n"


def test_rasters(tmp_path):
    (tmp_path / "depth.asc").write_text(ASC)
    depths = gis.raster(tmp_path / "depth.asc")
    assert depths[1] == (0, 5, 30, 25) and depths[0][0].tolist() == [0, 1, 2, 3] and np.isnan(depths[0][1, 2])
    at = [[0, 5], [30, 25], [5, 10], [30, 15], [-9, 0], [50, 25], [20, 15]]
    assert gis.sampled(depths, at)[:6].tolist() == [0, 23, 5.5, 13, 0, 23]
    assert gis.sampled(depths, at)[6] in (2, 11, 13, 22)  # the place of no data: one beside it
    with pytest.raises(ptriangle.FileError, match="no ESRI"):
        (tmp_path / "bad.asc").write_text("ncols 4\nnrows 3\n1 2 3\n")
        gis.raster(tmp_path / "bad.asc")
    rasterio = pytest.importorskip("rasterio")
    same = gis.raster(rasterio.open(tmp_path / "depth.asc").name)
    with rasterio.open(tmp_path / "depth.tif", "w", driver="GTiff", width=4, height=3, count=1, dtype="float64",
                       nodata=-9999, crs="EPSG:32633",
                       transform=rasterio.transform.from_origin(-5, 30, 10, 10)) as file:
        file.write(np.nan_to_num(depths[0][::-1], nan=-9999), 1)
    tif = gis.raster(tmp_path / "depth.tif")
    for other in same, tif:
        assert other[1] == pytest.approx(depths[1]) and np.array_equal(other[0], depths[0], equal_nan=True)
    with pytest.raises(ptriangle.InputError, match="does not name its coordinates"):
        gis.raster(tmp_path / "depth.asc", crs="EPSG:4326")
    (tmp_path / "depth.prj").write_text(rasterio.crs.CRS.from_epsg(32633).to_wkt())
    for path in tmp_path / "depth.asc", tmp_path / "depth.tif":
        assert gis.raster(path, crs="EPSG:4326")[1][0] == pytest.approx(10.51, abs=0.01)  # degrees


@pytest.mark.parametrize("text", [b"ncols 2\nnrows", b"ncols 2\nnrows 1\ncellsize 1\nfoo 3\n1 2", b"\xff\xfe"])
def test_asc_files_that_are_none(tmp_path, text):
    (tmp_path / "bad.asc").write_bytes(text)
    with pytest.raises(ptriangle.FileError, match="no ESRI"):
        gis.raster(tmp_path / "bad.asc")
    (tmp_path / "good.asc").write_text("\n " + ASC.replace("\n", "\n ").replace("0 1 2 3", "nan 1 2 3"))
    assert np.isnan(gis.raster(tmp_path / "good.asc")[0]).sum() == 2


def test_land_in_other_coordinates():
    metres = (5e5, 5.5e6, 6e5, 5.6e6)
    with pytest.warns(ptriangle.InputWarning, match="no land in the box .*crs="):
        gis.sea([box(8, 50, 1, 1)], metres)
    with pytest.warns(ptriangle.InputWarning, match="No polygon is left"):
        gis.cleaned([box(8, 50, 1, 1)], 5000)


def test_land_that_is_not_valid():
    bow = shapely.Polygon([(0, 0), (2, 2), (2, 0), (0, 2)])
    rings = [[[(0, 0), (1, 1), (0, 2)]], [[(1, 1), (2, 0), (2, 2)]], [[(1, 1), (3, 1), (3, 3), (1, 3)]]]
    for land in ([bow, box(1, 1, 2, 2), None], rings):
        assert ptriangle.mesh(**gis.sea(land, (-1, -1, 4, 4))).areas.sum() == pytest.approx(25 - 2 - 4 + 0.5)
    if hasattr(shapely, "coverage_simplify"):
        with pytest.warns(ptriangle.InputWarning, match="changes by 0%"):
            assert sum(shapely.area(gis.cleaned([bow], 0.1))) == pytest.approx(2)


@pytest.mark.parametrize("call, words", [
    (lambda: gis.sea(LAND, (0, 0, 1)), "bounds"), (lambda: gis.sea(LAND, (0, 0, 1, np.nan)), "bounds"),
    (lambda: gis.sea(LAND, BOUNDS, min_edge=0), "min_edge"),
    (lambda: gis.wave_sizes((np.ones((2, 2)), BOUNDS), 0), "period"),
    (lambda: gis.sampled((np.ones((2, 2)), BOUNDS), [1, 2]), "shape"),
    (lambda: gis.write_figure(LAND, "fig.vtu"), r"\.poly")])
def test_errors(call, words):
    with pytest.raises(ptriangle.InputError, match=r"^gis\.\w+\(\): .*" + words):
        call()


def test_sizes_of_depths():
    x, y = np.meshgrid(np.linspace(0, 100, 101), np.linspace(0, 50, 51))
    depths = (10 + x, (0, 0, 100, 50))
    wave = gis.wave_sizes(depths, period=12, n=40, min_depth=20)
    assert wave[0][3, [0, 50]] == pytest.approx(np.sqrt(9.81 * np.array([20, 60])) * 12 / 40)
    slope = gis.slope_sizes(depths, n=10)
    assert slope[0][7, 40] == pytest.approx(2 * np.pi * 50 / 10)
    assert np.isinf(gis.slope_sizes((x * 0, depths[1]))[0]).all()
    m = ptriangle.mesh(**gis.figure([box(0, 0, 100, 50)]), size=[wave, slope], min_angle=25)
    want = (m.areas / (np.sqrt(3) / 4 * gis.sampled(wave, m.points[m.triangles].mean(axis=1)) ** 2)).sum()
    assert len(m.triangles) == pytest.approx(want, rel=0.05)


def test_files_with_depths(tmp_path):
    m = ptriangle.mesh(**gis.sea(LAND, BOUNDS), min_angle=25, size=5)
    depths = m.points @ [0.1, 0.2]
    for name in "fort.14", "sea.2dm", "sea.msh":
        gis.write(m, tmp_path / name, depths=depths)
        back = ptriangle.mesh(**ptriangle.read(tmp_path / name))
        order, same = np.lexsort(m.points.T), np.lexsort(back.points.T)
        np.testing.assert_allclose(back.points[same], m.points[order])
        np.testing.assert_allclose(back.point_attributes[same, 0], depths[order], rtol=1e-6)
        assert (back.segment_markers == 2).sum() == (m.segment_markers == 2).sum()
    gis.write(m, tmp_path / "degrees.14", depths, points=m.points / 1000)
    assert np.abs(ptriangle.read(tmp_path / "degrees.14")["points"]).max() <= 0.1
    with pytest.raises(ptriangle.InputError, match="shape"):
        gis.write(m, tmp_path / "fort.14", depths=depths[1:])
    with pytest.raises(ptriangle.InputError, match="depths of .* 1 of them not finite"):
        gis.write(m, tmp_path / "fort.14", depths=np.append(depths[1:], np.nan))
    io = pytest.importorskip("scipy.io")
    gis.write(m, tmp_path / "sea.nc", depths)
    with io.netcdf_file(tmp_path / "sea.nc", mmap=False) as file:
        assert np.array_equal(file.variables["face_nodes"][:], m.triangles)
        assert np.array_equal(file.variables["depth"][:], depths)
        assert file.variables["mesh2d"].cf_role == b"mesh_topology" and file.variables["node_x"].units == b"m"
    gis.write(m, tmp_path / "degrees.nc", points=m.points / 1000)
    with io.netcdf_file(tmp_path / "degrees.nc", mmap=False) as file:
        assert not {"units", "standard_name"} & set(file.variables["node_x"]._attributes)


def test_a_map_for_the_programs(tmp_path):
    geopandas = pytest.importorskip("geopandas")
    shapes = [box(0, 0, 4, 4), box(2, 2, 4, 4).difference(box(4, 4, 1, 1))]
    frame = geopandas.GeoDataFrame({"code": [5, 9], "most": [0.5, 0.1]}, geometry=shapes)
    frame.to_file(tmp_path / "map.gpkg")
    subprocess.run([sys.executable, "-m", "ptriangle.gis", tmp_path / "map.gpkg", tmp_path / "map.poly",
                    "--attributes", "code", "--areas", "most"], check=True)
    wrong = subprocess.run([sys.executable, "-m", "ptriangle.gis", tmp_path / "map.gpkg", tmp_path / "map.poly",
                            "--areas", "zz"], stderr=subprocess.PIPE, text=True)
    assert wrong.returncode == 2 and "'zz', but code, most" in wrong.stderr and "Traceback" not in wrong.stderr
    m = ptriangle.mesh(**ptriangle.read(tmp_path / "map.poly"), min_angle=25)
    of = m.triangle_attributes[:, 0]
    assert m.areas[of == 5].sum() == pytest.approx(12) and m.areas[of == 9].sum() == pytest.approx(15)
    assert m.areas[of == 9].max() <= 0.1 < m.areas[of == 5].max()


def test_files_of_maps(tmp_path):
    geopandas = pytest.importorskip("geopandas")
    frame = geopandas.GeoDataFrame({"code": [5]}, geometry=[box(10, 60, 1, 1)], crs="EPSG:4326")
    for name in "map.geojson", "map.shp", "map.gpkg":
        frame.to_file(tmp_path / name)
        assert gis.read(tmp_path / name).geometry[0].equals(frame.geometry[0])
    metres = gis.read(tmp_path / "map.gpkg", crs="utm")
    assert metres.crs.to_epsg() == 32632 and 5e9 < metres.geometry[0].area < 7e9
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        m = ptriangle.mesh(polygons=metres, polygon_attributes="code", size=5000, min_angle=25)
    assert (m.triangle_attributes == 5).all()
