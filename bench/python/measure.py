# SPDX-License-Identifier: BSD-3-Clause
"""Measures one contender and prints JSON. contest.py starts it in the contender's own environment.

usage: measure.py NAME SIZE TRIANGLES SECONDS PICTURE|-
"""
import importlib
import json
import pathlib
import resource
import sys
import time

begin = time.perf_counter()
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
name, size, triangles, seconds, picture = sys.argv[1:]
contender = importlib.import_module(f"contenders.{name}")
imported = time.perf_counter() - begin

import numpy as np  # noqa: E402  after the contender, whose import is timed

import model  # noqa: E402

scene = model.scene(int(triangles), int(size))
begin = time.perf_counter()
draw = contender.prepare(scene)
images = draw()
images_of = getattr(draw, "images", lambda: images)
first = time.perf_counter() - begin
times = []
end = time.perf_counter() + float(seconds)
while len(times) < 3 or time.perf_counter() < end and len(times) < 200:
    begin = time.perf_counter()
    draw()
    times.append(time.perf_counter() - begin)
maps = None
if hasattr(contender, "depth_maps") and float(seconds) > 0:
    maps = contender.depth_maps(model.scene(10_000, 128), model.ring(1000))
if picture != "-":
    np.savez_compressed(picture, **images_of())
print(json.dumps({"import_s": imported, "first_s": first, "frame_ms": 1e3 * float(np.median(times)), "frames": len(times),
                  "maps_s": maps, "peak_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024}))
