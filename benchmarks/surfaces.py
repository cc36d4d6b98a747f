"""What surfaces are worth: ours and navis', of the same files, as a table on standard output.

    python surfaces.py --bin DIR FILES...

Seconds are those of the whole process, reading and writing included, the best of three. Crossings and volume
are by `neurotess check`, whoever made the mesh; the volume is that of the tracing's cones and soma by
`neurotess info`, which counts twice what branches share. TetGen has a minute to fill the surface as it stands.
"""

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).parent

# TetGen's wrapper runs in a process of its own: on some surfaces it ends the process, or does not end.
FILL = """
import sys, numpy, tetgen, trimesh
mesh = trimesh.load(sys.argv[1], process=False)
filled = tetgen.TetGen(numpy.asarray(mesh.vertices, float), numpy.asarray(mesh.faces, numpy.int32))
print("tetrahedra", len(filled.tetrahedralize(switches=sys.argv[2])[1]))
"""


def json_of(command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=True)
    found = json.loads(done.stdout)
    return found[0] if isinstance(found, list) else found


def verdict(mesh):
    """What TetGen makes of a surface that must stay as it is. Files that it leaves go with the mesh's folder."""
    try:
        command = [sys.executable, "-c", FILL, str(mesh), "pYQ"]
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=60, check=False, cwd=mesh.parent
        )
    except subprocess.TimeoutExpired:
        return "no end in 60 s"
    last = done.stdout.strip().rsplit("\n", 1)[-1]
    return f"{int(last.split()[1]):,}" if last.startswith("tetrahedra") else "refused"


def best(make):
    """Seconds of the fastest of three, and what the last one said."""
    times = []
    for _ in range(3):
        start = time.perf_counter()
        said = make()
        times.append(time.perf_counter() - start)
    return min(times), said


def row(name, way, seconds, mesh, neurotess, volume):
    found = json_of([neurotess, "check", mesh, "--json"])
    pairs = found["self_intersections"]
    change = 100 * (found["volume"] / volume - 1) if found["closed"] else None
    return [
        name,
        way,
        f"{seconds:.2f}",
        f"{found['triangles'] + 2 * found['quads']:,}",
        "yes" if found["closed"] else "no",
        f"{pairs:,}" if found["self_intersections_complete"] else f"over {pairs:,}",
        "–" if change is None else f"{change:+.1f} %",
        verdict(mesh),
    ]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bin", type=Path, required=True)
    parser.add_argument("files", nargs="+", type=Path)
    arguments = parser.parse_args()
    neurotess = arguments.bin / "neurotess"
    print("| cell | by | s | triangles | closed | crossing pairs | volume | TetGen, tetrahedra |")
    print("| --- | --- | ---: | ---: | --- | ---: | ---: | ---: |")
    with tempfile.TemporaryDirectory() as folder:
        mesh = Path(folder) / "mesh.ply"
        for file in arguments.files:
            told = json_of([neurotess, "info", file, "--json"])
            volume = told["volume"] + (told["soma"] or {}).get("volume", 0.0)
            for way, flags in [
                ("neurotess, level 2", ["--level", "2"]),
                ("`--crossings merge`", ["--level", "2", "--crossings", "merge"]),
                ("`--simulation`", ["--simulation"]),
            ]:
                command = [neurotess, "mesh", file, "-o", mesh, "--force", "--quiet", *flags]
                seconds, _ = best(lambda command=command: subprocess.run(command, check=True, capture_output=True))
                print("|", " | ".join(row(file.stem[:24], way, seconds, mesh, neurotess, volume)), "|", flush=True)
            mesh.unlink()
            command = [sys.executable, HERE / "peers.py", "navis", file, mesh]
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            if done.returncode == 0:
                seconds = json.loads(done.stdout.strip().rsplit("\n", 1)[-1])["s"]
                print("|", " | ".join(row(file.stem[:24], "navis", seconds, mesh, neurotess, volume)), "|", flush=True)


if __name__ == "__main__":
    main()
