"""Benchmarks of reading and meshing beside other tools, in one run: `cargo xtask bench` calls it.

    python bench.py --bin DIR --out DIR --samples FILES...  [--peers PYTHON]

DIR of --bin holds `neurotess` and `examples/stages`, built with --release. Prints Markdown tables
and writes them with all raw figures to --out. Needs nothing beyond Python 3 on Linux or macOS;
peers are timed with the interpreter given, where there is one.
"""

import argparse
import json
import os
import platform
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).parent
# Seconds after which a peer is given up.
PATIENCE = "120"
# How often ours and a peer are timed in turns.
ROUNDS = 5


def run(command):
    """Runs a command; seconds, seconds of all cores, peak memory in MiB, standard output."""
    start = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    out, errors = process.stdout.read(), process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    seconds = time.perf_counter() - start
    if os.waitstatus_to_exitcode(status) != 0:
        sys.exit(f"{' '.join(map(str, command))}: {errors.decode()}")
    unit = 1 if platform.system() == "Darwin" else 1024
    cpu = usage.ru_utime + usage.ru_stime
    return {"s": seconds, "cpu": cpu, "mib": usage.ru_maxrss * unit / 2**20, "out": out.decode()}


def best(command, runs=3):
    return min((run(command) for _ in range(runs)), key=lambda r: r["s"])


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "| --- " + "| ---: " * (len(head) - 1) + "|"]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows])


def interleaved(arguments):
    """Our stages and MorphIO's load, file by file in turns, the best of each: what else the machine
    does meets both alike."""
    stage, loads = {}, {}
    for file in arguments.samples:
        for _ in range(ROUNDS):
            keep_best(stage, file, json.loads(run([arguments.bin / "examples/stages", file])["out"]))
            if arguments.peers:
                keep_best(loads, file, morphio_load(arguments, file))
    return stage, loads


def keep_best(best_of, file, figures):
    best = best_of.setdefault(file, figures)
    for key, value in figures.items():
        if key.endswith("ms"):
            best[key] = min(best.get(key, value), value)


def morphio_load(arguments, file):
    """In a process of its own: on deep trees it does not return."""
    process = subprocess.run([arguments.peers, HERE / "peers.py", "morphio", file],
                             capture_output=True, text=True)
    if process.returncode != 0:
        return {"error": "crashes"}
    return json.loads(process.stdout.splitlines()[-1])[file]


def stage_table(stage, loads):
    head = ["cell", "points", "read ms", "MB/s", "M points/s", "soma ms", "coarse ms", "first ms",
            "refine M triangles/s", "MorphIO load ms", "read: × MorphIO", "read + soma + coarse / MorphIO"]
    rows = []
    for file, s in stage.items():
        if "error" in s:
            continue
        load = loads.get(file, {})
        theirs = load.get("ms")
        ours = s["read_ms"] + s["coarse_ms"]
        rows.append([
            Path(file).stem[:24], s["points"], f"{s['read_ms']:.2f}",
            f"{s['bytes'] / s['read_ms'] / 1e3:.0f}", f"{s['points'] / s['read_ms'] / 1e3:.1f}",
            f"{s['soma_ms']:.2f}", f"{s['coarse_ms']:.2f}", f"{s['first_ms']:.0f}",
            f"{s['triangles'] / s['refine_ms'] / 1e3:.1f}",
            f"{theirs:.2f}" if theirs else load.get("error", "–"),
            f"{theirs / s['read_ms']:.1f}" if theirs else "–",
            f"{ours / theirs:.2f}" if theirs else "–",
        ])
    return table(head, rows)


def large_cell(arguments, scratch):
    """A cell of as many points as the largest tracing that peers were measured with."""
    out = scratch / "motor_122821.swc"
    run([arguments.bin / "neurotess", "synth", "motor", "-o", out, "--points", "122821"])
    return out


def whole(arguments, scratch):
    head = ["cell", "level", "triangles", "s", "core s", "peak MiB", "file MiB", "peak / file",
            "navis s", "navis MiB", "navis closed"]
    rows = []
    for file in [*arguments.samples, large_cell(arguments, scratch)]:
        peer = ["–", "–", "–"]
        if arguments.peers and Path(file).stat().st_size < 8e6:
            command = [arguments.peers, HERE / "peers.py", "navis", file, scratch / "peer.ply"]
            try:
                p = run(["timeout", PATIENCE, *command])
                peer = [f"{p['s']:.1f}", f"{p['mib']:.0f}", json.loads(p["out"])["watertight"]]
            except SystemExit:
                peer = ["fails", "–", "–"]
        for level in (1, 4):
            out = scratch / "ours.ply"
            command = [arguments.bin / "neurotess", "mesh", file, "-o", out, "--force", "--json",
                       "--level", str(level)]
            r = best(command)
            report = json.loads(r["out"])
            report = report[0] if isinstance(report, list) else report
            rows.append([Path(file).stem[:24], level, report["triangles"], f"{r['s']:.2f}",
                         f"{r['cpu']:.2f}", f"{r['mib']:.0f}", f"{out.stat().st_size / 2**20:.0f}",
                         f"{r['mib'] / (out.stat().st_size / 2**20):.1f}", *peer])
            peer = ["", "", ""]
    return table(head, rows)


def thousand(arguments, scratch, cells):
    """Cells of 5,000 points, grown, then meshed to level-4 PLY in one call."""
    tracings, meshes = scratch / "tracings", scratch / "meshes"
    grow = run([arguments.bin / "neurotess", "synth", "pyramidal", "-o", tracings, "--points", "5000",
                "--count", str(cells), "--seed", "1"])
    mesh = run([arguments.bin / "neurotess", "mesh", tracings, "-o", meshes, "--level", "4"])
    size = sum(f.stat().st_size for f in meshes.rglob("*.ply"))
    for f in meshes.rglob("*.ply"):
        f.unlink()
    shutil.rmtree(tracings)
    return (f"{cells} synthetic pyramidal cells of 5,000 points: grown in {grow['s']:.1f} s, meshed to "
            f"level-4 PLY ({size / 2**30:.1f} GiB) in {mesh['s']:.1f} s ({mesh['cpu']:.1f} s of one core), peak memory {mesh['mib']:.0f} MiB.")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bin", type=Path, required=True)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--peers")
    parser.add_argument("--only-stages", action="store_true")
    parser.add_argument("--cells", type=int, default=1000)
    parser.add_argument("--samples", nargs="+", required=True)
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    stage, loads = interleaved(arguments)
    if arguments.only_stages:
        print(stage_table(stage, loads))
        return
    with tempfile.TemporaryDirectory(dir=arguments.out) as scratch:
        scratch = Path(scratch)
        parts = [
            f"{os.cpu_count()} cores, {platform.machine()}, {time.strftime('%Y-%m-%d')}",
            "## Stages, one thread\n\n" + stage_table(stage, loads),
            "## Whole process, file to PLY\n\n" + whole(arguments, scratch),
            "## Many cells\n\n" + thousand(arguments, scratch, arguments.cells),
        ]
    text = "\n\n".join(parts) + "\n"
    (arguments.out / "benchmarks.md").write_text(text)
    (arguments.out / "raw.json").write_text(json.dumps({"stages": stage, "morphio": loads}, indent=1))
    print(text)


if __name__ == "__main__":
    main()
