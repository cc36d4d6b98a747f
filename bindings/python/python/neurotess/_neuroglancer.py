"""Cells as neuroglancer opens them."""

from __future__ import annotations

import os

from . import _neurotess
from ._circuits import Circuit
from ._sources import expanded

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from typing import Any

    from ._nodes import Nodes


def neuroglancer(
    inputs: Iterable[str | os.PathLike[str]] | str | os.PathLike[str] | Circuit,
    folder: str | os.PathLike[str],
    *,
    nodes: Nodes | None = None,
    max_error: float = 0.04,
    lods: int = 4,
    sharded: bool = False,
    resume: bool = False,
    overwrite: bool = False,
    shard: tuple[int, int] | None = None,
    threads: int | None = None,
    url: str | None = None,
    color_by: str | None = None,
    synapses: Sequence[str] = (),
) -> dict[str, Any]:
    """Writes cells as neuroglancer opens them, as ``neurotess neuroglancer`` does: meshes, skeletons, properties, a view.

    `inputs`: a file, a folder (searched recursively), a glob, or several of these; or a `Circuit`, of which all cells are
    written, or those of `nodes`.

    - `max_error`: how far (µm) the finest level of detail may be from the smooth surface; `lods`: most levels
    - `sharded`: some hundred cells in a file
    - `resume`: finishes a folder that was begun with the same inputs and options; `overwrite`: writes it anew
    - `shard`: ``(3, 8)`` is the third of eight parts, by whole files, for one of eight machines; they may share the folder
    - `url`: where browsers will find the folder; else where ``neurotess neuroglancer -o FOLDER --serve`` serves it
    - of circuits: `color_by`, an attribute of nodes; `synapses`, names of populations of edges that become annotations

    Gives ``link``, which opens the cells, ``written``, ``kept``, ``triangles``, ``bytes``, ``synapses``, ``warnings`` (how many tracings
    have one of each code) and ``failed``, a list of dictionaries with ``file`` and ``error``. Ctrl-C stops the work; no file is left half-written.

    Raises ``ValueError`` for options and if no tracing can be read, ``FileExistsError`` for a folder that is there.

    >>> import neurotess as nt, tempfile
    >>> folder = tempfile.mkdtemp()
    >>> _ = nt.synth("granule", points=100).save(folder + "/cell.swc")
    >>> made = nt.neuroglancer(folder + "/cell.swc", folder + "/shared")
    >>> made["written"], made["failed"]
    (1, [])
    """
    if threads is not None and threads < 1:
        raise ValueError(f"threads={threads} is not 1 or more")
    wanted = {
        "max_error": max_error,
        "lods": lods,
        "sharded": sharded,
        "resume": resume,
        "overwrite": overwrite,
        "shard": shard,
        "threads": threads,
        "url": url,
        "color_by": color_by,
        "synapses": list(synapses),
    }
    if isinstance(inputs, Circuit):
        rows = inputs._rows(nodes, None, None, None, None, 1)
        return _neurotess.neuroglancer(inputs._circuit, [], rows, expanded(folder), wanted)
    if nodes is not None or color_by is not None or synapses:
        raise ValueError("nodes=, color_by= and synapses= are of a Circuit")
    if isinstance(inputs, (str, os.PathLike)):
        inputs = [inputs]
    return _neurotess.neuroglancer(None, [expanded(path) for path in inputs], [], expanded(folder), wanted)
