"""A mesh for a solver: separated, merged and of even triangles; tetrahedra in it by TetGen, if it is there; and a number of
each of their nodes back on the surface.

python simulation.py OUT [CELL.swc]
"""

# %%
from __future__ import annotations

import sys
from pathlib import Path

import neurotess as nt
import numpy as np

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

    # %% What a solver finds at the nodes goes back onto the surface: its vertices are the first nodes, in their order, since
    # TetGen adds others behind them. Here the distance from the first point stands for a concentration.
    assert (nodes[: len(mesh.vertices)] == mesh.vertices).all()
    concentration = np.exp(-np.linalg.norm(nodes - cell.points[0], axis=1) / 30)
    solved = mesh.with_attribute("calcium_uM", concentration[: len(mesh.vertices)])
    solved.save(out / "calcium.vtu")
    assert nt.read_mesh(out / "calcium.vtu").attributes["calcium_uM"].shape == (len(mesh.vertices),)
    try:
        solved.render(values="calcium_uM", title="calcium", unit="µM", colormap="inferno").save(out / "calcium.png")
    except nt.RenderError as error:
        print(error)
