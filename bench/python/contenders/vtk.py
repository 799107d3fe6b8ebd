# SPDX-License-Identifier: BSD-3-Clause
"""VTK, off screen, by its own light."""
import numpy as np
import vtk
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

REQUIREMENTS = ["vtk==9.7.2", "numpy"]


def prepare(scene):
    points, cells, data = vtk.vtkPoints(), vtk.vtkCellArray(), vtk.vtkPolyData()
    points.SetData(numpy_to_vtk(scene.vertices, deep=True))
    cells.SetData(numpy_to_vtkIdTypeArray(np.arange(0, 3 * len(scene.faces) + 1, 3), deep=True),
                  numpy_to_vtkIdTypeArray(scene.faces.reshape(-1), deep=True))
    data.SetPoints(points)
    data.SetPolys(cells)
    mapper, actor, renderer, window = (vtk.vtkPolyDataMapper(), vtk.vtkActor(), vtk.vtkRenderer(), vtk.vtkRenderWindow())
    mapper.SetInputData(data)
    actor.SetMapper(mapper)
    renderer.AddActor(actor)
    camera = renderer.GetActiveCamera()
    camera.SetPosition(*scene.eye)
    camera.SetFocalPoint(*scene.target)
    camera.SetViewAngle(scene.fov)
    camera.SetClippingRange(scene.near, scene.far)
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(scene.size, scene.size)
    window.AddRenderer(renderer)
    n, out = scene.size, vtk.vtkUnsignedCharArray()

    def draw():
        window.Render()
        window.GetRGBACharPixelData(0, 0, n - 1, n - 1, 0, out)
        return {"color": vtk_to_numpy(out).reshape(n, n, 4)[::-1]}

    def images():
        z = vtk.vtkFloatArray()
        picture = draw()
        window.GetZbufferData(0, 0, n - 1, n - 1, z)
        z = vtk_to_numpy(z).reshape(n, n)[::-1].astype(np.float64)
        near, far = camera.GetClippingRange()
        depth = np.where(z < 1, near * far / (far - z * (far - near)), 0)
        return {**picture, "depth": depth}
    draw.images = images
    return draw
