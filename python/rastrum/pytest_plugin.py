# SPDX-License-Identifier: BSD-3-Clause
"""A pytest fixture for pictures that must not change by a bit.

    def test_part(rr_snapshot):
        rr_snapshot(rastrum.render("part.stl"), "part")

Digests are kept in `rr_snapshots.json` beside the test; `pytest --rr-update` writes them. Where one differs, the actual
picture and, where the expected one was drawn here before, that and the difference are in `rr_failures/`.
"""

import json
import pathlib

import numpy as np
import pytest

from . import _rastrum as _r
from ._render import digest


def pytest_addoption(parser):
    parser.addoption("--rr-update", action="store_true", help="keep the pictures of rr_snapshot as they are now")


def _write(file, colors):
    file.parent.mkdir(parents=True, exist_ok=True)
    _r.write_png(str(file), np.ascontiguousarray(colors))


@pytest.fixture
def rr_snapshot(request):
    """Returns check(picture, name), which compares the digest of a Picture or an array with the one that was kept."""
    folder = pathlib.Path(request.node.path).parent
    book = folder / "rr_snapshots.json"
    # Pictures that were right, to be shown beside wrong ones; not to be committed.
    seen = pathlib.Path(request.config.cache.mkdir("rastrum"))

    def check(picture, name):
        array = getattr(picture, "color", picture)
        key = f"{request.node.path.name}::{name}"
        known = json.loads(book.read_text()) if book.exists() else {}
        now = digest(array)
        is_picture = array.dtype == np.uint8 and array.ndim == 3 and array.shape[2] == 4
        cached = seen / f"{known.get(key, now)}.png"
        if request.config.getoption("--rr-update"):
            known[key] = now
            book.write_text(json.dumps(known, indent=1, sort_keys=True) + "\n")
            cached = seen / f"{now}.png"
        if known.get(key) == now:
            if is_picture and not cached.exists():
                _write(cached, array)
            return
        if key not in known:
            pytest.fail(f"{key}: no digest yet; look at the picture, then pytest --rr-update", pytrace=False)
        wrong = folder / "rr_failures" / name
        said = [f"{key}: the digest was {known[key]} and is {now}"]
        if is_picture:
            _write(wrong.with_suffix(".actual.png"), array)
            said.append(f"actual: {wrong}.actual.png")
            if cached.exists():
                expected = _read_png(cached)
                _write(wrong.with_suffix(".expected.png"), expected)
                said.append(f"expected: {wrong}.expected.png")
                if expected.shape == array.shape:
                    difference = np.abs(expected.astype(int) - array)
                    said.append(f"{np.any(difference, axis=2).sum()} pixels differ, by at most {difference.max()} of 255")
                    difference = np.minimum(255, 8 * difference).astype(np.uint8)
                    difference[..., 3] = 255
                    _write(wrong.with_suffix(".difference.png"), difference)
                    said.append(f"difference, times 8: {wrong}.difference.png")
        pytest.fail("\n".join(said), pytrace=False)
    return check


def _read_png(file):
    return _r.read_image(str(file))
