"""The view of cells in a notebook that the kernel draws."""

from __future__ import annotations

import math
import os
import warnings

from ._errors import NeurotessWarning, RenderError
from ._groups import ungrouped
from ._packages import needed
from ._images import Image
from ._pictures import render
from ._scene import DrawnCircuit, check_names, drawing_of
from ._series import Times
from ._words import spoken

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from typing import Any

    from . import _neurotess
    from ._live_view import Camera, Picked

    # The second is a part of the first: who evaluates annotations looks for it here.
    from ._typed import Drawable

needed("jupyter_rfb", "notebook")
from jupyter_rfb import RemoteFrameBuffer  # noqa: E402
from traitlets import observe, validate  # noqa: E402

from ._live_view import LiveView, numbers_of  # noqa: E402

#: Seconds without an event after which the full picture is drawn.
REST = 0.25
#: Samples of a pixel while something moves: with one, thin neurites are dashed.
MOVING = 4
#: A click within so many pixels of a neurite picks it.
REACH = 3.0
#: A press and a release that are nearer than this (pixels) are a click.
CLICK = 4.0


class KernelView(LiveView, RemoteFrameBuffer):  # type: ignore[misc]
    """Cells or a circuit in a notebook, drawn where the kernel runs: ``View(renderer="kernel")``.

    Drag to turn, drag with Shift or the right button to move, use the wheel to come nearer. While something moves,
    it is drawn within a `budget` of triangles; at rest the full picture follows, with `samples` a pixel. A double click
    shows all again.

    `what` and the options are those of `render`, without those of the camera, of which there are `camera` and
    `orthographic` (no perspective): both can be set. With a `report`, or `values` with `times`, `time` can be set.
    `on_pick` is called with a dictionary when a neurite or a soma is clicked: ``name``, ``node_id``, ``section``
    (0 is the soma, as in `Mesh.section`), ``section_index`` (of ``cell.sections``; −1 is the soma), ``sample`` and
    ``position``; with None beside them.

    >>> view = nt.View(cell, renderer="kernel")                      # doctest: +SKIP
    >>> view.on_pick = print                                         # doctest: +SKIP
    >>> view.color_by = "radius"                                     # doctest: +SKIP

    `color_by` and `time` (ms) are traits: ``ipywidgets.link((slider, "value"), (view, "time"))`` links them.
    """

    # What is closed may not have been made.
    _drawings: tuple[_neurotess.Drawing, _neurotess.Drawing] | None = None

    def __new__(cls, *what: Any, **options: Any) -> Any:
        # Before there is anything to close.
        check_names("View", render, {name: None for name in options if name != "what"})
        return super().__new__(cls, *what, **options)

    def __init__(
        self,
        what: Drawable | Iterable[Any],
        *,
        size: tuple[int, int] = (800, 600),
        budget: int | None = None,
        samples: int = 16,
        color_by: str | None = None,
        report: str | None = None,
        time: float | None = None,
        orthographic: bool | float = False,
        adapter: str | None = None,
        **options: Any,
    ) -> None:
        super().__init__()
        self.css_width, self.css_height = f"{size[0]}px", f"{size[1]}px"
        self.on_pick: Callable[[Picked | None], object] | None = None
        # An iterator is drawn more than once.
        drawn: Any = what
        self._what = list(drawn) if hasattr(drawn, "__next__") else drawn
        self._samples = samples
        self._adapter = adapter
        self._budget = budget
        self._options = {"orthographic": orthographic, **ungrouped(options)}
        self._size = size
        self._ratio = 1.0
        self._moving = False
        self._rest: Any = None
        self._pressed: tuple[float, float] | None = None
        self._last: tuple[float, float] | None = None
        self._times: list[float] = []
        self._picture = 0
        self._shown_colors: str | None = None
        if report is not None:
            self._set_report(report)
        elif options.get("times") is not None:
            times = Times(options["times"])
            self._set_times([times.start + times.step * frame for frame in range(times.count)])
        self._make(color_by)
        self.color_by = color_by
        if self._times:
            self.time = self._times[0] if time is None else time
        elif time is not None:
            raise ValueError("there is no report and no times=, so there are no times")
        self._whole = True

    # What is shown

    @validate("color_by")
    def _check_color_by(self, proposal: Any) -> str | None:
        what: str | None = proposal["value"]
        if what != self._shown_colors:
            # Wrong ones raise here, and the old ones stay.
            self._make(what)
        return what

    @observe("time", "color_by")
    def _changed(self, _change: Any) -> None:
        if self.color_by is None and self._shown_colors is not None:
            # None is not checked.
            self._make(None)
        if self._times and self.time is not None:
            self._picture = self._times.index(self.time)
        self._draw()

    @property
    def camera(self) -> Camera:
        """Eye, target, direction upwards (µm), and the vertical angle of view (radians)."""
        eye, target, up, fov = self._camera
        return tuple(eye), tuple(target), tuple(up), fov

    @camera.setter
    def camera(self, camera: Camera) -> None:
        self._camera = numbers_of(camera)
        self._draw()

    @property
    def orthographic(self) -> bool:
        """Whether there is no perspective. What the camera looks at keeps its size when this changes."""
        return self._orthographic

    @orthographic.setter
    def orthographic(self, on: bool) -> None:
        self._orthographic = bool(on)
        self._draw()

    def image(self) -> Image:
        """The full picture as it is now."""
        return Image(self._pixels(self._full, self._samples))

    def close(self, *arguments: Any, **named: Any) -> None:
        """Closes the view and gives back its memory on the graphics device."""
        self._drop()
        super().close(*arguments, **named)

    # Making

    def _set_report(self, report: str) -> None:
        from . import _neurotess
        from ._circuits import Circuit
        from ._reports import Report

        if not isinstance(self._what, Circuit):
            raise ValueError("a report needs a circuit, whose cells have its values")
        path = self._what.reports.get(report, report)
        self._options["report"] = path
        first = _neurotess.Report(path).populations[:1]
        self._set_times(Report(path, *first).times.tolist())

    def _set_times(self, times: list[float]) -> None:
        """All frames become pictures of the scene."""
        if len(times) > 1:
            end = times[-1] + 0.5 * (times[1] - times[0])
            self._options["time"] = f"{times[0]!r}:{end!r}:{times[1] - times[0]!r}"
        self._times = times

    def _make(self, color_by: str | None) -> None:
        options = {
            "size": "{}x{}".format(*self._pixel_size()),
            "color_by": color_by,
            **self._options,
        }
        if options.pop("legend", False) is False:
            options["no_legend"] = True
        if not options.pop("cache", True):
            options["no_cache"] = True
        given = {**self._options, "color_by": color_by, "size": self._size}
        full = drawing_of(self._what, {**options, "lod": "static"}, self._adapter, given)
        made = (self._quick(options, given), full)
        for message in full.messages:
            warnings.warn(NeurotessWarning(spoken(message)), stacklevel=3)
        first = self._drawings is None
        self._drop()
        self._drawings = made
        self._shown_colors = color_by
        if first:
            eye, target, up, fov, self._orthographic = full.camera(0)
            self._home = self._camera = (eye, target, up, fov)

    def _quick(self, options: dict[str, Any], given: dict[str, Any]) -> _neurotess.Drawing:
        """What is drawn while something moves: circuits within a budget, by an adapter if there is one; else coarsely."""
        explored = {**options, "lod": "exploration", "budget": self._budget}
        named = self._adapter or os.environ.get("NEUROTESS_ADAPTER")
        if named != "cpu" and (named or isinstance(self._what, DrawnCircuit)):
            try:
                return drawing_of(self._what, explored, self._adapter, given)
            except RenderError:
                if named:
                    raise
        return drawing_of(self._what, {**options, "pixels": 1.0, "ao": 0.0}, self._adapter, given)

    def _drop(self) -> None:
        for drawing in self._drawings or ():
            drawing.close()
        self._drawings = None

    @property
    def _full(self) -> _neurotess.Drawing:
        if self._drawings is None:
            raise RuntimeError("the view is closed")
        return self._drawings[1]

    # Drawing

    def _pixel_size(self) -> list[int]:
        return [max(16, round(n * self._ratio)) for n in self._size]

    def _pixels(self, drawing: _neurotess.Drawing, samples: int) -> Any:
        return drawing.draw_from(self._picture, self._seen_from(), self._pixel_size(), samples)

    def _seen_from(self) -> Any:
        eye, target, up, fov = self._camera
        return list(eye), list(target), list(up), fov, self._orthographic

    def get_frame(self) -> Any:
        """Draws what the browser asks for."""
        if self._drawings is None:
            return None
        quick, full = self._drawings
        if self._moving:
            return self._pixels(quick, min(self._samples, MOVING))
        return self._pixels(full, self._samples)

    def _draw(self) -> None:
        if self._drawings is not None:
            self.request_draw()

    def _moved(self) -> None:
        """Something moves: quick pictures until nothing does."""
        import asyncio

        self._moving = True
        if self._rest is not None:
            self._rest.cancel()
        try:
            self._rest = asyncio.get_running_loop().call_later(REST, self._rested)
        except RuntimeError:
            # Without a loop nobody would draw the full picture later.
            self._moving = False
        self._draw()

    def _rested(self) -> None:
        self._moving = False
        self._rest = None
        self._draw()

    # Events

    def handle_event(self, event: dict[str, Any]) -> None:
        """Takes an event of the browser."""
        kind = event.get("type") or event.get("event_type")
        if kind == "close":
            self._drop()
        elif kind == "resize":
            self._size = (event["width"], event["height"])
            self._ratio = event.get("ratio") or event.get("pixel_ratio") or 1.0
        elif kind == "wheel":
            self._zoom(math.exp(event["dy"] * 0.001))
        elif kind == "double_click":
            self.camera = self._home
        elif kind == "pointer_down":
            self._pressed = self._last = (event["x"], event["y"])
        elif kind == "pointer_move" and self._last is not None:
            at = (event["x"], event["y"])
            dx, dy = at[0] - self._last[0], at[1] - self._last[1]
            self._last = at
            if "Shift" in event.get("modifiers", ()) or 2 in event.get("buttons", ()):
                self._pan(dx, dy)
            else:
                self._turn(dx, dy)
        elif kind == "pointer_up":
            pressed, self._pressed, self._last = self._pressed, None, None
            at = (event["x"], event["y"])
            if pressed is not None and math.dist(pressed, at) < CLICK:
                self._click(at)

    def _click(self, at: tuple[float, float]) -> None:
        if self.on_pick is not None:
            self.on_pick(self.pick(*at))

    def pick(self, x: float, y: float) -> Picked | None:
        """What is at a point of the view, or within three pixels of it; None if nothing is."""
        place = [x * self._ratio, y * self._ratio]
        return self._full.pick(self._seen_from(), self._pixel_size(), place, REACH * self._ratio)

    def _axes(self) -> tuple[Any, Any, Any]:
        import numpy as np

        eye, target, up, _ = self._camera
        back = np.subtract(eye, target)
        back = back / np.linalg.norm(back)
        right = np.cross(up, back)
        right = right / np.linalg.norm(right)
        return right, np.cross(back, right), back

    def _turn(self, dx: float, dy: float) -> None:
        import numpy as np

        eye, target, _, fov = self._camera
        right, up, back = self._axes()
        distance = np.linalg.norm(np.subtract(eye, target))
        # Half the width is half a turn.
        a, b = (math.pi * n / max(self._size) for n in (dx, dy))
        back = math.cos(a) * back - math.sin(a) * right
        right = np.cross(up, back)
        back, up = math.cos(b) * back + math.sin(b) * up, math.cos(b) * up - math.sin(b) * back
        eye = np.asarray(target) + distance * back
        self._camera = (eye.tolist(), list(target), up.tolist(), fov)
        self._moved()

    def _pan(self, dx: float, dy: float) -> None:
        import numpy as np

        eye, target, up, fov = self._camera
        right, upwards, _ = self._axes()
        distance = float(np.linalg.norm(np.subtract(eye, target)))
        pixel = 2 * distance * math.tan(fov / 2) / self._size[1]
        by = pixel * (dy * upwards - dx * right)
        self._camera = ((eye + by).tolist(), (target + by).tolist(), list(up), fov)
        self._moved()

    def _zoom(self, factor: float) -> None:
        import numpy as np

        eye, target, up, fov = self._camera
        nearer = np.asarray(target) + factor * np.subtract(eye, target)
        self._camera = (nearer.tolist(), list(target), list(up), fov)
        self._moved()
