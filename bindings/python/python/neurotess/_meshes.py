"""Meshes of cells."""

from __future__ import annotations

import os
import warnings

from . import _neurotess
from ._errors import NeurotessWarning
from ._units import plain
from ._own import COLORS, check_name, color_column, holds_own, own_arrays, own_column
from ._parts import Notice
from ._packages import needed
from ._sources import arrays_of, is_surface

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any, Literal

    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from ._colormaps import Colormap
    from ._colors import Color
    from ._morphology import Morphology
    from ._images import Image
    from ._places import OnLines
    from ._reports import Report


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
        cell: Morphology | None = None,
        placement: NDArray[np.float64] | None = None,
        own: dict[str, NDArray[Any]] | None = None,
    ) -> None:
        self._surface = surface
        self._own: dict[str, NDArray[Any]] = dict(own or {})
        self.cell: Morphology | None = cell
        """The cell that it was made of; none of files and of `from_arrays`, for which it can be set."""
        self.placement: NDArray[np.float64] | None = placement
        """The matrix (4, 4) from the cell's coordinates to the mesh's, where these are a circuit's."""
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

        vertices = np.ascontiguousarray(plain("vertices", vertices, "um"), dtype=np.float64)
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
    def sample(self) -> NDArray[np.int32]:
        """The file's own number of the nearest sample, for each vertex; `Morphology.samples` has those of points.

        Where a number of the file needs more than 32 bits, it is the sample's place instead, from 1 on, as in
        `Morphology.to_table` (warning ``long_sample_numbers``); `sample_index` is right for all.
        """
        return self._surface.points

    @property
    def point(self) -> NDArray[np.int32]:
        """The same as `sample`, under the name that it has in files."""
        return self._surface.points

    @property
    def section(self) -> NDArray[np.int32]:
        """Section of each vertex, counted from 1; 0 is the soma. `section_index` are indices of `Morphology.sections`."""
        return self._surface.sections

    @property
    def radius(self) -> NDArray[np.float32]:
        """Radius (µm) of the tracing at each vertex."""
        return self._surface.radii

    # Its cell

    @property
    def section_index(self) -> NDArray[np.int64]:
        """For each vertex the index of its section in ``cell.sections``; −1 on the soma."""
        from ._places import section_index

        return section_index(self.section)

    @property
    def point_index(self) -> NDArray[np.int64]:
        """For each vertex the index of the nearest point in ``cell.points``; −1 on the soma.

        >>> import neurotess as nt
        >>> cell = nt.read(b"1 1 0 0 0 5 -1\\n20 3 0 9 0 1 1\\n30 3 0 30 0 1 20\\n")
        >>> mesh = nt.mesh(cell, level=1)
        >>> sorted(set(mesh.sample.tolist())), sorted(set(mesh.point_index.tolist()))
        ([1, 20, 30], [-1, 0, 1])
        """
        from ._places import point_index

        return point_index(self._traced(), self.sample, self.section)

    @property
    def sample_index(self) -> NDArray[np.int64]:
        """For each vertex the row of the nearest sample in ``cell.to_table()``, which has those of somata, too."""
        from ._places import sample_index

        return sample_index(self._traced(), self.sample, self.point_index)

    @property
    def path_distance(self) -> NDArray[np.float64]:
        """Length (µm) of the path along the tracing from the soma's center to each vertex, where it falls on the traced
        line; straight on the soma itself. Without a soma, from where each tree begins."""
        from ._places import path_distance

        return path_distance(self._traced(), self._lines(), self._in_cell())

    def compartments(self, report: Report, node: int) -> NDArray[np.int64]:
        """For each vertex the nearest compartment of its section: the row of ``report.compartments(node)`` and the column
        of ``report.values(node)``. −1 where the report has none of the section.

        ``report.at(time, node)[mesh.compartments(report, node)]`` are the values of the vertices, if all have one.
        """
        from ._places import compartments_at

        return compartments_at(self._traced(), report, node, self.section_index + 1, self._lines().along())

    def _traced(self) -> Morphology:
        if self.cell is None:
            raise ValueError(f"{self.name} does not know its cell: set mesh.cell, as in mesh.cell = neurotess.read(…)")
        return self.cell

    def _in_cell(self) -> NDArray[np.float64]:
        """Vertices in the cell's own coordinates."""
        import numpy as np

        if self.placement is None:
            return self.vertices
        back = np.linalg.inv(self.placement)
        return np.asarray(self.vertices @ back[:3, :3].T + back[:3, 3])

    def _lines(self) -> OnLines:
        from ._places import OnLines

        return OnLines(self._traced(), self._in_cell(), self.section_index, self.point_index)

    # Numbers of one's own

    @property
    def attributes(self) -> dict[str, NDArray[Any]]:
        """Attributes of vertices: ``type``, ``point``, ``section``, ``radius``, and your own."""
        return {**self._built_in(), **self._own}

    def with_attribute(self, name: str, values: ArrayLike) -> Mesh:
        """A copy with numbers of your own for each vertex, (v,) or (v, n) with up to four: `to_trimesh` and `to_pyvista`
        hand them over, and PLY, VTU and GLB hold them.

        It shares all arrays with this mesh.

        >>> import neurotess as nt
        >>> mesh = nt.mesh(nt.synth("granule", points=100), level=1)
        >>> far = mesh.with_attribute("distance", mesh.path_distance)
        >>> bool((far.attributes["distance"] == mesh.path_distance).all())
        True
        """
        import numpy as np

        check_name(name)
        column = np.array(plain(f"values of {name!r}", values))
        if column.ndim not in (1, 2) or len(column) != len(self.vertices) or column[:1].size > 4:
            raise ValueError(
                f"values of {name!r} have shape {column.shape}: one for each of the {len(self.vertices)} vertices is "
                "needed, or up to four"
            )
        if column.dtype.kind not in "fiub":
            raise ValueError(f"values of {name!r} are not numbers, but {column.dtype}")
        column.flags.writeable = False
        return Mesh(
            self._surface,
            self.report,
            tuple(self.warnings),
            self.name,
            self.cell,
            self.placement,
            {**self._own, name: column},
        )

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

    def _warn_of_rounding(self, kind: str) -> None:
        """STL has numbers of 32 bits: far from the origin they round."""
        import numpy as np

        radii = self.attributes["radius"]
        radii = radii[radii > 0]
        if kind.lower().lstrip(".") != "stl" or not len(radii):
            return
        at, radius = float(np.abs(self.vertices).max()), float(np.median(radii))
        by = at * 2.0**-24
        if by > 0.02 * radius:
            warnings.warn(
                NeurotessWarning(
                    f"{self.name}: at {at:.3g} µm, stl rounds by {by:.3g} µm, and the median radius is {radius:.3g} µm: "
                    "save as ply, or move the mesh towards the origin"
                ),
                stacklevel=3,
            )

    def save(
        self,
        path: str | os.PathLike[str],
        *,
        format: str | None = None,
        unit: Literal["um", "m"] = "um",
        overwrite: bool = True,
        materials: bool = False,
        color_by: Literal["type"] | None = None,
        compress: Literal["draco"] | None = None,
        color: str | None = None,
        colormap: Colormap = "viridis",
        range: tuple[float, float] | None = None,
    ) -> None:
        """Writes a file, whole or not at all: PLY, OBJ, STL, GLB, OFF, VTU, MSH, POLY or SMESH.

        The extension tells the format if `format` does not; ``format="msh2"`` is MSH 2.2, as STEPS wants it, in files
        that end in ``.msh``. With ``unit="m"`` coordinates and radii are in meters.

        ``materials=True`` gives faces of a GLB or OBJ the colors of their types, of an OBJ in an ``.mtl`` file beside it.
        Some programs then read a mesh for each type, none of which is closed. ``color_by="type"`` gives vertices of a GLB, PLY
        or VTU these colors, and the mesh stays one.

        ``compress="draco"`` makes a GLB a tenth as large or less. Whole numbers stay exact, others are rounded; vertices and
        triangles have another order. Programs without Draco read nothing of it: trimesh needs DracoPy.

        PLY, VTU and GLB hold attributes of your own (`with_attribute`), as 32-bit numbers, and `read_mesh` gives them back; in a
        GLB they are called like ``_DISTANCE``. With the name of an attribute as `color`, vertices of a GLB have colors by its numbers (``COLOR_0``),
        which all programs show: of a `colormap`, whose ends are at the numbers of `range`. An attribute (v, 3) or (v, 4) of
        numbers from 0 to 1 is colors itself.
        """
        kind = format or os.path.splitext(os.fspath(path))[1]
        self._warn_of_rounding(kind)
        own = [own_column(name, values) for name, values in self._own.items()]
        if own and not holds_own(kind):
            told = f"{os.fspath(path)} has no {', '.join(self._own)}: PLY, VTU and GLB hold attributes of your own"
            warnings.warn(NeurotessWarning(told), stacklevel=2)
        if color is not None and color_by is not None:
            raise ValueError("color and color_by both give colors: leave out one of them")
        if color_by is not None and not {name.lower() for name in self._own}.isdisjoint(COLORS):
            raise ValueError(f"color_by: the mesh has colors of its own ({', '.join(self._own)}): leave out one of them")
        if color is not None:
            own.append(color_column(self.attributes, color, kind, colormap, range))
        self._surface.write(path, format, unit, overwrite, materials, color_by, compress, own)

    def to_trimesh(self) -> Any:
        """A `trimesh.Trimesh` with `attributes` as vertex attributes.

        Whole numbers are floating-point numbers there: glTF, by which trimesh also shows meshes in notebooks, has no
        others for vertices.
        """
        trimesh = needed("trimesh")
        return trimesh.Trimesh(
            self.vertices,
            self.triangles(),
            vertex_normals=self.normals,
            vertex_attributes={name: _floating(values) for name, values in self.attributes.items()},
            process=False,
            metadata={"name": self.name, "units": "micrometers"},
        )

    def to_pyvista(self) -> Any:
        """A `pyvista.PolyData` with normals and attributes as point data."""
        pyvista = needed("pyvista")
        mesh = pyvista.PolyData.from_regular_faces(self.vertices, self.triangles())
        for name, values in self.attributes.items():
            mesh.point_data[name] = values
        mesh.point_data["Normals"] = self.normals
        mesh.point_data.active_normals_name = "Normals"
        return mesh

    def to_navis(self) -> Any:
        """A `navis.MeshNeuron`, in µm."""
        navis = needed("navis")
        return navis.MeshNeuron((self.vertices, self.triangles()), units="1 micrometer", name=self.name)

    def _built_in(self) -> dict[str, NDArray[Any]]:
        return {
            "type": self.type,
            "point": self.point,
            "section": self.section,
            "radius": self.radius,
        }

    # Pictures

    def render(self, *, color: Color | None = None, values: ArrayLike | None = None, **options: Any) -> Image:
        """Draws the mesh alone, in one color, or colored by `values`: a number for each vertex, (v,), or the name of an
        attribute. NaN is gray; `colormap`, `range`, `title` and `unit` as of `neurotess.render`, whose options are all
        possible, and which draws the mesh beside cells, too: ``neurotess.render([cell, mesh])``.

        >>> import neurotess as nt
        >>> mesh = nt.mesh(nt.synth("granule", points=100))
        >>> mesh.render(color="teal", view="iso").save("mesh.png")        # doctest: +SKIP
        >>> mesh.render(values="radius", unit="µm").save("mesh.png")      # doctest: +SKIP
        """
        from ._pictures import render

        look = {"mesh": self, "color": color, "values": values}
        return render([], meshes=[look], **options)

    # Python

    def __reduce__(self) -> tuple[Any, ...]:
        told = self.report, tuple(self.warnings), self.name, self.cell, self.placement, self._own
        return type(self), (self._surface, *told)

    def _repr_html_(self) -> str:
        from ._html import of_mesh

        return of_mesh(self)

    def __repr__(self) -> str:
        count = len(self.faces) + len(self.quads)
        closed = {True: ", closed", False: ", not closed", None: ""}[self.report.get("closed")]
        return f"<Mesh {self.name!r}: {len(self.vertices)} vertices, {count} faces{closed}>"


def _floating(values: NDArray[Any]) -> NDArray[Any]:
    """Numbers as floating-point numbers of the fewest bits that hold them."""
    import numpy as np

    if values.dtype.kind == "f":
        return values
    narrow = values.astype(np.float32)
    return narrow if (narrow == values).all() else values.astype(np.float64)


def read_mesh(path: str | os.PathLike[str], *, format: str | None = None) -> Mesh:
    """Reads a mesh file: PLY, OBJ, STL, GLB, OFF, VTU, MSH, POLY or SMESH.

    Numbers that vertices have in PLY, VTU and GLB beside those of every mesh, as `Mesh.with_attribute` made them or
    another program, are in `Mesh.attributes`: (v,) or (v, n), 32-bit floating-point numbers where these hold them,
    else 64-bit ones. What is no letter or digit in a name is ``_``. In a GLB they are those that begin with ``_``.

    >>> import neurotess as nt
    >>> mesh = nt.mesh(nt.synth("granule", points=100), level=1)
    >>> mesh.with_attribute("distance", mesh.path_distance).save("far.vtu")      # doctest: +SKIP
    >>> nt.read_mesh("far.vtu").attributes["distance"].shape                     # doctest: +SKIP
    (1234,)
    """
    surface, own = _neurotess.Surface.read(path, format)
    return Mesh(surface, name=os.path.basename(os.fspath(path)), own=own_arrays(own))


def check(mesh: Mesh | str | os.PathLike[str] | Any, *, merge: bool = False) -> dict[str, Any]:
    """Judges a mesh or a mesh file, or a surface of another package (trimesh, PyVista, navis; µm): `Mesh.check`."""
    if is_surface(mesh) and not isinstance(mesh, Mesh):
        mesh = Mesh.from_arrays(*arrays_of(mesh))
    if not isinstance(mesh, Mesh):
        mesh = read_mesh(mesh)
    return mesh.check(merge=merge)
