#!/usr/bin/env bash
# A soma that was traced as an outline in ASC: its area depends on the program.
#
# An outline of twelve points, 10 µm by 5 µm (a prolate spheroid of these axes has 134 µm²):
#
#   NEURON 9.0.2    127.25 µm², a chain of cylinders along the longer axis
#   arbor 0.12.2    179.21 µm², a cylinder as long and wide as twice the mean distance from the center, without its ends
#   NeuroM 4.0.6    179.21 µm², a ball of the mean distance
#   MorphIO 3.5.0   no area: its `surface` raises
#   TMD 2.4.3       `get_diameter()` is 3.776: that is the mean distance, so the radius
#
# A soma in three outlines, one above the other, as tracers of sections write it: NEURON reads it, MorphIO, NeuroM and
# arbor refuse the file.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"${PYTHON:-python3}" -m venv env
env/bin/pip install -q neuron==9.0.2 morphio==3.5.0 neurom==4.0.6 arbor==0.12.2 TMD==2.4.3

cat > one.asc <<'ASC'
("CellBody" (CellBody)
 (5 0 0 0) (4 1.5 0 0) (2.5 2.165 0 0) (0 2.5 0 0) (-2.5 2.165 0 0) (-4 1.5 0 0) (-5 0 0 0)
 (-4 -1.5 0 0) (-2.5 -2.165 0 0) (0 -2.5 0 0) (2.5 -2.165 0 0) (4 -1.5 0 0))
((Dendrite) (6 0 0 2) (16 0 0 2))
ASC
cat > three.asc <<'ASC'
("CellBody" (CellBody) (4 0 -2 0) (0 2 -2 0) (-4 0 -2 0) (0 -2 -2 0))
("CellBody" (CellBody) (5 0 0 0) (0 2.5 0 0) (-5 0 0 0) (0 -2.5 0 0))
("CellBody" (CellBody) (4 0 2 0) (0 2 2 0) (-4 0 2 0) (0 -2 2 0))
((Dendrite) (6 0 0 2) (16 0 0 2))
ASC
cat > areas.py <<'PY'
import math
import warnings

warnings.simplefilter("ignore")
import arbor
import morphio
import neurom
import tmd
from neuron import h

h.load_file("import3d.hoc")
morphio.set_maximum_warnings(0)


class Cell:
    pass


def by_neuron(path):
    reader = h.Import3d_Neurolucida3()
    reader.quiet = 1
    reader.input(path)
    cell = Cell()
    h.Import3d_GUI(reader, 0).instantiate(cell)
    return sum(segment.area() for segment in cell.soma[0])


def by_arbor(path):
    tree = arbor.load_asc(path).morphology
    area = 0
    for branch in range(tree.num_branches):
        for segment in tree.branch_segments(branch):
            p, q = segment.prox, segment.dist
            if max(p.x, q.x) < 5.5:
                area += math.pi * (p.radius + q.radius) * math.dist((p.x, p.y, p.z), (q.x, q.y, q.z))
    return area


def show(program, found, expected):
    print(f"{program:18}{found:7.2f}")
    assert abs(found - expected) < 0.01, (program, expected)


show("NEURON, µm²", by_neuron("one.asc"), 127.25)
show("arbor, µm²", by_arbor("one.asc"), 179.21)
soma = neurom.load_morphology("one.asc").soma
show("NeuroM, µm²", soma.area, 179.21)
show("TMD, diameter", tmd.io.load_neuron_from_morphio("one.asc").soma.get_diameter(), 3.776)
show("NeuroM, radius", soma.radius, 3.776)


def refuses(program, read):
    try:
        read()
    except Exception as error:
        print(f"{program:18}{str(error).strip().splitlines()[-1]}")
        return
    raise SystemExit(f"{program} reads it")


refuses("MorphIO, surface", lambda: morphio.Morphology("one.asc").soma.surface)
print("three outlines:")
area = by_neuron("three.asc")
print(f"NEURON, µm²       {area:7.2f}")
assert area > 0
refuses("MorphIO", lambda: morphio.Morphology("three.asc"))
refuses("NeuroM", lambda: neurom.load_morphology("three.asc"))
refuses("arbor", lambda: arbor.load_asc("three.asc"))
PY
env/bin/python areas.py 2> errors || { cat errors; exit 1; }
