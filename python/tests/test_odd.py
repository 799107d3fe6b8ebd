"""Troubles that users of other tools have reported, rebuilt with geometry of our own: one test a trouble, named
for what is odd; its docstring says what is right. Those of files and of the C++ library stand in tests/odd/."""
import numpy as np
import pytest
import rastrum as rr


def test_vtk_triangle_strips():
    """A vtkPolyData of strips, and of a polygon before them: n - 2 triangles a strip, every second one turned, each with its
    cell's number."""
    from rastrum._others import triangles_of_strips
    triangles, strip = triangles_of_strips(np.array([0, 1, 2, 3, 9, 8, 7]), np.array([0, 4, 7]))
    assert triangles.tolist() == [[0, 1, 2], [1, 3, 2], [9, 8, 7]] and strip.tolist() == [0, 0, 1]

    pytest.importorskip("vtkmodules")
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    points, polys, strips, data = vtkPoints(), vtkCellArray(), vtkCellArray(), vtkPolyData()
    for x in range(4):
        for y in range(2):
            points.InsertNextPoint(x, y, 0)
    polys.InsertNextCell(4, [0, 2, 3, 1])
    strips.InsertNextCell(4, [2, 4, 3, 5])
    strips.InsertNextCell(4, [4, 6, 5, 7])
    data.SetPoints(points)
    data.SetPolys(polys)
    data.SetStrips(strips)
    numbers = numpy_to_vtk(np.array([1.0, 2.0, 3.0]))
    numbers.SetName("n")
    data.GetCellData().AddArray(numbers)
    from rastrum._others import of_vtk
    seen = rr.render(of_vtk(data, None, scalars="n"), size=(90, 60), outputs="scalars").scalars
    middle = seen[30]
    assert [middle[15], middle[45], middle[75]] == [1.0, 2.0, 3.0]


def test_meshio_pixels():
    """A pixel of VTK has its corners in rows, not around it: its area is that of the quad."""
    from rastrum._surface import outer_surface
    corners, offsets, _ = outer_surface([("pixel", np.array([[0, 1, 2, 3]]))])
    assert corners.tolist() == [0, 1, 3, 2] and offsets.tolist() == [0, 4]
