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
    """A light. Make one by ambient, hemisphere, directional, point, spot or environment.

    color: a display colour, as everywhere. intensity: how bright the light makes a white, matt surface that faces it (from one
    unit away if the light has a position). of_camera: places and directions are relative to the camera, x to the right, y up,
    z towards the viewer. A direction is the one in which the light travels. casts_shadows: where a frame's `shadows` asks for them.

    classic: for the shader classic, {"ambient", "diffuse", "specular": a colour each, "attenuation": (x, y, z), "exponent": e}, as
    OpenGL has them: the light at distance d is divided by x + y d + z d^2, and a spot's has the cosine of the angle to its axis
    to the power of e within `outer`. By default they are black, white, white, (1, 0, 0) and 0. None: `color` times `intensity`.
    """

    @raises_errors
    def __init__(self, kind, place=(0, 0, 0), direction=(0, 0, -1), below="black", range=math.inf, inner=0.0, outer=45.0, *,
                 color="white", intensity=1.0, of_camera=False, casts_shadows=True, classic=None):
        self._make(kind, _three(place, "position"), _three(direction, "direction"), _linear(below, "below"),
                   number(range, "range"), math.radians(number(inner, "inner")), math.radians(number(outer, "outer")),
                   _linear(color, "color"), number(intensity, "intensity"), bool(of_camera), bool(casts_shadows),
                   None if classic is None else _classic(**classic))

    def _make(self, kind, *arguments):
        self._made = _environment(*arguments) if kind == "environment" else _r.light(kind, *arguments)
        self._call = kind, *arguments

    def __getstate__(self):
        return self._call

    def __setstate__(self, call):
        self._make(*call)

    @classmethod
    @names_arguments
    def ambient(cls, **look):
        """Shines from everywhere."""
        return cls("ambient", **look)

    @classmethod
    @names_arguments
    def hemisphere(cls, up=(0, 1, 0), below="black", **look):
        """Shines with its colour from `up` and with `below` from the other side; between them the colour is linear."""
        return cls("hemisphere", direction=up, below=below, **look)

    @classmethod
    @names_arguments
    def directional(cls, direction=(0, 0, -1), **look):
        """Shines in parallel rays from far away."""
        return cls("directional", direction=direction, **look)

    @classmethod
    @names_arguments
    def point(cls, position, range=math.inf, **look):
        """Shines from a place. The light fades by the square of the distance and ends at `range`."""
        return cls("point", position, range=range, **look)

    @classmethod
    @names_arguments
    def spot(cls, position, direction, inner=0.0, outer=45.0, range=math.inf, **look):
        """Shines from a place in a cone: fully up to `inner` degrees from the axis, and not beyond `outer`."""
        return cls("spot", position, direction, range=range, inner=inner, outer=outer, **look)

    @classmethod
    @raises_errors
    def environment(cls, picture, up=(0, 1, 0), turn=0.0, *, color="white", intensity=1.0, of_camera=False):
        """Shines from a picture of the whole surroundings: a path (.hdr, .exr, .png, .jpg), "sky", "room", or an array (H, 2 H, 3), linear.

        Its top row lies at `up` and its middle at -z, turned by `turn` degrees counter-clockwise as seen from `up`. Matt
        surfaces gather its light; the shader material also mirrors it. Making one takes a core about 0.3 s: keep it for many frames.
        """
        look = (_three(up, "up"), math.radians(number(turn, "turn")), _linear(color, "color"), number(intensity, "intensity"), bool(of_camera))
        if isinstance(picture, (str, os.PathLike)):
            source = os.fspath(picture)
            source = os.path.abspath(source) if os.path.exists(source) else source  # else "sky", or an error that names it
        else:
            source = _numbers(picture, "environment")
            if source.dtype.kind not in "fiu":
                raise ArgumentTypeError(f"environment: must be numbers or a file, not {source.dtype}")
            source = np.array(source, np.float32, order="C")
        light = cls.__new__(cls)
        light._make("environment", source, *look)
        return light


@names_arguments
def _classic(ambient="black", diffuse="white", specular="white", attenuation=(1, 0, 0), exponent=0.0):
    """C++'s fields of it, one after the other. Colours may be brighter than white."""
    colors = ((ambient, "ambient"), (diffuse, "diffuse"), (specular, "specular"))
    rows = [list(_color(c, name)[:3]) if isinstance(c, str) else _three(c, name) for c, name in colors]
    return [*rows[0], *rows[1], *rows[2], *_three(attenuation, "attenuation"), number(exponent, "exponent")]


def _environment(source, *look):
    """`source`: a name, or an array of float32."""
    return _r.environment(_r.environment_of_file(source) if isinstance(source, str) else _r.environment_of_array(source), *look)


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
            raise ArgumentTypeError(f"lights: {light!r} is neither a name nor a rastrum.Light")
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
