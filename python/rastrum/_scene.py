# SPDX-License-Identifier: BSD-3-Clause
"""Scenes: things of any kind that are drawn together."""

import os

import numpy as np

from . import _rastrum as _r
from . import _others, _readers, _surface
from ._errors import ArgumentError, ArgumentTypeError, NotFoundError, raises_errors, warn
from ._files import shallow
from ._locks import lock_in
from ._things import ColorMapping, Mesh, _Thing


class Scene:
    """Things that are drawn together. ids count their primitives one after the other, in this order.

    A path may be "builtin:SHAPE" or "builtin:SHAPE?key=value&...", a procedural shape as the program has it (`rastrum make
    --help` lists them).

    A Scene may be kept: each frame draws its things with the places, looks and arrays that they have at that time.
    pickle carries things with their arrays. Files of our own readers are read again where it arrives, from the same absolute paths.

    crease: meshes of files without normals are smooth where their faces meet at no more than this angle (degrees);
    180: everywhere; None: nowhere. scalars: the name of the files' numbers that become colours; x, y, z and distance are
    computed if no file has them. cmap, clim: as for things. memory_limit: how many bytes of memory a file may take on top of
    64 times its size (None: 1 GiB). allow_outside: whether files may name other files outside of their folders.
    """

    @raises_errors
    def __init__(self, things=(), copy=None, crease=40.0, *, scalars=None, cmap="viridis", clim=None, memory_limit=None,
                 allow_outside=True):
        self.files, self.things = [], []
        options = {"crease": crease, "scalars": scalars, "cmap": cmap, "clim": clim, "memory_limit": memory_limit,
                   "allow_outside": allow_outside}
        self._call = [], options  # for pickle: things and absolute paths in their order
        self._read_from = ()  # absolute, because the process may change its folder
        self._made = _r.Scene()
        self._locks = {}  # of _read_again
        # By id(): (material, C++'s of it, the changes that this has), in the order of their numbers; (texture, its number).
        self._materials, self._textures = {}, {}
        self._material_of = []  # for each thing
        mappings, others = {}, []
        for thing in _flat(things, copy):
            if isinstance(thing, (str, os.PathLike)):
                path = os.fspath(thing)
                builtin = path.startswith("builtin:")
                if not builtin and not os.path.exists(path):
                    raise NotFoundError(f"{path}: there is no such file")
                if not builtin:
                    self._read_from += (os.path.abspath(path),)
                if builtin or not _readers.reads(path):
                    self._call[0].append(path if builtin else os.path.abspath(path))
                    self._made.add_file(path, crease, memory_limit, bool(allow_outside))
                    self.files.append(path)
                    continue
                others.append(path)
                made = self._read(path, copy, scalars, cmap, clim)
            else:
                made = [thing]
            for thing in made:
                mapping = 0 if thing.mapping is None else thing.mapping._add_to(self._made, mappings)
                self._made.add(thing._geometry, thing._look, thing._scalar, mapping)
                self.things.append(thing)
                self._call[0].append(thing)
                self._material_of.append(None)
        self._read_again()
        if scalars is not None and (self.files or not others):
            self._show(scalars, cmap, clim, mappings)
        elif others:
            options.update(scalars=None, clim=None)  # the things have them
        for mapping, number in mappings.values():
            if mapping.isoline_count:
                self._made.spread_isolines(number, mapping.isoline_count)

    def __reduce__(self):
        return _made_again, (type(self), *self._call, self._read_from)

    def __copy__(self):
        return shallow(self)

    def _read_again(self):
        """Reads the looks of the things as they are now. Threads that draw the scene take turns here."""
        with lock_in(self._locks):
            for thing in self.things:
                thing._read_in_place()
            self._read_materials()

    def _read_materials(self):
        wanted = [thing.material for thing in self.things]
        if (all(now is before for now, before in zip(wanted, self._material_of)) and
                all(material.changes is changes for material, _, changes in self._materials.values())):
            return
        made = {}
        for material in wanted:
            if material is None or id(material) in made:
                continue
            changes = material.changes  # before the fields: a later change is for the next frame
            known = self._materials.get(id(material))
            if known is None or known[2] is not changes:
                known = material, material._made([-1 if t is None else self._texture(t) for t in material.textures]), changes
            made[id(material)] = known
        for thing, now, before in zip(self.things, wanted, self._material_of):
            if now is not before and now is not None and not thing._has_uv and any(t is not None for t in now.textures):
                warn(f"material: its textures are not drawn on a {type(thing).__name__} without uv")
        numbers = {key: number for number, key in enumerate(made)}
        # At once, so that no other thread's frame has the materials of before and the things of now.
        self._made.set_materials([material for _, material, _ in made.values()],
                                 [None if material is None else numbers[id(material)] for material in wanted])
        self._materials, self._material_of = made, wanted

    def _texture(self, pixels):
        if id(pixels) not in self._textures:
            self._textures[id(pixels)] = pixels, self._made.add_texture(pixels)
        return self._textures[id(pixels)][1]

    @staticmethod
    def _read(path, copy, scalars, cmap, clim):
        """The things of a file that another library reads."""
        read = _readers.read(path)
        simulation = hasattr(read, "GetPolys") or hasattr(read, "cell_data")
        if not simulation:
            return _others.things_of(read, copy)
        if scalars is not None and not isinstance(scalars, str):
            raise ArgumentTypeError(f"scalars: must be a name for files, not {scalars!r}")
        return (_others.of_vtk if hasattr(read, "GetPolys") else _surface.things_of)(read, copy, scalars, cmap, clim)

    def _show(self, scalars, cmap, clim, mappings):
        if not isinstance(scalars, str):
            raise ArgumentTypeError(f"scalars: must be a name for files, not {scalars!r}")
        if not self.files:
            raise ArgumentError("scalars: names the numbers of files, but there is no file; give a Mesh its scalars itself")
        if isinstance(cmap, ColorMapping) and clim is not None:
            raise ArgumentError("clim: the ColorMapping already has a range")
        mapping = cmap if isinstance(cmap, ColorMapping) else ColorMapping(cmap, clim)
        self._made.show_scalars(scalars, mapping._add_to(self._made, mappings))

    @property
    def primitives(self):
        """The number of primitives."""
        return self._made.primitives

    @property
    def instances(self):
        """The number of instances: the parts of files, and things."""
        return self._made.instances

    @property
    def warnings(self):
        """Sentences about data that the readers of files left out or found odd."""
        return list(self._made.warnings)

    @property
    def bounds(self):
        """The box ((x, y, z), (x, y, z)) of all finite vertices in the world; None if there are none."""
        self._read_again()
        found = self._made.bounds()
        return None if found is None else tuple(tuple(corner) for corner in found)


def _made_again(kind, things, options, read_from):
    scene = kind(things, **options)
    scene._read_from = read_from
    return scene


def load(path, *, crease=40.0, scalars=None, cmap="viridis", clim=None, memory_limit=None, allow_outside=True):
    """Returns the scene of a file (.obj .ply .stl .off .gltf .glb, .npy of triangles; .vtp .vtu .vti .vts .vtr .vtk where the vtk wheel is installed,
    and other files if trimesh is installed). The other parameters are those of Scene."""
    return Scene([path], crease=crease, scalars=scalars, cmap=cmap, clim=clim, memory_limit=memory_limit,
                 allow_outside=allow_outside)


def _flat(what, copy=None):
    """Things and paths, one after the other."""
    if isinstance(what, (_Thing, str, os.PathLike)):
        yield what
        return
    if isinstance(what, Scene):
        raise ArgumentTypeError("a Scene cannot hold another Scene: give the things of that one")
    elif (made := _others.things_of(what, copy)) is not None:
        yield from made
    elif isinstance(what, tuple) and len(what) == 2 and all(np.ndim(a) == 2 for a in what):
        yield Mesh(*what, copy=copy)
    elif isinstance(what, (list, tuple)):
        for thing in what:
            yield from _flat(thing, copy)
    else:
        raise ArgumentTypeError(f"{type(what).__module__}.{type(what).__qualname__}: cannot be drawn; take a path, "
                                "(vertices, faces), a rastrum.Mesh or its kin, a mesh or cloud of trimesh, PyVista, VTK, meshio or Open3D, a "
                                "shape of build123d or CadQuery, or a list of these")


@raises_errors
def as_scene(what, copy=None):
    """Returns the Scene of a path, (vertices, faces), things of this package, meshes and scenes of trimesh, PyVista, VTK and
    Open3D, shapes of build123d and CadQuery, or a list of these. A rastrum.Scene is returned as it is."""
    if not isinstance(what, Scene):
        return Scene(what, copy)
    what._read_again()
    return what
