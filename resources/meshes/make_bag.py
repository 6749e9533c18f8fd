#!/usr/bin/python3
"""Makes a retrieval bag, the wire ring that holds it open and its draw-string, all in the frame of the instrument that
brings them: tip of its tube at the origin, shaft along +z, mouth of the bag upward.

    make_bag.py FOLDER
"""
import pathlib
import sys

import numpy as np

from make_organs import turned, write_off
from make_tissue import write_rows

MOUTH = 0.0280  # m, radius
DEPTH = 0.0520
SIDE = 0.0068  # between the points of the film
CENTRE = np.array([0.0, 0.0, -0.0310])
THREAD = 0.0006  # radius of the draw-string
TAIL = 0.030  # of each of its ends, inside the tube


def profile(count):
    """(radius, depth) from the mouth down, evenly along the film: straight, and round below."""
    straight = DEPTH - MOUTH
    bend = np.linspace(0, np.pi / 2, 200)
    points = np.concatenate([[[MOUTH, 0]], np.stack([MOUTH * np.cos(bend), straight + MOUTH * np.sin(bend)], 1)])
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    even = np.linspace(0, length[-1], count)
    return np.stack([np.interp(even, length, points[:, k]) for k in range(2)], 1)


def zipped(a, b):
    """Triangles between two rings of points, given by number and turn (0..1), from the outer to the inner one."""
    triangles, i, k = [], 0, 0
    while i < len(a[0]) or k < len(b[0]):
        ahead_a = (a[1] + [a[1][0] + 1])[i + 1] if i < len(a[0]) else np.inf
        ahead_b = (b[1] + [b[1][0] + 1])[k + 1] if k < len(b[0]) else np.inf
        here_a, here_b = a[0][i % len(a[0])], b[0][k % len(b[0])]
        if ahead_a <= ahead_b:
            i += 1
            triangles.append([here_a, a[0][i % len(a[0])], here_b])
        else:
            k += 1
            triangles.append([here_a, b[0][k % len(b[0])], here_b])
    return triangles


def film():
    """Rings of points, as many as fit into each; every second one is turned by half a place where they are as many."""
    places = profile(round((DEPTH - MOUTH + np.pi / 2 * MOUTH) / SIDE) + 1)
    vertices, rings, turned_half = [], [], False
    for radius, depth in places[:-1]:
        count = max(5, 2 * round(np.pi * radius / SIDE))
        turn = [(n + 0.5 * turned_half) / count for n in range(count)]
        rings.append((list(range(len(vertices), len(vertices) + count)), turn))
        vertices += [CENTRE + [radius * np.sin(2 * np.pi * t), -depth, radius * np.cos(2 * np.pi * t)] for t in turn]
        turned_half = not turned_half
    triangles = [t for a, b in zip(rings, rings[1:]) for t in zipped(a, b)]
    last, bottom = rings[-1][0], len(vertices)
    vertices.append(CENTRE + [0, -places[-1][1], 0])
    triangles += [[last[n], last[(n + 1) % len(last)], bottom] for n in range(len(last))]
    return np.array(vertices), np.array(triangles), len(rings[0][0])


def ring():
    """Wire of 1.6 mm around the mouth, from the tube and back to it."""
    sectors, around, wire = 48, 10, 0.0008
    s, a = np.meshgrid(2 * np.pi * np.arange(sectors) / sectors, 2 * np.pi * np.arange(around) / around, indexing="ij")
    reach = MOUTH + 0.0012 + wire * np.cos(a)
    vertices = CENTRE + np.stack([reach * np.sin(s), wire * np.sin(a), reach * np.cos(s)], -1).reshape(-1, 3)
    i = np.arange(sectors * around).reshape(sectors, around)
    b, c = np.roll(i, -1, 0), np.roll(i, -1, 1)
    d = np.roll(b, -1, 1)
    return vertices, np.concatenate([np.stack([i, b, d], -1).reshape(-1, 3), np.stack([i, d, c], -1).reshape(-1, 3)])


def tube(radius=0.0035, length=0.26):
    """Shaft of the instrument, up to its tip."""
    return turned([(radius - 0.0008, 0.0), (radius - 0.0002, 0.0), (radius, 0.0006)] +
                  [(radius, z) for z in np.linspace(0.01, length - 0.0006, 20)] + [(radius - 0.0006, length)])


def draw_string(count):
    """Out of the tube, around the mouth through the hem, and back."""
    beside = 0.0012
    start = np.arcsin(beside / MOUTH)
    turn = np.linspace(start, 2 * np.pi - start, 200)
    loop = CENTRE + np.stack([MOUTH * np.sin(turn), 0 * turn, MOUTH * np.cos(turn)], 1)
    way = np.concatenate([[[beside, 0, TAIL]], loop, [[-beside, 0, TAIL]]])
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(way, axis=0), axis=1))])
    even = np.linspace(0, length[-1], count)
    return np.stack([np.interp(even, length, way[:, k]) for k in range(3)], 1)


def joined_parts(*parts):
    firsts = np.cumsum([0] + [len(v) for v, _ in parts])
    return np.concatenate([v for v, _ in parts]), np.concatenate([t + n for (_, t), n in zip(parts, firsts)])


def main():
    folder = pathlib.Path(sys.argv[1])
    vertices, triangles, rim = film()
    write_off(folder, "bag", (vertices, triangles))
    write_rows(folder / "bag.spheres", np.column_stack([vertices, np.full(len(vertices), 0.0010)]), "# x y z r, in metres")
    # For what is thin enough to go between the points: also in the middle of each triangle.
    dense = np.concatenate([vertices, vertices[triangles].mean(1)])
    write_rows(folder / "bag-dense.spheres", np.column_stack([dense, np.full(len(dense), 0.0010)]), "# x y z r, in metres")
    write_off(folder, "holder", joined_parts(tube(), ring()))
    string = draw_string(160)
    write_rows(folder / "draw-string.curve", np.column_stack([string, np.full(len(string), THREAD)]), "# x y z r, in metres")
    stop = np.arange(0.0035, 0.070, 0.003)  # along the tube: the film is not drawn into it
    wire = [CENTRE + [(MOUTH + 0.002) * np.sin(a), 0, (MOUTH + 0.002) * np.cos(a)] for a in 2 * np.pi * (np.arange(24) + 0.5) / 24]
    spheres = [(0, 0, z, 0.0035) for z in stop] + [(*p, 0.0008) for p in wire]
    write_rows(folder / "holder.spheres", spheres, "# x y z r, in metres")
    print(f"bag: {len(vertices)} points, {rim} of them along the rim")


if __name__ == "__main__":
    main()
