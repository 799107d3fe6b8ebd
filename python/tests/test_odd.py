"""Troubles that users of other tools have reported, rebuilt with geometry of our own: one test a trouble, named
for what is odd; its docstring says what is right. Those of files and of the C++ library stand in tests/odd/."""

import numpy as np
import pytest

import rastrum as rr


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_near_plane_in_any_unit(unit):
    """A ball of 1 on ground of 20,000, seen from 10: it is there, whatever a unit is: near follows the scene and the target."""
    ground = np.array([[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]]) * 10000 * unit
    things = [rr.Mesh(ground, [[0, 2, 1], [0, 3, 2]]), rr.Spheres([[0.0, unit, 0]], unit)]
    cameras = [rr.Camera.look_at((0, 7 * unit, 8 * unit), (0, unit, 0)),
               rr.Camera.orthographic((0, 7 * unit, 8 * unit), (0, unit, 0), height=12 * unit)]
    for camera in cameras:
        seen = (rr.render(things, camera, size=(100, 100), outputs="instance").instance == 1).sum()
        assert 150 < seen < 260


def test_parallel_depth_in_any_unit():
    """A sheet a thousandth before another hides it in a parallel projection: far lies behind the scene, not at 10^6."""
    sheet = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], float)
    things = [rr.Mesh(sheet, [[0, 1, 2], [0, 2, 3]]), rr.Mesh(sheet + (0, 0, 0.001), [[0, 1, 2], [0, 2, 3]])]
    seen = rr.render(things, rr.Camera.orthographic((0, 0, 4), height=3), size=(60, 60), outputs="instance").instance
    assert (seen[seen >= 0] == 1).all() and (seen == 1).sum() > 1000


def test_shadows_on_a_large_floor():
    """A box's shadow is the same on a floor of 2 and of 2,000."""
    def shadow(half, **more):
        floor = rr.Mesh(np.array([[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]]) * half, [[0, 2, 1], [0, 3, 2]])
        things = [floor, rr.Spheres([[0.0, 0.2, 0]], 0.15)]
        frame = dict(size=(96, 96), shader="lambert", lights=rr.Light.directional((-1, -1.2, -0.4)))
        camera = rr.Camera.look_at((0.7, 0.8, 1.2), (0, 0.1, 0))
        lit = rr.render(things, camera, **frame, outputs=("color", "instance"))
        dark = rr.render(things, camera, shadows=True, **more, **frame)
        return ((lit.instance == 0) & (dark.color[..., 0] < 0.5 * lit.color[..., 0])).sum()
    small = shadow(1)
    assert small > 50 and abs(int(shadow(1000)) - int(small)) <= small // 8
    assert shadow(1000, shadow_distance=0.5) == 0 and shadow(1000, shadow_size=1024) > 50
    with pytest.raises(rr.Error, match="shadows must be 64 to 8192"):
        shadow(1, shadow_size=7)
