"""Mended and compared tracings."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping

from . import _neurotess, _options
from ._cells import cell_of
from ._errors import NeurotessWarning, OptionError, missing_file
from ._morphology import Morphology, _warn
from ._sources import is_table, package_of, read_cell
from ._units import plain
from ._errors import with_given

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from typing import Any, Literal

    from numpy.typing import ArrayLike

    from ._meshing import Source

    Axis = Literal["x", "y", "z"]
    Spines = float | Literal["file"] | os.PathLike[str] | str | ArrayLike


def edit(
    cell: Source,
    *,
    types: Mapping[str | int, str | int] | None = None,
    scale: float | None = None,
    units: Literal["um", "nm"] | Sequence[float] | None = None,
    mend_radii: bool | float = False,
    reroot: int | Sequence[int] | None = None,
    join: float | None = None,
    subtree: int | None = None,
    cut: int | Sequence[int] | None = None,
    drop_types: str | int | Sequence[str | int] | None = None,
    within: float | None = None,
    prune: float | None = None,
    smooth: float | Literal["auto"] | None = None,
    resample: float | None = None,
    simplify: float | None = None,
    spines: Spines | tuple[Spines, int] | None = None,
    recenter: bool = False,
    rotate: Mapping[Axis, float] | Iterable[tuple[Axis, float]] | None = None,
    mirror: Axis | Iterable[Axis] | None = None,
    matrix: ArrayLike | None = None,
    translate: Sequence[float] | None = None,
) -> Morphology:
    """A mended copy of a cell: of a `Morphology`, or of what `mesh` takes. The cell itself stays as it is.

    The options are those of ``neurotess convert``, and are applied in this order, whatever their order in the call.
    Lengths are µm after `units` or `scale`; samples are the file's own numbers (`Morphology.samples`).

    - `types`: gives samples other types, as in ``{5: "axon", "undefined": 3}``; all at once, so ``{2: 3, 3: 2}``
      swaps them
    - `scale`: multiplies coordinates and radii
    - `units`: the unit of the file, to be turned into µm: ``"um"``, ``"nm"``, or the sides (x, y, z) of a voxel in µm
    - `mend_radii`: interpolates radii that are not above 0 or no number, and those 5 times (or as many times as
      given) thicker or thinner than their neighborhood
    - `reroot`: makes this sample the root of its tree, which must have no soma; several for several trees
    - `join`: connects each piece without a soma to the nearest sample of another piece within this distance (µm;
      ``math.inf`` for any)
    - `subtree`: keeps this sample and what hangs on it
    - `cut`: drops this sample and what hangs on it, or several
    - `drop_types`: drops the samples of this type, or of several, as in ``["axon", 7]``; what hung on them is a piece
      of its own then
    - `within`: drops what is farther along the tree than this distance (µm) from the soma's center, or without a soma
      from the root; neurites are cut at it
    - `prune`: drops twigs, from an end up to the fork or soma before it, that are shorter than this length (µm): once,
      so what becomes a twig by it stays
    - `smooth`: smooths noise away that is shorter than this length (µm), or ``"auto"``
    - `resample`: puts samples at this distance (µm) along each section, as nearly as equal parts allow
    - `simplify`: leaves out samples without which the membrane moves by no more than this tolerance (µm)
    - `spines`: grows spines, as far as there is room: a number for so many on each µm of basal and apical dendrites, at
      random places; ``"file"`` for those that an ASC or H5 file tells of (`Morphology.spines`); the path of a table, or
      places (µm), (n, 3), as those of synapses (`Circuit.inputs`). ``(…, seed)`` gives others than seed 1. They are of
      type 7, a neck and a head each
    - `recenter`: moves the soma, or without one the first root, to the origin
    - `rotate`: turns around axes through the origin, counterclockwise, by degrees: ``{"z": 90}``, or pairs where an
      axis comes twice
    - `mirror`: changes the sign of the coordinates of an axis, or of several
    - `matrix`: moves by an affine map, as of a registration: (4, 4), (3, 4) or (3, 3), for columns (x, y, z, 1); radii are
      scaled by the cube root of its determinant
    - `translate`: moves by (x, y, z) in µm

    `Morphology.edits` of the result tells what each of them changed.

    Raises ``ValueError`` for options and for edits that cannot be done, `ReadError` for files.

    >>> import neurotess as nt
    >>> cell = nt.synth("granule", seed=1, points=200)
    >>> light = nt.edit(cell, simplify=0.2, recenter=True)
    >>> len(light) < len(cell), light.soma.center.tolist()
    (True, [0.0, 0.0, 0.0])
    >>> [edit["edit"] for edit in light.edits]
    ['simplify', 'recenter']
    """
    given = dict(locals())
    synapses = None
    if spines is not None:
        places, *seed = spines if isinstance(spines, tuple) else (spines,)
        if isinstance(places, (str, os.PathLike)) and places != "file" and not os.path.exists(places):
            raise missing_file(os.fspath(places))
        if hasattr(places, "__len__") and not isinstance(places, (str, os.PathLike)):
            places, synapses = "synapses", _places(places)
        spines = [os.fspath(places) if isinstance(places, os.PathLike) else places, *seed]
    keywords = {
        **{name: value for name, value in given.items() if name not in ("cell", "translate")},
        "spines": spines,
        # In their order: turns do not commute.
        "rotate": [*rotate.items()] if isinstance(rotate, Mapping) else rotate,
        "matrix": None if matrix is None and translate is None else _rows(matrix, translate),
    }
    try:
        edits = _neurotess.Edits(_options.keywords(keywords))
    except OptionError as error:
        raise with_given(error, given) from None
    if isinstance(cell, Morphology) or package_of(cell) or is_table(cell):
        known = cell_of(cell)
    else:
        known = Morphology(read_cell(cell, None, None, False, bad_radii=edits.mends_radii))
        _warn(known._cell)
    if units not in (None, "um") and any(code == "units_in_header" for code, *_ in known._cell.warnings):
        raise ValueError(
            f"units= is given, and the unit that the header of {known.name} names was read already, so lengths are µm: "
            "leave units= out, or give scale="
        )
    edited, reports = edits.apply(known._cell, synapses)
    if known.connectors is not None and reports:
        lost = f"{known.name}: its connectors are left out, since samples may have other numbers and places now"
        warnings.warn(NeurotessWarning(lost), stacklevel=2)
    connectors = None if reports else known.connectors
    return Morphology(edited, tuple(reports), known.id, connectors)


def _rows(matrix: ArrayLike | None, translate: Sequence[float] | None) -> list[float]:
    """The upper three rows of an affine map, which ends with a shift."""
    import numpy as np

    given = np.eye(4) if matrix is None else np.asarray(matrix, dtype=float)
    if given.shape not in ((4, 4), (3, 4), (3, 3)):
        raise ValueError(f"matrix= is of shape {given.shape}: (4, 4), (3, 4) or (3, 3) is needed")
    if given.shape == (4, 4) and not (given[3] == (0, 0, 0, 1)).all():
        raise ValueError(f"matrix= is not affine: its last row is {given[3].tolist()} instead of [0, 0, 0, 1]")
    rows = np.zeros((3, 4))
    rows[:, : given.shape[1]] = given[:3]
    if translate is not None:
        shift = np.asarray(plain("translate=", translate, "um"), dtype=float)
        if shift.shape != (3,):
            raise ValueError(f"translate={translate!r}: (x, y, z) in µm is needed")
        rows[:, 3] += shift
    rows_in_one: list[float] = rows.ravel().tolist()
    return rows_in_one


def _places(places: ArrayLike) -> list[list[float]]:
    """Rows of three numbers."""
    import numpy as np

    rows = np.asarray(plain("spines", places, "um"), dtype=float)
    if rows.size == 0:
        return []
    if rows.ndim != 2 or rows.shape[1] != 3:
        raise ValueError(f"spines: places have three coordinates each, (n, 3), not {rows.shape}")
    return rows.tolist()


def diff(
    first: Source, second: Source, *, tolerance: float = 0.001, samples: int | None = None
) -> dict[str, Any]:
    """What differs between two cells or files, under the names of ``neurotess diff --json``.

    The keys are ``same``, ``matched_by``, ``samples``, ``sections``, ``neurites``, ``forks``, ``ends``, ``length``
    and ``length_by_type`` (each with ``before``, the first cell, and ``after``, the second); ``only_in_first``,
    ``only_in_second``, ``moved``, ``radii``, ``types`` and ``parents`` (each with ``count``, ``largest`` in µm where
    it is a length, and the numbers of the ``samples``: all, or the first `samples` of them); ``retyped`` and ``soma``. Distances and differences
    of radii up to `tolerance` (µm) are none.

    >>> import neurotess as nt
    >>> cell = nt.synth("granule", seed=1, points=200)
    >>> nt.diff(cell, cell)["same"]
    True
    >>> moved = nt.diff(cell, nt.edit(cell, scale=2))["moved"]
    >>> moved["count"], moved["largest"] > 10
    (200, True)
    """
    if samples is not None and samples < 0:
        raise ValueError(f"samples={samples} is not 0 or more")
    cells = [cell_of(cell) for cell in (first, second)]
    return _neurotess.diff(cells[0]._cell, cells[1]._cell, float(tolerance), samples)
