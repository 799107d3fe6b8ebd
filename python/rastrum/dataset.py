# SPDX-License-Identifier: BSD-3-Clause
"""Ground truth for data sets: the masks of each object, depth in millimetres, COCO's run lengths, and BOP's folder."""

import json
import os
import pathlib
import typing

import numpy as np

from ._arrays import _numbers, matrix, product
from ._camera import Camera, as_camera
from ._errors import ArgumentError, ArgumentTypeError, UnsupportedError, raises_errors, warn
from ._files import whole
from ._render import _size, render
from ._scene import Scene, as_scene

__all__ = ["BopScene", "Seen", "millimetres", "objects", "run_lengths"]


class Seen(typing.NamedTuple):
    """An object in a picture. visible: (H, W) bool, where it is in front. mask: where it would be without the others.
    visibility: the part of `mask` that is visible, 0 if `mask` is empty."""
    visible: np.ndarray
    mask: np.ndarray
    visibility: float


def _box(mask):
    """BOP's and COCO's [x, y, width, height]; [-1, -1, -1, -1] if nothing is there."""
    rows, columns = np.flatnonzero(mask.any(1)), np.flatnonzero(mask.any(0))
    if not rows.size:
        return [-1, -1, -1, -1]
    return [int(columns[0]), int(rows[0]), int(columns[-1] - columns[0] + 1), int(rows[-1] - rows[0] + 1)]


@raises_errors
def objects(what, camera=None, *, size=(640, 480), **frame):
    """Returns {id: Seen} for each visible object of a scene, in the order of ids.

    Things with one `id` are one object; a thing without has its place in the scene. frame: more of Renderer.render, such as
    clip_planes, cull and threads. All surfaces count as opaque. Cost: a picture of the scene, and one of each object.
    Raises UnsupportedError for scenes of files, whose parts cannot be drawn alone: give their meshes.
    """
    scene = as_scene(what)
    if scene.files:
        raise UnsupportedError(f"objects: the parts of {scene.files[0]} cannot be drawn alone; give things, such as rastrum.Mesh")
    frame = {"transparency": "none", **frame, "outputs": "instance", "size": size}
    # The planes of a camera may depend on the scene: all pictures have those of the whole.
    camera = Camera._of(as_camera(camera, scene)._for_size(_size(size), scene))
    ids = render(scene, camera, **frame).instance
    parts = {}
    for place, thing in enumerate(scene.things):
        if thing.visible:
            parts.setdefault(place if thing.id is None else thing.id, []).append(thing)
    seen = {}
    for number in sorted(parts):
        visible = ids == number
        mask = render(Scene(parts[number]), camera, **frame).instance >= 0
        pixels = np.count_nonzero(mask)
        seen[number] = Seen(visible, mask, np.count_nonzero(visible) / pixels if pixels else 0.0)
    return seen


@raises_errors
def millimetres(depth, unit=1.0):
    """Returns `depth` as sensors store it: (H, W) of uint16 in millimetres, rounded, 0 where nothing is.

    unit: how many metres a unit of the scene is. Depths beyond 65.535 m become 0, and a warning says how many pixels.
    """
    depth = _numbers(depth, "depth")
    if depth.dtype.kind != "f" or depth.ndim != 2:
        raise ArgumentError(f"depth: must be (H, W) of floats, not {depth.shape} of {depth.dtype}")
    made = np.rint(depth.astype(np.float64) * (1000.0 * unit))
    far = np.isfinite(made) & (made > 65535)
    if far.any():
        warn(f"depth: {np.count_nonzero(far)} pixels lie beyond 65.535 m and become 0; is unit={unit} right?")
    return np.where((made > 0) & (made <= 65535), made, 0).astype(np.uint16)


@raises_errors
def run_lengths(mask):
    """Returns a mask (H, W) as COCO's uncompressed run lengths: {"size": [H, W], "counts": [...]}, down the columns, beginning
    with a run of 0 (pycocotools.mask.frPyObjects compresses it)."""
    mask = _numbers(mask, "mask")
    if mask.ndim != 2 or mask.dtype.kind not in "bui":
        raise ArgumentError(f"mask: must be (H, W) of bool or integers, not {mask.shape} of {mask.dtype}")
    flat = (mask != 0).ravel(order="F")
    ends = np.flatnonzero(flat[1:] != flat[:-1]) + 1
    first = [0] if flat[:1].any() else []
    return {"size": list(mask.shape), "counts": first + np.diff(ends, prepend=0, append=flat.size).tolist()}


def _pose(value, name, unit):
    """BOP's rotation, row after row, and translation in millimetres of a rigid (4, 4)."""
    pose = np.asarray(value, np.float64)
    if pose.shape != (4, 4) or pose[3].tolist() != [0, 0, 0, 1] or not np.isfinite(pose).all():
        raise ArgumentError(f"{name}: must be a pose, a finite (4, 4) whose last row is (0, 0, 0, 1)")
    if np.abs(product(pose[:3, :3], pose[:3, :3].T) - np.eye(3)).max() > 1e-4:
        raise ArgumentError(f"{name}: its rotation must not scale")
    return pose[:3, :3].ravel().tolist(), (1000.0 * unit * pose[:3, 3]).tolist()


class BopScene:
    """Writes one scene's folder of a BOP data set: rgb, depth, mask, mask_visib, and scene_camera.json, scene_gt.json and
    scene_gt_info.json, which close() writes (so does the end of a `with`). Needs Pillow.

    folder: is made, and must be empty. unit: how many metres a unit of the scene is.
    """

    @raises_errors
    def __init__(self, folder, unit=1.0):
        self._folder, self._unit = pathlib.Path(folder), float(unit)
        self._folder.mkdir(parents=True, exist_ok=True)
        if any(self._folder.iterdir()):
            raise ArgumentError(f"{folder}: is not empty, and pictures of two runs would mix")
        for name in ("rgb", "depth", "mask", "mask_visib"):
            (self._folder / name).mkdir()
        self._tables = {"scene_camera": {}, "scene_gt": {}, "scene_gt_info": {}}

    @raises_errors
    def add(self, color, depth, K, world_to_camera, objects):
        """Adds a picture. color: (H, W, 3 or 4) of uint8. depth: (H, W), as Picture.depth. K: (3, 3), for centres of pixels at
        whole numbers. world_to_camera: (4, 4) in OpenCV's axes. objects: rows (obj_id, model_to_world (4, 4), Seen)."""
        number = len(self._tables["scene_camera"])
        color = np.asarray(color)
        if color.dtype != np.uint8 or color.ndim != 3 or color.shape[2] not in (3, 4):
            raise ArgumentError(f"color: must be (H, W, 3 or 4) of uint8, not {color.shape} of {color.dtype}")
        stored, objects = millimetres(depth, self._unit), list(objects)
        shapes = {"depth": stored.shape, **{f"objects[{i}]": seen.mask.shape for i, (_, _, seen) in enumerate(objects)}}
        for name, shape in shapes.items():
            if shape != color.shape[:2]:
                raise ArgumentError(f"{name}: is {shape}, and the picture is {color.shape[:2]}")
        k = np.asarray(K, np.float64)
        if k.shape != (3, 3):
            raise ArgumentError(f"K: must be (3, 3), not {k.shape}")
        to_camera = matrix(world_to_camera, "world_to_camera")
        turn, move = _pose(to_camera, "world_to_camera", self._unit)
        poses, about = [], []
        for obj_id, model_to_world, seen in objects:
            if isinstance(obj_id, bool) or not isinstance(obj_id, (int, np.integer)):
                raise ArgumentTypeError(f"objects: obj_id must be a whole number, not {obj_id!r}")
            r, t = _pose(product(to_camera, matrix(model_to_world, "model_to_world")), "model_to_world", self._unit)
            poses.append({"cam_R_m2c": r, "cam_t_m2c": t, "obj_id": int(obj_id)})
            about.append({"bbox_obj": _box(seen.mask), "bbox_visib": _box(seen.visible),
                          "px_count_all": int(np.count_nonzero(seen.mask)),
                          "px_count_valid": int(np.count_nonzero(seen.mask & (stored > 0))),
                          "px_count_visib": int(np.count_nonzero(seen.visible)), "visib_fract": float(seen.visibility)})
        name = f"{number:06d}"
        self._save(f"rgb/{name}.png", color[..., :3])
        self._save(f"depth/{name}.png", stored)
        for i, (_, _, seen) in enumerate(objects):
            self._save(f"mask/{name}_{i:06d}.png", np.where(seen.mask, 255, 0).astype(np.uint8))
            self._save(f"mask_visib/{name}_{i:06d}.png", np.where(seen.visible, 255, 0).astype(np.uint8))
        self._tables["scene_camera"][str(number)] = {"cam_K": k.ravel().tolist(), "depth_scale": 1.0,
                                                     "cam_R_w2c": turn, "cam_t_w2c": move}
        self._tables["scene_gt"][str(number)] = poses
        self._tables["scene_gt_info"][str(number)] = about

    def _save(self, name, pixels):
        from PIL import Image
        Image.fromarray(np.ascontiguousarray(pixels)).save(self._folder / name)

    def close(self):
        """Writes the tables."""
        for name, table in self._tables.items():
            with whole(os.fspath(self._folder / f"{name}.json")) as file:
                file.write(json.dumps(table, indent=1).encode())

    def __enter__(self):
        return self

    def __exit__(self, kind, error, traceback):
        if kind is None:
            self.close()
