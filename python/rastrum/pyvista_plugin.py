"""PyVista (0.48 and later) finds this by itself: mesh.rastrum.render(), plotter.rastrum.screenshot()."""

import numpy as np
import pyvista

from ._camera import Camera
from ._lights import Light, display
from ._render import render
from ._things import Lines, Mesh, Points, Scene


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
    background and parallel lights. `left_out` says what was there and is not drawn. Colours are the lookup table's at
    points or cells, and are interpolated as such.
    """

    def __init__(self, plotter):
        self._plotter = plotter
        self.left_out = []

    def scene(self):
        """The rastrum.Scene of all visible actors."""
        self.left_out = []
        things = []
        for actor in self._plotter.renderer.GetViewProps():
            if not actor.GetVisibility():
                continue
            mapper = actor.GetMapper() if hasattr(actor, "GetMapper") else None
            data = mapper.GetInputDataObject(0, 0) if mapper is not None and mapper.GetNumberOfInputPorts() else None
            if not actor.IsA("vtkActor") or data is None or not data.IsA("vtkDataSet"):
                self.left_out.append(actor.GetClassName())
                continue
            mapper.Update()
            things += self._things(actor, mapper, pyvista.wrap(mapper.GetInputDataObject(0, 0)))
        return Scene(things)

    def _things(self, actor, mapper, data):
        surface = data if isinstance(data, pyvista.PolyData) else data.extract_surface()
        look, colors, per_cell = actor.GetProperty(), None, False
        if mapper.GetScalarVisibility():
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
        if colors is None:
            common["color"] = look.GetColor()
        at_points = {} if colors is None or per_cell else {"colors": colors}
        made, normals = [], surface.point_data.active_normals
        points, style = np.asarray(surface.points), look.GetRepresentation()
        if surface.GetNumberOfPolys() and style == 2:  # surface
            # Cells are counted as VTK does: vertices, lines, then faces.
            first = surface.n_verts + surface.n_lines
            faces = {"colors": colors[first:first + surface.GetNumberOfPolys()]} if per_cell else at_points
            polys = surface.GetPolys()
            made.append(Mesh(points, pyvista.convert_array(polys.GetConnectivityArray()),
                             offsets=pyvista.convert_array(polys.GetOffsetsArray()),
                             normals=None if normals is None or look.GetInterpolation() == 0 else np.asarray(normals),
                             **faces, **common))
            if look.GetEdgeVisibility():
                self.left_out.append("edges of a surface")
        elif surface.GetNumberOfPolys() and style == 1:  # wireframe
            edges = surface.extract_all_edges()
            made.append(Lines(np.asarray(edges.points), edges.lines.reshape(-1, 3)[:, 1:], width=look.GetLineWidth(), **common))
        if surface.n_lines:
            lines = surface.GetLines()
            made.append(Lines(points, pyvista.convert_array(lines.GetConnectivityArray()),
                              offsets=pyvista.convert_array(lines.GetOffsetsArray()), width=look.GetLineWidth(),
                              **at_points, **common))
        if style == 0 or surface.n_verts and not made:
            made.append(Points(points, size=look.GetPointSize(), round=bool(look.GetRenderPointsAsSpheres()), **at_points,
                               **common))
        if surface.n_strips:
            self.left_out.append("triangle strips")
        return made

    def camera(self):
        """The plotter's camera."""
        width, height = self._plotter.window_size
        matrix = self._plotter.renderer.GetActiveCamera().GetCompositeProjectionTransformMatrix(width / height, -1, 1)
        return Camera.opengl(np.array([[matrix.GetElement(i, j) for j in range(4)] for i in range(4)]))

    def lights(self):
        """The plotter's lights that are parallel, which those of its light kit and headlight are."""
        renderer = self._plotter.renderer
        renderer.UpdateLightsGeometryToFollowCamera()
        made = []
        for light in renderer.GetLights():
            if not light.GetSwitch() or light.GetIntensity() <= 0:
                continue
            if light.GetPositional():
                self.left_out.append("a light with a place")
                continue
            way = np.subtract(light.GetTransformedFocalPoint(), light.GetTransformedPosition())
            made.append(Light.directional(way, color=tuple(display(light.GetDiffuseColor())), intensity=light.GetIntensity()))
        return made

    def screenshot(self, filename=None, **frame):
        """A rastrum.Picture of what the plotter shows, saved as `filename`. frame: as rastrum.render, whose size and
        background are the plotter's."""
        renderer = self._plotter.renderer
        if not self._plotter.camera_set:
            self._plotter.view_isometric()
        renderer.ResetCameraClippingRange()
        scene, lights = self.scene(), self.lights()
        lit = {"lights": lights, "shader": "lambert"} if lights else {}  # VTK's surfaces do not shine
        frame = {"size": tuple(self._plotter.window_size), "background": renderer.GetBackground(), "samples": 4, **lit, **frame}
        picture = render(scene, self.camera(), **frame)
        return picture if filename is None else picture.save(filename)
