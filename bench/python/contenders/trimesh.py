# SPDX-License-Identifier: BSD-3-Clause
"""trimesh with Embree's rays (embreex): the triangle of each pixel. The tree is built in the first picture."""
import embreex  # noqa: F401  trimesh uses it if it is installed
import numpy as np
import trimesh

REQUIREMENTS = ["trimesh==5.2.0", "embreex==4.4.0.post1", "numpy", "scipy"]


def prepare(scene):
    mesh = trimesh.Trimesh(scene.vertices, scene.faces, process=False)
    n = scene.size
    x = (np.arange(n) + 0.5) / n * 2 - 1
    t = np.tan(np.radians(scene.fov) / 2)
    rays = np.stack([np.broadcast_to(t * x, (n, n)), np.broadcast_to(-t * x[:, None], (n, n)), -np.ones((n, n))], -1)
    rays = rays.reshape(-1, 3) / np.linalg.norm(rays.reshape(-1, 3), axis=1, keepdims=True)
    origins = np.broadcast_to(scene.eye, rays.shape)
    return lambda: {"id": mesh.ray.intersects_first(origins, rays).reshape(n, n)}
