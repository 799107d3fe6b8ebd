# SPDX-License-Identifier: BSD-3-Clause
"""Lights."""

import os
import subprocess

import numpy as np
import pytest

import rastrum as rr

SIZE = (120, 90)


def draw(lights, camera=None, shader="lambert", **more):
    return rr.render(rr.Spheres([[0.0, 0, 0]], 1.0, color="white"), camera or rr.Camera.look_at((0, 0, 3)), size=SIZE,
                     shader=shader, lights=lights, **more).color.astype(int)


def test_they_light_from_where_they_are():
    left, right = draw(rr.Light.directional((1, 0, 0))), draw(rr.Light.directional((-1, 0, 0)))
    assert left[:, :50].sum() > 2 * left[:, 70:].sum() and right[:, 70:].sum() > 2 * right[:, :50].sum()
    assert np.abs(left[:, ::-1] - right).max() <= 1
    even = draw(rr.Light.ambient(color="#808080"))
    seen = even[even[..., 3] == 255][:, 0]
    assert seen.max() == seen.min() > 0
    assert (draw("default") == draw(None)).all() and (draw("headlight") != draw(None)).any()
    both = draw([rr.Light.ambient(intensity=0.2), rr.Light.point((0, 2, 2), intensity=3, range=50)])
    assert (both != even).any()
    lamp = rr.Light.spot((0, 0, 3), (0, 0, -1), inner=5, outer=10, intensity=9)
    spot = draw(lamp)
    assert spot[45, 60, 0] > 100 and spot[45, 30, 0] == 0


def test_lights_of_the_camera_move_with_it():
    light = rr.Light.directional((1, 0, -1), of_camera=True)
    assert np.abs(draw(light) - draw(light, rr.Camera.look_at((3, 0, 0)))).max() <= 1


def test_environments(tmp_path):
    white = rr.Light.environment(np.full((64, 128, 3), 0.4))
    assert np.abs(draw(white) - draw(rr.Light.ambient(intensity=0.4))).max() <= 1
    room = rr.Light.environment("room", intensity=0.5)
    behind = draw(room, shader="material", environment_behind=True)
    alone = draw(room, shader="material")
    assert (behind[..., 3] == 255).all() and (alone[0, 0] == 0).all()
    assert (behind[alone[..., 3] == 255] == alone[alone[..., 3] == 255]).all()
    # A red half on the right, then turned to the left.
    halves = np.zeros((32, 64, 3), np.float32)
    halves[:, 32:, 0] = 1
    right = draw(rr.Light.environment(halves))
    left = draw(rr.Light.environment(halves[:, ::-1]))
    turned = draw(rr.Light.environment(halves, turn=180))
    assert right[45, 80, 0] > right[45, 40, 0] + 50 and np.abs(left - turned).max() <= 2
    for bad, error in (("none.hdr", rr.NotFoundError), (np.zeros((4, 4, 3)), ValueError), (np.zeros((4, 8)), ValueError),
                       (np.full((4, 8, 3), -1.0), ValueError), (np.full((4, 8, 3), np.nan), ValueError)):
        with pytest.raises(error):
            rr.Light.environment(bad)
    (tmp_path / "a.hdr").write_bytes(b"#?RADIANCE\n\n-Y 2 +X 8\n12")
    with pytest.raises(rr.FormatError, match="a.hdr"):
        rr.Light.environment(tmp_path / "a.hdr")
    with pytest.raises(rr.Error, match="no environment"):
        draw("headlight", environment_behind=True)


def test_shadows():
    floor = rr.Mesh(np.array([[-3, 0, -3], [3, 0, -3], [3, 0, 3], [-3, 0, 3]], np.float32), [[0, 2, 1], [0, 3, 2]])
    things = [floor, rr.Spheres([[0.0, 1, 0]], 0.5)]
    camera, light = rr.Camera.look_at((0, 4, 4)), rr.Light.directional((0, -1, 0.01))
    lit = rr.render(things, camera, size=SIZE, shader="lambert", lights=light, outputs=("color", "instance"))
    dark = rr.render(things, camera, size=SIZE, shader="lambert", lights=light, shadows=True)
    changed = (lit.color != dark.color).any(-1)
    assert 50 < changed.sum() < 0.3 * changed.size
    assert (dark.color.astype(int)[changed] <= lit.color.astype(int)[changed]).all()


def test_tone():
    material = rr.Material("white")
    things = rr.Spheres([[0.0, 0, 0]], 1.0, material=material)

    def toned(**more):
        return rr.render(things, size=SIZE, shader="material", lights=rr.Light.directional((0, 0, -1), intensity=8), **more).color
    middle = {tone: int(toned(tone=tone)[45, 60, 1]) for tone in ("none", "reinhard", "aces", "neutral")}
    assert middle["none"] == 255 and 200 < middle["reinhard"] < 255 and middle["reinhard"] < middle["aces"]
    assert (toned(exposure=-8.0)[45, 60] < 60)[:3].all()
    for bad in (dict(tone="loud"), dict(exposure=float("nan")), dict(exposure=99)):
        with pytest.raises(rr.Error):
            toned(**bad)
    with pytest.raises(rr.Error, match="material"):
        draw(None, tone="aces")


def test_the_program_draws_the_same(sheet, obj):
    program = os.environ.get("RASTRUM_PROGRAM")
    if not program:
        pytest.skip("RASTRUM_PROGRAM does not name the program")
    said = subprocess.run([program, "render", "--look", "plain", str(obj), "--lights", "studio", "--size", "120x90", "--normals", "face", "--hash",
                           "--quiet"], capture_output=True, text=True, check=True).stdout
    assert said.split()[0] == rr.digest(rr.render(rr.load(obj, crease=None), size=SIZE, lights="studio").color)
    # The program alone draws the picture to show.
    said = subprocess.run([program, "render", str(obj), "--size", "120x90", "--normals", "face", "--hash", "--quiet"],
                          check=True, capture_output=True, text=True).stdout
    part = rr.load(obj, crease=None)
    shown = rr.render(part, rr.Camera.fit(part, "iso", fov=30), size=SIZE, lights="studio", samples=4, annotate="occlusion")
    assert said.split()[0] == rr.digest(shown.color)


@pytest.mark.parametrize("bad", [
    lambda: rr.Light("lamp"), lambda: rr.Light.ambient(intensity=-1), lambda: rr.Light.ambient(intensity=float("nan")),
    lambda: rr.Light.directional((0, 0, 0)), lambda: rr.Light.directional((0, 0)), lambda: rr.Light.point((0, 0, float("inf"))),
    lambda: rr.Light.spot((0, 0, 0), (0, 0, 1), inner=50, outer=40), lambda: rr.Light.point((0, 0, 0), range=-1),
    lambda: rr.Light.ambient(color="none"), lambda: draw("lamp"), lambda: draw([3]), lambda: draw([None])])
def test_bad_lights(bad):
    with pytest.raises(rr.Error):
        bad()


def test_lights_of_files_are_asked_for_by_name():
    with pytest.raises(rr.ArgumentError, match="no lights of their own"):
        draw("file")
