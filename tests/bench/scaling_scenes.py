"""Scenes of one kind in many sizes, for the curve of cost against size. Bodies keep their size while their parts become
smaller; spheres and particles keep theirs and become more."""
import math

import shapes
from kernel import net_mesh

HEAD = """<?xml version="1.0" encoding="UTF-8"?>
<spore version="1.0">
  <environment gravity="0 %s 0"/>
  <solver time_step="%s" sleep_speed="0"/>
"""


def scene(path, time_step, assets, bodies, links="", gravity="-9.81"):
    path.write_text(HEAD % (gravity, time_step) + f"  <assets>{assets}</assets>\n  <bodies>\n{bodies}  </bodies>\n"
                    + (f"  <links>{links}</links>\n" if links else "") + "</spore>\n")
    return path


def body(name, geometry, model):
    return f'    <body name="{name}"><mechanical geometry="{geometry}">{model}</mechanical></body>\n'


def tetrahedra(folder, size):
    """A cube of 20 cm, cut into cells of six tetrahedra each, held at one side."""
    n = max(1, round((size / 3) ** (1 / 3)) - 1)
    corners = [(i, j, k) for i in range(n + 1) for j in range(n + 1) for k in range(n + 1)]
    number = {corner: index + 1 for index, corner in enumerate(corners)}
    lines = ["MeshVersionFormatted 2", "Dimension 3", "Vertices", str(len(corners))]
    lines += ["%.9g %.9g %.9g 0" % tuple(0.2 * c / n for c in corner) for corner in corners]
    paths = ((4, 6, 7), (6, 2, 7), (2, 3, 7), (3, 1, 7), (1, 5, 7), (5, 4, 7))  # from a cell's first corner to its last

    def corner_of(cell, bits):
        return number[tuple(c + (bits >> (2 - axis) & 1) for axis, c in enumerate(cell))]

    cells = [(i, j, k) for i in range(n) for j in range(n) for k in range(n)]
    lines += ["Tetrahedra", str(6 * len(cells))]
    lines += [" ".join(str(corner_of(cell, bits)) for bits in (0, *path)) + " 0" for cell in cells for path in paths]
    (folder / "block.mesh").write_text("\n".join(lines + ["End", ""]))
    held = '<pin name="side" body="block" point="-10 0.1 0.1" radius="10.002"/>'
    model = '<neo_hookean_tetrahedra young_modulus="5000" poisson_ratio="0.4"/>'
    return scene(folder / "tetrahedra.spore", "0.004", '<tetrahedra name="block" file="block.mesh"/>', body("block", "block", model), held)


def nets(folder, size):
    """A square net of 1 m and 1 kg that swings from two corners."""
    n = max(4, round(math.sqrt(size / 3)))
    (folder / "net.off").write_bytes(shapes.off(*net_mesh(n)))
    held = "".join(f'<pin name="{name}" body="net" point="{x} 0 -0.5" radius="0.001"/>' for name, x in (("left", -0.5), ("right", 0.5)))
    return scene(folder / "nets.spore", "0.004", '<mesh name="net" file="net.off"/>', body("net", "net", '<mass_spring_net mass="1"/>'), held)


def sheets(folder, size):
    """A spline sheet of 20 cm, held at two corners."""
    n = max(6, round(math.sqrt(size / 3)))
    vertices, triangles = net_mesh(24, 0.2)
    (folder / "sheet.off").write_bytes(shapes.off(vertices, triangles))
    held = "".join(f'<pin name="{name}" body="sheet" point="{x} 0 -0.1" radius="0.02"/>' for name, x in (("left", -0.1), ("right", 0.1)))
    model = f'<spline_2d control_points_u="{n}" control_points_v="{n}"/>'
    return scene(folder / "sheets.spore", "0.004", '<mesh name="sheet" file="sheet.off"/>', body("sheet", "sheet", model), held)


def threads(folder, size):
    """A thread of 1 m, held at one end."""
    (folder / "thread.curve").write_text("".join("%.9g 0 0 0.002\n" % (i / 200) for i in range(201)))
    held = '<pin name="end" body="thread" point="0 0 0" radius="0.01"/>'
    model = f'<spline_1d control_points="{max(4, round(size / 3))}"/>'
    return scene(folder / "threads.spore", "0.004", '<curve name="thread" file="thread.curve"/>', body("thread", "thread", model), held)


def spheres(folder, size):
    """Balls of 10 cm that lie on a floor, four deep, each touching those around it."""
    side = max(1, round(math.sqrt(size / 6 / 4)))
    (folder / "ball.off").write_bytes(shapes.off(*shapes.sphere(0.05, rings=6, sectors=8)))
    (folder / "ball.spheres").write_text("0 0 0 0.05\n")
    (folder / "floor.spheres").write_text("0 -10000 0 10000\n")
    assets = '<mesh name="ball" file="ball.off"/><spheres name="ball-sphere" file="ball.spheres"/><spheres name="floor-sphere" file="floor.spheres"/>'
    law = 'stiffness="20000" damping="20" friction="0.5"'
    places = ((i, j, k) for i in range(side) for k in range(side) for j in range(4))
    bodies = "".join(f'    <body name="ball_{i}_{j}_{k}" position="{0.0998 * i:.6g} {0.05 + 0.0998 * j:.6g} {0.0998 * k:.6g}">'
                     f'<mechanical geometry="ball"><rigid_body/></mechanical><collision spheres="ball-sphere" {law}/></body>\n' for i, j, k in places)
    bodies += f'    <body name="floor" role="unmovable"><collision spheres="floor-sphere" {law}/></body>\n'
    return scene(folder / "spheres.spore", "0.004", assets, bodies)


def particles(folder, size):
    """A liquid without walls: one period of it, 2 mm from one particle to the next."""
    count = max(300, round(size / 3))  # fewer would touch themselves
    side = 0.002 * count ** (1 / 3)
    corner, period = side / 2, 1.06 * side
    points = [(x, y, z) for x in (-corner, corner) for y in (-corner, corner) for z in (-corner, corner)]
    faces = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)]
    (folder / "drop.off").write_bytes(shapes.off(points, faces))
    model = f'<lennard_jones particles="{count}" temperature="1" period="{period:.9g} {period:.9g} {period:.9g}"/>'
    return scene(folder / "particles.spore", "0.0001", '<mesh name="drop" file="drop.off"/>', body("drop", "drop", model), gravity="0")


class Family:
    """`exponent` of the time of a step by theory, and why."""

    def __init__(self, make, exponent, why):
        self.make, self.exponent, self.why = make, exponent, why


FAMILIES = {
    "tetrahedra": Family(tetrahedra, 4 / 3, "conjugate gradients: n an iteration, and as many as there are cells along a side"),
    "nets": Family(nets, 3 / 2, "conjugate gradients: n an iteration, and as many as there are nodes along a side"),
    "sheets": Family(sheets, 2, "conjugate gradients on a plate: n an iteration, and as many as the square of the points along a side"),
    "threads": Family(threads, 1, "factor of a band of fixed width"),
    "spheres": Family(spheres, 1, "a grid, and iterations by how deep the balls lie"),
    "particles": Family(particles, 1, "lists of neighbours from a grid"),
}
