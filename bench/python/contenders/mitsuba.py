# SPDX-License-Identifier: BSD-3-Clause
"""Mitsuba 3, scalar: direct light, one path a pixel. The tree is built once and not timed."""
import mitsuba as mi
import numpy as np

REQUIREMENTS = ["mitsuba==3.9.1", "numpy"]
mi.set_variant("scalar_rgb")


def prepare(scene):
    mesh = mi.Mesh("mesh", len(scene.vertices), len(scene.faces))
    params = mi.traverse(mesh)
    params["vertex_positions"] = np.ascontiguousarray(scene.vertices, np.float32).ravel()
    params["faces"] = np.ascontiguousarray(scene.faces, np.uint32).ravel()
    params.update()
    look = mi.ScalarTransform4f().look_at(origin=scene.eye.tolist(), target=scene.target.tolist(), up=[0, 1, 0])

    def made(integrator):
        film = {"type": "hdrfilm", "width": scene.size, "height": scene.size, "rfilter": {"type": "box"}, "pixel_format": "rgba"}
        return mi.load_dict({"type": "scene", "integrator": integrator, "light": {"type": "constant"}, "mesh": mesh, "sensor": {
            "type": "perspective", "fov": scene.fov, "near_clip": scene.near, "far_clip": scene.far, "to_world": look, "film": film,
            "sampler": {"type": "independent", "sample_count": 1}}})
    world = made({"type": "direct", "hide_emitters": True})

    def draw():
        return {"color": np.array(mi.render(world, spp=1))}

    def images():
        # The hit of one ray at a random place in each pixel.
        aov = np.array(mi.render(made({"type": "aov", "aovs": "p:position"}), spp=1))
        ahead = (scene.target - scene.eye) / np.linalg.norm(scene.target - scene.eye)
        place = aov[..., -3:].astype(np.float64)
        depth = np.where((place != 0).any(-1), (place - scene.eye) @ ahead, 0)
        return {**draw(), "depth": depth}
    draw.images = images
    return draw
