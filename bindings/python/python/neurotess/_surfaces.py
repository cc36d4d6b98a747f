"""Surfaces of pictures: meshes alone and beside cells, how they look, and numbers of one's own of their vertices."""

from __future__ import annotations

import os
from collections.abc import Mapping

from . import _neurotess, _options
from ._colors import text_of
from ._errors import missing_file
from ._meshes import Mesh, read_mesh
from ._sources import arrays_of, is_alone, is_surface
from ._units import grayed, plain, unit_of

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any, TypeAlias

    import numpy as np
    from numpy.typing import NDArray

    #: By mesh the numbers of its vertices, if it has any; what they are, and their unit.
    OfMeshes: TypeAlias = tuple[list[NDArray[np.float32] | None], str, str]


def without_surfaces(what: Any, options: dict[str, Any]) -> Any:
    """The cells of what is drawn; surfaces among them become `meshes` of the options, with their part of `values`."""
    alone = is_surface(what)
    if not alone and (is_alone(what) or not hasattr(what, "__iter__")):
        return what
    many = [what] if alone else list(what)
    if not any(map(is_surface, many)):
        return many
    values = options.get("values")
    if values is None or alone:
        values = [values]
        values *= len(many)
    elif isinstance(values, (str, Mapping)) or len(values) != len(many):
        told = "cells and meshes" if len(many) > 1 else "mesh"
        raise ValueError(f"values= of {len(many)} {told} are a list with an array, or None, for each")
    pairs = list(zip(many, values, strict=True))
    surfaces = [one if of is None else {"mesh": one, "values": of} for one, of in pairs if is_surface(one)]
    options["meshes"] = [*surfaces, *_listed(options.get("meshes"))]
    of_cells = [of for one, of in pairs if not is_surface(one)]
    options["values"] = None if all(of is None for of in of_cells) else of_cells
    return [one for one in many if not is_surface(one)]


def _listed(meshes: Any) -> list[Any]:
    if meshes is None:
        return []
    alone = isinstance(meshes, (str, os.PathLike, Mapping)) or is_surface(meshes)
    return [meshes] if alone else list(meshes)


def looks_of(meshes: Any) -> list[dict[str, Any]]:
    """Meshes beside the cells, each with how it looks: a file or a `Mesh` as `mesh`."""
    looks = []
    for number, one in enumerate(_listed(meshes)):
        look = dict(one) if isinstance(one, Mapping) else {"mesh": one}
        if "mesh" not in look:
            raise ValueError(f"{one!r} names no mesh: it needs a file or a mesh as 'mesh'")
        source = look["mesh"]
        if isinstance(source, (str, os.PathLike)):
            if not os.path.exists(source):
                raise missing_file(os.fspath(source))
            if look.get("values") is not None:
                look["mesh"] = read_mesh(source)
        elif not isinstance(source, Mesh):
            look["mesh"] = _of_package(source, f"mesh {number + 1}", look.get("values"))
        looks.append(look)
    return looks


def _of_package(source: Any, name: str, values: Any) -> Mesh:
    """A mesh of another package, with the attribute that is wanted of it."""
    mesh = Mesh.from_arrays(*arrays_of(source), name=name)
    theirs = getattr(source, "vertex_attributes", None)
    if isinstance(values, str) and isinstance(theirs, Mapping):
        if values not in theirs:
            raise ValueError(f"values={values!r}: {name} has {_names(theirs)}")
        mesh._own[values] = theirs[values]
    return mesh


def values_of_meshes(looks: list[dict[str, Any]], options: dict[str, Any]) -> OfMeshes | None:
    """Takes `values` of the looks, and their `title` and `unit` of the options, where cells have no numbers; none if no
    mesh has numbers."""
    given = [look.pop("values", None) for look in looks]
    if all(values is None for values in given):
        return None
    for name in ("times", "report"):
        if options.get(name) is not None:
            raise ValueError(f"values= of meshes do not change over time: leave out {name}=")
    for look, values in zip(looks, given, strict=True):
        if values is not None and look.get("color") is not None:
            raise ValueError(f"values= are what colors tell: leave out color={look['color']!r}")
    title, unit = options.get("title"), options.get("unit")
    if unit is None:
        unit = next((own for own in map(unit_of, given) if own is not None), None)
    numbers = [
        None if of is None else _numbers(look["mesh"], of, unit) for look, of in zip(looks, given, strict=True)
    ]
    if title is None:
        title = next((of for of in given if isinstance(of, str)), None)
    if options.get("values") is None:
        options["title"] = options["unit"] = None
    return numbers, str(title or ""), str(unit or "")


def _numbers(mesh: Mesh, values: Any, unit: str | None) -> NDArray[np.float32]:
    """The numbers of the vertices, of an array or of an attribute by its name."""
    import numpy as np

    told = f"values= of {mesh.name}"
    if isinstance(values, str):
        if values not in mesh.attributes:
            raise ValueError(f"values={values!r}: {mesh.name} has {_names(mesh.attributes)}")
        told = f"values={values!r} of {mesh.name}"
        values = mesh.attributes[values]
    array = np.asarray(plain(told, values, unit))
    count = len(mesh.vertices)
    if array.ndim == 2 and array.shape[1] == 1:
        array = array[:, 0]
    if array.ndim != 1 or len(array) != count:
        raise ValueError(f"{told} have shape {array.shape}: ({count},) is needed, a number for each vertex{_hint(mesh, array)}")
    if array.dtype.kind not in "fiub":
        raise ValueError(f"{told} are not numbers, but {array.dtype}")
    return grayed(told, array)


def _hint(mesh: Mesh, array: NDArray[Any]) -> str:
    if mesh.cell is not None and array.shape == (len(mesh.cell),):
        return "; of the cell's points they are values[mesh.point_index] (−1 is the soma)"
    return "; these are of its faces" if array.shape == (len(mesh.faces),) else ""


def _names(attributes: Mapping[str, Any]) -> str:
    return ", ".join(map(repr, attributes)) or "no attributes"


def joint_range(of_cells: Any, of_meshes: OfMeshes) -> tuple[float, float] | None:
    """The least and the greatest number of cells and meshes, which have one scale; none if cells have no numbers, or none is
    finite."""
    import numpy as np

    if of_cells is None:
        return None
    cells, _, _ = of_cells
    arrays = [*(points for points, _ in cells), [soma for _, soma in cells], *(n for n in of_meshes[0] if n is not None)]
    every = np.concatenate(arrays)
    finite = every[np.isfinite(every)]
    if not len(finite):
        return None
    low, high = float(finite.min()), float(finite.max())
    return low, high if high > low else low + 1


def words_of(looks: list[dict[str, Any]]) -> tuple[list[str], list[_neurotess.Surface | None]]:
    """Meshes beside the cells: a file or a name with the options of how it looks, and the surface, if it is in memory."""
    words: list[str] = []
    surfaces: list[_neurotess.Surface | None] = []
    for look in looks:
        look = dict(look)
        file = look.pop("mesh")
        if look.get("color") is not None:
            look["color"] = text_of(look["color"])
        surfaces.append(file._surface if isinstance(file, Mesh) else None)
        if isinstance(file, Mesh):
            # The extension ends the name, which may have commas.
            file = f"{file.name.replace(os.sep, '_')}.ply"
        given = {name: value for name, value in look.items() if value is not None}
        options = [f"{name}={_options.word(value)}" for name, value in given.items() if not isinstance(value, bool)]
        flags = [name for name, value in given.items() if value is True]
        words.append(",".join([os.fspath(file), *options, *flags]))
    return words, surfaces
