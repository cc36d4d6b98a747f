"""The package as a whole: import, command, documentation, types."""

from __future__ import annotations

import doctest
import importlib
import inspect
import json
import re
import subprocess
import sys
from pathlib import Path

import neurotess as nt
import pytest

PACKAGE = Path(nt.__file__).parent
ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted((ROOT / "bindings/python/examples").glob("*.py"))


def python(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, *arguments], capture_output=True, text=True, check=False)


def test_import_is_light() -> None:
    code = "import sys, neurotess; print(*sorted({'numpy', 're', 'asyncio'} & set(sys.modules)))"
    before = python("-S", "-c", "import sys; print(*sorted({'re', 'asyncio'} & set(sys.modules)))")
    assert before.stdout.split() == []
    path = f"import sys; sys.path.insert(0, {str(PACKAGE.parent)!r}); {code}"
    assert python("-S", "-c", path).stdout.split() == []


def test_the_command_is_there(samples: Path, tmp_path: Path) -> None:
    assert python("-m", "neurotess", "--version").stdout.strip() == f"neurotess {nt.__version__}"
    wrong = python("-m", "neurotess", "mesh")
    assert wrong.returncode == 2 and "required" in wrong.stderr
    out = tmp_path / "cell.ply"
    made = python("-m", "neurotess", "mesh", str(samples / "granule.swc"), "-o", str(out), "--level", "1")
    assert made.returncode == 0 and nt.check(out)["closed"]
    failed = python("-m", "neurotess", "info", str(tmp_path / "missing.swc"))
    assert failed.returncode == 1 and "missing.swc" in failed.stderr


@pytest.mark.parametrize("name", nt.__all__)
def test_everything_is_documented(name: str) -> None:
    thing = getattr(nt, name)
    if name == "__version__":
        return
    assert inspect.getdoc(thing), name
    if inspect.isclass(thing):
        members = vars(thing).items()
        bare = [
            key
            for key, value in members
            if not key.startswith("_")
            and (inspect.isfunction(value) or isinstance(value, (property, classmethod)))
            and not inspect.getdoc(value)
        ]
        assert bare == []


DOCUMENTED = ["_morphology", "_edits", "_meshes", "_meshing", "_circuits", "_reports", "_pages", "_pictures", "plot", "dask"]


@pytest.mark.parametrize("module", DOCUMENTED)
def test_examples_of_the_documentation_hold(module: str) -> None:
    failed, _ = doctest.testmod(importlib.import_module(f"neurotess.{module}"))
    assert failed == 0


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_examples_run(example: Path, tmp_path: Path) -> None:
    for package in ("matplotlib", "pandas"):
        pytest.importorskip(package)
    command = [sys.executable, str(example), str(tmp_path)]
    environment = {"MPLBACKEND": "agg"}
    import os

    ran = subprocess.run(
        command, capture_output=True, text=True, check=False, env={**os.environ, **environment}
    )
    assert ran.returncode == 0, ran.stderr
    assert any(tmp_path.iterdir())


@pytest.mark.full
def test_the_reference_is_made_without_a_warning(tmp_path: Path) -> None:
    for package in ("pdoc", "jupyter_rfb", "matplotlib", "dask"):
        pytest.importorskip(package)
    modules = ["neurotess", "neurotess._view", "neurotess.plot", "neurotess.dask"]
    made = python("-W", "error", "-m", "pdoc", "-o", str(tmp_path), *modules)
    assert made.returncode == 0 and "arning" not in made.stderr, made.stderr
    page = (tmp_path / "neurotess.html").read_text()
    missing = [name for name in nt.__all__ if f'id="{name}"' not in page]
    assert missing == []
    assert "Plots" in (tmp_path / "neurotess/plot.html").read_text()


@pytest.mark.full
def test_the_page_runs_as_printed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for package in ("trimesh", "pyvista", "navis", "pandas", "matplotlib", "jupyter_rfb"):
        pytest.importorskip(package)
    import warnings

    page = (ROOT / "docs/python.md").read_text(encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    blocks = re.findall(r"^```(python|)\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", nt.NeurotessWarning)
        for language, text in blocks:
            if language == "python":
                exec(compile(text, text.splitlines()[0], "exec"), names)
            elif text.startswith("neurotess "):
                ran = python("-m", *text.split())
                assert ran.returncode == 0, ran.stderr
    assert sum(language == "python" for language, _ in blocks) >= 11
    made = {path.name for path in tmp_path.iterdir()}
    assert {"cell.glb", "cell.png", "cell.asc", "both.png", "turn.gif", "paper.png", "both.html", "meshes"} <= made
    assert "none.swc: there is no such file" in capsys.readouterr().out


#: What type checkers know in loops over batches.
TYPED = """
import neurotess as nt

for result in nt.mesh_many(["cell.swc"], level=2):
    if result:
        result.mesh.save(f"{result.mesh.name}.ply")
    else:
        print(result.input, result.error.args)
for one in nt.Circuit("circuit").mesh(node_set="L4", level=2):
    if one.ok:
        one.mesh.save(f"{one.population}_{one.node_id}.ply")
cells: list[nt.Morphology] = nt.read(["a.swc", "b.swc"])
cell: nt.Morphology = nt.read("a.swc")
nt.render(cell, values={"section": [1.0, 2.0]}, title="current", unit="nA")
nt.render(cells, values=[cells[0].radii, None])
nt.Circuit("circuit").select([("cortex", 3)])
"""


@pytest.mark.full
def test_types_hold_in_loops(tmp_path: Path) -> None:
    pytest.importorskip("mypy")
    settings = str(ROOT / "bindings/python/pyproject.toml")
    (tmp_path / "typed.py").write_text(TYPED)
    checked = python("-m", "mypy", "--config-file", settings, "--strict", str(tmp_path / "typed.py"))
    assert checked.returncode == 0, checked.stdout
    (tmp_path / "wrong.py").write_text(TYPED.replace("    if result:\n    ", "    if True:\n    "))
    checked = python("-m", "mypy", "--config-file", settings, "--strict", str(tmp_path / "wrong.py"))
    assert 'has no attribute "save"' in checked.stdout


@pytest.mark.full
def test_types_hold() -> None:
    pytest.importorskip("mypy")
    settings = str(ROOT / "bindings/python/pyproject.toml")
    checked = python("-m", "mypy", "--config-file", settings, str(PACKAGE))
    assert checked.returncode == 0, checked.stdout
    files = [str(example) for example in EXAMPLES]
    checked = python("-m", "mypy", "--config-file", settings, "--strict", *files)
    assert checked.returncode == 0, checked.stdout


@pytest.mark.full
def test_the_stub_is_that_of_the_module() -> None:
    pytest.importorskip("mypy")
    checked = python("-m", "mypy.stubtest", "neurotess._neurotess", "--concise")
    assert checked.returncode == 0, checked.stdout + checked.stderr


def test_the_command_starts_itself_again() -> None:
    small = ["--neurons", "20", "--morphologies", "2", "--points", "100", "--json"]
    line = [sys.executable, "-m", "neurotess", "bench", "opening", *small]
    ran = subprocess.run(line, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    assert json.loads(ran.stdout)
