# SPDX-License-Identifier: BSD-3-Clause
# Types for type checkers and editors; tests/test_stubs.py compares this file with rastrum.dataset.
import os
from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import Camera

__all__: list[str]

class Seen(NamedTuple):
    visible: NDArray[np.bool_]
    mask: NDArray[np.bool_]
    visibility: float

# `frame`: more of what rastrum.render takes.
def objects(what: Any, camera: Camera | ArrayLike | None = None, *, size: tuple[int, int] = (640, 480), **frame: Any) -> dict[int, Seen]: ...
def millimetres(depth: ArrayLike, unit: float = 1.0) -> NDArray[np.uint16]: ...
def run_lengths(mask: ArrayLike) -> dict[str, list[int]]: ...

class BopScene:
    def __init__(self, folder: str | os.PathLike[str], unit: float = 1.0) -> None: ...
    def add(self, color: NDArray[np.uint8], depth: ArrayLike, K: ArrayLike, world_to_camera: ArrayLike,
            objects: Iterable[tuple[int, ArrayLike, Seen]]) -> None: ...
    def close(self) -> None: ...
    def __enter__(self) -> BopScene: ...
    def __exit__(self, kind: Any, error: Any, traceback: Any) -> None: ...
