"""Numbers of one's own, by which cells are colored."""

from __future__ import annotations

from collections.abc import Mapping

from ._series import Times, columns_of, segments_of
from ._units import grayed, plain, times_of, unit_of

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Any, TypeAlias, Union

    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from ._morphology import Morphology
    from ._series import Columns, Series

    Values: TypeAlias = Union[ArrayLike, Mapping[str, ArrayLike], Sequence[Any]]
    #: By cell the numbers of its points and that of its somata; what they are, and their unit.
    Still: TypeAlias = tuple[list[tuple[NDArray[np.float32], float]], str, str]
    #: Numbers that do not change, or those over time.
    Told: TypeAlias = tuple[Union[Still, None], Union[Series, None]]

KINDS = ("point", "sample", "section")


def values_of(cells: list[Morphology], alone: bool, options: dict[str, Any]) -> Told:
    """Takes `values`, their `times`, `title` and `unit` from the options of a picture, and of such over time also the
    `time` that is shown; `alone`: its cell is no list."""
    values, times, title, unit = (options.pop(name, None) for name in ("values", "times", "title", "unit"))
    if values is None:
        for name, given in (("title", title), ("unit", unit)):
            if given is not None:
                raise ValueError(f"{name}={given!r} is of values: give values=, too")
        if times is not None:
            raise ValueError("times= are of the frames of values: give values=, too")
        return None, None
    for name in ("color_by", "color_by_attribute", "report"):
        if options.get(name) is not None:
            raise ValueError(f"values= are what colors tell: leave out {name}={options[name]!r}")
    if not cells:
        raise ValueError("values= are of cells: those of a circuit are colored by report= or color_by_attribute=")
    if alone:
        values = [values]
    elif isinstance(values, Mapping) or len(values) != len(cells):
        raise ValueError(f"values= of {len(cells)} cells are a list with an array, or None, for each")
    if unit is None:
        unit = next((own for own in map(_unit, values) if own is not None), None)
    values = [_without_unit(cell, one, unit) for cell, one in zip(cells, values, strict=True)]
    pairs = list(zip(cells, values, strict=True))
    named = str(title or ""), str(unit or "")
    if times is None:
        if options.get("time") is not None:
            raise ValueError("time= needs times=, too: those of the frames of values=")
        return ([_of_cell(cell, one) for cell, one in pairs], *named), None
    over_time = Times(times_of("times=", times))
    columns = [_over_time(cell, one, over_time) for cell, one in pairs]
    time = times_of("time=", options.pop("time", None))
    ends = over_time.start, over_time.step
    return None, (columns, ends, *named, None if time is None else str(time))


def _unit(values: Any) -> str | None:
    """The unit that numbers of a cell have, if they have one."""
    if isinstance(values, Mapping):
        return next((unit for unit in map(unit_of, values.values()) if unit is not None), None)
    return unit_of(values)


def _without_unit(cell: Morphology, values: Any, unit: str | None) -> Any:
    """Numbers of a cell in this unit, with NaN where they are masked."""
    if values is None:
        return None
    what = f"values= of {cell.name}"
    if not isinstance(values, Mapping):
        return plain(what, values, unit)
    # Of segments there is an array for each section.
    return {
        kind: [plain(what, one, unit) for one in array] if isinstance(array, (list, tuple)) else plain(what, array, unit)
        for kind, array in values.items()
    }


def _over_time(cell: Morphology, values: Any, times: Times) -> Columns:
    import numpy as np

    if values is None:
        return np.full(len(cell), -1, np.int32), -1, np.empty((times.count, 0), np.float32)
    if isinstance(values, Mapping) and set(values) == {"segment"}:
        return segments_of(cell, values["segment"], times)
    kind, array = _told(values)
    numbers = times.framed(f"values= of {cell.name}", array)
    return columns_of(cell, _kind(cell, numbers.shape[1], kind), numbers)


def _of_cell(cell: Morphology, values: Any) -> tuple[NDArray[np.float32], float]:
    import numpy as np

    if values is None:
        return np.full(len(cell), np.nan, np.float32), np.nan
    kind, array = _told(values)
    if array.ndim != 1 or array.dtype.kind not in "fiub":
        over_time = ", or times= of their frames" if array.ndim == 2 else ""
        raise ValueError(
            f"values= of {cell.name} are {array.dtype} of shape {array.shape}: one number for each is needed{over_time}"
        )
    kind = _kind(cell, len(array), kind)
    numbers = grayed(f"values= of {cell.name}", array)
    soma = len(cell.to_table()) - len(cell)
    if kind == "point":
        return numbers, np.nan
    if kind == "sample":
        return np.ascontiguousarray(numbers[soma:]), _mean(numbers[:soma])
    # Of sections the soma's number may come first, as meshes count.
    with_soma = len(numbers) > len(cell.sections)
    columns = cell._section_columns()
    of_points = np.repeat(numbers[with_soma:], columns["end"] - columns["first"])
    return np.ascontiguousarray(of_points), float(numbers[0]) if with_soma else np.nan


def _told(values: Any) -> tuple[str | None, NDArray[Any]]:
    import numpy as np

    if not isinstance(values, Mapping):
        return None, np.asarray(values)
    if len(values) != 1 or next(iter(values)) not in KINDS:
        if "segment" in values:
            raise ValueError("values={'segment': …} are over time: give times=, too, or values of sections")
        raise ValueError(f"values= have the keys {list(values)}: one of {', '.join(map(repr, KINDS))} is needed")
    [(kind, array)] = values.items()
    return kind, np.asarray(array)


def _kind(cell: Morphology, count: int, kind: str | None) -> str:
    """What so many values are of."""
    kinds = [k for k in _kinds(cell, count) if kind in (None, k)]
    if len(kinds) != 1:
        raise ValueError(_wrong_length(cell, count, kind, kinds))
    return kinds[0]


def _kinds(cell: Morphology, count: int) -> list[str]:
    """What as many values may be of."""
    points, samples, sections = len(cell), len(cell.to_table()), len(cell.sections)
    kinds = ["point"] if count == points else []
    if count == samples != points:
        kinds.append("sample")
    if count in (sections, sections + 1):
        kinds.append("section")
    return kinds


def _wrong_length(cell: Morphology, count: int, kind: str | None, kinds: list[str]) -> str:
    if len(kinds) > 1:
        named = " or ".join(f"values={{{k!r}: …}}" for k in kinds)
        return f"values= of {cell.name}: {count} may be of {'s or '.join(kinds)}s: say {named}"
    points, samples, sections = len(cell), len(cell.to_table()), len(cell.sections)
    possible = {
        "point": f"{points} points",
        "sample": f"{samples} samples with the soma's",
        "section": f"{sections} sections, or {sections + 1} with the soma first",
    }
    wanted = possible[kind] if kind else "; ".join(possible.values())
    return f"values= of {cell.name} are {count}: it has {wanted}"


def _mean(numbers: NDArray[np.float32]) -> float:
    import numpy as np

    known = numbers[np.isfinite(numbers)]
    return float(known.mean()) if len(known) else np.nan
