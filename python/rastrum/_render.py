# SPDX-License-Identifier: BSD-3-Clause
"""Pictures: what is drawn, by whom, and into which arrays."""

import atexit
import copy
import math
import operator
import os
import sys
import typing
import weakref
from collections.abc import Mapping

import numpy as np

from . import _rastrum as _r
from ._annotate import annotations as _annotations
from ._arrays import color as _color
from ._arrays import _numbers, floats, number
from ._camera import Camera, as_camera
from ._errors import ArgumentError, ArgumentTypeError, MissingOutputError, PictureIndexError, UnsupportedError, names_arguments, raises_errors
from ._files import refuse_inputs, shallow, whole
from ._lights import lights as _lights
from ._scene import as_scene

#: name: (dtype, numbers a pixel)
OUTPUTS = {name: (np.dtype(dtype).type, channels) for name, dtype, channels in _r.OUTPUTS}
# Numbers; below, memory is not new pages anyway.
_LARGE = 1 << 16


def digest(array):
    """SHA-256 of a picture's pixels in 64 hexadecimal digits, as C++'s digest() and the program's --hash have it."""
    import hashlib
    array = np.ascontiguousarray(array)
    if array.dtype.kind not in "biuf":
        raise ArgumentTypeError(f"digest: must be given an array of numbers, such as a picture's color, not one of {array.dtype}")
    if array.dtype.kind == "f" and np.isnan(array).any():
        array = array.copy()
        array.view(np.uint32)[np.isnan(array)] = 0x7FC00000
    shape = "x".join(map(str, array.shape))
    return hashlib.sha256(f"{array.dtype} {shape}\n".encode() + array.astype(array.dtype.newbyteorder("<")).tobytes()).hexdigest()


def _number_of_threads():
    """RASTRUM_NUM_THREADS, else the cores that this process may use, by affinity and its cgroup's quota."""
    given = os.environ.get("RASTRUM_NUM_THREADS", "")
    if given:
        if not given.isdigit() or int(given) < 1:
            raise ArgumentError(f"RASTRUM_NUM_THREADS: must be a whole number from 1 on, not {given!r}")
        return int(given)
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    try:
        with open("/sys/fs/cgroup/cpu.max", encoding="ascii") as file:
            quota, period = file.read().split()
        if quota != "max":
            cores = min(cores, max(1, math.ceil(int(quota) / int(period))))
    except (OSError, ValueError):
        pass
    return cores


def thread_count(threads):
    if isinstance(threads, bool) or not isinstance(threads, (int, np.integer)) or not 1 <= threads <= 1024:
        raise ArgumentError(f"threads: {threads!r} must be a whole number from 1 to 1024")
    return int(threads)


class Hit(typing.NamedTuple):
    """The primitive under a pixel, and the place on it. barycentrics: the weights of its three corners. position, normal: in
    the world. depth: along the camera's axis. distance: from the eye. scalar: interpolated there, None without scalars."""
    id: int
    instance: int
    face: int
    barycentrics: tuple
    position: tuple
    normal: tuple
    depth: float
    distance: float
    scalar: float | None = None


def _no_pick(x, y):
    raise UnsupportedError("pick: pickle carries a picture without the scene that it shows; pick where it was drawn")


class _Fields:
    """Arrays by name, as attributes."""

    def __init__(self, arrays, stats):
        self.arrays, self.stats = arrays, stats

    def __copy__(self):
        return shallow(self)

    def __deepcopy__(self, memo):
        made = shallow(self)
        made.arrays, made.stats = copy.deepcopy((self.arrays, self.stats), memo)
        return made

    def __getattr__(self, name):
        arrays = self.__dict__.get("arrays", {})
        if name in arrays:
            return arrays[name]
        if name in OUTPUTS:
            raise MissingOutputError(f"{name}: was not drawn; ask for it by outputs=({name!r}, ...)")
        raise AttributeError(name)

    def __dir__(self):
        return [*super().__dir__(), *self.arrays]


def _save_npy(of, path, output):
    name = output or ("color" if "color" in of.arrays or len(of.arrays) != 1 else next(iter(of.arrays)))
    array = getattr(of, name)
    with whole(path) as file:
        np.save(file, array)


def _numbered(path, i):
    try:
        name = path % i
    except (TypeError, ValueError) as e:
        raise ArgumentError(f"{path}: one number is expected, as in frame_%03d.png") from e
    return name


class Picture(_Fields):
    """One frame: its outputs as attributes, NumPy arrays with row 0 at the top.

    color: uint8 (H, W, 4), straight alpha. color_f32: float32, premultiplied. depth: float32 (H, W), along the axis in
    world units, 0 where nothing is. depth_raw: reversed. distance: from the eye. id, instance, face: int32 (int64 from
    2**31 primitives), -1 where nothing is. barycentrics: (H, W, 2). normal, position, camera_normal: (H, W, 3). albedo,
    linear: (H, W, 4). scalars: float32 (H, W), the things' numbers, NaN where there are none. stats: a dict.
    """

    def __init__(self, arrays, stats, pick, files=()):
        super().__init__(arrays, stats)
        self._pick, self._files = pick, files

    def __reduce__(self):
        return type(self), (self.arrays, self.stats, _no_pick, self._files)

    @raises_errors
    def pick(self, x, y):
        """Returns the Hit at pixel (x, y), or None. It reads the scene's arrays as they are now."""
        return self._pick(int(x), int(y))

    def save(self, path, output=None):
        """Writes a .png of `color`, or a .npy of one output (default: the only one, or `color`). If writing fails, the file
        stays as it was before. Raises if the scene was read from that file."""
        path = os.fspath(path)
        refuse_inputs(path, self._files)
        if path.lower().endswith(".png"):
            _r.write_png(path, np.ascontiguousarray(self.color), _number_of_threads())
        elif path.lower().endswith(".npy"):
            _save_npy(self, path, output)
        else:
            raise ArgumentError(f"{path}: pictures are saved as .png or .npy")
        return self

    def pil(self):
        """Returns `color` as a PIL image."""
        from PIL import Image
        return Image.fromarray(self.color, "RGBA")

    def _repr_png_(self):
        if "color" not in self.arrays:
            return None
        import pathlib
        import tempfile
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "picture.png"
            self.save(file)
            return file.read_bytes()


class Pictures(_Fields):
    """Several frames: the fields of Picture with a leading N, `stats` a list, and each Picture by its number."""

    def __init__(self, arrays, stats, picks, files=()):
        super().__init__(arrays, stats)
        self._picks, self._files = picks, files

    def __reduce__(self):
        return type(self), (self.arrays, self.stats, [_no_pick] * len(self), self._files)

    def __len__(self):
        return len(self.stats)

    def __getitem__(self, i):
        if isinstance(i, slice):
            return Pictures({name: a[i] for name, a in self.arrays.items()}, self.stats[i], self._picks[i], self._files)
        if not -len(self) <= operator.index(i) < len(self):
            raise PictureIndexError(f"there are {len(self)} pictures, and none has the number {i}")
        return Picture({name: a[i] for name, a in self.arrays.items()}, self.stats[i], self._picks[i], self._files)

    def save(self, path, output=None):
        """Writes each picture to its own file if the name has a number (frame_%03d.png, counted from 0); else writes one output
        of all pictures to a .npy."""
        path = os.fspath(path)
        if "%" in path:
            names = [_numbered(path, i) for i in range(len(self))]
            for name in names:
                refuse_inputs(name, self._files)
            for name, picture in zip(names, self):
                picture.save(name, output)
        elif path.lower().endswith(".npy"):
            refuse_inputs(path, self._files)
            _save_npy(self, path, output)
        else:
            raise ArgumentError(f"{path}: there are {len(self)} pictures; number them, as in frame_%03d.png, or save sheet()")
        return self

    def _repr_png_(self):
        return self.sheet()._repr_png_() if "color" in self.arrays else None

    def sheet(self, columns=None):
        """Returns one Picture with all colours side by side."""
        n, h, w, _ = self.color.shape
        if n == 0:
            raise ArgumentError("sheet: there are no pictures")
        columns = math.ceil(math.sqrt(n)) if columns is None else columns
        if isinstance(columns, bool) or not isinstance(columns, (int, np.integer)) or columns < 1:
            raise ArgumentError(f"columns: {columns!r} must be a whole number from 1 on")
        rows = math.ceil(n / columns)
        sheet = np.zeros((rows * h, columns * w, 4), np.uint8)
        for i, picture in enumerate(self.color):
            y, x = i // columns * h, i % columns * w
            sheet[y:y + h, x:x + w] = picture
        def pick(x, y):
            i = y // h * columns + x // w
            return self._picks[i](x % w, y % h) if 0 <= i < n else None
        return Picture({"color": sheet}, {"pictures": self.stats}, pick, self._files)


def _bar(done, total):
    end = "\n" if done == total else ""
    print(f"\r{done} of {total}", end=end, file=sys.stderr, flush=True)


_renderers = weakref.WeakSet()


def _after_fork():
    # The threads of the parent are not here; each Renderer makes its own again.
    for renderer in _renderers:
        renderer._forget()
    _default.clear()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_after_fork)


class Renderer:
    """Draws frames, and keeps threads and memory between them. Several may draw at once, a thread each; one that is
    shared draws one frame after the other.

    threads: None takes RASTRUM_NUM_THREADS or the cores that this process may use. memory_limit: the most bytes of memory
    beside meshes and pictures, 0 for no limit; what does not fit at once is drawn piece by piece. device: threads, serial,
    cuda or auto. isa: scalar, sse4, avx2, avx512, neon or wasm, None takes the best that this machine has; the picture is the same.
    """

    @raises_errors
    def __init__(self, *, threads=None, memory_limit=0, device="threads", isa=None):
        threads = _number_of_threads() if threads is None else threads
        threads = thread_count(threads)
        if isinstance(memory_limit, bool) or not isinstance(memory_limit, (int, np.integer)) or memory_limit < 0:
            raise ArgumentError(f"memory_limit: {memory_limit!r} must be a number of bytes")
        self._options = threads, int(memory_limit), _text(device, "device"), isa if isa is None else _text(isa, "isa")
        self._made = None
        self._renderer()
        _renderers.add(self)

    def __reduce__(self):
        return _renderer_again, self._options

    def _renderer(self):
        if self._made is None:
            self._made = _r.Renderer(*self._options)
        return self._made

    _lost = []

    def _forget(self):
        # Kept for ever: its end would wait for threads that are not here.
        Renderer._lost.append(self._made)
        self._made = None

    @names_arguments
    def render(self, what, camera=None, *, size=(1280, 720), outputs="color", shader="auto", background=None, samples=1,
               transparency="exact", cull="none", opacity=1.0, clip_planes=(), lights=None, shadows=False, shadow_size=0,
               shadow_distance=0.0, tone="none", exposure=0.0, environment_behind=False, annotate=(), out=None, progress=None):
        """Returns a Picture of `what` for one camera, or Pictures for a sequence of cameras or an (N, 4, 4) array.

        what: anything that as_scene takes. camera: a Camera, a (4, 4), or None: the whole scene from the front. size: (W, H).
        outputs: names of Picture's fields. shader: auto, flat, depth, normal, id, lambert, phong, material, wireframe, classic.
        background: a colour, None: transparent. samples: 1, 4, 8 or 16 a pixel. transparency: exact, unsorted, none.
        cull: none, back, front. clip_planes: rows (x, y, z, d); only what lies at x X + y Y + z Z + d >= 0 in the world is drawn.
        lights: for the shaders lambert, phong, material and classic: headlight, studio (key, fill, back and head light), file (the lights of
        glTF files), a Light, or a list of these; None: each shader's fixed light. shadows: whether directional lights and spots
        throw them. shadow_size: the largest width of a shadow map in texels, 0: the frame's size decides. shadow_distance: how
        far from the eye shadows are drawn, 0: as far as the picture sees. tone, exposure: for material: none, reinhard, aces or
        neutral shows light brighter than white, after `exposure` doublings. environment_behind: shows the environments among the
        lights where nothing else is seen.
        annotate: what is drawn over the colours, by name, or {name: options}: "occlusion" (radius, in world units,
        strength), "edl" (strength), "silhouettes", "edges" (angle, in degrees: only edges whose faces meet at
        more, such as creases and borders; width, px), "axes", "bounds", "bar" (for scalars; title, unit, nan: True shows the
        colour of missing numbers), "title", "captions" (a list), "text_scale". With camera=None there is room for "bounds" and "bar".
        out: {name: array}, filled in place, (H, W, ...) or with a leading N. progress: a function that is called with (done,
        total) after each frame, or True to show a count on a terminal.
        Raises rastrum.Error of the natural class; KeyboardInterrupt in a frame leaves the arrays partly filled.
        """
        scenes, made, frame, arrays, many, notes = _prepared(what, camera, size, outputs, shader, background, samples,
                                                             transparency, cull, opacity, clip_planes, lights, shadows, shadow_size, shadow_distance, tone,
                                                             exposure, environment_behind, annotate, out)
        if progress is True:
            progress = _bar if sys.stderr.isatty() else None
        if progress is not None and not callable(progress):
            raise ArgumentTypeError(f"progress: {progress!r} cannot be called")
        states = what.states if isinstance(what, _Many) else None
        stats = self._renderer().render([scene._made for scene in scenes], states, made, frame,
                                        {name: a if many else a[np.newaxis] for name, a in arrays.items()}, notes, progress)

        def picker(scene, camera):
            def pick(x, y):
                if states is not None:
                    raise UnsupportedError("pick: the scene has other transforms now; draw one state alone to pick in it")
                scene._read_again()
                found = self._renderer().pick(scene._made, camera, frame, x, y)  # a forked child has another one
                return None if found is None else Hit(**found)
            return pick
        files = tuple(file for scene in scenes for file in scene._read_from)
        picks = [picker(scene, c) for scene, c in zip(_for_each(scenes, made), made)]
        return Pictures(arrays, stats, picks, files) if many else Picture(arrays, stats[0], picks[0], files)

    @names_arguments
    def render_many(self, what, cameras=None, *, transforms=None, **frame):
        """Returns Pictures of many scenes, or of many states of one, by one call. Pictures of up to 512 x 512 pixels are drawn side by
        side, a thread each, if each thread's share of memory_limit is at least 64 MiB.

        what: a sequence of N scenes, each anything that as_scene takes; with `transforms` one scene. cameras: a sequence of N, or one
        for all; None: each scene from the front, as it stands without `transforms`. transforms: (N, T, 4, 4), from object to world, for
        the scene's T things in each of N states; files keep their places. frame: as in render; lights of files ("file") are not for several scenes.
        """
        states = None
        if transforms is not None:
            scenes = [as_scene(what)]
            states = _states(transforms, len(scenes[0].things))
        elif isinstance(what, (str, os.PathLike, Mapping)) or not hasattr(what, "__len__"):
            raise ArgumentTypeError(f"what: must be a sequence of scenes, or one scene with transforms, not {what!r}")
        else:
            given = list(what)
            read = {id(one): as_scene(one) for one in {id(one): one for one in given}.values()}  # each once
            scenes = [read[id(one)] for one in given]
        number = len(scenes) if states is None else len(states)
        if number == 0:
            raise ArgumentError("what: there is no scene" if states is None else "transforms: there is no state")
        if not _is_many(cameras):
            cameras = [cameras] * number
        if len(cameras) != number:
            raise ArgumentError(f"cameras: there are {len(cameras)} for {number} pictures")
        return self.render(_Many(scenes, states), list(cameras), **frame)


class _Many(typing.NamedTuple):
    """A scene for each camera, or one in several states: render_many hands it to render."""
    scenes: list
    states: object


@raises_errors
def _states(transforms, things):
    states = _numbers(transforms, "transforms")
    if states.dtype.kind not in "fiu":
        raise ArgumentTypeError(f"transforms: must be an array of numbers, not of {states.dtype}")
    states = np.ascontiguousarray(states, np.float64)
    if states.ndim != 4 or states.shape[1:] != (things, 4, 4):
        raise ArgumentError(f"transforms: the shape is {states.shape} and must be (N, {things}, 4, 4): the scene has {things} things")
    return states


def _for_each(scenes, cameras):
    return scenes if len(scenes) == len(cameras) else scenes * len(cameras)


def _renderer_again(threads, memory_limit, device, isa):
    return Renderer(threads=threads, memory_limit=memory_limit, device=device, isa=isa)


@raises_errors
def _prepared(what, camera, size, outputs, shader, background, samples, transparency, cull, opacity, clip_planes,
              lights, shadows, shadow_size, shadow_distance, tone, exposure, environment_behind, annotate, out):
    """(scenes, cameras, frame, arrays, whether there are several pictures, annotations)"""
    scenes = what.scenes if isinstance(what, _Many) else [as_scene(what)]
    many = _is_many(camera)
    cameras = list(camera) if many else [camera]
    if not cameras:
        raise ArgumentError("camera: the sequence has no camera; give at least one")
    fitted = [c is None for c in cameras]
    of_each = _for_each(scenes, cameras)
    fits = {scene: as_camera(None, scene) for c, scene in zip(cameras, of_each) if c is None}
    cameras = [fits[scene] if c is None else as_camera(c, scene) for c, scene in zip(cameras, of_each)]
    frame, (width, height) = _look(scenes, size, shader, background, samples, transparency, cull, opacity, clip_planes, lights,
                                   shadows, shadow_size, shadow_distance, tone, exposure, environment_behind)
    states = [None] * len(cameras) if not isinstance(what, _Many) or what.states is None else what.states
    made, balls = [], {}
    for camera, scene, state in zip(cameras, of_each, states):
        if camera._asks and (state is not None or scene not in balls):
            balls[scene] = scene._made.ball(state)
        made.append(camera._make((width, height), balls[scene] if camera._asks else None))
    notes = _annotations(annotate)
    if notes is not None:
        made = [notes.with_room(c, scene._made, width, height) if f else c for f, c, scene in zip(fitted, made, of_each)]
    arrays = _arrays(outputs, out, len(made), many, (height, width), max(scene.primitives for scene in scenes))
    if notes is not None and not {"color", "color_f32"} & set(arrays):
        raise ArgumentError("annotate: is drawn into color or color_f32; ask for one of them by outputs")
    return scenes, made, frame, arrays, many, notes


def _look(scenes, size, shader, background, samples, transparency, cull, opacity, clip_planes, lights, shadows, shadow_size,
          shadow_distance, tone, exposure, environment_behind):
    """(frame, (width, height))"""
    width, height = _size(size)
    if isinstance(samples, bool) or not isinstance(samples, (int, np.integer)):
        raise ArgumentTypeError(f"samples: must be 1, 4, 8 or 16, not {samples!r}")
    if len(scenes) > 1 and (lights == "file" or isinstance(lights, (list, tuple)) and "file" in lights):
        raise ArgumentError("lights: those of files are not for several scenes")
    made = _lights(lights, scenes[0]._made)
    if shadows and not any(light.throws_shadows for light in made):
        raise ArgumentError("shadows: only directional lights and spots throw them, and none of the lights does; take lights='studio', or a rastrum.Light")
    return _r.frame(width, height, _text(shader, "shader"), _text(cull, "cull"),
                    [0.0] * 4 if background is None else list(_color(background, "background")), number(opacity, "opacity", 0, 1),
                    _text(transparency, "transparency"), samples,
                    [] if len(clip_planes) == 0 else floats(clip_planes, "clip_planes", (4,)).tolist(),
                     made, bool(shadows), int(shadow_size), number(shadow_distance, "shadow_distance"), _text(tone, "tone"), number(exposure, "exposure"),
                    bool(environment_behind)), (width, height)


def _text(value, name):
    if not isinstance(value, str):
        raise ArgumentTypeError(f"{name}: must be a name, not {value!r}")
    return value


def empty(shape, dtype):
    """np.empty, where it is large in the place of an array that has died."""
    pixels = math.prod(shape)
    return _r.empty(shape, np.dtype(dtype).name) if pixels > _LARGE else np.empty(shape, dtype)


def _is_many(camera):
    return isinstance(camera, (list, tuple)) or np.ndim(camera) == 3 and not isinstance(camera, Camera)


def _size(size):
    try:
        width, height = size
        whole = width == int(width) and height == int(height)
    except (TypeError, ValueError) as e:
        raise ArgumentTypeError(f"size: must be (width, height), not {size!r}") from e
    if not whole or not (1 <= width <= 32768 and 1 <= height <= 32768):
        raise ArgumentError(f"size: {size!r} is outside of 1 x 1 to 32768 x 32768")
    return int(width), int(height)


def _arrays(outputs, out, number, many, shape, primitives):
    names = [outputs] if isinstance(outputs, str) else list(outputs)
    if out is not None and not isinstance(out, Mapping):
        raise ArgumentTypeError(f"out: must be arrays by name, as in {{'depth': array}}, not {type(out).__qualname__}")
    given = {} if out is None else dict(out)
    if out is not None and outputs == "color" and "color" not in given:
        names = []
    arrays = {}
    for name in [*names, *(n for n in given if n not in names)]:
        if name not in OUTPUTS:
            import difflib  # as other modules that few calls need: imports are a script's time
            near = difflib.get_close_matches(str(name), OUTPUTS, 1, 0.75)
            raise ArgumentError(f"outputs: there is no {name!r}" + (f", {near[0]!r} perhaps" if near else "") +
                                f"; take some of {', '.join(OUTPUTS)}")
        dtype, channels = OUTPUTS[name]
        expected = (number,) * many + shape + (channels,) * (channels > 1)
        if name in given:
            array = given[name]
            if not isinstance(array, np.ndarray) or not array.flags.writeable or not array.flags.c_contiguous:
                raise ArgumentTypeError(f"out[{name!r}]: must be a C-contiguous NumPy array that can be written")
            if not array.dtype.isnative:
                raise ArgumentTypeError(f"out[{name!r}]: its bytes are in the other order")
            if array.shape != expected:
                raise ArgumentError(f"out[{name!r}]: the shape is {array.shape} and must be {expected}")
            arrays[name] = array
        else:
            wide = dtype is np.int32 and primitives > 0x7FFFFFFF
            arrays[name] = empty(expected, np.int64 if wide else dtype)
    if not arrays:
        raise ArgumentError("outputs: is empty; ask for at least one")
    return arrays


_default = {}
# Before the interpreter takes the module apart.
atexit.register(_default.clear)


@raises_errors
def _kept(threads, device, memory_limit, isa):
    key = threads, device, memory_limit, isa
    found = _default.get(key)
    if found is None:  # threads that come here at once all take the first one's
        found = _default.setdefault(key, Renderer(threads=threads, device=device, memory_limit=memory_limit, isa=isa))
    return found


@names_arguments
def render(what, camera=None, *, threads=None, device="threads", memory_limit=0, isa=None, **frame):
    """Draws one frame, or one for each camera. Renderer.render describes `frame`, Renderer the other parameters. A Renderer is
    kept for each set of these."""
    return _kept(threads, device, memory_limit, isa).render(what, camera, **frame)


@names_arguments
def render_many(what, cameras=None, *, threads=None, device="threads", memory_limit=0, isa=None, **frame):
    """Draws many scenes, or many states of one, by one call. Renderer.render_many describes `frame`, Renderer the other parameters."""
    return _kept(threads, device, memory_limit, isa).render_many(what, cameras, **frame)


def views4(what, *, size=(512, 512), **frame):
    """Returns one sheet with the front, right, top and three-quarter view."""
    scene = as_scene(what)
    cameras = [Camera.fit(scene, view) for view in ("front", "right", "top", "iso")]
    return render(scene, cameras, size=size, **frame).sheet(2)
