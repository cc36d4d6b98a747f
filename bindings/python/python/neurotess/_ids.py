"""Which cell, section and sample is at each pixel of a picture."""

from __future__ import annotations

from ._groups import ungrouped
from ._pictures import render
from ._scene import check_names, drawing_of

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Iterable
    from typing import Any

    import numpy as np
    from numpy.typing import NDArray

    from ._typed import Drawable


class Ids:
    """What is at each pixel: arrays of (height, width)."""

    def __init__(self, cell: NDArray[np.int32], section: NDArray[np.int32], sample: NDArray[np.int64]) -> None:
        self.cell = cell
        """Index of the cell among those that are drawn; −1 where nothing is."""
        self.section = section
        """As in `Mesh.section`: 0 on the soma, else one more than the index in ``cell.sections``; −1 where nothing is."""
        self.sample = sample
        """The file's own number of the nearest sample; −1 on the soma and where nothing is."""

    def __repr__(self) -> str:
        height, width = self.cell.shape
        return f"<Ids: {width} × {height}>"


def ids(what: Drawable | Iterable[Any], **options: Any) -> Ids:
    """Tells what is at each pixel of the picture that `render` draws with the same options: to mask, label or measure in it.

    A pixel tells what is at its middle, so nothing is mixed at borders. Markers, meshes beside the cells, legends and
    scale bars hide nothing. The processor tells it, whatever draws pictures.

    >>> import neurotess as nt
    >>> cell = nt.synth("granule")
    >>> seen = nt.ids(cell, view="iso")
    >>> longest = max(range(len(cell.sections)), key=lambda i: cell.sections[i].length)
    >>> mask = seen.section == longest + 1                    # (height, width), True where that section shows
    """
    check_names("ids", render, options)
    given = ungrouped(options)
    taken = dict(given)
    taken["no_legend"] = not taken.pop("legend", True)
    taken["no_cache"] = not taken.pop("cache", True)
    taken.pop("adapter", None)
    drawing = drawing_of(what, taken, "cpu", given)
    try:
        return Ids(*drawing.ids())
    finally:
        drawing.close()
