#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compares rastrum.compat.mujoco with mujoco.Renderer by EGL: first the pictures, then the times, in turns.

usage: mujoco_pictures.py [--only MODEL…] [--seconds S] [--threads N] [--out DIR] [--batch]

Needs mujoco, dm_control, gymnasium-robotics and pillow (PyPI), and libegl1 and libgl1-mesa-dri. Pictures go to out/mujoco, MuJoCo's on
the left. CPU time is that of all threads of this process, of llvmpipe's too.
"""
import argparse
import importlib.util
import os
import pathlib
import statistics
import time

os.environ.setdefault("MUJOCO_GL", "egl")

import mujoco  # noqa: E402
import numpy as np  # noqa: E402
from PIL import Image  # noqa: E402

from rastrum.compat.mujoco import Renderer  # noqa: E402

SUITE = ("humanoid", "quadruped", "cheetah", "walker", "hopper", "manipulator", "dog")
ROBOTICS = {"fetch": "fetch/pick_and_place.xml", "hand": "hand/manipulate_block.xml", "kitchen": "kitchen_franka/kitchen_assets/kitchen_env_model.xml"}
SIZES = ((84, 84), (256, 256), (640, 480))
SHADOW, REFLECTION = mujoco.mjtRndFlag.mjRND_SHADOW, mujoco.mjtRndFlag.mjRND_REFLECTION


def folder_of(package):
    return pathlib.Path(importlib.util.find_spec(package).origin).parent


def load(name):
    """(model, data, camera) after some steps."""
    if name in ROBOTICS:
        model, camera = mujoco.MjModel.from_xml_path(str(folder_of("gymnasium_robotics") / "envs" / "assets" / ROBOTICS[name])), -1
    elif name == "dog":
        from dm_control.suite import dog
        model, camera = mujoco.MjModel.from_xml_string(*dog.get_model_and_assets(10, False)), 0
    else:
        from dm_control.suite import common
        model, camera = mujoco.MjModel.from_xml_string((folder_of("dm_control") / "suite" / f"{name}.xml").read_text(), common.ASSETS), 0
    data = mujoco.MjData(model)
    for _ in range(20):
        mujoco.mj_step(model, data)
    mujoco.mj_forward(model, data)
    model.vis.global_.offwidth, model.vis.global_.offheight = max(model.vis.global_.offwidth, 640), max(model.vis.global_.offheight, 480)
    return model, data, camera if model.ncam else -1


class Drawn:
    """One kind of picture by one renderer."""

    def __init__(self, renderer, data, camera, kind):
        self.renderer, self.data, self.camera, self.kind = renderer, data, camera, kind

    def __call__(self):
        renderer = self.renderer
        renderer.disable_depth_rendering()
        renderer.disable_segmentation_rendering()
        if self.kind == "depth":
            renderer.enable_depth_rendering()
        if self.kind == "segmentation":
            renderer.enable_segmentation_rendering()
        renderer.update_scene(self.data, self.camera)
        if self.kind == "rgb, no shadow":
            renderer.scene.flags[SHADOW] = renderer.scene.flags[REFLECTION] = 0
        else:
            renderer.scene.flags[SHADOW] = renderer.scene.flags[REFLECTION] = 1
        return renderer.render()


def in_turns(draws, seconds):
    """The median CPU and wall milliseconds of each of `draws`, which take turns."""
    times = [[] for _ in draws]
    end = time.perf_counter() + seconds
    while len(times[0]) < 3 or time.perf_counter() < end:
        for draw, own in zip(draws, times):
            cpu, wall = time.process_time(), time.perf_counter()
            draw()
            own.append((1e3 * (time.process_time() - cpu), 1e3 * (time.perf_counter() - wall)))
    return [tuple(statistics.median(column) for column in zip(*own)) for own in times]


def compared(name, out):
    """The pictures of 640 x 480 with MuJoCo's samples off, which blends edges that ours would have to guess."""
    model, data, camera = load(name)
    model.vis.quality.offsamples = 0
    ours, theirs = (make(model, 480, 640) for make in (Renderer, mujoco.Renderer))
    pictures = {kind: [Drawn(r, data, camera, kind)().copy() for r in (theirs, ours)] for kind in ("rgb", "depth", "segmentation")}
    theirs.close()
    same = (pictures["segmentation"][0] == pictures["segmentation"][1]).all(-1)
    near = same & (pictures["segmentation"][0][..., 0] >= 0)
    a, b = pictures["depth"]
    off = np.median(np.abs(a - b)[near] / a[near])
    error = np.square(pictures["rgb"][0].astype(float) - pictures["rgb"][1]).mean()
    Image.fromarray(np.concatenate(pictures["rgb"], 1)).save(out / f"{name}.png")
    print(f"| {name} | {100 * same.mean():.3f} % | {off:.1e} | {10 * np.log10(255 ** 2 / max(error, 1e-9)):.1f} dB | {'; '.join(ours.left_out)} |", flush=True)


def timed(name, threads, seconds):
    ratios = {}
    for width, height in SIZES:
        model, data, camera = load(name)
        ours, theirs = Renderer(model, height, width, threads=threads), mujoco.Renderer(model, height, width)
        row = []
        for kind in ("rgb", "rgb, no shadow", "depth", "segmentation"):
            draws = [Drawn(r, data, camera, kind) for r in (theirs, ours)]
            (mj_cpu, _), (our_cpu, our_wall) = in_turns(draws, seconds)
            ratios[kind, width] = mj_cpu / our_cpu
            row.append(f"{mj_cpu:.1f} → {our_cpu:.2f} ({mj_cpu / our_cpu:.1f} ×)")
        theirs.close()
        print(f"| {name} | {width} x {height} | {' | '.join(row)} |", flush=True)
    return ratios


def batch(threads):
    """Frames a second of 64 humanoids at 84 x 84, all three outputs."""
    model, data, camera = load("humanoid")
    model.vis.quality.offsamples = 0
    random = np.random.default_rng(0)
    states = []
    for _ in range(64):
        state = mujoco.MjData(model)
        state.qpos[:] = data.qpos + 0.02 * random.normal(size=model.nq)
        mujoco.mj_forward(model, state)
        states.append(state)
    ours = Renderer(model, 84, 84, threads=threads)

    ours.scene.flags[SHADOW] = ours.scene.flags[REFLECTION] = 0

    def draw():
        ours.render_batch(states, camera)

    (cpu, wall), = in_turns([draw], 5)
    print(f"\n64 humanoids, 84 x 84, colours without shadows, depth and segmentation: {64e3 / wall:.0f} frames/s, {64e3 / cpu:.0f} for each second of CPU")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", nargs="+", default=[*SUITE, *ROBOTICS])
    parser.add_argument("--seconds", type=float, default=2, help="for each row and kind (2)")
    parser.add_argument("--threads", type=int, default=None)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/mujoco"))
    parser.add_argument("--batch", action="store_true", help="only 64 humanoids")
    o = parser.parse_args()
    if o.batch:
        return batch(o.threads)
    o.out.mkdir(parents=True, exist_ok=True)
    print("| model | equal segmentation | depth, median relative | colours | not drawn |\n|---|---|---|---|---|")
    for name in o.only:
        compared(name, o.out)
    print("\nCPU ms a frame, MuJoCo (EGL) → Rastrum\n\n| model | size | rgb | rgb without shadows and mirrors | depth | segmentation |\n|---|---|---|---|---|---|")
    all_ratios = [timed(name, o.threads, o.seconds) for name in o.only]
    print()
    for kind, width in all_ratios[0]:
        print(f"{kind}, {width} wide: median {statistics.median(r[kind, width] for r in all_ratios):.1f} ×")


if __name__ == "__main__":
    main()
