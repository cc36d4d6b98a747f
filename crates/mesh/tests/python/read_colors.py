"""Which colors of vertices trimesh and meshio find in files; prints JSON.

usage: read_colors.py FILE...

One object per file: file, reader, colors (red, green, blue of each vertex, 0 to 255).
"""

import json
import sys
from pathlib import Path

import meshio
import trimesh


def main():
    results = []
    for path in map(Path, sys.argv[1:]):
        if path.suffix == ".ply":
            reader, colors = "trimesh", trimesh.load_mesh(path, process=False).visual.vertex_colors
        else:
            reader, colors = "meshio", meshio.read(path).point_data["RGB"]
        results.append({"file": path.name, "reader": reader, "colors": colors[:, :3].tolist()})
    json.dump(results, sys.stdout)


if __name__ == "__main__":
    main()
