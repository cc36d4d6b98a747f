"""One cell with a number of one's own for each point as colors, by neurotess and by others: lines, seconds, bytes.

    python benchmarks/own_numbers.py CELL.swc [--out out/own_numbers]

Each script below is what a user would write: from the file to a picture of 1280 × 960 or to a page, colored by the distance
along the tracing from the soma. Each runs three times in a process of its own, with its imports, and the fastest counts.
Lines are those of the script, without the line that names it. Needs
`pip install navis octarine3d k3d plotly "pyvista[jupyter]" vedo`.
"""

from __future__ import annotations

import argparse
import inspect
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

RUNS = 3


def neurotess(swc: str, out: str) -> None:
    import neurotess as nt
    cell = nt.read(swc)
    nt.render(cell, values=cell.path_distances(), title="distance", unit="µm").save(out)


def neurotess_mesh(swc: str, out: str) -> None:
    import neurotess as nt
    mesh = nt.mesh(swc, level=2)
    mesh.render(values=mesh.path_distance, title="distance", unit="µm").save(out)


def neurotess_page(swc: str, out: str) -> None:
    import neurotess as nt
    cell = nt.read(swc)
    nt.html(cell, out, values=cell.path_distances(), values_title="distance", unit="µm")


def navis_2d(swc: str, out: str) -> None:
    import navis
    neuron = navis.read_swc(swc)
    neuron.nodes["distance"] = neuron.nodes.node_id.map(navis.dist_to_root(neuron, weight="weight"))
    figure, _ = navis.plot2d(neuron, color_by="distance", palette="viridis", method="2d", radius=True)
    figure.savefig(out, dpi=200)


def navis_plotly(swc: str, out: str) -> None:
    import navis
    neuron = navis.read_swc(swc)
    neuron.nodes["distance"] = neuron.nodes.node_id.map(navis.dist_to_root(neuron, weight="weight"))
    plot = navis.plot3d(neuron, color_by="distance", palette="viridis", backend="plotly", radius=True, inline=False)
    plot.write_html(out)


def octarine(swc: str, out: str) -> None:
    import matplotlib
    import navis
    import octarine as oc
    import scipy.spatial
    neuron = navis.read_swc(swc)
    distance = neuron.nodes.node_id.map(navis.dist_to_root(neuron, weight="weight")).to_numpy()
    tubes = navis.conversion.tree2meshneuron(neuron)
    _, nearest = scipy.spatial.cKDTree(neuron.nodes[["x", "y", "z"]]).query(tubes.vertices)
    colors = matplotlib.colormaps["viridis"](distance / distance.max())[nearest].astype("float32")
    viewer = oc.Viewer(offscreen=True, size=(1280, 960), show=False)
    viewer.add_mesh(tubes.trimesh, color=colors)
    viewer.center_camera()
    viewer.canvas.request_draw(viewer._animate)
    viewer.screenshot(out)


def k3d(swc: str, out: str) -> None:
    import k3d
    import navis
    import scipy.spatial
    from pathlib import Path
    neuron = navis.read_swc(swc)
    distance = neuron.nodes.node_id.map(navis.dist_to_root(neuron, weight="weight")).to_numpy()
    tubes = navis.conversion.tree2meshneuron(neuron)
    _, nearest = scipy.spatial.cKDTree(neuron.nodes[["x", "y", "z"]]).query(tubes.vertices)
    plot = k3d.plot()
    plot += k3d.mesh(
        tubes.vertices.astype("float32"), tubes.faces.astype("uint32"), attribute=distance[nearest].astype("float32"),
        color_map=k3d.matplotlib_color_maps.Viridis, color_range=[0, float(distance.max())],
    )
    Path(out).write_text(plot.get_snapshot())


def pyvista_tubes(swc: str) -> object:
    import navis
    import numpy as np
    import pyvista
    neuron = navis.read_swc(swc)
    nodes, row = neuron.nodes, {node: row for row, node in enumerate(neuron.nodes.node_id)}
    parts = [[row[node] for node in segment] for segment in neuron.small_segments]
    lines = np.concatenate([[len(part), *part] for part in parts])
    tree = pyvista.PolyData(nodes[["x", "y", "z"]].to_numpy(float), lines=lines)
    tree["radius"] = nodes.radius.to_numpy()
    tree["distance"] = nodes.node_id.map(navis.dist_to_root(neuron, weight="weight")).to_numpy()
    return tree.tube(scalars="radius", absolute=True)


def pyvista(swc: str, out: str) -> None:
    import pyvista
    plotter = pyvista.Plotter(off_screen=True, window_size=(1280, 960))
    plotter.add_mesh(pyvista_tubes(swc), scalars="distance", cmap="viridis", scalar_bar_args={"title": "distance (µm)"})
    plotter.screenshot(out)


def pyvista_page(swc: str, out: str) -> None:
    import pyvista
    plotter = pyvista.Plotter(off_screen=True)
    plotter.add_mesh(pyvista_tubes(swc), scalars="distance", cmap="viridis")
    plotter.export_html(out)


def vedo(swc: str, out: str) -> None:
    import navis
    import vedo
    neuron = navis.read_swc(swc)
    nodes = neuron.nodes.set_index("node_id")
    nodes["distance"] = nodes.index.map(navis.dist_to_root(neuron, weight="weight"))
    tubes = []
    for part in neuron.small_segments:
        of_part = nodes.loc[part]
        tube = vedo.Tube(of_part[["x", "y", "z"]].to_numpy(), r=of_part.radius.to_numpy(), res=8, cap=True)
        numbers = of_part.distance.to_numpy().repeat(tube.npoints // len(part) + 1)[: tube.npoints]
        tubes.append(tube.cmap("viridis", numbers, vmin=0, vmax=nodes.distance.max()))
    tubes[0].add_scalarbar("distance (µm)")
    vedo.show(tubes, offscreen=True, size=(1280, 960)).screenshot(out)


#: By name: the script, what it calls, and the extension of what it makes.
SCRIPTS: dict[str, tuple[Callable[[str, str], None], list[Callable[..., object]], str]] = {
    "neurotess, picture": (neurotess, [], "png"),
    "neurotess, picture of a mesh, level 2": (neurotess_mesh, [], "png"),
    "navis, matplotlib": (navis_2d, [], "png"),
    "octarine, tubes of navis": (octarine, [], "png"),
    "PyVista, tubes": (pyvista, [pyvista_tubes], "png"),
    "vedo, tubes": (vedo, [], "png"),
    "neurotess, page": (neurotess_page, [], "html"),
    "navis, plotly": (navis_plotly, [], "html"),
    "k3d, tubes of navis": (k3d, [], "html"),
    "PyVista, page": (pyvista_page, [pyvista_tubes], "html"),
}


def lines_of(name: str) -> int:
    """Lines of the script, without those that name its functions."""
    script, calls, _ = SCRIPTS[name]
    return sum(len(inspect.getsource(part).strip().splitlines()) - 1 for part in (script, *calls))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("swc")
    parser.add_argument("--out", type=Path, default=Path("out/own_numbers"))
    parser.add_argument("--only", help="runs this script in this process")
    given = parser.parse_args()
    if given.only:
        script, _, extension = SCRIPTS[given.only]
        script(given.swc, str(made(given.out, given.only, extension)))
        return
    given.out.mkdir(parents=True, exist_ok=True)
    print("| script | lines | s | MB |\n| --- | ---: | ---: | ---: |")
    for name, (_, _, extension) in SCRIPTS.items():
        out = made(given.out, name, extension)
        times = []
        for _ in range(RUNS):
            out.unlink(missing_ok=True)
            command = [sys.executable, __file__, given.swc, "--out", str(given.out), "--only", name]
            start = time.perf_counter()
            ran = subprocess.run(command, capture_output=True, text=True, check=False, env=os.environ)
            times.append(time.perf_counter() - start)
        if out.exists():
            print(f"| {name} | {lines_of(name)} | {min(times):.1f} | {out.stat().st_size / 1e6:.2f} |", flush=True)
        else:
            # What another package cannot do is a row, too.
            print(f"| {name} | {lines_of(name)} | – | {ran.stderr.strip().splitlines()[-1:]} |", flush=True)


def made(folder: Path, name: str, extension: str) -> Path:
    return folder / f"{name.replace(', ', '-').replace(' ', '-')}.{extension}"


if __name__ == "__main__":
    main()
