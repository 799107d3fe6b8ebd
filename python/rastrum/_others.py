# SPDX-License-Identifier: BSD-3-Clause
"""Things of other libraries, recognised by their modules and never imported."""

import numpy as np

from . import _cad, _readers, _surface
from . import _things as _t
from ._errors import ArgumentError


def things_of(what, copy):
    """The things of an object of another library; None where nobody knows it."""
    names = {c.__module__.partition(".")[0] + "." + c.__name__ for c in type(what).__mro__}
    libraries = {name.partition(".")[0] for name in names}
    if "trimesh.Trimesh" in names:
        return [_trimesh(what, None, copy)]
    if "trimesh.PointCloud" in names:
        return [_t.Points(what.vertices, colors=_some(what.colors), copy=copy)]
    if "trimesh.Scene" in names:
        return _trimesh_scene(what, copy)
    if names & {"pyvista.PolyData", "vtkmodules.vtkPolyData", "pyvista.DataSet", "vtkmodules.vtkDataSet"}:
        return of_vtk(what, copy)
    if "meshio.Mesh" in names:
        return _surface.things_of(what, copy)
    if "open3d" in libraries:
        return _open3d(what, names, copy)
    if libraries & {"build123d", "cadquery"}:
        made = _cad.things_of(what, names, copy)
        if made == []:
            raise ArgumentError(f"{type(what).__module__}.{type(what).__qualname__}: has no faces that could be drawn")
        return made
    return None


def _some(array):
    return None if array is None or len(array) == 0 else array


def _trimesh(mesh, transform, copy):
    look = {}
    visual = getattr(mesh, "visual", None)
    kind = getattr(visual, "kind", None)
    if kind in ("vertex", "face"):
        look.update(colors=np.asarray(visual.vertex_colors if kind == "vertex" else visual.face_colors), per=kind)
    elif kind == "texture" and getattr(visual, "uv", None) is not None:
        # trimesh counts v from the bottom, glTF from the top.
        look["uv"] = np.asarray(visual.uv) * (1.0, -1.0) + (0.0, 1.0)
        image = getattr(visual.material, "baseColorTexture", None) or getattr(visual.material, "image", None)
        if image is not None:
            look["material"] = _t.Material(base_color_texture=np.asarray(image.convert("RGBA")))
    return _t.Mesh(mesh.vertices.view(np.ndarray), mesh.faces.view(np.ndarray), transform=transform, copy=copy, **look)


def _trimesh_scene(scene, copy):
    made = []
    for node in scene.graph.nodes_geometry:
        transform, name = scene.graph[node]
        for thing in things_of(scene.geometry[name], copy) or []:
            thing.transform = transform
            made.append(thing)
    return made


def without_strips(data):
    """A vtkPolyData with its triangle strips as triangles, behind its other faces; faces, lines and vertices stay."""
    from vtkmodules.vtkFiltersCore import vtkTriangleFilter

    made = vtkTriangleFilter()
    made.SetInputDataObject(data)
    made.Update()
    return made.GetOutput()


def segments(corners, offsets):
    """(ends, polyline) of VTK's polylines: the two ends of each segment, and for each end its polyline."""
    starts = np.delete(np.arange(len(corners)), offsets[1:] - 1) if len(corners) else np.empty(0, int)
    ends = np.stack([starts, starts + 1], -1).reshape(-1)
    return np.asarray(corners)[ends], np.searchsorted(offsets, ends, "right") - 1


def edges(corners, offsets):
    """(ends, face) of polygons: the two ends of each edge, and for each end a face of the edge; each edge occurs once."""
    after = np.arange(1, len(corners) + 1)
    after[offsets[1:] - 1] = offsets[:-1]
    pairs = np.stack([corners, np.asarray(corners)[after]], -1)
    _, where = np.unique(np.sort(pairs, axis=1), axis=0, return_index=True)
    face = np.searchsorted(offsets, where, "right") - 1
    return pairs[where].reshape(-1), np.repeat(face, 2)


def a_cell_of_each(corners, offsets, points):
    """For each point a polygon that has it as a corner, or the first polygon if none has."""
    cell = np.zeros(points, int)
    cell[np.asarray(corners)[::-1]] = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))[::-1]
    return cell


def of_vtk(data, copy, scalars=None, cmap="viridis", clim=None):
    """The polygons, strips, lines and points of a vtkPolyData; the outer surface of other data sets. scalars: a
    name of its numbers, None: the active ones of the points."""
    if not hasattr(data, "GetPolys"):
        from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter

        outer = vtkGeometryFilter()
        outer.SetInputDataObject(data)
        outer.Update()
        data = outer.GetOutput()
    if data.GetNumberOfStrips():
        data = without_strips(data)
    from vtkmodules.util.numpy_support import vtk_to_numpy

    positions = vtk_to_numpy(data.GetPoints().GetData()) if data.GetNumberOfPoints() else np.empty((0, 3), np.float32)
    normals = data.GetPointData().GetNormals()
    at_points, at_cells = _readers.numbers_of(data, scalars)
    numbers = {} if at_points is None else {"scalars": at_points, "cmap": cmap, "clim": clim}
    face_values = {**numbers, "per": "vertex"}
    if at_cells is not None:  # VTK counts vertices, lines, faces
        first = data.GetNumberOfVerts() + data.GetNumberOfLines()
        face_values = {"scalars": at_cells[first:first + data.GetNumberOfPolys()], "per": "face", "cmap": cmap, "clim": clim}
    made = []

    def cells(of):
        return vtk_to_numpy(of.GetConnectivityArray()), vtk_to_numpy(of.GetOffsetsArray())

    if data.GetNumberOfPolys():
        corners, offsets = cells(data.GetPolys())
        made.append(_t.Mesh(positions, corners, offsets=offsets, copy=copy,
                            normals=None if normals is None else vtk_to_numpy(normals), **face_values))
    if data.GetNumberOfLines():
        corners, offsets = cells(data.GetLines())
        made.append(_t.Lines(positions, corners, offsets=offsets, copy=copy, **numbers))
    if data.GetNumberOfVerts() or (not made and len(positions)):
        made.append(_t.Points(positions, copy=copy, **numbers))
    return made


def _open3d(what, names, copy):
    """Things from Open3D's geometry, which has arrays, or t.geometry, which has named tensors; None for other types."""
    if "open3d.TriangleMesh" in names and hasattr(what, "vertices"):
        return [_t.Mesh(np.asarray(what.vertices), np.asarray(what.triangles), normals=_some(np.asarray(what.vertex_normals)),
                        colors=_some(np.asarray(what.vertex_colors)), per="vertex", copy=copy)]
    if "open3d.TriangleMesh" in names:
        corners = _tensor(what.triangle, "indices")
        return [_t.Mesh(_tensor(what.vertex, "positions"), np.empty((0, 3), np.int64) if corners is None else corners, per="vertex",
                        normals=_some(_tensor(what.vertex, "normals")), colors=_some(_tensor(what.vertex, "colors")), copy=copy)]
    if "open3d.PointCloud" in names and hasattr(what, "points"):
        return [_t.Points(np.asarray(what.points), normals=_some(np.asarray(what.normals)),
                          colors=_some(np.asarray(what.colors)), copy=copy)]
    if "open3d.PointCloud" in names:
        return [_t.Points(_tensor(what.point, "positions"), normals=_some(_tensor(what.point, "normals")),
                          colors=_some(_tensor(what.point, "colors")), copy=copy)]
    if "open3d.LineSet" in names:
        legacy = hasattr(what, "points")
        points = np.asarray(what.points) if legacy else _tensor(what.point, "positions")
        ends = np.asarray(what.lines) if legacy else _tensor(what.line, "indices")
        colors = _some(np.asarray(what.colors) if legacy else _tensor(what.line, "colors"))
        if colors is None:
            return [_t.Lines(points, ends, copy=copy)]
        # Our colours belong to positions, so each line gets two positions of its own.
        return [_t.Lines(np.asarray(points)[np.asarray(ends).reshape(-1)], np.arange(2 * len(ends)).reshape(-1, 2),
                         colors=np.repeat(colors, 2, axis=0), copy=copy)]
    return None


def _tensor(attributes, name):
    return attributes[name].cpu().numpy() if name in attributes else None
