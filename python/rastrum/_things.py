# SPDX-License-Identifier: BSD-3-Clause
"""Geometries over arrays, and their materials."""

import math
import os
import re

import numpy as np

from . import _rastrum as _r
from ._arrays import _numbers, colors as _colors_of, floats, integers, linear, number, placement, scalars as _scalars, whole
from ._arrays import color as _color
from ._errors import ArgumentError, ArgumentTypeError, NotFoundError, raises_errors, warn
from ._locks import lock_in


def _one_of(*names):
    def check(value, name):
        if not isinstance(value, str) or value not in names:
            kind = ArgumentError if isinstance(value, str) else ArgumentTypeError
            raise kind(f"{name}: must be one of {', '.join(names)}, not {value!r}")
        return value
    return check


def _yes_or_no(value, name):
    if not isinstance(value, (bool, np.bool_, int, np.integer)):
        raise ArgumentTypeError(f"{name}: must be True or False, not {value!r}")
    return bool(value)


def _part(value, name):
    return number(value, name, 0, 1)


def _not_negative(value, name):
    return number(value, name, 0, math.inf)


def _fixed_color(value, name):
    """A string as it is, else a copy that cannot change later."""
    made = _color(value, name)
    return value if isinstance(value, str) else made


def _texture(value, name):
    if value is None:
        return None
    if isinstance(value, (str, os.PathLike)):
        return _r.read_image(os.fspath(value))
    array = _numbers(value, name)
    if array.dtype != np.uint8 or array.ndim != 3 or array.shape[2] not in (3, 4) or 0 in array.shape:
        raise ArgumentError(f"{name}: must be (H, W, 3 or 4) of uint8, or the path of a .png or .jpg, not {array.shape} of {array.dtype}")
    return array


_TEXTURES = ("base_color_texture", "metallic_roughness_texture", "normal_texture", "occlusion_texture", "emissive_texture")
_OF_MATERIAL = {"base_color": _fixed_color, "metallic": _part, "roughness": _part, "emissive": _fixed_color,
                "alpha_mode": _one_of("opaque", "mask", "blend"), "alpha_cutoff": _not_negative,
                "double_sided": _yes_or_no, "unlit": _yes_or_no, "opacity": _part, "specular": _not_negative, "shininess": _part,
                "emission": _not_negative, **dict.fromkeys(_TEXTURES, _texture)}


class Material:
    """glTF's metallic-roughness surface.

    base_color, emissive: display colours ('#rrggbb', names, 3 or 4 numbers in [0, 1]). Textures: (H, W, 3 or 4)
    of uint8, or a file (.png, .jpg), sRGB for base colour and emission. A Scene copies a texture when it first gets it. metallic,
    roughness, opacity: in [0, 1]; `opacity` multiplies alpha. specular, shininess, emission: only for the shader classic: how much light
    is mirrored, the exponent's part of 128, and how much of its colour shines by itself. Fields may be changed: scenes draw them
    as they are.
    """

    @raises_errors
    def __init__(self, base_color="white", *, metallic=0.0, roughness=1.0, emissive="black", alpha_mode="opaque",
                 alpha_cutoff=0.5, double_sided=True, unlit=False, opacity=1.0, specular=0.5, shininess=0.5, emission=0.0,
                 base_color_texture=None, metallic_roughness_texture=None, normal_texture=None, occlusion_texture=None,
                 emissive_texture=None):
        self.changes = object()  # another one after each change: tells scenes whether they have the latest
        self.base_color, self.metallic, self.roughness = base_color, metallic, roughness
        self.emissive, self.alpha_mode, self.alpha_cutoff = emissive, alpha_mode, alpha_cutoff
        self.double_sided, self.unlit, self.opacity = double_sided, unlit, opacity
        self.specular, self.shininess, self.emission = specular, shininess, emission
        self.base_color_texture, self.metallic_roughness_texture = base_color_texture, metallic_roughness_texture
        self.normal_texture, self.occlusion_texture, self.emissive_texture = normal_texture, occlusion_texture, emissive_texture

    @property
    def textures(self):
        """All five; None for each that is not set."""
        return tuple(getattr(self, name) for name in _TEXTURES)

    @raises_errors
    def __setattr__(self, name, value):
        is_field = name in _OF_MATERIAL
        object.__setattr__(self, name, _OF_MATERIAL[name](value, name) if is_field else value)
        if is_field:  # after the value, or a scene of another thread would take the one before for the latest
            object.__setattr__(self, "changes", object())

    def _made(self, textures):
        """The material of C++. `textures`: the numbers of its textures in the scene, -1 for none."""
        return _r.material(list(linear(_color(self.base_color, "base_color"))), self.metallic, self.roughness,
                           list(linear(_color(self.emissive, "emissive"))[:3]), self.alpha_mode, self.alpha_cutoff,
                           self.double_sided, self.unlit, self.opacity, [self.specular, self.shininess, self.emission], textures)


#: For errors: C++ messages name the fields of ScalarMapping; fields that ColorMapping calls otherwise are translated.
_FIELD = re.compile(r"^ScalarMapping::(\w+)")
_ARGUMENT = {"map": "cmap", "range": "clim", "logarithmic": "log", "isoline_px": "isoline_width"}


class ColorMapping:
    """Says how numbers become colours. Several things that share one ColorMapping share its range.

    cmap: a name (`color_maps()`; NAME_r is its reverse), a list of colours, or a colormap of matplotlib.
    clim: (low, high), None: from the least to the greatest finite number. log: equal factors become equal steps of colour.
    symmetric: puts 0 in the middle. steps: takes so many colours. categories: numbers that each get their own colour.
    below, above: colours of numbers beyond the range. nan: the colour where there is no number. opacity: (number, opacity)
    pairs, linear between them. isolines: numbers at which lines are drawn on meshes, across lines and along axes,
    isoline_width pixels wide; or about how many lines, at round numbers of the range that a Scene finds when it is made.
    docs/scalars.md has the details.
    """

    @raises_errors
    def __init__(self, cmap="viridis", clim=None, *, log=False, symmetric=False, steps=0, categories=(), below=None,
                 above=None, nan=(0.5, 0.5, 0.5), opacity=(), isolines=(), isoline_color="black", isoline_width=1.0):
        colors, discrete = _map(cmap)
        if clim is not None:
            clim = tuple(float(v) for v in clim)
            if len(clim) != 2:
                raise ArgumentError(f"clim: {clim!r} must be (low, high)")
        if not isinstance(steps, (int, np.integer)) or abs(int(steps)) >= 2**31:
            raise ArgumentError(f"steps: must be a whole number up to 65536, got {steps!r}")
        self.isoline_count, values = 0, ()
        if np.ndim(isolines) == 0:
            if isinstance(isolines, bool) or not isinstance(isolines, (int, np.integer)) or not 1 <= isolines <= 1000:
                raise ArgumentError(f"isolines: {isolines!r} must be numbers, or how many, from 1 to 1000")
            self.isoline_count = int(isolines)
        else:
            values = [float(v) for v in isolines]
        try:
            self._make(
                colors, discrete, clim, bool(log), bool(symmetric), int(steps), [float(v) for v in categories],
                None if below is None else list(_color(below, "below")),
                None if above is None else list(_color(above, "above")), list(_color(nan, "nan")),
                [(float(v), float(a)) for v, a in opacity], values,
                list(_color(isoline_color, "isoline_color")), float(isoline_width))
        except ArgumentError as e:
            raise ArgumentError(_FIELD.sub(lambda m: _ARGUMENT.get(m[1], m[1]), str(e))) from None

    def _make(self, *arguments):
        self._made, self._arguments = _r.mapping(*arguments), arguments

    def __getstate__(self):
        return self.isoline_count, self._arguments

    def __setstate__(self, state):
        self.isoline_count, arguments = state
        self._make(*arguments)

    def _add_to(self, scene, mappings):
        """Its number among the scene's. `mappings`: (mapping, number) of those that are there, by id()."""
        if id(self) not in mappings:
            mappings[id(self)] = self, len(mappings)
            scene.add_mapping(self._made)
        return mappings[id(self)][1]


def color_maps():
    """Returns the names of colour maps, without the reversed ones."""
    return list(_r.color_map_names())


def _map(cmap):
    """(colours, whether each has a part of the range for itself)"""
    if isinstance(cmap, str):
        try:
            return _r.color_map(cmap)
        except NotFoundError as e:  # no file is meant
            raise ArgumentError(f"cmap: {e}") from None
    if callable(cmap):  # matplotlib
        n = getattr(cmap, "N", 256)
        return [tuple(float(c) for c in cmap(i)) for i in range(n)], n < 64
    try:
        colors = list(cmap)
    except TypeError:
        raise ArgumentTypeError(f"cmap: must be a name, a list of colours or a colormap of matplotlib, not {cmap!r}") from None
    return [list(_color(c, "cmap")) for c in colors], False


def _look_color(value, name):
    return None if value is None else list(_color(value, name))


def _look_planes(value, name):
    planes = [] if len(value) == 0 else floats(value, name, (4,)).tolist()
    if len(planes) > 8:
        raise ArgumentError(f"{name}: at most 8 are drawn, not {len(planes)}")
    return planes


def _look_material(value, name):
    if value is not None and not isinstance(value, Material):
        raise ArgumentTypeError(f"{name}: must be a rastrum.Material, not {value!r}")
    return value


#: Checks and converts the fields of a thing's look for C++.
_LOOK = {"color": _look_color, "opacity": _part, "material": _look_material,
         "transform": lambda value, name: None if value is None else placement(value, name), "visible": _yes_or_no, "casts_shadows": _yes_or_no,
         "id": lambda value, name: None if value is None else whole(value, name, 0, 2**63 - 1),
         "winding": _one_of("counter_clockwise", "clockwise", "either"), "clip_planes": _look_planes}
#: The values with which C++ begins.
_PLAIN = {"color": None, "opacity": 1.0, "material": None, "transform": None, "visible": True, "casts_shadows": True, "id": None,
          "winding": "counter_clockwise", "clip_planes": ()}
_FIXED = (type(None), str, bool, int, float, np.generic)
#: An assignment to a thing's look and a frame's reading of it in place are one after the other.
_locks = {}


class _Thing:
    """A geometry placed in the world, with its own look.

    color: replaces the geometry's colours. opacity: in [0, 1]. transform: (4, 4) or (3, 4), from object to world.
    material: a Material. visible: False draws nothing, but keeps the ids. casts_shadows: False leaves it out of shadows. id:
    the number in `instance` pictures, by default its place in the scene. clip_planes: rows (x, y, z, d) in object space; only
    what lies at x X + y Y + z Z + d >= 0 is drawn. winding: counter_clockwise, clockwise or either.
    These may be changed, by assignment or in place: scenes read them for each frame.

    scalars: numbers that become colours: one for the whole thing, or one for each vertex, face, corner, point, sphere or
    disc. cmap: a ColorMapping, or a cmap for one; clim: (low, high), its range.

    Arrays are not copied where they can be drawn in place; copy=True always copies, copy=False raises
    ArgumentError with the reason where a copy would be needed. They are read anew for every frame.
    """

    _has_uv = False

    def __init__(self, *, scalars=None, cmap="viridis", clim=None, copy=None, **look):
        self.__dict__.update(_PLAIN, _look=_r.Look(), _in_place=frozenset())
        for name, value in look.items():
            if name not in _LOOK:
                self._refuse(name)
            setattr(self, name, value)
        mapping, one, each = None, None, None
        if scalars is not None:
            if isinstance(cmap, ColorMapping) and clim is not None:
                raise ArgumentError("clim: the ColorMapping already has a range")
            mapping = cmap if isinstance(cmap, ColorMapping) else ColorMapping(cmap, clim)
            if np.ndim(scalars) == 0:
                one = float(scalars)
            else:
                each = _scalars(scalars, "scalars", copy)
        self.__dict__.update(mapping=mapping, scalars=each, _scalar=one)

    def _make(self, kind, *arguments):
        """Makes the geometry by the function `kind` of C++; kept for pickle, too."""
        self._geometry, self._call = getattr(_r, kind)(*arguments), (kind, *arguments)

    def __getstate__(self):
        return {name: value for name, value in self.__dict__.items() if name not in ("_look", "_geometry", "_in_place")}

    def __setstate__(self, state):
        self.__dict__.update(state, _look=_r.Look(), _in_place=frozenset())
        for name in _LOOK:
            self._take(name, state[name])
        self._make(*self._call)

    def _refuse(self, name):
        import difflib
        import inspect
        known = [*inspect.signature(type(self).__init__).parameters, *_LOOK, "scalars", "cmap", "clim"]
        known = [k for k in known if k not in ("self", "look")]
        near = difflib.get_close_matches(name, known, 1)
        raise ArgumentTypeError(f"{type(self).__name__}: there is no {name!r}" + (f", {near[0]!r} perhaps" if near else "") +
                                f"; it takes {', '.join(known)}")

    def __setattr__(self, name, value):
        if name in _LOOK or name in ("scalars", "mapping"):
            self._take(name, value)
        else:
            object.__setattr__(self, name, value)

    @raises_errors
    def _take(self, name, value):
        if name not in _LOOK:
            raise ArgumentError(f"{name}: cannot be assigned; change its numbers in place, or make another thing")
        made = _LOOK[name](value, name)
        # Values that may change in place are read again before a frame; C++ reads a transform's own memory.
        fixed = isinstance(value, _FIXED) or isinstance(value, tuple) and all(isinstance(v, _FIXED) for v in value)
        with lock_in(_locks):
            if name != "material":  # each scene has its own number for it
                setattr(self._look, name, made)
            # A new set each time: another thread may be going through the old one.
            self._in_place = self._in_place - {name} if fixed or made is value else self._in_place | {name}
            object.__setattr__(self, name, value)

    def _read_in_place(self):
        """Reads the values again that may have changed in place."""
        for name in self._in_place:
            value = getattr(self, name)
            made = _LOOK[name](value, name)  # without the lock: a caller's class may run here
            with lock_in(_locks):
                if getattr(self, name) is value:  # else the assignment has set it
                    setattr(self._look, name, made)

    @property
    def primitives(self):
        """The number of primitives (triangles, points, segments, spheres, ...); each has an id."""
        return self._geometry.primitives


def _colors(value, copy):
    return None if value is None else _colors_of(value, copy)


def _positions(value, copy, name="positions"):
    array = floats(value, name, (3,), copy)
    if len(array) and not math.isfinite(array[0].sum()) and not np.isfinite(array).all(axis=1).any():
        warn(f"{name}: none of the {len(array)} is finite, so nothing is drawn of this thing")
    return array


_MANY = {"vertex": "vertices", "face": "faces", "corner": "corners"}


def _per(array, name, counts, said=None):
    """The kind of element that each value belongs to: `said`, or the one whose count fits. counts: of vertices, faces
    and corners."""
    n = 0 if array is None else len(array)
    if n == 0:
        return "vertex"
    fit = [kind for kind, count in counts.items() if n == count]
    if said is not None:
        if said not in fit:
            raise ArgumentError(f"{name}: {n} values for {counts[said]} {_MANY[said]}")
        return said
    if len(fit) > 1 and name in ("colors", "scalars"):
        raise ArgumentError(f"{name}: {n} values fit the {' or the '.join(_MANY[kind] for kind in fit)}; choose by "
                            f"per={' or per='.join(map(repr, fit))}")
    if not fit and n != 1:
        raise ArgumentError(f"{name}: {n} values for " + ", ".join(f"{count} {_MANY[kind]}" for kind, count in counts.items()))
    return fit[0] if fit else "mesh"


def _none(array):
    """Whether the array is given but empty, which means no primitives."""
    return array is not None and array.size == 0


class Mesh(_Thing):
    """Triangles, quads or polygons.

    positions: (N, 3). indices: (M, 3) triangles or (M, 4) quads, a flat array of three a triangle, or, with
    `offsets` (F + 1), the corners of polygons one after the other; None: every three positions are a triangle.
    normals (K, 3), uv (K, 2), colors (K, 3 or 4; floats in [0, 1] or uint8): K is the number of vertices, faces or
    corners. per: what colors and scalars belong to, "vertex", "face" or "corner"; give it where two of these have the same
    number (normals and uv then belong to the vertices). Without normals the mesh is shaded with face normals.
    """

    _prepared = False

    @raises_errors
    def __init__(self, positions, indices=None, *, offsets=None, normals=None, uv=None, colors=None, per=None, copy=None, **look):
        super().__init__(copy=copy, **look)
        positions = _positions(positions, copy)
        vertices, kind = len(positions), "triangles"
        if indices is not None:
            indices = integers(indices, "indices", copy)
            if offsets is not None:
                offsets, kind = integers(offsets, "offsets", copy), "polygons"
                indices = indices.reshape(-1)
            elif indices.ndim == 2:
                if indices.shape[1] not in (3, 4):
                    raise ArgumentError(f"indices: the shape is {indices.shape}; faces have 3 or 4 corners "
                                        "(others: `offsets`)")
                kind = "quads" if indices.shape[1] == 4 else "triangles"
        elif offsets is not None:
            raise ArgumentError("offsets: need indices beside them")
        if _none(indices) or _none(offsets):
            positions, indices = positions[:0], indices.reshape(-1)[:0]
            offsets = None if offsets is None else np.zeros(1, np.int64)
        corners = vertices if indices is None else indices.size
        size = 4 if kind == "quads" else 3
        if offsets is None and corners % size:
            raise ArgumentError(f"indices: {corners} corners are no whole number of {kind}")
        faces = len(offsets) - 1 if offsets is not None else corners // size
        normals = None if normals is None else floats(normals, "normals", (3,), copy)
        uv = None if uv is None else floats(uv, "uv", (2,), copy)
        colors = _colors(colors, copy)
        self._has_uv = uv is not None
        if per is not None:
            _one_of(*_MANY)(per, "per")
        counts = {"vertex": vertices, "face": faces, "corner": corners}
        if per != "corner" and (indices is None or corners == vertices and np.array_equal(indices.reshape(-1), np.arange(corners))):
            del counts["corner"]  # corners are the vertices
        self._make("mesh", positions, indices, kind, offsets, normals, _per(normals, "normals", counts), uv, _per(uv, "uv", counts),
                   colors, _per(colors, "colors", counts, per), self.scalars, _per(self.scalars, "scalars", counts, per))

    @raises_errors
    def prepare(self, threads=0):
        """Sorts the triangles into clusters, so that pictures can leave out hidden ones, and returns the mesh. No picture changes
        by a bit. It takes about as long as two pictures of the mesh.

        Positions and faces are copied: what changes in them later is not seen (other arrays are read anew for each
        picture). Scenes that were made of the mesh before draw it as it was. threads: 0: all.
        """
        name, positions, indices, kind, offsets, *attributes = self._call
        positions, indices, offsets = (None if a is None else np.array(a, order="C") for a in (positions, indices, offsets))
        self._make(name, positions, indices, kind, offsets, *attributes)
        self._geometry, self._prepared = self._geometry.prepared(int(threads)), True
        return self

    def __setstate__(self, state):
        super().__setstate__(state)
        if self._prepared:
            self.prepare()


def _one_or_each(value, name, copy):
    """(array, number): a number for all, or one each."""
    if np.ndim(value) == 0:
        return None, number(value, name, 0, 3.4e38)
    each = floats(value, name, None, copy)
    negative = int((each < 0).sum())
    if negative:
        warn(f"{name}: {negative} of {len(each)} are negative, which are not drawn")
    return each, 1.0


class Points(_Thing):
    """Squares or discs of `size` pixels (a number, or one for each point) around positions (N, 3)."""

    @raises_errors
    def __init__(self, positions, *, size=3.0, round=True, normals=None, colors=None, copy=None, **look):
        super().__init__(copy=copy, **look)
        sizes, size = _one_or_each(size, "size", copy)
        normals = None if normals is None else floats(normals, "normals", (3,), copy)
        self._make("points", _positions(positions, copy), normals, _colors(colors, copy), sizes, size, _yes_or_no(round, "round"),
                   self.scalars)


class Lines(_Thing):
    """Lines of `width` pixels. indices: (M, 2) segments; None: positions in order are one polyline, or with `offsets`
    (L + 1) several: line i goes through positions offsets[i] to offsets[i + 1]. colors: one for each position."""

    @raises_errors
    def __init__(self, positions, indices=None, *, offsets=None, width=1.0, colors=None, copy=None, **look):
        super().__init__(copy=copy, **look)
        polylines = indices is None
        if indices is not None:
            indices = integers(indices, "indices", copy)
        if offsets is not None:
            offsets, polylines = integers(offsets, "offsets", copy), True
        positions = _positions(positions, copy)
        if _none(indices) or _none(offsets):
            positions, indices, offsets = positions[:0], None, None
        self._make("lines", positions, indices, offsets, polylines, _colors(colors, copy), number(width, "width", 0, 3.4e38),
                   self.scalars)


class Spheres(_Thing):
    """Exact spheres around centers (N, 3). radius: a number, or one for each sphere."""

    @raises_errors
    def __init__(self, centers, radius=1.0, *, colors=None, copy=None, **look):
        super().__init__(copy=copy, **look)
        radii, radius = _one_or_each(radius, "radius", copy)
        self._make("spheres", _positions(centers, copy, "centers"), radii, radius, _colors(colors, copy), self.scalars)


class Cylinders(_Thing):
    """Cylinders between pairs of positions, or cones where the two radii differ. indices: (M, 2)."""

    @raises_errors
    def __init__(self, positions, indices=None, radius=1.0, *, caps=True, colors=None, copy=None, **look):
        super().__init__(copy=copy, **look)
        radii, radius = _one_or_each(radius, "radius", copy)
        indices = None if indices is None else integers(indices, "indices", copy)
        positions = _positions(positions, copy)
        if _none(indices):
            positions, indices = positions[:0], None
        self._make("cylinders", positions, indices, radii, radius, _colors(colors, copy), _yes_or_no(caps, "caps"), self.scalars)


class Tubes(_Thing):
    """Polylines with round joints and ends. offsets: (L + 1), as in Lines."""

    @raises_errors
    def __init__(self, positions, offsets=None, radius=1.0, *, colors=None, copy=None, **look):
        super().__init__(copy=copy, **look)
        radii, radius = _one_or_each(radius, "radius", copy)
        offsets = None if offsets is None else integers(offsets, "offsets", copy)
        positions = _positions(positions, copy)
        if _none(offsets):
            positions, offsets = positions[:0], None
        self._make("tubes", positions, offsets, radii, radius, _colors(colors, copy), self.scalars)


class Discs(_Thing):
    """Flat discs around centers (N, 3). Their fronts face along normals (N, 3)."""

    @raises_errors
    def __init__(self, centers, normals, radius=1.0, *, colors=None, copy=None, **look):
        super().__init__(copy=copy, **look)
        radii, radius = _one_or_each(radius, "radius", copy)
        self._make("discs", _positions(centers, copy, "centers"), floats(normals, "normals", (3,), copy), radii, radius,
                   _colors(colors, copy), self.scalars)


@raises_errors
def crease_normals(positions, indices, degrees=40.0):
    """Returns (3 M, 3) float32: a normal for each corner of (M, 3) triangles over (N, 3) positions, smooth where faces meet at no
    more than so many degrees. Corners at one place count as one. Files without normals get the same ones. Give the result to a Mesh as `normals`.
    """
    corners = integers(indices, "indices").reshape(-1)
    if corners.size % 3:
        raise ArgumentError(f"indices: {corners.size} corners are no whole number of triangles")
    if corners.size and not 0 <= corners.min() <= corners.max() < 2**32:
        raise ArgumentError(f"indices: {corners.min()} to {corners.max()} cannot be indices of vertices")
    normals = np.empty((corners.size, 3), np.float32)
    _r.crease_normals(np.ascontiguousarray(floats(positions, "positions", (3,)), np.float32), corners.astype(np.uint32),
                      float(degrees), normals)
    return normals
