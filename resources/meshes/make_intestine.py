#!/usr/bin/python3
"""Makes the curve of a bowel: loops that lie before the womb on the floor of the pelvis, in the frame of
make_organs.py. Rows in two layers follow the floor and bend into each other; the script refuses to write a bowel that touches itself.
Needs the spheres of the peritoneum, of the womb and of the ovaries, to say how far it lies from them.

    make_intestine.py ORGANS FOLDER FIRST LOWER UPPER

FIRST: how far down the slope of the floor it begins, 0 to 1; LOWER, UPPER: rows in each layer.
"""
import pathlib
import sys

import numpy as np

from make_organs import spline, wall
from make_tissue import write_rows

RADIUS, WAVE = 0.0095, 0.0005  # m: of the bowel, and by how much it widens and narrows along itself
APART = 0.0235           # m: between stretches at rest, at least
LAYER = 0.0235           # m: from the lower rows to the upper ones
REACH = 4 * RADIUS       # m: along the bowel, within which points are of one stretch


def floor(x, v, height):
    """Above the wall, whose folds are smoothed over; x, v and height: arrays."""
    around = [wall(0.5 + (x + dx) / 0.300, v + dv) for dx in (-0.014, 0, 0.014) for dv in (-0.02, 0, 0.02)]
    return np.mean(around, axis=0) + np.outer(height, [0, 0.8, 0.6])


def rows(first, lower, upper):
    """To and fro, down the slope of the floor and back above, with a bend from each row to the next."""
    lower = [(first + 0.047 * k, LAYER * 0.6) for k in range(lower)]
    upper = [(lower[-1][0] - 0.023 - 0.047 * k, LAYER * 1.6) for k in range(upper)]
    turns = [0.066, -0.072, 0.078, -0.076, 0.072, -0.070, 0.064, -0.068, 0.062, -0.058]  # x where a row ends
    points = []
    for n, (v, height) in enumerate(lower + upper):
        t = np.linspace(0, 1, 15)
        x = turns[n] + t * (turns[n + 1] - turns[n])
        wave = (0.006 * np.sin(62 * x) + 0.003 * np.sin(141 * x + 1)) * (1 - (2 * t - 1) ** 6)
        row = floor(x, v + wave, height + 0.0012 * np.sin(95 * x))
        if points:
            outward = np.array([0.009 * np.sign(x[0]), 0, 0])
            points.append((0.5 * (points[-1][-1] + row[0]) + outward)[None])
        points.append(row)
    return np.concatenate(points)


def evenly(points, count):
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    s = np.linspace(0, length[-1], count)
    return np.column_stack([np.interp(s, length, points[:, k]) for k in range(3)]), s


def stretches_apart(p, step):
    """Least distance between points that are not of one stretch."""
    distance = np.linalg.norm(p[:, None] - p[None], axis=2)
    i = np.arange(len(p))
    distance[np.abs(i[:, None] - i[None]) * step < REACH] = np.inf
    return distance.min()


def push_apart(start, balls, rounds):
    """Moves what is too near apart, with what lies beside it along the bowel."""
    i = np.arange(len(start))
    step, moved = np.linalg.norm(start[1] - start[0]), np.zeros_like(start)
    other = np.abs(i[:, None] - i[None]) * step >= REACH
    for _ in range(rounds):
        p = start + moved
        for others, least in ((p, np.where(other, APART, 0)), (balls[:, :3], balls[None, :, 3] + RADIUS + WAVE)):
            away = p[:, None] - others[None]
            distance = np.maximum(np.linalg.norm(away, axis=2), 1e-9)
            depth = np.maximum(least - distance, 0)
            push = (away * (depth / distance)[..., None]).sum(1) / np.maximum((depth > 0).sum(1), 1)[:, None]
            moved = moved + 0.5 * push
        moved[1:-1] = 0.25 * moved[:-2] + 0.5 * moved[1:-1] + 0.25 * moved[2:]
    return start + moved


def main():
    organs, folder = (pathlib.Path(name) for name in sys.argv[1:3])
    first, lower, upper = float(sys.argv[3]), int(sys.argv[4]), int(sys.argv[5])
    balls = np.concatenate([np.loadtxt(organs / (name + ".spheres")) for name in ("peritoneum", "uterus", "ovary_left", "ovary_right")])
    p = push_apart(evenly(spline(rows(first, lower, upper), 4000), 360)[0], balls, 400)
    p, s = evenly(spline(p, 4000), 700)
    length = s[-1]
    apart = stretches_apart(p, length / len(p))
    clear = (np.linalg.norm(p[:, None] - balls[None, :, :3], axis=2) - balls[:, 3]).min()
    print(f"intestine: {length:.2f} m, stretches {1e3 * apart:.1f} mm apart, {1e3 * clear:.1f} mm off the organs")
    if apart < 2 * (RADIUS + WAVE) * 1.1:
        raise SystemExit("stretches of the bowel lie nearer to each other than self-contact can tell apart")
    radius = RADIUS + WAVE * np.sin(2 * np.pi * s / 0.021) * np.cos(2 * np.pi * s / 0.13)
    write_rows(folder / "intestine.curve", np.column_stack([p, radius]), "# x y z r, in metres")


if __name__ == "__main__":
    main()
