"""Tables of samples, whatever their columns are called."""

from __future__ import annotations

from ._units import plain, unit_of

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    import numpy as np
    from numpy.typing import NDArray

#: Names of each column, in the order of SWC: ours, those of navis, of CATMAID, of SWC files.
NAMES = {
    "id": ("id", "node_id", "treenode_id", "sample", "sample_number", "n"),
    "type": ("type", "label", "structure_identifier", "t", "kind"),
    "x": ("x",),
    "y": ("y",),
    "z": ("z",),
    "radius": ("radius", "r"),
    "parent": ("parent", "parent_id", "parent_sample", "pid", "p"),
}


def columns_of(
    table: Any,
) -> tuple[
    NDArray[np.int64],
    NDArray[np.int64],
    NDArray[np.float64],
    NDArray[np.float64],
    NDArray[np.float64],
    NDArray[np.float64],
    NDArray[np.int64],
]:
    """The seven columns of a table."""
    import numpy as np

    if isinstance(table, np.ndarray) and table.dtype.names is None:
        if table.ndim != 2 or table.shape[1] != 7:
            raise ValueError(
                f"an array of shape {table.shape} is no table: seven columns are needed, "
                "id, type, x, y, z, radius and parent"
            )
        found = list(table.T)
    else:
        names = list(table.dtype.names if isinstance(table, np.ndarray) else table.keys())
        found = [table[_named(column, names)] for column in NAMES]
        found = [column if unit_of(column) else np.asarray(plain("a column", column)) for column in found]
    ids, types, x, y, z, radii, parents = found
    lengths = {len(column) for column in found}
    if len(lengths) > 1:
        raise ValueError(f"the columns have different lengths: {sorted(lengths)}")
    return (
        _integers(ids, "id"),
        _integers(types, "type"),
        _numbers(x, "x"),
        _numbers(y, "y"),
        _numbers(z, "z"),
        _numbers(radii, "radius"),
        _integers(parents, "parent"),
    )


def _named(column: str, names: list[Any]) -> Any:
    plain = {str(name).lower(): name for name in reversed(names)}
    for name in NAMES[column]:
        if name in plain:
            return plain[name]
    raise ValueError(
        f"the table has no column {column!r} (nor {', '.join(map(repr, NAMES[column][1:])) or 'another'}): "
        f"it has {', '.join(map(repr, names))}"
    )


def _numbers(values: NDArray[Any], name: str) -> NDArray[np.float64]:
    import numpy as np

    try:
        return np.ascontiguousarray(plain(f"column {name!r}", values, "um"), dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise ValueError(f"column {name!r} is not of numbers: {error}") from None


def _integers(values: NDArray[Any], name: str) -> NDArray[np.int64]:
    import numpy as np

    if values.dtype.kind in "iub":
        return np.ascontiguousarray(values, dtype=np.int64)
    numbers = _numbers(values, name)
    whole = np.nan_to_num(numbers, nan=-1.0).astype(np.int64)
    # Parents of roots are missing values in some tables.
    wrong = np.flatnonzero((whole != numbers) & ~(np.isnan(numbers) & (name == "parent")))
    if len(wrong):
        raise ValueError(f"column {name!r} is not of whole numbers: row {wrong[0]} has {numbers[wrong[0]]}")
    return np.ascontiguousarray(whole)
