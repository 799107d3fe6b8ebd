#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the six pictures at the top of README.md. It generates all that they show, so it needs only the package.

    python3 tools/front_picture.py [-o docs/images/front.png]
"""
import argparse

import numpy as np
import rastrum as rr

SIZE = (520, 380)
LOOK = dict(size=SIZE, background="white", lights="studio", samples=8)


def extruded(inner, outer, thickness, steps=1440):
    """Returns the solid between two outlines, radii over the angle, as (vertices, faces)."""
    angle = np.arange(steps) * (2 * np.pi / steps)
    radius = np.stack([outer(angle), outer(angle), inner(angle), inner(angle)], 1)
    z = np.broadcast_to(np.array([-1, 1, -1, 1]) * thickness / 2, radius.shape)
    ring = np.stack([radius * np.cos(angle)[:, None], radius * np.sin(angle)[:, None], z], -1)
    a = 4 * np.arange(steps)[:, None]
    b = np.roll(a, -1, 0)
    faces = [np.hstack(q) for q in ((a, b, b + 1, a + 1), (b + 2, a + 2, a + 3, b + 3),
                                    (a + 1, b + 1, b + 3, a + 3), (b, a, a + 2, b + 2))]
    return ring.reshape(-1, 3), np.concatenate(faces)


def gear(teeth, module=0.05):
    return lambda angle: module * (teeth / 2 + 0.9 * np.clip(2 * np.cos(teeth * angle), -1, 1))


def circle(radius):
    return lambda angle: np.full_like(angle, radius)


def placed(shape, x, y, turn, **look):
    c, s = np.cos(turn), np.sin(turn)
    to_world = np.array([[c, -s, 0, x], [s, c, 0, y], [0, 0, 1, 0], [0, 0, 0, 1]])
    v, f = shape
    return rr.Mesh(v, f, normals=rr.crease_normals(v, f, 35), transform=to_world, **look)


def assembly():
    """A planetary gear in a translucent housing."""
    sun, planet = 16, 14
    far = 0.05 * (sun + planet) / 2
    wheel = extruded(circle(0.1), gear(planet), 0.45)
    things = [placed(extruded(circle(0.12), gear(sun), 0.5), 0, 0, 0, color="#e0a030"),
              placed(extruded(circle(0.0001), circle(0.119), 2.2), 0, 0, 0, color="#8a929c"),
              placed(extruded(gear(sun + 2 * planet), circle(1.26), 0.5), 0, 0, 0, color="#5a8fd0", opacity=0.35),
              placed(extruded(circle(0.3), circle(1.36), 0.1), 0, 0, 0, color="#7ac0a0", opacity=0.3)]
    for k in range(3):
        at = k * 2 * np.pi / 3
        turn = at + np.pi / planet + at * sun / planet
        things.append(placed(wheel, far * np.cos(at), far * np.sin(at), turn, color="#c05848"))
        things.append(placed(extruded(circle(0.0001), circle(0.099), 0.9), far * np.cos(at), far * np.sin(at), 0, color="#8a929c"))
    camera = rr.Camera.fit(things, (-0.5, 0.55, -0.9), up=(0, 1, 0), fov=30)
    return rr.render(things, camera, annotate="occlusion", **LOOK)


def molecule():
    """A double helix: backbones as tubes, atoms as spheres, pairs as cylinders, without a mesh."""
    t = np.linspace(0, 5.2 * np.pi, 520)
    strands = [np.stack([2.1 * np.cos(t + p), t * 0.72, 2.1 * np.sin(t + p)], 1) for p in (0, 2.5)]
    backbone = rr.Tubes(np.concatenate(strands), [0, 520, 1040], 0.30, color="#6f8fb5")
    k = np.arange(6, 520, 20)
    a, b = strands[0][k], strands[1][k]
    n = len(k)
    i = np.arange(n)
    kinds = np.array([[0.85, 0.28, 0.22], [0.25, 0.65, 0.40], [0.95, 0.70, 0.20], [0.45, 0.42, 0.78]])
    base = np.random.default_rng(3).integers(0, 4, n)
    colors = kinds[np.concatenate([base, base ^ 1, base, base ^ 1])]
    middle = (a + b) / 2
    pairs = np.concatenate([np.stack([i, i + 2 * n], 1), np.stack([i + n, i + 3 * n], 1)])
    bonds = rr.Cylinders(np.concatenate([a, b, middle, middle]), pairs, 0.2, colors=colors)
    atoms = rr.Spheres(np.concatenate([a, b]), 0.42, color="#e8e4da")
    things = [backbone, bonds, atoms]
    camera = rr.Camera.fit(things, (-0.35, -0.1, -1), up=(0.62, 0.78, 0), fov=30)
    return rr.render(things, camera, annotate={"occlusion": {"radius": 1.0}, "silhouettes": True}, **LOOK)


def scalars():
    """A swinging plate, coloured by its displacement."""
    x, y = np.meshgrid(np.linspace(0, 3, 241), np.linspace(0, 2, 161))
    w = np.sin(np.pi * x) * np.sin(np.pi * y)
    v = np.stack([x, y, 0.24 * w], -1).reshape(-1, 3)
    i = (np.arange(160)[:, None] * 241 + np.arange(240)).reshape(-1)
    f = np.stack([i, i + 1, i + 242, i + 241], -1)
    colors = rr.ColorMapping("coolwarm", isolines=9, clim=(-1, 1))
    plate = rr.Mesh(v, f, normals=rr.crease_normals(v, f, 180), scalars=w.reshape(-1), per="vertex", cmap=colors)
    camera = rr.Camera.look_at((0.1, -3.3, 3.4), (1.86, 0.92, 0), up=(0, 0, 1), fov=30)
    return rr.render(plate, camera, annotate={"bar": {"title": "Deflection", "unit": "mm"}}, **LOOK)


def terrain():
    """A height map in the evening sun, without triangles."""
    n = 1024
    u = np.fft.fftfreq(n)
    k = np.hypot(u[:, None], u[None, :])
    k[0, 0] = 1
    noise = np.fft.ifft2(np.fft.fft2(np.random.default_rng(11).normal(size=(n, n))) * k**-2.3).real
    noise = (noise - noise.min()) / np.ptp(noise)
    heights = (np.maximum(noise, 0.38) ** 2 * 230).astype(np.float32)
    grass, rock, snow, water = ([96, 112, 62], [128, 112, 96], [236, 238, 242], [52, 92, 128])
    at = np.clip((noise - 0.42) / 0.42, 0, 1)[..., None]
    colors = np.where(at < 0.5, np.add(grass, (np.subtract(rock, grass)) * at * 2), np.add(rock, np.subtract(snow, rock) * (at * 2 - 1)))
    colors = np.where(noise[..., None] <= 0.38, water, colors).astype(np.uint8)
    ground = rr.Terrain(heights, colors, sun=(125, 22), shadows="soft")
    return ground.render((880, 690), altitude=112, angle=78, horizon=170, size=SIZE, distance=1400, sky="#b9cfe4", fog=(0.0015, 350, "#b9cfe4"))


def depth_and_masks():
    """One frame's picture, depth and masks."""
    rng = np.random.default_rng(5)
    wheel = extruded(circle(0.35), gear(32), 0.35, 720)
    t = np.linspace(0, 2 * np.pi, 400)
    knot = 0.3 * np.stack([np.cos(2 * t) * (2 + np.cos(3 * t)), np.sin(2 * t) * (2 + np.cos(3 * t)), np.sin(3 * t)], 1)
    things = []
    for k in range(28):
        at = np.array([k % 7 - 3, k // 7 - 1.5, 0]) * [1.25, 1.2, 1] + rng.uniform(-0.35, 0.35, 3) * [1, 1, 6]
        axes, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        to_world = np.eye(4)
        to_world[:3, :3], to_world[:3, 3] = axes * np.sign(np.linalg.det(axes)) * 0.75, at
        thing = (rr.Mesh(*wheel, normals=rr.crease_normals(*wheel, 35)), rr.Tubes(knot, radius=0.16), rr.Spheres([[0, 0, 0]], 0.7))[k % 3]
        thing.transform, thing.id = to_world, k
        things.append(thing)
    camera = rr.Camera.look_at((0, 0, 13.5), fov=25)
    p = rr.render(things, camera, outputs=("color", "depth", "instance"), size=SIZE, background="white", lights="studio")
    h, w = p.depth.shape
    seen = p.depth > 0
    near, far = p.depth[seen].min(), p.depth[seen].max()
    grey = np.where(seen, 235 - 200 * (p.depth - near) / (far - near), 255).astype(np.uint8)
    tints = np.array([[228, 87, 86], [245, 176, 65], [82, 165, 120], [76, 114, 176], [255, 255, 255]], np.uint8)
    third = np.arange(w) * 3 // w
    p.color[:, third == 1, :3] = grey[:, third == 1, None]
    p.color[:, third == 2, :3] = tints[np.where(p.instance < 0, -1, p.instance % 4)][:, third == 2]
    return p


def million():
    """A million triangles."""
    part = rr.load("builtin:gyroid?cells=187&periods=3")
    camera = rr.Camera.fit(part, "iso", fov=30)
    return rr.render(part, camera, annotate={"occlusion": {}}, **LOOK)


def front_picture():
    """Returns the six pictures, three in a row."""
    pictures = [assembly(), molecule(), scalars(), terrain(), depth_and_masks(), million()]
    width, height = SIZE
    sheet = rr.render([], rr.Camera.look_at((0, 0, 1)), size=(3 * width, 2 * height), background="white")
    for k, picture in enumerate(pictures):
        y, x = divmod(k, 3)
        sheet.color[y * height:(y + 1) * height, x * width:(x + 1) * width] = picture.color
    return sheet


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", default="docs/images/front.png")
    front_picture().save(parser.parse_args().output)
