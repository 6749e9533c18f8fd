#!/usr/bin/python3
"""Makes a suture in an open overhand knot: a trefoil with one lobe open, whose ends turn aside. Frame and units are
those of make_organs.py.

    make_knot.py FOLDER
"""
import pathlib
import sys

import numpy as np

from make_tissue import write_rows

CENTRE, SCALE, RADIUS = np.array([0.045, 0.026, 0.050]), 0.002, 0.0005
OPEN, BEND, TAIL = 0.6, 1.5, 12.0  # of the lobe, rad; radius of the tails' turn and their length, in SCALE


def knot():
    t = np.linspace(np.pi + OPEN, 3 * np.pi - OPEN, 161)
    middle = np.stack([np.sin(t) + 2 * np.sin(2 * t), np.cos(t) - 2 * np.cos(2 * t), -np.sin(3 * t)], 1)
    angle = np.concatenate([np.linspace(0, np.pi / 2, 21)[1:], np.full(20, np.pi / 2)])
    on = np.concatenate([np.zeros(20), np.linspace(0, TAIL, 21)[1:]])
    x, y, z = middle[0]
    tail = np.stack([x + BEND * (1 - np.cos(angle)) + on, y - BEND * np.sin(angle), z * (1 + np.cos(2 * angle)) / 2], 1)
    return CENTRE + SCALE * np.concatenate([tail[::-1], middle, tail * [-1, 1, -1]])


def main():
    write_rows(pathlib.Path(sys.argv[1]) / "suture.curve", [(*p, RADIUS) for p in knot()], "# x y z r, in metres")


if __name__ == "__main__":
    main()
