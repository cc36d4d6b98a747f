#!/usr/bin/env bash
# A surface that crosses itself: what tools find of six pairs of triangles that meet where they must not.
#
#   pair                                       CGAL  libigl  pymeshlab  meshlib  Open3D
#   they cross                                  yes   yes      yes       yes      yes
#   one's corner is in the other's middle       yes   yes      no        no       yes
#   they lie in one plane and overlap           yes   yes      no        no       yes
#   the same triangle twice                     yes   no       no        no       yes
#   a fold: one edge shared, one on the other   yes   yes      no        no       no
#   one corner shared, and they cross           yes   yes      yes       yes      no
#
# cgal 6.0.1 (does_self_intersect), libigl 2.6.3 (remesh_self_intersections), pymeshlab 2025.7
# (compute_selection_by_self_intersections_per_face), meshlib 3.1.4 (findSelfCollidingTriangles), Open3D 0.20.0
# (get_self_intersecting_triangles). A surface without any finding in the last three may cross itself still: Open3D
# passes over every pair with a common vertex, which is where a bent tube meets itself.
#
# Open3D needs libusb, which a package brings here.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"${PYTHON:-python3}" -m venv a
"${PYTHON:-python3}" -m venv b
a/bin/pip install -q cgal==6.0.1.post202410241521 libigl==2.6.3 pymeshlab==2025.7.post1 meshlib==3.1.4.297
b/bin/pip install -q open3d==0.20.0 libusb-package==1.0.30.0

cat > pairs.py <<'PY'
import numpy

BASE = [(0, 0, 0), (2, 0, 0), (0, 2, 0)]
APART = [(0, 1, 2), (3, 4, 5)]
PAIRS = {
    "cross": (BASE + [(0.5, 0.5, -1), (0.5, 0.5, 1), (3, 3, 1)], APART),
    "corner inside": (BASE + [(0.5, 0.5, 0), (1, 1, 1), (0.5, 1.5, 1)], APART),
    "one plane": (BASE + [(0.5, 0.5, 0), (2.5, 0.5, 0), (0.5, 2.5, 0)], APART),
    "twice": (BASE + BASE, [(0, 1, 2), (3, 5, 4)]),
    "fold": ([(0, 0, 0), (2, 0, 0), (1, 2, 0), (1, 1, 0)], [(0, 1, 2), (1, 0, 3)]),
    "shared corner": (BASE + [(1, 0.5, -1), (1, 0.5, 1)], [(0, 1, 2), (0, 3, 4)]),
    "apart": (BASE + [(0, 0, 1), (2, 0, 1), (0, 2, 1)], APART),
}


def row(program, finds, expected):
    found = [name for name, (v, f) in PAIRS.items() if finds(numpy.array(v, float), numpy.array(f, numpy.int32))]
    print(f"{program:10} {', '.join(found)}")
    assert found == expected, f"{program} is said to find {expected}"
PY
cat > a.py <<'PY'
import igl.copyleft.cgal
import pymeshlab
from CGAL import CGAL_Polygon_mesh_processing as cgal
from CGAL.CGAL_Kernel import Point_3
from CGAL.CGAL_Polyhedron_3 import Polyhedron_3
from meshlib import mrmeshnumpy, mrmeshpy
from pairs import row


def by_cgal(vertices, faces):
    points, polygons, surface = cgal.Point_3_Vector(), cgal.Polygon_Vector(), Polyhedron_3()
    for vertex in vertices:
        points.append(Point_3(*map(float, vertex)))
    for face in faces:
        corners = cgal.Int_Vector()
        for corner in face:
            corners.append(int(corner))
        polygons.append(corners)
    cgal.polygon_soup_to_polygon_mesh(points, polygons, surface)
    return cgal.does_self_intersect(surface)


def by_igl(vertices, faces):
    return len(igl.copyleft.cgal.remesh_self_intersections(vertices, faces, detect_only=True)[2]) > 0


def by_pymeshlab(vertices, faces):
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(vertices, faces))
    meshes.compute_selection_by_self_intersections_per_face()
    return meshes.current_mesh().selected_face_number() > 0


def by_meshlib(vertices, faces):
    return mrmeshpy.findSelfCollidingTriangles(mrmeshnumpy.meshFromFacesVerts(faces, vertices)).size() > 0


row("CGAL", by_cgal, ["cross", "corner inside", "one plane", "twice", "fold", "shared corner"])
row("libigl", by_igl, ["cross", "corner inside", "one plane", "fold", "shared corner"])
row("pymeshlab", by_pymeshlab, ["cross", "shared corner"])
row("meshlib", by_meshlib, ["cross", "shared corner"])
PY
cat > b.py <<'PY'
import ctypes

import libusb_package

ctypes.CDLL(str(libusb_package.get_library_path()), mode=ctypes.RTLD_GLOBAL)

import open3d
from pairs import row


def by_open3d(vertices, faces):
    mesh = open3d.geometry.TriangleMesh(
        open3d.utility.Vector3dVector(vertices), open3d.utility.Vector3iVector(faces)
    )
    assert mesh.is_self_intersecting() == (len(mesh.get_self_intersecting_triangles()) > 0)
    return mesh.is_self_intersecting()


row("Open3D", by_open3d, ["cross", "corner inside", "one plane", "twice"])
PY
for program in a b; do
    $program/bin/python $program.py 2> errors || { cat errors; exit 1; }
done
