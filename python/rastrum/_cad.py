# SPDX-License-Identifier: BSD-3-Clause
"""Shapes of build123d and CadQuery: triangles of their faces, a thing for each colour."""

import numpy as np

from . import _things as _t
from ._arrays import product


def things_of(what, names, copy):
    """None for what is none; [] for what has no faces."""
    if "build123d.Builder" in names:  # with BuildPart() as ...
        what = next((made for kind in ("part", "sketch", "line") if (made := getattr(what, kind, None)) is not None), None)
        return [] if what is None else _build123d(what, copy)
    if "build123d.Shape" in names:
        return _build123d(what, copy)
    if "cadquery.Assembly" in names:
        return _assembly(what, copy)
    if names & {"cadquery.Workplane", "cadquery.Sketch"}:
        shapes = what.vals() if "cadquery.Workplane" in names else what
        return [thing for shape in shapes if hasattr(shape, "tessellate") for thing in _cadquery(shape, None, copy)]
    if "cadquery.Shape" in names:
        return _cadquery(what, None, copy)
    return None


def _fine(diagonal):
    """How far the triangles of a shape may be off."""
    return max(diagonal, 1e-9) / 1000


def _build123d(shape, copy, color=None, within=None):
    """within: where the parent of an assembly's part lies, whose places and colours are relative to it."""
    color = getattr(shape, "color", None) or color
    children = getattr(shape, "children", ())
    if children:
        here = _place(shape.location)
        within = here if within is None else product(within, here)
        return [thing for child in children for thing in _build123d(child, copy, color, within)]
    if not shape.faces():
        return []
    made = _triangles(shape.tessellate(_fine(shape.bounding_box().diagonal)), color, copy)
    for thing in made:
        thing.transform = within
    return made


def _place(location):
    of = location.wrapped.Transformation()
    return np.array([[of.Value(i, j) for j in range(1, 5)] for i in range(1, 4)] + [[0, 0, 0, 1]], np.float64)


def _assembly(assembly, copy):
    made = []
    for shape, _, place, color in assembly:
        made += _cadquery(shape.moved(place), color, copy)
    return made


def _cadquery(shape, color, copy):
    if not shape.Faces():
        return []
    return _triangles(shape.tessellate(_fine(shape.BoundingBox().DiagonalLength)), color, copy)


def _numbers(vector):
    return vector.toTuple() if hasattr(vector, "toTuple") else tuple(vector)


def _rgba(color):
    if color is None:
        return None
    return tuple(min(max(c, 0.0), 1.0) for c in (color.toTuple() if hasattr(color, "toTuple") else color))


def _triangles(tessellated, color, copy):
    """Smooth where faces are: both libraries give each face vertices of its own, and no normals."""
    vertices, triangles = tessellated
    positions = np.array([_numbers(v) for v in vertices], np.float64).reshape(-1, 3)
    corners = np.asarray(triangles, np.int64).reshape(-1, 3)
    if not len(corners):
        return []
    return [_t.Mesh(positions, corners, normals=_t.crease_normals(positions, corners), color=_rgba(color), copy=copy)]
