# SPDX-License-Identifier: BSD-3-Clause
"""OpenCV 5's cv2.triangleRasterize: one colour and depth, on the CPU."""
import cv2
import numpy as np

REQUIREMENTS = ["opencv-python-headless==5.0.0.93", "numpy"]


def prepare(scene):
    v, f = scene.vertices.astype("f4"), scene.faces.astype("i4")
    grey = np.full(v.shape, 0.7, "f4")
    world_to_camera = np.eye(4, dtype="f4")
    world_to_camera[2, 3] = -scene.eye[2]
    n = scene.size

    def draw():
        color, depth = np.zeros((n, n, 3), "f4"), np.full((n, n), scene.far, "f4")
        color, depth = cv2.triangleRasterize(v, f, grey, color, depth, world_to_camera, np.radians(scene.fov), scene.near,
                                             scene.far)
        return {"color": color, "depth": depth}
    return draw
