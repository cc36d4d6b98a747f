"""Reading cells, their arrays, tables and pickles."""

from __future__ import annotations

import gc
import io
import pickle
import sys
import types
import warnings
from pathlib import Path

import neurotess as nt
import numpy as np
import pytest

FORKED = """# a soma, an axon, a dendrite that forks
1 1  0   0  0  5   -1
2 2  0  -9  0  1    1
3 2  0 -30  2  0.8  2
4 3  0   9  0  1.2  1
5 3  2  25  0  1    4
6 3 12  40  3  0.7  5
7 3 -9  42 -4  0.7  5
"""


@pytest.fixture
def cell() -> nt.Morphology:
    return nt.read(FORKED.encode())


def test_arrays_show_the_file(cell: nt.Morphology) -> None:
    assert cell.points.shape == (6, 3) and cell.points.dtype == np.float64
    assert cell.samples.tolist() == [2, 3, 4, 5, 6, 7]
    assert cell.types.tolist() == [2, 2, 3, 3, 3, 3]
    assert cell.parents.tolist() == [-1, 0, -1, 2, 3, 3]
    assert cell.points[5].tolist() == [-9, 42, -4]
    assert np.allclose(cell.radii, [1, 0.8, 1.2, 1, 0.7, 0.7])
    assert len(cell) == 6 and not cell.warnings
    assert cell.soma is not None and cell.soma.kind == "point" and cell.soma.radius == 5


def test_arrays_are_made_once_and_cannot_be_changed(cell: nt.Morphology) -> None:
    assert cell.points is cell.points
    section = cell.sections[1]
    assert np.shares_memory(section.points, cell.points)
    with pytest.raises(ValueError, match="read-only"):
        cell.points[0, 0] = 1.0
    with pytest.raises(ValueError, match="read-only"):
        section.radii[0] = 1.0


def test_arrays_outlive_their_cell() -> None:
    cell = nt.synth("pyramidal", points=500)
    points, expected = cell.points[100:200], cell.points[100:200].copy()
    del cell
    gc.collect()
    [nt.synth("star", points=500) for _ in range(5)]
    assert (points == expected).all()


def test_sections_make_a_tree(cell: nt.Morphology) -> None:
    axon, trunk, left, right = cell.sections
    assert (axon.type, trunk.type) == (2, 3)
    assert left.parent == trunk and trunk.parent is None
    assert trunk.children == [left, right]
    assert (trunk.order, left.order) == (0, 1)
    assert left.length == pytest.approx(np.linalg.norm([10, 15, 3]))
    assert left.path_length == pytest.approx(trunk.length + left.length)
    assert 0 < left.exposed_area < left.area
    assert [neurite.type for neurite in cell.neurites] == [2, 3]
    assert cell.neurites[1].points.shape == (4, 3)
    assert sum(n.length for n in cell.neurites) == pytest.approx(cell.measures()["length"])


def test_open_files_bytes_and_paths_give_the_same(tmp_path: Path) -> None:
    path = tmp_path / "cell.swc"
    path.write_text(FORKED)
    read = nt.read(path)
    assert read == nt.read(str(path)) and read.name == "cell"
    with path.open("rb") as file:
        assert (nt.read(file).points == read.points).all()
    with path.open() as file:
        assert (nt.read(file).points == read.points).all()
    assert (nt.read(io.BytesIO(FORKED.encode())).points == read.points).all()
    assert nt.read(FORKED.encode(), name="x/other.swc").name == "other"
    with pytest.raises(TypeError, match="path, bytes, an open file or a table, not from int"):
        nt.read(3)  # type: ignore[arg-type]


def test_errors_have_file_line_and_message(tmp_path: Path) -> None:
    path = tmp_path / "broken.swc"
    path.write_text(FORKED + "8 3 0 0 zero 1 7\n")
    with pytest.raises(nt.ReadError) as caught:
        nt.read(path)
    error = caught.value
    assert (error.file, error.line) == (str(path), 9)
    assert "zero" in error.message and str(error) == f"{path}:9: {error.message}"
    assert pickle.loads(pickle.dumps(error)).line == 9
    with pytest.raises(FileNotFoundError) as missing:
        nt.read(tmp_path / "missing.swc")
    assert isinstance(missing.value, nt.ReadError) and missing.value.filename.endswith("missing.swc")
    with pytest.raises(nt.ReadError):
        nt.read(b"")


def test_warnings_are_warned_of_and_are_data() -> None:
    odd = b"1 1 0 0 0 5 -1\n2 3 0 9 0 0 1\n3 3 0 30 0 1 2\n"
    with pytest.warns(nt.ReadWarning, match="radius") as warned:
        cell = nt.read(odd, name="odd.swc")
    assert warned[0].filename == __file__
    [notice] = cell.warnings
    assert notice.line == 2 and notice.count == 1 and notice.code in str(warned[0].message)
    with pytest.raises(nt.ReadError, match=notice.code):
        nt.read(odd, strict=True)
    with warnings.catch_warnings():
        warnings.simplefilter("error", nt.ReadWarning)
        with pytest.raises(nt.ReadWarning):
            nt.read(odd)


def test_too_few_points_are_refused() -> None:
    with pytest.raises(ValueError, match="points=3 is not 50 or more"):
        nt.synth("granule", points=3)


def test_cells_without_points_work() -> None:
    cell = nt.read(b"1 1 0 0 0 5 -1\n")
    assert cell.points.shape == (0, 3) and cell.parents.shape == (0,)
    assert cell.sections == () and cell.neurites == ()
    assert cell.measures()["n_points"] == 0
    mesh = nt.mesh(cell)
    assert mesh.closed and (mesh.point_index == -1).all() and (mesh.sample_index == 0).all()
    assert mesh.path_distance == pytest.approx(5, rel=0.1)


def test_tables_of_any_kind_give_the_same_cell(cell: nt.Morphology) -> None:
    table = cell.to_table()
    assert table.dtype.names == ("id", "type", "x", "y", "z", "radius", "parent")
    as_array = np.array([list(row) for row in table.tolist()])
    as_columns = {name: table[name] for name in table.dtype.names or ()}
    of_navis = {
        "node_id": table["id"],
        "label": table["type"],
        "parent_id": table["parent"],
        **{name: table[name] for name in ("x", "y", "z", "radius")},
    }
    for other in (table, as_array, as_columns, of_navis):
        made = nt.Morphology.from_table(other)
        assert sorted(made.samples.tolist()) == cell.samples.tolist()
        assert made.measures()["length"] == pytest.approx(cell.measures()["length"])
    with pytest.warns(nt.ReadWarning, match="above their parents"):
        assert len(nt.Morphology.from_table(table[::-1])) == len(cell)
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame(table)
    assert (nt.Morphology.from_table(frame, name="frame").points == cell.points).all()


def test_tables_that_are_none_are_told(cell: nt.Morphology) -> None:
    table = cell.to_table()
    with pytest.raises(ValueError, match="no column 'radius'"):
        nt.Morphology.from_table({"id": [1], "type": [1], "x": [0], "y": [0], "z": [0], "parent": [-1]})
    with pytest.raises(ValueError, match="seven columns"):
        nt.Morphology.from_table(np.zeros((3, 4)))
    columns = {name: table[name].tolist() for name in table.dtype.names or ()}
    with pytest.raises(ValueError, match="'id' is not of whole numbers: row 1"):
        nt.Morphology.from_table({**columns, "id": [1, 2.5, 3, 4, 5, 6, 7]})
    with pytest.raises(ValueError, match="different lengths"):
        nt.Morphology.from_table({**columns, "x": [1.0]})
    with pytest.raises(nt.ReadError, match=r"cycle|ancestor|parent"):
        nt.Morphology.from_table({**columns, "parent": [2, 1, 2, 1, 4, 5, 5]})


def test_files_are_written_and_read_back(cell: nt.Morphology, tmp_path: Path) -> None:
    for extension, name in (("swc", "swc"), ("asc", "asc"), ("h5", "h5"), ("nml", "neuroml")):
        path = tmp_path / f"out.{extension}"
        lost = cell.save(path)
        assert all(isinstance(text, str) for text in lost)
        again = nt.read(path)
        assert np.allclose(again.points, cell.points) and again.format == name
    with pytest.raises(FileExistsError):
        cell.save(tmp_path / "out.swc", overwrite=False)
    with pytest.raises(ValueError, match="no format"):
        cell.save(tmp_path / "out.xyz")
    with pytest.raises(ValueError, match="read, not written"):
        cell.save(tmp_path / "out.traces")


def test_cells_are_pickled(samples: Path) -> None:
    for path in sorted(samples.glob("*.swc")):
        cell = nt.read(path)
        again = pickle.loads(pickle.dumps(cell))
        assert again == cell and again.name == cell.name and again.header == cell.header
        assert (again.points == cell.points).all()
    with pytest.raises(ValueError, match="no cell"):
        nt._neurotess.Cell.restore(b"\0" * 40)


def test_measures_are_those_of_the_command(samples: Path) -> None:
    import json
    import subprocess
    import sys

    path = samples / "granule.swc"
    command = [sys.executable, "-m", "neurotess", "info", "--json", str(path)]
    printed = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    [told] = json.loads(printed)
    measures = nt.read(path).measures()
    assert measures == {key: told[key] for key in measures}


def test_synthetic_cells_are_the_same_for_a_seed() -> None:
    assert nt.synth("granule", seed=7, points=80) == nt.synth("granule", seed=7, points=80)
    assert nt.synth("granule", seed=8, points=80) != nt.synth("granule", seed=7, points=80)


def test_grown_branches_cross_only_if_they_may() -> None:
    kept_clear, crossing = (nt.synth("purkinje", points=1000, may_cross=may) for may in [False, True])
    assert kept_clear != crossing and len(kept_clear.points) == len(crossing.points)
    pairs = [nt.mesh(cell, level=2).check()["self_intersections"] for cell in [kept_clear, crossing]]
    assert pairs[0] < 10 and pairs[1] > 100, pairs
    with pytest.raises(ValueError, match="glia"):
        nt.synth("glia")


def test_paths_go_along_the_tracing(cell: nt.Morphology) -> None:
    steps = np.linalg.norm(cell.points[[1, 3, 4, 5]] - cell.points[[0, 2, 3, 3]], axis=1)
    axon, trunk, left, right = steps
    assert cell.path_length(4, 5) == pytest.approx(left + right)
    assert cell.path_length(2, -1) == pytest.approx(trunk + right)
    # Through the soma's center, which is 9 µm from both neurites.
    assert cell.path_length(1, 4) == pytest.approx(axon + 9 + 9 + trunk + left)
    from_soma = cell.path_distances()
    assert from_soma == pytest.approx([9, 9 + axon, 9, 9 + trunk, 9 + trunk + left, 9 + trunk + right])
    each = [[cell.path_length(a, b) for b in range(6)] for a in range(6)]
    assert np.allclose(each, [cell.path_distances(a) for a in range(6)])
    with pytest.raises(IndexError):
        cell.path_length(0, 6)


def test_trees_that_do_not_meet_have_no_path() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        free = nt.read(b"1 3 0 0 0 1 -1\n2 3 0 9 0 1 1\n3 3 5 0 0 1 -1\n4 3 5 9 0 1 3\n")
    assert free.path_distances(0).tolist() == [0, 9, np.inf, np.inf]
    assert free.path_length(1, 2) == np.inf
    with pytest.raises(ValueError, match="no soma"):
        free.path_distances()


def test_forks_have_angles(cell: nt.Morphology) -> None:
    trunk = cell.sections[1]
    a, b = (child.points[0] - trunk.points[-1] for child in trunk.children)
    angle = np.arccos(a @ b / np.linalg.norm(a) / np.linalg.norm(b))
    assert trunk.local_bifurcation_angle == pytest.approx(angle)
    assert trunk.remote_bifurcation_angle == pytest.approx(angle)
    assert cell.sections[0].local_bifurcation_angle is None


def test_lists_homes_and_addresses_are_read(
    samples: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = samples / "granule.swc"
    cell = nt.read(file)
    several = nt.read([file, str(file), file.read_bytes()])
    assert len(several) == 3 and all((one.points == cell.points).all() for one in several)
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("USERPROFILE", str(tmp_path))
    (tmp_path / "mine.swc").write_bytes(file.read_bytes())
    assert nt.read("~/mine.swc") == nt.read(tmp_path / "mine.swc")
    assert nt.read("~/mine.swc", format="swc").name == "mine"
    with pytest.raises(nt.MissingFileError, match="there is no such file"):
        nt.read(tmp_path / "none.swc", format="swc")
    (tmp_path / "notes.txt").write_text("none")
    assert [one.name for one in nt.read(tmp_path)] == sorted(one.stem for one in tmp_path.glob("*.swc"))
    with pytest.raises(IsADirectoryError, match="is a folder: neurotess.read and neurotess.mesh_many take one"):
        nt.mesh(tmp_path)
    monkeypatch.setitem(sys.modules, "fsspec", None)
    with pytest.raises(ImportError, match="pip install fsspec"):
        nt.read("https://example.org/cell.swc")


def test_addresses_are_read_by_fsspec(samples: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of fsspec only what is used: `open`."""
    content = {"s3://cells/granule.swc": (samples / "granule.swc").read_bytes()}

    def opened(address: str, mode: str) -> io.BytesIO:
        if address not in content:
            raise FileNotFoundError(address)
        assert mode == "rb"
        return io.BytesIO(content[address])

    monkeypatch.setitem(sys.modules, "fsspec", types.SimpleNamespace(open=opened))
    cell = nt.read("s3://cells/granule.swc")
    assert cell.name == "granule" and cell == nt.read(samples / "granule.swc")
    with pytest.raises(FileNotFoundError, match="s3://cells/none.swc: there is no such file"):
        nt.read("s3://cells/none.swc")


def test_section_tables_have_what_sections_tell(cell: nt.Morphology) -> None:
    table = cell.section_table()
    assert len(table) == len(cell.sections)
    for row, section in zip(table, cell.sections, strict=True):
        assert (row["section_index"], row["type"], row["order"]) == (section.id, section.type, section.order)
        assert row["section"] == section.id + 1
        assert row["parent"] == (0 if section.parent is None else section.parent.id + 1)
        told = (section.length, section.area, section.volume, section.mean_diameter)
        assert [row[name] for name in ("length", "area", "volume", "mean_diameter")] == pytest.approx(told)
    # Of a cylinder: 10 µm long and 2 µm thick.
    rod = nt.read(b"1 1 0 0 0 5 -1\n2 3 9 0 0 1 1\n3 3 9 5 0 1 2\n4 3 9 10 0 1 3\n")
    [row] = rod.section_table()
    assert row["volume"] == pytest.approx(10 * np.pi) and row["area"] == pytest.approx(20 * np.pi)
    assert row["mean_diameter"] == pytest.approx(2)
    # 1e5 sqrt(d / (4 pi f Ra cm)) is the length constant.
    constant = 1e5 * np.sqrt(2 / (4 * np.pi * 100 * 35.4))
    for share in (0.5, 0.1, 0.003):
        d_lambda = 10 / constant * share
        expected = int((1 / share + 0.9) / 2) * 2 + 1
        assert rod.section_table(d_lambda=d_lambda)["nseg"].tolist() == [expected]
    for name, value in (("Ra", -1.0), ("d_lambda", 0.0), ("cm", float("nan")), ("frequency", float("inf"))):
        with pytest.raises(ValueError, match=f"{name}={value} is not a number above 0"):
            rod.section_table(**{name: value})


def test_tables_are_cells_and_lists_are_told(cell: nt.Morphology) -> None:
    mesh = nt.mesh(cell.to_table(), level=1)
    assert mesh.closed
    with pytest.raises(TypeError, match="of a list, neurotess.mesh_many makes meshes"):
        nt.mesh([cell, cell])
    with pytest.raises(TypeError, match="it is a surface, which neurotess.check judges"):
        nt.mesh(mesh)
    for threads in (0, -1):
        with pytest.raises(ValueError, match=f"threads={threads} is not 1 or more"):
            nt.mesh(cell, threads=threads)
