# SPDX-License-Identifier: BSD-3-Clause
"""Cells of simulations by meshio: the outer surface, and numbers at points and in cells."""

import importlib.util

import numpy as np
import pytest

import rastrum as rr

meshio = pytest.importorskip("meshio")
SIZE = (120, 90)
N = 3


def grid():
    """(points, hexahedra) of a cube of N^3."""
    z, y, x = np.mgrid[0:N + 1, 0:N + 1, 0:N + 1]
    points = np.stack([x, y, z], -1).reshape(-1, 3) / N
    k, j, i = np.mgrid[0:N, 0:N, 0:N]
    a = ((k * (N + 1) + j) * (N + 1) + i).reshape(-1)
    up, side = (N + 1) ** 2, N + 1
    return points, np.stack([a, a + 1, a + 1 + side, a + side, a + up, a + up + 1, a + up + 1 + side, a + up + side], -1)


def split(cells):
    """The same cube by other cells: name -> nodes."""
    h = cells
    return {
        "hexahedron": h,
        "wedge": np.concatenate([h[:, [0, 1, 3, 4, 5, 7]], h[:, [1, 2, 3, 5, 6, 7]]]),
        "tetra": np.concatenate([h[:, t] for t in ([0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6])]),
        # Three pyramids that meet in corner 7, so that none needs a point in the middle.
        "pyramid": np.concatenate([h[:, [0, 1, 2, 3, 7]], h[:, [0, 4, 5, 1, 7]], h[:, [1, 5, 6, 2, 7]]]),
    }


def seen(what):
    p = rr.render(what, rr.Camera.fit(what, (3, 2, 5)), size=SIZE, outputs=("id", "position", "color"))
    return p, p.id >= 0


@pytest.mark.parametrize("kind, faces", [("hexahedron", 6 * N * N), ("wedge", 4 * N * N + 2 * 2 * N * N), ("tetra", 12 * N * N),
                                         ("pyramid", None)])
def test_the_outer_surface_of_a_cube(kind, faces):
    points, cells = grid()
    mesh = meshio.Mesh(points, [(kind, split(cells)[kind])])
    (thing,) = rr.as_scene(mesh).things
    corners, offsets, of = rr._surface.outer_surface([(kind, split(cells)[kind])])
    if faces is not None:
        assert len(of) == faces
    # Every face lies in a side of the cube, and together they are its six sides.
    area = 0
    for f, (begin, end) in enumerate(zip(offsets, offsets[1:])):
        p = points[corners[begin:end]]
        if kind != "pyramid":  # those of neighbours do not fit each other
            assert ((p == 0).all(0) | (p == 1).all(0)).any(), p
        area += sum(np.linalg.norm(np.cross(p[i] - p[0], p[i + 1] - p[0])) / 2 for i in range(1, len(p) - 1))
        assert set(corners[begin:end]) <= set(split(cells)[kind][of[f]])
    assert kind == "pyramid" and area > 6 or np.isclose(area, 6)
    p, there = seen(mesh)
    near = np.abs(p.position[there] - np.clip(np.round(p.position[there]), 0, 1)).min(-1)
    assert near.max() < 1e-5 and thing.primitives == sum(np.diff(offsets) - 2)


def test_numbers_at_points_and_in_cells(tmp_path):
    points, cells = grid()
    heat, load = points @ (1.0, 2.0, 3.0), np.arange(len(cells), dtype=float)
    file = tmp_path / "cube.avs"
    kinds = {"heat": heat, "flow": points}
    meshio.Mesh(points, [("hexahedron", cells)], point_data=kinds, cell_data={"load": [load]}).write(file)
    corners, offsets, of = rr._surface.outer_surface([("hexahedron", cells)])
    for name, values in (("heat", heat), ("load", load[of])):
        direct = rr.Mesh(points, corners, offsets=offsets, scalars=values, cmap="coolwarm", clim=(0, 9))
        assert np.array_equal(seen(rr.load(file, scalars=name, cmap="coolwarm", clim=(0, 9)))[0].color, seen(direct)[0].color)
    with pytest.raises(rr.ArgumentError, match="there is no 'cold'; there are heat, flow, .*load"):
        rr.load(file, scalars="cold")
    with pytest.raises(rr.ArgumentError, match="flow has 3 numbers"):
        rr.load(file, scalars="flow")
    (tmp_path / "bad.msh").write_text("$MeshFormat\nnonsense\n")
    with pytest.raises(rr.FormatError, match="bad.msh: meshio"):
        rr.load(tmp_path / "bad.msh")


def test_flat_cells_lines_and_vertices():
    points = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [2, 0], [2, 1], [0.5, 2]])
    blocks = [("triangle6", [[0, 1, 2, 3, 3, 3]]), ("quad", [[1, 4, 5, 2]]), ("line3", [[3, 6, 0]]), ("vertex", [[6]])]
    mesh = rr.as_scene(meshio.Mesh(points, [(n, np.array(c)) for n, c in blocks]))
    assert [type(t) for t in mesh.things] == [rr.Mesh, rr.Lines, rr.Points]
    assert [t.primitives for t in mesh.things] == [3, 1, 1]
    with pytest.raises(rr.UnsupportedError, match="polyhedron8"):
        rr._surface.things_of(type("M", (), {"points": points, "cells": [type("B", (), {"type": "polyhedron8", "data": [[1]]})],
                                             "point_data": {}, "cell_data": {}}))


def exodus(source, file):
    """As VTK writes it: what meshio writes VTK cannot read."""
    from vtkmodules.vtkIOExodus import vtkExodusIIWriter
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
    reader, writer = vtkXMLUnstructuredGridReader(), vtkExodusIIWriter()
    reader.SetFileName(str(source))
    writer.SetInputConnection(reader.GetOutputPort())
    writer.SetFileName(str(file))
    writer.Write()


def exodus_of_a_code(file, points, blocks, heat, load):
    """Exodus by netCDF alone, as solvers write it: blocks of (kind, nodes), numbers at nodes and in elements."""
    netcdf = pytest.importorskip("netCDF4")
    with netcdf.Dataset(file, "w") as out:
        out.title, out.api_version, out.version = "two blocks", np.float32(5.1), np.float32(5.1)
        out.floating_point_word_size, out.file_size = np.int32(8), np.int32(1)
        for name, size in [("num_dim", 3), ("num_nodes", len(points)), ("num_elem", sum(len(c) for _, c in blocks)),
                           ("num_el_blk", len(blocks)), ("len_string", 33), ("len_name", 33), ("num_nod_var", 1),
                           ("num_elem_var", 1), ("time_step", None)]:
            out.createDimension(name, size)

        def text(name, of, words):
            out.createVariable(name, "S1", (of, "len_name"))[:] = netcdf.stringtochar(np.array(words, "S33"))
        text("name_nod_var", "num_nod_var", ["heat"])
        text("name_elem_var", "num_elem_var", ["load"])
        out.createVariable("time_whole", "f8", ("time_step",))[:] = [0.5]
        for axis, name in enumerate("xyz"):
            out.createVariable(f"coord{name}", "f8", ("num_nodes",))[:] = points[:, axis]
        out.createVariable("vals_nod_var1", "f8", ("time_step", "num_nodes"))[0] = heat
        for b, ((kind, cells), numbers) in enumerate(zip(blocks, load), 1):
            out.createDimension(f"num_el_in_blk{b}", len(cells))
            out.createDimension(f"num_nod_per_el{b}", cells.shape[1])
            nodes = out.createVariable(f"connect{b}", "i4", (f"num_el_in_blk{b}", f"num_nod_per_el{b}"))
            nodes.elem_type = kind
            nodes[:] = cells + 1
            out.createVariable(f"vals_elem_var1eb{b}", "f8", ("time_step", f"num_el_in_blk{b}"))[0] = numbers


def test_exodus_of_netcdf(tmp_path, monkeypatch):
    file = tmp_path / "two.e"
    points, cells = grid()
    hexahedra, tetrahedra = cells[:2 * N * N], split(cells[2 * N * N:])["tetra"]
    heat, load = points @ (1.0, 2.0, 3.0), [np.arange(len(hexahedra)) % 7.0, np.arange(len(tetrahedra)) % 5.0]
    exodus_of_a_code(file, points, [("HEX8", hexahedra), ("TETRA", tetrahedra)], heat, load)
    find = importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name == "vtkmodules" else find(name))
    meshio.Mesh(points, [("hexahedron", hexahedra), ("tetra", tetrahedra)], point_data={"heat": heat},
                cell_data={"load": load}).write(tmp_path / "two.vtu")
    camera = rr.Camera.look_at((3, 2, 5), (0.5, 0.5, 0.5), fov=25)
    for scalars, clim in (("heat", (0, 6)), ("load", (0, 7))):
        scene = rr.load(file, scalars=scalars, clim=clim)
        expected = rr.render(rr.load(tmp_path / "two.vtu", scalars=scalars, clim=clim), camera, size=SIZE).color
        assert np.array_equal(rr.render(scene, camera, size=SIZE).color, expected)
        assert len(np.unique(expected[..., :3].reshape(-1, 3), axis=0)) > 5
    with pytest.raises(rr.ArgumentError, match="there is no 'stress'; there are heat, load"):
        rr.load(file, scalars="stress")
    exodus_of_a_code(tmp_path / "other.e", points, [("TETRA4", tetrahedra)], heat, load[1:])
    with pytest.raises(rr.FormatError, match="other.e: meshio: nothing is known of 'tetra4'"):
        rr.load(tmp_path / "other.e")
    whole = file.read_bytes()
    for length in (0, 100, len(whole) // 2, len(whole) - 10):
        (tmp_path / "cut.e").write_bytes(whole[:length])
        with pytest.raises(rr.FormatError, match="cut.e: meshio"):
            rr.load(tmp_path / "cut.e")


@pytest.mark.parametrize("ending", [".vtu", ".vtk", ".e"])
@pytest.mark.parametrize("by", ["meshio", "vtk"])
def test_files_that_both_read(tmp_path, ending, by, monkeypatch):
    pytest.importorskip("vtkmodules" if by == "vtk" else "netCDF4" if ending == ".e" else "meshio")
    points, cells = grid()
    file = tmp_path / f"cube{ending}"
    heat = points @ (1.0, 2.0, 3.0)
    mesh = meshio.Mesh(points, [("hexahedron", cells)], point_data={"heat": heat})
    if by == "vtk" and ending == ".e":
        mesh.write(tmp_path / "cube.vtu")
        exodus(tmp_path / "cube.vtu", file)
    else:
        mesh.write(file)
    find = importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name == "vtkmodules" and by == "meshio" else find(name))
    camera = rr.Camera.look_at((3, 2, 5), (0.5, 0.5, 0.5), fov=25)
    scene = rr.load(file, scalars="heat", clim=(0, 6))
    assert scene.primitives == 12 * N * N
    corners, offsets, _ = rr._surface.outer_surface([("hexahedron", cells)])
    direct = rr.render(rr.Mesh(points, corners, offsets=offsets, scalars=heat, clim=(0, 6)), camera, size=SIZE).color
    # VTK's points are float32, and which two triangles a side of a cube is may differ.
    off = np.abs(rr.render(scene, camera, size=SIZE).color.astype(int) - direct).max(-1)
    assert (off > (2 if by == "vtk" else 0)).mean() <= (0.02 if by == "vtk" else 0)
