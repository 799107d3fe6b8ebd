# SPDX-License-Identifier: BSD-3-Clause
"""The scene of all contenders: a wavy ball of about a given number of triangles, and its camera."""
import dataclasses
import math

import numpy as np


@dataclasses.dataclass
class Scene:
    vertices: np.ndarray  # (N, 3) float64
    faces: np.ndarray  # (M, 3) int64
    eye: np.ndarray
    target: np.ndarray
    fov: float  # degrees, in both directions: pictures are square
    size: int
    near: float = 0.5
    far: float = 10.0


def ball(triangles):
    """Returns a closed ball of rings and segments with bumps, counter-clockwise from outside."""
    rings = max(4, round(math.sqrt(triangles / 4)))
    segments = 2 * rings
    polar = np.linspace(0, np.pi, rings + 1)[:, None]
    around = np.linspace(0, 2 * np.pi, segments, endpoint=False)[None, :]
    r = 1 + 0.08 * np.sin(9 * polar) * np.cos(7 * around)
    v = np.stack([r * np.sin(polar) * np.cos(around), r * np.cos(polar) + 0 * around, -r * np.sin(polar) * np.sin(around)], -1)
    i, j = np.meshgrid(np.arange(rings), np.arange(segments), indexing="ij")
    a, b = i * segments + j, i * segments + (j + 1) % segments
    c, d = a + segments, b + segments
    faces = np.concatenate([np.stack([a, c, b], -1).reshape(-1, 3), np.stack([b, c, d], -1).reshape(-1, 3)])
    return v.reshape(-1, 3), faces.astype(np.int64)


def scene(triangles, size):
    v, f = ball(triangles)
    return Scene(v, f, np.array([0.0, 0.0, 3.2]), np.zeros(3), 45.0, size)


def ring(n):
    """Returns (n, 4, 4) camera-to-world matrices of OpenGL, around the y axis."""
    poses = np.tile(np.eye(4), (n, 1, 1))
    a = 2 * np.pi * np.arange(n) / n
    poses[:, 0, 0] = poses[:, 2, 2] = np.cos(a)
    poses[:, 0, 2], poses[:, 2, 0] = np.sin(a), -np.sin(a)
    poses[:, 0, 3], poses[:, 2, 3] = 3.2 * np.sin(a), 3.2 * np.cos(a)
    return poses


def projection(scene):
    """Returns OpenGL's projection matrix."""
    f, n, far = 1 / math.tan(math.radians(scene.fov) / 2), scene.near, scene.far
    return np.array([[f, 0, 0, 0], [0, f, 0, 0], [0, 0, (far + n) / (n - far), 2 * far * n / (n - far)], [0, 0, -1, 0]])
