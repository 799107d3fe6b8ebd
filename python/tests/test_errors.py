# SPDX-License-Identifier: BSD-3-Clause
"""Mistakes of users raise an exception of the natural class that is an rr.Error as well, and says what to do."""

import shutil

import numpy as np
import pytest

import rastrum as rr

V = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
F = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
SIZE = (16, 12)


def draw(**more):
    return rr.render((V, F), size=SIZE, **more)


def three(**more):
    return rr.render((V, F), rr.orbit((V, F), 3), size=SIZE, **more)


@pytest.mark.parametrize("call, natural, says", [
    (lambda: draw().depth, AttributeError, "outputs="),
    (lambda: draw(outputs="depth").save("x.png"), AttributeError, "color"),
    (lambda: three(outputs="id").sheet(), AttributeError, "color"),
    (lambda: rr.render((V, F), sise=SIZE), TypeError, "'sise'"),
    (lambda: rr.render(), TypeError, "what"),
    (lambda: rr.Renderer().render((V, F), sise=SIZE), TypeError, "'sise'"),
    (lambda: three()[3], IndexError, "there are 3 pictures"),
    (lambda: three().save("x.png"), ValueError, "frame_%03d.png"),
    (lambda: three().save("%d_%d.png"), ValueError, "one number"),
    (lambda: draw().save("/nowhere/x.npy"), OSError, "/nowhere/x.npy"),
    (lambda: draw(samples="4"), TypeError, "samples"),
    (lambda: draw(out=np.zeros((12, 16, 4), np.uint8)), TypeError, "out: must be arrays by name"),
    (lambda: rr.Mesh(V, F, scalars=[1, 2, 3, 4], cmap="jetty"), ValueError, "jetty"),
    (lambda: rr.digest(object()), TypeError, "digest"),
    (lambda: rr.orbit((V, F), 2.5), TypeError, "whole number"),
    (lambda: rr.orbit((V, F), "a"), TypeError, "whole number"),
    (lambda: rr.Camera.opencv(np.eye(3), np.zeros(3)), ValueError, "Rodrigues"),
    (lambda: rr.Camera.opencv(np.eye(3), None, [1, 2]), ValueError, "t: "),
])
def test_errors_are_of_the_natural_class(call, natural, says):
    with pytest.raises(natural, match=says) as raised:
        call()
    assert isinstance(raised.value, rr.Error)


def test_what_a_callers_own_function_raises_stays_as_it_is():
    def progress(done, total):
        raise TypeError("mine")
    with pytest.raises(TypeError, match="mine") as raised:
        draw(progress=progress)
    assert not isinstance(raised.value, rr.Error)


def test_pictures_are_taken_apart_and_saved(tmp_path):
    pictures = three()
    some = pictures[1:]
    assert isinstance(some, rr.Pictures) and len(some) == 2 and np.array_equal(some[0].color, pictures[1].color)
    assert np.array_equal(pictures[-1].color, pictures[2].color) and len(list(pictures)) == 3
    assert some[0].pick(8, 6) == pictures[1].pick(8, 6)
    pictures.save(tmp_path / "f_%02d.png").save(tmp_path / "all.npy")
    assert np.array_equal(np.load(tmp_path / "all.npy"), pictures.color)
    for i in range(3):
        assert np.array_equal(rr._rastrum.read_image(str(tmp_path / f"f_{i:02d}.png")), pictures.color[i])
    pictures.sheet().save(tmp_path / "sheet.png")
    assert pictures._repr_png_() == (tmp_path / "sheet.png").read_bytes()


@pytest.mark.parametrize("bad, words", [(dict(fov=0), "fov"), (dict(fov=180), "fov"), (dict(fov=float("nan")), "fov"),
                                        (dict(up=(0, 0, 0)), "up"), (dict(elevation=float("nan")), "elevation")])
def test_orbits_that_cannot_be(sheet, bad, words):
    with pytest.raises(rr.ArgumentError, match=words):
        rr.orbit(sheet, 3, **bad)


def test_sheets_threads_and_arrays_of_the_other_order(sheet):
    pictures = rr.render(sheet, [None] * 3, size=(8, 6))
    assert pictures.sheet(np.int64(3)).color.shape == (6, 24, 4)
    with pytest.raises(rr.ArgumentError, match="no pictures"):
        pictures[:0].sheet()
    for columns in (0, -1, 1.5, True):
        with pytest.raises(rr.ArgumentError, match="columns"):
            pictures.sheet(columns)
    with pytest.raises(rr.ArgumentTypeError, match="other order"):
        rr.render(sheet, size=(8, 6), out={"depth": np.zeros((6, 8), np.dtype(np.float32).newbyteorder())})
    assert rr.digest(rr.render(sheet, size=(8, 6), threads=np.int64(2)).color) == rr.digest(rr.render(sheet, size=(8, 6)).color)
    for threads in (True, 0, 1.0):
        with pytest.raises(rr.ArgumentError, match="threads"):
            rr.Renderer(threads=threads)
        with pytest.raises(rr.ArgumentError, match="threads"):
            rr.Terrain(np.zeros((8, 8)), threads=threads)
    with pytest.raises(rr.ArgumentError, match="K: must be"):
        rr.Camera.opencv(np.eye(3) * 1j)
    with pytest.raises(rr.ArgumentError, match="direction: must be three numbers"):
        rr.Light.directional((1j, 0, 0))


def contents(folder):
    return {p.name: p.read_bytes() for p in folder.iterdir() if p.is_file()}


def test_a_picture_is_not_saved_over_what_it_is_of(tmp_path):
    from rastrum.__main__ import main
    triangle = tmp_path / "t.npy"
    np.save(triangle, np.float32([[[0, 0, 0], [1, 0, 0], [0, 1, 0]]]))
    (tmp_path / "link.npy").symlink_to("t.npy")
    (tmp_path / "hard_2.npy").hardlink_to(triangle)
    (tmp_path / "f_3.png").hardlink_to(triangle)
    before = contents(tmp_path)
    one, many = rr.render(triangle, size=(8, 8)), rr.render(triangle, rr.orbit(triangle, 4), size=(8, 8))
    for saves in (one.save, many.save, many[1].save, many[1:].save, many.sheet().save):
        for name in ("t.npy", "link.npy", "hard_2.npy"):
            with pytest.raises(rr.ArgumentError, match=f"{name}: was read for this picture"):
                saves(tmp_path / name)
    for name in ("hard_%d.npy", "f_%d.png"):
        with pytest.raises(rr.ArgumentError, match="was read"):
            many.save(tmp_path / name)
    assert contents(tmp_path) == before  # none of the four pictures was written
    for arguments in (["render", "-o", "t.npy"], ["video", "--frames", "4", "-o", "f_%d.png"]):
        arguments[-1] = str(tmp_path / arguments[-1])
        assert main([arguments[0], str(triangle), "--size", "8x8", *arguments[1:]]) == 1
    assert contents(tmp_path) == before
    one.save(tmp_path / "other.npy")


def test_arrays_and_videos_are_written_whole_or_not_at_all(tmp_path):
    """On a full disk the old file stays, nothing is left beside it, and the message has the cause."""
    import subprocess
    import sys
    script = """
import resource, signal, sys
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
import rastrum as rr
from rastrum import _video
scene = rr.Scene("builtin:torus_knot")
picture = rr.render(scene, size=(200, 200))
_video.check("a.gif", (200, 200))
resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))
for name in sys.argv[1:]:
    try:
        if name.endswith(".npy"):
            picture.save(name)
        else:
            _video.write(name, [picture] * 3, 3, (200, 200), 10)
    except rr.FileError as e:
        print(e)
"""
    names = ["a.npy", "a.gif", "a.png", *(["a.mp4"] if shutil.which("ffmpeg") else [])]
    for name in names:
        (tmp_path / name).write_text("old")
    said = subprocess.run([sys.executable, "-c", script, *names], cwd=tmp_path, capture_output=True, text=True, check=True).stdout
    lines = said.splitlines()
    assert [line.split(":")[0] for line in lines] == names
    assert all(": cannot be written: " in line and not line.endswith(("None", ": ")) for line in lines), said
    assert all("File too large" in line for line in lines[:3]), said
    assert contents(tmp_path) == {name: b"old" for name in names}


def test_what_is_written_keeps_the_mode_of_what_was_there(tmp_path):
    picture = rr.render("builtin:sphere", size=(8, 8))
    for name in ("a.npy", "a.png"):
        file = tmp_path / name
        file.write_text("old")
        file.chmod(0o600)
        picture.save(file)
        assert file.stat().st_mode & 0o777 == 0o600 and file.read_bytes() != b"old"
        file.chmod(0o444)
        with pytest.raises(rr.FileError, match="read-only"):
            picture.save(file)
        link = tmp_path / ("link" + name[1:])
        link.symlink_to("target" + name[1:])
        picture.save(link)
        assert link.is_symlink() and (tmp_path / ("target" + name[1:])).read_bytes() == file.read_bytes()


def test_a_terrain_is_not_saved_over_its_map(tmp_path):
    heights = tmp_path / "h.npy"
    np.save(heights, np.zeros((8, 8), np.float32))
    picture = rr.Terrain(heights, height_scale=1).render(size=(8, 8))
    with pytest.raises(rr.ArgumentError, match="was read"):
        picture.save(heights)
