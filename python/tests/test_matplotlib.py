# SPDX-License-Identifier: BSD-3-Clause
"""Pictures behind matplotlib's axes have each place where matplotlib puts it."""

import numpy as np
import pytest

import rastrum as rr

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402
from mpl_toolkits.mplot3d import proj3d  # noqa: E402

PLACES = np.array([[0.0, 0, 0], [3, 1, -2], [-2, 2, 4], [1, -1.5, 3], [-3, -1, -4]])


def axes(kind, angles, limits=True):
    figure = plt.figure(figsize=(4, 3), dpi=100)
    ax = figure.add_subplot(projection="3d")
    ax.set_proj_type(kind)
    ax.view_init(*angles)
    if limits:
        ax.set(xlim=(-4, 4), ylim=(-3, 3), zlim=(-5, 6))
    return figure, ax


@pytest.mark.parametrize("kind", ["persp", "ortho"])
@pytest.mark.parametrize("angles", [(30, -60, 0), (-20, 140, 0), (80, 10, 35)])
def test_places_are_matplotlibs(kind, angles):
    from rastrum._matplotlib import camera_of
    figure, ax = axes(kind, angles)
    figure.canvas.draw()
    size = round(ax.bbox.width), round(ax.bbox.height)
    seen = rr.render(rr.Points(PLACES, size=3), camera_of(ax), size=size, outputs="id").id
    x, y, _ = proj3d.proj_transform(*PLACES.T, ax.get_proj())
    for i, (px, py) in enumerate(ax.transData.transform(np.stack([x, y], -1))):
        rows, columns = np.nonzero(seen == i)
        assert abs(columns.mean() + 0.5 - (px - ax.bbox.x0)) <= 1 and abs(size[1] - rows.mean() - 0.5 - (py - ax.bbox.y0)) <= 1
    plt.close(figure)


def pixels(figure):
    figure.canvas.draw()
    return np.asarray(figure.canvas.buffer_rgba())[..., :3].astype(int)


@pytest.mark.parametrize("kind", ["persp", "ortho"])
def test_it_is_in_the_figure_and_turns_with_it(kind):
    figure, ax = axes(kind, (25, -50, 0))
    empty = pixels(figure)
    # The nearer of two balls hides the other.
    eye = np.array([np.cos(np.radians(25)) * np.cos(np.radians(-50)), np.cos(np.radians(25)) * np.sin(np.radians(-50)),
                    np.sin(np.radians(25))])
    ax.set_box_aspect((8, 6, 11))
    empty = pixels(figure)
    balls = [rr.Spheres([[0, 0, 0]], 1, color="red"), rr.Spheres([2.2 * eye], 0.6, color="blue")]
    artist = rr.draw_behind(ax, balls, lights=None, shader="flat", samples=1)
    drawn = pixels(figure)
    red, blue = (drawn == [255, 0, 0]).all(-1), (drawn == [0, 0, 255]).all(-1)
    assert red.sum() > 300 and blue.sum() > 100 and (drawn != empty).any(-1).sum() < 20000
    middle = np.argwhere(blue).mean(0)
    assert np.abs(middle - np.argwhere(red | blue).mean(0)).max() < 3      # the blue one before the middle of the red one
    ax.view_init(25, 40)
    turned = pixels(figure)
    assert np.abs(np.argwhere((turned == [0, 0, 255]).all(-1)).mean(0) - middle).max() > 5
    artist.remove()
    ax.view_init(25, -50)
    assert (pixels(figure) == empty).all()
    plt.close(figure)


def test_lines_lie_before_it_and_files_are_written(tmp_path):
    figure, ax = axes("persp", (25, -50, 0))
    rr.draw_behind(ax, rr.Spheres([[0, 0, 0]], 3, color="white"))
    ax.plot([-4, 4], [0, 0], [0, 0], color="lime", linewidth=3)
    assert ((pixels(figure) - [0, 255, 0]) ** 2).sum(-1).min() < 100
    for name in ("f.png", "f.pdf", "f.svg"):
        figure.savefig(tmp_path / name, dpi=200)
        assert (tmp_path / name).stat().st_size > 2000
    plt.close(figure)


def test_flat_axes_are_refused():
    figure, ax = plt.subplots()
    with pytest.raises(rr.ArgumentTypeError, match="Axes3D"):
        rr.draw_behind(ax, rr.Spheres([[0, 0, 0]], 1))
    plt.close(figure)
