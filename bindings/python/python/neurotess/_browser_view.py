"""The view of cells in a notebook that the browser draws, joined with the kernel."""

from __future__ import annotations

from ._errors import OptionError
from ._frame import framed, saved
from ._neurotess import WIDGET
from ._packages import needed

TYPE_CHECKING = False
if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Iterable
    from pathlib import Path
    from typing import Any

    from . import _neurotess
    from ._live_view import Camera, Picked

needed("anywidget", "notebook")
from anywidget import AnyWidget  # noqa: E402
from traitlets import Bool, Float, List, Unicode, observe, validate  # noqa: E402

from ._live_view import LiveView, numbers_of  # noqa: E402

#: What shows widgets only if they come as such, by what it is known by: a module, or a variable of the environment.
WIDGETS_ONLY = ("google.colab", "VSCODE_PID")
WIDGET_TYPE = "application/vnd.jupyter.widget-view+json"


class BrowserView(LiveView, AnyWidget):
    """Cells or a circuit in a notebook, drawn by the browser: ``View(renderer="browser")`` where anywidget is installed.

    What it shows can be read and set here while the browser shows it: `color_by`, `time` (ms), `hidden`, `camera` and
    `orthographic`. What a reader changes in the page is here as soon as that is at rest. `on_pick` is called with a
    dictionary when a neurite or a soma is clicked: ``name``, ``node_id``, ``section`` (0 is the soma, as in
    `Mesh.section`), ``section_index`` (of ``cell.sections``; −1 is the soma), ``sample`` and ``position``; with None
    beside them.

    >>> import neurotess as nt
    >>> view = nt.View(nt.synth("granule", points=100))       # doctest: +SKIP
    >>> view.on_pick = print                                 # doctest: +SKIP
    >>> view.hide("axon")                                    # doctest: +SKIP

    `color_by`, `time`, `hidden` and `orthographic` are traits: ``ipywidgets.link((slider, "value"), (view, "time"))`` links
    them.
    """

    _esm = WIDGET
    # Synchronized with the page by widget.js, which knows these names.
    _key = Unicode().tag(sync=True)
    _camera: Any = List(default_value=None, allow_none=True).tag(sync=True)
    color_by = Unicode(None, allow_none=True).tag(sync=True)
    """What colors tell, as in `render`."""
    time = Float(None, allow_none=True).tag(sync=True)
    """Time (ms) that is shown; set to any time, it is that of the frame which shows then."""
    hidden = List(Unicode()).tag(sync=True)
    """Entries of the legend that are hidden. Another `color_by` has another legend: what is not in that shows."""
    orthographic = Bool(False).tag(sync=True)
    """Whether there is no perspective. What the camera looks at keeps its size when this changes."""

    def __init__(
        self,
        page: _neurotess.Page,
        *,
        size: tuple[int, int],
        color_by: str | None = None,
        time: float | None = None,
    ) -> None:
        self._page = page
        self._times = page.times
        self._legends = dict(page.legends)
        if page.has_values:
            self._legends["value"] = []
        self._first = color_by or ("value" if page.has_values else "type")
        super().__init__()
        self.html: str = page.html
        """The page."""
        self.size = int(size[0]), int(size[1])
        """Width and height (pixels)."""
        self.on_pick: Callable[[Picked | None], object] | None = None
        # Frames of one run of a notebook are not those of the next.
        self._key = self.model_id or ""
        self.color_by = self._first
        if self._times:
            self.time = self._times[0] if time is None else time
        elif time is not None:
            raise ValueError("there is no report and no times=, so there are no times")
        self.on_msg(self._told)
        self._whole = True

    # What is shown

    @validate("color_by")
    def _check_color_by(self, proposal: Any) -> str:
        what: str = proposal["value"]
        if what not in self._legends:
            words = ", ".join(map(repr, self._legends))
            raise OptionError(f"color_by={what!r}: use one of {words}", "color_by", f"one of {words} is needed")
        return what

    @observe("color_by")
    def _recolored(self, _change: Any) -> None:
        if self.color_by is None:
            # None is not checked.
            self.color_by = self._first
        self.hidden = [name for name in self.hidden if name in self.legend]

    @validate("hidden")
    def _check_hidden(self, proposal: Any) -> list[str]:
        for name in proposal["value"]:
            if name not in self.legend:
                raise ValueError(f"hidden: the legend has no {name!r}: {self._entries()}")
        return [name for name in self.legend if name in proposal["value"]]

    def _entries(self) -> str:
        if not self.legend:
            return "it is a scale of numbers: choose another color_by"
        return "it has " + ", ".join(map(repr, self.legend[:20])) + (", …" if len(self.legend) > 20 else "")

    @property
    def legend(self) -> list[str]:
        """Entries of the legend; none of scales of numbers."""
        return list(self._legends[self.color_by or self._first])

    def hide(self, *names: str) -> None:
        """Hides entries of the legend, such as ``"axon"``."""
        self.hidden = [*self.hidden, *names]

    def show(self, *names: str) -> None:
        """Shows entries of the legend again; without names all."""
        self.hidden = [name for name in self.hidden if names and name not in names]

    @property
    def camera(self) -> Camera | None:
        """Eye, target, direction upwards (µm), and the vertical angle of view (radians). None before a browser shows the
        cells, which are fitted there."""
        if self._camera is None:
            return None
        eye, target, up, fov = self._camera
        return tuple(eye), tuple(target), tuple(up), fov

    @camera.setter
    def camera(self, camera: Camera) -> None:
        self._camera = list(numbers_of(camera))

    # What the browser says

    def _told(self, _widget: Any, message: dict[str, Any], _buffers: Iterable[Any]) -> None:
        if message.get("frame"):
            # A program that shows widgets only asks for what others show.
            self.send({"frame": self._repr_html_()})
        elif "picked" in message and self.on_pick is not None:
            found = message["picked"]
            self.on_pick(None if found is None else self._page.picked(found["key"], found["position"]))

    # What is shown of it

    def _repr_html_(self) -> str:
        """The page in a frame, which is what is saved with a notebook."""
        return framed(self.html, self.size, self._key)

    def _repr_mimebundle_(self, **_options: Any) -> tuple[dict[str, Any], dict[str, Any]]:
        """The frame, which widget.js finds. Why not the widget: without a kernel, JupyterLab would show an error in its
        place, not the frame beside it."""
        bundle: dict[str, Any] = {"text/plain": repr(self), "text/html": self._repr_html_()}
        if _shows_widgets_only():
            bundle[WIDGET_TYPE] = {"version_major": 2, "version_minor": 0, "model_id": self.model_id}
        return bundle, {}

    def __repr__(self) -> str:
        return f"<neurotess.View of {len(self.html) / 1000:.0f} kB, drawn by the browser>"

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Writes the page to a file, which must not exist."""
        return saved(self.html, path)


def _shows_widgets_only() -> bool:
    import os
    import sys

    module, variable = WIDGETS_ONLY
    return module in sys.modules or variable in os.environ
