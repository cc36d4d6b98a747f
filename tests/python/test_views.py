"""Views in a notebook that the browser draws. No browser and no adapter is needed."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import neurotess as nt
import numpy as np
import pytest


@pytest.fixture(scope="module")
def cell() -> nt.Morphology:
    return nt.synth("granule", seed=2, points=100)


def framed(view: Any) -> str:
    """The page in what a notebook shows."""
    import html.parser

    class Frame(html.parser.HTMLParser):
        page = ""

        def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
            assert tag == "iframe" and dict(attrs)["title"]
            self.page = dict(attrs)["srcdoc"] or ""

    frame = Frame()
    frame.feed(view._repr_html_())
    return frame.page


@pytest.fixture(params=["alone", "joined"])
def anywidget(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> bool:
    """Whether anywidget is there, which joins a page with the kernel."""
    from neurotess import _view

    joined: bool = request.param == "joined"
    if joined:
        pytest.importorskip("anywidget")
    monkeypatch.setattr(_view, "_can_live", lambda: joined)
    return joined


@pytest.mark.usefixtures("anywidget")
def test_views_are_pages_that_the_browser_draws(cell: nt.Morphology, tmp_path: Path) -> None:
    view = nt.View(cell, size=(640, 480), color_by="radius")
    assert framed(view) == view.html == nt.html(cell, color_by="radius")
    assert "width:640px" in view._repr_html_() and "kB, drawn by the browser" in repr(view)
    out = view.save(tmp_path / "cell.html")
    assert out.read_text(encoding="utf-8") == view.html
    distances = cell.path_distances()
    view = nt.View([cell], values=[distances], title="distance", unit="µm", renderer="browser")
    assert view.html == nt.html([cell], values=[distances], values_title="distance", unit="µm")
    # An iterator can be read once only.
    assert nt.View(iter([cell])).html == nt.html([cell])
    over_time = {"values": np.outer([0, 1], distances), "times": [0, 1]}
    assert nt.View(cell, **over_time).html == nt.html(cell, **over_time)
    view.close()


def test_views_that_pages_cannot_show_are_drawn_by_the_kernel(
    cell: nt.Morphology, monkeypatch: pytest.MonkeyPatch
) -> None:
    from neurotess import _view

    made: list[dict[str, Any]] = []
    kernel = type(sys)("neurotess._kernel_view")
    kernel.KernelView = lambda _what, **options: made.append(options)  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "neurotess._kernel_view", kernel)
    nt.View(cell, renderer="kernel", size=(64, 48))
    nt.View(cell, samples=4, color_by="radius")
    monkeypatch.setattr(_view, "MOST_BYTES", 1000)
    nt.View(cell)
    assert made == [{"size": (64, 48)}, {"size": (800, 600), "samples": 4, "color_by": "radius"}, {"size": (800, 600)}]
    # Who asks for it gets it.
    assert len(nt.View(cell, renderer="browser").html) > 1000
    with pytest.raises(ValueError, match="samples= is of views that the kernel draws"):
        nt.View(cell, renderer="browser", samples=4)
    with pytest.raises(ValueError, match="'browser' or 'kernel' is needed"):
        nt.View(cell, renderer="gpu")
    with pytest.raises(TypeError, match="unexpected keyword argument 'colour_by': did you mean 'color_by'"):
        nt.View(cell, colour_by="radius")


def test_views_of_few_cells_of_a_circuit_are_pages(circuit_folder: Path) -> None:
    circuit = nt.Circuit(circuit_folder)
    assert nt.View(circuit, nodes=[0, 1]).html == circuit.to_html(nodes=[0, 1])
    shown = {"nodes": [0, 1], "report": "voltage"}
    view = nt.View(circuit, **shown, markers={"synapses": True, "size": 2})
    assert view.html == circuit.to_html(**shown, synapses=True, marker_size=2)


def test_views_without_anywidget_say_what_they_need(cell: nt.Morphology, monkeypatch: pytest.MonkeyPatch) -> None:
    from neurotess import _view

    monkeypatch.setattr(_view, "_can_live", lambda: False)
    view = nt.View(cell)
    for name in ("camera", "on_pick", "time", "hide"):
        needed = rf"^'{name}' of a View .* needs anywidget: pip install 'neurotess\[notebook\]'; or use renderer='kernel'"
        with pytest.raises(AttributeError, match=needed):
            getattr(view, name)
        with pytest.raises(AttributeError, match=needed):
            setattr(view, name, None)
    with pytest.raises(AttributeError, match="no 'image': use renderer='kernel'"):
        view.image()
    with pytest.raises(AttributeError, match="a View has no 'tiem'"):
        view.tiem = 3
    with pytest.raises(ValueError, match="time= needs anywidget"):
        nt.View(cell, renderer="browser", values=np.ones((2, 100)), times=[0, 1], time=1)


@pytest.fixture
def over_time(cell: nt.Morphology) -> Any:
    """A view of values over time."""
    pytest.importorskip("anywidget")
    distances = cell.path_distances()
    return nt.View(cell, values=np.outer([0, 1, 2, 3], distances), times=[0, 0.5, 1, 1.5], time=1.1)


def test_views_have_the_properties_of_those_that_the_kernel_draws(cell: nt.Morphology, over_time: Any) -> None:
    view = over_time
    assert (view.color_by, view.time, view.times, view.hidden, view.legend) == ("value", 1.0, [0, 0.5, 1, 1.5], [], [])
    assert view.camera is None and view.on_pick is None and not view.orthographic
    view.time = 99
    assert view.time == 1.5
    # What the browser says.
    seen = [[0, 0, 9], [0, 0, 0], [0, 1, 0], 0.3]
    view.set_state({"_camera": seen, "color_by": "type", "hidden": ["axon"], "orthographic": True, "time": 0.5})
    assert view.camera == ((0, 0, 9), (0, 0, 0), (0, 1, 0), 0.3)
    assert (view.color_by, view.hidden, view.orthographic, view.time) == ("type", ["axon"], True, 0.5)
    # And what it is told.
    view.camera = np.eye(3)[0] * 5, (0, 0, 0), (0, 1, 0), 0.4
    assert view.get_state()["_camera"] == [[5, 0, 0], [0, 0, 0], [0, 1, 0], 0.4]
    assert view.legend[:2] == ["soma", "axon"]
    view.hide("soma")
    assert view.get_state()["hidden"] == ["soma", "axon"]
    view.show("axon")
    assert view.hidden == ["soma"]
    view.show()
    assert view.hidden == []
    view.hide("axon")
    view.color_by = "depth"
    assert view.hidden == [] and view.legend == []
    view.color_by = None
    assert view.color_by == "value"
    wrong: list[tuple[str, Any, str]] = [
        ("color_by", "size", r"^color_by='size': use one of 'type', 'neurite', .*'radius', 'value'$"),
        ("hidden", ["axon"], r"^hidden: the legend has no 'axon': it is a scale of numbers"),
    ]
    for name, value, message in wrong:
        with pytest.raises(ValueError, match=message):
            setattr(view, name, value)
    view.color_by = "type"
    with pytest.raises(ValueError, match=r"^hidden: the legend has no 'axxon': it has 'soma', "):
        view.hide("axxon")
    with pytest.raises(AttributeError, match="a View has no 'tiem': did you mean 'time'?"):
        view.tiem = 3
    with pytest.raises(ValueError, match="there is no report and no times="):
        nt.View(cell, time=3)
    with pytest.raises(ValueError, match="a time is set where there is a report"):
        nt.View(cell).time = 3
    view.close()


def test_reports_have_times(circuit_folder: Path) -> None:
    pytest.importorskip("anywidget")
    circuit = nt.Circuit(circuit_folder)
    view = nt.View(circuit, nodes=[0, 1], report="voltage", time=3.2)
    assert view.color_by == "value" and view.time == 3.0 and len(view.times) == 200
    assert view.times[:2] == circuit.report("voltage").times[:2].tolist()


def test_clicks_are_told_as_the_kernel_tells_them(cell: nt.Morphology, circuit_folder: Path) -> None:
    pytest.importorskip("anywidget")
    view, found = nt.View(cell), []
    click = {"picked": {"key": 0, "position": [1, 2, 3]}}
    view._handle_custom_msg(click, [])
    view.on_pick = found.append
    for key in range(5000):
        view._handle_custom_msg({"picked": {"key": key, "position": [1, 2, 3]}}, [])
    view._handle_custom_msg({"picked": None}, [])
    assert found.pop() is None
    known = [one for one in found if one is not None]
    assert len(known) < 5000 and {one["name"] for one in known} == {cell.name}
    assert set(known[0]) == {"cell", "name", "node_id", "section", "section_index", "sample", "position"}
    neurites = [one for one in known if one["section"]]
    assert all(one["section_index"] == one["section"] - 1 and one["position"] == [1, 2, 3] for one in known)
    assert all(one["sample"] is None for one in known if not one["section"]) and len(neurites) < len(known)
    mesh = nt.mesh(cell, level=1)
    on_mesh = set(zip(mesh.section.tolist(), mesh.sample.tolist(), strict=True))
    assert {(one["section"], one["sample"]) for one in neurites} == {pair for pair in on_mesh if pair[0]}
    circuit, found = nt.Circuit(circuit_folder), []
    view = nt.View(circuit, nodes=[3, 5])
    view.on_pick = found.append
    for key in range(5000):
        view._handle_custom_msg({"picked": {"key": key, "position": [1, 2, 3]}}, [])
    [population, *_] = set(circuit.nodes.population)
    assert {(one["name"], one["node_id"]) for one in found if one} == {(f"{population} {id}", id) for id in (3, 5)}


def test_notebooks_hold_the_frame_and_nothing_else(cell: nt.Morphology, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("anywidget")
    monkeypatch.delenv("VSCODE_PID", raising=False)
    view = nt.View(cell)
    bundle, _ = view._repr_mimebundle_()
    assert set(bundle) == {"text/plain", "text/html"} and framed(view) == view.html
    assert f'data-view="{view.model_id}"' in bundle["text/html"]
    # The page goes to the browser once, not with the widget's state.
    assert all(len(str(value)) < 100 for name, value in view.get_state().items() if name != "_esm")
    assert nt.View(cell).model_id != view.model_id
    # A program that shows widgets only gets one, which asks for the frame.
    monkeypatch.setenv("VSCODE_PID", "1")
    assert view._repr_mimebundle_()[0]["application/vnd.jupyter.widget-view+json"]["model_id"] == view.model_id
    sent: list[Any] = []
    monkeypatch.setattr(view, "send", sent.append)
    view._handle_custom_msg({"frame": True}, [])
    assert sent == [{"frame": bundle["text/html"]}]
