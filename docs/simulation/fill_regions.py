"""Fills a cell with walls by tetrahedra that know their region, by TetGen.

usage: fill_regions.py CELL.smesh TETRAHEDRA.vtu

Regions are the soma and its neurites, numbered as in CELL.smesh; the soma's is 0. Corners of the membrane that TetGen
gives to none have −1.
"""

import sys

import meshio
import numpy
import tetgen

with open(sys.argv[1], encoding="utf-8") as file:
    rows = [line.split() for line in file if line.strip() and not line.startswith("#")]


def section(width):
    """Takes a count and as many rows of numbers."""
    count = int(rows[0][0])
    taken, rows[: count + 1] = rows[1 : count + 1], []
    return numpy.array(taken, dtype=float).reshape(count, width)


points, facets, holes, regions = (section(width) for width in (4, 5, 4, 5))
facets = facets.astype(numpy.int32)
filled = tetgen.TetGen(points[:, 1:], facets[:, 1:4].copy(), facets[:, 4].copy())
for number, x, y, z, _ in regions:
    # Numbers from 1 on: TetGen leaves 0 to a few tetrahedra in corners of the membrane.
    filled.add_region(int(number) + 1, (x, y, z), 0.0)
nodes, tetrahedra, found, _ = filled.tetrahedralize(switches="pq1.4YAQ")
found = numpy.asarray(found).ravel().astype(int) - 1

edges = nodes[tetrahedra[:, 1:]] - nodes[tetrahedra[:, :1]]
volumes = numpy.abs(numpy.linalg.det(edges)) / 6
# A part in which no point lies has the next free number, as if it had been asked for.
nameless = found > regions[:, 0].max()
if nameless.any():
    sys.exit(f"{volumes[nameless].sum():.2f} µm³ are a region without a point in {sys.argv[1]}")
for number, _, _, _, kind in regions:
    inside = found == int(number)
    if not inside.any():
        sys.exit(f"region {int(number)} is empty")
    print(f"region {int(number)}, type {int(kind)}: {inside.sum()} tetrahedra, {volumes[inside].sum():.2f} µm³")
meshio.write_points_cells(
    sys.argv[2], nodes, [("tetra", tetrahedra)], cell_data={"region": [found]}
)
