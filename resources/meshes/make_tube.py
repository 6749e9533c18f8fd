#!/usr/bin/python3
"""Makes the tube between two posts that is clipped and cut, and two tracks of that: one that puts both clamps first, and
one that cuts too early.

    make_tube.py FOLDER
"""
import math
import pathlib
import sys

import numpy as np

from make_organs import check_closed, turned, write_off
from make_pegs import turn_of
from make_tissue import write_rows

RADIUS, HALF = 0.0026, 0.036  # of the tube, m
POST, HEIGHT, SLAB = (0.004, 0.009), 0.030, (0.060, 0.040, 0.006)  # half of a post's sides; the tube is HEIGHT above the slab
BALL = 0.4  # radius of the spheres that make the slab's top
PLACE = 0.009  # of the clamps along the tube, from its middle
# Where instruments go through the wall, where they wait, and how far from the hinge they take hold or cut.
ENTRY = {"left": (-0.080, 0.180, 0.050), "right": (0.080, 0.180, 0.050), "scissors": (0.0, 0.170, 0.120)}
AWAY = {"left": (-0.042, 0.046, 0.012), "right": (0.042, 0.046, 0.012), "scissors": (0.0, 0.050, 0.030)}
REACH = {"left": 0.0100, "right": 0.0100, "scissors": 0.0110}
RATE_HZ = 25
END = 8.0  # s


def tube():
    """About x, with round ends."""
    ends = np.linspace(0, np.pi / 2, 4)[1:]
    profile = [(RADIUS * np.sin(a), 0.0012 * (1 - np.cos(a))) for a in ends]
    profile += [(RADIUS, z) for z in np.linspace(0.0012, 2 * HALF - 0.0012, 60)[1:-1]]
    profile += [(r, 2 * HALF - z) for r, z in profile[:3][::-1]]
    vertices, triangles = turned(profile, 14)
    return np.stack([vertices[:, 2] - HALF, vertices[:, 0], vertices[:, 1]], 1), triangles


def box(low, high):
    corners = np.array([[(low, high)[c][k] for k, c in enumerate(((i >> 2) & 1, (i >> 1) & 1, i & 1))] for i in range(8)])
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return corners, np.array([t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))])


def stand():
    """A slab and two posts, which the ends of the tube go into."""
    x, z, deep = SLAB
    parts = [box((-x, -HEIGHT - deep, -z), (x, -HEIGHT, z))]
    for side in (-1, 1):
        middle = side * (HALF + 0.001)
        parts.append(box((middle - POST[0], -HEIGHT, -POST[1]), (middle + POST[0], 0.006, POST[1])))
    first, vertices, triangles = 0, [], []
    for v, t in parts:
        vertices.append(v)
        triangles.append(t + first)
        first += len(v)
    return np.concatenate(vertices), np.concatenate(triangles)


def spheres():
    line = [(x, 0, 0, RADIUS) for x in np.linspace(-HALF + RADIUS, HALF - RADIUS, 36)]
    top = [(x, -HEIGHT - BALL, z, BALL) for x in np.linspace(-0.05, 0.05, 6) for z in (-0.03, 0, 0.03)]
    posts = [(side * (HALF + 0.001), y, z, 0.004) for side in (-1, 1) for y in np.arange(-HEIGHT + 0.004, 0.003, 0.004)
             for z in (-0.005, 0.0, 0.005)]
    return line, top + posts


# Tracks.


def hinge(name, at):
    """Where the hinge is for the instrument to work at a place."""
    way = np.asarray(ENTRY[name]) - at
    return np.asarray(at) + REACH[name] * way / np.linalg.norm(way)


def hand(name, rows):
    """Rows of time, place of work (None: away) and whether the button is down from then on."""
    return [(t, np.asarray(AWAY[name], float) if at is None else hinge(name, np.asarray(at, float)), down) for t, at, down in rows]


def at_time(rows, t):
    k = max([0] + [i for i, r in enumerate(rows[:-1]) if t >= r[0] - 1e-9])
    (start, a, down), (end, b, _) = rows[k], rows[k + 1]
    s = min(1, (t - start) / (end - start))
    return a + s * s * (3 - 2 * s) * (b - a), down


def clamp(name, t):
    """Comes to the tube at t, closes on it, stays, and draws its part of the tube aside after the cut."""
    x = -PLACE if name == "left" else PLACE
    apart = x + (-0.003 if name == "left" else 0.003)
    return hand(name, [(0, None, 0), (t, None, 0), (t + 0.7, (x, 0.012, 0), 0), (t + 1.1, (x, 0, 0), 1), (t + 1.6, (x, 0, 0), 0),
                       (6.6, (x, 0, 0), 0), (7.4, (apart, 0, 0), 0), (END, (apart, 0, 0), 0)])


def scissors(t):
    return hand("scissors", [(0, None, 0), (t, None, 0), (t + 0.8, (0, 0.014, 0), 0), (t + 1.2, (0, 0, 0), 1), (t + 1.6, (0, 0, 0), 0),
                             (t + 1.8, (0, 0, 0), 0), (t + 2.2, (0, 0.020, 0), 0), (END, None, 0)])


def track(hands):
    lines = ["spore-track 1"]
    for name, rows in hands.items():
        lines.append("device " + name)
        for n in range(round(RATE_HZ * END) + 1):
            place, down = at_time(rows, n / RATE_HZ)
            lines.append("%.2f %.6f %.6f %.6f %.6f %.6f %.6f %.6f 0 %d" % (n / RATE_HZ, *place, *turn_of(place, ENTRY[name]), down))
    return "\n".join(lines) + "\n"


def say_poses():
    """What the scene says of each instrument: where it stands at the start."""
    for name, away in AWAY.items():
        w, *v = turn_of(np.asarray(away), ENTRY[name])
        angle, size = 2 * math.atan2(np.linalg.norm(v), w), np.linalg.norm(v)
        rotation = np.asarray(v) * (angle / size)
        x, y, z = v
        axis = (1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y))
        along = np.asarray(ENTRY[name]) - away
        tip = away - 0.018 * along / np.linalg.norm(along)
        print(name, *('%s="%.6f %.6f %.6f"' % (what, *values) for what, values in (
            ("position", away), ("rotation", rotation), ("axis", axis), ("tip", tip))))


def main():
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(exist_ok=True)
    check_closed(tube()[1])
    write_off(folder, "tube", tube())
    write_off(folder, "stand", stand())
    for name, rows in zip(("tube", "stand"), spheres()):
        write_rows(folder / (name + ".spheres"), rows, "# x y z r, in metres")
    (folder / "exercise-clip-and-cut.track").write_text(track({"left": clamp("left", 0.2), "right": clamp("right", 1.9), "scissors": scissors(3.8)}))
    (folder / "early.track").write_text(track({"left": clamp("left", 0.2), "right": clamp("right", 4.6), "scissors": scissors(1.9)}))
    say_poses()


if __name__ == "__main__":
    main()
