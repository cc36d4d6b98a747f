"""What goes wrong, as exceptions and warnings."""

from __future__ import annotations

import errno


class NeurotessError(Exception):
    """Everything that neurotess raises beside Python's own exceptions."""


class ReadError(NeurotessError):
    """A file that cannot be read.

    A file that is not there is a ``FileNotFoundError`` too, and one that the system does not give is an
    ``OSError``.
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


class _UnreadableFile(ReadError, OSError):
    def __init__(self, file: str, line: int | None, message: str) -> None:
        super().__init__(file, line, message)
        self.filename = file


class _MissingFile(_UnreadableFile, FileNotFoundError):
    pass


class _ForbiddenFile(_UnreadableFile, PermissionError):
    pass


class MeshError(NeurotessError):
    """A cell that cannot be meshed as the options ask."""


class RenderError(NeurotessError):
    """A picture that cannot be drawn: there is no graphics adapter, or it fails."""


class NeurotessWarning(UserWarning):
    """Everything that neurotess warns of."""


class ReadWarning(NeurotessWarning):
    """Something odd in a file that could be read all the same."""


def read_error(file: str, line: int | None, message: str, number: int | None) -> ReadError:
    """The exception for a file; `number` is the system's error, if there is one."""
    if number is None:
        return ReadError(file, line, message)
    kind: type[_UnreadableFile] = {
        errno.ENOENT: _MissingFile,
        errno.EACCES: _ForbiddenFile,
    }.get(number, _UnreadableFile)
    error = kind(file, line, message)
    error.errno = number
    return error


def option_error(message: str) -> ValueError:
    """The exception for an option, which the command line calls ``--max-error <E>``."""
    import re

    def plain(name: re.Match[str]) -> str:
        return name[1].replace("-", "_")

    return ValueError(re.sub(r"--([a-z][a-z-]*)(?: <[^>]*>|\[=<[^>]*>\])?", plain, message))
