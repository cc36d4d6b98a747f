"""Meshes on a cluster of several processes, one of which is killed."""

from __future__ import annotations

import os
import signal
from pathlib import Path

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


def test_a_killed_worker_changes_nothing(paths: list[Path], tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    alone = tmp_path / "alone"
    nt.dask.mesh(paths, alone, **OPTIONS)
    cluster = distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    )
    with cluster, distributed.Client(cluster) as client:
        pids = list(client.run(os.getpid).values())
        out = tmp_path / "out"
        out.mkdir()
        # Killed as soon as the first mesh is there.
        import threading

        def kill() -> None:
            while not any(out.glob("*.ply")):
                pass
            os.kill(pids[0], signal.SIGKILL)

        killer = threading.Thread(target=kill)
        killer.start()
        made = nt.dask.mesh(paths, out, client, **OPTIONS)
        killer.join()
    assert [one.error for one in made] == [None] * len(paths)
    assert content(out) == content(alone) and len(content(out)) == len(paths)
