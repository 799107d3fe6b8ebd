# SPDX-License-Identifier: BSD-3-Clause
"""The lights of a scene."""

import math
import os

import numpy as np

from . import _rastrum as _r
from ._arrays import color as _color
from ._arrays import _numbers, linear, number
from ._errors import ArgumentError, ArgumentTypeError, names_arguments, raises_errors

_NAMES = ("default", "headlight", "studio", "file")


def _three(value, name):
    array = _numbers(value, name) if not isinstance(value, str) else np.empty(0)
    if array.shape != (3,) or array.dtype.kind not in "fiu":
        raise ArgumentError(f"{name}: must be three numbers, not {value!r}")
    return array.astype(np.float64).tolist()


def _linear(value, name):
    """Linear light of a colour; float32 before it is, as the program's --light has it."""
    return list(linear([float(np.float32(c)) for c in _color(value, name)])[:3])


def display(linear):
    """Colours as they are given here, of linear ones in [0, 1]: lights of others are in these."""
    x = np.clip(np.asarray(linear, float), 0, 1)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)


class Light:
    """A light; made by one of its six functions.

    color: of a display, as colours everywhere. intensity: how bright it makes a white, matt surface that faces it (a
    unit away, where it has a position). of_camera: places and directions are the camera's, x to the right, y up, z
    towards the viewer. Directions are those in which light travels.
    """

    @raises_errors
    def __init__(self, kind, place=(0, 0, 0), direction=(0, 0, -1), below="black", range=math.inf, inner=0.0, outer=45.0, *,
                 color="white", intensity=1.0, of_camera=False):
        self._made = _r.light(kind, _three(place, "position"), _three(direction, "direction"),
                              _linear(below, "below"), number(range, "range"), math.radians(number(inner, "inner")),
                              math.radians(number(outer, "outer")), _linear(color, "color"), number(intensity, "intensity"),
                              bool(of_camera))

    @classmethod
    @names_arguments
    def ambient(cls, **look):
        """From everywhere."""
        return cls("ambient", **look)

    @classmethod
    @names_arguments
    def hemisphere(cls, up=(0, 1, 0), below="black", **look):
        """Its colour from `up`, `below` from the other side, linear between."""
        return cls("hemisphere", direction=up, below=below, **look)

    @classmethod
    @names_arguments
    def directional(cls, direction=(0, 0, -1), **look):
        """Parallel, from far away."""
        return cls("directional", direction=direction, **look)

    @classmethod
    @names_arguments
    def point(cls, position, range=math.inf, **look):
        """Weaker by the square of the distance, nothing beyond `range`."""
        return cls("point", position, range=range, **look)

    @classmethod
    @names_arguments
    def spot(cls, position, direction, inner=0.0, outer=45.0, range=math.inf, **look):
        """A point light in a cone: full up to `inner` degrees from its axis, nothing beyond `outer`."""
        return cls("spot", position, direction, range=range, inner=inner, outer=outer, **look)

    @classmethod
    @raises_errors
    def environment(cls, picture, up=(0, 1, 0), turn=0.0, *, color="white", intensity=1.0, of_camera=False):
        """A picture of all that is around: a path (.hdr, .exr, .png, .jpg), "sky", "room", or an array (H, 2 H, 3), linear.

        Its top row is at `up`, its middle at -z, turned by `turn` degrees counter-clockwise seen from `up`. Matt
        surfaces gather it, `material` mirrors it. Making one takes about 0.3 s of a core: keep it for many frames.
        """
        look = (_three(up, "up"), math.radians(number(turn, "turn")), _linear(color, "color"), number(intensity, "intensity"), bool(of_camera))
        if isinstance(picture, (str, os.PathLike)):
            made = _r.environment_of_file(os.fspath(picture))
        else:
            pixels = _numbers(picture, "environment")
            if pixels.dtype.kind not in "fiu":
                raise ArgumentTypeError(f"environment: must be numbers or a file, not {pixels.dtype}")
            made = _r.environment_of_array(np.ascontiguousarray(pixels, np.float32))
        light = cls.__new__(cls)
        light._made = _r.environment(made, *look)
        return light


def lights(wanted, scene=None):
    """The C++ form of render's `lights`. `scene`: the C++ scene, whose files may have lights; None for a terrain."""
    if wanted is None:
        return []
    if isinstance(wanted, (str, Light)):
        wanted = (wanted,)
    made = []
    for light in wanted:
        if isinstance(light, Light):
            made.append(light._made)
        elif not isinstance(light, str):
            raise ArgumentTypeError(f"lights: {light!r} is no rastrum.Light")
        elif light == "headlight":
            made.append(_r.headlight())
        elif light == "studio":
            made += _r.light_kit()
        elif light == "file":
            of_files = [] if scene is None else scene.lights
            if not of_files:
                raise ArgumentError("lights: the scene's files have no lights of their own")
            made += of_files
        elif light != "default":
            raise ArgumentError(f"lights: there is no {light!r}; take some of {', '.join(_NAMES)}, or a rastrum.Light")
    return made
