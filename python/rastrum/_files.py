# SPDX-License-Identifier: BSD-3-Clause
"""Writes files, whole or not at all, and never over one that was read."""

import contextlib
import os

from . import _rastrum as _r
from ._errors import ArgumentError, FileError


class _Stream:
    """The few functions of an open file that writers of other libraries need. With more of them they would bypass write()."""

    def __init__(self, file):
        self._file = file
        self.write, self.flush, self.seek, self.tell, self.descriptor = file.write, file.flush, file.seek, file.tell, file.fileno()


@contextlib.contextmanager
def whole(path):
    """A file to write to, which becomes `path` at the end, or disappears if anything is raised. `descriptor`: for processes."""
    temporary = _r.AtomicFile(path)
    try:
        try:
            with os.fdopen(os.dup(temporary.fileno()), "wb") as file:
                yield _Stream(file)
        except OSError as e:
            if isinstance(e, FileError):
                raise
            raise FileError(f"{path}: cannot be written: {e.strerror or e}") from e
        temporary.commit()
    finally:
        temporary.abandon()


def shallow(value):
    """A copy that shares all; of a class whose __reduce__ is for other processes."""
    made = type(value).__new__(type(value))
    made.__dict__.update(value.__dict__)
    return made


def refuse_inputs(path, inputs):
    """Raises if `path`, by any name or link, is one of the files that were read."""
    for read in inputs:
        with contextlib.suppress(OSError):
            if os.path.samefile(path, read):
                raise ArgumentError(f"{path}: was read for this picture and would be overwritten: name another file")
