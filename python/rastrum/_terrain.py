# SPDX-License-Identifier: BSD-3-Clause
"""Height maps, lit once and drawn from where one stands."""

import os

import numpy as np

from . import _rastrum as _r
from ._annotate import annotations as _annotations
from ._arrays import _numbers
from ._arrays import color as _color
from ._arrays import number as _number
from ._errors import ArgumentError, ArgumentTypeError, UnsupportedError, raises_errors
from ._lights import lights as _lights
from ._render import Picture, _number_of_threads, _size, _text, thread_count
from ._things import ColorMapping


def _rgb(value, name):
    return None if value is None else [round(255 * c) for c in _color(value, name)[:3]]


def _arrays(heights, colors):
    """The arrays that C++ copies: heights as float32, colors as (h, w, 4) of uint8 or None."""
    array = _numbers(heights, "heights")
    if array.dtype.kind not in "fiu" or array.ndim != 2:
        raise ArgumentError(f"heights: must be (H, W) numbers, not {array.shape} of {array.dtype}")
    if colors is not None:
        colors = _numbers(colors, "colors")
        if colors.dtype != np.uint8 or colors.ndim != 3 or colors.shape[2] not in (3, 4):
            raise ArgumentError(f"colors: must be (h, w, 3 or 4) of uint8, not {colors.shape} of {colors.dtype}")
        opaque = np.full((*colors.shape[:2], 4), 255, np.uint8)
        opaque[..., :3] = colors[..., :3]
        colors = opaque
    with np.errstate(over="ignore"):  # what float32 has no number for is a hole
        return np.ascontiguousarray(array, np.float32), colors


class Terrain:
    """A height map, which is lit once and drawn from any place.

    heights: (H, W) in cells, row 0 in the north, NaN is a hole; they are copied (but pickle takes the array as it is then).
    Or a file (.png, .npy, .dem, .tif), as the program reads it. height_scale: how many cells high a unit of the heights is,
    if the heights are not in cells and the file does not say so. `clim`, bar and box are in that unit, everything else in
    cells.

    colors: (h, w, 3 or 4) of uint8, of any size, stretched over the map; for a file of heights a .png or .jpg; None: colours by
    height, with shaded slopes. sun: (azimuth clockwise from north, elevation) in degrees, None: (315, 35). shadows: none,
    accumulated, sharp, soft. ambient: the part of a colour that is left in the shade. sun_radius: the radius of the sun's disc
    for soft shadows, in degrees. filter: none, bilinear, mip. tiling: what lies beyond the map's edge: repeat, mirror, clamp,
    none; None: repeat, but none for a .dem or .tif. threads: None takes RASTRUM_NUM_THREADS or the cores that this process
    may use. lights: replace the sun; they are those of Renderer.render, in the terrain's world (x, the height, y), and
    directional lights then throw the shadows. tone, exposure: none, reinhard, aces or neutral shows that light, after
    `exposure` doublings. cmap, clim: colour the ground by its heights, instead of `colors`; a ColorMapping, or a cmap for one.
    """

    @raises_errors
    def __init__(self, heights, colors=None, *, height_scale=None, sun=None, shadows="none", ambient=0.45,
                 sun_radius=0.2666, filter="bilinear", tiling=None, threads=None, lights=None, tone="none", exposure=0.0,
                 cmap=None, clim=None):
        self._threads = thread_count(_number_of_threads() if threads is None else threads)
        made = _lights(lights)
        if made and sun is not None:
            raise ArgumentError("sun: lights take the sun's place; give the sun as one of them, by rastrum.Light.directional")
        if not made and (tone != "none" or exposure != 0):
            raise ArgumentError("tone: needs lights, and there are none; the sun lights colours as a display shows them")
        if cmap is not None and colors is not None:
            raise ArgumentError("cmap: colours the ground by its heights, but colors colours it, too: leave one of them out")
        if isinstance(cmap, ColorMapping) and clim is not None:
            raise ArgumentError("clim: the ColorMapping already has a range")
        if cmap is None and clim is not None:
            raise ArgumentError("clim: needs a cmap")
        mapping = cmap if cmap is None or isinstance(cmap, ColorMapping) else ColorMapping(cmap, clim)
        if tiling is None:
            tiling = "none" if isinstance(heights, (str, os.PathLike)) and _r.ends_at_edge(os.fspath(heights)) else "repeat"
        light = ([315.0, 35.0] if sun is None else list(sun), _text(shadows, "shadows"), ambient, sun_radius,
                 _text(filter, "filter"), _text(tiling, "tiling"), self._threads, made, _text(tone, "tone"), float(exposure),
                 None if mapping is None else mapping._made)
        scale = None if height_scale is None else _number(height_scale, "height_scale")
        if isinstance(heights, (str, os.PathLike)):
            if colors is not None and not isinstance(colors, (str, os.PathLike)):
                raise ArgumentTypeError("colors: must be a file, too, if heights are a file")
            self._made = _r.lit_terrain_of_file(os.fspath(heights), None if colors is None else os.fspath(colors), scale, *light)
            heights, colors = os.path.abspath(heights), None if colors is None else os.path.abspath(colors)
            self._read_from = (heights,) if colors is None else (heights, colors)
        else:
            self._made = _r.lit_terrain(*_arrays(heights, colors), scale, *light)
            self._read_from = ()
        self._renderer = None, None
        # For pickle: the caller's arrays, because C++ keeps only what is drawn.
        self._call = heights, None if mapping is not None else colors, {
            "height_scale": height_scale, "sun": sun, "shadows": shadows, "ambient": ambient, "sun_radius": sun_radius, "filter": filter,
            "tiling": tiling, "threads": threads, "lights": lights, "tone": tone, "exposure": exposure, "cmap": mapping}

    def __reduce__(self):
        return _made_again, self._call

    @property
    def heights(self):
        """The lowest and the highest height, in cells."""
        return self._made.lowest, self._made.highest

    @raises_errors
    def ground_at(self, x, y):
        """Returns the height of the ground at (x, y), as it is drawn near by; NaN in a hole."""
        return self._made.ground_at(float(x), float(y))

    @raises_errors
    def render(self, position=None, *, altitude=None, angle=0.0, horizon=None, roll=0.0, clearance=None, size=(1280, 720),
               distance=800.0, fov=90.0, scale=0.0, projection="planar", sky=None, fog=None, depth=False,
               environment_behind=False, annotate=()):
        """Returns a Picture with `color` and, with depth=True, `depth`, in cells along the view, 0 where the sky is.

        position: (x, y) in cells, x east and y south (default: half of the width, 0.78 of the height). altitude: height of the
        camera in cells (default: a tenth of the relief above the highest point). angle: 0 looks north, 90 west. horizon: the
        row of the horizon (default: a quarter of the height). roll: degrees counter-clockwise. clearance: lifts the camera to so
        many cells above the ground. distance: how far the picture sees, in cells. fov: the field of view across the picture, in
        degrees. scale: how many rows a height of 1 takes at distance 1; 0: as many as columns in the middle. projection: planar,
        cylindrical. sky: a colour, None: one that dims with a low sun. fog: density a cell, or (density, start), or (density,
        start, colour). environment_behind: shows the environments among the terrain's lights where no ground is, and fog fades
        to their horizon. annotate: as in Renderer.render, but only "axes", "bounds", "bar" (with a cmap), "title", "captions"
        and "text_scale". The program's `terrain` draws the same bits.
        """
        notes = _annotations(annotate)
        width, height = _size(size)
        density, start, fog_color = _fog(fog)
        frame = _r.terrain_frame(self._made, width, height, distance, fov, scale, _text(projection, "projection"),
                                 _rgb(sky, "sky"), density, start, _rgb(fog_color, "fog"), clearance, bool(environment_behind))
        camera = _r.terrain_camera(self._made, height, None if position is None else list(position), altitude, angle, horizon,
                                   roll)
        arrays = {"color": np.empty((height, width, 4), np.uint8)}
        if depth:
            arrays["depth"] = np.empty((height, width), np.float32)
        stats = self._drawer().render(self._made, camera, frame, arrays["color"], arrays.get("depth"), bool(environment_behind),
                                      notes)
        if depth:
            arrays["depth"][np.isinf(arrays["depth"])] = 0
        return Picture(arrays, stats, _no_pick, self._read_from)

    _lost = []

    def _drawer(self):
        # A forked child has none of its parent's threads, and the end of a renderer would wait for them.
        process, renderer = self._renderer
        if process != os.getpid():
            if renderer is not None:
                Terrain._lost.append(renderer)
            renderer = _r.TerrainRenderer(self._threads)
            self._renderer = os.getpid(), renderer
        return renderer


def _made_again(heights, colors, options):
    return Terrain(heights, colors, **options)


def _no_pick(x, y):
    raise UnsupportedError("pick: a terrain has no primitives; `depth` tells how far away the ground is")


def _fog(fog):
    if fog is None:
        return 0.0, 0.0, None
    parts = [fog] if np.isscalar(fog) else list(fog)
    if not 1 <= len(parts) <= 3:
        raise ArgumentTypeError(f"fog: must be density, start and colour, not {fog!r}")
    return (*parts, *(0.0, 0.0, None)[len(parts):])
