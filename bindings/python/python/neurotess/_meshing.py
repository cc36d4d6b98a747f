"""Cells to meshes: one, or many."""

from __future__ import annotations

import os
import warnings
from collections import deque

from . import _neurotess, _options
from ._cells import cell_of, quietly
from ._errors import NeurotessWarning
from ._meshes import Mesh
from ._parts import Notice
from ._sources import expanded, files_of, is_alone

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence
    from typing import Any, Literal, TypeAlias

    import numpy as np
    from numpy.typing import NDArray
    from typing_extensions import Unpack

    from ._morphology import File, Morphology
    from ._typed import MeshOptions

    # Cells of navis, MorphIO and NeuroM, too.
    Source: TypeAlias = Morphology | File | Any



def mesh(
    cell: Source,
    *,
    level: int | None = None,
    max_error: float | None = None,
    level_along: int | None = None,
    isotropic: bool | float = False,
    max_edge: float | None = None,
    min_edge: float | None = None,
    max_aspect: float | None = None,
    path: Literal["hermite", "linear"] | None = None,
    caps: Literal["round", "flat"] | None = None,
    crossings: Literal["keep", "merge", "separate"] | None = None,
    simulation: bool = False,
    soma: Literal["fem", "sphere", "profile", "none"] | None = None,
    poisson: float | None = None,
    soma_keep: Literal["volume", "area", "scale"] | None = None,
    soma_mesh: str | os.PathLike[str] | None = None,
    soma_scale: float | None = None,
    radii: Literal["traced", "equal-area", "equal-perimeter"] | None = None,
    radius_factor: float | None = None,
    radius: float | None = None,
    min_radius: float | None = None,
    soma_sphere: Literal["cube", "octahedron"] | None = None,
    soma_level: int | None = None,
    ring: Mapping[int, float] | None = None,
    smooth: float | Literal["auto"] | None = None,
    types: Sequence[str | int] | str | None = None,
    quads: bool = False,
    threads: int | None = None,
) -> Mesh:
    """Makes the closed surface of a cell: of a `Morphology`, of what `read` takes, or of a cell of navis, MorphIO or
    NeuroM.

    The options are those of ``neurotess mesh``.

    Refinement:

    - `level`: subdivisions of each coarse edge, 1 to 64 (4 if nothing is said); 0 gives the coarse quads
    - `max_error`: instead, as fine as keeps the surface within so many µm of that of level 64
    - `level_along`: subdivisions along neurites; `level` is then for the edges around them
    - `isotropic`: instead, edges about as long as the local radius, or a factor of it; with `max_edge`,
      `min_edge` (µm) and `max_aspect`
    - `path`: ``"hermite"`` (smooth) or ``"linear"`` between traced points; `caps`: ``"round"`` or ``"flat"``
    - `quads`: quads where possible, instead of triangles

    Crossings:

    - `crossings`: what becomes of places where the surface crosses itself: ``"keep"``, ``"merge"`` (the exact
      union) or ``"separate"`` (branches traced through one another are moved apart, the rest is merged)
    - `simulation`: a mesh that solvers take, or a `MeshError` that says where it fails

    Soma and tracing:

    - `soma`: ``"fem"``, ``"sphere"``, ``"profile"`` or ``"none"``; `soma_keep`: what of it is as traced, ``"volume"``
      (the default), ``"area"`` or ``"scale"``; `poisson` (0.3), `soma_scale` (1),
      `soma_sphere`, `soma_level`
    - `soma_mesh`: a file with the soma's surface (PLY, OBJ, STL, …; µm, in the tracing's coordinates), as from a stack
      of images or electron microscopy, instead of what was traced of it
    - `ring`: where neurites leave the soma, as in ``{1: 0.5}``: neurites count from 1, positions are 0 to 2
    - `radii`: ``"traced"``: rings of neurites lie on the traced radius, and hold less the fewer sides they have;
      ``"equal-area"`` (with `simulation` if nothing is said): as much larger as keeps the traced volume;
      ``"equal-perimeter"``: as keeps the traced area of the membrane
    - `radius_factor`: a factor on the radii of neurites, as for printing in three dimensions
    - `radius`: that of points without one (µm), else taken from their neighbors; `min_radius`: the least of neurites
    - `smooth`: smooths the noise of the tracing away by this length (µm), or ``"auto"``
    - `types`: keeps only these, as in ``["axon", 3, "custom_9"]``

    `threads` to use; all cores if it is left out. The result is the same for any number of them.

    Raises ``ValueError`` for options, `MeshError` for cells that cannot be meshed, `ReadError` for files.

    >>> import neurotess as nt
    >>> mesh = nt.mesh(nt.synth("granule", points=100), level=2)
    >>> mesh.closed, mesh.vertices.dtype, mesh.faces.shape[1]
    (True, dtype('float64'), 3)
    """
    options: dict[str, Any] = dict(locals())
    for name in ("cell", "threads"):
        del options[name]
    recipe = _options.recipe(options)
    _check_threads(threads)
    return _mesh(recipe, cell_of(cell), threads)


def _mesh(
    recipe: _neurotess.Recipe, cell: Morphology, threads: int | None, stop: _neurotess.Stop | None = None
) -> Mesh:
    surface, report = recipe.mesh(cell._cell, threads, stop)
    for told in report["warnings"]:
        if told["code"] == "types_unused":
            warnings.warn(NeurotessWarning(f"{cell.name}: {told['message']}: check types="), stacklevel=3)
    return _of(surface, report, cell.warnings, cell.name, cell)


def _of(
    surface: _neurotess.Surface,
    report: dict[str, Any],
    read: list[Notice],
    name: str,
    cell: Morphology,
    placement: NDArray[np.float64] | None = None,
) -> Mesh:
    mended = [
        Notice(w["code"], w["message"], w["count"], w["line"], w["sample"]) for w in report.pop("warnings")
    ]
    return Mesh(surface, report, (*read, *mended), name, cell, placement)


class Outcome:
    """A mesh, or the error instead of it."""

    ok: bool
    """Whether there is a mesh."""
    mesh: Mesh | None
    """The mesh; none if there is an error."""
    error: Exception | None
    """Why there is none."""

    __slots__ = ("error", "mesh")

    def __init__(self, mesh: Mesh | None, error: Exception | None) -> None:
        self.mesh = mesh
        self.error = error

    def _said(self) -> str:
        return repr(self.mesh if self.ok else self.error)


class MeshResult(Outcome):
    """What became of a cell in `mesh_many`: `Meshed` or `Failed`."""

    input: Any
    """What was to be meshed."""

    __slots__ = ("input",)

    def __init__(self, input: Any, mesh: Mesh | None, error: Exception | None) -> None:
        super().__init__(mesh, error)
        self.input = input

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.input!r}: {self._said()}>"


class Meshed(MeshResult):
    """A cell of `mesh_many` that was meshed."""

    ok: Literal[True] = True
    mesh: Mesh
    error: None

    __slots__ = ()

    def __bool__(self) -> Literal[True]:
        return True

    def __init__(self, input: Any, mesh: Mesh) -> None:
        super().__init__(input, mesh, None)

    def __reduce__(self) -> tuple[type[Meshed], tuple[Any, Mesh]]:
        return type(self), (self.input, self.mesh)


class Failed(MeshResult):
    """A cell of `mesh_many` that could not be meshed, and why."""

    ok: Literal[False] = False
    mesh: None
    error: Exception

    __slots__ = ()

    def __bool__(self) -> Literal[False]:
        return False

    def __init__(self, input: Any, error: Exception) -> None:
        super().__init__(input, None, error)

    def __reduce__(self) -> tuple[type[Failed], tuple[Any, Exception]]:
        return type(self), (self.input, self.error)


class Results:
    """What becomes of the cells of `mesh_many`, one after the other."""

    def __init__(self, cells: Iterable[Any], results: Iterator[Meshed | Failed]) -> None:
        self._cells = cells
        self._results = results

    def __iter__(self) -> Iterator[Meshed | Failed]:
        return self._results

    def __next__(self) -> Meshed | Failed:
        return next(self._results)

    def __len__(self) -> int:
        count: int = len(self._cells)  # type: ignore[arg-type]
        return count

    def close(self) -> None:
        """Stops the work."""
        self._results.close()  # type: ignore[attr-defined]


def mesh_many(
    cells: Iterable[Source] | str | os.PathLike[str], *, threads: int | None = None, **options: Unpack[MeshOptions]
) -> Results:
    """Meshes many cells or files on `threads` threads (all cores), with the options of `mesh`.

    `cells` are what `mesh` takes, or a folder, of which all SWC, ASC, NeuroML and TRACES files are meshed.
    Gives a `Meshed` or `Failed` for each cell, in their order, of which ``ok`` tells which it is. An error is a value: one
    bad file never ends the batch.
    Not more than two cells a thread are in memory, beside the one that you hold. Wrong options raise
    ``ValueError`` at once. Warnings of readers are in `Mesh.warnings` only. Ctrl-C, and ``close()`` of the iterator,
    stop the work. ``len()`` of it is the number of cells, where they have one, so ``tqdm(nt.mesh_many(…))`` shows how far it is.

    >>> import neurotess as nt
    >>> cells = [nt.synth("granule", seed=seed, points=100) for seed in range(3)]
    >>> [result.ok for result in nt.mesh_many(cells, threads=2, level=1)]
    [True, True, True]
    """
    recipe = _options.recipe(options)
    _check_threads(threads)
    if isinstance(cells, (str, os.PathLike)):
        cells = files_of(cells)
    elif is_alone(cells):
        cells = [cells]
    return Results(cells, _results(cells, recipe, threads or _cores()))


def mesh_all(
    inputs: Iterable[str | os.PathLike[str]] | str | os.PathLike[str],
    folder: str | os.PathLike[str],
    *,
    format: str = "ply",
    resume: bool = False,
    overwrite: bool = False,
    shard: tuple[int, int] | None = None,
    threads: int | None = None,
    **options: Unpack[MeshOptions],
) -> list[dict[str, Any]]:
    """Meshes files into a folder as ``neurotess mesh`` does, with the options of `mesh`.

    `inputs`: a file, a folder (searched recursively), a glob, or several of these. `folder` repeats the structure below that
    of the inputs. `format`: ``"ply"``, ``"obj"``, ``"stl"``, ``"glb"``, ``"off"``, ``"vtu"``, ``"msh"``, ``"poly"``, …

    - `resume`: leaves files alone that are up to date: of the same inputs and options. Several programs may share the folder
    - `overwrite`: replaces files that are there; else they are errors
    - `shard`: ``(3, 8)`` is the third of eight parts of the inputs, for one of eight machines
    - `threads`: each has one cell in memory; all cores if it is left out

    Gives a dictionary for each input, in their order, as ``neurotess mesh --json``: ``file``, ``out``, ``vertices``,
    ``warnings``, …; with ``error`` if it failed, which never ends the batch, and with ``skipped`` if it was up to date.
    Ctrl-C stops the work; no file is left half-written.

    Raises ``ValueError`` for options, and where two inputs would become one file.

    >>> import neurotess as nt, tempfile
    >>> folder = tempfile.mkdtemp()
    >>> _ = nt.synth("granule", points=100).save(folder + "/cell.swc")
    >>> [made] = nt.mesh_all(folder, folder + "/meshes", level=1)
    >>> made["closed"]
    True
    """
    recipe = _options.recipe(options)
    _check_threads(threads)
    if isinstance(inputs, (str, os.PathLike)):
        inputs = [inputs]
    wanted = {"format": format, "resume": resume, "overwrite": overwrite, "shard": shard, "threads": threads}
    return _neurotess.mesh_all(recipe, [expanded(path) for path in inputs], expanded(folder), wanted)


def _check_threads(threads: int | None) -> None:
    if threads is not None and threads < 1:
        raise ValueError(f"threads={threads} is not 1 or more")


def _cores() -> int:
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:
        return os.cpu_count() or 1


def _results(cells: Iterable[Source], recipe: _neurotess.Recipe, threads: int) -> Iterator[Meshed | Failed]:
    from concurrent.futures import ThreadPoolExecutor

    stop = _neurotess.Stop()

    def one(cell: Source) -> Meshed | Failed:
        try:
            # A cell has one thread: all are busy with others.
            return Meshed(cell, _mesh(recipe, quietly(cell), 1, stop))
        except Exception as error:
            return Failed(cell, error)

    pool = ThreadPoolExecutor(threads, thread_name_prefix="neurotess")
    waiting: deque[Any] = deque()
    try:
        for cell in cells:
            waiting.append(pool.submit(one, cell))
            if len(waiting) >= 2 * threads:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()
    finally:
        # After an interrupt, or where nobody wants the other results, what has begun stops.
        stop.set()
        pool.shutdown(wait=False, cancel_futures=True)
