"""pyrender's names over Rastrum: what its users wrote for it runs, and means the same."""

import numpy as np
import pytest

import rastrum as rr
import rastrum.compat.pyrender as pyrender

BOX = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
FACES = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4],
                  [1, 5, 7], [1, 7, 3]])


def box():
    return pyrender.Mesh([pyrender.Primitive(BOX, indices=FACES,
                                             material=pyrender.MetallicRoughnessMaterial(baseColorFactor=[1.0, 0, 0, 1]))])


def at(x, y, z):
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


def test_depth_colour_and_background():
    scene = pyrender.Scene(bg_color=[0.0, 0, 1.0, 1.0])
    scene.add(box())
    scene.add(pyrender.PerspectiveCamera(yfov=np.pi / 3), pose=at(0, 0, 5))
    with pytest.warns(UserWarning, match="lights are not drawn"):
        scene.add(pyrender.DirectionalLight(color=np.ones(3), intensity=3.0), pose=at(0, 0, 5))
        color, depth = pyrender.OffscreenRenderer(160, 120).render(scene)
    assert color.shape == (120, 160, 3) and color.dtype == np.uint8
    assert depth.shape == (120, 160) and depth.dtype == np.float32
    assert np.isclose(depth[60, 80], 4) and depth[0, 0] == 0
    assert tuple(color[0, 0]) == (0, 0, 255) and color[60, 80, 0] > 3 * color[60, 80, 1]
    # 2 units at distance 4 of 2 · 4 · tan(30°) across 120 pixels.
    assert (depth > 0)[60].sum() == round(120 * 2 / (8 * np.tan(np.pi / 6)))
    flags = pyrender.RenderFlags.RGBA | pyrender.RenderFlags.SKIP_CULL_FACES
    assert pyrender.OffscreenRenderer(160, 120).render(scene, flags)[0].shape == (120, 160, 4)
    only = pyrender.OffscreenRenderer(160, 120).render(scene, pyrender.RenderFlags.DEPTH_ONLY)
    assert np.array_equal(only, depth)


def test_nodes_poses_and_segments():
    scene = pyrender.Scene()
    parent = pyrender.Node(name="parent", translation=[1, 0, 0])
    scene.add_node(parent)
    a = scene.add(box(), pose=at(1, 0, 0), parent_node=parent)
    b = scene.add(box(), pose=at(-2, 0, 0), name="b")
    camera = scene.add(pyrender.IntrinsicsCamera(100, 100, 80, 60), pose=at(0, 0, 10))
    assert scene.get_pose(a)[0, 3] == 2 and scene.get_nodes(name="b") == {b}
    r = pyrender.OffscreenRenderer(160, 120)
    segments, depth = r.render(scene, pyrender.RenderFlags.SEG, {a: (255, 0, 0), b: (0, 1.0, 0)})
    # x = ±2 at distance 9 … 11: about 20 px from the middle.
    assert tuple(segments[60, 80 + 21]) == (255, 0, 0) and tuple(segments[60, 80 - 21]) == (0, 255, 0)
    assert tuple(segments[0, 0]) == (0, 0, 0) and np.isclose(depth[60, 101], 9)
    scene.set_pose(b, at(-4, 0, 0))
    assert r.render(scene, pyrender.RenderFlags.DEPTH_ONLY)[60, 80 - 21] == 0
    scene.remove_node(parent)
    assert not scene.has_node(a) and r.render(scene, pyrender.RenderFlags.DEPTH_ONLY)[60, 101] == 0
    scene.remove_node(camera)
    with pytest.raises(ValueError, match="no camera"):
        r.render(scene)


def test_points_poses_and_orthographic():
    scene = pyrender.Scene()
    scene.add(pyrender.Mesh.from_points(np.array([[0.0, 0, 0]]), colors=np.array([[0, 255, 0]], np.uint8)))
    poses = np.stack([at(-1, 0, 0), at(1, 0, 0)])
    scene.add(pyrender.Mesh([pyrender.Primitive(BOX * 0.2, indices=FACES, poses=poses)]))
    scene.add(pyrender.OrthographicCamera(2, 2), pose=at(0, 0, 3))
    color, depth = pyrender.OffscreenRenderer(80, 80, point_size=5).render(scene)
    assert tuple(color[40, 40]) == (0, 255, 0)
    assert (depth[40] > 0).sum() == 5 + 2 * 8
    assert np.isclose(depth[40, 20], 2.8, atol=1e-4)
    with pytest.raises(NotImplementedError):
        pyrender.Viewer(scene)


def test_trimesh():
    trimesh = pytest.importorskip("trimesh")
    mesh = trimesh.creation.icosphere(subdivisions=3)
    scene = pyrender.Scene.from_trimesh_scene(trimesh.Scene([mesh]))
    camera = pyrender.PerspectiveCamera(yfov=np.pi / 3)
    scene.add(camera, pose=at(0, 0, 4))
    _, depth = pyrender.OffscreenRenderer(64, 64).render(scene)
    own = rr.render(rr.Mesh(mesh.vertices.view(np.ndarray), mesh.faces.view(np.ndarray)),
                    rr.Camera.opengl(camera.get_projection_matrix(64, 64) @ np.linalg.inv(at(0, 0, 4))), size=(64, 64),
                    outputs="depth", cull="back").depth
    assert np.array_equal(depth, own)
