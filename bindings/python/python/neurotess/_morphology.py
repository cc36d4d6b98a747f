"""Traced cells."""

from __future__ import annotations

import os
import warnings

from . import _neurotess
from ._errors import ReadWarning
from ._parts import Neurite, Notice, Section, Soma
from ._sources import expanded, files_of, read_cell

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path
    from typing import IO, Any, TypeAlias, Union, overload

    import numpy as np
    import pandas as pd
    from numpy.typing import NDArray
    from typing_extensions import Unpack

    from ._reports import Report
    from ._typed import PageOptions

    File: TypeAlias = Union[str, os.PathLike[str], bytes, IO[bytes], IO[str]]
    Files: TypeAlias = Union[list[Any], tuple[Any, ...]]


class Morphology:
    """A traced cell: points with radii in sections, and somata. Lengths are µm.

    Made by `read`, `synth`, `from_table` and the other `from_` methods. It never changes, and neither do its
    arrays, which are made once and shared; ``cell.points.copy()`` is yours.

    >>> import neurotess as nt
    >>> cell = nt.synth("granule", seed=1, points=200)
    >>> cell.points.shape, cell.types.min() >= 2
    ((200, 3), np.True_)
    """

    edits: tuple[dict[str, Any], ...]
    """What each edit of `edit` changed, under the names of ``neurotess convert --json``; empty for other cells."""

    id: Any
    """What navis calls it by, and is called back; None for other cells."""
    connectors: pd.DataFrame | None
    """Connectors (synapses) as navis has them, in µm; None for other cells."""

    def __init__(
        self,
        cell: _neurotess.Cell,
        edits: tuple[dict[str, Any], ...] = (),
        id: Any = None,
        connectors: pd.DataFrame | None = None,
    ) -> None:
        if not isinstance(cell, _neurotess.Cell):
            raise TypeError("use neurotess.read, neurotess.synth or Morphology.from_table")
        self._cell = cell
        self.edits = edits
        self.id = id
        self.connectors = connectors
        self._neuron: Any = None
        self._columns: dict[str, NDArray[Any]] | None = None
        self._exposed: NDArray[np.float64] | None = None
        self._child_ids: list[list[int]] | None = None
        self._sections: tuple[Section, ...] | None = None
        self._neurites: tuple[Neurite, ...] | None = None

    # What it is

    @property
    def name(self) -> str:
        """Name for people: that of the file, without its extension."""
        return self._cell.name

    @property
    def header(self) -> list[str]:
        """Comments at the head of the file."""
        return self._cell.header

    @property
    def format(self) -> str:
        """``"swc"``, ``"asc"``, ``"h5"``, ``"neuroml"``, ``"traces"``, ``"knossos"``, ``"neurolucida_xml"``,
        ``"mouselight"``, ``"catmaid"`` or ``"synth"``."""
        return self._cell.format

    @property
    def warnings(self) -> list[Notice]:
        """What was odd in the file."""
        told = self._cell.warnings
        return [Notice(code, text, count, line, None) for code, text, line, count in told]

    # Points

    def __len__(self) -> int:
        return len(self._cell)

    @property
    def points(self) -> NDArray[np.float64]:
        """Positions (µm) of the points of all neurites, (n, 3), depth-first. Those of somata are theirs."""
        return self._cell.points

    @property
    def radii(self) -> NDArray[np.float64]:
        """Radii (µm) of the points, (n,)."""
        return self._cell.radii

    @property
    def spines(self) -> NDArray[np.float64]:
        """Places (µm) of spines that the file tells of without tracing them, (n, 3): where each ends, or where it is on
        its dendrite. ``neurotess.edit(cell, spines="file")`` grows them."""
        return self._cell.spines

    @property
    def types(self) -> NDArray[np.int32]:
        """SWC types of the points, (n,): 2 axon, 3 basal dendrite, 4 apical dendrite, others as in the file."""
        return self._cell.types

    @property
    def parents(self) -> NDArray[np.int64]:
        """The index of the point that each point hangs on, (n,); −1 where a neurite begins."""
        return self._cell.parents

    @property
    def samples(self) -> NDArray[np.int64]:
        """The file's own number of each point, (n,), as `Mesh.point` has it."""
        return self._cell.samples

    # Parts

    @property
    def sections(self) -> tuple[Section, ...]:
        """All sections, depth-first: parents come before their children."""
        if self._sections is None:
            count = len(self._section_columns()["first"])
            self._sections = tuple(Section(self, i) for i in range(count))
        return self._sections

    @property
    def neurites(self) -> tuple[Neurite, ...]:
        """All neurites, in the order of the file."""
        if self._neurites is None:
            numbers = self._section_columns()["neurite"].tolist()
            starts = [i for i, n in enumerate(numbers) if i == 0 or n != numbers[i - 1]]
            ends = [*starts, len(numbers)][1:]
            pairs = zip(starts, ends, strict=True)
            self._neurites = tuple(Neurite(self, k, *ends_of) for k, ends_of in enumerate(pairs))
        return self._neurites

    @property
    def soma(self) -> Soma | None:
        """The main soma, if there is one."""
        somata = self.somata
        return somata[0] if somata else None

    @property
    def somata(self) -> list[Soma]:
        """All somata, the main one first."""
        return [Soma(told) for told in self._cell.somata()]

    def _section_columns(self) -> dict[str, NDArray[Any]]:
        if self._columns is None:
            self._columns = self._cell.sections()
        return self._columns

    def _exposed_areas(self) -> NDArray[np.float64]:
        if self._exposed is None:
            self._exposed = self._cell.exposed_areas()
        return self._exposed

    def _children(self) -> list[list[int]]:
        if self._child_ids is None:
            parents = self._section_columns()["parent"].tolist()
            children: list[list[int]] = [[] for _ in parents]
            for child, parent in enumerate(parents):
                if parent >= 0:
                    children[parent].append(child)
            self._child_ids = children
        return self._child_ids

    def path_length(self, start: int | None, end: int | None) -> float:
        """Length (µm) of the path along the tracing between two points, given by their indices.

        None is the soma's center. Between two neurites, the path goes through it, straight from the first
        point of the one and to the first point of the other. Infinite between trees that do not meet.

        >>> import neurotess as nt
        >>> cell = nt.read(b"1 1 0 0 0 5 -1\\n2 3 0 9 0 1 1\\n3 3 0 30 0 1 2\\n4 2 -8 0 0 1 1\\n")
        >>> cell.path_length(0, 1), cell.path_length(None, 1), cell.path_length(1, 2)
        (21.0, 30.0, 38.0)
        """
        return self._cell.path_length(self._point(start), self._point(end))

    def path_distances(self, start: int | None = None) -> NDArray[np.float64]:
        """Length (µm) of the path from one point to every point, (n,), as `path_length` has it.

        >>> import neurotess as nt
        >>> cell = nt.read(b"1 1 0 0 0 5 -1\\n2 3 0 9 0 1 1\\n3 3 0 30 0 1 2\\n4 2 -8 0 0 1 1\\n")
        >>> cell.path_distances(), cell.path_distances(1)
        (array([ 9., 30.,  8.]), array([21.,  0., 38.]))
        """
        return self._cell.path_distances(self._point(start))

    def _point(self, index: int | None) -> int | None:
        return None if index is None else range(len(self))[index]

    def compartments(self, report: Report, node: int) -> NDArray[np.int64]:
        """For each row of `to_table` the nearest compartment of its section: the row of ``report.compartments(node)`` and
        the column of ``report.values(node)``. −1 where the report has none of the section.

        ``neurotess.render(cell, values=report.at(time, node)[cell.compartments(report, node)])`` shows a report without a
        circuit.
        """
        from ._places import compartments_of

        return compartments_of(self, report, node)

    def measures(self) -> dict[str, Any]:
        """Counts, lengths, areas and volumes, under the names of ``neurotess info --json``.

        >>> import neurotess as nt
        >>> nt.synth("granule", seed=1, points=200).measures()["n_points"]
        200
        """
        return self._cell.measures()

    # Files and tables

    def save(
        self,
        path: str | os.PathLike[str],
        *,
        format: str | None = None,
        overwrite: bool = True,
        keep_ids: bool = False,
    ) -> list[str]:
        """Writes an SWC, ASC, H5 or NeuroML file, whole or not at all.

        `keep_ids`: samples keep their numbers in SWC where these do not ascend from row to row, though NEURON refuses such
        files; otherwise they are numbered from 1 on.

        Returns what the format cannot hold, such as the header of the file.
        """
        return self._cell.write(path, format, overwrite, keep_ids)

    if TYPE_CHECKING:

        @overload
        def to_html(self, path: None = None, **options: Unpack[PageOptions]) -> str: ...

        @overload
        def to_html(self, path: str | os.PathLike[str], **options: Unpack[PageOptions]) -> Path: ...

    def to_html(
        self, path: str | os.PathLike[str] | None = None, **options: Unpack[PageOptions]
    ) -> str | Path:
        """One HTML page to send, in which readers turn the cell: `neurotess.html` with this cell."""
        from ._pages import html
        from ._scene import check_names

        check_names("to_html", html, dict(options))
        return html(self, path, **options)

    def to_table(self) -> NDArray[np.void]:
        """A table as SWC has it, with somata: ``id``, ``type``, ``x``, ``y``, ``z``, ``radius``, ``parent``.

        It is a structured array; ``pandas.DataFrame(cell.to_table())`` is a data frame of it.
        """
        import numpy as np

        columns = self._cell.table()
        names = ["id", "type", "x", "y", "z", "radius", "parent"]
        formats = ["i8", "i8", "f8", "f8", "f8", "f8", "i8"]
        table = np.zeros(len(columns["id"]), dtype=list(zip(names, formats, strict=True)))
        for name in ("id", "type", "radius", "parent"):
            table[name] = columns[name]
        for axis, name in enumerate("xyz"):
            table[name] = columns["position"][:, axis]
        return table

    def section_table(
        self, *, d_lambda: float = 0.1, frequency: float = 100.0, Ra: float = 35.4, cm: float = 1.0
    ) -> NDArray[np.void]:
        """A row for each section, as `Section` tells them: ``section``, ``section_index``, ``neuron_section``, ``type``, ``parent``,
        ``neurite``, ``order``, ``length``, ``area``, ``volume``, ``mean_diameter``, ``path_length``, and ``nseg``.

        ``section`` and ``parent`` count from 1, as `Mesh.section` and `ids` do; the parent of sections that leave the soma is 0.
        ``section_index`` is the index in `sections`.

        ``nseg`` is how many segments it takes so that none is longer than `d_lambda` of the length constant at a `frequency`
        (Hz), with an axial resistance `Ra` (Ω cm) and a capacitance `cm` (µF/cm²): the rule and the defaults of NEURON.
        It is a structured array; ``pandas.DataFrame(cell.section_table())`` is a data frame of it.

        >>> import neurotess as nt
        >>> table = nt.synth("granule").section_table()
        >>> table.dtype.names[:3], bool((table["nseg"] % 2 == 1).all())
        (('section', 'section_index', 'neuron_section'), True)
        """
        from ._section_table import section_table

        return section_table(self, d_lambda, frequency, Ra, cm)

    @classmethod
    def from_table(cls, table: Any, *, name: str = "table", strict: bool = False) -> Morphology:
        """A cell of a table as SWC has it: a row for each sample, by the same rules as a file.

        `table` is a data frame, a dictionary of columns, a structured array, or an array of seven columns in
        the order of SWC. Columns may have the names of `to_table` or those of navis (``node_id``, ``label``,
        ``parent_id``), of CATMAID (``treenode_id``) and of SWC files (``n``, ``t``, ``r``, ``p``). Rows may be
        in any order. Lengths are µm. Lines of errors and warnings are rows, from 1 on.
        """
        from ._tables import columns_of

        cell = _neurotess.Cell.from_columns(*columns_of(table), name, strict)
        return _with_warnings(cell)

    # Other packages

    def to_navis(self) -> Any:
        """A `navis.TreeNeuron`, in µm, with `id` and `connectors` where there are some."""
        from ._exchange import to_navis

        return to_navis(self.to_table(), self.name, self.id, self.connectors)

    @classmethod
    def from_navis(cls, neuron: Any, *, strict: bool = False) -> Morphology:
        """A cell of a `navis.TreeNeuron`, whose units are taken into account; without units it is in µm.

        It has its name, `id` and `connectors`.
        """
        from ._exchange import from_navis

        table, name, connectors = from_navis(neuron)
        cell = cls.from_table(table, name=name, strict=strict)
        cell.id, cell.connectors = neuron.id, connectors
        return cell

    def to_morphio(self) -> Any:
        """A `morphio.Morphology`. MorphIO leaves out sections of a single point, and takes one soma only."""
        from ._exchange import to_morphio

        return to_morphio(self._cell)

    @classmethod
    def from_morphio(cls, morphology: Any, *, name: str = "morphio", strict: bool = False) -> Morphology:
        """A cell of a `morphio.Morphology`, which has no name: give one."""
        from ._exchange import from_morphio

        return _with_warnings(from_morphio(morphology, name, strict))

    def to_neurom(self) -> Any:
        """A `neurom.core.Morphology`."""
        from ._exchange import to_neurom

        return to_neurom(self._cell, self.name)

    @classmethod
    def from_neurom(cls, morphology: Any, *, strict: bool = False) -> Morphology:
        """A cell of a `neurom.core.Morphology`, with its name."""
        from ._exchange import from_neurom

        return _with_warnings(from_neurom(morphology, strict))

    @classmethod
    def from_neuron(cls, sections: Any, *, name: str | None = None, strict: bool = False) -> Morphology:
        """A cell of NEURON: of ``h.allsec()``, a list of sections, one section (its whole tree), or an object of a template
        with its sections in ``all``. They need 3D points: ``h.define_shape()`` makes them where there are none.

        Types follow from names that begin with soma, axon, dend, basal or apic. `neuron_values` colors it by section.
        """
        from ._neuron import table_of

        table, places, cell_name = table_of(sections)
        cell = cls.from_table(table, name=name or cell_name, strict=strict)
        cell._neuron = places
        return cell

    def neuron_values(self, values: Mapping[Any, Any]) -> NDArray[np.float64]:
        """Of numbers by section of NEURON, or by its name, those of each row of `to_table`, for `values` of pictures: a number of
        a section, an array with one of each segment, or an array (segments, times), which makes them over time. NaN where a
        section has none.

        ``neurotess.render(cell, values=cell.neuron_values({"soma": -65.0, "dend[0]": [-64.0, -60.5, -58.0]}))``
        """
        from ._neuron import values_of_sections

        return values_of_sections(values, self._neuron, self.to_table()["id"], self.name)

    # Python

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Morphology) and self._cell == other._cell

    def __hash__(self) -> int:
        return hash((self.name, len(self)))

    def __reduce__(self) -> tuple[type[Morphology], tuple[object, ...]]:
        return type(self), (self._cell, self.edits, self.id, self.connectors)

    def _repr_html_(self) -> str:
        from ._html import of_cell
        from ._pictures import render

        return of_cell(self, render)

    def __repr__(self) -> str:
        neurites = len(self.neurites)
        return f"<Morphology {self.name!r}: {len(self)} points, {neurites} neurites>"


if TYPE_CHECKING:

    @overload
    def read(
        source: Files, *, format: str | None = None, name: str | None = None, strict: bool = False, allow_large: bool = False
    ) -> list[Morphology]: ...

    @overload
    def read(
        source: File, *, format: str | None = None, name: str | None = None, strict: bool = False, allow_large: bool = False
    ) -> Morphology: ...


def read(
    source: File | Files,
    *,
    format: str | None = None,
    name: str | None = None,
    strict: bool = False,
    allow_large: bool = False,
) -> Morphology | list[Morphology]:
    """Reads a morphology: SWC, Neurolucida ASC or XML, Blue Brain's H5, NeuroML, SNT's traces, skeletons of
    webKnossos and KNOSSOS, and JSON of MouseLight and CATMAID.

    `source` is a path (``~`` is your folder), the bytes of a file, an open file, or an address (``https://…``,
    ``s3://…``), which needs fsspec; of a list of these it is a list of cells, and of a folder that of its tracings. ``merged.h5#cells/a`` is one morphology of
    an H5 file that holds many. `format` (``"swc"``, ``"asc"``, ``"h5"``, ``"nml"``, ...) is for bytes and open files
    whose content does not tell it, and `name` is what errors call them.

    What is odd in the file is warned of (`ReadWarning`), and stays in `Morphology.warnings`. With `strict` it
    is an error.

    Of a packed file (HDF5, gzip) 20 times its size and 100 MB may be made; `allow_large` allows more, in this process
    from then on.

    Raises `ReadError`, with file, line and message; it is a ``FileNotFoundError`` too where there is no file.

    >>> import neurotess as nt
    >>> cell = nt.read(b"1 1 0 0 0 5 -1\\n2 3 0 9 0 1 1\\n3 3 0 30 0 1 2\\n")
    >>> cell.soma
    <Soma: point, radius 5 µm>
    """
    if allow_large:
        _neurotess.allow_large()
    if isinstance(source, (str, os.PathLike)) and os.path.isdir(expanded(source)):
        source = files_of(source)
    if isinstance(source, (list, tuple)):
        return [_with_warnings(read_cell(one, format, name, strict)) for one in source]
    return _with_warnings(read_cell(source, format, name, strict))


def _with_warnings(cell: _neurotess.Cell) -> Morphology:
    """The cell; its warnings are given at the caller's caller."""
    _warn(cell, 4)
    return Morphology(cell)


def _warn(cell: _neurotess.Cell, stacklevel: int = 3) -> None:
    """Gives a reader's warnings at the caller's caller."""
    for code, message, line, _ in cell.warnings:
        place = cell.name if line is None else f"{cell.name}:{line}"
        warnings.warn(ReadWarning(f"{place}: {message} ({code})"), stacklevel=stacklevel)


def synth(
    kind: str, *, seed: int = 1, points: int | None = None, may_cross: bool = False
) -> Morphology:
    """Grows a synthetic cell, the same for the same seed on every machine.

    `kind` is ``"pyramidal"``, ``"purkinje"``, ``"granule"``, ``"basket"``, ``"motor"`` or ``"star"``.
    `points` outside the soma, 50 or more, are usual for the kind if they are left out. Branches keep clear of
    one another unless they `may_cross`.
    """
    if points is not None and points < 50:
        raise ValueError(f"points={points} is not 50 or more")
    return Morphology(_neurotess.Cell.grow(kind, seed, points, may_cross))
