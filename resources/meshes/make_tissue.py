#!/usr/bin/python3
"""Makes what the scenes of Table 1 hold beside organs: a sheet of tissue, a string, a drop of blood, each with its
collision spheres where it needs any, and spheres below the peritoneum. Frame and units are those of make_organs.py.

    make_tissue.py ORGANS TABLE1
"""
import pathlib
import sys

import numpy as np

from make_minimal import ball
from make_organs import sheet, spline, tube_path, wall, write_off


def write_rows(path, rows, header):
    path.parent.mkdir(exist_ok=True)
    path.write_text(header + "\n" + "".join("%.6f %.6f %.6f %.6f\n" % tuple(r) for r in rows))


def tissue(u, v):
    """A fold of peritoneum of 6 x 6 cm that hangs beside the womb, toward the viewer."""
    x, y = 0.026 + 0.060 * u, 0.036 - 0.060 * v
    return np.stack([x, y, 0.020 + 0.003 * np.sin(2 * np.pi * u) * np.sin(np.pi * v)], 1)


def even_sheet(side, place):
    """A sheet whose squares are all cut along the same diagonal: its springs follow one another in memory."""
    vertices, _ = sheet(side, side, place)
    i = np.arange(side * side).reshape(side, side)
    a, b, c, d = (x.ravel() for x in (i[:-1, :-1], i[1:, :-1], i[1:, 1:], i[:-1, 1:]))
    return vertices, np.stack([a, b, c, a, c, d], 1).reshape(-1, 3)


def tissue_spheres(rows, columns, radius):
    """Evenly over the sheet, in its middle surface."""
    v, u = np.meshgrid((np.arange(rows) + 0.5) / rows, (np.arange(columns) + 0.5) / columns, indexing="ij")
    p = tissue(u.ravel(), v.ravel())
    return np.column_stack([p, np.full(len(p), radius)])


def string(count):
    """A thread that falls from the womb in a loop and rises to the wall of the pelvis."""
    turn = np.linspace(0, 2 * np.pi, 9)
    coil = np.stack([0.046 + 0.0036 * turn, 0.010 + 0.007 * np.cos(turn), 0.018 + 0.006 * np.sin(turn)], 1)
    return spline(np.concatenate([[[0.030, 0.030, 0.012], [0.038, 0.022, 0.018]], coil, [[0.078, 0.016, 0.018], [0.088, 0.022, 0.014]]]), count)


def pelvis_spheres(radius, spacing):
    """Below the peritoneum and touching it, over the pouch and the floor: the first of each neighbourhood in a fine
    lattice of the wall's own coordinates."""
    u, v = np.meshgrid(np.linspace(0.14, 0.86, 160), np.linspace(0.30, 0.98, 260))
    p = wall(u.ravel(), v.ravel())
    grid = p.reshape(*u.shape, 3)
    normal = np.cross(np.gradient(grid, axis=1), np.gradient(grid, axis=0)).reshape(-1, 3)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    normal *= np.sign(normal[:, 1:2] + normal[:, 2:3])
    kept = []
    for i in range(len(p)):
        if not kept or np.min(np.linalg.norm(p[kept] - p[i], axis=1)) > spacing:
            kept.append(i)
    return np.column_stack([p[kept] - radius * normal[kept], np.full(len(kept), radius)])


def main():
    organs, table = (pathlib.Path(folder) for folder in sys.argv[1:])
    write_rows(organs / "peritoneum.spheres", pelvis_spheres(0.008, 0.0075), "# x y z r, in metres")
    path = tube_path(1)
    along = np.linspace(0, 1, len(path))
    write_rows(organs / "tube_right.curve", np.column_stack([path, 0.0024 + 0.0026 * np.clip((along - 0.25) / 0.5, 0, 1) ** 1.3]),
               "# x y z r, in metres")
    write_off(table, "tissue", even_sheet(20, tissue))
    write_rows(table / "tissue.spheres", tissue_spheres(23, 22, 0.0018), "# x y z r, in metres")
    write_rows(table / "string.curve", [(*p, 0.0016) for p in string(120)], "# x y z r, in metres")
    write_rows(table / "string.spheres", [(*p, 0.0016) for p in string(60)], "# x y z r, in metres")
    vertices, triangles = ball(0.0100, 2)
    write_off(table, "drop", (vertices + [0.036, -0.006, 0.028], triangles))


if __name__ == "__main__":
    main()
