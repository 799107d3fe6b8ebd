# SPDX-License-Identifier: BSD-3-Clause
"""rasterize() against homogeneous barycentrics in float64, each triangle at each pixel."""

import numpy as np
import pytest

import rastrum as rr

HEIGHT, WIDTH = 48, 64


def oracle(pos, tri):
    """(H, W, 4) in float64, and how many pixels each pixel's centre is from the nearest edge of any triangle."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    point = np.stack([(x + 0.5) / WIDTH * 2 - 1, (y + 0.5) / HEIGHT * 2 - 1, np.ones(x.shape)], -1)
    best, margin = np.zeros((HEIGHT, WIDTH, 4)), np.full((HEIGHT, WIDTH), np.inf)
    nearest = np.full((HEIGHT, WIDTH), np.inf)
    for number, corners in enumerate(np.asarray(pos, np.float64)[tri]):
        # point = sum of beta_i (x, y, w)_i, which holds behind the eye, too.
        inverse = np.linalg.inv(corners[:, [0, 1, 3]])
        beta = point @ inverse
        step = np.hypot(inverse[0] * 2 / WIDTH, inverse[1] * 2 / HEIGHT)
        margin = np.minimum(margin, np.abs(beta / step).min(-1))
        z = beta @ corners[:, 2]
        inside = (beta >= 0).all(-1) & (np.abs(z) <= 1) & (z < nearest)
        margin = np.where(np.abs(np.abs(z) - 1) < 1e-3, 0, margin)
        nearest[inside] = z[inside]
        weights = beta / beta.sum(-1, keepdims=True)
        best[inside] = np.stack([weights[..., 0], weights[..., 1], z, np.full(z.shape, number + 1)], -1)[inside]
    return best, margin


def clip_triangles(seed, number):
    """Large triangles at many depths, some through the near plane and the eye."""
    rng = np.random.default_rng(seed)
    w = rng.uniform(0.5, 3, (number * 3, 1))
    w[rng.random(w.shape) < 0.1] *= -1
    pos = np.concatenate([rng.uniform(-1.4, 1.4, (number * 3, 3)) * np.abs(w), w], -1)
    return pos.astype(np.float32), np.arange(number * 3).reshape(-1, 3)


@pytest.mark.parametrize("seed", range(6))
def test_every_pixel_is_the_oracles(seed):
    pos, tri = clip_triangles(seed, 12)
    drawn = rr.rasterize(pos, tri, (HEIGHT, WIDTH))
    assert drawn.shape == (1, HEIGHT, WIDTH, 4) and drawn.dtype == np.float32
    expected, margin = oracle(pos, tri)
    # Corners are snapped to 1/256 px, which moves edges and, where two surfaces cut each other, depths.
    sure = margin > 0.05
    same = drawn[0, ..., 3] == expected[..., 3]
    assert sure.mean() > 0.5 and len(np.unique(expected[sure][:, 3])) > 4
    assert (~same & sure).sum() <= 0.005 * sure.sum()
    both = same & sure & (expected[..., 3] > 0)
    assert np.median(np.abs(drawn[0] - expected)[both]) < 1e-3
    assert np.percentile(np.abs(drawn[0] - expected)[both][:, :3], 99) < 0.02


def test_corners_rows_and_depth():
    # A right triangle that fills the lower left half; its corners have z/w of -0.5, 0 and 0.5.
    pos = np.array([[-1, -1, -0.5, 1], [2, -2, 0, 2], [-4, 4, 2, 4]], np.float32)
    r = rr.rasterize(pos, [[0, 1, 2]], (64, 64))[0]
    assert r[0, 0, 3] == 1 and r[0, 62, 3] == 1 and r[62, 0, 3] == 1 and r[63, 63, 3] == 0
    assert r[0, 0, 0] > 0.96 and r[0, 62, 1] > 0.9 and r[62, 0, :2].sum() < 0.1
    assert abs(r[0, 0, 2] + 0.5) < 0.02 and abs(r[0, 62, 2]) < 0.02 and abs(r[62, 0, 2] - 0.5) < 0.02
    assert not r[63, 63].any()


def test_the_first_of_equal_depths_and_nothing_beyond_the_planes():
    quad = np.array([[-1, -1, 0, 1], [3, -1, 0, 1], [-1, 3, 0, 1]], np.float32)
    assert (rr.rasterize(quad, [[0, 1, 2], [2, 1, 0]], (8, 8))[..., 3] == 1).all()
    assert not rr.rasterize(quad, np.zeros((0, 3), int), (8, 8)).any()
    for z in (-1.25, 1.25):
        outside = quad + np.array([0, 0, z, 0], np.float32)
        assert not rr.rasterize(outside, [[0, 1, 2]], (8, 8)).any()
        both = np.concatenate([outside, quad])
        assert (rr.rasterize(both, [[0, 1, 2], [3, 4, 5]], (8, 8))[..., 3] == 2).all()


def test_many_pictures_and_ranges():
    pos, tri = clip_triangles(7, 12)
    moved = pos + np.array([0.25, 0, 0, 0], np.float32)
    many = rr.rasterize(np.stack([pos, moved]), tri, (HEIGHT, WIDTH))
    for picture, one in zip(many, (pos, moved)):
        assert (picture == rr.rasterize(one, tri, (HEIGHT, WIDTH))[0]).all()
    parts = rr.rasterize(pos, tri, (HEIGHT, WIDTH), [[0, 5], [5, 7], [3, 0]])
    first, second = (rr.rasterize(pos, t, (HEIGHT, WIDTH))[0] for t in (tri[:5], tri[5:]))
    second[..., 3] += 5 * (second[..., 3] > 0)
    assert (parts[0] == first).all() and (parts[1] == second).all() and not parts[2].any()


def test_types_strides_threads_and_out_are_the_same_bits():
    pos, tri = clip_triangles(8, 30)
    expected = rr.digest(rr.rasterize(pos, tri, (HEIGHT, WIDTH), threads=1))
    wide = np.zeros((len(pos), 9), np.float32)
    wide[:, 2:6] = pos
    for p in (pos.astype(np.float64), wide[:, 2:6], memoryview(pos)):
        for dtype in (np.int32, np.uint32, np.int64, np.uint16):
            assert rr.digest(rr.rasterize(p, tri.astype(dtype), (HEIGHT, WIDTH), copy=False, threads=2)) == expected
    out = np.empty((1, HEIGHT, WIDTH, 4), np.float32)
    assert rr.rasterize(pos, tri, (HEIGHT, WIDTH), out=out) is out and rr.digest(out) == expected


BAD = {
    "pos": [np.zeros((3, 3), np.float32), np.zeros(4), np.zeros((0, 3, 4)), np.zeros((3, 4), object), "no", None],
    "tri": [[[0, 1, 3]], [[0, 1, -1]], [[0.0, 1.0, 2.0]], [0, 1, 2], np.zeros((1, 4), int), None],
    "resolution": [(0, 4), (4, -1), (4.5, 4), 4, (40000, 4), None, "8x8"],
    "ranges": [[[0, 2]], [[2, 0]], [[-1, 1]], [[0, 1, 2]], [], [[2 ** 63 - 1, 2]]],
    "out": [np.zeros((1, 8, 8, 4)), np.zeros((8, 8, 4), np.float32), [0], np.zeros((1, 8, 8, 8), np.float32)[..., ::2]],
}


@pytest.mark.parametrize("name", BAD)
def test_what_is_wrong_is_named(name):
    good = {"pos": np.array([[-1, -1, 0, 1], [3, -1, 0, 1], [-1, 3, 0, 1]], np.float32), "tri": [[0, 1, 2]],
            "resolution": (8, 8)}
    rr.rasterize(**good)
    for value in BAD[name]:
        with pytest.raises(rr.Error, match=f"^{name}"):
            rr.rasterize(**{**good, name: value})


def test_a_batch_is_its_pictures():
    """Small pictures are drawn side by side."""
    batch = np.stack([clip_triangles(seed, 12)[0] for seed in range(9)])
    tri = clip_triangles(0, 12)[1]
    one = np.concatenate([rr.rasterize(pos, tri, (HEIGHT, WIDTH), threads=1) for pos in batch])
    for threads in (1, 2, 5):
        assert np.array_equal(rr.rasterize(batch, tri, (HEIGHT, WIDTH), threads=threads), one)
    wrong = tri.copy()
    wrong[7, 1] = 36
    with pytest.raises(rr.ArgumentError, match="index 36 of triangle 7"):
        rr.rasterize(batch, wrong, (HEIGHT, WIDTH), threads=4)
