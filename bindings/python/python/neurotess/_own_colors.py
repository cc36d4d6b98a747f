"""Colors of one's own for each point, and of kinds that have whole numbers."""

from __future__ import annotations

from collections.abc import Mapping

from ._colormaps import _bytes, _of_matplotlib, is_own

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    import numpy as np
    from numpy.typing import NDArray

#: Most colors of a map of kinds.
MOST_KINDS = 40


def colors_of_points(alone: bool, options: dict[str, Any]) -> list[list[int]] | None:
    """Where `values` are colors, (n, 3), numbers take their place: which color of a list each has. Gives the list."""
    import numpy as np

    values = options.get("values")
    if values is None or options.get("times") is not None or isinstance(values, str):
        return None
    listed = [values] if alone else list(values)
    arrays = [None if one is None else _colors(one) for one in listed]
    if not any(array is not None for array in arrays):
        return None
    for one, array in zip(listed, arrays, strict=True):
        if one is not None and array is None:
            raise ValueError("values= are colors of one cell, (n, 3), and numbers of another: give either")
    for name in ("colormap", "range", "title", "unit"):
        if options.get(name) is not None:
            raise ValueError(f"values= are colors: leave out {name}=")
    every = np.concatenate([array for array in arrays if array is not None])
    colors, index = np.unique(every, axis=0, return_inverse=True)
    numbers = index.reshape(-1).astype(np.float32)
    start, told = 0, []
    for one, array in zip(listed, arrays, strict=True):
        if array is None:
            told.append(None)
            continue
        own: Any = numbers[start : start + len(array)]
        start += len(array)
        told.append({next(iter(one)): own} if isinstance(one, Mapping) else own)
    options["values"] = told[0] if alone else told
    options["range"] = (0.0, float(max(len(colors) - 1, 1)))
    # A bar of them would tell nothing.
    options["no_legend"] = True
    scale: list[list[int]] = (colors if len(colors) > 1 else np.repeat(colors, 2, axis=0)).tolist()
    return scale


def _colors(values: Any) -> NDArray[np.uint8] | None:
    """The colors of an array, alone or by the name of what it is of."""
    import numpy as np

    if isinstance(values, Mapping):
        if len(values) != 1 or "segment" in values:
            return None
        values = next(iter(values.values()))
    try:
        array = np.asarray(values)
    except ValueError:
        return None
    if array.ndim != 2 or array.shape[1] not in (3, 4) or array.dtype.kind not in "fiu":
        return None
    whole = array.dtype.kind in "iu"
    most = 255 if whole else 1
    if not (np.isfinite(array).all() and array.min(initial=0) >= 0 and array.max(initial=0) <= most):
        raise ValueError("values= are colors: red, green and blue from 0 to 1, or whole numbers to 255, are needed")
    return array[:, :3].astype(np.uint8) if whole else _bytes(array.astype(float))


def kinds_of(still: Any, options: dict[str, Any]) -> list[list[int]] | None:
    """Where numbers are kinds, whole numbers from 0 on, and the color map is a list of colors like ``"tab10"``: those colors,
    of which each kind has its own."""
    import numpy as np

    colormap = options.get("colormap")
    if still is None or colormap is None or is_own(colormap) or options.get("range") is not None:
        return None
    if isinstance(colormap, str):
        colormap = _of_matplotlib(colormap)
    listed = getattr(colormap, "colors", None)
    if listed is None or not 2 <= len(listed) <= MOST_KINDS:
        return None
    numbers = np.concatenate([np.append(points, soma) for points, soma in still[0]])
    numbers = numbers[np.isfinite(numbers)]
    if not len(numbers) or (numbers != np.round(numbers)).any() or numbers.min() < 0 or numbers.max() >= len(listed):
        return None
    options["range"] = (0.0, len(listed) - 1.0)
    del options["colormap"]
    colors: list[list[int]] = _bytes(np.asarray(listed, float)).tolist()
    return colors
