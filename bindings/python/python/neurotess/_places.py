"""Where on a traced cell the vertices of its mesh are."""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    import numpy as np
    from numpy.typing import NDArray

    from ._morphology import Morphology
    from ._reports import Report

def section_index(section: NDArray[np.int32]) -> NDArray[np.int64]:
    """Indices of sections by their numbers in meshes: −1 on the soma, and where there is none."""
    import numpy as np

    return np.maximum(section.astype(np.int64) - 1, -1)


def point_index(cell: Morphology, sample: NDArray[np.int32], section: NDArray[np.int32]) -> NDArray[np.int64]:
    """Indices of the points with these numbers; −1 on the soma, and where no point has the number.

    Numbers may repeat: then it is the point of the section or, where branches leave, of its parent.
    """
    import numpy as np

    columns = cell._section_columns()
    sections = section_index(section)
    known, code = np.unique(cell._cell.sample_labels()[0], return_inverse=True)
    of_point = np.repeat(np.arange(len(columns["first"])), columns["end"] - columns["first"])
    asked = np.searchsorted(known, sample)
    asked[asked == len(known)] = 0
    there = (sections >= 0) & (known[asked] == sample) if len(known) else np.zeros(len(sample), bool)
    above = np.append(columns["parent"], -1)[sections]
    found = np.full(len(sample), -1)
    for wanted in (sections, above):
        left = there & (found < 0)
        found[left] = _find(of_point * len(known) + code, wanted[left] * len(known) + asked[left])
    left = there & (found < 0)
    found[left] = _find(code, asked[left])
    return found


def sample_index(cell: Morphology, sample: NDArray[np.int32], points: NDArray[np.int64]) -> NDArray[np.int64]:
    """Rows of the cell's table: somata first, then the points."""
    import numpy as np

    of_somata = cell._cell.sample_labels()[1]
    numbers = np.concatenate(of_somata) if of_somata else np.zeros(0, np.int64)
    rows = points + len(numbers)
    on_soma = points < 0
    rows[on_soma] = _find(numbers, sample[on_soma].astype(np.int64))
    return rows


def _find(keys: NDArray[np.int64], wanted: NDArray[np.int64]) -> NDArray[np.int64]:
    """Where each of `wanted` is first among `keys`; −1 if it is not."""
    import numpy as np

    if not len(keys):
        return np.full(len(wanted), -1)
    order = np.argsort(keys, kind="stable")
    place = np.searchsorted(keys[order], wanted)
    found = order[np.minimum(place, len(keys) - 1)]
    return np.where(keys[found] == wanted, found, -1)


def distances_from_root(cell: Morphology) -> NDArray[np.float64]:
    """Length (µm) of the way to each point from the first one of its neurite."""
    import numpy as np

    columns = cell._section_columns()
    points, parents = cell.points, cell.parents
    steps = np.where(parents >= 0, np.linalg.norm(points - points[parents], axis=1), 0.0)
    ways = np.cumsum(steps)
    counts = columns["end"] - columns["first"]
    to_end = np.repeat(ways[columns["end"] - 1], counts) - ways
    return np.repeat(columns["path_length"], counts) - to_end


class OnLines:
    """Where vertices fall on the traced lines of their sections."""

    root_distance: NDArray[np.float64]
    """Length (µm) of the way from the first point of the neurite; NaN on somata."""
    neurite: NDArray[np.bool_]
    """Whether a vertex is on a neurite."""

    def __init__(self, cell: Morphology, vertices: Any, sections: Any, points: Any) -> None:
        import numpy as np

        columns = cell._section_columns()
        self.cell, self.sections, self.points = cell, sections, points
        self.neurite = (sections >= 0) & (points >= 0)
        at, s, p = vertices[self.neurite], sections[self.neurite], points[self.neurite]
        first, end = columns["first"][s], columns["end"][s]
        inside = (first <= p) & (p < end)
        # The sample may be the one that the section branches from, which is its parent's.
        following = np.where(inside, np.where(p + 1 < end, p + 1, p), first)
        before = np.where(inside, np.where(cell.parents[p] >= 0, cell.parents[p], p), p)
        from_root = distances_from_root(cell)
        best = np.full(len(p), np.inf)
        self.root_distance = np.full(len(vertices), np.nan)
        told = np.zeros(len(p))
        for a, b in ((before, p), (p, following)):
            start, way = cell.points[a], cell.points[b] - cell.points[a]
            length = np.einsum("ij,ij->i", way, way)
            along = np.einsum("ij,ij->i", at - start, way) / np.maximum(length, 1e-12)
            along = np.clip(along, 0.0, 1.0)
            off = np.linalg.norm(at - start - along[:, None] * way, axis=1)
            nearer = off < best
            best[nearer] = off[nearer]
            told[nearer] = (from_root[a] + along * np.sqrt(length))[nearer]
        self.root_distance[self.neurite] = told

    def along(self) -> NDArray[np.float64]:
        """Place along the section, 0 at its start to 1 at its end; ½ on somata."""
        import numpy as np

        columns = self.cell._section_columns()
        length = np.maximum(columns["length"], 1e-9)
        start = columns["path_length"] - columns["length"]
        s = self.sections[self.neurite]
        along = np.full(len(self.sections), 0.5)
        along[self.neurite] = np.clip((self.root_distance[self.neurite] - start[s]) / length[s], 0.0, 1.0)
        return along


def path_distance(cell: Morphology, lines: OnLines, vertices: NDArray[np.float64]) -> NDArray[np.float64]:
    """Length (µm) of the way along the tracing from the soma's center; without a soma, from where each tree begins."""
    import numpy as np

    told = lines.root_distance.copy()
    somata = cell.somata
    if not somata:
        return told
    columns = cell._section_columns()
    starts = np.array([neurite.root.indices.start for neurite in cell.neurites], dtype=np.int64)
    from_soma = cell.path_distances()[starts]
    on = lines.neurite
    told[on] += from_soma[columns["neurite"][lines.sections[on]]]
    away = np.stack([np.linalg.norm(vertices[~on] - soma.center, axis=1) for soma in somata], axis=1)
    told[~on] = np.where(away.argmin(axis=1) == 0, away[:, 0], np.inf)
    return told


def compartments_of(cell: Morphology, report: Report, node: int) -> NDArray[np.int64]:
    """For each row of the cell's table the nearest compartment of a node in a report."""
    import numpy as np

    columns = cell._section_columns()
    counts = columns["end"] - columns["first"]
    on_soma = len(cell.to_table()) - len(cell)
    start, length = columns["path_length"] - columns["length"], np.maximum(columns["length"], 1e-9)
    of_points = np.repeat(np.arange(len(counts)), counts)
    share = np.clip((distances_from_root(cell) - start[of_points]) / length[of_points], 0.0, 1.0)
    sections = np.append(np.zeros(on_soma, np.int64), of_points + 1)
    places = np.append(np.full(on_soma, 0.5), share)
    return compartments_at(cell, report, node, sections, places)


def compartments_at(
    cell: Morphology,
    report: Report,
    node: int,
    sections: NDArray[np.integer[Any]],
    places: NDArray[np.float64],
) -> NDArray[np.int64]:
    """For each place along a section, as meshes count these, the nearest compartment of a node in a report: of the section
    that the file of the tracing has there."""
    import numpy as np

    numbers, along = report._on(node)
    report._places_on(cell, numbers, along, stacklevel=5)
    there = cell._cell.neuron_numbers(sections.astype(np.int64), np.ascontiguousarray(places, np.float64))
    return nearest_compartments(numbers, along, *there)


def nearest_compartments(
    section: NDArray[np.int64],
    along: NDArray[np.floating[Any]],
    sections: NDArray[np.int64],
    places: NDArray[np.float64],
) -> NDArray[np.int64]:
    """For each place the nearest compartment of its section; −1 where the section has none."""
    import numpy as np

    if not len(section):
        return np.full(len(sections), -1)
    # Compartments of another section are farther than any of the same.
    order = np.lexsort((along, section))
    keys = 4.0 * section[order] + along[order]
    wanted = 4.0 * sections + places
    after = np.clip(np.searchsorted(keys, wanted), 1, max(len(keys) - 1, 1))
    after = np.minimum(after, len(keys) - 1)
    before = np.maximum(after - 1, 0)
    nearer = np.where(wanted - keys[before] <= keys[after] - wanted, before, after)
    found = order[nearer]
    return np.where(section[found] == sections, found, -1)
