"""Small scripts as users write them, each from a file to a result, with numbers of their own.

What single functions do is tested beside them; these hold together what such a script needs.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import neurotess as nt

SMALL = {"size": (160, 120), "samples": 1, "legend": False}


@pytest.fixture(scope="module")
def cell() -> nt.Morphology:
    return nt.synth("pyramidal", seed=3, points=120)


def is_drawn(picture: nt.Image) -> bool:
    return bool((np.asarray(picture)[..., :3] < 200).any())


def test_numbers_of_points_are_on_the_membrane_and_in_files(cell: nt.Morphology, tmp_path: Path) -> None:
    per_point = np.sin(cell.path_distances() / 20)
    mesh = nt.mesh(cell, level=1)
    mesh = mesh.with_attribute("phase", np.append(per_point, np.nan)[mesh.point_index])
    mesh.save(tmp_path / "phase.vtu")
    read = nt.read_mesh(tmp_path / "phase.vtu")
    read.cell = cell
    on_neurites = read.point_index >= 0
    expected = per_point[read.point_index[on_neurites]].astype(np.float32)
    assert (read.attributes["phase"][on_neurites] == expected).all()
    assert np.isnan(read.attributes["phase"][~on_neurites]).all()


@pytest.mark.full
def test_a_recording_without_a_circuit_is_filmed_on_its_cell(circuit_folder: Path) -> None:
    circuit = nt.Circuit(circuit_folder)
    name = next(name for name, path in circuit.reports.items() if not nt.Report(path).is_of_spikes)
    report = nt.Report(circuit.reports[name])
    node = int(report.node_ids[0])
    alone = circuit.morphology(node)
    rows = alone.compartments(report, node)
    voltages = report.values(node)[:, rows]
    span = (float(report.times[0]), float(report.times[4]), float(report.times[1] - report.times[0]))
    frames = list(nt.film(alone, values=voltages, times=report.times, time=span, unit=report.units, **SMALL))
    assert len(frames) in (4, 5) and all(map(is_drawn, frames))
    # And one time of it on the mesh.
    mesh = nt.mesh(alone, level=1)
    at_once = report.at(report.times[2], node)[mesh.compartments(report, node)]
    assert is_drawn(mesh.render(values=at_once, title="voltage", unit=report.units, **SMALL))


def test_what_a_solver_finds_at_nodes_goes_back_onto_the_surface(cell: nt.Morphology) -> None:
    mesh = nt.mesh(cell, level=1)
    # Mesh generators add nodes within behind those of the surface.
    nodes = np.concatenate([mesh.vertices, mesh.vertices[::3] - 0.05 * mesh.normals[::3]])
    found = np.exp(-np.linalg.norm(nodes - cell.points[0], axis=1) / 30)
    solved = mesh.with_attribute("calcium", found[: len(mesh.vertices)])
    assert is_drawn(solved.render(values="calcium", unit="µM", **SMALL))


@pytest.mark.full
def test_trimesh_goes_in_and_out_with_its_numbers(cell: nt.Morphology) -> None:
    pytest.importorskip("trimesh")
    mesh = nt.mesh(cell, level=1)
    theirs = mesh.with_attribute("distance", mesh.path_distance).to_trimesh()
    ours = np.asarray(mesh.render(values=mesh.path_distance, **SMALL))
    assert (np.asarray(nt.render(theirs, values="distance", **SMALL)) == ours).all()
    assert (np.asarray(nt.render(theirs, values=mesh.path_distance, **SMALL)) == ours).all()


@pytest.mark.full
def test_one_figure_has_cells_and_a_mesh_with_numbers(cell: nt.Morphology) -> None:
    region = nt.Mesh.from_arrays([[0, 0, 0], [200, 0, 0], [0, 200, 0], [0, 0, 200]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    glass = {"mesh": region, "values": [0.0, 1.0, 2.0, 3.0], "opacity": 0.4}
    picture = nt.render(cell, meshes=glass, title="dose", unit="Gy", colormap=["#ffffcc", "#800026"], **SMALL)
    assert is_drawn(picture) and (np.asarray(picture) != np.asarray(nt.render(cell, **SMALL))).any()


def test_a_batch_of_meshes_keeps_a_number_for_each_vertex(tmp_path: Path) -> None:
    for seed in range(2):
        nt.synth("granule", seed=seed, points=60).save(tmp_path / f"{seed}.swc")
    for one in nt.mesh_many(tmp_path, level=1):
        assert one.ok
        far = one.mesh.with_attribute("distance", one.mesh.path_distance)
        far.save(tmp_path / f"{one.mesh.name}.ply")
    made = [nt.read_mesh(file) for file in sorted(tmp_path.glob("*.ply"))]
    assert len(made) == 2 and all(mesh.attributes["distance"].max() > 10 for mesh in made)


@pytest.mark.full
def test_a_mesh_is_turned_in_a_film_with_its_colors(cell: nt.Morphology) -> None:
    mesh = nt.mesh(cell, level=1)
    frames = list(nt.film(mesh, values="radius", turntable=True, frames=3, **SMALL))
    assert len(frames) == 3 and all(map(is_drawn, frames))
    assert (np.asarray(frames[0]) == np.asarray(mesh.render(values="radius", **SMALL))).mean() > 0.98
