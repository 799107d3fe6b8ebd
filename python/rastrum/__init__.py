# SPDX-License-Identifier: BSD-3-Clause
"""Rastrum: pictures from arrays, anywhere. No OpenGL, no GPU, no display; the same bytes on every machine.

    import rastrum as rr
    rr.render("bunny.obj").save("bunny.png")
    picture = rr.render(rr.Mesh(vertices, faces), rr.Camera.opencv(K, R, t), size=(640, 480),
                        outputs=("color", "depth", "instance"))
"""

from ._camera import Camera, Projected, orbit
from ._errors import (ArgumentError, ArgumentTypeError, DeviceError, Error, FileError, FormatError, MissingOutputError, NotFoundError,
                      OddInputWarning, OutOfMemoryError, PictureIndexError, UnsupportedError)
from ._lights import Light
from ._matplotlib import draw_behind
from ._rasterize import rasterize
from ._render import OUTPUTS, Hit, Picture, Pictures, Renderer, digest, render, render_many, views4
from ._scene import Scene, as_scene, load
from ._terrain import Terrain
from ._things import ColorMapping, Cylinders, Discs, Lines, Material, Mesh, Points, Spheres, Tubes, color_maps, crease_normals
from ._view import View
from ._rastrum import version as __version__
from . import mpi

__all__ = [
    "OUTPUTS", "ArgumentError", "ArgumentTypeError", "Camera", "ColorMapping", "Cylinders", "DeviceError", "Discs", "Error", "FileError",
    "FormatError", "Hit", "Light", "Lines", "Material", "Mesh", "MissingOutputError", "NotFoundError", "OddInputWarning", "OutOfMemoryError", "Picture",
    "PictureIndexError", "Pictures", "Points", "Projected", "Renderer", "Scene", "Spheres", "Terrain", "Tubes", "UnsupportedError", "View", "as_scene",
    "color_maps", "crease_normals", "digest", "draw_behind", "load", "mpi", "orbit", "rasterize", "render", "render_many",
    "trimesh_viewer", "views4",
]


def trimesh_viewer(scene, **frame):
    """For trimesh: scene.show(viewer=rastrum.trimesh_viewer) returns a Picture, which notebooks show."""
    return render(scene, **frame)
