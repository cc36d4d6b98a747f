"""Times pictures by the processor beside those by a graphics adapter, in turn, and prints a table.

    python benchmarks/drawn.py target/release/neurotess ADAPTER CIRCUIT [REPORT]

The program is a release build with the feature `gpu`. Each row is the best of three runs of the command, from file to PNG:
seconds of the processor (user and system, all threads), and the most memory. An adapter has a cold row, too, whose shaders
are compiled anew: its first run in an empty cache. Linux only.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

RUNS = 3
CLOSE = ["--eye", "0,20,80", "--target", "0,20,0"]
SIZE = ["--size", "1920x1080"]


def cost(words: list[str], cache: str) -> tuple[float, float]:
    """Seconds of the processor, and MB of memory."""
    environment = {**os.environ, "MESA_SHADER_CACHE_DIR": cache, "XDG_CACHE_HOME": cache}
    process = subprocess.Popen(words, env=environment)
    _, status, used = os.wait4(process.pid, 0)
    assert status == 0, words
    return used.ru_utime + used.ru_stime, used.ru_maxrss / 1000


def main() -> None:
    program, adapter, circuit, *report = sys.argv[1:]
    samples = sorted(Path("samples").glob("*.swc"))
    scenes = [(path.stem, [str(path)], RUNS) for path in samples]
    scenes += [("pyramidal, close up", ["samples/pyramidal.swc", *CLOSE], RUNS), ("circuit", [circuit], 1)]
    if report:
        series = [circuit, "--report", report[0], "--time"]
        scenes += [("recording, one picture", [*series, "0"], 1), ("recording, 40 pictures", [*series, "0:40:1"], 1)]
    print(f"| processor seconds | cpu | {adapter}, warm | | cold | | MB, cpu | MB, {adapter} |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |")
    for name, words, runs in scenes:
        with tempfile.TemporaryDirectory() as cache:
            picture = [*SIZE, "--force", "--quiet", "--no-progress", "-o", f"{cache}/picture.png"]
            command = [program, "render", *words, *picture, "--adapter"]
            cold = cost([*command, adapter], cache)
            pairs = [(cost([*command, "cpu"], cache), cost([*command, adapter], cache)) for _ in range(runs)]
        own, warm = (min(pair[k] for pair in pairs) for k in (0, 1))
        times = [f"{own[0]:.2f}", f"{warm[0]:.2f}", f"{warm[0] / own[0]:.1f} ×", f"{cold[0]:.2f}", f"{cold[0] / own[0]:.1f} ×"]
        print(f"| {name} | {' | '.join(times)} | {own[1]:.0f} | {warm[1]:.0f} |", flush=True)


if __name__ == "__main__":
    main()
