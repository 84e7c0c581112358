"""Scenes, pictures of them, and compositing."""

from __future__ import annotations

import json
import os
from typing import Any, Dict, Iterator, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _render
from .delaunay import Delaunay

Vector = Sequence[float]


class Camera(NamedTuple):
    """Where a picture is taken from, in the coordinates of the scene; `fov` is the vertical field
    of view in degrees."""

    eye: Vector
    at: Vector
    up: Vector = (0.0, 1.0, 0.0)
    fov: float = 40.0


#: A Camera, its four values, or the name or number (from 1) of one in the scene.
CameraLike = Union[Camera, Tuple[Vector, Vector, Vector, float], str, int]


def _camera_text(camera: Optional[CameraLike]) -> str:
    if camera is None:
        return ""
    if isinstance(camera, (str, int)):
        return str(camera)
    eye, at, up, fov = Camera(*camera)
    return ",".join(repr(float(x)) for x in (*eye, *at, *up, fov))


def _arguments(options: Dict[str, Any]) -> List[str]:
    """Keywords as the program's options: spp=16 is --spp=16, no_shadows=True is --no-shadows."""
    arguments = []
    for name, value in options.items():
        flag = "--" + name.replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            arguments.append(flag)
        elif isinstance(value, (tuple, list, np.ndarray)):
            between = "x" if name in ("size", "wall", "bezel") else ","
            arguments.append(f"{flag}={between.join(str(v) for v in value)}")
        else:
            arguments.append(f"{flag}={value}")
    return arguments


class Picture(np.ndarray):
    """(height, width, 4) array of a picture, top row first, premultiplied by alpha: uint8 (sRGB) or
    float32 (linear light). It shows itself in notebooks. Arrays that are made from it are plain."""

    #: (height, width) float32: distances along the view axis, in units of the scene, inf where there
    #: is nothing.
    depth: Optional[NDArray[np.float32]]
    #: Further (height, width) float32 arrays by name, with aovs=True: "normal.X" ...
    channels: Dict[str, NDArray[np.float32]]
    #: Of the 8-bit pixels, as `delray render --stats` has it.
    hash: str
    #: As `delray render --stats` writes them.
    statistics: Dict[str, Any]

    def __array_finalize__(self, made_from: Any) -> None:
        self.depth, self.channels, self.hash, self.statistics = None, {}, "", {}

    def __array_wrap__(self, array: Any, context: Any = None) -> Any:
        return np.asarray(array)[()]

    def png(self) -> bytes:
        """The picture as the bytes of a PNG file."""
        pixels = np.asarray(self)
        return _render.encode_png(pixels if pixels.dtype == np.uint8 else _coded(pixels))

    def save(self, path: Union[str, os.PathLike]) -> None:
        """Writes it as a PNG file."""
        with open(path, "wb") as file:
            file.write(self.png())

    def _repr_png_(self) -> Optional[bytes]:
        return self.png() if self.ndim == 3 and self.shape[-1] == 4 else None


def _coded(pixels: NDArray[np.float32]) -> NDArray[np.uint8]:
    """Linear light as sRGB bytes."""
    linear = np.clip(np.nan_to_num(pixels), 0, 1)
    coded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    coded[..., 3] = linear[..., 3]
    return np.round(coded * 255).astype(np.uint8)


def _picture(made: Optional[tuple]) -> Optional[Picture]:
    if made is None:
        return None
    pixels, depth, channels, digest, statistics = made
    picture = pixels.view(Picture)
    picture.depth, picture.channels, picture.hash = depth, channels, digest
    picture.statistics = json.loads(statistics) if statistics else {}
    return picture


class Scene:
    """Meshes and points with materials, lights and instances.

    origin : three coordinates that all positions are relative to inside, where 32-bit floats are
        enough; for large ones, such as UTM, a place in the scene.
    z_up : whether z points up, or y.
    """

    def __init__(self, origin: Vector = (0.0, 0.0, 0.0), z_up: bool = False) -> None:
        self._scene = _render.Scene([float(x) for x in origin], z_up)

    @classmethod
    def load(cls, path: Union[str, os.PathLike], **options: Any) -> "Scene":
        """Reads a scene, mesh or points (glTF, OBJ, PLY, STL, LAS ...), or makes a generated scene
        such as "gen:city:100000". Options are those of `delray render` that say how a scene is read:
        color_by, exaggeration, show_as, point_size, radius, up ..."""
        scene = cls.__new__(cls)
        scene._scene = _render.load_scene(_arguments(options) + ["--", os.fspath(path)])
        return scene

    @classmethod
    def from_triangulation(
        cls,
        mesh: Delaunay,
        heights: Optional[ArrayLike] = None,
        colors: Optional[ArrayLike] = None,
        **material: Any,
    ) -> "Scene":
        """A surface over x and y, with z up: the heights (n,), or the third column of the points,
        else 0. Of a triangulation in space its hull."""
        points = mesh.points
        if heights is None:
            heights = points[:, 2] if points.shape[1] == 3 else np.zeros(len(points))
        positions = np.column_stack((points[:, :2], np.asarray(heights, np.float64)))
        origin = positions.mean(axis=0).round() if len(positions) else np.zeros(3)
        scene = cls(origin, z_up=True)
        number = scene.add_material(**material) if material else 0
        triangles = mesh.simplices if mesh.ndim == 2 else mesh.convex_hull
        scene.add_mesh(positions, triangles, colors=colors, material=number)
        return scene

    def add_mesh(
        self,
        positions: ArrayLike,
        triangles: ArrayLike,
        *,
        normals: Optional[ArrayLike] = None,
        uvs: Optional[ArrayLike] = None,
        colors: Optional[ArrayLike] = None,
        material: int = 0,
        transform: Optional[ArrayLike] = None,
        place: bool = True,
    ) -> int:
        """Adds a mesh, placed once unless `place` is False, and returns its number.

        positions : (n, 3). triangles : (m, 3) rows of positions, counterclockwise from outside.
        normals : (n, 3); without, smooth ones are made. uvs : (n, 2), v downwards.
        colors : (n, 3 or 4) uint8 (sRGB) or floats (linear), times the material's colour.
        transform : (3 or 4, 4), acts on columns (x, y, z, 1).
        """
        return self._scene.add_mesh(
            positions, triangles, normals, uvs, colors, material, transform, place
        )

    def add_points(
        self,
        positions: ArrayLike,
        *,
        colors: Optional[ArrayLike] = None,
        shape: str = "disc",
        radius: Optional[float] = None,
        size: Optional[float] = None,
        material: int = 0,
        transform: Optional[ArrayLike] = None,
        place: bool = True,
    ) -> int:
        """Adds (n, 3) points as "point", "disc" or "sphere", of a radius in units of the scene or a
        size (diameter) in pixels, by default 1. Returns the number of the mesh that they are."""
        return self._scene.add_points(
            positions, colors, shape, radius, size, material, transform, place
        )

    def add_instance(self, mesh: int, transform: Optional[ArrayLike] = None) -> int:
        """Places a mesh once more, and returns the instance's number."""
        return self._scene.add_instance(mesh, transform)

    def add_material(
        self,
        base_color: Vector = (0.8, 0.8, 0.8, 1.0),
        *,
        metallic: float = 0.0,
        roughness: float = 0.6,
        transmission: float = 0.0,
        ior: float = 1.5,
        emission: Vector = (0.0, 0.0, 0.0),
        unlit: bool = False,
        double_sided: bool = True,
        texture: Optional[ArrayLike] = None,
    ) -> int:
        """Adds a material of glTF's metallic-roughness model, and returns its number. Colours are
        linear; an alpha below 1 is see-through. texture : (height, width, 3 or 4) uint8, sRGB."""
        return self._scene.add_material(
            list(base_color), metallic, roughness, transmission, ior, list(emission), unlit,
            double_sided, texture,
        )  # fmt: skip

    def add_light(
        self,
        kind: str = "directional",
        color: Vector = (1.0, 1.0, 1.0),
        *,
        position: Vector = (0.0, 0.0, 0.0),
        direction: Vector = (0.0, 0.0, -1.0),
        edge_u: Vector = (0.0, 0.0, 0.0),
        edge_v: Vector = (0.0, 0.0, 0.0),
    ) -> None:
        """Adds a light: "directional" (irradiance, along `direction`), "point" (radiant intensity,
        at `position`) or "area" (radiance, from the parallelogram at `position` with `edge_u` and
        `edge_v`, on the side of their cross product). A scene without light gets a key light and a
        sky."""
        self._scene.add_light(
            kind, list(color), list(position), list(direction), list(edge_u), list(edge_v)
        )

    def set_sky(self, zenith: Vector, horizon: Vector, ground: Vector) -> None:
        """Light from everywhere: radiance from horizon to zenith above, and to ground below."""
        self._scene.set_sky(list(zenith), list(horizon), list(ground))

    @property
    def bounds(self) -> Tuple[Tuple[float, ...], Tuple[float, ...]]:
        """The least and the greatest coordinates."""
        return self._scene.bounds

    @property
    def triangles(self) -> int:
        """Number of triangles of all instances."""
        return self._scene.triangles

    @property
    def points(self) -> int:
        """Number of points of all instances."""
        return self._scene.points

    @property
    def cameras(self) -> List[str]:
        """Names of the cameras that the scene's file has."""
        return self._scene.cameras

    def _repr_png_(self) -> Optional[bytes]:
        if self.triangles + self.points == 0:
            return None
        return render(self, size=(640, 480)).png()

    def __repr__(self) -> str:
        return f"<delray.Scene: {self.triangles} triangles, {self.points} points>"


SceneLike = Union[Scene, Delaunay, str, os.PathLike]


class Communicator:
    """The ranks of an mpi4py communicator, which is duplicated: for calls over the same ranks again
    and again. Collective; the calls are made by one thread of each process."""

    def __init__(self, comm: Any) -> None:
        from mpi4py import MPI

        self._ranks = _render.Communicator(MPI._addressof(comm))

    @property
    def rank(self) -> int:
        """The number of this one, from 0."""
        return self._ranks.rank

    @property
    def size(self) -> int:
        """How many there are."""
        return self._ranks.size


def _ranks(comm: Any) -> Any:
    if comm is None:
        return None
    return (comm if isinstance(comm, Communicator) else Communicator(comm))._ranks


class Renderer:
    """A scene ready for pictures: acceleration structures and textures are built once, of a copy of
    the scene.

    scene : a Scene, a Delaunay, or whatever Scene.load() takes, with its options.
    camera : a Camera or its four values, or the name or number of one in the scene; by default the
        scene's own first, else one that shows everything. `view` chooses other such ones: "top" ...
    size : width and height in pixels.
    engine : "raster" or "raytrace".
    dtype : uint8, or float32 for linear light.
    comm : an mpi4py communicator or a Communicator, whose ranks render together; rank 0 gets the
        picture, others None. Every rank has the same scene.
    options : whatever else `render_options()` explains, such as spp=64, integrator="path",
        samples=2, background="#ffffff", ranks=4, strategy="sort-first", denoise=True.

    Options that cannot be, or have no effect with the others, raise ValueError.
    """

    def __init__(
        self,
        scene: SceneLike,
        camera: Optional[CameraLike] = None,
        *,
        size: Tuple[int, int] = (1280, 720),
        engine: str = "raster",
        dtype: Any = np.uint8,
        comm: Any = None,
        **options: Any,
    ) -> None:
        dtype = np.dtype(dtype)
        if dtype not in (np.uint8, np.float32):
            raise ValueError(f"dtype: {dtype} is neither uint8 nor float32")
        arguments = _arguments(dict(options, size=size, engine=engine))
        if camera is not None:
            arguments.append(f"--camera={_camera_text(camera)}")
        if isinstance(scene, Delaunay):
            scene = Scene.from_triangulation(scene)
        if not isinstance(scene, Scene):
            arguments += ["--", os.fspath(scene)]
        handle = scene._scene if isinstance(scene, Scene) else None
        self._renderer = _render.Renderer(handle, arguments, dtype == np.float32, _ranks(comm))

    def render(self, camera: Optional[CameraLike] = None) -> Optional[Picture]:
        """The picture from a camera, by default the renderer's own. A light that was added for the
        renderer's camera stays where it is."""
        return _picture(self._renderer.render(_camera_text(camera)))


def render(
    scene: SceneLike, camera: Optional[CameraLike] = None, **options: Any
) -> Optional[Picture]:
    """A picture of a scene, as an array; see Renderer, which makes many."""
    return Renderer(scene, camera, **options).render()


class Progressive:
    """A ray traced picture that grows in the background.

    Iterating gives pictures with more and more samples, the newest when it is asked for, and ends
    with the finished one. `stop()`, leaving a `with` block, or Ctrl-C end the work before.
    Arguments are those of Renderer; engine is "raytrace".

        >>> with delray.Progressive("gen:cornell", integrator="path", spp=4096) as growing:
        ...     for picture in growing:
        ...         show(picture)
        ...         if good(picture): break
    """

    def __init__(
        self, scene: SceneLike, camera: Optional[CameraLike] = None, **options: Any
    ) -> None:
        options.setdefault("engine", "raytrace")
        self._renderer = Renderer(scene, camera, **options)
        self._growing = _render.Growing(self._renderer._renderer)
        #: The last picture that was given.
        self.picture: Optional[Picture] = None

    def __iter__(self) -> Iterator[Picture]:
        return self

    def __next__(self) -> Picture:
        picture = _picture(self._growing.next())
        if picture is None:
            raise StopIteration
        self.picture = picture
        return picture

    def stop(self) -> None:
        """Ends the work; the last picture stays."""
        self._growing.stop()

    def __enter__(self) -> "Progressive":
        return self

    def __exit__(self, *ignored: Any) -> None:
        self.stop()

    def _repr_png_(self) -> Optional[bytes]:
        return None if self.picture is None else self.picture.png()


def render_options() -> Dict[str, str]:
    """Options of Renderer, and what they mean. A name such as "color-by" is the keyword color_by."""
    return _render.render_options()


def compose(
    rgba: ArrayLike,
    depth: Optional[ArrayLike] = None,
    *,
    comm: Any,
    scheme: str = "radix-k",
    codec: str = "active",
    interlace: bool = False,
    root: int = 0,
    empty_depth: float = np.inf,
    threads: Optional[int] = None,
) -> Optional[Tuple[NDArray[Any], Optional[NDArray[np.float32]]]]:
    """Merges the images of all ranks of an mpi4py communicator (or a Communicator); collective.

    rgba : (height, width, 4) uint8 or float32, premultiplied by alpha.
    depth : (height, width) float32, smaller is nearer, `empty_depth` where there is nothing; the
        nearest pixel wins, of equally near ones that of the lower rank. Without, images lie over
        each other, that of rank 0 in front.
    scheme, codec : of `schemes()` and `codecs()`: who sends what to whom, and how it is packed.
    root : the rank that gets (rgba, depth); others get None.
    threads : of each rank; 1 by default.
    """
    return _render.compose(
        _ranks(comm), rgba, depth, scheme, codec, interlace, root, empty_depth, threads
    )


def schemes() -> Dict[str, str]:
    """Names of compositing schemes, and what they do."""
    return _render.schemes()


def codecs() -> Dict[str, str]:
    """Names of encodings of pixels between ranks, and what they do."""
    return _render.codecs()
