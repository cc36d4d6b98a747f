"""Meshes of skeletons beside the electron microscopy that they were traced in.

    python benchmarks/reality.py --bin DIR

navis ships five neurons of the hemibrain as skeletons and as EM meshes, in voxels of 8 nm; nothing is fetched. Needs navis
and PyVista. Prints tables in Markdown. Distances are from points spread evenly over one surface to the nearest of the
other, in nm.

What is the skeleton's is told from what is ours by a third shape, which no mesh has a part in: the *cones* of the
skeleton, all balls along its links with radii between those of their ends. From the EM mesh to them, it is the skeleton's;
from our mesh to them, it is ours.
"""

from __future__ import annotations

import argparse
import subprocess
import tempfile
from pathlib import Path

import navis
import numpy as np
import pyvista
import trimesh
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

#: µm of a voxel.
VOXEL = 0.008
#: Points on each surface.
POINTS = 40_000
#: Balls of the cones are so many radii apart: between two, the surface is 0.2 % of a radius lower than at them.
STEP = 1 / 8
#: Balls that may be nearest to a point, by the places of their centers.
NEAR = 96
#: Radius (µm) from which on a ball is asked after by every point: the center of a soma is never near.
LARGE = 1.0
#: A place belongs to a fork within so many of its radii, and to the soma within so many of that.
AT_FORK, AT_SOMA = 3.0, 1.3


class Cones:
    """The balls along the links of a skeleton."""

    def __init__(self, rows: np.ndarray, soma: int | None) -> None:
        """`rows`: id, x, y, z, radius, parent (µm); `soma`: the id of its node."""
        index = {int(row[0]): n for n, row in enumerate(rows)}
        parents = np.array([index.get(int(row[5]), -1) for row in rows])
        places, radii = rows[:, 1:4], rows[:, 4]
        forks = np.bincount(parents[parents >= 0], minlength=len(rows)) > 1
        self.forks, self.fork_radii = places[forks], radii[forks]
        self.soma = None if soma is None else (places[index[soma]], radii[index[soma]])
        centers, sizes = [places], [radii]
        for child, parent in enumerate(parents):
            if parent < 0:
                continue
            length = np.linalg.norm(places[child] - places[parent])
            steps = int(np.ceil(length / (STEP * min(radii[child], radii[parent]))))
            share = np.linspace(0, 1, steps + 1)[1:-1, None]
            centers.append(places[parent] + share * (places[child] - places[parent]))
            sizes.append((radii[parent] + share * (radii[child] - radii[parent]))[:, 0])
        self.centers, self.radii = np.concatenate(centers), np.concatenate(sizes)
        self.large = list(zip(places[radii > LARGE], radii[radii > LARGE], strict=True))
        self.tree = cKDTree(self.centers)

    def distances(self, points: np.ndarray) -> np.ndarray:
        """How far points are outside; negative within."""
        far, near = self.tree.query(points, NEAR)
        outside = (far - self.radii[near]).min(1)
        for center, radius in self.large:
            outside = np.minimum(outside, np.linalg.norm(points - center, axis=1) - radius)
        return outside

    def regions(self, points: np.ndarray) -> np.ndarray:
        """0 along neurites, 1 at forks, 2 at the soma."""
        region = np.zeros(len(points), int)
        far, near = cKDTree(self.forks).query(points)
        region[far < AT_FORK * self.fork_radii[near]] = 1
        if self.soma:
            center, radius = self.soma
            region[np.linalg.norm(points - center, axis=1) < AT_SOMA * radius] = 2
        return region


def spread(mesh: trimesh.Trimesh) -> np.ndarray:
    """Points spread evenly over a mesh, the same in each run."""
    return trimesh.sample.sample_surface(mesh, POINTS, seed=7)[0]


def to_surface(points: np.ndarray, mesh: trimesh.Trimesh) -> np.ndarray:
    """How far points are from the nearest of a surface."""
    surface = pyvista.PolyData.from_regular_faces(np.asarray(mesh.vertices, float), mesh.faces)
    _, nearest = surface.find_closest_cell(points, return_closest_point=True)
    return np.linalg.norm(nearest - points, axis=1)


def volume(mesh: trimesh.Trimesh) -> tuple[float, int]:
    """What a mesh encloses with each of its holes closed by triangles to its middle, and how many holes there are. With
    them open, the sum over triangles depends on where the origin is: by up to 14 % for these EM meshes."""
    faces, places = np.asarray(mesh.faces), mesh.vertices - mesh.vertices.mean(0)
    corners = places[faces]
    enclosed = np.einsum("ij,ij", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
    edges = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    unique, number = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True)
    excess = np.bincount(number.ravel(), weights=np.where(edges[:, 0] < edges[:, 1], 1, -1))
    rim, excess = unique[excess != 0], excess[excess != 0]
    graph = coo_matrix((np.ones(len(rim)), (rim[:, 0], rim[:, 1])), shape=(len(places),) * 2)
    hole_of = connected_components(graph, directed=False)[1][rim[:, 0]]
    holes = np.unique(hole_of)
    for hole in holes:
        at, of = rim[hole_of == hole], excess[hole_of == hole]
        middle = places[np.unique(at)].mean(0)
        # A cap runs against the edges of its rim.
        enclosed -= (of * (np.cross(places[at[:, 0]], places[at[:, 1]]) @ middle)).sum()
    return enclosed / 6, len(holes)


def figures(distances: np.ndarray) -> list[str]:
    """Mean, median, 99 % in nm."""
    distances = 1000 * np.abs(distances)
    return [f"{value:.0f}" for value in (distances.mean(), np.median(distances), np.percentile(distances, 99))]


def plain(mesh: object) -> trimesh.Trimesh:
    """navis' mesh in µm."""
    return trimesh.Trimesh(VOXEL * np.asarray(mesh.vertices), np.asarray(mesh.faces), process=False)


def ours(rows: np.ndarray, soma: int | None, folder: Path, program: Path) -> trimesh.Trimesh:
    """The merged surface of a skeleton, which has no types but for the node of the soma."""
    swc, ply = folder / "cell.swc", folder / "cell.ply"
    with swc.open("w") as file:
        for number, x, y, z, radius, parent in rows:
            kind = 1 if int(number) == soma else 0
            file.write(f"{int(number)} {kind} {x:.6f} {y:.6f} {z:.6f} {radius:.6f} {int(parent)}\n")
    command = [program, "mesh", swc, "-o", ply, "--crossings", "merge", "--force", "--quiet"]
    subprocess.run(command, check=True)
    return trimesh.load(ply, process=False)


def table(head: list[str], rows: list[list[str]]) -> None:
    print("| " + " | ".join(head) + " |")
    print("| --- |" + " ---: |" * (len(head) - 1))
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--bin", type=Path, required=True, help="the folder of neurotess")
    program = parser.parse_args().bin.resolve() / "neurotess"
    navis.set_loggers("ERROR")
    navis.set_pbars(hide=True)
    skeletons = navis.example_neurons(kind="skeleton")
    meshes = {str(mesh.id): mesh for mesh in navis.example_neurons(kind="mesh")}
    beside, split, sizes = [], [], []
    of_regions: dict[int, list[list[np.ndarray]]] = {0: [], 1: [], 2: []}
    for skeleton in skeletons:
        name = str(skeleton.id)
        nodes = skeleton.nodes
        rows = nodes[["node_id", "x", "y", "z", "radius", "parent_id"]].to_numpy(float)
        rows[:, 1:5] *= VOXEL
        soma = None if skeleton.soma is None else int(np.atleast_1d(skeleton.soma)[0])
        cones, real = Cones(rows, soma), plain(meshes[name])
        tubes = plain(navis.conversion.tree2meshneuron(skeleton))
        with tempfile.TemporaryDirectory() as folder:
            mine = ours(rows, soma, Path(folder), program)
        on_real, on_mine, on_tubes = spread(real), spread(mine), spread(tubes)
        there, back = to_surface(on_real, mine), to_surface(on_mine, real)
        beside.append([name, "neurotess", *figures(there), *figures(back)])
        beside.append([name, "navis", *figures(to_surface(on_real, tubes)), *figures(to_surface(on_tubes, real))])
        of_cones, of_mine = cones.distances(on_real), cones.distances(on_mine)
        # Outside of the cones is where the skeleton is too thin.
        split.append([name, *figures(of_cones), f"{1000 * of_cones.mean():+.0f}", *figures(there), *figures(of_mine)])
        for region, parts in of_regions.items():
            on = cones.regions(on_real) == region
            parts.append([of_cones[on], there[on], of_mine[cones.regions(on_mine) == region]])
        (in_real, holes), (in_mine, none), (in_tubes, ends) = map(volume, (real, mine, tubes))
        areas = f"{real.area:.0f}", f"{mine.area / real.area:.2f}", f"{tubes.area / real.area:.2f}"
        volumes = f"{in_real:.0f}", f"{in_mine / in_real:.2f}", f"{in_tubes / in_real:.2f}"
        sizes.append([name, *areas, *volumes, str(holes), str(none), str(ends)])
    three = ["mean", "median", "99 %"]
    table(["neuron", "by", *(f"EM to it, {n}" for n in three), *(f"it to EM, {n}" for n in three)], beside)
    table(
        ["neuron", "EM: area", "ours", "navis'", "EM: volume", "ours", "navis'", "EM: holes", "ours", "navis'"],
        sizes,
    )
    parts = ["EM to cones", "EM to ours", "ours to cones"]
    others = (f"{part}, {n}" for part in parts[1:] for n in three)
    table(["neuron", *(f"{parts[0]}, {n}" for n in three), "signed", *others], split)
    regions = []
    for region, where in enumerate(["along neurites", "at forks", "soma"]):
        found = [np.concatenate(of) for of in zip(*of_regions[region], strict=True)]
        share = len(found[0]) / (POINTS * len(skeletons))
        regions.append([where, f"{100 * share:.0f} %", *(figure for of in found for figure in figures(of))])
    table(["where", "of the EM surface", *(f"{part}, {n}" for part in parts for n in three)], regions)


if __name__ == "__main__":
    main()
