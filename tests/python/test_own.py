"""Numbers of one's own for the vertices of a mesh: in files and back, and as colors of pictures."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import neurotess as nt


@pytest.fixture(scope="module")
def mesh() -> nt.Mesh:
    cell = nt.read(b"1 1 0 0 0 5 -1\n2 3 0 9 0 1 1\n3 3 0 40 0 1 2\n4 3 20 60 0 1 3\n5 3 -20 60 0 1 3\n", name="fork")
    return nt.mesh(cell, level=2)


@pytest.mark.parametrize("extension", ["ply", "vtu", "glb"])
def test_files_give_back_attributes_of_ones_own(mesh: nt.Mesh, tmp_path: Path, extension: str) -> None:
    file = tmp_path / f"fork.{extension}"
    count = len(mesh.vertices)
    marks = np.arange(count, dtype=np.int64)
    own = {
        "distance": mesh.path_distance,
        "voltage_mV": np.where(marks % 7 == 0, np.nan, -65.0 + marks / 8),
        "marks": marks,
        "is_far": mesh.path_distance > 20,
        "uv": mesh.vertices[:, :2],
        "direction": mesh.normals,
        "paint": np.random.default_rng(7).random((count, 4)),
    }
    ours = mesh
    for name, values in own.items():
        ours = ours.with_attribute(name, values)
    ours.save(file)
    read = nt.read_mesh(file)
    assert set(read.attributes) == set(ours.attributes)
    for name, values in own.items():
        found = read.attributes[name]
        assert found.dtype == np.float32 and not found.flags.writeable
        np.testing.assert_array_equal(found, np.asarray(values).astype(np.float32), err_msg=name)
    # And again, from what was read.
    read.save(tmp_path / f"again.{extension}")
    again = nt.read_mesh(tmp_path / f"again.{extension}")
    assert (again.attributes["direction"] == mesh.normals).all()


def test_attributes_of_other_programs_have_names_that_files_may_have(tmp_path: Path) -> None:
    file = tmp_path / "other.ply"
    header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    header += "property uchar red\nproperty double von-Mises\nproperty float normal\nproperty int id\n"
    header += "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    file.write_text(header + "0 0 0 255 0.1 1 16777217\n1 0 0 0 1e30 2 -5\n0 1 0 9 -1 3 0\n3 0 1 2\n")
    read = nt.read_mesh(file)
    assert list(read.attributes) == ["type", "point", "section", "radius", "red", "von_Mises", "normal_", "id"]
    assert read.attributes["von_Mises"].tolist() == [0.1, 1e30, -1]
    assert read.attributes["id"].tolist() == [16777217, -5, 0]
    assert read.attributes["red"].dtype == np.float32
    read.save(tmp_path / "same.ply")
    assert nt.read_mesh(tmp_path / "same.ply").attributes["red"].tolist() == [255, 0, 9]


def test_attributes_that_end_early_are_errors(mesh: nt.Mesh, tmp_path: Path) -> None:
    for extension in ("ply", "vtu", "glb"):
        file = tmp_path / f"cut.{extension}"
        mesh.with_attribute("distance", mesh.path_distance).save(file)
        content = file.read_bytes()
        file.write_bytes(content[: len(content) - len(content) // 3])
        with pytest.raises(nt.ReadError, match="ends within"):
            nt.read_mesh(file)
    header = b"ply\nformat binary_little_endian 1.0\nelement vertex 9000000000\n"
    header += b"".join(b"property double %s\n" % name for name in (b"x", b"y", b"z", b"a", b"b"))
    (tmp_path / "large.ply").write_bytes(header + b"end_header\n" + bytes(100))
    with pytest.raises(nt.ReadError, match="ends within"):
        nt.read_mesh(tmp_path / "large.ply")
