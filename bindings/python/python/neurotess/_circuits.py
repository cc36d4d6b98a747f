"""Circuits."""

from __future__ import annotations

import os
import warnings

from . import _neurotess, _options
from ._errors import ReadWarning
from ._meshes import Mesh
from ._meshing import Outcome, _of
from ._morphology import Morphology, _with_warnings
from ._parts import Notice
from ._nodes import rows_of
from ._packages import needed
from ._pages import html
from ._images import Image
from ._pictures import render
from ._reports import Report
from ._scene import DrawnCircuit, check_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path
    from typing import Any, Literal, overload

    import numpy as np
    import pandas as pd
    from numpy.typing import NDArray
    from typing_extensions import Unpack

    from ._nodes import Nodes
    from ._typed import MeshOptions, PageOptions, RenderOptions


class Circuit(DrawnCircuit):
    """A circuit: SONATA, a network of Snudda, a scene of nsol or one of your own.

    `path` is a configuration, or the folder of one; of Snudda, `network-synapses.hdf5` or its folder. Parts that are missing are warned of.

    Of each HDF5 file 20 times its size and 100 MB may be made; `allow_large` allows more, in this process from then on.
    """

    def __init__(self, path: str | os.PathLike[str], *, allow_large: bool = False) -> None:
        if allow_large:
            _neurotess.allow_large()
        self._circuit = _neurotess.Circuit(path)
        self._path = os.fspath(path)
        self._allow_large = allow_large
        self._tables: dict[str, pd.DataFrame] = {}
        for message in self._circuit.warnings:
            warnings.warn(ReadWarning(message), stacklevel=2)

    @property
    def file(self) -> str:
        """The configuration that was read."""
        return self._circuit.file

    @property
    def populations(self) -> list[str]:
        """Names of the populations of nodes."""
        return [name for name, _, _ in self._circuit.populations]

    @property
    def node_sets(self) -> list[str]:
        """Names of the node sets."""
        return self._circuit.node_sets

    @property
    def reports(self) -> dict[str, str]:
        """The files of reports and spikes that the configuration names, by their names."""
        return {name: os.fspath(path) for name, path in self._circuit.reports}

    def __len__(self) -> int:
        return sum(count for _, _, count in self._circuit.populations)

    # Tables

    @property
    def nodes(self) -> pd.DataFrame:
        """A table with a row for each node of all populations; needs pandas.

        Columns: ``population``, ``node_id``, ``x``, ``y``, ``z`` (µm), ``rotation_w``, ``rotation_x``,
        ``rotation_y``, ``rotation_z`` (a quaternion), ``morphology`` (a path, or missing), then the attributes of
        the file, text as categories.
        """
        if "nodes" not in self._tables:
            pandas = needed("pandas", "circuit")
            tables = [self._nodes_of(i, pandas) for i in range(len(self.populations))]
            self._tables["nodes"] = pandas.concat(tables, ignore_index=True) if tables else pandas.DataFrame()
        return self._tables["nodes"].copy(deep=False)

    def _nodes_of(self, population: int, pandas: Any) -> pd.DataFrame:
        columns = self._circuit.columns(population)
        name = self.populations[population]
        count = len(columns["node_id"])
        told: dict[str, Any] = {"population": pandas.Categorical([name] * count)}
        told["node_id"] = columns["node_id"].astype("int64")
        for axis, place in enumerate("xyz"):
            told[place] = columns["position"][:, axis]
        for axis, part in enumerate("wxyz"):
            told[f"rotation_{part}"] = columns["rotation"][:, axis]
        paths = [os.fspath(path) for path in self._circuit.templates]
        told["morphology"] = [paths[t] if t >= 0 else None for t in columns["template"]]
        for attribute, values in columns["attributes"].items():
            key = attribute if attribute not in told else f"{attribute}_attribute"
            if isinstance(values, tuple):
                library, codes = values
                unique = list(dict.fromkeys(library))
                if len(unique) == len(library):
                    told[key] = pandas.Categorical.from_codes(codes, unique)
                else:
                    told[key] = [library[code] if code >= 0 else None for code in codes]
            else:
                told[key] = values
        return pandas.DataFrame(told)

    def select(
        self,
        nodes: Nodes | None = None,
        *,
        node_set: str | None = None,
        population: str | None = None,
        region: tuple[Iterable[float], Iterable[float]] | None = None,
        sample: int | None = None,
        sample_seed: int = 1,
    ) -> pd.DataFrame:
        """Rows of `nodes` that are selected; the options narrow each other down.

        `nodes` are rows of such a table, pairs of a population and an id, or ids, if only one population has them or
        `population` says which (``"0,5,10-19"`` are ids, too). An id that several populations have is a ``ValueError``,
        and one that is not there a ``KeyError``. `region` are two corners (µm) of a box that has the somata, and `sample` a number of cells at
        random, the same for the same seed.
        """
        rows = self._rows(nodes, node_set, population, region, sample, sample_seed)
        starts = [0]
        for _, _, count in self._circuit.populations:
            starts.append(starts[-1] + count)
        return self.nodes.iloc[[starts[p] + row for p, row in rows]]

    def _rows(
        self,
        nodes: Nodes | None,
        node_set: str | None,
        population: str | None,
        region: tuple[Iterable[float], Iterable[float]] | None,
        sample: int | None,
        sample_seed: int,
    ) -> list[tuple[int, int]]:
        named = None if nodes is None else rows_of(self._circuit, nodes, population)
        box = None
        if region is not None:
            low, high = region
            box = ([float(n) for n in low], [float(n) for n in high])
        found = self._circuit.select(named, node_set, population, box, sample, sample_seed)
        return list(zip(found[0].tolist(), found[1].tolist(), strict=True))

    def _row(self, node: int, population: str | None) -> tuple[int, int]:
        return rows_of(self._circuit, [node], population)[0]

    @property
    def edges(self) -> pd.DataFrame:
        """A table of the populations of edges: ``name``, ``source``, ``target``, ``count``; needs pandas."""
        pandas = needed("pandas", "circuit")
        names = ["name", "source", "target", "count"]
        return pandas.DataFrame(self._circuit.edges, columns=names)

    def synapses(
        self,
        edges: str,
        *,
        side: Literal["afferent", "efferent"] | None = None,
        numbers: Iterable[str] = (),
    ) -> pd.DataFrame:
        """A table of a population of edges: ``source``, ``target`` (node ids), and ``x``, ``y``, ``z`` (µm) if
        the file has places; needs pandas.

        `side`: on the targets (afferent) or on the sources (efferent), by default whichever the file has.
        `numbers`: further columns of the file, such as ``"delay"``.
        """
        pandas = needed("pandas", "circuit")
        names = list(numbers)
        columns = self._circuit.synapses(edges, side, names)
        told = {name: columns[name].astype("int64") for name in ("source", "target")}
        if len(columns["position"]) == len(told["source"]):
            told |= {axis: columns["position"][:, i] for i, axis in enumerate("xyz")}
        told |= {name: columns[name] for name in names}
        return pandas.DataFrame(told)

    # Cells

    def morphology(self, node: int, *, population: str | None = None) -> Morphology:
        """The morphology of a node, in its own coordinates."""
        p, row = self._row(node, population)
        template = int(self._circuit.columns(p)["template"][row])
        if template < 0:
            raise ValueError(f"node {node} has no morphology that exists")
        return _with_warnings(self._circuit.morphology(template))

    def placement(self, node: int, *, population: str | None = None) -> NDArray[np.float64]:
        """The matrix (4, 4) from the coordinates of a node's morphology to those of the circuit (µm)."""
        return self._matrix(*self._row(node, population))

    def _matrix(self, population: int, row: int) -> NDArray[np.float64]:
        import numpy as np

        return np.array([*self._circuit.placement(population, row), [0.0, 0.0, 0.0, 1.0]])

    def inputs(self, node: int, *, population: str | None = None) -> NDArray[np.float64]:
        """Places of the synapses that a node gets, of all edges, in the coordinates of its morphology (µm), (n, 3).

        ``neurotess.edit(circuit.morphology(7), spines=circuit.inputs(7))`` grows a spine at each. Where a file of edges
        has no coordinates, they follow from sections and places along them.
        """
        return self._circuit.inputs(*self._row(node, population))

    def mesh(
        self,
        nodes: Nodes | None = None,
        *,
        node_set: str | None = None,
        population: str | None = None,
        region: tuple[Iterable[float], Iterable[float]] | None = None,
        sample: int | None = None,
        sample_seed: int = 1,
        threads: int | None = None,
        **options: Unpack[MeshOptions],
    ) -> Iterator[MeshedNode | FailedNode]:
        """Meshes cells in the coordinates of the circuit, with the options of `neurotess.mesh`.

        What selects cells is that of `select`. An error is a value, as in `mesh_many`. Nodes that share a
        morphology share its coarse mesh.
        """
        recipe = _options.recipe(options)
        rows = self._rows(nodes, node_set, population, region, sample, sample_seed)
        return self._meshes(rows, recipe, threads)

    def _meshes(
        self, rows: list[tuple[int, int]], recipe: _neurotess.Recipe, threads: int | None
    ) -> Iterator[MeshedNode | FailedNode]:
        mesher = self._circuit.mesher(recipe)
        names = self.populations
        ids = [self._circuit.columns(i)["node_id"] for i in range(len(names))]
        for p, row in rows:
            node = int(ids[p][row])
            try:
                surface, report, cell = mesher.mesh(p, row, threads)
                read: list[Notice] = []
                placement = self._matrix(p, row)
                mesh = _of(surface, report, read, f"{names[p]}_{node}", Morphology(cell), placement)
                yield MeshedNode(names[p], node, mesh, None)
            except Exception as error:
                yield FailedNode(names[p], node, None, error)

    # Recordings

    def report(self, name: str | os.PathLike[str], *, population: str | None = None) -> Report:
        """A report or a file of spikes: one that the configuration names, or a file. Where it has several populations of
        nodes, `population` says which."""
        return Report(self._report_file(name), population, circuit=self)

    @property
    def spikes(self) -> Report:
        """The first file of spikes that the configuration names; ``AttributeError`` where it names none."""
        for file in self.reports.values():
            if _neurotess.Report(file).is_of_spikes:
                return Report(file, circuit=self)
        raise AttributeError(f"{self.file} names no file of spikes")

    def _report_file(self, name: str | os.PathLike[str]) -> str:
        """The file of a report: one that the configuration names, or a file."""
        name = os.fspath(name)
        file = self.reports.get(name, name)
        if file == name and not os.path.exists(name) and os.sep not in name:
            known = ", ".join(map(repr, self.reports)) or "none"
            raise KeyError(f"{self.file} names no report {name!r}, and there is no such file: it has {known}")
        return file

    def render(self, **options: Unpack[RenderOptions]) -> Image:
        """A picture of the circuit: `neurotess.render` with this circuit.

        A `time` without a `report` is of the first report with values.
        """
        if options.get("time") is not None and options.get("report") is None:
            files = self.reports.values()
            on_cells = (file for file in files if self._circuit.elements(file) == "section")
            options["report"] = next((file for file in on_cells if not _neurotess.Report(file).is_of_spikes), None)
        elif (report := options.get("report")) is not None:
            options["report"] = self._report_file(report)
        return render(self, **options)

    if TYPE_CHECKING:

        @overload
        def to_html(self, path: None = None, **options: Unpack[PageOptions]) -> str: ...

        @overload
        def to_html(self, path: str | os.PathLike[str], **options: Unpack[PageOptions]) -> Path: ...

    def to_html(
        self, path: str | os.PathLike[str] | None = None, **options: Unpack[PageOptions]
    ) -> str | Path:
        """One HTML page of some of its cells, to send: `neurotess.html` with this circuit."""
        check_names("to_html", html, dict(options))
        return html(self, path, **options)

    def __reduce__(self) -> tuple[type[Circuit], tuple[str]]:
        return type(self), (self._path,)

    def _repr_html_(self) -> str:
        from ._html import of_circuit

        return of_circuit(self)

    def __repr__(self) -> str:
        return f"<Circuit {self.file!r}: {len(self)} nodes>"


class NodeMesh(Outcome):
    """A cell of `Circuit.mesh`: a `MeshedNode` with a mesh in the coordinates of the circuit, or a `FailedNode`."""

    population: str
    """The population of the node."""
    node_id: int
    """Its id."""

    __slots__ = ("node_id", "population")

    def __init__(self, population: str, node_id: int, mesh: Mesh | None, error: Exception | None) -> None:
        super().__init__(mesh, error)
        self.population = population
        self.node_id = node_id

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.node_id} of {self.population!r}: {self._said()}>"


class MeshedNode(NodeMesh):
    """A cell of `Circuit.mesh` that was meshed."""

    ok: Literal[True] = True
    mesh: Mesh
    error: None

    __slots__ = ()

    def __bool__(self) -> Literal[True]:
        return True


class FailedNode(NodeMesh):
    """A cell of `Circuit.mesh` that could not be meshed, and why."""

    ok: Literal[False] = False
    mesh: None
    error: Exception

    __slots__ = ()

    def __bool__(self) -> Literal[False]:
        return False
