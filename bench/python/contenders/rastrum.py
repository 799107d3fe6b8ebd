"""This package: phong, ids, normals and depth in one frame."""
import time

import numpy as np
import rastrum as rr

import model

REQUIREMENTS = []  # the wheel: contest.py --wheel


def prepare(scene):
    mesh = rr.Scene(rr.Mesh(scene.vertices, scene.faces, normals=None))
    camera = rr.Camera.look_at(scene.eye, scene.target, fov=scene.fov)
    renderer = rr.Renderer()

    def draw():
        p = renderer.render(mesh, camera, size=(scene.size, scene.size), outputs=("color", "id"))
        return {"color": p.color, "id": p.id}
    draw.images = lambda: {n: renderer.render(mesh, camera, size=(scene.size, scene.size), outputs=n).arrays[n]
                           for n in ("color", "depth", "id")}
    return draw


def depth_maps(scene, poses):
    mesh = rr.Scene(rr.Mesh(scene.vertices, scene.faces))
    clip = np.stack([model.projection(scene) @ np.linalg.inv(p) for p in poses])
    rr.render(mesh, clip[:8], size=(scene.size, scene.size), outputs="depth")
    begin = time.perf_counter()
    rr.render(mesh, clip, size=(scene.size, scene.size), outputs="depth")
    return time.perf_counter() - begin
