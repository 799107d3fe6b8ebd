# SPDX-License-Identifier: BSD-3-Clause
"""MuJoCo's renderer over Rastrum, beside what the geometry must show."""

import os
import pathlib
import re

import numpy as np
import pytest

import rastrum as rr

if "asan" in os.environ.get("LD_PRELOAD", ""):
    pytest.skip("MuJoCo's library is not made for a sanitizer", allow_module_level=True)
mujoco = pytest.importorskip("mujoco")

from rastrum.compat.mujoco import Renderer  # noqa: E402

XML = """<mujoco>
  <visual><global offwidth="640" offheight="480"/><quality offsamples="4"/>
    <headlight ambient=".2 .2 .2" diffuse=".6 .6 .6" specular="0 0 0"/></visual>
  <asset>
    <texture name="sky" type="skybox" builtin="flat" rgb1="0 .5 1" rgb2="0 .5 1" width="32" height="32"/>
    <texture name="checks" type="2d" builtin="checker" rgb1="1 0 0" rgb2="0 0 1" width="64" height="64"/>
    <texture name="cube" type="cube" builtin="flat" rgb1="0 1 0" rgb2="0 1 0" width="16" height="16"/>
    <material name="checks" texture="checks" texrepeat="2 2" texuniform="true"/>
    <material name="cube" texture="cube"/>
    <material name="mirror" reflectance=".5" rgba=".1 .1 .1 1"/>
    <hfield name="hills" nrow="8" ncol="8" size="1 1 .4 .1"/>
    <mesh name="wedge" vertex="0 0 0  1 0 0  0 1 0  0 0 1"/>
  </asset>
  <worldbody>
    <light name="lamp" pos="0 0 4" dir="0 0 -1" cutoff="60" castshadow="true"/>
    <camera name="above" pos="0 0 6" xyaxes="1 0 0 0 1 0"/>
    <camera name="side" pos="0 -6 1" xyaxes="1 0 0 0 0 1"/>
    <geom name="floor" type="plane" size="3 3 .1" material="checks"/>
    <body name="ball" pos="0 0 1"><freejoint/><geom name="ball" type="sphere" size=".5" rgba="1 1 1 1"/>
      <site name="mark" type="sphere" size=".1" pos=".8 0 0" rgba="1 1 0 1"/></body>
    <geom type="capsule" size=".2 .4" pos="2 0 .7" rgba="1 0 0 .4"/>
    <geom type="cylinder" size=".2 .4" pos="2 2 .5"/>
    <geom type="ellipsoid" size=".4 .3 .2" pos="-2 2 .5"/>
    <geom type="box" size=".3 .3 .3" pos="-2 0 .4" material="cube"/>
    <geom type="mesh" mesh="wedge" pos="-2 -2 .1"/>
    <geom type="hfield" hfield="hills" pos="2 -2 .2"/>
  </worldbody>
</mujoco>"""


@pytest.fixture(scope="module")
def model():
    return mujoco.MjModel.from_xml_string(XML)


@pytest.fixture
def data(model):
    made = mujoco.MjData(model)
    mujoco.mj_forward(model, made)
    return made


def geom(model, name):
    return mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM.value, name)


def test_depth_and_segmentation_are_the_geometrys(model, data):
    with Renderer(model, 120, 160) as renderer:
        renderer.update_scene(data, "above")
        renderer.enable_depth_rendering()
        depth = renderer.render()
        renderer.enable_segmentation_rendering()
        seen = renderer.render()
        assert depth.dtype == np.float32 and depth.shape == (120, 160)
        assert seen.dtype == np.int32 and seen.shape == (120, 160, 2)
        assert abs(depth[60, 80] - 4.5) < 2e-3  # the top of the ball
        assert seen[60, 80].tolist() == [geom(model, "ball"), mujoco.mjtObj.mjOBJ_GEOM.value]
        assert seen[60, 50].tolist() == [geom(model, "floor"), mujoco.mjtObj.mjOBJ_GEOM.value] and abs(depth[60, 50] - 6) < 1e-4
        kinds = {tuple(pair) for pair in seen.reshape(-1, 2)}
        assert len(kinds) == model.ngeom + 2  # all geoms, the site, and nothing
        renderer.update_scene(data, "side")
        sky = renderer.render()[0, 0]
        assert sky.tolist() == [-1, -1]
        renderer.enable_depth_rendering()
        assert renderer.render()[0, 0] == pytest.approx(model.vis.map.zfar * model.stat.extent, rel=1e-5)


def test_nothing_is_beyond_the_far_plane():
    near = mujoco.MjModel.from_xml_string("""<mujoco><statistic extent="1"/><visual><map zfar="4"/></visual><worldbody>
      <camera name="c" pos="0 0 6" xyaxes="1 0 0 0 1 0"/><geom type="sphere" size=".5" pos="0 0 3"/><geom type="box" size="3 3 .1"/>
    </worldbody></mujoco>""")
    data = mujoco.MjData(near)
    mujoco.mj_forward(near, data)
    with Renderer(near, 60, 80) as renderer:
        renderer.update_scene(data, "c")
        renderer.enable_segmentation_rendering()
        assert set(renderer.render()[..., 0].ravel().tolist()) == {-1, 0}
        renderer.enable_depth_rendering()
        assert renderer.render().max() == pytest.approx(4)


def test_things_move(model, data):
    with Renderer(model, 60, 80) as renderer:
        renderer.enable_segmentation_rendering()
        ball = geom(model, "ball")
        places = []
        for x in (0, 1):
            data.qpos[0] = x
            mujoco.mj_forward(model, data)
            renderer.update_scene(data, "above")
            places.append(np.argwhere(renderer.render()[..., 0] == ball).mean(0))
        assert places[1][1] - places[0][1] == pytest.approx(60 / 2 / np.tan(np.radians(22.5)) / 5, abs=1)
        assert places[0][0] == pytest.approx(places[1][0], abs=0.6)


def test_colours(model, data):
    with Renderer(model, 240, 320) as renderer:
        renderer.update_scene(data, "above")
        with_shadow = renderer.render()
        assert with_shadow.dtype == np.uint8 and with_shadow.shape == (240, 320, 3)
        assert renderer.left_out == ()
        renderer.scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = 0
        without = renderer.render()
        assert ((without.astype(int) - with_shadow).max(-1) > 30).sum() > 300  # the ball's shadow
        for one, other in ((0, 2), (2, 0)):  # the checks of the floor
            assert ((without[..., one] > 100) & (without[..., other] < 10)).sum() > 1000
        green = without[110:130, 42:60]
        assert (green[..., 1] > 100).all() and (green[..., 0] == 0).all()
        renderer.update_scene(data, "side")
        sky = renderer.render()[0, 0]
        assert np.abs(sky.astype(int) - [0, 128, 255]).max() <= 1


def test_all_at_once_is_each_alone(model, data):
    with Renderer(model, 90, 120, samples=1) as renderer:
        renderer.update_scene(data, "above")
        colours, depth, segmentation = renderer.render_all()
        assert np.array_equal(colours, renderer.render())
        renderer.enable_depth_rendering()
        alone = renderer.render()
        assert np.array_equal(depth, alone)
        renderer.enable_segmentation_rendering()
        assert np.array_equal(segmentation, renderer.render())


def test_a_batch_is_its_states(model):
    states = []
    for x in (0, 0.4, 0.8):
        states.append(mujoco.MjData(model))
        states[-1].qpos[0] = x
        mujoco.mj_forward(model, states[-1])
    with Renderer(model, 60, 80, threads=2) as renderer:
        renderer.scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = 0
        batch = renderer.render_batch(states, "above")
        assert [a.shape for a in batch] == [(3, 60, 80, 3), (3, 60, 80), (3, 60, 80, 2)]
        for i, state in enumerate(states):
            renderer.update_scene(state, "above")
            renderer.scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = 0
            for all_of, alone in zip(batch, renderer.render_all()):
                assert np.array_equal(all_of[i], alone)
        assert not np.array_equal(batch[2][0], batch[2][1])
        assert renderer.render_batch([])[0].shape == (0, 60, 80, 3)


def test_other_options_are_drawn_at_once():
    cloth = mujoco.MjModel.from_xml_string("""<mujoco><worldbody><light pos="0 0 3"/>
      <flexcomp name="cloth" type="grid" count="4 4 1" spacing=".2 .2 .2" pos="0 0 1" dim="2" mass="1" radius=".02"/>
    </worldbody></mujoco>""")
    data = mujoco.MjData(cloth)
    mujoco.mj_forward(cloth, data)
    with Renderer(cloth, 60, 80) as renderer:
        renderer.enable_segmentation_rendering()
        seen, option = [], mujoco.MjvOption()
        flags = mujoco.mjtVisFlag
        for skin in (1, 0, 1):
            option.flags[flags.mjVIS_FLEXSKIN], option.flags[flags.mjVIS_FLEXVERT] = skin, 1 - skin
            renderer.update_scene(data, scene_option=option)
            seen.append((renderer.render()[..., 1] == mujoco.mjtObj.mjOBJ_FLEX.value).sum())
        assert seen[0] == seen[2] > seen[1] > 100


def test_an_exception_leaves_all_as_it_was(model, data, monkeypatch):
    with Renderer(model, 60, 80, samples=1) as renderer:
        renderer.update_scene(data, "above")
        expected = rr.digest(renderer.render())
        data.qpos[0] = 0.5
        model.geom_rgba[geom(model, "ball")] = 0, 1, 0, 1
        mujoco.mj_forward(model, data)
        renderer.update_scene(data, "above")
        with monkeypatch.context() as patch:
            patch.setattr(renderer, "_thing", lambda *_: 1 / 0)
            with pytest.raises(ZeroDivisionError):
                renderer.render()
        changed = rr.digest(renderer.render())
        with Renderer(model, 60, 80, samples=1) as fresh:
            fresh.update_scene(data, "above")
            assert changed == rr.digest(fresh.render()) != expected
        model.geom_rgba[geom(model, "ball")] = 1
        data.qpos[0] = 0
        mujoco.mj_forward(model, data)
        renderer.update_scene(data, "above")
        assert rr.digest(renderer.render()) == expected


def test_the_model_is_read_again(model, data):
    with Renderer(model, 60, 80, samples=1) as renderer:
        renderer.update_scene(data, "above")
        before = rr.digest(renderer.render())
        texture = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_TEXTURE.value, "checks")
        kept, first = model.tex_data.copy(), model.tex_adr[texture]
        model.tex_data[first:first + 64 * 64 * 3] = 255
        assert rr.digest(renderer.render()) == before
        renderer.read_model_again()
        textured = rr.digest(renderer.render())
        assert textured != before
        model.tex_data[:] = kept
        heights = model.hfield_data.copy()
        model.hfield_data[:] = np.arange(heights.size) % 3 / 2
        renderer.read_model_again()
        assert rr.digest(renderer.render()) not in (before, textured)
        model.hfield_data[:] = heights
        renderer.read_model_again()
        assert rr.digest(renderer.render()) == before


def test_a_mirror_reflects(model):
    xml = XML.replace('type="plane" size="3 3 .1" material="checks"', 'type="plane" size="3 3 .1" material="mirror"')
    mirroring = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(mirroring)
    mujoco.mj_forward(mirroring, data)
    with Renderer(mirroring, 120, 160, samples=1) as renderer:
        renderer.update_scene(data, "side")
        seen = renderer.render()
        assert np.array_equal(seen, renderer.render())
        renderer.scene.flags[mujoco.mjtRndFlag.mjRND_REFLECTION] = 0
        brighter = (seen.astype(int) - renderer.render()).max(-1)
        rows = np.argwhere(brighter > 30)[:, 0]
        assert len(rows) > 50 and rows.min() > 70  # below the ball


def test_what_is_not_drawn_is_said(model, data):
    with Renderer(model, 30, 40) as renderer:
        renderer.update_scene(data)
        for flag in ("mjRND_FOG", "mjRND_WIREFRAME"):
            renderer.scene.flags[getattr(mujoco.mjtRndFlag, flag)] = 1
        renderer.render()
        assert renderer.left_out == ("fog is not drawn", "lines of faces are not drawn alone")


def test_the_same_bits_by_any_number_of_threads(model, data):
    digests = set()
    for threads in (1, 3):
        with Renderer(model, 60, 80, threads=threads) as renderer:
            renderer.update_scene(data, "above")
            digests.add(rr.digest(renderer.render()))
    assert len(digests) == 1


def test_mistakes(model, data):
    with Renderer(model, 30, 40) as renderer:
        with pytest.raises(ValueError, match='The camera "nowhere" does not exist'):
            renderer.update_scene(data, "nowhere")
        with pytest.raises(ValueError, match=r"The camera id 2 is out of range \[-1, 2\)"):
            renderer.update_scene(data, 2)
        renderer.update_scene(data)
        with pytest.raises(ValueError, match="out.shape"):
            renderer.render(out=np.empty((3, 3, 3), np.uint8))
        out = np.empty((30, 40, 3), np.uint8)
        assert renderer.render(out=out) is out
    with pytest.raises(RuntimeError, match="after close"):
        renderer.render()
    with pytest.raises(rr.ArgumentError, match="offwidth"):
        Renderer(model, 30, 4000)


def test_the_page_runs():
    page = pathlib.Path(__file__).parents[2] / "docs" / "robots.md"
    if not page.exists():
        pytest.skip("the pages are not beside the tests")
    block = re.findall(r"^```python\n(.*?)^```", page.read_text(encoding="utf-8"), re.M | re.S)[0]
    names = {"xml": XML}
    exec(compile(block, str(page), "exec"), names)
    assert names["pixels"].shape == (240, 320, 3) and names["segmentation"].shape == (240, 320, 2)
