# SPDX-License-Identifier: BSD-3-Clause
"""PyVista (0.48 and later) finds this by itself: mesh.rastrum.render(), plotter.rastrum.screenshot()."""

import numpy as np
import pyvista
from vtkmodules.vtkCommonCore import reference

from . import _others
from ._camera import Camera
from ._lights import Light, display
from ._render import render
from ._scene import Scene
from ._things import ColorMapping, Lines, Mesh, Points


#: Settings that are not drawn if they differ from VTK's default, by object: the name in VTK, the default, the text for
#: `left_out`, and the kind of cell that shows it. tests/test_plugins.py lists all others, which are drawn or never show.
_LEFT_OUT = {
    "property": [("Specular", 0, "highlights (specular)", "lit"), ("EdgeColor", (0, 0, 0), "colours of edges", "edges"),
                 ("EdgeOpacity", 1, "opacities of edges", "edges"), ("EdgeTint", (1, 1, 1), "colours of edges", "edges"),
                 ("LineStipplePattern", 0xFFFF, "dashes of lines", "lines"), ("LineJoin", 2, "joins of lines", "lines"),
                 ("RenderLinesAsTubes", 0, "tubes: lines are flat", "lines"),
                 ("RenderPointsAsSpheres", 0, "spheres: points are flat", "points"),
                 ("VertexVisibility", 0, "vertices of surfaces", "surface")],
    "actor": [("BackfaceProperty", None, "looks of back faces", "surface"), ("Texture", None, "textures", "surface"),
              ("CoordinateSystem", 0, "places of what is not in the world", "")],
    "mapper": [("ClippingPlanes", None, "clipping planes", "")],
    "renderer": [("GradientBackground", 0, "the background's gradient", ""), ("TexturedBackground", 0, "the background's picture", ""),
                 ("UseShadows", 0, "shadows", ""), ("UseSSAO", 0, "occlusion (SSAO)", ""), ("Pass", None, "passes, as of shadows or depth of field", ""),
                 ("UseHiddenLineRemoval", 0, "removal of hidden lines", ""), ("UseImageBasedLighting", 0, "light of a picture", ""),
                 ("EnvironmentTexture", None, "light of a picture", ""), ("TwoSidedLighting", 1, "light of one side", ""),
                 ("Ambient", (1, 1, 1), "the colour of ambient light", "lit")]}


def _surface(data):
    """The outer surface of any data set, without triangle strips."""
    if not isinstance(data, pyvista.PolyData):
        try:
            data = data.extract_surface(algorithm="dataset_surface")
        except TypeError:  # before 0.47
            data = data.extract_surface()
    return pyvista.wrap(_others.without_strips(data)) if data.n_strips else data


def _leaves(data):
    """The data sets of a composite, or the one that is given."""
    if not data.IsA("vtkCompositeDataSet"):
        return [data]
    made, at = [], data.NewIterator()
    while not at.IsDoneWithTraversal():
        made.append(at.GetCurrentDataObject())
        at.GoToNextItem()
    return [leaf for leaf in made if leaf is not None and leaf.IsA("vtkDataSet")]


@pyvista.register_dataset_accessor("rastrum", pyvista.DataSet)
class MeshAccessor:
    """mesh.rastrum.render(...): its outer surface, lines and points, by rastrum.render."""

    def __init__(self, mesh):
        self._mesh = mesh

    def render(self, camera=None, **frame):
        """A rastrum.Picture; rastrum.render has the parameters."""
        return render(self._mesh, camera, **frame)


@pyvista.register_plotter_component("rastrum")
class PlotterComponent:
    """plotter.rastrum.screenshot(...): the picture of a plotter, without OpenGL.

    It draws surfaces with colours, lookup tables and opacity, lines and points in pixels, and all blocks, with the
    plotter's camera, size, background and lights; a scalar bar, titles and texts in corners, axes, the box of show_bounds;
    edges, culling, ambient and diffuse light, or none, if all surfaces have the same. `left_out` lists what is not drawn.
    Scalars with a plain lookup table are interpolated, then mapped; other tables map first.
    """

    def __init__(self, plotter):
        self._plotter = plotter
        self.left_out = []
        self._mappings, self._surfaces = {}, []

    def _leave_out(self, words):
        if words not in self.left_out:
            self.left_out.append(words)

    def _name(self, whose, owner, shows):
        """Leaves out the settings that differ from VTK's default and show. shows: those of lit, edges, lines, points and surface that there are."""
        for name, begins, words, where in _LEFT_OUT[whose]:
            value = getattr(owner, f"Get{name}", lambda begins=begins: begins)()
            if (not where or where in shows) and value != begins:
                self._leave_out(words)

    def scene(self):
        """The rastrum.Scene of all visible actors."""
        self.left_out, self._mappings, self._surfaces = [], {}, []
        things = []
        for actor in self._plotter.renderer.GetViewProps():
            if not actor.GetVisibility():
                continue
            if actor.IsA("vtkScalarBarActor") or actor.IsA("vtkCornerAnnotation") or actor.IsA("vtkCubeAxesActor"):
                continue  # annotations() has them
            mapper = actor.GetMapper() if hasattr(actor, "GetMapper") else None
            data = mapper.GetInputDataObject(0, 0) if mapper is not None and mapper.GetNumberOfInputPorts() else None
            if not actor.IsA("vtkActor") or data is None or not (data.IsA("vtkDataSet") or data.IsA("vtkCompositeDataSet")):
                self._leave_out(actor.GetClassName())
                continue
            mapper.Update()
            for leaf in _leaves(mapper.GetInputDataObject(0, 0)):
                things += self._things(actor, mapper, leaf)
        self._name("renderer", self._plotter.renderer, {"lit"} if any(s["lit"] for s in self._surfaces) else ())
        if len(self._plotter.renderers) > 1:
            self._leave_out("the other subplots")
        return Scene(things)

    def _block(self, mapper, data, look):
        """(colour, opacity, whether it is visible) of a block, or of the whole."""
        color, opacity, visible = None, look.GetOpacity(), True
        blocks = mapper.GetCompositeDataDisplayAttributes() if hasattr(mapper, "GetCompositeDataDisplayAttributes") else None
        if blocks is not None and blocks.HasBlockColor(data):
            color = tuple(blocks.GetBlockColor(data))
        if blocks is not None and blocks.HasBlockOpacity(data):
            opacity = blocks.GetBlockOpacity(data)
        if blocks is not None and blocks.HasBlockVisibility(data):
            visible = blocks.GetBlockVisibility(data)
        return color, opacity, visible

    def _things(self, actor, mapper, data):
        surface, look = _surface(pyvista.wrap(data)), actor.GetProperty()
        block_color, opacity, visible = self._block(mapper, data, look)
        if not visible:
            return []
        values, per_cell, mapping = None, False, None
        if mapper.GetScalarVisibility() and block_color is None:
            values, per_cell, mapping = self._numbers(mapper, surface)
        name = "scalars" if values is not None else "colors"
        if mapper.GetScalarVisibility() and block_color is None and values is None:
            # Where values are interpolated before they are mapped VTK makes a texture instead.
            of_surface = pyvista.DataSetMapper()
            of_surface.ShallowCopy(mapper)
            of_surface.SetInputData(surface)
            of_surface.SetInterpolateScalarsBeforeMapping(False)
            mapped = of_surface.MapScalars(surface, 1.0)
            if mapped is not None:
                values = pyvista.convert_array(mapped)
                per_cell = len(values) == surface.n_cells != surface.n_points or mapper.GetScalarMode() in (2, 4)
        matrix = np.array([[actor.GetMatrix().GetElement(i, j) for j in range(4)] for i in range(4)])
        common = {"opacity": opacity, "transform": matrix}
        if mapping is not None:
            common["cmap"] = mapping
        elif values is None:
            common["color"] = block_color if block_color is not None else look.GetColor()
        points, style = np.asarray(surface.points), look.GetRepresentation()

        def values_at(cells, offset, per_corner):
            """(points, their values), one a cell or one a point. `cells`: corners, cell by cell."""
            if values is None:
                return points[cells], {}
            return points[cells], {name: values[offset + per_corner] if per_cell else values[cells]}

        # Cells are counted as VTK does: vertices, lines, then faces.
        first = surface.n_verts + surface.n_lines
        made, shows, polys = [], set(), surface.GetPolys()
        corners, offsets = (pyvista.convert_array(a) for a in (polys.GetConnectivityArray(), polys.GetOffsetsArray()))
        if surface.GetNumberOfPolys() and style == 2:  # surface
            normals = surface.point_data.active_normals
            faces = {} if values is None else {name: values[first:first + len(offsets) - 1] if per_cell else values,
                                               "per": "face" if per_cell else "vertex"}
            made.append(Mesh(points, corners, offsets=offsets,
                             normals=None if normals is None or look.GetInterpolation() == 0 else np.asarray(normals),
                             **faces, **common))
            shows.add("surface")
            if look.GetEdgeVisibility():
                shows.add("edges")
            if look.GetLighting():
                shows.add("lit")
            if look.GetInterpolation() == 3:
                self._leave_out("physically based surfaces (pbr)")
            if look.GetNumberOfTextures():
                self._leave_out("textures")
            self._surfaces.append({
                "edges": (look.GetLineWidth() if look.GetUseLineWidthForEdgeThickness() else look.GetEdgeWidth())
                if look.GetEdgeVisibility() else None,
                "lit": bool(look.GetLighting()), "light": (look.GetAmbient(), look.GetDiffuse()),
                "cull": "back" if look.GetBackfaceCulling() else "front" if look.GetFrontfaceCulling() else "none"})
            if look.GetLighting() and look.GetAmbient() > 0 and look.GetAmbientColor() != look.GetDiffuseColor():
                self._leave_out("colours of ambient light")
        elif surface.GetNumberOfPolys() and style == 1:  # wireframe
            at, face = _others.edges(corners, offsets)
            places, numbers = values_at(at, first, face)
            made.append(Lines(places, np.arange(len(at)).reshape(-1, 2), width=look.GetLineWidth(), **numbers, **common))
        if surface.n_lines:
            lines = surface.GetLines()
            at, line = _others.segments(*(pyvista.convert_array(a) for a in (lines.GetConnectivityArray(), lines.GetOffsetsArray())))
            places, numbers = values_at(at, surface.n_verts, line)
            made.append(Lines(places, np.arange(len(at)).reshape(-1, 2), width=look.GetLineWidth(), **numbers, **common))
        if any(isinstance(thing, Lines) for thing in made):
            shows.add("lines")
        if style == 0 or surface.n_verts:
            verts, begins = (pyvista.convert_array(a) for a in (surface.GetVerts().GetConnectivityArray(), surface.GetVerts().GetOffsetsArray()))
            cell = np.repeat(np.arange(len(begins) - 1), np.diff(begins))
            if style == 0 and not (per_cell and len(verts)):  # all points, of all cells
                verts, cell = np.arange(len(points)), _others.a_cell_of_each(corners, offsets, len(points))
            places, numbers = values_at(verts, 0 if surface.n_verts else first, cell)
            made.append(Points(places, size=look.GetPointSize(), round=bool(look.GetRenderPointsAsSpheres()) or
                               getattr(look, "GetPoint2DShape", lambda: 1)() == 0, **numbers, **common))
            shows.add("points")
        for whose, what in (("property", look), ("actor", actor), ("mapper", mapper)):
            self._name(whose, what, shows)
        return made

    def _numbers(self, mapper, surface):
        """(what a mapper's lookup table maps, whether they are cells', the ColorMapping); None first where it has no plain
        table of one number each."""
        table = mapper.GetLookupTable()
        flag = reference(0)
        array = mapper.GetAbstractScalars(surface, mapper.GetScalarMode(), mapper.GetArrayAccessMode(), mapper.GetArrayId(),
                                          mapper.GetArrayName(), flag)
        direct = mapper.GetColorMode() == 2 or (array is not None and mapper.GetColorMode() == 0
                                                and array.GetClassName() == "vtkUnsignedCharArray")
        if (array is None or direct or array.GetNumberOfComponents() != 1 or not array.IsNumeric()
                or not table.IsA("vtkLookupTable") or table.GetIndexedLookup()):
            return None, False, None
        low, high = table.GetRange() if mapper.GetUseLookupTableScalarRange() else mapper.GetScalarRange()
        is_log = bool(table.GetScale())
        if not low <= high or (is_log and low <= 0):
            return None, False, None
        key = table.GetAddressAsString(""), low, high
        if key not in self._mappings:
            colors = [table.GetTableValue(i) for i in range(table.GetNumberOfTableValues())]
            below = table.GetBelowRangeColor() if table.GetUseBelowRangeColor() else None
            above = table.GetAboveRangeColor() if table.GetUseAboveRangeColor() else None
            self._mappings[key] = ColorMapping(colors, (low, high), log=is_log, steps=len(colors) if len(colors) < 64 else 0,
                                               below=below, above=above, nan=table.GetNanColor())
        return np.asarray(pyvista.convert_array(array)), bool(flag), self._mappings[key]

    def annotations(self):
        """`annotate` of rastrum.render for what the plotter draws over its picture. Call it after scene()."""
        notes, renderer, captions = {}, self._plotter.renderer, [""] * 4
        for actor in renderer.GetViewProps():
            if not actor.GetVisibility():
                continue
            if actor.IsA("vtkScalarBarActor"):
                # The bar is of the first lookup table that is drawn.
                first = next(iter(self._mappings), (None,))[0]
                if "bar" in notes or actor.GetLookupTable().GetAddressAsString("") != first:
                    self._leave_out("a scalar bar of another lookup table")
                else:
                    notes["bar"] = {"title": (actor.GetTitle() or "").strip()}
            elif actor.IsA("vtkCornerAnnotation"):
                words = [actor.GetText(i) or "" for i in range(8)]
                if actor.GetLinearFontScaleFactor() != 9:  # the default of 18 points in PyVista
                    self._leave_out("sizes of words")
                for place, corner in enumerate((1, 2, 3, 0)):  # ours begin in the bottom right
                    captions[place] += words[corner]
                if words[7]:
                    notes["title"] = words[7].strip("\n")
                if any(words[4:7]):
                    self._leave_out("words at an edge")
            elif actor.IsA("vtkCubeAxesActor"):
                notes["bounds"] = True
        edges = [surface["edges"] for surface in self._surfaces if surface["edges"] is not None]
        if edges and len(edges) == len(self._surfaces):
            notes["edges"] = {"width": max(1.0, edges[0])}
        elif edges:
            self._leave_out("edges of some surfaces")
        if any(captions):
            notes["captions"] = captions
        if getattr(renderer, "axes_enabled", False):
            notes["axes"] = True
        return notes

    def camera(self):
        """The plotter's camera."""
        width, height = self._plotter.window_size
        matrix = self._plotter.renderer.GetActiveCamera().GetCompositeProjectionTransformMatrix(width / height, -1, 1)
        return Camera.opengl(np.array([[matrix.GetElement(i, j) for j in range(4)] for i in range(4)]))

    def lights(self, scene=None, times=1.0):
        """The plotter's lights. Parallel ones, such as those of its light kit and headlight, are taken as they are. Lights
        with a place fade by the square of the distance. With VTK's attenuation (0, 0, q) that is the same; with others the
        brightness is the same in the middle of `scene`, and `left_out` says so. times: the factor for all."""
        renderer = self._plotter.renderer
        renderer.UpdateLightsGeometryToFollowCamera()
        made = []
        for light in renderer.GetLights():
            if not light.GetSwitch() or light.GetIntensity() <= 0:
                continue
            place, to = np.array(light.GetTransformedPosition()), np.array(light.GetTransformedFocalPoint())
            look = {"color": tuple(display(light.GetDiffuseColor())), "intensity": light.GetIntensity() * times}
            if not light.GetPositional():
                made.append(Light.directional(to - place, **look))
                continue
            look["intensity"] *= self._brightness(light, place, to, scene)
            cone = light.GetConeAngle()
            if not 0 < cone < 90:
                made.append(Light.point(place, **look))
                continue
            made.append(Light.spot(place, to - place, inner=cone * 0.999, outer=cone, **look))
            if np.cos(np.radians(cone)) ** light.GetExponent() < 0.8:  # how bright the edge is, which is 1 here
                self._leave_out("how a light fades towards the edge of its cone")
        return made

    def _look_of_all(self, scene):
        """Settings that belong to the frame here, so all surfaces have them or none."""
        def alike(key, words):
            kinds = {surface[key] for surface in self._surfaces}
            if len(kinds) > 1:
                self._leave_out(words)
            return kinds.pop() if len(kinds) == 1 else None
        frame = {"cull": alike("cull", "culling of some surfaces") or "none"}
        if alike("lit", "surfaces without light among others") is False:
            return {**frame, "shader": "flat"}
        ambient, diffuse = alike("light", "ambient and diffuse light of some surfaces") or (0.0, 1.0)
        lights = self.lights(scene, diffuse)
        if ambient > 0:
            lights.append(Light.ambient(intensity=ambient))
        return {**frame, "lights": lights, "shader": "lambert"} if lights else frame  # VTK's surfaces have no highlights

    def _brightness(self, light, place, to, scene):
        """The brightness, one unit away, of a light with a place that fades by the square of the distance."""
        constant, linear, square = light.GetAttenuationValues()
        if constant == linear == 0 < square:
            return 1 / square
        bounds = None if scene is None else scene.bounds
        middle = to if bounds is None else np.mean(bounds, axis=0)
        away = max(np.linalg.norm(middle - place), 1e-6)
        self._leave_out("how a light with a place fades with the distance")
        return away**2 / max(constant + linear * away + square * away**2, 1e-12)

    def screenshot(self, filename=None, **frame):
        """A rastrum.Picture of what the plotter shows, saved as `filename`. frame: as rastrum.render, whose size and
        background are the plotter's."""
        renderer = self._plotter.renderer
        if not self._plotter.camera_set:
            self._plotter.view_isometric()
        renderer.ResetCameraClippingRange()
        scene = self.scene()
        frame = {"size": tuple(self._plotter.window_size), "background": renderer.GetBackground(), "samples": 4,
                 "annotate": self.annotations(), **self._look_of_all(scene), **frame}
        picture = render(scene, self.camera(), **frame)
        return picture if filename is None else picture.save(filename)
