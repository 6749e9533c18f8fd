"""Small meshes for the end-to-end tests, made here so that they need no file."""
import math
import struct


def sphere(radius=0.03, rings=12, sectors=24, centre=(0.0, 0.0, 0.0)):
    """Closed, outward triangles of a sphere: (vertices, triangles)."""
    vertices = [(centre[0], centre[1] + radius, centre[2])]
    for ring in range(1, rings):
        polar = math.pi * ring / rings
        for sector in range(sectors):
            turn = 2 * math.pi * sector / sectors
            vertices.append((centre[0] + radius * math.sin(polar) * math.cos(turn), centre[1] + radius * math.cos(polar),
                             centre[2] + radius * math.sin(polar) * math.sin(turn)))
    vertices.append((centre[0], centre[1] - radius, centre[2]))
    at = lambda ring, sector: 1 + (ring - 1) * sectors + sector % sectors
    triangles = [(0, at(1, s + 1), at(1, s)) for s in range(sectors)]
    for ring in range(1, rings - 1):
        for s in range(sectors):
            triangles += [(at(ring, s), at(ring, s + 1), at(ring + 1, s)),
                          (at(ring, s + 1), at(ring + 1, s + 1), at(ring + 1, s))]
    last = len(vertices) - 1
    triangles += [(last, at(rings - 1, s), at(rings - 1, s + 1)) for s in range(sectors)]
    return vertices, triangles


def off(vertices, triangles):
    """OFF text."""
    lines = ["OFF", f"{len(vertices)} {len(triangles)} 0"]
    lines += ["%.9g %.9g %.9g" % v for v in vertices]
    lines += ["3 %d %d %d" % t for t in triangles]
    return ("\n".join(lines) + "\n").encode()


def stl(vertices, triangles):
    """Binary STL."""
    out = [b"binary stl".ljust(80, b"\0"), struct.pack("<I", len(triangles))]
    for t in triangles:
        out.append(struct.pack("<12fH", 0, 0, 0, *(x for i in t for x in vertices[i]), 0))
    return b"".join(out)
