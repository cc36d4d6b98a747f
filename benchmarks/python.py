"""Times the Python package beside MorphIO, navis and the command line, in one run.

Run it in an environment with the package (a release build: `cargo xtask wheel`), MorphIO and navis:

    python benchmarks/python.py samples/*.swc

Prints a table in Markdown. Times are the best of several runs.
"""

from __future__ import annotations

import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

import neurotess as nt

#: Cells and threads of the batch.
BATCH, THREADS = 1000, 2


def best(work: Callable[[], object], runs: int) -> float:
    """Milliseconds of the fastest of some runs."""
    times = []
    for _ in range(runs):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return 1e3 * min(times)


def imports() -> float:
    """Milliseconds of `import neurotess` in a new interpreter."""
    code = "import time; t = time.perf_counter(); import neurotess; print(time.perf_counter() - t)"
    command = [sys.executable, "-c", code]
    runs = [subprocess.run(command, check=True, capture_output=True, text=True) for _ in range(7)]
    return 1e3 * min(float(run.stdout) for run in runs)


def batch() -> tuple[list[float], list[float]]:
    """Seconds of a batch into arrays, and of the command line into files: on the clock and of the processor."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "cells").mkdir()
        paths = []
        for seed in range(BATCH):
            path = folder / "cells" / f"{seed:04}.swc"
            nt.synth("granule", seed=seed, points=400).save(path)
            paths.append(path)
        start = time.perf_counter(), time.process_time()
        done = sum(result.ok for result in nt.mesh_many(paths, threads=THREADS, level=4))
        arrays = [time.perf_counter() - start[0], time.process_time() - start[1]]
        assert done == BATCH
        command = [sys.executable, "-m", "neurotess", "mesh", str(folder / "cells"), "-q"]
        command += ["-o", str(folder / "meshes"), "--threads", str(THREADS)]
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        start = time.perf_counter(), before.ru_utime + before.ru_stime
        subprocess.run(command, check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        files = [time.perf_counter() - start[0], after.ru_utime + after.ru_stime - start[1]]
        return arrays, files


def main() -> None:
    import morphio
    import navis

    print("| cell | points | read, ms | MorphIO, ms | times | mesh, ms | faces | navis, ms | faces | times |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |")
    reads, meshes = [], []
    for file in sys.argv[1:]:
        cell = nt.read(file)
        ours = best(lambda: nt.read(file), 9)
        theirs = best(lambda: morphio.Morphology(file), 9)
        neuron = cell.to_navis()
        mesh = best(lambda: nt.mesh(cell, level=4), 5)
        tubes = best(lambda: navis.conversion.tree2meshneuron(neuron), 2)
        reads.append(theirs / ours)
        meshes.append(tubes / mesh)
        print(
            f"| {cell.name} | {len(cell)} | {ours:.2f} | {theirs:.2f} | {theirs / ours:.1f} "
            f"| {mesh:.1f} | {len(nt.mesh(cell, level=4).faces):,} "
            f"| {tubes:.1f} | {len(navis.conversion.tree2meshneuron(neuron).faces):,} | {tubes / mesh:.1f} |"
        )
    print(f"\nMedian: read {np.median(reads):.1f} times, mesh {np.median(meshes):.1f} times as fast.")
    print(f"import neurotess: {imports():.1f} ms")
    arrays, files = batch()
    print(f"{BATCH} cells of 400 points on {THREADS} threads, seconds on the clock and of the processor:")
    print(
        f"{arrays[0]:.2f} and {arrays[1]:.2f} into arrays, {files[0]:.2f} and {files[1]:.2f} by the command"
    )


if __name__ == "__main__":
    main()
