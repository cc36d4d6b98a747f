#!/usr/bin/env bash
# What dolfinx 0.11.0 makes of a mesh of Gmsh 4.15.2 with physical groups.
#
# A box of two regions; the right one is physical group 1, the left one group 2, though the left one comes first in the
# file; surfaces have groups 1 and 2, too.
#
#   original_cell_index    is no index into Gmsh's elements as the file has them: cells are counted group by group, in the
#                          order of the groups' numbers, and within a group entity by entity. Here it is wrong for all
#                          cells; through the groups it is right for all
#   physical_groups        is keyed by name: of a volume and a surface of one name, one is lost without a word
#   tags                   1 and 2 are volumes in cell_tags, and surfaces in facet_tags
#   read_from_msh          ends the caller's session of Gmsh: gmsh.isInitialized() is 0 afterwards
#
# The wheel is dolfinx-solver-real 0.11.0.post0 for Python 3.12 or newer (Linux, x86-64).
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
newer() { # a Python that dolfinx has wheels for
    local python
    for python in "${PYTHON:-python3}" python3.12 python3.13 "$HOME"/.pyenv/versions/3.1[2-9]*/bin/python; do
        "$python" -c 'import sys; sys.exit(sys.version_info < (3, 12))' 2> errors && echo "$python" && return
    done
    echo "dolfinx 0.11.0 needs Python 3.12 or newer" >&2
    return 1
}
python=$(newer)
"$python" -m venv env
env/bin/pip install -q dolfinx-solver-real==0.11.0.post0 gmsh==4.15.2

cat > order.py <<'PY'
from mpi4py import MPI  # before dolfinx

import gmsh
import numpy
from dolfinx.io.gmsh import read_from_msh

gmsh.initialize()
gmsh.option.setNumber("General.Verbosity", 0)
left, right = (gmsh.model.occ.addBox(x, 0, 0, 1, 1, 1) for x in (0, 1))
gmsh.model.occ.fragment([(3, left)], [(3, right)])
gmsh.model.occ.synchronize()
first, second = sorted(tag for _, tag in gmsh.model.getEntities(3))
outer = [tag for _, tag in gmsh.model.getEntities(2) if len(gmsh.model.getAdjacencies(2, tag)[0]) == 1]
gmsh.model.addPhysicalGroup(3, [second], tag=1, name="right")
gmsh.model.addPhysicalGroup(3, [first], tag=2, name="left")
gmsh.model.addPhysicalGroup(2, outer[:5], tag=1, name="skin")
gmsh.model.addPhysicalGroup(2, outer[5:], tag=2, name="right")
gmsh.option.setNumber("Mesh.MeshSizeMax", 0.6)
gmsh.model.mesh.generate(3)
gmsh.write("boxes.msh")


def middles(entities):
    """The middle of each tetrahedron of these volumes, in this order."""
    tags, places, _ = gmsh.model.mesh.getNodes()
    place = numpy.zeros((int(tags.max()) + 1, 3))
    place[tags] = places.reshape(-1, 3)
    corners = [gmsh.model.mesh.getElements(3, entity)[2][0].reshape(-1, 4) for entity in entities]
    return place[numpy.concatenate(corners)].mean(axis=1)


by_file, by_group = middles([first, second]), middles([second, first])
read = read_from_msh("boxes.msh", MPI.COMM_SELF)
print("Gmsh still there:", bool(gmsh.isInitialized()))
assert not gmsh.isInitialized()

mesh = read.mesh
middle = mesh.geometry.x[mesh.geometry.dofmaps[0]].mean(axis=1)
index = mesh.topology.original_cell_index
for name, order, expected in (("by file", by_file, 0), ("group by group", by_group, 1)):
    right = (numpy.abs(order[index] - middle).max(axis=1) < 1e-9).mean()
    print(f"original_cell_index {name}: right for {right:.0%} of {len(index)} cells")
    assert right == expected

print({name: tuple(group) for name, group in read.physical_groups.items()})
assert {name: tuple(group) for name, group in read.physical_groups.items()} == {
    "skin": (2, 1),
    "right": (3, 1),
    "left": (3, 2),
}
assert set(read.facet_tags.values) == {1, 2} == set(read.cell_tags.values)
PY
env/bin/python order.py 2> errors || { cat errors; exit 1; }
