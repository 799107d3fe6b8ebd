# SPDX-License-Identifier: BSD-3-Clause
"""Several threads at once: one scene, one renderer, things that change meanwhile. Pictures may be those of before or after a
change, and no others. With the GIL threads change often here; a Python without one needs no help."""

import multiprocessing
import os
import sys
import threading

import numpy as np
import pytest

import rastrum as rr

SIZE = (48, 36)
CAMERA = rr.Camera.look_at((0, 0, 4), fov=60)
THREADS = 4


@pytest.fixture(autouse=True)
def often():
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    yield
    sys.setswitchinterval(before)


def together(draw, change=None, threads=THREADS):
    """The values of draw(i), a thread each, while change() is called in another until all are done. Raises what one raised."""
    results, failures, done = [None] * threads, [], threading.Event()
    start = threading.Barrier(threads + (change is not None))

    def guarded(work):
        try:
            start.wait(60)
            work()
        except BaseException as e:
            failures.append(e)

    def keep(i):
        results[i] = draw(i)

    def until_done():
        while not done.is_set():
            change()
    drawing = [threading.Thread(target=guarded, args=(lambda i=i: keep(i),), daemon=True) for i in range(threads)]
    changing = [threading.Thread(target=guarded, args=(until_done,), daemon=True)] if change is not None else []
    for t in drawing + changing:
        t.start()
    for t in drawing:
        t.join(120)
    done.set()
    for t in changing:
        t.join(120)
    assert not any(t.is_alive() for t in drawing + changing), "threads wait for each other"
    if failures:
        raise failures[0]
    return results


def digests(scene, renderer, frames=40):
    return {rr.digest(renderer.render(scene, CAMERA, size=SIZE).color) for _ in range(frames)}


@pytest.mark.parametrize("shared", [True, False])
def test_a_scene_that_does_not_change(sheet, shared):
    scene = rr.Scene([rr.Mesh(*sheet, color="red"), rr.Spheres(np.zeros((1, 3)), 0.4)])
    expected = rr.digest(rr.render(scene, CAMERA, size=SIZE).color)
    one = rr.Renderer(threads=2)
    found = together(lambda i: digests(scene, one if shared else rr.Renderer(threads=1)))
    assert found == [{expected}] * THREADS


def test_the_first_frames_of_a_scene(sheet):
    # What the first frame makes and later ones share is made by all at once.
    expected = rr.digest(rr.render(sheet, CAMERA, size=SIZE).color)
    for _ in range(20):
        scene = rr.Scene([rr.Mesh(*sheet)])
        def draw(i):
            assert scene.primitives == len(sheet[1])
            return rr.digest(rr.render(scene, CAMERA, size=SIZE).color)
        assert together(draw) == [expected] * THREADS


@pytest.mark.parametrize("name, values", [
    ("color", ("red", [0.0, 0.0, 1.0])),  # the second may change in place and is read for each frame
    ("opacity", (1.0, np.array(0.5))),
    ("clip_planes", ([[1.0, 0, 0, 0]], [[0.0, 1, 0, 0], [0.0, -1, 0, 0.5]])),
    ("transform", (np.eye(4), [[1.0, 0, 0, 0.5], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])),
    ("material", (rr.Material("red"), rr.Material("blue", opacity=0.5)))])
def test_looks_that_change(sheet, name, values):
    thing, renderer = rr.Mesh(*sheet), rr.Renderer(threads=1)
    scene = rr.Scene([thing])
    expected = []
    for value in values:
        setattr(thing, name, value)
        expected.append(rr.digest(renderer.render(scene, CAMERA, size=SIZE).color))

    def change():
        for value in values:
            setattr(thing, name, value)
    found = set().union(*together(lambda i: digests(scene, renderer), change))
    assert found <= set(expected)
    # No frame has put back what it read before.
    assert digests(scene, renderer, 1) == {expected[-1]}


def test_materials_that_change_in_place(sheet):
    material = rr.Material("red")
    things = [rr.Mesh(*sheet, material=material), rr.Spheres(np.zeros((1, 3)), 0.4, material=rr.Material("green"))]
    scene, renderer = rr.Scene(things), rr.Renderer(threads=1)
    expected = {}
    for color in ("red", "blue"):
        material.base_color = color
        expected[color] = rr.digest(renderer.render(scene, CAMERA, size=SIZE).color)

    def change():
        for color in expected:
            material.base_color = color
    found = set().union(*together(lambda i: digests(scene, renderer), change))
    assert found <= set(expected.values())
    assert digests(scene, renderer, 1) == {expected["blue"]}  # no change was missed


def test_a_mesh_that_is_prepared_meanwhile(sheet):
    mesh = rr.Mesh(*sheet)
    scene, renderer = rr.Scene([mesh]), rr.Renderer(threads=1)
    expected = rr.digest(renderer.render(scene, CAMERA, size=SIZE).color)

    def draw(i):
        return digests(scene, renderer) | {rr.digest(rr.render(rr.Scene([mesh]), CAMERA, size=SIZE).color) for _ in range(20)}
    assert together(draw, mesh.prepare) == [{expected}] * THREADS


def test_arrays_that_die_give_their_memory_to_no_other_picture(sheet):
    size = (320, 240)  # large enough for memory that is used again
    shades = [rr.Scene([rr.Mesh(*sheet, color=(i / THREADS, 0.0, 0.0))]) for i in range(THREADS)]
    expected = [rr.digest(rr.render(s, CAMERA, size=size).color) for s in shades]

    def draw(i):
        kept, renderer = [], rr.Renderer(threads=1)
        for _ in range(30):
            kept.append(renderer.render(shades[i], CAMERA, size=size).color)
            if len(kept) > 3:
                kept.pop(0)
        return {rr.digest(array) for array in kept}
    assert together(draw) == [{e} for e in expected]


def test_a_terrain():
    terrain = rr.Terrain(np.add.outer(np.arange(32.0), np.arange(32.0)) % 7, threads=1)
    expected = rr.digest(terrain.render(size=SIZE).color)
    assert together(lambda i: {rr.digest(terrain.render(size=SIZE).color) for _ in range(10)}) == [{expected}] * THREADS


def test_threads_that_ask_at_once_get_one_renderer():
    from rastrum import _render
    found = together(lambda i: _render._kept(3, "threads", 12345678, None))
    assert all(renderer is found[0] for renderer in found)


@pytest.mark.parametrize("number", [1, 4])
def test_progress_draws_with_the_same_renderer(sheet, number):
    renderer, inner = rr.Renderer(threads=2), []

    def progress(done, total):
        inner.append(rr.digest(renderer.render(sheet, CAMERA, size=SIZE).color))
    pictures = together(lambda i: renderer.render(sheet, [CAMERA] * number, size=SIZE, progress=progress), threads=1)[0]
    assert inner and set(inner) == {rr.digest(p.color) for p in pictures}


def _pick_in_child(picture, queue):
    queue.put(picture.pick(24, 18))


def test_a_forked_child_picks_in_a_picture_of_its_parent(sheet):
    picture = rr.render(sheet, CAMERA, size=SIZE)
    expected = picture.pick(24, 18)
    assert expected is not None
    context = multiprocessing.get_context("fork")
    queue = context.Queue()
    child = context.Process(target=_pick_in_child, args=(picture, queue), daemon=True)
    child.start()
    assert queue.get(timeout=30) == expected
    child.join(10)
    assert child.exitcode == 0


def _draw_in_child(scene, queue):
    queue.put(rr.digest(rr.render(scene, CAMERA, size=SIZE).color))


@pytest.mark.skipif("asan" in os.environ.get("LD_PRELOAD", ""),
                    reason="clang 14's address sanitizer copies a held lock of its allocator into the child")
def test_a_child_that_is_forked_while_threads_draw(sheet):
    mesh = rr.Mesh(*sheet, color=[1.0, 0.0, 0.0])  # read for each frame, under a lock
    scene = rr.Scene([mesh])
    expected = rr.digest(rr.render(scene, CAMERA, size=SIZE).color)
    context = multiprocessing.get_context("fork")
    queue, stop = context.Queue(), threading.Event()

    def draw(renderer):
        while not stop.is_set():
            renderer.render(scene, CAMERA, size=SIZE)
    drawing = [threading.Thread(target=draw, args=(rr.Renderer(threads=2),), daemon=True) for _ in range(2)]
    for t in drawing:
        t.start()
    try:
        children = [context.Process(target=_draw_in_child, args=(scene, queue), daemon=True) for _ in range(20)]
        for c in children:
            c.start()
        assert [queue.get(timeout=60) for _ in children] == [expected] * len(children)
        for c in children:
            c.join(10)
            assert c.exitcode == 0
    finally:
        stop.set()
        for t in drawing:
            t.join(60)


def test_files_that_another_library_reads_leave_stdout(tmp_path, sheet):
    meshio = pytest.importorskip("meshio")
    file = tmp_path / "sheet.mesh"
    vertices, triangles = sheet
    meshio.Mesh(vertices, [("triangle", triangles.astype(np.int64))]).write(file)
    before = sys.stdout, sys.stderr
    together(lambda i: [rr.load(file).primitives for _ in range(3)])
    assert (sys.stdout, sys.stderr) == before
