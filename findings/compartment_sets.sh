#!/usr/bin/env bash
# libsonata 0.2.2 reads compartment sets that name what is not there, and an empty selection selects all.
#
# A set lists places in cells (node, section, offset) for a report of type `compartment_set`. The form is checked (order,
# duplicates, offsets from 0 to 1), what it refers to is not:
#
#   a report of a set that no file has, in a `compartment_sets_file` that does not exist    taken
#   a node that the population does not have, a section that no cell has                   taken
#   set.filter(Selection([5])), where 5 is not in the set                                   0 of 3 places
#   set.filter(Selection([])), what a search without a hit gives                            3 of 3 places
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"${PYTHON:-python3}" -m venv env
env/bin/pip install -q libsonata==0.2.2 h5py

cat > sets.py <<'PY'
import json

import h5py
import libsonata


def write(name, content):
    with open(name, "w") as file:
        json.dump(content, file)


with h5py.File("nodes.h5", "w") as file:
    file["nodes/cells/node_type_id"] = [1]
    file["nodes/cells/0/x"] = [0.0]
nodes = {"nodes_file": "nodes.h5", "populations": {"cells": {"type": "virtual"}}}
write("circuit.json", {"version": 2, "networks": {"nodes": [nodes], "edges": []}, "components": {}})
report = {"type": "compartment_set", "compartment_set": "nowhere", "variable_name": "v", "dt": 0.1}
write(
    "simulation.json",
    {
        "version": 1,
        "network": "circuit.json",
        "run": {"tstop": 1.0, "dt": 0.1, "random_seed": 1},
        "compartment_sets_file": "missing.json",
        "reports": {"voltage": report | {"start_time": 0.0, "end_time": 1.0}},
    },
)
simulation = libsonata.SimulationConfig.from_file("simulation.json")
print("report of set:", simulation.report("voltage").compartment_set, "in", simulation.compartment_sets_file[-12:])
assert simulation.report("voltage").compartment_set == "nowhere"

write("sets.json", {"dendrites": {"population": "cells", "compartment_set": [[0, 0, 0.5], [7, 3, 0.25], [7, 900, 0.5]]}})
places = libsonata.CompartmentSets.from_file("sets.json")["dendrites"]
count = libsonata.CircuitConfig.from_file("circuit.json").node_population("cells").size
print("nodes of the population:", count, "nodes of the set:", places.node_ids().flatten().tolist())
assert count == 1 and places.node_ids().flatten().tolist() == [0, 7]

for chosen, expected in (([0], 1), ([5], 0), ([], 3)):
    found = places.filter(libsonata.Selection(chosen)).size()
    print("filter", chosen, "leaves", found)
    assert found == expected

for wrong in ([[1, 0, 0.5], [0, 0, 0.5]], [[0, 0, 0.5], [0, 0, 0.5]], [[0, 0, 1.5]]):
    try:
        libsonata.CompartmentSets(json.dumps({"set": {"population": "cells", "compartment_set": wrong}}))
        raise SystemExit(f"{wrong} is taken")
    except libsonata.SonataError:
        pass
PY
env/bin/python sets.py
