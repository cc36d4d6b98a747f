#!/usr/bin/env bash
# How long the neurites of a cell are depends on where a program lets them begin.
#
# The soma is one sample of radius 5 at the origin. A dendrite starts at 6 µm from its center, an axon at 6 µm on the
# other side. From their first samples on they are 42.36 µm long.
#
#   42.36 µm   MorphIO 3.5.0, NeuroM 4.0.6; NEURON 9.0.2, jaxley 0.14.0 and arbor 0.12.2 without their soma of 10 µm
#   54.36 µm   navis 1.12.0, swcgeom 0.21.6, osteoid 0.7.4, bsb-core 8.0.2, MorphoPy 0.7.6, brian2 2.10.1: from the
#              soma's center on
#
# brian2 needs Python 3.12 or newer.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"${PYTHON:-python3}" -m venv a
"${PYTHON:-python3}" -m venv b
"${PYTHON:-python3}" -m venv c
newer() { # a Python that brian2 has wheels for
    local python
    for python in "${PYTHON:-python3}" python3.12 python3.13 "$HOME"/.pyenv/versions/3.1[2-9]*/bin/python; do
        "$python" -c 'import sys; sys.exit(sys.version_info < (3, 12))' 2> errors && echo "$python" && return
    done
    echo "brian2 2.10.1 needs Python 3.12 or newer" >&2
    return 1
}
python=$(newer)
"$python" -m venv d
a/bin/pip install -q neuron==9.0.2 morphio==3.5.0 neurom==4.0.6 jaxley==0.14.0 arbor==0.12.2
b/bin/pip install -q navis==1.12.0 swcgeom==0.21.6 osteoid==0.7.4
c/bin/pip install -q bsb-core==8.0.2 MorphoPy==0.7.6
d/bin/pip install -q brian2==2.10.1

cat > cell.swc <<'SWC'
1 1 0 0 0 5 -1
2 3 6 0 0 1 1
3 3 16 0 0 1 2
4 3 26 5 0 1 3
5 3 26 -5 0 1 3
6 2 -6 0 0 1 1
7 2 -16 0 0 1 6
SWC
cat > common.py <<'PY'
import warnings

warnings.simplefilter("ignore")


def show(program, length, expected):
    print(f"{program:10}{length:7.2f} µm")
    assert abs(length - expected) < 0.01, f"{program} is said to give {expected}"
PY
cat > a.py <<'PY'
import math

import arbor
import jaxley
import morphio
import neurom
from common import show
from neuron import h

morphio.set_maximum_warnings(0)
sections = morphio.Morphology("cell.swc").sections
show("MorphIO", sum(math.dist(*pair) for s in sections for pair in zip(s.points, s.points[1:])), 42.36)
show("NeuroM", neurom.get("total_length", neurom.load_morphology("cell.swc")), 42.36)
show("jaxley", float(jaxley.read_swc("cell.swc", ncomp=1).nodes["length"].sum()), 52.36)
tree = arbor.load_swc_neuron("cell.swc").morphology
segments = [s for branch in range(tree.num_branches) for s in tree.branch_segments(branch)]
at = lambda p: (p.x, p.y, p.z)
show("arbor", sum(math.dist(at(s.prox), at(s.dist)) for s in segments), 52.36)

h.load_file("import3d.hoc")
reader = h.Import3d_SWC_read()
reader.quiet = 1
reader.input("cell.swc")
h.Import3d_GUI(reader, 0).instantiate(None)
show("NEURON", sum(section.L for section in h.allsec()), 52.36)
PY
cat > b.py <<'PY'
from common import show

import navis
import osteoid
from swcgeom import Tree

show("navis", float(navis.read_swc("cell.swc").cable_length), 54.36)
show("osteoid", float(osteoid.load("cell.swc").cable_length()), 54.36)
show("swcgeom", float(Tree.from_swc("cell.swc").length()), 54.36)
PY
cat > c.py <<'PY'
from common import show

import pandas
from bsb import parse_morphology_file
from morphopy.computation.feature_presentation import compute_morphometric_statistics
from morphopy.neurontree import NeuronTree

branches = parse_morphology_file("cell.swc").branches
show("bsb-core", float(sum(branch.path_length for branch in branches)), 54.36)

names = ["n", "type", "x", "y", "z", "radius", "parent"]
table = pandas.read_csv("cell.swc", sep=r"\s+", names=names)
numbers = compute_morphometric_statistics(NeuronTree.NeuronTree(swc=table))
show("MorphoPy", float(numbers["total_length"].iloc[0]), 54.36)
PY
cat > d.py <<'PY'
from common import show

from brian2 import Morphology, um


def length(section):
    own = float(sum(section.length / um)) if section.type != "soma" else 0
    return own + sum(length(child) for child in section.children)


show("brian2", length(Morphology.from_file("cell.swc", spherical_soma=True)), 54.36)
PY
for program in a b c d; do
    $program/bin/python $program.py 2> errors || { cat errors; exit 1; }
done
