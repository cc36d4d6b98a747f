"""What libsonata and bluepysnap find in a circuit, as JSON.

read_circuit.py FOLDER [libsonata|bluepysnap]
"""

import json
import sys
from pathlib import Path

import numpy as np


def with_libsonata(folder):
    import libsonata

    config = libsonata.CircuitConfig.from_file(str(folder / "circuit_config.json"))
    (name,) = config.node_populations
    nodes = config.node_population(name)
    everyone = nodes.select_all()
    column = lambda attribute: np.asarray(nodes.get_attribute(attribute, everyone))
    sets = libsonata.NodeSets.from_file(config.node_sets_path)
    simulation = libsonata.SimulationConfig.from_file(str(folder / "simulation_config.json"))
    report = libsonata.ElementReportReader(simulation.report("voltage").file_name)[name]
    frame = report.get(tstart=10.0, tstop=10.0)
    spikes = libsonata.SpikeReader(simulation.output.spikes_file)[name].get()
    properties = config.node_population_properties(name)
    missing = [
        m
        for m in sorted(set(column("morphology")))
        if not Path(properties.morphologies_dir, f"{m}.swc").is_file()
    ]
    return {
        "n": nodes.size,
        "x": column("x").tolist(),
        "y": column("y").tolist(),
        "z": column("z").tolist(),
        "quaternion": np.stack([column(f"orientation_{c}") for c in "wxyz"], axis=1).tolist(),
        "morphology": column("morphology").tolist(),
        "layer": column("layer").tolist(),
        "layer_names": nodes.enumeration_values("layer"),
        "missing": missing,
        "sets": {n: sets.materialize(n, nodes).flatten().tolist() for n in sets.names},
        "times": list(report.times),
        "units": [report.data_units, report.time_units],
        "report_nodes": report.get_node_ids().tolist()
        if hasattr(report.get_node_ids(), "tolist")
        else list(report.get_node_ids()),
        "frame": np.asarray(frame.data[0], dtype=float).tolist(),
        "sections": [int(element) for _, element in np.asarray(frame.ids)],
        "spikes": [[float(t), int(n)] for n, t in spikes],
    }


def with_bluepysnap(folder):
    import bluepysnap

    circuit = bluepysnap.Circuit(str(folder / "circuit_config.json"))
    (name,) = circuit.nodes.population_names
    nodes = circuit.nodes[name]
    orientations = nodes.orientations()
    simulation = bluepysnap.Simulation(str(folder / "simulation_config.json"))
    report = simulation.reports["voltage"][name]
    return {
        "n": nodes.size,
        "rotation": np.stack(list(orientations)).tolist(),
        "upper": [int(i) for i in nodes.ids("Upper pyramidal")],
        "frame": report.get(t_start=10.0, t_stop=10.0).to_numpy(dtype=float).ravel().tolist(),
        "n_spikes": len(simulation.spikes[name].get()),
    }


reader = {"libsonata": with_libsonata, "bluepysnap": with_bluepysnap}[sys.argv[2]]
print(json.dumps(reader(Path(sys.argv[1]))))
