# SPDX-License-Identifier: BSD-3-Clause
"""A scene in a notebook that turns with the mouse: the kernel draws, the browser shows (_view.js)."""

import inspect
import math
import time

import numpy as np

from . import _rastrum as _r
from ._camera import Camera, as_camera, orbit
from ._errors import ArgumentError, ArgumentTypeError, Error, UnsupportedError, raises_errors
from ._render import Renderer, _size
from ._scene import as_scene

# As in the program's window (apps/rastrum/window): few sizes, so that a moving picture does not shimmer.
_SCALES = (1.0, 0.75, 0.5, 0.375, 0.25, 0.1875, 0.125)
_POLE = 0.01  # rad that the view keeps from straight up and down
_NEAREST, _FARTHEST = 1e-4, 1e4  # radii of the scene


class _Resolution:
    """Which of _SCALES to draw at while something moves, by the times that frames took: a fixed part and one by pixels."""

    def __init__(self, target_ms):
        self.target_ms, self.times, self.newest, self.other = target_ms, {}, None, None

    def add(self, step, ms):
        if self.newest is not None and self.newest != step:
            self.other = self.newest
        # Half of the past, so that one slow frame does not change the size.
        self.times[step] = (self.times[step] + ms) / 2 if step in self.times else ms
        self.newest = step

    def expected_ms(self, step):
        ms, pixels = self.times[self.newest], _SCALES[self.newest] ** 2
        rate = ms / pixels
        if self.other is not None:
            slope = (ms - self.times[self.other]) / (pixels - _SCALES[self.other] ** 2)
            rate = min(max(slope, 0.0), rate)
        return max(ms + rate * (_SCALES[step] ** 2 - pixels), 0.0)

    def moving(self):
        if self.newest is None:
            return _SCALES.index(0.5)
        last = len(_SCALES) - 1
        # Where triangles alone are too slow fewer pixels would not help.
        most = max(self.target_ms, 1.25 * self.expected_ms(last))
        return next((s for s in range(last) if self.expected_ms(s) <= most), last)


class _Orbit:
    """An eye about a target, moved by parts of the picture's smaller side."""

    def __init__(self, made, bounds):
        self.target, self.up = np.asarray(made.target), np.asarray(made.up) / np.linalg.norm(made.up)
        self.back = np.asarray(made.eye) - self.target
        self.fov, self.parallel, self.height = made.fov, made.is_orthographic, made.orthographic_height
        low, high = np.asarray(bounds if bounds is not None else ((-1, -1, -1), (1, 1, 1)), float)
        self.middle, self.radius = (low + high) / 2, math.dist(low, high) / 2 or 1.0
        self.first = made

    def turn(self, x, y):
        """Half a turn across the smaller side; the pole is not passed."""
        length = np.linalg.norm(self.back)
        rise = self.back @ self.up / length
        flat = self.back / length - rise * self.up
        if np.linalg.norm(flat) < 1e-9:  # looks straight down
            flat = np.cross(self.up, (1.0, 0.0, 0.0) if abs(self.up[0]) < 0.9 else (0.0, 0.0, 1.0))
        flat_length = np.linalg.norm(flat)
        flat = flat / flat_length
        side = np.cross(self.up, flat)
        limit = math.pi / 2 - _POLE
        pitch = min(max(math.asin(min(max(rise, -1.0), 1.0)) + math.pi * y, -limit), limit)
        yaw = -math.pi * x
        self.back = length * (math.cos(pitch) * (math.cos(yaw) * flat + math.sin(yaw) * side) + math.sin(pitch) * self.up)
        self.first = None

    def pan(self, x, y):
        """Moves the target so that things as far away as it stay under the pointer."""
        length = np.linalg.norm(self.back)
        across = self.height if self.parallel else 2 * length * math.tan(math.radians(self.fov) / 2)
        back = self.back / length
        right = np.cross(self.up, back)
        right = right / (np.linalg.norm(right) or 1.0)
        self.target = self.target + across * (-x * right + y * np.cross(back, right))
        self.first = None

    def zoom(self, times):
        """times > 1: nearer. A parallel projection shows less instead."""
        low, high = _NEAREST * self.radius, _FARTHEST * self.radius
        if self.parallel:
            self.height = min(max(self.height / times, low), high)
        else:
            length = np.linalg.norm(self.back)
            self.back = self.back * (min(max(length / times, low), high) / length)
        self.first = None

    def camera(self):
        """The first one as it was given until it is moved, then with planes about the scene."""
        if self.first is not None:
            return Camera._of(self.first)
        away = np.linalg.norm(self.back)
        if self.parallel:
            # An eye out of the scene; how far does not matter.
            back = self.back / away
            ahead = max(away, (self.middle - self.target) @ back + 1.01 * self.radius + self.radius / 100)
            eye = self.target + ahead * back
            reach = (eye - self.middle) @ back
            return Camera.orthographic(eye, self.target, self.up, height=self.height, near=max(reach - 1.01 * self.radius, 0.0),
                                       far=reach + 1.01 * self.radius)
        eye = self.target + self.back
        reach = (eye - self.middle) @ (self.back / away)
        return Camera.look_at(eye, self.target, self.up, fov=self.fov, near=max(reach - 1.01 * self.radius, away / 1000))


class _Session:
    """Answers the browser's messages: moves the view and draws the pictures to be sent. Knows no Jupyter."""

    def __init__(self, scene, camera, size, target_ms, renderer, frame, clock=time.perf_counter):
        self.scene, self.size, self.frame, self.clock = scene, size, frame, clock
        self._renderer, self._resolution = renderer, _Resolution(target_ms)
        self.start(camera)

    def start(self, camera):
        if camera is None:  # nothing leaves the picture when it turns
            camera, = orbit(self.scene, 1, fov=30)
        made = as_camera(camera, self.scene)._for_size(self.size, self.scene)
        if made.has_matrix:
            raise ArgumentError("camera: View can turn cameras of look_at, orthographic and fit, but not matrices")
        self._home = made
        self.home()

    def home(self):
        self._orbit = _Orbit(self._home, self.scene.bounds)

    @property
    def camera(self):
        return self._orbit.camera()

    def draw(self, step=0):
        size = tuple(max(1, round(n * _SCALES[step])) for n in self.size)
        return self._renderer.render(self.scene, self.camera, size=size, **self.frame)

    def receive(self, message):
        """(answer, buffers). message: {"turn": (x, y)}, {"pan": (x, y)}, {"zoom": times} while it moves, several in one;
        {"home": true}; {} when it rests: then the picture is whole."""
        try:
            self._move(message)
            moving = any(key in message for key in ("turn", "pan", "zoom"))
            step = self._resolution.moving() if moving else 0
            begin = self.clock()
            png = self.draw(step)._repr_png_()
            ms = 1000 * (self.clock() - begin)
            self._resolution.add(step, ms)
        except Error as e:
            return {"error": str(e)}, []
        return {"whole": step == 0, "ms": ms}, [png]

    def _move(self, message):
        if not isinstance(message, dict):
            raise ArgumentTypeError(f"message: must be a dict, not {message!r}")
        def numbers(key, count):
            value = message[key]
            value = list(value) if isinstance(value, (list, tuple)) else [value]
            if len(value) != count or not all(isinstance(v, (int, float)) and math.isfinite(v) for v in value):
                raise ArgumentError(f"message: {key} must be {count} finite numbers, not {message[key]!r}")
            return value
        for key in message:
            if key not in ("turn", "pan", "zoom", "home"):
                raise ArgumentError(f"message: there is no {key!r}; take turn, pan, zoom or home")
        if "home" in message:
            self.home()
        if "turn" in message:
            self._orbit.turn(*numbers("turn", 2))
        if "pan" in message:
            self._orbit.pan(*numbers("pan", 2))
        if "zoom" in message:
            times, = numbers("zoom", 1)
            if times <= 0:
                raise ArgumentError(f"message: zoom must be > 0, not {times!r}")
            self._orbit.zoom(times)


def _widget(session):
    """An anywidget whose messages the session answers."""
    try:
        import pathlib

        import anywidget
        import traitlets
    except ImportError as e:
        raise UnsupportedError("View: needs anywidget, which is not installed (pip install rastrum[jupyter])") from e

    class Widget(anywidget.AnyWidget):
        _esm = pathlib.Path(__file__).with_name("_view.js").read_text(encoding="utf-8")
        width = traitlets.Int(session.size[0]).tag(sync=True)
        height = traitlets.Int(session.size[1]).tag(sync=True)

    def on_message(widget, message, buffers):
        answer, pictures = session.receive(message)
        widget.send(answer, pictures)

    made = Widget()
    made.on_msg(on_message)
    return made


class View:
    """A widget for notebooks (pip install rastrum[jupyter]). Drag to turn; drag with Shift or the middle button to pan. The
    wheel zooms. A double click goes back to the beginning.

    what, camera, frame: as in render. The camera is made by look_at, orthographic or fit; None: one that sees the whole scene,
    however it turns. While it moves, pictures have as many pixels as can be drawn within target_ms; the whole picture
    follows. threads: as in Renderer.
    """

    @raises_errors
    def __init__(self, what, camera=None, *, size=(800, 600), target_ms=33.0, threads=None, **frame):
        for name in frame:
            if name in ("outputs", "out", "progress"):
                raise ArgumentTypeError(f"{name}: View shows only colours; leave this out")
            if name not in inspect.signature(Renderer.render).parameters:
                raise ArgumentTypeError(f"{name}: render has no such option")
        if not 1 <= float(target_ms) <= 10000:
            raise ArgumentError(f"target_ms: {target_ms!r} must lie in 1 to 10000")
        self._session = _Session(as_scene(what), camera, _size(size), float(target_ms), Renderer(threads=threads), frame)
        self._shown = _widget(self._session)

    @property
    def widget(self):
        """The widget itself, for ipywidgets' boxes."""
        return self._shown

    @property
    def camera(self):
        """The Camera of the shown picture, for render. Another one may be assigned; it becomes the beginning."""
        return self._session.camera

    @camera.setter
    @raises_errors
    def camera(self, camera):
        self._session.start(camera)
        self.update()

    def picture(self):
        """Returns the Picture that is shown, whole."""
        return self._session.draw()

    def update(self):
        """Draws again. Call it after arrays have changed in place."""
        self._shown.send(*self._session.receive({}))

    def _repr_mimebundle_(self, **kwargs):
        bundle = self._shown._repr_mimebundle_(**kwargs)
        data, metadata = bundle if isinstance(bundle, tuple) else (bundle, {})
        # The picture is for places that show notebooks without widgets.
        return {**(data or {}), "image/png": self.picture()._repr_png_()}, metadata
