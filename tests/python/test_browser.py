"""Views in a real JupyterLab, in a browser without a window, moved by a mouse.

Needs jupyterlab, playwright and Chromium, which `cargo xtask setup` does not install.
"""

from __future__ import annotations

import io
import json
import os
import shutil
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytestmark = pytest.mark.full

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")

KERNEL = """import neurotess as nt
view = nt.View(nt.synth('pyramidal', seed=4, points=800), renderer='kernel', size=(500, 400))
view.on_pick = lambda found: open('picked.txt', 'w').write(found['name'])
view"""

BROWSER = """import json, numpy as np, neurotess as nt
cell = nt.synth('pyramidal', seed=4, points=800)
over_time = np.outer(np.arange(5), cell.path_distances())
view = nt.View(cell, values=over_time, times=np.arange(5), color_by='type', size=(600, 400))
view.on_pick = lambda found: json.dump(found, open('picked.json', 'w'))
def tell(name):
    told = [view.camera, view.color_by, view.hidden, view.time, view.orthographic]
    json.dump(told, open(name + '.json', 'w'))
view"""
SET = """view.camera = (300, 0, 1000), (0, 0, 0), (0, 1, 0), 0.4
view.hide('axon'); view.time = 3.2; view.orthographic = True
tell('set')"""


@pytest.fixture
def lab(tmp_path: Path) -> Iterator[Callable[..., str]]:
    """Starts a JupyterLab with a notebook of these cells, and gives its address."""
    for package in ("jupyterlab", "nbformat"):
        pytest.importorskip(package)
    import nbformat

    servers = []

    def started(*sources: str) -> str:
        notebook = nbformat.v4.new_notebook()
        notebook.cells = [nbformat.v4.new_code_cell(source) for source in sources]
        notebook.metadata["kernelspec"] = {"name": "python3", "display_name": "Python 3", "language": "python"}
        nbformat.write(notebook, tmp_path / "view.ipynb")
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        command = [sys.executable, "-m", "jupyterlab", "--no-browser", "--allow-root", f"--port={port}"]
        command += ["--IdentityProvider.token=", f"--ServerApp.root_dir={tmp_path}", "--ip=127.0.0.1"]
        servers.append(subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))
        for _ in range(300):
            with socket.socket() as trial:
                if trial.connect_ex(("127.0.0.1", port)) == 0:
                    break
            time.sleep(0.2)
        return f"http://127.0.0.1:{port}/lab/tree/view.ipynb?reset"

    yield started
    for server in servers:
        server.terminate()
        server.wait()


def run_first(page: Any, address: str, shown: str) -> Any:
    """Opens a notebook and runs its first cell until there is what it shows."""
    playwright = pytest.importorskip("playwright.sync_api")
    page.goto(address, timeout=120_000)
    page.wait_for_selector(".jp-Notebook .jp-CodeCell", timeout=120_000)
    # The kernel starts meanwhile; what is run before it is there is lost.
    for _ in range(12):
        time.sleep(5)
        page.click(".jp-CodeCell >> nth=0 >> .cm-content")
        page.keyboard.press("Shift+Enter")
        try:
            return page.wait_for_selector(shown, timeout=15_000)
        except playwright.TimeoutError:
            continue
    raise AssertionError("the first cell shows nothing")


def written(file: Path) -> str:
    """What the kernel has written."""
    for _ in range(150):
        if file.exists() and file.read_text():
            break
        time.sleep(0.2)
    return file.read_text()


@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium")
def test_a_mouse_turns_and_picks(lab: Callable[..., str], tmp_path: Path) -> None:
    pytest.importorskip("jupyter_rfb")
    playwright = pytest.importorskip("playwright.sync_api")
    pillow = pytest.importorskip("PIL.Image")
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": 1100, "height": 900})
        place = run_first(page, lab(KERNEL), ".renderview-wrapper").bounding_box()

        def settled() -> np.ndarray:
            """The view when it does not change any more."""
            last: bytes = b""
            for _ in range(60):
                time.sleep(1.0)
                shot = page.screenshot(clip=place)
                pixels = np.asarray(pillow.open(io.BytesIO(shot)).convert("RGB"))
                if shot == last and (pixels < 100).any():
                    return pixels
                last = shot
            raise AssertionError("the view does not come to rest")

        before = settled()
        x, y = place["x"] + 100, place["y"] + 100
        page.mouse.move(x, y)
        page.mouse.down()
        for step in range(10):
            page.mouse.move(x + 15 * step, y)
        page.mouse.up()
        after = settled()
        assert (before != after).any()
        row, column = np.argwhere(after.sum(axis=2) < 250)[0].tolist()
        page.mouse.click(place["x"] + column, place["y"] + row)
        assert written(tmp_path / "picked.txt") == "pyramidal_4"
        if folder := os.environ.get("NEUROTESS_SCREENSHOTS"):
            page.screenshot(path=Path(folder) / "notebook.png")
        browser.close()


@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium")
def test_what_the_browser_shows_is_joined_with_the_kernel(lab: Callable[..., str], tmp_path: Path) -> None:
    pytest.importorskip("anywidget")
    playwright = pytest.importorskip("playwright.sync_api")
    flags = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=flags)
        page = browser.new_page(viewport={"width": 1100, "height": 900})
        frame = run_first(page, lab(BROWSER, SET, "tell('last')"), "iframe[data-view]")
        inner = frame.content_frame()
        for _ in range(600):
            if inner.evaluate("window.neurotess?.app?.shown") is not None:
                break
            time.sleep(0.2)
        rest = "neurotess.app.loop.settled()"
        inner.evaluate(f"neurotess.ready.then(() => {rest})")
        page.keyboard.press("Shift+Enter")
        camera, colors, hidden, shown, orthographic = json.loads(written(tmp_path / "set.json"))
        assert (colors, hidden, shown, orthographic) == ("type", ["axon"], 3, True)
        time.sleep(1)
        inner.evaluate(rest)
        eye, away, frames = inner.evaluate(
            "[neurotess.app.camera.eye(), neurotess.app.colors.hiddenNow().size, neurotess.app.colors.frame]"
        )
        assert np.allclose(eye, [300, 0, 1000]) and np.allclose(camera[0], eye) and (away, frames) == (1, 3)
        if folder := os.environ.get("NEUROTESS_SCREENSHOTS"):
            frame.screenshot(path=Path(folder) / "joined.png")
        frame.scroll_into_view_if_needed()
        place = frame.bounding_box()
        x, y = place["x"] + 300, place["y"] + 200
        # The camera looks at the soma, before which a branch may be.
        there = inner.evaluate("neurotess.app.pick(300, 200)")["section"]
        page.mouse.click(x, y)
        picked = json.loads(written(tmp_path / "picked.json"))
        assert (picked["name"], picked["section"], picked["section_index"]) == ("pyramidal_4", there + 1, there)
        page.mouse.move(x, y)
        page.mouse.down()
        page.mouse.move(x + 30, y)
        page.mouse.move(x + 60, y)
        page.mouse.up()
        inner.evaluate(rest)
        time.sleep(1)
        page.click(".jp-CodeCell >> nth=2 >> .cm-content")
        page.keyboard.press("Shift+Enter")
        turned = json.loads(written(tmp_path / "last.json"))
        assert turned[1:] == ["type", ["axon"], 3, True]
        assert abs(turned[0][0][0] - 300) > 50 and np.allclose(turned[0][1], 0)
        # The page is what is saved.
        page.keyboard.press("Control+s")
        time.sleep(3)
        saved = json.loads((tmp_path / "view.ipynb").read_text())
        [output] = saved["cells"][0]["outputs"]
        assert set(output["data"]) == {"text/html", "text/plain"} and "widgets" not in saved["metadata"]
        browser.close()
