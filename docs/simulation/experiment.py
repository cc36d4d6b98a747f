"""The experiment of calcium.py and calcium_dolfinx.py: its numbers, its start, and what it writes.

Free diffusion without flux through the membrane: ∂c/∂t = D ∇²c in the cell, c = 1 µM in the soma at
the beginning. The amount of calcium must not change.
"""

import csv

import meshio
import numpy
from scipy.spatial import KDTree

DIFFUSION = 223.0  # µm²/s, free calcium: Allbritton, Meyer and Stryer, Science 258, 1992
STEP, STEPS = 0.05, 200  # s


class Membrane:
    """The surface that neurotess made, with the table of its triangles."""

    def __init__(self, surface, table):
        self.surface = meshio.read(surface)
        self.points = self.surface.points
        self.triangles = self.surface.cells_dict["triangle"]
        # A row of the table for each triangle, in their order.
        with open(table) as file:
            rows = list(csv.DictReader(file))
        assert [int(row["triangle"]) for row in rows] == list(range(len(self.triangles)))
        self.sample, self.section, self.kind = (
            numpy.array([int(row[name]) for row in rows]) for name in ("sample", "section", "type")
        )

    def nodes(self, points):
        """Which node of the inside each vertex is."""
        distance, node = KDTree(points).query(self.points)
        assert distance.max() < 1e-6, "the fill has moved the membrane"
        return node

    def source(self, points):
        """1 µM at all nodes in the soma: those whose nearest vertex of the membrane is the soma's."""
        _, nearest = KDTree(self.points).query(points)
        section = numpy.ravel(self.surface.point_data["section"])
        return (section[nearest] == 0).astype(float)

    def write(self, calcium, membrane, sections):
        """The calcium of each vertex, with its section and sample, and the mean of each section."""
        shown = {name: self.surface.point_data[name] for name in ("section", "point")}
        meshio.write_points_cells(
            membrane,
            self.points,
            [("triangle", self.triangles)],
            point_data={"calcium": calcium, **shown},
            cell_data={"sample": [self.sample], "section": [self.section], "type": [self.kind]},
        )
        # Means are weighted by area.
        a, b, c = (self.points[self.triangles[:, corner]] for corner in range(3))
        area = numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1) / 2
        mean = calcium[self.triangles].mean(axis=1)
        with open(sections, "w", newline="") as file:
            out = csv.writer(file)
            out.writerow(["section", "type", "area", "calcium"])
            for number in numpy.unique(self.section):
                here = self.section == number
                value = numpy.average(mean[here], weights=area[here])
                out.writerow([number, self.kind[here][0], f"{area[here].sum():.3f}", f"{value:.8g}"])


def report(calcium, volume, before, after):
    """Stops if calcium was lost or made; prints what became of it."""
    drift = abs(after / before - 1)
    assert drift < 1e-6, f"calcium was lost or made: {drift}"
    print(f"{STEP * STEPS:.0f} s: {calcium.min():.4f} to {calcium.max():.4f} µM, mean {before / volume:.4f} µM")
    print(f"amount {before:.4f} µM µm³, changed by {drift:.1e} of it")
