# Types for type checkers and editors; tests/test_stubs.py compares this file with the package.
from collections.abc import Callable, Iterable, Mapping, Sequence
from os import PathLike
from typing import Any, Literal, NamedTuple, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import mpi as mpi

__version__: str
__all__: list[str]

Color = str | Sequence[float]
_Texture = ArrayLike | str | PathLike[str] | None
Output = Literal["color", "color_f32", "depth", "depth_raw", "distance", "id", "instance", "face", "barycentrics", "normal",
                 "camera_normal", "position", "albedo", "linear", "scalars"]
OUTPUTS: dict[str, tuple[type, int]]

class Error(Exception): ...
class ArgumentError(Error, ValueError): ...
class ArgumentTypeError(Error, TypeError): ...
class NotFoundError(Error, FileNotFoundError): ...
class MissingOutputError(Error, AttributeError): ...
class PictureIndexError(Error, IndexError): ...
class FileError(Error, OSError): ...
class FormatError(Error, ValueError): ...
class UnsupportedError(Error, NotImplementedError): ...
class OutOfMemoryError(Error, MemoryError): ...
class DeviceError(Error, RuntimeError): ...
class OddInputWarning(UserWarning): ...

class Material:
    def __init__(self, base_color: Color = "white", *, metallic: float = 0.0, roughness: float = 1.0,
                 emissive: Color = "black", alpha_mode: Literal["opaque", "mask", "blend"] = "opaque",
                 alpha_cutoff: float = 0.5, double_sided: bool = True, unlit: bool = False, opacity: float = 1.0,
                 base_color_texture: _Texture = None, metallic_roughness_texture: _Texture = None,
                 normal_texture: _Texture = None, occlusion_texture: _Texture = None,
                 emissive_texture: _Texture = None) -> None: ...

class ColorMapping:
    def __init__(self, cmap: Any = "viridis", clim: Sequence[float] | None = None, *, log: bool = False, symmetric: bool = False,
                 steps: int = 0, categories: Iterable[float] = (), below: Color | None = None, above: Color | None = None,
                 nan: Color = (0.5, 0.5, 0.5), opacity: Iterable[tuple[float, float]] = (), isolines: int | Iterable[float] = (),
                 isoline_color: Color = "black", isoline_width: float = 1.0) -> None: ...

def color_maps() -> list[str]: ...

class _Thing:
    color: Color | None
    opacity: float
    material: Material | None
    transform: ArrayLike | None
    visible: bool
    id: int | None
    winding: str
    clip_planes: ArrayLike
    scalars: NDArray[Any] | None
    mapping: ColorMapping | None
    @property
    def primitives(self) -> int: ...

# `look`: color, opacity, material, transform, visible, id, winding, clip_planes, scalars, cmap, clim.
class Mesh(_Thing):
    def __init__(self, positions: ArrayLike, indices: ArrayLike | None = None, *, offsets: ArrayLike | None = None,
                 normals: ArrayLike | None = None, uv: ArrayLike | None = None, colors: ArrayLike | None = None,
                 per: Literal["vertex", "face", "corner"] | None = None, copy: bool | None = None, **look: Any) -> None: ...
    def prepare(self, threads: int = 0) -> Mesh: ...

class Points(_Thing):
    def __init__(self, positions: ArrayLike, *, size: ArrayLike = 3.0, round: bool = True, normals: ArrayLike | None = None,
                 colors: ArrayLike | None = None, copy: bool | None = None, **look: Any) -> None: ...

class Lines(_Thing):
    def __init__(self, positions: ArrayLike, indices: ArrayLike | None = None, *, offsets: ArrayLike | None = None,
                 width: float = 1.0, colors: ArrayLike | None = None, copy: bool | None = None, **look: Any) -> None: ...

class Spheres(_Thing):
    def __init__(self, centers: ArrayLike, radius: ArrayLike = 1.0, *, colors: ArrayLike | None = None,
                 copy: bool | None = None, **look: Any) -> None: ...

class Cylinders(_Thing):
    def __init__(self, positions: ArrayLike, indices: ArrayLike | None = None, radius: ArrayLike = 1.0, *,
                 caps: bool = True, colors: ArrayLike | None = None, copy: bool | None = None, **look: Any) -> None: ...

class Tubes(_Thing):
    def __init__(self, positions: ArrayLike, offsets: ArrayLike | None = None, radius: ArrayLike = 1.0, *,
                 colors: ArrayLike | None = None, copy: bool | None = None, **look: Any) -> None: ...

class Discs(_Thing):
    def __init__(self, centers: ArrayLike, normals: ArrayLike, radius: ArrayLike = 1.0, *, colors: ArrayLike | None = None,
                 copy: bool | None = None, **look: Any) -> None: ...

class Light:
    def __init__(self, kind: str, place: Sequence[float] = (0, 0, 0), direction: Sequence[float] = (0, 0, -1),
                 below: Color = "black", range: float = ..., inner: float = 0.0, outer: float = 45.0, *, color: Color = "white",
                 intensity: float = 1.0, of_camera: bool = False) -> None: ...
    @classmethod
    def ambient(cls, **look: Any) -> Light: ...
    @classmethod
    def hemisphere(cls, up: Sequence[float] = (0, 1, 0), below: Color = "black", **look: Any) -> Light: ...
    @classmethod
    def directional(cls, direction: Sequence[float] = (0, 0, -1), **look: Any) -> Light: ...
    @classmethod
    def point(cls, position: Sequence[float], range: float = ..., **look: Any) -> Light: ...
    @classmethod
    def spot(cls, position: Sequence[float], direction: Sequence[float], inner: float = 0.0, outer: float = 45.0,
             range: float = ..., **look: Any) -> Light: ...

class Scene:
    files: list[str]
    things: list[_Thing]
    def __init__(self, things: Any = (), copy: bool | None = None, crease: float | None = 40.0, *, scalars: str | None = None,
                 cmap: Any = "viridis", clim: Sequence[float] | None = None, memory_limit: int | None = None,
                 allow_outside: bool = True) -> None: ...
    @property
    def primitives(self) -> int: ...
    @property
    def instances(self) -> int: ...
    @property
    def warnings(self) -> list[str]: ...
    @property
    def bounds(self) -> tuple[Sequence[float], Sequence[float]] | None: ...

def load(path: str | PathLike[str], *, crease: float | None = 40.0, scalars: str | None = None, cmap: Any = "viridis",
         clim: Sequence[float] | None = None, memory_limit: int | None = None, allow_outside: bool = True) -> Scene: ...
def crease_normals(positions: ArrayLike, indices: ArrayLike, degrees: float = 40.0) -> NDArray[np.float32]: ...
def as_scene(what: Any, copy: bool | None = None) -> Scene: ...

class Camera:
    def __init__(self, make: Callable[[tuple[int, int], Any], Any], asks: bool = False) -> None: ...
    @staticmethod
    def look_at(eye: Sequence[float], target: Sequence[float] = (0, 0, 0), up: Sequence[float] = (0, 1, 0), *,
                fov: float = 60.0, near: float | None = None, far: float = ...) -> Camera: ...
    @staticmethod
    def orthographic(eye: Sequence[float], target: Sequence[float] = (0, 0, 0), up: Sequence[float] = (0, 1, 0), *,
                     height: float, near: float | None = None, far: float | None = None) -> Camera: ...
    @staticmethod
    def fit(what: Any, view: str | Sequence[float] = "front", *, up: Sequence[float] = (0, 1, 0), fov: float = 60.0,
            orthographic: bool = False) -> Camera: ...
    @staticmethod
    def opencv(K: ArrayLike, R: ArrayLike | None = None, t: ArrayLike | None = None, *, near: float | None = None,
               first_centre: float = 0.0) -> Camera: ...
    @staticmethod
    def opengl(projection: ArrayLike, view: ArrayLike | None = None, *, depth: str = "opengl") -> Camera: ...

def orbit(what: Any, n: int, *, elevation: float = 25.0, up: Sequence[float] = (0, 1, 0), fov: float = 60.0) -> list[Camera]: ...

class Hit(NamedTuple):
    id: int
    instance: int
    face: int
    barycentrics: tuple[float, float, float]
    position: tuple[float, float, float]
    normal: tuple[float, float, float]
    depth: float
    distance: float
    scalar: float | None = None

class _Fields:
    arrays: dict[str, NDArray[Any]]
    color: NDArray[np.uint8]
    color_f32: NDArray[np.float32]
    depth: NDArray[np.float32]
    depth_raw: NDArray[np.float32]
    distance: NDArray[np.float32]
    id: NDArray[np.integer[Any]]
    instance: NDArray[np.integer[Any]]
    face: NDArray[np.integer[Any]]
    barycentrics: NDArray[np.float32]
    normal: NDArray[np.float32]
    camera_normal: NDArray[np.float32]
    position: NDArray[np.float32]
    albedo: NDArray[np.float32]
    linear: NDArray[np.float32]
    scalars: NDArray[np.float32]

class Picture(_Fields):
    stats: dict[str, Any]
    def __init__(self, arrays: dict[str, NDArray[Any]], stats: dict[str, Any], pick: Callable[[int, int], Hit | None], files: tuple[str, ...] = ()) -> None: ...
    def pick(self, x: int, y: int) -> Hit | None: ...
    def save(self, path: str | PathLike[str], output: str | None = None) -> Picture: ...
    def pil(self) -> Any: ...

class Pictures(_Fields):
    stats: list[dict[str, Any]]
    def __init__(self, arrays: dict[str, NDArray[Any]], stats: list[dict[str, Any]], picks: list[Any], files: tuple[str, ...] = ()) -> None: ...
    def __len__(self) -> int: ...
    @overload
    def __getitem__(self, i: int) -> Picture: ...
    @overload
    def __getitem__(self, i: slice) -> Pictures: ...
    def save(self, path: str | PathLike[str], output: str | None = None) -> Pictures: ...
    def sheet(self, columns: int | None = None) -> Picture: ...

class Renderer:
    def __init__(self, *, threads: int | None = None, memory_limit: int = 0, device: str = "threads",
                 isa: str | None = None) -> None: ...
    @overload
    def render(self, what: Any, camera: Camera | None = None, *, size: tuple[int, int] = (1280, 720),
               outputs: Output | Iterable[Output] = "color", shader: str = "auto", background: Color | None = None,
               samples: int = 1, transparency: str = "exact", cull: str = "none", opacity: float = 1.0,
               clip_planes: ArrayLike = (), lights: str | Light | Sequence[str | Light] | None = None,
               shadows: bool = False, shadow_size: int = 0, shadow_distance: float = 0.0, tone: str = "none", exposure: float = 0.0, environment_behind: bool = False, annotate: str | Iterable[str] | Mapping[str, Any] = (),
               out: Mapping[str, NDArray[Any]] | None = None,
               progress: Callable[[int, int], None] | bool | None = None) -> Picture: ...
    @overload
    def render(self, what: Any, camera: Sequence[Camera] | NDArray[Any], *, size: tuple[int, int] = (1280, 720),
               outputs: Output | Iterable[Output] = "color", shader: str = "auto", background: Color | None = None,
               samples: int = 1, transparency: str = "exact", cull: str = "none", opacity: float = 1.0,
               clip_planes: ArrayLike = (), lights: str | Light | Sequence[str | Light] | None = None,
               shadows: bool = False, shadow_size: int = 0, shadow_distance: float = 0.0, tone: str = "none", exposure: float = 0.0, environment_behind: bool = False, annotate: str | Iterable[str] | Mapping[str, Any] = (),
               out: Mapping[str, NDArray[Any]] | None = None,
               progress: Callable[[int, int], None] | bool | None = None) -> Pictures: ...

class Terrain:
    def __init__(self, heights: ArrayLike | str | PathLike[str], colors: ArrayLike | str | PathLike[str] | None = None, *,
                 height_scale: float | None = None, sun: Sequence[float] | None = None,
                 shadows: str = "none", ambient: float = 0.45, sun_radius: float = 0.2666, filter: str = "bilinear",
                 tiling: str = "repeat", threads: int | None = None, lights: Any = None, tone: str = "none",
                 exposure: float = 0.0, cmap: Any = None, clim: tuple[float, float] | None = None) -> None: ...
    @property
    def heights(self) -> tuple[float, float]: ...
    def ground_at(self, x: float, y: float) -> float: ...
    def render(self, position: Sequence[float] | None = None, *, altitude: float | None = None, angle: float = 0.0,
               horizon: float | None = None, roll: float = 0.0, clearance: float | None = None,
               size: tuple[int, int] = (1280, 720), distance: float = 800.0, fov: float = 90.0, scale: float = 0.0,
               projection: str = "planar", sky: Color | None = None, fog: Any = None, depth: bool = False,
               environment_behind: bool = False, annotate: Any = ()) -> Picture: ...

class View:
    def __init__(self, what: Any, camera: Camera | None = None, *, size: tuple[int, int] = (800, 600),
                 target_ms: float = 33.0, threads: int | None = None, **frame: Any) -> None: ...
    @property
    def widget(self) -> Any: ...
    @property
    def camera(self) -> Camera: ...
    @camera.setter
    def camera(self, camera: Camera | None) -> None: ...
    def picture(self) -> Picture: ...
    def update(self) -> None: ...

def render(what: Any, camera: Any = None, *, threads: int | None = None, device: str = "threads", memory_limit: int = 0,
           isa: str | None = None, **frame: Any) -> Any: ...
def rasterize(pos: ArrayLike, tri: ArrayLike, resolution: tuple[int, int], ranges: ArrayLike | None = None, *,
              out: NDArray[np.float32] | None = None, copy: bool | None = None,
              threads: int | None = None) -> NDArray[np.float32]: ...
def views4(what: Any, *, size: tuple[int, int] = (512, 512), **frame: Any) -> Picture: ...
def digest(array: ArrayLike) -> str: ...
def draw_behind(ax: Any, what: Any, **frame: Any) -> Any: ...
def trimesh_viewer(scene: Any, **frame: Any) -> Any: ...
