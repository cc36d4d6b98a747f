"""A row for each section of a cell."""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ._morphology import Morphology


def section_table(
    cell: Morphology, d_lambda: float, frequency: float, Ra: float, cm: float
) -> NDArray[np.void]:
    """The columns of `Morphology.section_table`."""
    import numpy as np

    given = {"d_lambda": d_lambda, "frequency": frequency, "Ra": Ra, "cm": cm}
    for name, value in given.items():
        if not (value > 0 and np.isfinite(value)):
            raise ValueError(f"{name}={value} is not a number above 0")

    told = cell._section_columns()
    length, area = told["length"], told["area"]
    with np.errstate(divide="ignore", invalid="ignore"):
        diameter = np.where(length > 0, area / (np.pi * length), 0.0)
    columns = {
        "section": np.arange(1, len(length) + 1),
        "section_index": np.arange(len(length)),
        "neuron_section": told["neuron_section"],
        "type": told["type"],
        "parent": told["parent"] + 1,
        "neurite": told["neurite"],
        "order": told["order"],
        "length": length,
        "area": area,
        "volume": told["volume"],
        "mean_diameter": diameter,
        "path_length": told["path_length"],
        "nseg": _segments(cell, d_lambda, frequency, Ra, cm),
    }
    table = np.zeros(len(length), dtype=[(name, values.dtype) for name, values in columns.items()])
    for name, values in columns.items():
        table[name] = values
    return table


def _segments(cell: Morphology, d_lambda: float, frequency: float, Ra: float, cm: float) -> NDArray[np.int64]:
    """Numbers of segments, odd, each at most `d_lambda` of the length constant for alternating current.

    Hines and Carnevale, NEURON: a tool for neuroscientists, The Neuroscientist 7 (2001): along a tapering section the
    constant is summed link by link, with the mean diameter of each.
    """
    import numpy as np

    told, parents = cell._section_columns(), cell.parents
    points, diameters = cell.points, 2 * cell.radii
    hangs = parents >= 0
    before = np.where(hangs, parents, np.arange(len(parents)))
    links = np.linalg.norm(points - points[before], axis=1)
    sums = diameters + diameters[before]
    with np.errstate(divide="ignore", invalid="ignore"):
        lambdas = np.where(links > 0, links / np.sqrt(sums), 0.0)
    first = told["first"]
    total = np.add.reduceat(lambdas, first) if len(first) else np.zeros(0)
    # Lengths in length constants; points without a radius have none.
    electrical = total * np.sqrt(2.0) * 1e-5 * np.sqrt(4 * np.pi * frequency * Ra * cm)
    electrical = np.where(np.isfinite(electrical), electrical, 0.0)
    count: NDArray[np.int64] = ((electrical / d_lambda + 0.9) / 2).astype(np.int64) * 2 + 1
    return count
