#!/usr/bin/python3
"""Makes the right fallopian tube with the fold of peritoneum that it hangs on, as one surface for a net of springs: the
hollow tube, and a sheet from its lower side to where the fold is rooted; and the recorded input of its removal. Frame
and units are those of make_organs.py.

    make_adnexa.py FOLDER
"""
import pathlib
import sys

import numpy as np

from make_organs import tube_path, write_off
from make_tissue import write_rows
from make_tracks import LEFT, RIGHT, UPPER_LEFT, UPPER_RIGHT, aim, track

SECTORS, RINGS, ROWS = 8, 36, 5  # around the tube, along it, and of the fold below it
ROOTED = 0.84  # of the tube's length: its fimbrial end is free
MIDDLE = np.array([0.055, 0.015, 0.000])  # what the tube winds about
FOLD = 0.0250  # m, from the middle of the tube to the fold's root

# Of the removal: times (s), places where instruments wait, and where they work: ring of the tube, m below its middle;
# cuts either part the tube or run along it, through the fold.
CUT, FREE, END = 7.6, 16.8, 22.2
ASIDE = (0.085, 0.045, 0.090), (0.080, 0.090, 0.080)
BURNS = (2, 0.0), (5, 0.009), (11, 0.009), (17, 0.009), (23, 0.009)
CUTS = (2.5, 0.0, False), (3.0, 0.0, False), (2.5, 0.006, False), (3.0, 0.006, False), *((ring + 0.5, 0.0, True) for ring in range(0, 31, 3))


def even_path():
    path = tube_path(1)
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    s = np.linspace(0, 1, RINGS)
    return s, np.stack([np.interp(s * length[-1], length, path[:, k]) for k in range(3)], 1)


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def radius(s):
    """Isthmus, ampulla, funnel."""
    return 0.0024 + 0.0026 * np.clip((s - 0.25) / 0.5, 0, 1) ** 1.3 + 0.0034 * np.clip((s - 0.90) / 0.10, 0, 1) ** 1.5


def directions(path):
    """Along the tube, and across it toward what it winds about."""
    along = unit(np.gradient(path, axis=0))
    down = MIDDLE - path
    return along, unit(down - along * (down * along).sum(1, keepdims=True))


def adnexa():
    """Vertices, triangles, and those vertices where the fold is rooted."""
    s, path = even_path()
    along, down = directions(path)
    side = np.cross(along, down)
    wind = 0.0012 * (4 * s * (1 - s))[:, None] * np.stack([0.3 * np.sin(31 * s), np.sin(27 * s), np.cos(23 * s)], 1)
    turn = 2 * np.pi * np.arange(SECTORS) / SECTORS
    fringe = np.where(np.arange(SECTORS) % 2, -0.0016, 0.0014)  # of the last ring: fimbriae
    reach = np.repeat(radius(s)[:, None], SECTORS, 1)
    reach[-1] += fringe
    vertices = (path + wind)[:, None] + reach[..., None] * (np.cos(turn)[:, None] * down[:, None] + np.sin(turn)[:, None] * side[:, None])
    vertices[-1] += fringe[:, None] * along[-1]
    ring = np.arange(RINGS * SECTORS).reshape(RINGS, SECTORS)
    a, b, c, d = ring[:-1], np.roll(ring, -1, 1)[:-1], np.roll(ring, -1, 1)[1:], ring[1:]
    triangles = [np.stack([a, d, c], -1).reshape(-1, 3), np.stack([a, c, b], -1).reshape(-1, 3)]
    columns = int(ROOTED * RINGS)
    root = path[:columns] + FOLD * down[:columns]
    share = (np.arange(ROWS) + 1)[:, None, None] / ROWS
    fold = vertices[:columns, 0] * (1 - share) + root * share
    sheet = np.concatenate([ring[None, :columns, 0], RINGS * SECTORS + np.arange(ROWS * columns).reshape(ROWS, columns)])
    a, b, c, d = sheet[:-1, :-1], sheet[:-1, 1:], sheet[1:, 1:], sheet[1:, :-1]
    triangles += [np.stack([a, d, c], -1).reshape(-1, 3), np.stack([a, c, b], -1).reshape(-1, 3)]
    return np.concatenate([vertices.reshape(-1, 3), fold.reshape(-1, 3)]), np.concatenate(triangles), sheet[-1]


def reach(ring, below, entry, ahead, across=False):
    """An instrument from its place of entry to a point below the middle of a ring of the tube: the place of its hinge,
    `ahead` of that point; how far it is turned, for its hinge to lie along the tube, or across it; and its way in."""
    _, path = even_path()
    place, along, down = (np.array([np.interp(ring, range(RINGS), x) for x in d.T]) for d in (path, *directions(path)))
    point = place + below * down
    inward = unit(np.asarray(entry) - point)
    w, x, y = aim(point + ahead * inward, entry)
    axes = np.array([[1 - 2 * y * y, 2 * x * y, -2 * w * y], [2 * x * y, 1 - 2 * x * x, 2 * w * x]])
    turn = np.arctan2(*reversed(axes @ along)) + (np.pi / 2 if across else 0)
    return point + ahead * inward, (turn + np.pi / 2) % np.pi - np.pi / 2, inward


def between_rows(ring):
    """Where the fold is cut, below the middle of the tube: between its first two rows."""
    side = radius(ring / (RINGS - 1))
    return side + 1.5 / ROWS * (FOLD - side)


def rest(begin, end, place):
    return [(begin, *place, 0, 0), (end, *place, 0, 0)]


def grasp():
    """Takes the tube, draws it up, and once it is free carries it into the bag."""
    hinge, turn, inward = reach(17, 0, UPPER_LEFT, 0.0115)
    held, up = hinge + [-0.001, 0.004, 0.003], hinge + [-0.021, 0.049, 0.033]
    rows = [(0.0, hinge + 0.06 * inward, 0), (0.9, hinge + 0.02 * inward, 0), (1.3, hinge, 0), (1.4, hinge, 1), (1.9, hinge, 1),
            (2.4, held, 1), (FREE, held, 1), (FREE + 1.2, up, 1), (FREE + 2.4, (-0.036, 0.105, 0.064), 1),
            (FREE + 3.4, (-0.032, 0.044, 0.066), 1), (FREE + 3.6, (-0.032, 0.044, 0.066), 0),
            (FREE + 4.0, (-0.032, 0.044, 0.066), 0), (FREE + 5.0, (-0.050, 0.110, 0.100), 0), (END, (-0.050, 0.110, 0.100), 0)]
    return [(t, *place, buttons, turn) for t, place, buttons in rows]


def coagulate():
    rows, t = rest(0.0, 2.2, ASIDE[0]), 2.2
    for ring, below in BURNS:
        point, _, inward = reach(ring, below, RIGHT, 0.0015)
        rows += [(t + 0.4, *(point + 0.012 * inward), 0, 0), (t + 0.6, *point, 1, 0), (t + 1.0, *point, 0, 0)]
        t += 1.0
    return rows + rest(t + 0.6, END, ASIDE[0])


def cut():
    rows, t = rest(0.0, CUT, ASIDE[1]), CUT
    for ring, below, across in CUTS:
        hinge, turn, inward = reach(ring, between_rows(ring) if across else below, UPPER_RIGHT, 0.011, across)
        rows += [(t + 0.25, *(hinge + 0.006 * inward), 0, turn), (t + 0.35, *hinge, 1, turn), (t + 0.55, *hinge, 0, turn)]
        t += 0.6
    return rows + rest(t + 0.6, END, ASIDE[1])


def main():
    folder = pathlib.Path(sys.argv[1])
    vertices, triangles, root = adnexa()
    write_off(folder, "adnexa", (vertices, triangles))
    size = np.where(np.arange(len(vertices)) < RINGS * SECTORS, 0.0016, 0.0012)
    write_rows(folder / "adnexa.spheres", np.column_stack([vertices, size]), "# x y z r, in metres")
    input_ = {"shaft": (UPPER_LEFT, grasp()), "forceps": (RIGHT, coagulate()), "scissors": (UPPER_RIGHT, cut()),
              "holder": (LEFT, [(0.0, -0.0300, 0.0329, 0.0851), (END, -0.0300, 0.0329, 0.0851)])}
    (folder / "exercise-salpingectomy.track").write_text(track(input_))


if __name__ == "__main__":
    main()
