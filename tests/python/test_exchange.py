"""Cells of other packages, there and back."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import neurotess as nt
import numpy as np
import pytest

KINDS = ["granule", "pyramidal", "star"]


@pytest.fixture(params=KINDS)
def cell(request: pytest.FixtureRequest, samples: Path) -> nt.Morphology:
    return nt.read(samples / f"{request.param}.swc")


def same(a: nt.Morphology, b: nt.Morphology) -> None:
    assert np.allclose(a.points, b.points, atol=1e-4) and np.allclose(a.radii, b.radii, atol=1e-4)
    assert (a.types == b.types).all() and (a.parents == b.parents).all()
    assert a.soma is not None and b.soma is not None
    assert np.allclose(a.soma.center, b.soma.center, atol=1e-4)
    assert a.soma.radius == pytest.approx(b.soma.radius, abs=1e-4)
    assert nt.mesh(a, level=1).volume == pytest.approx(nt.mesh(b, level=1).volume, rel=1e-4)


@pytest.mark.full
def test_navis(cell: nt.Morphology) -> None:
    pytest.importorskip("navis")
    neuron = cell.to_navis()
    assert neuron.n_nodes == len(cell.to_table()) and str(neuron.units) == "1 micrometer"
    # The way from the soma to the neurites is in navis' length.
    assert neuron.cable_length >= cell.measures()["length"]
    same(nt.Morphology.from_navis(neuron), cell)


@pytest.mark.full
@pytest.mark.parametrize("length", [10, 30, 80])
def test_twigs_are_those_of_navis(cell: nt.Morphology, length: float) -> None:
    navis = pytest.importorskip("navis")
    theirs = navis.prune_twigs(cell.to_navis(), length, inplace=False)
    ours = nt.edit(cell, prune=length)
    # navis also takes samples of a soma for twigs.
    assert set(ours.samples.tolist()) == set(theirs.nodes.node_id) & set(cell.samples.tolist())
    assert length < 80 or len(ours) < len(cell)


@pytest.mark.full
def test_units_of_navis_are_taken_into_account(cell: nt.Morphology) -> None:
    navis = pytest.importorskip("navis")
    neuron = cell.to_navis()
    table = neuron.nodes.copy()
    for column in ("x", "y", "z", "radius"):
        table[column] *= 1000 / 8
    in_voxels = navis.TreeNeuron(table, units="8 nm", name="voxels")
    same(nt.Morphology.from_navis(in_voxels), cell)
    without = navis.TreeNeuron(neuron.nodes.copy(), name="without")
    with pytest.warns(nt.NeurotessWarning, match="no units"):
        same(nt.Morphology.from_navis(without), cell)


@pytest.mark.full
def test_morphio(cell: nt.Morphology) -> None:
    morphio = pytest.importorskip("morphio")
    theirs = cell.to_morphio()
    assert len(theirs.sections) == len(cell.sections)
    same(nt.Morphology.from_morphio(theirs), cell)
    same(nt.Morphology.from_morphio(morphio.mut.Morphology(theirs)), cell)


@pytest.mark.full
def test_libneuroml_reads_what_is_written(cell: nt.Morphology, tmp_path: Path) -> None:
    pytest.importorskip("neuroml")
    from neuroml.loaders import NeuroMLLoader
    from neuroml.utils import validate_neuroml2

    path = str(tmp_path / "cell.nml")
    cell.save(path)
    # It raises where the schema is not kept to.
    validate_neuroml2(path)
    theirs = NeuroMLLoader.load(path).cells[0]
    soma = set(theirs.get_all_segments_in_group("soma_group"))
    others = [s.id for s in theirs.morphology.segments if s.id not in soma]
    length = sum(theirs.get_segment_length(segment) for segment in others)
    assert length == pytest.approx(cell.measures()["length"], rel=1e-5)


@pytest.mark.full
def test_neurom(cell: nt.Morphology) -> None:
    neurom = pytest.importorskip("neurom")
    theirs = cell.to_neurom()
    assert theirs.name == cell.name
    length = neurom.get("total_length", theirs)
    assert length == pytest.approx(cell.measures()["length"], rel=1e-4)
    sections = [section.length for section in cell.sections]
    assert np.allclose(sorted(neurom.get("section_lengths", theirs)), sorted(sections), rtol=1e-3)
    same(nt.Morphology.from_neurom(theirs), cell)


@pytest.mark.full
def test_morphio_reads_the_same_file_alike(samples: Path) -> None:
    morphio = pytest.importorskip("morphio")
    path = samples / "granule.swc"
    ours, theirs = nt.read(path), morphio.Morphology(str(path))
    made = nt.Morphology.from_morphio(theirs)
    assert np.allclose(made.points, ours.points, atol=1e-4)


@pytest.mark.full
def test_outlines_stay_outlines() -> None:
    pytest.importorskip("morphio")
    ring = [(np.cos(a) * 5, np.sin(a) * 5) for a in np.linspace(0, 2 * np.pi, 12, endpoint=False)]
    rows = [f"{i + 1} 1 {x} {y} 0 0 {i if i else -1}" for i, (x, y) in enumerate(ring)]
    rows += ["20 3 0 9 0 1 4", "21 3 0 20 0 1 20"]
    cell = nt.read("\n".join(rows).encode(), name="ring.swc")
    assert cell.soma is not None and cell.soma.kind == "contour"
    again = nt.Morphology.from_morphio(cell.to_morphio())
    assert again.soma is not None and again.soma.kind == "contour"
    assert again.soma.radius == pytest.approx(cell.soma.radius, rel=1e-4)


@pytest.mark.full
def test_meshes_go_to_navis() -> None:
    pytest.importorskip("navis")
    mesh = nt.mesh(nt.synth("granule", points=60), level=1)
    theirs = mesh.to_navis()
    assert theirs.n_vertices == len(mesh.vertices)


def test_packages_that_are_missing_are_named() -> None:
    from neurotess._packages import needed

    with pytest.raises(ImportError, match="pip install 'neurotess\\[view\\]'"):
        needed("no_such_package", "view")


def test_packages_are_named_as_pip_knows_them(monkeypatch: pytest.MonkeyPatch) -> None:
    import sys

    monkeypatch.setitem(sys.modules, "PIL.Image", None)
    picture = nt.Image(np.zeros((2, 3, 4), np.uint8))
    with pytest.raises(ImportError, match="pip install pillow"):
        picture.to_pillow()


@pytest.mark.full
def test_names_ids_and_connectors_come_and_go_with_navis(cell: nt.Morphology) -> None:
    navis = pytest.importorskip("navis")
    pandas = pytest.importorskip("pandas")
    neuron = cell.to_navis()
    node = int(cell.samples[3])
    row = {"connector_id": [7], "node_id": [node], "x": [1000.0], "y": [2000.0], "z": [3000.0], "type": ["pre"]}
    table = neuron.nodes.copy()
    table[["x", "y", "z", "radius"]] *= 1000
    in_nm = navis.TreeNeuron(table, units="1 nanometer", name="one", id=720575940)
    in_nm.connectors = pandas.DataFrame(row)
    ours = nt.Morphology.from_navis(in_nm)
    assert (ours.name, ours.id) == ("one", 720575940)
    assert ours.connectors is not None and ours.connectors[["x", "y", "z"]].to_numpy().tolist() == [[1.0, 2.0, 3.0]]
    import pickle

    theirs = pickle.loads(pickle.dumps(ours)).to_navis()
    assert (theirs.name, theirs.id) == ("one", 720575940)
    assert theirs.connectors.node_id.tolist() == [node] and theirs.connectors.x.tolist() == [1.0]
    with pytest.warns(nt.NeurotessWarning, match="connectors are left out"):
        moved = nt.edit(ours, recenter=True)
    assert moved.connectors is None and moved.id == 720575940
    assert cell.to_navis().name == cell.name


@pytest.mark.full
def test_names_come_and_go_with_neurom_and_morphio(samples: Path) -> None:
    neurom = pytest.importorskip("neurom")
    cell = nt.read(samples / "granule.swc")
    assert nt.Morphology.from_neurom(cell.to_neurom()).name == cell.name == "granule"
    assert nt.Morphology.from_neurom(neurom.load_morphology(str(samples / "granule.swc"))).name.startswith("granule")
    assert nt.Morphology.from_morphio(cell.to_morphio(), name="granule").name == "granule"


@pytest.mark.full
def test_cells_of_other_packages_are_taken_as_they_are(cell: nt.Morphology) -> None:
    navis = pytest.importorskip("navis")
    pytest.importorskip("neurom")
    ours = nt.mesh(cell, level=1)
    others = [cell.to_navis(), cell.to_morphio(), cell.to_neurom()]
    for theirs in others:
        assert nt.mesh(theirs, level=1).volume == pytest.approx(ours.volume, rel=1e-4)
        assert nt.edit(theirs, scale=2).points == pytest.approx(2 * cell.points, abs=1e-3)
        assert nt.diff(theirs, cell, tolerance=1e-3)["moved"]["count"] == 0
    options = {"size": (64, 48), "samples": 1, "legend": False, "color_by": "neuron"}
    drawn = [np.asarray(nt.render(what, **options)) for what in (cell, others[0], [others[0]], navis.NeuronList(others[0]))]
    assert all((picture == drawn[0]).mean() > 0.98 for picture in drawn)
    for many in (others, navis.NeuronList([others[0], others[0]]), others[0]):
        assert all(result.ok for result in nt.mesh_many(many, level=1))
    with pytest.raises(TypeError, match="MeshNeuron of navis has no tracing"):
        nt.mesh(ours.to_navis())


@pytest.mark.full
def test_surfaces_of_other_packages_are_judged_and_drawn(cell: nt.Morphology) -> None:
    trimesh, pyvista, navis = (pytest.importorskip(name) for name in ("trimesh", "pyvista", "navis"))
    mesh = nt.mesh(cell, level=1)
    theirs = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
    drawn = []
    for surface in (theirs, pyvista.wrap(theirs), navis.MeshNeuron(theirs)):
        assert nt.check(surface)["volume"] == pytest.approx(mesh.volume)
        drawn.append(np.asarray(nt.render(surface, size=(64, 48), samples=1)))
    assert (drawn[0] == drawn[1]).all() and (drawn[0] == drawn[2]).all()


@pytest.mark.full
def test_cells_of_neuron_come_with_their_sections(samples: Path) -> None:
    neuron = pytest.importorskip("neuron")
    h = neuron.h
    h.load_file("stdlib.hoc")
    h.load_file("import3d.hoc")
    ours = nt.read(samples / "pyramidal.swc")
    reader = h.Import3d_SWC_read()
    reader.input(str(samples / "pyramidal.swc"))
    h.Import3d_GUI(reader, 0).instantiate(None)
    sections = list(h.allsec())
    cell = nt.Morphology.from_neuron(h.allsec())
    assert len(cell) == len(ours) and len(cell.sections) == len(ours.sections)
    assert sum(s.length for s in cell.sections) == pytest.approx(sum(s.length for s in ours.sections))
    assert nt.mesh(sections[0], level=1).closed, "a section stands for its tree"
    # NEURON's own rule for the number of segments.
    table = ours.section_table(Ra=sections[0].Ra, cm=sections[0].cm)
    counts = dict(zip(table["neuron_section"].tolist(), table["nseg"].tolist(), strict=True))
    dendrites = [section for section in sections if "soma" not in section.name()]

    def constant(section: Any) -> float:
        points = range(1, int(section.n3d()))
        total = sum(
            (section.arc3d(i) - section.arc3d(i - 1)) / np.sqrt(section.diam3d(i - 1) + section.diam3d(i)) for i in points
        )
        return float(section.L / (total * np.sqrt(2) * 1e-5 * np.sqrt(4 * np.pi * 100 * section.Ra * section.cm)))

    for number, section in enumerate(dendrites, 1):
        assert counts[number] == int((section.L / (0.1 * constant(section)) + 0.9) / 2) * 2 + 1
    # Numbers of sections and segments are those of the points that lie there.
    dendrites[3].nseg = 3
    values = cell.neuron_values({"soma[0]": -65.0, dendrites[3]: [1.0, 2.0, 3.0]})
    types = cell.to_table()["type"]
    assert set(values[types == 1]) == {-65.0} and set(values[types != 1][np.isfinite(values[types != 1])]) == {1.0, 2.0, 3.0}
    assert cell.neuron_values({"soma[0]": np.zeros((1, 5))}).shape == (len(types), 5)
    with pytest.raises(ValueError, match="has no section 'dent'"):
        cell.neuron_values({"dent": 1.0})
    with pytest.raises(ValueError, match="is not of NEURON"):
        ours.neuron_values({"soma": 1.0})
    bare = h.Section(name="bare")
    with pytest.raises(ValueError, match="section bare has no 3D points: call h.define_shape"):
        nt.Morphology.from_neuron([bare])
