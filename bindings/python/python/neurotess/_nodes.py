"""Which nodes of a circuit are meant: ids, pairs, or rows of a table."""

from __future__ import annotations

import operator

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Iterable
    from typing import Any, TypeAlias, Union

    import pandas as pd

    from . import _neurotess

    Nodes: TypeAlias = Union[Iterable[int], Iterable[tuple[str, int]], pd.DataFrame, str]


def rows_of(circuit: _neurotess.Circuit, nodes: Any, population: str | None) -> list[tuple[int, int]]:
    """Population and row of each node that is named. Raises what says which id is meant by none or by several."""
    rows: list[tuple[int, int]] = []
    for name, ids in _by_population(nodes, population).items():
        rows += circuit.find(name, ids)
    return rows


def _by_population(nodes: Any, population: str | None) -> dict[str | None, list[int]]:
    """Ids by the name of their population; None where it is not told."""
    columns = getattr(nodes, "columns", None)
    if columns is not None:
        if "node_id" not in columns:
            raise ValueError(f"nodes: a table needs the column 'node_id': it has {', '.join(map(repr, columns))}")
        names = nodes["population"] if "population" in columns else [population] * len(nodes)
        pairs = zip(names, nodes["node_id"], strict=True)
    elif isinstance(nodes, str):
        pairs = zip(_all(population), _ids_of_text(nodes))
    else:
        pairs = (_pair(node, population) for node in nodes)  # type: ignore[assignment]
    found: dict[str | None, list[int]] = {}
    for name, node in pairs:
        # Of what another population has, none is selected.
        if population is None or name == population:
            found.setdefault(name, []).append(_id(node))
    return found


def _all(name: str | None) -> Iterable[str | None]:
    while True:
        yield name


def _pair(node: Any, population: str | None) -> tuple[str | None, Any]:
    if isinstance(node, (tuple, list)) and len(node) == 2 and isinstance(node[0], str):
        return node[0], node[1]
    return population, node


def _id(node: Any) -> int:
    try:
        number = operator.index(node)
    except TypeError:
        raise ValueError(
            f"nodes: {node!r} is no id: give ids with population=, pairs like ('name', 3), or rows of `Circuit.nodes`"
        ) from None
    if number < 0:
        raise KeyError(f"no node {number}")
    return number


def _ids_of_text(text: str) -> Iterable[int]:
    for part in text.split(","):
        low, _, high = part.partition("-")
        try:
            yield from range(int(low), int(high or low) + 1)
        except ValueError:
            raise ValueError(f"nodes={text!r}: ids and ranges of them are needed, as in '0,5,10-19'") from None
