# SPDX-License-Identifier: BSD-3-Clause
"""rr.mpi: ranks as threads, whose communicator is written here, and ranks of MPI where mpi4py and an mpirun are there."""

import os
import re
import pathlib
import shutil
import subprocess
import sys
import threading

import numpy as np
import pytest

import rastrum as rr

RANKS = pathlib.Path(__file__).with_name("mpi_ranks.py")
SIZE = (90, 70)
CAMERA = rr.Camera.look_at((2, 1, 3))


class Threads:
    """Ranks that are threads: each lays copies of its buffers down (Python 3.13t loses count of a memoryview that several threads
    read), all meet, each takes what is its own."""

    def __init__(self, size):
        self.size, self.posts, self.barrier = size, [None] * size, threading.Barrier(size, timeout=60)

    def run(self, work):
        """[work(communicator) of each rank]; an exception is its result."""
        results = [None] * self.size

        def as_rank(r):
            try:
                results[r] = work(ThreadRank(self, r))
            except BaseException as e:
                results[r] = e
        threads = [threading.Thread(target=as_rank, args=(r,)) for r in range(self.size)]
        for t in threads:
            t.start()
        for t in threads:
            t.join(120)
            assert not t.is_alive(), "a rank waits for ever"
        return results


class ThreadRank(rr.mpi.Communicator):
    def __init__(self, shared, rank):
        self.shared, self.rank, self.size, self.phases = shared, rank, shared.size, []

    def begin_phase(self, name):
        self.phases.append(name)

    def _meet(self, post, take):
        self.shared.posts[self.rank] = post
        self.shared.barrier.wait()
        taken = take(self.shared.posts)
        self.shared.barrier.wait()
        return taken

    def max(self, value):
        return self._meet(value, max)

    def broadcast(self, buffer, root):
        def take(posts):
            if root != self.rank:
                buffer[:] = posts[root]
        self._meet(bytes(buffer), take)

    def exchange_sizes(self, to, received):
        def take(posts):
            into = np.frombuffer(received, np.uint64)
            for r, post in enumerate(posts):
                into[r] = np.frombuffer(post, np.uint64)[self.rank]
        self._meet(bytes(to), take)

    def exchange(self, to, received):
        def take(posts):
            for r, post in enumerate(posts):
                received[r][:] = post[self.rank]
        self._meet(to, take)


def sheet(k, n=20, **look):
    y, x = np.mgrid[0:n + 1, 0:n + 1] / n
    vertices = np.stack([2 * x - 1, 2 * y - 1, 0.3 * np.round(8 * x * y) / 8 + 0.15 * (k % 4) - 0.1 * x * k], -1).reshape(-1, 3)
    a = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).reshape(-1)
    faces = np.concatenate([np.stack([a, a + 1, a + n + 2], -1), np.stack([a, a + n + 2, a + n + 1], -1)])
    return rr.Mesh(vertices, faces, **{"opacity": 0.5 if k % 2 else 1.0, **look})


def things(with_materials=False):
    heat = rr.ColorMapping("turbo")
    made = []
    for k in range(5):
        scalars = np.linspace(k, 2 * k + 1, 21 * 21)
        look = {"material": rr.Material("orange", metallic=0.2)} if with_materials and k == 2 else {"scalars": scalars, "cmap": heat}
        made.append(sheet(k, **look))
    return made


def drawn(size, picture_of, root=0):
    """The root's picture of ranks that have every size-th thing each."""
    def work(comm):
        own = list(range(comm.rank, 5, comm.size))
        all_of_them = picture_of["things"]()
        return rr.mpi.render(comm, [all_of_them[i] for i in own], parts=own, root=root, threads=1, **picture_of["frame"])
    results = Threads(size).run(work)
    for r, result in enumerate(results):
        if isinstance(result, BaseException):
            raise result
        assert (result is None) == (r != root)
    return results[root]


FRAMES = {
    "plain": dict(outputs=("color", "color_f32", "id", "instance", "face", "depth", "normal", "position", "scalars")),
    "lit": dict(lights=["studio", rr.Light.directional((1, -1, -1))], shadows=True, samples=4, outputs=("color", "linear"), tone="aces",
                shader="material"),
    "noted": dict(annotate={"occlusion": True, "bounds": True, "bar": "heat", "axes": True, "title": "Ranks"}, camera=None),
    "edged": dict(annotate={"edges": {"angle": 20, "width": 1.5}}, outputs=("color", "color_f32", "id")),
    "edged, of samples": dict(annotate={"edges": {}}, samples=4, shader="phong"),
}


@pytest.mark.parametrize("size", [1, 3])
@pytest.mark.parametrize("name", FRAMES)
def test_the_picture_is_that_of_one_process(size, name):
    frame = {"camera": CAMERA, "size": SIZE, **FRAMES[name]}
    picture = drawn(size, {"things": things, "frame": frame}, root=size - 1)
    one = rr.render(things(), **frame)
    assert picture.arrays.keys() == one.arrays.keys()
    for output, array in one.arrays.items():
        assert array.dtype == picture.arrays[output].dtype
        assert array.tobytes() == picture.arrays[output].tobytes(), output
    assert picture.stats["primitives"] == 5 * 2 * 20 * 20
    with pytest.raises(rr.UnsupportedError, match="another rank"):
        picture.pick(1, 1)


def test_a_rank_without_materials_beside_one_that_has_some():
    frame = {"camera": CAMERA, "size": SIZE}
    picture = drawn(3, {"things": lambda: things(True), "frame": frame})
    assert np.array_equal(picture.color, rr.render(things(True), **frame).color)


def test_several_cameras_into_arrays_of_the_callers():
    cameras = [CAMERA, rr.Camera.look_at((-2, 1, 3))]
    depth = np.empty((2, SIZE[1], SIZE[0]), np.float32)
    done = []

    def work(comm):
        frame = dict(size=SIZE, outputs="depth", threads=1, progress=lambda *n: done.append(n))
        own = sheet(comm.rank)
        before = own.scalars
        picture = rr.mpi.render(comm, own, cameras, out={"depth": depth} if comm.rank == 0 else None, **frame)
        assert before is own.scalars
        return picture
    pictures = Threads(2).run(work)[0]
    one = rr.render([sheet(0), sheet(1)], cameras, size=SIZE, outputs="depth")
    assert pictures.depth is depth and np.array_equal(depth, one.depth) and len(pictures) == 2
    assert done == [(1, 2), (2, 2)]


def test_a_camera_that_fits_all():
    def work(comm):
        return rr.mpi.fit(comm, [] if comm.rank == 1 else sheet(comm.rank), "iso", size=SIZE)
    cameras = Threads(3).run(work)
    what = [sheet(0), sheet(2)]
    one = rr.render(what, rr.Camera.fit(what, "iso"), size=SIZE)
    for camera in cameras:
        assert np.array_equal(rr.render(what, camera, size=SIZE).color, one.color)


def test_every_exchange_of_many_ranks():
    one = rr.render([sheet(k) for k in range(5)], CAMERA, size=SIZE)
    for exchange in ("automatic", "sparse", "two_hops", "shared"):
        def work(comm):
            own = list(range(comm.rank, 5, comm.size))
            return rr.mpi.render(comm, [sheet(k) for k in own], CAMERA, parts=own, size=SIZE, threads=1, exchange=exchange)
        picture = Threads(16).run(work)[0]
        assert np.array_equal(picture.color, one.color), exchange
        assert picture.stats["exchange"] == exchange or exchange in ("automatic", "shared") and picture.stats["exchange"] in ("sparse", "two_hops")


def bad_array(comm, thing):
    thing = (np.zeros((3, 3)), np.array([[0, 1, 7]]))
    return rr.mpi.render(comm, thing, CAMERA, size=SIZE)


WRONG = {
    "an index": (rr.ArgumentError, "7", bad_array),
    "what": (rr.ArgumentTypeError, "cannot be drawn", lambda comm, thing: rr.mpi.render(comm, object(), size=SIZE)),
    "a keyword": (rr.ArgumentTypeError, "'colour'", lambda comm, thing: rr.mpi.render(comm, thing, size=SIZE, colour=1)),
    "a file": (rr.NotFoundError, "there is no such file", lambda comm, thing: rr.mpi.render(comm, "nofile.ply", size=SIZE)),
    "parts": (rr.ArgumentError, "parts", lambda comm, thing: rr.mpi.render(comm, thing, CAMERA, parts=[1, 2], size=SIZE)),
    "a part twice": (rr.ArgumentError, "part 0 is on rank 0 and on rank 1", lambda comm, thing: rr.mpi.render(comm, thing, CAMERA, parts=[0], size=SIZE)),
    "a size": (rr.ArgumentError, "size", lambda comm, thing: rr.mpi.render(comm, thing, CAMERA, size=(0, 1))),
    "no camera": (rr.ArgumentError, "different cameras", lambda comm, thing: rr.mpi.render(comm, thing, size=SIZE)),
    "annotations": (rr.ArgumentError, "different cameras, annotations", lambda comm, thing: rr.mpi.render(comm, thing, CAMERA, size=SIZE, annotate="axes")),
    "a camera": (rr.ArgumentError, "different cameras", lambda comm, thing: rr.mpi.render(comm, thing, rr.Camera.look_at((1, 1, 9)), size=SIZE)),
    "something of the caller's": (RuntimeError, "ZeroDivisionError: integer division", lambda comm, thing: rr.mpi.render(comm, thing, CAMERA, parts=(1 // 0 for _ in "a"), size=SIZE)),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_fails_on_one_rank_is_said_on_all(name):
    kind, words, call = WRONG[name]

    def work(comm):
        thing = sheet(comm.rank)
        return call(comm, thing) if comm.rank == 1 else rr.mpi.render(comm, thing, CAMERA, size=SIZE, threads=1)
    said = Threads(3).run(work)
    assert all(type(e) is kind for e in said), said
    assert len({str(e) for e in said}) == 1 and words in str(said[0]) and str(said[0]).startswith("rank "), said[0]


def test_what_is_refused():
    with pytest.raises(rr.ArgumentTypeError, match="comm: must be"):
        rr.mpi.render(object(), sheet(0))
    for frame, words in (({"environment_behind": True}, "environment"), ({"root": 1}, "root"),
                         ({"exchange": "fast"}, "exchange")):
        with pytest.raises(rr.Error, match=words):
            rr.mpi.render(ThreadRank(Threads(1), 0), sheet(0), size=SIZE, **frame)
    # The scene of the caller stays as it is.
    scene = rr.Scene([sheet(1)])
    before = rr.render(scene, CAMERA, size=SIZE).color
    rr.mpi.render(ThreadRank(Threads(1), 0), scene, size=SIZE)
    assert np.array_equal(rr.render(scene, CAMERA, size=SIZE).color, before)


def test_it_is_imported_without_mpi():
    code = "import sys, rastrum; assert rastrum.mpi.render and 'mpi4py' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)


# Ranks of MPI.

def mpirun(n, *arguments, timeout=90):
    pytest.importorskip("mpi4py", reason="ranks of MPI are not tested from Python: there is no mpi4py")
    if "ASAN_OPTIONS" in os.environ:
        pytest.skip("ranks of MPI are not tested from Python under sanitizers: the C++ ranks are")
    run = shutil.which("mpirun") or shutil.which("mpiexec")
    if run is None:
        pytest.skip("ranks of MPI are not tested from Python: there is no mpirun")
    env = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
           "OMPI_MCA_hwloc_base_binding_policy": "none", "OMPI_MCA_mpi_yield_when_idle": "1", "OMPI_MCA_btl": "self,vader,tcp",
           "PYTHONPATH": os.pathsep.join([str(RANKS.parent), *filter(None, [os.environ.get("PYTHONPATH")])])}
    return subprocess.run([run, "-n", str(n), sys.executable, "-m", "mpi4py", str(RANKS), *arguments], capture_output=True, text=True, timeout=timeout, env=env)


@pytest.mark.parametrize("n", [1, 2, 3, 5])
def test_ranks_of_mpi(n):
    ran = mpirun(n, "pictures")
    assert ran.returncode == 0, ran.stderr
    assert ran.stdout.count("equal") == 1


def test_ctrl_c_on_one_rank_of_mpi_ends_on_all():
    ran = mpirun(3, "interrupt")
    assert ran.returncode == 0, ran.stderr
    # mpirun may put one rank's line into another's.
    said = re.findall(r"rank \d: KeyboardInterrupt: rank 1: interrupted", ran.stdout)
    assert sorted(said) == [f"rank {r}: KeyboardInterrupt: rank 1: interrupted" for r in range(3)], ran.stdout
    assert "not interrupted" not in ran.stdout


def test_a_rank_of_mpi_that_dies_or_hangs_ends_the_job():
    for way, words in (("die", ""), ("hang", "has waited 1.0 s for the others")):
        ran = mpirun(2, way)
        assert ran.returncode != 0 and "drawn" not in ran.stdout
        assert words in ran.stderr


def test_what_one_rank_says_of_its_environment_all_hear(sheet, monkeypatch):
    def of_rank_1():
        if threading.current_thread().rank == 1:
            raise rr.ArgumentError("RASTRUM_NUM_THREADS: 'x' is no number of threads")
        return 1
    monkeypatch.setattr(rr.mpi, "_number_of_threads", of_rank_1)

    def work(ranks):
        threading.current_thread().rank = ranks.rank
        return rr.mpi.render(ranks, sheet, CAMERA, size=SIZE)
    for said in Threads(2).run(work):
        assert isinstance(said, rr.ArgumentError) and str(said) == "rank 1: RASTRUM_NUM_THREADS: 'x' is no number of threads"


def test_ranks_with_and_without_a_number_of_threads_ask_alike(sheet):
    """How many share a machine is asked by all of them together, whatever each was told."""
    class Asked(ThreadRank):
        @property
        def neighbours(self):
            return self.max(2)

    def work(ranks):
        return rr.mpi.render(Asked(ranks.shared, ranks.rank), sheet, CAMERA, size=SIZE, threads=None if ranks.rank else 1)
    first, second = Threads(2).run(work)
    assert second is None and first.color.any(), (first, second)


def test_progress_that_cannot_be_called_is_refused(sheet):
    for said in Threads(2).run(lambda ranks: rr.mpi.render(ranks, sheet, CAMERA, size=SIZE, progress=5)):
        assert isinstance(said, rr.ArgumentTypeError) and "progress: 5 cannot be called" in str(said)
