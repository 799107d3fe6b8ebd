# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of meshio (simulations' cells of every shape) as what is drawn: the outer surface, lines and points."""

import re

import numpy as np

from ._errors import ArgumentError, UnsupportedError
from ._things import Lines, Mesh, Points

# The faces of each cell, by its corners as VTK and meshio number them; nodes of higher order come after the corners.
_FACES = {
    "tetra": ((0, 1, 3), (1, 2, 3), (2, 0, 3), (0, 2, 1)),
    "hexahedron": ((0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1), (4, 5, 6, 7)),
    "wedge": ((0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)),
    "pyramid": ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
}
_FLAT = {"triangle": (0, 1, 2), "quad": (0, 1, 2, 3), "pixel": (0, 1, 3, 2)}
# vtk_lagrange_tetrahedron is a tetra.
_NAME = re.compile(r"^(?:vtk_lagrange_)?(tetra|hexahedron|wedge|pyramid|triangle|quad|pixel|line|curve|polygon|vertex)(?:hedron|rilateral)?\d*$")


def _kind(name):
    found = _NAME.match(name.lower())
    return {"curve": "line"}.get(found[1], found[1]) if found else None


def outer_surface(blocks):
    """(corners, offsets, cells) of the polygons that bound the cells of `blocks`, (name, (M, K) of nodes) each: a cell's faces
    that no other cell has, and all flat cells. cells: which cell each is of, counted over all blocks."""
    by_size = {}  # corners of a face: ([nodes], [cell], [whether it is a cell of its own])
    polygons, first = [], 0
    for name, nodes in blocks:
        kind, count = _kind(name), len(nodes)
        cells = np.arange(first, first + count)
        first += count
        if kind in _FACES:
            for face in _FACES[kind]:
                by_size.setdefault(len(face), []).append((nodes[:, face], cells, False))
        elif kind in _FLAT:
            by_size.setdefault(len(_FLAT[kind]), []).append((nodes[:, _FLAT[kind]], cells, True))
        elif kind == "polygon":
            polygons.append((np.asarray(nodes), cells))
    corners, sizes, of = [], [], []
    for size, parts in sorted(by_size.items()):
        nodes = np.concatenate([p[0] for p in parts])
        cells = np.concatenate([p[1] for p in parts])
        flat = np.concatenate([np.full(len(p[0]), p[2]) for p in parts])
        _, place, times = np.unique(np.sort(nodes, axis=1), axis=0, return_inverse=True, return_counts=True)
        inner = np.bincount(place.reshape(-1)[~flat], minlength=len(times)) > 1
        seen = flat | ~inner[place.reshape(-1)]
        corners.append(nodes[seen].reshape(-1))
        sizes.append(np.full(seen.sum(), size))
        of.append(cells[seen])
    for nodes, cells in polygons:
        corners.append(nodes.reshape(-1))
        sizes.append(np.full(len(nodes), nodes.shape[1]))
        of.append(cells)
    if not corners:
        return np.empty(0, np.int64), np.zeros(1, np.int64), np.empty(0, np.int64)
    return (np.concatenate(corners).astype(np.int64), np.concatenate([[0], np.cumsum(np.concatenate(sizes))]).astype(np.int64),
            np.concatenate(of))


def _numbers(mesh, name):
    """(at points, at cells over all blocks); one of them is None."""
    if name is None:
        return None, None
    for at, of in ((0, mesh.point_data), (1, mesh.cell_data)):
        if name not in of:
            continue
        values = np.asarray(of[name]) if at == 0 else np.concatenate([np.asarray(v) for v in of[name]])
        if values.ndim > 1 and values.size != len(values):
            raise ArgumentError(f"scalars: {name} has {values[0].size} numbers at each place, not one")
        return (values.reshape(-1), None) if at == 0 else (None, values.reshape(-1))
    known = [*mesh.point_data, *mesh.cell_data]
    raise ArgumentError(f"scalars: there is no {name!r}; there are {', '.join(known) or 'none'}")


def things_of(mesh, copy=None, scalars=None, cmap="viridis", clim=None):
    """The things of a meshio.Mesh: its outer surface, lines and vertices; scalars: the name of its numbers."""
    positions = np.asarray(mesh.points)
    if positions.ndim == 2 and positions.shape[1] == 2:
        positions = np.concatenate([positions, np.zeros((len(positions), 1), positions.dtype)], axis=1)
    blocks = [(b.type, np.asarray(b.data)) for b in mesh.cells]
    at_points, at_cells = _numbers(mesh, scalars)
    look = {"cmap": cmap, "clim": clim}
    numbers = {} if at_points is None else {"scalars": at_points, **look}
    made = []
    corners, offsets, of = outer_surface(blocks)
    if len(of):
        face_values = {**numbers, "per": "vertex"} if at_cells is None else {"scalars": at_cells[of], "per": "face", **look}
        made.append(Mesh(positions, corners, offsets=offsets, copy=copy, **face_values))
    segments = [nodes[:, :2] for name, nodes in blocks if _kind(name) == "line"]
    if segments:
        made.append(Lines(positions, np.concatenate(segments), copy=copy, **numbers))
    vertices = [nodes.reshape(-1) for name, nodes in blocks if _kind(name) == "vertex"]
    if vertices or not blocks:
        some = np.concatenate(vertices) if vertices else np.arange(len(positions))
        of_points = {} if at_points is None else {"scalars": at_points[some], **look}
        made.append(Points(positions[some], copy=copy, **of_points))
    if not made:
        raise UnsupportedError("cells: none of these types are drawn: " + ", ".join(sorted({name for name, _ in blocks})))
    return made
