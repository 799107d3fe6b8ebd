# SPDX-License-Identifier: BSD-3-Clause
"""Troubles that users of other tools have reported, rebuilt with geometry of our own: one test a trouble, named
for what is odd; its docstring says what is right. tests/odd/ has those of files and of the C++ library."""

import inspect
import itertools
import warnings

import numpy as np
import pytest

import rastrum as rr

SIZE = (48, 36)
CAMERA = rr.Camera.look_at((0, 0, 4))
TRIANGLE = np.array([[-1, -1, 0], [1, -1, 0], [0, 1, 0]], float)
TETRAHEDRON = (np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], float), [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
RED, BLUE = (255, 0, 0), (0, 0, 255)


def ids(what, **more):
    return rr.render(what, CAMERA, size=SIZE, outputs="id", **more).id


def flat(what, camera=CAMERA, **more):
    return rr.render(what, camera, size=SIZE, shader="flat", **more).color


def middle(what, **more):
    return tuple(int(v) for v in flat(what, **more)[SIZE[1] // 2, SIZE[0] // 2, :3])


def quad_torus(n=5, m=4):
    """As many vertices as quads."""
    u, v = np.meshgrid(np.arange(n) * 2 * np.pi / n, np.arange(m) * 2 * np.pi / m, indexing="ij")
    points = np.stack([(1 + 0.4 * np.cos(v)) * np.cos(u), (1 + 0.4 * np.cos(v)) * np.sin(u), 0.4 * np.sin(v)], -1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(n), np.arange(m), indexing="ij")
    at = lambda a, b: (a % n * m + b % m).reshape(-1)  # noqa: E731
    return points, np.stack([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)], -1)


@pytest.mark.parametrize("make", [
    lambda: rr.Mesh(TRIANGLE, np.zeros((0, 3), int)),
    lambda: rr.Mesh(TRIANGLE, []),
    lambda: rr.Mesh(TRIANGLE, np.zeros((0, 4), int)),
    lambda: rr.Mesh(TRIANGLE, [], offsets=[0]),
    lambda: rr.Mesh(TRIANGLE, [0, 1, 2], offsets=[]),
    lambda: rr.Mesh(TRIANGLE, [], colors=np.ones((3, 3)), normals=np.ones((3, 3))),
    lambda: rr.Mesh(TRIANGLE, []).prepare(),
    lambda: rr.as_scene((TRIANGLE, np.zeros((0, 3)))).things[0],
    lambda: rr.Lines(TRIANGLE, np.zeros((0, 2), int), width=9),
    lambda: rr.Lines(TRIANGLE, offsets=[], width=9),
    lambda: rr.Lines(TRIANGLE, offsets=[0], width=9),
    lambda: rr.Cylinders(TRIANGLE[:2], [], 0.5),
    lambda: rr.Tubes(TRIANGLE, [], 0.5),
    lambda: rr.Tubes(TRIANGLE, [0], 0.5)])
def test_faces_that_are_none(make):
    """A mesh whose face array is empty has no primitives; its vertices in order are no faces."""
    thing = make()
    assert thing.primitives == 0 and (ids([thing, rr.Points([[9.0, 9, 0]])]) == -1).all()


def test_faces_that_are_none_of_other_libraries():
    """An empty trimesh, and a cloud that is a mesh of no triangles, draw nothing."""
    trimesh = pytest.importorskip("trimesh")
    assert (ids([trimesh.Trimesh(TRIANGLE, np.zeros((0, 3), int), process=False), rr.Points([[9.0, 9, 0]])]) == -1).all()
    assert (ids([trimesh.Trimesh(), rr.Points([[9.0, 9, 0]])]) == -1).all()


@pytest.mark.parametrize("mesh", [TETRAHEDRON, quad_torus()], ids=["tetrahedron", "torus"])
def test_as_many_faces_as_vertices(mesh):
    """With per="face" each face has one colour; if the number of values is ambiguous, they are refused without it."""
    n = len(mesh[1])
    assert n == len(mesh[0])
    colors = np.random.default_rng(1).integers(0, 256, (n, 3)).astype(np.uint8)
    for name, values in (("colors", colors), ("scalars", np.arange(n) * 1.0)):
        with pytest.raises(rr.ArgumentError, match=f"{name}.*per='vertex' or per='face'"):
            rr.Mesh(*mesh, **{name: values})
    p = rr.render(rr.Mesh(*mesh, colors=colors, per="face"), rr.Camera.fit(rr.Mesh(*mesh)), size=SIZE, shader="flat",
                  outputs=("color", "id"))
    on = p.id >= 0
    faces = p.id[on] // (1 if mesh is TETRAHEDRON else 2)
    assert on.any() and (np.abs(p.color[on][:, :3].astype(int) - colors[faces]) <= 1).all()
    numbers = rr.render(rr.Mesh(*mesh, scalars=np.arange(n) * 1.0, per="face"), rr.Camera.fit(rr.Mesh(*mesh)), size=SIZE, outputs="scalars")
    assert np.array_equal(numbers.scalars[on], faces)
    blended = flat(rr.Mesh(*mesh, colors=colors, per="vertex"), rr.Camera.fit(rr.Mesh(*mesh)))
    assert len(np.unique(blended[on], axis=0)) > n
    for per, error in (("corner", "corners"), ("point", "vertex, face, corner"), (3, "per")):
        with pytest.raises(rr.Error, match=error):
            rr.Mesh(*mesh, colors=colors, per=per)


def test_as_many_faces_as_vertices_of_other_libraries():
    """Adapters pass `per`."""
    trimesh, meshio = pytest.importorskip("trimesh"), pytest.importorskip("meshio")
    vertices, faces = TETRAHEDRON
    colors = np.array([[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [255, 255, 0, 255]], np.uint8)
    view = rr.Camera.fit(TETRAHEDRON)
    for kind in ("face", "vertex"):
        theirs = trimesh.Trimesh(vertices, faces, process=False, **{f"{kind}_colors": colors})
        assert np.array_equal(flat(theirs, view), flat(rr.Mesh(vertices, faces, colors=colors, per=kind), view)), kind
        import rastrum.compat.pyrender as pyrender
        scene = pyrender.Scene(nodes=[pyrender.Node(mesh=pyrender.Mesh.from_trimesh(theirs, smooth=False))])
        scene.add(pyrender.PerspectiveCamera(1.0), pose=np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 4], [0, 0, 0, 1.0]]))
        color, depth = pyrender.OffscreenRenderer(*SIZE).render(scene, pyrender.RenderFlags.FLAT)
        assert (len(np.unique(color[depth > 0], axis=0)) <= 4) == (kind == "face"), kind
    from rastrum import _surface
    numbers = np.array([0.0, 1, 2, 3])
    made = meshio.Mesh(vertices, [("triangle", np.array(faces))], point_data={"p": numbers}, cell_data={"c": [numbers]})
    for name, per in (("p", "vertex"), ("c", "face")):
        thing, = _surface.things_of(made, scalars=name)
        ours = rr.Mesh(vertices, faces, scalars=numbers, per=per)
        assert np.array_equal(*(rr.render(t, view, size=SIZE, outputs="scalars").scalars for t in (thing, ours)), equal_nan=True), name


def test_vertices_in_order_are_corners():
    """If each corner has its own vertex, in order, `per` is not needed."""
    colors = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    soup = rr.Mesh(TRIANGLE, colors=colors)
    for same in (rr.Mesh(TRIANGLE, [[0, 1, 2]], colors=colors), rr.Mesh(TRIANGLE, colors=colors, per="corner"),
                 rr.Mesh(TRIANGLE, [[0, 1, 2]], colors=colors, per="vertex")):
        assert np.array_equal(flat(same), flat(soup))
    with pytest.raises(rr.ArgumentError, match="per='vertex' or per='corner'"):
        rr.Mesh(TRIANGLE, [[1, 2, 0]], colors=colors)


def changed(name, value):
    def change(thing):
        setattr(thing, name, value)
    return change


def moved(of, place):
    def change(thing):
        of[place] = 0.7
    return change


FLOATS, SINGLES, NESTED = np.eye(4), np.eye(4, dtype=np.float32), np.eye(4).tolist()
COLOR, LIST, PLANES = np.array([1.0, 0, 0]), [1.0, 0.0, 0.0], np.array([[1.0, 0, 0, 0]])
MATERIAL = rr.Material("red", unlit=True)


def nested(thing):
    NESTED[0][3] = 0.7


@pytest.mark.parametrize("look, change", [
    ({}, changed("transform", [[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0]])), ({"transform": FLOATS}, moved(FLOATS, (0, 3))),
    ({"transform": SINGLES}, moved(SINGLES, (0, 3))), ({"transform": NESTED}, nested), ({}, changed("visible", False)),
    ({}, changed("color", "red")), ({"color": COLOR}, moved(COLOR, 1)), ({"color": LIST}, moved(LIST, 1)),
    ({}, changed("opacity", 0.5)), ({}, changed("id", 7)), ({}, changed("clip_planes", [[1, 0, 0, 0]])),
    ({"clip_planes": PLANES}, moved(PLANES, (0, 3))), ({}, changed("material", MATERIAL)), ({"material": MATERIAL}, changed("material", None)),
    ({"material": MATERIAL}, lambda thing: setattr(MATERIAL, "base_color", "blue")),
    ({"material": MATERIAL}, lambda thing: setattr(MATERIAL, "opacity", 0.5)),
    ({}, changed("winding", "clockwise"))])
def test_a_kept_scene_whose_things_change(look, change):
    """Each frame draws the things as they are, however they changed: the picture of a new scene."""
    def draw(what):
        p = rr.render(what, CAMERA, size=SIZE, cull="back", outputs=("color", "instance", "depth"))
        return p.color, p.instance, p.depth
    thing = rr.Mesh(TRIANGLE, **look)
    scene = rr.Scene([rr.Spheres([[0, 0, -3.0]], 0.5), thing])
    before = draw(scene)
    change(thing)
    after, anew = draw(scene), draw([rr.Spheres([[0, 0, -3.0]], 0.5), thing])
    assert all(map(np.array_equal, after, anew))
    assert not all(map(np.array_equal, before, after))


def test_a_kept_scene_moves_its_bounds_and_hits():
    """Bounds, fitted cameras and picks follow the things as well."""
    ball = rr.Spheres([[0.0, 0, 0]], 0.5)
    scene = rr.Scene([ball])
    picture = rr.render(scene, CAMERA, size=SIZE)
    assert picture.pick(24, 18).id == 0
    ball.transform = [[1, 0, 0, 5], [0, 1, 0, 0], [0, 0, 1, 0]]
    assert picture.pick(24, 18) is None
    assert np.allclose(scene.bounds, [(4.5, -0.5, -0.5), (5.5, 0.5, 0.5)])
    assert (rr.render(scene, size=SIZE, outputs="id").id[18, 24] == 0) and (rr.render(scene, rr.Camera.fit(scene), size=SIZE).color != 0).any()
    ball.visible = False
    assert picture.pick(24, 18) is None and (rr.render(scene, CAMERA, size=SIZE, outputs="id").id == -1).all()


def test_things_refuse_what_they_would_ignore():
    """An attribute that frames do not read cannot be assigned."""
    thing = rr.Mesh(TRIANGLE, scalars=[1.0, 2, 3])
    for name, value in (("scalars", [3.0, 2, 1]), ("mapping", rr.ColorMapping())):
        with pytest.raises(rr.ArgumentError, match=name):
            setattr(thing, name, value)
    for name, value in (("id", "wheel"), ("opacity", 5), ("transform", np.eye(3)), ("color", (255, 0, 0)), ("material", "steel")):
        before = getattr(thing, name)
        with pytest.raises(rr.Error, match=name):
            setattr(thing, name, value)
        assert getattr(thing, name) is before


MOVED = np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [1, 2, 3, 1.0]])
TURNED = np.array([[0, 0, 1, 3], [0, 1, 0, 0], [-1, 0, 0, 1], [0, 0, 0, 1.0]])


def projection(near=0.1, far=50.0):
    return np.array([[1.5, 0, 0, 0], [0, 2, 0, 0], [0, 0, (far + near) / (near - far), 2 * far * near / (near - far)], [0, 0, -1, 0]])


def test_matrices_that_multiply_rows():
    """A translation in the last row is refused, with a hint: it would draw the thing unmoved, or bent."""
    with pytest.raises(rr.ArgumentError, match=r"transform: the last row must be \(0, 0, 0, 1\), not \(1, 2, 3, 1\).*take transform.T"):
        rr.Mesh(TRIANGLE, transform=MOVED)
    with pytest.raises(rr.ArgumentError, match="transform: the last row"):
        rr.Mesh(TRIANGLE, transform=np.diag([1, 1, 1, 2.0]))
    with pytest.raises(rr.ArgumentError, match="finite"):
        rr.Mesh(TRIANGLE, transform=np.full((4, 4), np.nan))
    in_place = np.eye(4)
    thing = rr.Mesh(TRIANGLE, transform=in_place)
    in_place[3, :3] = 1, 2, 3
    with pytest.raises(rr.ArgumentError, match="instance 0: the last row of its object_to_world"):
        rr.render(thing, CAMERA, size=SIZE)
    with pytest.raises(rr.ArgumentError, match="view: the last row.*take view.T"):
        rr.Camera.opengl(projection(), MOVED)
    parallel = np.diag([0.5, 0.5, -0.1, 1])
    parallel[:3, 3] = 0.1, 0.2, -1
    view = np.linalg.inv(TURNED)
    for m in (projection(), projection() @ view, parallel, parallel @ view):
        rr.Camera.opengl(m)
        with pytest.raises(rr.ArgumentError, match="projection: .*transpose"):
            rr.Camera.opengl(m.T)
        with pytest.raises(rr.ArgumentError, match="transpose"):
            rr.render(TETRAHEDRON, m.T, size=SIZE)


def test_poses_in_the_place_of_cameras():
    """A (4, 4) camera goes from the world to clip space: a pose, of the camera in the world or the other way, is none."""
    for pose in (TURNED, np.linalg.inv(TURNED), np.eye(4), TURNED.astype(np.float32)):
        for camera in (pose, [rr.Camera.opengl(projection()), pose], np.stack([pose, pose])):
            with pytest.raises(rr.ArgumentError, match="camera: this is a pose.*opengl"):
                rr.render(TETRAHEDRON, camera, size=SIZE)
    # Camera.opengl takes any matrix to clip space.
    assert (rr.render(rr.Mesh(TRIANGLE * 0.5), rr.Camera.opengl(np.eye(4)), size=SIZE, outputs="id").id == 0).any()
    with pytest.raises(rr.ArgumentError, match="R: .*4, 4.*pose"):
        rr.Camera.opencv(np.eye(3), np.eye(4))


@pytest.mark.parametrize("eye, target, up, take", [((0, 5, 0), (0, 0, 0), (0, 1, 0), (0, 0, -1)), ((0, -5, 0), (0, 0, 0), (0, 1, 0), (0, 0, -1)),
                                                   ((0, 0, 5), (0, 0, 0), (0, 0, 1), (0, 1, 0)),
                                                   ((5, 0, 0), (0, 0, 0), (-1, 0, 0), (0, 1, 0))])
def test_looking_along_up(eye, target, up, take):
    """The message names the `up` that would do, and that does."""
    for call in (lambda up: rr.Camera.look_at(eye, target, up), lambda up: rr.Camera.orthographic(eye, target, up, height=3),
                 lambda up: rr.Camera.fit(TETRAHEDRON, eye, up=up)):
        with pytest.raises(rr.ArgumentError) as said:
            call(up)
        assert f"take up={take}" in str(said.value)
        rr.render(TETRAHEDRON, call(take), size=SIZE)


T = np.zeros((2, 2, 3), np.uint8)
K = np.array([[50, 0, 24], [0, 50, 18], [0, 0, 1.0]])


@pytest.mark.parametrize("call, says", [
    (lambda: rr.Light.point(0, 1, 2), r"position, range"), (lambda: rr.Light.directional(direction=3), "direction"),
    (lambda: rr.Light.ambient(colour="red"), "'colour'"), (lambda: rr.Light.spot((0, 0, 0), (0, 0, -1), outer="wide"), "outer"),
    (lambda: rr.Light.ambient(intensity="bright"), "intensity"), (lambda: rr.Light.ambient(color=(255, 0, 0)), "color.*divide"),
    (lambda: rr.Mesh(TRIANGLE, id="wheel"), "id: must be a whole number"), (lambda: rr.Mesh(TRIANGLE, id=-5), "id"),
    (lambda: rr.Mesh(TRIANGLE, colour="red"), r"Mesh: there is no 'colour', 'colors?' perhaps"),
    (lambda: rr.render(rr.Mesh(TRIANGLE), outputs="ids"), "outputs: there is no 'ids', 'id' perhaps"),
    (lambda: rr.render(rr.Mesh(TRIANGLE), "iso"), r"camera: .*not str; Camera.fit\(what, 'iso'\)"),
    (lambda: rr.Points(TRIANGLE, radius=1), "Points: there is no 'radius'"), (lambda: rr.Mesh(TRIANGLE, visible="no"), "visible"),
    (lambda: rr.Mesh(TRIANGLE, color="reed"), "color: 'reed'.*'red'"), (lambda: rr.Mesh(TRIANGLE, opacity=5), "opacity"),
    (lambda: rr.Mesh(TRIANGLE, color=RED), "color.*divide"), (lambda: rr.Mesh(TRIANGLE, winding="cw"), "winding"),
    (lambda: rr.Mesh(TRIANGLE, clip_planes=np.ones((9, 4))), "at most 8"), (lambda: rr.Mesh(TRIANGLE, material="steel"), "material"),
    (lambda: rr.Mesh(TRIANGLE, colors=np.array([RED, BLUE, RED], float)), "colors.*255.*uint8"),
    (lambda: rr.Mesh(TRIANGLE, colors=np.array([RED, BLUE, RED])), "colors.*255.*uint8"),
    (lambda: rr.Material("reed"), "base_color"), (lambda: rr.Material(roughness=5), "roughness"), (lambda: rr.Material(metallic=-1), "metallic"),
    (lambda: rr.Material(opacity=2), "opacity"), (lambda: rr.Material(alpha_mode="blended"), "alpha_mode"),
    (lambda: rr.Material(emissive="glow"), "emissive"), (lambda: rr.Material(unlit="yes"), "unlit"),
    (lambda: rr.Material(base_color_texture="nowhere.png"), "nowhere.png"), (lambda: rr.Material(normal_texture=T.astype(float)), "normal_texture"),
    (lambda: rr.Material(base_color_texture=T[..., 0]), "base_color_texture"), (lambda: rr.Material(alpha_cutoff="half"), "alpha_cutoff"),
    (lambda: rr.Spheres(TRIANGLE, -1), "radius"), (lambda: rr.Cylinders(TRIANGLE[:2], radius=-1), "radius"), (lambda: rr.Tubes(TRIANGLE, radius=-1), "radius"),
    (lambda: rr.Discs(TRIANGLE, TRIANGLE, -1), "radius"), (lambda: rr.Points(TRIANGLE, size=-1), "size"), (lambda: rr.Lines(TRIANGLE, width=-1), "width"),
    (lambda: rr.Spheres(TRIANGLE, "big"), "radius"), (lambda: rr.Lines(TRIANGLE, width="wide"), "width"),
    (lambda: rr.Camera.look_at((0, 0, 4), fov=500), "fov"), (lambda: rr.Camera.look_at((0, 0, 4), fov="wide"), "fov"),
    (lambda: rr.Camera.look_at((0, 0, 4), near=0), "near"), (lambda: rr.Camera.look_at((0, 0, 4), near=5, far=1), "far"),
    (lambda: rr.Camera.look_at((0, 0, 4), (0, 0, 4)), "target"), (lambda: rr.Camera.look_at((0, 0, 4), up=(0, 0, 0)), "up"),
    (lambda: rr.Camera.orthographic((0, 0, 4), height=-1), "height"), (lambda: rr.Camera.fit(TETRAHEDRON, fov=0), "fov"),
    (lambda: rr.Camera.fit(TETRAHEDRON, fov="wide"), "fov"), (lambda: rr.Camera.opencv(-np.eye(3)), "K"), (lambda: rr.Camera.opencv(K * 0), "K"),
    (lambda: rr.Camera.opencv(K, 2 * np.eye(3)), "rotation"), (lambda: rr.Camera.opencv(K, near=-1), "near"),
    (lambda: rr.Camera.opencv(np.array([[np.nan, 0, 0], [0, 1, 0], [0, 0, 1]])), "fx"),
    (lambda: rr.render(TETRAHEDRON, shadows=True), "shadows.*lights="),
    (lambda: rr.render(TETRAHEDRON, shadows=True, lights=rr.Light.ambient(), shader="lambert"), "shadows"),
    (lambda: rr.render(TETRAHEDRON, opacity="half"), "opacity"), (lambda: rr.render(TETRAHEDRON, exposure="bright"), "exposure")])
def test_what_is_refused_where_it_is_said(call, says):
    """The constructor raises an Error that begins with the argument's name."""
    with pytest.raises(rr.Error, match=says) as raised:
        call()
    assert_plain(raised.value)


def assert_plain(error):
    for word in ("incompatible function", "_Thing", "_rastrum", "nanobind", "ndarray["):
        assert word not in str(error), str(error)


def public_calls():
    """(name, function, valid arguments) of all public functions."""
    things = {"positions": TRIANGLE, "centers": TRIANGLE, "normals": TRIANGLE, "what": rr.Spheres(TRIANGLE), "eye": (0, 0, 4), "height": 2,
              "K": K, "projection": projection(), "n": 2, "position": (0, 1, 0), "direction": (0, 0, -1), "picture": np.ones((4, 8, 3)), "indices": [[0, 1, 2]],
              "kind": "point", "heights": np.zeros((8, 8)), "array": TRIANGLE, "path": "builtin:teapot?n=2", "pos": np.ones((3, 4)),
              "tri": [[0, 1, 2]], "resolution": (8, 8), "scene": rr.Spheres(TRIANGLE), "threads": 1}
    def calls(owner, name):
        function = getattr(owner, name)
        takes = [p for p in inspect.signature(function).parameters.values() if p.kind in (p.POSITIONAL_OR_KEYWORD, p.KEYWORD_ONLY)]
        needed = {p.name: things[p.name] for p in takes if p.default is p.empty and p.name in things}
        return f"{getattr(owner, '__name__', owner)}.{name}", function, needed, [p.name for p in takes]
    look = ["color", "opacity", "material", "transform", "visible", "id", "winding", "clip_planes", "scalars", "clim"]
    for name in ("Mesh", "Points", "Lines", "Spheres", "Cylinders", "Tubes", "Discs"):
        label, function, needed, takes = calls(rr, name)
        yield label, function, needed, takes + look
    for name in ("Material", "ColorMapping", "Terrain", "Renderer", "Scene", "Light", "crease_normals", "load", "orbit", "rasterize", "digest", "as_scene"):
        yield calls(rr, name)
    for name in ("look_at", "orthographic", "fit", "opencv", "opengl"):
        yield calls(rr.Camera, name)
    for name in ("ambient", "hemisphere", "directional", "point", "spot", "environment"):
        label, function, needed, takes = calls(rr.Light, name)
        yield label, function, needed, takes + ["color", "intensity"]
    for owner, name in ((rr.Renderer(), "render"), (rr, "views4")):
        label, function, needed, takes = calls(owner, name)
        yield label, function, {**needed, "size": (8, 8)}, takes


@pytest.mark.parametrize("label, function, needed, takes", list(public_calls()), ids=lambda v: v if isinstance(v, str) else "")
def test_what_is_of_a_kind_that_nobody_takes(label, function, needed, takes):
    """Any argument of a wrong type raises an Error of the package, never a binding's list of signatures."""
    function(**needed)
    class Odd:
        def __repr__(self):
            return "an odd thing"
    for name, bad in itertools.product(takes, (Odd(), "odd", b"odd", {1: 2}, 1j, [[[[1]]]], lambda: 1)):
        try:
            function(**{**needed, name: bad})
        except rr.Error as e:
            assert_plain(e)
        except TypeError as e:
            assert name == "progress" or "Odd" in str(e), (name, bad, e)


@pytest.mark.parametrize("make, says", [
    (lambda: rr.Mesh(TRIANGLE, colors=np.eye(3, dtype=np.uint8)), "colors.*nearly black"),
    (lambda: rr.Mesh(TRIANGLE, colors=200 * np.eye(3, dtype=np.uint16)), "colors.*65535"),
    (lambda: rr.Mesh(TRIANGLE, color=np.array([1, 0, 0], np.uint8)), "color.*nearly black"),
    (lambda: rr.Mesh(np.full((3, 3), np.nan)), "positions: none"), (lambda: rr.Spheres(np.full((3, 3), np.inf)), "centers: none"),
    (lambda: rr.Spheres(TRIANGLE, [1, -1, -2]), "radius: 2 of 3"), (lambda: rr.Points(TRIANGLE, size=[1, -1, 2]), "size: 1 of 3"),
    (lambda: rr.Scene(rr.Mesh(TRIANGLE, material=rr.Material(base_color_texture=T))), "uv"),
    (lambda: rr.Scene(rr.Spheres(TRIANGLE, material=rr.Material(base_color_texture=T))), "uv")])
def test_what_is_drawn_and_hardly_meant_is_said_once(make, says):
    """One warning, for the caller's line, names the argument."""
    with pytest.warns(rr.OddInputWarning, match=says) as said:
        make()
    assert len(said) == 1 and said[0].filename == __file__


def test_what_is_as_it_should_be_is_not_warned_of():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        some = TRIANGLE.copy()
        some[0] = np.nan
        rr.Mesh(some)
        rr.Mesh(np.zeros((0, 3)))
        rr.Mesh(TRIANGLE, colors=np.zeros((3, 3), np.uint8))
        rr.Mesh(TRIANGLE, colors=np.array([RED, BLUE, RED], np.uint8))
        rr.Mesh(TRIANGLE, colors=np.eye(3) * (1 + 1e-7))
        rr.Scene(rr.Mesh(TRIANGLE, uv=np.zeros((3, 2)), material=rr.Material(base_color_texture=T)))


def test_colours_of_bytes_and_textures_of_files(tmp_path):
    """An array of uint8 goes to 255, wherever it stands; a texture may be a path."""
    red = np.array(RED, np.uint8)
    assert middle(rr.Mesh(TRIANGLE, color=red)) == RED
    file = tmp_path / "blue.png"
    rr.render(rr.Points([[0, 0, 99.0]]), CAMERA, size=(4, 4), background="blue").save(file)
    made = [rr.Mesh(TRIANGLE, uv=np.zeros((3, 2)), material=rr.Material(base_color_texture=t, unlit=True))
            for t in (file, str(file), np.full((4, 4, 3), BLUE, np.uint8))]
    pictures = [rr.render(m, CAMERA, size=SIZE).color for m in made]
    assert np.array_equal(pictures[0], pictures[2]) and np.array_equal(pictures[1], pictures[2])
    assert tuple(pictures[0][18, 24, :3]) == BLUE


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_near_plane_in_any_unit(unit):
    """A ball of 1 on ground of 20,000, seen from 10, is there in any unit: near follows the scene and the target."""
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


def test_vtk_triangle_strips():
    """A vtkPolyData of strips, and of a polygon before them: each triangle of a strip has its cell's number."""
    pytest.importorskip("vtkmodules")
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    points, polys, strips, data = vtkPoints(), vtkCellArray(), vtkCellArray(), vtkPolyData()
    for x in range(4):
        for y in range(2):
            points.InsertNextPoint(x, y, 0)
    polys.InsertNextCell(4, [0, 2, 3, 1])
    strips.InsertNextCell(4, [2, 4, 3, 5])
    strips.InsertNextCell(4, [4, 6, 5, 7])
    data.SetPoints(points)
    data.SetPolys(polys)
    data.SetStrips(strips)
    numbers = numpy_to_vtk(np.array([1.0, 2.0, 3.0]))
    numbers.SetName("n")
    data.GetCellData().AddArray(numbers)
    from rastrum._others import of_vtk
    seen = rr.render(of_vtk(data, None, scalars="n"), size=(90, 60), outputs="scalars").scalars
    middle = seen[30]
    assert [middle[15], middle[45], middle[75]] == [1.0, 2.0, 3.0]


def test_meshio_pixels():
    """A pixel of VTK has its corners in rows, not around it: its area is that of the quad."""
    from rastrum._surface import outer_surface
    corners, offsets, _ = outer_surface([("pixel", np.array([[0, 1, 2, 3]]))])
    assert corners.tolist() == [0, 1, 3, 2] and offsets.tolist() == [0, 4]
