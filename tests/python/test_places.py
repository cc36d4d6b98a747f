"""Where on its cell a mesh is, and numbers of one's own on it."""

from __future__ import annotations

import json
import pickle
import sys
from pathlib import Path
from typing import Any

import neurotess as nt
import numpy as np
import pytest

#: A dendrite before an axon, numbers with gaps, a fork.
CELL = b"""1 1 0 0 0 5 -1
20 3 0 10 0 1 1
21 3 0 40 0 1 20
30 3 20 60 0 1 21
31 3 -20 60 0 1 21
40 2 0 -10 0 1 1
41 2 0 -50 0 1 40
"""


@pytest.fixture(scope="module")
def cell() -> nt.Morphology:
    return nt.read(CELL)


@pytest.fixture(scope="module")
def mesh(cell: nt.Morphology) -> nt.Mesh:
    return nt.mesh(cell, level=3)


def test_vertices_know_their_points_and_sections(cell: nt.Morphology, mesh: nt.Mesh) -> None:
    points, on_soma = mesh.point_index, mesh.section == 0
    assert ((points < 0) == on_soma).all() and (mesh.section_index == mesh.section - 1).all()
    assert (cell.samples[points[~on_soma]] == mesh.sample[~on_soma]).all()
    assert (cell.to_table()["id"][mesh.sample_index] == mesh.sample).all()
    assert set(mesh.sample_index.tolist()) == set(range(7))
    for index in range(len(cell.sections)):
        section = cell.sections[index]
        found = mesh.type[mesh.section_index == index]
        assert len(found) and (found == section.type).all()


def test_one_cell_is_that_of_the_mesh(cell: nt.Morphology, mesh: nt.Mesh, tmp_path: Path) -> None:
    assert mesh.cell is cell and pickle.loads(pickle.dumps(mesh)).cell == cell
    mesh.save(tmp_path / "cell.ply")
    read = nt.read_mesh(tmp_path / "cell.ply")
    with pytest.raises(ValueError, match="set mesh.cell"):
        read.point_index  # noqa: B018
    read.cell = cell
    assert (read.point_index == mesh.point_index).all()
    only = nt.mesh(cell, level=1, types=["axon"], soma="none")
    assert set(only.section_index.tolist()) == {3}
    assert set(only.point_index.tolist()) == {4, 5}


def test_numbers_that_repeat_are_those_of_the_section() -> None:
    rows = [(1, 1, 0, 0, 0, 5, -1), (2, 3, 0, 9, 0, 1, 1), (3, 3, 0, 30, 0, 1, 2)]
    first = nt.Morphology.from_table(np.array(rows, dtype=float))
    mesh = nt.mesh(first, level=1)
    assert set(mesh.point_index.tolist()) == {-1, 0, 1}
    wide = nt.Morphology.from_table(np.array([(n if n < 3 else 2**40, *rest) for n, *rest in rows], dtype=float))
    mesh = nt.mesh(wide, level=1)
    assert any(told.code == "long_sample_numbers" for told in mesh.warnings)
    # Places instead of numbers that 32 bits do not hold.
    assert set(mesh.sample.tolist()) == {1, 2, 3}
    assert set(mesh.point_index.tolist()) == {-1, 0, 1}
    assert set(wide.to_table()["id"][mesh.sample_index].tolist()) == {1, 2, 2**40}


def test_path_distances_are_those_of_the_tracing(cell: nt.Morphology, mesh: nt.Mesh) -> None:
    told = mesh.path_distance
    dendrite = mesh.section_index == 0
    # It is straight up: the height is the way.
    straight = dendrite & (mesh.vertices[:, 1] > 12) & (mesh.vertices[:, 1] < 38)
    assert straight.sum() > 20
    assert told[straight] == pytest.approx(mesh.vertices[straight, 1], abs=1e-4)
    on_soma = mesh.section == 0
    assert told[on_soma] == pytest.approx(np.linalg.norm(mesh.vertices[on_soma], axis=1))
    ends = [told[mesh.section_index == index].max() for index in range(4)]
    # Where a section forks, the last vertices may be those of its branches.
    assert ends == pytest.approx([40, 40 + 800**0.5, 40 + 800**0.5, 50], abs=1)
    assert ends[1:] == pytest.approx([40 + 800**0.5, 40 + 800**0.5, 50], abs=1e-4)
    assert (np.abs(told - np.append(cell.path_distances(), 0)[mesh.point_index])[~on_soma] <= 28.3).all()
    free = nt.read(b"1 3 0 0 0 1 -1\n2 3 0 30 0 1 1\n")
    alone = nt.mesh(free, level=1).path_distance
    assert alone.min() == 0 and alone.max() == pytest.approx(30)


def test_attributes_of_ones_own_are_handed_over(mesh: nt.Mesh, tmp_path: Path) -> None:
    far = mesh.with_attribute("distance", mesh.path_distance)
    assert set(far.attributes) == {"type", "point", "section", "radius", "distance"}
    assert "distance" not in mesh.attributes and far.vertices is mesh.vertices
    assert (pickle.loads(pickle.dumps(far)).attributes["distance"] == mesh.path_distance).all()
    with pytest.raises(ValueError, match="section.*every mesh has"):
        mesh.with_attribute("section", mesh.section)
    with pytest.raises(ValueError, match=f"each of the {len(mesh.vertices)} vertices"):
        mesh.with_attribute("short", [1, 2, 3])
    with pytest.raises(ValueError, match="letters, digits and _"):
        mesh.with_attribute("my voltage", mesh.radius)
    with pytest.raises(ValueError, match="up to four"):
        mesh.with_attribute("wide", np.zeros((len(mesh.vertices), 5)))
    with pytest.raises(ValueError, match="not numbers"):
        mesh.with_attribute("names", ["a"] * len(mesh.vertices))


def glb_of(file: Path) -> tuple[dict[str, Any], bytes]:
    """The JSON and the binary chunk."""
    content = file.read_bytes()
    length = int.from_bytes(content[12:16], "little")
    assert len(content) == int.from_bytes(content[8:12], "little")
    return json.loads(content[20 : 20 + length]), content[28 + length :]


def accessor(document: dict[str, Any], binary: bytes, name: str) -> np.ndarray:
    found = document["accessors"][document["meshes"][0]["primitives"][0]["attributes"][name]]
    view = document["bufferViews"][found["bufferView"]]
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[found["type"]]
    values = np.frombuffer(binary, "<f4", found["count"] * width, view["byteOffset"])
    return values.reshape(-1, width)


def test_files_hold_attributes_of_ones_own(mesh: nt.Mesh, tmp_path: Path) -> None:
    ours = mesh.with_attribute("distance", mesh.path_distance).with_attribute("ends", mesh.vertices[:, :2])
    for name in ("cell.ply", "cell.vtu", "cell.glb"):
        ours.save(tmp_path / name)
        read = nt.read_mesh(tmp_path / name)
        assert (read.section == mesh.section).all() and (read.faces == mesh.faces).all() and read.closed
    header, _, rows = (tmp_path / "cell.ply").read_bytes().partition(b"end_header\n")
    assert b"property float radius\nproperty float distance\nproperty float ends_0\nproperty float ends_1\n" in header
    table = np.frombuffer(rows, "<f4", 13 * len(mesh.vertices)).reshape(-1, 13)
    assert (table[:, 10] == mesh.path_distance.astype(np.float32)).all()
    assert (table[:, 11:] == mesh.vertices[:, :2].astype(np.float32)).all()
    document, binary = glb_of(tmp_path / "cell.glb")
    assert (accessor(document, binary, "_DISTANCE")[:, 0] == mesh.path_distance.astype(np.float32)).all()
    with pytest.warns(nt.NeurotessWarning, match="cell.stl has no distance, ends: PLY, VTU and GLB"):
        ours.save(tmp_path / "cell.stl")


def test_colors_of_a_glb_are_those_of_an_attribute(mesh: nt.Mesh, tmp_path: Path) -> None:
    file = tmp_path / "cell.glb"
    ramp = np.linspace(0, 1, len(mesh.vertices))
    ramp[0] = np.nan
    ours = mesh.with_attribute("ramp", ramp)

    def colors(**options: object) -> np.ndarray:
        ours.save(file, **options)  # type: ignore[arg-type]
        return accessor(*glb_of(file), "COLOR_0")

    # Black to white is linear in light after sRGB's curve.
    gray = colors(color="ramp", colormap=["#000000", "#ffffff"])
    assert gray.shape == (len(mesh.vertices), 4) and (gray[:, 3] == 1).all()
    assert gray[0, :3] == pytest.approx([0.3515] * 3, abs=1e-3) and gray[-1, :3].tolist() == [1, 1, 1]
    middle = np.nanargmin(np.abs(ramp - 0.5))
    assert gray[middle, 0] == pytest.approx(0.214, abs=2e-3)
    assert colors(color="radius")[:, :3].std() > 0
    half = colors(color="ramp", colormap=["#000000", "#ffffff"], range=(0, 0.5))
    assert (half[ramp > 0.5, :3] == 1).all()
    direct = np.column_stack([ramp, ramp, ramp])
    direct[0] = 0
    ours = mesh.with_attribute("paint", direct)
    assert colors(color="paint")[-1].tolist() == [1, 1, 1, 1]
    with pytest.raises(ValueError, match="color='way': the mesh has 'type'"):
        colors(color="way")
    with pytest.raises(ValueError, match="a GLB has colors"):
        ours.save(tmp_path / "cell.ply", color="paint")


def test_color_maps_are_ours_or_others(monkeypatch: pytest.MonkeyPatch) -> None:
    from neurotess._colormaps import scale_of

    assert len(scale_of("viridis")) > 100 and scale_of("viridis")[0].tolist() == [68, 1, 84]
    matplotlib = pytest.importorskip("matplotlib")
    theirs = scale_of("coolwarm")
    assert theirs.shape == (256, 3) and (scale_of(matplotlib.colormaps["coolwarm"]) == theirs).all()
    apart = np.abs(scale_of(matplotlib.colormaps["viridis"])[[0, -1]].astype(int) - scale_of("viridis")[[0, -1]])
    assert apart.max() <= 2
    assert scale_of([(0.0, 0.0, 1.0), "#ff0000"]).tolist() == [[0, 0, 255], [255, 0, 0]]
    assert scale_of(np.array([[0, 0, 255], [255, 0, 0]])).tolist() == [[0, 0, 255], [255, 0, 0]]
    assert scale_of(["navy", "linen"]).tolist() == [[0, 0, 128], [250, 240, 230]]
    for wrong in ("no_such_map", ["#ff0000"], 3, [["a", "b"]], ["red", "blu"]):
        with pytest.raises(nt.OptionError, match="colormap=.*'viridis'"):
            scale_of(wrong)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(nt.OptionError, match="where matplotlib is installed"):
        scale_of("coolwarm")


@pytest.mark.full
def test_other_programs_read_attributes_of_ones_own(mesh: nt.Mesh, tmp_path: Path) -> None:
    trimesh = pytest.importorskip("trimesh")
    meshio = pytest.importorskip("meshio")
    ours = mesh.with_attribute("distance", mesh.path_distance)
    for name in ("cell.vtu", "cell.ply"):
        ours.save(tmp_path / name)
        theirs = meshio.read(tmp_path / name)
        assert np.ravel(theirs.point_data["distance"]) == pytest.approx(mesh.path_distance, abs=1e-3)
        assert (np.ravel(theirs.point_data["section"]) == mesh.section).all()
    ours.save(tmp_path / "cell.glb", color="distance", colormap="magma")
    theirs = trimesh.load(tmp_path / "cell.glb", force="mesh", process=False)
    assert theirs.vertex_attributes["_DISTANCE"].ravel() == pytest.approx(mesh.path_distance, abs=1e-3)
    assert theirs.visual.kind == "vertex" and len(np.unique(theirs.visual.vertex_colors, axis=0)) > 20


@pytest.mark.full
def test_trimesh_writes_and_shows_meshes(mesh: nt.Mesh, tmp_path: Path) -> None:
    trimesh = pytest.importorskip("trimesh")
    theirs = mesh.with_attribute("distance", mesh.path_distance).to_trimesh()
    theirs.export(tmp_path / "cell.glb")
    read = trimesh.load(tmp_path / "cell.glb", force="mesh", process=False).vertex_attributes
    assert (read["_section"].ravel() == mesh.section).all() and (read["_type"].ravel() == mesh.type).all()
    assert read["_distance"].ravel() == pytest.approx(mesh.path_distance, abs=1e-3)
    gltf = trimesh.exchange.gltf.export_gltf(theirs.scene())
    assert any(name.endswith(".gltf") for name in gltf)
    from trimesh.viewer.notebook import scene_to_html

    assert "<canvas" in scene_to_html(theirs.scene()) or "<script" in scene_to_html(theirs.scene())
    from_arrays = nt.Mesh.from_arrays(mesh.vertices, mesh.triangles()).to_trimesh()
    assert trimesh.exchange.gltf.export_glb(from_arrays.scene())


def test_numbers_too_large_for_a_float_are_exact() -> None:
    from neurotess._meshes import _floating

    wide = np.array([2**24 + 1, -1], np.int32)
    assert _floating(wide).dtype == np.float64 and (_floating(wide) == wide).all()
    assert _floating(np.array([3], np.int32)).dtype == np.float32


SMALL = {"size": (96, 64), "samples": 1, "legend": False}


def test_values_color_points_samples_and_sections(cell: nt.Morphology) -> None:
    def drawn(values: object, **options: object) -> np.ndarray:
        return np.asarray(nt.render(cell, values=values, **{**SMALL, **options}))  # type: ignore[arg-type]

    by_point = np.arange(len(cell), dtype=float)
    plain = np.asarray(nt.render(cell, **SMALL))
    first = drawn(by_point)
    assert (first != plain).any() and (drawn(by_point.astype(np.int16)) == first).all()
    assert (drawn({"point": by_point}) == first).all()
    # The soma is gray where it has no number.
    with_soma = drawn(np.append(0.0, by_point))
    assert (with_soma != first).any()
    assert (drawn({"sample": np.append(np.nan, by_point)}) == first).all()
    sections = np.array([5.0, 6.0, 7.0, 8.0])
    spread = np.repeat(sections, [s.indices.stop - s.indices.start for s in cell.sections])
    assert (drawn(sections) == drawn(spread)).all()
    assert (drawn(np.append(5.0, sections)) == drawn(np.append(5.0, spread))).all()
    assert (drawn(by_point, range=(0, 100)) != first).any()
    titled = np.asarray(nt.render(cell, values=by_point, title="current", unit="nA", size=(300, 200), samples=1))
    assert (titled != np.asarray(nt.render(cell, values=by_point, size=(300, 200), samples=1))).any()
    assert (drawn(by_point, colormap="magma") != first).any()
    assert (drawn(by_point, colormap=["#ff0000", "#ff0000"]) != first).any()
    both = np.asarray(nt.render([cell, cell], values=[by_point, None], **SMALL))
    assert both.shape == first.shape
    frames = list(nt.film(cell, turntable=True, frames=2, values=by_point, **SMALL))
    assert len(frames) == 2


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"values": [1.0, 2.0]}, "are 2: it has 6 points; 7 samples with the soma's; 4 sections, or 5 with the soma"),
        ({"values": {"point": [1.0]}}, "are 1: it has 6 points"),
        ({"values": {"vertex": [1.0]}}, "one of 'point', 'sample', 'section'"),
        ({"values": np.zeros((6, 2))}, r"shape \(6, 2\)"),
        ({"values": ["a"] * 6}, "one number for each"),
        ({"values": np.zeros(6), "color_by": "type"}, "leave out color_by='type'"),
        ({"title": "current"}, "give values="),
    ],
)
def test_values_that_do_not_fit_are_told(cell: nt.Morphology, options: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        nt.render(cell, **options)  # type: ignore[arg-type]


def test_lengths_that_may_be_of_two_things_are_asked_about() -> None:
    short = nt.read(b"1 1 0 0 0 5 -1\n2 3 0 9 0 1 1\n3 3 0 30 0 1 2\n")
    with pytest.raises(ValueError, match="2 may be of points or sections: say values={'point'"):
        nt.render(short, values=[1.0, 2.0])


def test_sections_are_made_once(cell: nt.Morphology) -> None:
    assert cell.sections is cell.sections and cell.neurites is cell.neurites
    assert cell.neurites[0].sections[0] is cell.sections[0]
