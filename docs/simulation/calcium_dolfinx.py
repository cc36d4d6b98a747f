"""Calcium diffuses through a cell, as in calcium.py, by dolfinx.

usage: calcium_dolfinx.py CELL.vtu CELL.csv TETRAHEDRA.msh MEMBRANE.vtu SECTIONS.csv

experiment.py says what is simulated. Linear elements, backward Euler, in one process. TETRAHEDRA.msh is
as fill_gmsh.py writes it.
"""

import sys

# Before dolfinx: its wheel takes the MPI that mpi4py has loaded.
from mpi4py import MPI

import ufl
from dolfinx import fem
from dolfinx.fem.petsc import assemble_matrix
from dolfinx.io import gmsh
from petsc4py import PETSc

from experiment import DIFFUSION, STEP, STEPS, Membrane, report

membrane_in, table_in, tetrahedra, membrane_out, sections_out = sys.argv[1:]
if MPI.COMM_WORLD.size > 1:
    sys.exit("each process would have a part of the cell: run this in one")

# The cell's inside. dolfinx numbers nodes anew.
filled = gmsh.read_from_msh(tetrahedra, MPI.COMM_WORLD)
space = fem.functionspace(filled.mesh, ("Lagrange", 1))
points = space.tabulate_dof_coordinates()

membrane = Membrane(membrane_in, table_in)
node = membrane.nodes(points)
calcium = fem.Function(space)
calcium.x.array[:] = membrane.source(points)

# ∫ (c⁺ − c) v + Δt D ∇c⁺·∇v = 0 for all v. For v = 1 the second term is 0, so the amount, ∫ c, stays.
c, v = ufl.TrialFunction(space), ufl.TestFunction(space)
M = assemble_matrix(fem.form(c * v * ufl.dx))
M.assemble()
A = assemble_matrix(fem.form((c * v + STEP * DIFFUSION * ufl.dot(ufl.grad(c), ufl.grad(v))) * ufl.dx))
A.assemble()

# The matrix stays the same: it is factorized once.
solver = PETSc.KSP().create(filled.mesh.comm)
solver.setOperators(A)
solver.setType("preonly")
solver.getPC().setType("lu")

volume = fem.assemble_scalar(fem.form(fem.Constant(filled.mesh, 1.0) * ufl.dx))
amount = fem.form(calcium * ufl.dx)
before = fem.assemble_scalar(amount)
now, right = calcium.x.petsc_vec, M.createVecLeft()
for _ in range(STEPS):
    M.mult(now, right)
    solver.solve(right, now)

report(calcium.x.array, volume, before, fem.assemble_scalar(amount))
membrane.write(calcium.x.array[node], membrane_out, sections_out)
