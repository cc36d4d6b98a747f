"""What goes wrong, as exceptions and warnings."""

from __future__ import annotations

import errno
import os

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import Any, TypeVar

    Unreadable = TypeVar("Unreadable", bound="UnreadableFileError")


class NeurotessError(Exception):
    """Everything that neurotess raises beside Python's own exceptions."""


class ReadError(NeurotessError):
    """A file that cannot be read.

    One that is not there is a `MissingFileError`, which is a ``FileNotFoundError``, too.
    """

    def __init__(self, file: str, line: int | None, message: str) -> None:
        super().__init__(file, line, message)
        self._told = file, line, message

    @property
    def file(self) -> str:
        """The file as it was named."""
        return self._told[0]

    @property
    def line(self) -> int | None:
        """The line, from 1 on, if the fault is in one."""
        return self._told[1]

    @property
    def message(self) -> str:
        """What is wrong, and what to do."""
        return self._told[2]

    def __str__(self) -> str:
        place = self.file if self.line is None else f"{self.file}:{self.line}"
        return f"{place}: {self.message}"


class UnreadableFileError(ReadError, OSError):
    """A file that the system does not give."""

    def __init__(self, file: str, line: int | None, message: str) -> None:
        super().__init__(file, line, message)
        self.filename = file


class MissingFileError(UnreadableFileError, FileNotFoundError):
    """A file that is not there."""


class ForbiddenFileError(UnreadableFileError, PermissionError):
    """A file that may not be read."""


class FolderError(UnreadableFileError, IsADirectoryError):
    """A folder where a file is needed."""


class OptionError(NeurotessError, ValueError):
    """An option that is wrong: its name, what was given, and what is possible."""

    def __init__(self, message: str, option: str | None = None, needed: str = "") -> None:
        super().__init__(message)
        self.option: str | None = option
        """The option, if it is about a single one."""
        self.needed: str = needed
        """What is possible."""

    def __reduce__(self) -> tuple[type[OptionError], tuple[str, str | None, str]]:
        return type(self), (str(self), self.option, self.needed)


class MeshError(NeurotessError):
    """A cell that cannot be meshed as the options ask."""


class RenderError(NeurotessError):
    """A picture that cannot be drawn: nothing is in it, or the graphics adapter that was named is not there or fails."""


class NeurotessWarning(UserWarning):
    """Everything that neurotess warns of."""


class ReadWarning(NeurotessWarning):
    """Something odd in a file that could be read all the same."""


def read_error(file: str, line: int | None, message: str, number: int | None) -> ReadError:
    """The exception for a file; `number` is the system's error, if there is one."""
    if number is None:
        # Folders have no number of the system.
        return folder(file) if line is None and os.path.isdir(file) else ReadError(file, line, message)
    if number == errno.ENOENT:
        return missing_file(file)
    kind = ForbiddenFileError if number in (errno.EACCES, errno.EPERM) else UnreadableFileError
    message = f"cannot be read ({os.strerror(number)}): check the path and its permissions"
    return _numbered(kind(file, line, message), number)


def missing_file(file: str) -> MissingFileError:
    """The exception for a file that is not there."""
    return _numbered(MissingFileError(file, None, "there is no such file: check the path"), errno.ENOENT)


def folder(file: str) -> FolderError:
    """The exception for a folder."""
    told = "is a folder: neurotess.read and neurotess.mesh_many take one"
    return _numbered(FolderError(file, None, told), errno.EISDIR)


def _numbered(error: Unreadable, number: int) -> Unreadable:
    error.errno = number
    return error


def option_error(message: str) -> OptionError:
    """The exception for an option, which the command line calls ``--max-error <E>``."""
    from ._words import told

    option, given, needed = told(message)
    if option is None:
        return OptionError(needed)
    shown = "" if option == "meshes" else f"={given!r}"
    return OptionError(f"{option}{shown}: {needed}", option, needed)


def value_error(option: str, given: str, needed: str) -> OptionError:
    """The exception for an option that has another value than it can have."""
    from ._words import named

    option, needed = named(option, needed)
    shown = "" if option == "meshes" else f"={given!r}"
    return OptionError(f"{option}{shown}: {needed}", option, needed)


def with_given(error: OptionError, options: Mapping[str, Any]) -> OptionError:
    """The same error with the value as it was given to a function."""
    import reprlib

    if error.option is None or options.get(error.option) is None:
        return error
    given = "" if error.option == "meshes" else f"={reprlib.repr(options[error.option])}"
    return type(error)(f"{error.option}{given}: {error.needed}", error.option, error.needed)
