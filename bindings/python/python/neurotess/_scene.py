"""What pictures show: cells or a circuit, meshes beside them, colors; options as the renderer takes them."""

from __future__ import annotations

import os

from . import _neurotess, _options
from ._cells import cell_of
from ._colormaps import is_own, scale_of
from ._colors import text_of
from ._errors import OptionError, RenderError, missing_file
from ._own_colors import colors_of_points, kinds_of
from ._sources import is_alone
from ._surfaces import joint_range, looks_of, values_of_meshes, without_surfaces, words_of
from ._values import values_of

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import Any

    from ._morphology import Morphology

#: What selects cells of a circuit.
SELECTION = ("nodes", "node_set", "population", "region", "sample", "sample_seed")


class DrawnCircuit:
    """What pictures take of a `Circuit`."""

    _path: str
    _circuit: _neurotess.Circuit

    @property
    def reports(self) -> dict[str, str]:
        """The files of reports and spikes that the configuration names, by their names."""
        raise NotImplementedError

    def _rows(self, *selection: Any) -> list[tuple[int, int]]:
        raise NotImplementedError


def _chosen(circuit: DrawnCircuit, options: dict[str, Any]) -> list[tuple[int, int]] | None:
    """Takes what selects cells from the options: population and row of each; None if nothing does."""
    nodes, node_set, population, region, sample, seed = (options.pop(name, None) for name in SELECTION)
    if all(option is None for option in (nodes, node_set, population, region, sample)):
        return None
    return circuit._rows(nodes, node_set, population, region, sample, 1 if seed is None else seed)


def _cells(what: Any, options: dict[str, Any]) -> list[Morphology]:
    many = [what] if is_alone(what) else list(what)
    if any(isinstance(one, DrawnCircuit) for one in many):
        raise ValueError("a circuit is drawn alone")
    if not many and not options.get("meshes"):
        raise ValueError("there is no cell to draw")
    given = [name for name in SELECTION if options.get(name) is not None]
    if given:
        raise ValueError(f"{given[0]}= selects cells of a circuit, and none is drawn")
    return [cell_of(one) for one in many]


def check_names(name: str, function: Callable[..., Any], options: dict[str, Any]) -> None:
    """Checks that these are keywords of a function, which hands them over to another.

    Raises ``TypeError``, as Python itself does.
    """
    import inspect
    from difflib import get_close_matches

    known = list(inspect.signature(function).parameters)[1:]
    for option in options:
        if option not in known:
            near = get_close_matches(option, known, 1)
            hint = f": did you mean {near[0]!r}?" if near else ""
            raise TypeError(f"{name}() got an unexpected keyword argument {option!r}{hint}")


def drawing_of(
    what: Any,
    options: dict[str, Any],
    adapter: str | None,
    given: dict[str, Any],
    times: list[float] | None = None,
) -> _neurotess.Drawing:
    """Cells or a circuit on the device; `given`: the options as the caller gave them, for messages; `times`: of the
    pictures."""
    from . import quiet_adapters

    if not _neurotess.CAN_RENDER:
        raise RenderError("this build draws no pictures: build it with the feature 'render'")
    quiet_adapters()
    options = _with_colors(options)
    what = without_surfaces(what, options)
    if isinstance(what, DrawnCircuit):
        cells, circuit = [], (what._path, _chosen(what, options))
    else:
        cells, circuit = _cells(what, options), None
    looks = looks_of(options.pop("meshes", None))
    of_meshes = values_of_meshes(looks, options)
    own = colors_of_points(is_alone(what), options) if cells else None
    still, series = values_of(cells, is_alone(what), options)
    own = own or kinds_of(still, options)
    if of_meshes is not None and options.get("range") is None:
        options["range"] = joint_range(still, of_meshes)
    scale = own or _own_scale(options)
    report = options.get("report")
    named = isinstance(what, DrawnCircuit) and report is not None and os.fspath(report) in what.reports
    for name, is_file in (("points", True), ("like", True), ("report", circuit is not None and not named)):
        if is_file and options.get(name) is not None:
            _check_file(options[name])
    words, surfaces = words_of(looks)
    if words:
        options["mesh"] = words
    keywords = _options.keywords({**options, "picture_times": times, "adapter": adapter})
    data = still, series, surfaces, of_meshes, scale
    try:
        return _neurotess.Drawing([cell._cell for cell in cells], circuit, keywords, *data)
    except OptionError as error:
        from ._errors import with_given

        raise with_given(error, given) from None


def _own_scale(options: dict[str, Any]) -> list[list[int]] | None:
    """Takes a color map that is not one of ours from the options: its colors."""
    colormap = options.get("colormap")
    if colormap is None or is_own(colormap):
        return None
    if options.get("trim_colormap"):
        raise ValueError("trim_colormap= is for the color maps of neurotess: leave it out")
    del options["colormap"]
    scale: list[list[int]] = scale_of(colormap).tolist()
    return scale


def _check_file(path: str | os.PathLike[str]) -> None:
    if not os.path.exists(path):
        raise missing_file(os.fspath(path))


def _with_colors(options: dict[str, Any]) -> dict[str, Any]:
    """The options with a palette of one's own as those of the command line."""
    from collections.abc import Mapping

    options = dict(options)
    if options.get("background") is not None:
        options["background"] = text_of(options["background"])
    palette = options.get("palette")
    if not isinstance(palette, Mapping):
        # A name of a palette has no extension.
        if isinstance(palette, (str, os.PathLike)) and os.path.splitext(palette)[1]:
            _check_file(palette)
        return options
    # The palette that is beneath has a name.
    own = {}
    for name, color in palette.items():
        try:
            own[str(name)] = color if name == "base" else text_of(color)
        except ValueError as error:
            raise ValueError(f"palette={{{name!r}: …}}: {error}") from None
    background = options.get("background") or own.get("background")
    if options.get("transparent"):
        background = None
    colors = {name: color for name, color in own.items() if name not in ("base", "background")}
    return {**options, "palette": own.get("base"), "background": background, "set_color": colors}
