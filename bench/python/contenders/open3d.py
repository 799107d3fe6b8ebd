"""Open3D by Embree's rays: ids and distances; without a picture, which wants OpenGL. The tree is built once and not timed."""
import numpy as np
import open3d as o3d

REQUIREMENTS = ["open3d==0.20.0", "numpy"]


def prepare(scene):
    made = o3d.t.geometry.RaycastingScene()
    made.add_triangles(o3d.core.Tensor(scene.vertices.astype(np.float32)), o3d.core.Tensor(scene.faces.astype(np.uint32)))
    rays = made.create_rays_pinhole(fov_deg=scene.fov, center=scene.target, eye=scene.eye, up=[0, 1, 0], width_px=scene.size,
                                    height_px=scene.size)
    # A ray has a length of 1 along the axis, so that its parameter is the depth.
    directions = rays.numpy()[..., 3:].astype(np.float64)
    ahead = (scene.target - scene.eye) / np.linalg.norm(scene.target - scene.eye)
    along = (directions @ ahead).astype(np.float32)

    def draw():
        hit = made.cast_rays(rays)
        ids = hit["primitive_ids"].numpy()
        return {"id": np.where(ids == made.INVALID_ID, -1, ids.astype(np.int64)), "t": hit["t_hit"].numpy()}

    def images():
        found = draw()
        return {"id": found["id"], "depth": np.where(found["id"] >= 0, found.pop("t") * along, 0)}
    draw.images = images
    return draw
