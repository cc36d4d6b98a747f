"""Pictures a second while a cell is turned, of the page (WebGPU, WebGL 2) and of the view that the kernel draws.

python benchmarks/turning.py CELL.swc [--size 800x600] [--seconds 8]

Needs neurotess with its extra `notebook`, playwright, and Chromium; for the row of JupyterLab also jupyterlab and nbformat. Its
table goes into web.md.
"""

from __future__ import annotations

import argparse
import shutil
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import neurotess as nt

SOFTWARE = {
    "WebGPU": "--enable-unsafe-webgpu --use-webgpu-adapter=swiftshader --enable-features=Vulkan --use-vulkan=swiftshader",
    "WebGL 2": "",
}
ALL = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]

#: Turns the page by a pixel's worth after another, as soon as each draft is there, and counts the drafts.
TURN = """async (seconds) => {
  const { app } = neurotess, { draw } = app, took = [];
  let drafts = 0;
  app.draw = (how) => { drafts += how.draft; draw.call(app, how); };
  const begin = performance.now();
  while (performance.now() - begin < 1000 * seconds) {
    app.camera.turn(0.02, 0);
    const before = drafts, asked = performance.now();
    app.loop.change();
    while (drafts === before || app.loop.draftAsked) await new Promise(requestAnimationFrame);
    await app.renderer.done();
    took.push(performance.now() - asked);
  }
  return [took.length / seconds, app.loop.scale, took.sort((a, b) => a - b)[took.length >> 1]];
}"""


def of_page(page_file: Path, size: tuple[int, int], seconds: float) -> None:
    from playwright.sync_api import sync_playwright

    for renderer, flags in SOFTWARE.items():
        with sync_playwright() as driver:
            browser = driver.chromium.launch(executable_path=shutil.which("chromium"), args=[*ALL, *flags.split()])
            page = browser.new_page(viewport={"width": size[0], "height": size[1]})
            page.set_default_timeout(600_000)
            page.goto(f"{page_file.as_uri()}{'' if flags else '#renderer=webgl'}")
            while page.evaluate("window.neurotess?.ready === undefined"):
                time.sleep(0.1)
            # What a page at rest has compiled is what a reader turns.
            page.evaluate("neurotess.ready.then(() => neurotess.app.loop.settled())")
            drawn = page.evaluate("neurotess.app.renderer.constructor.name")
            page.evaluate(f"({TURN})(2)")
            rate, scale, median = page.evaluate(f"({TURN})({seconds})")
            print(f"| page, {renderer} ({drawn}) | {rate:.1f} | {median:.0f} ms, drawn at {100 * scale:.0f} % of the size |", flush=True)
            browser.close()


def of_kernel(cell: Any, size: tuple[int, int], seconds: float) -> None:
    """What the kernel does for a picture, without a browser: it draws and packs."""
    from jupyter_rfb._jpg import array2jpg

    view = nt.View(cell, renderer="kernel", size=size)
    view.get_frame()
    drawing, packing, count = 0.0, 0.0, 0
    begin = time.perf_counter()
    while time.perf_counter() - begin < seconds:
        view._turn(4, 0)
        # Without a loop of events it would be at rest at once.
        view._moving = True
        first = time.perf_counter()
        frame = view.get_frame()
        second = time.perf_counter()
        array2jpg(frame[:, :, :3], 80)
        drawing += second - first
        packing += time.perf_counter() - second
        count += 1
    draw, pack = (1000 * one / count for one in (drawing, packing))
    print(f"| kernel, without a browser | {1000 / (draw + pack):.1f} | draw {draw:.0f} ms, pack {pack:.1f} ms |", flush=True)
    view.close()


NOTEBOOK = """import neurotess as nt
view = nt.View({path!r}, renderer='kernel', size={size})
view"""
STATS = "import json; json.dump(view.get_stats(), open('stats.json', 'w'))"


def of_lab(path: Path, size: tuple[int, int], seconds: float) -> None:
    """The whole way: a mouse in JupyterLab, the kernel, and back."""
    import json

    import nbformat
    from playwright.sync_api import sync_playwright

    folder = Path(tempfile.mkdtemp())
    notebook = nbformat.v4.new_notebook()
    sources = [NOTEBOOK.format(path=str(path), size=size), "view.reset_stats()", STATS]
    notebook.cells = [nbformat.v4.new_code_cell(source) for source in sources]
    notebook.metadata["kernelspec"] = {"name": "python3", "display_name": "Python 3", "language": "python"}
    nbformat.write(notebook, folder / "view.ipynb")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    command = [sys.executable, "-m", "jupyterlab", "--no-browser", "--allow-root", f"--port={port}"]
    command += ["--IdentityProvider.token=", f"--ServerApp.root_dir={folder}", "--ip=127.0.0.1"]
    server = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        time.sleep(8)
        with sync_playwright() as driver:
            browser = driver.chromium.launch(executable_path=shutil.which("chromium"), args=ALL)
            page = browser.new_page(viewport={"width": size[0] + 500, "height": size[1] + 400})
            page.goto(f"http://127.0.0.1:{port}/lab/tree/view.ipynb?reset", timeout=120_000)
            page.wait_for_selector(".jp-Notebook .jp-CodeCell", timeout=120_000)
            time.sleep(8)
            page.click(".jp-CodeCell >> nth=0 >> .cm-content")
            page.keyboard.press("Shift+Enter")
            shown = page.wait_for_selector(".renderview-wrapper", timeout=60_000)
            time.sleep(6)
            page.keyboard.press("Shift+Enter")
            shown.scroll_into_view_if_needed()
            place = shown.bounding_box()
            x, y = place["x"] + 50, place["y"] + size[1] / 2
            page.mouse.move(x, y)
            page.mouse.down()
            begin, step = time.perf_counter(), 0
            while time.perf_counter() - begin < seconds:
                step += 1
                page.mouse.move(x + 4 * (step % 150), y)
                time.sleep(1 / 60)
            page.mouse.up()
            page.click(".jp-CodeCell >> nth=2 >> .cm-content")
            page.keyboard.press("Shift+Enter")
            stats = folder / "stats.json"
            while not (stats.exists() and stats.read_text()):
                time.sleep(0.1)
            told = json.loads(stats.read_text())
            rate = told["sent_frames"] / seconds
            print(f"| kernel, in JupyterLab | {rate:.1f} | way to the browser and back {1000 * told['roundtrip']:.0f} ms, packing {1000 * told['img_encoding']:.1f} ms |", flush=True)
            browser.close()
    finally:
        server.terminate()
        server.wait()
        shutil.rmtree(folder, ignore_errors=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("cell", type=Path)
    parser.add_argument("--size", default="800x600")
    parser.add_argument("--seconds", type=float, default=8)
    parser.add_argument("--only", choices=("page", "kernel", "lab"))
    given = parser.parse_args()
    width, height = map(int, given.size.split("x"))
    size = width, height
    cell = nt.read(given.cell)
    print("| | pictures a second | |\n| --- | ---: | --- |")
    if given.only in (None, "kernel"):
        of_kernel(cell, size, given.seconds)
    if given.only in (None, "page"):
        with tempfile.TemporaryDirectory() as folder:
            of_page(nt.html(cell, Path(folder) / "cell.html"), size, given.seconds)
    if given.only in (None, "lab"):
        of_lab(given.cell.resolve(), size, given.seconds)


if __name__ == "__main__":
    main()
