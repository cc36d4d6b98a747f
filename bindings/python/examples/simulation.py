"""A mesh for a solver: separated, merged and of even triangles; and tetrahedra in it by TetGen, if it is there.

python simulation.py OUT [CELL.swc]
"""

# %%
from __future__ import annotations

import sys
from pathlib import Path

import neurotess as nt

out = Path(sys.argv[1] if len(sys.argv) > 1 else ".")

# %%
cell = nt.read(sys.argv[2]) if len(sys.argv) > 2 else nt.synth("granule", seed=2, points=60)
mesh = nt.mesh(cell, simulation=True)
quality = mesh.report["quality"]
print(mesh, f"half of the smallest angles are above {quality['min_angle_median']:.0f}°")
for notice in mesh.warnings:
    print(notice)
mesh.save(out / "cell.msh", unit="m")

# %% TetGen is AGPL; it is a program of its own that you install if you like: pip install tetgen
try:
    import tetgen
except ImportError:
    print("no TetGen here: Gmsh opens cell.msh, too")
else:
    generator = tetgen.TetGen(mesh.vertices, mesh.faces.astype("int32"))
    nodes, tetrahedra = generator.tetrahedralize(order=1, mindihedral=10, minratio=1.5)[:2]
    print(f"{len(nodes)} nodes, {len(tetrahedra)} tetrahedra")
