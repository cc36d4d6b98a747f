"""A notebook with a picture and a view, run by a kernel."""

from __future__ import annotations

import pytest


@pytest.mark.full
def test_a_notebook_shows_pictures_and_views() -> None:
    nbclient = pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    pytest.importorskip("jupyter_rfb")
    import nbformat

    cells = [
        "import neurotess as nt\ncell = nt.synth('granule', points=100)",
        "nt.render(cell, size=(64, 48), legend=False)",
        "view = nt.View(cell, renderer='kernel', size=(64, 48), samples=1)\nview",
        # What the browser would send.
        "view.handle_event({'type': 'pointer_down', 'x': 5, 'y': 5, 'buttons': (1,)})\n"
        "view.handle_event({'type': 'pointer_move', 'x': 25, 'y': 5, 'buttons': (1,)})\n"
        "assert view._moving\n"
        "import asyncio; await asyncio.sleep(1)\n"
        "assert not view._moving\n"
        "view.close()",
        "nt.View(cell)",
    ]
    notebook = nbformat.v4.new_notebook()
    notebook.cells = [nbformat.v4.new_code_cell(source) for source in cells]
    nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3").execute()
    [picture] = notebook.cells[1].outputs
    assert "image/png" in picture.data
    # What the browser draws stays in the notebook.
    [page] = notebook.cells[4].outputs
    assert "<iframe" in page.data["text/html"] and "<!doctype html>" in page.data["text/html"]
    shown = notebook.cells[2].outputs
    assert any("application/vnd.jupyter.widget-view+json" in output.get("data", {}) for output in shown)
