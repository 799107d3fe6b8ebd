"""What is drawn: geometries over arrays, materials, scenes."""

import os
import re

import numpy as np

from . import _rastrum as _r
from . import _readers
from ._arrays import color as _color
from ._arrays import floats, integers, linear, matrix, scalars as _scalars
from ._errors import ArgumentError, ArgumentTypeError, NotFoundError, raises_errors


class Material:
    """glTF's metallic-roughness surface.

    base_color, emissive: display colours ('#rrggbb', names, 3 or 4 numbers in [0, 1]). Textures: (H, W, 3 or 4)
    of uint8, sRGB for base colour and emission, copied. `opacity` multiplies the alpha of all that has it.
    """

    @raises_errors
    def __init__(self, base_color="white", *, metallic=0.0, roughness=1.0, emissive="black", alpha_mode="opaque",
                 alpha_cutoff=0.5, double_sided=True, unlit=False, opacity=1.0, base_color_texture=None,
                 metallic_roughness_texture=None, normal_texture=None, occlusion_texture=None,
                 emissive_texture=None):
        self.base_color, self.metallic, self.roughness = base_color, metallic, roughness
        self.emissive, self.alpha_mode, self.alpha_cutoff = emissive, alpha_mode, alpha_cutoff
        self.double_sided, self.unlit, self.opacity = double_sided, unlit, opacity
        self.textures = (base_color_texture, metallic_roughness_texture, normal_texture, occlusion_texture,
                         emissive_texture)

    def _add_to(self, scene, textures):
        """Its number among the scene's. `textures`: how many there are by now, a list of one."""
        numbers = []
        for t in self.textures:
            if t is None:
                numbers.append(-1)
                continue
            scene.add_texture(np.asarray(t))
            numbers.append(textures[0])
            textures[0] += 1
        scene.add_material(_r.material(
            list(linear(_color(self.base_color, "base_color"))), self.metallic, self.roughness,
            list(linear(_color(self.emissive, "emissive"))[:3]), self.alpha_mode, self.alpha_cutoff,
            self.double_sided, self.unlit, self.opacity, numbers))


#: What C++ calls the arguments of ColorMapping.
_FIELD = re.compile(r"^ScalarMapping::(\w+)")
_ARGUMENT = {"map": "cmap", "range": "clim", "logarithmic": "log", "isoline_px": "isoline_width"}


class ColorMapping:
    """How numbers become colours; give one to several things, and one range holds for all of them.

    cmap: a name (`color_maps()`; NAME_r is its reverse), a list of colours, or one of matplotlib's colormaps.
    clim: (low, high), None: from the least to the greatest finite number. log: by factors. symmetric: 0 in the middle.
    steps: so many colours. categories: numbers that have a colour each. below, above, nan: colours beyond the range and
    of what is no number. opacity: (number, opacity) pairs, linear between. isolines: numbers where lines are drawn on
    meshes, across lines and along axes, isoline_width pixels wide; or about how many, at round numbers of the range that
    a Scene finds when it is made. The picture: docs/scalars.md.
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
            self._made = _r.mapping(
                colors, discrete, clim, bool(log), bool(symmetric), int(steps), [float(v) for v in categories],
                None if below is None else list(_color(below, "below")),
                None if above is None else list(_color(above, "above")), list(_color(nan, "nan")),
                [(float(v), float(a)) for v, a in opacity], values,
                list(_color(isoline_color, "isoline_color")), float(isoline_width))
        except ArgumentError as e:
            raise ArgumentError(_FIELD.sub(lambda m: _ARGUMENT.get(m[1], m[1]), str(e))) from None

    def _add_to(self, scene, mappings):
        """Its number among the scene's. `mappings`: (mapping, number) of those that are there, by id()."""
        if id(self) not in mappings:
            mappings[id(self)] = self, len(mappings)
            scene.add_mapping(self._made)
        return mappings[id(self)][1]


def color_maps():
    """The names of colour maps, without the reversed ones."""
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
        raise ArgumentTypeError(f"cmap: must be a name, colours or a map of matplotlib's, not {cmap!r}") from None
    return [list(_color(c, "cmap")) for c in colors], False


class _Thing:
    """A geometry placed in the world, with a look of its own.

    color: stands for the geometry's colours. opacity in [0, 1]. transform: (4, 4) or (3, 4), object to world.
    material: a Material. visible: what is not draws nothing and keeps its ids. id: what `instance` pictures hold of
    it, its place in the scene by default. clip_planes: rows (x, y, z, d) in object space; kept is what has
    x X + y Y + z Z + d >= 0. winding: counter_clockwise, clockwise or either.

    scalars: numbers that become colours instead: one for all of it, or one a vertex, face, corner, point, sphere or
    disc. cmap: a ColorMapping, or what that takes; clim: (low, high), its range.

    Arrays are not copied where they can be drawn in place; copy=True always copies, copy=False raises
    ArgumentError with the reason where a copy would be needed. They are read anew for every frame.
    """

    def __init__(self, *, color=None, opacity=1.0, material=None, transform=None, visible=True, id=None,
                 winding="counter_clockwise", clip_planes=(), scalars=None, cmap="viridis", clim=None, copy=None):
        self.color, self.opacity, self.material = color, opacity, material
        self.transform, self.visible, self.id = transform, visible, id
        self.winding, self.clip_planes = winding, clip_planes
        self.scalars, self.mapping, self._scalar = None, None, None
        if scalars is None:
            return
        if isinstance(cmap, ColorMapping) and clim is not None:
            raise ArgumentError("clim: the range is the ColorMapping's")
        self.mapping = cmap if isinstance(cmap, ColorMapping) else ColorMapping(cmap, clim)
        if np.ndim(scalars) == 0:
            self._scalar = float(scalars)
        else:
            self.scalars = _scalars(scalars, "scalars", copy)

    def _add_to(self, scene, materials, mappings):
        mapping = 0
        if self.mapping is not None:
            mapping = self.mapping._add_to(scene, mappings)
        transform = None if self.transform is None else matrix(self.transform, "transform")
        color = None if self.color is None else list(_color(self.color, "color"))
        if self.material is not None and not isinstance(self.material, Material):
            raise ArgumentTypeError("material: must be a rastrum.Material")
        planes = [] if len(self.clip_planes) == 0 else floats(self.clip_planes, "clip_planes", (4,)).tolist()
        scene.add(self._geometry, transform, float(self.opacity), color, materials.get(id(self.material)),
                  bool(self.visible), self.winding, self.id, planes, self._scalar, mapping)

    @property
    def primitives(self):
        """Triangles, points, segments, spheres, ...: what has an id."""
        return self._geometry.primitives


def _colors(value, copy):
    return None if value is None else floats(value, "colors", (3, 4), copy, normalized=True)


def _per(array, name, vertices, corners, faces):
    """Whose values these are, by how many there are."""
    if array is None:
        return "vertex"
    n = len(array)
    for kind, count in (("vertex", vertices), ("face", faces), ("corner", corners), ("mesh", 1)):
        if n == count:
            return kind
    raise ArgumentError(f"{name}: {n} values for {vertices} vertices, {faces} faces and {corners} corners")


class Mesh(_Thing):
    """Triangles, quads or polygons.

    positions: (N, 3). indices: (M, 3) triangles or (M, 4) quads, a flat array of three a triangle, or, with
    `offsets` (F + 1), the corners of polygons one after the other; None: every three positions are a triangle.
    normals (K, 3), uv (K, 2), colors (K, 3 or 4; floats in [0, 1] or uint8): K is the number of vertices, faces or
    corners. Shaded with face normals where it has none.
    """

    @raises_errors
    def __init__(self, positions, indices=None, *, offsets=None, normals=None, uv=None, colors=None, copy=None, **look):
        super().__init__(copy=copy, **look)
        positions = floats(positions, "positions", (3,), copy)
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
            raise ArgumentError("offsets: want indices")
        corners = vertices if indices is None else indices.size
        size = 4 if kind == "quads" else 3
        if offsets is None and corners % size:
            raise ArgumentError(f"indices: {corners} corners are no whole number of {kind}")
        faces = len(offsets) - 1 if offsets is not None else corners // size
        normals = None if normals is None else floats(normals, "normals", (3,), copy)
        uv = None if uv is None else floats(uv, "uv", (2,), copy)
        colors = _colors(colors, copy)
        counts = vertices, corners, faces
        self._faces = positions, indices, kind, offsets
        self._attributes = (normals, _per(normals, "normals", *counts), uv, _per(uv, "uv", *counts), colors,
                            _per(colors, "colors", *counts), self.scalars, _per(self.scalars, "scalars", *counts))
        self._geometry = _r.mesh(*self._faces, *self._attributes)

    @raises_errors
    def prepare(self, threads=0):
        """Makes the mesh ready for many pictures, and returns it: clusters of its triangles, which pictures leave out
        where they are not seen. No picture changes by a bit. Takes about as long as two pictures of it.

        Positions and faces are copied: what changes in them later is not seen (other arrays are read anew for each
        picture). Scenes that were made of the mesh before draw it as it was. threads: 0: all.
        """
        positions, indices, kind, offsets = self._faces
        self._faces = (*(None if a is None else np.array(a, order="C") for a in (positions, indices)), kind,
                       None if offsets is None else np.array(offsets, order="C"))
        geometry = _r.mesh(*self._faces, *self._attributes)
        geometry.prepare(int(threads))
        self._geometry = geometry
        return self


def _one_or_each(value, name, copy):
    """(array, number): a number for all, or one each."""
    if np.ndim(value) == 0:
        return None, float(value)
    return floats(value, name, None, copy), 1.0


class Points(_Thing):
    """Squares or discs of `size` pixels (a number, or one a point) about their positions (N, 3)."""

    @raises_errors
    def __init__(self, positions, *, size=3.0, round=True, normals=None, colors=None, copy=None, **look):
        super().__init__(copy=copy, **look)
        sizes, size = _one_or_each(size, "size", copy)
        normals = None if normals is None else floats(normals, "normals", (3,), copy)
        self._geometry = _r.points(floats(positions, "positions", (3,), copy), normals, _colors(colors, copy), sizes,
                                   size, round, self.scalars)


class Lines(_Thing):
    """Lines of `width` pixels. indices: (M, 2) segments; None: positions in order are one polyline, or with `offsets`
    (L + 1) several: line i goes through positions offsets[i] to offsets[i + 1]. colors: one a position."""

    @raises_errors
    def __init__(self, positions, indices=None, *, offsets=None, width=1.0, colors=None, copy=None, **look):
        super().__init__(copy=copy, **look)
        polylines = indices is None
        if indices is not None:
            indices = integers(indices, "indices", copy)
        if offsets is not None:
            offsets, polylines = integers(offsets, "offsets", copy), True
        self._geometry = _r.lines(floats(positions, "positions", (3,), copy), indices, offsets, polylines,
                                  _colors(colors, copy), float(width), self.scalars)


class Spheres(_Thing):
    """Exact spheres about centers (N, 3); radius: a number, or one a sphere."""

    @raises_errors
    def __init__(self, centers, radius=1.0, *, colors=None, copy=None, **look):
        super().__init__(copy=copy, **look)
        radii, radius = _one_or_each(radius, "radius", copy)
        self._geometry = _r.spheres(floats(centers, "centers", (3,), copy), radii, radius, _colors(colors, copy),
                                    self.scalars)


class Cylinders(_Thing):
    """Cylinders between pairs of positions, cones where the radii of the two differ. indices: (M, 2)."""

    @raises_errors
    def __init__(self, positions, indices=None, radius=1.0, *, caps=True, colors=None, copy=None, **look):
        super().__init__(copy=copy, **look)
        radii, radius = _one_or_each(radius, "radius", copy)
        indices = None if indices is None else integers(indices, "indices", copy)
        self._geometry = _r.cylinders(floats(positions, "positions", (3,), copy), indices, radii, radius,
                                      _colors(colors, copy), caps, self.scalars)


class Tubes(_Thing):
    """Polylines with round joints and ends; offsets (L + 1) as Lines has them."""

    @raises_errors
    def __init__(self, positions, offsets=None, radius=1.0, *, colors=None, copy=None, **look):
        super().__init__(copy=copy, **look)
        radii, radius = _one_or_each(radius, "radius", copy)
        offsets = None if offsets is None else integers(offsets, "offsets", copy)
        self._geometry = _r.tubes(floats(positions, "positions", (3,), copy), offsets, radii, radius,
                                  _colors(colors, copy), self.scalars)


class Discs(_Thing):
    """Flat discs about centers (N, 3), their fronts where normals (N, 3) point to."""

    @raises_errors
    def __init__(self, centers, normals, radius=1.0, *, colors=None, copy=None, **look):
        super().__init__(copy=copy, **look)
        radii, radius = _one_or_each(radius, "radius", copy)
        self._geometry = _r.discs(floats(centers, "centers", (3,), copy), floats(normals, "normals", (3,), copy), radii,
                                  radius, _colors(colors, copy), self.scalars)


class Scene:
    """Things drawn together, in this order: ids count their primitives one after the other.

    A path may be "builtin:SHAPE" or "builtin:SHAPE?key=value&...", a procedural shape as the program has it (`rastrum make
    --help` lists them).

    crease: meshes of files without normals are smooth where their faces meet at no more than this angle (degrees);
    180: everywhere; None: nowhere. scalars: which numbers of files become colours, by name; x, y, z and distance are made
    where no file has them. cmap, clim: as things have them.
    """

    @raises_errors
    def __init__(self, things=(), copy=None, crease=40.0, *, scalars=None, cmap="viridis", clim=None):
        self.files, self.things = [], []
        self._made = _r.Scene()
        materials, mappings, textures, others = {}, {}, [0], []
        for thing in _flat(things, copy):
            if isinstance(thing, (str, os.PathLike)):
                path = os.fspath(thing)
                builtin = path.startswith("builtin:")
                if not builtin and not os.path.exists(path):
                    raise NotFoundError(f"{path}: there is no such file")
                if builtin or not _readers.reads(path):
                    self._made.add_file(path, crease)
                    self.files.append(path)
                    continue
                others.append(path)
                for made in self._read(path, copy, scalars, cmap, clim):
                    made._add_to(self._made, materials, mappings)
                    self.things.append(made)
                continue
            material = thing.material
            if isinstance(material, Material) and id(material) not in materials:
                material._add_to(self._made, textures)
                materials[id(material)] = len(materials)
            thing._add_to(self._made, materials, mappings)
            self.things.append(thing)
        if scalars is not None and (self.files or not others):
            self._show(scalars, cmap, clim, mappings)
        for mapping, number in mappings.values():
            if mapping.isoline_count:
                self._made.spread_isolines(number, mapping.isoline_count)

    @staticmethod
    def _read(path, copy, scalars, cmap, clim):
        """The things of a file that another library reads. Its meshes lie in memory that nobody changes."""
        from . import _others, _surface  # as below: a script's time, which files of our own do not need

        read = _readers.read(path)
        simulation = hasattr(read, "GetPolys") or hasattr(read, "cell_data")
        if not simulation:
            return _others.things_of(read, copy)
        if scalars is not None and not isinstance(scalars, str):
            raise ArgumentTypeError(f"scalars: of files they have a name, {scalars!r} is none")
        return (_others.of_vtk if hasattr(read, "GetPolys") else _surface.things_of)(read, copy, scalars, cmap, clim)

    def _show(self, scalars, cmap, clim, mappings):
        if not isinstance(scalars, str):
            raise ArgumentTypeError(f"scalars: of files they have a name, {scalars!r} is none")
        if not self.files:
            raise ArgumentError("scalars: names numbers of files, and there are none; a Mesh takes them itself")
        if isinstance(cmap, ColorMapping) and clim is not None:
            raise ArgumentError("clim: the range is the ColorMapping's")
        mapping = cmap if isinstance(cmap, ColorMapping) else ColorMapping(cmap, clim)
        self._made.show_scalars(scalars, mapping._add_to(self._made, mappings))

    @property
    def primitives(self):
        return self._made.primitives

    @property
    def instances(self):
        return self._made.instances

    @property
    def warnings(self):
        """What readers of files left out or found odd."""
        return list(self._made.warnings)

    @property
    def bounds(self):
        """((x, y, z), (x, y, z)) of all that is finite, in the world; None where nothing is."""
        found = self._made.bounds()
        return None if found is None else tuple(tuple(corner) for corner in found)


def load(path, *, crease=40.0, scalars=None, cmap="viridis", clim=None):
    """The scene of a file (.obj .ply .stl .off .gltf .glb, .npy of triangles; .vtp .vtu .vti .vts .vtr .vtk where the vtk wheel is installed,
    what trimesh reads where that is); crease, scalars, cmap, clim: as Scene has them."""
    return Scene([path], crease=crease, scalars=scalars, cmap=cmap, clim=clim)


def _flat(what, copy=None):
    """Things and paths, one after the other."""
    if isinstance(what, (_Thing, str, os.PathLike)):
        yield what
        return
    from . import _others

    if isinstance(what, Scene):
        raise ArgumentTypeError("a Scene inside of another: give its things")
    elif (made := _others.things_of(what, copy)) is not None:
        yield from made
    elif isinstance(what, tuple) and len(what) == 2 and all(np.ndim(a) == 2 for a in what):
        yield Mesh(*what, copy=copy)
    elif isinstance(what, (list, tuple)):
        for thing in what:
            yield from _flat(thing, copy)
    else:
        raise ArgumentTypeError(f"{type(what).__module__}.{type(what).__qualname__}: nothing that can be drawn; take a path, "
                                "(vertices, faces), a rastrum.Mesh or its kin, a mesh or cloud of trimesh, PyVista, VTK, meshio or Open3D, a "
                                "shape of build123d or CadQuery, or a list of these")


@raises_errors
def as_scene(what, copy=None):
    """The Scene of a path, (vertices, faces), things of this package, meshes and scenes of trimesh, PyVista, VTK and
    Open3D, shapes of build123d and CadQuery, or a list of these. What is no rastrum.Scene is made one."""
    return what if isinstance(what, Scene) else Scene(what, copy)


@raises_errors
def crease_normals(positions, indices, degrees=40.0):
    """(3 M, 3) float32: a normal for each corner of (M, 3) triangles over (N, 3) positions, smooth where faces meet at no
    more than so many degrees. Corners at one place count as one. As files without normals have them; `normals` of a Mesh.
    """
    corners = integers(indices, "indices").reshape(-1)
    if corners.size % 3:
        raise ArgumentError(f"indices: {corners.size} corners are no whole number of triangles")
    if corners.size and not 0 <= corners.min() <= corners.max() < 2**32:
        raise ArgumentError(f"indices: {corners.min()} to {corners.max()} are no indices of vertices")
    normals = np.empty((corners.size, 3), np.float32)
    _r.crease_normals(np.ascontiguousarray(floats(positions, "positions", (3,)), np.float32), corners.astype(np.uint32),
                      float(degrees), normals)
    return normals
