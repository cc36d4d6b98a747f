"""Cells as one HTML page. No adapter is needed."""

from __future__ import annotations

import inspect
import subprocess
import sys
from pathlib import Path
from typing import Any

import neurotess as nt
import numpy as np
import pytest


@pytest.fixture(scope="module")
def cell() -> nt.Morphology:
    return nt.synth("granule", seed=2, points=100)


def of_command(tmp_path: Path, *words: str | Path) -> str:
    out = tmp_path / "theirs.html"
    command = [sys.executable, "-m", "neurotess", "html", "-q", "-o", str(out), "--force", *map(str, words)]
    subprocess.run(command, check=True)
    return out.read_text(encoding="utf-8")


def test_a_page_is_text_or_a_file(samples: Path, tmp_path: Path) -> None:
    star = nt.read(samples / "star.swc")
    page = nt.html(star)
    assert page.startswith("<!doctype html>") and len(page) < 200_000
    assert "<title>star</title>" in page
    out = tmp_path / "new" / "star.html"
    assert star.to_html(out) == out and out.read_text(encoding="utf-8") == page == star.to_html()
    with pytest.raises(FileExistsError, match=r"star.html exists: use force=True"):
        nt.html(star, str(out))
    assert nt.html(star, str(out), title="<again>", force=True) == out
    assert "<title>&lt;again>" in out.read_text(encoding="utf-8")


def test_pages_are_those_of_the_command(samples: Path, tmp_path: Path) -> None:
    granule, star = samples / "granule.swc", samples / "star.swc"
    (tmp_path / "mine.toml").write_text('[types]\naxon = "#ff8800"\nbasal = "#00aa66"\n')
    cases: list[tuple[dict[str, Any], list[str | Path]]] = [
        ({}, []),
        (
            {"color_by": "depth", "colormap": "magma", "background": "black", "title": "a <b>"},
            ["--color-by", "depth", "--colormap", "magma", "--background", "black", "--title", "a <b>"],
        ),
        ({"color_by": "radius", "range": (0, 2)}, ["--color-by", "radius", "--range", "0,2"]),
        ({"palette": tmp_path / "mine.toml"}, ["--palette", tmp_path / "mine.toml"]),
        (
            {"palette": {"base": "okabe-ito", "axon": "#ff8800", "background": "gray"}},
            ["--palette", "okabe-ito", "--set-color", "axon=#ff8800", "--background", "gray"],
        ),
        (
            {"soma": "sphere", "radius_factor": 2, "least_width": 0, "types": ["basal", 2], "min_radius": 0.5},
            [*"--soma sphere --radius-factor 2 --least-width 0 --types basal,2 --min-radius 0.5".split()],
        ),
    ]
    for options, words in cases:
        assert nt.html(granule, **options) == of_command(tmp_path, granule, *words), options
    both = nt.html([granule, nt.read(star)], color_by="neuron")
    assert both == of_command(tmp_path, granule, star, "--color-by", "neuron")
    assert "<title>granule, star</title>" in both


def test_circuits_have_pages(circuit_folder: Path, tmp_path: Path) -> None:
    circuit = nt.Circuit(circuit_folder)
    page = circuit.to_html(nodes=[0, 1, 2])
    assert page == nt.html(circuit, nodes=[0, 1, 2])
    assert page == of_command(tmp_path, circuit_folder, "--nodes", "0-2")
    assert nt.html(circuit) == of_command(tmp_path, circuit_folder)
    with pytest.raises(ValueError, match=r"values= are of cells: .*circuit.morphology"):
        nt.html(circuit, values=[1.0])
    with pytest.raises(ValueError, match="alone"):
        nt.html([circuit])


def test_reports_and_markers_are_those_of_the_command(circuit_folder: Path, samples: Path, tmp_path: Path) -> None:
    circuit, two = nt.Circuit(circuit_folder), ["--nodes", "0-1"]
    voltage = circuit.reports["voltage"]
    spines = tmp_path / "spines.csv"
    spines.write_text("x,y,z,age\n0,0,0,1\n10,0,0,2\n")
    synapses = ["--synapses", "--synapse-side", "afferent", "--marker-color-by", "delay", "--marker-size", "3"]
    cases: list[tuple[dict[str, Any], list[str | Path]]] = [
        ({"report": "voltage"}, ["--report", voltage]),
        ({"report": voltage, "time": 3, "range": (-80, 0)}, ["--report", voltage, "--time", "3", "--range", "-80,0"]),
        ({"report": "voltage", "time": (0, 4, 0.5), "color_by": "type"}, ["--report", voltage, "--time", "0:4:0.5", "--color-by", "type"]),
        ({"synapses": True, "synapse_side": "afferent", "marker_color_by": "delay", "marker_size": 3}, [*synapses]),
        ({"markers": {"points": spines, "color_by": "age"}}, ["--points", spines, "--marker-color-by", "age"]),
    ]
    pages = {circuit.to_html(nodes=[0, 1])}
    for options, words in cases:
        pages.add(circuit.to_html(nodes=[0, 1], **options))
        assert nt.html(circuit, nodes=[0, 1], **options) == of_command(tmp_path, circuit_folder, *two, *words), options
    assert len(pages) == 1 + len(cases)
    star = samples / "star.swc"
    assert nt.html(star, points=spines) == of_command(tmp_path, star, "--points", spines)
    wrong: list[tuple[Any, dict[str, Any], str]] = [
        (star, {"report": "voltage.h5"}, "report needs a circuit"),
        (circuit, {"time": 3}, "time= needs report="),
        (circuit, {"report": "voltage", "time": (0, 4)}, r"^time=\(0, 4\): a time \(ms\) or \(from, to, step\) is needed"),
        (star, {"synapses": True}, "synapses needs a circuit"),
        (star, {"marker_size": 2}, "marker_size and marker_shape are for synapses or points"),
        (star, {"points": spines, "marker_size": -2}, r"^marker_size=-2: a number above 0"),
        (star, {"markers": {"points": spines, "shape": "point"}}, "markers of pages are spheres"),
        (star, {"color_by": "value"}, r"^color_by='value' needs values= or report="),
    ]
    for what, options, message in wrong:
        with pytest.raises(ValueError, match=message):
            nt.html(what, **options)
    for options in ({"points": "none.csv"}, {"report": "none.h5"}):
        with pytest.raises(nt.MissingFileError):
            nt.html(circuit, **options)


def test_values_of_ones_own_are_in_the_page(cell: nt.Morphology) -> None:
    plain = nt.html(cell)
    far = cell.path_distances()
    shown = nt.html(cell, values=far, values_title="distance", unit="µm")
    assert shown != plain and abs(len(shown) - len(plain)) < 2000
    # What a page begins with is another thing than what it holds.
    assert len({shown, nt.html(cell, values=far, color_by="type"), nt.html(cell, values=far, range=(0, 10))}) == 3
    assert shown == nt.html([cell], values=[far], values_title="distance", unit="µm", color_by="value")
    nt.html([cell, cell], values=[{"section": np.arange(len(cell.sections))}, None])
    played = nt.html(cell, values=np.outer([0, 1, 2], far), times=[0, 0.5, 1], values_title="voltage", unit="mV")
    assert len({shown, played, nt.html(cell, values=np.outer([0, 1, 3], far), times=[0, 0.5, 1])}) == 3
    with pytest.raises(ValueError, match="numbers of 2 frames"):
        nt.html(cell, values=np.outer([0, 1, 2], far), times=[0, 1])
    wrong: list[tuple[dict[str, Any], str]] = [
        ({"values": [1, 2]}, r"values= of granule.* are 2: it has 100 points"),
        ({"unit": "mV"}, r"unit='mV' is of values: give values=, too"),
        ({"color_by": "value"}, r"color_by='value' needs values="),
    ]
    for options, message in wrong:
        with pytest.raises(ValueError, match=message):
            nt.html(cell, **options)


def test_what_is_wrong_is_told_in_the_words_of_the_call(cell: nt.Morphology, tmp_path: Path) -> None:
    wrong: list[tuple[dict[str, Any], str]] = [
        ({"color_by": "size"}, r"^color_by='size': use 'type', 'neurite', .*'neuron' or 'value'$"),
        ({"color_by": 3}, r"^color_by=3: use 'type'"),
        ({"colormap": "coolwarm"}, r"^colormap='coolwarm': use 'viridis', .* or 'cividis'$"),
        ({"background": "reddish"}, r"^background='reddish': 'white', "),
        ({"palette": "mine"}, r"^palette='mine': use neurom, .* or a palette's file"),
        ({"palette": {"axon": "reddish"}}, r"^palette=\{'axon': 'reddish'\}: white, .*RRGGBB"),
        ({"range": (2, 1)}, r"^range=\(2, 1\): two numbers are needed, the lower first"),
        ({"least_width": -1}, r"^least_width=-1: a number of 0 or more is needed"),
        ({"soma": "cube"}, r"^soma='cube': use 'fem'"),
        ({"nodes": [1]}, r"^nodes= selects cells of a circuit"),
    ]
    for options, message in wrong:
        with pytest.raises(ValueError, match=message):
            nt.html(cell, tmp_path / "out.html", **options)
    assert not (tmp_path / "out.html").exists()
    with pytest.raises(nt.MissingFileError):
        nt.html(cell, palette=tmp_path / "none.toml")
    with pytest.raises(TypeError, match="unexpected keyword argument 'colour_by': did you mean 'color_by'"):
        cell.to_html(colour_by="type")  # type: ignore[call-overload]
    with pytest.raises(ValueError, match="no cell has a surface"):
        nt.html(cell, soma="none", types="custom_9")


def test_pages_too_large_for_mail_are_asked_for() -> None:
    cells = [nt.synth("pyramidal", seed=1, points=4000)] * 25
    with pytest.raises(ValueError, match=r"the page would have \d\.\d MB: leave out cells, or use force=True"):
        nt.html(cells)
    assert len(nt.html(cells, force=True)) > 2_000_000


def test_types_of_options_are_those_of_the_function() -> None:
    parameters = set(inspect.signature(nt.html).parameters) - {"what", "path"}
    assert parameters == set(nt.PageOptions.__annotations__)
