# SPDX-License-Identifier: BSD-3-Clause
"""Things that can be drawn: primitives, looks, cameras, things of other libraries; and what is refused."""

import itertools
import types

import numpy as np
import pytest

import rastrum as rr

SIZE = (64, 48)
CAMERA = rr.Camera.look_at((0, 0, 4), fov=60)
MIDDLE = np.zeros((1, 3))


def ids(thing, **more):
    return rr.render(thing, CAMERA, size=SIZE, outputs="id", **more).id


def test_colours_have_the_names_of_css():
    tables = pytest.importorskip("matplotlib.colors")
    for name, code in tables.CSS4_COLORS.items():
        both = [rr.render(rr.Mesh(np.eye(3), color=c), size=(8, 8), shader="flat").color for c in (name, code)]
        assert np.array_equal(*both), name
    white = rr.render(rr.Points(MIDDLE), CAMERA, size=(8, 8), background="white").color
    for same in ("White", "fff", "#FFF", "ffffff", (1, 1, 1)):
        assert np.array_equal(rr.render(rr.Points(MIDDLE), CAMERA, size=(8, 8), background=same).color, white)
    with pytest.raises(rr.ArgumentError, match="background: 'bleu' is no colour.*'blue' perhaps"):
        rr.render(rr.Points(MIDDLE), CAMERA, background="bleu")


def test_each_primitive_is_seen():
    ends = np.array([[-1, 0, 0], [1, 0, 0], [1, 1, 0.0]])
    for thing, count in ((rr.Spheres(MIDDLE, 0.5), 1), (rr.Spheres(ends, np.array([0.1, 0.2, 0.3])), 3),
                         (rr.Cylinders(ends[:2], radius=0.2), 1), (rr.Tubes(ends, radius=0.1), 2),
                         (rr.Discs(MIDDLE, [[0, 0, 1.0]], 0.7), 1), (rr.Points(ends, size=5), 3),
                         (rr.Lines(ends, width=3), 2), (rr.Lines(ends, [[0, 2]]), 1),
                         (rr.Mesh(ends), 1), (rr.Mesh(ends, [[0, 1, 2]]), 1)):
        assert thing.primitives == count
        assert set(np.unique(ids(thing))) == {-1, *range(count)}, type(thing)


def test_a_sphere_is_round():
    p = rr.render(rr.Spheres(MIDDLE), CAMERA, size=(200, 200), outputs=("depth", "id"))
    y, x = np.mgrid[0:200, 0:200] + 0.5
    # The ball of radius 1 at distance 4: rays whose angle is at most asin(1/4).
    tangent = np.hypot(x - 100, y - 100) / 100 * np.tan(np.radians(30))
    assert np.array_equal(p.id >= 0, np.sin(np.arctan(tangent)) <= 0.25)
    assert np.isclose(p.depth[100, 100], 3, atol=1e-3)


def test_looks():
    plain = rr.Spheres(MIDDLE, 0.5)
    red = rr.render(rr.Spheres(MIDDLE, 0.5, color="#ff0000"), CAMERA, size=SIZE, shader="flat").color[24, 32]
    assert tuple(red) == (255, 0, 0, 255)
    half = rr.render(rr.Spheres(MIDDLE, 0.5, color="#ff0000", opacity=0.5), CAMERA, size=SIZE, shader="flat").color[24, 32]
    assert half[0] == 255 and 180 < half[3] < 200  # two sides of it, each half
    assert (ids(rr.Spheres(MIDDLE, 0.5, visible=False)) == -1).all()
    moved = np.eye(4)
    moved[0, 3] = 1
    assert ids(rr.Spheres(MIDDLE, 0.5, transform=moved))[24, 32] == -1
    cut = ids(rr.Spheres(MIDDLE, 0.5, clip_planes=[[1, 0, 0, 0]]))
    assert (cut[:, :31] == -1).all() and (cut[:, 33:] == 0).any()
    textured = rr.Mesh([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], [[0, 1, 2, 3]],
                       uv=[[0, 1], [1, 1], [1, 0], [0, 0.0]],
                       material=rr.Material(base_color_texture=np.array([[[0, 255, 0], [0, 0, 255]]], np.uint8), unlit=True))
    p = rr.render([textured, plain], rr.Camera.orthographic((0, 0, 4), height=2), size=(40, 40))
    assert p.stats["shader"] == "material"
    assert p.color[2, 2, 1] > 200 and p.color[2, 37, 2] > 200  # left green, right blue
    assert p.color[20, 20, 0] > 80  # the sphere without a material keeps its own colour


def test_points_project_to_their_pixels(sheet):
    size = (90, 60)
    k = [[70.0, 0, 41.3], [0, 72.0, 30.1], [0, 0, 1]]
    cameras = (rr.Camera.look_at((2, 1, 3)), rr.Camera.orthographic((2, 1, 3), height=4), rr.Camera.fit(rr.Mesh(*sheet), "iso"),
               rr.Camera.opencv(k, np.diag([1.0, -1, -1]), [0, 0, 4]), rr.orbit(rr.Mesh(*sheet), 3)[1])
    for camera in cameras:
        picture = rr.render(rr.Mesh(*sheet), camera, size=size, outputs=("position", "depth", "id"))
        y, x = np.nonzero(picture.id >= 0)
        found = camera.project(picture.position[y, x], size, depth=picture.depth)
        np.testing.assert_allclose(found.pixel, np.stack([x, y], 1) + 0.5, atol=0.01)
        np.testing.assert_allclose(found.depth, picture.depth[y, x], rtol=1e-5)
        assert len(x) > 200 and found.seen.all()
    place = np.eye(4)
    thing = rr.Scene([rr.Mesh(*sheet, transform=place)])
    fitted = rr.Camera.fit(thing)
    rr.render(thing, fitted, size=size)
    before = fitted.project([[0.5, 0.2, 0]], size).pixel
    place[0, 3] = 30  # a fitted camera stays where it is
    assert (fitted.project([[0.5, 0.2, 0]], size).pixel == before).all()
    far = rr.Camera.orthographic((0, 0, 0), (0, 0, -100), height=4, near=50)
    assert far.project([[0, 0, -100]], size).seen.all()
    corner = rr.Camera.look_at((0, 0, 0), (1, 1, 1), near=0.01)
    v = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    room = rr.Mesh(v, np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]))
    inside = rr.render(room, corner, size=(64, 48), outputs="depth")
    assert corner.project([[1, 1, 1], [1.2, 1.2, 1.2]], (64, 48), depth=inside.depth).seen.tolist() == [True, False]
    k_only = cameras[3].project([[0.0, 0, 0]], size)  # OpenCV counts from the first pixel's centre
    np.testing.assert_allclose(k_only.pixel[0], [41.3 + 0.5, 30.1 + 0.5], atol=1e-9)
    behind = cameras[0].project([(4, 2, 6), (2, 1, 3), (-100, 0, 0)], size)
    assert behind.seen.tolist() == [False, False, False] and np.isnan(behind.pixel[:2]).all() and behind.depth[0] < 0
    for wrong, message in (([[1, 2]], r"points: must be \(N, 3\)"), ("ab", "points")):
        with pytest.raises(rr.Error, match=message):
            cameras[0].project(wrong, size)
    with pytest.raises(rr.ArgumentError, match=r"depth: the shape is \(3, 3\)"):
        cameras[0].project([[0, 0, 0]], size, depth=np.zeros((3, 3)))


def test_cameras_agree():
    k = np.array([[400, 0, 319.5], [0, 400, 239.5], [0, 0, 1.0]])
    box = rr.Mesh(np.random.default_rng(3).random((60, 3)) + (0, 0, 3))
    p = rr.render(box, rr.Camera.opencv(k), size=(640, 480), outputs=("id", "position"))
    y, x = np.argwhere(p.id >= 0).T
    X, Y, Z = p.position[y, x].T
    assert len(y) > 1000
    assert np.allclose(400 * X / Z + 319.5, x, atol=1e-3) and np.allclose(400 * Y / Z + 239.5, y, atol=1e-3)
    f = 1 / np.tan(np.radians(30))
    n, far = 0.01, 100.0
    projection = np.array([[f * 3 / 4, 0, 0, 0], [0, f, 0, 0], [0, 0, (far + n) / (n - far), 2 * far * n / (n - far)],
                           [0, 0, -1, 0]])
    view = np.eye(4)
    view[2, 3] = -4
    a = rr.render(rr.Spheres(MIDDLE), rr.Camera.opengl(projection, view), size=SIZE, outputs="id").id
    assert np.array_equal(a, ids(rr.Spheres(MIDDLE)))
    assert np.array_equal(a, rr.render(rr.Spheres(MIDDLE), projection @ view, size=SIZE, outputs="id").id)
    for view in ("front", "back", "left", "right", "top", "bottom", "iso", (1, 2, 3)):
        assert (rr.render(box, rr.Camera.fit(box, view), size=SIZE, outputs="id").id >= 0).any(), view


def stand_in(module, name, **fields):
    """An object of a class that looks as if it came from another library."""
    return type(name, (types.SimpleNamespace,), {"__module__": module})(**fields)


def test_meshes_of_others_are_recognised(sheet):
    vertices, triangles = sheet
    expected = ids(rr.Mesh(vertices, triangles))
    visual = types.SimpleNamespace(kind=None)
    mesh = stand_in("trimesh.base", "Trimesh", vertices=vertices, faces=triangles, visual=visual)
    assert np.array_equal(ids(mesh), expected)
    legacy = stand_in("open3d.cpu.pybind.geometry", "TriangleMesh", vertices=vertices, triangles=triangles,
                      vertex_normals=[], vertex_colors=[])
    assert np.array_equal(ids(legacy), expected)
    assert np.array_equal(ids([mesh, rr.Points(MIDDLE)]), ids([rr.Mesh(vertices, triangles), rr.Points(MIDDLE)]))


class Tensor:
    """Open3D's, as far as it is asked."""

    def __init__(self, array):
        self.array = array

    def cpu(self):
        return self

    def numpy(self):
        return self.array


def test_open3ds_clouds_lines_and_tensors(sheet):
    """As open3d 0.20 has them."""
    vertices, triangles = sheet
    rng = np.random.default_rng(5)
    colors, pairs = rng.random((len(vertices), 3)), rng.integers(0, len(vertices), (40, 2))
    looks = [
        (rr.Mesh(vertices, triangles, colors=colors),
         stand_in("open3d.cpu.pybind.t.geometry", "TriangleMesh", vertex={"positions": Tensor(vertices), "colors": Tensor(colors)},
                  triangle={"indices": Tensor(triangles)})),
        (rr.Points(vertices, colors=colors),
         stand_in("open3d.cpu.pybind.t.geometry", "PointCloud", point={"positions": Tensor(vertices), "colors": Tensor(colors)})),
        (rr.Points(vertices, colors=colors),
         stand_in("open3d.cpu.pybind.geometry", "PointCloud", points=vertices, normals=np.empty((0, 3)), colors=colors)),
        (rr.Lines(vertices, pairs),
         stand_in("open3d.cpu.pybind.geometry", "LineSet", points=vertices, lines=pairs, colors=np.empty((0, 3)))),
        (rr.Lines(vertices[pairs.reshape(-1)], np.arange(80).reshape(-1, 2), colors=np.repeat(colors[:40], 2, axis=0)),
         stand_in("open3d.cpu.pybind.t.geometry", "LineSet", point={"positions": Tensor(vertices)},
                  line={"indices": Tensor(pairs), "colors": Tensor(colors[:40])})),
    ]
    for ours, theirs in looks:
        expected = rr.render(ours, size=SIZE).color
        assert len(np.unique(expected.reshape(-1, 4), axis=0)) > 1
        assert np.array_equal(rr.render(theirs, size=SIZE).color, expected)
    with pytest.raises(rr.ArgumentTypeError, match="VoxelGrid: cannot be drawn"):
        rr.as_scene(stand_in("open3d.cpu.pybind.geometry", "VoxelGrid", voxel_size=1.0))


def test_real_open3d():
    o3d = pytest.importorskip("open3d")
    def bound(of):
        return of.numpy() if hasattr(of, "numpy") else of
    for made in (o3d.geometry.TriangleMesh.create_torus(), o3d.t.geometry.TriangleMesh.create_torus()):
        scene = rr.as_scene(made, copy=False)
        assert scene.primitives == 1200 and np.allclose(scene.bounds, [bound(made.get_min_bound()), bound(made.get_max_bound())])
    points = np.random.default_rng(1).random((50, 3))
    clouds = (o3d.geometry.PointCloud(o3d.utility.Vector3dVector(points)), o3d.t.geometry.PointCloud(points))
    for made in clouds:
        assert np.array_equal(ids(made), ids(rr.Points(points)))


class Located:
    """A placement by OpenCASCADE's matrix, as build123d has it."""

    def __init__(self, x, y, z):
        matrix = np.eye(4)
        matrix[:3, 3] = x, y, z
        transformation = types.SimpleNamespace(Value=lambda i, j: matrix[i - 1, j - 1])
        self.wrapped = types.SimpleNamespace(Transformation=lambda: transformation)


class Vector:
    """build123d's is iterated, CadQuery's has toTuple()."""

    def __init__(self, *xyz):
        self.xyz = xyz

    def __iter__(self):
        return iter(self.xyz)


class Tuple(Vector):
    __iter__ = None

    def toTuple(self):
        return self.xyz


def cad_shape(library, kind, vector, *, faces=True, **fields):
    """A shape whose tessellation is one triangle in the plane z = 0."""
    base = type("Shape", (types.SimpleNamespace,), {"__module__": f"{library}.topology.shape_core"})
    corners = [vector(0, 0, 0), vector(2, 0, 0), vector(0, 1, 0)] if faces else []
    made = type(kind, (base,), {"__module__": f"{library}.topology.composite"})(
        tessellate=lambda tolerance: (corners, [(0, 1, 2)] if faces else []), **fields)
    if library == "build123d":
        made.faces = lambda: [None] * faces
        made.bounding_box = lambda: types.SimpleNamespace(diagonal=1.0)
    else:
        made.Faces = lambda: [None] * faces
        made.BoundingBox = lambda: types.SimpleNamespace(DiagonalLength=1.0)
        made.moved = lambda place: cad_shape(library, kind, lambda x, y, z: vector(x + place[0], y + place[1], z + place[2]))
    return made


def test_shapes_of_cad():
    """As build123d 0.13 and CadQuery 2.8 have them: builders, assemblies with places and colours, what has no faces."""
    def boxes(what):
        return [tuple(np.round(corner, 6)) for thing in rr.as_scene(what).things
                for corner in rr.as_scene([thing]).bounds]
    flat = [(0, 0, 0), (2, 1, 0)]
    part = cad_shape("build123d", "Part", Vector, color=(1, 0, 0, 0.5), location=Located(0, 0, 0), children=())
    assert boxes(part) == flat and rr.as_scene(part).things[0].color == (1, 0, 0, 0.5)
    builder = type("BuildPart", (type("Builder", (types.SimpleNamespace,), {"__module__": "build123d.build_common"}),),
                   {"__module__": "build123d.build_part"})
    assert boxes(builder(part=part)) == flat
    plain = cad_shape("build123d", "Box", Vector, color=None, location=Located(0, 0, 0), children=())
    inner = cad_shape("build123d", "Compound", Vector, color=(0, 0, 1, 1), location=Located(5, 0, 0), children=(part, plain))
    outer = cad_shape("build123d", "Compound", Vector, color=None, location=Located(0, 7, 0), children=(inner,))
    assert boxes(outer) == [(5, 7, 0), (7, 8, 0)] * 2
    assert [thing.color for thing in rr.as_scene(outer).things] == [(1, 0, 0, 0.5), (0, 0, 1, 1)]

    face = cad_shape("cadquery", "Face", Tuple)
    assert boxes(face) == flat
    kind = type("Workplane", (types.SimpleNamespace,), {"__module__": "cadquery.cq"})
    assert boxes(kind(vals=lambda: [face, Tuple(0, 0, 0), face])) == flat * 2
    sketch = type("Sketch", (), {"__module__": "cadquery.sketch", "__iter__": lambda self: iter([face])})
    assert boxes(sketch()) == flat
    color = types.SimpleNamespace(toTuple=lambda: (1.0000001, 0.5, 0, 1))
    assembly = type("Assembly", (), {"__module__": "cadquery.assembly", "__iter__": lambda self: iter(
        [(face, "a", (3, 0, 0), color), (face, "b", (0, 0, 4), None)])})
    assert boxes(assembly()) == [(3, 0, 0), (5, 1, 0), (0, 0, 4), (2, 1, 4)]
    assert [thing.color for thing in rr.as_scene(assembly()).things] == [(1.0, 0.5, 0.0, 1.0), None]
    for edge in (cad_shape("build123d", "Edge", Vector, faces=False, color=None, children=()),
                 cad_shape("cadquery", "Edge", Tuple, faces=False), kind(vals=lambda: [])):
        with pytest.raises(rr.ArgumentError, match="has no faces"):
            rr.as_scene(edge)


def test_real_build123d():
    bd = pytest.importorskip("build123d")
    red, blue = bd.Box(1, 1, 1), bd.Pos(2, 0, 0) * bd.Sphere(0.7)
    red.color, blue.color = bd.Color("red"), bd.Color(0, 0, 1, 0.5)
    inner = bd.Compound(children=[red, blue])
    inner.location = bd.Location((0, 0, 7))
    outer = bd.Compound(children=[inner])
    outer.location = bd.Location((10, 0, 0), (0, 0, 90))
    box, scene = outer.bounding_box(), rr.as_scene(outer)
    assert np.allclose(scene.bounds, [tuple(box.min), tuple(box.max)], atol=2e-3)
    assert [t.color for t in scene.things] == [(1, 0, 0, 1), (0, 0, 1, 0.5)]
    with bd.BuildPart() as part:
        bd.Box(3, 2, 1)
    assert rr.as_scene(part).primitives == 12 == rr.as_scene(bd.Box(1, 1, 1).faces()).primitives


def test_real_cadquery():
    cq = pytest.importorskip("cadquery")
    inner = cq.Assembly().add(cq.Workplane().box(1, 1, 1), color=cq.Color("red")).add(
        cq.Workplane().sphere(0.6), loc=cq.Location(cq.Vector(2, 0, 0)))
    outer = cq.Assembly(loc=cq.Location(cq.Vector(0, 3, 0))).add(inner, loc=cq.Location(cq.Vector(0, 0, 1)))
    box, scene = outer.toCompound().BoundingBox(), rr.as_scene(outer)
    assert np.allclose(scene.bounds, [(box.xmin, box.ymin, box.zmin), (box.xmax, box.ymax, box.zmax)], atol=2e-3)
    assert np.allclose(scene.things[0].color, (1, 0, 0, 1)) and scene.things[1].color is None
    assert rr.as_scene(cq.Workplane().rarray(2, 2, 3, 3).box(1, 1, 1)).primitives == 108
    assert rr.as_scene(cq.Sketch().rect(2, 1)).primitives == 2
    with pytest.raises(rr.ArgumentError, match="no faces"):
        rr.as_scene(cq.Workplane().rect(1, 1))


def test_crease_normals():
    """A roof whose halves meet at 90 degrees, and files."""
    v = np.array([[0, 0, 0], [0, 1, 0], [1, 0, -1], [-1, 0, -1.0]])
    f = np.array([[0, 2, 1], [0, 1, 3]])
    right, left = np.array([1, 0, 1]) / np.sqrt(2), np.array([-1, 0, 1]) / np.sqrt(2)
    sharp = rr.crease_normals(v, f, 80)
    assert sharp.dtype == np.float32 and np.allclose(sharp, [right] * 3 + [left] * 3, atol=1e-6)
    smooth = rr.crease_normals(v, f, 100)
    assert np.allclose(smooth[[0, 2, 3, 4]], (0, 0, 1), atol=1e-6) and np.allclose(smooth[[1, 5]], [right, left], atol=1e-6)
    assert rr.crease_normals(np.empty((0, 3)), np.empty((0, 3), int)).shape == (0, 3)
    for bad in ((v, [[0, 1, 4]]), (v, [[0, 1]]), (v, [[0, 1, -1]]), (v, f, np.nan), (v, f, 200), (v[:, :2], f), (v, f * 1.0)):
        with pytest.raises(rr.Error):
            rr.crease_normals(*bad)


def test_real_trimesh(sheet):
    trimesh = pytest.importorskip("trimesh")
    mesh = trimesh.Trimesh(*sheet, process=False)
    expected = ids(rr.Mesh(*sheet))
    assert np.array_equal(ids(mesh), expected)
    scene = trimesh.Scene([mesh])
    assert np.array_equal(ids(scene), expected)
    assert np.array_equal(scene.show(viewer=rr.trimesh_viewer).color, rr.render(scene).color)


def test_real_torch(sheet):
    torch = pytest.importorskip("torch")
    vertices = torch.from_numpy(sheet[0].copy()).requires_grad_()
    assert np.array_equal(ids(rr.Mesh(vertices, torch.from_numpy(sheet[1].astype(np.int64)), copy=False)), ids(sheet))


def test_natural_classes(tmp_path):
    with pytest.raises(FileNotFoundError):
        rr.load(tmp_path / "none.obj")
    bad = tmp_path / "bad.ply"
    bad.write_bytes(b"ply\nnonsense\n")
    with pytest.raises(rr.FormatError, match="bad.ply"):
        rr.load(bad)
    with pytest.raises(ValueError, match="corner 2 of triangle 0 is vertex 3"):
        rr.render((np.zeros((3, 3)), [[0, 1, 3]]), size=SIZE)
    with pytest.raises(NotImplementedError):
        rr.load(_named(tmp_path, "x.unknown"))
    with pytest.raises(TypeError):
        rr.render(object(), size=SIZE)
    for error in (rr.ArgumentError, rr.NotFoundError, rr.FormatError, rr.OutOfMemoryError, rr.DeviceError):
        assert issubclass(error, rr.Error)


def _named(folder, name):
    file = folder / name
    file.write_text("0 0 0\n")
    return file


def bad_calls():
    """More than 2,000 calls that must end in an exception: each argument spoiled in each way that it can be."""
    good_v, good_f = np.random.default_rng(5).random((8, 3)), np.array([[0, 1, 2], [3, 4, 5]])
    arrays = [np.zeros((3,)), np.zeros((3, 2)), np.zeros((3, 4)), np.zeros((2, 2, 3)), np.array([["a", "b", "c"]]),
              np.array([[None, 1, 2]], object), np.zeros((3, 3), complex), np.zeros((3, 3), "M8[s]"), "text", 5, None,
              object(), [[1, 2, 3], [4, 5]], np.zeros((3, 3), np.dtype([("x", "f4")])), {}, b"bytes", np.array(1.0)]
    faces = [np.array([[0, 1, 8]]), np.array([[-1, 0, 1]]), np.array([[0, 1]]), np.zeros((1, 5), int),
             np.array([[0.5, 1, 2]]), np.array([["a"] * 3]), np.array([0, 1]), np.zeros((1, 1, 3), int),
             np.array([[2**40, 0, 1]]), np.array([[True, False, True]]), "abc", object(), 3]
    looks = [{"color": "nonsense"}, {"color": (1, 2, 3)}, {"color": (0.1,)}, {"color": object()}, {"opacity": -1},
             {"opacity": float("nan")}, {"opacity": "half"}, {"transform": np.eye(3)}, {"transform": "here"},
             {"transform": np.zeros((4, 4), complex)}, {"material": 3}, {"winding": "up"}, {"clip_planes": [[1, 2]]},
             {"clip_planes": [[0, 0, 0, 1]]}, {"clip_planes": [[1, 0, 0, 0]] * 9}, {"id": "seven"}, {"no_such": 1}]
    frames = [{"size": s} for s in ((0, 5), (5, 0), (-1, 5), (40000, 5), "big", 5, (1.5, 2), (1, 2, 3), None)]
    frames += [{"outputs": o} for o in ("colour", ("id", "x"), [], 5, [5])]
    frames += [{"shader": s} for s in ("fancy", 3, None)] + [{"samples": s} for s in (0, 2, 3, 17, "four", 1.5)]
    frames += [{"transparency": "guess"}, {"cull": "all"}, {"background": "no"}, {"background": (2, 0, 0)},
               {"opacity": 2.0}, {"opacity": float("nan")}, {"clip_planes": [[0, 0, 0, 0]]}, {"threads": 0},
               {"threads": "two"}, {"threads": -1}, {"memory_limit": -5}, {"device": "tpu"}, {"isa": "mmx"},
               {"out": {"depth": np.zeros((5, 5))}}, {"out": {"depth": np.zeros((48, 64))}}, {"out": {"nothing": 1}},
               {"out": {"id": np.zeros((48, 64), np.float32)}}, {"camera": 5}, {"camera": np.eye(3)},
               {"camera": np.zeros((4, 4))}, {"camera": np.full((4, 4), np.nan)}, {"no_such": 1}, {"progress": 5}]
    for a in arrays:
        yield lambda a=a: rr.render(rr.Mesh(a, good_f), size=SIZE)
        yield lambda a=a: rr.render((a, good_f), size=SIZE)
        for name in ("normals", "uv", "colors"):
            if a is not None:
                yield lambda a=a, name=name: rr.render(rr.Mesh(good_v, good_f, **{name: a}), size=SIZE)
        for kind in (rr.Points, rr.Lines, rr.Spheres, rr.Cylinders, rr.Tubes):
            yield lambda a=a, kind=kind: rr.render(kind(a), size=SIZE)
            if not (a is None or isinstance(a, (int, np.ndarray)) and np.ndim(a) == 0):
                name = "colors" if kind in (rr.Points, rr.Lines) else "radius"
                yield lambda a=a, kind=kind, name=name: rr.render(kind(good_v, **{name: a}), size=SIZE)
        yield lambda a=a: rr.render(rr.Discs(good_v, a), size=SIZE)
    for f in faces:
        yield lambda f=f: rr.render((good_v, f), size=SIZE)
        yield lambda f=f: rr.render(rr.Cylinders(good_v, f, caps=np.size), size=SIZE)
        yield lambda f=f: rr.render(rr.Mesh(good_v, np.arange(8), offsets=f), size=SIZE)
    for look in looks:
        for kind in (rr.Spheres, rr.Points, rr.Mesh, rr.Tubes, rr.Lines):
            positions = good_v[:6] if kind is rr.Mesh else good_v
            yield lambda look=look, kind=kind, p=positions: rr.render(kind(p, **look), size=SIZE)
    for frame in frames:
        for thing in (rr.Spheres(MIDDLE), (good_v, good_f), [rr.Points(good_v), rr.Mesh(good_v[:3])]):
            yield lambda frame=frame, thing=thing: rr.render(thing, **{"size": SIZE, **frame})
    for a, b in itertools.product(frames, frames):
        if not set(a) & set(b):
            yield lambda a=a, b=b: rr.render(rr.Spheres(MIDDLE), **{"size": SIZE, **a, **b})


def test_two_thousand_bad_calls():
    calls = list(bad_calls())
    assert len(calls) >= 2000
    for i, call in enumerate(calls):
        try:
            call()
        except rr.Error as e:
            assert str(e), i
            assert isinstance(e, (ValueError, TypeError, NotImplementedError, FileNotFoundError)), (i, type(e))
        except TypeError as e:
            assert "unexpected keyword argument 'no_such'" in str(e), i
        else:
            pytest.fail(f"call {i} was accepted")
    assert (ids(rr.Spheres(MIDDLE)) >= 0).any()


def test_memory_views_byte_orders_and_sizes_of_nothing():
    vertices, triangles = np.random.default_rng(1).random((6, 3), np.float32), np.arange(6, dtype=np.uint32).reshape(2, 3)
    expected = rr.digest(rr.render((vertices, triangles), size=SIZE).color)
    view = memoryview(bytearray(vertices.tobytes())).cast("f", (6, 3))
    assert rr.digest(rr.render((view, triangles), size=SIZE).color) == expected
    # A mesh holds its buffers: who gives one back is told by Python, and the mesh draws on.
    memory = bytearray(vertices.tobytes())
    mesh = rr.Mesh(np.frombuffer(memory, np.float32).reshape(6, 3), triangles, copy=False)
    with pytest.raises(BufferError):
        memory.clear()
    assert rr.digest(rr.render(mesh, size=SIZE).color) == expected
    view.release()
    for call in (lambda: rr.render((view, triangles), size=SIZE), lambda: rr.Mesh(vertices, view), lambda: rr.Spheres(view),
                 lambda: rr.Points(vertices, colors=view), lambda: rr.digest(view)):
        with pytest.raises(rr.Error):
            call()
    # Numbers of the other byte order are copied, or refused where that is not wanted.
    other = vertices.astype(vertices.dtype.newbyteorder())
    assert rr.digest(rr.render((other, triangles.astype(triangles.dtype.newbyteorder())), size=SIZE).color) == expected
    for arrays in ((other, triangles), (vertices, triangles.astype(triangles.dtype.newbyteorder()))):
        with pytest.raises(rr.ArgumentError, match="copy=False"):
            rr.Mesh(*arrays, copy=False)
    for empty in (np.zeros((0, 3)), np.zeros((0, 3), np.float32)):
        for thing in (rr.Mesh(empty), rr.Mesh(empty, np.zeros((0, 3), int)), rr.Points(empty), rr.Spheres(empty), rr.Lines(empty)):
            assert (ids(thing) == -1).all()
    with pytest.raises(rr.ArgumentError):
        rr.render(rr.Mesh(empty, [[0, 1, 2]]), size=SIZE)
    with pytest.raises(rr.Error):
        rr.render((np.zeros((3, 0)), triangles), size=SIZE)


def test_too_few_radii_are_refused_before_anything_looks_at_them():
    five = np.arange(15.0).reshape(5, 3)
    for thing in (rr.Spheres(five, [1, 2, 3]), rr.Discs(five, five, [1, 2, 3]), rr.Tubes(five, radius=[1, 2, 3]),
                  rr.Cylinders(five, [[0, 1], [3, 4]], [1, 2, 3])):
        for look in (lambda: rr.Scene(thing).bounds, lambda: rr.render(thing, rr.Camera.fit(thing)), lambda: rr.render(thing, CAMERA)):
            with pytest.raises(rr.ArgumentError, match="radii"):
                look()


def test_numbers_that_are_not_finite_are_dropped_and_counted():
    v = np.random.default_rng(6).random((9, 3))
    v[4, 1] = np.nan
    assert rr.render((v, np.arange(9).reshape(3, 3)), CAMERA, size=SIZE).stats["triangles"]["dropped"] == 1


def test_shapes_have_names():
    scene = rr.load("builtin:sphere?rings=4&segments=8")
    assert scene.primitives == 2 * 3 * 8 and scene.files == ["builtin:sphere?rings=4&segments=8"]
    assert (rr.render(["builtin:teapot?n=2"], size=(9, 9)).color[..., 3] != 0).any()
    for bad, what in (("builtin:cube", "cube"), ("builtin:sphere?ring=4", "ring")):
        with pytest.raises(rr.ArgumentError, match=what):
            rr.load(bad)


def test_prepared_meshes_draw_the_same():
    rng = np.random.default_rng(3)
    n = 150
    x, y = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n))
    v = np.stack([x, y, rng.uniform(-0.05, 0.05, x.shape)], -1).reshape(-1, 3).astype(np.float32)
    i = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).reshape(-1, 1)
    f = np.concatenate([i + [0, 1, n], i + [1, n + 1, n]]).astype(np.int64)
    cameras = [rr.Camera.look_at((0.3 * k, 0, 2.5 - k), fov=40) for k in range(3)]
    for positions in (v, v.astype(np.float64)):
        for more in ({}, {"cull": "back"}, {"samples": 4}):
            plain, prepared = rr.Mesh(positions, f), rr.Mesh(positions, f)
            assert prepared.prepare() is prepared and prepared.primitives == len(f)
            for camera in cameras:
                a, b = (rr.render(m, camera, size=(90, 70), outputs=("color", "id", "depth"), **more)
                        for m in (plain, prepared))
                assert np.array_equal(a.color, b.color) and np.array_equal(a.id, b.id)
                assert np.array_equal(a.depth, b.depth)
    # A copy was made: what changes later is not seen, nor read.
    mesh = rr.Mesh(v, f).prepare()
    before = ids(mesh)
    f[:] = 1 << 30
    assert np.array_equal(ids(mesh), before)
    with pytest.raises(rr.ArgumentError, match="vertex 1073741824"):
        rr.Mesh(v, f).prepare()
