"""Times a picture of one cell, 1280 × 960, by the processor, beside octarine, which draws by a Vulkan driver.

Run it in an environment with the package (a release build: `cargo xtask wheel`) and octarine3d:

    python benchmarks/pictures.py samples/pyramidal.swc

octarine draws the mesh that neurotess makes, level 4, which is not in its times. k3d draws in a browser only.
"""

from __future__ import annotations

import sys
import time

import neurotess as nt
import numpy as np

SIZE = (1280, 960)
RUNS = 4


def seconds(draw: object) -> list[float]:
    """Seconds of each of some runs; the first also makes devices and pipelines."""
    times = []
    for _ in range(RUNS):
        start = time.perf_counter()
        picture = np.asarray(draw())  # type: ignore[operator]
        times.append(time.perf_counter() - start)
        assert picture[..., :3].std() > 1, "the picture is empty"
    return times


def octarine(mesh: nt.Mesh) -> list[float]:
    """Seconds of octarine's pictures of a mesh."""
    import octarine as oc

    start = time.perf_counter()
    viewer = oc.Viewer(offscreen=True, size=SIZE, show=False)
    viewer.add(mesh.to_trimesh(), color="black")
    viewer.center_camera()
    # Its screenshots of an offscreen canvas need to be told what to draw.
    viewer.canvas.request_draw(viewer._animate)
    made = time.perf_counter() - start
    times = seconds(lambda: viewer.screenshot(None))
    return [made + times[0], *times[1:]]


def main() -> None:
    cell = nt.read(sys.argv[1])
    mesh = nt.mesh(cell, level=4)
    print(f"{cell.name}: {len(cell)} points, {len(mesh.faces):,} triangles at level 4")
    for name, times in [
        ("neurotess, from the cell on", seconds(lambda: nt.render(cell, size=SIZE, legend=False))),
        ("octarine, from the mesh on", octarine(mesh)),
    ]:
        print(f"{name}: {times[0]:.2f} s at first, {min(times[1:]):.2f} s again")


if __name__ == "__main__":
    main()
