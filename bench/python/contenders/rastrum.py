# SPDX-License-Identifier: BSD-3-Clause
"""This package: phong in 8 bits and ids."""
import time

import numpy as np
import rastrum as rr

import model

REQUIREMENTS = []  # the wheel: contest.py --wheel


def prepare(scene, outputs=("color", "id")):
    mesh = rr.Scene(rr.Mesh(scene.vertices, scene.faces, normals=None))
    camera = rr.Camera.look_at(scene.eye, scene.target, fov=scene.fov)
    renderer = rr.Renderer()

    def draw():
        return dict(renderer.render(mesh, camera, size=(scene.size, scene.size), outputs=outputs).arrays)
    draw.images = lambda: {n: renderer.render(mesh, camera, size=(scene.size, scene.size), outputs=n).arrays[n]
                           for n in dict.fromkeys((*outputs, "depth"))}
    return draw


def depth_maps(scene, poses):
    mesh = rr.Scene(rr.Mesh(scene.vertices, scene.faces))
    clip = np.stack([model.projection(scene) @ np.linalg.inv(p) for p in poses])
    rr.render(mesh, clip[:8], size=(scene.size, scene.size), outputs="depth")
    begin = time.perf_counter()
    rr.render(mesh, clip, size=(scene.size, scene.size), outputs="depth")
    return time.perf_counter() - begin
