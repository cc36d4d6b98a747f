#!/usr/bin/env bash
# Sholl analysis of one neurite that runs straight out from the soma: each sphere is crossed once.
#
# Samples at 6, 20, 30 and 45 µm; spheres of radius 10, 15, 20, 25, 30 and 40 µm. What programs count:
#
#   navis 1.12.0     0 0 0 0 0 0   only links that come nearer to the center on their way from the root count. The same
#                                  neurite traced from its tip to the soma gives 1 1 1 1 1 1. A center in coordinates,
#                                  which its documentation allows, raises ValueError
#   NeuroM 4.0.6     1 1 2 1 2 1   a sample on a sphere belongs to two links, and both count
#   swcgeom 0.21.6   1 1 1 1       in steps of 10 µm: once, on the sphere, too
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"${PYTHON:-python3}" -m venv a
"${PYTHON:-python3}" -m venv b
a/bin/pip install -q navis==1.12.0 swcgeom==0.21.6
b/bin/pip install -q neurom==4.0.6

cat > outward.swc <<'SWC'
1 1 0 0 0 5 -1
2 3 6 0 0 1 1
3 3 20 0 0 1 2
4 3 30 0 0 1 3
5 3 45 0 0 1 4
SWC
cat > inward.swc <<'SWC'
1 3 45 0 0 1 -1
2 3 30 0 0 1 1
3 3 20 0 0 1 2
4 3 6 0 0 1 3
5 1 0 0 0 5 4
SWC
cat > a.py <<'PY'
import warnings

warnings.simplefilter("ignore")
import navis
from swcgeom import Tree
from swcgeom.analysis import Sholl

radii = [10, 15, 20, 25, 30, 40]
for file, expected in (("outward.swc", [0] * 6), ("inward.swc", [1] * 6)):
    found = navis.sholl_analysis(navis.read_swc(file), radii=radii, center="soma")["intersections"].tolist()
    print("navis,", file, found)
    assert found == expected
try:
    navis.sholl_analysis(navis.read_swc("outward.swc"), radii=radii, center=[0, 0, 0])
    raise SystemExit("navis takes a center in coordinates")
except ValueError as error:
    print("navis, a center in coordinates:", error)

found = list(map(int, Sholl(Tree.from_swc("outward.swc"), step=10).get()))
print("swcgeom", found)
assert found == [1] * 4
PY
cat > b.py <<'PY'
import neurom

radii = [10, 15, 20, 25, 30, 40]
found = list(map(int, neurom.get("sholl_crossings", neurom.load_morphology("outward.swc"), radii=radii)))
print("NeuroM", found)
assert found == [1, 1, 2, 1, 2, 1]
PY
for program in a b; do
    $program/bin/python $program.py 2> errors || { cat errors; exit 1; }
done
