# SPDX-License-Identifier: BSD-3-Clause
"""Things, scenes, cameras, lights, terrains and pictures go through pickle, and draw the same pictures behind it."""

import copy
import importlib.util
import multiprocessing
import os
import pathlib
import pickle

import numpy as np
import pytest

import rastrum as rr

EXAMPLE = pathlib.Path(__file__).parents[2] / "examples" / "python" / "views_by_dask.py"


def through(value):
    """(value behind pickle, bytes within it, bytes of arrays beside it)"""
    beside = []
    data = pickle.dumps(value, protocol=5, buffer_callback=beside.append)
    return pickle.loads(data, buffers=beside), len(data), sum(b.raw().nbytes for b in beside)


def things():
    random = np.random.default_rng(1)
    at, faces = random.random((300, 3)), random.integers(0, 300, (200, 3))
    texture = random.integers(0, 255, (16, 16, 3), dtype=np.uint8)
    shared = rr.ColorMapping("plasma", (0, 1), isolines=3)
    return [
        rr.Mesh(at, faces, per="vertex", scalars=np.ascontiguousarray(at[:, 0]), cmap=shared),
        rr.Mesh(1.5 * at, faces, color="red", opacity=0.3, transform=np.diag([1, 1, 1.25, 1]), id=77),
        rr.Mesh(at + 1, faces, uv=at[:, :2], material=rr.Material(base_color_texture=texture, roughness=0.3)),
        rr.Mesh(at - 1, [[0, 1, 2, 3], [4, 5, 6, 7]], scalars=0.25, cmap=shared),
        rr.Mesh(at, [0, 1, 2, 3, 4], offsets=[0, 5], clip_planes=[(1, 0, 0, -0.5)]),
        rr.Points(at, size=2.0, colors=at), rr.Lines(at[:50], width=2), rr.Spheres(at[:20], 0.05),
        rr.Cylinders(at[:20], radius=0.01, visible=False), rr.Tubes(at[50:70], radius=0.02), rr.Discs(at[:9], at[:9], 0.1), "builtin:teapot",
    ]


def cameras(scene):
    return [rr.Camera.look_at((2, 2, 3)), rr.Camera.look_at((2, 2, 3), near=0.1, far=9), rr.Camera.orthographic((2, 2, 3), height=3),
            rr.Camera.fit(scene, "iso"), rr.Camera.opencv(np.array([[90, 0, 48], [0, 90, 32], [0, 0, 1]]), t=(0, 0, 4)),
            rr.Camera.opengl(np.diag([1, 1, -0.1, 1]))]


def lights():
    ramp = np.linspace(0, 1, 8 * 16 * 3).reshape(8, 16, 3)
    return ["studio", rr.Light.point((1, 2, 3), color="orange"), rr.Light.environment(ramp, turn=30), rr.Light.environment("sky")]


LOOK = {"size": (96, 64), "outputs": ("color", "instance", "depth", "scalars"), "shader": "material"}


def test_pictures_behind_pickle_are_the_same():
    scene = rr.Scene(things())
    seen, lit = cameras(scene), lights()
    picture = rr.render(scene, seen, lights=lit, **LOOK)
    (scene2, seen2, lit2, carried), _, _ = through((scene, seen, lit, picture))
    again = rr.render(scene2, seen2, lights=lit2, **LOOK)
    for name, array in picture.arrays.items():
        np.testing.assert_array_equal(array, again.arrays[name])
        np.testing.assert_array_equal(array, carried.arrays[name])
    assert carried[3].stats == picture[3].stats


def test_arrays_travel_beside_and_are_not_copied_twice():
    at = np.random.default_rng(2).random((9999, 3))
    _, within, beside = through(rr.Scene([rr.Mesh(at), rr.Points(at)]))
    assert within < 3000
    assert beside == at.nbytes


def test_looks_are_those_of_the_moment():
    thing = rr.Mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0)], color="red", transform=np.eye(4))
    scene = rr.Scene([thing])
    thing.color, thing.id = "lime", 5
    thing.transform[0, 3] = 0.25
    other, _, _ = through(scene)
    assert other.things[0].color == "lime" and other.things[0].transform[0, 3] == 0.25
    look = {"size": (32, 32), "outputs": ("color", "instance")}
    a, b = rr.render(scene, **look), rr.render(other, **look)
    assert rr.digest(a.color) == rr.digest(b.color) and 5 in b.instance
    other.things[0].color = "blue"  # each goes its way
    assert rr.digest(rr.render(other, **look).color) != rr.digest(rr.render(scene, **look).color) == rr.digest(a.color)
    assert copy.deepcopy(thing).id == 5


def test_a_prepared_mesh_stays_so(sheet):
    mesh = rr.Mesh(*sheet).prepare()
    expected = rr.digest(rr.render(mesh).color)
    other = pickle.loads(pickle.dumps(mesh))
    assert other._prepared
    sheet[0][:] = 0  # neither sees it
    assert rr.digest(rr.render(mesh).color) == rr.digest(rr.render(other).color) == expected


def test_a_file_is_read_again_where_it_is(obj, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    data = pickle.dumps(rr.Scene([obj.name], crease=None))
    monkeypatch.chdir("/")
    assert rr.digest(rr.render(pickle.loads(data)).color) == rr.digest(rr.render(rr.load(obj, crease=None)).color)
    obj.unlink()
    with pytest.raises(rr.NotFoundError, match="sheet.obj"):
        pickle.loads(data)


def test_a_picture_comes_without_its_scene(sheet):
    picture, _, _ = through(rr.render(rr.Mesh(*sheet), size=(8, 8)))
    with pytest.raises(rr.UnsupportedError, match="pickle carries a picture without the scene"):
        picture.pick(4, 4)


def test_a_copy_here_is_as_it_was(sheet):
    scene = rr.Scene([rr.Mesh(*sheet)])
    picture = rr.render(scene, size=(8, 8))
    for made in (copy.copy(picture), copy.deepcopy(picture)):
        assert made.pick(4, 4) == picture.pick(4, 4)
    assert copy.copy(scene).things[0] is scene.things[0]


def test_things_of_other_readers_travel_as_arrays(tmp_path):
    meshio = pytest.importorskip("meshio")
    file = tmp_path / "part.vtu"
    points, cells = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]]), [("tetra", [[0, 1, 2, 3]])]
    meshio.Mesh(points, cells, point_data={"heat": np.arange(4.0)}).write(file)
    scene = rr.load(file, scalars="heat")
    data = pickle.dumps(scene)
    picture = rr.render(scene, size=(32, 32))
    other = rr.render(pickle.loads(data), size=(32, 32))
    assert rr.digest(picture.color) == rr.digest(other.color)
    file.rename(tmp_path / "gone.vtu")
    assert rr.digest(rr.render(pickle.loads(data), size=(32, 32)).color) == rr.digest(picture.color)
    (tmp_path / "gone.vtu").rename(file)
    with pytest.raises(rr.ArgumentError, match="was read for this picture"):
        other.save(file)


def test_terrains_and_renderers():
    random = np.random.default_rng(3)
    for options in ({"colors": random.integers(0, 255, (9, 9, 3), dtype=np.uint8), "shadows": "soft"}, {"cmap": "YlGnBu", "clim": (0, 9)},
                    {"lights": [rr.Light.directional((1, -1, 0))], "tone": "aces"}):
        terrain = rr.Terrain(9 * random.random((32, 32)), **options)
        other, _, _ = through(terrain)
        assert rr.digest(terrain.render(size=(64, 48)).color) == rr.digest(other.render(size=(64, 48)).color)
    renderer, _, _ = through(rr.Renderer(threads=3, memory_limit=1 << 20, isa="scalar"))
    assert renderer._options == (3, 1 << 20, "threads", "scalar")


def _digest(scene, camera):
    return rr.digest(rr.render(scene, camera, size=(96, 64)).color)


sanitized = pytest.mark.skipif("asan" in os.environ.get("LD_PRELOAD", ""), reason="processes of a sanitizer take minutes")


@sanitized
@pytest.mark.parametrize("method", ["spawn", "forkserver"])
def test_processes_draw_the_same(method):
    scene = rr.Scene(things())
    expected = [_digest(scene, camera) for camera in cameras(scene)]
    with multiprocessing.get_context(method).Pool(2) as pool:
        assert pool.starmap(_digest, [(scene, camera) for camera in cameras(scene)]) == expected


@sanitized
def test_a_data_set_by_dask_survives_a_worker(tmp_path, sheet):
    distributed = pytest.importorskip("distributed")
    spec = importlib.util.spec_from_file_location("views_by_dask", EXAMPLE)
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    scene = rr.Scene([rr.Mesh(*sheet)])
    cameras = rr.orbit(scene, 60)
    for folder in ("one", "many"):
        (tmp_path / folder).mkdir()
    expected = [example.draw(i, camera, scene, 64, tmp_path / "one") for i, camera in enumerate(cameras)]

    def killing(number, camera, scene, size, folder):
        if number == 20 and not (killed := tmp_path / "killed").exists():
            killed.touch()
            os.kill(os.getpid(), 9)
        return example.draw(number, camera, scene, size, folder)

    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, distributed.Client(cluster) as client:
        client.upload_file(str(EXAMPLE))
        draw, example.draw = example.draw, killing
        try:
            assert example.draw_all(client, scene, cameras, 64, tmp_path / "many") == expected
        finally:
            example.draw = draw
    assert (tmp_path / "killed").exists()
    for i in range(len(cameras)):
        with np.load(tmp_path / "one" / f"{i:06d}.npz") as one, np.load(tmp_path / "many" / f"{i:06d}.npz") as many:
            assert all(np.array_equal(one[name], many[name]) for name in one)
