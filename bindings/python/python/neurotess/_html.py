"""How cells, meshes and circuits show themselves in notebooks: a small picture beside a table."""

from __future__ import annotations

import base64
import html
import warnings

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from typing import Any

    from ._circuits import Circuit
    from ._meshes import Mesh
    from ._morphology import Morphology
    from ._images import Image

#: Pixels of pictures, which a screen of twice the density shows sharp.
SIZE = (480, 360)
#: Most cells of a circuit that a picture shows: it is to be there within a few seconds in software, too.
CELLS = 500


def of_cell(cell: Morphology, render: Callable[..., Image]) -> str:
    """A cell: picture, counts, lengths."""
    measures = cell.measures()
    soma = measures["soma"]
    lengths = measures["length_by_type"]
    types = ((name.replace("_", " "), length) for name, length in lengths.items() if length)
    rows = [
        ("points", f"{measures['n_points']:,}"),
        ("neurites", f"{measures['n_neurites']:,}"),
        ("bifurcations", f"{measures['n_bifurcations']:,}"),
        ("length", _micrometers(measures["length"])),
        *((f"· {name}", _micrometers(length)) for name, length in types),
        ("soma", "none" if soma is None else f"{soma['kind']}, radius {soma['radius']:.3g} µm"),
        ("warnings", str(len(cell.warnings)) if cell.warnings else None),
    ]
    return _shown(cell.name, rows, lambda: render(cell, legend=False, size=SIZE, samples=4))


def of_mesh(mesh: Mesh) -> str:
    """A mesh: picture, counts, measures."""
    closed = mesh.report.get("closed")
    rows = [
        ("vertices", f"{len(mesh.vertices):,}"),
        ("triangles", f"{len(mesh.faces):,}"),
        ("quads", f"{len(mesh.quads):,}" if len(mesh.quads) else None),
        ("closed", None if closed is None else "yes" if closed else "no"),
        ("area", f"{mesh.area:,.1f} µm²"),
        ("volume", f"{mesh.volume:,.1f} µm³"),
        ("attributes", ", ".join(mesh.attributes)),
    ]
    return _shown(mesh.name, rows, lambda: mesh.render(legend=False, size=SIZE, samples=4))


def of_circuit(circuit: Circuit) -> str:
    """A circuit: picture of some of its cells, populations, reports."""
    populations = circuit._circuit.populations
    rows = [
        *((name, f"{count:,} nodes") for name, _, count in populations),
        ("node sets", ", ".join(circuit.node_sets)),
        ("reports", ", ".join(circuit.reports)),
    ]
    options: dict[str, Any] = {"lod": "exploration", "legend": False, "size": SIZE, "samples": 4}
    return _shown(circuit._path, rows, lambda: circuit.render(sample=CELLS, **options))


def _micrometers(length: float) -> str:
    return f"{length:,.1f} µm"


def _shown(title: str, rows: Iterable[tuple[str, str | None]], draw: Callable[[], Image]) -> str:
    """A table beside a picture, if there can be one."""
    cells = "".join(
        f'<tr><th style="text-align:left">{html.escape(name)}</th>'
        f'<td style="text-align:left">{html.escape(text)}</td></tr>'
        for name, text in rows
        if text
    )
    width, height = (side // 2 for side in SIZE)
    picture = _png(draw)
    shown = "" if picture is None else (
        f'<img alt="{html.escape(title)}" width="{width}" height="{height}" src="data:image/png;base64,{picture}">'
    )
    return (
        f'<div style="display:flex;gap:1em;align-items:center">{shown}'
        f"<table><caption><b>{html.escape(title)}</b></caption>{cells}</table></div>"
    )


def _png(draw: Callable[[], Image]) -> str | None:
    """The picture as base64; none where there is nothing to see: a table is better than an error."""
    from ._errors import NeurotessError

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return base64.b64encode(draw().to_png()).decode()
        except (NeurotessError, ValueError):
            return None
