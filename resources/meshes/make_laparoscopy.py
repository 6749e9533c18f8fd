#!/usr/bin/python3
"""Makes what the demo holds beside organs: the folds between tubes and floor, a thread over the womb, a drop of blood.
Frame and units are those of make_organs.py.

    make_laparoscopy.py FOLDER
"""
import pathlib
import sys

import numpy as np

from make_intestine import evenly
from make_minimal import ball
from make_organs import ligament_place, spline, write_off
from make_tissue import even_sheet, write_rows

THREAD = 0.0014  # m, radius


def ligament_spheres(place, rows, columns, radius):
    """Evenly over the fold, in its middle surface."""
    v, u = np.meshgrid((np.arange(rows) + 0.5) / rows, (np.arange(columns) + 0.5) / columns, indexing="ij")
    p = place(u.ravel(), v.ravel())
    return np.column_stack([p, np.full(len(p), radius)])


def thread(count):
    """From one shoulder of the womb to the other, in a coil before it."""
    turn = np.linspace(np.pi / 2, -3.5 * np.pi, 17)
    coil = np.stack([0.004 * np.linspace(-1, 1, len(turn)) + 0.0062 * np.cos(turn), 0.008 + 0.0062 * np.sin(turn),
                     0.0235 + 0.0035 * np.linspace(-1, 1, len(turn))], 1)
    return evenly(spline(np.concatenate([[[-0.022, 0.034, 0.0055], [-0.014, 0.022, 0.0165]], coil, [[0.014, 0.020, 0.0185], [0.022, 0.034, 0.0055]]]), 2000), count)[0]


def main():
    folder = pathlib.Path(sys.argv[1])
    for side, name, rows, columns in ((-1, "left", 20, 25), (1, "right", 18, 23)):
        place = ligament_place(side, 14, 0.066)
        write_off(folder, "ligament_" + name, even_sheet(20, place))
        write_rows(folder / f"ligament_{name}.spheres", ligament_spheres(place, rows, columns, 0.0018), "# x y z r, in metres")
    write_rows(folder / "thread.curve", [(*p, THREAD) for p in thread(160)], "# x y z r, in metres")
    write_rows(folder / "thread.spheres", [(*p, THREAD) for p in thread(60)], "# x y z r, in metres")
    vertices, triangles = ball(0.0115, 2)
    write_off(folder, "drop", (vertices + [0.036, -0.021, 0.029], triangles))


if __name__ == "__main__":
    main()
