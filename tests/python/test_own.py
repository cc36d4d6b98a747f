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


SMALL = {"size": (160, 120), "samples": 4}
BLUE_TO_RED = ["#0000ff", "#ff0000"]


def pixels(picture: nt.Image) -> np.ndarray:
    return np.asarray(picture)[..., :3].astype(int)


class Elsewhere:
    """A mesh of another package, as trimesh has them."""

    def __init__(self, mesh: nt.Mesh, **attributes: np.ndarray) -> None:
        self.vertices, self.faces = mesh.vertices, mesh.faces
        self.vertex_attributes = attributes


def test_meshes_are_colored_by_numbers_of_their_vertices(mesh: nt.Mesh) -> None:
    height = mesh.vertices[:, 1]
    options = {**SMALL, "colormap": BLUE_TO_RED, "legend": False, "light": "flat"}
    picture = pixels(mesh.render(values=height, **options))
    rows = [row[row.sum(axis=1) < 600] for row in picture]
    shown = [row for row in rows if len(row) > 2]
    red, blue = shown[2].mean(axis=0), shown[-3].mean(axis=0)
    assert red[0] > 200 > 80 > red[2] and blue[2] > 200 > 80 > blue[0]
    # Numbers that are none are gray.
    none = pixels(mesh.render(values=np.full(len(height), np.nan), **options))
    assert np.ptp(none, axis=2).max() == 0 and none.min() < 200


@pytest.mark.full
def test_numbers_of_meshes_come_by_name_and_from_other_packages(mesh: nt.Mesh) -> None:
    height = mesh.vertices[:, 1]
    options = {**SMALL, "colormap": BLUE_TO_RED, "legend": False, "light": "flat"}
    picture = pixels(mesh.render(values=height, **options))
    named = mesh.with_attribute("height", height)
    assert (pixels(named.render(values="height", **options)) == picture).all()
    assert (pixels(nt.render(named, values="height", **options)) == picture).all()
    assert (pixels(nt.render([named], values=[height[:, None]], **options)) == picture).all()
    theirs = Elsewhere(mesh, height=height.astype(int))
    assert (pixels(nt.render(Elsewhere(mesh), values=height, **options)) == picture).all()
    close = pixels(nt.render(theirs, values="height", **options))
    assert np.abs(close - picture).mean() < 2
    low = pixels(mesh.render(values=height, range=(100, 200), **options))
    assert (low[..., 0] - low[..., 2]).max() <= 0 < (low[..., 2] - low[..., 0]).max()


def test_vertices_at_one_place_keep_their_own_numbers() -> None:
    # Two triangles that share a side, each with its corners for itself.
    corners = np.array([[0, 0, 0], [10, 0, 0], [0, 10, 0], [10, 10, 0], [0, 10, 0], [10, 0, 0]], float)
    square = nt.Mesh.from_arrays(corners, [[0, 1, 2], [3, 4, 5]])
    options = {**SMALL, "colormap": BLUE_TO_RED, "legend": False, "light": "flat", "view": "front"}
    picture = pixels(square.render(values=[0, 0, 0, 1, 1, 1], **options))
    red, blue = picture[..., 0] > 200, picture[..., 2] > 200
    mixed = (picture.min(axis=2) < 60) & (picture[..., 0] > 60) & (picture[..., 2] > 60)
    assert (red & ~blue).sum() > 1000 < (blue & ~red).sum()
    # Between them is the side alone, which is smooth.
    assert mixed.sum() < 200


@pytest.mark.full
def test_the_legend_tells_numbers_of_meshes(mesh: nt.Mesh) -> None:
    height = mesh.vertices[:, 1]
    big = {"size": (400, 300), "samples": 4}
    plain = pixels(mesh.render(values=height, **big))
    titled = pixels(mesh.render(values=height, title="height", unit="µm", **big))
    without = pixels(mesh.render(values=height, legend=False, **big))
    assert (plain != titled).any() and (plain != without).any()
    # The name of an attribute is its title.
    named = mesh.with_attribute("height", height).render(values="height", unit="µm", **big)
    assert (pixels(named) == titled).all()


@pytest.mark.full
def test_cells_and_meshes_have_one_scale(mesh: nt.Mesh) -> None:
    cell = mesh.cell
    assert cell is not None
    beside = nt.Mesh.from_arrays(mesh.vertices + [60, 0, 0], mesh.faces)
    options = {**SMALL, "colormap": BLUE_TO_RED, "legend": False, "light": "flat"}
    zeros, ones = {"point": np.zeros(len(cell))}, np.ones(len(mesh.vertices))
    both = pixels(nt.render([cell, beside], values=[zeros, ones], **options))
    assert (both[:, :60, 0] - both[:, :60, 2]).max() < 50 and (both[:, 100:, 0] - both[:, 100:, 2]).max() > 150
    # Cells by their type beside a mesh with numbers, and the other way round.
    one = pixels(nt.render([cell, beside], values=[None, ones], **options))
    assert (one[:, 100:] == both[:, 100:]).mean() < 1
    other = pixels(nt.render([cell, beside], values=[zeros, None], **options))
    assert (other[:, 100:] != both[:, 100:]).any()
    listed = nt.render(cell, meshes={"mesh": beside, "values": ones}, values=zeros, **options)
    assert (pixels(listed) == both).all()


def test_numbers_that_fit_no_mesh_are_told(mesh: nt.Mesh, tmp_path: Path) -> None:
    count = len(mesh.vertices)
    shapes = rf"values= of fork have shape \(3,\): \({count},\) is needed, a number for each vertex"
    for draw in (lambda: mesh.render(values=[1, 2, 3]), lambda: nt.render(mesh, values=[1, 2, 3])):
        with pytest.raises(ValueError, match=shapes):
            draw()
    with pytest.raises(ValueError, match=rf"of mesh 1 have shape \({count}, 2\): \({count},\) is needed"):
        nt.render(Elsewhere(mesh), values=mesh.vertices[:, :2])
    with pytest.raises(ValueError, match=rf"shape \({len(mesh.faces)},\).*these are of its faces"):
        mesh.render(values=np.zeros(len(mesh.faces)))
    with pytest.raises(ValueError, match=r"values\[mesh.point_index\]"):
        mesh.render(values=np.zeros(len(mesh.cell or [])))
    with pytest.raises(ValueError, match="values='calcium': fork has 'type', 'point', 'section', 'radius'"):
        mesh.render(values="calcium")
    with pytest.raises(ValueError, match="values='calcium': mesh 1 has 'heat'"):
        nt.render(Elsewhere(mesh, heat=mesh.radius), values="calcium")
    with pytest.raises(ValueError, match="not numbers, but <U1"):
        mesh.render(values=["a"] * count)
    with pytest.raises(ValueError, match="values= of 2 cells and meshes are a list"):
        nt.render([mesh, mesh], values=mesh.radius)
    with pytest.raises(ValueError, match="leave out times="):
        mesh.render(values=mesh.radius, times=[0, 1])
    with pytest.raises(ValueError, match="leave out color='red'"):
        mesh.render(values="radius", color="red")
    mesh.save(tmp_path / "fork.obj")
    with pytest.raises(ValueError, match="values='heat': fork.obj has 'type'"):
        nt.render([], meshes={"mesh": tmp_path / "fork.obj", "values": "heat"})
