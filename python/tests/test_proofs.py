# SPDX-License-Identifier: BSD-3-Clause
"""Long tests, with RASTRUM_FULL=1: meshes of ten million triangles are not copied, 10,000 frames leave nothing."""

import os
import pathlib
import subprocess
import sys

import numpy as np
import pytest

import rastrum as rr

pytestmark = pytest.mark.skipif(os.environ.get("RASTRUM_FULL") != "1", reason="only with RASTRUM_FULL=1")
MIB = 1 << 20

# In a process of its own: what it draws must be small beside what it has.
LARGE = """
import pathlib, sys
import numpy as np, rastrum as rr

def memory(name):
    return next(int(line.split()[1]) * 1024 for line in open("/proc/self/status") if line.startswith(name))

floats, integers, n = np.dtype(sys.argv[1]), np.dtype(sys.argv[2]), 2237  # 10,008,338 triangles
vertices = np.empty((n + 1, n + 1, 3), floats)
vertices[..., 0], vertices[..., 1], vertices[..., 2] = np.arange(n + 1)[None, :] / n, np.arange(n + 1)[:, None] / n, 0
vertices = vertices.reshape(-1, 3)
triangles = np.empty((n, n, 2, 3), integers)
a = np.arange(n)[:, None] * (n + 1) + np.arange(n)
for k, by in enumerate((0, 1, n + 2)):
    triangles[:, :, 0, k] = a + by
for k, by in enumerate((0, n + 2, n + 1)):
    triangles[:, :, 1, k] = a + by
triangles = triangles.reshape(-1, 3)
del a
renderer = rr.Renderer(threads=1, memory_limit=16 << 20)
camera = rr.Camera.look_at((0.5, 0.5, 0.9), (0.5, 0.5, 0))
renderer.render(rr.Mesh(vertices[:3], triangles[:0]), camera, size=(320, 240), outputs="id")
pathlib.Path("/proc/self/clear_refs").write_text("5")
before = memory("VmRSS")
picture = renderer.render(rr.Mesh(vertices, triangles, copy=False), camera, size=(320, 240), outputs="id")
print(memory("VmHWM") - before, min(vertices.nbytes, triangles.nbytes), len(triangles), (picture.id >= 0).sum(), rr.digest(picture.id))
"""


def test_ten_million_triangles_take_no_second_place():
    digests = {}
    for floats in ("float32", "float64"):
        for integers in ("int32", "uint32", "int64", "uint64"):
            done = subprocess.run([sys.executable, "-c", LARGE, floats, integers], capture_output=True, text=True)
            assert done.returncode == 0, done.stderr
            grown, least, count, seen, digest = done.stdout.split()
            assert int(count) > 10_000_000 and int(seen) > 50_000
            print(f"{floats} {integers}: {int(grown) / MIB:.1f} MiB more, the smaller array has {int(least) / MIB:.0f}")
            assert int(grown) < 20 * MIB < int(least)
            digests.setdefault(floats, set()).add(digest)
    assert all(len(d) == 1 for d in digests.values())  # the same for each type of integers


def memory():
    return next(int(line.split()[1]) for line in pathlib.Path("/proc/self/status").read_text().splitlines() if line.startswith("VmRSS"))


def test_ten_thousand_frames_grow_nothing(sheet):
    renderer = rr.Renderer(threads=2)
    scene = rr.as_scene(sheet)

    def draw(i):
        if i % 4 == 0:
            renderer.render(sheet, size=(32, 24), samples=4)
        elif i % 4 == 1:
            renderer.render(scene, size=(320, 240), outputs=("color", "depth", "id"))
        elif i % 4 == 2:
            renderer.render(scene, size=(32, 24), annotate=("occlusion", "edges", "axes"), lights="studio")
        else:
            renderer.render([rr.Mesh(*sheet, opacity=0.5), rr.Spheres([[0, 0, 0]])], rr.orbit(scene, 2), size=(16, 12))
    for i in range(400):
        draw(i)
    before = memory()
    for i in range(10_000):
        draw(i)
    assert memory() - before < 2048
