"""Files that other libraries read: their surfaces and numbers, and what is wrong with them."""

import pathlib

import numpy as np
import pytest

import rastrum as rr

SHARED = pathlib.Path(__file__).resolve().parents[3] / "shared" / "data" / "sci"
SIZE = (96, 72)


def colors(what, **more):
    return rr.render(what, size=SIZE, **more).color


def test_points_by_trimesh(tmp_path):
    pytest.importorskip("trimesh")
    places = np.random.default_rng(3).normal(size=(200, 3)).round(3)
    np.savetxt(tmp_path / "cloud.xyz", places)
    assert np.array_equal(colors(str(tmp_path / "cloud.xyz")), colors(rr.Points(places)))
    (tmp_path / "bad.xyz").write_text("no numbers")
    with pytest.raises(rr.Error, match="bad.xyz"):
        rr.load(tmp_path / "bad.xyz")


def written(tmp_path, name, data):
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter, vtkXMLUnstructuredGridWriter
    writer = (vtkXMLPolyDataWriter if name.endswith("vtp") else vtkXMLUnstructuredGridWriter)()
    writer.SetFileName(str(tmp_path / name))
    writer.SetInputData(data)
    assert writer.Write()
    return tmp_path / name


def sheet():
    """A grid of 6 x 4 quads with numbers at points and in cells, a vector at points."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    x, y = np.meshgrid(np.arange(7.0), np.arange(5.0))
    places = np.stack([x, y, np.sin(x)], -1).reshape(-1, 3)
    i = (np.arange(4)[:, None] * 7 + np.arange(6)).reshape(-1)
    quads = np.stack([i, i + 1, i + 8, i + 7], -1)
    points, cells, data = vtkPoints(), vtkCellArray(), vtkPolyData()
    points.SetData(numpy_to_vtk(places, deep=True))
    cells.SetData(numpy_to_vtkIdTypeArray(np.arange(0, 97, 4), deep=True), numpy_to_vtkIdTypeArray(quads.reshape(-1), deep=True))
    data.SetPoints(points)
    data.SetPolys(cells)
    for of, name, values in ((data.GetPointData(), "heat", x.reshape(-1)), (data.GetPointData(), "flow", places),
                             (data.GetCellData(), "load", np.arange(24.0))):
        array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
        array.SetName(name)
        of.AddArray(array)
    return data, places, quads, x.reshape(-1)


def test_vtk_files_and_their_numbers(tmp_path):
    pytest.importorskip("vtkmodules")
    data, places, quads, heat = sheet()
    file = written(tmp_path, "sheet.vtp", data)
    assert np.array_equal(colors(file), colors((places, quads)))
    for name, values in (("heat", heat), ("load", np.arange(24.0))):
        direct = rr.Mesh(places, quads, scalars=values, cmap="coolwarm", clim=(0, 9))
        assert np.array_equal(colors(rr.load(file, scalars=name, cmap="coolwarm", clim=(0, 9))), colors(direct))
    with pytest.raises(rr.ArgumentError, match="there is no 'cold'; there are heat, flow, load"):
        rr.load(file, scalars="cold")
    with pytest.raises(rr.ArgumentError, match="flow has 3 numbers"):
        rr.load(file, scalars="flow")
    with pytest.raises(rr.ArgumentTypeError, match="have a name"):
        rr.load(file, scalars=3)
    with pytest.raises(rr.NotFoundError):
        rr.load(tmp_path / "none.vtu")
    (tmp_path / "bad.vtu").write_text("<VTKFile type='UnstructuredGrid'><Unstr")
    with pytest.raises(rr.FormatError, match="bad.vtu: VTK reads nothing"):
        rr.load(tmp_path / "bad.vtu")
    # Beside a file of ours, and a thing.
    (tmp_path / "t.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    assert rr.Scene([tmp_path / "t.obj", file, rr.Spheres([[0, 0, 0]], 1)]).primitives == 1 + 48 + 1


@pytest.mark.parametrize("name", ["can.vtu", "carotid.vtk", "fertility.vtu", "notch_stress.vtk", "disk_out_ref_surface.vtp", "hydrogen.vti"])
def test_real_files(name):
    pytest.importorskip("vtkmodules")
    if not (SHARED / name).exists():
        pytest.skip("no shared data")
    picture = rr.render(SHARED / name, rr.Camera.fit(SHARED / name, "iso"), size=SIZE, outputs=("color", "id"))
    assert (picture.id >= 0).mean() > 0.05 and picture.color[picture.id >= 0][:, :3].std() > 2
