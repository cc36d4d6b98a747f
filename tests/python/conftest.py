"""What all tests of the package share; and lines that `cargo xtask test` adds up."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def samples() -> Path:
    return ROOT / "samples"


@pytest.fixture(scope="session")
def circuit_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A circuit of 12 cells with spikes and voltages, grown by the package's own command."""
    folder = tmp_path_factory.mktemp("circuit") / "small"
    command = [sys.executable, "-m", "neurotess", "synth", "circuit", "-o", str(folder)]
    command += ["--neurons", "12", "--morphologies", "3", "--points", "60", "--synapses", "9", "--quiet"]
    subprocess.run(command, check=True)
    return folder


@pytest.fixture(scope="session")
def has_adapter() -> str:
    """A name that any adapter has. Skips what needs one where there is none; with NEUROTESS_REQUIRE_GPU=1 that is a
    failure."""
    import neurotess as nt

    named = os.environ.get("NEUROTESS_ADAPTER", "")
    try:
        nt.render(nt.synth("granule", points=50), size=(16, 16), legend=False, adapter=named)
    except nt.RenderError as error:
        if os.environ.get("NEUROTESS_REQUIRE_GPU") == "1":
            raise
        pytest.skip(f"no graphics adapter ({error})")
    return named


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "full: run by `cargo xtask test --full` alone; CONTRIBUTING.md says why")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    if os.environ.get("NEUROTESS_FULL") == "1":
        return
    skipped = pytest.mark.skip(reason="full lane only: cargo xtask test --full")
    for item in items:
        if item.get_closest_marker("full"):
            item.add_marker(skipped)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """The lines of Rust's tests, which xtask knows."""
    stats = terminalreporter.stats
    passed, skipped = len(stats.get("passed", [])), stats.get("skipped", [])
    failed = stats.get("failed", []) + stats.get("error", [])
    print("\n     Running tests/python (pytest-0)")
    for report in skipped:
        reason = str(report.longrepr[2] if isinstance(report.longrepr, tuple) else report.longrepr)
        reason = reason.removeprefix("Skipped: ")
        print(f"test {report.nodeid} ... ignored ({reason})")
    for report in failed:
        print(f"test {report.nodeid} ... FAILED")
    verdict = "FAILED" if failed else "ok"
    print(f"test result: {verdict}. {passed} passed; {len(failed)} failed; {len(skipped)} ignored")
