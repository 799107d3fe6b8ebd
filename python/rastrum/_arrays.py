# SPDX-License-Identifier: BSD-3-Clause
"""Converts arrays, numbers and colours of any kind. Arrays that can be drawn in place are not copied."""

import math

import numpy as np

from . import _rastrum as _r
from ._errors import ArgumentError, ArgumentTypeError, warn


def number(value, name, low=-math.inf, high=math.inf):
    """A float in [low, high]; without these any float, NaN too."""
    if isinstance(value, (bool, str, bytes)) or np.ndim(value) != 0:
        raise ArgumentTypeError(f"{name}: must be a number, not {value!r}")
    try:
        made = float(value)
    except (TypeError, ValueError) as e:
        raise ArgumentTypeError(f"{name}: must be a number, not {value!r}") from e
    if (low > -math.inf or high < math.inf) and not low <= made <= high:
        within = (f"lie in {low:g} to {high:g}" if max(-low, high) < math.inf else
                  f"be at least {low:g}" if low > -math.inf else f"be at most {high:g}")
        raise ArgumentError(f"{name}: must {within}, not {value!r}")
    return made


def whole(value, name, low, high):
    """An int in [low, high]."""
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)):
        raise ArgumentTypeError(f"{name}: must be a whole number, not {value!r}")
    if not low <= value <= high:
        raise ArgumentError(f"{name}: must lie in {low} to {high}, not {value!r}")
    return int(value)


def _numbers(value, name):
    """A NumPy array over the memory of `value` where it has some that can be shared."""
    if isinstance(value, np.ndarray):
        return value
    if hasattr(value, "detach"):  # torch: a gradient stays behind
        value = value.detach()
    if hasattr(value, "__dlpack__"):
        try:
            return np.from_dlpack(value)
        except (BufferError, RuntimeError, TypeError) as e:
            if _is_elsewhere(value):
                raise ArgumentTypeError(f"{name}: is not in this process's memory ({e}); take .cpu() of an array on a device") from e
            raise ArgumentTypeError(f"{name}: NumPy cannot take this array ({e}); take .float() or .to_dense() of a torch tensor") from e
    try:
        return np.asarray(value)
    except (ValueError, TypeError) as e:
        raise ArgumentTypeError(f"{name}: cannot become an array ({e})") from e


def _is_elsewhere(value):
    try:
        return value.__dlpack_device__()[0] != 1  # kDLCPU
    except Exception:  # one that DLPack does not know
        return True


def _drawable(array, kinds, types):
    return (array.dtype.kind in kinds and array.dtype.itemsize in types and array.dtype.isnative)


def _in_place(array):
    """Whether the numbers of a value lie side by side, at whole multiples of their size."""
    size = array.itemsize
    return (all(s % size == 0 for s in array.strides) and
            (array.ndim < 2 or array.shape[-1] == 1 or array.size == 0 or array.strides[-1] == size))


def _copied(array, name, copy, why, make):
    if copy is False:
        raise ArgumentError(f"{name}: copy=False, but {why}")
    return make(array)


def scalars(value, name, copy=None):
    """(N,) of numbers, each type where it is."""
    array = _numbers(value, name)
    if array.dtype.kind == "b":
        array = array.view(np.uint8)
    if array.dtype.kind not in "fiu" or array.ndim not in (1, 2) or array.ndim == 2 and array.shape[1] != 1:
        raise ArgumentError(f"{name}: must be (N,) numbers, not {array.shape} of {array.dtype}")
    array = array[:, 0] if array.ndim == 2 else array
    if not _drawable(array, "f", (4, 8)) and not _drawable(array, "iu", (1, 2, 4, 8)):
        array = _copied(array, name, copy, f"{array.dtype} is not drawn as it is",
                        lambda a: np.ascontiguousarray(a, np.float64))
    if copy is True:
        array = array.copy()
    elif not _in_place(array):
        array = _copied(array, name, copy, "their distances are no whole multiples of their size", np.ascontiguousarray)
    return array


def floats(value, name, columns, copy=None, normalized=False):
    """(N, c) with c of `columns`, or (N,) where `columns` is None. float32 and float64 stay where they are,
    with `normalized` integers of 8 and 16 bits too; other numbers are copied to float64."""
    array = _numbers(value, name)
    if array.dtype.kind not in "fiub" or array.dtype.kind == "b" and not normalized:
        raise ArgumentTypeError(f"{name}: must be an array of numbers, not of {array.dtype}")
    if columns is None:
        if array.ndim == 2 and array.shape[1] == 1:
            array = array[:, 0]
        if array.ndim != 1:
            raise ArgumentError(f"{name}: the shape is {array.shape} and must be (N,)")
    elif array.ndim != 2 or array.shape[1] not in columns:
        wanted = " or ".join(map(str, columns))
        raise ArgumentError(f"{name}: the shape is {array.shape} and must be (N, {wanted})")
    if not _drawable(array, "f", (4, 8)) and not (normalized and _drawable(array, "iu", (1, 2))):
        array = _copied(array, name, copy, f"{array.dtype} is not drawn as it is",
                        lambda a: np.ascontiguousarray(a, np.float64))
    if copy is True:
        array = array.copy(order="C")
    elif not _in_place(array):
        array = _copied(array, name, copy, "the numbers of a value lie apart", np.ascontiguousarray)
    return array


def integers(value, name, copy=None):
    """(N,) or (M, K) of integers, in C order."""
    array = _numbers(value, name)
    if array.dtype.kind not in "iu":
        if array.size or array.dtype.kind != "f":
            raise ArgumentTypeError(f"{name}: indices must be integers, not {array.dtype}")
        array = array.astype(np.int64)  # [] has no type of its own
    if array.ndim not in (1, 2):
        raise ArgumentError(f"{name}: the shape is {array.shape} and must be (N,) or (M, K)")
    if not array.dtype.isnative:
        array = _copied(array, name, copy, "the bytes are in the other order",
                        lambda a: a.astype(a.dtype.newbyteorder("=")))
    if copy is True:
        array = array.copy(order="C")
    elif not array.flags.c_contiguous and not (array.ndim == 1 and _in_place(array)):
        array = _copied(array, name, copy, "the rows lie apart", np.ascontiguousarray)
    return array


def colors(value, copy=None):
    """(N, 3 or 4): floats in [0, 1], or integers of 8 and 16 bits, whose greatest is 1."""
    array = floats(value, "colors", (3, 4), copy, normalized=True)
    if array.size == 0:
        return array
    most = array.max()
    if array.dtype.kind == "f" and most > 1.001:  # a 1 with rounding errors passes
        raise ArgumentError(f"colors: must lie in 0 to 1, and the greatest is {most:g}; for colours from 0 to 255 use "
                            ".astype(np.uint8)")
    _warn_of_dark("colors", most, array.dtype)
    return array


def _warn_of_dark(name, most, dtype):
    """Warns of integers that look like floats from 0 to 1, or like integers of fewer bits."""
    if dtype.kind in "iu" and 0 < most <= (1 if dtype.itemsize == 1 else 255):
        warn(f"{name}: {np.iinfo(dtype).max} is full intensity in {dtype}, but the greatest is {most}, which is nearly black; use "
             "floats for 0 to 1" + ("" if dtype.itemsize == 1 else ", or uint8 for 0 to 255"))


def matrix(value, name):
    """(4, 4) of float64; (3, 4) is completed."""
    array = _numbers(value, name)
    if array.dtype.kind not in "fiu" or array.shape not in ((4, 4), (3, 4)):
        raise ArgumentError(f"{name}: must be (4, 4) or (3, 4) numbers, not {array.shape} of {array.dtype}")
    return np.ascontiguousarray(array, np.float64)


def placement(value, name):
    """A matrix that places things: finite, and its last row is 0 0 0 1."""
    m = matrix(value, name)
    if not np.isfinite(m).all():
        raise ArgumentError(f"{name}: its numbers must be finite")
    if len(m) == 4 and m[3].tolist() != [0, 0, 0, 1]:
        row = ", ".join(f"{v:g}" for v in m[3])
        meant = (f"; vectors are columns here, and a translation is the last column: take {name}.T"
                 if m[:, 3].tolist() == [0, 0, 0, 1] else "")
        raise ArgumentError(f"{name}: the last row must be (0, 0, 0, 1), not ({row}){meant}")
    return m


def color(value, name):
    """Display values (r, g, b, a) in [0, 1], from '#rrggbb', '#rrggbbaa', '#rgb', a name of CSS, 3 or 4 numbers, or an
    array of 3 or 4 uint8, where 255 is 1."""
    if isinstance(value, str):
        found = _r.color_of(value)
        if found is None:
            import difflib  # as other modules that few calls need: imports are a script's time
            near = difflib.get_close_matches(value.lower(), _r.color_names(), 1)
            raise ArgumentError(f"{name}: {value!r} is no colour; take '#rrggbb' or a name of CSS" +
                                (f", {near[0]!r} perhaps" if near else ""))
        return tuple(v / 255 for v in found)
    if isinstance(value, (bool, bytes)):
        raise ArgumentTypeError(f"{name}: {value!r} is no colour")
    try:
        channels = [float(v) for v in value]
    except (TypeError, ValueError) as e:
        raise ArgumentTypeError(f"{name}: {value!r} is no colour") from e
    of_bytes = isinstance(value, np.ndarray) and value.dtype == np.uint8
    if of_bytes and channels:
        _warn_of_dark(name, max(channels), value.dtype)
        channels = [v / 255 for v in channels]
    if len(channels) not in (3, 4) or not all(0 <= c <= 1 for c in channels):
        meant = "; divide numbers up to 255 by 255" if len(channels) in (3, 4) and max(channels) > 1 else ""
        raise ArgumentError(f"{name}: {value!r} must be 3 or 4 numbers from 0 to 1{meant}")
    return tuple(channels + [1.0])[:4]


def linear(rgba):
    """Display values as linear light (sRGB), the same bits on every machine."""
    return tuple(_r.linear_from_srgb(float(v)) for v in rgba[:3]) + (rgba[3],)


def product(a, b):
    """a @ b, added in one order: a BLAS has its own on each machine, with other bits."""
    return sum(a[:, k, np.newaxis] * b[k] for k in range(len(b)))
