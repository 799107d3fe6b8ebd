"""Arrays as they come: what can be drawn in place stays where it is."""

import numpy as np

from . import _rastrum as _r
from ._errors import ArgumentError, ArgumentTypeError


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
                raise ArgumentTypeError(f"{name}: not in this process's memory ({e}); of a device's, take .cpu()") from e
            raise ArgumentTypeError(f"{name}: NumPy has no such array ({e}); of torch, take .float() or .to_dense()") from e
    try:
        return np.asarray(value)
    except (ValueError, TypeError) as e:
        raise ArgumentTypeError(f"{name}: no array ({e})") from e


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
        array = _copied(array, name, copy, "they lie at no whole multiples of their size", np.ascontiguousarray)
    return array


def floats(value, name, columns, copy=None, normalized=False):
    """(N, c) with c of `columns`, or (N,) where `columns` is None. float32 and float64 stay where they are,
    with `normalized` integers of 8 and 16 bits too; other numbers are copied to float64."""
    array = _numbers(value, name)
    if array.dtype.kind not in "fiub" or array.dtype.kind == "b" and not normalized:
        raise ArgumentTypeError(f"{name}: an array of {array.dtype} is none of numbers")
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
            raise ArgumentTypeError(f"{name}: indices are integers, these are {array.dtype}")
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


def matrix(value, name):
    """(4, 4) of float64; (3, 4) is completed."""
    array = _numbers(value, name)
    if array.dtype.kind not in "fiu" or array.shape not in ((4, 4), (3, 4)):
        raise ArgumentError(f"{name}: must be (4, 4) or (3, 4) numbers, not {array.shape} of {array.dtype}")
    return np.ascontiguousarray(array, np.float64)


def color(value, name):
    """Display values (r, g, b, a) in [0, 1] of '#rrggbb', '#rrggbbaa', '#rgb', a name of CSS's, or 3 or 4 numbers."""
    if isinstance(value, str):
        found = _r.color_of(value)
        if found is None:
            import difflib  # as other modules that few calls need: imports are a script's time
            near = difflib.get_close_matches(value.lower(), _r.color_names(), 1)
            raise ArgumentError(f"{name}: {value!r} is no colour; take '#rrggbb' or a name of CSS's" +
                                (f", {near[0]!r} perhaps" if near else ""))
        return tuple(v / 255 for v in found)
    try:
        channels = [float(v) for v in value]
    except (TypeError, ValueError) as e:
        raise ArgumentTypeError(f"{name}: {value!r} is no colour") from e
    if len(channels) not in (3, 4) or not all(0 <= c <= 1 for c in channels):
        raise ArgumentError(f"{name}: {value!r} must be 3 or 4 numbers from 0 to 1")
    return tuple(channels + [1.0])[:4]


def linear(rgba):
    """Display values as linear light (sRGB), the same bits on every machine."""
    return tuple(_r.linear_from_srgb(float(v)) for v in rgba[:3]) + (rgba[3],)


def product(a, b):
    """a @ b, added in one order: a BLAS has its own on each machine, with other bits."""
    return sum(a[:, k, np.newaxis] * b[k] for k in range(len(b)))
