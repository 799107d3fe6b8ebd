# SPDX-License-Identifier: BSD-3-Clause
"""pyrender's names and flags over Rastrum: `import rastrum.compat.pyrender as pyrender`.

It draws off screen, and needs no OpenGL, no OSMesa and no display. Differences: a scene without any light gets
Rastrum's fixed light; light becomes display values by the sRGB curve, not by a power of 1 / 2.2; point lights throw no
shadows; there is no Viewer; and pictures have the same bits on every machine.
"""

import numpy as np

from .. import _rastrum as _r
from .. import _things as _t
from .._arrays import product as _product
from .._camera import Camera as _Camera
from .._errors import ArgumentError, ArgumentTypeError, UnsupportedError
from .._lights import Light as _Light
from .._lights import display
from .._render import Renderer as _Renderer
from .._scene import Scene as _Scene

__all__ = ["Camera", "DirectionalLight", "IntrinsicsCamera", "Light", "Material", "Mesh", "MetallicRoughnessMaterial", "Node",
           "OffscreenRenderer", "OrthographicCamera", "PerspectiveCamera", "PointLight", "Primitive", "RenderFlags", "Scene",
           "Sampler", "SpotLight", "Texture", "Viewer"]


class RenderFlags:
    NONE, DEPTH_ONLY, OFFSCREEN, FLIP_WIREFRAME, ALL_WIREFRAME, ALL_SOLID = 0, 1, 2, 4, 8, 16
    SHADOWS_DIRECTIONAL, SHADOWS_POINT, SHADOWS_SPOT, SHADOWS_ALL = 32, 64, 128, 224
    VERTEX_NORMALS, FACE_NORMALS, SKIP_CULL_FACES, RGBA, FLAT, SEG = 256, 512, 1024, 2048, 4096, 8192


class Camera:
    def __init__(self, znear=0.05, zfar=100.0, name=None):
        self.znear, self.zfar, self.name = znear, zfar, name

    def get_projection_matrix(self, width=None, height=None):
        raise NotImplementedError

    def _depth_rows(self, p):
        """Fills in the rows of a perspective projection for depth, from znear and zfar; zfar None is infinite."""
        n, f = self.znear, self.zfar
        p[2, 2], p[2, 3] = (-1.0, -2.0 * n) if f is None else ((f + n) / (n - f), 2.0 * f * n / (n - f))
        p[3, 2] = -1.0
        return p


class PerspectiveCamera(Camera):
    """yfov: radians."""

    def __init__(self, yfov, znear=0.05, zfar=None, aspectRatio=None, name=None):
        super().__init__(znear, zfar, name)
        self.yfov, self.aspectRatio = yfov, aspectRatio

    def get_projection_matrix(self, width=None, height=None):
        aspect = self.aspectRatio
        if aspect is None:
            if width is None or height is None:
                raise ArgumentError("aspectRatio: is needed, because there is no picture to take it from")
            aspect = width / height
        p, t = np.zeros((4, 4)), np.tan(self.yfov / 2)
        p[0, 0], p[1, 1] = 1 / (aspect * t), 1 / t
        return self._depth_rows(p)


class IntrinsicsCamera(Camera):
    """fx, fy, cx, cy: pixels; (0, 0) is the top left corner of the picture."""

    def __init__(self, fx, fy, cx, cy, znear=0.05, zfar=100.0, name=None):
        super().__init__(znear, zfar, name)
        self.fx, self.fy, self.cx, self.cy = fx, fy, cx, cy

    def get_projection_matrix(self, width, height):
        p = np.zeros((4, 4))
        p[0, 0], p[1, 1] = 2 * self.fx / width, 2 * self.fy / height
        p[0, 2], p[1, 2] = 1 - 2 * self.cx / width, 2 * self.cy / height - 1
        return self._depth_rows(p)


class OrthographicCamera(Camera):
    def __init__(self, xmag, ymag, znear=0.05, zfar=100.0, name=None):
        super().__init__(znear, zfar, name)
        self.xmag, self.ymag = xmag, ymag

    def get_projection_matrix(self, width=None, height=None):
        across = self.ymag * width / height if width is not None and height is not None else self.xmag
        n, f = self.znear, self.zfar
        p = np.diag([1 / across, 1 / self.ymag, 2 / (n - f), 1.0])
        p[2, 3] = (f + n) / (n - f)
        return p


class Light:
    """color: linear, (3,), 0 to 1. intensity: lux, or candela where it has a place. It shines along its node's -z."""

    def __init__(self, color=None, intensity=None, name=None):
        self.color = np.ones(3) if color is None else np.asarray(color, float)[:3]
        self.intensity, self.name = 1.0 if intensity is None else intensity, name

    def _look(self):
        return {"color": tuple(display(self.color)), "intensity": self.intensity / np.pi}

    def _placed(self, pose):
        raise UnsupportedError(f"{type(self).__name__}: has no kind; take DirectionalLight, PointLight or SpotLight")


class DirectionalLight(Light):
    def _placed(self, pose):
        return _Light.directional(-pose[:3, 2], **self._look())


class PointLight(Light):
    """range: where it ends, None: nowhere."""

    def __init__(self, color=None, intensity=None, range=None, name=None):
        super().__init__(color, intensity, name)
        self.range = range

    def _reach(self):
        return {} if self.range is None else {"range": self.range}

    def _placed(self, pose):
        return _Light.point(pose[:3, 3], **self._reach(), **self._look())


class SpotLight(PointLight):
    """innerConeAngle, outerConeAngle: radians from the axis."""

    def __init__(self, color=None, intensity=None, range=None, innerConeAngle=0.0, outerConeAngle=np.pi / 4.0, name=None):
        super().__init__(color, intensity, range, name)
        self.innerConeAngle, self.outerConeAngle = innerConeAngle, outerConeAngle

    def _placed(self, pose):
        return _Light.spot(pose[:3, 3], -pose[:3, 2], inner=np.degrees(self.innerConeAngle),
                           outer=np.degrees(self.outerConeAngle), **self._reach(), **self._look())


class Sampler:
    """Kept; textures are filtered and repeated as Rastrum does it."""

    def __init__(self, name=None, magFilter=None, minFilter=None, wrapS=10497, wrapT=10497):
        self.name, self.magFilter, self.minFilter, self.wrapS, self.wrapT = name, magFilter, minFilter, wrapS, wrapT


class Texture:
    """source: an array (H, W) or (H, W, 1 to 4) of uint8 or floats in [0, 1], or a PIL image."""

    def __init__(self, name=None, sampler=None, source=None, source_channels=None, width=None, height=None, tex_type=3553,
                 data_format=5121):
        self.name, self.sampler, self.source, self.source_channels = name, sampler, source, source_channels

    def _pixels(self):
        if hasattr(self.source, "convert"):
            return np.asarray(self.source.convert("RGBA"))
        pixels = np.asarray(self.source)
        if pixels.dtype.kind == "f":
            pixels = np.round(np.clip(pixels, 0, 1) * 255).astype(np.uint8)
        if pixels.ndim == 2 or pixels.ndim == 3 and pixels.shape[2] == 1:
            pixels = np.repeat(pixels.reshape(*pixels.shape[:2], 1), 3, axis=2)
        elif pixels.ndim == 3 and pixels.shape[2] == 2:  # grey and alpha
            pixels = pixels[..., (0, 0, 0, 1)]
        if pixels.ndim != 3 or pixels.shape[2] not in (3, 4) or pixels.dtype != np.uint8:
            raise ArgumentError(f"Texture: source is {np.shape(self.source)} of {np.asarray(self.source).dtype}; (H, W) or "
                                "(H, W, 1 to 4) of uint8 or float are drawn")
        return pixels


def _texture(source):
    return source if source is None or isinstance(source, Texture) else Texture(source=source)


class Material:
    pass


class MetallicRoughnessMaterial(Material):
    def __init__(self, name=None, baseColorFactor=None, baseColorTexture=None, metallicFactor=1.0, roughnessFactor=1.0,
                 emissiveFactor=None, alphaMode=None, alphaCutoff=None, doubleSided=False, smooth=True, wireframe=False, **other):
        self.name, self.baseColorTexture = name, _texture(baseColorTexture)
        self.baseColorFactor = np.ones(4) if baseColorFactor is None else np.asarray(baseColorFactor, float)
        if self.baseColorFactor.dtype.kind in "f" and self.baseColorFactor.max() > 1:
            self.baseColorFactor = self.baseColorFactor / 255
        if self.baseColorFactor.shape == (3,):
            self.baseColorFactor = np.append(self.baseColorFactor, 1.0)
        self.metallicFactor, self.roughnessFactor, self.emissiveFactor = metallicFactor, roughnessFactor, emissiveFactor
        self.alphaMode, self.alphaCutoff, self.doubleSided = alphaMode or "OPAQUE", alphaCutoff or 0.5, doubleSided
        self.smooth, self.wireframe = smooth, wireframe

    def _made(self, textured=False):
        """The rastrum.Material for the shader `material`; only the base colour texture is drawn."""
        emissive = np.zeros(3) if self.emissiveFactor is None else np.asarray(self.emissiveFactor, float)[:3]
        base = np.append(display(self.baseColorFactor[:3]), np.clip(self.baseColorFactor[3], 0, 1))
        return _t.Material(tuple(base), metallic=self.metallicFactor, roughness=self.roughnessFactor,
                           emissive=tuple(display(emissive)), alpha_mode=self.alphaMode.lower(),
                           alpha_cutoff=self.alphaCutoff, double_sided=self.doubleSided,
                           base_color_texture=self.baseColorTexture._pixels() if textured else None)


class Primitive:
    """positions (N, 3), normals, color_0, indices (M, 3), material, poses (K, 4, 4); mode 4: triangles, 0: points."""

    def __init__(self, positions, normals=None, tangents=None, texcoord_0=None, texcoord_1=None, color_0=None, joints_0=None,
                 weights_0=None, indices=None, material=None, mode=None, targets=None, poses=None):
        self.positions, self.normals, self.texcoord_0, self.color_0 = positions, normals, texcoord_0, color_0
        self.indices, self.material, self.poses = indices, material, poses
        self.mode = 4 if mode is None else mode
        self._colors_per = "vertex"

    def _geometry(self, point_size, smooth, lit):
        look = {} if self.color_0 is None else {"colors": np.asarray(self.color_0)}
        textured = self.texcoord_0 is not None and self.material is not None and self.material.baseColorTexture is not None
        if self.material is not None and (lit or textured and self.mode == 4):
            look["material"] = self.material._made(textured)
        if textured and self.mode == 4:  # v is counted from the bottom, here from the top
            look["uv"] = np.asarray(self.texcoord_0, float) * (1.0, -1.0) + (0.0, 1.0)
        if self.mode == 0:
            return lambda **more: _t.Points(self.positions, size=point_size, round=False, normals=self.normals,
                                            **look, **more)
        if self.mode != 4:
            raise UnsupportedError(f"Primitive: mode {self.mode} is not drawn; triangles (4) and points (0) are")
        if not look and self.material is not None:
            look["color"] = np.clip(self.material.baseColorFactor, 0, 1)
        normals = self.normals if smooth else None
        return lambda **more: _t.Mesh(self.positions, self.indices, normals=normals, per=self._colors_per, **look, **more)


def _bounds(positions):
    filled = [p for p in positions if len(p)]
    if not filled:
        return np.zeros((2, 3))
    return np.array([np.min([p.min(axis=0) for p in filled], axis=0), np.max([p.max(axis=0) for p in filled], axis=0)])


def _material_of(visual):
    """The material of a trimesh with a texture; None where it has no texture."""
    theirs = getattr(visual, "material", None)
    image = getattr(theirs, "baseColorTexture", None)
    image = image if image is not None else getattr(theirs, "image", None)
    if image is None or getattr(visual, "uv", None) is None:
        return None
    def given(name, default):
        value = getattr(theirs, name, None)
        return default if value is None else value
    return MetallicRoughnessMaterial(baseColorTexture=image, baseColorFactor=given("baseColorFactor", None),
                                     metallicFactor=given("metallicFactor", 0.0), roughnessFactor=given("roughnessFactor", 0.9),
                                     alphaMode=given("alphaMode", None), doubleSided=bool(given("doubleSided", False)))


class Mesh:
    def __init__(self, primitives, name=None, weights=None, is_visible=True):
        self.primitives, self.name, self.is_visible = list(primitives), name, is_visible

    bounds = property(lambda self: _bounds([np.asarray(p.positions) for p in self.primitives]),
                      doc="(2, 3): least and greatest of the positions.")
    extents = property(lambda self: np.diff(self.bounds, axis=0).reshape(-1))
    centroid = property(lambda self: np.mean(self.bounds, axis=0))
    scale = property(lambda self: np.linalg.norm(self.extents), doc="The length of the box's diagonal.")

    @staticmethod
    def from_points(points, colors=None, normals=None, is_visible=True, poses=None):
        return Mesh([Primitive(points, normals=normals, color_0=colors, mode=0, poses=poses)], is_visible=is_visible)

    @staticmethod
    def from_trimesh(mesh, material=None, is_visible=True, poses=None, wireframe=False, smooth=True):
        """A Mesh from a trimesh.Trimesh, or from a list of them."""
        primitives = []
        for m in mesh if isinstance(mesh, (list, tuple, set, np.ndarray)) else [mesh]:
            colors, kind = None, getattr(getattr(m, "visual", None), "kind", None)
            if material is None and kind == "vertex":
                colors = np.asarray(m.visual.vertex_colors)
            elif material is None and kind == "face":
                colors = np.asarray(m.visual.face_colors)
            theirs = _material_of(m.visual) if material is None and kind == "texture" else material
            primitives.append(Primitive(np.asarray(m.vertices), indices=np.asarray(m.faces), color_0=colors,
                                        normals=np.asarray(m.vertex_normals) if smooth else None, material=theirs,
                                        texcoord_0=getattr(m.visual, "uv", None) if kind == "texture" else None, poses=poses))
            primitives[-1]._colors_per = "face" if colors is not None and kind == "face" else "vertex"
        return Mesh(primitives, is_visible=is_visible)


class Node:
    """A mesh, camera or light, placed: `matrix`, or translation, rotation (x, y, z, w) and scale."""

    def __init__(self, name=None, camera=None, children=None, skin=None, matrix=None, mesh=None, weights=None, rotation=None,
                 scale=None, translation=None, light=None):
        self.name, self.camera, self.mesh, self.light = name, camera, mesh, light
        self.children = list(children or [])
        if matrix is None:
            matrix = np.eye(4)
            x, y, z, w = (0, 0, 0, 1) if rotation is None else np.asarray(rotation, float)
            matrix[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                              [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                              [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
            matrix[:3, :3] *= np.ones(3) if scale is None else np.asarray(scale, float)
            matrix[:3, 3] = 0 if translation is None else translation
        self.matrix = np.asarray(matrix, float)

    @property
    def translation(self):
        return self.matrix[:3, 3]

    @translation.setter
    def translation(self, value):
        self.matrix[:3, 3] = value

    @property
    def scale(self):
        return np.linalg.norm(self.matrix[:3, :3], axis=0)

    @scale.setter
    def scale(self, value):
        self.matrix[:3, :3] = self.matrix[:3, :3] / self.scale * np.asarray(value, float)

    @property
    def rotation(self):
        """(x, y, z, w)."""
        m = self.matrix[:3, :3] / self.scale
        # The largest of the four is found first, so that no division is by little.
        squares = np.array([1 + m[0, 0] - m[1, 1] - m[2, 2], 1 - m[0, 0] + m[1, 1] - m[2, 2],
                            1 - m[0, 0] - m[1, 1] + m[2, 2], 1 + m[0, 0] + m[1, 1] + m[2, 2]])
        i = int(np.argmax(squares))
        four = 2 * np.sqrt(squares[i])  # 4 times it
        products = {(0, 1): m[0, 1] + m[1, 0], (0, 2): m[0, 2] + m[2, 0], (1, 2): m[1, 2] + m[2, 1],
                    (0, 3): m[2, 1] - m[1, 2], (1, 3): m[0, 2] - m[2, 0], (2, 3): m[1, 0] - m[0, 1]}
        return np.array([four / 4 if k == i else products[min(i, k), max(i, k)] / four for k in range(4)])

    @rotation.setter
    def rotation(self, value):
        turned = Node(rotation=value, scale=self.scale).matrix[:3, :3]
        self.matrix[:3, :3] = turned


class Scene:
    def __init__(self, nodes=None, bg_color=None, ambient_light=None, name=None):
        self.bg_color = np.ones(4) if bg_color is None else np.asarray(bg_color, float)
        self.ambient_light, self.name, self.main_camera_node = ambient_light, name, None
        self._parents = {}
        for node in nodes or []:
            self.add_node(node)

    @staticmethod
    def from_trimesh_scene(trimesh_scene, bg_color=None, ambient_light=None):
        scene = Scene(bg_color=bg_color, ambient_light=ambient_light)
        for name in trimesh_scene.graph.nodes_geometry:
            pose, geometry = trimesh_scene.graph[name]
            scene.add(Mesh.from_trimesh(trimesh_scene.geometry[geometry]), pose=pose, name=name)
        return scene

    @property
    def nodes(self):
        return set(self._parents)

    @property
    def mesh_nodes(self):
        return {n for n in self._parents if n.mesh is not None}

    @property
    def camera_nodes(self):
        return {n for n in self._parents if n.camera is not None}

    @property
    def light_nodes(self):
        return {n for n in self._parents if n.light is not None}

    @property
    def bounds(self):
        """(2, 3): the box of all positions, in the world."""
        corners = []
        for node in self.mesh_nodes:
            pose = self.get_pose(node)
            for primitive in node.mesh.primitives:
                poses = [np.eye(4)] if primitive.poses is None else np.asarray(primitive.poses, float).reshape(-1, 4, 4)
                box = _bounds([np.asarray(primitive.positions)])
                eight = np.array([[box[i, 0], box[j, 1], box[k, 2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
                for own in poses:
                    m = _product(pose, own)
                    corners.append((eight[:, None, :] * m[:3, :3]).sum(axis=2) + m[:3, 3])
        return _bounds(corners)

    extents = property(lambda self: np.diff(self.bounds, axis=0).reshape(-1))
    centroid = property(lambda self: np.mean(self.bounds, axis=0))
    scale = property(lambda self: np.linalg.norm(self.extents), doc="The length of the box's diagonal.")
    meshes = property(lambda self: {n.mesh for n in self.mesh_nodes})
    cameras = property(lambda self: {n.camera for n in self.camera_nodes})
    lights = property(lambda self: {n.light for n in self.light_nodes})

    def add(self, obj, name=None, pose=None, parent_node=None, parent_name=None):
        kind = "mesh" if isinstance(obj, Mesh) else "camera" if isinstance(obj, Camera) else "light" if isinstance(
            obj, Light) else None
        if kind is None:
            raise ArgumentTypeError(f"Scene.add: {type(obj).__qualname__} is no mesh, camera or light")
        if parent_name is not None:
            parent_node = next(iter(self.get_nodes(name=parent_name)), None)
            if parent_node is None:
                raise ArgumentError(f"parent_name: there is no node {parent_name}")
        node = Node(name=name, matrix=np.eye(4) if pose is None else pose, **{kind: obj})
        self.add_node(node, parent_node)
        return node

    def add_node(self, node, parent_node=None):
        if node in self._parents:
            raise ArgumentError("the node is in the scene already")
        self._parents[node] = parent_node
        if parent_node is not None and node not in parent_node.children:
            parent_node.children.append(node)
        if node.camera is not None and self.main_camera_node is None:
            self.main_camera_node = node
        for child in node.children:
            if child not in self._parents:
                self.add_node(child, node)

    def get_nodes(self, node=None, name=None, obj=None, obj_name=None):
        return {n for n in self._parents
                if (node is None or n is node) and (name is None or n.name == name) and
                (obj is None or obj in (n.mesh, n.camera, n.light)) and
                (obj_name is None or obj_name in [o.name for o in (n.mesh, n.camera, n.light) if o is not None])}

    def has_node(self, node):
        return node in self._parents

    def remove_node(self, node):
        if node not in self._parents:
            raise ArgumentError("the node is not in the scene")
        for child in list(node.children):
            if child in self._parents:
                self.remove_node(child)
        parent = self._parents.pop(node)
        if parent is not None:
            parent.children.remove(node)
        if node is self.main_camera_node:
            self.main_camera_node = next(iter(self.camera_nodes), None)

    def clear(self):
        self._parents.clear()
        self.main_camera_node = None

    def get_pose(self, node):
        if node not in self._parents:
            raise ArgumentError("the node is not in the scene")
        pose = node.matrix
        while (node := self._parents[node]) is not None:
            pose = _product(node.matrix, pose)
        return pose

    def set_pose(self, node, pose):
        """The pose within the node's parent."""
        if node not in self._parents:
            raise ArgumentError("the node is not in the scene")
        node.matrix = np.asarray(pose, float)


def _placed(camera, pose, size):
    if not isinstance(camera, OrthographicCamera):
        return _Camera.opengl(camera.get_projection_matrix(*size), np.array(_r.inverse(np.ascontiguousarray(pose, float))))
    # A parallel projection's matrix does not say where the eye is, from which depth counts.
    eye = pose[:3, 3]
    return _Camera.orthographic(eye, eye - pose[:3, 2], pose[:3, 1], height=2 * camera.ymag * min(1, size[0] / size[1]),
                                near=camera.znear, far=camera.zfar)


class OffscreenRenderer:
    """viewport_width, viewport_height: pixels."""

    def __init__(self, viewport_width, viewport_height, point_size=1.0):
        self.viewport_width, self.viewport_height, self.point_size = viewport_width, viewport_height, point_size
        self._renderer = _Renderer()

    def render(self, scene, flags=RenderFlags.NONE, seg_node_map=None):
        """Returns (color, depth), or only depth with DEPTH_ONLY. color: (H, W, 3) uint8, with RGBA (H, W, 4), with SEG the colours
        of seg_node_map. depth: (H, W) float32 along the axis, 0 where nothing is."""
        if scene.main_camera_node is None:
            raise ArgumentError("the scene has no camera")
        size = self.viewport_width, self.viewport_height
        node = scene.main_camera_node
        camera = _placed(node.camera, scene.get_pose(node), size)
        segmented = bool(flags & RenderFlags.SEG)
        shader = ("wireframe" if flags & RenderFlags.ALL_WIREFRAME else
                  "flat" if flags & RenderFlags.FLAT or segmented else "auto")
        lights = [n.light._placed(scene.get_pose(n)) for n in scene._parents if n.light is not None]
        if scene.ambient_light is not None:
            lights.append(_Light.ambient(color=tuple(display(np.asarray(scene.ambient_light)[:3]))))
        lit = bool(lights) and shader == "auto" and not flags & RenderFlags.DEPTH_ONLY
        things, nodes = [], []
        for n in scene._parents:
            if n.mesh is None or not n.mesh.is_visible:
                continue
            for primitive in n.mesh.primitives:
                make = primitive._geometry(self.point_size, not flags & RenderFlags.FACE_NORMALS, lit)
                poses = [np.eye(4)] if primitive.poses is None else np.asarray(primitive.poses, float).reshape(-1, 4, 4)
                for pose in poses:
                    things.append(make(transform=_product(scene.get_pose(n), pose), id=len(nodes)))
            nodes.append(n)
        outputs = ["depth"]
        if not flags & RenderFlags.DEPTH_ONLY:
            outputs.append("instance" if segmented else "color")
        background = np.clip(np.append(scene.bg_color, 1.0)[:4] if scene.bg_color.shape == (3,) else scene.bg_color, 0, 1)
        picture = self._renderer.render(_Scene(things), camera, size=size, outputs=outputs,
                                        shader="material" if lit else shader, lights=lights if lit else None,
                                        shadows=lit and bool(flags & RenderFlags.SHADOWS_ALL), background=background,
                                        cull="none" if flags & RenderFlags.SKIP_CULL_FACES else "back")
        if flags & RenderFlags.DEPTH_ONLY:
            return picture.depth
        if segmented:
            colors = np.zeros((len(nodes) + 1, 3), np.uint8)  # the last: nothing
            for i, n in enumerate(nodes):
                given = (seg_node_map or {}).get(n)
                if given is not None:
                    given = np.asarray(given)
                    colors[i] = np.round(given[:3] * 255) if given.dtype.kind == "f" else given[:3]
            return colors[picture.instance], picture.depth
        return picture.color if flags & RenderFlags.RGBA else np.ascontiguousarray(picture.color[..., :3]), picture.depth

    def delete(self):
        pass


class Viewer:
    def __init__(self, *arguments, **named):
        raise UnsupportedError("Viewer: Rastrum draws pictures; OffscreenRenderer returns them, `rastrum view` has a window")
