"""Types of options, for `**` and for type checkers: ``options: neurotess.MeshOptions = {"level": 2}``."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, TypedDict, Union

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ._colormaps import Colormap
    from ._colors import Color
    from ._meshes import Mesh
    from ._morphology import File, Morphology
    from ._nodes import Nodes
    from ._scene import DrawnCircuit
    from ._values import Values

    Drawable: TypeAlias = Union[Morphology, DrawnCircuit, File, Any]

ColorBy = Literal["type", "neurite", "section", "order", "radius", "depth", "neuron", "value"]
OwnColormap = Literal["viridis", "magma", "inferno", "plasma", "cividis"]
Side = Literal["front", "back", "left", "right", "top", "bottom", "iso"]


class MeshOptions(TypedDict, total=False):
    """The options of `mesh`."""

    level: int | None
    max_error: float | None
    level_along: int | None
    isotropic: bool | float
    max_edge: float | None
    min_edge: float | None
    max_aspect: float | None
    path: Literal["hermite", "linear"] | None
    caps: Literal["round", "flat"] | None
    crossings: Literal["keep", "merge", "separate"] | None
    simulation: bool
    soma: Literal["fem", "sphere", "profile", "none"] | None
    poisson: float | None
    soma_keep: Literal["volume", "area", "scale"] | None
    soma_mesh: str | os.PathLike[str] | None
    soma_scale: float | None
    radii: Literal["traced", "equal-area", "equal-perimeter"] | None
    radius_factor: float | None
    radius: float | None
    min_radius: float | None
    soma_sphere: Literal["cube", "octahedron"] | None
    soma_level: int | None
    ring: Mapping[int, float] | None
    smooth: float | Literal["auto"] | None
    types: Sequence[str | int] | str | None
    quads: bool


class SceneMesh(TypedDict, total=False):
    """A mesh beside the cells, and how it looks."""

    mesh: Mesh | str | os.PathLike[str] | Any
    color: Color
    values: ArrayLike
    opacity: float
    edges: bool
    scale: float
    fit: bool


if TYPE_CHECKING:
    Meshes: TypeAlias = Union[Mesh, str, os.PathLike[str], SceneMesh, Iterable[Any]]


class Camera(TypedDict, total=False):
    """From where `render` looks."""

    view: Side | None
    eye: Sequence[float] | None
    target: Sequence[float] | None
    up: Sequence[float] | None
    fov: float | None
    orthographic: bool | float


class Scene(TypedDict, total=False):
    """What is around the cells in `render`."""

    background: Color | None
    transparent: bool
    light: str | Sequence[float] | None
    ao: float | None
    meshes: Meshes | None
    legend: bool
    scale_bar: bool | float
    axes: bool


class Markers(TypedDict, total=False):
    """Synapses or points in `render`, and how they look."""

    synapses: bool | str | Sequence[str]
    side: Literal["afferent", "efferent"] | None
    points: str | os.PathLike[str] | None
    color_by: str | None
    shape: Literal["point", "sphere", "contact"] | None
    size: float | None


class RenderOptions(TypedDict, total=False):
    """The options of `render`."""

    camera: Camera | None
    scene: Scene | None
    markers: Markers | None
    size: tuple[int, int] | None
    color_by: ColorBy | None
    color_by_attribute: str | None
    values: Values | None
    times: ArrayLike | None
    title: str | None
    unit: str | None
    report: str | os.PathLike[str] | None
    time: float | None
    range: tuple[float, float] | None
    palette: str | os.PathLike[str] | Mapping[str, Color] | None
    colormap: Colormap | None
    trim_colormap: bool
    legend: bool
    scale_bar: bool | float
    axes: bool
    background: Color | None
    transparent: bool
    samples: int | None
    view: Side | None
    eye: Sequence[float] | None
    target: Sequence[float] | None
    up: Sequence[float] | None
    fov: float | None
    orthographic: bool | float
    wireframe: bool
    least_width: float | None
    radius_factor: float | None
    radius: float | None
    min_radius: float | None
    synapses: bool | str | Sequence[str]
    synapse_side: Literal["afferent", "efferent"] | None
    points: str | os.PathLike[str] | None
    marker_color_by: str | None
    marker_shape: Literal["point", "sphere", "contact"] | None
    marker_size: float | None
    meshes: Meshes | None
    light: str | Sequence[float] | None
    ao: float | None
    lod: Literal["adaptive", "homogeneous", "prerefined", "exploration", "static"] | None
    level: int | None
    pixels: float | None
    budget: int | None
    soma: Literal["fem", "sphere", "profile", "none"] | None
    ring: Mapping[int, float] | None
    types: Sequence[str | int] | str | None
    nodes: Nodes | None
    node_set: str | None
    population: str | None
    region: tuple[Sequence[float], Sequence[float]] | None
    sample: int | None
    sample_seed: int | None
    cache: bool
    gpu_memory: int | str | None
    adapter: str | None
    like: str | os.PathLike[str] | None


class PageOptions(TypedDict, total=False):
    """The options of `html`."""

    color_by: ColorBy | None
    values: Values | None
    times: ArrayLike | None
    values_title: str | None
    unit: str | None
    report: str | os.PathLike[str] | None
    time: float | tuple[float, float, float] | None
    range: tuple[float, float] | None
    palette: str | os.PathLike[str] | Mapping[str, Color] | None
    colormap: OwnColormap | None
    background: Color | None
    title: str | None
    least_width: float | None
    radius_factor: float | None
    radius: float | None
    min_radius: float | None
    synapses: bool | str | Sequence[str]
    synapse_side: Literal["afferent", "efferent"] | None
    points: str | os.PathLike[str] | None
    marker_color_by: str | None
    marker_size: float | None
    markers: Markers | None
    soma: Literal["fem", "sphere", "profile", "none"] | None
    ring: Mapping[int, float] | None
    types: Sequence[str | int] | str | None
    nodes: Nodes | None
    node_set: str | None
    population: str | None
    region: tuple[Sequence[float], Sequence[float]] | None
    sample: int | None
    sample_seed: int | None
    force: bool
