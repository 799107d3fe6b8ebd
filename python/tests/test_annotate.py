# SPDX-License-Identifier: BSD-3-Clause
"""Words, axes and effects in the call that draws: the colours alone change, and as the program draws them."""

import os
import subprocess

import numpy as np
import pytest

import rastrum as rr

SIZE = (160, 120)
ALL = ("occlusion", "edl", "silhouettes", "edges", "axes", "bounds", "title", "captions")


@pytest.fixture
def box():
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], np.float32)
    faces = np.array([(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
    triangles = np.concatenate([faces[:, (0, 1, 2)], faces[:, (0, 2, 3)]])
    floor = np.float32([(-3, -1, -3), (3, -1, -3), (3, -1, 3), (-3, -1, 3)])
    return rr.Scene([rr.Mesh(corners, triangles), rr.Mesh(floor, [(0, 2, 1), (0, 3, 2)])])


def wanted(name):
    return {"title": {"title": "α = 3°"}, "captions": {"captions": ["one", "two"]}}.get(name, (name,))


@pytest.mark.parametrize("name", ALL)
def test_colours_alone_change(box, name):
    camera = rr.Camera.look_at((3, 2.5, 5), near=0.1)
    outputs = ("color", "color_f32", "depth", "id", "camera_normal")
    plain = rr.render(box, camera, size=SIZE, outputs=outputs, background="white")
    noted = rr.render(box, camera, size=SIZE, outputs=outputs, background="white", annotate=wanted(name))
    for output in outputs:
        same = np.array_equal(plain.arrays[output].view(np.uint8), noted.arrays[output].view(np.uint8))
        assert same == (not output.startswith("color")), output
    # Outputs that effects need and nobody asked for are drawn without being kept. Threads, and several pictures at
    # once, change nothing.
    alone = rr.render(box, camera, size=SIZE, background="white", annotate=wanted(name), threads=3)
    assert np.array_equal(alone.color, noted.color)
    many = rr.render(box, [camera] * 3, size=SIZE, background="white", annotate=wanted(name), threads=2)
    assert (many.color == noted.color).all()


def test_options_mean_something(box):
    camera = rr.Camera.look_at((3, 2.5, 5), near=0.1)

    def drawn(**annotate):
        return rr.digest(rr.render(box, camera, size=SIZE, annotate=annotate).color)
    pictures = [drawn(occlusion=True), drawn(occlusion={"radius": 0.5}), drawn(occlusion={"strength": 3}), drawn(edl=True),
                drawn(edl={"strength": 0.3}), drawn(edges=True), drawn(edges={"angle": 30}), drawn(edges={"width": 3}),
                drawn(title="a"), drawn(title="a", text_scale=2), drawn(captions="a"), drawn(axes=False)]
    assert len(set(pictures)) == len(pictures)
    assert drawn(axes=False, title="") == drawn() == rr.digest(rr.render(box, camera, size=SIZE).color)
    # Numbers beside the box have room where nobody said where the eye is.
    assert (rr.render(box, size=SIZE, annotate="bounds", outputs=("color", "id")).id >= 0).sum() < (
        rr.render(box, size=SIZE, outputs="id").id >= 0).sum() * 0.6


@pytest.mark.skipif("RASTRUM_PROGRAM" not in os.environ, reason="the program was not built")
def test_the_program_draws_the_same(tmp_path):
    file = tmp_path / "b.obj"
    file.write_text("v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
    said = subprocess.run(
        [os.environ["RASTRUM_PROGRAM"], "render", "--look", "plain", str(file), "--size", "160x120", "--eye", "3,2,5", "--target", "0,0,0",
         "--fov", "60", "--shader", "phong", "--occlusion", "--edl", "--silhouettes", "--edges", "--edge-angle", "20", "--axes",
         "--title", "T", "--caption", "c", "-o", str(tmp_path / "p.png")], capture_output=True, text=True, check=False)
    assert said.returncode == 0, said.stderr
    assert np.array(rr._rastrum.read_image(str(tmp_path / "p.png"))).shape == (120, 160, 4)
    # The planes of the two cameras differ, and so does what depends on the bits of depth: shares of 255.
    camera = rr.Camera.look_at((3, 2, 5), fov=60, near=0.5)
    annotate = {"occlusion": True, "edl": True, "silhouettes": True, "edges": {"angle": 20}, "axes": True, "title": "T",
                "captions": ["c"]}
    mine = rr.render(rr.load(file), camera, size=(160, 120), shader="phong", annotate=annotate).color.astype(int)
    theirs = np.array(rr._rastrum.read_image(str(tmp_path / "p.png"))).astype(int)
    assert (abs(mine - theirs).max(axis=2) > 2).mean() < 0.01


@pytest.mark.parametrize("annotate, says", [
    ("shadow", "there is no 'shadow'"),
    ({"occlusion": {"size": 2}}, "no option 'size'"),
    ({"occlusion": {"radius": -1}}, "radius"),
    ({"occlusion": {"radius": 0}}, "radius"),
    ({"occlusion": {"radius": float("nan")}}, "radius"),
    ({"occlusion": {"radius": 1e-38}}, "radius.*1e-37"),
    ({"occlusion": {"radius": 1e-36}}, "radius must be at least 1e-30 of"),
    ({"edl": {"strength": float("nan")}}, "strength"),
    ({"title": "a\ud800b"}, "surrogate"),
    ({"edges": {"angle": 181}}, "angle"),
    ({"edges": {"width": "wide"}}, "width"),
    ({"edges": 3}, "True or a dict"),
    ({"title": 3}, "must be strings"),
    ({"captions": list("abcde")}, "four captions"),
    ({"title": "a", "text_scale": 0}, "text_scale"),
])
def test_what_cannot_be_meant_is_named(box, annotate, says):
    with pytest.raises(rr.Error, match=says):
        rr.render(box, size=SIZE, annotate=annotate)


def test_without_colours_there_is_nothing_to_draw_into(box):
    with pytest.raises(rr.ArgumentError, match="color"):
        rr.render(box, size=SIZE, outputs="depth", annotate="axes")
