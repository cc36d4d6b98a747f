#!/usr/bin/env bash
# A neurite that hangs on nothing: programs refuse it, keep it, move it, or lose it without a word.
#
# The soma has a dendrite of 10 µm; ten micrometers from its end another piece of 10 µm has a root of its own
# (parent −1), as tracings in several pieces have.
#
#   refused       swcgeom 0.21.6, MorphoPy 0.7.6 (its statistics), brian2 2.10.1, arbor 0.12.2
#   kept apart    navis 1.12.0, osteoid 0.7.4, bsb-core 8.0.2, MorphIO 3.5.0, NeuroM 4.0.6
#   moved         NEURON 9.0.2: the piece is connected to the middle of the soma, without the way there and a word
#   lost          jaxley 0.14.0: the piece is not in the cell, which has one branch beside its soma
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
newer() { # a Python that brian2 has wheels for
    local python
    for python in "${PYTHON:-python3}" python3.12 python3.13 "$HOME"/.pyenv/versions/3.1[2-9]*/bin/python; do
        "$python" -c 'import sys; sys.exit(sys.version_info < (3, 12))' 2> errors && echo "$python" && return
    done
    echo "brian2 2.10.1 needs Python 3.12 or newer" >&2
    return 1
}
python=$(newer)
for env in a b c; do "${PYTHON:-python3}" -m venv $env; done
"$python" -m venv d
a/bin/pip install -q neuron==9.0.2 morphio==3.5.0 neurom==4.0.6 jaxley==0.14.0 arbor==0.12.2
b/bin/pip install -q navis==1.12.0 swcgeom==0.21.6 osteoid==0.7.4
c/bin/pip install -q bsb-core==8.0.2 MorphoPy==0.7.6
d/bin/pip install -q brian2==2.10.1

cat > cell.swc <<'SWC'
1 1 0 0 0 5 -1
2 3 6 0 0 1 1
3 3 16 0 0 1 2
4 3 26 0 0 1 -1
5 3 36 0 0 1 4
SWC
cat > common.py <<'PY'
import warnings

warnings.simplefilter("ignore")


def refused(program, read):
    try:
        read()
    except Exception as error:
        print(f"{program:10}refused: {type(error).__name__}")
        return
    raise SystemExit(f"{program} takes pieces")


def kept(program, length, expected):
    print(f"{program:10}kept: {length:.0f} µm")
    assert abs(length - expected) < 0.01, f"{program} is said to have {expected} µm"
PY
cat > a.py <<'PY'
import arbor
import jaxley
import morphio
import neurom
from common import kept, refused
from neuron import h

morphio.set_maximum_warnings(0)
refused("arbor", lambda: arbor.load_swc_neuron("cell.swc"))
kept("MorphIO", sum(float(s.points[-1][0] - s.points[0][0]) for s in morphio.Morphology("cell.swc").sections), 20)
kept("NeuroM", neurom.get("total_length", neurom.load_morphology("cell.swc")), 20)

h.load_file("import3d.hoc")
reader = h.Import3d_SWC_read()
reader.quiet = 1
reader.input("cell.swc")
h.Import3d_GUI(reader, 0).instantiate(None)
piece = h.dend[1]
print("NEURON    moved: starts at x =", piece.x3d(0), "and is connected to", piece.parentseg(), "length", piece.L)
assert piece.x3d(0) == 26 and piece.L == 10 and str(piece.parentseg()) == "soma[0](0.5)"

ends = [float(trace[-1][0]) for trace in jaxley.read_swc("cell.swc", ncomp=1).xyzr]
print("jaxley    lost: branches end at x =", ends)
assert ends == [0, 16]
PY
cat > b.py <<'PY'
from common import kept, refused

import navis
import osteoid
from swcgeom import Tree

refused("swcgeom", lambda: Tree.from_swc("cell.swc"))
kept("navis", float(navis.read_swc("cell.swc").cable_length), 26)
kept("osteoid", float(osteoid.load("cell.swc").cable_length()), 26)
PY
cat > c.py <<'PY'
from common import kept, refused

import pandas
from bsb import parse_morphology_file
from morphopy.computation.feature_presentation import compute_morphometric_statistics
from morphopy.neurontree import NeuronTree

kept("bsb-core", float(sum(branch.path_length for branch in parse_morphology_file("cell.swc").branches)), 26)
table = pandas.read_csv("cell.swc", sep=r"\s+", names=["n", "type", "x", "y", "z", "radius", "parent"])
refused("MorphoPy", lambda: compute_morphometric_statistics(NeuronTree.NeuronTree(swc=table)))
PY
cat > d.py <<'PY'
from common import refused

from brian2 import Morphology

refused("brian2", lambda: Morphology.from_file("cell.swc", spherical_soma=True))
PY
for program in a b c d; do
    $program/bin/python $program.py 2> errors || { cat errors; exit 1; }
done
