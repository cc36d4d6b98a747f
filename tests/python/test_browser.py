"""The view in a real JupyterLab, in a browser without a window, moved by a mouse.

Needs jupyterlab, playwright and Chromium, which `cargo xtask setup` does not install.
"""

from __future__ import annotations

import io
import os
import shutil
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

pytestmark = pytest.mark.full

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")

SOURCE = """import neurotess as nt
view = nt.View(nt.synth('pyramidal', seed=4, points=800), renderer='kernel', size=(500, 400))
view.on_pick = lambda found: open('picked.txt', 'w').write(found['name'])
view"""


@pytest.fixture
def lab(tmp_path: Path) -> Iterator[str]:
    """The address of a JupyterLab with a notebook."""
    for package in ("jupyterlab", "jupyter_rfb", "nbformat"):
        pytest.importorskip(package)
    import nbformat

    notebook = nbformat.v4.new_notebook()
    notebook.cells = [nbformat.v4.new_code_cell(SOURCE)]
    notebook.metadata["kernelspec"] = {"name": "python3", "display_name": "Python 3", "language": "python"}
    nbformat.write(notebook, tmp_path / "view.ipynb")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    command = [sys.executable, "-m", "jupyterlab", "--no-browser", "--allow-root", f"--port={port}"]
    command += ["--IdentityProvider.token=", f"--ServerApp.root_dir={tmp_path}", "--ip=127.0.0.1"]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as server:
        for _ in range(300):
            with socket.socket() as trial:
                if trial.connect_ex(("127.0.0.1", port)) == 0:
                    break
            time.sleep(0.2)
        yield f"http://127.0.0.1:{port}/lab/tree/view.ipynb?reset"
        server.terminate()


@pytest.mark.usefixtures("can_draw")
@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium")
def test_a_mouse_turns_and_picks(lab: str, tmp_path: Path) -> None:
    playwright = pytest.importorskip("playwright.sync_api")
    pillow = pytest.importorskip("PIL.Image")
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": 1100, "height": 900})
        page.goto(lab, timeout=120_000)
        page.wait_for_selector(".jp-Notebook .jp-CodeCell", timeout=120_000)
        # The kernel starts meanwhile; what is run before it is there is lost.
        for _ in range(12):
            time.sleep(5)
            page.click(".jp-CodeCell >> nth=0 >> .cm-content")
            page.keyboard.press("Shift+Enter")
            try:
                page.wait_for_selector(".renderview-wrapper", timeout=15_000)
                break
            except playwright.TimeoutError:
                continue
        place = page.wait_for_selector(".renderview-wrapper", timeout=1_000).bounding_box()

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
        picked = tmp_path / "picked.txt"
        for _ in range(50):
            if picked.exists() and picked.read_text():
                break
            time.sleep(0.2)
        assert picked.read_text() == "pyramidal_4"
        if folder := os.environ.get("NEUROTESS_SCREENSHOTS"):
            page.screenshot(path=Path(folder) / "notebook.png")
        browser.close()
