"""Recordings of simulations."""

from __future__ import annotations

import os
import warnings

from . import _neurotess
from ._errors import ReadWarning
from ._packages import needed
from ._units import times_of

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    import numpy as np
    import pandas as pd
    from numpy.typing import NDArray

    from ._circuits import Circuit
    from ._morphology import Morphology


class Report:
    """A recording: values of compartments over time, or spikes. Times are ms.

    Values are read from the file when they are asked for. `circuit`: whose cells it is of; `Circuit.report` gives it. `allow_large`: as of `Circuit`.
    """

    def __init__(
        self,
        path: str | os.PathLike[str],
        population: str | None = None,
        *,
        circuit: Circuit | None = None,
        allow_large: bool = False,
    ) -> None:
        if allow_large:
            _neurotess.allow_large()
        self._report = _neurotess.Report(path) if circuit is None else circuit._circuit.recording(path)
        self._path = os.fspath(path)
        names = self._report.populations
        if population is None and len(names) > 1:
            raise ValueError(f"{self._path} has the populations {names}: say population=, one of them")
        if population is None:
            population = names[0] if names else ""
        if population not in names:
            raise ValueError(f"{self._path} has no population {population!r}: it has {names}")
        self.population: str = population
        """The population that this is of. Where a file has several, one has to be named."""
        self._index = names.index(population)
        self._told: dict[str, Any] | None = None
        self._circuit = circuit
        for message in self._report.warnings:
            warnings.warn(ReadWarning(message), stacklevel=2)

    @property
    def path(self) -> str:
        """The file."""
        return self._path

    def __fspath__(self) -> str:
        return self._path

    @property
    def populations(self) -> list[str]:
        """Names of the populations in the file."""
        return self._report.populations

    @property
    def is_of_spikes(self) -> bool:
        """Whether it has spikes instead of values."""
        return self._report.is_of_spikes

    @property
    def _layout(self) -> dict[str, Any]:
        if self._told is None:
            self._told = self._report.layout(self._index)
        return self._told

    @property
    def units(self) -> str:
        """Unit of the values, such as ``"mV"``."""
        return str(self._layout["units"])

    @property
    def times(self) -> NDArray[np.float64]:
        """Times (ms) of the frames, (frames,)."""
        import numpy as np

        told = self._layout
        return np.asarray(told["start"] + told["step"] * np.arange(told["frames"]))

    @property
    def node_ids(self) -> NDArray[np.uint64]:
        """Ids of the nodes that have values."""
        ids: NDArray[np.uint64] = self._layout["node_ids"]
        return ids

    @property
    def offsets(self) -> NDArray[np.uint64]:
        """Compartments of node k are those from ``offsets[k]`` on, before ``offsets[k + 1]``."""
        offsets: NDArray[np.uint64] = self._layout["offsets"]
        return offsets

    def _columns(self, node: int | None) -> list[int] | None:
        if node is None:
            return None
        import numpy as np

        found = np.flatnonzero(self.node_ids == node)
        if not len(found):
            raise KeyError(f"no values of node {node}")
        first, end = self.offsets[found[0] : found[0] + 2].tolist()
        return list(range(first, end))

    def compartments(self, node: int, *, cell: Morphology | None = None) -> pd.DataFrame:
        """A table of a node's compartments; needs pandas.

        Columns: ``section``, as `Mesh.section` counts (0 is the soma, ``cell.sections[i]`` is i + 1), ``along`` it (0 to
        1), and ``neuron_section``, the number in the file: there, as in NEURON, all sections of the axon come first, then
        those of the basal dendrites, the apical ones and the rest, each in the order of the tracing's file. A number that
        no section of the cell has is a warning, and its ``section`` is −1.

        ``section`` needs the node's `cell`: that of the circuit, where the report is one of `Circuit.report`. Without a
        cell there is no such column.
        """
        numbers, along = self._on(node)
        if cell is None and self._circuit is not None:
            cell = self._circuit.morphology(node, population=self.population)
        pandas = needed("pandas", "circuit")
        if cell is None:
            return pandas.DataFrame({"along": along, "neuron_section": numbers})
        section, along = self._places_on(cell, numbers, along, stacklevel=3)
        return pandas.DataFrame({"section": section, "along": along, "neuron_section": numbers})

    def _on(self, node: int) -> tuple[NDArray[np.int64], NDArray[np.float32]]:
        """Of each compartment of a node the section by its number in the file, and the place along it."""
        import numpy as np

        self._columns(node)
        elements = "section" if self._circuit is None else self._circuit._circuit.elements(self._path)
        if elements != "section":
            raise ValueError(
                f"{self._path} has values of {elements}s, not of compartments: report.values(node) and report.at(time, node) "
                "have them, in the order of the file"
            )
        index = int(np.flatnonzero(self.node_ids == node)[0])
        sections, along = self._report.compartments(self._index, index)
        return sections.astype("int64"), along

    def _places_on(
        self, cell: Morphology, numbers: NDArray[np.int64], along: NDArray[np.float32], stacklevel: int
    ) -> tuple[NDArray[np.int64], NDArray[np.float32]]:
        """Sections as meshes count them and the places along them, of numbers in the file; −1 where the cell has none."""
        import numpy as np

        section, along = cell._cell.neuron_places(np.ascontiguousarray(numbers), np.ascontiguousarray(along))
        unknown = numbers[section < 0]
        if len(unknown):
            import warnings

            from ._errors import NeurotessWarning

            count = f"{len(unknown)} of {len(numbers)} compartments are of sections"
            told = f"{self._path}: {count} that {cell.name} does not have, as section {unknown[0]}: they have no place"
            warnings.warn(NeurotessWarning(told), stacklevel=stacklevel)
        return section, along

    def values(
        self,
        node: int | None = None,
        *,
        start: float | None = None,
        stop: float | None = None,
    ) -> NDArray[np.float32]:
        """Values (frames, compartments) of a node, or of all, from `start` on and before `stop` (ms)."""
        import numpy as np

        first, end = 0, len(self.times)
        start, stop = times_of("start=", start), times_of("stop=", stop)
        if start is not None:
            first = int(np.searchsorted(self.times, start - 1e-9))
        if stop is not None:
            end = max(first, int(np.searchsorted(self.times, stop - 1e-9)))
        return self._report.values(self._index, (first, end), self._columns(node))

    def at(self, time: float, node: int | None = None) -> NDArray[np.float32]:
        """Values (compartments,) of the frame that shows at a time (ms)."""
        told, time = self._layout, times_of("time", time)
        frame = int((time - told["start"]) / told["step"] + 1e-6)
        if not 0 <= frame < told["frames"] or time < told["start"]:
            raise ValueError(f"no frame shows at {time} ms")
        return self._report.values(self._index, (frame, frame + 1), self._columns(node))[0]

    @property
    def spikes(self) -> pd.DataFrame:
        """A table of spikes: ``time`` (ms), ``node_id``; needs pandas."""
        if not self.is_of_spikes:
            raise AttributeError(f"{self._path} has values, no spikes")
        pandas = needed("pandas", "circuit")
        times, nodes = self._report.spikes(self._index)
        return pandas.DataFrame({"time": times, "node_id": nodes.astype("int64")})

    def __reduce__(self) -> tuple[Any, ...]:
        from functools import partial

        return partial(type(self), circuit=self._circuit), (self._path, self.population)

    def __repr__(self) -> str:
        if self.is_of_spikes:
            return f"<Report {self._path!r}: spikes of {self.population!r}>"
        told = self._layout
        nodes, frames = len(told["node_ids"]), told["frames"]
        return f"<Report {self._path!r}: {frames} frames of {nodes} nodes of {self.population!r}>"
