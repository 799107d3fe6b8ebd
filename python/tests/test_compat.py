# SPDX-License-Identifier: BSD-3-Clause
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


def white_wall(**material):
    quad = np.array([[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], float)
    white = pyrender.MetallicRoughnessMaterial(metallicFactor=0.0, roughnessFactor=1.0, **material)
    return pyrender.Mesh([pyrender.Primitive(quad, indices=[[0, 1, 2], [0, 2, 3]], material=white)])


def linear(picture):
    x = picture[..., :3] / 255.0
    return np.where(x <= 0.04045, x / 12.92, ((x + 0.055) / 1.055) ** 2.4)


def test_lights_are_pyrenders():
    def lit(light=None, pose=None, ambient=None, flags=pyrender.RenderFlags.NONE, more=()):
        scene = pyrender.Scene(ambient_light=ambient)
        scene.add(white_wall())
        for mesh in more:
            scene.add(mesh)
        scene.add(pyrender.PerspectiveCamera(yfov=np.pi / 3), pose=at(0, 0, 5))
        if light is not None:
            scene.add(light, pose=at(0, 0, 2) if pose is None else pose)
        return linear(pyrender.OffscreenRenderer(64, 64).render(scene, flags)[0])

    # The diffuse part of glTF's surface, 0.96 / pi of what arrives, and at roughness 1 little beside it.
    def expect(value, radiance):
        assert np.all(np.abs(np.asarray(value) - 0.96 / np.pi * np.asarray(radiance)) < 0.03), value

    expect(lit(pyrender.DirectionalLight(color=[1, 0.5, 0], intensity=2.0))[32, 32], [2, 1, 0])
    expect(lit(pyrender.PointLight(intensity=8.0))[32, 32], 2)          # two units away
    spot = lit(pyrender.SpotLight(intensity=8.0, innerConeAngle=0.3, outerConeAngle=0.5))
    expect(spot[32, 32], 2)
    assert spot[0, 0].max() == 0
    assert np.all(lit(pyrender.PointLight(intensity=8.0, range=1.5)) == 0)
    assert abs(lit(ambient=[0.25, 0.25, 0.25])[32, 32, 0] - 0.25) < 0.02
    turned = at(0, 0, 2)
    turned[:3, :3] = np.diag([-1, 1, -1])                               # it shines away from the wall
    assert np.all(lit(pyrender.DirectionalLight(intensity=2.0), turned) == 0)
    # A box between light and wall.
    sun = pyrender.DirectionalLight(intensity=2.0), np.array([[1, 0, 0.6, 0], [0, 1, 0, 0], [-0.6, 0, 1, 3], [0, 0, 0, 1.0]])
    shown = lit(*sun, flags=pyrender.RenderFlags.SHADOWS_DIRECTIONAL, more=[box()])
    assert (shown.max(-1) == 0).sum() > (lit(*sun, more=[box()]).max(-1) == 0).sum() + 20


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


def test_bounds_are_of_all_that_is_placed():
    scene = pyrender.Scene()
    mesh = box()
    assert np.array_equal(mesh.bounds, [[-1, -1, -1], [1, 1, 1]]) and np.isclose(mesh.scale, np.sqrt(12))
    assert np.array_equal(scene.bounds, np.zeros((2, 3)))
    scene.add(mesh, pose=at(5, 0, 0))
    turned = np.array([[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])
    flat = pyrender.Mesh([pyrender.Primitive([[0, 0, 0], [4, 0, 0], [0, 1, 0]], poses=[turned, at(0, 0, -9)])])
    scene.add(flat)
    assert np.allclose(scene.bounds, [[-1, -1, -9], [6, 4, 1]])
    assert np.allclose(scene.centroid, [2.5, 1.5, -4]) and np.allclose(scene.extents, [7, 5, 10])


def test_a_nodes_parts_can_be_set():
    quaternion = np.array([0.1, -0.5, 0.3, 0.7])
    quaternion /= np.linalg.norm(quaternion)
    node = pyrender.Node(rotation=quaternion, scale=[1, 2, 3], translation=[4, 5, 6])
    assert np.allclose(node.rotation, quaternion) and np.allclose(node.scale, [1, 2, 3])
    for q in np.vstack([np.eye(4), quaternion]):
        node.rotation = q
        assert np.allclose(node.rotation, q) and np.allclose(node.scale, [1, 2, 3]) and np.allclose(node.translation, [4, 5, 6])
    node.scale, node.translation = [2, 2, 2], [0, 1, 0]
    assert np.allclose(node.matrix, pyrender.Node(rotation=quaternion, scale=[2, 2, 2], translation=[0, 1, 0]).matrix)


def test_textures_of_meshes_are_drawn():
    trimesh = pytest.importorskip("trimesh")
    from PIL import Image
    # v is counted from the bottom: red above, blue below.
    image = Image.fromarray(np.array([[[255, 0, 0]] * 2, [[0, 0, 255]] * 2], np.uint8))
    square = trimesh.Trimesh([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], [[0, 1, 2], [0, 2, 3]], process=False)
    uv = np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]])
    square.visual = trimesh.visual.TextureVisuals(uv=uv, image=image)
    of_arrays = pyrender.Mesh([pyrender.Primitive(
        square.vertices, indices=square.faces, normals=square.vertex_normals, texcoord_0=uv,
        material=pyrender.MetallicRoughnessMaterial(baseColorTexture=pyrender.Texture(source=np.asarray(image) / 255.0), metallicFactor=0.0,
                                                    roughnessFactor=0.9))])
    pictures = []
    for mesh in (pyrender.Mesh.from_trimesh(square), of_arrays):
        for lights in ([], [pyrender.DirectionalLight(intensity=3.0)]):
            scene = pyrender.Scene()
            scene.add(mesh)
            scene.add(pyrender.PerspectiveCamera(yfov=np.pi / 3), pose=at(0, 0, 3))
            for light in lights:
                scene.add(light, pose=at(0, 0, 3))
            color, _ = pyrender.OffscreenRenderer(60, 60).render(scene)
            assert color[22, 30, 0] > color[22, 30, 2] + 50 and color[38, 30, 2] > color[38, 30, 0] + 50
            pictures.append(color)
    assert np.array_equal(pictures[0], pictures[2]) and np.array_equal(pictures[1], pictures[3])
    with pytest.raises(rr.ArgumentError, match="Texture"):
        pyrender.Texture(source=np.zeros((2, 2, 5), np.uint8))._pixels()


def test_errors_are_rastrums_too():
    scene = pyrender.Scene()
    with pytest.raises(TypeError, match="no mesh, camera or light") as raised:
        scene.add("box")
    assert isinstance(raised.value, rr.Error)
    with pytest.raises(ValueError, match="not in the scene") as raised:
        scene.get_pose(pyrender.Node())
    assert isinstance(raised.value, rr.Error)
