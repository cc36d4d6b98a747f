#!/usr/bin/env bash
# Skeletons of meshparty 2.0.3: `radius` is the diameter, and the exported SWC has radius 1 throughout.
#
# A closed tube, 1.4 µm thick and 20 µm long, in nanometers. The radius is 700 nm.
#
#   median of skeleton.radius                             1400 nm
#   radii in what export_to_swc writes                    1.000 for each sample
#   … with radius=skeleton.radius / 2                     0.700 in the median
#   number and type of the first sample                   0 and 0
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"${PYTHON:-python3}" -m venv env
env/bin/pip install -q meshparty==2.0.3

cat > tube.py <<'PY'
import logging
import warnings

warnings.simplefilter("ignore")
logging.disable(logging.CRITICAL)
import numpy
from meshparty import skeletonize, trimesh_io

SIDES, RINGS, RADIUS, LENGTH = 24, 161, 700.0, 20000.0
angles = numpy.linspace(0, 2 * numpy.pi, SIDES, endpoint=False)
vertices = [
    (x, RADIUS * numpy.cos(a), RADIUS * numpy.sin(a)) for x in numpy.linspace(0, LENGTH, RINGS) for a in angles
]
start, end = len(vertices), len(vertices) + 1
vertices += [(0, 0, 0), (LENGTH, 0, 0)]
faces = []
for side in range(SIDES):
    following = (side + 1) % SIDES
    last = (RINGS - 1) * SIDES
    faces += [(following, side, start), (last + side, last + following, end)]
    for first in range(0, last, SIDES):
        a, b = first + side, first + following
        faces += [(a, b, a + SIDES), (b, b + SIDES, a + SIDES)]
mesh = trimesh_io.Mesh(numpy.array(vertices), numpy.array(faces))
assert mesh.is_watertight

skeleton = skeletonize.skeletonize_mesh(mesh, invalidation_d=2000, collapse_soma=False, verbose=False)
median = numpy.median(skeleton.radius)
print(f"skeleton.radius: {median:.0f} nm in the median")
assert abs(median / (2 * RADIUS) - 1) < 0.02


def rows(**options):
    skeleton.export_to_swc("tube.swc", **options)
    return numpy.loadtxt("tube.swc")


plain, halved = rows(), rows(radius=skeleton.radius / 2)
print("radii in SWC:", sorted(set(plain[:, 5].tolist())), f"with radius / 2: {numpy.median(halved[:, 5]):.3f}")
assert set(plain[:, 5]) == {1.0} and abs(numpy.median(halved[:, 5]) - 0.7) < 0.02
print("first sample:", int(plain[0, 0]), "type", int(plain[0, 1]))
assert plain[0, 0] == 0 and set(plain[:, 1]) == {0}
PY
env/bin/python tube.py 2> errors || { cat errors; exit 1; }
