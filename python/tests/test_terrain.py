# SPDX-License-Identifier: BSD-3-Clause
"""Terrains: the program's picture bit for bit, and what is refused."""

import multiprocessing
import os
import pathlib
import subprocess

import numpy as np
import pytest

import rastrum as rr

SIZE = (160, 100)


@pytest.fixture(scope="module")
def heights():
    """A ridge and a hole, on 128 x 96 cells."""
    y, x = np.mgrid[0:96, 0:128]
    h = (np.abs((x * 7 + y * 3) % 61 - 30) / 3 + np.abs(x - 64) / 4).astype(np.float32)
    h[40:44, 60:66] = np.nan
    return h


def colors_of(heights):
    y, x = np.mgrid[0:heights.shape[0], 0:heights.shape[1]]
    return np.stack([x % 256, y % 256, (x ^ y) % 256], -1).astype(np.uint8)


@pytest.mark.parametrize("look, options, arguments", [
    ({}, {}, []),
    ({"sun": (120, 12), "shadows": "sharp"}, {"fov": 60, "fog": (0.002, 20)},
     ["--sun", "120,12", "--shadows", "sharp", "--fov", "60", "--fog", "0.002,20"]),
    ({"filter": "mip", "tiling": "mirror", "shadows": "soft"}, {"position": (30, 60), "altitude": 33, "angle": 200, "roll": 5},
     ["--filter", "mip", "--tile", "mirror", "--shadows", "soft", "--position", "30,60", "--altitude", "33", "--angle", "200",
      "--roll", "5"]),
    ({"filter": "none"}, {"projection": "cylindrical", "fov": 200, "sky": "#204060", "clearance": 2, "altitude": 0},
     ["--filter", "none", "--projection", "cylindrical", "--fov", "200", "--sky", "#204060", "--clearance", "2",
      "--altitude", "0"]),
    ({"lights": [rr.Light.ambient(intensity=0.2), rr.Light.directional((-1, -1, 0.4), intensity=0.8),
                 rr.Light.point((60, 40, 50), color="#ff8000", intensity=400)], "shadows": "sharp"},
     {"annotate": {"axes": True, "bounds": True, "title": "Ridge"}},
     ["--light", "ambient:intensity=0.2", "--light", "directional:-1,-1,0.4:intensity=0.8", "--light",
      "point:60,40,50:color=#ff8000:intensity=400", "--shadows", "sharp", "--axes", "--bounds", "--title", "Ridge"]),
    ({"lights": "headlight", "tone": "neutral", "exposure": 1}, {"angle": 40, "fog": 0.003, "clearance": 4, "altitude": 1},
     ["--lights", "headlight", "--tone", "neutral", "--exposure", "1", "--angle", "40", "--fog", "0.003", "--clearance", "4",
      "--altitude", "1"]),
    ({"lights": rr.Light.environment("room"), "tone": "aces"}, {"environment_behind": True, "fog": 0.003, "roll": 10},
     ["--light", "environment:room", "--tone", "aces", "--environment-behind", "--fog", "0.003", "--roll", "10"]),
])
@pytest.mark.parametrize("painted", [False, True])
def test_it_is_the_programs_picture(tmp_path, heights, look, options, arguments, painted):
    program = os.environ.get("RASTRUM_PROGRAM")
    if not program or not pathlib.Path(program).exists():
        pytest.skip("RASTRUM_PROGRAM does not name the program")
    np.save(tmp_path / "h.npy", heights)
    colors = None
    if painted:
        from PIL import Image
        colors = colors_of(heights)
        Image.fromarray(colors).save(tmp_path / "c.png")
        arguments = [*arguments, "--color", tmp_path / "c.png"]
    printed = subprocess.run([program, "terrain", "--height", tmp_path / "h.npy", "--height-scale", "1", "--size", "160x100",
                              "--depth", tmp_path / "d.npy", "-o", tmp_path / "o.png", "--hash", "--quiet", *arguments],
                             capture_output=True, text=True, check=True).stdout
    picture = rr.Terrain(heights, colors, **look).render(size=SIZE, depth=True, **options)
    depth = np.where(picture.depth == 0, np.float32(np.inf), picture.depth)
    assert rr.digest(picture.color) in printed and rr.digest(depth) in printed
    assert len(np.unique(picture.color.reshape(-1, 4), axis=0)) > 50


@pytest.mark.parametrize("scale", [1, 0.37])
@pytest.mark.parametrize("of_file", [False, True])
def test_heights_are_numbers_as_in_the_program(tmp_path, heights, of_file, scale):
    """Colours, range, bar and box in the unit of what was given."""
    program = os.environ.get("RASTRUM_PROGRAM")
    if not program or not pathlib.Path(program).exists():
        pytest.skip("RASTRUM_PROGRAM does not name the program")
    np.save(tmp_path / "h.npy", heights)
    mapping = rr.ColorMapping("plasma", (3, 20), steps=6, nan="red")
    terrain = rr.Terrain(tmp_path / "h.npy" if of_file else heights, height_scale=scale, cmap=mapping)
    notes = {"bar": {"title": "Height", "unit": "m", "nan": True}, "bounds": True, "axes": True, "captions": ["here"]}
    picture = terrain.render(size=SIZE, altitude=30, annotate=notes)
    printed = subprocess.run([program, "terrain", "--height", tmp_path / "h.npy", "--height-scale", str(scale), "--size",
                              "160x100", "--cmap", "plasma", "--range", "3,20", "--steps", "6", "--nan-color", "red", "--bar",
                              "Height", "--bar-unit", "m", "--bounds", "--axes", "--caption", "here", "--altitude", "30", "--hash",
                              "--quiet"], capture_output=True, text=True, check=True).stdout
    assert rr.digest(picture.color) in printed


def test_types_threads_and_views_are_the_same_bits(heights):
    expected = rr.Terrain(heights, threads=1).render(size=SIZE).color
    for same in (heights.astype(np.float64), np.asfortranarray(heights), heights[::-1][::-1]):
        assert (rr.Terrain(same, threads=2).render(size=SIZE).color == expected).all()


def test_what_it_says_of_itself(heights):
    terrain = rr.Terrain(heights, filter="none")
    assert terrain.heights == (np.nanmin(heights), np.nanmax(heights))
    assert terrain.ground_at(10.5, 20.5) == heights[20, 10] and np.isnan(terrain.ground_at(62, 42))
    picture = terrain.render(size=SIZE)
    assert not picture.arrays.keys() - {"color"} and picture.stats["samples"] > 0
    with pytest.raises(rr.UnsupportedError, match="^pick"):
        picture.pick(0, 0)


def test_later_changes_of_the_array_are_not_seen(heights):
    mine = heights.copy()
    terrain = rr.Terrain(mine)
    before = terrain.render(size=SIZE).color
    mine[:] = 0
    assert (terrain.render(size=SIZE).color == before).all()


def test_a_forked_child_draws_the_same(heights):
    terrain = rr.Terrain(heights, threads=2)
    here = rr.digest(terrain.render(size=SIZE).color)
    parent, child = multiprocessing.Pipe()

    def draw():
        child.send(rr.digest(terrain.render(size=SIZE).color))
    worker = multiprocessing.get_context("fork").Process(target=draw, daemon=True)
    worker.start()
    assert parent.poll(30) and parent.recv() == here
    worker.join(30)
    assert worker.exitcode == 0


@pytest.mark.parametrize("given, match", [
    ({"heights": np.zeros(4)}, "heights"), ({"heights": np.zeros((0, 4))}, "heights"),
    ({"heights": np.full((4, 4), np.nan)}, "heights"), ({"heights": np.zeros((4, 4), object)}, "heights"),
    ({"colors": np.zeros((4, 4), np.uint8)}, "colors"), ({"colors": np.zeros((0, 4, 3), np.uint8)}, "colors"),
    ({"colors": np.zeros((4, 4, 3))}, "colors"), ({"sun": (0, 91)}, "sun"), ({"sun": (np.nan, 10)}, "sun"),
    ({"shadows": "long"}, "shadows"), ({"filter": "cubic"}, "filter"), ({"tiling": 3}, "tiling"), ({"threads": 0}, "threads"),
    ({"lights": "moon"}, "lights"), ({"lights": "studio", "sun": (0, 20)}, "sun"), ({"tone": "aces"}, "tone"),
    ({"lights": "studio", "tone": "loud"}, "tone"), ({"lights": "studio", "exposure": np.inf}, "exposure"),
    ({"lights": [rr.Light.ambient()] * 257}, "257 lights"), ({"clim": (0, 1)}, "clim"), ({"cmap": "nope"}, "nope"),
    ({"cmap": "gray", "colors": np.zeros((4, 4, 3), np.uint8)}, "cmap"),
    ({"cmap": rr.ColorMapping("gray", isolines=[1])}, "isolines"), ({"cmap": "gray", "clim": (3, 1)}, "clim"),
])
def test_what_cannot_be_lit_is_named(heights, given, match):
    with pytest.raises(rr.Error, match=match):
        rr.Terrain(**{"heights": heights, **given})


@pytest.mark.parametrize("given", [
    {"size": (0, 4)}, {"distance": -1}, {"distance": np.inf}, {"fov": 180}, {"projection": "round"}, {"position": (np.nan, 1)},
    {"altitude": np.inf}, {"sky": "no colour"}, {"fog": (1, 2, "red", 3)}, {"fog": -1}, {"position": (1,)}, {"scale": -1}, {"environment_behind": True}, {"annotate": "edl"},
    {"annotate": {"bar": "Height"}}, {"annotate": "compass"}, {"annotate": "bounds", "projection": "cylindrical"},
])
def test_what_cannot_be_drawn_is_refused(heights, given):
    with pytest.raises(rr.Error):
        rr.Terrain(heights).render(**{"size": SIZE, **given})


def test_maps_are_read_from_files(tmp_path):
    heights = np.arange(48.0, dtype=np.float32).reshape(6, 8)
    np.save(tmp_path / "map.npy", heights)
    of_file = rr.Terrain(tmp_path / "map.npy", height_scale=0.5)
    assert of_file.heights == (0, 23.5)
    assert (of_file.render(size=(40, 30)).color == rr.Terrain(heights / 2).render(size=(40, 30)).color).all()
    with pytest.raises(rr.ArgumentError, match="map.npy.*height_scale"):
        rr.Terrain(tmp_path / "map.npy")
    with pytest.raises(rr.NotFoundError, match="none.png"):
        rr.Terrain(tmp_path / "none.png")
    for bad in (np.nan, 0, np.inf, 1e-60):
        with pytest.raises(rr.ArgumentError, match="height_scale"):
            rr.Terrain(heights, height_scale=bad)
    with pytest.raises(rr.ArgumentTypeError, match="height_scale"):
        rr.Terrain(heights, height_scale="2")
    with pytest.raises(rr.ArgumentTypeError, match="colors"):
        rr.Terrain(tmp_path / "map.npy", np.zeros((2, 2, 3), np.uint8), height_scale=1)
