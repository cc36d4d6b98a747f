#!/usr/bin/env bash
# The first frustum after a fork: its area depends on the program, and on whether the file is SWC or Neurolucida ASC.
#
# A dendrite of radius 2 forks into two branches of radius 1, each 12.81 µm long. The same cell as SWC and as ASC, once
# with branches that begin with a copy of the fork at their own radius, once without. Area of the neurites, in µm²:
#
#                    copy, SWC   copy, ASC   no copy, SWC   no copy, ASC
#   NEURON 9.0.2       305.44      286.59      367.79         286.59
#   arbor 0.12.2       305.44      305.44      367.79         367.79
#   MorphIO 3.5.0,
#   NeuroM 4.0.6       286.59      286.59      367.79         286.59
#   jaxley 0.14.0      286.59         -        367.79            -
#
# From SWC, NEURON and arbor count the ring where the copy steps from 2 to 1; from ASC, arbor alone does. Without a copy
# the first frustum is a cone from the fork's radius in SWC; in ASC, NEURON and MorphIO begin with the child's radius.
# Inside a section all of them count the ring of such a step: 215.55 µm², of which 9.42 are the ring.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"${PYTHON:-python3}" -m venv env
env/bin/pip install -q neuron==9.0.2 morphio==3.5.0 neurom==4.0.6 jaxley==0.14.0 arbor==0.12.2

cat > copy.swc <<'SWC'
1 1 0 0 0 5 -1
2 3 6 0 0 2 1
3 3 16 0 0 2 2
4 3 16 0 0 1 3
5 3 26 8 0 1 4
6 3 16 0 0 1 3
7 3 26 -8 0 1 6
SWC
cat > none.swc <<'SWC'
1 1 0 0 0 5 -1
2 3 6 0 0 2 1
3 3 16 0 0 2 2
4 3 26 8 0 1 3
5 3 26 -8 0 1 3
SWC
cat > inside.swc <<'SWC'
1 1 0 0 0 5 -1
2 3 6 0 0 2 1
3 3 16 0 0 2 2
4 3 16 0 0 1 3
5 3 26 8 0 1 4
SWC
soma='("CellBody" (CellBody) (5 0 0 0) (0 5 0 0) (-5 0 0 0) (0 -5 0 0))'
echo "$soma ((Dendrite) (6 0 0 4) (16 0 0 4)
  ((16 0 0 2) (26 8 0 2) | (16 0 0 2) (26 -8 0 2)))" > copy.asc
echo "$soma ((Dendrite) (6 0 0 4) (16 0 0 4) ((26 8 0 2) | (26 -8 0 2)))" > none.asc

cat > areas.py <<'PY'
import math
import warnings

warnings.simplefilter("ignore")
import arbor
import jaxley
import morphio
import neurom
from neuron import h

h.load_file("import3d.hoc")
morphio.set_maximum_warnings(0)


class Cell:
    pass


def by_neuron(path):
    reader = h.Import3d_Neurolucida3() if path.endswith(".asc") else h.Import3d_SWC_read()
    reader.quiet = 1
    reader.input(path)
    cell = Cell()
    h.Import3d_GUI(reader, 0).instantiate(cell)
    return sum(segment.area() for section in cell.dend for segment in section)


def by_arbor(path):
    load = arbor.load_asc if path.endswith(".asc") else arbor.load_swc_neuron
    tree = load(path).morphology
    area = 0
    for branch in range(tree.num_branches):
        for segment in tree.branch_segments(branch):
            p, q = segment.prox, segment.dist
            if max(p.x, q.x) > 5.5:  # neurites: the soma reaches to 5
                length = math.dist((p.x, p.y, p.z), (q.x, q.y, q.z))
                area += math.pi * (p.radius + q.radius) * math.hypot(p.radius - q.radius, length)
    return area


def by_neurom(path):
    return float(neurom.get("total_area", neurom.load_morphology(path)))


def by_jaxley(path):
    nodes = jaxley.read_swc(path, ncomp=1).nodes
    return float(nodes["area"].sum() - 4 * math.pi * 25)


def row(program, area, files, expected):
    found = [round(area(file), 2) for file in files]
    print(f"{program:16}", *found)
    assert all(abs(x - y) < 0.02 for x, y in zip(found, expected, strict=True)), (program, expected)


files = ["copy.swc", "copy.asc", "none.swc", "none.asc", "inside.swc"]
print(" " * 16, *files)
row("NEURON", by_neuron, files, [305.44, 286.59, 367.79, 286.59, 215.55])
row("arbor", by_arbor, files, [305.44, 305.44, 367.79, 367.79, 215.55])
row("MorphIO, NeuroM", by_neurom, files, [286.59, 286.59, 367.79, 286.59, 215.55])
row("jaxley", by_jaxley, [f for f in files if f.endswith(".swc")], [286.59, 367.79, 215.55])
PY
env/bin/python areas.py 2> errors || { cat errors; exit 1; }
