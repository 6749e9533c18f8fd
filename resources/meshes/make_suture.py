#!/usr/bin/python3
"""Makes a wound in a sheet of skin, what lies below it, a curved needle, its thread, and the track that sews with them:
skin in the plane y = 0, wound along z, needle in the plane z = 0.

    make_suture.py SUTURE INSTRUMENTS
"""
import pathlib
import sys

import numpy as np

from make_organs import turned, write_off
from make_tissue import write_rows

COLUMNS, ROWS, SIDE = 21, 15, 0.003  # of the skin
SLIT, OPEN = 0.012, 0.003  # half of the wound's length and width
RADIUS, HEIGHT, START = 0.007, 0.002, np.radians(10)  # of the needle's circle, of its middle, of its tip on it
WIRE, THREAD, LENGTH = 0.00035, 0.0002, 0.1
TURN, DRAW, UP = (0.1, 1.3), (1.35, 2.6), 0.112  # s, s, m
RATE_HZ, END = 50, 2.8


def skin():
    """A grid whose middle column is parted along the wound, and gapes there."""
    middle, half = COLUMNS // 2, (ROWS - 1) / 2
    place = [(i, k, 0) for k in range(ROWS) for i in range(COLUMNS)]
    parted = [k for k in range(ROWS) if abs(k - half) * SIDE < SLIT - 1e-9]
    right = {k: len(place) + n for n, k in enumerate(parted)}
    place = [(i, k, -1 if i == middle and k in right else s) for i, k, s in place] + [(middle, k, 1) for k in parted]

    def at(i, k, side):
        x, z = (i - middle) * SIDE, (k - half) * SIDE
        gape = OPEN * np.cos(np.pi * z / (2 * SLIT)) ** 2 if abs(z) < SLIT else 0
        return [x + (np.sign(x) or side) * gape * (1 - abs(x) / (middle * SIDE)), 0, z]

    def node(i, k, to_right):
        return right[k] if i == middle and to_right and k in right else k * COLUMNS + i

    triangles = []
    for k in range(ROWS - 1):
        for i in range(COLUMNS - 1):
            a, b, c, d = (node(i + n, k + m, i >= middle) for n, m in ((0, 0), (1, 0), (1, 1), (0, 1)))
            triangles += [[a, d, b], [b, d, c]] if (i + k) % 2 else [[a, d, c], [a, c, b]]
    return np.array([at(*p) for p in place]), np.array(triangles)


def bed():
    """Below the skin, uneven."""
    x, z = np.meshgrid(np.linspace(-0.036, 0.036, 49), np.linspace(-0.028, 0.028, 39), indexing="ij")
    y = -0.009 + 0.0006 * np.sin(900 * x + 2 * np.sin(300 * z)) * np.cos(500 * z) - 3 * (x * x + z * z)
    i = np.arange(x.size).reshape(x.shape)
    a, b, c, d = (s.ravel() for s in (i[:-1, :-1], i[:-1, 1:], i[1:, 1:], i[1:, :-1]))
    return np.stack([x, y, z], -1).reshape(-1, 3), np.stack([a, b, c, a, c, d], 1).reshape(-1, 3)


def needle():
    """Half a circle about the origin; the point is ground over the first fifth."""
    length = np.pi * RADIUS
    straight, triangles = turned([(WIRE * min(1, 0.1 + 5 * z / length), z) for z in np.linspace(0, length, 40)], 12)
    angle, reach = START + straight[:, 2] / RADIUS, RADIUS + straight[:, 0]
    return np.stack([reach * np.cos(angle), reach * np.sin(angle), -straight[:, 1]], 1), triangles


def thread(count):
    """From the swage aside and up, in one bend."""
    s = np.linspace(0, 1, count)
    angle = np.radians(110) - np.radians(75) * np.sin(np.pi * np.minimum(1, 1.6 * s) / 2) * -1
    step = np.stack([np.cos(angle), np.sin(angle), 0.15 * np.sin(2 * np.pi * s)], 1)[:-1] * LENGTH / (count - 1)
    swage = START + np.pi
    first = [RADIUS * np.cos(swage), HEIGHT + RADIUS * np.sin(swage), 0]
    return np.concatenate([[first], first + np.cumsum(step, 0)])


def ease(t, span):
    x = np.clip((t - span[0]) / (span[1] - span[0]), 0, 1)
    return x * x * (3 - 2 * x)


def track():
    """Once around through both edges, then up with the thread."""
    lines = ["spore-track 1", "device needle"]
    for n in range(round(RATE_HZ * END) + 1):
        t = n / RATE_HZ
        half = -1.025 * np.pi * ease(t, TURN)
        lines.append("%.2f 0 %.6f 0 %.7f 0 0 %.7f 0 0" % (t, HEIGHT + UP * ease(t, DRAW), np.cos(half), np.sin(half)))
    return "\n".join(lines) + "\n"


def main():
    folder = pathlib.Path(sys.argv[1])
    write_off(folder, "skin", skin())
    write_off(folder, "bed", bed())
    write_off(sys.argv[2], "needle", needle())
    write_rows(folder / "thread.curve", [(*p, THREAD) for p in thread(60)], "# x y z r, in metres")
    (folder / "suture.track").write_text(track())


if __name__ == "__main__":
    main()
