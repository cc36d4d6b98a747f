"""Meshes on a cluster, with Dask (``pip install 'neurotess[dask]'``).

>>> import neurotess as nt
>>> from dask.distributed import Client                              # doctest: +SKIP
>>> done = nt.dask.mesh(paths, "meshes/", Client(), level=4)         # doctest: +SKIP
>>> made = nt.dask.neuroglancer(nt.Circuit("circuit/"), "shared/", Client(), sharded=True)  # doctest: +SKIP
"""

from __future__ import annotations

import hashlib
import json
import os
import tempfile
from collections import namedtuple

from . import __version__, _neurotess, _options
from ._circuits import Circuit
from ._meshing import _mesh
from ._morphology import Morphology
from ._neuroglancer import neuroglancer as _neuroglancer
from ._sources import expanded, read_cell

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Iterable
    from typing import Any, NamedTuple, TypeAlias

    from typing_extensions import Unpack

    from ._typed import MeshOptions

    # Files, or a circuit's path and whether it may be large.
    Cells: TypeAlias = list[str] | tuple[str, bool]

    class Made(NamedTuple):
        """What became of a file."""

        input: str
        """The file that was read."""
        out: str
        """The mesh."""
        error: str | None
        """Why there is no mesh."""
        skipped: bool
        """Whether it was there already, made of the same content with the same options."""

else:
    Made = namedtuple("Made", "input out error skipped")
    Made.__doc__ = """What became of a file: the `input`, the mesh `out`, an `error` (a text, or None), and whether it
    was `skipped`, as it was there already, made of the same content with the same options."""

__all__ = ["Made", "mesh", "neuroglancer"]

#: Folder within the output that tells what files were made of.
RECORDS = ".neurotess-dask"
#: Parts of a folder for neuroglancer for each thread of a cluster, so that threads end at about the same time. Each part
#: lists all cells and meshes the tracings of its own.
PARTS = 4


def mesh(
    paths: Iterable[str | os.PathLike[str]],
    out: str | os.PathLike[str],
    client: Any = None,
    *,
    format: str = "ply",
    **options: Unpack[MeshOptions],
) -> list[Made]:
    """Meshes files into the folder `out`, which all workers must reach, with the options of `neurotess.mesh`.

    `client` is a `dask.distributed.Client`; without one, this process works alone. Each file is a task of its own,
    and running it twice gives the same file: tasks of a worker that is lost run elsewhere. A mesh that is there
    already, of the same content and options, is left alone, so a batch that was stopped goes on where it was.
    """
    # Wrong options are told here, not by each worker.
    _options.recipe(options)
    folder = os.path.abspath(os.fspath(out))
    os.makedirs(os.path.join(folder, RECORDS), exist_ok=True)
    files = [os.path.abspath(os.fspath(path)) for path in paths]
    names = [os.path.splitext(os.path.basename(file))[0] + "." + format for file in files]
    if len(set(names)) < len(names):
        twice = next(name for name in names if names.count(name) > 1)
        raise ValueError(f"several files would become {twice}: mesh them into different folders")
    tasks = [(file, folder, name, dict(options)) for file, name in zip(files, names, strict=True)]
    if client is None:
        return [make(task) for task in tasks]
    futures = client.map(make, tasks, pure=False, retries=2)
    return [Made(*made) for made in client.gather(futures)]


def make(task: tuple[str, str, str, dict[str, Any]]) -> Made:
    """Makes one mesh: a task."""
    file, folder, name, options = task
    path = os.path.join(folder, name)
    record = os.path.join(folder, RECORDS, name + ".json")
    try:
        with open(file, "rb") as stream:
            content = stream.read()
        recipe = _neurotess.Recipe(options)
        key = _key(content, name, recipe)
        if os.path.exists(path) and _recorded(record) == key:
            return Made(file, path, None, True)
        cell = Morphology(read_cell(content, _format(file), file, False))
        made = _mesh(recipe, cell, 1)
        made.save(path)
        _replace(record, json.dumps({"of": file, "key": key}))
        return Made(file, path, None, False)
    except Exception as error:
        return Made(file, path, f"{type(error).__name__}: {error}", False)


def neuroglancer(
    inputs: Iterable[str | os.PathLike[str]] | str | os.PathLike[str] | Circuit,
    folder: str | os.PathLike[str],
    client: Any = None,
    *,
    parts: int | None = None,
    **options: Any,
) -> dict[str, Any]:
    """Writes cells as neuroglancer opens them, as `neurotess.neuroglancer` does, with its options, into `folder`. All workers
    must reach it and the inputs by the same paths.

    `client` is a `dask.distributed.Client`; without one, this process works alone. The work is divided into `parts`, four
    for each thread of the cluster unless something else is said: by whole files, with ``sharded=True`` by neuroglancer's
    own shards, so that no two workers write the same file. Files are the same as without Dask. Those that are there
    already, of the same cells and options, are left alone: parts of a worker that is lost run elsewhere, and a run that was
    stopped goes on where it was. `threads` is of each part: 1 unless something else is said.

    Gives the numbers of all parts together. Raises ``FileExistsError`` if the folder is of other cells or options.
    """
    for name in ("shard", "resume", "overwrite"):
        if name in options:
            raise TypeError(f"{name}= is not an option of nt.dask.neuroglancer: workers divide the folder and resume it")
    if parts is not None and parts < 1:
        raise ValueError(f"parts={parts} is not 1 or more")
    cells = _told(inputs)
    out = os.path.abspath(expanded(folder))
    if client is None:
        return _neuroglancer(_opened(cells), out, resume=True, **options)
    if parts is None:
        parts = PARTS * max(sum(client.nthreads().values()), 1)
    options = {"threads": 1, **options}
    tasks = [(cells, out, (number, parts), options) for number in range(1, parts + 1)]
    return _together(client.gather(client.map(write, tasks, pure=False, retries=2)))


def write(task: tuple[Cells, str, tuple[int, int], dict[str, Any]]) -> dict[str, Any]:
    """Writes a part of a folder for neuroglancer: a task."""
    cells, folder, shard, options = task
    return _neuroglancer(_opened(cells), folder, shard=shard, **options)


def _told(inputs: Iterable[str | os.PathLike[str]] | str | os.PathLike[str] | Circuit) -> Cells:
    """Cells as workers are told of them."""
    if isinstance(inputs, Circuit):
        return os.path.abspath(inputs._path), inputs._allow_large
    if isinstance(inputs, (str, os.PathLike)):
        inputs = [inputs]
    return [os.path.abspath(expanded(path)) for path in inputs]


def _opened(cells: Cells) -> list[str] | Circuit:
    if isinstance(cells, list):
        return cells
    path, allow_large = cells
    return Circuit(path, allow_large=allow_large)


def _together(made: list[dict[str, Any]]) -> dict[str, Any]:
    """What became of a folder by what became of its parts. The first part wrote what all cells share."""
    whole = dict(made[0])
    for name in ("written", "kept", "triangles", "bytes"):
        whole[name] = sum(part[name] for part in made)
    # Each part that needs a tracing tells of it.
    failed = {(one["file"], one["error"]): one for part in made for one in part["failed"]}
    whole["failed"] = list(failed.values())
    return whole


def _key(content: bytes, name: str, recipe: _neurotess.Recipe) -> str:
    hashed = hashlib.sha256(content)
    hashed.update(json.dumps([__version__, os.path.splitext(name)[1], recipe.json]).encode())
    return hashed.hexdigest()


def _format(file: str) -> str | None:
    extension = os.path.splitext(file)[1].lower().lstrip(".")
    return extension if extension in ("swc", "eswc", "asc", "h5", "nml", "traces") else None


def _recorded(record: str) -> str | None:
    try:
        with open(record, encoding="utf-8") as stream:
            key = json.load(stream).get("key")
            return key if isinstance(key, str) else None
    except (OSError, ValueError):
        return None


def _replace(path: str, text: str) -> None:
    """Writes a file whole or not at all: a worker may be lost at any moment."""
    number, part = tempfile.mkstemp(dir=os.path.dirname(path))
    with os.fdopen(number, "w", encoding="utf-8") as stream:
        stream.write(text)
    os.replace(part, path)
