"""Many cells, threads, interrupts."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import neurotess as nt
import pytest


def test_one_bad_file_does_not_end_the_batch(samples: Path, tmp_path: Path) -> None:
    bad = tmp_path / "bad.swc"
    bad.write_text("1 1 0 0 zero 5 -1\n")
    paths = [samples / "granule.swc", bad, tmp_path / "missing.swc", samples / "star.swc"]
    results = list(nt.mesh_many(paths, threads=2, level=1))
    assert [result.input for result in results] == paths
    assert [result.ok for result in results] == [True, False, False, True]
    assert isinstance(results[1].error, nt.ReadError) and results[1].error.line == 1
    assert isinstance(results[2].error, FileNotFoundError)
    assert results[3].mesh is not None and results[3].mesh.closed


def test_folders_and_single_cells_are_batches(samples: Path, tmp_path: Path) -> None:
    for name in ("star", "granule"):
        (tmp_path / f"{name}.swc").write_bytes((samples / f"{name}.swc").read_bytes())
    (tmp_path / "notes.txt").write_text("no tracing")
    made = list(nt.mesh_many(tmp_path, level=1, threads=2))
    assert [Path(str(result.input)).name for result in made] == ["granule.swc", "star.swc"]
    assert all(result.ok for result in made)
    [one] = nt.mesh_many(str(samples / "star.swc"), level=1)
    [same] = nt.mesh_many(nt.read(samples / "star.swc"), level=1)
    assert one.mesh is not None and same.mesh is not None and (one.mesh.vertices == same.mesh.vertices).all()
    (tmp_path / "empty").mkdir()
    with pytest.raises(nt.ReadError, match="has no tracings"):
        nt.mesh_many(tmp_path / "empty")


def test_files_become_files_and_stay_while_they_are_up_to_date(samples: Path, tmp_path: Path) -> None:
    cells, meshes = tmp_path / "cells", tmp_path / "meshes"
    (cells / "sub").mkdir(parents=True)
    (cells / "star.swc").write_bytes((samples / "star.swc").read_bytes())
    (cells / "sub/granule.swc").write_bytes((samples / "granule.swc").read_bytes())
    (cells / "bad.swc").write_text("1 1 0 0 zero 5 -1\n")
    bad, star, granule = nt.mesh_all(cells, meshes, format="off", level=1, threads=2)
    assert "bad.swc:1: " in bad["error"] and star["closed"] and granule["warnings"] is not None
    made = sorted(path.relative_to(meshes).as_posix() for path in meshes.rglob("*.off"))
    assert made == ["star.off", "sub/granule.off"]
    _, star, granule = nt.mesh_all(cells, meshes, format="off", level=1, resume=True)
    assert star["skipped"] and granule["skipped"]
    _, star, _ = nt.mesh_all(cells, meshes, format="off", level=1)
    assert "resume=True" in star["error"]
    [one] = nt.mesh_all(str(cells / "*.swc"), meshes, format="off", level=1, overwrite=True, shard=(2, 2))
    assert one["file"].endswith("star.swc") and one["closed"]
    for wrong in ({"format": "doc"}, {"shard": (3, 2)}, {"threads": 0}, {"level": 100}):
        with pytest.raises(ValueError):
            nt.mesh_all(cells, meshes, **wrong)


def test_any_number_of_threads_gives_the_same() -> None:
    cells = [nt.synth("granule", seed=seed, points=80) for seed in range(6)]
    one = [result.mesh for result in nt.mesh_many(cells, threads=1, level=2)]
    three = [result.mesh for result in nt.mesh_many(iter(cells), threads=3, level=2)]
    alone = [nt.mesh(cell, level=2, threads=2) for cell in cells]
    for a, b, c in zip(one, three, alone, strict=True):
        assert a is not None and b is not None
        assert (a.vertices == b.vertices).all() and (a.faces == b.faces).all()
        assert (a.vertices == c.vertices).all() and (a.faces == c.faces).all()


def test_inputs_are_taken_as_they_are_needed() -> None:
    taken = 0

    def cells() -> Iterator[nt.Morphology]:
        nonlocal taken
        while True:
            taken += 1
            yield nt.synth("granule", seed=taken, points=50)

    results = nt.mesh_many(cells(), threads=2, level=1)
    for _ in range(3):
        next(results)
    assert taken <= 3 + 2 * 2
    results.close()  # type: ignore[attr-defined]


def test_wrong_options_are_told_at_once() -> None:
    with pytest.raises(ValueError, match="level"):
        nt.mesh_many([], level=100)
    with pytest.raises(ValueError, match="threads"):
        nt.mesh_many([], threads=0)


def test_other_threads_run_meanwhile() -> None:
    """The interpreter is free while a cell is meshed: a thread that counts is not stopped."""
    cell = nt.synth("purkinje", points=3000)
    done, counted = threading.Event(), []

    def count() -> None:
        number = 0
        while not done.is_set():
            number += 1
            time.sleep(0.001)
        counted.append(number)

    counter = threading.Thread(target=count)
    counter.start()
    nt.mesh(cell, level=8)
    done.set()
    counter.join()
    # A sleep is a millisecond and more; a lock held all the time would leave a count of about 1.
    assert counted[0] > 3


def test_one_cell_is_shared_by_threads() -> None:
    cell = nt.synth("star", points=300)
    found: list[object] = []
    work = [
        lambda: found.append(nt.mesh(cell, level=1).vertices.sum()),
        lambda: found.append(cell.points.sum() and None),
    ]
    threads = [threading.Thread(target=work[i % 2]) for i in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len({value for value in found if value is not None}) == 1 and len(found) == 8


#: What takes much longer than the tests wait, as `work(cell)`.
LONG_WORK = {
    "mesh": "nt.mesh(cell, level=2)",
    "separate": "nt.mesh(cell, crossings='separate', level=1)",
    "merge": "nt.mesh(cell, crossings='merge', level=8, types='axon,dendrite')",
    "mesh_many": "list(nt.mesh_many([cell] * 50, threads=2, level=4))",
    "mesh_all": "cell.save('cell.swc'); nt.mesh_all('cell.swc', 'meshes', crossings='separate', level=1)",
    "render": "nt.render(cell, size=(8000, 8000), samples=64)",
}
#: Samples of the cell, where 100,000 are too many or too soon done.
POINTS = {"render": 3000, "mesh": 2_000_000}


@pytest.mark.skipif(os.name != "posix", reason="signals are those of POSIX")
@pytest.mark.parametrize("work", LONG_WORK)
def test_interrupts_stop_the_work(work: str, tmp_path: Path) -> None:
    code = f"""
        import os, signal, time, neurotess as nt
        # Where the tests run in the background, it is ignored.
        signal.signal(signal.SIGINT, signal.default_int_handler)
        cell = nt.synth("purkinje", points={POINTS.get(work, 100_000)}, may_cross=True)
        def used():
            # Of all threads.
            return time.process_time()
        try:
            print("begin", flush=True)
            {LONG_WORK[work]}
        except KeyboardInterrupt:
            print("interrupted", flush=True)
            start = used()
            while True:
                before = used()
                time.sleep(0.5)
                if used() - before < 0.1:
                    break
            print(used() - start, flush=True)
            os._exit(0)
        print("done", flush=True)
    """
    command = [sys.executable, "-c", textwrap.dedent(code)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=tmp_path) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "begin\n"
        time.sleep(1.0)
        process.send_signal(signal.SIGINT)
        assert process.stdout.readline() == "interrupted\n"
        # Seconds of the processor until everything was quiet; all of the work would take a minute and more.
        assert float(process.stdout.readline()) < 5
    # Nothing half-written.
    assert not [path for path in tmp_path.rglob("*") if path.suffix != ".swc" and path.is_file()]


def test_results_that_nobody_wants_are_not_made() -> None:
    cell = nt.synth("purkinje", points=60_000)
    results = nt.mesh_many([nt.synth("granule", points=50), *[cell] * 8], threads=2, level=1)
    assert next(results).ok
    results.close()  # type: ignore[attr-defined]
    start = time.process_time()
    while True:
        before = time.process_time()
        time.sleep(0.5)
        if time.process_time() - before < 0.1:
            break
    assert time.process_time() - start < 5


def test_processes_share_cells() -> None:
    import multiprocessing

    cell = nt.synth("granule", points=60)
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        mesh = pool.apply(nt.mesh, (cell,), {"level": 1})
    assert (mesh.vertices == nt.mesh(cell, level=1).vertices).all()
