"""Circuits as tables, their cells and recordings."""

from __future__ import annotations

import pickle
from pathlib import Path

import neurotess as nt
import numpy as np
import pytest

pandas = pytest.importorskip("pandas")


@pytest.fixture(scope="module")
def circuit(circuit_folder: Path) -> nt.Circuit:
    return nt.Circuit(circuit_folder)


def test_nodes_are_a_table(circuit: nt.Circuit) -> None:
    nodes = circuit.nodes
    assert len(nodes) == len(circuit) == 12
    assert {"population", "node_id", "x", "y", "z", "rotation_w", "morphology"} <= set(nodes.columns)
    assert nodes.population.unique().tolist() == circuit.populations
    assert nodes.node_id.tolist() == list(range(12))
    assert nodes.morphology.map(lambda path: Path(path).is_file()).all()
    norm = np.linalg.norm(nodes[[f"rotation_{part}" for part in "wxyz"]], axis=1)
    assert np.allclose(norm, 1)
    changed = circuit.nodes
    changed["x"] = 0.0
    assert (circuit.nodes.x == nodes.x).all()


@pytest.mark.full
def test_libsonata_has_the_same_nodes(circuit: nt.Circuit, circuit_folder: Path) -> None:
    libsonata = pytest.importorskip("libsonata")
    [file] = [path for path in circuit_folder.rglob("*.h5") if "nodes" in path.name]
    population = libsonata.NodeStorage(str(file)).open_population(circuit.populations[0])
    everything = population.select_all()
    for axis in "xyz":
        assert np.allclose(population.get_attribute(axis, everything), circuit.nodes[axis])


def test_nodes_are_selected(circuit: nt.Circuit) -> None:
    assert circuit.select([3, 5]).node_id.tolist() == [3, 5]
    assert len(circuit.select(sample=4)) == 4
    assert circuit.select(sample=4).equals(circuit.select(sample=4))
    low, high = circuit.nodes[["x", "y", "z"]].min(), circuit.nodes[["x", "y", "z"]].max()
    assert len(circuit.select(region=(low, high))) == 12
    assert len(circuit.select(population=circuit.populations[0])) == 12
    with pytest.raises(ValueError, match="no_such"):
        circuit.select(population="no_such")
    with pytest.raises(ValueError, match="no_such"):
        circuit.select(node_set="no_such")


def test_cells_are_placed(circuit: nt.Circuit) -> None:
    cell = circuit.morphology(4)
    matrix = circuit.placement(4)
    assert matrix.shape == (4, 4) and np.allclose(matrix[3], [0, 0, 0, 1])
    assert np.linalg.det(matrix[:3, :3]) == pytest.approx(1)
    assert cell.soma is not None
    soma = matrix @ [*cell.soma.center, 1]
    assert np.allclose(soma[:3], circuit.nodes.loc[4, ["x", "y", "z"]].astype(float))
    with pytest.raises(KeyError, match="no node 99"):
        circuit.morphology(99)


def test_meshes_are_in_the_coordinates_of_the_circuit(circuit: nt.Circuit) -> None:
    made = list(circuit.mesh([0, 7], level=1))
    assert [one.node_id for one in made] == [0, 7] and all(one.ok for one in made)
    for one in made:
        assert one.mesh is not None and one.mesh.closed
        matrix = circuit.placement(one.node_id)
        alone = nt.mesh(circuit.morphology(one.node_id), level=1)
        moved = alone.vertices @ matrix[:3, :3].T + matrix[:3, 3]
        assert np.allclose(one.mesh.vertices, moved, atol=1e-2)
    with pytest.raises(ValueError, match="level"):
        circuit.mesh([0], level=100)


def test_reports_are_read(circuit: nt.Circuit) -> None:
    name = next(name for name, path in circuit.reports.items() if not nt.Report(path).is_of_spikes)
    report = circuit.report(name)
    assert report.times[0] >= 0 and np.all(np.diff(report.times) > 0)
    node = int(report.node_ids[0])
    values = report.values(node)
    table = report.compartments(node)
    assert values.shape == (len(report.times), len(table))
    assert (report.at(report.times[2], node) == values[2]).all()
    half = report.values(node, start=float(report.times[1]), stop=float(report.times[3]))
    assert (half == values[1:3]).all()
    assert report.values().shape[1] == report.offsets[-1]
    with pytest.raises(KeyError, match="no values of node 10000"):
        report.values(10_000)
    with pytest.raises(ValueError, match="no frame"):
        report.at(-1.0)
    assert pickle.loads(pickle.dumps(report)).units == report.units


@pytest.mark.full
def test_reports_agree_with_libsonata(circuit: nt.Circuit) -> None:
    libsonata = pytest.importorskip("libsonata")
    path = next(path for path in circuit.reports.values() if not nt.Report(path).is_of_spikes)
    report = nt.Report(path)
    reader = libsonata.ElementReportReader(path)
    theirs = reader[report.population].get(node_ids=[int(report.node_ids[0])])
    assert np.allclose(theirs.data, report.values(int(report.node_ids[0])), atol=1e-5)


def test_spikes_are_a_table(circuit: nt.Circuit) -> None:
    paths = [path for path in circuit.reports.values() if nt.Report(path).is_of_spikes]
    spikes = nt.Report(paths[0]).spikes
    assert set(spikes.columns) == {"time", "node_id"} and spikes.time.is_monotonic_increasing
    assert spikes.node_id.isin(circuit.nodes.node_id).all()
    with pytest.raises(ValueError, match="spikes"):
        nt.Report(paths[0]).values()


def test_circuits_that_are_none_are_read_errors(tmp_path: Path) -> None:
    with pytest.raises(nt.ReadError):
        nt.Circuit(tmp_path)
    (tmp_path / "circuit_config.json").write_text("{\n  broken\n}")
    with pytest.raises(nt.ReadError) as caught:
        nt.Circuit(tmp_path / "circuit_config.json")
    assert caught.value.line == 2


def test_circuits_are_pickled(circuit: nt.Circuit) -> None:
    assert len(pickle.loads(pickle.dumps(circuit))) == len(circuit)


def test_synapses_are_a_table_and_drawn(
    circuit: nt.Circuit, can_draw: bool, tmp_path: Path
) -> None:
    [edges] = circuit.edges.name
    synapses = circuit.synapses(edges, numbers=["delay"])
    assert list(synapses.columns) == ["source", "target", "x", "y", "z", "delay"]
    assert len(synapses) == 12 * 9
    assert (synapses.groupby("target").size() == 9).all()
    assert (synapses.source != synapses.target).all() and (synapses.delay > 0.5).all()
    efferent = circuit.synapses(edges, side="efferent")
    assert list(efferent.columns) == ["source", "target"]
    with pytest.raises(ValueError, match="side"):
        circuit.synapses(edges, side="both")  # type: ignore[arg-type]
    with pytest.raises(nt.NeurotessError, match="no_such"):
        circuit.synapses(edges, numbers=["no_such"])
    options = {"size": (80, 60), "samples": 1, "legend": False, "nodes": [3]}
    plain, marked = (nt.render(circuit, synapses=shown, **options) for shown in (False, True))
    assert (np.asarray(plain) != np.asarray(marked)).any()
    dots = nt.render(circuit, synapses=True, marker_shape="point", **options)
    discs = nt.render(circuit, synapses=True, marker_shape="contact", marker_size=9, **options)
    assert (np.asarray(plain) != np.asarray(dots)).any()
    assert (np.asarray(dots) != np.asarray(discs)).any()
    table = tmp_path / "points.csv"
    synapses[synapses.target == 3].to_csv(table, index=False)
    colored = nt.render(circuit, points=table, marker_color_by="delay", **options)
    assert (np.asarray(plain) != np.asarray(colored)).any()
