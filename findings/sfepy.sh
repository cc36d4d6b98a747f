#!/usr/bin/env bash
# sfepy 2026.3 does not keep the numbers of physical groups of a mesh of Gmsh 4.15.2, and mixes up cells of two groups.
#
# Two boxes side by side with 718 and 737 tetrahedra, physical groups 7 "zone" and 3 "axon", and their skin, group 5.
#
#   MSH 4.1    groups 1, 2 and 4: 731, 6 and 718 tetrahedra. Six of "axon" are not with the others
#   MSH 2.2    group 1 for all 1,455
#   VTU with the numbers as mat_id, tetrahedra alone    groups 3 and 7: 737 and 718
#
# sfepy comes as source and needs a C compiler.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"${PYTHON:-python3}" -m venv env
env/bin/pip install -q sfepy==2026.3 gmsh==4.15.2 meshio==5.3.5

cat > make.py <<'PY'
import gmsh
import meshio
import numpy

gmsh.initialize()
gmsh.option.setNumber("General.Verbosity", 0)
left, right = (gmsh.model.occ.addBox(x, 0, 0, 1, 1, 1) for x in (0, 1))
gmsh.model.occ.fragment([(3, left)], [(3, right)])
gmsh.model.occ.synchronize()
volumes = sorted(tag for _, tag in gmsh.model.getEntities(3))
gmsh.model.addPhysicalGroup(3, volumes[:1], tag=7, name="zone")
gmsh.model.addPhysicalGroup(3, volumes[1:], tag=3, name="axon")
gmsh.model.addPhysicalGroup(2, [tag for _, tag in gmsh.model.getEntities(2)], tag=5, name="skin")
gmsh.option.setNumber("Mesh.MeshSizeMax", 0.7)
gmsh.model.mesh.generate(3)
gmsh.write("new.msh")
gmsh.option.setNumber("Mesh.MshFileVersion", 2.2)
gmsh.write("old.msh")

corners = [gmsh.model.mesh.getElements(3, tag)[2][0].reshape(-1, 4).astype(int) - 1 for tag in volumes]
tags, places, _ = gmsh.model.mesh.getNodes()
points = numpy.zeros((len(tags), 3))
points[tags.astype(int) - 1] = places.reshape(-1, 3)
numbers = numpy.repeat([7, 3], [len(part) for part in corners])
meshio.write_points_cells(
    "cells.vtu", points, [("tetra", numpy.concatenate(corners))], cell_data={"mat_id": [numbers]}
)
print("FOUND zone and axon:", *(len(part) for part in corners))
PY
cat > read.py <<'PY'
import numpy
from sfepy.discrete.fem import Mesh

found = {}
for path in ("new.msh", "old.msh", "cells.vtu"):
    mesh = Mesh.from_file(path)
    numbers, counts = numpy.unique(mesh.cmesh.cell_groups, return_counts=True)
    found[path] = dict(zip(numbers.tolist(), counts.tolist()))
    print("FOUND", path, found[path])
axon, zone = found["cells.vtu"][3], found["cells.vtu"][7]
assert set(found["new.msh"]) == {1, 2, 4} and found["new.msh"][4] == zone
assert found["new.msh"][1] < axon and found["new.msh"][1] + found["new.msh"][2] == axon
assert found["old.msh"] == {1: axon + zone}
PY
env/bin/python make.py > out 2>&1 && env/bin/python read.py >> out 2>&1 || { cat out; exit 1; }
sed -n 's/^FOUND //p' out
