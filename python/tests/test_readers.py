# SPDX-License-Identifier: BSD-3-Clause
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
    with pytest.raises(rr.ArgumentTypeError, match="must be a name"):
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


def test_any_vtk_data_set_by_its_outer_surface():
    pytest.importorskip("vtkmodules")
    from vtkmodules.vtkCommonDataModel import vtkImageData
    image = vtkImageData()
    image.SetDimensions(3, 4, 5)
    scene = rr.as_scene(image)
    assert scene.primitives == 2 * 2 * (2 * 3 + 2 * 4 + 3 * 4) and scene.bounds == ((0, 0, 0), (2, 3, 4))


def test_numbers_on_the_command_line(obj, tmp_path):
    from rastrum.__main__ import main
    options = [str(obj), "--size", "160x120", "--shader", "phong", "--scalars", "z", "--cmap", "turbo"]
    assert main(["render", *options, "-o", str(tmp_path / "p.png")]) == 0
    scene = rr.Scene([obj], scalars="z", cmap="turbo")
    drawn = rr.render(scene, rr.Camera.fit(scene, "iso", fov=30), size=(160, 120), shader="phong", annotate={"bar": "z"})
    assert np.array_equal(rr._rastrum.read_image(str(tmp_path / "p.png")), drawn.color)
    # A range of its own is another picture; four views have no bar.
    assert main(["render", *options, "--range", "-5,5", "-o", str(tmp_path / "r.png")]) == 0
    assert not np.array_equal(rr._rastrum.read_image(str(tmp_path / "r.png")), drawn.color)
    assert main(["views", *options, "-o", str(tmp_path / "v.png")]) == 0
    plain = rr.views4(scene, size=(160, 120), shader="phong")
    assert np.array_equal(rr._rastrum.read_image(str(tmp_path / "v.png")), plain.color)
    assert main(["render", *options[:-4], "--scalars", "heat", "-o", str(tmp_path / "n.png")]) == 1
