# SPDX-License-Identifier: BSD-3-Clause
"""Triangles in clip space, as nvdiffrast has them: what its users' inference needs, on the CPU."""

import numpy as np

from ._arrays import _copied, _in_place, _numbers, integers
from ._errors import ArgumentError, ArgumentTypeError, raises_errors
from ._render import _kept, empty

#: The largest number up to which float32 has every whole number.
_MOST = 1 << 24


@raises_errors
def rasterize(pos, tri, resolution, ranges=None, *, out=None, copy=None, threads=None):
    """Returns (N, H, W, 4) of float32: u, v, z/w and the number of the triangle + 1, zeros where nothing is.

    pos: vertices in OpenGL's clip space (-w <= x, y, z <= w), float32 or float64; (N, V, 4): one picture for each N; (V, 4):
    one picture, or with ranges one for each range. tri: (T, 3) of any integer type. resolution: (height, width). ranges: (N, 2),
    the first triangle and the number of triangles of each picture. u, v: perspective-correct weights of the first and second
    corner. Row 0 lies at y = -w, as in nvdiffrast and OpenGL; out[:, ::-1] has the top first. Both sides are drawn.
    At equal depths the first triangle wins. Nothing is drawn at the far plane and beyond. There are no gradients.
    out: an array that is filled. copy: as Mesh. Raises rastrum.Error of the natural class.
    """
    positions = _positions(pos, copy)
    corners = integers(tri, "tri", copy)
    if corners.ndim != 2 or corners.shape[1] != 3:
        raise ArgumentError(f"tri: the shape is {corners.shape} and must be (T, 3)")
    if len(corners) > _MOST:
        raise ArgumentError(f"tri: has {len(corners)} triangles, but float32 can number only {_MOST}")
    rows = _ranges(ranges, positions)
    height, width = _resolution(resolution)
    pictures = len(rows) if rows else len(positions)
    expected = pictures, height, width, 4
    if out is None:
        out = empty(expected, np.float32)
    elif not isinstance(out, np.ndarray) or out.dtype != np.float32 or not out.flags.writeable or not out.flags.c_contiguous:
        raise ArgumentTypeError("out: must be a C-contiguous NumPy array of float32 that can be written")
    elif out.shape != expected:
        raise ArgumentError(f"out: the shape is {out.shape} and must be {expected}")
    _kept(threads, "threads", 0, None)._renderer().rasterize(list(positions), corners, rows, out)
    return out


def _positions(pos, copy):
    """(N, V, 4)"""
    array = _numbers(pos, "pos")
    if array.dtype.kind not in "fiu":
        raise ArgumentTypeError(f"pos: must be an array of numbers, not of {array.dtype}")
    if array.ndim not in (2, 3) or array.shape[-1] != 4:
        raise ArgumentError(f"pos: the shape is {array.shape} and must be (V, 4) or (N, V, 4)")
    if array.dtype not in (np.float32, np.float64) or not array.dtype.isnative:
        array = _copied(array, "pos", copy, f"{array.dtype} is not drawn as it is",
                        lambda a: np.ascontiguousarray(a, np.float64))
    if copy is True:
        array = array.copy(order="C")
    elif not _in_place(array):
        array = _copied(array, "pos", copy, "the numbers of a value lie apart", np.ascontiguousarray)
    array = array[np.newaxis] if array.ndim == 2 else array
    if len(array) == 0:
        raise ArgumentError("pos: has no picture; N must be at least 1")
    return array


def _ranges(ranges, positions):
    if ranges is None:
        return []
    if len(positions) != 1:
        raise ArgumentError("ranges: need pos of shape (V, 4)")
    array = integers(ranges, "ranges")
    if array.ndim != 2 or array.shape[1] != 2 or len(array) == 0:
        raise ArgumentError(f"ranges: the shape is {array.shape} and must be (N, 2)")
    if (array < 0).any():
        raise ArgumentError("ranges: must not have numbers below 0")
    return [(int(first), int(count)) for first, count in array]


def _resolution(resolution):
    try:
        height, width = resolution
        whole = height == int(height) and width == int(width)
    except (TypeError, ValueError) as e:
        raise ArgumentTypeError(f"resolution: must be (height, width), not {resolution!r}") from e
    if not whole or not (1 <= width <= 32768 and 1 <= height <= 32768):
        raise ArgumentError(f"resolution: {resolution!r} is outside of 1 x 1 to 32768 x 32768")
    return int(height), int(width)
