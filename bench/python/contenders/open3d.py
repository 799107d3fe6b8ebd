# SPDX-License-Identifier: BSD-3-Clause
"""Open3D by Embree's rays: ids and distances, no picture, which needs OpenGL. The tree is built once, untimed."""
import numpy as np
import open3d as o3d

REQUIREMENTS = ["open3d==0.20.0", "numpy"]


def prepare(scene):
    made = o3d.t.geometry.RaycastingScene()
    made.add_triangles(o3d.core.Tensor(scene.vertices.astype(np.float32)), o3d.core.Tensor(scene.faces.astype(np.uint32)))
    # Rays go one unit along the axis, so that their parameter is the depth.
    n, t = scene.size, np.tan(np.radians(scene.fov) / 2)
    x = t * ((np.arange(n) + 0.5) / n * 2 - 1)
    rays = np.empty((n, n, 6), np.float32)
    rays[..., :3], rays[..., 3], rays[..., 4], rays[..., 5] = scene.eye, x, -x[:, None], -1
    rays = o3d.core.Tensor(rays)

    def draw():
        hit = made.cast_rays(rays)
        ids = hit["primitive_ids"].numpy()
        return {"id": np.where(ids == made.INVALID_ID, -1, ids.astype(np.int64)), "t": hit["t_hit"].numpy()}

    def images():
        found = draw()
        return {"id": found["id"], "depth": np.where(found["id"] >= 0, found["t"], 0)}
    draw.images = images
    return draw
