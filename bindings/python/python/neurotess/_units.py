"""Numbers of other packages as plain arrays: their units are converted, what is masked is NaN.

Quantities of `quantities` (and neo), pint and astropy convert themselves; arrays of xarray and netCDF name a unit as text;
a ``TimeSeries`` of pynwb has its numbers in units. A data set of h5py may have a unit and a factor that reading it
forgets: that is warned of.
"""

from __future__ import annotations

import warnings

from ._errors import NeurotessWarning

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    import numpy as np
    from numpy.typing import NDArray

#: Units that are converted where no package does it: what they are of, and their factor.
_WORDS = {
    **dict.fromkeys(("s", "sec", "second", "seconds"), ("time", 1e3)),
    **dict.fromkeys(("ms", "msec", "millisecond", "milliseconds"), ("time", 1.0)),
    **dict.fromkeys(("us", "µs", "μs", "microsecond", "microseconds"), ("time", 1e-3)),
    **dict.fromkeys(("V", "volt", "volts"), ("voltage", 1e3)),
    **dict.fromkeys(("mV", "millivolt", "millivolts"), ("voltage", 1.0)),
    **dict.fromkeys(("uV", "µV", "μV", "microvolt", "microvolts"), ("voltage", 1e-3)),
    **dict.fromkeys(("A", "ampere", "amperes"), ("current", 1e9)),
    **dict.fromkeys(("nA", "nanoampere", "nanoamperes"), ("current", 1.0)),
    **dict.fromkeys(("pA", "picoampere", "picoamperes"), ("current", 1e-3)),
    **dict.fromkeys(("m", "meter", "meters"), ("length", 1e6)),
    **dict.fromkeys(("mm", "millimeter", "millimeters"), ("length", 1e3)),
    **dict.fromkeys(("um", "µm", "μm", "micrometer", "micrometers", "micron", "microns"), ("length", 1.0)),
    **dict.fromkeys(("nm", "nanometer", "nanometers"), ("length", 1e-3)),
}


def unit_of(given: Any) -> str | None:
    """The unit of numbers of another package; None where they have none."""
    if isinstance(given, (list, tuple)):
        return next((unit for unit in map(unit_of, given) if unit is not None), None)
    if hasattr(given, "get_data_in_units"):
        return str(given.unit)
    if hasattr(given, "rescale") and hasattr(given, "dimensionality"):
        return str(given.dimensionality.string)
    if hasattr(given, "to_value") and hasattr(given, "unit"):
        return str(given.unit)
    if hasattr(given, "magnitude") and hasattr(given, "units"):
        return f"{given.units:~}"
    units = getattr(given, "units", None)
    return units if isinstance(units, str) else None


def plain(what: str, given: Any, unit: str | None = None) -> Any:
    """Numbers without their unit: in `unit`, or in their own. What has no unit stays as it is, but for masks."""
    if isinstance(given, (list, tuple)) and unit_of(given) is not None:
        to = unit or unit_of(given)
        return type(given)(plain(what, one, to) for one in given)
    own = unit_of(given)
    if own is None:
        return _unmasked(_told_of_file(what, given, unit))
    if hasattr(given, "get_data_in_units"):
        return _scaled(what, given.get_data_in_units(), own, unit)
    to = unit or own
    try:
        if hasattr(given, "rescale"):
            return given.rescale(to).magnitude if unit else given.magnitude
        if hasattr(given, "to_value"):
            return given.to_value(to) if unit else given.value
        if hasattr(given, "magnitude"):
            return given.to(to).magnitude if unit else given.magnitude
    except Exception as error:
        raise ValueError(f"{what} are in {own!r}, which cannot be converted to {to!r}: {error}") from None
    return _scaled(what, given, own, unit)


def times_of(what: str, given: Any) -> Any:
    """Times as milliseconds: of a ``TimeSeries``, of numbers with a unit, or numbers that are ms already."""
    import numpy as np

    if hasattr(given, "get_data_in_units"):
        if given.timestamps is not None:
            return 1e3 * np.asarray(given.timestamps)
        return 1e3 * (float(given.starting_time or 0.0) + np.arange(len(given.data)) / float(given.rate))
    if hasattr(given, "times") and unit_of(given.times) is not None:
        given = given.times
    return plain(what, given, "ms")


def _scaled(what: str, given: Any, own: str, unit: str | None) -> Any:
    """Numbers whose unit is a word."""
    import numpy as np

    if unit is None or unit == own:
        return _unmasked(given)
    (of, factor), (of_other, other) = (_WORDS.get(word, (None, 1.0)) for word in (own, unit))
    if of is None or of != of_other:
        raise ValueError(f"{what} are in {own!r}, which is not converted to {unit!r}: give plain numbers")
    return np.asarray(_unmasked(given), dtype=float) * (factor / other)


def _told_of_file(what: str, given: Any, unit: str | None) -> Any:
    """Warns of a factor and a unit that a data set of HDF5 has beside its numbers."""
    attributes = getattr(given, "attrs", None)
    if not type(given).__module__.startswith("h5py") or attributes is None:
        return given
    for name, usual in (("conversion", 1.0), ("offset", 0.0)):
        factor = attributes.get(name, usual)
        if factor != usual:
            warnings.warn(
                NeurotessWarning(
                    f"{what}: the data set has {name}={factor}, which is not applied: give numbers in units, as those of "
                    "TimeSeries.get_data_in_units()"
                ),
                stacklevel=2,
            )
    own = attributes.get("unit", attributes.get("units"))
    own = own.decode() if isinstance(own, bytes) else own
    if own and own != unit and _WORDS.get(str(own)) != _WORDS.get(unit or "", ()):
        taken = f"as {unit}" if unit else "without it"
        warnings.warn(
            NeurotessWarning(f"{what}: the unit of the data set is {own!r}; its numbers are taken {taken}"), stacklevel=2
        )
    return given


def _unmasked(given: Any) -> Any:
    """An array with NaN where it is masked, or has no value."""
    import numpy as np

    if np.ma.isMaskedArray(given):
        masked: Any = given
        if masked.dtype.kind not in "fiub":
            return masked
        return masked.astype(float).filled(np.nan) if np.ma.is_masked(masked) else np.asarray(masked)
    if hasattr(given, "to_numpy") and getattr(getattr(given, "dtype", None), "na_value", None) is not None:
        try:
            return given.to_numpy(dtype=float, na_value=np.nan)
        except (TypeError, ValueError):
            return given
    return given


def grayed(what: str, numbers: NDArray[Any]) -> NDArray[np.float32]:
    """Numbers as they are colored: infinite ones have no color, which is told."""
    import numpy as np

    with np.errstate(over="ignore"):
        told = np.ascontiguousarray(numbers, dtype=np.float32)
    infinite = np.isinf(told)
    count = int(infinite.sum())
    if count:
        is_or_are = "is" if count == 1 else "are"
        warnings.warn(
            NeurotessWarning(f"{what}: {count} of {told.size} {is_or_are} infinite: drawn gray"), stacklevel=2
        )
        told = np.where(infinite, np.float32(np.nan), told)
    return told
