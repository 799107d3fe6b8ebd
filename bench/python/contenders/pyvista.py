# SPDX-License-Identifier: BSD-3-Clause
"""PyVista's screenshot."""
import numpy as np
import pyvista as pv

REQUIREMENTS = ["pyvista==0.49.1", "vtk==9.7.2", "numpy"]


def prepare(scene):
    plotter = pv.Plotter(off_screen=True, window_size=(scene.size, scene.size))
    plotter.disable_anti_aliasing()  # as for all contenders: one sample a pixel
    plotter.render_window.SetMultiSamples(0)
    plotter.add_mesh(pv.PolyData.from_regular_faces(scene.vertices, scene.faces))
    plotter.camera.position = tuple(scene.eye)
    plotter.camera.focal_point = tuple(scene.target)
    plotter.camera.up = 0, 1, 0  # PyVista's default is the viewing axis, which gives an empty picture
    plotter.camera.view_angle = scene.fov
    plotter.camera.clipping_range = scene.near, scene.far

    def draw():
        plotter.render()
        return {"color": plotter.screenshot(return_img=True)}
    # Depth along the axis, negative; NaN where nothing is.
    draw.images = lambda: {**draw(), "depth": np.nan_to_num(-plotter.get_image_depth(reset_camera_clipping_range=False), nan=0)}
    return draw
