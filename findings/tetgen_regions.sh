#!/usr/bin/env bash
# The Python package tetgen 0.8.4 gives a region that nobody asked for the next free number, as if it had been asked for.
#
# Two unit cubes that share a wall, filled with -A. A point names the region in which it lies.
#
#   points                     numbers of the tetrahedra
#   1 in the left, 2 right     1 and 2
#   1 in the left              1 and 2: nothing tells that 2 was not given
#   7 in the left              7 and 8
#   none                       1 and 2
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"${PYTHON:-python3}" -m venv env
env/bin/pip install -q tetgen==0.8.4 numpy

cat > regions.py <<'PY'
import itertools

import numpy
import tetgen

points = numpy.array(list(itertools.product((0, 1, 2), (0, 1), (0, 1))), float)
index = {tuple(map(int, point)): number for number, point in enumerate(points)}
triangles = []


def square(corner, u, v):
    corners = [tuple(numpy.add(corner, step)) for step in ((0, 0, 0), u, numpy.add(u, v), v)]
    a, b, c, d = (index[tuple(map(int, corner))] for corner in corners)
    triangles.extend([(a, b, c), (a, c, d)])


x, y, z = (1, 0, 0), (0, 1, 0), (0, 0, 1)
for start in (0, 1, 2):
    square((start, 0, 0), y, z)
for start in (0, 1):
    for side in (0, 1):
        square((start, side, 0), x, z)
        square((start, 0, side), x, y)
triangles = numpy.array(triangles, numpy.int32)

LEFT, RIGHT = (0.5, 0.5, 0.5), (1.5, 0.5, 0.5)
for regions, expected in (([(1, LEFT), (2, RIGHT)], [1, 2]), ([(1, LEFT)], [1, 2]), ([(7, LEFT)], [7, 8]), ([], [1, 2])):
    filled = tetgen.TetGen(points, triangles)
    for number, place in regions:
        filled.add_region(number, place, 0.0)
    found = filled.tetrahedralize(switches="pYAQ")[2]
    numbers = sorted(set(numpy.asarray(found).ravel().astype(int).tolist()))
    print("points", [number for number, _ in regions], "numbers", numbers)
    assert numbers == expected
PY
env/bin/python regions.py | grep points
