"""Times what other tools do with the same files: one JSON object on standard output.

    python peers.py morphio FILES...   load time, best of several, in one process
    python peers.py navis FILE OUT     read and mesh one file (run as a process of its own)
"""

import json
import sys
import time


def morphio(files):
    import morphio as m

    m.set_maximum_warnings(0)
    options = m.Option.allow_unifurcated_section_change
    times = {}
    for file in files:
        best = None
        try:
            for _ in range(7):
                start = time.perf_counter()
                m.Morphology(file, options)
                seconds = time.perf_counter() - start
                best = seconds if best is None else min(best, seconds)
        except Exception as error:  # what it refuses is a result too
            times[file] = {"error": type(error).__name__}
            continue
        times[file] = {"ms": 1e3 * best}
    return times


def navis(file, out):
    import navis as n
    import trimesh

    start = time.perf_counter()
    mesh = n.conversion.tree2meshneuron(n.read_swc(file))
    seconds = time.perf_counter() - start
    surface = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
    surface.export(out)
    return {"s": seconds, "faces": len(mesh.faces), "watertight": bool(surface.is_watertight)}


if __name__ == "__main__":
    if sys.argv[1] == "morphio":
        print(json.dumps(morphio(sys.argv[2:])))
    else:
        print(json.dumps(navis(sys.argv[2], sys.argv[3])))
