"""Writes cells for neuroglancer by neurotess and by igneous, in the same run: time, bytes, and which levels are closed.

    python neuroglancer_igneous.py CELLS EMPTY_FOLDER [NEUROTESS]

`CELLS` is a folder of tracings named by numbers from 1 to 9, since igneous divides its work by first digits. igneous is given
the finest meshes of ours, so both begin with the same triangles; ours are also meshed in its time. Both take two cores.
Needs igneous-pipeline and cloud-volume.
"""

import json
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
from cloudvolume import CloudVolume, Mesh
from igneous.task_creation import create_unsharded_multires_mesh_tasks
from pathos.pools import ProcessPool
from taskqueue import LocalTaskQueue

CORES = 2
LEVELS = 4


def own(command, cells, out):
    run = [command, "neuroglancer", cells, "-o", out, "--lods", str(LEVELS), "--threads", str(CORES), "--quiet"]
    subprocess.run(run, check=True, stdout=subprocess.DEVNULL)


def give(ours, segments, out):
    """The finest meshes as igneous begins with them: a volume with legacy meshes, in nm."""
    info = CloudVolume.create_new_info(
        num_channels=1,
        layer_type="segmentation",
        data_type="uint64",
        encoding="raw",
        resolution=[1, 1, 1],
        voxel_offset=[0, 0, 0],
        volume_size=[64, 64, 64],
        mesh="mesh",
    )
    volume = CloudVolume(url(out), info=info)
    volume.commit_info()
    (out / "mesh").mkdir()
    (out / "mesh/info").write_text(json.dumps({"@type": "neuroglancer_legacy_mesh", "mip": 0}))
    triangles = 0
    for segment in segments:
        mesh = consolidated(ours, segment, 0)
        triangles += len(mesh.faces)
        plain = Mesh(mesh.vertices, mesh.faces, segid=segment)
        (out / f"mesh/{segment}:0:0-1_0-1_0-1").write_bytes(plain.to_precomputed())
    return triangles


def theirs(out):
    tasks = create_unsharded_multires_mesh_tasks(url(out), num_lod=LEVELS - 1, magnitude=1, mesh_dir="mesh")
    queue = LocalTaskQueue(parallel=CORES, progress=False)
    queue.insert(tasks)
    queue.execute()
    # Ended, so that their processor seconds count.
    pool = ProcessPool(CORES)
    pool.close()
    pool.join()
    pool.clear()


def url(folder):
    return f"precomputed://file://{folder}"


def opened(folder):
    return CloudVolume(url(folder), use_https=False, progress=False)


def consolidated(volume, segment, level):
    return volume.mesh.get(segment, lod=level)[segment].consolidate()


def open_edges(faces):
    """Edges without a way back."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]).astype(np.int64)
    forth, back = edges[:, 0] << 32 | edges[:, 1], edges[:, 1] << 32 | edges[:, 0]
    return int((~np.isin(forth, back)).sum() + len(forth) - len(np.unique(forth)))


def judged(folder, segments):
    """Levels of all cells: cells that have one, those that are closed, triangles, open edges."""
    volume = opened(folder)
    levels = []
    for level in range(LEVELS):
        told = {"level": level, "cells": 0, "closed": 0, "triangles": 0, "open_edges": 0}
        for segment in segments:
            try:
                mesh = consolidated(volume, segment, level)
            except Exception as error:  # a cell without this level
                told["error"] = f"{type(error).__name__}: {error}"
                continue
            unpaired = open_edges(mesh.faces)
            told["cells"] += 1
            told["closed"] += unpaired == 0
            told["triangles"] += len(mesh.faces)
            told["open_edges"] += unpaired
        levels.append(told)
    return levels


def size(folder, segments):
    files = [folder / f"mesh/{segment}{end}" for segment in segments for end in ("", ".index")]
    return sum(file.stat().st_size for file in files)


def timed(work):
    """Seconds by the clock and of processors, of this process and those that it started."""
    clock, processors = time.perf_counter(), os.times()
    work()
    ended = os.times()
    return round(time.perf_counter() - clock, 2), round(sum(ended[:4]) - sum(processors[:4]), 2)


def main():
    cells, folder = (Path(path).resolve() for path in sys.argv[1:3])
    command = sys.argv[3] if len(sys.argv) > 3 else shutil.which("neurotess")
    segments = sorted(int(file.stem) for file in cells.glob("*.swc"))
    ours, igneous = folder / "ours", folder / "igneous"
    own_seconds = timed(lambda: own(command, cells, ours))
    triangles = give(opened(ours), segments, igneous)
    their_seconds = timed(lambda: theirs(igneous))
    told = {"cells": len(segments), "finest_triangles": triangles, "ratio": their_seconds[0] / own_seconds[0]}
    for name, seconds, out in [("neurotess", own_seconds, ours), ("igneous", their_seconds, igneous)]:
        told[name] = {"seconds": seconds[0], "processor_seconds": seconds[1], "bytes": size(out, segments)}
        told[name]["levels"] = judged(out, segments)
    print(json.dumps(told, indent=1))


if __name__ == "__main__":
    main()
