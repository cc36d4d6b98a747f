#!/usr/bin/env bash
# A node of a SONATA circuit that has a quaternion and angles: bluepysnap takes the one, bmtk the others.
#
# The cell is a dendrite that ends at (25, 0, 0). The quaternion turns it by 90° around z; the angle, where there is
# one, is 0° or 90°. Where the end is afterwards:
#
#                                bluepysnap 3.0.8   bmtk 1.2.0
#   quaternion, and angle 0°        (0, 25, 0)      (25, 0, 0)
#   quaternion alone                (0, 25, 0)      (25, 0, 0): bmtk does not read quaternions, without a word
#   angle 90° alone                 (0, 25, 0)      (0, 25, 0)
#
# bmtk's builder writes nodes with different attributes as groups of one population. Of such a file, libsonata 0.2.2 (and
# so bluepysnap) reads nothing: "Only single-group populations are supported at the moment".
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"${PYTHON:-python3}" -m venv a
"${PYTHON:-python3}" -m venv b
a/bin/pip install -q bmtk==1.2.0 neuron==9.0.2
b/bin/pip install -q bluepysnap==3.0.8 libsonata==0.2.2

cat > cell.hoc <<'HOC'
begintemplate Stick
public soma, dend, all
create soma[1], dend[1]
objref all
proc init() {
  soma[0] { pt3dclear() pt3dadd(-5, 0, 0, 10) pt3dadd(5, 0, 0, 10) }
  dend[0] { pt3dclear() pt3dadd(5, 0, 0, 2) pt3dadd(25, 0, 0, 2) }
  connect dend[0](0), soma[0](1)
  all = new SectionList()
  soma[0] all.append()
  dend[0] all.append()
}
endtemplate Stick
HOC
cat > build.py <<'PY'
import json
import math

from bmtk.builder import NetworkBuilder

half = math.sqrt(0.5)
turned = {"orientation_w": [half], "orientation_x": [0.0], "orientation_y": [0.0], "orientation_z": [half]}
network = NetworkBuilder("cells")
for rotation in (turned | {"rotation_angle_zaxis": [0.0]}, turned, {"rotation_angle_zaxis": [math.pi / 2]}):
    network.add_nodes(
        N=1, model_type="biophysical", model_template="own:Stick", x=[0.0], y=[0.0], z=[0.0], **rotation
    )
network.build()
network.save(output_dir="network", compression=None)
nodes = {"nodes_file": "network/cells_nodes.h5", "node_types_file": "network/cells_node_types.csv"}
simulation = {
    "run": {"tstop": 1.0, "dt": 0.1, "dL": 20.0, "spike_threshold": -15},
    "target_simulator": "NEURON",
    "conditions": {"celsius": 34.0, "v_init": -80},
    "output": {"output_dir": "out"},
    "networks": {"nodes": [nodes], "edges": []},
}
with open("bmtk.json", "w") as file:
    json.dump(simulation | {"inputs": {}, "components": {}}, file)
PY
cat > by_bmtk.py <<'PY'
from bmtk.simulator import bionet
from bmtk.simulator.bionet.pyfunction_cache import add_cell_model
from neuron import h

h.load_file("cell.hoc")


def stick(cell, template, parameters):
    return h.Stick()


add_cell_model(stick, directive="own:Stick", model_type="biophysical")
network = bionet.BioNetwork.from_config(bionet.Config.from_json("bmtk.json"))
network.build()
ends = [cell.seg_coords.p1[:, -1].round(3).tolist() for _, cell in sorted(network.get_local_cells().items())]
print("bmtk", ends)
assert ends == [[25, 0, 0], [25, 0, 0], [0, 25, 0]]
PY
cat > by_snap.py <<'PY'
import json
import math

import bluepysnap
import h5py
import libsonata

half = math.sqrt(0.5)
turned = {"orientation_w": half, "orientation_x": 0.0, "orientation_y": 0.0, "orientation_z": half}
ends = []
for rotation in (turned | {"rotation_angle_zaxis": 0.0}, turned, {"rotation_angle_zaxis": math.pi / 2}):
    with h5py.File("nodes.h5", "w") as file:
        file["nodes/cells/node_type_id"] = [1]
        for name, value in (rotation | {"x": 0.0, "y": 0.0, "z": 0.0}).items():
            file[f"nodes/cells/0/{name}"] = [value]
    nodes = {"nodes_file": "nodes.h5", "populations": {"cells": {"type": "point_neuron"}}}
    with open("snap.json", "w") as file:
        json.dump({"version": 2, "networks": {"nodes": [nodes], "edges": []}, "components": {}}, file)
    matrix = bluepysnap.Circuit("snap.json").nodes["cells"].orientations(0)
    ends.append((matrix @ [25, 0, 0]).round(3).tolist())
print("bluepysnap", ends)
assert ends == [[0, 25, 0]] * 3

try:
    libsonata.NodeStorage("network/cells_nodes.h5").open_population("cells")
    raise SystemExit("libsonata reads several groups")
except libsonata.SonataError as error:
    print("libsonata, three groups:", error)
PY
a/bin/python build.py > out 2>&1 || { cat out; exit 1; }
a/bin/python by_bmtk.py > out 2> errors || { cat errors; exit 1; }
grep "^bmtk" out
b/bin/python by_snap.py 2> errors || { cat errors; exit 1; }
