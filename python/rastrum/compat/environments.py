# SPDX-License-Identifier: BSD-3-Clause
"""Environments of gymnasium, gymnasium-robotics and dm_control that draw themselves without OpenGL: `attach(env)`."""

import mujoco
import numpy as np

from .._errors import ArgumentTypeError, UnsupportedError
from .mujoco import Renderer

__all__ = ["attach"]


def attach(env, *, threads=1, samples=None):
    """Makes `env.render()`, and a dm_control environment's `env.physics.render()`, draw with rastrum.compat.mujoco. Returns env.

    env: an environment of gymnasium's MuJoCo, wrapped or not, or of dm_control. threads: for each picture; environments mostly run
    side by side. samples: a pixel; None takes the model's. A window ("human") stays gymnasium's.
    """
    inner = getattr(env, "unwrapped", env)
    inner = getattr(inner, "robot_env", inner)  # gymnasium-robotics' kitchen has its robot's environment inside
    if hasattr(inner, "mujoco_renderer"):
        inner.mujoco_renderer = _OfGymnasium(inner.mujoco_renderer, threads, samples)
    elif hasattr(getattr(env, "physics", None), "render"):
        def take(physics, *_):
            physics.render = _OfPhysics(physics, threads, samples)
        take(env.physics)
        if hasattr(env, "add_extra_hook"):  # a composer's environment compiles its physics anew
            env.add_extra_hook("after_compile", take)
    else:
        raise ArgumentTypeError(f"env: {type(inner).__module__}.{type(inner).__qualname__} has neither gymnasium's mujoco_renderer nor dm_control's physics")
    return env


class _Kept:
    """A Renderer for each size, of one model: environments may compile another."""

    def __init__(self, threads, samples):
        self._options = {"threads": threads, "samples": samples}
        self._model, self._renderers = None, {}

    def renderer(self, model, height, width, max_geom):
        if model is not self._model:
            self._model, self._renderers = model, {}
        if (height, width) not in self._renderers:
            self._renderers[height, width] = Renderer(model, height, width, max_geom, **self._options)
        return self._renderers[height, width]


class _OfGymnasium:
    """Stands for a MujocoRenderer, whose fields it has."""

    def __init__(self, theirs, threads, samples):
        self._theirs, self._kept = theirs, _Kept(threads, samples)
        self._camera, self._option = None, mujoco.MjvOption()
        for flag, value in theirs._vopt.items():
            self._option.flags[flag] = value

    def __getattr__(self, name):
        if name.startswith("_"):  # not there yet while it is copied
            raise AttributeError(name)
        return getattr(self._theirs, name)

    def __setattr__(self, name, value):
        object.__setattr__(self if name.startswith("_") else self._theirs, name, value)

    def render(self, render_mode):
        theirs = self._theirs
        if render_mode not in ("rgb_array", "depth_array", "rgbd_tuple"):
            return theirs.render(render_mode)
        renderer = self._kept.renderer(theirs.model, theirs.height, theirs.width, theirs.max_geom)
        renderer.update_scene(theirs.data, self._seen_by(), self._option)
        colours = None if render_mode == "depth_array" else renderer.render()
        if render_mode == "rgb_array":
            return colours
        renderer.enable_depth_rendering()
        try:
            depth = self._buffer(renderer.render(), renderer.scene.camera[0].orthographic)
        finally:
            renderer.disable_depth_rendering()
        return depth if render_mode == "depth_array" else (colours, depth)

    def close(self):
        self._kept = _Kept(**self._kept._options)
        self._theirs.close()

    def _seen_by(self):
        """gymnasium's camera: it stands where it was put at the first picture."""
        theirs = self._theirs
        if self._camera is None:
            self._camera = camera = mujoco.MjvCamera()
            camera.lookat[:] = np.median(theirs.data.geom_xpos, axis=0)
            camera.distance = theirs.model.stat.extent
            for name, value in (theirs.default_cam_config or {}).items():
                if isinstance(value, np.ndarray):
                    getattr(camera, name)[:] = value
                else:
                    setattr(camera, name, value)
        self._camera.fixedcamid = theirs.camera_id
        self._camera.type = mujoco.mjtCamera.mjCAMERA_FREE if theirs.camera_id == -1 else mujoco.mjtCamera.mjCAMERA_FIXED
        return self._camera

    def _buffer(self, depth, is_parallel):
        """OpenGL's depth buffer, 0 at the near plane and 1 at the far one, of distances in metres."""
        extent, planes = self._theirs.model.stat.extent, self._theirs.model.vis.map
        near, far = planes.znear * extent, planes.zfar * extent
        if is_parallel:
            return np.clip((depth - near) / (far - near), 0, 1).astype(np.float32)
        return np.clip((1 - near / depth) / (1 - near / far), 0, 1).astype(np.float32)


class _OfPhysics:
    """Stands for physics.render."""

    def __init__(self, physics, threads, samples):
        self._physics, self._kept = physics, _Kept(threads, samples)
        self._option = mujoco.MjvOption()
        self._option.flags[mujoco.mjtVisFlag.mjVIS_RANGEFINDER] = False  # as dm_control has it

    def __call__(self, height=240, width=320, camera_id=-1, overlays=(), depth=False, segmentation=False, scene_option=None,
                 render_flag_overrides=None, scene_callback=None):
        if overlays:
            raise UnsupportedError("overlays: text is not drawn into pictures of environments; draw it with annotate, or over the array")
        if depth and segmentation:
            raise ArgumentTypeError("depth and segmentation are two pictures; ask for one of them")
        renderer = self._kept.renderer(self._physics.model.ptr, height, width, None)
        renderer.update_scene(self._physics.data.ptr, camera_id, scene_option or self._option)
        flags = renderer.scene.flags.copy()
        try:
            if scene_callback is not None:
                scene_callback(self._physics, renderer.scene)
            for flag, value in (render_flag_overrides or {}).items():
                renderer.scene.flags[getattr(mujoco.mjtRndFlag, f"mjRND_{flag.upper()}") if isinstance(flag, str) else flag] = value
            renderer.enable_depth_rendering() if depth else renderer.disable_depth_rendering()
            renderer.enable_segmentation_rendering() if segmentation else renderer.disable_segmentation_rendering()
            return renderer.render()
        finally:
            renderer.scene.flags[:] = flags
