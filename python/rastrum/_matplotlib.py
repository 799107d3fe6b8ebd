# SPDX-License-Identifier: BSD-3-Clause
"""Pictures behind matplotlib's three-dimensional axes, by their camera."""

import numpy as np

from ._arrays import product
from ._camera import Camera
from ._errors import ArgumentTypeError
from ._render import Renderer
from ._scene import as_scene


def camera_of(ax):
    """The Camera of an Axes3D as it would be drawn now, for a picture of ax.bbox's size.

    matplotlib's matrix gives a place on the axes' plane and, of a perspective, w: the distance along the view. Its third
    row orders artists alone, so depth is made from w here, and of a parallel projection shifted before the eye.
    """
    m = np.asarray(ax.get_proj(), float)
    # From the axes' plane to pixels, which is affine, and from there to the picture's -1 … 1.
    to_px = product(ax.transData.get_affine().get_matrix(), ax.transData.transform_non_affine(np.eye(3)))
    box = ax.bbox
    to_picture = np.array([[2 / box.width, 0, -2 * box.x0 / box.width - 1], [0, 2 / box.height, -2 * box.y0 / box.height - 1]])
    place = np.concatenate([product(to_px[:2], m[[0, 1, 3]]), m[3:]])
    clip = np.empty((4, 4))
    clip[:2] = product(to_picture, place)
    clip[3] = m[3]
    if np.abs(m[3, :3]).max() < 1e-12:
        clip[2] = m[2] - m[3]
    else:
        near, far = ax._dist / 100, ax._dist * 100
        clip[2] = (far + near) / (far - near) * m[3]
        clip[2, 3] -= 2 * far * near / (far - near)
    return Camera.opengl(clip)


def draw_behind(ax, what, **frame):
    """Draws `what` into a matplotlib Axes3D, in its data coordinates, in front of panes and grid and behind everything that is
    plotted. It is drawn again whenever the figure is, so that it turns and zooms with the axes.

    what, frame: as in render, but size and camera are those of the axes; samples is 4 and lights studio unless given.
    The axes must be linear. Returns the artist, whose remove() takes it away again. Raises ArgumentTypeError if `ax` is not
    three-dimensional.
    """
    if not hasattr(ax, "get_proj"):
        raise ArgumentTypeError(f"ax: must be a matplotlib Axes3D (projection='3d'), not {type(ax).__name__}")
    from matplotlib.artist import Artist

    scene, renderer = as_scene(what), Renderer()
    frame = {"samples": 4, "lights": "studio", **frame}

    class Behind(Artist):
        def draw(self, canvas):
            size = round(ax.bbox.width), round(ax.bbox.height)
            if not self.get_visible() or min(size) < 1:
                return
            picture = renderer.render(scene, camera_of(ax), size=size, **frame)
            gc = canvas.new_gc()
            gc.set_clip_rectangle(ax.bbox)
            canvas.draw_image(gc, round(ax.bbox.x0), round(ax.bbox.y0), np.ascontiguousarray(picture.color[::-1]))
            gc.restore()

    artist = Behind()
    artist.set_zorder(-1000)
    return ax.add_artist(artist)
