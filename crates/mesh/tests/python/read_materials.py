"""Which colors trimesh and meshio find in files; prints JSON.

usage: read_materials.py FILE...

One object per file and reader: file, reader, vertices, watertight (as it is read) and merged (with equal vertices
merged), materials (name: [color in the numbers of the file, triangles]).
"""

import json
import sys
from pathlib import Path

import meshio
import trimesh


def color(material):
    of_glb = getattr(material, "baseColorFactor", None)
    return [int(x) for x in (material.diffuse if of_glb is None else of_glb)[:3]]


def with_trimesh(path):
    scene = trimesh.load_scene(path, process=False)
    parts = scene.dump()
    whole = trimesh.util.concatenate(parts)
    result = {"vertices": len(whole.vertices), "watertight": bool(whole.is_watertight)}
    whole.merge_vertices(merge_norm=True, merge_tex=True)
    materials = [(getattr(part.visual, "material", None), len(part.faces)) for part in parts]
    return result | {
        "merged": bool(whole.is_watertight),
        "materials": {of.name: [color(of), faces] for of, faces in materials if of is not None and of.name},
    }


def with_meshio(path):
    mesh = meshio.read(path)
    whole = trimesh.Trimesh(mesh.points, mesh.cells_dict["triangle"], process=False)
    closed = bool(whole.is_watertight)
    return {"vertices": len(mesh.points), "watertight": closed, "merged": closed, "materials": {}}


def main():
    results = []
    for path in map(Path, sys.argv[1:]):
        for reader in [with_trimesh] + [with_meshio] * (path.suffix == ".obj"):
            name = reader.__name__.removeprefix("with_")
            results.append({"file": path.name, "reader": name, **reader(path)})
    json.dump(results, sys.stdout)


if __name__ == "__main__":
    main()
