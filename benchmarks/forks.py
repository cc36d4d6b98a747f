"""What forks look like: figures of their facets, and sheets of close-ups, of one build or of two.

    python forks.py measure --bin DIR [--before DIR] FILES...
    python forks.py sheets --bin DIR [--before DIR] --out DIR FILES...
    python forks.py random --bin DIR [--before DIR] --out DIR [--count 60] [--seed 1] FILES...
    python forks.py hard --bin DIR [--before DIR] --out DIR [--count 12] FILES...

`measure` looks at the surface of level 8 within three radii of each fork: the angles between neighboring facets,
and the share of the area whose normal is more than 30 degrees off that of the branches' round cones, blended
(polynomial smooth minimum) over half the radius of the thinnest one. It prints the median, 99 % and the largest, by
cell and of all forks. A perfect surface has a share above zero, too, where a tracing turns sharply.

`sheets` draws every fork within 60 µm of the soma from both sides, and the soma, 1600 x 1200, and puts them in one
picture for each cell; with --before, beside what that build draws.

`random` draws so many forks of all files, each as likely as any other; `hard` those whose share that is off is largest in the
build before, at most three of a cell. Twelve make a sheet, each from one side, with --before beside what that build draws; a
list says which they are.
"""

import argparse
import json
import subprocess
import tempfile
from pathlib import Path

import numpy as np
import trimesh
from PIL import Image
from scipy.spatial import cKDTree

# In radii of the fork: what is looked at, and how far branches are followed.
REACH = 3.0
FOLLOWED = 7.5
OFF = np.cos(np.radians(30))
# µm from the soma within which forks are drawn.
NEAR = 60.0
# Forks in a sheet of `random` and `hard`.
PER_SHEET = 12


class Tracing:
    """Samples of a file, as `neurotess convert` writes them to SWC."""

    def __init__(self, neurotess, file, folder):
        swc = folder / "tracing.swc"
        run(neurotess, "convert", file, "-o", swc)
        rows = [line.split() for line in swc.read_text().splitlines() if not line.startswith("#")]
        rows = [row for row in rows if row]
        place = {row[0]: number for number, row in enumerate(rows)}
        self.soma = np.array([row[1] == "1" for row in rows])
        self.points = np.array([row[2:5] for row in rows], float)
        self.radii = np.array([row[5] for row in rows], float)
        self.parents = [place.get(row[6], -1) for row in rows]
        self.children = [[] for _ in rows]
        for number, parent in enumerate(self.parents):
            if parent >= 0:
                self.children[parent].append(number)
        self.center = self.points[self.soma].mean(0) if self.soma.any() else self.points[0]

    def forks(self):
        """Samples of neurites with several children, and a parent on the neurite."""
        of_neurite = lambda n: n >= 0 and not self.soma[n]
        numbers = range(len(self.points))
        return [n for n in numbers if len(self.children[n]) > 1 and of_neurite(n) and of_neurite(self.parents[n])]

    def radius(self, fork):
        """The thickest radius at a fork."""
        return max(self.radii[n] for n in [fork, *self.children[fork]])

    def branches(self, fork, length):
        """Round cones along the parent and each child, so far (µm)."""
        up = self.follow(fork, self.parents[fork], length, self.parent_of_neurite)
        return [up] + [self.follow(fork, child, length, self.thickest) for child in self.children[fork]]

    def follow(self, before, here, length, onward):
        cones = []
        while here is not None:
            cones.append((before, here))
            length -= np.linalg.norm(self.points[here] - self.points[before])
            before, here = here, onward(here) if length > 0 else None
        return cones

    def parent_of_neurite(self, number):
        parent = self.parents[number]
        return parent if parent >= 0 and not self.soma[parent] else None

    def thickest(self, number):
        return max(self.children[number], key=lambda child: self.radii[child], default=None)

    def distance(self, places, cones):
        """Distance (µm) of places from the union of round cones."""
        return np.min([self.cone(places, cone) for cone in cones], axis=0)

    def cone(self, places, cone):
        (a, b), (ra, rb) = self.points[list(cone)], self.radii[list(cone)]
        way = b - a
        t = np.clip((places - a) @ way / max(way @ way, 1e-12), 0, 1)
        return np.linalg.norm(places - a - t[:, None] * way, axis=1) - (ra + (rb - ra) * t)


def run(neurotess, *words):
    command = [str(word) for word in (neurotess, *words, "--force", "--quiet")]
    subprocess.run(command, check=True, capture_output=True)


def blended(tracing, places, branches, width):
    """Smooth minimum of the distances from branches."""
    least = tracing.distance(places, branches[0])
    for branch in branches[1:]:
        other = tracing.distance(places, branch)
        near = np.maximum(width - np.abs(least - other), 0) / width
        least = np.minimum(least, other) - near * near * width / 4
    return least


def own_facets(tracing, fork, branches, centers, candidates):
    """Facets on the branches of a fork, and not on others that pass it."""
    radius = tracing.radius(fork)
    own = np.abs(np.min([tracing.distance(centers[candidates], b) for b in branches], axis=0))
    among = {sample for branch in branches for cone in branch for sample in cone}
    near = np.linalg.norm(tracing.points - tracing.points[fork], axis=1) < (REACH + 4) * radius
    others = [
        (tracing.parents[n], n)
        for n in np.flatnonzero(near)
        if tracing.parents[n] >= 0 and not (n in among and tracing.parents[n] in among)
    ]
    nearest = own < 0.6 * radius
    if others:
        nearest &= own < np.min([np.abs(tracing.cone(centers[candidates], c)) for c in others], axis=0)
    return candidates[nearest]


def figures(neurotess, file, folder):
    """Angles (degrees) between facets near forks, shares of area that are off, and the forks that these are of."""
    tracing = Tracing(neurotess, file, folder)
    run(neurotess, "mesh", file, "--level", 8, "-o", folder / "mesh.ply")
    mesh = trimesh.load(folder / "mesh.ply", process=False)
    corners = np.asarray(mesh.vertices, float)[mesh.faces]
    centers = corners.mean(1)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(normals, axis=1)
    normals /= np.maximum(areas, 1e-30)[:, None]
    tree = cKDTree(centers)
    angles, shares, forks = [np.zeros(0)], [], []
    for fork in tracing.forks():
        radius = tracing.radius(fork)
        thinnest = min(tracing.radii[child] for child in tracing.children[fork])
        near = np.array(tree.query_ball_point(tracing.points[fork], REACH * radius), int)
        branches = tracing.branches(fork, FOLLOWED * radius)
        if thinnest <= 0 or len(near) == 0:
            continue
        facets = own_facets(tracing, fork, branches, centers, near)
        facets = facets[areas[facets] > 1e-9 * radius * radius]
        if len(facets) < 10:
            continue
        angles.append(between(mesh.faces[facets], normals[facets]))
        steps = 0.01 * thinnest * np.eye(3)
        value = lambda places: blended(tracing, places, branches, 0.5 * thinnest)
        slope = np.stack([value(centers[facets] + s) - value(centers[facets] - s) for s in steps], axis=1)
        slope /= np.maximum(np.linalg.norm(slope, axis=1), 1e-30)[:, None]
        is_off = (normals[facets] * slope).sum(1) < OFF
        shares.append(areas[facets][is_off].sum() / areas[facets].sum())
        forks.append(fork)
    return np.concatenate(angles), np.array(shares), forks


def between(faces, normals):
    """Angles between facets that share an edge."""
    edges = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    owners = np.repeat(np.arange(len(faces)), 3)
    order = np.lexsort(edges.T)
    same = np.flatnonzero((edges[order][1:] == edges[order][:-1]).all(1))
    cosines = (normals[owners[order[same]]] * normals[owners[order[same + 1]]]).sum(1)
    return np.degrees(np.arccos(np.clip(cosines, -1, 1)))


def measure(arguments):
    builds = [build for build in (arguments.before, arguments.bin) if build]
    print("| cell | forks | angles: median, 99 %, largest | share off: median, 99 %, largest |")
    print("| --- | ---: | --- | --- |")
    found = [[] for _ in builds]
    with tempfile.TemporaryDirectory() as folder:
        for file in arguments.files:
            for build, of_build in zip(builds, found):
                of_build.append(figures(build / "neurotess", file, Path(folder))[:2])
            print(row(file.stem[:24], [of_build[-1] for of_build in found]), flush=True)
    print(row("all", [tuple(map(np.concatenate, zip(*of_build))) for of_build in found]))


def chosen(arguments):
    """Sheets of forks of many cells, and their list."""
    builds = [build for build in (arguments.before, arguments.bin) if build]
    arguments.out.mkdir(parents=True, exist_ok=True)
    count = arguments.count or {"random": 60, "hard": 12}[arguments.what]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        forks = {"random": at_random, "hard": the_worst}[arguments.what](builds[0], arguments, count, folder)
        tiles = []
        for number, (file, fork, told) in enumerate(forks, 1):
            tracing = Tracing(arguments.bin / "neurotess", file, folder)
            view = next(views(tracing, fork))
            tiles.append([picture(build / "neurotess", file, view, folder) for build in builds])
            place = ", ".join(f"{x:.1f}" for x in tracing.points[fork])
            print(f"{number}: {file.stem} at {place}{told}", flush=True)
    for first in range(0, len(tiles), PER_SHEET):
        across = 3
        rows = tiles[first : first + PER_SHEET]
        width, height = rows[0][0].size
        size = (width * len(builds) * across, height * -(-len(rows) // across))
        sheet = Image.new("RGB", size, "white")
        for place, pictures in enumerate(rows):
            for build, one in enumerate(pictures):
                x = (place % across * len(builds) + build) * width
                sheet.paste(one, (x, place // across * height))
        sheet.save(arguments.out / f"{arguments.what}-{first // PER_SHEET + 1}.png")


def at_random(_, arguments, count, folder):
    """Forks of all files, each as likely as any other."""
    neurotess = arguments.bin / "neurotess"
    all_forks = [(file, fork, "") for file in arguments.files for fork in Tracing(neurotess, file, folder).forks()]
    picked = np.random.default_rng(arguments.seed).choice(len(all_forks), min(count, len(all_forks)), replace=False)
    return [all_forks[number] for number in sorted(picked)]


def the_worst(build, arguments, count, folder):
    """Forks with the largest shares off of a build, at most three of a cell."""
    worst = []
    for file in arguments.files:
        _, shares, forks = figures(build / "neurotess", file, folder)
        order = np.argsort(shares)[::-1][:3]
        worst += [(shares[n], file, forks[n]) for n in order]
    worst.sort(key=lambda one: -one[0])
    return [(file, fork, f", {100 * share:.0f} % off") for share, file, fork in worst[:count]]


def row(name, found):
    told = lambda values, unit: ", ".join(f"{np.quantile(values, q):.1f}{unit}" for q in (0.5, 0.99, 1.0))
    forks = len(found[-1][1])
    if forks == 0:
        return f"| {name} | 0 | – | – |"
    angles = " → ".join(told(angles, "°") for angles, _ in found)
    shares = " → ".join(told(100 * shares, " %") for _, shares in found)
    return f"| {name} | {forks} | {angles} | {shares} |"


def sheets(arguments):
    builds = [build for build in (arguments.before, arguments.bin) if build]
    arguments.out.mkdir(parents=True, exist_ok=True)
    for file in arguments.files:
        with tempfile.TemporaryDirectory() as folder:
            rows = [
                [picture(build / "neurotess", file, view, Path(folder)) for build in builds for view in views]
                for views in cameras(arguments.bin / "neurotess", file, Path(folder))
            ]
        width, height = rows[0][0].size
        sheet = Image.new("RGB", (width * len(rows[0]), height * len(rows)), "white")
        for y, pictures in enumerate(rows):
            for x, one in enumerate(pictures):
                sheet.paste(one, (x * width, y * height))
        sheet.save(arguments.out / f"{file.stem}.png")
        print(f"{file.stem}: {len(rows) - 1} forks and the soma", flush=True)


def cameras(neurotess, file, folder):
    """Pairs of views (eye, target, up): of the soma, and of each fork near it."""
    tracing = Tracing(neurotess, file, folder)
    told = subprocess.run([str(neurotess), "info", str(file), "--json"], capture_output=True, text=True, check=True)
    soma = (json.loads(told.stdout)[0]["soma"] or {}).get("radius") or 5.0
    ahead = np.array([0.0, 0.0, 5.5 * soma])
    yield [(tracing.center + side * ahead, tracing.center, np.array([0.0, 1.0, 0.0])) for side in (1, -1)]
    distance = lambda fork: np.linalg.norm(tracing.points[fork] - tracing.center)
    for fork in sorted((f for f in tracing.forks() if distance(f) < NEAR), key=distance):
        yield list(views(tracing, fork))


def views(tracing, fork):
    """A fork from both sides (eye, target, up)."""
    radius, at = tracing.radius(fork), tracing.points[fork]
    ways = [tracing.points[branch[-1][1]] - at for branch in tracing.branches(fork, 4 * radius)[1:3]]
    first, second = [way / max(np.linalg.norm(way), 1e-9) for way in ways]
    across = np.cross(first, second)
    if np.linalg.norm(across) < 0.05:
        across = np.cross(first, [0.3, 0.5, 0.8])
    across /= np.linalg.norm(across)
    up = first + second if np.linalg.norm(first + second) > 0.1 else np.cross(across, first)
    target = at + 0.5 * radius * (first + second)
    slanted = 0.35 * np.cross(across, up / np.linalg.norm(up))
    for side in (1, -1):
        yield target + 12 * radius * (side * across + slanted), target, up


def picture(neurotess, file, view, folder):
    words = [f"--{name}=" + ",".join(f"{x:.4f}" for x in place) for name, place in zip(("eye", "target", "up"), view)]
    run(neurotess, "render", file, "-o", folder / "view.png", "--size", "1600x1200", "--fov", 45, "--no-legend", *words)
    with Image.open(folder / "view.png") as one:
        return one.convert("RGB").resize((640, 480), Image.Resampling.LANCZOS)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("what", choices=["measure", "sheets", "random", "hard"])
    parser.add_argument("--bin", type=Path, required=True)
    parser.add_argument("--before", type=Path)
    parser.add_argument("--out", type=Path, default=Path("out/sheets"))
    parser.add_argument("--count", type=int)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("files", nargs="+", type=Path)
    arguments = parser.parse_args()
    does = {"measure": measure, "sheets": sheets, "random": chosen, "hard": chosen}
    does[arguments.what](arguments)


if __name__ == "__main__":
    main()
