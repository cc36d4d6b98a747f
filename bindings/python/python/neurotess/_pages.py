"""Cells as one HTML page."""

from __future__ import annotations

import os
import warnings

from . import _neurotess, _options
from ._errors import NeurotessWarning, OptionError, RenderError, missing_file
from ._groups import ungrouped
from ._scene import SELECTION, DrawnCircuit, _cells, _chosen, _with_colors
from ._sources import is_alone
from ._units import times_of
from ._values import values_of
from ._words import spoken

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from pathlib import Path
    from typing import Any, Literal, overload

    from numpy.typing import ArrayLike
    from typing_extensions import Unpack

    from ._colors import Color
    from ._nodes import Nodes
    from ._typed import ColorBy, Drawable, Markers, OwnColormap, PageOptions
    from ._values import Told, Values

if TYPE_CHECKING:

    @overload
    def html(what: Drawable | Iterable[Any], path: None = None, **options: Unpack[PageOptions]) -> str: ...

    @overload
    def html(
        what: Drawable | Iterable[Any], path: str | os.PathLike[str], **options: Unpack[PageOptions]
    ) -> Path: ...


def html(
    what: Drawable | Iterable[Any],
    path: str | os.PathLike[str] | None = None,
    *,
    color_by: ColorBy | None = None,
    values: Values | None = None,
    times: ArrayLike | None = None,
    values_title: str | None = None,
    unit: str | None = None,
    report: str | os.PathLike[str] | None = None,
    time: float | tuple[float, float, float] | None = None,
    range: tuple[float, float] | None = None,
    palette: str | os.PathLike[str] | Mapping[str, Color] | None = None,
    colormap: OwnColormap | None = None,
    background: Color | None = None,
    title: str | None = None,
    least_width: float | None = None,
    radius_factor: float | None = None,
    radius: float | None = None,
    min_radius: float | None = None,
    synapses: bool | str | Sequence[str] = False,
    synapse_side: Literal["afferent", "efferent"] | None = None,
    points: str | os.PathLike[str] | None = None,
    marker_color_by: str | None = None,
    marker_size: float | None = None,
    markers: Markers | None = None,
    soma: Literal["fem", "sphere", "profile", "none"] | None = None,
    ring: Mapping[int, float] | None = None,
    types: Sequence[str | int] | str | None = None,
    nodes: Nodes | None = None,
    node_set: str | None = None,
    population: str | None = None,
    region: tuple[Sequence[float], Sequence[float]] | None = None,
    sample: int | None = None,
    sample_seed: int | None = None,
    force: bool = False,
) -> str | Path:
    """One HTML page to send, in which readers turn cells, color them and point at them: of a cell or a file (or whatever
    `mesh` takes), of several of them, or of a `Circuit`. It asks nothing of any server.

    Without a `path` the page is returned as text. With one it is written, whole or not at all, and the path is returned.
    It is the page of ``neurotess html``, whose options these are; no graphics card is needed to make it.

    `color_by`, `palette`, `colormap` (one of neurotess, by its name) and `range` are what the page begins with, as in
    `render`. `background`: else light or dark, as the reader's system is. `title` is that of the page: else the names of
    the cells.

    `values`: numbers of your own as in `render`, with a `values_title` and a `unit` for the legend. The page begins with
    them, unless `color_by` says otherwise. They are stored in 255 steps of their range. Those over time, with the `times` of
    their frames, are played: all frames, or 200 that are evenly spread.

    Of circuits `report`, a name of `Circuit.reports` or a file: values of a simulation, which are played at all its times, or
    200 that are evenly spread; or at `time` (ms): one, or ``(from, to, step)``.

    `synapses` of a circuit's cells, with `synapse_side`, or the `points` of a CSV file, with `marker_color_by` and
    `marker_size`, or all these in the group `markers`, are those of `render`. They are spheres.

    `least_width`, `radius_factor`, `radius`, `min_radius`, `soma`, `ring` and `types` are those of `render`; of circuits
    `nodes`, `node_set`, `population`, `region`, `sample` and `sample_seed` select cells, as in `Circuit.select`.

    `force`: replace a file that exists, and make a page of more than 2 MB, too.

    Raises ``ValueError`` for options, and for a page that would be too large; ``FileExistsError``; `MeshError`.

    >>> import neurotess as nt
    >>> nt.html(nt.synth("granule", points=100), color_by="radius")[:15]
    '<!doctype html>'
    """
    options: dict[str, Any] = dict(locals())
    for name in ("what", "path", "force"):
        del options[name]
    options = ungrouped(options)
    if options.get("marker_shape") is not None:
        raise OptionError("markers of pages are spheres: leave out 'shape' of markers=", "markers", "no 'shape' is needed")
    if path is not None and not force and os.path.exists(path):
        raise FileExistsError(f"{os.fspath(path)} exists: use force=True, or another name")
    made = page_of(what, options, force)
    if path is None:
        return made.html
    from pathlib import Path

    made.write(path, force)
    return Path(path)


#: Options of pages that say how cells are meshed, and what they begin with.
MESHED = ("soma", "ring", "types", "radius_factor", "radius", "min_radius")
LOOK = ("color_by", "palette", "colormap", "range", "background", "least_width")
#: Options of what a page shows beside cells.
CONTENT = ("report", "time", "synapses", "synapse_side", "points", "marker_color_by", "marker_size")


def page_of(what: Any, options: Mapping[str, Any], force: bool) -> _neurotess.Page:
    """The page with these options of `html`."""
    if not _neurotess.CAN_PAGE:
        raise RenderError("this build makes no pages: build it with the feature 'gpu'")
    given = {name: options.get(name) for name in (*MESHED, *LOOK)}
    content = _content(what, {name: options.get(name) for name in CONTENT})
    keywords = _options.keywords({**_with_colors(given), **content})
    chosen = {name: options.get(name) for name in SELECTION}
    values = options.get("values")
    if given["color_by"] == "value" and values is None and content["report"] is None:
        raise OptionError("color_by='value' needs values= or report=, too", "color_by", "values= is needed, too")
    circuit = None
    if isinstance(what, DrawnCircuit):
        if values is not None:
            raise ValueError("values= are of cells: make a page of them, as of [circuit.morphology(7)]")
        nodes = _chosen(what, chosen)
        circuit = what._circuit, what._rows(*[None] * 5, 1) if nodes is None else nodes
        cells = []
    else:
        cells = _cells(what, chosen)
    still, series = _told(cells, is_alone(what), options)
    try:
        page = _neurotess.page(
            [cell._cell for cell in cells], circuit, keywords, options.get("title"), still, series, force
        )
    except OptionError as error:
        from ._errors import with_given

        raise with_given(error, {**given, **options}) from None
    for message in page.messages:
        warnings.warn(NeurotessWarning(spoken(message)), stacklevel=3)
    return page


def _content(what: Any, options: dict[str, Any]) -> dict[str, Any]:
    """Reports, synapses and points as the command line has them."""
    report, time = options["report"], times_of("time=", options["time"])
    if time is not None:
        if report is None:
            raise OptionError("time= needs report=, too", "time", "report= is needed, too")
        if hasattr(time, "__iter__") and len(tuple(time)) != 3:
            raise OptionError(f"time={time!r}: a time (ms) or (from, to, step) is needed", "time", "a time is needed")
    if report is not None and isinstance(what, DrawnCircuit):
        report = what.reports.get(os.fspath(report), os.fspath(report))
    for file in (report if isinstance(what, DrawnCircuit) else None, options["points"]):
        if file is not None and not os.path.exists(file):
            raise missing_file(os.fspath(file))
    return {**options, "report": report, "time": _options.joined(time, ":")}


def _told(cells: list[Any], alone: bool, options: Mapping[str, Any]) -> Told:
    title, own = options.get("values_title"), {name: options.get(name) for name in ("values", "times", "unit")}
    if own["values"] is None and title is not None:
        raise ValueError(f"values_title={title!r} is of values: give values=, too")
    return values_of(cells, alone, {**own, "title": title})
