"""Times the Python package beside MorphIO, navis and the command line, in one run.

Run it in an environment with the package (a release build: `cargo xtask wheel`), MorphIO and navis:

    python benchmarks/python.py samples/*.swc

Prints a table in Markdown. Times are the best of several runs.
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

import neurotess as nt

#: Points of each cell of the batch, threads that mesh them, and the level of all meshes.
POINTS, THREADS, LEVEL = 5000, 2, 4


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


def batch(cells: int) -> None:
    """Times a batch into arrays beside the command, without what the command takes to write its files."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "cells").mkdir()
        paths = []
        for seed in range(cells):
            path = folder / "cells" / f"{seed:04}.swc"
            nt.synth("granule", seed=seed, points=POINTS).save(path)
            paths.append(path)
        before, start = most_memory(), time.perf_counter()
        largest = done = 0
        for result in nt.mesh_many(paths, threads=THREADS, level=LEVEL):
            assert result.mesh is not None, result.error
            arrays = (result.mesh.vertices, result.mesh.normals, result.mesh.faces)
            largest = max(largest, sum(array.nbytes for array in arrays) + 16 * len(arrays[0]))
            done += 1
        ours = time.perf_counter() - start
        assert done == cells
        grown = most_memory() - before
        command = [sys.executable, "-m", "neurotess", "mesh", str(folder / "cells"), "--json", "--quiet"]
        command += ["-o", str(folder / "meshes"), "--threads", str(THREADS), "--level", str(LEVEL)]
        start = time.perf_counter()
        ran = subprocess.run(command, check=True, capture_output=True, text=True)
        files = time.perf_counter() - start
        stages = [cell["seconds"] for cell in json.loads(ran.stdout)]
        made = sum(cell[stage] for cell in stages for stage in ("read", "soma", "coarse", "refine"))
        theirs = made / THREADS
    print(f"\n{cells} cells of {POINTS} points on {THREADS} threads: {ours:.2f} s into arrays;")
    print(f"by the command {theirs:.2f} s without writing ({ours / theirs:.2f} times), {files:.2f} s into files.")
    print(f"The largest mesh has {largest / 1e6:.1f} MB of arrays; memory grew by {grown / 1e6:.0f} MB at most.")


def most_memory() -> int:
    """The most memory (bytes) that this process has had so far."""
    return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def level_of(cell: nt.Morphology, faces: int) -> int:
    """The level whose number of triangles is nearest to this one."""
    numbers = {level: len(nt.mesh(cell, level=level).faces) for level in range(1, LEVEL + 1)}
    return min(numbers, key=lambda level: abs(np.log(numbers[level] / faces)))


def cells(files: list[str]) -> None:
    """Times reading and meshing of each file."""
    import morphio
    import navis

    print("| cell | points | read, ms | MorphIO, ms | times | mesh, ms | faces | navis, ms | faces | times ", end="")
    print("| mesh like navis', ms | faces | times | faces/µs | navis |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |")
    reads, meshes, alike = [], [], []
    for file in files:
        cell = nt.read(file)
        ours = best(lambda: nt.read(file), 9)
        theirs = best(lambda: morphio.Morphology(file), 9)
        neuron = cell.to_navis()
        tubes = len(navis.conversion.tree2meshneuron(neuron).faces)
        near = level_of(cell, tubes)
        mesh, as_coarse, of_navis = [], [], []
        # In turn, so that a moment when the machine is busy is one for all.
        for _ in range(5):
            mesh.append(best(lambda: nt.mesh(cell, level=LEVEL), 1))
            as_coarse.append(best(lambda: nt.mesh(cell, level=near), 1))
            of_navis.append(best(lambda: navis.conversion.tree2meshneuron(neuron), 1))
        fine, coarse, navis_ms = min(mesh), min(as_coarse), min(of_navis)
        faces = [len(nt.mesh(cell, level=level).faces) for level in (LEVEL, near)]
        reads.append(theirs / ours)
        meshes.append(navis_ms / fine)
        alike.append(navis_ms / coarse)
        print(
            f"| {cell.name} | {len(cell)} | {ours:.2f} | {theirs:.2f} | {theirs / ours:.1f} "
            f"| {fine:.1f} | {faces[0]:,} | {navis_ms:.1f} | {tubes:,} | {navis_ms / fine:.1f} "
            f"| {coarse:.1f} | {faces[1]:,} | {navis_ms / coarse:.1f} "
            f"| {faces[0] / fine / 1e3:.1f} | {tubes / navis_ms / 1e3:.1f} |"
        )
    print(f"\nMedian: read {np.median(reads):.1f} times, mesh {np.median(meshes):.1f} times as fast,")
    print(f"with about as many triangles {np.median(alike):.1f} times.")


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("files", nargs="*", help="tracings")
    parser.add_argument("--batch", type=int, default=1000, help="cells of the batch; 0 for none")
    arguments = parser.parse_args()
    if arguments.files:
        cells(arguments.files)
    print(f"import neurotess: {imports():.1f} ms")
    if arguments.batch:
        batch(arguments.batch)


if __name__ == "__main__":
    main()
