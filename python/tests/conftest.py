# SPDX-License-Identifier: BSD-3-Clause
"""Fixtures: the meshes that tests draw."""

import numpy as np
import pytest


@pytest.fixture
def sheet():
    """A wavy sheet of 40 x 40 quads: (vertices, triangles) of float32 and uint32."""
    n = 40
    y, x = np.mgrid[0:n + 1, 0:n + 1] / n
    vertices = np.stack([2 * x - 1, 2 * y - 1, 0.25 * np.round(16 * x * y) / 16], -1).reshape(-1, 3).astype(np.float32)
    a = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).reshape(-1)
    triangles = np.concatenate([np.stack([a, a + 1, a + n + 2], -1), np.stack([a, a + n + 2, a + n + 1], -1)])
    return vertices, triangles.astype(np.uint32)


@pytest.fixture
def obj(tmp_path, sheet):
    """The same as a file."""
    file = tmp_path / "sheet.obj"
    vertices, triangles = sheet
    file.write_text("".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in vertices.tolist()) +
                    "".join(f"f {a} {b} {c}\n" for a, b, c in (triangles + 1).tolist()))
    return file
