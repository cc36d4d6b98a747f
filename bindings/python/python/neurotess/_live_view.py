"""What all views in a notebook have that can be changed while they show, whoever draws them."""

from __future__ import annotations

from bisect import bisect_right

from ._packages import needed

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import Any, TypedDict

    class Picked(TypedDict):
        """What was clicked: a neurite or a soma."""

        cell: int
        """Its index among the cells that are shown."""
        name: str
        """Its name: that of the cell, or population and id of a node."""
        node_id: int | None
        """The id of the node, of a circuit."""
        section: int
        """As in `Mesh.section`: 0 is the soma."""
        section_index: int
        """Index in ``cell.sections``; −1 is the soma."""
        sample: int | None
        """The file's own number of the nearest sample; none on the soma."""
        position: list[float]
        """Where that sample was traced (µm)."""

    #: Eye, target, direction upwards (µm), and the vertical angle of view (radians).
    Camera = tuple[Any, Any, Any, float]

needed("traitlets", "notebook")
from traitlets import Float, HasTraits, Unicode, validate  # noqa: E402


class LiveView(HasTraits):
    """What can be changed while it shows."""

    color_by = Unicode(None, allow_none=True)
    """What colors tell, as in `render`."""
    time = Float(None, allow_none=True)
    """Time (ms) that is shown; set to any time, it is that of the frame which shows then."""
    on_pick: Callable[[Picked | None], object] | None
    """What is called when something is clicked, with None beside all cells."""

    _times: list[float]

    def __setattr__(self, name: str, value: object) -> None:
        # A misspelled property would be taken and do nothing.
        if not (name.startswith("_") or hasattr(self, name)) and self.__dict__.get("_whole"):
            from difflib import get_close_matches

            near = get_close_matches(name, _own_names(type(self)), 1)
            hint = f": did you mean {near[0]!r}?" if near else ""
            raise AttributeError(f"a View has no {name!r}{hint}")
        super().__setattr__(name, value)

    @property
    def times(self) -> list[float]:
        """Times (ms) of the frames of the report or of `values`; none without."""
        return list(self._times)

    @validate("time")
    def _check_time(self, proposal: Any) -> float:
        time, times = proposal["value"], self._times
        if not times:
            raise ValueError("a time is set where there is a report, or values with times=")
        # A time that is a frame's but for rounding is that frame's.
        step = times[1] - times[0] if len(times) > 1 else 1.0
        return times[max(bisect_right(times, time + 1e-6 * step) - 1, 0)]


def _own_names(kind: type) -> list[str]:
    """What a view has of its own, not of widgets."""
    kinds = [one for one in kind.__mro__ if one.__module__.startswith(__package__)]
    return ["on_pick", *(name for one in kinds for name in vars(one) if not name.startswith("_"))]


def numbers_of(camera: Camera) -> tuple[list[float], list[float], list[float], float]:
    """A camera with numbers as they are needed."""
    eye, target, up, fov = camera
    return [*map(float, eye)], [*map(float, target)], [*map(float, up)], float(fov)
