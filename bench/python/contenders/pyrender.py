# SPDX-License-Identifier: BSD-3-Clause
"""pyrender on OSMesa: metallic-roughness, one light from the eye."""
import os

os.environ.setdefault("PYOPENGL_PLATFORM", "osmesa")

import numpy as np  # noqa: E402
import pyrender  # noqa: E402
import trimesh  # noqa: E402

# pyrender's own requirements do not work: its PyOpenGL does not know current OSMesa, and it uses names that
# NumPy 2 has dropped.
REQUIREMENTS = ["numpy<2", "trimesh<5", "pyglet<2", "PyOpenGL==3.1.10", "freetype-py", "imageio", "networkx", "pillow", "scipy", "six"]
WITHOUT_DEPENDENCIES = ["pyrender==0.1.45"]


def prepare(scene):
    pose = np.eye(4)
    pose[:3, 3] = scene.eye
    made = pyrender.Scene(bg_color=[0, 0, 0, 0], ambient_light=[0.1, 0.1, 0.1])
    made.add(pyrender.Mesh.from_trimesh(trimesh.Trimesh(scene.vertices, scene.faces, process=False)))
    made.add(pyrender.PerspectiveCamera(np.radians(scene.fov), znear=scene.near, zfar=scene.far), pose=pose)
    made.add(pyrender.DirectionalLight(intensity=3), pose=pose)
    renderer = pyrender.OffscreenRenderer(scene.size, scene.size)

    def draw():
        color, depth = renderer.render(made, flags=pyrender.RenderFlags.RGBA)
        return {"color": color, "depth": depth}
    return draw
