# SPDX-License-Identifier: BSD-3-Clause
"""The package as a plug-in of others: PyVista's component, pytest's fixture."""

import json
import os
import pathlib
import subprocess
import sys

import numpy as np
import pytest

import rastrum as rr

TEST = """
import numpy as np, rastrum as rr
def test_ball(rr_snapshot):
    rr_snapshot(rr.render(rr.Spheres(np.zeros((1, 3)), RADIUS), rr.Camera.look_at((0, 0, 4)), size=(40, 30)), "ball")
"""


def run_pytest(folder, *options):
    package = pathlib.Path(rr.__file__).resolve().parent
    path = os.pathsep.join([str(pathlib.Path(rr.__file__).parent.parent), os.environ.get("PYTHONPATH", "")])
    assert package.is_dir()
    return subprocess.run([sys.executable, "-m", "pytest", "-q", "-p", "rastrum.pytest_plugin", *options], cwd=folder,
                          capture_output=True, text=True,
                          env={**os.environ, "PYTHONPATH": path, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"})


def test_a_snapshot_is_taken_held_and_shown_where_it_differs(tmp_path):
    test = tmp_path / "test_it.py"
    test.write_text(TEST.replace("RADIUS", "1.0"))
    first = run_pytest(tmp_path)
    assert first.returncode == 1 and "no digest yet" in first.stdout
    assert run_pytest(tmp_path, "--rr-update").returncode == 0
    book = json.loads((tmp_path / "rr_snapshots.json").read_text())
    ball = rr.render(rr.Spheres(np.zeros((1, 3))), rr.Camera.look_at((0, 0, 4)), size=(40, 30))
    assert book == {"test_it.py::ball": rr.digest(ball.color)}
    assert run_pytest(tmp_path).returncode == 0
    test.write_text(TEST.replace("RADIUS", "1.1"))
    wrong = run_pytest(tmp_path)
    assert wrong.returncode == 1 and "pixels differ" in wrong.stdout, wrong.stdout
    for kind in ("actual", "expected", "difference"):
        assert (tmp_path / "rr_failures" / f"ball.{kind}.png").stat().st_size > 0


def test_pyvista():
    pv = pytest.importorskip("pyvista")
    import rastrum.pyvista_plugin  # noqa: F401  where no wheel is installed there are no entry points
    sphere = pv.Sphere(theta_resolution=40, phi_resolution=40)
    faces = sphere.regular_faces
    direct = rr.render(rr.Mesh(np.asarray(sphere.points), faces, normals=np.asarray(sphere.point_normals)), size=(90, 70))
    assert np.array_equal(sphere.rastrum.render(size=(90, 70)).color, direct.color)
    plotter = pv.Plotter(off_screen=True, window_size=(160, 120))
    plotter.add_mesh(sphere, color="red", opacity=0.5)
    plotter.add_mesh(pv.Cube(center=(2, 0, 0)), scalars=np.arange(6.0), cmap="viridis", show_scalar_bar=False)
    plotter.add_mesh(pv.Line((0, 0, 0), (2, 2, 0)), line_width=4)
    plotter.add_points(np.array([[0.0, 2, 0]]), point_size=9)
    plotter.add_mesh(pv.Plane(center=(-2, 0, 0)).elevation((-2, -0.5, 0), (-2, 0.5, 0)), cmap="gray", lighting=False)
    plotter.add_text("words")
    plotter.camera_position = "xy"
    p = plotter.rastrum.screenshot(outputs=("color", "instance"))
    assert set(np.unique(p.instance)) == {-1, 0, 1, 2, 3, 4}
    # The first table is the cube's, who has no bar.
    assert set(plotter.rastrum.left_out) == {"a scalar bar of another lookup table", "surfaces without light among others"}
    assert p.color[p.instance == 1][:, :3].std(axis=0).max() < 60  # one side of the cube: one colour but for the light
    middle = p.color[p.instance == 0].mean(axis=0)
    assert middle[0] > middle[1] + 30


def test_what_a_plotter_draws_over_its_picture():
    pv = pytest.importorskip("pyvista")
    import rastrum.pyvista_plugin  # noqa: F401

    def plotter():
        made = pv.Plotter(off_screen=True, window_size=(200, 150))
        made.camera_position = [(3, 2, 4), (0, 0, 0), (0, 1, 0)]
        return made
    sphere = pv.Sphere(theta_resolution=40, phi_resolution=40)
    numbers = sphere.points[:, 2].astype(np.float64)
    numbers[:3] = np.nan
    sphere["z"] = numbers
    full = plotter()
    full.add_mesh(sphere, scalars="z", cmap="coolwarm", clim=(-0.4, 0.3), below_color="green", above_color="black", nan_color="red",
                  scalar_bar_args={"title": "Height"}, show_edges=True)
    full.add_text("corner", position="lower_right")
    full.add_title("Title")
    full.add_axes()
    full.show_bounds()
    picture = full.rastrum.screenshot()
    assert not full.rastrum.left_out, full.rastrum.left_out
    assert full.rastrum.annotations() == {"bar": {"title": "Height"}, "title": "Title", "captions": ["corner", "", "", ""],
                                          "axes": True, "bounds": True, "edges": {"width": 1.0}}
    # Without what is drawn over it the picture is of the numbers, by the table that PyVista made.
    table = [tuple(c) for c in full.mapper.lookup_table.values / 255.0]
    mapping = rr.ColorMapping(table, (-0.4, 0.3), below="green", above="black", nan="red")
    mesh = rr.Mesh(np.asarray(sphere.points), sphere.regular_faces, normals=np.asarray(sphere.point_normals), scalars=numbers,
                   cmap=mapping)
    direct = rr.render(mesh, full.rastrum.camera(), size=(200, 150), shader="flat", outputs=("color", "scalars"))
    mine = full.rastrum.screenshot(shader="flat", lights=None, samples=1, annotate=(), background=None,
                                   outputs=("color", "scalars"))
    assert np.array_equal(mine.scalars, direct.scalars, equal_nan=True) and np.array_equal(mine.color, direct.color)
    assert (picture.color[:, :, :3] != mine.color[:, :, :3]).any(axis=2).mean() > 0.1
    # Settings that Rastrum has no equivalent for are named.
    other = plotter()
    other.add_mesh(sphere, scalars="z", show_edges=True, scalar_bar_args={"title": "Height"})
    other.add_mesh(pv.Cube(), color="red")
    other.add_text("here", position=(30, 40))
    other.add_text("edge", position="left_edge")
    other.rastrum.screenshot()
    assert sorted(other.rastrum.left_out)[0] == "edges of some surfaces"
    assert any("Text" in name for name in other.rastrum.left_out) and "words at an edge" in other.rastrum.left_out


def test_the_plotters_lights():
    pv = pytest.importorskip("pyvista")
    import rastrum.pyvista_plugin  # noqa: F401

    def shown(*lights, lighting="none"):
        plotter = pv.Plotter(off_screen=True, window_size=(80, 80), lighting=lighting)
        plotter.add_mesh(pv.Plane(i_size=10, j_size=10), color="white")
        for light in lights:
            plotter.add_light(light)
        plotter.camera_position = "xy"
        return plotter.rastrum.screenshot().color[40, 40, :3], plotter.rastrum

    # VTK's light is in display values: so much of white as the light has, times its slant.
    tilted = pv.Light(position=(0, 1, 1), focal_point=(0, 0, 0), color=(1.0, 0.5, 0.25), intensity=0.8, light_type="scene light")
    tilted.positional = False
    color, component = shown(tilted)
    assert np.abs(color - 255 * 0.8 * np.sqrt(0.5) * np.array([1, 0.5, 0.25])).max() <= 1 and not component.left_out
    behind = pv.Light(position=(0, 0, -1), focal_point=(0, 0, 0), light_type="scene light")
    assert shown(behind)[0].max() == 0
    assert np.abs(shown(pv.Light(light_type="headlight", intensity=0.5))[0] - 127.5).max() <= 1.5
    assert 150 < shown(lighting="light kit")[0].mean() < 256


def test_a_plotters_lights_with_a_place():
    pv = pytest.importorskip("pyvista")
    import rastrum.pyvista_plugin  # noqa: F401

    def shown(**of_light):
        """The brightness along the middle row of a white plane of 4 x 4, and the component."""
        plotter = pv.Plotter(off_screen=True, window_size=(81, 81), lighting="none")
        plotter.add_mesh(pv.Plane(i_size=4, j_size=4), color="white")
        plotter.add_light(pv.Light(**{"position": (0, 0, 2), "focal_point": (0, 0, 0), "positional": True, "cone_angle": 90,
                                      "attenuation_values": (0, 0, 0.25), **of_light}))
        plotter.camera_position = "xy"
        plotter.enable_parallel_projection()
        plotter.camera.parallel_scale = 2
        return plotter.rastrum.screenshot(samples=1).color[40, :, 0] / 255, plotter.rastrum
    x = (np.arange(81) + 0.5) * 4 / 81 - 2
    slant, square = 2 / np.sqrt(4 + x * x), 4 + x * x
    fading, component = shown()
    assert np.abs(fading - slant / (0.25 * square)).max() < 0.006 and not component.left_out
    cone, component = shown(cone_angle=20, exponent=0)
    edge = 2 * np.tan(np.radians(20))
    away = np.abs(np.abs(x) - edge) > 0.06
    assert np.abs(cone - (np.abs(x) < edge) * slant / (0.25 * square))[away].max() < 0.006 and not component.left_out
    # A light that fades otherwise is as bright in the middle, and its fading is named in left_out.
    constant, component = shown(attenuation_values=(1, 0, 0), intensity=0.7)
    assert abs(constant[40] - 0.7) < 0.01 and component.left_out == ["how a light with a place fades with the distance"]
    assert shown(cone_angle=30, exponent=9)[1].left_out == ["how a light fades towards the edge of its cone"]
    assert shown(cone_angle=30, exponent=1)[1].left_out == []


#: With _LEFT_OUT of the plug-in, all settings of VTK: those that are drawn, and those that show in no picture.
DRAWN = {
    "property": "Ambient AmbientColor BackfaceCulling Color Diffuse DiffuseColor EdgeVisibility EdgeWidth FrontfaceCulling Interpolation "
                "Lighting LineWidth Opacity Point2DShape PointSize Representation UseLineWidthForEdgeThickness",
    "actor": "Mapper Orientation Origin Position Property Scale UserMatrix UserTransform Visibility",
    "mapper": "ArrayAccessMode ArrayComponent ArrayId ArrayName ColorMode FieldDataTupleId InputConnection InputDataObject "
              "InterpolateScalarsBeforeMapping LookupTable ScalarMode ScalarRange ScalarVisibility UseLookupTableScalarRange",
    "renderer": "ActiveCamera Background LightFollowCamera AutomaticLightCreation Viewport"}
#: Settings of physically based surfaces, of textures, of selections, of VTK's inner working, and of drawing orders, which are exact here.
ELSEWHERE = {
    "property": "Anisotropy AnisotropyRotation BaseIOR CoatColor CoatIOR CoatNormalScale CoatRoughness CoatStrength EmissiveFactor "
                "Metallic NormalScale OcclusionStrength Roughness Texture ShowTexturesOnBackface SpecularColor SpecularPower VertexColor "
                "LineStippleRepeatFactor Information MaterialName SelectionColor SelectionLineWidth SelectionPointSize Shading",
    "actor": "AllocatedRenderTime CoordinateSystemDevice CoordinateSystemRenderer Dragable EstimatedRenderTime ForceOpaque "
             "ForceTranslucent Pickable PropertyKeys RenderTimeMultiplier ShaderProperty UseBounds",
    "mapper": "AbortExecute AbortOutput CellIdArrayName CompositeIdArrayName ContainerAlgorithm Executive GhostLevel Information "
              "NumberOfPieces NumberOfSubPieces PauseShiftScale Piece PointIdArrayName ProcessIdArrayName ProgressObserver "
              "ProgressText RelativeCoincidentTopologyLineOffsetParameters RelativeCoincidentTopologyPointOffsetParameter "
              "RelativeCoincidentTopologyPolygonOffsetParameters ReleaseDataFlag RenderTime ResolveCoincidentTopology "
              "ResolveCoincidentTopologyLineOffsetParameters ResolveCoincidentTopologyPointOffsetParameter "
              "ResolveCoincidentTopologyPolygonOffsetFaces ResolveCoincidentTopologyPolygonOffsetParameters "
              "ResolveCoincidentTopologyZShift SeamlessU SeamlessV Selection Static VBOShiftScaleMethod",
    "renderer": "AllocatedRenderTime Aspect Background2 BackgroundAlpha BackgroundTexture BackingStore ClippingRangeExpansion Delegate "
                "DisplayPoint DitherGradient Draw EnvironmentRight EnvironmentRotationMatrix EnvironmentUp EnvironmentalBG "
                "EnvironmentalBG2 Erase FXAAOptions GradientEnvironmentalBG GradientMode Information Interactive Layer LeftBackgroundTexture "
                "MaximumNumberOfPeels NearClippingPlaneTolerance OcclusionRatio PixelAspect PreserveColorBuffer "
                "PreserveDepthBuffer RenderWindow RightBackgroundTexture SSAOBias SSAOBlur SSAOKernelSize SSAORadius SafeGetZ "
                "SkyboxBlurEnabled SkyboxBlurRadius UseDepthPeeling UseDepthPeelingForVolumes UseFXAA UseOIT ViewPoint WorldPoint"}


def test_nothing_that_vtk_can_be_told_is_forgotten():
    """Each setting of a property, an actor, a mapper or a renderer is drawn, named in left_out, or shows nowhere."""
    pytest.importorskip("pyvista")
    from rastrum.pyvista_plugin import _LEFT_OUT
    from vtkmodules import vtkCommonCore, vtkRenderingCore
    of_all = set(dir(vtkCommonCore.vtkObject))
    for whose, kind in (("property", "vtkProperty"), ("actor", "vtkActor"), ("mapper", "vtkPolyDataMapper"), ("renderer", "vtkRenderer")):
        has = dir(getattr(vtkRenderingCore, kind))
        told = {m[3:] for m in has if m.startswith("Set") and f"Get{m[3:]}" in has and m not in of_all}
        named = {name for name, *_ in _LEFT_OUT[whose]}
        drawn, elsewhere = set(DRAWN[whose].split()), set(ELSEWHERE[whose].split())
        assert told - named - drawn - elsewhere == set(), kind
        assert not named & drawn and not named & elsewhere and not drawn & elsewhere


def picture_of(pv, *meshes, then=None, window=(60, 60), **plotter):
    """(colours, left_out) of meshes, (mesh, options) each, seen along -z."""
    made = pv.Plotter(off_screen=True, window_size=window, **plotter)
    for mesh, options in meshes:
        made.add_mesh(mesh, **{"color": None if "scalars" in options else "white", "show_scalar_bar": False, **options})
    if then is not None:
        then(made)
    made.camera_position = "xy"
    return made.rastrum.screenshot(samples=1).color, made.rastrum.left_out


def textured(pv):
    return pv.Plane(), {"texture": pv.Texture(np.zeros((4, 4, 3), np.uint8))}


@pytest.mark.parametrize("meshes, then, words", [
    (lambda pv: [(pv.Sphere(), {"specular": 0.5})], None, "highlights (specular)"),
    (lambda pv: [(pv.Sphere(), {"pbr": True, "metallic": 0.5})], None, "physically based surfaces (pbr)"),
    (lambda pv: [textured(pv)], None, "textures"),
    (lambda pv: [(pv.Sphere(), {"lighting": False}), (pv.Cube(), {})], None, "surfaces without light among others"),
    (lambda pv: [(pv.Sphere(), {"ambient": 0.5}), (pv.Cube(), {})], None, "ambient and diffuse light of some surfaces"),
    (lambda pv: [(pv.Sphere(), {"culling": "back"}), (pv.Cube(), {})], None, "culling of some surfaces"),
    (lambda pv: [(pv.Line(), {"render_lines_as_tubes": True, "line_width": 5})], None, "tubes: lines are flat"),
    (lambda pv: [(pv.PolyData(np.eye(3)), {"render_points_as_spheres": True})], None, "spheres: points are flat"),
    (lambda pv: [(pv.Sphere(), {"show_edges": True, "edge_color": "red"})], None, "colours of edges"),
    (lambda pv: [(pv.Sphere(), {"show_edges": True, "edge_opacity": 0.5})], None, "opacities of edges"),
    (lambda pv: [(pv.Sphere(), {})], lambda p: first(p).prop.SetVertexVisibility(True), "vertices of surfaces"),
    (lambda pv: [(pv.Plane(), {"backface_params": {"color": "red"}})], None, "looks of back faces"),
    (lambda pv: [(pv.Sphere(), {})], lambda p: p.set_background("white", top="blue"), "the background's gradient"),
    (lambda pv: [(pv.Sphere(), {})], lambda p: p.enable_shadows(), "passes, as of shadows or depth of field"),
    (lambda pv: [(pv.Sphere(), {})], lambda p: p.add_text("large", font_size=40, position="upper_left"), "sizes of words"),
    (lambda pv: [(pv.Sphere(), {})], lambda p: first(p).mapper.AddClippingPlane(plane()), "clipping planes")])
def test_what_a_plotter_shows_and_is_not_drawn_is_named(meshes, then, words):
    pv = pytest.importorskip("pyvista")
    import rastrum.pyvista_plugin  # noqa: F401
    assert picture_of(pv, *meshes(pv), then=then)[1] == [words]


def first(plotter):
    return next(iter(plotter.actors.values()))


def plane():
    from vtkmodules.vtkCommonDataModel import vtkPlane
    return vtkPlane()


def test_subplots_are_named():
    pv = pytest.importorskip("pyvista")
    import rastrum.pyvista_plugin  # noqa: F401
    assert picture_of(pv, (pv.Sphere(), {}), shape=(1, 2))[1] == ["the other subplots"]


def test_light_culling_strips_and_blocks_are_drawn():
    pv = pytest.importorskip("pyvista")
    import rastrum.pyvista_plugin  # noqa: F401
    ball = pv.Sphere()

    def drawn(*meshes, **more):
        color, left_out = picture_of(pv, *meshes, **more)
        assert not left_out, left_out
        return color
    unlit = drawn((ball, {"color": "red", "lighting": False}))
    assert (unlit[unlit[..., 0] > unlit[..., 1]][:, :3] == (255, 0, 0)).all() and (unlit[30, 30, :3] == (255, 0, 0)).all()
    dim = drawn((ball, {"ambient": 0.25, "diffuse": 0.0, "color": "white"}))
    assert np.abs(dim[30, 30, :3].astype(int) - 64).max() <= 1
    plain, ambient = drawn((ball, {"diffuse": 0.5})), drawn((ball, {"ambient": 0.25, "diffuse": 0.5}))
    assert np.abs(ambient[30, 30, :3].astype(int) - plain[30, 30, :3] - 64).max() <= 2
    inside = drawn((ball, {"culling": "front"}))
    assert not np.array_equal(inside, drawn((ball, {})))
    # A tube consists of triangle strips.
    strips = pv.Line((-1, 0, 0), (1, 0, 0)).tube(radius=0.3)
    assert strips.n_strips and np.array_equal(drawn((strips, {})), drawn((strips.triangulate(), {})))
    assert strips.rastrum.render(size=(20, 20), outputs="id").id.max() > 0
    blocks = pv.MultiBlock([pv.Plane(center=(-1, 0, 0)), pv.MultiBlock([pv.Plane(center=(1, 0, 0))])])
    both = [(pv.Plane(center=(-1, 0, 0)), {"color": "green"}), (pv.Plane(center=(1, 0, 0)), {"color": "green"})]
    assert np.array_equal(drawn((blocks, {"color": "green"})), drawn(*both))

    def colored(plotter):
        actor, mapper = plotter.add_composite(pv.MultiBlock([pv.Plane(center=(-1, 0, 0)), pv.Plane(center=(1, 0, 0))]), color="green", lighting=False)
        mapper.block_attr[1].color = "blue"
        mapper.block_attr[2].opacity = 0.5
    color = drawn(then=colored)
    assert (color[30, 10, :3] == (0, 0, 255)).all() and 0 < color[30, 50, 1] and (color[30, 50] != color[30, 10]).any()


def test_numbers_of_cells_on_lines_points_and_wires():
    """Each segment and each point has the colour of its cell."""
    pv = pytest.importorskip("pyvista")
    import rastrum.pyvista_plugin  # noqa: F401
    rows = np.array([[-1, 0.5, 0], [1, 0.5, 0], [-1, -0.5, 0], [1, -0.5, 0.0]])
    lines = pv.PolyData(rows, lines=[2, 0, 1, 2, 2, 3])
    dots = pv.PolyData(rows)
    for mesh, values in ((lines, [0.0, 1.0]), (dots, [0.0, 0, 1, 1])):
        mesh.cell_data["c"] = values
        color, left_out = picture_of(pv, (mesh, {"scalars": "c", "cmap": ["red", "blue"], "line_width": 5, "point_size": 9}), window=(80, 80))
        red, blue = ((color[..., :3] == c).all(axis=2) for c in ((255, 0, 0), (0, 0, 255)))
        assert red[:40].any() and blue[40:].any() and not red[40:].any() and not blue[:40].any() and not left_out, mesh
    sheets = pv.PolyData(np.concatenate([rows + (0, 0.3, 0), rows - (0, 0.3, 0)]), faces=[4, 0, 1, 3, 2, 4, 4, 5, 7, 6])
    sheets.cell_data["c"] = [0.0, 1.0]
    for style in ("wireframe", "points"):
        color, left_out = picture_of(pv, (sheets, {"scalars": "c", "cmap": ["red", "blue"], "style": style, "point_size": 9, "line_width": 3}))
        red, blue = ((color[..., :3] == c).all(axis=2) for c in ((255, 0, 0), (0, 0, 255)))
        assert red.any() and blue.any() and not left_out, style
