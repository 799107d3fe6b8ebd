# SPDX-License-Identifier: BSD-3-Clause
"""Environments of gymnasium and dm_control draw with Rastrum."""
import os
import types

import numpy as np
import pytest

import rastrum as rr

if "asan" in os.environ.get("LD_PRELOAD", ""):
    pytest.skip("MuJoCo's library is not made for a sanitizer", allow_module_level=True)
mujoco = pytest.importorskip("mujoco")

from rastrum.compat.environments import attach  # noqa: E402
from rastrum.compat.mujoco import Renderer  # noqa: E402

XML = """<mujoco><visual><global offwidth="200" offheight="100"/></visual><asset><material name="red" rgba="1 0 0 1"/></asset>
  <worldbody><light pos="0 0 3"/><camera name="above" pos="0 0 4"/><geom type="plane" size="2 2 .1"/>
    <body pos="0 0 1"><freejoint/><geom name="ball" type="sphere" size=".4" material="red"/></body></worldbody></mujoco>"""


@pytest.fixture
def cheetah():
    rendering = pytest.importorskip("gymnasium.envs.mujoco.mujoco_rendering")
    import gymnasium
    made = []

    def make(mode, **options):
        env = attach(gymnasium.make("HalfCheetah-v5", render_mode=mode, width=96, height=64, **options))
        made.append(env)
        env.reset(seed=1)
        assert isinstance(env.unwrapped.mujoco_renderer._theirs, rendering.MujocoRenderer)
        return env
    yield make
    for env in made:
        assert not env.unwrapped.mujoco_renderer._theirs._viewers  # OpenGL was not asked
        env.close()


def picture_of(env, depth=False):
    """By gymnasium's default camera."""
    inner = env.unwrapped
    camera = mujoco.MjvCamera()
    camera.lookat[:] = np.median(inner.data.geom_xpos, axis=0)
    camera.distance = 4.0  # HalfCheetah's own
    with Renderer(inner.model, 64, 96, threads=1) as renderer:
        renderer.update_scene(inner.data, camera)
        if depth:
            renderer.enable_depth_rendering()
        return renderer.render()


def test_gymnasium_draws_colours(cheetah):
    env = cheetah("rgb_array")
    first = env.render()
    assert first.shape == (64, 96, 3) and first.dtype == np.uint8
    assert (first == picture_of(env)).all()
    for _ in range(20):
        env.step(env.action_space.sample())
    assert (env.render() != first).any()


def test_gymnasiums_depth_is_opengls_buffer(cheetah):
    env = cheetah("depth_array")
    buffer, metres = env.render(), picture_of(env, depth=True)
    vis, extent = env.unwrapped.model.vis.map, env.unwrapped.model.stat.extent
    near, far = vis.znear * extent, vis.zfar * extent
    assert buffer.dtype == np.float32 and 0 < buffer.min() and buffer.max() <= 1
    np.testing.assert_allclose(near / (1 - buffer.astype(float) * (1 - near / far)), metres, rtol=2e-3)
    colours, depth = cheetah("rgbd_tuple").render()
    assert (depth == buffer).all() and (colours == picture_of(env)).all()


def test_gymnasiums_wrappers_take_it(cheetah):
    import gymnasium
    env = gymnasium.wrappers.AddRenderObservation(cheetah("rgb_array", camera_name="track"), render_only=True)
    observation, _ = env.reset(seed=1)
    assert observation.shape == (64, 96, 3) and observation.std() > 5


class Physics:
    """What attach() uses of dm_control's."""

    def __init__(self):
        self.model = types.SimpleNamespace(ptr=mujoco.MjModel.from_xml_string(XML))
        self.data = types.SimpleNamespace(ptr=mujoco.MjData(self.model.ptr))
        mujoco.mj_forward(self.model.ptr, self.data.ptr)

    def render(self, *_, **__):
        raise AssertionError("OpenGL is asked")


def test_dm_controls_physics_draws():
    env = attach(types.SimpleNamespace(physics=Physics()))
    render = env.physics.render
    with Renderer(env.physics.model.ptr, 60, 80) as renderer:
        renderer.update_scene(env.physics.data.ptr, "above")
        colours, depth, segmentation = renderer.render(), *renderer.render_all()[1:]
    assert (render(60, 80, "above") == colours).all()
    assert (render(60, 80, camera_id=0, depth=True) == depth).all()
    assert (render(60, 80, 0, segmentation=True) == segmentation).all()
    assert (render(60, 80, 0) == colours).all()
    unshadowed = render(60, 80, 0, render_flag_overrides={"shadow": False})
    assert (unshadowed != colours).any()
    assert (render(60, 80, 0, render_flag_overrides={mujoco.mjtRndFlag.mjRND_SHADOW: 0}) == unshadowed).all()
    assert (render(60, 80, 0) == colours).all()  # the flags came back

    def add(physics, scene):
        assert physics is env.physics
        mujoco.mjv_initGeom(scene.geoms[scene.ngeom], mujoco.mjtGeom.mjGEOM_BOX, np.full(3, 0.3), np.array([1.2, 0, 0.5]), np.eye(3).ravel(),
                            np.array([0, 1, 0, 1], np.float32))
        scene.ngeom += 1
    assert (render(60, 80, 0, scene_callback=add) != colours).any()
    other = Physics()
    env.physics.model, env.physics.data = other.model, other.data  # compiled anew
    assert (render(60, 80, 0) == colours).all()


def test_a_composers_environment_draws_after_it_compiles_anew():
    hooks = {}
    env = attach(types.SimpleNamespace(physics=Physics(), add_extra_hook=lambda name, hook: hooks.setdefault(name, hook)))
    before = env.physics.render(60, 80, 0)
    env.physics = Physics()
    hooks["after_compile"](env.physics, np.random.RandomState(0))
    assert (env.physics.render(60, 80, 0) == before).all()


def test_what_is_not_drawn_is_refused():
    physics = Physics()
    env = attach(types.SimpleNamespace(physics=physics))
    with pytest.raises(rr.UnsupportedError, match="overlays"):
        env.physics.render(60, 80, overlays=("text",))
    with pytest.raises(rr.ArgumentTypeError, match="two pictures"):
        env.physics.render(60, 80, depth=True, segmentation=True)
    with pytest.raises(rr.ArgumentTypeError, match="neither gymnasium's"):
        attach(object())
