"""Numbers of one's own for the vertices of a mesh, as files hold them."""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import Any

    import numpy as np
    from numpy.typing import NDArray

    from ._colormaps import Colormap

#: Names that files have for what every mesh has.
TAKEN = {
    *("type", "point", "section", "radius", "sample", "position", "normal", "normals", "points", "color_0"),
    *("x", "y", "z", "nx", "ny", "nz"),
}

#: Names that files have for colors of vertices.
COLORS = {"red", "green", "blue", "rgb"}


def check_name(name: str) -> None:
    """Checks that files can have an attribute of this name."""
    if name.lower() in TAKEN:
        raise ValueError(f"name={name!r} is an attribute that every mesh has: choose another name")
    if not (name.isascii() and name.isidentifier()):
        raise ValueError(f"name={name!r}: letters, digits and _ are needed, a letter first, as in 'voltage_mV'")


def holds_own(kind: str) -> bool:
    """Whether a format, by its name or extension, holds attributes of one's own."""
    return kind.lower().lstrip(".") in ("ply", "vtu", "glb")


def own_column(name: str, values: NDArray[Any]) -> tuple[str, int, NDArray[np.float32]]:
    """Name, number of components, and all numbers in a row."""
    import numpy as np

    components = 1 if values.ndim == 1 else values.shape[1]
    return name, components, np.ascontiguousarray(values, np.float32).reshape(-1)


def own_arrays(columns: list[tuple[str, int, NDArray[Any]]]) -> dict[str, NDArray[Any]]:
    """What a file has, (v,) or (v, n) by name; a name that every mesh has for something else gets a ``_``."""
    arrays: dict[str, NDArray[Any]] = {}
    for name, components, numbers in columns:
        while name.lower() in TAKEN or name in arrays:
            name += "_"
        arrays[name] = numbers if components == 1 else numbers.reshape(-1, components)
    return arrays


def color_column(
    attributes: Mapping[str, NDArray[Any]],
    name: str,
    kind: str,
    colormap: Colormap,
    range: tuple[float, float] | None,
) -> tuple[str, int, NDArray[np.float32]]:
    """Colors by an attribute, as a GLB has them."""
    from ._colormaps import colored

    if kind.lower().lstrip(".") != "glb":
        raise ValueError(f"color={name!r}: a GLB has colors of vertices: name the file so, as in 'cell.glb'")
    if name not in attributes:
        raise ValueError(f"color={name!r}: the mesh has {', '.join(map(repr, attributes))}")
    return own_column("COLOR_0", colored(attributes[name], colormap, range))
