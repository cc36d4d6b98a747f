#!/usr/bin/env bash
# "Aspect ratio" of a triangle is another number in each program, and in pymeshlab not what its name says.
#
# A flat triangle, 10 wide and 1 high; a sharp one, 1 wide and 10 high; an equilateral one of side 2:
#
#                                                   flat    sharp   equilateral
#   VTK 9.7.2 AspectRatio                           5.831   6.077   1       longest side × perimeter / (4 √3 area)
#   VTK 9.7.2 RadiusRatio                          13.129   5.269   1       the flat one is the worse here
#   pymeshlab 2025.7 "area/max side"                0.100   0.100   0.866   2 area / longest side²: no length
#   pymeshlab 2025.7 "inradius/circumradius"        0.076   0.190   1       twice that ratio
#   √3/2 × longest side / height on it              8.660   8.682   1
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"${PYTHON:-python3}" -m venv env
env/bin/pip install -q vtk==9.7.2 pymeshlab==2025.7.post1 numpy

cat > aspect.py <<'PY'
import numpy
import pymeshlab
import vtk
from vtk.util.numpy_support import vtk_to_numpy

triangles = [
    [(0, 0, 0), (10, 0, 0), (5, 1, 0)],
    [(0, 0, 0), (1, 0, 0), (0.5, 10, 0)],
    [(0, 0, 0), (2, 0, 0), (1, 3**0.5, 0)],
]


def by_vtk(triangle, measure):
    points, faces, mesh = vtk.vtkPoints(), vtk.vtkCellArray(), vtk.vtkPolyData()
    for point in triangle:
        points.InsertNextPoint(*point)
    faces.InsertNextCell(3, [0, 1, 2])
    mesh.SetPoints(points)
    mesh.SetPolys(faces)
    quality = vtk.vtkMeshQuality()
    quality.SetInputData(mesh)
    getattr(quality, f"SetTriangleQualityMeasureTo{measure}")()
    quality.Update()
    return vtk_to_numpy(quality.GetOutput().GetCellData().GetArray("Quality"))[0]


def by_pymeshlab(triangle, measure):
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(numpy.array(triangle, float), numpy.array([[0, 1, 2]])))
    meshes.compute_scalar_by_aspect_ratio_per_face(metric=measure)
    return meshes.current_mesh().face_scalar_array()[0]


def by_height(triangle, factor):
    a, b, c = numpy.array(triangle, float)
    longest = max(numpy.linalg.norm(side) for side in (b - a, c - b, a - c))
    return factor * longest**2 / numpy.linalg.norm(numpy.cross(b - a, c - a))


def row(name, measure, option, expected):
    found = [float(measure(triangle, option)) for triangle in triangles]
    print(f"{name:42}", *(f"{number:8.3f}" for number in found))
    assert numpy.allclose(found, expected, atol=5e-4), (name, expected)


row("VTK AspectRatio", by_vtk, "AspectRatio", [5.831, 6.077, 1])
row("VTK RadiusRatio", by_vtk, "RadiusRatio", [13.129, 5.269, 1])
row("pymeshlab area/max side", by_pymeshlab, "area/max side", [0.100, 0.100, 0.866])
row("pymeshlab inradius/circumradius", by_pymeshlab, "inradius/circumradius", [0.076, 0.190, 1])
row("√3/2 longest side / height", by_height, 3**0.5 / 2, [8.660, 8.682, 1])
area, longest = 3**0.5, 2
assert abs(by_pymeshlab(triangles[2], "area/max side") - area / longest) < 1e-9, "the same for this side alone"
PY
env/bin/python aspect.py 2> errors || { cat errors; exit 1; }
