"""Opens each mesh file with the independent readers that know its format; prints JSON.

usage: read_meshes.py [--simulators] FILE...

One object per file and reader: file, reader, vertices, triangles, quads, watertight, winding,
volume, low, high, attributes (name: [min, max]). Nothing is merged, except positions of STL.
"""

import json
import sys
from pathlib import Path

import meshio
import numpy
import pygltflib
import trimesh


def judged(points, triangles, quads):
    """What trimesh says of the faces, quads split."""
    split = numpy.concatenate([triangles.reshape(-1, 3), quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    mesh = trimesh.Trimesh(points, split, process=False)
    return described(mesh, len(triangles), len(quads))


def described(mesh, triangles, quads):
    points = numpy.asarray(mesh.vertices, dtype=float)
    return {
        "vertices": len(points),
        "triangles": triangles,
        "quads": quads,
        "watertight": bool(mesh.is_watertight),
        "winding": bool(mesh.is_winding_consistent),
        "volume": float(mesh.volume),
        "low": points.min(axis=0).tolist(),
        "high": points.max(axis=0).tolist(),
        "attributes": {},
    }


def ranges(attributes, names):
    """The lowest and highest value of the attributes that are there."""
    found = {name: numpy.asarray(attributes[name]) for name in names if name in attributes}
    return {
        name.strip("_").lower(): [float(values.min()), float(values.max())]
        for name, values in found.items()
    }


OWN = ["type", "point", "section", "radius"]
GLTF = ["_TYPE", "_POINT", "_SECTION", "_RADIUS"]


def with_trimesh(path):
    merge = path.suffix == ".stl"
    if path.suffix == ".glb":
        # A mesh for each type; each has all vertices.
        parts = trimesh.load(path, process=False).dump()
        assert all((part.vertices == parts[0].vertices).all() for part in parts)
        mesh = parts[0]
        mesh.faces = numpy.concatenate([part.faces for part in parts])
    else:
        mesh = trimesh.load(path, process=merge, force="mesh")
    result = described(mesh, len(mesh.faces), 0)
    if path.suffix == ".glb":
        result["attributes"] = ranges(mesh.vertex_attributes, GLTF)
    if path.suffix == ".ply":
        data = mesh.metadata.get("_ply_raw", {}).get("vertex", {}).get("data")
        if data is not None and data.dtype.names:
            result["attributes"] = ranges({name: data[name] for name in data.dtype.names}, OWN)
    return result


def with_meshio(path):
    mesh = meshio.read(path)
    cells = mesh.cells_dict
    triangles = cells.get("triangle", numpy.zeros((0, 3), dtype=int))
    quads = cells.get("quad", numpy.zeros((0, 4), dtype=int))
    result = judged(mesh.points, triangles, quads)
    result["attributes"] = ranges(mesh.point_data, OWN)
    if path.suffix == ".msh":
        assert set(numpy.concatenate(mesh.cell_data["gmsh:physical"])) == {
            code for code, dimension in mesh.field_data.values() if dimension == 2
        }
    return result


def with_pygltflib(path):
    """Reads accessors by their definition in the glTF specification."""
    model = pygltflib.GLTF2().load(str(path))
    blob = model.binary_blob()
    primitives = model.meshes[0].primitives
    primitive = primitives[0]
    assert all(vars(other.attributes) == vars(primitive.attributes) for other in primitives)
    translation = numpy.array(model.nodes[0].translation or [0, 0, 0])

    def numbers(index):
        accessor = model.accessors[index]
        view = model.bufferViews[accessor.bufferView]
        kind = {5126: numpy.float32, 5125: numpy.uint32}[accessor.componentType]
        width = {"SCALAR": 1, "VEC3": 3}[accessor.type]
        stride = view.byteStride or 4 * width
        start = (view.byteOffset or 0) + (accessor.byteOffset or 0)
        return numpy.ndarray((accessor.count, width), kind, blob, start, (stride, 4))

    positions = numbers(primitive.attributes.POSITION)
    bounds = model.accessors[primitive.attributes.POSITION]
    assert positions.min(axis=0).tolist() == bounds.min, "min"
    assert positions.max(axis=0).tolist() == bounds.max, "max"
    triangles = numpy.concatenate([numbers(one.indices) for one in primitives]).reshape(-1, 3)
    result = judged(positions + translation, triangles, numpy.zeros((0, 4), dtype=int))
    own = {name: numbers(getattr(primitive.attributes, name)) for name in GLTF}
    result["attributes"] = ranges(own, GLTF)
    return result


def with_gmsh(path):
    """Gmsh reads the file as a model: sections are its surfaces, types their physical groups."""
    import gmsh

    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.open(str(path))
    nodes, points, _ = gmsh.model.mesh.getNodes()
    row = numpy.empty(int(nodes.max()) + 1, dtype=int)
    row[nodes] = numpy.arange(len(nodes))
    triangles, kinds, sections = [], [], []
    for code in (tag for dimension, tag in gmsh.model.getPhysicalGroups(2) if dimension == 2):
        for surface in gmsh.model.getEntitiesForPhysicalGroup(2, code):
            _, [tags], [corners] = gmsh.model.mesh.getElements(2, surface)
            triangles.append(row[corners].reshape(-1, 3))
            kinds.append(code)
            sections.append(surface - 1)
            name = gmsh.model.getPhysicalName(2, code)
            assert name == NAMES.get(code, f"custom_{code}"), name
    gmsh.finalize()
    result = judged(points.reshape(-1, 3), numpy.concatenate(triangles), numpy.zeros((0, 4), int))
    result["attributes"] = ranges({"type": kinds, "section": sections}, OWN)
    return result


NAMES = {1: "soma", 2: "axon", 3: "basal_dendrite", 4: "apical_dendrite"}


def with_tetgen(path):
    """TetGen's own words for its files, and TetGen to fill what they describe."""
    import tetgen

    words = [line.split("#")[0].split() for line in path.read_text().splitlines()]
    words = [line for line in words if line]
    count = int(words[0][0])
    points = numpy.array(words[1 : count + 1], dtype=float)[:, 1:]
    facets = int(words[count + 1][0])
    rest = words[count + 2 : -2]
    if path.suffix == ".poly":
        rest = [corners + [head[2]] for head, corners in zip(rest[::2], rest[1::2])]
    assert len(rest) == facets and words[-2:] == [["0"], ["0"]]
    rest = numpy.array(rest, dtype=int)
    triangles, markers = rest[:, 1:4], rest[:, 4]
    result = judged(points, triangles, numpy.zeros((0, 4), int))
    filled = tetgen.TetGen(points, triangles.astype(numpy.int32), markers.astype(numpy.int32))
    nodes, tetrahedra, *_ = filled.tetrahedralize(plc=True, nobisect=True)
    a, b, c, d = (nodes[tetrahedra[:, n]] for n in range(4))
    volume = abs(numpy.einsum("ij,ij->i", b - a, numpy.cross(c - a, d - a))).sum() / 6
    assert abs(volume / result["volume"] - 1) < 1e-6, (volume, result["volume"])
    assert set(filled.triface_markers[filled.triface_markers != -1]) == set(markers)
    result["attributes"] = ranges({"type": markers}, OWN)
    return result


READERS = {
    ".ply": [with_trimesh, with_meshio],
    ".obj": [with_trimesh, with_meshio],
    ".stl": [with_trimesh],
    ".glb": [with_trimesh, with_pygltflib],
    ".off": [with_trimesh, with_meshio],
    ".vtu": [with_meshio],
    ".msh": [with_meshio],
}

# With --simulators.
SIMULATORS = {".msh": [with_gmsh], ".poly": [with_tetgen], ".smesh": [with_tetgen]}

# These readers want faces of one kind: trimesh in binary PLY, meshio in OFF.
TRIANGLES_ONLY = [(with_trimesh, "mixed.ply"), (with_meshio, "mixed.off")]


def main():
    results = []
    simulators = "--simulators" in sys.argv
    readers = SIMULATORS if simulators else READERS
    for path in map(Path, sys.argv[1 + simulators :]):
        for reader in readers.get(path.suffix, []):
            if (reader, path.name) in TRIANGLES_ONLY:
                continue
            name = reader.__name__.removeprefix("with_")
            results.append({"file": path.name, "reader": name, **reader(path)})
    json.dump(results, sys.stdout)


if __name__ == "__main__":
    main()
