"""Plots of numbers, with matplotlib (``pip install 'neurotess[plot]'``).

Each function draws into `ax`, or a new figure's, and returns it.
"""

from __future__ import annotations

from ._packages import needed

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    import numpy as np
    from numpy.typing import NDArray

    from ._reports import Report
    from ._morphology import Morphology

__all__ = ["dendrogram", "sholl", "sholl_counts", "voltage"]

#: Colors of types, those of NeuroM.
COLORS = {1: "black", 2: "blue", 3: "red", 4: "purple"}


def _axes(ax: Any) -> Any:
    if ax is not None:
        return ax
    needed("matplotlib", "plot")
    return needed("matplotlib.pyplot", "plot").subplots()[1]


def sholl_counts(
    cell: Morphology, radii: NDArray[np.float64], types: tuple[int, ...] | None = None
) -> NDArray[np.int64]:
    """How often the neurites cross spheres of these radii (µm) around the soma, or around the first point."""
    import numpy as np

    soma = cell.soma
    center = soma.center if soma is not None else cell.points[:1].reshape(-1)
    inner = cell.parents >= 0
    if types is not None:
        inner &= np.isin(cell.types, types)
    distance = np.linalg.norm(cell.points - center, axis=1)
    a, b = distance[cell.parents[inner]], distance[inner]
    low, high = np.sort(np.minimum(a, b)), np.sort(np.maximum(a, b))
    # Links that begin within a sphere and end outside it.
    counts: NDArray[np.int64] = np.searchsorted(low, radii, side="left") - np.searchsorted(
        high, radii, side="left"
    )
    return counts


def sholl(cell: Morphology, *, step: float = 10.0, by_type: bool = True, ax: Any = None) -> Any:
    """Sholl's diagram: crossings of spheres around the soma, every `step` µm."""
    import numpy as np

    ax = _axes(ax)
    soma = cell.soma
    center = soma.center if soma is not None else cell.points[:1].reshape(-1)
    farthest = np.linalg.norm(cell.points - center, axis=1).max(initial=0.0)
    radii = np.arange(step, farthest + step, step)
    names = {2: "axon", 3: "basal dendrite", 4: "apical dendrite"}
    kinds: list[int | None] = [int(k) for k in np.unique(cell.types)] if by_type else [None]
    for kind in kinds:
        counts = sholl_counts(cell, radii, None if kind is None else (kind,))
        label = "all" if kind is None else names.get(kind, f"type {kind}")
        ax.plot(radii, counts, label=label, color=None if kind is None else COLORS.get(kind))
    ax.set(xlabel="distance from the soma (µm)", ylabel="crossings")
    if by_type:
        ax.legend()
    return ax


def dendrogram(cell: Morphology, *, ax: Any = None) -> Any:
    """Sections as vertical lines as long as they are, from the soma upwards; ends side by side."""
    ax = _axes(ax)
    sections = cell.sections
    places: dict[int, float] = {}
    ends = 0
    children = cell._children()
    for section in reversed(sections):
        below = children[section.id]
        if below:
            places[section.id] = sum(places[i] for i in below) / len(below)
        else:
            # From the last end to the first.
            places[section.id] = float(-ends)
            ends += 1
    for section in sections:
        x, top = places[section.id] + ends - 1, section.path_length
        color = COLORS.get(section.type, "gray")
        ax.plot([x, x], [top - section.length, top], color=color, linewidth=1)
        across = [places[i] + ends - 1 for i in children[section.id]]
        if across:
            ax.plot([min(across), max(across)], [top, top], color=color, linewidth=0.5)
    ax.set(xticks=[], ylabel="path length (µm)")
    return ax


def voltage(report: Report, node: int, *, compartment: int = 0, ax: Any = None) -> Any:
    """Values of a compartment of a node over time."""
    ax = _axes(ax)
    ax.plot(report.times, report.values(node)[:, compartment], linewidth=1)
    ax.set(xlabel="time (ms)", ylabel=report.units or "value", title=f"node {node}")
    return ax
