"""Calcium diffuses through a cell; the membrane shows how much there is.

usage: calcium.py CELL.vtu CELL.csv TETRAHEDRA MEMBRANE.vtu SECTIONS.csv

experiment.py says what is simulated. Linear elements, backward Euler, by scikit-fem.
"""

import sys

import meshio
import numpy
import skfem
from scipy.sparse.linalg import splu
from skfem.models.poisson import laplace, mass

from experiment import DIFFUSION, STEP, STEPS, Membrane, report

membrane_in, table_in, tetrahedra, membrane_out, sections_out = sys.argv[1:]

# The cell's inside.
filled = meshio.read(tetrahedra)
cells = numpy.concatenate([block.data for block in filled.cells if block.type == "tetra"])
used, cells = numpy.unique(cells, return_inverse=True)
points = filled.points[used]
mesh = skfem.MeshTet(points.T, cells.reshape(-1, 4).T)
basis = skfem.Basis(mesh, skfem.ElementTetP1())

membrane = Membrane(membrane_in, table_in)
node = membrane.nodes(points)
calcium = membrane.source(points)

# (M + Δt D K) c⁺ = M c. Rows of K sum to 0, so the amount, 1ᵀ M c, stays.
M, K = mass.assemble(basis), laplace.assemble(basis)
solve = splu((M + STEP * DIFFUSION * K).tocsc()).solve
amount = (M @ calcium).sum()
for _ in range(STEPS):
    calcium = solve(M @ calcium)

report(calcium, M.sum(), amount, (M @ calcium).sum())
membrane.write(calcium[node], membrane_out, sections_out)
