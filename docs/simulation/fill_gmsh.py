"""Fills the surface of a cell with tetrahedra by Gmsh.

usage: fill_gmsh.py CELL.msh TETRAHEDRA.msh [FOR_STEPS.msh]

The volume is the physical group "intracellular"; the types keep theirs. FOR_STEPS.msh is the same in
meters, as MSH 2.2 text.
"""

import sys

import gmsh

INTRACELLULAR = 3_000_000

gmsh.initialize()
gmsh.option.setNumber("General.Verbosity", 2)
gmsh.open(sys.argv[1])

# All surfaces, which are the sections, together enclose the cell.
sections = [tag for _, tag in gmsh.model.getEntities(2)]
loop = gmsh.model.geo.addSurfaceLoop(sections)
volume = gmsh.model.geo.addVolume([loop])
gmsh.model.geo.synchronize()
# A number that no type and no wall has: programs that read groups without their dimension would make one of two.
gmsh.model.addPhysicalGroup(3, [volume], INTRACELLULAR, name="intracellular")
gmsh.model.mesh.generate(3)

gmsh.write(sys.argv[2])
if len(sys.argv) > 3:
    gmsh.option.setNumber("Mesh.MshFileVersion", 2.2)
    gmsh.option.setNumber("Mesh.ScalingFactor", 1e-6)
    gmsh.write(sys.argv[3])

tetrahedra = sum(len(tags) for tags in gmsh.model.mesh.getElements(3)[1])
print(f"Gmsh: {len(gmsh.model.mesh.getNodes()[0])} nodes, {tetrahedra} tetrahedra")
gmsh.finalize()
