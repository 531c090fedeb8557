"""Writes the meshes of this folder with the real Gmsh (pip install gmsh==4.15.2), for the tests of src/formats/gmsh.

Every run gives the same bytes, but for the order of $GhostElements.
"""

import math
import os

import gmsh

HERE = os.path.dirname(os.path.abspath(__file__))
MSH1, MSH22, MSH40, MSH41 = 1.0, 2.2, 4.0, 4.1


def new_model(**options):
    """Starts an empty model, with Gmsh's options as they are by default except the ones given."""
    gmsh.clear()
    gmsh.option.restoreDefaults()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.Verbosity", 2)
    for name, value in options.items():
        gmsh.option.setNumber("Mesh." + name, value)


def write(name, version=MSH41, binary=False):
    """Writes the mesh of the model to `name`.msh."""
    gmsh.option.setNumber("Mesh.MshFileVersion", version)
    gmsh.option.setNumber("Mesh.Binary", int(binary))
    gmsh.write(os.path.join(HERE, name + ".msh"))


def polygon(corners, size):
    """A closed polygon; its curves and its loop."""
    points = [gmsh.model.geo.addPoint(*(corner + (0,))[:3], size) for corner in corners]
    curves = [gmsh.model.geo.addLine(a, b) for a, b in zip(points, points[1:] + points[:1])]
    return curves, gmsh.model.geo.addCurveLoop(curves)


def rectangle(size=0.3, x=0.0, width=1.2, z=0.0):
    """The surface (x, x + width) x (0, 0.8) in the plane of height z, and its curves."""
    curves, loop = polygon([(x, 0, z), (x + width, 0, z), (x + width, 0.8, z), (x, 0.8, z)], size)
    surface = gmsh.model.geo.addPlaneSurface([loop])
    gmsh.model.geo.synchronize()
    return surface, curves


def groups(surfaces, curves):
    """Puts the surfaces into one physical group and the curves into another."""
    gmsh.model.addPhysicalGroup(2, surfaces, name="membrane")
    gmsh.model.addPhysicalGroup(1, curves, name="clamped edge")


def encodings():
    """One mesh in the four encodings. Points, lines, a curve inside and physical groups are among the elements."""
    new_model()
    surface, curves = rectangle()
    a, b = gmsh.model.geo.addPoint(0.3, 0.3, 0, 0.3), gmsh.model.geo.addPoint(0.8, 0.5, 0, 0.3)
    inside = gmsh.model.geo.addLine(a, b)
    gmsh.model.geo.synchronize()
    gmsh.model.mesh.embed(1, [inside], 2, surface)
    groups([surface], curves)
    gmsh.model.addPhysicalGroup(0, [a], name="gauge")
    gmsh.model.addPhysicalGroup(1, [inside], name="stiffener")
    gmsh.model.mesh.generate(2)
    for version, digits in ((MSH22, "22"), (MSH41, "41")):
        for binary, encoding in ((False, "ascii"), (True, "binary")):
            write(f"rectangle_{digits}_{encoding}", version, binary)
    write("version_40", MSH40)
    write("version_1", MSH1)


def sparse():
    """Node and element tags far apart and unordered, nodes that belong to no triangle, in the four encodings."""
    new_model(SaveAll=1, PreserveNumberingMsh2=1)
    tags = [7, 9_000_000, 12, 400, 5, 1_000_003, 33]
    points = [(0, 0), (1, 0), (1, 1), (0, 1), (0.4, 0.6), (2, 2), (3, 0)]
    surface = gmsh.model.addDiscreteEntity(2)
    gmsh.model.mesh.addNodes(2, surface, tags, [c for x, y in points for c in (x, y, 0)])
    triangles = [(7, 9_000_000, 5), (9_000_000, 12, 5), (12, 400, 5), (400, 7, 5)]
    gmsh.model.mesh.addElementsByType(surface, 2, [50, 2_000_000, 3, 9], [tag for t in triangles for tag in t])
    write("sparse_41_ascii")
    write("sparse_41_binary", binary=True)
    write("sparse_22_ascii", MSH22)
    write("sparse_22_binary", MSH22, binary=True)


def group_cases():
    """Physical groups: none at all, two that share the surface, only one of a curve."""
    new_model()
    rectangle()
    gmsh.model.mesh.generate(2)
    write("no_groups_41")

    new_model()
    surface, curves = rectangle(size=0.5)
    groups([surface], curves)
    gmsh.model.addPhysicalGroup(2, [surface], name="steel")
    gmsh.model.mesh.generate(2)
    write("two_groups_22_ascii", MSH22)
    write("two_groups_22_binary", MSH22, binary=True)
    write("two_groups_41")

    new_model()
    _, curves = rectangle(size=0.5)
    gmsh.model.addPhysicalGroup(1, curves, name="clamped edge")
    gmsh.model.mesh.generate(2)
    write("only_curves_41")
    write("only_curves_22", MSH22)


def materials():
    """Two materials with a common side, groups that overlap, one without a name."""
    new_model()
    left, left_curves = rectangle(size=0.8, width=1.0)
    right, right_curves = rectangle(size=0.8, x=1.0, width=1.0)
    gmsh.model.geo.removeAllDuplicates()
    gmsh.model.geo.synchronize()
    # The right surface now has the right side of the left one as its left side.
    seam = left_curves[1]
    gmsh.model.addPhysicalGroup(2, [left], name="rubber")
    gmsh.model.addPhysicalGroup(2, [right], name="steel")
    gmsh.model.addPhysicalGroup(2, [left, right], name="all of it")
    gmsh.model.addPhysicalGroup(1, [left_curves[0], left_curves[2], left_curves[3]], name="clamped")
    gmsh.model.addPhysicalGroup(1, [right_curves[1], right_curves[2]], name="free")
    gmsh.model.addPhysicalGroup(1, [left_curves[2], right_curves[2]], name="top")
    gmsh.model.addPhysicalGroup(1, [seam])
    gmsh.model.mesh.generate(2)
    for version, digits in ((MSH22, "22"), (MSH41, "41")):
        for binary, encoding in ((False, "ascii"), (True, "binary")):
            write(f"materials_{digits}_{encoding}", version, binary)
    write("materials_40", MSH40)


def shapes():
    """Two separate surfaces, a surface with a hole, a periodic one with a view behind it, one at a height."""
    new_model()
    left, left_curves = rectangle(size=0.4)
    right, right_curves = rectangle(size=0.4, x=2.0)
    groups([left, right], left_curves + right_curves)
    gmsh.model.mesh.generate(2)
    write("two_surfaces_41")

    new_model()
    outer, outer_loop = polygon([(0, 0), (1.2, 0), (1.2, 0.8), (0, 0.8)], 0.3)
    hole, hole_loop = polygon([(0.4, 0.3), (0.8, 0.3), (0.8, 0.5), (0.4, 0.5)], 0.2)
    surface = gmsh.model.geo.addPlaneSurface([outer_loop, hole_loop])
    gmsh.model.geo.synchronize()
    groups([surface], outer + hole)
    gmsh.model.mesh.generate(2)
    write("hole_41")

    new_model()
    surface, curves = rectangle(size=0.4, z=1000.1)
    groups([surface], curves)
    gmsh.model.mesh.generate(2)
    write("height_41")


def periodic_with_view():
    """$Periodic and $NodeData behind the mesh, ASCII and binary."""
    new_model()
    surface, curves = rectangle(size=0.4)
    translation = [1, 0, 0, 1.2, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
    gmsh.model.mesh.setPeriodic(1, [curves[1]], [curves[3]], translation)
    groups([surface], curves)
    gmsh.model.mesh.generate(2)
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    view = gmsh.view.add("height")
    heights = [[math.sin(x)] for x in coordinates[::3]]
    gmsh.view.addModelData(view, 0, gmsh.model.getCurrent(), "NodeData", tags, heights)
    for binary, encoding in ((False, "ascii"), (True, "binary")):
        gmsh.option.setNumber("Mesh.Binary", int(binary))
        gmsh.option.setNumber("PostProcessing.Binary", int(binary))
        gmsh.view.write(view, os.path.join(HERE, f"periodic_view_41_{encoding}.msh"))


def parametric():
    """Nodes with their parameters on curves and surface."""
    new_model(SaveParametric=1)
    surface, curves = rectangle(size=0.5)
    groups([surface], curves)
    gmsh.model.mesh.generate(2)
    write("parametric_41_ascii")
    write("parametric_41_binary", binary=True)
    write("parametric_22", MSH22)


def partitioned():
    """Two parts, with the topology between them and ghost cells."""
    new_model(PartitionCreateGhostCells=1)
    surface, curves = rectangle(size=0.4)
    groups([surface], curves)
    gmsh.model.mesh.generate(2)
    gmsh.model.mesh.partition(2)
    write("partitioned_41_ascii")
    write("partitioned_41_binary", binary=True)
    write("partitioned_22", MSH22)


def views():
    """Numbers at nodes and on all elements, a vector, and two time steps, in one file with the mesh before each; in the four encodings."""
    new_model()
    surface, curves = rectangle(size=0.5)
    groups([surface], curves)
    gmsh.model.mesh.generate(2)
    nodes, coordinates, _ = gmsh.model.mesh.getNodes()
    _, elements, _ = gmsh.model.mesh.getElements()
    elements = [tag for tags in elements for tag in tags]
    model = gmsh.model.getCurrent()
    added = [gmsh.view.add(name) for name in ("pressure", "number", "wind", "history")]
    pressure = [[-10 * x] for x in coordinates[::3]]
    gmsh.view.addModelData(added[0], 0, model, "NodeData", nodes, pressure)
    gmsh.view.addModelData(added[1], 0, model, "ElementData", elements, [[float(tag)] for tag in elements])
    gmsh.view.addModelData(added[2], 0, model, "NodeData", nodes, [[1, 2, 3]] * len(nodes))
    for step in (0, 1):
        gmsh.view.addModelData(added[3], step, model, "NodeData", nodes, pressure, time=0.5 * step)
    for version, digits in ((MSH22, "22"), (MSH41, "41")):
        for binary, encoding in ((False, "ascii"), (True, "binary")):
            gmsh.option.setNumber("Mesh.MshFileVersion", version)
            gmsh.option.setNumber("Mesh.Binary", int(binary))
            gmsh.option.setNumber("PostProcessing.Binary", int(binary))
            for k, view in enumerate(added):
                gmsh.view.write(view, os.path.join(HERE, f"views_{digits}_{encoding}.msh"), append=k > 0)


def inclined():
    """The rectangle in a plane of slope 3/4."""
    new_model()
    curves, loop = polygon([(0, 0, 0), (1.2, 0, 0), (1.2, 0.64, 0.48), (0, 0.64, 0.48)], 0.4)
    surface = gmsh.model.geo.addPlaneSurface([loop])
    gmsh.model.geo.synchronize()
    groups([surface], curves)
    gmsh.model.mesh.generate(2)
    write("inclined_41")


def other_elements():
    """Quadrangles, second-order triangles, tetrahedra; triangles that are not flat."""
    new_model(RecombineAll=1)
    surface, curves = rectangle(size=0.5)
    groups([surface], curves)
    gmsh.model.mesh.generate(2)
    write("quadrangles_41")
    write("quadrangles_22_binary", MSH22, binary=True)

    new_model(ElementOrder=2)
    surface, curves = rectangle(size=0.6)
    groups([surface], curves)
    gmsh.model.mesh.generate(2)
    write("second_order_41")
    write("second_order_22_binary", MSH22, binary=True)

    new_model()
    gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
    gmsh.model.occ.synchronize()
    gmsh.option.setNumber("Mesh.MeshSizeMin", 1)
    gmsh.model.mesh.generate(2)
    write("not_flat_41")
    write("not_flat_22", MSH22)
    gmsh.model.mesh.generate(3)
    write("tetrahedra_41")
    write("tetrahedra_41_binary", binary=True)


def main():
    gmsh.initialize(interruptible=False)
    encodings()
    sparse()
    group_cases()
    materials()
    shapes()
    periodic_with_view()
    parametric()
    partitioned()
    views()
    inclined()
    other_elements()
    gmsh.finalize()


if __name__ == "__main__":
    main()
