"""Work on a cluster of several processes, one of which is killed."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import neurotess as nt
import pytest

pytestmark = pytest.mark.full

OPTIONS = {"level": 6}


@pytest.fixture
def paths(tmp_path: Path) -> list[Path]:
    folder = tmp_path / "cells"
    folder.mkdir()
    made = []
    for seed in range(16):
        path = folder / f"cell_{seed:02}.swc"
        nt.synth("pyramidal", seed=seed, points=400).save(path)
        made.append(path)
    return made


def content(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted(folder.glob("*.ply"))}


def test_one_process_resumes_by_content(paths: list[Path], tmp_path: Path) -> None:
    out = tmp_path / "out"
    bad = paths[0].with_name("bad.swc")
    bad.write_text("1 1 0 0 zero 5 -1\n")
    first = nt.dask.mesh([*paths[:3], bad], out, level=1)
    assert [made.error is None for made in first] == [True, True, True, False]
    assert "ReadError" in str(first[3].error) and not any(made.skipped for made in first)
    again = nt.dask.mesh(paths[:3], out, level=1)
    assert all(made.skipped for made in again)
    paths[0].write_text(paths[0].read_text().replace("\n", " \n") + "# other content\n")
    assert [made.skipped for made in nt.dask.mesh(paths[:3], out, level=1)] == [False, True, True]
    assert not any(made.skipped for made in nt.dask.mesh(paths[:3], out, level=2))
    with pytest.raises(ValueError, match="level"):
        nt.dask.mesh(paths, out, level=100)
    with pytest.raises(ValueError, match="several files"):
        nt.dask.mesh([paths[0], paths[0]], out)


@contextmanager
def cluster_that_loses_a_worker(out: Path, files: str) -> Iterator[Any]:
    """A client of two workers, one of which is killed as soon as `out` has one of the files."""
    distributed = pytest.importorskip("distributed")
    cluster = distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    )
    with cluster, distributed.Client(cluster) as client:
        pids = list(client.run(os.getpid).values())
        ended = threading.Event()

        def kill() -> None:
            while not any(out.glob(files)) and not ended.wait(0.001):
                pass
            os.kill(pids[0], signal.SIGKILL)

        killer = threading.Thread(target=kill)
        killer.start()
        try:
            yield client
        finally:
            ended.set()
            killer.join()


def test_a_killed_worker_changes_nothing(paths: list[Path], tmp_path: Path) -> None:
    alone, out = tmp_path / "alone", tmp_path / "out"
    nt.dask.mesh(paths, alone, **OPTIONS)
    with cluster_that_loses_a_worker(out, "*.ply") as client:
        made = nt.dask.mesh(paths, out, client, **OPTIONS)
    assert [one.error for one in made] == [None] * len(paths)
    assert content(out) == content(alone) and len(content(out)) == len(paths)


def everything(folder: Path) -> dict[str, bytes]:
    files = (path for path in folder.rglob("*") if path.is_file())
    return {str(path.relative_to(folder)): path.read_bytes() for path in files}


def test_a_killed_worker_leaves_neuroglancer_a_whole_folder(paths: list[Path], tmp_path: Path) -> None:
    alone, out = tmp_path / "alone", tmp_path / "out"
    options: dict[str, Any] = {"max_error": 0.1, "lods": 3}
    nt.neuroglancer(paths, alone, **options)
    with cluster_that_loses_a_worker(out, "mesh/*.index") as client:
        made = nt.dask.neuroglancer(paths, out, client, **options)
        assert made["failed"] == [] and made["link"] and made["written"] <= len(paths)
        assert made["written"] + made["kept"] == len(paths)
        again = nt.dask.neuroglancer(paths, out, client, **options)
        assert (again["written"], again["kept"]) == (0, len(paths))
        with pytest.raises(FileExistsError, match="other options"):
            nt.dask.neuroglancer(paths, out, client, lods=1)
    assert everything(out) == everything(alone)


def test_workers_write_shards_of_their_own(tmp_path: Path) -> None:
    folder = tmp_path / "circuit"
    command = [sys.executable, "-m", "neurotess", "synth", "circuit", "-o", str(folder), "--quiet"]
    command += ["--neurons", "2100", "--morphologies", "4", "--points", "60", "--synapses", "2"]
    subprocess.run(command, check=True)
    circuit = nt.Circuit(folder)
    alone, out = tmp_path / "alone", tmp_path / "out"
    options: dict[str, Any] = {"max_error": 0.5, "lods": 2, "sharded": True}
    options["synapses"] = ["cortex__cortex__chemical"]
    nt.neuroglancer(circuit, alone, **options)
    assert len(list((alone / "mesh").glob("*.shard"))) > 4
    with cluster_that_loses_a_worker(out, "mesh/*.shard") as client:
        made = nt.dask.neuroglancer(circuit, out, client, **options)
    assert made["failed"] == [] and made["written"] + made["kept"] == len(circuit)
    assert everything(out) == everything(alone)


def test_options_that_workers_set_are_refused(paths: list[Path], tmp_path: Path) -> None:
    for name in ("shard", "resume", "overwrite"):
        with pytest.raises(TypeError, match=name):
            nt.dask.neuroglancer(paths, tmp_path / "out", **{name: True})
    with pytest.raises(ValueError, match="parts=0"):
        nt.dask.neuroglancer(paths, tmp_path / "out", parts=0)
    one = nt.dask.neuroglancer(paths[0], tmp_path / "out", lods=1, max_error=0.5)
    assert (one["written"], one["failed"]) == (1, [])
