#!/usr/bin/env bash
# netpyne 1.1.1 turns the sign of y of a cell's place, and not that of its form: pictures and fields are no mirror image.
#
# A cell at y = 200 µm, with a dendrite that goes from its soma towards larger y, 5 to 25 µm. In NEURON the soma is at
# y = −200 and the dendrite goes from −195 to −175; tags of the cell say y = 200 still.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"${PYTHON:-python3}" -m venv env
env/bin/pip install -q netpyne==1.1.1 neuron==9.0.2

cat > place.py <<'PY'
from netpyne import sim, specs

network = specs.NetParams()
network.popParams["cells"] = {"cellType": "cell", "cellsList": [{"x": 100, "y": 200, "z": 300}]}
soma = {"geom": {"pt3d": [(0, -5, 0, 10), (0, 5, 0, 10)]}, "mechs": {}}
dendrite = {
    "geom": {"pt3d": [(0, 5, 0, 2), (0, 25, 0, 2)]},
    "topol": {"parentSec": "soma", "parentX": 1.0, "childX": 0.0},
    "mechs": {},
}
network.cellParams["cell"] = {"conds": {"cellType": "cell"}, "secs": {"soma": soma, "dendrite": dendrite}}
sim.create(network, specs.SimConfig())
cell = sim.net.cells[0]


def ends(name):
    section = cell.secs[name]["hObj"]
    return [(section.x3d(i), section.y3d(i), section.z3d(i)) for i in range(section.n3d())]


print("FOUND tags:", [cell.tags[axis] for axis in "xyz"])
print("FOUND soma:", ends("soma"), "dendrite:", ends("dendrite"))
assert [cell.tags[axis] for axis in "xyz"] == [100, 200, 300]
assert ends("soma") == [(100, -205, 300), (100, -195, 300)]
assert ends("dendrite") == [(100, -195, 300), (100, -175, 300)]
PY
env/bin/python place.py > out 2>&1 || { cat out; exit 1; }
sed -n 's/^FOUND //p' out
