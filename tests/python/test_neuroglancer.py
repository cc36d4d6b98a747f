"""What `neurotess neuroglancer` writes, in other people's programs: cloud-volume, Google's Draco decoder by DracoPy, and the
client of neuroglancer itself in Chromium without a window."""

from __future__ import annotations

import json
import math
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import neurotess as nt

pytestmark = pytest.mark.full

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
NM = 1000.0


def command(*arguments: object) -> list[str]:
    return [sys.executable, "-m", "neurotess", "neuroglancer", *map(str, arguments)]


def written(out: Path, *arguments: object) -> Path:
    subprocess.run([*command(*arguments, "-o", out), "--quiet"], check=True)
    return out


def volume_of(folder: Path) -> Any:
    cloudvolume = pytest.importorskip("cloudvolume")
    return cloudvolume.CloudVolume(f"precomputed://file://{folder}", use_https=False, progress=False)


@pytest.fixture(scope="module")
def cell_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("cell") / "720575940623456789.swc"
    nt.synth("pyramidal", seed=3, points=400).save(file)
    return file


@pytest.fixture(scope="module")
def long_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A soma with an axon of 5 mm, which turns in all directions."""
    rows = ["1 1 0 0 0 9 -1"]
    for n in range(2, 300):
        turn = 0.05 * n
        x, y, z = 17 * n, 600 * math.sin(turn) + 4 * n, 500 * math.cos(turn) - 500 + 3 * n
        rows.append(f"{n} 2 {x:.3f} {y:.3f} {z:.3f} 0.6 {n - 1}")
    file = tmp_path_factory.mktemp("long") / "axon.swc"
    file.write_text("\n".join(rows) + "\n")
    return file


def is_closed(faces: Any) -> bool:
    """Whether each edge has its way back."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]).astype(np.int64)
    forth = edges[:, 0] << 32 | edges[:, 1]
    back = edges[:, 1] << 32 | edges[:, 0]
    return bool((np.sort(forth) == np.sort(back)).all())


def enclosed(mesh: Any) -> float:
    """Volume (µm³)."""
    a, b, c = (mesh.vertices[mesh.faces[:, n]].astype(np.float64) / NM for n in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


def test_each_level_is_closed_and_the_finest_is_the_cell(cell_file: Path, tmp_path: Path) -> None:
    segment = int(cell_file.stem)
    volume = volume_of(written(tmp_path / "out", cell_file))
    own = nt.mesh(nt.read(cell_file), max_error=0.04)
    volumes = []
    for level in range(4):
        mesh = volume.mesh.get(segment, lod=level)[segment].consolidate()
        assert is_closed(mesh.faces), level
        volumes.append(enclosed(mesh))
    assert abs(volumes[0] / own.volume - 1) < 1e-3
    assert volumes == sorted(volumes, reverse=True)
    finest = volume.mesh.get(segment, lod=0)[segment]
    places = np.asarray(own.vertices) * NM
    step = (places.max(axis=0) - places.min(axis=0)) / 65533
    # Sorted along each axis, places are within half a step, and what rounding to 32 bits adds.
    for axis in range(3):
        ends = [f(finest.vertices[:, axis]) - f(places[:, axis]) for f in (np.min, np.max)]
        assert max(np.abs(ends)) <= 0.5 * step[axis] + 0.1


def test_draco_decodes_whole_numbers_of_sixteen_bits(cell_file: Path, tmp_path: Path) -> None:
    draco = pytest.importorskip("DracoPy")
    folder = written(tmp_path / "out", cell_file)
    index = (folder / f"mesh/{cell_file.stem}.index").read_bytes()
    levels = int(np.frombuffer(index, "<u4", 1, 24)[0])
    nodes = np.frombuffer(index, "<u4", -1, 28 + 20 * levels).reshape(levels, 4)
    data = (folder / f"mesh/{cell_file.stem}").read_bytes()
    start = 0
    for level, size in enumerate(nodes[:, 3]):
        mesh = draco.decode(data[start : start + int(size)])
        points = np.asarray(mesh.points)
        assert (points == points.round()).all() and points.min() >= 0
        assert points.max() < (2**16 if level == 0 else 2**15)
        start += int(size)
    assert start == len(data)


def test_a_long_axon_is_cut_without_cracks(long_file: Path, tmp_path: Path) -> None:
    volume = volume_of(written(tmp_path / "out", long_file))
    own = nt.mesh(nt.read(long_file), max_error=0.04)
    index = (tmp_path / "out/mesh/1.index").read_bytes()
    levels = int(np.frombuffer(index, "<u4", 1, 24)[0])
    fragments = np.frombuffer(index, "<u4", levels, 28 + 16 * levels)
    assert fragments[0] > 4, fragments
    for level in range(levels):
        mesh = volume.mesh.get(1, lod=level)[1].consolidate()
        assert is_closed(mesh.faces), level
        if level == 0:
            assert abs(enclosed(mesh) / own.volume - 1) < 2e-3


def test_skeletons_are_the_tracings(cell_file: Path, tmp_path: Path) -> None:
    segment = int(cell_file.stem)
    volume = volume_of(written(tmp_path / "out", cell_file))
    skeleton = volume.skeleton.get(segment)
    cell = nt.read(cell_file)
    # The soma's point is the first.
    assert np.allclose(skeleton.vertices[1:], np.asarray(cell.points) * NM, atol=0.2)
    assert np.allclose(skeleton.radii[1:], np.asarray(cell.radii) * NM, rtol=1e-6)
    assert list(skeleton.edges[0]) == [0, 1]
    assert (skeleton.edges[:, 0] < skeleton.edges[:, 1]).all()
    names = [attribute["id"] for attribute in skeleton.extra_attributes]
    assert names == ["radius", "vertex_types", "section", "path_distance"]


def test_shards_are_read(circuit_folder: Path, tmp_path: Path) -> None:
    arguments = (circuit_folder, "--max-error", 0.5, "--lods", 2, "--synapses", "all")
    folders = {
        name: written(tmp_path / name, *arguments, *more)
        for name, more in {"single": (), "sharded": ("--sharded",)}.items()
    }
    single, sharded = map(volume_of, folders.values())
    for segment in range(1, 13):
        one, other = (v.mesh.get(segment, lod=0)[segment] for v in (single, sharded))
        assert (one.vertices == other.vertices).all() and (one.faces == other.faces).all()
        one, other = (v.skeleton.get(segment) for v in (single, sharded))
        assert (one.vertices == other.vertices).all() and (one.edges == other.edges).all()
    properties = json.loads((folders["sharded"] / "properties/info").read_text())["inline"]
    assert properties["ids"] == [str(n) for n in range(1, 13)]


def test_synapses_are_read(circuit_folder: Path, tmp_path: Path) -> None:
    cloudvolume = pytest.importorskip("cloudvolume.cloudvolume")
    folder = written(tmp_path / "out", circuit_folder, "--max-error", 0.5, "--lods", 1, "--synapses", "all")
    points = cloudvolume.from_cloudpath(f"precomputed://file://{folder}/synapses")
    everything = points.get_all()
    assert len(everything.geometry) == 12 * 9
    behind = points.get_by_relationship("post", 5)
    assert len(behind.geometry) == 9
    assert {tuple(place) for place in behind.geometry} < {tuple(place) for place in everything.geometry}
    assert (everything.properties["delay"] > 0.4).all()


def test_python_writes_what_the_command_does(cell_file: Path, circuit_folder: Path, tmp_path: Path) -> None:
    made = nt.neuroglancer(cell_file, tmp_path / "python")
    assert (made["written"], made["kept"], made["failed"]) == (1, 0, [])
    command_made = written(tmp_path / "command", cell_file)
    name = f"mesh/{cell_file.stem}"
    assert (tmp_path / "python" / name).read_bytes() == (command_made / name).read_bytes()
    with pytest.raises(FileExistsError, match="resume=True"):
        nt.neuroglancer(cell_file, tmp_path / "python")
    assert nt.neuroglancer(cell_file, tmp_path / "python", resume=True)["kept"] == 1
    with pytest.raises(ValueError, match="Circuit"):
        nt.neuroglancer(cell_file, tmp_path / "no", color_by="layer")
    circuit = nt.Circuit(circuit_folder)
    options: dict[str, Any] = {"max_error": 0.5, "lods": 1, "synapses": ["cortex__cortex__chemical"]}
    some = nt.neuroglancer(circuit, tmp_path / "circuit", nodes=[3, 5], sharded=True, **options)
    assert some["written"] == 2 and some["synapses"] >= 18


@contextmanager
def served(folder: Path, port: int) -> Iterator[None]:
    server = subprocess.Popen([*command("-o", folder), "--serve", "--port", str(port)], stderr=subprocess.PIPE)
    try:
        assert server.stderr is not None and b"until" in server.stderr.readline()
        yield
    finally:
        server.terminate()
        server.wait()


def picture(state: Any, size: tuple[int, int] = (700, 600)) -> Any:
    """What the client draws of a state."""
    neuroglancer = pytest.importorskip("neuroglancer")
    neuroglancer.set_server_bind_address("127.0.0.1")
    viewer = neuroglancer.Viewer()
    viewer.set_state(neuroglancer.ViewerState(state))
    profile = tempfile.mkdtemp()
    flags = ["--headless", "--no-sandbox", "--no-first-run", "--disable-background-networking", "--use-angle=swiftshader"]
    flags += ["--enable-unsafe-swiftshader", f"--user-data-dir={profile}", "--window-size=1280,900"]
    browser = subprocess.Popen([str(CHROMIUM), *flags, str(viewer.get_viewer_url())], stderr=subprocess.DEVNULL)
    try:
        shot = viewer.screenshot(size=list(size))
        return np.asarray(shot.screenshot.image_pixels)[..., :3].astype(int)
    finally:
        browser.terminate()
        browser.wait()
        shutil.rmtree(profile, ignore_errors=True)


@pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not installed")
def test_the_client_shows_the_cell_at_two_zooms(cell_file: Path, tmp_path: Path) -> None:
    port = 20_000 + os.getpid() % 20_000
    folder = written(tmp_path / "out", cell_file, "--port", port)
    state = json.loads((folder / "view.json").read_text())
    state["selectedLayer"]["visible"] = False
    state["layers"][0]["segmentColors"] = {cell_file.stem: "#ff8000"}
    shares = []
    with served(folder, port):
        for scale in (None, 40_000):
            if scale:
                state.update(projectionScale=scale, position=[0, 0, 0])
                state["layers"] = state["layers"][:1]
            pixels = picture(state)
            red, green, blue = pixels[..., 0], pixels[..., 1], pixels[..., 2]
            shares.append(float(((red > 60) & (red > green) & (blue < green / 2)).mean()))
    assert shares[0] > 0.0005, shares
    # The soma fills much of the second.
    assert shares[1] > 0.1, shares
