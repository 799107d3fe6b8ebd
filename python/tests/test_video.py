# SPDX-License-Identifier: BSD-3-Clause
"""python -m rastrum video: each kind of file has its frames, and they differ."""

import shutil
import subprocess

import numpy as np
import pytest

import rastrum as rr
from rastrum.__main__ import main


SHOWN = {"lights": "studio", "samples": 4, "annotate": "occlusion"}


def video(obj, output, *more):
    return main(["video", str(obj), "-o", str(output), "--size", "64x48", "--frames", "6", "--background", "white", *more])


@pytest.mark.parametrize("name", ["turn.gif", "turn.png"])
def test_animations_have_all_frames(obj, tmp_path, name):
    from PIL import Image, ImageSequence
    assert video(obj, tmp_path / name, "--fps", "10") == 0
    with Image.open(tmp_path / name) as file:
        frames = [np.asarray(f.convert("RGB")) for f in ImageSequence.Iterator(file)]
    expected = rr.render(obj, rr.orbit(rr.load(obj), 6, elevation=25), size=(64, 48), background="white", **SHOWN).color[..., :3]
    assert len(frames) == 6 and all((a != b).any() for a, b in zip(frames, frames[1:]))
    for frame, drawn in zip(frames, expected):
        # A GIF has a palette; an animated PNG the very pixels.
        assert np.abs(frame.astype(int) - drawn).max() <= (0 if name.endswith("png") else 24)


def test_numbered_frames_are_an_orbits(obj, tmp_path):
    from PIL import Image
    assert video(obj, tmp_path / "f_%02d.png") == 0
    assert len(list(tmp_path.glob("f_*.png"))) == 6
    cameras = rr.orbit(rr.load(obj), 6, elevation=25)
    drawn = rr.render(obj, cameras[3], size=(64, 48), background="white", **SHOWN).color
    assert (np.asarray(Image.open(tmp_path / "f_03.png")) == drawn).all()


def test_render_alone_is_the_programs(obj, tmp_path):
    from PIL import Image
    assert main(["render", str(obj), "-o", str(tmp_path / "p.png"), "--size", "64x48"]) == 0
    part = rr.load(obj)
    drawn = rr.render(part, rr.Camera.fit(part, "iso", fov=30), size=(64, 48), **SHOWN).color
    assert (np.asarray(Image.open(tmp_path / "p.png")) == drawn).all()
    assert main(["render", str(obj), "-o", str(tmp_path / "p.png"), "--size", "64x48", "--shader", "phong", "--view", "front"]) == 0
    drawn = rr.render(part, rr.Camera.fit(part, fov=30), size=(64, 48)).color
    assert (np.asarray(Image.open(tmp_path / "p.png")) == drawn).all()


def test_it_keeps_its_size_and_stays_in_the_picture():
    scene = rr.Scene([rr.Spheres([[-3, 0, 0], [3, 0, 0]], 0.5)])
    seen = rr.render(scene, rr.orbit(scene, 8, elevation=25), size=(64, 48), outputs="id").id >= 0
    assert not seen[:, [0, -1]].any() and not seen[:, :, [0, -1]].any()
    # From both ends, and from both sides, as many pixels but for where they begin.
    areas = seen.sum((1, 2))
    assert areas.min() > 8 and abs(int(areas[0]) - int(areas[4])) <= 6 and abs(int(areas[2]) - int(areas[6])) <= 6


def test_mp4(obj, tmp_path):
    if not shutil.which("ffmpeg") or not shutil.which("ffprobe"):
        pytest.skip("ffmpeg and ffprobe are not here")
    assert video(obj, tmp_path / "turn.mp4") == 0
    said = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=width,height,nb_read_frames", "-of",
                           "csv=p=0", tmp_path / "turn.mp4"], capture_output=True, text=True, check=True).stdout
    assert said.strip() == "64,48,6"


@pytest.mark.parametrize("name, more", [("turn.avi", []), ("turn.mp4", ["--size", "63x48"]), ("f_%02d.gif", []),
                                        ("turn.gif", ["--frames", "0"]), ("turn.gif", ["--fps", "0"])])
def test_what_cannot_be_written_is_said(obj, tmp_path, capsys, name, more):
    assert video(obj, tmp_path / name, *more) == 1
    assert capsys.readouterr().err.startswith("error: ") and not list(tmp_path.glob("turn*"))


@pytest.mark.parametrize("name", ["turn.gif", "turn.png", "turn_%02d.png", "turn.mp4"])
def test_what_cannot_be_written_is_said(obj, tmp_path, name, capsys):
    if name.endswith("mp4") and shutil.which("ffmpeg") is None:
        pytest.skip("no ffmpeg")
    assert video(obj, tmp_path / "none" / name) == 1
    assert "none/turn" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["100%_%03d.png", "%d_%d.png"])
def test_names_with_other_percents_are_refused(obj, tmp_path, name, capsys):
    assert video(obj, tmp_path / name) == 1
    assert "one number is expected" in capsys.readouterr().err
