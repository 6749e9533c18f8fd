#!/usr/bin/python3
"""Makes the board with its pegs, the ring, and two tracks of the peg transfer: one that carries six rings over and back,
from hand to hand, and one that lets a ring fall.

    make_pegs.py FOLDER
"""
import math
import pathlib
import sys

import numpy as np

from make_organs import check_closed, turned, write_off
from make_tissue import write_rows

COLUMNS, ROWS = (-0.047, -0.020, 0.020, 0.047), (-0.034, 0.0, 0.034)  # of pegs, x and z, m
PEG, HEIGHT = 0.0016, 0.012  # radius and height of a peg
RING, WALL, TALL = 0.010, 0.0015, 0.003  # radius of the ring's middle circle, half of its wall, half of its height
BOARD, BALL = (0.064, 0.054), 0.6  # half of the board's sides; spheres that make its top, one below each peg
HANDS = {"left": (-0.070, 0.200, 0.040), "right": (0.070, 0.200, 0.040)}  # where they go through the wall
AWAY = {"left": (-0.060, 0.085, 0.010), "right": (0.060, 0.085, 0.010)}
REACH = 0.0160  # from the hinge to the middle of what jaws hold
LIFT = 0.030  # of a ring where hands change
RATE_HZ = 25


def ring():
    """A band: a rectangle with cut corners, turned about y."""
    w, h, c = WALL, TALL, 0.0005
    corners = [(w, -h + c), (w, h - c), (w - c, h), (c - w, h), (-w, h - c), (-w, c - h), (c - w, -h), (w - c, -h)]
    sectors, count = 36, len(corners)
    angle = np.linspace(0, 2 * np.pi, sectors, endpoint=False)
    vertices = [((RING + r) * math.cos(a), y, (RING + r) * math.sin(a)) for a in angle for r, y in corners]
    triangles = []
    for s in range(sectors):
        for k in range(count):
            a, b = s * count + k, s * count + (k + 1) % count
            c, d = ((s + 1) % sectors) * count + (k + 1) % count, ((s + 1) % sectors) * count + k
            triangles += [(a, b, c), (a, c, d)]
    return np.array(vertices), np.array(triangles)


def board():
    """A slab with its top at y = 0, and a post with a round head at each place."""
    x, z, deep = *BOARD, 0.008
    box = np.array([(sx * x, y, sz * z) for y in (0, -deep) for sx, sz in ((-1, -1), (-1, 1), (1, 1), (1, -1))])
    faces = [(0, 1, 2), (0, 2, 3), (4, 6, 5), (4, 7, 6)] + [t for i in range(4) for t in (
        (i, 4 + i, (i + 1) % 4), ((i + 1) % 4, 4 + i, 4 + (i + 1) % 4))]
    head = [(PEG * math.cos(a), HEIGHT - PEG + PEG * math.sin(a)) for a in np.linspace(0, 1.5, 6)]
    post, sides = turned([(PEG, 0)] + head, 16)
    post = post[:, [0, 2, 1]] * (1, 1, -1)  # turned about z; here about y
    parts, triangles = [box], [np.array(faces)]
    for place in pegs():
        triangles.append(sides + sum(len(p) for p in parts))
        parts.append(post + place)
    return np.concatenate(parts), np.concatenate(triangles)


def pegs():
    return [np.array((x, 0, z)) for x in COLUMNS for z in ROWS]


def spheres():
    top = [(p[0], -BALL, p[2], BALL) for p in pegs()]
    posts = [(*(p + (0, y, 0)), PEG) for p in pegs() for y in np.arange(PEG, HEIGHT, 0.002)]
    band = [(RING * math.cos(a), y, RING * math.sin(a), WALL) for a in np.linspace(0, 2 * np.pi, 20, endpoint=False)
            for y in (-WALL, WALL)]
    return top + posts, band


# Tracks.


def turn_of(place, entry):
    """The shaft along the body's +z, the jaws opening along the scene's z as nearly as that allows; w, x, y, z."""
    along = np.asarray(entry, float) - place
    along /= np.linalg.norm(along)
    across = np.array((0, 0, -1.0))
    across -= along * (across @ along)
    across /= np.linalg.norm(across)
    m = np.stack([np.cross(across, along), across, along], 1)
    w = math.sqrt(max(1e-12, 1 + m[0, 0] + m[1, 1] + m[2, 2])) / 2
    return w, (m[2, 1] - m[1, 2]) / (4 * w), (m[0, 2] - m[2, 0]) / (4 * w), (m[1, 0] - m[0, 1]) / (4 * w)


def hinge(hold, entry):
    """Where the hinge is for jaws to hold at a place."""
    d = np.asarray(entry, float) - hold
    return np.asarray(hold) + REACH * d / np.linalg.norm(d)


class Hand:
    """A hand that is told one place after the other."""

    def __init__(self, name):
        self.entry, self.rows = HANDS[name], [(0.0, np.asarray(AWAY[name], float), 0)]
        self.away = AWAY[name]

    def go(self, until, hold, closed):
        self.rows.append((until, hinge(hold, self.entry), closed))

    def leave(self, until):
        self.rows.append((until, np.asarray(self.away, float), 0))

    def wait(self, until):
        self.rows.append((until, self.rows[-1][1], self.rows[-1][2]))

    def at(self, t):
        k = max([0] + [i for i, r in enumerate(self.rows[:-1]) if t >= r[0] - 1e-9])
        (start, a, closed), (end, b, _) = self.rows[k], self.rows[k + 1]
        s = min(1, (t - start) / (end - start))
        return a + s * s * (3 - 2 * s) * (b - a), closed


def carry(giver, taker, t, source, target):
    """One ring, from one hand to the other above the middle of the board, within 4.4 s from t."""
    rest, up = np.array((0, TALL, 0)), np.array((0, 0.020, 0))
    near, far = np.array((0, 0, RING)), np.array((0, 0, -RING))
    middle = np.array((0, LIFT, 0.5 * (source[2] + target[2])))
    giver.wait(t)
    giver.go(t + 0.6, source + rest + near + up, 0)
    giver.go(t + 0.9, source + rest + near, 1)
    giver.go(t + 1.2, source + rest + near, 1)
    giver.go(t + 1.5, source + rest + near + up, 1)
    giver.go(t + 2.1, middle + near, 1)
    giver.go(t + 2.6, middle + near, 0)
    giver.go(t + 2.8, middle + near, 0)
    giver.go(t + 3.1, middle + near + up, 0)
    taker.wait(t + 1.1)
    taker.go(t + 1.9, middle + far + up, 0)
    taker.go(t + 2.3, middle + far, 1)
    taker.go(t + 2.9, middle + far, 1)
    taker.go(t + 3.5, target + rest + far + up, 1)
    taker.go(t + 3.9, target + rest + far, 0)
    taker.go(t + 4.1, target + rest + far, 0)
    taker.go(t + 4.4, target + rest + far + up, 0)


def transfer():
    left, right, places, t = Hand("left"), Hand("right"), pegs(), 0.0
    inner = places[3:6] + places[:3]
    for giver, taker, way in ((left, right, zip(inner, places[6:])), (right, left, zip(places[6:], inner))):
        for here, there in way:
            carry(giver, taker, t, here, there)
            t += 3.7
        t += 0.8
    left.leave(t + 0.8)
    right.leave(t + 0.8)
    return left, right, t + 0.8


def fall():
    """The ring is let go on its way to the other hand."""
    left, right = Hand("left"), Hand("right")
    carry(left, Hand("right"), 0.0, pegs()[3], pegs()[6])
    left.rows = [r if r[0] < 2.0 else (r[0], r[1], 0) for r in left.rows if r[0] < 2.2]
    left.leave(4.0)
    right.leave(4.0)
    return left, right, 4.0


def track(left, right, end):
    lines = ["spore-track 1"]
    for name, hand in (("left", left), ("right", right)):
        lines.append("device " + name)
        for n in range(round(RATE_HZ * end) + 1):
            place, closed = hand.at(n / RATE_HZ)
            lines.append("%.2f %.6f %.6f %.6f %.6f %.6f %.6f %.6f 0 %d" % (
                n / RATE_HZ, *place, *turn_of(place, hand.entry), closed))
    return "\n".join(lines) + "\n"


def main():
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(exist_ok=True)
    check_closed(ring()[1])
    write_off(folder, "ring", ring())
    write_off(folder, "board", board())
    for name, rows in zip(("board", "ring"), spheres()):
        write_rows(folder / (name + ".spheres"), rows, "# x y z r, in metres")
    (folder / "exercise-peg-transfer.track").write_text(track(*transfer()))
    (folder / "fall.track").write_text(track(*fall()))


if __name__ == "__main__":
    main()
