"""Parts of traced cells, and what was odd about them."""

from __future__ import annotations

import math

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import Any

    import numpy as np
    from numpy.typing import NDArray

    from ._morphology import Morphology


class Notice:
    """A warning as data."""

    code: str
    """Name for programs, like ``radius_mended``."""
    message: str
    """What is odd, or was mended."""
    count: int
    """How often."""
    line: int | None
    """The first line of the file, from 1 on, where it is about the file."""
    sample: int | None
    """Number of the first sample, where it is about the mesh."""

    __slots__ = ("code", "count", "line", "message", "sample")

    def __init__(self, code: str, message: str, count: int, line: int | None, sample: int | None) -> None:
        self.code = code
        self.message = message
        self.count = count
        self.line = line
        self.sample = sample

    def _values(self) -> tuple[object, ...]:
        return self.code, self.message, self.count, self.line, self.sample

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Notice) and self._values() == other._values()

    def __hash__(self) -> int:
        return hash(self._values())

    def __repr__(self) -> str:
        place = "" if self.line is None else f"line {self.line}: "
        return f"<Notice {self.code}: {place}{self.message}>"


class Soma:
    """A soma as it was traced, and the sphere that stands for it."""

    kind: str
    """``"point"``, ``"three_point"``, ``"contour"``, ``"cylinders"`` or ``"surface"``."""
    center: NDArray[np.float64]
    """Center (µm)."""
    radius: float
    """Radius (µm) of the sphere that stands for it."""
    area: float
    """Area (µm²)."""
    volume: float
    """Volume (µm³)."""
    points: NDArray[np.float64]
    """Positions (µm) of the traced samples, (n, 3)."""
    radii: NDArray[np.float64]
    """Radii (µm) of the traced samples."""
    samples: NDArray[np.int64]
    """The file's own numbers of the traced samples."""

    def __init__(self, told: Mapping[str, Any]) -> None:
        import numpy as np

        self.kind = told["kind"]
        self.center = np.array(told["center"])
        self.radius = told["radius"]
        self.area = told["area"]
        self.volume = told["volume"]
        self.points = told["points"]
        self.radii = told["radii"]
        self.samples = told["samples"]

    def __repr__(self) -> str:
        return f"<Soma: {self.kind}, radius {self.radius:.3g} µm>"


class Section:
    """An unbranched part of a neurite, of one type."""

    id: int
    """Its index in `Morphology.sections`, depth-first. `Mesh.section` has i + 1, since 0 is the soma there."""

    def __init__(self, cell: Morphology, id: int) -> None:
        self._cell = cell
        self._columns = cell._section_columns()
        self.id = id

    def _of(self, column: str) -> Any:
        return self._columns[column][self.id].item()

    @property
    def indices(self) -> slice:
        """Its points among those of the cell: ``cell.points[section.indices]``."""
        return slice(self._of("first"), self._of("end"))

    @property
    def points(self) -> NDArray[np.float64]:
        """Positions (µm), (n, 3), without the point that it branches from. A view."""
        return self._cell.points[self.indices]

    @property
    def radii(self) -> NDArray[np.float64]:
        """Radii (µm). A view."""
        return self._cell.radii[self.indices]

    @property
    def type(self) -> int:
        """SWC type: 2 axon, 3 basal dendrite, 4 apical dendrite, others as in the file."""
        return int(self._of("type"))

    @property
    def parent(self) -> Section | None:
        """The section that it branches from; none where a neurite begins."""
        parent = int(self._of("parent"))
        return None if parent < 0 else Section(self._cell, parent)

    @property
    def children(self) -> list[Section]:
        """The sections that branch from its end."""
        return [Section(self._cell, i) for i in self._cell._children()[self.id]]

    @property
    def neurite(self) -> int:
        """Number of its neurite, from 0 on."""
        return int(self._of("neurite"))

    @property
    def neuron_section(self) -> int:
        """Its number in NEURON and in reports of simulations, from 1 on: the axon's come first, then those of basal
        dendrites, of apical ones and the rest, each in the order of the file.

        A file may have an only child as a section of its own, which is a part of this one here: then it is the number of
        the first.
        """
        return int(self._of("neuron_section"))

    @property
    def morphio_section(self) -> int:
        """Its number in MorphIO, from 0 on: as `neuron_section`, of the first."""
        return int(self._of("morphio_section"))

    @property
    def order(self) -> int:
        """Number of forks between the neurite's start and the section."""
        return int(self._of("order"))

    @property
    def length(self) -> float:
        """Length (µm), from the point that it branches from on."""
        return float(self._of("length"))

    @property
    def area(self) -> float:
        """Area (µm²) of its frusta, from the point that it branches from on, without caps."""
        return float(self._of("area"))

    @property
    def volume(self) -> float:
        """Volume (µm³) of its frusta, from the point that it branches from on."""
        return float(self._of("volume"))

    @property
    def mean_diameter(self) -> float:
        """Diameter (µm) of a cylinder of the same length and area; 0 where it has no length."""
        return self.area / (math.pi * self.length) if self.length > 0 else 0.0

    @property
    def exposed_area(self) -> float:
        """Area (µm²) of its cones outside the soma and all branches but its own: what a mesh of it is to have.

        Each link has the radii of its own ends, and a side branch begins at its fork with the radius of its first point.
        """
        return float(self._cell._exposed_areas()[self.id])

    @property
    def path_length(self) -> float:
        """Length (µm) of the way from the neurite's first point to the section's end."""
        return float(self._of("path_length"))

    @property
    def local_bifurcation_angle(self) -> float | None:
        """Angle (radians) at its end between its two branches, to their first points that are elsewhere.

        None where there are not two. The same as NeuroM's.
        """
        return self._angle("local_angle")

    @property
    def remote_bifurcation_angle(self) -> float | None:
        """Angle (radians) at its end between its two branches, to their ends; none where there are not two."""
        return self._angle("remote_angle")

    def _angle(self, column: str) -> float | None:
        angle = float(self._of(column))
        return None if angle != angle else angle

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Section) and (self._cell, self.id) == (other._cell, other.id)

    def __hash__(self) -> int:
        return hash((self._cell, self.id))

    def __repr__(self) -> str:
        count = self.indices.stop - self.indices.start
        return f"<Section {self.id}: type {self.type}, {count} points, {self.length:.4g} µm>"


class Neurite:
    """A tree that begins on the soma, or on nothing."""

    id: int
    """Its number, from 0 on, in the order of the file."""
    sections: list[Section]
    """Its sections in depth-first order; the first one is its root."""

    def __init__(self, cell: Morphology, id: int, first: int, end: int) -> None:
        self._cell = cell
        self.id = id
        self.sections = list(cell.sections[first:end])

    @property
    def root(self) -> Section:
        """The section that it begins with."""
        return self.sections[0]

    @property
    def type(self) -> int:
        """SWC type of its first section."""
        return self.root.type

    @property
    def indices(self) -> slice:
        """Its points among those of the cell."""
        return slice(self.root.indices.start, self.sections[-1].indices.stop)

    @property
    def points(self) -> NDArray[np.float64]:
        """Positions (µm), (n, 3). A view."""
        return self._cell.points[self.indices]

    @property
    def radii(self) -> NDArray[np.float64]:
        """Radii (µm). A view."""
        return self._cell.radii[self.indices]

    @property
    def length(self) -> float:
        """Length (µm)."""
        return float(sum(section.length for section in self.sections))

    def __repr__(self) -> str:
        return f"<Neurite {self.id}: type {self.type}, {len(self.sections)} sections>"
