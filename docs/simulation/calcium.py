"""Calcium diffuses through a cell; the membrane shows how much there is.

usage: calcium.py CELL.vtu CELL.csv TETRAHEDRA MEMBRANE.vtu SECTIONS.csv

Free diffusion without flux through the membrane: ∂c/∂t = D ∇²c in the cell, c = 1 µM in the soma at
the beginning. Linear elements, backward Euler. The amount of calcium must not change.
"""

import csv
import sys

import meshio
import numpy
import skfem
from scipy.sparse.linalg import splu
from scipy.spatial import KDTree
from skfem.models.poisson import laplace, mass

DIFFUSION = 223.0  # µm²/s, free calcium: Allbritton, Meyer and Stryer, Science 258, 1992
STEP, STEPS = 0.05, 200  # s

membrane_in, table_in, tetrahedra, membrane_out, sections_out = sys.argv[1:]

# The membrane; a row of the table for each of its triangles, in their order.
membrane = meshio.read(membrane_in)
triangles = membrane.cells_dict["triangle"]
with open(table_in) as file:
    rows = list(csv.DictReader(file))
assert [int(row["triangle"]) for row in rows] == list(range(len(triangles)))
sample, section, kind = (
    numpy.array([int(row[name]) for row in rows]) for name in ("sample", "section", "type")
)

# The cell's inside.
filled = meshio.read(tetrahedra)
cells = numpy.concatenate([block.data for block in filled.cells if block.type == "tetra"])
used, cells = numpy.unique(cells, return_inverse=True)
points = filled.points[used]
mesh = skfem.MeshTet(points.T, cells.reshape(-1, 4).T)
basis = skfem.Basis(mesh, skfem.ElementTetP1())

# Which node of the inside a vertex of the membrane is.
distance, node = KDTree(points).query(membrane.points)
assert distance.max() < 1e-6, "the fill has moved the membrane"

# The source: all within the soma's radius about its center.
soma = membrane.points[numpy.unique(triangles[section == 0])]
center = soma.mean(axis=0)
radius = numpy.median(numpy.linalg.norm(soma - center, axis=1))
calcium = (numpy.linalg.norm(points - center, axis=1) <= radius).astype(float)

# (M + Δt D K) c⁺ = M c. Rows of K sum to 0, so the amount, 1ᵀ M c, stays.
M, K = mass.assemble(basis), laplace.assemble(basis)
solve = splu((M + STEP * DIFFUSION * K).tocsc()).solve
amount = (M @ calcium).sum()
volume = M.sum()
for _ in range(STEPS):
    calcium = solve(M @ calcium)
drift = abs((M @ calcium).sum() / amount - 1)
assert drift < 1e-6, f"calcium was lost or made: {drift}"

# Back onto the membrane: per vertex with its section and sample, per triangle by the table.
on_membrane = calcium[node]
shown = {name: membrane.point_data[name] for name in ("section", "point")}
meshio.write_points_cells(
    membrane_out,
    membrane.points,
    [("triangle", triangles)],
    point_data={"calcium": on_membrane, **shown},
    cell_data={"sample": [sample], "section": [section], "type": [kind]},
)

# The mean of each section, weighted by area.
a, b, c = (membrane.points[triangles[:, corner]] for corner in range(3))
area = numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1) / 2
mean = on_membrane[triangles].mean(axis=1)
with open(sections_out, "w", newline="") as file:
    out = csv.writer(file)
    out.writerow(["section", "type", "area", "calcium"])
    for number in numpy.unique(section):
        here = section == number
        value = numpy.average(mean[here], weights=area[here])
        out.writerow([number, kind[here][0], f"{area[here].sum():.3f}", f"{value:.6f}"])

print(f"{STEP * STEPS:.0f} s: {calcium.min():.4f} to {calcium.max():.4f} µM, mean {amount / volume:.4f} µM")
print(f"amount {amount:.4f} µM µm³, changed by {drift:.1e} of it")
