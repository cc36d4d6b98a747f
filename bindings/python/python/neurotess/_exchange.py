"""Cells of other packages, there and back: tables and cells of the extension, which `_morphology` wraps."""

from __future__ import annotations

import warnings

from . import _neurotess
from ._errors import NeurotessWarning
from ._packages import needed

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any


def to_navis(points: Any, name: str, id: Any, connectors: Any) -> Any:
    """`points`: as `Morphology.to_table` gives them."""
    navis = needed("navis")
    pandas = needed("pandas")
    names = {"id": "node_id", "type": "label", "parent": "parent_id"}
    table = pandas.DataFrame(points).rename(columns=names)
    soma = table.loc[table.label == 1, "node_id"]
    named = {} if id is None else {"id": id}
    neuron = navis.TreeNeuron(table, units="1 micrometer", name=name, **named)
    if connectors is not None:
        neuron.connectors = connectors.copy()
    if len(soma):
        neuron.soma = int(soma.iloc[0])
    return neuron


def from_navis(neuron: Any) -> tuple[Any, str, Any]:
    """A table as `Morphology.from_table` takes it, a name, and connectors (µm)."""
    table = neuron.nodes[["node_id", "label", "x", "y", "z", "radius", "parent_id"]].copy()
    # Labels are of any kind in navis; those that are no SWC types are undefined.
    pandas = needed("pandas")
    table["label"] = pandas.to_numeric(table["label"], errors="coerce").fillna(0).astype("int64")
    connectors = getattr(neuron, "connectors", None)
    connectors = None if connectors is None else connectors.copy()
    units = getattr(neuron, "units", None)
    if units is not None and not getattr(units, "dimensionless", True):
        scale = float(units.to("micrometer").magnitude)
        for column in ("x", "y", "z", "radius"):
            table[column] = table[column] * scale
            if connectors is not None and column in connectors:
                connectors[column] = connectors[column] * scale
    else:
        told = f"{neuron.name or 'the neuron'} has no units: its lengths are taken as µm"
        warnings.warn(NeurotessWarning(told), stacklevel=3)
    soma = getattr(neuron, "soma", None)
    if soma is not None and not (table["label"] == 1).any():
        import numpy as np

        table.loc[table["node_id"].isin(np.atleast_1d(soma)), "label"] = 1
    return table, str(neuron.name or "navis"), connectors


def to_morphio(cell: _neurotess.Cell) -> Any:
    morphio = needed("morphio")
    # SWC has no outlines.
    contour = any(soma["kind"] == "contour" for soma in cell.somata())
    format = "asc" if contour else "swc"
    # Neurites may change their type without a fork, as in many files.
    option = morphio.Option.allow_unifurcated_section_change
    text = cell.to_bytes(format).decode()
    return morphio.Morphology(text, extension=format, options=option)


def from_morphio(morphology: Any, name: str, strict: bool) -> _neurotess.Cell:
    import numpy as np

    morphio = needed("morphio")
    if hasattr(morphology, "as_immutable"):
        morphology = morphology.as_immutable()
    soma = morphology.soma
    n_soma = len(soma.points)
    outline = morphology.soma_type == morphio.SomaType.SOMA_SIMPLE_CONTOUR
    soma_radii = np.zeros(n_soma) if outline else np.asarray(soma.diameters) / 2
    soma_parents = np.arange(n_soma, dtype=np.int64)
    if morphology.soma_type == morphio.SomaType.SOMA_NEUROMORPHO_THREE_POINT_CYLINDERS:
        soma_parents[1:] = 1
    soma_parents[:1] = -1

    offsets = np.asarray(morphology.section_offsets, dtype=np.int64)
    starts, counts = offsets[:-1], np.diff(offsets)
    parent_section = np.full(len(starts), -1, dtype=np.int64)
    for parent, children in morphology.connectivity.items():
        if parent >= 0:
            parent_section[children] = parent
    # A section repeats the point that it branches from.
    kept = np.ones(len(morphology.points), dtype=bool)
    kept[starts[parent_section >= 0]] = False
    ids = np.cumsum(kept) + n_soma
    parents = ids - 1
    first = starts + (parent_section >= 0)
    ends = ids[starts + counts - 1]
    root = 1 if n_soma else -1
    parents[first] = np.where(parent_section >= 0, ends[parent_section], root)
    types = np.repeat(np.asarray(morphology.section_types, dtype=np.int64), counts)

    def column(of_soma: Any, of_points: Any, kind: Any) -> Any:
        return np.ascontiguousarray(np.concatenate([of_soma, of_points[kept]]), dtype=kind)

    points = np.asarray(morphology.points)
    soma_points = np.asarray(soma.points).reshape(-1, 3)
    x, y, z = (column(soma_points[:, k], points[:, k], float) for k in range(3))
    return _neurotess.Cell.from_columns(
        column(np.arange(1, n_soma + 1), ids, np.int64),
        column(np.ones(n_soma), types, np.int64),
        x,
        y,
        z,
        column(soma_radii, np.asarray(morphology.diameters) / 2, float),
        column(soma_parents, parents, np.int64),
        name,
        strict,
    )


def to_neurom(cell: _neurotess.Cell, name: str) -> Any:
    neurom = needed("neurom")
    morphology = neurom.load_morphology(to_morphio(cell))
    morphology.name = name
    return morphology


def from_neurom(morphology: Any, strict: bool) -> _neurotess.Cell:
    return from_morphio(morphology.to_morphio(), str(morphology.name or "neurom"), strict)
