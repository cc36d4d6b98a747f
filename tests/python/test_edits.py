"""Mended and compared cells."""

from __future__ import annotations

import inspect
import json
import math
import pickle
import re
import subprocess
import sys
from pathlib import Path

import neurotess as nt
import numpy as np
import pytest

CELL = b"1 1 0 0 0 5 -1\n2 3 0 9 0 1 1\n3 3 0 20 0 1 2\n4 3 5 30 0 1 3\n5 2 -4 31 0 0.5 3\n6 2 -9 40 1 0.5 5\n"


@pytest.fixture(scope="module")
def cell() -> nt.Morphology:
    return nt.read(CELL)


def command(*words: object) -> subprocess.CompletedProcess[str]:
    line = [sys.executable, "-m", "neurotess", *map(str, words)]
    return subprocess.run(line, capture_output=True, text=True, check=False)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"types": {2: "basal", "dendrite": 2}}, ["--types", "2=basal,dendrite=2"]),
        ({"scale": np.float32(0.5)}, ["--scale", "0.5"]),
        ({"units": "nm"}, ["--units", "nm"]),
        ({"units": (0.1, 0.1, 0.5)}, ["--units", "voxel=0.1,0.1,0.5"]),
        ({"mend_radii": True}, ["--mend-radii"]),
        ({"mend_radii": 1.5}, ["--mend-radii=1.5"]),
        ({"types": {"soma": 3}, "reroot": 6}, ["--types", "soma=3", "--reroot", "6"]),
        ({"join": math.inf}, ["--join", "inf"]),
        ({"subtree": np.int64(3)}, ["--subtree", "3"]),
        ({"cut": 4}, ["--cut", "4"]),
        ({"cut": np.array([4, 6])}, ["--cut", "4", "--cut", "6"]),
        ({"drop_types": "axon"}, ["--drop-types", "axon"]),
        ({"drop_types": ["axon", 7]}, ["--drop-types", "axon,7"]),
        ({"within": 25.5}, ["--within", "25.5"]),
        ({"prune": 12}, ["--prune", "12"]),
        ({"smooth": "auto"}, ["--smooth", "auto"]),
        ({"smooth": 8}, ["--smooth", "8"]),
        ({"resample": 2.5}, ["--resample", "2.5"]),
        ({"simplify": 1}, ["--simplify", "1"]),
        ({"spines": 0.5}, ["--spines", "0.5"]),
        ({"spines": (0.5, 7)}, ["--spines", "0.5,7"]),
        ({"recenter": True}, ["--recenter"]),
        ({"rotate": {"z": 90, "x": -30}}, ["--rotate", "z=90", "--rotate", "x=-30"]),
        ({"rotate": [("z", 1), ("y", 2), ("z", 3)]}, ["--rotate=z=1", "--rotate=y=2", "--rotate=z=3"]),
        ({"mirror": "x"}, ["--mirror", "x"]),
        ({"mirror": ["x", "y"], "simplify": 0.5}, ["--mirror=x", "--mirror=y", "--simplify=0.5"]),
    ],
    ids=lambda value: "-".join(value) if isinstance(value, dict) else "",
)
def test_edits_are_those_of_the_command(
    tmp_path: Path, options: dict[str, object], words: list[str]
) -> None:
    (tmp_path / "cell.swc").write_bytes(CELL)
    edited = nt.edit(nt.read(tmp_path / "cell.swc"), **options)  # type: ignore[arg-type]
    edited.save(tmp_path / "ours.swc")
    ran = command("convert", tmp_path / "cell.swc", "-o", tmp_path / "theirs.swc", "--json", *words)
    assert ran.returncode == 0, ran.stderr
    assert (tmp_path / "ours.swc").read_bytes() == (tmp_path / "theirs.swc").read_bytes()
    assert list(edited.edits) == json.loads(ran.stdout)[0]["edits"]


def test_what_edits_do(cell: nt.Morphology) -> None:
    table = cell.to_table()
    assert len(nt.edit(table, scale=2.0)) == len(cell)
    assert nt.edit(cell) == cell and cell.edits == ()
    turned = nt.edit(cell, rotate={"z": 90}, mirror="y")
    x, y, z = cell.points.T
    assert np.allclose(turned.points, np.stack([-y, -x, z], axis=1), atol=1e-5)
    assert nt.edit(cell, units="nm").points == pytest.approx(cell.points / 1000)
    even = nt.edit(cell, resample=1)
    assert even.edits[0]["renumbered"] and len(even) > 3 * len(cell)
    assert len(nt.edit(cell, subtree=5)) == 2
    assert nt.edit(cell, cut=[4, 6]).samples.tolist() == [2, 3, 5]
    assert len(nt.edit(cell, drop_types="axon")) == 3
    assert nt.edit(cell, within=15).samples.tolist() == [2, 7]
    assert len(nt.edit(cell, prune=12)) == 4
    assert len(cell) == 5, "the cell itself stays"


def test_affine_maps_move_cells(cell: nt.Morphology) -> None:
    quarter = np.array([[0, -2, 0, 5], [2, 0, 0, 6], [0, 0, 2, 7], [0, 0, 0, 1.0]])
    moved = nt.edit(cell, matrix=quarter)
    homogeneous = np.c_[cell.points, np.ones(len(cell))]
    assert np.allclose(moved.points, (homogeneous @ quarter.T)[:, :3])
    assert np.allclose(moved.radii, 2 * cell.radii) and moved.edits[0]["edit"] == "place"
    assert nt.edit(cell, matrix=quarter[:3]) == moved
    assert nt.edit(cell, matrix=quarter[:3, :3], translate=(5, 6, 7)) == moved
    assert np.allclose(nt.edit(cell, translate=(1, 0, 0)).points - cell.points, (1, 0, 0))
    for wrong, message in [
        ({"matrix": np.eye(2)}, r"\(2, 2\): \(4, 4\), \(3, 4\) or \(3, 3\) is needed"),
        ({"matrix": quarter * 2}, r"is not affine: its last row is \[0.0, 0.0, 0.0, 2.0\]"),
        ({"matrix": np.zeros((3, 4))}, r"determinant that is not 0"),
        ({"translate": (1, 2)}, r"\(x, y, z\) in µm is needed"),
    ]:
        with pytest.raises(ValueError, match=message):
            nt.edit(cell, **wrong)


def test_radii_that_are_no_numbers_are_mended(tmp_path: Path) -> None:
    bad = tmp_path / "bad.swc"
    bad.write_bytes(CELL.replace(b"20 0 1 2", b"20 0 nan 2"))
    with pytest.raises(nt.ReadError):
        nt.read(bad)
    with pytest.warns(nt.ReadWarning):
        mended = nt.edit(bad, mend_radii=True)
    assert mended.radii[1] == 1 and mended.edits[0]["changed"] == 1


def test_a_unit_that_was_dealt_with_is_not_warned_of() -> None:
    far = b"1 1 0 0 0 5 -1\n2 3 0 9 0 1 1\n3 3 0 90000000 0 1 2\n"
    with pytest.warns(nt.ReadWarning, match="too_large"):
        cell = nt.read(far)
    codes = [notice.code for notice in nt.edit(cell, mirror="x").warnings]
    assert "too_large" in codes
    assert "too_large" not in [notice.code for notice in nt.edit(cell, units="nm").warnings]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"scale": 0}, "scale=0: a number above 0"),
        ({"scale": 2, "units": "nm"}, "'scale.* cannot be used with 'units"),
        ({"units": (1, 2)}, r"units=\(1, 2\): 'um', 'nm' or the sides of a voxel"),
        ({"mend_radii": 0.5}, "mend_radii=0.5: a number above 1"),
        ({"rotate": {"w": 3}}, r"rotate=\{'w': 3\}: an axis and degrees"),
        ({"mirror": "xy"}, "mirror='xy': 'x', 'y' or 'z'"),
        ({"subtree": 77}, "no sample has the number 77"),
        ({"cut": [77, 5, 78]}, "no samples have the numbers 77, 78"),
        ({"drop_types": ["axon", "branch"]}, r"drop_types=\['axon', 'branch'\]: use axon"),
        ({"within": 0}, "within=0: a number above 0"),
        ({"cut": "x"}, "cut='x': a whole number is needed"),
        ({"reroot": 6}, "in a tree with a soma"),
        ({"resample": 1e-9}, "take a larger one"),
        ({"types": {"branch": 3}}, r"types=\{'branch': 3\}: use axon"),
    ],
    ids=lambda value: "-".join(value) if isinstance(value, dict) else "",
)
def test_wrong_edits_are_value_errors(
    cell: nt.Morphology, options: dict[str, object], message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        nt.edit(cell, **options)  # type: ignore[arg-type]


def test_no_edit_of_the_command_is_missing() -> None:
    helped = command("convert", "--help").stdout
    flags = {flag.replace("-", "_") for flag in re.findall(r"^\s+(?:-\w, )?--([a-z-]+)", helped, re.M)}
    files = {"out", "force", "format", "keep_ids", "strict", "dry_run", "threads", "help"}
    common = {"json", "quiet", "verbose", "no_progress", "color", "allow_large"}
    # In Python a circuit's cells are selected by `Circuit.select`.
    cells = {"nodes", "node_set", "population", "region", "sample", "sample_seed"}
    # `translate` is a `matrix` without turn and size.
    assert flags - files - common - cells == set(inspect.signature(nt.edit).parameters) - {"cell", "translate"}


def test_spines_grow_where_they_are_asked_for(tmp_path: Path) -> None:
    dendrite = b"1 1 0 0 0 5 -1\n" + b"".join(
        b"%d 3 %d 0 0 0.8 %d\n" % (i, 3 * i, i - 1) for i in range(2, 40)
    )
    (tmp_path / "dendrite.swc").write_bytes(dendrite)
    plain = nt.read(tmp_path / "dendrite.swc")
    places = np.array([[30.0, 1.0, 0.0], [60.0, 0.0, 1.0], [90.0, -1.0, 0.0]])
    grown = nt.edit(plain, spines=places)
    assert grown.edits[0]["edit"] == "spines"
    types = np.asarray(grown.types)
    heads = np.asarray(grown.points)[types == 7]
    for place in places:
        assert np.min(np.abs(heads[:, 0] - place[0])) < 1.0
    table = tmp_path / "places.csv"
    table.write_text("x,y,z\n" + "".join(f"{x},{y},{z}\n" for x, y, z in places))
    assert np.sum(np.asarray(nt.edit(plain, spines=table).types) == 7) == len(heads)
    assert nt.mesh(grown, level=1).check()["closed"]
    with pytest.raises(ValueError, match="three coordinates"):
        nt.edit(plain, spines=np.zeros((2, 2)))


def test_edited_cells_are_pickled(cell: nt.Morphology) -> None:
    edited = nt.edit(cell, scale=2)
    again = pickle.loads(pickle.dumps(edited))
    assert again == edited and again.edits == edited.edits and again.edits[0]["edit"] == "scale"


def test_differences_are_those_of_the_command(cell: nt.Morphology, tmp_path: Path) -> None:
    (tmp_path / "a.swc").write_bytes(CELL)
    (tmp_path / "b.swc").write_bytes(CELL.replace(b"4 3 5 30", b"4 4 5 30.5"))
    ran = command("diff", tmp_path / "a.swc", tmp_path / "b.swc", "--json")
    assert ran.returncode == 1
    theirs = json.loads(ran.stdout)
    del theirs["files"]
    ours = nt.diff(cell, tmp_path / "b.swc")
    assert ours == theirs and not ours["same"]
    assert ours["moved"] == {"count": 1, "largest": pytest.approx(0.5), "samples": [4]}
    assert ours["retyped"][0]["count"] == 1
    assert nt.diff(cell, cell)["same"] and nt.diff(cell, nt.edit(cell, scale=1.00001))["same"]
    assert nt.diff(cell, nt.edit(cell, scale=2), samples=2)["moved"]["samples"] == [2, 3]
    grown = nt.synth("granule", points=100)
    moved = nt.diff(grown, nt.edit(grown, scale=2))["moved"]
    assert moved["samples"] == grown.samples.tolist() and len(moved["samples"]) == moved["count"] == 100
    with pytest.raises(ValueError, match="samples=-1"):
        nt.diff(cell, cell, samples=-1)
    for tolerance in (-1, math.nan, math.inf):
        with pytest.raises(ValueError, match="tolerance"):
            nt.diff(cell, cell, tolerance=tolerance)
