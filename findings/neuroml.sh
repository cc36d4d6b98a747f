#!/usr/bin/env bash
# arbor 0.12.2 reads a NeuroML cell with a soma that is a ball: without the soma's membrane, or with other dendrites.
#
# The soma is one segment whose ends coincide, as NeuroML writes a ball: 314.16 µm². A dendrite of 10 µm begins at its
# own proximal point, 6 µm from the soma's center, and forks; an axon begins on the other side. As SWC and as NeuroML:
#
#                                            soma     neurites, µm²
#   load_swc_neuron                         314.16      234.74
#   neuroml.cell_morphology                   0         234.74      without a word
#   … allow_spherical_root=True             314.16      738.56      cones of 16 µm from the soma's center at its radius
#
# The documentation offers the option for such somata. With it the neurites have 3.1 times the membrane.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"${PYTHON:-python3}" -m venv env
env/bin/pip install -q arbor==0.12.2

cat > cell.swc <<'SWC'
1 1 0 0 0 5 -1
2 3 6 0 0 1 1
3 3 16 0 0 1 2
4 3 26 5 0 1 3
5 3 26 -5 0 1 3
6 2 -6 0 0 .5 1
7 2 -16 0 0 .5 6
SWC
cat > cell.nml <<'NML'
<neuroml xmlns="http://www.neuroml.org/schema/neuroml2" id="cells"><cell id="cell"><morphology id="form">
<segment id="0" name="soma">
  <proximal x="0" y="0" z="0" diameter="10"/><distal x="0" y="0" z="0" diameter="10"/></segment>
<segment id="1" name="dend0"><parent segment="0"/>
  <proximal x="6" y="0" z="0" diameter="2"/><distal x="16" y="0" z="0" diameter="2"/></segment>
<segment id="2" name="dend1"><parent segment="1"/><distal x="26" y="5" z="0" diameter="2"/></segment>
<segment id="3" name="dend2"><parent segment="1"/><distal x="26" y="-5" z="0" diameter="2"/></segment>
<segment id="4" name="axon0"><parent segment="0"/>
  <proximal x="-6" y="0" z="0" diameter="1"/><distal x="-16" y="0" z="0" diameter="1"/></segment>
</morphology></cell></neuroml>
NML
cat > areas.py <<'PY'
import math

import arbor


def areas(tree):
    """Of the soma, which reaches to 5 µm, and of the rest."""
    found = [0.0, 0.0]
    for branch in range(tree.num_branches):
        for segment in tree.branch_segments(branch):
            p, q = segment.prox, segment.dist
            length = math.dist((p.x, p.y, p.z), (q.x, q.y, q.z))
            area = math.pi * (p.radius + q.radius) * math.hypot(p.radius - q.radius, length)
            found[max(abs(p.x), abs(q.x)) > 5.5] += area
    return found


def row(name, tree, expected):
    found = areas(tree)
    print(f"{name:30} soma {found[0]:7.2f}  neurites {found[1]:7.2f}")
    assert all(abs(x - y) < 0.01 for x, y in zip(found, expected, strict=True)), (name, expected)


row("load_swc_neuron", arbor.load_swc_neuron("cell.swc").morphology, [314.16, 234.74])
cells = arbor.neuroml("cell.nml")
row("cell_morphology", cells.cell_morphology("cell").morphology, [0, 234.74])
ball = cells.cell_morphology("cell", allow_spherical_root=True).morphology
row("with allow_spherical_root", ball, [314.16, 738.56])
PY
env/bin/python areas.py 2> errors || { cat errors; exit 1; }
