"""neurotess: from tracings of neurons to closed surface meshes and pictures.

    import neurotess as nt

    cell = nt.read("cell.swc")
    mesh = nt.mesh(cell, level=4)
    mesh.save("cell.glb")
    nt.render(cell).save("cell.png")

Lengths are micrometers (µm), times milliseconds. Arrays are NumPy's, read-only, and shared, not copied. Heavy work
leaves the interpreter to other threads, and Ctrl-C stops it.

| to | use |
| --- | --- |
| read a tracing, or make one | `read`, `synth`, `Morphology.from_table`, `Morphology.from_navis`, … |
| mend it, or compare two | `edit`, `diff` |
| mesh it | `mesh`, `mesh_many`, `mesh_all`, `Mesh` |
| judge a mesh | `Mesh.check`, `check`, `read_mesh` |
| draw it | `render`, `film`, `Image`, `View` |
| send it as one HTML page | `html` |
| open it in neuroglancer | `neuroglancer` |
| use a circuit and its recordings | `Circuit`, `Report` |
| plot numbers of it | `neurotess.plot` |
| mesh on a cluster | `neurotess.dask` |
"""

from __future__ import annotations

import os

from ._neurotess import __version__
from ._errors import (
    FolderError,
    ForbiddenFileError,
    MeshError,
    MissingFileError,
    NeurotessError,
    NeurotessWarning,
    OptionError,
    ReadError,
    ReadWarning,
    RenderError,
    UnreadableFileError,
)
from ._morphology import Morphology, read, synth
from ._parts import Neurite, Notice, Section, Soma
from ._edits import diff, edit
from ._meshes import Mesh, check, read_mesh
from ._meshing import Failed, Meshed, MeshResult, mesh, mesh_all, mesh_many
from ._circuits import Circuit
from ._neuroglancer import neuroglancer
from ._reports import Report
from ._pages import html
from ._images import Film, Image
from ._pictures import film, render
from ._ids import Ids, ids

TYPE_CHECKING = False
if TYPE_CHECKING:
    from . import dask as dask
    from . import plot as plot
    from ._typed import Camera as Camera
    from ._typed import Markers as Markers
    from ._typed import MeshOptions as MeshOptions
    from ._typed import PageOptions as PageOptions
    from ._typed import RenderOptions as RenderOptions
    from ._typed import Scene as Scene
    from ._typed import SceneMesh as SceneMesh
    from ._view import View as View

# Without what needs other packages: `from neurotess import *` works everywhere.
__all__ = [
    "Circuit",
    "Failed",
    "Film",
    "FolderError",
    "ForbiddenFileError",
    "Ids",
    "Image",
    "Mesh",
    "MeshError",
    "MeshResult",
    "Meshed",
    "MissingFileError",
    "Morphology",
    "Neurite",
    "NeurotessError",
    "NeurotessWarning",
    "Notice",
    "OptionError",
    "ReadError",
    "ReadWarning",
    "RenderError",
    "Report",
    "Section",
    "Soma",
    "UnreadableFileError",
    "__version__",
    "check",
    "diff",
    "edit",
    "film",
    "html",
    "ids",
    "mesh",
    "mesh_all",
    "mesh_many",
    "neuroglancer",
    "read",
    "read_mesh",
    "render",
    "synth",
]


#: Types of options, which few need.
TYPED = ("Camera", "Markers", "MeshOptions", "PageOptions", "RenderOptions", "Scene", "SceneMesh")


def __getattr__(name: str) -> object:
    # What needs other packages is imported when it is asked for.
    import importlib

    if name in ("dask", "plot"):
        return importlib.import_module(f".{name}", __name__)
    if name == "View":
        return importlib.import_module("._view", __name__).View
    if name in TYPED:
        return getattr(importlib.import_module("._typed", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return [*__all__, *TYPED, "View", "dask", "plot"]


def quiet_adapters() -> None:
    """Keeps Mesa's layer that selects devices from asking for a display, where the user does not need it."""
    chosen = ("NODEVICE_SELECT", "MESA_VK_DEVICE_SELECT", "DRI_PRIME")
    if not any(name in os.environ for name in chosen):
        os.environ["NODEVICE_SELECT"] = "1"


for _name in __all__:
    _thing = globals().get(_name)
    # Tracebacks call exceptions what users call them. Of others the sources would no longer be found.
    if isinstance(_thing, type) and issubclass(_thing, Exception):
        _thing.__module__ = __name__
del _name, _thing
