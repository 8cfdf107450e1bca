"""The library, for the package's Python files alone."""

from typing import Any, Callable, Optional, Sequence

import numpy as np
import numpy.typing as npt

version: str
point_formats: tuple[str, ...]
length_units: tuple[str, ...]

class _Enumeration:
    __members__: dict[str, Any]

class Method(_Enumeration):
    automatic: Method
    basic: Method
    extended: Method

class NormalSource(_Enumeration):
    automatic: NormalSource
    given: NormalSource
    estimate: NormalSource

class Holes(_Enumeration):
    automatic: Holes
    keep: Holes
    close: Holes
    complete: Holes

class Grid(_Enumeration):
    automatic: Grid
    uniform: Grid
    adaptive: Grid

class ReconstructOptions:
    depth: Optional[int]
    voxel_size: Optional[float]
    grid: Grid
    method: Method
    normals: NormalSource
    holes: Holes
    merge_layers: bool
    confidence: bool
    trim: float
    crease_angle: float
    normal_smoothing: int
    threads: int
    classify: bool
    vertex_normals: bool
    measure: bool
    def __init__(self) -> None: ...
    def set_max_error(self, value: float, of_diagonal: bool) -> None: ...
    def set_debug_dir(self, folder: bytes) -> None: ...
    def set_min_component(self, value: float, of_largest: bool) -> None: ...

class Polygons:
    def __init__(
        self,
        positions: npt.NDArray[np.float64],
        corners: npt.NDArray[np.uint32],
        first: npt.NDArray[np.uint32],
        normals: npt.NDArray[np.float64],
        sharp_edges: npt.NDArray[np.uint32],
        properties: dict[bytes, npt.NDArray[Any]],
    ) -> None: ...
    @property
    def positions(self) -> npt.NDArray[np.float64]: ...
    @property
    def normals(self) -> npt.NDArray[np.float64]: ...
    @property
    def corners(self) -> npt.NDArray[np.uint32]: ...
    @property
    def first(self) -> npt.NDArray[np.uint32]: ...
    @property
    def sharp_edges(self) -> npt.NDArray[np.uint32]: ...
    def properties(self) -> dict[str, npt.NDArray[Any]]: ...
    def triangles(self) -> npt.NDArray[np.uint32]: ...
    def write(self, path: bytes, ascii: bool, units: str, recentre: bool) -> tuple[float, float, float]: ...
    def digest(self) -> str: ...

class Cloud:
    @property
    def positions(self) -> npt.NDArray[np.float64]: ...
    @property
    def normals(self) -> npt.NDArray[np.float64]: ...
    @property
    def colors(self) -> npt.NDArray[np.uint8]: ...
    @property
    def scalars(self) -> dict[str, npt.NDArray[np.float64]]: ...
    @property
    def labels(self) -> dict[str, npt.NDArray[np.float64]]: ...
    @property
    def sensor(self) -> Optional[tuple[float, float, float]]: ...
    @property
    def sensors(self) -> npt.NDArray[np.float64]: ...
    @property
    def sensor_of(self) -> npt.NDArray[np.int32]: ...
    @property
    def format(self) -> str: ...
    @property
    def faces(self) -> int: ...
    @property
    def nonfinite(self) -> int: ...
    @property
    def withheld(self) -> int: ...
    @property
    def first_withheld(self) -> Optional[tuple[float, float, float]]: ...
    @property
    def columns(self) -> str: ...

class View:
    def __init__(
        self,
        positions: npt.NDArray[Any],
        normals: Optional[npt.NDArray[Any]],
        colors: Optional[npt.NDArray[Any]],
        sensor: Optional[tuple[float, float, float]],
        sensors: Optional[list[list[float]]],
        sensor_of: Optional[npt.NDArray[np.int32]],
    ) -> None: ...
    def add_scalar(self, name: bytes, values: npt.NDArray[Any], is_label: bool) -> None: ...
    def note_file(self, cloud: Cloud) -> None: ...
    def address(self) -> int: ...

def read_points(
    path: bytes, format: str, columns: str, sensors: Sequence[tuple[float, float, float]], sensor_column: str
) -> Cloud: ...
def read_mesh(path: bytes) -> Polygons: ...
def reconstruct(
    view: View, options: ReconstructOptions, progress: Optional[Callable[[str, float], Optional[bool]]]
) -> tuple[Polygons, str]: ...
def reconstruct_levels(
    view: View,
    first_depth: int,
    last_depth: int,
    options: ReconstructOptions,
    progress: Optional[Callable[[str, float], Optional[bool]]],
) -> list[tuple[Polygons, str]]: ...
def process(polygons: Polygons, stages: list[bytes]) -> tuple[Polygons, list[str]]: ...
def compare(a: Polygons, b: Polygons, samples: int) -> dict[str, Any]: ...
def topology(polygons: Polygons) -> dict[str, Any]: ...
