"""Morphometrics of a folder: a table with a row for each cell, and a mesh of each.

python morphometrics.py OUT [FOLDER]
"""

# %%
from __future__ import annotations

import sys
from pathlib import Path

import pandas as pd

import neurotess as nt

out = Path(sys.argv[1] if len(sys.argv) > 1 else ".")

# %% Tracings of yours, or some that are grown.
if len(sys.argv) > 2:
    folder = Path(sys.argv[2])
else:
    folder = out / "cells"
    folder.mkdir(exist_ok=True)
    for seed in range(4):
        nt.synth("granule", seed=seed, points=150).save(folder / f"granule_{seed}.swc")

# %% Numbers of all cells. A nested one like soma.radius becomes a column of this name.
paths = sorted(folder.glob("*.swc"))
table = pd.json_normalize([nt.read(path).measures() for path in paths])
table.insert(0, "cell", [path.stem for path in paths])
table.to_csv(out / "morphometrics.csv", index=False)
print(table[["cell", "n_points", "length", "soma.radius"]])

# %% Meshes on all cores; what fails is told and does not end the batch.
for result in nt.mesh_many(paths, level=2):
    if not result.ok:
        print(f"{result.input}: {result.error}")
        continue
    mesh = result.mesh
    print(f"{mesh.name}: {len(mesh.faces)} faces, {mesh.volume:.1f} µm³, closed: {mesh.closed}")
    mesh.save(out / f"{mesh.name}.ply")
