# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of things that lie on several ranks of MPI. Each thing is drawn where it lies. A picture has the same bits as one of
a single process that has all of them.

    from mpi4py import MPI
    import rastrum as rr
    picture = rr.mpi.render(MPI.COMM_WORLD, rr.Mesh(vertices, faces), size=(1920, 1080))
    if picture is not None:  # the root's
        picture.save("all.png")

The package links no MPI: it calls the methods of the caller's mpi4py communicator.
docs/ranks_traffic.md says what is sent, docs/scale.md what is refused.
"""

import os
import sys
import threading
import time
import zlib

import numpy as np

from . import _errors
from . import _rastrum as _r
from ._annotate import annotations as _annotations
from ._camera import Camera, _triple, as_camera
from ._errors import ArgumentError, ArgumentTypeError, Error, UnsupportedError, raises_errors
from ._lights import lights as _lights
from ._render import Picture, Pictures, Renderer, _arrays, _bar, _is_many, _look, _number_of_threads
from ._scene import as_scene

__all__ = ["Communicator", "Ranks", "fit", "render"]

#: The most bytes in one message: MPI 3 counts in int.
_MOST = 1 << 30
#: Bytes of the message that tells all ranks of a failure.
_TEXT = 1024


class Communicator:
    """The messages between ranks: `rank`, `size` and five functions, to be implemented where ranks do not come from
    mpi4py. All ranks call the same functions in the same order; each returns when its own part is done. Buffers are
    memoryviews of bytes, numbers in them uint64 of this machine; they are the frame's own and end with the call. An
    implementation must end the job where it fails: an exception would leave the other ranks waiting.
    """
    rank, size = 0, 1

    def begin_phase(self, name):
        """All ranks begin this phase now. A message about a rank that waits in vain can name it."""

    def max(self, value):
        """The greatest `value`, a number below 2**64, of all ranks."""
        raise NotImplementedError

    def broadcast(self, buffer, root):
        """Copies the root's bytes to all ranks; the buffer has one size everywhere."""
        raise NotImplementedError

    def exchange_sizes(self, to, received):
        """Sends one number to each rank, and receives one from each."""
        raise NotImplementedError

    def exchange(self, to, received):
        """`to` and `received` are lists of `size` buffers, one to each rank and one from each, of the sizes that were
        exchanged; some are empty."""
        raise NotImplementedError


class Ranks(Communicator):
    """The ranks of an mpi4py communicator, which is duplicated: neither its messages nor its error handler are touched.
    All its ranks make it together, and free it together (`free`, or the end of a `with`). An error of MPI itself ends
    the job.

    timeout: a rank that waits for others for more seconds than this ends the job and says in which phase; 0: for ever.
    """

    def __init__(self, comm, *, timeout=0.0):
        from mpi4py import MPI
        self._mpi, self._timeout, self._phase = MPI, float(timeout), "begin"
        self._comm, self.rank, self.size = comm, comm.Get_rank(), comm.Get_size()
        if self._timeout > 0:
            self._comm, request = comm.Idup()
            self._wait(lambda: [request], "beginning")
        else:
            self._comm = comm.Dup()
        self._comm.Set_errhandler(MPI.ERRORS_RETURN)
        self._neighbours = None

    def free(self):
        """All ranks call it; no frame is drawn after it."""
        if self._comm:
            self._comm.Free()

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self.free()

    @property
    def neighbours(self):
        """How many of the ranks are on this machine. All ranks must ask together the first time."""
        if self._neighbours is None:
            here = self._comm.Split_type(self._mpi.COMM_TYPE_SHARED)
            self._neighbours = here.Get_size()
            here.Free()
        return self._neighbours

    def begin_phase(self, name):
        self._phase = name

    def _end_job(self, why):
        print(f"rastrum: error: rank {self.rank} {why}", file=sys.stderr, flush=True)
        self._comm.Abort(1)

    def _wait(self, begin, what):
        """Waits for the requests that begin() makes."""
        try:
            requests = begin()
            if self._timeout <= 0:
                self._mpi.Request.Waitall(requests)
                return
            since = time.monotonic()
            while not self._mpi.Request.Testall(requests):
                if time.monotonic() - since > self._timeout:
                    self._end_job(f"has waited {self._timeout} s for the others ({what}, phase '{self._phase}') and ends the job: "
                                  "one of them has died, hangs, or needs longer than the timeout")
                time.sleep(1e-4)
        except BaseException as e:
            # The others wait for a message that is not going to come.
            self._end_job(f"({what}, phase '{self._phase}'): {type(e).__name__}: {e}")
            raise

    def max(self, value):
        own, most, mpi = np.array([value], np.uint64), np.empty(1, np.uint64), self._mpi
        self._wait(lambda: [self._comm.Iallreduce([own, mpi.UINT64_T], [most, mpi.UINT64_T], mpi.MAX)], "agreeing on a number")
        return int(most[0])

    def broadcast(self, buffer, root):
        for begin in range(0, len(buffer), _MOST):
            piece = buffer[begin:begin + _MOST]
            self._wait(lambda: [self._comm.Ibcast([piece, self._mpi.BYTE], root)], "telling all ranks")

    def exchange_sizes(self, to, received):
        kind = self._mpi.UINT64_T
        self._wait(lambda: [self._comm.Ialltoall([to, 1, kind], [received, 1, kind])], "exchanging sizes")

    def exchange(self, to, received):
        received[self.rank][:] = to[self.rank]
        for step in range(1, self.size):
            target, source = (self.rank + step) % self.size, (self.rank - step) % self.size
            out, into = to[target], received[source]
            # Piece k of one rank meets piece k of the other, so nobody waits for a later one.
            for at in range(0, max(len(out), len(into)), _MOST):
                sent, taken = out[at:at + _MOST], into[at:at + _MOST]

                def begin():
                    requests = []
                    if len(taken):
                        requests.append(self._comm.Irecv([taken, self._mpi.BYTE], source, 1))
                    if len(sent):
                        requests.append(self._comm.Isend([sent, self._mpi.BYTE], target, 1))
                    return requests
                self._wait(begin, "exchanging blocks")


class _Kept:
    """The caller's own Ranks, which the caller frees."""

    def __init__(self, ranks):
        self._ranks = ranks

    def __enter__(self):
        return self._ranks

    def __exit__(self, *exception):
        pass


def _ranks_of(comm, timeout):
    mpi = sys.modules.get("mpi4py.MPI")
    if mpi is not None and isinstance(comm, mpi.Comm):
        if comm == mpi.COMM_NULL or not comm.Is_intra():
            raise ArgumentError("comm: must be a communicator within one group, and not COMM_NULL")
        return Ranks(comm, timeout=timeout)
    functions = ("rank", "size", "begin_phase", "max", "broadcast", "exchange_sizes", "exchange")
    if all(hasattr(comm, name) for name in functions):
        return _Kept(comm)
    raise ArgumentTypeError(f"comm: must be a communicator of mpi4py, or have what rastrum.mpi.Communicator has, not {comm!r}")


class _Together:
    """Steps that all ranks of a frame take together."""

    def __init__(self, ranks, interrupt):
        self.ranks, self.interrupt = ranks, interrupt
        self.rank, self.size = ranks.rank, ranks.size

    def alike(self, work):
        """Returns this rank's work(), which must call no function of the ranks. If it raises on one rank, all ranks
        raise the same, with that rank's number."""
        value = failure = None
        try:
            value = work()
            self.interrupt.raise_()
        except BaseException as e:
            failure = e
        worst = self.ranks.max(0 if failure is None else self.size - self.rank)
        if worst == 0:
            return value
        speaker = self.size - worst
        said = bytearray(_TEXT)
        if speaker == self.rank:
            kind = type(failure).__name__
            known = hasattr(_errors, kind) or isinstance(failure, (KeyboardInterrupt, MemoryError))
            if isinstance(failure, KeyboardInterrupt):
                failure.args = failure.args or ("interrupted",)
            text = f"{kind if known else 'RuntimeError'}\n{str(failure) if known else f'{kind}: {failure}'}"
            text = text.encode(errors="replace")[:_TEXT - 1]
            said[:len(text)] = text
        self.ranks.broadcast(memoryview(said), speaker)
        kind, _, text = bytes(said).rstrip(b"\0").decode(errors="replace").partition("\n")
        kinds = {"KeyboardInterrupt": KeyboardInterrupt, "MemoryError": _errors.OutOfMemoryError, "RuntimeError": RuntimeError}
        raise (kinds.get(kind) or getattr(_errors, kind, Error))(f"rank {speaker}: {text or kind}") from failure

    def gather(self, number):
        """A list of the numbers that the ranks give, one each."""
        own, all_of_them = np.full(self.size, number, np.uint64), np.empty(self.size, np.uint64)
        self.ranks.exchange_sizes(memoryview(own).cast("B"), memoryview(all_of_them).cast("B"))
        return [int(n) for n in all_of_them]

    def equal(self, kind, what):
        """Raises ArgumentError on all ranks unless all give the same `kind`: what they do together depends on it."""
        numbers = set(self.gather(zlib.crc32(repr(kind).encode())))

        def check():
            if len(numbers) > 1:
                raise ArgumentError(f"the ranks were given different {what}")
        self.alike(check)

    def until_done(self, draw):
        """Returns draw(), which is None where Ctrl-C stopped the frame; draws again if its handler raised nothing."""
        while (done := draw()) is None:
            self.alike(lambda: None)
        return done


def _pick(*_):
    raise UnsupportedError("pick: what is under a pixel lies on another rank; ask for the outputs id, position and face")


# A renderer for each thread, since ranks may be threads and all draw at once.
_local = threading.local()


def _renderer(threads, device, memory_limit, isa):
    kept = _local.__dict__.setdefault("renderers", {})
    key = threads, device, memory_limit, isa
    if key not in kept:
        kept[key] = Renderer(threads=threads, device=device, memory_limit=memory_limit, isa=isa)
    return kept[key]


def _own_threads(neighbours):
    """Ranks of one machine share its cores."""
    if os.environ.get("RASTRUM_NUM_THREADS"):
        return _number_of_threads()
    return max(1, _number_of_threads() // neighbours)


@raises_errors
def _frame(frame):
    """All arguments of Renderer.render by name."""
    defaults = Renderer.render.__wrapped__.__kwdefaults__
    for name in frame:
        if name not in defaults:
            raise ArgumentTypeError(f"render() got an unexpected keyword argument {name!r}")
    return {**defaults, **frame}


def render(comm, what, camera=None, *, parts=None, root=0, timeout=0.0, exchange="automatic", fragment_bytes=1 << 30,
           threads=None, device="threads", memory_limit=0, isa=None, **frame):
    """Returns the Picture (or Pictures) of the things of all ranks of `comm` on rank `root`, and None on the others.
    All ranks call it, with the same arguments except `what` and `out`, which is the root's. Arrays are drawn where they
    lie.

    comm: a communicator of mpi4py, or Ranks, or an object with the functions of Communicator. what: as in rr.render; []
    on a rank that has nothing. camera: None sees the whole from the front; fit() makes others. parts: the number of each
    instance of `what`; one process would draw all instances in rising order of these, each number once; None: rank 0's
    come first, then rank 1's. timeout: as in Ranks. exchange, fragment_bytes: docs/ranks_traffic.md. threads: None: this
    rank's share of the machine's cores. The other parameters are those of rr.render. Transparency other than "exact" and
    "none" is refused, and so is environment_behind.

    A failure on one rank is raised on all of them, with its number: "rank 3: ..."; Ctrl-C on one is KeyboardInterrupt
    on all, once the others have done their part. A picture's pick() is refused: the scene lies on other ranks, too.
    """
    with _r.DeferredInterrupt() as interrupt, _ranks_of(comm, timeout) as ranks:
        together = _Together(ranks, interrupt)
        scene = together.alike(lambda: as_scene(what))
        mine, has_materials, primitives = together.alike(
            lambda: (int(scene._made.instances), bool(scene._made.has_materials), int(scene.primitives)))
        o = together.alike(lambda: _frame(frame))
        many = together.alike(lambda: _is_many(camera))
        together.equal((camera is None, len(camera) if many else -1, bool(o["annotate"]), _of_files(o["lights"])),
                       "cameras, annotations or lights of files")
        counts, primitives = together.gather(mine), sum(together.gather(primitives))
        has_materials = any(together.gather(has_materials))
        lights = _all_lights(together, scene, o["lights"])
        # All ask, since each may have an environment and `threads` of its own.
        neighbours = getattr(ranks, "neighbours", ranks.size)

        def prepare():
            if isinstance(root, bool) or not isinstance(root, (int, np.integer)) or not 0 <= root < ranks.size:
                raise ArgumentError(f"root: must be a rank from 0 to {ranks.size - 1}, not {root!r}")
            numbers = parts
            if numbers is None:
                numbers = range(sum(counts[:ranks.rank]), sum(counts[:ranks.rank + 1]))
            if o["progress"] is not None and not isinstance(o["progress"], bool) and not callable(o["progress"]):
                raise ArgumentTypeError(f"progress: {o['progress']!r} cannot be called")
            own = _own_threads(neighbours) if threads is None else threads
            return (_renderer(own, device, memory_limit, isa), _look([scene], **{**_looks(o), "lights": lights}),
                    _r.RanksFrame(int(root), exchange, int(fragment_bytes), _numbers(numbers, mine), has_materials),
                    _annotations(o["annotate"]))
        renderer, (look, size), options, notes = together.alike(raises_errors(prepare))
        # A fit is of all ranks, so they make it together.
        fitted = _fit(together, scene, "front", (0, 1, 0), 60.0, False, size, notes) if camera is None else None

        # The ball of all ranks, so that they have one camera.
        ball = _r.ball_of_ranks(together.ranks, scene._made) if camera is not None else None

        def look_at():
            cameras = [as_camera(c, scene) for c in camera] if many else [fitted or as_camera(camera, scene)]
            if not cameras:
                raise ArgumentError("camera: the sequence has no camera; give at least one")
            arrays = {}
            if ranks.rank == root:
                arrays = _arrays(o["outputs"], o["out"], len(cameras), many, size[::-1], primitives)
                if notes is not None and not {"color", "color_f32"} & set(arrays):
                    raise ArgumentError("annotate: is drawn into color or color_f32; ask for one of them by outputs")
            return [c._make(size, ball) for c in cameras], arrays
        cameras, arrays = together.alike(raises_errors(look_at))
        progress = _bar if o["progress"] is True and sys.stderr.isatty() else o["progress"] or None
        stats = []
        for i, one in enumerate(cameras):
            filled = {name: a[i:i + 1] if many else a[np.newaxis] for name, a in arrays.items()}
            stats.append(together.until_done(lambda: _r.render_parts(
                renderer._renderer(), ranks, scene._made, one, look, filled, options, notes, interrupt)))
            together.alike(lambda: progress(i + 1, len(cameras)) if callable(progress) and arrays else None)
        if not arrays:
            return None
        return Pictures(arrays, stats, [_pick] * len(cameras)) if many else Picture(arrays, stats[0], _pick)


def fit(comm, what, view="front", *, up=(0, 1, 0), fov=60.0, orthographic=False, size=(1280, 720)):
    """Returns the Camera that sees the things of all ranks of `comm`, for pictures of `size`. It is made as Camera.fit does it,
    and is the same on each rank."""
    with _r.DeferredInterrupt() as interrupt, _ranks_of(comm, 0) as ranks:
        together = _Together(ranks, interrupt)
        scene = together.alike(lambda: as_scene(what))
        return _fit(together, scene, view, up, fov, orthographic, size, None)


def _fit(together, scene, view, up, fov, orthographic, size, notes):
    @raises_errors
    def checked():
        way, upward = view, _triple(up, "up")
        if isinstance(view, str):
            way, upward = _r.view(view, upward)
        else:
            way = [-v for v in _triple(view, "view")]
        width, height = (int(n) for n in size)
        return list(way), list(upward), float(fov), bool(orthographic), width, height
    arguments = together.alike(checked)
    made = _r.fit_of_ranks(together.ranks, scene._made, *arguments, notes)
    return Camera._of(made)


def _numbers(parts, instances):
    numbers = [int(n) for n in parts]
    if len(numbers) != instances or any(not 0 <= n < 2**63 for n in numbers):
        raise ArgumentError(f"parts: {parts!r} must be {instances} numbers from 0, one for each instance of `what`")
    return numbers


def _looks(o):
    """The arguments of a frame that _look takes."""
    return {name: o[name] for name in ("size", "shader", "background", "samples", "transparency", "cull", "opacity", "clip_planes",
                                       "lights", "shadows", "shadow_size", "shadow_distance", "tone", "exposure", "environment_behind")}


def _of_files(lights):
    return lights == "file" if isinstance(lights, str) else isinstance(lights, (list, tuple)) and any(
        isinstance(light, str) and light == "file" for light in lights)


def _all_lights(together, scene, wanted):
    """`wanted`, with "file" replaced by the lights of all ranks' files."""
    if not _of_files(wanted):
        return wanted
    of_all = _r.lights_of_ranks(together.ranks, scene._made.lights)

    class Files:
        lights = of_all
    made = []
    for name in [wanted] if isinstance(wanted, str) else wanted:
        made += together.alike(lambda: _lights(name, Files))
    return made
