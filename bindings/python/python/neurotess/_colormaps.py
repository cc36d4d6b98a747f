"""Colors of numbers: color maps of ours and of matplotlib, and lists of colors."""

from __future__ import annotations

from . import _neurotess
from ._colors import text_of
from ._errors import OptionError

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any, TypeAlias, Union

    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    #: A name, a map of matplotlib, or colors from low to high.
    Colormap: TypeAlias = Union[str, ArrayLike, Any]

#: Color of what has no number, as in pictures.
NOTHING = 160
#: Colors that a map of matplotlib is sampled at.
STEPS = 256


def is_own(colormap: Colormap) -> bool:
    """Whether it is one of ours, by its name."""
    return isinstance(colormap, str) and _neurotess.color_scale(colormap) is not None


def scale_of(colormap: Any) -> NDArray[np.uint8]:
    """Colors from low to high, (n, 3)."""
    import numpy as np

    if isinstance(colormap, str):
        scale = _neurotess.color_scale(colormap)
        if scale is not None:
            return np.array([list(color) for color in scale], np.uint8)
        colormap = _of_matplotlib(colormap)
    if callable(colormap):
        return _bytes(colormap(np.linspace(0.0, 1.0, STEPS)))
    try:
        colors = np.array([_rgb(color) for color in colormap])
    except (TypeError, ValueError):
        colors = np.zeros((0, 3))
    if colors.ndim != 2 or len(colors) < 2 or colors.shape[1] not in (3, 4):
        raise _refused(colormap)
    return _bytes(colors)


def colored(values: NDArray[Any], colormap: Colormap, range: tuple[float, float] | None) -> NDArray[np.float32]:
    """Colors (n, 4) as glTF wants them, of light instead of bytes: 0 to 1. Where there is no number they are gray."""
    import numpy as np

    if values.ndim == 2:
        if values.shape[1] not in (3, 4) or values.min(initial=0) < 0 or values.max(initial=0) > 1:
            raise ValueError(f"colors have shape {values.shape}: red, green, blue and perhaps alpha, 0 to 1, are needed")
        bytes_of = np.asarray(values[:, :3], float) * 255
        alpha = values[:, 3] if values.shape[1] == 4 else np.ones(len(values))
    else:
        scale = scale_of(colormap).astype(float)
        known = np.isfinite(values)
        low, high = (0.0, 1.0) if range is None else range
        if range is None and known.any():
            low, high = float(values[known].min()), float(values[known].max())
        at = np.clip((np.where(known, values, low) - low) / max(high - low, 1e-30), 0, 1) * (len(scale) - 1)
        bytes_of = np.stack([np.interp(at, np.arange(len(scale)), scale[:, k]) for k in (0, 1, 2)], axis=1)
        bytes_of[~known] = NOTHING
        alpha = np.ones(len(values))
    share = bytes_of / 255
    # sRGB, IEC 61966-2-1.
    light = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    return np.ascontiguousarray(np.column_stack([light, alpha]), np.float32)


def _rgb(color: Any) -> Any:
    if not isinstance(color, str):
        return color
    digits = {"white": "ffffff", "black": "000000", "gray": "808080"}.get(color, text_of(color).removeprefix("#"))
    if len(digits) != 6:
        raise ValueError(color)
    return [int(digits[k : k + 2], 16) / 255 for k in (0, 2, 4)]


def _bytes(colors: Any) -> NDArray[np.uint8]:
    """Of whole numbers to 255, or of shares to 1."""
    import numpy as np

    colors = np.asarray(colors)[:, :3]
    if colors.dtype.kind in "iu" and colors.max(initial=0) > 1:
        return np.clip(colors, 0, 255).astype(np.uint8)
    return np.clip(np.round(colors * 255), 0, 255).astype(np.uint8)


def _of_matplotlib(name: str) -> Any:
    try:
        from matplotlib import colormaps
    except ImportError:
        raise _refused(name) from None
    try:
        return colormaps[name]
    except KeyError:
        raise _refused(name) from None


def _refused(colormap: Any) -> OptionError:
    import reprlib

    needed = (
        "use 'viridis', 'magma', 'inferno', 'plasma' or 'cividis', where matplotlib is installed the name of one of its "
        "maps, or two colors and more, from low to high"
    )
    return OptionError(f"colormap={reprlib.repr(colormap)}: {needed}", "colormap", needed)
