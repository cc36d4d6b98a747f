"""Cells of NEURON, and numbers of its sections."""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from typing import Any, TypeAlias

    import numpy as np
    from numpy.typing import NDArray

    #: By the number of a sample: the index of its section among the names, and its place along it, 0 to 1.
    Places: TypeAlias = tuple[list[str], dict[int, tuple[int, float]]]

#: How names of sections begin, and their types in SWC.
TYPES = (("soma", 1), ("axon", 2), ("dend", 3), ("basal", 3), ("apic", 4), ("ais", 2), ("myelin", 2), ("node", 2))
#: Distance (µm) within which a section begins where it hangs.
SAME = 1e-3


def sections_of(source: Any) -> list[Any]:
    """The sections of a cell of NEURON: a list of them, one whose whole tree is meant, or an object with ``all``."""
    if type(source).__module__ == "nrn":
        return list(source.wholetree())
    if hasattr(source, "all") and not hasattr(source, "__len__"):
        source = source.all
    return list(source)


def table_of(source: Any) -> tuple[Any, Places, str]:
    """A table as `Morphology.from_table` takes it, where each sample is in NEURON, and a name."""
    import numpy as np

    sections = sections_of(source)
    if not sections:
        raise ValueError("there is no section: build the cell before")
    names = [section.name() for section in sections]
    rows: list[tuple[int, int, float, float, float, float, int]] = []
    places: dict[int, tuple[int, float]] = {}
    # Of each section the numbers of its samples, and their places along it.
    samples: dict[str, tuple[list[int], list[float]]] = {}
    for index, section in _parents_first(sections):
        count = int(section.n3d())
        if count < 2:
            raise ValueError(f"section {names[index]} has no 3D points: call h.define_shape() before")
        points = np.array(
            [[getattr(section, f"{axis}3d")(i) for axis in ("x", "y", "z")] for i in range(count)], dtype=float
        )
        radii = [section.diam3d(i) / 2 for i in range(count)]
        arcs = [section.arc3d(i) / max(section.L, 1e-12) for i in range(count)]
        kind = type_of(names[index])
        parent = _sample_of_parent(section, samples)
        first = 0
        if parent > 0 and kind != 1 and np.linalg.norm(points[0] - np.array(rows[parent - 1][2:5])) < SAME and count > 2:
            # It repeats the point that it hangs on.
            first = 1
        own: tuple[list[int], list[float]] = ([], [])
        for i in range(first, count):
            number = len(rows) + 1
            x, y, z = points[i]
            rows.append((number, kind, x, y, z, radii[i], parent))
            places[number] = (index, min(max(arcs[i], 0.0), 1.0))
            own[0].append(number)
            own[1].append(arcs[i])
            parent = number
        samples[names[index]] = own
    formats = ["i8", "i8", "f8", "f8", "f8", "f8", "i8"]
    columns = ["id", "type", "x", "y", "z", "radius", "parent"]
    table = np.array(rows, dtype=list(zip(columns, formats, strict=True)))
    cell = str(sections[0].cell() or "neuron")
    return table, (names, places), cell.partition("[")[0]


def type_of(name: str) -> int:
    """The SWC type of a section by its name, as of ``Cell[0].apic[3]``; 0 where it tells none."""
    own = name.rpartition(".")[2].lower()
    return next((kind for begin, kind in TYPES if own.startswith(begin)), 0)


def _parents_first(sections: list[Any]) -> Iterable[tuple[int, Any]]:
    waiting = {section.name(): (index, section) for index, section in enumerate(sections)}
    while waiting:
        for name, (index, section) in list(waiting.items()):
            at = section.parentseg()
            if at is None or at.sec.name() not in waiting:
                del waiting[name]
                yield index, section


def _sample_of_parent(section: Any, samples: Mapping[str, tuple[list[int], list[float]]]) -> int:
    """The number of the sample that a section hangs on; −1 where it begins a tree."""
    at = section.parentseg()
    if at is None or at.sec.name() not in samples:
        return -1
    numbers, arcs = samples[at.sec.name()]
    nearest = min(range(len(arcs)), key=lambda i: abs(arcs[i] - at.x))
    return numbers[nearest]


def values_of_sections(
    values: Mapping[Any, Any], places: Places | None, samples: NDArray[np.int64], name: str
) -> NDArray[np.float64]:
    """Of each sample the number of its section: a number of the whole section, or of the segment that it is in."""
    import numpy as np

    if places is None:
        raise ValueError(f"{name} is not of NEURON: only cells of Morphology.from_neuron know its sections")
    names, of_samples = places
    known = {str(key.name() if hasattr(key, "name") else key): np.asarray(value, float) for key, value in values.items()}
    unknown = [key for key in known if key not in names]
    if unknown:
        raise ValueError(f"{name} has no section {unknown[0]!r}: it has {', '.join(map(repr, names[:5]))}, …")
    frames = next((value.shape[1:] for value in known.values() if value.ndim == 2), ())
    numbers = np.full((len(samples), *frames), np.nan)
    for row, sample in enumerate(samples.tolist()):
        index, along = of_samples[sample]
        value = known.get(names[index])
        if value is not None:
            numbers[row] = value if value.ndim == 0 else value[min(int(along * len(value)), len(value) - 1)]
    return numbers
