# The compiled half of the package; see rendering.py and comparing.py for what it means.
from typing import Any, Dict, List, Optional, Sequence, Tuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

class Scene:
    def __init__(self, origin: Sequence[float], z_up: bool) -> None: ...
    def add_mesh(
        self,
        positions: ArrayLike,
        triangles: ArrayLike,
        normals: Optional[ArrayLike],
        uvs: Optional[ArrayLike],
        colors: Optional[ArrayLike],
        material: int,
        transform: Optional[ArrayLike],
        place: bool,
    ) -> int: ...
    def add_points(
        self,
        positions: ArrayLike,
        colors: Optional[ArrayLike],
        shape: str,
        radius: Optional[float],
        size: Optional[float],
        material: int,
        transform: Optional[ArrayLike],
        place: bool,
    ) -> int: ...
    def add_instance(self, mesh: int, transform: Optional[ArrayLike]) -> int: ...
    def add_material(
        self,
        base_color: Sequence[float],
        metallic: float,
        roughness: float,
        transmission: float,
        ior: float,
        emission: Sequence[float],
        unlit: bool,
        double_sided: bool,
        texture: Optional[ArrayLike],
    ) -> int: ...
    def add_light(
        self,
        kind: str,
        color: Sequence[float],
        position: Sequence[float],
        direction: Sequence[float],
        edge_u: Sequence[float],
        edge_v: Sequence[float],
    ) -> None: ...
    def set_sky(
        self, zenith: Sequence[float], horizon: Sequence[float], ground: Sequence[float]
    ) -> None: ...
    @property
    def bounds(self) -> Tuple[Tuple[float, ...], Tuple[float, ...]]: ...
    @property
    def triangles(self) -> int: ...
    @property
    def points(self) -> int: ...
    @property
    def meshes(self) -> int: ...
    @property
    def instances(self) -> int: ...
    @property
    def cameras(self) -> List[str]: ...

class Communicator:
    def __init__(self, address: int) -> None: ...
    @property
    def rank(self) -> int: ...
    @property
    def size(self) -> int: ...

class Renderer:
    def __init__(
        self,
        scene: Optional[Scene],
        arguments: Sequence[str],
        floats: bool,
        communicator: Optional[Communicator],
    ) -> None: ...
    def render(self, camera: str) -> Optional[Tuple[Any, ...]]: ...

class Growing:
    def __init__(self, renderer: Renderer) -> None: ...
    def next(self) -> Optional[Tuple[Any, ...]]: ...
    def stop(self) -> None: ...

def load_scene(arguments: Sequence[str]) -> Scene: ...
def encode_png(rgba: ArrayLike) -> bytes: ...
def render_options() -> Dict[str, str]: ...
def compose(
    communicator: Communicator,
    rgba: ArrayLike,
    depth: Optional[ArrayLike],
    scheme: str,
    codec: str,
    interlace: bool,
    root: int,
    empty_depth: float,
    threads: Optional[int],
) -> Optional[Tuple[NDArray[Any], Optional[NDArray[np.float32]]]]: ...
def schemes() -> Dict[str, str]: ...
def codecs() -> Dict[str, str]: ...
def compare(arguments: Sequence[str]) -> str: ...
