"""Pages of one cell by neurotess and by others: how large they are, and how long making them takes.

    python benchmarks/pages.py CELL.swc --bin FOLDER [--out out/pages]

Others are navis (skeletons and tubes, by plotly and k3d), and the mesh of `neurotess mesh --level 4` by plotly, k3d and
PyVista. Needs `pip install navis plotly k3d "pyvista[jupyter]" trimesh`.
"""

from __future__ import annotations

import argparse
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

def navis_page(swc: Path, out: Path, backend: str, radius: bool) -> None:
    import navis

    navis.set_pbars(hide=True)
    plot = navis.plot3d(navis.read_swc(swc), backend=backend, radius=radius, inline=False)
    if backend == "plotly":
        plot.write_html(out, include_plotlyjs=True)
    else:
        out.write_text(plot.get_snapshot())


def plotly_mesh(ply: Path, out: Path) -> None:
    import plotly.graph_objects as go
    import trimesh

    mesh = trimesh.load(ply, process=False)
    (x, y, z), (i, j, k) = mesh.vertices.T, mesh.faces.T
    figure = go.Figure(go.Mesh3d(x=x, y=y, z=z, i=i, j=j, k=k))
    figure.update_scenes(aspectmode="data").write_html(out, include_plotlyjs=True)


def k3d_mesh(ply: Path, out: Path) -> None:
    import k3d
    import numpy as np
    import trimesh

    mesh = trimesh.load(ply, process=False)
    plot = k3d.plot()
    plot += k3d.mesh(mesh.vertices.astype(np.float32), mesh.faces.astype(np.uint32), color=0x3050C0)
    out.write_text(plot.get_snapshot())


def pyvista_mesh(ply: Path, out: Path) -> None:
    import pyvista

    plotter = pyvista.Plotter(off_screen=True)
    plotter.add_mesh(pyvista.read(ply))
    plotter.export_html(out)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("swc", type=Path)
    parser.add_argument("--bin", type=Path, required=True, help="folder of the program neurotess")
    parser.add_argument("--out", type=Path, default=Path("out/pages"))
    given = parser.parse_args()
    swc, out = given.swc, given.out
    out.mkdir(parents=True, exist_ok=True)
    ply = out / "mesh.ply"
    program = str(given.bin / "neurotess")
    subprocess.run([program, "mesh", swc, "-o", ply, "--force", "-q"], check=True)
    makers: dict[str, tuple[str, Callable[[Path], object]]] = {
        "neurotess html": (
            "any level",
            lambda page: subprocess.run([program, "html", swc, "-o", page, "--force", "-q"], check=True),
        ),
        "navis, plotly": ("lines", lambda page: navis_page(swc, page, "plotly", False)),
        "navis, plotly, radius": ("tubes", lambda page: navis_page(swc, page, "plotly", True)),
        "navis, k3d": ("lines", lambda page: navis_page(swc, page, "k3d", False)),
        "navis, k3d, radius": ("tubes", lambda page: navis_page(swc, page, "k3d", True)),
        "plotly": ("our level 4", lambda page: plotly_mesh(ply, page)),
        "k3d": ("our level 4", lambda page: k3d_mesh(ply, page)),
        "PyVista": ("our level 4", lambda page: pyvista_mesh(ply, page)),
    }
    print("| page | shows | made in, s | MB |\n| --- | --- | ---: | ---: |")
    for name, (what, make) in makers.items():
        page = out / f"{name.replace(', ', '-').replace(' ', '-')}.html"
        start = time.perf_counter()
        try:
            make(page)
            made = time.perf_counter() - start
            print(f"| {name} | {what} | {made:.1f} | {page.stat().st_size / 1e6:.2f} |", flush=True)
        except Exception as error:  # What another package cannot do is a row, too.
            print(f"| {name} | {what} | – | {type(error).__name__}: {str(error)[:80]} |", flush=True)


if __name__ == "__main__":
    main()
