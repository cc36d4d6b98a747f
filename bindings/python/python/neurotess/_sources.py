"""What a cell may be given as: files and their content, folders, and cells of other packages."""

from __future__ import annotations

import os

from . import _neurotess
from ._errors import ReadError, read_error

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

#: Extensions of tracings that a folder is searched for; of others a folder has many that are none.
EXTENSIONS = ("swc", "eswc", "asc", "nml", "traces", "swc.gz", "asc.gz")


def package_of(source: Any) -> str | None:
    """The package that a cell is of, if it is one that we know."""
    for base in type(source).__mro__:
        package = base.__module__.partition(".")[0]
        if package in ("navis", "morphio", "neurom", "nrn", "hoc"):
            return package
    return None


def is_surface(source: Any) -> bool:
    """Whether it is a surface: a `Mesh`, or another package's with vertices (or points, as in PyVista) and faces."""
    if isinstance(source, (str, bytes)) or package_of(source) in ("nrn", "hoc") or hasattr(source, "nodes"):
        return False
    return (hasattr(source, "vertices") or hasattr(source, "triangulate")) and hasattr(source, "faces")


def arrays_of(surface: Any) -> tuple[Any, Any]:
    """Vertices and triangles of a surface of another package."""
    if hasattr(surface, "vertices"):
        return surface.vertices, surface.faces
    # PyVista: faces are numbers of corners, each before these.
    triangles = surface.triangulate()
    return triangles.points, triangles.faces.reshape(-1, 4)[:, 1:]


def is_table(source: Any) -> bool:
    """Whether it is a table of samples: a data frame, a structured array or columns by name."""
    named = getattr(getattr(source, "dtype", None), "names", None)
    return bool(named) or isinstance(source, dict) or hasattr(source, "columns")


def is_alone(source: Any) -> bool:
    """Whether it is one cell, and no list of them."""
    package = package_of(source)
    if package is not None:
        # Whatever else one asks of an object of NEURON may be an error.
        return type(source).__name__ != "NeuronList"
    # A `Morphology` has a cell of the module; it is not imported here, since it reads by this file.
    if isinstance(source, (str, os.PathLike, bytes)) or hasattr(source, "read") or hasattr(source, "_cell"):
        return True
    return is_table(source) or is_surface(source)


def files_of(path: str | os.PathLike[str]) -> list[str]:
    """The tracings of a folder, in the order of their names; a file alone."""
    path = expanded(path)
    if not os.path.isdir(path):
        return [path]
    names = sorted(os.listdir(path))
    found = [name for name in names if name.lower().endswith(tuple(f".{end}" for end in EXTENSIONS))]
    if not found:
        raise ReadError(path, None, f"has no tracings: no file ends in .{', .'.join(EXTENSIONS)}")
    return [os.path.join(path, name) for name in found]


def expanded(path: str | os.PathLike[str]) -> str:
    """A path as text; ``~`` is the user's folder."""
    text = os.fspath(path)
    return os.path.expanduser(text) if text.startswith("~") else text


def read_cell(
    source: Any, format: str | None, name: str | None, strict: bool, *, bad_radii: bool = False
) -> _neurotess.Cell:
    """Reads a cell; with `bad_radii`, radii that are no numbers are 0."""
    if isinstance(source, (str, os.PathLike)):
        path = expanded(source)
        if "://" in path:
            return read_cell(_fetched(path), format, name or path.rpartition("/")[2], strict)
        if format is None:
            return _neurotess.Cell.read(path, strict, bad_radii)
        try:
            with open(path, "rb") as file:
                return read_cell(file, format, name or path, strict)
        except OSError as error:
            if isinstance(error, ReadError):
                raise
            raise read_error(path, None, str(error), error.errno) from None
    if hasattr(source, "read"):
        name = name or getattr(source, "name", None)
        source = source.read()
    if isinstance(source, str):
        source = source.encode()
    if not isinstance(source, (bytes, bytearray, memoryview)):
        hint = ""
        if isinstance(source, (list, tuple)):
            hint = ": of a list, neurotess.mesh_many makes meshes and neurotess.render a picture"
        elif is_surface(source):
            hint = ": it is a surface, which neurotess.check judges and neurotess.render draws"
        raise TypeError(
            f"a morphology is read from a path, bytes, an open file or a table, not from {type(source).__name__}{hint}"
        )
    return _neurotess.Cell.read_bytes(bytes(source), str(name or "<bytes>"), format, strict)


def _fetched(address: str) -> bytes:
    """The content at an address, by fsspec."""
    from ._packages import needed

    try:
        with needed("fsspec").open(address, "rb") as file:
            content: bytes = file.read()
            return content
    except FileNotFoundError:
        from ._errors import missing_file

        raise missing_file(address) from None
    except OSError as error:
        raise read_error(address, None, str(error), None) from error
