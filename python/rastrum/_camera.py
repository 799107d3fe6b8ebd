# SPDX-License-Identifier: BSD-3-Clause
"""Cameras: ours, OpenCV's, OpenGL's, and those that see a whole scene."""

import functools
import math
import typing

import numpy as np

from . import _rastrum as _r
from ._arrays import _numbers, matrix, number, placement, product, whole
from ._errors import ArgumentError, ArgumentTypeError, raises_errors
from ._scene import as_scene


def _triple(value, name):
    try:
        numbers = [float(v) for v in value]
    except (TypeError, ValueError) as e:
        raise ArgumentTypeError(f"{name}: must be three numbers, not {value!r}") from e
    if len(numbers) != 3 or not all(map(math.isfinite, numbers)):
        raise ArgumentError(f"{name}: must be three finite numbers, not {value!r}")
    return numbers


def _look(ahead, up):
    """Returns (ahead, up); raises if they give no axes for a picture."""
    if not any(ahead):
        raise ArgumentError("target: must differ from the eye")
    if not any(up):
        raise ArgumentError("up: (0, 0, 0) is no direction")
    if np.linalg.norm(np.cross(ahead, up)) < 1e-9 * np.linalg.norm(ahead) * np.linalg.norm(up):
        other = (0, 0, -1) if abs(ahead[1]) > 0.5 * np.linalg.norm(ahead) else (0, 1, 0)  # from above, as the program does
        raise ArgumentError(f"up: {tuple(up)} lies along the view; take up={other}, say")
    return ahead, up


def _fov(fov):
    made = number(fov, "fov")
    if not 0 < made < 180:
        raise ArgumentError(f"fov: {fov!r} degrees; it must lie between 0 and 180")
    return made


def _plane(distance, name):
    return None if distance is None else number(distance, name)


def _is_pose(m):
    """Whether a matrix only rotates and translates."""
    turn = m[:3, :3]
    return (m[3].tolist() == [0, 0, 0, 1] and np.abs(product(turn, turn.T) - np.eye(3)).max() < 1e-4 and
            (np.cross(turn[0], turn[1]) * turn[2]).sum() > 0)


def _is_transposed(m):
    """Whether a matrix to clip space is transposed. In a proper one depth is parallel to w. If that holds both ways, w has
    length 1 in the proper one; for a parallel projection w is constant."""
    def length(v):
        return math.sqrt((v * v).sum())

    def goes_along(a):
        return length(np.cross(a[2, :3], a[3, :3])) < 1e-6 * length(a[2, :3]) * length(a[3, :3])
    row, column = m[3, :3], m[:3, 3]
    if not row.any() or not column.any():
        return bool(row.any())
    return goes_along(m.T) and (not goes_along(m) or abs(length(row) - 1) > 1e-6 > abs(length(column) - 1))


# What Camera._make calls; functions with names, so that pickle carries cameras.

def _standing(lens, size, ball):
    return _r.look_at(*lens, ball)


def _fitted(scene, lens, size, ball):
    return _r.fit(scene._made, *lens, *size)


def _of_opencv(k, pose, near, first_centre, size, ball):
    return _r.opencv(k, pose, *size, near, first_centre, ball)


def _of_matrix(clip, depth, size, ball):
    return _r.of_matrix(clip, depth)


class Projected(typing.NamedTuple):
    """Points in a picture: Camera.project."""
    pixel: np.ndarray
    depth: np.ndarray
    seen: np.ndarray


class Camera:
    """A camera: where it stands and what it sees. Right-handed, x right, y up, looking along its -z; angles in degrees.

    Make one by look_at, orthographic, fit, opencv or opengl. docs/cameras.md compares the conventions.

    near, far: nothing nearer or farther is drawn, in the world's units. None: near is a thousandth of the scene's radius or
    of the distance to it, whichever is more, but at most a hundredth of the distance to the target (opencv, which has no
    target, takes 0.01); far of a parallel projection lies behind the scene.
    """

    def __init__(self, make, asks=False):
        # make(size, ball) -> _rastrum.Camera; ball: (x, y, z, radius) of the scene, if `asks`. Results are cached, so a
        # fitted camera stays where it is.
        self._make, self._asks = functools.lru_cache(maxsize=8)(make), asks

    def __reduce__(self):
        return Camera, (self._make.__wrapped__, self._asks)

    @staticmethod
    def _of(made):
        """A camera of C++, the same for all sizes and scenes. pickle does not take it."""
        return Camera(lambda size, ball: made)

    def _for_size(self, size, scene=None):
        return self._make(size, scene._made.ball(None) if self._asks else None)

    @raises_errors
    def project(self, points, size, *, depth=None):
        """Returns where a picture of size (W, H) shows points (N, 3) of the world: a Projected of `pixel` (N, 2), x and y with the centre of
        the first pixel at (0.5, 0.5), NaN at and behind the eye; `depth` (N,) along the axis, as the output depth; and `seen` (N,). A
        point is seen if it lies in the picture and, with that picture's `depth` (H, W), no surface hides it; surfaces do not hide the
        points that lie on them."""
        width, height = (whole(n, "size", 1, 32768) for n in size)
        points = _numbers(points, "points")
        if points.dtype.kind not in "fiu" or points.ndim != 2 or points.shape[1] != 3:
            raise ArgumentError(f"points: must be (N, 3) numbers, not {points.shape} of {points.dtype}")
        if depth is not None:
            depth = np.ascontiguousarray(depth, np.float32)
            if depth.shape != (height, width):
                raise ArgumentError(f"depth: the shape is {depth.shape} and must be {(height, width)}, as size says")
        found = np.empty((len(points), 3))
        # A scene's ball decides planes alone, which do not move what is seen; in this one all of them fit.
        made = self._make((width, height), (0.0, 0.0, 0.0, 1e30) if self._asks else None)
        seen = _r.project(made, width, height, np.ascontiguousarray(points, np.float64), found, depth)
        if depth is None:
            inside = (found[:, 2] > 0) & (found[:, :2] >= 0).all(1) & (found[:, :2] < (width, height)).all(1)
        return Projected(found[:, :2], found[:, 2], inside if depth is None else np.frombuffer(seen, bool).copy())

    @staticmethod
    @raises_errors
    def look_at(eye, target=(0, 0, 0), up=(0, 1, 0), *, fov=60.0, near=None, far=math.inf):
        """Looks from `eye` to `target`. fov: the field of view across the smaller side of the picture."""
        return Camera._standing(eye, target, up, _fov(fov), None, near, far)

    @staticmethod
    @raises_errors
    def orthographic(eye, target=(0, 0, 0), up=(0, 1, 0), *, height, near=None, far=None):
        """Has a parallel projection. height: world units across the smaller side of the picture."""
        return Camera._standing(eye, target, up, 60.0, number(height, "height"), near, far)

    @staticmethod
    def _standing(eye, target, up, fov, height, near, far):
        eye, target, up = _triple(eye, "eye"), _triple(target, "target"), _triple(up, "up")
        _look([b - a for a, b in zip(eye, target)], up)
        near, far = _plane(near, "near"), _plane(far, "far")
        lens = eye, target, up, fov, height
        # Raises now for numbers out of range, before the scene is known.
        _r.look_at(*lens, 1e-30 if near is None else near, 1e30 if far is None else far, None)
        return Camera(functools.partial(_standing, (*lens, near, far)), None in (near, far))

    @staticmethod
    @raises_errors
    def fit(what, view="front", *, up=(0, 1, 0), fov=60.0, orthographic=False):
        """Shows the whole of `what`, as large as it fits into the picture. view: front, back, left, right, top, bottom, iso, or
        the direction (x, y, z) from the middle of `what` to the eye."""
        scene, up, fov = as_scene(what), _triple(up, "up"), _fov(fov)
        if isinstance(view, str):
            direction, up = _r.view(view, up)
        else:
            direction, up = _look([-v for v in _triple(view, "view")], up)
        return Camera(functools.partial(_fitted, scene, (direction, up, fov, orthographic)))

    @staticmethod
    @raises_errors
    def opencv(K, R=None, t=None, *, near=None, first_centre=0.0):
        """Makes a camera from OpenCV's intrinsics (3, 3) in pixels and a pose from world to camera (x right, y down,
        z ahead). first_centre: u and v at the centre of the top left pixel; take 0.5 if cx = W / 2 is the middle."""
        k = _numbers(K, "K")
        if k.dtype.kind not in "fiu" or k.shape != (3, 3):
            raise ArgumentError(f"K: must be (3, 3) numbers, not {k.shape} of {k.dtype}")
        k = np.array(k, np.float64, order="C")  # a copy: it is asked when a size is known
        pose = np.eye(4)
        if R is not None:
            turn = _numbers(R, "R")
            if turn.dtype.kind not in "fiu" or turn.shape != (3, 3):
                meant = ("a (4, 4) is a pose: its R is pose[:3, :3], its t pose[:3, 3]" if turn.shape in ((4, 4), (3, 4)) else
                         "cv2.Rodrigues turns a rotation vector into one")
                raise ArgumentError(f"R: must be (3, 3) numbers, not {turn.shape} of {turn.dtype}; {meant}")
            pose[:3, :3] = turn
        if t is not None:
            move = _numbers(t, "t")
            if move.dtype.kind not in "fiu" or move.size != 3:
                raise ArgumentError(f"t: must be three numbers, not {move.shape} of {move.dtype}")
            pose[:3, 3] = move.reshape(3)
        near, first_centre = _plane(near, "near"), number(first_centre, "first_centre")
        _r.opencv(k, pose, 1, 1, near, first_centre, None)  # raises for numbers out of range
        return Camera(functools.partial(_of_opencv, k, pose, near, first_centre), near is None)

    @staticmethod
    @raises_errors
    def opengl(projection, view=None, *, depth="opengl"):
        """Makes a camera from 4 x 4 matrices that multiply columns: projection @ view takes the world to clip space.
        depth: the depths of the near and the far plane: opengl (-1, 1), zero_to_one (0, 1) or reversed (1, 0)."""
        clip = matrix(projection, "projection")
        if clip.shape == (4, 4) and _is_transposed(clip):
            raise ArgumentError("projection: is a matrix that multiplies rows, but vectors are columns here: take its transpose, .T")
        if view is not None:
            clip = product(clip, placement(view, "view"))
        _r.of_matrix(clip, depth)  # raises for one without an inverse
        return Camera(functools.partial(_of_matrix, clip, depth))


@raises_errors
def orbit(what, n, *, elevation=25.0, up=(0, 1, 0), fov=60.0):
    """Returns n cameras around the whole of `what`, at one distance, so that it keeps its size. They go counter-clockwise as
    seen from above and stand `elevation` degrees up."""
    if isinstance(n, bool) or not isinstance(n, (int, np.integer)):
        raise ArgumentTypeError(f"n: must be a whole number of cameras, not {n!r}")
    if n < 1:
        raise ArgumentError(f"n: must be at least 1, not {n!r}")
    fov, elevation = _fov(fov), number(elevation, "elevation")
    if not math.isfinite(elevation):
        raise ArgumentError(f"elevation: must be a finite number of degrees, not {elevation}")
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
    """Returns the Camera for a Camera, for a (4, 4) from world to OpenGL's clip space, or for None, which sees the whole scene
    from the front."""
    if camera is None:
        return Camera.fit(scene)
    if isinstance(camera, Camera):
        return camera
    if np.shape(camera) == (4, 4):
        m = matrix(camera, "camera")
        if _is_pose(m):
            raise ArgumentError("camera: this is a pose (rotation and translation), but a (4, 4) must go from the world to clip space. With "
                                "OpenGL's axes use Camera.opengl(projection, view), where view is this, or its inverse if it goes "
                                "from camera to world; with OpenCV's axes use Camera.opencv(K, R, t)")
        return Camera.opengl(m)
    hint = f"; Camera.fit(what, {camera!r}) takes the name of a view" if isinstance(camera, str) else ""
    raise ArgumentTypeError(f"camera: must be a rastrum.Camera or a (4, 4), not {type(camera).__qualname__}{hint}")
