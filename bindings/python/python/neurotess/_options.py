"""Options of functions as the module takes them, which checks them."""

from __future__ import annotations

import operator
import os

from . import _neurotess
from ._errors import OptionError
from ._units import plain, unit_of

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from typing import Any


def recipe(options: Mapping[str, Any]) -> _neurotess.Recipe:
    """Options of meshes, checked."""
    try:
        files = {name: os.fspath(value) for name, value in options.items() if isinstance(value, os.PathLike)}
        lengths = {name: plain(f"{name}=", value, "um") for name, value in options.items() if unit_of(value) is not None}
        return _neurotess.Recipe({**options, **files, **lengths})
    except OptionError as error:
        from ._errors import with_given

        raise with_given(error, options) from None


def keywords(options: Mapping[str, Any]) -> dict[str, Any]:
    """Options of pictures and edits as the module takes them: paths as text, lengths in µm."""
    given = {name: value for name, value in options.items() if value is not None and value is not False}
    files = {name: os.fspath(value) for name, value in given.items() if isinstance(value, os.PathLike)}
    lengths = {name: plain(f"{name}=", value, "um") for name, value in given.items() if unit_of(value) is not None}
    return {**given, **files, **lengths}


def joined(values: Iterable[Any] | float | None, by: str) -> str | float | None:
    """Several values as one, as in ``1280x960``; one stays what it is."""
    if values is None or isinstance(values, str) or not hasattr(values, "__iter__"):
        return values
    return by.join(map(word, values))


def word(value: Any) -> str:
    """A value as text. Numbers of NumPy are numbers, too."""
    if isinstance(value, str):
        return value
    if isinstance(value, os.PathLike):
        return str(os.fspath(value))
    if unit_of(value) is not None:
        # Lengths: times are milliseconds before they come here.
        value = plain("an option", value, "um")
    try:
        return str(operator.index(value))
    except TypeError:
        return repr(float(value))
