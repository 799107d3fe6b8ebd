# SPDX-License-Identifier: BSD-3-Clause
"""Draws a picture with five lines of rastrum in a root that has only Python (./dev bare), and prints what was loaded.

usage: bare_picture.py [MESH]
"""
import sys
import time

begin = time.perf_counter()
import numpy as np  # noqa: E402
import rastrum as rr  # noqa: E402

a, b = np.meshgrid(np.linspace(0, 2 * np.pi, 97), np.linspace(0, np.pi, 49))
ball = np.stack([np.cos(a) * np.sin(b), np.cos(b), np.sin(a) * np.sin(b)], -1).reshape(-1, 3)
i = (np.arange(48)[:, None] * 97 + np.arange(96)).reshape(-1)
what = sys.argv[1] if len(sys.argv) > 1 else (ball, np.stack([i, i + 1, i + 98, i + 97], -1))
picture = rr.render(what, rr.Camera.fit(what, "iso", fov=30), size=(1024, 1024), lights="studio", outputs=("color", "id")).save("/bare.png")
assert (picture.id >= 0).mean() > 0.2
print(f"{time.perf_counter() - begin:.2f} s, Python {sys.version.split()[0]}, digest {rr.digest(picture.color)}")
libraries = {line.split()[-1] for line in open("/proc/self/maps") if ".so" in line}
print("of the system:", ", ".join(sorted(f.rpartition("/")[2] for f in libraries if not f.startswith("/site"))))
