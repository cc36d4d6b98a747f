"""Meshes: options, arrays, checks, files, other packages."""

from __future__ import annotations

import gc
import pickle
import subprocess
import sys
import warnings
from pathlib import Path
from typing import Any

import neurotess as nt
import numpy as np
import pytest


@pytest.fixture(scope="module")
def cell() -> nt.Morphology:
    return nt.synth("granule", seed=3, points=120)


@pytest.fixture(scope="module")
def mesh(cell: nt.Morphology) -> nt.Mesh:
    return nt.mesh(cell, level=2)


def test_a_mesh_is_closed_and_has_attributes(cell: nt.Morphology, mesh: nt.Mesh) -> None:
    count = len(mesh.vertices)
    assert mesh.closed and mesh.check()["closed"] and mesh.check()["volume"] == mesh.volume > 0
    assert mesh.vertices.shape == (count, 3) and mesh.vertices.dtype == np.float64
    assert mesh.faces.dtype == np.uint32 and mesh.faces.max() == count - 1
    assert mesh.normals.shape == (count, 3) and np.allclose(np.linalg.norm(mesh.normals, axis=1), 1)
    assert set(mesh.type.tolist()) == {1, *np.unique(cell.types).tolist()}
    assert mesh.section.max() == len(cell.sections) and mesh.section.min() == 0
    assert set(mesh.point[mesh.section > 0].tolist()) <= set(cell.samples.tolist())
    assert mesh.radius.min() >= 0 and not len(mesh.quads)


def test_the_soma_can_be_that_of_a_file(cell: nt.Morphology, tmp_path: Path) -> None:
    radius = 2 * cell.somata[0].radius
    soma = cell.somata[0]
    radius, at = 2 * soma.radius, soma.center
    ball = nt.read(f"1 1 {at[0]} {at[1]} {at[2]} {radius} -1\n".encode(), format="swc")
    nt.mesh(ball, level=2).save(tmp_path / "ball.ply")
    more = nt.mesh(cell, soma_mesh=tmp_path / "ball.ply").volume - nt.mesh(cell).volume
    assert more > 0.5 * 7 / 8 * (4 / 3 * np.pi * radius**3)
    with pytest.raises(nt.MeshError, match="none.ply"):
        nt.mesh(cell, soma_mesh=tmp_path / "none.ply")
    with pytest.raises(ValueError, match="soma"):
        nt.mesh(cell, soma_mesh="ball.ply", soma="sphere")


@pytest.mark.parametrize(
    "options",
    [
        {"level": 1},
        {"max_error": 0.2},
        {"level": 2, "level_along": 5},
        {"isotropic": True, "max_edge": 3.0, "min_edge": 0.2, "max_aspect": 2},
        {"isotropic": 1.5},
        {"path": "linear", "caps": "flat"},
        {"crossings": "merge", "level": 1},
        {"crossings": "separate", "level": 1},
        {"simulation": True},
        {"soma": "sphere", "soma_scale": 1.2},
        {"soma_keep": "area"},
        {"soma": "none", "types": ["axon"]},
        {"soma_sphere": "octahedron", "soma_level": 3, "poisson": 0.1},
        {"ring": {1: 0.5, 2: 1.5}},
        {"smooth": "auto"},
        {"radius_factor": 2.5},
        {"radii": "equal-area", "level": 2},
        {"simulation": True, "radii": "traced", "max_aspect": 1},
        {"smooth": 2},
        {"types": "dendrite,2"},
        {"level": np.int64(2), "poisson": np.float32(0.25)},
    ],
    ids=lambda options: "-".join(options),
)
def test_options_are_those_of_the_command(
    cell: nt.Morphology, tmp_path: Path, options: dict[str, object]
) -> None:

    cell.save(tmp_path / "cell.swc")
    read = nt.read(tmp_path / "cell.swc")
    nt.mesh(read, **options).save(tmp_path / "ours.ply")
    command = [sys.executable, "-m", "neurotess", "mesh", str(tmp_path / "cell.swc"), "-q"]
    command += ["-o", str(tmp_path / "theirs.ply"), *_arguments(options)]
    subprocess.run(command, check=True)
    assert (tmp_path / "ours.ply").read_bytes() == (tmp_path / "theirs.ply").read_bytes()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"level": 99}, "level=99: a whole number from 0 to 64 is needed"),
        ({"level": -1}, "level=-1: a whole number from 0 to 64"),
        ({"level": 4, "max_error": 0.1}, "'level' cannot be used with 'max_error'"),
        ({"max_edge": 2.0}, "max_edge, min_edge and max_aspect are for isotropic"),
        ({"soma": "cube"}, "soma='cube': use 'fem', 'sphere', 'profile' or 'none'"),
        ({"poisson": 0.5}, "poisson=0.5: a number"),
        ({"ring": {0: 1.0}}, r"ring=\{0: 1.0\}: neurites from 1 on"),
        ({"types": ["branch"]}, "use axon, basal"),
        ({"quads": True, "crossings": "merge"}, "quads or crossings"),
        ({"level": "many"}, "level='many': a whole number is needed"),
    ],
    ids=lambda value: "-".join(value) if isinstance(value, dict) else "",
)
def test_wrong_options_are_value_errors(
    cell: nt.Morphology, options: dict[str, object], message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        nt.mesh(cell, **options)


def test_unknown_options_are_type_errors(cell: nt.Morphology) -> None:
    with pytest.raises(TypeError, match="levle"):
        nt.mesh(cell, levle=3)  # type: ignore[call-arg]


def test_no_option_of_the_command_is_missing() -> None:
    import inspect
    import re

    files = {"out", "force", "format", "unit", "walls", "table", "areas", "materials", "parts", "color_by", "compress"}
    files |= {"shard", "resume", "log", "strict", "help"}
    common = {"json", "quiet", "verbose", "no_progress", "color", "allow_large"}
    circuit = {"nodes", "node_set", "population", "region", "sample", "sample_seed"}
    # In Python a palette may be a dictionary of colors.
    drawing = {"out", "force", "help", "strict", "stats", "turntable", "frames", "threads", "set_color", "saved_view"}
    # What pictures tell of themselves is said when they are saved.
    drawing |= {"no_recipe"}
    # In Python several meshes are one list.
    drawing |= {"mesh", "meshes"}
    # The command has no numbers of one's own.
    drawing |= {"values", "times", "title", "unit"}
    # Groups of the others.
    drawing |= {"camera", "scene", "markers"}
    for command, function, other in [
        ("mesh", nt.mesh, files | circuit),
        ("render", nt.render, drawing),
    ]:
        words = [sys.executable, "-m", "neurotess", command, "--help"]
        text = subprocess.run(words, check=True, capture_output=True, text=True).stdout
        flags = {
            flag.replace("-", "_") for flag in re.findall(r"^ +(?:-\w, )?--([a-z-]+)", text, re.MULTILINE)
        }
        ours = set(inspect.signature(function).parameters)
        flags = {flag.removeprefix("no_") if flag in ("no_legend", "no_cache") else flag for flag in flags}
        assert flags - other - common == ours - {"cell", "what"} - other, command


def test_what_cannot_be_meshed_is_a_mesh_error(cell: nt.Morphology) -> None:
    with pytest.raises(nt.MeshError, match="nothing is left"):
        nt.mesh(cell, types=["custom_9"], soma="none")


def test_quads_and_their_halves(cell: nt.Morphology) -> None:
    coarse = nt.mesh(cell, level=0)
    assert len(coarse.quads) and coarse.check()["closed"]
    quads = nt.mesh(cell, level=2, quads=True)
    halves = quads.triangles()
    assert len(halves) == len(quads.faces) + 2 * len(quads.quads)
    assert nt.Mesh.from_arrays(quads.vertices, halves).check()["closed"]


def test_merging_tells_what_it_did(cell: nt.Morphology) -> None:
    merged = nt.mesh(cell, crossings="merge", level=1)
    assert merged.report["crossings"]["pairs"] == 0
    assert merged.check()["self_intersections"] == 0
    solved = nt.mesh(cell, simulation=True)
    assert solved.report["quality"]["min_angle_median"] > 20


def test_arrays_are_read_only_and_outlive_the_mesh(cell: nt.Morphology) -> None:
    mesh = nt.mesh(cell, level=2)
    assert mesh.vertices is mesh.vertices
    with pytest.raises(ValueError, match="read-only"):
        mesh.vertices[0] = 0
    arrays = [mesh.vertices, mesh.faces, mesh.normals, mesh.radius, mesh.section[5:]]
    copies = [array.copy() for array in arrays]
    del mesh
    gc.collect()
    nt.mesh(cell, level=3)
    assert all((a == b).all() for a, b in zip(arrays, copies, strict=True))


def test_every_format_is_written_and_read_back(mesh: nt.Mesh, tmp_path: Path) -> None:
    for extension in ("ply", "obj", "stl", "glb", "off", "vtu", "msh", "msh2", "poly", "smesh"):
        path = tmp_path / f"mesh.{extension}"
        mesh.save(path)
        again = nt.read_mesh(path)
        report = nt.check(path, merge=extension == "stl")
        assert report["closed"], extension
        assert len(again.faces) == len(mesh.faces)
        assert nt.check(again, merge=extension == "stl")["volume"] == pytest.approx(mesh.volume, rel=1e-4)
    mesh.save(tmp_path / "colored.obj", materials=True)
    assert "usemtl soma" in (tmp_path / "colored.obj").read_text()
    assert "newmtl soma" in (tmp_path / "colored.mtl").read_text()
    assert not (tmp_path / "mesh.mtl").exists()
    mesh.save(tmp_path / "colored.glb", materials=True)
    assert b'"materials"' in (tmp_path / "colored.glb").read_bytes()
    assert b'"materials"' not in (tmp_path / "mesh.glb").read_bytes()
    with pytest.raises(ValueError, match="ply knows no materials"):
        mesh.save(tmp_path / "x.ply", materials=True)
    for extension in ("glb", "ply", "vtu"):
        mesh.save(tmp_path / f"by_type.{extension}", color_by="type")
    by_type = nt.read_mesh(tmp_path / "by_type.vtu")
    assert len(np.unique(by_type.attributes["RGB"], axis=0)) == len(np.unique(mesh.type))
    assert {"red", "green", "blue"} <= set(nt.read_mesh(tmp_path / "by_type.ply").attributes)
    assert b"COLOR_0" in (tmp_path / "by_type.glb").read_bytes()
    mesh.save(tmp_path / "small.glb", compress="draco", color_by="type")
    small = nt.read_mesh(tmp_path / "small.glb")
    assert small.closed and small.volume == pytest.approx(mesh.volume, rel=1e-3)
    assert (np.sort(small.point) == np.sort(mesh.point)).all()
    assert 6 * (tmp_path / "small.glb").stat().st_size < (tmp_path / "mesh.glb").stat().st_size
    for wrong, told in [
        ({"compress": "draco", "path": "x.ply"}, "only glb is compressed"),
        ({"compress": "zip", "path": "x.glb"}, "compress='zip': use draco"),
        ({"color_by": "type", "path": "x.stl"}, "stl has no colors of vertices"),
        ({"color_by": "type", "color": "radius", "path": "x.glb"}, "both give colors"),
        ({"compress": "draco", "materials": True, "path": "x.glb"}, "use color_by"),
    ]:
        name = str(wrong.pop("path"))
        with pytest.raises(ValueError, match=told):
            mesh.save(tmp_path / name, **wrong)  # type: ignore[arg-type]
    mesh.save(tmp_path / "meters.ply", unit="m")
    assert nt.read_mesh(tmp_path / "meters.ply").volume == pytest.approx(mesh.volume * 1e-18, rel=1e-3)
    with pytest.raises(ValueError, match="unit='mm'"):
        mesh.save(tmp_path / "x.ply", unit="mm")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="unknown mesh format"):
        mesh.save(tmp_path / "x.png")
    with pytest.raises(FileExistsError):
        mesh.save(tmp_path / "meters.ply", overwrite=False)
    with pytest.raises(FileNotFoundError):
        nt.check(tmp_path / "missing.ply")
    (tmp_path / "broken.off").write_text("OFF\n1 1 0\n0 0 zero\n")
    with pytest.raises(nt.ReadError) as caught:
        nt.read_mesh(tmp_path / "broken.off")
    assert caught.value.line == 3


def test_meshes_are_pickled(mesh: nt.Mesh) -> None:
    again = pickle.loads(pickle.dumps(mesh))
    assert (again.vertices == mesh.vertices).all() and (again.faces == mesh.faces).all()
    assert again.report == mesh.report and again.warnings == mesh.warnings
    assert again.check() == mesh.check()


def test_meshes_of_ones_own_are_checked() -> None:
    corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]
    report = nt.Mesh.from_arrays(corners, faces).check()
    assert report["closed"] and report["volume"] == pytest.approx(1 / 6)
    assert not nt.Mesh.from_arrays(corners, faces[:3]).closed
    with pytest.raises(ValueError, match="none of the 4 vertices"):
        nt.Mesh.from_arrays(corners, [[0, 1, 4]])
    with pytest.raises(ValueError, match="shape"):
        nt.Mesh.from_arrays(corners, [[0, 1, 2, 3]])
    with pytest.raises(ValueError, match="not indices"):
        nt.Mesh.from_arrays(corners, [[0, 1, -1]])
    with pytest.raises(TypeError):
        nt.Mesh.from_arrays("corners", faces, 3)  # type: ignore[misc]


@pytest.mark.full
def test_trimesh_agrees(mesh: nt.Mesh) -> None:
    pytest.importorskip("trimesh")
    theirs = mesh.to_trimesh()
    assert theirs.is_watertight and theirs.is_winding_consistent
    assert theirs.volume == pytest.approx(mesh.volume, rel=1e-6)
    assert theirs.area == pytest.approx(mesh.area, rel=1e-6)
    assert np.shares_memory(np.asarray(theirs.vertices), mesh.vertices)
    assert (theirs.vertex_attributes["type"] == mesh.type).all()


@pytest.mark.full
def test_pyvista_agrees(mesh: nt.Mesh) -> None:
    pytest.importorskip("pyvista")
    theirs = mesh.to_pyvista()
    assert theirs.n_cells == len(mesh.faces) and theirs.is_manifold
    assert theirs.volume == pytest.approx(mesh.volume, rel=1e-4)
    assert (theirs.point_data["section"] == mesh.section).all()
    assert np.shares_memory(theirs.points, mesh.vertices)


def test_cells_far_from_the_origin_are_as_smooth(cell: nt.Morphology) -> None:
    table = cell.to_table()
    for axis in "xyz":
        table[axis] += 50_000.0
    far = nt.mesh(nt.Morphology.from_table(table), level=2)
    assert far.vertices.min() > 40_000 and far.closed
    near = nt.mesh(nt.Morphology.from_table(cell.to_table()), level=2)
    assert far.volume == pytest.approx(near.volume, rel=1e-3)


def test_too_little_memory_is_an_error_beforehand() -> None:
    """In a process of its own, whose memory is limited."""
    script = """
import resource, sys
import neurotess as nt
cell = nt.synth("pyramidal", seed=1, points=2000)
nt.mesh(cell, level=1)
with open("/proc/self/status") as status:
    used = next(int(line.split()[1]) for line in status if line.startswith("VmSize:"))
resource.setrlimit(resource.RLIMIT_AS, (1024 * used + (400 << 20),) * 2)
for options in ({"level": 64}, {"level": 64, "crossings": "merge"}):
    try:
        nt.mesh(cell, threads=1, **options)
    except MemoryError as error:
        assert "of memory are needed, and" in str(error) and "level" in str(error), error
    else:
        sys.exit(f"{options} was made")
assert len(nt.mesh(cell, level=1, threads=1).vertices)
"""
    if not sys.platform.startswith("linux"):
        pytest.skip("other systems do not tell")
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_stl_far_from_the_origin_is_told(cell: nt.Morphology, tmp_path: Path) -> None:
    far = nt.mesh(nt.edit(cell, translate=(2e6, 0, 0)), level=1)
    with pytest.warns(nt.NeurotessWarning, match="stl rounds by .* save as ply"):
        far.save(tmp_path / "far.stl")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        far.save(tmp_path / "far.ply")
        nt.mesh(cell, level=1).save(tmp_path / "near.stl")


def _arguments(options: dict[str, Any]) -> list[str]:
    """Options as arguments: ``max_error=0.1`` is ``--max-error=0.1``; None and False are left out."""
    from neurotess._options import word

    words: list[str] = []
    for name, value in options.items():
        flag = "--" + name.replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            words.append(flag)
        elif isinstance(value, dict):
            words += [f"{flag}={word(of)}={word(to)}" for of, to in value.items()]
        elif isinstance(value, (str, Path)) or not hasattr(value, "__iter__"):
            words.append(f"{flag}={word(value)}")
        else:
            words.append(f"{flag}={','.join(map(word, value))}")
    return words
