#!/usr/bin/env bash
# NEURON reads an SWC by the order of its rows: one cell becomes another, without a word, or is refused.
#
# A cell of 42.36 µm of neurites: a dendrite that forks, and an axon of 10 µm. Three files of it, all valid: parents
# above their children, each id used once.
#
#   file                                      NEURON 9.0.2          MorphIO 3.5.0, jaxley 0.14.0, arbor 0.12.2
#   each section's samples in one run         axon 10 µm            axon 10 µm
#   the two first samples, then the others    axon 32 µm, no word   axon 10 µm
#   in one run, but ids out of order          refused               axon 10 µm
#
# In the second file the dendrite's first sample is followed by the axon's. NEURON then takes the link from sample 2 to
# sample 4 as one of the axon, from sample 3 on: an axon of 22 µm through the soma to the dendrite's fork, and a second
# one of 10 µm. The dendrite keeps a stump of 6 µm.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"${PYTHON:-python3}" -m venv env
env/bin/pip install -q neuron==9.0.2 morphio==3.5.0 jaxley==0.14.0 arbor==0.12.2

cat > runs.swc <<'SWC'
1 1 0 0 0 5 -1
2 3 6 0 0 1 1
3 3 16 0 0 1 2
4 3 26 5 0 1 3
5 3 26 -5 0 1 3
6 2 -6 0 0 .5 1
7 2 -16 0 0 .5 6
SWC
cat > starts_first.swc <<'SWC'
1 1 0 0 0 5 -1
2 3 6 0 0 1 1
3 2 -6 0 0 .5 1
4 3 16 0 0 1 2
5 2 -16 0 0 .5 3
6 3 26 5 0 1 4
7 3 26 -5 0 1 4
SWC
cat > ids_mixed.swc <<'SWC'
1 1 0 0 0 5 -1
2 3 6 0 0 1 1
4 3 16 0 0 1 2
6 3 26 5 0 1 4
7 3 26 -5 0 1 4
3 2 -6 0 0 .5 1
5 2 -16 0 0 .5 3
SWC

cat > by_neuron.py <<'PY'
import sys

from neuron import h

h.load_file("import3d.hoc")


class Cell:
    pass


reader = h.Import3d_SWC_read()
reader.quiet = 1
reader.input(sys.argv[1])
cell = Cell()
h.Import3d_GUI(reader, 0).instantiate(cell)
for part in ("axon", "dend"):
    print(part, *(round(section.L, 2) for section in getattr(cell, part)), end="  ")
PY
cat > by_others.py <<'PY'
import math
import sys
import warnings

warnings.simplefilter("ignore")
import arbor
import jaxley
import morphio

morphio.set_maximum_warnings(0)
path = sys.argv[1]
axon = [section for section in morphio.Morphology(path).sections if int(section.type) == 2]
lengths = [math.dist(*section.points) for section in axon]
print("MorphIO", lengths)
assert lengths == [10]

left = [trace for trace in jaxley.read_swc(path, ncomp=1).xyzr if trace[-1][0] < 0]
lengths = [math.dist(trace[0][:3], trace[-1][:3]) for trace in left]
print("jaxley", lengths)
assert lengths == [10]

tree = arbor.load_swc_neuron(path).morphology
ends = [segment for branch in range(tree.num_branches) for segment in tree.branch_segments(branch)]
lengths = [segment.prox.x - segment.dist.x for segment in ends if segment.dist.x < -5]
print("arbor", lengths)
assert lengths == [10]
PY
expect() { # FILE TEXT: what NEURON says of FILE
    local found
    found=$(env/bin/python by_neuron.py "$1" 2> errors) || found="refused"
    echo "NEURON, $1: $found"
    [[ $found == "$2"* ]]
}
expect runs.swc "axon 10.0  dend 10.0 11.18 11.18"
expect starts_first.swc "axon 22.0 10.0  dend 6.0 11.18 11.18"
expect ids_mixed.swc "refused"
grep -q "Section access unspecified" errors
for file in runs starts_first ids_mixed; do
    echo "$file.swc"
    env/bin/python by_others.py $file.swc 2> errors || { cat errors; exit 1; }
done
