#!/usr/bin/env bash
# The wheels of libsonata and MorphIO have no deflate: they open no gzip data set, so no network that bmtk writes.
#
# bmtk 1.2.0 compresses all it saves (gzip, unless told otherwise). libsonata 0.2.2 opens such a file and raises at the
# first data that is read, as MorphIO 3.5.0 does for a compressed morphology: "required filter 'deflate' is not
# registered". Uncompressed, chunked, shuffled data and such with checksums are read. LZF, h5py's other one, is not read
# either.
#
#   bmtk, default                          libsonata: RuntimeError, bluepysnap 3.0.8, which is built on it, too
#   bmtk, save(compression=None)           libsonata: 0 0 1 1
#   H5 morphology, plain                   MorphIO: 2 points
#   H5 morphology, gzip                    MorphIO: RuntimeError
#
# And MorphIO warns of points in float64, which h5py makes of an array of Python's floats, for each file.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"${PYTHON:-python3}" -m venv a
"${PYTHON:-python3}" -m venv b
a/bin/pip install -q bmtk==1.2.0 neuron==9.0.2
b/bin/pip install -q libsonata==0.2.2 bluepysnap==3.0.8 morphio==3.5.0 h5py

cat > a.py <<'PY'
import json

from bmtk.builder import NetworkBuilder

for folder, options in (("packed", {}), ("plain", {"compression": None})):
    network = NetworkBuilder("cells")
    network.add_nodes(N=2, model_type="virtual", x=[1.0, 2.0])
    network.add_edges(source=network.nodes(), target=network.nodes(), connection_rule=1)
    network.build()
    network.save(output_dir=folder, **options)
    nodes = {
        "nodes_file": f"{folder}/cells_nodes.h5",
        "node_types_file": f"{folder}/cells_node_types.csv",
        "populations": {"cells": {"type": "virtual"}},
    }
    with open(f"{folder}.json", "w") as file:
        json.dump({"version": 2, "networks": {"nodes": [nodes], "edges": []}, "components": {}}, file)
PY
cat > b.py <<'PY'
import sys

import bluepysnap
import h5py
import libsonata
import morphio
import numpy


def sources(folder):
    edges = libsonata.EdgeStorage(f"{folder}/cells_cells_edges.h5").open_population("cells_to_cells")
    return sorted(edges.source_nodes(edges.select_all()).tolist())


def places(folder):
    return bluepysnap.Circuit(f"{folder}.json").nodes["cells"].get(properties="x").tolist()


def points(kind, **options):
    with h5py.File("cell.h5", "w") as file:
        file.create_dataset("points", data=numpy.array([[6, 0, 0, 2], [16, 0, 0, 2]], kind), **options)
        file.create_dataset("structure", data=numpy.array([[0, 3, -1]], "i4"), **options)
    return len(morphio.Morphology("cell.h5").points)


def refused(what, read, *arguments, **options):
    try:
        read(*arguments, **options)
    except RuntimeError as error:
        assert "filter" in str(error) or "Plugin" in str(error), error
        print(f"{what}: {str(error).splitlines()[0][:60]}")
        return
    raise SystemExit(f"{what}: read")


print("libsonata, plain:", sources("plain"))
assert sources("plain") == [0, 0, 1, 1]
assert places("plain") == [1, 2]
refused("libsonata, bmtk's default", sources, "packed")
refused("bluepysnap, bmtk's default", places, "packed")

for options in ({}, {"chunks": True}, {"shuffle": True}, {"fletcher32": True}):
    assert points("f4", **options) == 2
print("MorphIO, plain: 2 points")
refused("MorphIO, gzip", points, "f4", compression="gzip")
refused("MorphIO, LZF", points, "f4", compression="lzf")
print("float64", file=sys.stderr, flush=True)
points("f8")
PY
a/bin/python a.py > out 2>&1 || { cat out; exit 1; }
b/bin/python b.py 2> errors || { cat errors; exit 1; }
sed -n '/^float64$/,$p' errors | grep -q "Float64 -> Float32" && echo "MorphIO, float64: warns"
