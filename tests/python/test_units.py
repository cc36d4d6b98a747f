"""Numbers with units, masks and holes: converted, gray or told, never dropped."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import h5py
import neurotess as nt
import numpy as np
import pytest
from neurotess import _units

SMALL: dict[str, Any] = {"size": (96, 64), "samples": 1, "legend": False}


class Quantity:
    """As those of the package `quantities`, which neo has, too."""

    class Dimensionality:
        def __init__(self, string: str) -> None:
            self.string = string

    FACTORS = {"s": 1e3, "ms": 1.0, "V": 1e3, "mV": 1.0, "mm": 1e3, "um": 1.0}

    def __init__(self, magnitude: Any, unit: str) -> None:
        self.magnitude = np.asarray(magnitude, dtype=float)
        self.dimensionality = self.Dimensionality(unit)
        self.units = self

    def __len__(self) -> int:
        return len(self.magnitude)

    def rescale(self, unit: str) -> Quantity:
        if (unit in ("s", "ms")) != (self.dimensionality.string in ("s", "ms")):
            raise ValueError(f"no way from {self.dimensionality.string} to {unit}")
        factor = self.FACTORS[self.dimensionality.string] / self.FACTORS[unit]
        return Quantity(self.magnitude * factor, unit)


class Series:
    """As pynwb's TimeSeries."""

    def __init__(self, data: Any, unit: str, rate: float) -> None:
        self.data, self.unit, self.rate = data, unit, rate
        self.conversion, self.offset = 1e-3, -0.01
        self.timestamps, self.starting_time = None, 0.5

    def get_data_in_units(self) -> Any:
        return np.asarray(self.data) * self.conversion + self.offset


@pytest.fixture(scope="module")
def cell() -> nt.Morphology:
    return nt.synth("granule", seed=2, points=100)


def test_numbers_with_a_unit_are_converted() -> None:
    assert _units.unit_of(Quantity([1.0], "V")) == "V"
    assert _units.plain("values", Quantity([0.5], "V"), "mV").tolist() == [500.0]
    assert _units.plain("values", Quantity([0.5], "V")).tolist() == [0.5]
    assert _units.times_of("times", Quantity([0.5, 1.0], "s")).tolist() == [500.0, 1000.0]
    assert _units.times_of("time", [Quantity(0.5, "s"), Quantity(2.0, "ms")]) == [500.0, 2.0]
    with pytest.raises(ValueError, match="times are in 'V', which cannot be converted to 'ms'"):
        _units.times_of("times", Quantity([0.5], "V"))
    series = Series([10.0, 20.0], "volts", 2.0)
    assert _units.plain("values", series).tolist() == pytest.approx([0.0, 0.01])
    assert _units.plain("values", series, "mV").tolist() == pytest.approx([0.0, 10.0])
    assert _units.times_of("times", series).tolist() == [500.0, 1000.0]


def test_units_of_words_are_converted() -> None:
    class Named(np.ndarray):
        units = "s"

    named = np.array([0.5]).view(Named)
    assert _units.times_of("times", named).tolist() == [500.0]
    with pytest.raises(ValueError, match="'s', which is not converted to 'mV'"):
        _units.plain("values", named, "mV")


def test_masked_and_missing_numbers_are_nan() -> None:
    masked = np.ma.masked_array([1.0, 2.0, 3.0], [False, True, False])
    assert np.isnan(_units.plain("values", masked)).tolist() == [False, True, False]
    pandas = pytest.importorskip("pandas")
    holes = pandas.Series([1.0, None], dtype="Float64")
    assert np.isnan(_units.plain("values", holes)).tolist() == [False, True]


def test_infinite_numbers_are_gray_and_told() -> None:
    with pytest.warns(nt.NeurotessWarning, match="values: 2 of 3 are infinite: drawn gray"):
        told = _units.grayed("values", np.array([1.0, np.inf, -1e300]))
    assert np.isnan(told).tolist() == [False, True, True]


def test_data_sets_with_a_conversion_are_told(tmp_path: Path) -> None:
    with h5py.File(tmp_path / "a.nwb", "w") as file:
        data = file.create_dataset("data", data=[1.0, 2.0])
        assert _units.plain("values", data) is data
        data.attrs["conversion"], data.attrs["unit"] = 1e-3, "volts"
        with pytest.warns(nt.NeurotessWarning, match="conversion=0.001, which is not applied"):
            _units.plain("values", data, "volts")
        data.attrs["conversion"] = 1.0
        with pytest.warns(nt.NeurotessWarning, match="the unit of the data set is 'volts'; its numbers are taken as mV"):
            _units.plain("values", data, "mV")
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            _units.plain("values", data, "V")


def test_lengths_of_options_and_tables_have_units(cell: nt.Morphology) -> None:
    plain = nt.mesh(cell, max_error=0.05)
    assert len(nt.mesh(cell, max_error=Quantity(5e-5, "mm")).vertices) == len(plain.vertices)
    table = cell.to_table()
    given = {name: table[name] for name in table.dtype.names}
    given["x"] = Quantity(table["x"] * 1e-3, "mm")
    assert np.allclose(nt.Morphology.from_table(given).points, cell.points, atol=1e-4)


def test_types_that_no_point_has_are_told(cell: nt.Morphology) -> None:
    with pytest.warns(nt.NeurotessWarning, match="no point is of type 99"):
        mesh = nt.mesh(cell, types=[99], level=1)
    assert "types_unused" in [notice.code for notice in mesh.warnings]
    with pytest.warns(nt.NeurotessWarning, match="no point is of type 99: check types="):
        nt.html(cell, types=[99])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        nt.mesh(cell, types=["axon", "basal"], level=1)
        nt.html(cell, types=["axon", "basal"])


class TestPictures:
    def test_masked_points_are_gray(self, cell: nt.Morphology) -> None:
        numbers = np.linspace(0.0, 1.0, len(cell))
        holes = np.where(np.arange(len(cell)) < len(cell) // 2, np.nan, numbers)
        masked = np.ma.masked_invalid(holes)
        drawn = nt.render(cell, values=masked, range=(0, 1), **SMALL)
        assert (np.asarray(drawn) == np.asarray(nt.render(cell, values=holes, range=(0, 1), **SMALL))).all()
        assert (np.asarray(drawn) != np.asarray(nt.render(cell, values=numbers, range=(0, 1), **SMALL))).any()
        infinite = np.where(np.isnan(holes), np.inf, holes)
        with pytest.warns(nt.NeurotessWarning, match="infinite: drawn gray"):
            told = nt.render(cell, values=infinite, range=(0, 1), **SMALL)
        assert (np.asarray(told) == np.asarray(drawn)).all()

    def test_a_film_has_the_times_of_an_array(self, cell: nt.Morphology) -> None:
        times = np.array([0.0, 1.0, 2.0, 3.0])
        values = np.arange(4.0)[:, None] * np.ones(len(cell))
        film = {"values": values, "times": times, "range": (0, 3), **SMALL}
        chosen = list(nt.film(cell, time=np.array([3.0, 0.0, 1.0]), **film))
        assert len(chosen) == 3
        for picture, time in zip(chosen, (3.0, 0.0, 1.0), strict=True):
            still = np.asarray(nt.render(cell, time=time, **film)).astype(int)
            # A film is colored anew, a still is drawn: they round differently.
            assert np.abs(np.asarray(picture).astype(int) - still).max() <= 3
        assert (np.asarray(chosen[0]) != np.asarray(chosen[1])).any()
        seconds = {**film, "times": Quantity(times / 1e3, "s")}
        both = zip(nt.film(cell, time=(0.0, 3.0, 1.0), **film), nt.film(cell, time=(0.0, 3.0, 1.0), **seconds), strict=True)
        assert all((np.asarray(a) == np.asarray(b)).all() for a, b in both)
        with pytest.raises(ValueError, match="may be from, to and step, or times"):
            nt.film(cell, time=[0.0, 1.0, 2.0], **film)
        with pytest.raises(ValueError, match="leave out turntable= and frames="):
            nt.film(cell, time=times, frames=3, **film)

    def test_a_film_whose_legend_covers_the_cell_has_all_pictures(self) -> None:
        fork = nt.read(b"1 1 0 0 0 5 -1\n2 3 6 0 0 1 1\n3 3 20 0 0 1 2\n4 3 40 20 0 1 3\n5 3 40 -20 0 1 3\n")
        times = np.arange(3.0)
        values = times[:, None] * np.ones(len(fork))
        look: dict[str, Any] = {"title": "membrane", "size": (320, 240), "samples": 1}
        film = nt.film(fork, values={"point": values}, times=times, time=(0, 3, 1), **look)
        assert len(list(film)) == 3

    def test_the_unit_of_values_is_that_of_the_legend(self, cell: nt.Morphology) -> None:
        numbers = np.linspace(-0.07, 0.03, len(cell))
        look: dict[str, Any] = {"size": (320, 240), "samples": 1, "title": "membrane"}
        volts = nt.render(cell, values=Quantity(numbers, "V"), **look)
        assert (np.asarray(volts) == np.asarray(nt.render(cell, values=numbers, unit="V", **look))).all()
        millivolts = nt.render(cell, values=Quantity(numbers, "V"), unit="mV", **look)
        assert (np.asarray(millivolts) == np.asarray(nt.render(cell, values=1e3 * numbers, unit="mV", **look))).all()


def test_a_report_of_several_populations_names_them(tmp_path: Path) -> None:
    path = tmp_path / "report.h5"
    with h5py.File(path, "w") as file:
        for number, name in enumerate(("A", "B")):
            group = file.create_group(f"report/{name}")
            group["data"] = np.full((2, 1), number, np.float32)
            group["mapping/node_ids"] = np.array([0], np.uint64)
            group["mapping/index_pointers"] = np.array([0, 1], np.uint64)
            group["mapping/element_ids"] = np.array([0], np.uint32)
            group["mapping/time"] = [0.0, 2.0, 1.0]
    with pytest.raises(ValueError, match=r"has the populations \['A', 'B'\]: say population="):
        nt.Report(path)
    assert nt.Report(path, "B").values().tolist() == [[1.0], [1.0]]


def test_reports_that_contradict_themselves_are_told(tmp_path: Path) -> None:
    path = tmp_path / "report.h5"

    def write(time: list[float], nodes: list[int], kind: str = "f4") -> None:
        with h5py.File(path, "w") as file:
            file["report/A/data"] = np.array([[0.5] * len(nodes), [1.5] * len(nodes)], kind)
            file["report/A/mapping/node_ids"] = np.array(nodes, np.uint64)
            file["report/A/mapping/index_pointers"] = np.arange(len(nodes) + 1, dtype=np.uint64)
            file["report/A/mapping/element_ids"] = np.zeros(len(nodes), np.uint32)
            file["report/A/mapping/time"] = time

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for end in (1.0, 2.0):
            write([0.0, end, 1.0], [3, 4])
            nt.Report(path)
        # Numbers of 16 bits.
        write([0.0, 2.0, 1.0], [3, 4], "f2")
        assert nt.Report(path).values().tolist() == [[0.5, 0.5], [1.5, 1.5]]
    write([0.0, 1000.0, 1.0], [3, 4])
    with pytest.warns(nt.ReadWarning, match="1000 frames are announced, and 2 are there"):
        nt.Report(path)
    write([0.0, 0.0, 1.0], [3, 4])
    with pytest.warns(nt.ReadWarning, match="the end is 0 ms, before the last of 2 frames at 1 ms"):
        nt.Report(path)
    write([0.0, 2.0, 1.0], [3, 3])
    with pytest.warns(nt.ReadWarning, match="1 nodes are there more than once, the first is 3"):
        nt.Report(path)
