"""Troubles that users of other tools have reported, rebuilt with geometry of our own: one test a trouble, named
for what is odd; its docstring says what is right. Those of files and of the C++ library stand in tests/odd/."""

import numpy as np

import rastrum as rr


def test_a_colour_is_itself_beside_a_material():
    """`#804020` is a display value of vertices, things and balls, whatever stands beside; `albedo` is its light."""
    camera = rr.Camera.look_at((0, 0, 4), fov=60)
    wall = np.array([[-9, -9, 0], [9, -9, 0], [0, 9, 0.0]])
    beside = rr.Mesh(wall + (1000, 0, 0), material=rr.Material("red"))
    brown = np.array([[0x80, 0x40, 0x20]], np.uint8)
    for thing in (rr.Mesh(wall, color="#804020"), rr.Mesh(wall, colors=np.repeat(brown, 3, 0)),
                  rr.Mesh(wall, colors=np.repeat(brown / 255, 3, 0)), rr.Spheres([[0, 0, 0]], 1, color="#804020"),
                  rr.Points([[0, 0, 0]], size=30, colors=brown)):
        for shader in ("flat", "phong", "material"):
            alone, both = (rr.render(things, camera, size=(32, 32), shader=shader, outputs=("color", "albedo"))
                           for things in ([thing], [thing, beside]))
            assert np.array_equal(alone.color[16, 16], both.color[16, 16]), shader
            assert np.allclose(alone.albedo[16, 16, :3], (0.2158605, 0.0512695, 0.0144438), atol=1e-6), shader
            assert np.array_equal(alone.albedo[16, 16], both.albedo[16, 16]), shader
        assert tuple(rr.render(thing, camera, size=(32, 32), shader="flat").color[16, 16]) == (0x80, 0x40, 0x20, 255)


def test_a_c_is_no_fan():
    """A face whose corners point inwards is drawn as it is: a quad, a polygon, and one of several."""
    camera = rr.Camera.look_at((0, 0, 20), fov=40)
    dart = np.array([[-2, -3, 0], [-0.5, 0, 0], [-2.5, 3, 0], [4.5, 0, 0.0]])
    for mesh in (rr.Mesh(dart, [[0, 1, 2, 3]]), rr.Mesh(dart, [0, 1, 2, 3], offsets=[0, 4])):
        seen = rr.render(mesh, camera, size=(200, 200), outputs="id").id >= 0
        assert not seen[100, 82] and seen[100, 120] and seen[80, 90] and seen[120, 90]
        assert mesh.primitives == 2
