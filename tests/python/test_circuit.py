"""Circuits as tables, their cells and recordings."""

from __future__ import annotations

import json
import pickle
import shutil
from pathlib import Path

import neurotess as nt
import numpy as np
import pytest

pandas = pytest.importorskip("pandas")


@pytest.fixture(scope="module")
def circuit(circuit_folder: Path) -> nt.Circuit:
    return nt.Circuit(circuit_folder)


@pytest.fixture(scope="module")
def two(circuit_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> nt.Circuit:
    """The same cells in two populations: the second has them 1000 µm aside."""
    h5py = pytest.importorskip("h5py")
    folder = tmp_path_factory.mktemp("two") / "circuit"
    shutil.copytree(circuit_folder, folder)
    with h5py.File(folder / "nodes.h5", "a") as file:
        [name] = file["nodes"]
        file.copy(f"nodes/{name}", file["nodes"], "other")
        file["nodes/other/0/x"][:] += 1000
    config = json.loads((folder / "circuit_config.json").read_text())
    populations = config["networks"]["nodes"][0]["populations"]
    populations["other"] = next(iter(populations.values()))
    (folder / "circuit_config.json").write_text(json.dumps(config))
    return nt.Circuit(folder)


def test_ids_of_several_populations_are_told_apart(two: nt.Circuit) -> None:
    first, second = two.populations
    frame = two.nodes[(two.nodes.population == second) & (two.nodes.node_id < 3)]
    pairs = [(second, 0), (second, 1), (second, 2)]
    for nodes, population in [(frame, None), (pairs, None), ([0, 1, 2], second), ("0-2", second), (frame.node_id, second)]:
        selected = two.select(nodes, population=population)
        assert selected.population.tolist() == [second] * 3 and selected.node_id.tolist() == [0, 1, 2]
    both = two.select([(first, 5), (second, 7)])
    assert both.population.tolist() == [first, second] and both.node_id.tolist() == [5, 7]
    assert len(two.select(frame, population=first)) == 0
    for ambiguous in (frame.node_id, [0], "0", np.array([0, 1])):
        for use in (two.select, two.mesh, lambda nodes: nt.render(two, nodes=nodes, size=(16, 16))):
            with pytest.raises(ValueError, match=f"several populations have a node 0 .{first}, {second}.: give population="):
                use(ambiguous)
    with pytest.raises(ValueError, match="several populations"):
        two.morphology(3)
    with pytest.raises(KeyError, match="no node 99 in 'other'"):
        two.select([0, 99], population=second)
    with pytest.raises(KeyError, match="no node -1"):
        two.select([-1], population=second)
    with pytest.raises(ValueError, match="no population 'third'"):
        two.select([("third", 0)])
    with pytest.raises(ValueError, match="0.5 is no id"):
        two.select([0.5], population=second)  # type: ignore[list-item]
    with pytest.raises(ValueError, match="the column 'node_id'"):
        two.select(frame[["x", "y"]])


def test_meshes_and_pictures_are_of_the_population_that_is_meant(two: nt.Circuit) -> None:
    first, second = two.populations
    made = list(two.mesh([(second, 4), (first, 4)], level=1))
    assert [(one.population, one.node_id) for one in made] == [(first, 4), (second, 4)]
    meshes = [one.mesh for one in made if one.mesh is not None]
    assert meshes[1].vertices[:, 0] == pytest.approx(meshes[0].vertices[:, 0] + 1000, abs=1e-2)
    assert (meshes[1].point_index == meshes[0].point_index).all()
    here, there = ({"nodes": [(name, 4)], "size": (64, 48), "samples": 1, "legend": False} for name in (first, second))
    # The camera fits what is drawn, so a cell alone looks alike wherever it is.
    assert (np.asarray(nt.render(two, **here)) == np.asarray(nt.render(two, **there))).mean() > 0.98
    frame = two.nodes[two.nodes.node_id == 4]
    apart = np.asarray(nt.render(two, **{**here, "nodes": frame}))
    assert (apart != np.asarray(nt.render(two, **here))).any()
    region = ((900.0, -1e6, -1e6), (2000.0, 1e6, 1e6))
    within = np.asarray(nt.render(two, **{**here, "nodes": frame, "region": region}))
    assert (within == np.asarray(nt.render(two, **there))).all()


def test_sections_of_reports_are_those_of_meshes(circuit: nt.Circuit) -> None:
    name = next(name for name, path in circuit.reports.items() if not nt.Report(path).is_of_spikes)
    report, differ = circuit.report(name), 0
    for node in report.node_ids.tolist()[:4]:
        [one] = circuit.mesh([node], level=1)
        mesh, table = one.mesh, report.compartments(node)
        assert mesh is not None and mesh.cell is not None
        sections = [(0, None), *((section.id + 1, section.type) for section in mesh.cell.sections)]
        # NEURON's order: the axon, basal dendrites, apical ones, the rest.
        order = sorted(sections[1:], key=lambda pair: (min(int(pair[1] or 0), 5), pair[0]))
        assert table.section.tolist() == [[0, *(number for number, _ in order)][n] for n in table.neuron_section]
        assert [s.neuron_section for s in mesh.cell.sections] == [1 + [n for n, _ in order].index(k) for k, _ in sections[1:]]
        differ += int((table.section != table.neuron_section).sum())
        rows = mesh.compartments(report, node)
        assert rows.min() >= 0 and (table.section.to_numpy()[rows] == mesh.section).all()
        assert report.at(report.times[0], node)[rows].shape == (len(mesh.vertices),)
        table_rows = mesh.cell.compartments(report, node)
        of_soma = len(mesh.cell.to_table()) - len(mesh.cell)
        of_points = table.section.to_numpy()[table_rows]
        assert (of_points[:of_soma] == 0).all()
        numbers = [s.id + 1 for s in mesh.cell.sections for _ in s.points]
        assert of_points[of_soma:].tolist() == numbers
        # A vertex is not far from its sample.
        assert (table_rows[mesh.sample_index] == rows).mean() > 0.8
        alone = nt.Report(report.path)
        assert list(alone.compartments(node).columns) == ["along", "neuron_section"]
        assert alone.compartments(node, cell=mesh.cell).equals(table)
        assert (mesh.compartments(alone, node) == rows).all()
    assert differ > 0
    with pytest.warns(nt.NeurotessWarning, match="compartments are of sections that .* does not have, as section 2"):
        other = circuit.report(name).compartments(int(report.node_ids[0]), cell=nt.read(b"1 1 0 0 0 5 -1\n2 3 0 9 0 1 1\n"))
    assert set(other.section) == {-1, 0, 1}
    assert pickle.loads(pickle.dumps(report)).compartments(0).equals(report.compartments(0))


def test_places_between_compartments_have_the_nearest(circuit: nt.Circuit) -> None:
    from neurotess._places import nearest_compartments

    section, along = np.array([0, 2, 2, 1]), np.array([0.5, 0.25, 0.75, 0.5])
    places = [(0, 0.5), (1, 0.0), (1, 1.0), (2, 0.0), (2, 0.49), (2, 0.51), (2, 1.0), (3, 0.0)]
    found = nearest_compartments(section, along, *map(np.array, zip(*places, strict=True)))
    assert found.tolist() == [0, 3, 3, 1, 1, 2, 2, -1]
    nothing = nearest_compartments(section[:0], along[:0], np.array([1]), np.array([0.5]))
    assert nothing.tolist() == [-1]


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
    circuit: nt.Circuit, tmp_path: Path
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
