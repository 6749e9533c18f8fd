#!/usr/bin/python3
"""Makes what the exercise of suction holds: a bowl with its collision spheres, a pool of blood that lies in it, and the
water of the irrigation, which is out of the world at first.

    make_dish.py FOLDER
"""
import math
import pathlib
import sys

import numpy as np

from make_organs import check_closed, turned, write_off
from make_tissue import write_rows

BOWL, RIM, THICK = 0.034, 1.15, 0.003  # radius of its inside about the origin; how far up the rim is, rad; its wall
SPHERE, SPACING = 0.006, 0.0045  # radius of collision spheres, and how far apart they lie
POOL = (0.0165, 0.0055)  # half width and half height
WATER = 0.0156  # radius of what is poured at most: 16 ml


def upright(mesh):
    """What is turned about z, about y."""
    vertices, triangles = mesh
    return vertices[:, [0, 2, 1]] * (1, 1, -1), triangles


def bowl():
    """Inside and outside, as one closed surface."""
    angle = np.linspace(0.06, RIM, 14)
    inside = [(BOWL * math.sin(a), -BOWL * math.cos(a)) for a in angle]
    outside = [((BOWL + THICK) * math.sin(a), -(BOWL + THICK) * math.cos(a)) for a in angle]
    vertices, triangles = turned(outside + inside[::-1], 40)
    vertices[0] = (0, 0, -BOWL - THICK)
    vertices[-1] = (0, 0, -BOWL)
    return upright((vertices, triangles))


def drop(width, height):
    angle = np.linspace(0.15, np.pi - 0.15, 12)
    vertices, triangles = turned([(width * math.sin(a), -height * math.cos(a)) for a in angle], 24)
    vertices[0], vertices[-1] = (0, 0, -height), (0, 0, height)
    return upright((vertices, triangles))


def bowl_spheres():
    """Below the inside, which they touch, in rings."""
    rows, away = [(0, -BOWL - SPHERE, 0, SPHERE)], BOWL + SPHERE
    rings = round(RIM * BOWL / SPACING)
    for k in range(1, rings + 1):
        a = RIM * k / rings
        count = max(6, round(2 * np.pi * BOWL * math.sin(a) / SPACING))
        for n in range(count):
            b = 2 * np.pi * (n + 0.5 * (k % 2)) / count
            rows.append((away * math.sin(a) * math.cos(b), -away * math.cos(a), away * math.sin(a) * math.sin(b), SPHERE))
    return rows


def main():
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(exist_ok=True)
    for name, mesh in (("bowl", bowl()), ("pool", drop(*POOL)), ("water", drop(WATER, WATER))):
        check_closed(mesh[1])
        write_off(folder, name, mesh)
    write_rows(folder / "bowl.spheres", bowl_spheres(), "# x y z r, in metres")


if __name__ == "__main__":
    main()
