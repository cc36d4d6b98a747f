"""Pictures."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import neurotess as nt
import numpy as np
import pytest


SMALL = {"size": (96, 64), "samples": 4}


@pytest.fixture(scope="module")
def cell() -> nt.Morphology:
    return nt.synth("granule", seed=2, points=100)


def test_a_picture_is_an_array(cell: nt.Morphology) -> None:
    picture = nt.render(cell, legend=False, **SMALL)
    pixels = np.asarray(picture)
    assert pixels.shape == (64, 96, 4) and pixels.dtype == np.uint8 and picture.size == (96, 64)
    assert pixels[0, 0].tolist() == [255, 255, 255, 255]
    assert (pixels[..., :3] < 128).any()
    assert np.asarray(picture, dtype=float).max() == 255.0


def test_pictures_are_those_of_the_command(cell: nt.Morphology, tmp_path: Path) -> None:
    cell.save(tmp_path / "cell.swc")
    read = nt.read(tmp_path / "cell.swc")
    (tmp_path / "mine.toml").write_text('[types]\naxon = "#ff8800"\nbasal = "#00aa66"\n')
    for options, words in [
        ({}, []),
        ({"color_by": "radius", "scale_bar": True}, ["--color-by", "radius", "--scale-bar"]),
        ({"transparent": True, "view": "iso"}, ["--transparent", "--view", "iso"]),
        (
            {"wireframe": True, "level": 2, "background": "#203040"},
            ["--wireframe", "--level", "2", "--background", "203040"],
        ),
        (
            {"eye": (0, 20, 200), "target": (0, 20, 0), "light": (-1, 1, 1), "ao": 0},
            ["--eye", "0,20,200", "--target", "0,20,0", "--light=-1,1,1", "--ao", "0"],
        ),
        ({"orthographic": True, "lod": "static"}, ["--lod", "static", "--orthographic"]),
        ({"orthographic": 90.0}, ["--orthographic", "90"]),
        ({"lod": "exploration", "budget": 500}, ["--lod", "exploration", "--budget", "500"]),
        ({"palette": "okabe-ito"}, ["--palette", "okabe-ito"]),
        ({"palette": tmp_path / "mine.toml"}, ["--palette", str(tmp_path / "mine.toml")]),
        (
            {"palette": {"base": "okabe-ito", "axon": "#ff8800", "soma": "000", "background": "gray"}},
            "--palette okabe-ito --set-color axon=#ff8800 --set-color soma=000 --background gray".split(),
        ),
    ]:
        ours = nt.render(read, size=(200, 150), samples=4, **options)
        out = tmp_path / "theirs.png"
        command = [sys.executable, "-m", "neurotess", "render", str(tmp_path / "cell.swc"), "-q"]
        command += ["-o", str(out), "--size", "200x150", "--samples", "4", "--force", *words]
        subprocess.run(command, check=True)
        assert ours.to_png() == out.read_bytes(), options


def test_colors_of_ones_own_are_checked(cell: nt.Morphology, tmp_path: Path) -> None:
    alike = {"axon": "#d04248", "basal": "#48923e", "soma": "white"}
    with pytest.warns(nt.NeurotessWarning, match="look alike with deuteranopia"):
        nt.render(cell, palette=alike, **SMALL)
    with pytest.warns(nt.NeurotessWarning, match="nothing in the picture is called 'L5'"):
        nt.render(cell, palette={"L5": "#123456"}, **SMALL)
    (tmp_path / "bad.toml").write_text("[types]\naxon = 3\n")
    for palette, message in [
        ("mine", "palette's file"),
        (tmp_path / "bad.toml", "bad.toml:2: "),
        ({"axon": (1, 0)}, r"palette=\{'axon': …\}: \(1, 0\) is no color"),
        ({"axon": "reddish"}, "RRGGBB"),
    ]:
        with pytest.raises(ValueError, match=message):
            nt.render(cell, palette=palette, **SMALL)  # type: ignore[arg-type]


def test_several_cells_are_drawn_together(cell: nt.Morphology, samples: Path) -> None:
    both = nt.render([cell, samples / "star.swc"], color_by="neuron", **SMALL)
    assert (np.asarray(both) != np.asarray(nt.render(cell, color_by="neuron", **SMALL))).any()
    with pytest.raises(ValueError, match="no cell"):
        nt.render([], **SMALL)


def test_films_go_around_and_through_time(cell: nt.Morphology, circuit_folder: Path) -> None:
    turn = [np.asarray(picture) for picture in nt.film(cell, turntable=True, frames=3, **SMALL)]
    assert len(turn) == 3 and (turn[0] != turn[1]).any()
    circuit = nt.Circuit(circuit_folder)
    name = next(n for n, path in circuit.reports.items() if not nt.Report(path).is_of_spikes)
    times = circuit.report(name).times
    options = {"report": name, "nodes": [0], "legend": False, **SMALL}
    assert len(list(nt.film(circuit, time=(times[0], times[4], times[1] - times[0]), **options))) == 4
    with pytest.raises(ValueError, match="turntable=True, or time"):
        nt.film(cell)
    with pytest.raises(TypeError, match="unexpected keyword argument 'legends': did you mean 'legend'"):
        nt.film(cell, turntable=True, legends=False)


def test_numbers_over_time_are_drawn_and_filmed(cell: nt.Morphology) -> None:
    times = np.arange(0, 4, 0.5)
    sections = len(cell.sections)
    # Each time has one number everywhere.
    rising = np.repeat(times[:, None], len(cell), axis=1)
    options = {"times": times, "range": (0, 4), "legend": False, **SMALL}

    def shown(values: object, time: float) -> np.ndarray:
        return np.asarray(nt.render(cell, values=values, time=time, **options))

    def still(number: float) -> np.ndarray:
        return np.asarray(nt.render(cell, values=[number] * len(cell), range=(0, 4), legend=False, **SMALL))

    assert (shown(rising, 1.5) == still(1.5)).all() and (shown(rising, 3.9) == still(3.5)).all()
    assert (shown(rising.T, 1.5) == still(1.5)).all()
    by_section = [np.repeat(times[None], 3, axis=0) for _ in range(sections)]
    assert (shown({"segment": by_section}, 1.5) == still(1.5)).all()
    # A variable step: the last number is held.
    uneven = {"times": [0, 1, 4], "time": 3.0, "range": (0, 4), "legend": False, **SMALL}
    held = nt.render(cell, values=np.array([[0.0], [2.0], [4.0]]) * np.ones(len(cell)), **uneven)
    assert (np.asarray(held) == still(2.0)).all()
    film = list(nt.film(cell, values=rising, time=(0, 4, 1), **options))
    # Films are one picture that is colored anew: rounded once more.
    off = np.abs(np.asarray(film[3]).astype(int) - still(3.0))
    assert len(film) == 4 and off.max() <= 2 and (np.asarray(film[0]) != np.asarray(film[3])).any()
    for wrong, message in [
        ({"values": rising}, r"or times= of their frames"),
        ({"values": rising, "times": times[1:]}, r"numbers of 7 frames are needed"),
        ({"values": rising, "times": times[::-1]}, r"each later than the one before"),
        ({"values": rising[:, 1:], "times": times}, r"it has 100 points"),
        ({"values": {"segment": by_section[1:-1]}, "times": times}, r"a list with an array for each of"),
        ({"values": {"segment": by_section}}, r"are over time: give times="),
        ({"values": rising[0], "time": 1.0}, r"time= needs times="),
        ({"times": times}, r"times= are of the frames of values"),
    ]:
        with pytest.raises(ValueError, match=message):
            nt.render(cell, **wrong)
    with pytest.raises(nt.RenderError, match="has no values at 9 ms: choose a time from 0 to below 4"):
        nt.render(cell, values=rising, times=times, time=9)


def test_segments_are_where_they_are_along_their_sections(cell: nt.Morphology) -> None:
    from neurotess._series import Times, segments_of

    times = Times([0.0, 1.0])
    count = len(cell.sections)
    columns, soma, numbers = segments_of(cell, [np.zeros((2, 1))] + [np.ones((2, 2))] * count, times)
    assert soma == 0 and numbers.shape == (2, 1 + 2 * count) and numbers[0].tolist() == [0.0] + [1.0] * 2 * count
    own = cell.sections[-1].points
    before = cell.points[cell.parents[len(cell) - len(own)]]
    ways = np.cumsum(np.linalg.norm(np.diff(own, axis=0, prepend=before[None]), axis=1))
    second = ways / ways[-1] >= 0.5
    assert second.any() and not second.all()
    assert (columns[len(cell) - len(own) :] == 1 + 2 * (count - 1) + second).all()


def test_notebooks_and_files_get_png(cell: nt.Morphology, tmp_path: Path) -> None:
    picture = nt.render(cell, transparent=True, **SMALL)
    assert picture._repr_png_().startswith(b"\x89PNG")
    picture.save(tmp_path / "cell.png")
    assert (tmp_path / "cell.png").read_bytes() == picture.to_png()
    with pytest.raises(FileExistsError):
        picture.save(tmp_path / "cell.png", overwrite=False)
    pillow = pytest.importorskip("PIL.Image")
    with pillow.open(tmp_path / "cell.png") as read:
        assert (np.asarray(read) == np.asarray(picture)).all()
    picture.save(tmp_path / "cell.webp")
    assert (tmp_path / "cell.webp").stat().st_size > 0


def test_wrong_options_are_value_errors(cell: nt.Morphology) -> None:
    for options, message in [
        ({"color_by": "mood"}, "color_by='mood': use 'type', 'neurite', .* or 'value'"),
        ({"size": (0, 10)}, r"size=\(0, 10\): a width and a height of 1 to 32768 pixels"),
        ({"samples": "many"}, "samples='many': a whole number from 1 to 64 is needed"),
        ({"samples": 100}, "samples=100: a whole number from 1 to 64 is needed"),
        ({"fov": "wide"}, "fov='wide': a number is needed"),
        ({"axes": "x"}, "axes='x': True or False is needed"),
        ({"ao": -1}, "ao=-1: True or a radius"),
        ({"eye": (0, 0, 0)}, "eye= needs target=, too"),
        ({"time": 3}, "time= needs report=, too"),
        ({"eye": (0, 0, 0), "target": (0, 0, 0)}, "eye"),
        ({"color_by_attribute": "layer"}, "needs a circuit"),
        ({"report": "x.h5"}, "needs a circuit"),
        ({"range": (3, 1), "color_by": "radius"}, r"range=\(3, 1\): two numbers are needed, the lower first"),
    ]:
        with pytest.raises(ValueError, match=message) as caught:
            nt.render(cell, **options)  # type: ignore[arg-type]
        assert "--" not in str(caught.value)
    for options in ({"palette": "none.toml"}, {"points": "none.csv"}, {"meshes": "none.ply"}):
        with pytest.raises(nt.MissingFileError, match="none.*there is no such file"):
            nt.render(cell, **options)  # type: ignore[arg-type]


def test_colors_are_named_by_css_or_numbers(cell: nt.Morphology) -> None:
    from neurotess._colors import _named, text_of

    colors = pytest.importorskip("matplotlib.colors").CSS4_COLORS
    assert _named() == {k: v.lower() for k, v in colors.items() if k not in ("white", "black", "gray")}
    assert text_of("RebeccaPurple") == "#663399" and text_of("#123456") == "#123456"
    assert text_of((1.0, 0.5, 0.0)) == text_of((255, 128, 0)) == text_of(np.array([255, 128, 0])) == "#ff8000"
    assert text_of((1, 0, 0)) == "#ff0000" and text_of((2, 0, 0)) == "#020000"
    for wrong in ((1, 2), (300, 0, 0), 3, (0.5, None, 1)):
        with pytest.raises(ValueError, match="is no color"):
            text_of(wrong)

    def drawn(**options: object) -> np.ndarray:
        return np.asarray(nt.render(cell, legend=False, **SMALL, **options))  # type: ignore[arg-type]

    named = drawn(palette={"axon": "darkorange", "soma": "navy"}, background="linen")
    assert (named == drawn(palette={"axon": (255, 140, 0), "soma": "#000080"}, background=(250, 240, 230))).all()
    around = nt.mesh(nt.synth("star", points=60), level=1)
    by_name, by_number = (drawn(meshes={"mesh": around, "color": color}) for color in ("teal", (0, 128, 128)))
    assert (by_name == by_number).all()


def test_options_in_groups_are_those_outside(cell: nt.Morphology) -> None:
    flat = nt.render(cell, view="iso", fov=25, background="black", legend=False, size=(96, 64), samples=1)
    camera, scene = nt.Camera(view="iso", fov=25), nt.Scene(background="black", legend=False)
    grouped = nt.render(cell, camera=camera, scene=scene, size=(96, 64), samples=1)
    assert (np.asarray(flat) == np.asarray(grouped)).all()
    [first, _] = nt.film(cell, turntable=True, frames=2, camera={"fov": 25}, scene=scene, size=(96, 64), samples=1)
    assert first.size == (96, 64)
    with pytest.raises(ValueError, match="camera= has no 'veiw': did you mean 'view'"):
        nt.render(cell, camera={"veiw": "iso"}, **SMALL)  # type: ignore[typeddict-unknown-key]
    with pytest.raises(ValueError, match="fov= is said twice"):
        nt.render(cell, camera=camera, fov=30, **SMALL)
    with pytest.raises(ValueError, match="marker_shape='cube': use 'point'"):
        nt.render(cell, markers={"shape": "cube"}, **SMALL)  # type: ignore[typeddict-item]


def test_ids_are_what_is_at_each_pixel(cell: nt.Morphology) -> None:
    look = {"size": (240, 160), "view": "iso", "least_width": 0, "samples": 1}
    seen = nt.ids([cell, nt.synth("granule", points=80)], **look)
    assert {seen.cell.shape, seen.section.shape, seen.sample.shape} == {(160, 240)}
    assert set(np.unique(seen.cell)) == {-1, 0, 1}
    assert ((seen.section < 0) == (seen.cell < 0)).all()
    # The same pixels show, and a section has one color there.
    drawn = nt.render(cell, color_by="section", light="flat", ao=0, legend=False, transparent=True, **look)
    pixels, alone = np.asarray(drawn), nt.ids(cell, **look)
    assert ((pixels[..., 3] > 0) == (alone.cell == 0)).all()
    for section in np.unique(alone.section[alone.section > 0]):
        of_section = alone.section == section
        samples = set(alone.sample[of_section].tolist())
        assert samples <= set(cell.samples[cell.sections[section - 1].indices].tolist())
    with pytest.raises(TypeError, match="did you mean 'color_by'"):
        nt.ids(cell, colour_by="type")


def test_types_of_options_are_those_of_the_functions() -> None:
    import inspect

    for function, typed in ((nt.render, nt.RenderOptions), (nt.mesh, nt.MeshOptions)):
        parameters = set(inspect.signature(function).parameters) - {"what", "cell", "threads"}
        assert parameters == set(typed.__annotations__)


def test_adapters_that_are_not_there_are_render_errors(cell: nt.Morphology) -> None:
    with pytest.raises(nt.RenderError):
        nt.render(cell, adapter="no such adapter", **SMALL)


def test_circuits_and_their_voltages_are_drawn(circuit_folder: Path) -> None:
    circuit = nt.Circuit(circuit_folder)
    plain = nt.render(circuit, nodes=[0, 1, 2], **SMALL)
    assert plain.size == (96, 64)
    names = [name for name, path in circuit.reports.items() if not nt.Report(path).is_of_spikes]
    times = circuit.report(names[0]).times
    early, late = (
        circuit.render(report=names[0], time=float(t), range=(-80, 30), legend=False, **SMALL)
        for t in (times[0], times[len(times) // 2])
    )
    assert early.size == late.size
    late = np.asarray(circuit.render(time=float(times[-1]), range=(-80, 30), legend=False, **SMALL))
    named = circuit.render(report=names[0], time=float(times[-1]), range=(-80, 30), legend=False, **SMALL)
    assert (late == np.asarray(named)).all()
    with pytest.raises(ValueError, match="alone"):
        nt.render([circuit, nt.synth("granule", points=50)], **SMALL)  # type: ignore[list-item]


def test_views_are_turned_picked_and_closed(cell: nt.Morphology) -> None:
    pytest.importorskip("jupyter_rfb")
    view = nt.View([cell], renderer="kernel", size=(120, 90), samples=1)
    whole = np.asarray(view.image())
    assert whole.shape == (90, 120, 4) and (view.get_frame() == whole).all()

    picked: list[object] = []
    view.on_pick = picked.append
    dark = np.argwhere(whole[..., :3].sum(axis=2) < 300)
    y, x = dark[len(dark) // 2].tolist()
    view.handle_event({"type": "pointer_down", "x": x, "y": y, "buttons": (1,)})
    view.handle_event({"type": "pointer_up", "x": x, "y": y, "buttons": ()})
    [told] = picked
    assert isinstance(told, dict) and told["name"] == cell.name
    section, sample = told["section_index"], told["sample"]
    assert told["section"] == section + 1
    if section >= 0:
        of_section = cell.samples[cell.sections[section].indices].tolist()
        parent = cell.parents[cell.sections[section].indices.start]
        assert sample in [*of_section, *cell.samples[[parent]].tolist()]
    assert view.pick(0, 0) is None

    view.handle_event({"type": "pointer_down", "x": 10, "y": 10, "buttons": (1,)})
    view.handle_event({"type": "pointer_move", "x": 40, "y": 20, "buttons": (1,)})
    view.handle_event({"type": "pointer_up", "x": 40, "y": 20, "buttons": ()})
    turned = np.asarray(view.image())
    assert (turned != whole).any() and len(picked) == 1
    eye, target, up, _ = view.camera
    assert np.linalg.norm(up) == pytest.approx(1)
    assert np.dot(np.subtract(eye, target), up) == pytest.approx(0, abs=1e-6)
    view.handle_event({"type": "double_click", "x": 0, "y": 0})
    assert (np.asarray(view.image()) == whole).all()

    camera = view.camera
    view.orthographic = True
    assert view.camera == camera and (np.asarray(view.image()) != whole).any()
    told = view.pick(x, y)
    assert told is not None and told["name"] == cell.name
    view.orthographic = False
    assert (np.asarray(view.image()) == whole).all()

    with pytest.raises(AttributeError, match="no 'colour_by': did you mean 'color_by'"):
        view.colour_by = "radius"
    with pytest.raises(TypeError, match="unexpected keyword argument 'colour_by': did you mean 'color_by'"):
        nt.View(cell, colour_by="radius")
    view.color_by = "radius"
    assert (np.asarray(view.image()) != whole).any()
    with pytest.raises(ValueError, match="color_by"):
        view.color_by = "mood"
    assert view.color_by == "radius" and view.image().size == (120, 90)
    view.color_by = None
    assert (np.asarray(view.image()) == whole).all()
    with pytest.raises(ValueError, match="report"):
        view.time = 3.0
    view.handle_event({"type": "resize", "width": 60, "height": 40, "ratio": 2.0})
    assert view.get_frame().shape == (80, 120, 4)
    view.close()
    assert view.get_frame() is None
    with pytest.raises(RuntimeError, match="closed"):
        view.image()


def test_views_show_times(circuit_folder: Path) -> None:
    pytest.importorskip("jupyter_rfb")
    circuit = nt.Circuit(circuit_folder)
    name = next(n for n, path in circuit.reports.items() if not nt.Report(path).is_of_spikes)
    view = nt.View(circuit, report=name, renderer="kernel", size=(80, 60), samples=1, nodes=[0, 1])
    times = circuit.report(name).times
    assert view.times == times.tolist() and view.time == times[0]
    frames = {np.asarray(view.image()).tobytes()}
    for time in times[:: len(times) // 8]:
        view.time = float(time)
        frames.add(np.asarray(view.image()).tobytes())
    assert len(frames) > 1
    view.time = 1e9
    assert view.time == times[-1]
    widgets = pytest.importorskip("ipywidgets")
    slider = widgets.FloatSlider(min=times[0], max=times[-1])
    widgets.link((slider, "value"), (view, "time"))
    slider.value = times[3]
    assert view.time == times[3]
    view.close()


def test_cells_meshes_and_circuits_show_themselves(cell: nt.Morphology, circuit_folder: Path) -> None:
    mesh, circuit = nt.mesh(cell, level=1), nt.Circuit(circuit_folder)
    named = nt.Morphology.from_table(cell.to_table(), name="<b>")
    for shown, told in [
        (cell, ["<th", "100</td>", "µm</td>", "axon"]),
        (named, ["&lt;b&gt;"]),
        (mesh, ["triangles", f"{len(mesh.faces):,}", ">yes<"]),
        (circuit, [circuit.populations[0], "nodes"]),
    ]:
        text = shown._repr_html_()
        assert text.count("data:image/png;base64,") == 1 and "<b></b>" not in text
        for part in told:
            assert part in text, part


def test_surfaces_are_drawn_alone(cell: nt.Morphology) -> None:
    from types import SimpleNamespace

    mesh = nt.mesh(cell, level=2)
    alone = np.asarray(mesh.render(color="teal", legend=False, **SMALL))
    assert (alone[..., :3].min(axis=2) < 200).any()
    red, _, blue = (alone[..., k].astype(int)[alone[..., 0] < 250] for k in range(3))
    assert (blue - red).mean() > 10
    other = SimpleNamespace(vertices=mesh.vertices, faces=mesh.faces)
    assert (np.asarray(nt.render(other, **SMALL)) == np.asarray(nt.render([], meshes=other, **SMALL))).all()
    both = nt.render([cell, mesh], **SMALL)
    assert (np.asarray(both) == np.asarray(nt.render(cell, meshes=[mesh], **SMALL))).all()
    with pytest.raises(ValueError, match="there is no cell to draw"):
        nt.render([])
    with pytest.raises(ValueError, match="is needed, a number for each vertex"):
        mesh.render(values=[1.0])


def test_views_show_times_of_numbers(cell: nt.Morphology) -> None:
    pytest.importorskip("jupyter_rfb")
    rising = np.outer([0.0, 1.0, 2.0], np.ones(len(cell)))
    view = nt.View(cell, renderer="kernel", values=rising, times=[0, 2, 4], range=(0, 2), size=(96, 64), samples=4)
    assert view.times == [0, 2, 4] and view.time == 0
    first = np.asarray(view.image())
    view.time = 3.0
    assert view.time == 2 and (np.asarray(view.image()) != first).any()
    view.close()


def test_meshes_are_drawn_from_files_and_from_memory(cell: nt.Morphology, tmp_path: Path) -> None:
    around = nt.mesh(nt.synth("star", points=60), level=1)
    file = tmp_path / "around.ply"
    around.save(file)
    plain = np.asarray(nt.render(cell, legend=False, **SMALL))
    glass = {"opacity": 0.4, "color": "#2080ff", "fit": True}

    class Elsewhere:
        vertices = around.vertices
        faces = around.triangles()

    pictures = [
        np.asarray(nt.render(cell, meshes=meshes, legend=False, **SMALL))
        for meshes in ([{"mesh": file, **glass}], {"mesh": around, **glass}, [{"mesh": Elsewhere(), **glass}])
    ]
    assert (pictures[0] != plain).any()
    assert (pictures[0] == pictures[1]).all() and (pictures[0] == pictures[2]).all()
    nanometers = tmp_path / "nm.ply"
    nt.Mesh.from_arrays(1000 * around.vertices, around.triangles()).save(nanometers)
    scaled = nt.render(cell, meshes=[{"mesh": nanometers, "scale": 0.001, **glass}], legend=False, **SMALL)
    apart = np.abs(np.asarray(scaled).astype(int) - pictures[0])
    assert (apart > 8).mean() < 0.02
    wires = nt.render(cell, meshes=[str(file), {"mesh": around, "edges": True}], **SMALL)
    assert (np.asarray(wires) != plain).any()
    with pytest.raises(ValueError, match="from 0 to 1"):
        nt.render(cell, meshes=[{"mesh": file, "opacity": 7}], **SMALL)
    with pytest.raises(ValueError, match="names no mesh"):
        nt.render(cell, meshes=[{"color": "red"}], **SMALL)
    with pytest.raises(FileNotFoundError, match=r"none\.obj"):
        nt.render(cell, meshes=["none.obj"], **SMALL)


def test_a_png_tells_how_it_was_made(cell: nt.Morphology, tmp_path: Path) -> None:
    look: dict[str, Any] = {"size": (60, 40), "samples": 1, "view": "iso", "transparent": True, "least_width": 0}
    figure = nt.render(cell, color_by="depth", colormap="magma", **look)
    figure.save(tmp_path / "figure.png")
    again = nt.render(cell, like=tmp_path / "figure.png")
    assert np.array_equal(np.asarray(again), np.asarray(figure))
    assert again.to_png() == figure.to_png()
    # Options that are given go before its own.
    other = nt.render(cell, like=tmp_path / "figure.png", colormap="viridis")
    expected = nt.render(cell, color_by="depth", colormap="viridis", **look)
    assert np.array_equal(np.asarray(other), np.asarray(expected))
    with pytest.raises(nt.RenderError, match="no PNG file"):
        cell.save(tmp_path / "cell.swc")
        nt.render(cell, like=tmp_path / "cell.swc")


def test_what_was_in_memory_is_not_in_a_picture_and_is_told(cell: nt.Morphology, tmp_path: Path) -> None:
    small: dict[str, Any] = {"size": (60, 40), "samples": 1, "legend": False}
    numbers = np.arange(len(cell), dtype=np.float32)
    nt.render(cell, values=numbers, meshes=[nt.mesh(cell, level=1)], **small).save(tmp_path / "own.png")
    with pytest.warns(nt.NeurotessWarning, match="own.png: was drawn with values in memory, meshes in memory"):
        again = nt.render(cell, like=tmp_path / "own.png")
    assert np.array_equal(np.asarray(again), np.asarray(nt.render(cell, **small)))
    # A given side goes before the eye of the picture; switches of NumPy are switches.
    nt.render(cell, eye=(0, 0, 500), target=(0, 0, 0), **small).save(tmp_path / "eye.png")
    side = nt.render(cell, like=tmp_path / "eye.png", view="iso", axes=np.False_)
    assert np.array_equal(np.asarray(side), np.asarray(nt.render(cell, view="iso", **small)))
    with pytest.raises(FileNotFoundError):
        nt.render(cell, like=tmp_path / "none.png")


def test_a_group_is_a_dictionary(cell: nt.Morphology) -> None:
    wrong: Any = "iso"
    with pytest.raises(nt.OptionError, match=r"^camera='iso': a dictionary is needed, as in \{'view': …\}$"):
        nt.render(cell, camera=wrong)


def test_pictures_tell_where_points_are(cell: nt.Morphology) -> None:
    for options in ({"view": "iso"}, {"view": "top", "orthographic": True}):
        look = {"size": (320, 200), "legend": False, "samples": 1, "least_width": 3}
        picture = nt.render(cell, color_by="type", transparent=True, **look, **options)
        places = picture.project(cell.points)
        assert places.shape == (len(cell), 2)
        x, y = np.floor(places).astype(int).T
        assert (np.asarray(picture)[y, x, 3] > 0).mean() > 0.98, "points lie where something shows"
        # The same camera by value, of another picture.
        again = nt.render(cell, color_by="type", transparent=True, camera=picture.camera, **look)
        assert (np.asarray(again) == np.asarray(picture)).all()
    with pytest.raises(ValueError, match=r"points of shape .*: \(n, 3\) is needed"):
        picture.project(cell.points[:, :2])
    assert np.isnan(picture.project([[0, 1e6, 0]])).any() == (not picture.camera["orthographic"])


def test_scales_are_of_matplotlib(cell: nt.Morphology) -> None:
    pytest.importorskip("matplotlib")
    assert nt.render(cell, **SMALL).mappable is None
    mappable = nt.render(cell, color_by="depth", range=(0, 100), **SMALL).mappable
    assert (mappable.norm.vmin, mappable.norm.vmax, mappable.label) == (0, 100, "path distance (µm)")
    assert mappable.to_rgba(0)[:3] == pytest.approx((68 / 255, 1 / 255, 84 / 255), abs=1e-6)


def test_pictures_know_their_size_on_paper(cell: nt.Morphology, tmp_path: Path) -> None:
    import io
    import struct

    picture = nt.render(cell, **SMALL)
    file = io.BytesIO()
    picture.save(file, dpi=300)
    at = file.getvalue().index(b"pHYs") + 4
    assert struct.unpack(">IIB", file.getvalue()[at : at + 9]) == (11811, 11811, 1)
    assert file.getvalue().index(b"pHYs") < file.getvalue().index(b"IDAT")
    picture.save(tmp_path / "plain.png")
    assert b"pHYs" not in (tmp_path / "plain.png").read_bytes()
    assert nt.render(cell, like=tmp_path / "plain.png").size == picture.size
    for dpi in (0, "300"):
        with pytest.raises(ValueError, match=f"dpi={dpi}"):
            picture.to_png(dpi=dpi)  # type: ignore[arg-type]


def test_films_have_a_length_and_are_saved(cell: nt.Morphology, tmp_path: Path) -> None:
    film = nt.film(cell, turntable=True, frames=3, **SMALL)
    assert len(film) == 3 and [picture.size for picture in film] == [SMALL["size"]] * 3
    first = next(film)
    assert (np.asarray(first) == np.asarray(next(iter(film)))).all()
    with pytest.raises(ValueError, match="a film is .gif"):
        film.save(tmp_path / "film.avi")
    pil = pytest.importorskip("PIL.Image")
    film.save(tmp_path / "film.gif", fps=10)
    with pil.open(tmp_path / "film.gif") as saved:
        assert (saved.n_frames, saved.size, saved.info["duration"]) == (3, SMALL["size"], 100)


def test_points_have_colors_of_their_own(cell: nt.Morphology) -> None:
    look = {"size": (120, 80), "samples": 1, "light": "flat", "ao": 0, "background": "black"}
    colors = np.zeros((len(cell), 3))
    colors[cell.types == 2] = (1.0, 0.5, 0.0)
    colors[cell.types != 2] = (0.0, 0.5, 1.0)
    drawn = np.asarray(nt.render(cell, values=colors, **look))[..., :3].reshape(-1, 3)
    seen = {tuple(color) for color in np.unique(drawn, axis=0).tolist()}
    assert {(255, 128, 0), (0, 128, 255)} <= seen
    whole = nt.render(cell, values=np.round(colors * 255).astype(np.uint8), **look)
    assert (np.asarray(whole)[..., :3].reshape(-1, 3) == drawn).all()
    by_section = np.tile([[0.25, 0.75, 0.5]], (len(cell.sections), 1))
    one = np.asarray(nt.render([cell, cell], values=[{"section": by_section}, None], **look))
    assert (64, 191, 128) in {tuple(color) for color in np.unique(one[..., :3].reshape(-1, 3), axis=0).tolist()}
    for wrong, told in (({"colormap": "magma"}, "leave out colormap="), ({"title": "t"}, "leave out title=")):
        with pytest.raises(ValueError, match=told):
            nt.render(cell, values=colors, **look, **wrong)
    with pytest.raises(ValueError, match="from 0 to 1, or whole numbers to 255"):
        nt.render(cell, values=2 * colors, **look)


def test_kinds_have_the_colors_of_their_map(cell: nt.Morphology) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    kinds = np.where(cell.types == 2, 3, 1)
    look = {"size": (120, 80), "samples": 1, "light": "flat", "ao": 0, "legend": False, "background": "black"}
    drawn = np.asarray(nt.render(cell, values=kinds, colormap="tab10", **look))[..., :3].reshape(-1, 3)
    seen = {tuple(color) for color in np.unique(drawn, axis=0).tolist()}
    tab = [tuple(round(255 * part) for part in color) for color in matplotlib.colormaps["tab10"].colors]
    assert {tab[1], tab[3]} <= seen
