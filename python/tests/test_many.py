# SPDX-License-Identifier: BSD-3-Clause
"""Many scenes, or many states of one, by one call."""
import numpy as np
import pytest

import rastrum as rr

SIZE = (64, 48)
OUTPUTS = ("color", "depth", "instance", "face")


def moved(x, y, z):
    m = np.eye(4)
    m[:3, 3] = x, y, z
    return m


@pytest.fixture(scope="module")
def cameras():
    return [rr.Camera.look_at((3 + k, 2, 4 - k)) for k in range(6)]


def spheres(k):
    return rr.Scene([rr.Spheres([[0.3 * k, 0, 0], [0, 0.2, -1]], 0.7, color="red"), rr.Points([[1, 1, 0.1 * k]], size=5)])


def box(**look):
    v = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    f = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    return rr.Mesh(v, f, **look)


def expect_same(pictures, each, outputs=OUTPUTS):
    assert len(pictures) == len(each)
    for one, other in zip(pictures, each):
        for name in outputs:
            assert rr.digest(getattr(one, name)) == rr.digest(getattr(other, name)), name


@pytest.mark.parametrize("threads", [1, 3])
def test_scenes_are_drawn_as_each_alone(cameras, threads):
    scenes = [spheres(k) for k in range(6)]
    look = {"size": SIZE, "outputs": OUTPUTS, "samples": 4, "lights": "studio"}
    many = rr.render_many(scenes, cameras, threads=threads, **look)
    assert many.color.shape == (6, 48, 64, 4)
    expect_same(many, [rr.render(s, c, threads=threads, **look) for s, c in zip(scenes, cameras)])
    assert len({rr.digest(one.color) for one in many}) == 6
    hit = many[2].pick(32, 24)
    assert hit.instance == many[2].instance[24, 32]


def test_cameras_may_be_one_or_fitted():
    scenes = [spheres(k) for k in range(3)]
    camera = rr.Camera.look_at((3, 2, 4))
    expect_same(rr.render_many(scenes, camera, size=SIZE, outputs=OUTPUTS), [rr.render(s, camera, size=SIZE, outputs=OUTPUTS) for s in scenes])
    fitted = rr.render_many(scenes, size=SIZE, outputs=OUTPUTS, annotate="bounds")
    expect_same(fitted, [rr.render(s, size=SIZE, outputs=OUTPUTS, annotate="bounds") for s in scenes])


def test_progress_ends_with_all_of_them(cameras):
    for threads in (1, 2):
        seen = []
        rr.render_many([spheres(0)] * 6, cameras, size=SIZE, threads=threads, progress=lambda done, total: seen.append((done, total)))
        assert seen[-1] == (6, 6)


def test_scenes_may_come_from_a_sequence_that_makes_them(cameras):
    class Made:
        def __len__(self):
            return 3

        def __getitem__(self, k):
            if k >= 3:
                raise IndexError
            return [rr.Spheres([[0.3 * k, 0, 0]], 0.7)]
    many = rr.render_many(Made(), cameras[0], size=SIZE)
    assert len({rr.digest(one.color) for one in many}) == 3


def test_larger_pictures_come_one_after_the_other(cameras):
    seen = []
    scenes = [spheres(k) for k in range(2)]
    many = rr.render_many(scenes, cameras[:2], size=(600, 500), progress=lambda done, total: seen.append((done, total)))
    assert seen == [(1, 2), (2, 2)]
    expect_same(many, [rr.render(s, c, size=(600, 500)) for s, c in zip(scenes, cameras)], ("color",))


@pytest.mark.parametrize("annotate", [(), {"edges": {"angle": 30}}])
def test_states_are_scenes_with_these_transforms(cameras, annotate, tmp_path):
    (tmp_path / "floor.obj").write_text("v -3 -1.2 -3\nv 3 -1.2 -3\nv 3 -1.2 3\nv -3 -1.2 3\nf 1 4 3 2\n")
    places = np.array([[moved(k, 0, 0), moved(0, 0, -k) @ np.diag([1, 0.3, 1, 1])] for k in range(4)])
    scene = rr.Scene([str(tmp_path / "floor.obj"), box(transform=np.eye(4), color="green"), box(color="blue")])
    look = {"size": SIZE, "outputs": OUTPUTS, "annotate": annotate}
    before = rr.render(scene, cameras[0], **look)
    many = rr.render_many(scene, cameras[:4], transforms=places, **look)
    for k, one in enumerate(many):
        alone = rr.Scene([str(tmp_path / "floor.obj"), box(transform=places[k, 0], color="green"), box(transform=places[k, 1], color="blue")])
        expect_same([one], [rr.render(alone, cameras[k], **look)])
    expect_same([rr.render(scene, cameras[0], **look)], [before])  # the scene itself did not move
    with pytest.raises(rr.UnsupportedError, match="draw one state alone"):
        many[0].pick(3, 3)
    many32 = rr.render_many(scene, cameras[0], transforms=places.astype(np.float32), **look)
    assert rr.digest(many32[3].color) == rr.digest(rr.render_many(scene, cameras[0], transforms=places[3:], **look)[0].color)


def test_arrays_are_filled_in_place(cameras):
    out = np.zeros((2, 48, 64), np.float32)
    rr.render_many([spheres(0), spheres(3)], cameras[:2], size=SIZE, outputs="depth", out={"depth": out})
    assert (out > 0).any(axis=(1, 2)).all()


def test_one_that_fails_leaves_the_renderer_usable(cameras):
    renderer = rr.Renderer(threads=3)
    faces = np.array([[0, 1, 2]])
    bad = rr.Scene([rr.Mesh(np.eye(3), faces)])
    scenes = [spheres(k) for k in range(5)] + [bad]
    good = renderer.render_many(scenes, cameras, size=SIZE)
    faces[0, 2] = 7  # read in place
    with pytest.raises(rr.ArgumentError, match="7"):
        renderer.render_many(scenes, cameras, size=SIZE)
    faces[0, 2] = 2
    expect_same(renderer.render_many(scenes, cameras, size=SIZE), list(good), ("color",))


def test_wrong_calls_say_what_is_wrong(cameras, tmp_path):
    scene = rr.Scene([box()])
    for call, error, message in (
            (lambda: rr.render_many(box(), cameras), rr.ArgumentTypeError, "what: must be a sequence of scenes"),
            (lambda: rr.render_many("bunny.obj", cameras), rr.ArgumentTypeError, "what: must be a sequence of scenes"),
            (lambda: rr.render_many([], cameras[0]), rr.ArgumentError, "what: there is no scene"),
            (lambda: rr.render_many([scene] * 3, cameras), rr.ArgumentError, "cameras: there are 6 for 3 pictures"),
            (lambda: rr.render_many(scene, transforms=np.eye(4)), rr.ArgumentError, r"the shape is \(4, 4\) and must be \(N, 1, 4, 4\)"),
            (lambda: rr.render_many(scene, transforms="abc"), rr.ArgumentTypeError, "transforms: must be an array of numbers"),
            (lambda: rr.render_many(scene, transforms=np.zeros((0, 1, 4, 4))), rr.ArgumentError, "transforms: there is no state"),
            (lambda: rr.render_many(scene, transforms=np.full((2, 1, 4, 4), np.nan), size=SIZE), rr.ArgumentError, "finite"),
            (lambda: rr.render_many([scene, spheres(1)], lights="file"), rr.ArgumentError, "lights: those of files"),
            (lambda: rr.render_many([scene], colour=3), rr.ArgumentTypeError, "colour")):
        with pytest.raises(error, match=message):
            call()
