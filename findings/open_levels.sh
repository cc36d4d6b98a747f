#!/usr/bin/env bash
# A closed surface is open along the cuts of igneous' multiresolution meshes, at the levels that are looked at up close.
#
# A torus of 80,000 triangles is closed: each edge is shared by two faces, in opposite directions. igneous makes the
# multiresolution mesh of it that neuroglancer draws, and cloud-volume reads each level back and joins its pieces
# (`consolidate`), which it is to do without seams.
#
#   igneous-pipeline 4.37.0, cloud-volume 12.15.2
#     its input, read by cloud-volume:      no open edge
#     levels of several pieces (0 and 1):   thousands of open edges, also when vertices that lie within 4 nm (20 steps of
#                                           the places in a piece) are joined before
#     the level of one piece (2):           none
#
# So volumes, and whatever asks for an inside, are to be taken from the meshes that were put in, or from the coarsest level.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"${PYTHON:-python3}" -m venv env
env/bin/pip install -q igneous-pipeline==4.37.0 cloud-volume==12.15.2 2> errors || { cat errors; exit 1; }
cat > levels.py <<'PY'
import json
import pathlib

import numpy as np
from cloudvolume import CloudVolume, Mesh
from igneous.task_creation import create_unsharded_multires_mesh_tasks
from taskqueue import LocalTaskQueue

LEVELS = 3
# Twenty steps of the 16 bits that a place has in a piece of level 0, which is 12 µm wide.
STEP = 4


def torus(around, across):
    """Points (nm) and faces."""
    u, v = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    a, b = 2 * np.pi * u / around, 2 * np.pi * v / across
    ring = 20_000 + 4_000 * np.cos(b)
    points = np.stack([ring * np.cos(a), ring * np.sin(a), 4_000 * np.sin(b)], axis=-1).reshape(-1, 3) + 30_000
    index = lambda i, j: (i % around) * across + j % across
    corners = [index(u, v), index(u + 1, v), index(u + 1, v + 1), index(u, v + 1)]
    p, q, r, s = (corner.ravel() for corner in corners)
    return points.astype(np.float32), np.concatenate([np.stack([p, q, r], 1), np.stack([p, r, s], 1)])


def unpaired(faces):
    """Edges without a way back, and those that come twice."""
    faces = np.asarray(faces, dtype=np.int64)
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    forth, back = (edges[:, 0] << 32) | edges[:, 1], (edges[:, 1] << 32) | edges[:, 0]
    names, counts = np.unique(forth, return_counts=True)
    return edges[~np.isin(forth, back) | np.isin(forth, names[counts > 1])]


def joined(mesh, step):
    """Faces between vertices that are one if they are the same after rounding to a step (nm)."""
    places = np.round(np.asarray(mesh.vertices, dtype=float) / step).astype(np.int64)
    faces = np.unique(places, axis=0, return_inverse=True)[1].reshape(-1)[np.asarray(mesh.faces)]
    return faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]


def pieces(index, level):
    """How many fragments a level has, of the manifest."""
    levels = int(np.frombuffer(index, "<u4", 1, 24)[0])
    return int(np.frombuffer(index, "<u4", levels, 28 + 16 * levels)[level])


points, faces = torus(400, 100)
path = pathlib.Path("volume").resolve()
info = CloudVolume.create_new_info(
    num_channels=1,
    layer_type="segmentation",
    data_type="uint64",
    encoding="raw",
    resolution=[1, 1, 1],
    voxel_offset=[0, 0, 0],
    volume_size=[60_000] * 3,
    mesh="mesh",
)
CloudVolume(f"precomputed://file://{path}", info=info).commit_info()
(path / "mesh").mkdir()
(path / "mesh/info").write_text(json.dumps({"@type": "neuroglancer_legacy_mesh", "mip": 0}))
(path / "mesh/1:0:0-1_0-1_0-1").write_bytes(Mesh(points, faces.astype(np.uint32), segid=1).to_precomputed())
(path / "mesh/1:0").write_text(json.dumps({"fragments": ["1:0:0-1_0-1_0-1"]}))

given = CloudVolume(f"precomputed://file://{path}", progress=False).mesh.get(1)
given = given[1] if isinstance(given, dict) else given
before = len(unpaired(given.consolidate().faces))
print("given:  ", len(faces), "triangles,", before, "open edges")
assert before == 0, "the torus is closed"

(path / "mesh/1:0").unlink()
queue = LocalTaskQueue(parallel=1, progress=False)
tasks = create_unsharded_multires_mesh_tasks(
    f"precomputed://file://{path}", num_lod=LEVELS - 1, magnitude=1, mesh_dir="mesh"
)
queue.insert(tasks)
queue.execute()
made = CloudVolume(f"precomputed://file://{path}", progress=False)
index = (path / "mesh/1.index").read_bytes()
for level in range(LEVELS):
    mesh = made.mesh.get(1, lod=level)[1].consolidate()
    edges, count = unpaired(mesh.faces), pieces(index, level)
    apart = len(unpaired(joined(mesh, STEP)))
    print(f"level {level}: {count} pieces, {len(mesh.faces)} triangles, {len(edges)} open edges, {apart} of places {STEP} nm wide")
    assert apart > 1000 or count == 1, "and stay open where near vertices are joined"
    assert (len(edges) > 0) == (count > 1), "levels of several pieces are said to be open, and no other"
PY
env/bin/python levels.py 2> errors || { cat errors; exit 1; }
