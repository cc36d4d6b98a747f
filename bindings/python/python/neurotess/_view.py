"""The view of cells in a notebook."""

from __future__ import annotations

from ._frame import framed, saved
from ._groups import ungrouped
from ._pages import page_of
from ._pictures import render
from ._scene import DrawnCircuit, _cells, _chosen, check_names
from ._sources import is_alone, is_surface

TYPE_CHECKING = False
if TYPE_CHECKING:
    import os
    from collections.abc import Iterable
    from pathlib import Path
    from typing import Any, Literal

    from ._typed import Drawable

#: The largest page (bytes) that a notebook gets without being asked: it is saved with it.
MOST_BYTES = 20_000_000
#: Bytes of a page for each point of its tracings, at most.
POINT_BYTES = 28
#: Most cells of a circuit, each of which a page stores by itself.
MOST_CELLS = 50

#: What installs all that views need.
INSTALL = "pip install 'neurotess[notebook]'"

#: Options of `render` that pages have, by their names there.
PAGE = {
    name: name
    for name in (
        *("color_by", "values", "times", "unit", "range", "palette", "colormap", "background", "least_width"),
        *("radius_factor", "radius", "min_radius", "soma", "ring", "types"),
        *("report", "synapses", "synapse_side", "points", "marker_color_by", "marker_size"),
        *("nodes", "node_set", "population", "region", "sample", "sample_seed"),
    )
} | {"title": "values_title"}


class View:
    """Cells or a circuit in a notebook, to be turned, colored and pointed at.

    ``renderer="browser"``: the page of `html` in the notebook. The browser draws it, and it stays in the notebook that is saved or exported. It is what you get where all options are such
    as pages have and the page would have up to 20 MB, of circuits up to 50 cells.

    ``renderer="kernel"``: the kernel draws what the browser shows, of circuits of any size, and all frames of a `report`. It
    needs no graphics driver; large circuits move more smoothly with an adapter.
    Drag to turn, drag with Shift or the right button to move, use the wheel to come nearer; a double click shows all
    again.

    With ``pip install neurotess[notebook]`` both have ``view.camera``, ``view.orthographic``, ``view.color_by``,
    ``view.time`` with ``view.times``, and ``view.on_pick``, which is called with what is clicked. The browser's has
    ``view.hide("axon")``, ``view.show()``, ``view.hidden`` and ``view.legend``, too, and the kernel's ``view.image()`` and
    ``view.pick(x, y)``. Without these packages the browser's view is the page alone.

    `what` and the options are those of `render`; `size` is in pixels of the page.

    >>> import neurotess as nt
    >>> view = nt.View(nt.synth("granule", points=100), color_by="radius")
    >>> view.html[:15]
    '<!doctype html>'
    """

    html: str
    """The page."""
    size: tuple[int, int]
    """Width and height (pixels)."""

    def __new__(
        cls,
        what: Drawable | Iterable[Any],
        *,
        renderer: Literal["browser", "kernel"] | None = None,
        size: tuple[int, int] = (800, 600),
        **options: Any,
    ) -> Any:
        if renderer not in (None, "browser", "kernel"):
            raise ValueError(f"renderer={renderer!r}: 'browser' or 'kernel' is needed")
        check_names("View", render, options)
        options = ungrouped(options)
        if _has_surfaces(what):
            if renderer == "browser":
                raise ValueError("pages hold cells, no surfaces: leave renderer= out")
            from ._kernel_view import KernelView

            return KernelView(what, size=size, **options)
        shown = _read(what)
        known = {*PAGE, "time"} if _can_live() else PAGE
        others = [name for name, value in options.items() if name not in known and value not in (None, False)]
        if renderer == "browser" and others:
            where = f"needs anywidget ({INSTALL})" if others[0] == "time" else "is of views that the kernel draws"
            raise ValueError(f"{others[0]}= {where}: leave one of the two out")
        page = None
        if renderer == "browser" or (renderer is None and not others and _is_small(shown, options)):
            named = {PAGE[name]: value for name, value in options.items() if name in PAGE}
            page = page_of(shown, named, force=True)
        if page is None or (renderer is None and len(page.html) > MOST_BYTES):
            from ._kernel_view import KernelView

            return KernelView(shown, size=size, **options)
        if _can_live():
            from ._browser_view import BrowserView

            return BrowserView(page, size=size, color_by=options.get("color_by"), time=options.get("time"))
        view = super().__new__(cls)
        object.__setattr__(view, "html", page.html)
        object.__setattr__(view, "size", (int(size[0]), int(size[1])))
        return view

    def _repr_html_(self) -> str:
        return framed(self.html, self.size)

    def __repr__(self) -> str:
        return f"<neurotess.View of {len(self.html) / 1000:.0f} kB, drawn by the browser>"

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Writes the page to a file, which must not exist."""
        return saved(self.html, path)

    def close(self) -> None:
        """Does nothing here: a view that the kernel draws gives back its memory."""

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(_missing(name))

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(_missing(name))


def _has_surfaces(what: Any) -> bool:
    if is_surface(what):
        return True
    return isinstance(what, (list, tuple)) and any(map(is_surface, what))


def _read(what: Any) -> Any:
    """A circuit, or the cells: what can be read only once is."""
    if isinstance(what, DrawnCircuit):
        return what
    cells = _cells(what, {})
    return cells[0] if is_alone(what) else cells


def _is_small(shown: Any, options: dict[str, Any]) -> bool:
    if isinstance(shown, DrawnCircuit):
        chosen = _chosen(shown, dict(options))
        return len(shown._rows(*[None] * 5, 1) if chosen is None else chosen) <= MOST_CELLS
    cells = [shown] if is_alone(shown) else shown
    return POINT_BYTES * sum(len(cell.points) for cell in cells) <= MOST_BYTES


def _can_live() -> bool:
    """Whether what the browser draws can be joined with the kernel."""
    from importlib.util import find_spec

    return find_spec("anywidget") is not None


def _missing(name: str) -> str:
    if name in ("camera", "color_by", "hidden", "hide", "legend", "on_pick", "orthographic", "show", "time", "times"):
        return f"{name!r} of a View that the browser draws needs anywidget: {INSTALL}; or use renderer='kernel'"
    if name in ("image", "pick"):
        return f"a View that the browser draws has no {name!r}: use renderer='kernel'"
    return f"a View has no {name!r}"
