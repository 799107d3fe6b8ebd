# SPDX-License-Identifier: BSD-3-Clause
"""Pictures: what each output holds, who draws the same bits, and what becomes of arrays."""

import gc
import hashlib
import multiprocessing
import os
import pathlib
import resource
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import rastrum as rr

SIZE = (96, 64)
ALL = tuple(n for n in rr.OUTPUTS if n != "linear")  # that one is of the material shader


def same(a, b):
    return all(np.array_equal(a.arrays[n].view(np.uint8), b.arrays[n].view(np.uint8)) for n in a.arrays)


def test_outputs_hold_what_they_say(sheet):
    vertices, triangles = sheet
    camera = rr.Camera.look_at((0.2, -0.3, 3), fov=50)
    p = rr.render(rr.Mesh(vertices, triangles, id=7), camera, size=SIZE, outputs=ALL, shader="flat", background="navy")
    for name in ALL:
        dtype, channels = rr.OUTPUTS[name]
        assert p.arrays[name].dtype == dtype
        assert p.arrays[name].shape == (64, 96) + (channels,) * (channels > 1)
    seen = p.id >= 0
    assert seen.any() and not seen.all()
    assert (p.face == p.id).all() and set(np.unique(p.instance)) == {-1, 7}
    for name in ("depth", "distance", "position", "normal", "barycentrics", "albedo"):
        assert not p.arrays[name][~seen].any(), name
    assert tuple(p.color[0, 0]) == (0, 0, 128, 255)
    # A point is its corners by their weights, lies as far as the picture says, and is drawn where it is seen.
    y, x = np.argwhere(seen)[len(np.argwhere(seen)) // 2]
    u, v = p.barycentrics[y, x]
    corners = vertices[triangles[p.face[y, x]]]
    assert np.allclose(corners[0] * (1 - u - v) + corners[1] * u + corners[2] * v, p.position[y, x], atol=1e-5)
    eye = np.array((0.2, -0.3, 3))
    assert np.isclose(np.linalg.norm(p.position[y, x] - eye), p.distance[y, x], rtol=1e-5)
    ahead = -eye / np.linalg.norm(eye)
    assert np.isclose((p.position[y, x] - eye) @ ahead, p.depth[y, x], rtol=1e-5)
    hit = p.pick(x, y)
    assert hit.id == p.id[y, x] and hit.instance == 7 and np.allclose(hit.position, p.position[y, x], atol=1e-6)
    assert p.pick(0, 0) is None


def test_equal_values_give_equal_bits(sheet):
    vertices, triangles = sheet
    expected = rr.render((vertices, triangles), size=SIZE, outputs=("color", "color_f32", "depth", "id"))
    for threads in (1, 2, 8):
        assert same(expected, rr.render((vertices, triangles), size=SIZE, outputs=tuple(expected.arrays), threads=threads))
    assert same(expected, rr.render((vertices, triangles), size=SIZE, outputs=tuple(expected.arrays), device="serial"))
    assert same(expected, rr.render((vertices, triangles), size=SIZE, outputs=tuple(expected.arrays), isa="scalar"))
    camera = rr.Camera.look_at((0, 0, 3))
    expected = rr.render((vertices, triangles), camera, size=SIZE, outputs=("color", "depth", "id"))
    for dtype in (np.int32, np.int64, np.uint64, np.uint16, np.int16):
        assert same(expected, rr.render((vertices, triangles.astype(dtype)), camera, size=SIZE, outputs=tuple(expected.arrays)))
    wide = np.zeros((len(vertices), 6), np.float32)  # xyzrgb
    wide[:, :3] = vertices
    for positions in (wide[:, :3], vertices[::-1][::-1], np.asfortranarray(vertices)):
        assert same(expected, rr.render((positions, triangles), camera, size=SIZE, outputs=tuple(expected.arrays)))
    # float64 is transformed in float64, which here may differ in the last bits of depth, but not in ids.
    assert np.array_equal(rr.render((vertices.astype(np.float64), triangles.astype(np.int64)), camera, size=SIZE,
                                    outputs="id").id, expected.id)


def exact_sheet():
    """Numbers that are exact, so that nothing but what draws could differ; tests/render/as_python_test.cpp has it, too."""
    y, x = np.mgrid[0:33, 0:33]
    v = np.stack([x / 16 - 1, y / 16 - 1, (x * x * 7 + y * y * 5 + x * y * 3) % 64 / 256], -1).reshape(-1, 3)
    corner = (np.arange(32)[:, None] * 33 + np.arange(32)).reshape(-1, 1)
    return v.astype(np.float32), np.concatenate([corner + [0, 1, 34], corner + [0, 34, 33]]).astype(np.uint32)


def golden_digests():
    """{image: digest}, which the C++ test of the same picture compares with, too."""
    lines = (pathlib.Path(__file__).resolve().parents[2] / "tests" / "golden" / "hashes.txt").read_text(encoding="utf-8").split("\n")
    return {name.removeprefix("as_python/"): digest for digest, name in (line.split() for line in lines if " as_python/" in line)}


def test_pictures_are_the_same_bytes_for_cpp_every_python_and_numpy():
    p = rr.render(exact_sheet(), rr.Camera.look_at((1, -2, 3), (0, 0, 0), near=0.01), size=(200, 150), samples=1, shader="phong",
                  outputs=("color", "depth_raw", "id", "normal", "position", "barycentrics"))
    assert {"color": rr.digest(p.color), "depth": rr.digest(p.depth_raw), "ids": rr.digest(p.id.astype(np.int64)),
            "normals": rr.digest(p.normal), "positions": rr.digest(p.position),
            "barycentrics": rr.digest(p.barycentrics)} == golden_digests()


@pytest.mark.skipif("RASTRUM_PROGRAM" not in os.environ, reason="the program was not built")
def test_the_program_finds_the_same_bytes(tmp_path):
    v, f = exact_sheet()
    file = tmp_path / "sheet.obj"
    file.write_text("".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in v.tolist()) +
                    "".join(f"f {a} {b} {c}\n" for a, b, c in (f + 1).tolist()))
    images = [word for name in ("normals", "positions", "barycentrics") for word in ("--image", f"{name}={tmp_path / name}.npy")]
    said = subprocess.run(
        [os.environ["RASTRUM_PROGRAM"], "render", "--look", "plain", "--samples", "1", str(file), "--size", "200x150", "--eye", "1,-2,3",
         "--target", "0,0,0", "--fov", "60", "--near", "0.01", "--far", "inf", "--shader", "phong", "--normals", "face", "--hash", "--quiet",
         "-o", str(tmp_path / "c.png"), "--depth", str(tmp_path / "d.npy"), "--ids", str(tmp_path / "i.npy"), *images],
        capture_output=True, text=True, check=True).stdout
    assert {name: digest for digest, name in (line.split() for line in said.splitlines())} == golden_digests()


def test_types_of_equal_numbers_give_equal_bits_where_these_are_exact(sheet):
    # A camera whose matrix has powers of two alone: float32 and float64 round nothing.
    camera = rr.Camera.orthographic((0, 0, 4), height=4, near=1, far=9)
    vertices, triangles = sheet
    expected = rr.render((vertices, triangles), camera, size=(128, 128), outputs=ALL)
    assert (expected.id >= 0).any()
    for positions in (np.float32, np.float64):
        for corners in (np.int32, np.uint32, np.int64, np.uint64):
            assert same(expected, rr.render((vertices.astype(positions), triangles.astype(corners)), camera, size=(128, 128),
                                            outputs=ALL)), (positions, corners)


def test_an_orbit_of_no_camera_is_refused(sheet):
    with pytest.raises(rr.ArgumentError, match="at least 1, not 0"):
        rr.orbit(sheet, 0)


def test_files_arrays_and_the_program_agree(sheet, obj):
    a = rr.render(rr.load(obj, crease=None), size=SIZE)
    b = rr.render(sheet, size=SIZE)
    assert same(a, b)
    assert rr.digest(a.color) == hashlib.sha256(b"uint8 64x96x4\n" + a.color.tobytes()).hexdigest()
    program = os.environ.get("RASTRUM_PROGRAM")
    if not program:
        pytest.skip("RASTRUM_PROGRAM does not name the program")
    for options, scene in ((["--normals", "face"], rr.load(obj, crease=None)), ([], rr.load(obj)),
                           (["--crease", "0"], rr.load(obj, crease=0))):
        said = subprocess.run([program, "render", "--look", "plain", str(obj), "--size", "96x64", "--hash", "--quiet", *options],
                              capture_output=True, text=True, check=True).stdout
        assert said.split()[0] == rr.digest(rr.render(scene, size=SIZE).color), options


def test_a_batch_is_its_pictures(sheet):
    scene = rr.as_scene(sheet)
    cameras = rr.orbit(scene, 7)
    names = ("color", "depth", "id", "instance", "face")
    batch = rr.render(scene, cameras, size=SIZE, outputs=names)
    assert len(batch) == 7 and batch.depth.shape == (7, 64, 96)
    for i, camera in enumerate(cameras):
        one = rr.render(scene, camera, size=SIZE, outputs=names)
        assert same(one, batch[i])
    assert batch.sheet().color.shape == (3 * 64, 3 * 96, 4)
    assert batch[3].pick(48, 32).face == batch.face[3, 32, 48]


def test_given_arrays_are_filled(sheet):
    depth = np.full((64, 96), 9, np.float32)
    ids = np.full((64, 96), 9, np.int64)
    p = rr.render(sheet, size=SIZE, out={"depth": depth, "id": ids})
    assert p.depth is depth and p.id is ids and set(p.arrays) == {"depth", "id"}
    assert np.array_equal(ids, rr.render(sheet, size=SIZE, outputs="id").id)
    assert depth[0, 0] == 0 and depth.max() > 0


def test_arrays_are_viewed_not_copied(sheet):
    vertices, triangles = sheet[0].copy(), sheet[1].astype(np.int64)
    mesh = rr.Mesh(vertices, triangles, copy=False)
    camera = rr.Camera.look_at((0, 0, 3))
    before = rr.render(mesh, camera, size=SIZE, outputs="depth").depth
    vertices[:, 2] += 0.5  # read anew for every frame
    assert np.allclose((before - rr.render(mesh, camera, size=SIZE, outputs="depth").depth)[32, 48], 0.5)
    kept = rr.Mesh(sheet[0], sheet[1], copy=True)
    with pytest.raises(rr.ArgumentError, match="copy=False"):
        rr.Mesh(np.asfortranarray(vertices), triangles, copy=False)
    with pytest.raises(rr.ArgumentError, match="copy=False"):
        rr.Mesh(vertices.astype(np.float16), triangles, copy=False)
    vertices.flags.writeable = False
    assert rr.Mesh(vertices, triangles, copy=False).primitives == kept.primitives
    # Arrays that a mesh views stay alive when the caller drops them.
    mesh = rr.Mesh(sheet[0].copy(), sheet[1].copy())
    gc.collect()
    assert (rr.render(mesh, camera, size=SIZE, outputs="id").id >= 0).any()


sanitized = pytest.mark.skipif("asan" in os.environ.get("LD_PRELOAD", ""), reason="a sanitizer keeps what is freed")


def peak_mb():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


@sanitized
@pytest.mark.parametrize("floats", [np.float32, np.float64])
@pytest.mark.parametrize("integers", [np.int32, np.uint32, np.int64, np.uint64])
def test_large_meshes_take_no_second_place(floats, integers):
    """Half a million vertices and a million triangles: a copy of either array would be seen."""
    n = 700
    y, x = np.mgrid[0:n + 1, 0:n + 1].astype(floats) / n
    vertices = np.stack([x, y, np.zeros_like(x)], -1).reshape(-1, 3)
    a = (np.arange(n, dtype=integers)[:, None] * integers(n + 1) + np.arange(n, dtype=integers)).reshape(-1)
    triangles = np.concatenate([np.stack([a, a + integers(1), a + integers(n + 2)], -1),
                                np.stack([a, a + integers(n + 2), a + integers(n + 1)], -1)])
    camera = rr.Camera.look_at((0.5, 0.5, 2))
    renderer = rr.Renderer(threads=1, memory_limit=4 << 20)
    renderer.render(rr.Mesh(vertices[:3], triangles[:0]), camera, size=SIZE)
    before = peak_mb()
    p = renderer.render(rr.Mesh(vertices, triangles, copy=False), camera, size=SIZE, outputs="id")
    assert (p.id >= 0).any()
    # The smallest of the arrays has 5.6 MiB, and 4 are the limit.
    assert peak_mb() - before < 4 + 1.5


@sanitized
def test_frames_leave_nothing_behind(sheet):
    renderer = rr.Renderer(threads=1)
    for _ in range(300):
        renderer.render(sheet, size=(16, 16))
    before = peak_mb()
    for _ in range(2000):
        renderer.render(sheet, size=(16, 16))
    assert peak_mb() - before < 2


def test_large_arrays_take_the_place_of_dead_ones(sheet):
    def place(array):
        return array.__array_interface__["data"][0]
    size, names = (400, 300), ("color", "depth", "id", "normal")
    first = rr.render(sheet, size=size, outputs=names)
    assert all(a.flags.c_contiguous and a.flags.writeable and place(a) % 64 == 0 for a in first.arrays.values())
    places, part = {place(a) for a in first.arrays.values()}, first.depth[10:20]
    expected = {name: a.copy() for name, a in first.arrays.items()}
    # Memory of an array that somebody keeps, even by a view alone, is not given to another picture.
    kept_color, depth_at, color_at = first.color, place(first.depth), place(first.color)
    del first
    for _ in range(3):
        again = rr.render(sheet, size=size, outputs=names)
        assert {place(a) for a in again.arrays.values()} & places and same(again, rr.Picture(expected, {}, None))
        assert depth_at not in map(place, again.arrays.values()) and color_at not in map(place, again.arrays.values())
        del again
    assert np.array_equal(part, expected["depth"][10:20]) and np.array_equal(kept_color, expected["color"])
    with pytest.raises(rr.OutOfMemoryError):
        rr.render(sheet, [rr.Camera.look_at((0, 0, 3))] * 70000, size=(32768, 32768), outputs="position")


def test_several_draw_at_once(sheet):
    expected = rr.render(sheet, size=SIZE, outputs="id").id
    wrong = []
    def draw():
        renderer = rr.Renderer(threads=1)
        for _ in range(20):
            if not np.array_equal(renderer.render(sheet, size=SIZE, outputs="id").id, expected):
                wrong.append(1)
    threads = [threading.Thread(target=draw) for _ in range(8)]
    for t in threads:
        t.start()
    for t in threads:
        t.join()
    assert not wrong


def _in_child(sheet, queue):
    queue.put(rr.digest(rr.render(sheet, size=SIZE).color))


def _draw_for_ever(sheet, drawn):
    while True:
        rr.render(sheet, size=SIZE)
        drawn.value += 1


def test_forked_workers_draw(sheet):
    expected = rr.digest(rr.render(sheet, size=SIZE).color)  # the parent has threads by now
    context = multiprocessing.get_context("fork")
    queue = context.Queue()
    # Daemons, so that one that hangs fails this test and is not waited for at the end.
    children = [context.Process(target=_in_child, args=(sheet, queue), daemon=True) for _ in range(3)]
    for c in children:
        c.start()
    assert [queue.get(timeout=30) for _ in children] == [expected] * 3
    for c in children:
        c.join(10)
        assert c.exitcode == 0
    # One that is killed while it draws takes nothing with it.
    drawn = context.Value("i", 0)
    child = context.Process(target=_draw_for_ever, args=(sheet, drawn), daemon=True)
    child.start()
    end = time.monotonic() + 30
    while drawn.value < 5:
        assert child.is_alive() and time.monotonic() < end, f"a forked child drew {drawn.value} pictures, not 5, and has exit code {child.exitcode}"
        time.sleep(0.01)
    child.kill()
    child.join(10)
    assert child.exitcode == -signal.SIGKILL
    assert rr.digest(rr.render(sheet, size=SIZE).color) == expected


LONG = """
import numpy as np, rastrum as rr, sys, time
v = np.random.default_rng(1).random((300000, 3), np.float32)
mesh = rr.Mesh(v, np.arange(300000).reshape(-1, 3), opacity=0.5)
print("ready", flush=True)
begin = time.monotonic()
try:
    rr.render(mesh, size=(4096, 4096), samples=16, threads=1)
except KeyboardInterrupt:
    print("interrupted", time.monotonic() - begin, flush=True)
    rr.render(mesh, size=(16, 16))
    print("drew again", flush=True)
"""


def test_ctrl_c_ends_a_long_frame():
    # A shell's background jobs ignore SIGINT, and their children would inherit that.
    process = subprocess.Popen([sys.executable, "-c", LONG], stdout=subprocess.PIPE, text=True,
                               preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
    assert process.stdout.readline() == "ready\n"
    time.sleep(1)
    process.send_signal(signal.SIGINT)
    said, _ = process.communicate(timeout=60)
    assert said.startswith("interrupted") and said.endswith("drew again\n")


def test_progress_is_told(sheet):
    told = []
    rr.render(sheet, [None] * 3, size=(600, 600), progress=lambda done, total: told.append((done, total)))
    assert told == [(1, 3), (2, 3), (3, 3)]
    with pytest.raises(ZeroDivisionError):
        rr.render(sheet, size=SIZE, progress=lambda done, total: 1 / 0)
