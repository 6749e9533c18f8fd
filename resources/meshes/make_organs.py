#!/usr/bin/python3
"""Makes the organs and instruments of the shipped scenes: closed OFF surfaces in metres, and the pelvic wall as an open one.

Each organ is a signed distance field (smooth unions of ellipsoids and tapered capsules), meshed by surface nets, then
relaxed along the surface so that triangles are even. All stand in one frame, that of the scene: x to the right, y up,
z toward the viewer, who looks at the back of the womb from above, as through a laparoscope. Sizes are those of an
adult. Nothing is random from run to run. Needs numpy; neither build nor tests run it.

    make_organs.py ORGANS INSTRUMENTS
"""
import os
import sys

import numpy as np

# Distance fields. Points are arrays (n, 3); a field gives n distances, negative inside.


def smooth_union(a, b, width):
    h = np.clip(0.5 + 0.5 * (b - a) / width, 0, 1)
    return b + (a - b) * h - width * h * (1 - h)


def ellipsoid(p, centre, radii):
    q = (p - centre) / radii
    k0 = np.linalg.norm(q, axis=1)
    k1 = np.linalg.norm(q / radii, axis=1)
    return k0 * (k0 - 1) / np.maximum(k1, 1e-9)


def capsule(p, a, b, radius_a, radius_b):
    a, b = np.asarray(a, float), np.asarray(b, float)
    along = b - a
    t = np.clip((p - a) @ along / (along @ along), 0, 1)
    return np.linalg.norm(p - a - t[:, None] * along, axis=1) - (radius_a + t * (radius_b - radius_a))


def chain(p, points, radii, width):
    distance = None
    for i in range(len(points) - 1):
        piece = capsule(p, points[i], points[i + 1], radii[i], radii[i + 1])
        distance = piece if distance is None else smooth_union(distance, piece, width)
    return distance


def hash_noise(cell):
    h = (cell[:, 0] * 73856093) ^ (cell[:, 1] * 19349663) ^ (cell[:, 2] * 83492791)
    h = (h ^ (h >> 13)) * 1274126177
    return ((h ^ (h >> 16)) & 0xFFFF) / 65535.0


def noise(p, size):
    """Smooth value noise in -1..1."""
    q = p / size + 100.0
    cell = np.floor(q).astype(np.int64)
    f = q - cell
    w = f * f * f * (f * (6 * f - 15) + 10)
    total = np.zeros(len(p))
    for corner in range(8):
        d = np.array([corner & 1, corner >> 1 & 1, corner >> 2])
        weight = np.prod(np.where(d, w, 1 - w), axis=1)
        total += weight * hash_noise(cell + d)
    return 2 * total - 1


def spline(knots, count):
    """Catmull-Rom curve through knots."""
    k = np.asarray(knots, float)
    k = np.vstack([2 * k[0] - k[1], k, 2 * k[-1] - k[-2]])
    s = np.linspace(0, len(k) - 3, count)
    i = np.minimum(s.astype(int), len(k) - 4)
    t = (s - i)[:, None]
    a, b, c, d = k[i], k[i + 1], k[i + 2], k[i + 3]
    return 0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t**2 + (3 * b - a - 3 * c + d) * t**3)


# Meshing.


def join_diagonals(value):
    """Where two inner samples touch only across a square's diagonal, four sheets would share an edge: one of the two
    outer samples is taken in."""
    while True:
        inside, taken = value < 0, np.zeros(value.shape, bool)
        for axis in range(3):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            here, beside, above = inside, np.roll(inside, -1, u), np.roll(inside, -1, v)
            across = np.roll(beside, -1, v)
            taken |= np.roll(here & across & ~beside & ~above, 1, u)
            taken |= np.roll(~here & ~across & beside & above, (1, 1), (u, v))
        taken &= ~inside
        if not taken.any():
            return value
        value = np.where(taken, -1e-7, value)


def surface_nets(field, lower, upper, step):
    """One vertex a cell that the surface crosses, one quadrilateral a grid edge that it crosses (Gibson 1998)."""
    axes = [np.arange(lo - 2 * step, up + 3 * step, step) for lo, up in zip(lower, upper)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), -1)
    value = join_diagonals(field(grid.reshape(-1, 3)).reshape(grid.shape[:3]))
    inside = value < 0
    nx, ny, nz = (n - 1 for n in inside.shape)
    corners = [(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    count = sum(inside[i : i + nx, j : j + ny, k : k + nz].astype(int) for i, j, k in corners)
    active = (count > 0) & (count < 8)
    index = np.full(active.shape, -1)
    index[active] = np.arange(active.sum())
    cells = np.argwhere(active)
    total, crossings = np.zeros((len(cells), 3)), np.zeros(len(cells))
    for a in corners:
        for axis in range(3):
            if a[axis]:
                continue
            b = tuple(c + (n == axis) for n, c in enumerate(a))
            va, vb = value[tuple((cells + a).T)], value[tuple((cells + b).T)]
            cut = (va < 0) != (vb < 0)
            t = np.where(cut, va / np.where(cut, va - vb, 1), 0)
            place = np.asarray(a, float) + t[:, None] * (np.asarray(b) - np.asarray(a))
            total += np.where(cut[:, None], place, 0)
            crossings += cut
    origin = np.array([axis[0] for axis in axes])
    vertices = origin + step * (cells + total / crossings[:, None])
    quads = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        ahead = np.roll(inside, -1, axis)
        cut = np.argwhere(inside != ahead)
        cut = cut[(cut[:, u] > 0) & (cut[:, v] > 0) & (cut[:, axis] < inside.shape[axis] - 1)]
        du, dv = np.eye(3, dtype=int)[u], np.eye(3, dtype=int)[v]
        quad = np.stack([index[tuple((cut - o).T)] for o in (du + dv, dv, 0 * du, du)], 1)
        outward = inside[tuple(cut.T)]
        quads.append(np.where(outward[:, None], quad, quad[:, ::-1]))
    return vertices, split(vertices, np.concatenate(quads))


def split(vertices, quads):
    """Two triangles a quadrilateral, along its shorter diagonal."""
    v = vertices[quads]
    other = np.linalg.norm(v[:, 0] - v[:, 2], axis=1) > np.linalg.norm(v[:, 1] - v[:, 3], axis=1)
    q = np.where(other[:, None], np.roll(quads, -1, axis=1), quads)
    return np.concatenate([q[:, [0, 1, 2]], q[:, [0, 2, 3]]])


def gradient(field, p, h=2e-5):
    return np.stack([(field(p + h * e) - field(p - h * e)) / (2 * h) for e in np.eye(3)], 1)


def relax(field, vertices, triangles, rounds, step):
    """Moves each vertex toward the middle of its neighbours, then back onto the surface."""
    edges = np.unique(np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
    degree = np.bincount(edges.ravel(), minlength=len(vertices))
    for _ in range(rounds):
        middle = np.zeros_like(vertices)
        np.add.at(middle, edges[:, 0], vertices[edges[:, 1]])
        np.add.at(middle, edges[:, 1], vertices[edges[:, 0]])
        vertices = vertices + 0.6 * (middle / degree[:, None] - vertices)
        for _ in range(2):
            g = gradient(field, vertices)
            move = field(vertices)[:, None] * g / np.maximum((g * g).sum(1), 0.05)[:, None]
            length = np.linalg.norm(move, axis=1, keepdims=True)
            vertices = vertices - move * np.minimum(1, step / np.maximum(length, 1e-12))
    return vertices


def organ(field, lower, upper, step, rounds=14):
    vertices, triangles = surface_nets(field, lower, upper, step)
    check_closed(triangles)
    return relax(field, vertices, triangles, rounds, 0.5 * step), triangles


def check_closed(triangles):
    """Each edge once in each direction."""
    directed = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    pairs, times = np.unique(directed, axis=0, return_counts=True)
    if times.max() > 1 or not np.array_equal(pairs, np.unique(pairs[:, ::-1], axis=0)):
        raise SystemExit("a surface is not closed")


# The pelvis. Lengths in metres.

LEAN = np.radians(-24)  # the womb leans forward, away from the viewer


def lean(point):
    x, y, z = point
    return np.array([x, y * np.cos(LEAN) - z * np.sin(LEAN), y * np.sin(LEAN) + z * np.cos(LEAN)])


def upright(p):
    c, s = np.cos(LEAN), np.sin(LEAN)
    return np.stack([p[:, 0], c * p[:, 1] + s * p[:, 2], -s * p[:, 1] + c * p[:, 2]], 1)


OVARY = {-1: np.array([-0.0545, 0.0135, 0.0085]), 1: np.array([0.0550, 0.0120, 0.0095])}


def ovary_frame(side):
    """Long axis outward and a little down; thickness toward the viewer."""
    along = np.array([side * 0.90, -0.30 if side > 0 else -0.24, 0.24])
    along /= np.linalg.norm(along)
    thick = np.array([0.0, 0.35, 1.0])
    thick -= along * (thick @ along)
    thick /= np.linalg.norm(thick)
    return np.stack([along, np.cross(thick, along), thick])


def uterus(p):
    """Pear of body and neck, 8 cm long: fundus above, horns to both sides, neck below with its mouth."""
    q = upright(p)
    d = ellipsoid(q, [0, 0.022, 0.001], [0.0245, 0.026, 0.0175])
    d = smooth_union(d, ellipsoid(q, [0, 0.036, 0.000], [0.0275, 0.0150, 0.0160]), 0.010)
    d = smooth_union(d, capsule(q, [0, 0.010, 0], [0, -0.012, 0.001], 0.0150, 0.0110), 0.012)
    d = smooth_union(d, capsule(q, [0, -0.012, 0.001], [0, -0.034, 0.003], 0.0112, 0.0128), 0.006)
    for side in (-1, 1):
        horn = chain(q, [[side * 0.016, 0.036, 0], [side * 0.028, 0.0400, 0], [side * 0.0375, 0.0405, 0.001]],
                     [0.0105, 0.0062, 0.0034], 0.006)
        d = smooth_union(d, horn, 0.007)
        pole = OVARY[side] - 0.0203 * ovary_frame(side)[0]
        root, middle = lean([side * 0.020, 0.029, 0.008]), 0.5 * lean([side * 0.022, 0.030, 0.011]) + 0.5 * pole
        cord = chain(p, [root, middle + [0, 0.0015, 0.002], pole], [0.0042, 0.0031, 0.0026], 0.004)
        d = smooth_union(d, cord, 0.005)
        round_cord = chain(q, [[side * 0.020, 0.034, -0.008], [side * 0.036, 0.030, -0.020], [side * 0.055, 0.030, -0.030]],
                           [0.0045, 0.0030, 0.0026], 0.004)
        d = smooth_union(d, round_cord, 0.006)
    mouth = capsule(q, [-0.004, -0.0475, 0.003], [0.004, -0.0475, 0.003], 0.0022, 0.0022)
    d = -smooth_union(-d, mouth, 0.003)
    d = d + 0.0006 * noise(q, 0.011) + 0.0003 * noise(q + 3, 0.0055)
    # A faint furrow along the middle of the fundus.
    return d + 0.0006 * np.exp(-(q[:, 0] / 0.004) ** 2) * np.clip(q[:, 1] / 0.05, 0, 1)


def ovary(p, side):
    """Almond of 38 x 21 x 15 mm, flatter at its hilum, with follicles that bulge."""
    q = (p - OVARY[side]) @ ovary_frame(side).T
    d = ellipsoid(q, [0, 0, 0], [0.0190, 0.0104, 0.0075])
    d = smooth_union(d, ellipsoid(q, [0.003, -0.0015, 0.0005], [0.0145, 0.0098, 0.0080]), 0.004)
    turn = np.arange(15) * 2.39996 + (0.7 if side > 0 else 2.1)
    height = 0.92 - (np.arange(15) + 0.5) * 1.84 / 15
    for i in range(15):
        ring = np.sqrt(1 - height[i] ** 2)
        place = np.array([height[i] * 0.0165, ring * np.cos(turn[i]) * 0.0088, ring * np.sin(turn[i]) * 0.0064])
        size = 0.0024 + 0.0016 * ((i * 7 + (side > 0) * 3) % 5) / 4
        d = smooth_union(d, np.linalg.norm(q - place, axis=1) - size, 0.0026)
    return d + 0.00035 * noise(q, 0.0042) + 0.0002 * noise(q + 1, 0.0021)


def tube_path(side):
    """From the womb's horn outward, over the ovary, and round its outer end."""
    horn = lean([side * 0.0360, 0.0405, 0.001])
    drop = 0.0 if side < 0 else -0.0015
    return spline([horn, [side * 0.050, 0.0415, -0.0120], [side * 0.066, 0.0400 + drop, -0.0060],
                   [side * 0.0800, 0.0290 + drop, 0.0035], [side * 0.0835, 0.0130, 0.0110],
                   [side * 0.0770, 0.0000, 0.0165]], 34)


def tube(p, side):
    """Fallopian tube: narrow isthmus, winding ampulla, funnel with fimbriae."""
    path = tube_path(side)
    s = np.linspace(0, 1, len(path))
    path = path + 0.0016 * np.stack([0.3 * np.sin(31 * s), np.sin(27 * s), np.cos(23 * s)], 1) * (s * (1 - s))[:, None] * 4
    radii = 0.0024 + 0.0026 * np.clip((s - 0.25) / 0.5, 0, 1) ** 1.3 + 0.0012 * np.clip((s - 0.86) / 0.14, 0, 1)
    d = chain(p, path, radii, 0.0016)
    end, outward = path[-1], path[-1] - path[-3]
    outward /= np.linalg.norm(outward)
    right = np.cross(outward, [0, 0, 1.0])
    right /= np.linalg.norm(right)
    up = np.cross(right, outward)
    for i in range(9):
        angle = 2 * np.pi * i / 9 + 0.3
        flare = np.cos(angle) * right + np.sin(angle) * up
        reach = 1 + 0.25 * np.sin(5.1 * i)
        root = end + 0.0036 * flare - 0.001 * outward
        knee = end + 0.0072 * flare + 0.0028 * reach * outward
        tip = knee + 0.0028 * reach * flare + 0.0018 * np.sin(3.3 * i) * up - 0.0006 * outward
        d = smooth_union(d, chain(p, [root, knee, tip], [0.0021, 0.0017, 0.0013], 0.001), 0.0012)
    funnel = np.linalg.norm(p - (end + 0.0065 * outward), axis=1) - 0.0042
    d = -smooth_union(-d, funnel, 0.0012)
    return d + 0.0003 * noise(p, 0.004)


def sheet(rows, columns, place):
    """Open surface from place(u, v), both 0..1; front side toward the viewer."""
    v, u = np.meshgrid(np.linspace(0, 1, rows), np.linspace(0, 1, columns), indexing="ij")
    vertices = place(u.ravel(), v.ravel())
    i = np.arange(rows * columns).reshape(rows, columns)
    quads = np.stack([i[:-1, :-1], i[:-1, 1:], i[1:, 1:], i[1:, :-1]], -1).reshape(-1, 4)
    return vertices, split(vertices, quads)


def wall(u, v):
    """Peritoneum of the pelvis: floor in front, pouch below the womb, back wall, sides that come forward."""
    profile = spline([[0.020, 0.190], [-0.030, 0.165], [-0.064, 0.120], [-0.073, 0.082], [-0.070, 0.050],
                      [-0.066, 0.018], [-0.056, -0.006], [-0.034, -0.018], [0.000, -0.021], [0.032, -0.032],
                      [0.062, -0.056], [0.082, -0.086], [0.090, -0.110]], 400)
    at = np.minimum((v * 399).astype(int), 398)
    t = (v * 399 - at)[:, None]
    yz = profile[at] * (1 - t) + profile[at + 1] * t  # z first
    z, y = yz.T
    x = (2 * u - 1) * 0.150
    bend = (np.abs(x) / 0.150) ** 2.6
    floor = np.clip((0.02 - y) / 0.06, 0, 1)
    p = np.stack([x, y + 0.040 * bend * floor, z + 0.105 * bend * (1 - 0.4 * floor)], 1)
    folds = 0.0050 * noise(p * [1.0, 1.4, 1.4], 0.034) + 0.0024 * noise(p + 7, 0.015) + 0.0009 * noise(p + 2, 0.007)
    normal = np.stack([-np.sign(x) * 0.5 * bend, 0.45 + 0 * x, 0.9 + 0 * x], 1)
    p += folds[:, None] * normal / np.linalg.norm(normal, axis=1, keepdims=True)
    p[:, 1] += 0.011 * np.exp(-((p[:, 0] / 0.030) ** 2) - ((p[:, 2] - 0.020) / 0.022) ** 2)  # the neck lies embedded
    p[:, 1] -= 0.015 * np.exp(-(((np.abs(p[:, 0]) - 0.036) / 0.020) ** 2) - ((p[:, 2] - 0.030) / 0.020) ** 2)  # a hollow on either side
    # The bladder bulges before the womb, seen above it.
    dome = np.exp(-((p[:, 0] / 0.050) ** 2) - ((p[:, 1] - 0.078) / 0.024) ** 2)
    p[:, 2] += 0.022 * dome
    return p


def ligament_place(side, short=10, reach=0.074):
    """Of the fold of peritoneum between tube and floor: along the tube, but for the last points of its path, and down."""
    path = tube_path(side)

    def place(u, v):
        at = u * (len(path) - short)
        i = np.minimum(at.astype(int), len(path) - 2)
        t = (at - i)[:, None]
        top = path[i] * (1 - t) + path[i + 1] * t - [0, 0.0008, 0.0012]
        bottom = np.stack([side * (0.016 + reach * u), -0.030 + 0.004 * np.sin(9 * u), -0.022 - 0.028 * u * (1 - u)], 1)
        p = top * (1 - v[:, None]) + bottom * v[:, None]
        p[:, 2] += -0.010 * np.sin(np.pi * v) + 0.0016 * np.sin(np.pi * v) * noise(p + 4, 0.013)
        return p

    return place


def broad_ligament(side):
    vertices, triangles = sheet(20, 26, ligament_place(side))
    return vertices, triangles if side < 0 else triangles[:, ::-1]


def joined(parts):
    vertices, triangles, first = [], [], 0
    for v, t in parts:
        vertices.append(v)
        triangles.append(t + first)
        first += len(v)
    return np.concatenate(vertices), np.concatenate(triangles)


def probe():
    """Blunt rod of 5 mm with a ring each centimetre near its tip."""
    radius, length = 0.0025, 0.26
    profile = [(radius * np.sin(a), radius * (1 - np.cos(a))) for a in np.linspace(0, np.pi / 2, 7)[1:]]
    for ring in np.arange(0.01, 0.085, 0.01):
        profile += [(radius, ring - 0.0005), (radius - 0.0003, ring - 0.0003), (radius - 0.0003, ring + 0.0003),
                    (radius, ring + 0.0005)]
    return turned(profile + [(radius, z) for z in np.linspace(0.09, length - 0.0006, 15)] + [(radius - 0.0006, length)])


def jaw():
    """One jaw of a clamp, 18 mm long, along -z from the hinge at the origin, on the side of +y."""
    vertices, triangles = turned([(0.0008, 0.0), (0.0015, 0.0006), (0.0015, 0.0170), (0.0009, 0.0180)])
    return vertices * [1, 1, -1] + [0, 0.0015, 0], triangles[:, ::-1]


def endoscope():
    """Tube of 10 mm: a pane of glass, set back in a bevelled rim, and a smooth shaft."""
    radius, length = 0.005, 0.30
    profile = [(0.0032, 0.0006), (0.0034, 0.0), (0.0046, 0.0), (radius, 0.0004)]
    return turned(profile + [(radius, z) for z in np.linspace(0.01, length - 0.0006, 24)] + [(radius - 0.0006, length)])


def turned(profile, sectors=20):
    """What a profile of (radius, z) sweeps about z, closed at both ends. The tip is the origin; the shaft runs along +z."""
    length, front = profile[-1][1], profile[0][1] if profile[1][1] < profile[0][1] else 0
    turn = np.arange(sectors) * 2 * np.pi / sectors
    rings = [np.stack([r * np.cos(turn), r * np.sin(turn), 0 * turn + z], 1) for r, z in profile]
    vertices = np.concatenate([[[0, 0, front]]] + rings + [[[0, 0, length]]])
    last, triangles = len(vertices) - 1, []
    for s in range(sectors):
        n = (s + 1) % sectors
        triangles += [[0, 1 + n, 1 + s]]
        for k in range(len(rings) - 1):
            a, b = 1 + k * sectors, 1 + (k + 1) * sectors
            triangles += [[a + s, a + n, b + n], [a + s, b + n, b + s]]
        end = 1 + (len(rings) - 1) * sectors
        triangles += [[end + s, end + n, last]]
    triangles = np.array(triangles)
    return vertices, triangles


def write_off(folder, name, mesh):
    vertices, triangles = mesh
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, name + ".off")
    with open(path, "w") as out:
        out.write(f"OFF\n{len(vertices)} {len(triangles)} 0\n")
        out.writelines("%.6g %.6g %.6g\n" % tuple(np.round(v, 7)) for v in vertices)
        out.writelines("3 %d %d %d\n" % tuple(t) for t in triangles)
    v = vertices[triangles]
    volume = np.einsum("ij,ij->i", v[:, 0], np.cross(v[:, 1], v[:, 2])).sum() / 6
    size = 1000 * (vertices.max(0) - vertices.min(0))
    print(f"{name}: {len(triangles)} triangles, {size[0]:.0f} x {size[1]:.0f} x {size[2]:.0f} mm, {1e6 * volume:.1f} ml")


def main():
    folder, instruments = sys.argv[1:]
    write_off(folder, "uterus", organ(uterus, [-0.062, -0.055, -0.055], [0.062, 0.060, 0.035], 0.0027))
    for side, name in ((-1, "left"), (1, "right")):
        box = OVARY[side]
        write_off(folder, "ovary_" + name,
                  organ(lambda p: ovary(p, side), box - 0.024, box + 0.024, 0.0014))
        write_off(folder, "ovary_" + name + "_coarse",
                  organ(lambda p: ovary(p, side), box - 0.024, box + 0.024, 0.0033))
        path = tube_path(side)
        write_off(folder, "tube_" + name,
                  organ(lambda p: tube(p, side), path.min(0) - 0.016, path.max(0) + 0.016, 0.0014, 8))
    write_off(folder, "pelvis", sheet(64, 90, wall))
    write_off(folder, "peritoneum", joined([sheet(64, 90, wall), broad_ligament(-1), broad_ligament(1)]))
    write_off(instruments, "probe", probe())
    write_off(instruments, "endoscope", endoscope())
    vertices, triangles = jaw()
    write_off(instruments, "jaw_upper", (vertices, triangles))
    write_off(instruments, "jaw_lower", (vertices * [1, -1, 1], triangles[:, ::-1]))


if __name__ == "__main__":
    main()
