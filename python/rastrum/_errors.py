# SPDX-License-Identifier: BSD-3-Clause
"""The exceptions: each is the natural class of Python's and `Error` as well."""

import functools


class Error(Exception):
    """Rastrum refuses something. The message names the argument, file or place, and says what to do."""


class ArgumentError(Error, ValueError):
    """A value is out of range, or does not fit the others."""


class ArgumentTypeError(Error, TypeError):
    """An argument has a type that is not drawn or not taken."""


class NotFoundError(Error, FileNotFoundError):
    """A file does not exist."""


class MissingOutputError(Error, AttributeError):
    """A picture does not have this field, because it was not asked for."""


class PictureIndexError(Error, IndexError):
    """There is no picture with this number."""


class FileError(Error, OSError):
    """Reading or writing failed."""


class FormatError(Error, ValueError):
    """A file is damaged, or is not what its name says."""


class UnsupportedError(Error, NotImplementedError):
    """The input is valid, but Rastrum does not do this."""


class OutOfMemoryError(Error, MemoryError):
    """There is not enough memory. The message says how much was asked for."""


class DeviceError(Error, RuntimeError):
    """A device or an instruction set is not available."""


class OddInputWarning(UserWarning):
    """The input is drawn, but is hardly meant so."""


def warn(message):
    """Gives an OddInputWarning for the caller's line, outside of this package."""
    import os
    import sys
    import warnings
    here, frame, level = os.path.dirname(os.path.abspath(__file__)), sys._getframe(1), 2
    while frame.f_back is not None and os.path.abspath(frame.f_code.co_filename).startswith(here + os.sep):
        frame, level = frame.f_back, level + 1
    warnings.warn(message, OddInputWarning, stacklevel=level)


def _words(function, error):
    """The message of a TypeError, without the signatures of bindings; for a wrong call, with the parameters of `function`."""
    text = str(error)
    if "incompatible function arguments" in text:
        given = text.rpartition("Invoked with types: ")[2].strip().replace("rastrum._rastrum.", "")
        return f"{function.__qualname__}: one of these arguments has the wrong type: {given}"
    if error.__traceback__ is not None and error.__traceback__.tb_next is None:
        import inspect
        takes = [p for p in inspect.signature(function).parameters.values() if p.name not in ("self", "cls")]
        return f"{text}; it takes ({', '.join(map(str, takes))})"
    return text


def names_arguments(function):
    """Decorator: Python's TypeError for a call with arguments that `function` does not have becomes an
    ArgumentTypeError. Exceptions from within, raised by a caller's own function perhaps, stay as they are."""
    @functools.wraps(function)
    def wrapped(*arguments, **named):
        try:
            return function(*arguments, **named)
        except TypeError as e:
            if e.__traceback__.tb_next is not None or isinstance(e, Error):
                raise
            raise ArgumentTypeError(_words(function, e)) from e
    return wrapped


def raises_errors(function):
    """Decorator: Python's own exceptions for wrong arguments become Errors of the same natural class."""
    @functools.wraps(function)
    def wrapped(*arguments, **named):
        try:
            return function(*arguments, **named)
        except Error:
            raise
        except TypeError as e:
            raise ArgumentTypeError(_words(function, e)) from e
        except (ValueError, OverflowError) as e:
            raise ArgumentError(str(e)) from e
    return wrapped
