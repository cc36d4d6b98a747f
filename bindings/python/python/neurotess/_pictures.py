"""Pictures."""

from __future__ import annotations

import os
import warnings

from . import _neurotess, _options
from ._errors import NeurotessWarning, OptionError
from ._groups import ungrouped
from ._images import Film, Image
from ._scene import check_names, drawing_of
from ._units import times_of
from ._words import spoken

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from typing import Any, Literal

    from numpy.typing import ArrayLike

    from ._colormaps import Colormap
    from ._colors import Color
    from ._nodes import Nodes
    from ._typed import Camera, ColorBy, Drawable, Markers, Meshes, Scene, Side
    from ._values import Values


def render(
    what: Drawable | Iterable[Any],
    *,
    size: tuple[int, int] | None = None,
    camera: Camera | None = None,
    scene: Scene | None = None,
    markers: Markers | None = None,
    color_by: ColorBy | None = None,
    color_by_attribute: str | None = None,
    values: Values | None = None,
    times: ArrayLike | None = None,
    title: str | None = None,
    unit: str | None = None,
    report: str | os.PathLike[str] | None = None,
    time: float | None = None,
    range: tuple[float, float] | None = None,
    palette: str | os.PathLike[str] | Mapping[str, Color] | None = None,
    colormap: Colormap | None = None,
    trim_colormap: bool = False,
    legend: bool = True,
    scale_bar: bool | float = False,
    axes: bool = False,
    background: Color | None = None,
    transparent: bool = False,
    samples: int | None = None,
    view: Side | None = None,
    eye: Sequence[float] | None = None,
    target: Sequence[float] | None = None,
    up: Sequence[float] | None = None,
    fov: float | None = None,
    orthographic: bool | float = False,
    wireframe: bool = False,
    least_width: float | None = None,
    radius_factor: float | None = None,
    radius: float | None = None,
    min_radius: float | None = None,
    synapses: bool | str | Sequence[str] = False,
    synapse_side: Literal["afferent", "efferent"] | None = None,
    points: str | os.PathLike[str] | None = None,
    marker_color_by: str | None = None,
    marker_shape: Literal["point", "sphere", "contact"] | None = None,
    marker_size: float | None = None,
    meshes: Meshes | None = None,
    light: str | Sequence[float] | None = None,
    ao: float | None = None,
    lod: Literal["adaptive", "homogeneous", "prerefined", "exploration", "static"] | None = None,
    level: int | None = None,
    pixels: float | None = None,
    budget: int | None = None,
    soma: Literal["fem", "sphere", "profile", "none"] | None = None,
    ring: Mapping[int, float] | None = None,
    types: Sequence[str | int] | str | None = None,
    nodes: Nodes | None = None,
    node_set: str | None = None,
    population: str | None = None,
    region: tuple[Sequence[float], Sequence[float]] | None = None,
    sample: int | None = None,
    sample_seed: int | None = None,
    cache: bool = True,
    gpu_memory: int | str | None = None,
    adapter: str | None = None,
    like: str | os.PathLike[str] | None = None,
) -> Image:
    """Draws cells or a circuit, without a window: a cell or a file (or whatever `mesh` takes), several of them,
    or a `Circuit`; or surfaces, alone or among cells: a `Mesh`, or any with `vertices` and `faces` (µm), as those of trimesh.

    The options are those of ``neurotess render``. The processor draws; `adapter` names a graphics adapter instead.

    Options of the camera, of what is around the cells, and of markers can be in groups: ``camera={"view": "iso", "fov":
    30}``, ``scene={"background": "black", "scale_bar": True}``, ``markers={"synapses": True, "shape": "contact"}``.

    Picture: `size` (1280, 960), `background` (``"white"``, ``"#102030"``) or `transparent`, `samples` (16),
    `legend`, `scale_bar` (True, or a length in µm), `axes` (the directions of x, y and z).

    Colors: `color_by`; `values` of your own, with a `title` and a `unit` for the legend: an array with a number for each
    of ``cell.points``, of the rows of ``cell.to_table()`` (with the soma's) or of ``cell.sections``; as in
    ``{"section": numbers}`` where the length tells not which; NaN is gray; of several cells a list of them. Of a mesh they
    are a number for each vertex, or the name of an attribute. Of cells they may be colors, (n, 3), instead; whole numbers with a
    map of kinds, like ``"tab10"``, have its colors as they are. With `times`
    (ms) they are over time: an array with a row, or a column, for each time, or ``{"segment": arrays}``, an array for each
    of ``cell.sections`` (the soma's before them, or not) with the segments' numbers, as a simulator records them; `time`
    (ms) is the one that is shown, of `film` those. Of circuits `color_by_attribute`, or `report` (a name of `Circuit.reports` or a file) at a
    `time` (ms); `range`; `colormap`: a name, one of matplotlib's, or a list of colors from low to high; `trim_colormap`;
    `palette`: a name, a file, or colors of your own by the name
    of a type or of anything else in the legend, as in ``{"axon": "#ff8800", "L5_PC": "#2ca02c"}``, over those of the
    palette called ``"base"``.

    Camera: `view` from a side, or `eye`, `target` (µm) and `up`; `fov` (degrees). `orthographic`: without
    perspective, so that lengths are true at all depths (True, or the height of the picture in µm).

    Look: `wireframe`; of neurites `least_width` (1.5 pixels of pictures of up to 960, proportionally more in larger
    ones; 0: as wide as they are, which is usual for more than 50 neurons), `radius_factor`, `radius` (µm) of points
    without one and `min_radius`; `light` (``"soft"``, ``"flat"`` or a direction), `ao` (radius of ambient occlusion,
    µm), `lod` with `level`, `pixels` or `budget`.

    Synapses of a circuit's cells: `synapses` (True, or names of `Circuit.edges`), `synapse_side`; or the `points` of
    a CSV file with columns x, y and z (µm). `marker_color_by` is a number that each has; `marker_shape`
    ``"sphere"``, ``"point"``, or of synapses ``"contact"``: spheres on discs that lie on the membrane; `marker_size` the
    diameter (µm).

    Other `meshes` of the scene, such as brain regions, segments of electron microscopy or a pipette: files (PLY, OBJ,
    STL, GLB, …), a `Mesh`, or anything with `vertices` and `faces` (µm); or dictionaries like ``{"mesh": "region.obj",
    "color": "#7799bb", "opacity": 0.2}``, with ``"values"`` (a number for each vertex, or the name of an
    attribute, with `colormap`, `range`, `title` and `unit` as above), ``"edges"`` (True: only those are drawn), ``"scale"`` (µm of a unit of
    the file) and ``"fit"`` (True: the camera fits it even if one can see through it).

    Cells: `soma`, `ring` and `types`, as in `mesh`; of circuits `nodes`, `node_set`, `population`, `region`,
    `sample` and `sample_seed`, as in `Circuit.select`; `cache`: whether the meshes of a large circuit are kept beside it for the next time;
    `gpu_memory`: most memory of the adapter for the tracings of large scenes (bytes, or like ``"512MiB"``).

    `like`: a PNG file of neurotess, whose camera, colors and look the picture has, but for the options that are given (what
    it switches on stays on). Which cells it shows, and what was in memory, is not in it.

    Raises ``ValueError`` for options, and `RenderError` where nothing can be drawn.
    """
    options: dict[str, Any] = dict(locals())
    del options["what"]
    options = ungrouped(options)
    _check_pairs(options)
    drawing = _drawing(what, options)
    try:
        return Image.drawn(drawing, 0)
    finally:
        drawing.close()


def film(
    what: Drawable | Iterable[Any],
    *,
    turntable: bool = False,
    time: tuple[float, float, float] | tuple[float, float] | ArrayLike | None = None,
    frames: int | None = None,
    **options: Any,
) -> Film:
    """Draws a series of pictures, one after the other: once around with `turntable` (36 pictures, or `frames`), or
    through a report, or through `values` over time, with `time`: a tuple (from, to, and the step, in ms, or `frames`), or an
    array of the times of all pictures. The options are those of `render`.

    >>> import neurotess as nt
    >>> film = nt.film(nt.synth("granule"), turntable=True, frames=8, size=(96, 64))
    >>> len(film)
    8
    >>> film.save("turn.gif")                                         # doctest: +SKIP
    >>> for number, picture in enumerate(film):                       # doctest: +SKIP
    ...     picture.save(f"turn_{number:03}.png")
    """
    between, at = _times(time)
    series = {"turntable": turntable, "time": _options.joined(between, ":"), "frames": frames}
    check_names("film", render, options)
    options = ungrouped(options)
    _check_pairs({**options, "time": time})
    if not turntable and time is None:
        raise ValueError("a film needs turntable=True, or time=(from, to, step)")
    if at is not None and (turntable or frames is not None):
        raise ValueError("time= is of each picture: leave out turntable= and frames=")
    return Film(lambda: _drawing(what, {**options, **series}, at))


def _times(time: Any) -> tuple[Any, list[float] | None]:
    """The times of a film: from, to and step, or those of all pictures."""
    import numpy as np

    if time is None or isinstance(time, str):
        return time, None
    if isinstance(time, tuple):
        return times_of("time=", time), None
    times = np.asarray(times_of("time=", time), dtype=float)
    if times.ndim != 1 or not times.size or not np.isfinite(times).all():
        raise ValueError(f"time= is of shape {times.shape}: (from, to, step), or an array of times (ms) is needed")
    if isinstance(time, list) and len(times) in (2, 3):
        raise ValueError(f"time={time!r} may be from, to and step, or times: give a tuple, or an array")
    return None, times.tolist()


def _check_pairs(options: Mapping[str, Any]) -> None:
    """Checks that options which belong together are there together."""
    if options.get("like") is not None:
        # What it is like may have the other one.
        return
    over_time = "report" if options.get("values") is None else "times"
    for name, other in (("eye", "target"), ("time", over_time)):
        if options.get(name) is not None and options.get(other) is None:
            raise OptionError(f"{name}= needs {other}=, too", name, f"{other}= is needed, too")


def _drawing(what: Any, options: dict[str, Any], times: list[float] | None = None) -> _neurotess.Drawing:
    """What draws the pictures that the options ask for, or those of these times."""
    given, options = options, dict(options)
    options["no_legend"] = not options.pop("legend", True)
    options["no_cache"] = not options.pop("cache", True)
    if times is None and options.get("time") is not None:
        options["time"] = times_of("time=", options["time"])
    drawing = drawing_of(what, options, options.pop("adapter", None), given, times)
    for message in drawing.messages:
        warnings.warn(NeurotessWarning(spoken(message)), stacklevel=3)
    return drawing
