"""Cameras: ours, OpenCV's, OpenGL's, and those that see a whole scene."""

import functools
import math

import numpy as np

from . import _rastrum as _r
from ._arrays import _numbers, matrix, product
from ._errors import ArgumentError, ArgumentTypeError, raises_errors
from ._things import as_scene

def _triple(value, name):
    try:
        numbers = [float(v) for v in value]
    except (TypeError, ValueError) as e:
        raise ArgumentTypeError(f"{name}: must be three numbers, not {value!r}") from e
    if len(numbers) != 3 or not all(map(math.isfinite, numbers)):
        raise ArgumentError(f"{name}: must be three finite numbers, not {value!r}")
    return numbers


class Camera:
    """Where it stands and what it sees. Right-handed, x right, y up, looking along its -z; angles in degrees.

    Made by look_at, orthographic, fit, opencv and opengl. docs/conventions.md compares the conventions.

    near, far: what is nearer is cut off, in the world's units. None: near is a thousandth of the scene's size, or of how
    far it is, whichever is more, and at most a hundredth of how far the target is, or, of opencv, which has none, 0.01;
    far of a parallel projection lies behind the scene.
    """

    def __init__(self, make, asks=False):
        # make(size, ball) -> _rastrum.Camera; ball: (x, y, z, radius) of the scene, where it asks. What was fitted once
        # stays where it is.
        self._make, self._asks = functools.lru_cache(maxsize=8)(make), asks

    def _for_size(self, size, scene=None):
        return self._make(size, scene._made.ball() if self._asks else None)

    @staticmethod
    @raises_errors
    def look_at(eye, target=(0, 0, 0), up=(0, 1, 0), *, fov=60.0, near=None, far=math.inf):
        """From `eye` to `target`. fov: across the smaller side of the picture."""
        return _placed(_triple(eye, "eye"), _triple(target, "target"), _triple(up, "up"), fov, None, near, far)

    @staticmethod
    @raises_errors
    def orthographic(eye, target=(0, 0, 0), up=(0, 1, 0), *, height, near=None, far=None):
        """Parallel projection; height: world units across the smaller side of the picture."""
        return _placed(_triple(eye, "eye"), _triple(target, "target"), _triple(up, "up"), 60.0, float(height), near, far)

    @staticmethod
    @raises_errors
    def fit(what, view="front", *, up=(0, 1, 0), fov=60.0, orthographic=False):
        """All of `what` as large as the picture can have it. view: front, back, left, right, top, bottom, iso, or
        where the eye stands as seen from the middle of it, (x, y, z)."""
        scene, up = as_scene(what), _triple(up, "up")
        if isinstance(view, str):
            direction, up = _r.view(view, up)
        else:
            direction = [-v for v in _triple(view, "view")]
            if np.linalg.norm(np.cross(direction, up)) < 1e-9 * np.linalg.norm(direction):
                raise ArgumentError("up: lies along the view; from above take up=(0, 0, -1), say")
        return Camera(lambda size, ball: _r.fit(scene._made, direction, up, fov, orthographic, *size))

    @staticmethod
    @raises_errors
    def opencv(K, R=None, t=None, *, near=None, first_centre=0.0):
        """Of OpenCV's intrinsics (3, 3) in pixels and a pose from world to camera (x right, y down, z ahead).
        first_centre: u and v of the centre of the top left pixel, 0.5 where cx = W / 2 is the middle."""
        k = _numbers(K, "K")
        if k.dtype.kind not in "fiu" or k.shape != (3, 3):
            raise ArgumentError(f"K: must be (3, 3) numbers, not {k.shape} of {k.dtype}")
        k = np.array(k, np.float64, order="C")  # a copy: it is asked when a size is known
        pose = np.eye(4)
        if R is not None:
            turn = _numbers(R, "R")
            if turn.dtype.kind not in "fiu" or turn.shape != (3, 3):
                raise ArgumentError(f"R: must be (3, 3) numbers, not {turn.shape} of {turn.dtype}; of a rotation vector cv2.Rodrigues makes one")
            pose[:3, :3] = turn
        if t is not None:
            move = _numbers(t, "t")
            if move.dtype.kind not in "fiu" or move.size != 3:
                raise ArgumentError(f"t: must be three numbers, not {move.shape} of {move.dtype}")
            pose[:3, 3] = move.reshape(3)
        return Camera(lambda size, ball: _r.opencv(k, pose, *size, near, first_centre, ball), near is None)

    @staticmethod
    @raises_errors
    def opengl(projection, view=None, *, depth="opengl"):
        """Of 4 x 4 matrices that multiply columns: projection @ view takes the world to clip space. depth: what the
        near and far plane become: opengl (-1, 1), zero_to_one (0, 1) or reversed (1, 0)."""
        clip = matrix(projection, "projection")
        if view is not None:
            clip = product(clip, matrix(view, "view"))
        made = _r.of_matrix(clip, depth)
        return Camera(lambda size, ball: made)


def _placed(*lens):
    asks = None in lens[-2:]
    if not asks:
        made = _r.look_at(*lens, None)
        return Camera(lambda size, ball: made)
    return Camera(lambda size, ball: _r.look_at(*lens, ball), asks)


@raises_errors
def orbit(what, n, *, elevation=25.0, up=(0, 1, 0), fov=60.0):
    """n cameras around all of `what` at one distance, so that it keeps its size; counter-clockwise as seen from above,
    `elevation` degrees up."""
    if isinstance(n, bool) or not isinstance(n, (int, np.integer)):
        raise ArgumentTypeError(f"n: must be a whole number of cameras, not {n!r}")
    if n < 1:
        raise ArgumentError(f"n: {n!r} cameras; there is at least one")
    fov, elevation = float(fov), float(elevation)
    if not 0 < fov < 180:
        raise ArgumentError(f"fov: {fov} degrees; it must lie between 0 and 180")
    if not math.isfinite(elevation):
        raise ArgumentError(f"elevation: {elevation} degrees are no height")
    scene, up = as_scene(what), np.asarray(_triple(up, "up"))
    if not up.any():
        raise ArgumentError("up: (0, 0, 0) is no direction")
    up = up / np.linalg.norm(up)
    side = np.cross(up, (0.0, 0.0, 1.0))
    if np.linalg.norm(side) < 1e-9:
        side = np.array((1.0, 0.0, 0.0))
    side = side / np.linalg.norm(side)
    ahead = np.cross(side, up)
    low, high = np.asarray(scene.bounds if scene.bounds is not None else ((-1, -1, -1), (1, 1, 1)), float)
    middle, radius = (low + high) / 2, math.dist(low, high) / 2 or 1.0
    away = radius / math.sin(math.radians(fov / 2))
    near = max(away - 1.001 * radius, away / 1000)
    rise = math.radians(max(-89.0, min(89.0, elevation)))
    cameras = []
    for i in range(int(n)):
        a = 2 * math.pi * i / n
        eye = math.cos(rise) * (math.cos(a) * ahead + math.sin(a) * side) + math.sin(rise) * up
        cameras.append(Camera.look_at(middle + away * eye, middle, up, fov=fov, near=near))
    return cameras


@raises_errors
def as_camera(camera, scene):
    """A Camera, a (4, 4) from world to OpenGL's clip space, or None: all of the scene from the front."""
    if camera is None:
        return Camera.fit(scene)
    if isinstance(camera, Camera):
        return camera
    if np.shape(camera) == (4, 4):
        return Camera.opengl(camera)
    raise ArgumentTypeError(f"camera: must be a rastrum.Camera or a (4, 4), not {type(camera).__qualname__}")
