"""Meshes of cells."""

from __future__ import annotations

import os

from . import _neurotess
from ._parts import Notice
from ._packages import needed

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any, Literal

    import numpy as np
    from numpy.typing import ArrayLike, NDArray


class Mesh:
    """A surface of triangles (and quads, if they were asked for) with attributes. Lengths are µm.

    Made by `mesh`, `mesh_many`, `Circuit.mesh`, `read_mesh` and `Mesh.from_arrays`. Its arrays are read-only
    and own their memory, so they may outlive it.
    """

    def __init__(
        self,
        surface: _neurotess.Surface,
        report: dict[str, Any] | None = None,
        notices: tuple[Notice, ...] = (),
        name: str = "mesh",
    ) -> None:
        self._surface = surface
        self.name: str = name
        """Name for people: that of the cell or the file."""
        self.report: dict[str, Any] = report or {}
        """What is known of its making, under the names of ``neurotess mesh --json``: ``closed``, ``euler``,
        ``components``, ``soma_volume``, ``crossings``, ``separation``, ``smoothing``, ``quality``."""
        self.warnings: list[Notice] = list(notices)
        """What was odd in the file, and what was mended of the tracing."""

    @classmethod
    def from_arrays(cls, vertices: ArrayLike, faces: ArrayLike, *, name: str = "mesh") -> Mesh:
        """A mesh of vertices (n, 3) in µm and triangles (m, 3), without attributes, to check or save it."""
        import numpy as np

        vertices = np.ascontiguousarray(vertices, dtype=np.float64)
        faces = np.asarray(faces)
        for array, what in ((vertices, "vertices"), (faces, "faces")):
            if array.ndim != 2 or array.shape[1] != 3:
                raise ValueError(f"{what} have shape {array.shape} instead of (n, 3)")
        if faces.size and (faces.dtype.kind not in "iu" or faces.min() < 0 or faces.max() >= 2**32):
            raise ValueError("faces are not indices of vertices")
        surface = _neurotess.Surface.from_arrays(vertices, np.ascontiguousarray(faces, dtype=np.uint32))
        return cls(surface, name=name)

    # Arrays

    @property
    def vertices(self) -> NDArray[np.float64]:
        """Positions (µm), (v, 3), in the coordinates of the tracing or the circuit."""
        return self._surface.vertices

    @property
    def faces(self) -> NDArray[np.uint32]:
        """Triangles, (f, 3): counter-clockwise seen from outside."""
        return self._surface.faces

    @property
    def quads(self) -> NDArray[np.uint32]:
        """Quads, (q, 4); there are some with ``quads=True`` and with ``level=0``."""
        return self._surface.quads

    @property
    def normals(self) -> NDArray[np.float32]:
        """Unit normals of the vertices, (v, 3)."""
        return self._surface.normals

    @property
    def type(self) -> NDArray[np.int32]:
        """SWC type of each vertex: 1 soma, 2 axon, 3 basal dendrite, 4 apical dendrite, …"""
        return self._surface.types

    @property
    def point(self) -> NDArray[np.int32]:
        """The file's own number of the nearest sample, for each vertex."""
        return self._surface.points

    @property
    def section(self) -> NDArray[np.int32]:
        """Section of each vertex, counted from 1; 0 is the soma. ``cell.sections[i]`` has number i + 1."""
        return self._surface.sections

    @property
    def radius(self) -> NDArray[np.float32]:
        """Radius (µm) of the tracing at each vertex."""
        return self._surface.radii

    def triangles(self) -> NDArray[np.uint32]:
        """All faces as triangles, (f, 3): quads are halved. Without quads it is `faces` itself."""
        import numpy as np

        if not len(self.quads):
            return self.faces
        halves = self.quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
        return np.concatenate([self.faces, halves])

    # What it is

    @property
    def closed(self) -> bool:
        """Whether every edge has exactly two faces."""
        if "closed" not in self.report:
            names = ("closed", "euler", "components")
            self.report.update(zip(names, self._surface.topology(), strict=True))
        return bool(self.report["closed"])

    @property
    def volume(self) -> float:
        """Enclosed volume (µm³)."""
        return self._surface.measure()[0]

    @property
    def area(self) -> float:
        """Area (µm²)."""
        return self._surface.measure()[1]

    def check(self, *, merge: bool = False) -> dict[str, Any]:
        """Judges the mesh as ``neurotess check --json`` does.

        The keys are ``closed``, ``edge_manifold``, ``vertex_manifold``, ``oriented``, ``components``, ``euler``,
        ``genus``, ``volume``, ``area``, ``self_intersections``, ``quality`` and others. `merge` joins vertices of
        the same position first, as STL files need it.
        """
        return self._surface.check(merge)

    # Elsewhere

    def save(
        self,
        path: str | os.PathLike[str],
        *,
        format: str | None = None,
        unit: Literal["um", "m"] = "um",
        overwrite: bool = True,
        materials: bool = False,
    ) -> None:
        """Writes a file, whole or not at all: PLY, OBJ, STL, GLB, OFF, VTU, MSH, POLY or SMESH.

        The extension tells the format if `format` does not; ``format="msh2"`` is MSH 2.2, as STEPS wants it, in files
        that end in ``.msh``. With ``unit="m"`` coordinates and radii are in meters.

        ``materials=True`` gives faces of a GLB or OBJ the colors of their types, of an OBJ in an ``.mtl`` file beside it.
        Some programs then read a mesh for each type, none of which is closed.
        """
        self._surface.write(path, format, unit, overwrite, materials)

    def to_trimesh(self) -> Any:
        """A `trimesh.Trimesh` with `type`, `point`, `section` and `radius` as vertex attributes."""
        trimesh = needed("trimesh")
        return trimesh.Trimesh(
            self.vertices,
            self.triangles(),
            vertex_normals=self.normals,
            vertex_attributes=self._attributes(),
            process=False,
            metadata={"name": self.name, "units": "micrometers"},
        )

    def to_pyvista(self) -> Any:
        """A `pyvista.PolyData` with normals and attributes as point data."""
        pyvista = needed("pyvista")
        mesh = pyvista.PolyData.from_regular_faces(self.vertices, self.triangles())
        for name, values in self._attributes().items():
            mesh.point_data[name] = values
        mesh.point_data["Normals"] = self.normals
        mesh.point_data.active_normals_name = "Normals"
        return mesh

    def to_navis(self) -> Any:
        """A `navis.MeshNeuron`, in µm."""
        navis = needed("navis")
        return navis.MeshNeuron((self.vertices, self.triangles()), units="1 micrometer", name=self.name)

    def _attributes(self) -> dict[str, NDArray[Any]]:
        return {
            "type": self.type,
            "point": self.point,
            "section": self.section,
            "radius": self.radius,
        }

    # Python

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self._surface, self.report, tuple(self.warnings), self.name)

    def __repr__(self) -> str:
        count = len(self.faces) + len(self.quads)
        closed = {True: ", closed", False: ", not closed", None: ""}[self.report.get("closed")]
        return f"<Mesh {self.name!r}: {len(self.vertices)} vertices, {count} faces{closed}>"


def read_mesh(path: str | os.PathLike[str], *, format: str | None = None) -> Mesh:
    """Reads a mesh file: PLY, OBJ, STL, GLB, OFF, VTU, MSH, POLY or SMESH."""
    return Mesh(_neurotess.Surface.read(path, format), name=os.path.basename(os.fspath(path)))


def check(mesh: Mesh | str | os.PathLike[str], *, merge: bool = False) -> dict[str, Any]:
    """Judges a mesh or a mesh file: `Mesh.check`."""
    if not isinstance(mesh, Mesh):
        mesh = read_mesh(mesh)
    return mesh.check(merge=merge)
