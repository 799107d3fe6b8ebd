"""PyVista (0.48 and later) finds this by itself: mesh.rastrum.render(), plotter.rastrum.screenshot()."""

import numpy as np
import pyvista
from vtkmodules.vtkCommonCore import reference

from ._camera import Camera
from ._lights import Light, display
from ._render import render
from ._scene import Scene
from ._things import ColorMapping, Lines, Mesh, Points


def _surface(data):
    try:
        return data.extract_surface(algorithm="dataset_surface")
    except TypeError:  # before 0.47
        return data.extract_surface()


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
    """plotter.rastrum.screenshot(...): what a plotter shows, without OpenGL.

    Surfaces with their colours, lookup tables and opacity, lines and points in pixels, by the plotter's camera, size,
    background and lights; a scalar bar, titles and words in corners, axes, the box of show_bounds, edges where all
    surfaces show them. `left_out` says what was there and is not drawn. Numbers are interpolated, then mapped, where they
    have a plain lookup table; else its colours are.
    """

    def __init__(self, plotter):
        self._plotter = plotter
        self.left_out = []
        self._mappings, self._edge_widths = {}, []

    def scene(self):
        """The rastrum.Scene of all visible actors."""
        self.left_out, self._mappings, self._edge_widths = [], {}, []
        things = []
        for actor in self._plotter.renderer.GetViewProps():
            if not actor.GetVisibility():
                continue
            if actor.IsA("vtkScalarBarActor") or actor.IsA("vtkCornerAnnotation") or actor.IsA("vtkCubeAxesActor"):
                continue  # annotations() has them
            mapper = actor.GetMapper() if hasattr(actor, "GetMapper") else None
            data = mapper.GetInputDataObject(0, 0) if mapper is not None and mapper.GetNumberOfInputPorts() else None
            if not actor.IsA("vtkActor") or data is None or not data.IsA("vtkDataSet"):
                self.left_out.append(actor.GetClassName())
                continue
            mapper.Update()
            things += self._things(actor, mapper, pyvista.wrap(mapper.GetInputDataObject(0, 0)))
        return Scene(things)

    def _things(self, actor, mapper, data):
        surface = data if isinstance(data, pyvista.PolyData) else _surface(data)
        look, colors, per_cell = actor.GetProperty(), None, False
        numbers, mapping = None, None
        if mapper.GetScalarVisibility():
            numbers, per_cell, mapping = self._numbers(mapper, surface)
        if mapper.GetScalarVisibility() and numbers is None:
            # Where values are interpolated before they are mapped VTK makes a texture instead.
            of_surface = pyvista.DataSetMapper()
            of_surface.ShallowCopy(mapper)
            of_surface.SetInputData(surface)
            of_surface.SetInterpolateScalarsBeforeMapping(False)
            mapped = of_surface.MapScalars(surface, 1.0)
            if mapped is not None:
                colors = pyvista.convert_array(mapped)
                per_cell = len(colors) == surface.n_cells != surface.n_points
        matrix = np.array([[actor.GetMatrix().GetElement(i, j) for j in range(4)] for i in range(4)])
        common = {"opacity": look.GetOpacity(), "transform": matrix}
        if numbers is not None:
            common["cmap"] = mapping
        elif colors is None:
            common["color"] = look.GetColor()
        values, name = (numbers, "scalars") if numbers is not None else (colors, "colors")
        at_points = {} if values is None or per_cell else {name: values}
        if per_cell:
            one_color = {k: v for k, v in common.items() if k != "cmap"}
        else:
            one_color = common
        made, normals = [], surface.point_data.active_normals
        points, style = np.asarray(surface.points), look.GetRepresentation()
        if surface.GetNumberOfPolys() and style == 2:  # surface
            # Cells are counted as VTK does: vertices, lines, then faces.
            first = surface.n_verts + surface.n_lines
            faces = {name: values[first:first + surface.GetNumberOfPolys()]} if per_cell else at_points
            polys = surface.GetPolys()
            made.append(Mesh(points, pyvista.convert_array(polys.GetConnectivityArray()),
                             offsets=pyvista.convert_array(polys.GetOffsetsArray()),
                             normals=None if normals is None or look.GetInterpolation() == 0 else np.asarray(normals),
                             **faces, **common))
            self._edge_widths.append(look.GetLineWidth() if look.GetEdgeVisibility() else None)
        elif surface.GetNumberOfPolys() and style == 1:  # wireframe
            edges = surface.extract_all_edges()
            made.append(Lines(np.asarray(edges.points), edges.lines.reshape(-1, 3)[:, 1:], width=look.GetLineWidth(), **one_color))
        if surface.n_lines:
            lines = surface.GetLines()
            made.append(Lines(points, pyvista.convert_array(lines.GetConnectivityArray()),
                              offsets=pyvista.convert_array(lines.GetOffsetsArray()), width=look.GetLineWidth(),
                              **at_points, **one_color))
        if style == 0 or surface.n_verts and not made:
            made.append(Points(points, size=look.GetPointSize(), round=bool(look.GetRenderPointsAsSpheres()), **at_points,
                               **one_color))
        if surface.n_strips:
            self.left_out.append("triangle strips")
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
        """What of the plotter is drawn over the picture: `annotate` of rastrum.render. After scene()."""
        notes, renderer, captions = {}, self._plotter.renderer, [""] * 4
        for actor in renderer.GetViewProps():
            if not actor.GetVisibility():
                continue
            if actor.IsA("vtkScalarBarActor"):
                # The bar is of the first lookup table that is drawn.
                first = next(iter(self._mappings), (None,))[0]
                if "bar" in notes or actor.GetLookupTable().GetAddressAsString("") != first:
                    self.left_out.append("a scalar bar of another lookup table")
                else:
                    notes["bar"] = {"title": (actor.GetTitle() or "").strip()}
            elif actor.IsA("vtkCornerAnnotation"):
                words = [actor.GetText(i) or "" for i in range(8)]
                for place, corner in enumerate((1, 2, 3, 0)):  # ours begin in the bottom right
                    captions[place] += words[corner]
                if words[7]:
                    notes["title"] = words[7].strip("\n")
                if any(words[4:7]):
                    self.left_out.append("words at an edge")
            elif actor.IsA("vtkCubeAxesActor"):
                notes["bounds"] = True
        edges = [width for width in self._edge_widths if width is not None]
        if edges and len(edges) == len(self._edge_widths):
            notes["edges"] = {"width": max(1.0, edges[0])}
        elif edges:
            self.left_out.append("edges of some surfaces")
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

    def lights(self, scene=None):
        """The plotter's lights. Parallel ones, which those of its light kit and headlight are, as they are. Lights with a
        place, in a cone or not, fade by the square of the distance here: by VTK's attenuation of (0, 0, q) they are as
        there; by others as bright as there in the middle of `scene`, and `left_out` says so."""
        renderer = self._plotter.renderer
        renderer.UpdateLightsGeometryToFollowCamera()
        made = []
        for light in renderer.GetLights():
            if not light.GetSwitch() or light.GetIntensity() <= 0:
                continue
            place, to = np.array(light.GetTransformedPosition()), np.array(light.GetTransformedFocalPoint())
            look = {"color": tuple(display(light.GetDiffuseColor())), "intensity": light.GetIntensity()}
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
                self.left_out.append("how a light fades towards the edge of its cone")
        return made

    def _brightness(self, light, place, to, scene):
        """Of a light with a place, a unit away, where it fades by the square of the distance."""
        constant, linear, square = light.GetAttenuationValues()
        if constant == linear == 0 < square:
            return 1 / square
        bounds = None if scene is None else scene.bounds
        middle = to if bounds is None else np.mean(bounds, axis=0)
        away = max(np.linalg.norm(middle - place), 1e-6)
        self.left_out.append("how a light with a place fades with the distance")
        return away**2 / max(constant + linear * away + square * away**2, 1e-12)

    def screenshot(self, filename=None, **frame):
        """A rastrum.Picture of what the plotter shows, saved as `filename`. frame: as rastrum.render, whose size and
        background are the plotter's."""
        renderer = self._plotter.renderer
        if not self._plotter.camera_set:
            self._plotter.view_isometric()
        renderer.ResetCameraClippingRange()
        scene = self.scene()
        lights = self.lights(scene)
        lit = {"lights": lights, "shader": "lambert"} if lights else {}  # VTK's surfaces do not shine
        frame = {"size": tuple(self._plotter.window_size), "background": renderer.GetBackground(), "samples": 4,
                 "annotate": self.annotations(), **lit, **frame}
        picture = render(scene, self.camera(), **frame)
        return picture if filename is None else picture.save(filename)
