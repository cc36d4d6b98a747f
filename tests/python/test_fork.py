"""What a forked process does: each public function, after the package's threads were at work in its parent."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")

#: Run in a process of its own, since it forks: name, then what a child does. `adapter`: what draws.
SCRIPT = '''
import os, signal, sys, time, warnings
warnings.simplefilter("ignore")
import neurotess as nt
import numpy as np

work, circuit_folder, adapter, opened = sys.argv[1], sys.argv[2], sys.argv[3], sys.argv[4] == "1"
cell = nt.synth("granule", seed=1, points=80)
mesh = nt.mesh(cell, level=2)
path = os.path.join(work, "cell.swc")
cell.save(path)
mesh_path = os.path.join(work, "mesh.ply")
mesh.save(mesh_path)
circuit = nt.Circuit(circuit_folder)
name_of = lambda path: not nt.Report(path).is_of_spikes
name = next(name for name, path in circuit.reports.items() if name_of(path))
report = circuit.report(name)
list(nt.mesh_many([cell, cell], threads=2, level=1))
SMALL = {"size": (48, 32), "samples": 1, "legend": False, "adapter": adapter}
if opened:
    nt.render(cell, **SMALL)

functions = {
    "read": lambda: nt.read(path),
    "synth": lambda: nt.synth("granule", seed=2, points=80),
    "edit": lambda: nt.edit(cell, resample=1.0),
    "diff": lambda: nt.diff(cell, nt.read(path)),
    "mesh": lambda: nt.mesh(cell, level=2),
    "mesh with threads": lambda: nt.mesh(cell, level=2, threads=2),
    "mesh for simulators": lambda: nt.mesh(cell, simulation=True),
    "mesh_many": lambda: [r.mesh for r in nt.mesh_many([cell, cell], level=1)],
    "mesh_all": lambda: nt.mesh_all(path, os.path.join(work, "all"), level=1, overwrite=True),
    "neuroglancer": lambda: nt.neuroglancer(path, os.path.join(work, "shared"), lods=1, overwrite=True),
    "read_mesh": lambda: nt.read_mesh(mesh_path),
    "check": lambda: nt.check(mesh),
    "html": lambda: nt.html([cell, cell]),
    "ids": lambda: nt.ids(cell, **SMALL),
    "Morphology.measures": lambda: cell.measures(),
    "Morphology.to_table": lambda: cell.to_table(),
    "Morphology.save": lambda: cell.save(os.path.join(work, "again.swc"), overwrite=True),
    "Mesh.check": lambda: mesh.check(),
    "Mesh.volume": lambda: nt.read_mesh(mesh_path).volume,
    "Mesh.save": lambda: mesh.save(os.path.join(work, "again.stl"), overwrite=True),
    "Circuit": lambda: len(nt.Circuit(circuit_folder)),
    "Circuit.select": lambda: circuit.select(sample=3),
    "Circuit.nodes": lambda: circuit.nodes,
    "Circuit.morphology": lambda: circuit.morphology(1),
    "Circuit.inputs": lambda: circuit.inputs(1),
    "Circuit.placement": lambda: circuit.placement(1),
    "Circuit.mesh": lambda: [len(m.mesh.vertices) for m in circuit.mesh([0, 1], level=1)],
    "Circuit.report": lambda: circuit.report(name).values(),
    "Circuit.to_html": lambda: circuit.to_html(nodes=[0, 1]),
    "Report.values": lambda: report.values(),
    "Report.at": lambda: report.at(1.0),
}
functions |= {
    "render": lambda: nt.render(cell, **SMALL),
    "film": lambda: list(nt.film(cell, turntable=True, frames=2, **SMALL)),
    "Circuit.render": lambda: circuit.render(**SMALL),
}
missing = {name for name in nt.__all__ if type(getattr(nt, name)).__name__ == "function"} - set(functions)
assert not missing, missing
assert sys.modules.get("concurrent.futures.process") is None

for done, function in functions.items():
    sys.stdout.flush()
    start = time.time()
    child = os.fork()
    if child == 0:
        signal.alarm(60)
        code = 0
        try:
            function()
        except nt.RenderError as error:
            code = 3 if "spawn" in str(error) else 4
            print(error)
        except BaseException as error:
            print(done, repr(error))
            code = 1
        sys.stdout.flush()
        os._exit(code)
    _, status = os.waitpid(child, 0)
    said = "hangs" if os.WIFSIGNALED(status) else os.WEXITSTATUS(status)
    print(f"{done}: {said} after {time.time() - start:.1f} s")
    drawn = done in ("render", "film", "Circuit.render")
    assert said == (3 if drawn and opened and adapter != "cpu" else 0), done
'''


def _run(*arguments: str) -> None:
    command = [sys.executable, "-c", SCRIPT, *arguments]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_each_function_works_in_a_forked_process(tmp_path: Path, circuit_folder: Path) -> None:
    _run(str(tmp_path), str(circuit_folder), "cpu", "1")


def test_a_forked_process_opens_a_device_of_its_own(tmp_path: Path, circuit_folder: Path, has_adapter: str) -> None:
    _run(str(tmp_path), str(circuit_folder), has_adapter, "0")


def test_a_device_of_the_parent_is_an_error_that_names_spawn(
    tmp_path: Path, circuit_folder: Path, has_adapter: str
) -> None:
    _run(str(tmp_path), str(circuit_folder), has_adapter, "1")
