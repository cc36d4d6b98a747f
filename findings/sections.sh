#!/usr/bin/env bash
# The number of a section depends on the program, and in MorphIO on the file's format.
#
# One cell with forks, as SWC whose sections stand in the order of their distance from the soma: each section in one
# piece, ids ascending, the axon last. The sections are A (from the soma), B and C (from A), D and E (from B), and the
# axon X; in the file they stand as A B C D E X.
#
#   NEURON 9.0.2            soma X A B C D E    by type, then by the file
#   LFPy 2.3.7              soma X A B C D E    as NEURON
#   bmtk 1.2.0              soma X A B C D E    as NEURON
#   MorphIO 3.5.0           A B D E C X         depth first, without the soma
#   MorphIO 3.5.0 nrn_order X A B D E C         by type, then depth first: not NEURON's
#   MorphIO 3.5.0, H5       A B C D E X         by the file, from rows in that order
#   jaxley 0.14.0           soma A B D E C X    depth first
#   arbor 0.12.2            soma soma A B C D E X   by the file; a soma of one sample is two branches
#   swcgeom 0.21.6          seven branches for six sections: the soma is one of its own, and the order is another
#
# SONATA's guide wants NEURON's order in `section_id`. A library that reads SWC by MorphIO and counts on cannot
# have it from `nrn_order`.
#
# And a run of type 3 that goes on as type 4, without a fork: two sections in NEURON and jaxley, an error in MorphIO
# unless `allow_unifurcated_section_change` is set.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"${PYTHON:-python3}" -m venv env
env/bin/pip install -q neuron==9.0.2 LFPy==2.3.7 bmtk==1.2.0 morphio==3.5.0 jaxley==0.14.0 arbor==0.12.2 \
    swcgeom==0.21.6 h5py

cat > cell.swc <<'SWC'
1 1 0 0 0 5 -1
2 3 6 0 0 1 1
3 3 16 0 0 1 2
4 3 26 5 0 1 3
5 3 30 7 0 1 4
6 3 26 -5 0 1 3
7 3 32 -8 0 1 6
8 3 40 12 0 1 5
9 3 46 14 0 1 8
10 3 40 4 0 1 5
11 3 46 4 0 1 10
12 2 -6 0 0 .5 1
13 2 -16 0 0 .5 12
SWC
cat > types.swc <<'SWC'
1 1 0 0 0 5 -1
2 3 6 0 0 1 1
3 3 16 0 0 1 2
4 4 26 5 0 1 3
5 4 36 5 0 1 4
SWC

cat > common.py <<'PY'
"""Names sections by where they end."""
import warnings

warnings.simplefilter("ignore")
ENDS = {(16, 0): "A", (30, 7): "B", (32, -8): "C", (46, 14): "D", (46, 4): "E", (-16, 0): "X"}


def name(end):
    return ENDS.get((round(float(end[0])), round(float(end[1]))), "soma")


def show(program, found, expected):
    print(f"{program:25}{' '.join(found)}")
    assert " ".join(found) == expected, f"{program} is said to give {expected}"
PY

cat > by_neuron.py <<'PY'
from common import name, show
from neuron import h

h.load_file("import3d.hoc")


class Cell:
    pass


def load(path):
    reader = h.Import3d_SWC_read()
    reader.quiet = 1
    reader.input(path)
    cell = Cell()
    h.Import3d_GUI(reader, 0).instantiate(cell)
    return cell


def end(section):
    last = section.n3d() - 1
    return section.x3d(last), section.y3d(last)


cell = load("cell.swc")
show("NEURON", [name(end(section)) for section in cell.all], "soma X A B C D E")

from bmtk.simulator.bionet.morphology import Morphology

numbers = Morphology.load(hobj=cell, morphology_file="cell.swc").seg_props.sec_id
show("bmtk", [name(end(list(cell.all)[number])) for number in numbers], "soma X A B C D E")

types = load("types.swc")
kinds = [section.name().split(".")[-1] for section in types.all]
print("NEURON, types:          ", *kinds)
assert kinds == ["soma[0]", "dend[0]", "apic[0]"]
PY

cat > by_lfpy.py <<'PY'
import LFPy
from common import name, show

cell = LFPy.Cell(morphology="cell.swc", passive=False)
ends = [(s.x3d(s.n3d() - 1), s.y3d(s.n3d() - 1)) for s in cell.allseclist]
show("LFPy", [name(end) for end in ends], "soma X A B C D E")
PY

cat > by_morphio.py <<'PY'
import h5py
import morphio
import numpy
from common import name, show

morphio.set_maximum_warnings(0)


def ends(path, *options):
    return [name(section.points[-1]) for section in morphio.Morphology(path, *options).sections]


show("MorphIO", ends("cell.swc"), "A B D E C X")
show("MorphIO nrn_order", ends("cell.swc", morphio.Option.nrn_order), "X A B D E C")

points, structure = [], []
for kind, parent, section in [
    (1, -1, [(5, 0), (0, 5), (-5, 0), (0, -5)]),
    (3, 0, [(6, 0), (16, 0)]),
    (3, 1, [(16, 0), (30, 7)]),
    (3, 1, [(16, 0), (32, -8)]),
    (3, 2, [(30, 7), (46, 14)]),
    (3, 2, [(30, 7), (46, 4)]),
    (2, 0, [(-6, 0), (-16, 0)]),
]:
    structure.append([len(points), kind, parent])
    points += [(x, y, 0, 2) for x, y in section]
with h5py.File("cell.h5", "w") as file:
    file["points"] = numpy.array(points, "f4")
    file["structure"] = numpy.array(structure, "i4")
show("MorphIO, H5", ends("cell.h5"), "A B C D E X")

try:
    morphio.Morphology("types.swc")
    raise SystemExit("MorphIO takes a type that changes without a fork")
except morphio.RawDataError as error:
    print("MorphIO, types:         ", str(error).split(",")[0])
kept = morphio.Morphology("types.swc", morphio.Option.allow_unifurcated_section_change)
assert [int(section.type) for section in kept.sections] == [3, 4]
PY

cat > by_others.py <<'PY'
from common import name, show

import arbor
import jaxley
from swcgeom import Tree

cell = jaxley.read_swc("cell.swc", ncomp=1)
show("jaxley", [name(trace[-1]) for trace in cell.xyzr], "soma A B D E C X")
assert len(jaxley.read_swc("types.swc", ncomp=1).xyzr) == 3, "the soma, type 3, type 4"

tree = arbor.load_swc_neuron("cell.swc").morphology
tips = [tree.branch_segments(branch)[-1].dist for branch in range(tree.num_branches)]
show("arbor", [name((tip.x, tip.y)) for tip in tips], "soma soma A B C D E X")

branches = [[int(node.id) + 1 for node in branch] for branch in Tree.from_swc("cell.swc").get_branches()]
print("swcgeom                 ", branches)
assert len(branches) == 7 and [1] in branches
PY
for program in neuron lfpy morphio others; do
    env/bin/python by_$program.py 2> errors || { cat errors; exit 1; }
done
