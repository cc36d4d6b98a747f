"""Numbers of one's own over time, as columns that points of cells share."""

from __future__ import annotations

from collections.abc import Sequence

from ._places import distances_from_root
from ._units import grayed

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any, TypeAlias

    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from ._morphology import Morphology

    #: Of each point its column (−1: none), that of the somata, and the numbers of the columns, (frames, columns).
    Columns: TypeAlias = tuple[NDArray[np.int32], int, NDArray[np.float32]]
    #: By cell its columns; start and step (ms) of the frames; what they are, and their unit; the time that is shown.
    Series: TypeAlias = tuple[list[Columns], tuple[float, float], str, str, str | None]


class Times:
    """Times (ms) of frames: evenly spaced ones, in which those of a variable step are held."""

    def __init__(self, times: ArrayLike) -> None:
        import numpy as np

        given = np.asarray(times, dtype=float)
        if given.ndim != 1 or not len(given) or not np.isfinite(given).all() or (np.diff(given) <= 0).any():
            raise ValueError("times= are the times (ms) of the frames, each later than the one before")
        self.count = len(given)
        self.start = float(given[0])
        self.step = float(given[-1] - given[0]) / (self.count - 1) if self.count > 1 else 1.0
        grid = self.start + self.step * np.arange(self.count)
        # A time that is a frame's but for rounding is that frame's.
        self._frames = np.searchsorted(given, grid + 1e-6 * self.step, side="right") - 1

    def framed(self, what: str, array: NDArray[Any]) -> NDArray[np.float32]:
        """Numbers by frame: (frames, n). They may come as (n, frames), as recordings of segments do."""
        import numpy as np

        if array.ndim == 1 and len(array) == self.count:
            array = array[:, None]
        if array.ndim != 2 or self.count not in array.shape or array.dtype.kind not in "fiub":
            raise ValueError(
                f"{what} are {array.dtype} of shape {array.shape}: numbers of {self.count} frames are needed, since "
                f"times= are {self.count}"
            )
        if array.shape[0] != self.count:
            array = array.T
        return grayed(what, array[self._frames])


def columns_of(cell: Morphology, kind: str, numbers: NDArray[np.float32]) -> Columns:
    """Numbers of points, samples or sections over time, (frames, n), which fit the cell."""
    import numpy as np

    points = np.arange(len(cell), dtype=np.int32)
    if kind == "point":
        return points, -1, numbers
    if kind == "sample":
        soma = len(cell.to_table()) - len(cell)
        if not soma:
            return points, -1, numbers
        # Somata have one number: the mean of their samples'.
        mean = numbers[:, :soma].mean(axis=1, keepdims=True)
        return points + 1, 0, np.ascontiguousarray(np.hstack([mean, numbers[:, soma:]]))
    with_soma = numbers.shape[1] > len(cell.sections)
    of_points = np.repeat(np.arange(len(cell.sections)), _counts(cell)) + with_soma
    return of_points.astype(np.int32), 0 if with_soma else -1, numbers


def segments_of(cell: Morphology, segments: Any, times: Times) -> Columns:
    """Numbers of the segments of each section over time: a list with an array for each section, the soma's first or
    not."""
    import numpy as np

    sections = len(cell.sections)
    if not isinstance(segments, Sequence) or len(segments) not in (sections, sections + 1):
        count = f"{len(segments)} arrays" if hasattr(segments, "__len__") else type(segments).__name__
        raise ValueError(
            f"values={{'segment': …}} of {cell.name} are {count}: a list with an array for each of {sections} sections is "
            f"needed, or for {sections + 1} with the soma first"
        )
    of_sections = [times.framed(f"values of segments of section {k}", np.asarray(one)) for k, one in enumerate(segments)]
    with_soma = len(of_sections) > sections
    soma = 0 if with_soma else -1
    if with_soma:
        # Somata have one number.
        of_sections[0] = of_sections[0].mean(axis=1, keepdims=True)
    first, columns = 0, np.empty(len(cell), np.int32)
    places = _places(cell)
    end = 0
    for k, own in enumerate(of_sections):
        if not (with_soma and k == 0):
            start, end = end, end + _counts(cell)[k - with_soma]
            of = np.minimum((places[start:end] * own.shape[1]).astype(np.int32), own.shape[1] - 1)
            columns[start:end] = first + of
        first += own.shape[1]
    return columns, soma, np.ascontiguousarray(np.hstack(of_sections))


def _counts(cell: Morphology) -> NDArray[Any]:
    """Points of each section."""
    columns = cell._section_columns()
    counts: NDArray[Any] = columns["end"] - columns["first"]
    return counts


def _places(cell: Morphology) -> NDArray[np.float64]:
    """Of each point the share of its section's length before it, 0 to 1. Sections begin where their parents end."""
    import numpy as np

    columns = cell._section_columns()
    ends, parents = columns["path_length"], columns["parent"]
    starts = np.where(parents >= 0, ends[parents], 0.0)
    lengths = np.where(ends > starts, ends - starts, 1.0)
    counts = _counts(cell)
    own = distances_from_root(cell) - np.repeat(starts, counts)
    places: NDArray[np.float64] = np.clip(own / np.repeat(lengths, counts), 0.0, 1.0)
    return places

