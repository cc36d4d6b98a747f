"""Fills the surface of a cell with tetrahedra by TetGen.

usage: fill_tetgen.py CELL.msh TETRAHEDRA.vtu

The membrane stays as it is (TetGen's -Y): its vertices come first, in the order of CELL.msh.
"""

import sys

import meshio
import numpy
import tetgen

surface = meshio.read(sys.argv[1])
triangles = numpy.concatenate([block.data for block in surface.cells if block.type == "triangle"])
# A facet's marker is its section plus one: 1 is the soma.
markers = numpy.concatenate(surface.cell_data["gmsh:geometrical"])

filled = tetgen.TetGen(surface.points, triangles.astype(numpy.int32), markers.astype(numpy.int32))
# p: a closed surface; q1.4: no needles, as far as the surface allows; Y: the surface stays; Q: quiet.
nodes, tetrahedra, *_ = filled.tetrahedralize(switches="pq1.4YQ")

meshio.write_points_cells(sys.argv[2], nodes, [("tetra", tetrahedra)])
print(f"TetGen: {len(nodes)} nodes, {len(tetrahedra)} tetrahedra")
