#!/usr/bin/python3
"""Makes the meshes of the minimal scene: a ball of 2 cm radius, and a floor slab with its top at y = 0.

    make_minimal.py FOLDER
"""
import os
import sys

import numpy as np

from make_organs import check_closed, write_off


def ball(radius, rounds):
    """An icosahedron, its triangles cut in four and pushed out to the sphere."""
    g = (1 + 5**0.5) / 2
    corners = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g), (0, 1, -g),
               (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    triangles = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2),
                 (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11),
                 (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    vertices = [np.array(c) / np.linalg.norm(c) for c in corners]
    for _ in range(rounds):
        middles, finer = {}, []

        def middle(a, b):
            key = min(a, b), max(a, b)
            if key not in middles:
                middles[key] = len(vertices)
                m = vertices[a] + vertices[b]
                vertices.append(m / np.linalg.norm(m))
            return middles[key]

        for a, b, c in triangles:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        triangles = finer
    return radius * np.array(vertices), np.array(triangles)


def slab(half, thickness, bevel):
    """A square slab whose upper edge is bevelled; four rings from the middle of its top to that of its bottom."""
    rings = [(half - bevel, 0), (half, -bevel), (half, bevel - thickness), (half - bevel, -thickness)]
    turn = [(1, 1), (1, -1), (-1, -1), (-1, 1)]
    vertices = [(0, 0, 0)] + [(r * x, y, r * z) for r, y in rings for x, z in turn] + [(0, -thickness, 0)]
    triangles = []
    for s in range(4):
        n = (s + 1) % 4
        triangles += [(0, 1 + s, 1 + n), (17, 13 + n, 13 + s)]
        for k in range(3):
            a, b = 1 + 4 * k, 5 + 4 * k
            triangles += [(a + s, b + s, a + n), (a + n, b + s, b + n)]
    return np.array(vertices, float), np.array(triangles)


def main():
    folder = sys.argv[1]
    os.makedirs(folder, exist_ok=True)
    for name, mesh in (("ball", ball(0.02, 3)), ("floor", slab(0.065, 0.012, 0.002))):
        check_closed(mesh[1])
        write_off(folder, name, mesh)


if __name__ == "__main__":
    main()
