# SPDX-License-Identifier: BSD-3-Clause
"""mujoco.Renderer without OpenGL: `from rastrum.compat.mujoco import Renderer`.

It takes what MuJoCo's own visualizer puts into an MjvScene, which needs no OpenGL, and has the interface of mujoco.Renderer.
Besides, render_all() gives colours, depth and segmentation of one frame at once, and render_batch() those of many states. Light
is that of OpenGL's fixed pipeline (the shader classic), at each pixel. Not drawn, and listed by `left_out`: haze, fog and
labels.
"""

import concurrent.futures
import copy
import ctypes
import functools
import math
import threading

import numpy as np

import mujoco

from .. import _things as _t
from .._arrays import product as _product
from .._camera import Camera as _Camera
from .._camera import _of_matrix
from .._errors import ArgumentError, UnsupportedError
from .._lights import Light as _Light
from .._render import Renderer as _Renderer
from .._scene import Scene as _Scene

__all__ = ["Renderer"]

_PLANE, _HFIELD, _SPHERE, _CAPSULE, _ELLIPSOID, _CYLINDER, _BOX, _MESH, _SDF = range(9)
_ARROW, _ARROW1, _ARROW2, _LINE, _LINEBOX, _FLEX, _SKIN, _LABEL, _TRIANGLE = range(100, 109)
_FLAGS = mujoco.mjtRndFlag
_LARGE = 500  # triangles
_MOST_SHAPES = 1000
_SEETHROUGH = 0.995  # MuJoCo draws geoms below this alpha as translucent


def _unit(v):
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-30)


# Lists of numbers: NumPy takes longer for so few.

def _cross(a, b):
    (ax, ay, az), (bx, by, bz) = a, b
    return [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx]


def _dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _of_length_1(v):
    length = max(math.sqrt(_dot(v, v)), 1e-30)
    return [x / length for x in v]


def _kind_of(light):
    """Lights had no type before 3.3."""
    if not hasattr(light, "type"):
        return "directional" if light.directional else "spot"
    kinds = mujoco.mjtLightType
    return {kinds.mjLIGHT_DIRECTIONAL.value: "directional", kinds.mjLIGHT_SPOT.value: "spot"}.get(light.type, "point")


def _seen_by(projection, view):
    """Camera.opengl without its checks."""
    columns = list(zip(*view))
    seen = [[a * x + b * y + c * z + d * w for x, y, z, w in columns] for a, b, c, d in projection]
    return _Camera(functools.partial(_of_matrix, np.array(seen), "opengl"))


# Geometry in a geom's own frame: (positions, faces, normals, coordinates for textures); the last are those of a shape of size 1.

def _ball(slices, stacks):
    """A ball as MuJoCo has it: 2 * stacks rows of faces."""
    rings = np.arange(-stacks + 1, stacks) * (math.pi / 2 / stacks)
    around = np.arange(slices) * (2 * math.pi / slices)
    ring = np.stack([np.outer(np.cos(rings), np.cos(around)), np.outer(np.cos(rings), np.sin(around)),
                     np.outer(np.sin(rings), np.ones(slices))], -1).reshape(-1, 3)
    points = np.concatenate([[[0, 0, -1]], ring, [[0, 0, 1]]])
    j = np.arange(slices)
    k = (j + 1) % slices
    top, last = len(points) - 1, 1 + (len(rings) - 1) * slices
    faces = [np.stack([np.zeros(slices, int), 1 + k, 1 + j], 1), np.stack([np.full(slices, top), last + j, last + k], 1)]
    for i in range(len(rings) - 1):
        a, b = 1 + i * slices + j, 1 + i * slices + k
        faces += [np.stack([a, b, b + slices], 1), np.stack([a, b + slices, a + slices], 1)]
    return points, np.concatenate(faces)


def _capsule(ball, slices, stacks, size):
    points, faces = ball
    middle = 1 + (stacks - 1) * slices  # the first vertex of the equator, which both halves have
    scale, lift = np.array([size[0], size[1], (size[0] + size[1]) / 2]), [0, 0, size[2]]
    low, high = points[:middle + slices], points[middle:]
    j = np.arange(slices)
    k = (j + 1) % slices
    a, b = middle + j, middle + k
    c, d = len(low) + k, len(low) + j
    faces = np.concatenate([faces[(faces < middle + slices).all(1)], faces[(faces >= middle).all(1)] + len(low) - middle,
                            np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    return (np.concatenate([low * scale - lift, high * scale + lift]), faces, _unit(np.concatenate([low, high]) / scale),
            np.concatenate([low - [0, 0, 1], high + [0, 0, 1]]))


def _turned(slices, rows):
    """A surface of revolution: rows of (radius, z, radius, z, normal's z) between two rings."""
    around = np.arange(slices) * (2 * math.pi / slices)
    ring = np.stack([np.cos(around), np.sin(around), np.zeros(slices)], 1)
    j = np.arange(slices)
    k = (j + 1) % slices
    points, normals, faces = [], [], []
    for r0, z0, r1, z1, nz in rows:
        first = 2 * slices * len(faces)
        points += [ring * [r0, r0, 0] + [0, 0, z0], ring * [r1, r1, 0] + [0, 0, z1]]
        normals += [ring * (1 - abs(nz)) + [0, 0, nz]] * 2
        faces.append(first + np.concatenate([np.stack([j, k, slices + k], 1), np.stack([j, slices + k, slices + j], 1)]))
    return np.concatenate(points), np.concatenate(faces), np.concatenate(normals)


def _box():
    points, normals, faces = [], [], []
    for axis in range(3):
        for sign in (-1, 1):
            corner = np.zeros((4, 3))
            corner[:, axis] = sign
            corner[:, (axis + 1) % 3], corner[:, (axis + 2) % 3] = [-1, 1, 1, -1], [-1, -1, 1, 1]
            faces += [[len(points) * 4, len(points) * 4 + 1, len(points) * 4 + 2], [len(points) * 4, len(points) * 4 + 2, len(points) * 4 + 3]]
            points.append(corner if sign > 0 else corner[::-1])
            normals.append(np.tile(np.eye(3)[axis] * sign, (4, 1)))
    return np.concatenate(points), np.array(faces), np.concatenate(normals)


def _grid(x, y, z):
    """Faces of a grid whose columns go along x."""
    points = np.stack([np.broadcast_to(x, z.shape), np.broadcast_to(y[:, None], z.shape), z], -1).reshape(-1, 3)
    n = len(x)
    a = (np.arange(len(y) - 1)[:, None] * n + np.arange(n - 1)).reshape(-1)
    return points, np.concatenate([np.stack([a, a + 1, a + n + 1], 1), np.stack([a, a + n + 1, a + n], 1)])


def _memory(lights):
    """The memory of structures side by side, a row each, from the first one's `pos` on."""
    first, second = (light.pos.__array_interface__["data"][0] for light in lights[:2])
    return np.frombuffer((ctypes.c_ubyte * ((second - first) * len(lights))).from_address(first), np.uint8).reshape(len(lights), -1)


class _Geoms:
    """The geoms of an MjvScene as arrays over its memory: n rows of all bytes, and of some fields."""

    def __init__(self, scene):
        first, second = scene.geoms[0], scene.geoms[1]
        address = [g.pos.__array_interface__["data"][0] for g in (first, second)]
        stride = address[1] - address[0]
        # The offsets of fields of numbers are found by changing them. All that is looked at belongs to the first three geoms.
        window = (ctypes.c_ubyte * (2 * stride)).from_address(address[0])
        bytes_ = np.frombuffer(window, np.uint8)
        def offset(name):
            value, seen = getattr(second, name), []
            for other in (1, 2):
                setattr(second, name, other)
                seen.append(bytes_.copy())
            setattr(second, name, value)
            changed = np.flatnonzero(seen[0] != seen[1])
            if not changed.size:
                raise UnsupportedError(f"mujoco {mujoco.__version__}: the memory of its geoms is not understood; 3.2 to 4.0 were tried")
            return int(changed[0] - stride) // 4 * 4
        start = offset("type")
        raw = (ctypes.c_ubyte * (stride * scene.maxgeom)).from_address(address[0] + start)
        self.bytes = np.frombuffer(raw, np.uint8).reshape(scene.maxgeom, stride)
        def field(offset, dtype, *strides):
            return np.ndarray((scene.maxgeom, *(3 for _ in strides)), dtype, raw, offset - start, (stride, *strides))
        def offset_of(name):
            return getattr(first, name).__array_interface__["data"][0] - address[0]
        self.pos, self.mat = field(0, np.float32, 4), field(offset_of("mat"), np.float32, 12, 4)
        self.objid, self.objtype = field(offset("objid"), np.int32), field(offset("objtype"), np.int32)
        # What does not move: all but place, orientation and the distance to the camera.
        moving = np.zeros(stride, bool)
        for at, size in ((-start, 12), (offset_of("mat") - start, 36), (offset("camdist") - start, 4)):
            moving[at:at + size] = True
        self.fixed = np.flatnonzero(~moving)
        self._keep = scene


class Renderer:
    """Draws a MuJoCo model: mujoco.Renderer's interface.

    threads: None takes RASTRUM_NUM_THREADS or the cores that this process may use. samples: 1, 4, 8 or 16 a pixel for colours; None takes
    the model's visual.quality.offsamples. left_out: sentences about what the last picture asked for and does not show.
    """

    def __init__(self, model, height=240, width=320, max_geom=10000, font_scale=None, *, threads=None, samples=None):
        if not hasattr(model, "tex_nchannel"):
            raise UnsupportedError(f"mujoco {mujoco.__version__}: is older than 3.2, the first version whose scenes are drawn")
        buffer = model.vis.global_
        if width > buffer.offwidth or height > buffer.offheight:
            raise ArgumentError(f"Image size {width} x {height} is larger than the model's framebuffer, {buffer.offwidth} x "
                                f"{buffer.offheight}: raise offwidth and offheight of <visual><global>")
        self._model, self._height, self._width = model, int(height), int(width)
        self._scene = mujoco.MjvScene(model=model, maxgeom=max(3, max_geom or 10000))
        max_geom = self._scene.maxgeom
        self._option = mujoco.MjvOption()
        self._kind = "rgb"
        self._renderer = _Renderer(threads=threads)
        offered = model.vis.quality.offsamples
        self._samples = max(s for s in (1, 4, 8, 16) if s <= max(1, offered)) if samples is None else samples
        quality = model.vis.quality
        self._slices, self._stacks = quality.numslices, quality.numstacks
        self._unit_ball = _ball(self._slices, self._stacks)
        self._geoms = _Geoms(self._scene)
        self._places = np.tile(np.eye(4), (max_geom, 1, 1))  # things read their rows in place
        self._objects = np.empty((max_geom + 2, 2), np.int32)  # a row for the sky, too
        self._known = None  # (bytes of geoms, what soft things have of the scene) that _things are made of
        self._things, self._shapes, self._textures, self._scenes = [], {}, {}, {}
        self._light_bytes, self._lit = _memory(self._scene.lights), {}
        self._sky = next((i for i in range(model.ntex) if model.tex_type[i] == mujoco.mjtTexture.mjTEXTURE_SKYBOX), None)
        self._sky_thing, self._mirrors, self._workers, self.left_out = None, [], [], ()

    model = property(lambda self: self._model)
    scene = property(lambda self: self._scene)
    height = property(lambda self: self._height)
    width = property(lambda self: self._width)

    def enable_depth_rendering(self):
        self._kind = "depth"

    def disable_depth_rendering(self):
        self._kind = "rgb" if self._kind == "depth" else self._kind

    def enable_segmentation_rendering(self):
        self._kind = "segmentation"

    def disable_segmentation_rendering(self):
        self._kind = "rgb" if self._kind == "segmentation" else self._kind

    def close(self):
        self._renderer = None
        self._workers.clear()

    def read_model_again(self):
        """Reads the model's textures, height fields and meshes anew, after they were changed."""
        for kept in (self._shapes, self._textures, self._workers):
            kept.clear()
        self._sky_thing, self._known = None, None

    def __enter__(self):
        return self

    def __exit__(self, kind, error, traceback):
        self.close()

    def update_scene(self, data, camera=-1, scene_option=None):
        """Takes the geometry that is drawn: what mjv_updateScene makes of the data. camera: a name, a number, or an MjvCamera."""
        if not isinstance(camera, mujoco.MjvCamera):
            number = camera
            if isinstance(camera, str):
                number = mujoco.mj_name2id(self._model, mujoco.mjtObj.mjOBJ_CAMERA.value, camera)
                if number == -1:
                    raise ArgumentError(f'The camera "{camera}" does not exist.')
            if not -1 <= number < self._model.ncam:
                raise ArgumentError(f"The camera id {number} is out of range [-1, {self._model.ncam}).")
            camera = mujoco.MjvCamera()
            camera.fixedcamid = number
            if number == -1:
                camera.type = mujoco.mjtCamera.mjCAMERA_FREE
                mujoco.mjv_defaultFreeCamera(self._model, camera)
            else:
                camera.type = mujoco.mjtCamera.mjCAMERA_FIXED
        mujoco.mjv_updateScene(self._model, data, scene_option or self._option, None, camera, mujoco.mjtCatBit.mjCAT_ALL.value, self._scene)

    def render(self, *, out=None):
        """Returns the picture: (H, W, 3) of uint8; with depth rendering (H, W) of float32, in metres along the axis; with segmentation
        rendering (H, W, 2) of int32, the id and type of each pixel's object, -1 where nothing is."""
        outputs = {"rgb": ("color",), "depth": ("depth",), "segmentation": ("instance", "depth")}
        made = self._draw(outputs[self._kind])
        made = {"rgb": self._rgb, "depth": self._depth, "segmentation": self._segmentation}[self._kind](made)
        if out is None:
            return made
        if out.shape != made.shape:
            raise ArgumentError(f"Expected `out.shape == {made.shape}`. Got `out.shape={out.shape}` instead.")
        np.copyto(out, made, casting="unsafe")
        return out

    def render_all(self):
        """Returns (colours, depth, segmentation), each as render() has them, of one frame with one sample a pixel. Depth and segmentation
        then show what the colours show, MuJoCo's decoration included, and nothing behind it."""
        made = self._draw(("color", "depth", "instance"))
        segmentation = self._segmentation(made)
        return self._rgb(made), self._depth(made), segmentation

    def render_batch(self, datas, camera=-1, scene_option=None):
        """Returns what render_all() has, (N, H, W, 3), (N, H, W) and (N, H, W, 2), for each of N MjData. Frames are drawn side by side,
        a thread each. The flags of `scene` apply to all."""
        self._refuse_closed()
        datas = list(datas)
        shape = len(datas), self._height, self._width
        all_of = np.empty((*shape, 3), np.uint8), np.empty(shape, np.float32), np.empty((*shape, 2), np.int32)
        count = min(self._renderer._options[0], len(datas))
        while len(self._workers) < count:
            self._workers.append(Renderer(self._model, self._height, self._width, len(self._places), threads=1))
        turn = threading.Lock()  # states and cameras may be shared, and MuJoCo writes into them

        def draw(first):
            worker = self._workers[first]
            for i in range(first, len(datas), count):
                with turn:
                    worker.update_scene(datas[i], copy.copy(camera), scene_option)
                worker.scene.flags[:] = self._scene.flags
                for made, into in zip(worker.render_all(), all_of):
                    into[i] = made

        if count > 1:
            with concurrent.futures.ThreadPoolExecutor(count) as pool:
                list(pool.map(draw, range(count)))
        elif datas:
            draw(0)
        self.left_out = tuple(sorted({said for worker in self._workers[:count] for said in worker.left_out}))
        return all_of

    # From a Picture's arrays to MuJoCo's.

    @staticmethod
    def _rgb(picture):
        rgb = np.empty((*picture.color.shape[:2], 3), np.uint8)
        for k in range(3):  # one copy of all three takes four times as long
            rgb[..., k] = picture.color[..., k]
        return rgb

    def _depth(self, picture):
        depth = picture.depth
        depth[(depth <= 0) | (depth > self._far)] = self._far
        return depth

    def _segmentation(self, picture):
        n, table = self._scene.ngeom, self._objects
        table[:n, 0], table[:n, 1], table[n:] = self._geoms.objid[:n], self._geoms.objtype[:n], -1
        ids = picture.instance
        ids[picture.depth > self._far] = -1
        # A pair is one number, and -1 the last one.
        return np.take(table.view(np.int64)[:, 0], ids, mode="wrap").view(np.int32).reshape(*ids.shape, 2)

    def _draw(self, outputs):
        self._refuse_closed()
        colored = "color" in outputs
        self._update()
        self.left_out = tuple(sorted(text for text, applies in self._not_drawn().items() if applies))
        projection, view = self._matrices()
        camera = _seen_by(projection, view)
        look = {"size": (self._width, self._height)}
        if not colored:
            return self._renderer.render(self._scene_of(False), camera, outputs=outputs, transparency="none", cull="back", **look)
        lights, shadows = self._lights()
        reach = math.dist(self._model.stat.center, self._eye) + self._model.stat.extent
        look.update(shader="classic", lights=lights, shadows=shadows, background="black", shadow_distance=reach,
                    samples=self._samples if "depth" not in outputs else 1)
        mirrors = self._mirrors if self._scene.flags[_FLAGS.mjRND_REFLECTION] else ()
        if mirrors:
            outputs = tuple({*outputs, "instance", "normal"})
        picture = self._renderer.render(self._scene_of(True), camera, outputs=outputs, cull="back", **look)
        for mirror in mirrors:
            self._reflect(picture, mirror, projection, view, look)
        return picture

    def _refuse_closed(self):
        if self._renderer is None:
            raise RuntimeError("render cannot be called after close.")

    def _not_drawn(self):
        flags = self._scene.flags
        haze, labels, textures = self._of_geoms
        return {"fog is not drawn": flags[_FLAGS.mjRND_FOG], "lines of faces are not drawn alone": flags[_FLAGS.mjRND_WIREFRAME],
                "transparent things are blended, not added": flags[_FLAGS.mjRND_ADDITIVE],
                "faces seen from behind are not drawn": not flags[_FLAGS.mjRND_CULL_FACE],
                "haze is not drawn": flags[_FLAGS.mjRND_HAZE] and haze, "labels are not drawn": labels,
                "textures of flexes are not drawn": textures}

    def _reflect(self, picture, mirror, projection, view, look):
        """Adds to a mirror what a camera behind it sees in front of it. A box mirrors by its upper side. Only the part of the picture
        that has the mirror is drawn."""
        geom, at = self._scene.geoms[mirror], self._places[mirror]
        normal, place = at[:3, 2], at[:3, 3] + at[:3, 2] * (geom.size[2] if geom.type == _BOX else 0)
        on = picture.instance == mirror
        on &= (picture.normal * normal.astype(np.float32)).sum(-1) > 0.99
        if ((self._eye - place) * normal).sum() <= 0 or not on.any():
            return
        across = np.eye(4)
        across[:3, :3] -= 2 * np.outer(normal, normal)
        across[:3, 3] = 2 * (normal * place).sum() * normal
        rows, columns = (np.flatnonzero(on.any(axis)) for axis in (1, 0))
        part = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
        (height, width), projection = on[part].shape, np.array(projection)
        cropped = projection.copy()
        for row, first, count, all_, up in ((0, columns[0], width, self._width, 1), (1, rows[0], height, self._height, -1)):
            low, high = up * (2 * first / all_ - 1), up * (2 * (first + count) / all_ - 1)
            cropped[row] = up * (2 * projection[row] - (low + high) * projection[3]) / (high - low)
        hidden = [t for t in (*self._things[mirror], self._sky_thing) if t is not None and t.visible]
        look = {**look, "size": (width, height), "background": None, "shadows": False}
        try:
            for thing in hidden:
                thing.visible = False
            seen = self._renderer.render(self._scenes[True], _seen_by(cropped, _product(np.array(view), across)), cull="front",
                                         clip_planes=[[*normal, -(normal * place).sum()]], **look).color[on[part]]
        finally:
            for thing in hidden:
                thing.visible = True
        added = picture.color[on][:, :3] + geom.reflectance / 255 * seen[:, 3:] * seen[:, :3]
        picture.color[on, :3] = np.minimum(255, np.rint(added)).astype(np.uint8)

    # The camera.

    def _matrices(self):
        """Rows of the projection and of the view."""
        view = mujoco.mjv_averageCamera(self._scene.camera[0], self._scene.camera[1])
        eye, ahead, up = (v.tolist() for v in (view.pos, view.forward, view.up))
        ahead = _of_length_1(ahead)
        right = _of_length_1(_cross(ahead, up))
        axes = right, _cross(right, ahead), [-x for x in ahead]
        to_camera = [[*axis, -_dot(axis, eye)] for axis in axes] + [[0.0, 0.0, 0.0, 1.0]]
        half = view.frustum_width or 0.5 * self._width / self._height * (view.frustum_top - view.frustum_bottom)
        l, r, b, t = view.frustum_center - half, view.frustum_center + half, view.frustum_bottom, view.frustum_top
        n, f = view.frustum_near, 4.0 * view.frustum_far  # the sky lies behind MuJoCo's far plane
        if view.orthographic:
            rows = ([2 / (r - l), 0.0, 0.0, -(r + l) / (r - l)], [0.0, 2 / (t - b), 0.0, -(t + b) / (t - b)],
                    [0.0, 0.0, -2 / (f - n), -(f + n) / (f - n)], [0.0, 0.0, 0.0, 1.0])
        else:
            rows = ([2 * n / (r - l), 0.0, (r + l) / (r - l), 0.0], [0.0, 2 * n / (t - b), (t + b) / (t - b), 0.0],
                    [0.0, 0.0, -(f + n) / (f - n), -2 * f * n / (f - n)], [0.0, 0.0, -1.0, 0.0])
        self._far, self._eye = view.frustum_far, eye
        return rows, to_camera

    # The lights.

    def _lights(self):
        scene = self._scene
        now = [row.tobytes() for row in self._light_bytes[:scene.nlight]]
        self._lit = {row: self._lit.get(row) or self._light(scene.lights[i]) for i, row in enumerate(now)}
        made = [self._lit[row] for row in now] or [_Light.ambient(intensity=0)]
        return made, bool(scene.flags[_FLAGS.mjRND_SHADOW]) and any(light._made.throws_shadows for light in made)

    @staticmethod
    def _light(light):
        kind = _kind_of(light)
        look = {"casts_shadows": bool(light.castshadow), "classic": {name: tuple(getattr(light, name)) for name in ("ambient", "diffuse", "specular")}}
        if kind == "directional":
            return _Light.directional(tuple(light.dir), **look)
        look["classic"]["attenuation"] = tuple(light.attenuation) if any(light.attenuation) else (1, 0, 0)
        if kind != "spot" or light.cutoff > 90:
            return _Light.point(tuple(light.pos), **look)
        look["classic"]["exponent"] = min(float(light.exponent), 128.0)
        return _Light.spot(tuple(light.pos), tuple(light.dir), 0.0, max(float(light.cutoff), 0.01), **look)

    # The geoms.

    def _update(self):
        """Makes things of geoms that are new or changed, and moves all."""
        scene, geoms = self._scene, self._geoms
        n = scene.ngeom
        self._places[:n, :3, 3], self._places[:n, :3, :3] = geoms.pos[:n], geoms.mat[:n]
        now = geoms.bytes[:n, geoms.fixed]
        soft = (scene.flexvertopt, scene.flexedgeopt, scene.flexfaceopt, scene.flexskinopt, np.array(scene.flexfaceused).tobytes())
        before, soft_before = (np.zeros((0, 0), np.uint8), None) if self._known is None else self._known
        if now.shape == before.shape and soft == soft_before and np.array_equal(now, before):
            return
        things, all_geoms = [], scene.geoms[:n]
        for i in range(n):
            stays = i < len(before) and all_geoms[i].type not in (_FLEX, _SKIN) and np.array_equal(now[i], before[i])
            things.append(self._things[i] if stays else self._thing(i, all_geoms[i]))
        # At once, so that an exception before leaves all as it was.
        self._known, self._things, self._scenes = (now, soft), things, {}
        self._mirrors = [i for i, g in enumerate(all_geoms) if g.reflectance > 0 and g.type in (_PLANE, _BOX)]
        self._of_geoms = (any(g.type == _PLANE and g.size[0] <= 0 for g in all_geoms), any(g.type == _LABEL or g.label for g in all_geoms),
                          any(g.type == _FLEX and self._texture_of(g)[0] >= 0 for g in all_geoms))

    def _scene_of(self, colored):
        """The scene for colours, which has the sky, or for depth and segmentation."""
        if colored not in self._scenes:
            geoms = self._scene.geoms
            sky = [self._skybox()] if colored and self._sky is not None else []
            self._scenes[colored] = _Scene(sky + [t for i, row in enumerate(self._things) if colored or geoms[i].segid >= 0 for t in row])
        if colored and self._sky is not None:
            self._sky_thing.visible = bool(self._scene.flags[_FLAGS.mjRND_SKYBOX])
            self._sky_place[:3, 3] = self._eye
            self._sky_place[[0, 1, 2], [0, 1, 2]] = 1.9 * self._far
        return self._scenes[colored]

    def _thing(self, i, geom):
        """The things of a geom; mostly one."""
        kind, size = geom.type, np.array(geom.size, np.float64)
        color = np.clip(geom.rgba, 0, 1).astype(np.float64)
        look = {"id": i, "casts_shadows": bool(getattr(geom, "castshadow", True)) and geom.category != mujoco.mjtCatBit.mjCAT_DECOR}
        material = {"alpha_mode": "blend" if color[3] < _SEETHROUGH else "opaque", "specular": max(0.0, float(geom.specular)),
                    "shininess": float(np.clip(geom.shininess, 0, 1)), "emission": max(0.0, float(geom.emission))}
        if kind in (_FLEX, _SKIN):
            return self._soft(geom, color, material, look)
        place = {**look, "transform": self._places[i]}
        if kind in (_LINE, _LINEBOX):
            return [self._lines(kind, size, {**place, "material": _t.Material(color, unlit=True, alpha_mode=material["alpha_mode"])})]
        shape = self._shape(kind, geom.dataid, tuple(size))
        if shape is None:
            return []
        points, faces, normals, unit, uv = shape
        texture, uniform, repeat = self._texture_of(geom)
        if texture >= 0:
            if self._model.tex_type[texture] != mujoco.mjtTexture.mjTEXTURE_2D:
                uv = self._cube_uv((unit if unit is not None else points) * (size if uniform and unit is not None else 1), faces)
            elif not geom.texcoord:
                uv = self._planar_uv(points / np.where(size > 0, size, 1) if unit is None else unit, uniform, repeat, size)
            if uv is not None:
                material["base_color_texture"] = self._texture(texture)
        mesh = _t.Mesh(points, faces, normals=normals, uv=uv, material=_t.Material(color, **material), **place)
        # What lies outside of a picture, a shadow map or a mirror is then left out by its box.
        return [mesh.prepare() if len(faces) > _LARGE else mesh]

    @staticmethod
    def _lines(kind, size, look):
        if kind == _LINE:
            return _t.Lines(np.array([[0, 0, 0], [0, 0, size[2]]]), width=max(1.0, size[0]), **look)
        corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * size
        edges = np.array([[a, a | b] for a in range(8) for b in (1, 2, 4) if not a & b])
        return _t.Lines(corners, edges, width=1.5, **look)

    def _soft(self, geom, color, material, look):
        """Skins and flexes, whose vertices MuJoCo moves; the arrays are read in place."""
        scene, model, k = self._scene, self._model, geom.objid
        if geom.type == _SKIN:
            at, count = scene.skinvertadr[k], scene.skinvertnum[k]
            first, faces = model.skin_faceadr[k], model.skin_facenum[k]
            points, normals = (a.reshape(-1, 3)[at:at + count] for a in (scene.skinvert, scene.skinnormal))
            uv = None
            texture, _, _ = self._texture_of(geom)
            if texture >= 0 and model.skin_texcoordadr[k] >= 0:
                uv = model.skin_texcoord.reshape(-1, 2)[model.skin_texcoordadr[k]:][:count]
                material["base_color_texture"] = self._texture(texture)
            return [_t.Mesh(points, model.skin_face[first:first + faces], normals=normals, uv=uv, material=_t.Material(color, **material), **look)]
        look["material"] = _t.Material(color, **material)
        things, radius = [], float(geom.size[0])
        at, count = scene.flexvertadr[k], scene.flexvertnum[k]
        points = scene.flexvert.reshape(-1, 3)[at:at + count]
        shown = radius > 0 and not (scene.flexskinopt and scene.flexfaceused[k])
        if shown and scene.flexvertopt:
            things.append(_t.Spheres(points, radius, **look))
        if shown and scene.flexedgeopt:
            first, edges = scene.flexedgeadr[k], scene.flexedgenum[k]
            things.append(_t.Cylinders(points, scene.flexedge.reshape(-1, 2)[first:first + edges], radius, caps=False, **look))
        if scene.flexfaceused[k]:
            corners = slice(3 * scene.flexfaceadr[k], 3 * (scene.flexfaceadr[k] + scene.flexfaceused[k]))
            things.append(_t.Mesh(scene.flexface.reshape(-1, 3)[corners], normals=scene.flexnormal.reshape(-1, 3)[corners], **look))
        return things

    def _shape(self, kind, dataid, size):
        """(positions, faces, normals, coordinates for textures or None, uv or None); None: nothing is drawn."""
        key = kind, dataid, size
        if key not in self._shapes:
            if len(self._shapes) >= _MOST_SHAPES:
                self._shapes.clear()  # tendons and arrows have another size in each frame
            made = self._made_shape(kind, dataid, np.array(size))
            if made is not None:
                made = tuple(None if a is None else np.ascontiguousarray(a, np.uint32 if k == 1 else np.float32) for k, a in enumerate(made))
            self._shapes[key] = made
        return self._shapes[key]

    def _made_shape(self, kind, dataid, size):
        model, slices = self._model, self._slices
        if kind in (_SPHERE, _ELLIPSOID):
            points, faces = self._unit_ball
            return points * size, faces, _unit(points / size), points, None
        if kind == _CAPSULE:
            return *_capsule(self._unit_ball, slices, self._stacks, size), None
        if kind == _BOX:
            points, faces, normals = _box()
            return points * size, faces, normals, points, None
        if kind == _CYLINDER:
            points, faces, normals = _turned(slices, [(1, -1, 1, 1, 0), (0, -1, 1, -1, -1), (1, 1, 0, 1, 1)])
            return points * size, faces, _unit(normals / size), points, None
        if kind in (_ARROW, _ARROW1, _ARROW2):
            wide = 1.0 if kind == _ARROW1 else 1.75
            if kind == _ARROW2:
                rows, size = [(1, -1, 1, 1, 0), (wide, 1, 0, 2, 0.5), (0, -2, wide, -1, -0.5)], size * [1, 1, 1 / 3]
            else:
                rows, size = [(0, 0, 1, 0, -1), (1, 0, 1, 2, 0), (1, 2, wide, 2, -1), (wide, 2, 0, 4, 0.5)], size * [1, 1, 1 / 6]
            points, faces, normals = _turned(slices, rows)
            return points * size, faces, _unit(normals / size), points, None
        if kind == _PLANE:
            far = model.vis.map.zfar * model.stat.extent
            half = [s if s > 0 else 1.05 * far for s in size[:2]]
            lines = [np.linspace(-h, h, 2 if size[0] > 0 else 9) for h in half]
            points, faces = _grid(*lines, np.zeros((len(lines[1]), len(lines[0]))))
            return points, faces, np.tile([0, 0, 1.0], (len(points), 1)), None, None
        if kind in (_MESH, _SDF):
            return self._mesh(dataid // 2, dataid % 2)
        if kind == _HFIELD:
            return self._heights(dataid)
        if kind == _TRIANGLE:
            return np.array([[0, 0, 0], [size[0], 0, 0], [0, size[1], 0]]), [[0, 1, 2]], None, None, None
        return None

    def _mesh(self, i, hull):
        m = self._model
        points = m.mesh_vert[m.mesh_vertadr[i]:m.mesh_vertadr[i] + m.mesh_vertnum[i]]
        if hull:
            graph = m.mesh_graph[m.mesh_graphadr[i]:]
            vertices, faces = graph[0], graph[1]
            first = 2 + 3 * vertices + 3 * faces
            return points, graph[first:first + 3 * faces].reshape(-1, 3), None, None, None
        which = slice(m.mesh_faceadr[i], m.mesh_faceadr[i] + m.mesh_facenum[i])
        faces = m.mesh_face[which]
        normals = m.mesh_normal[m.mesh_normaladr[i]:][m.mesh_facenormal[which]]
        uv = None
        if m.mesh_texcoordadr[i] >= 0:
            uv = m.mesh_texcoord[m.mesh_texcoordadr[i]:][m.mesh_facetexcoord[which]].reshape(-1, 2)
        else:  # MuJoCo's own normals, flat where faces lean away from them
            p = points[faces]
            flat = _unit(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]))[:, None]
            normals = np.where((normals * flat).sum(-1, keepdims=True) < 0.8, flat, normals)
        return points, faces, normals.reshape(-1, 3), None, uv

    def _heights(self, i):
        m = self._model
        rows, columns = m.hfield_nrow[i], m.hfield_ncol[i]
        heights = m.hfield_data[m.hfield_adr[i]:m.hfield_adr[i] + rows * columns].reshape(rows, columns)
        sx, sy, sz, base = m.hfield_size[i]
        points, faces = _grid(np.linspace(-sx, sx, columns), np.linspace(-sy, sy, rows), heights * sz)
        at = np.arange(rows * columns).reshape(rows, columns)
        ring = np.concatenate([at[0], at[1:, -1], at[-1, -2::-1], at[-2:0:-1, 0]])
        below = points[ring] * [1, 1, 0] - [0, 0, base]
        a, b = ring, len(points) + np.arange(len(ring))
        a2, b2 = np.roll(a, -1), np.roll(b, -1)
        first = len(points) + len(below)
        floor = [[-sx, -sy, -base], [-sx, sy, -base], [sx, sy, -base], [sx, -sy, -base]]
        faces = [faces, np.stack([a, b, b2], 1), np.stack([a, b2, a2], 1), [[first, first + 1, first + 2], [first, first + 2, first + 3]]]
        return np.concatenate([points, below, floor]), np.concatenate(faces), None, None, None

    # Textures.

    def _texture(self, i):
        if i not in self._textures:
            m = self._model
            height, width, channels = m.tex_height[i], m.tex_width[i], m.tex_nchannel[i]
            pixels = m.tex_data[m.tex_adr[i]:m.tex_adr[i] + height * width * channels].reshape(height, width, channels)
            if m.tex_type[i] != mujoco.mjtTexture.mjTEXTURE_2D and height != 6 * width:
                pixels = np.tile(pixels, (6, 1, 1))  # one picture for all sides
            self._textures[i] = np.ascontiguousarray(pixels[..., :4] if channels >= 3 else np.repeat(pixels[..., :1], 3, 2))
        return self._textures[i]

    def _texture_of(self, geom):
        """(number or -1, whether it repeats by lengths, its repetitions) of a geom."""
        material = getattr(geom, "matid", 0)
        if material < 0:
            return -1, False, (1, 1)
        if hasattr(geom, "texid"):
            return geom.texid, bool(geom.texuniform), geom.texrepeat
        # From 3.2 until the geom had it again, only the material has it, a texture for each role.
        m = self._model
        return m.mat_texid[material][mujoco.mjtTextureRole.mjTEXROLE_RGB], bool(m.mat_texuniform[material]), m.mat_texrepeat[material]

    @staticmethod
    def _planar_uv(points, uniform, repeat, size):
        """`points`: in units of the size, or as they are where that is 0: an infinite plane."""
        at = points[:, :2] * [1, -1]
        for k in range(2):
            repeats = 0.5 * float(repeat[k])
            if size[k] > 0:
                at[:, k] = repeats * (size[k] if uniform else 1) * (at[:, k] + 1)
            else:
                at[:, k] = repeats * at[:, k] + 0.5
        return at.astype(np.float32)

    @staticmethod
    def _cube_uv(points, faces):
        """For each corner a place in the six sides of a cube, one below the other; a face has that of its middle."""
        corners = points[faces].astype(np.float64)
        middle = corners.mean(1)
        axis = np.abs(middle).argmax(1)
        away = np.take_along_axis(middle, axis[:, None], 1)[:, 0] < 0
        x, y, z = np.moveaxis(corners, 2, 0)
        length = np.maximum(np.abs(np.take_along_axis(corners, axis[:, None, None], 2)[..., 0]), 1e-20)
        side = (2 * axis + away)[:, None]
        u = np.choose(side, [-z, z, x, x, x, -x]) / length
        v = np.choose(side, [-y, -y, z, -z, -y, -y]) / length
        inside = 1 - 1e-3  # not a texel of the side next to it
        return np.stack([(np.clip(u, -inside, inside) + 1) / 2, (side + (np.clip(v, -inside, inside) + 1) / 2) / 6], -1).reshape(-1, 2).astype(np.float32)

    def _skybox(self):
        if self._sky_thing is None:
            points, faces, _ = _box()
            # MuJoCo looks up the sky with z for y.
            uv = self._cube_uv(np.stack([points[:, 0], points[:, 2], -points[:, 1]], 1), faces)
            self._sky_place = np.eye(4)
            self._sky_thing = _t.Mesh(points, faces[:, ::-1], uv=uv.reshape(-1, 3, 2)[:, ::-1].reshape(-1, 2), transform=self._sky_place,
                                      casts_shadows=False, id=len(self._places),
                                      material=_t.Material(unlit=True, base_color_texture=self._texture(self._sky)))
        return self._sky_thing
