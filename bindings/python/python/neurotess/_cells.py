"""Cells of whatever they may be given as: a `Morphology`, a file or its content, or a cell of another package."""

from __future__ import annotations

from ._morphology import Morphology, _with_warnings
from ._sources import is_table, package_of, read_cell

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any


def cell_of(source: Any) -> Morphology:
    """The cell; what is odd in a file is warned of."""
    if isinstance(source, Morphology):
        return source
    package = package_of(source)
    if package is None and is_table(source):
        return Morphology.from_table(source)
    if package is None:
        return _with_warnings(read_cell(source, None, None, False))
    return _from_package(source, package)


def quietly(source: Any) -> Morphology:
    """The cell, without warnings: they are in `Morphology.warnings`."""
    if isinstance(source, Morphology) or package_of(source) or is_table(source):
        return cell_of(source)
    return Morphology(read_cell(source, None, None, False))


def _from_package(source: Any, package: str) -> Morphology:
    if package in ("nrn", "hoc"):
        return Morphology.from_neuron(source)
    if package == "navis" and not hasattr(source, "nodes"):
        kind = type(source).__name__
        raise TypeError(f"a {kind} of navis has no tracing: a TreeNeuron is needed (of a list, use neurotess.mesh_many)")
    if package == "navis":
        return Morphology.from_navis(source)
    return Morphology.from_morphio(source) if package == "morphio" else Morphology.from_neurom(source)
