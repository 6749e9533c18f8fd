"""Small meshes for the end-to-end tests, made here so that they need no file."""
import base64
import gzip
import json
import math
import struct
import zlib


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


def heavy(across=360, size=0.1):
    """A sheet of about 258,000 triangles, more than the import lets pass without a word: STL."""
    steps = [size * i / across for i in range(across + 1)]
    head, foot = struct.pack("<3f", 0, 0, 1), b"\0\0"
    pack = struct.Struct("<9f").pack
    body = bytearray()
    for i in range(across):
        x, x1 = steps[i], steps[i + 1]
        for j in range(across):
            y, y1 = steps[j], steps[j + 1]
            body += head + pack(x, y, 0, x1, y, 0, x1, y1, 0) + foot + head + pack(x, y, 0, x1, y1, 0, x, y1, 0) + foot
    return bytes(80) + struct.pack("<I", 2 * across * across) + bytes(body)


def joined(*meshes):
    """Several meshes in one."""
    vertices, triangles = [], []
    for points, corners in meshes:
        triangles += [tuple(i + len(vertices) for i in t) for t in corners]
        vertices += points
    return vertices, triangles


def glb(**parts):
    """Binary glTF with a node of that name for each mesh, the last one mirrored in x by its node."""
    nodes, meshes, accessors, views, blob = [], [], [], [], b""
    for number, (name, (vertices, triangles)) in enumerate(parts.items()):
        points = b"".join(struct.pack("<3f", *v) for v in vertices)
        corners = b"".join(struct.pack("<3I", *t) for t in triangles)
        views += [{"buffer": 0, "byteOffset": len(blob), "byteLength": len(points)},
                  {"buffer": 0, "byteOffset": len(blob) + len(points), "byteLength": len(corners)}]
        accessors += [{"bufferView": 2 * number, "componentType": 5126, "count": len(vertices), "type": "VEC3",
                       "min": [min(v[k] for v in vertices) for k in range(3)], "max": [max(v[k] for v in vertices) for k in range(3)]},
                      {"bufferView": 2 * number + 1, "componentType": 5125, "count": 3 * len(triangles), "type": "SCALAR"}]
        meshes.append({"primitives": [{"attributes": {"POSITION": 2 * number}, "indices": 2 * number + 1}]})
        nodes.append({"name": name, "mesh": number, **({"scale": [-1, 1, 1]} if number == len(parts) - 1 else {})})
        blob += points + corners
    text = json.dumps({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes,
                       "meshes": meshes, "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(blob)}]}).encode()
    text += b" " * (-len(text) % 4)
    return (struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(blob)) + struct.pack("<I4s", len(text), b"JSON") + text +
            struct.pack("<I4s", len(blob), b"BIN\0") + blob)


def png(width, height, at):
    """RGB picture: at(x, y) gives three bytes."""
    rows = b"".join(b"\0" + b"".join(bytes(at(x, y)) for x in range(width)) for y in range(height))
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


# 8 x 8 pixels of red, as JPEG.
PHOTOGRAPH = base64.b64decode(
    "/9j/4AAQSkZJRgABAQAAAQABAAD/2wBDABALDA4MChAODQ4SERATGCgaGBYWGDEjJR0oOjM9PDkzODdASFxOQERXRTc4UG1RV19iZ2hnPk1xeXBkeFxlZ2P/"
    "2wBDARESEhgVGC8aGi9jQjhCY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2NjY2P/wAARCAAIAAgDASIAAhEBAxEB/8QA"
    "HwAAAQUBAQEBAQEAAAAAAAAAAAECAwQFBgcICQoL/8QAtRAAAgEDAwIEAwUFBAQAAAF9AQIDAAQRBRIhMUEGE1FhByJxFDKBkaEII0KxwRVS0fAkM2JyggkK"
    "FhcYGRolJicoKSo0NTY3ODk6Q0RFRkdISUpTVFVWV1hZWmNkZWZnaGlqc3R1dnd4eXqDhIWGh4iJipKTlJWWl5iZmqKjpKWmp6ipqrKztLW2t7i5usLDxMXG"
    "x8jJytLT1NXW19jZ2uHi4+Tl5ufo6erx8vP09fb3+Pn6/8QAHwEAAwEBAQEBAQEBAQAAAAAAAAECAwQFBgcICQoL/8QAtREAAgECBAQDBAcFBAQAAQJ3AAEC"
    "AxEEBSExBhJBUQdhcRMiMoEIFEKRobHBCSMzUvAVYnLRChYkNOEl8RcYGRomJygpKjU2Nzg5OkNERUZHSElKU1RVVldYWVpjZGVmZ2hpanN0dXZ3eHl6goOE"
    "hYaHiImKkpOUlZaXmJmaoqOkpaanqKmqsrO0tba3uLm6wsPExcbHyMnK0tPU1dbX2Nna4uPk5ebn6Onq8vP09fb3+Pn6/9oADAMBAAIRAxEAPwDGooorzz6Y"
    "/9k=")


def textured_gltf(vertices, triangles, picture, kind="image/png"):
    """glTF text of a mesh that wears the picture, laid over it from the front, all in one file."""
    low, high = [min(v[k] for v in vertices) for k in range(3)], [max(v[k] for v in vertices) for k in range(3)]
    places = [((v[0] - low[0]) / (high[0] - low[0]), (high[1] - v[1]) / (high[1] - low[1])) for v in vertices]
    pieces = [b"".join(struct.pack("<3f", *v) for v in vertices), b"".join(struct.pack("<2f", *p) for p in places),
              b"".join(struct.pack("<3I", *t) for t in triangles), picture]
    starts = [sum(map(len, pieces[:i])) for i in range(4)]
    data = lambda content: "data:application/octet-stream;base64," + base64.b64encode(content).decode()
    return json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"name": "worn", "mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}], "textures": [{"source": 0}],
        "images": [{"bufferView": 3, "mimeType": kind}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(vertices), "type": "VEC3", "min": low, "max": high},
                      {"bufferView": 1, "componentType": 5126, "count": len(vertices), "type": "VEC2"},
                      {"bufferView": 2, "componentType": 5125, "count": 3 * len(triangles), "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteOffset": start, "byteLength": len(piece)} for start, piece in zip(starts, pieces)],
        "buffers": [{"byteLength": sum(map(len, pieces)), "uri": data(b"".join(pieces))}]})


def seamed(vertices, triangles):
    """Places of the corners of a sphere's triangles in a map of it: three (u, v) of each, v from below; a seam runs down at z = 0."""
    places = []
    for triangle in triangles:
        points = [vertices[i] for i in triangle]
        turns = [math.atan2(p[2], p[0]) / (2 * math.pi) % 1 if abs(p[0]) + abs(p[2]) > 1e-9 else None for p in points]
        known = [u for u in turns if u is not None]
        wrapped = [u + 1 if u < 0.5 and max(known) - min(known) > 0.5 else u for u in known]
        turns = [wrapped.pop(0) if u is not None else None for u in turns]
        middle = sum(u for u in turns if u is not None) / len(known)
        places.append([(middle if u is None else u, 0.5 + math.asin(max(-1, min(1, p[1] / 0.03))) / math.pi) for u, p in zip(turns, points)])
    return places


def worn_obj(vertices, triangles, library, *materials):
    """OBJ text of a sphere with a map's places, whose triangles have the materials in turn, a hundred at a time."""
    lines = [f"mtllib {library}", "o worn"] + ["v %.9g %.9g %.9g" % v for v in vertices]
    lines += ["vt %.9g %.9g" % place for corners in seamed(vertices, triangles) for place in corners]
    for i, corners in enumerate(triangles):
        if i % 100 == 0:
            lines.append(f"usemtl {materials[i // 100 % len(materials)]}")
        lines.append("f " + " ".join(f"{corner + 1}/{3 * i + k + 1}" for k, corner in enumerate(corners)))
    return "\n".join(lines) + "\n"


def labels(size, label_at):
    """Bytes of a volume of uint8, the first index fastest: label_at(i, j, k)."""
    return bytes(label_at(i, j, k) for k in range(size[2]) for j in range(size[1]) for i in range(size[0]))


def nifti(size, voxels, spacing=(1, 1, 1), origin=(0, 0, 0), datatype=2, bits=8, sform=None, order="<"):
    """NIfTI-1 in one file, voxels in mm: sform rows, else qform without a turn."""
    rows = sform or [0] * 12
    head = struct.pack(order + "i35xB8h3f4h8f3fhBB4f2i", 348, 0, 3, *size, 1, 1, 1, 1, 0, 0, 0, 0, datatype, bits, 0, 1, *spacing, 0, 0, 0, 0,
                       352, 1, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0)
    head += struct.pack("80s24s", b"", b"") + struct.pack(order + "2h6f12f", 0 if sform else 1, 1 if sform else 0, 0, 0, 0, *origin, *rows)
    return head + struct.pack("16s4s4x", b"", b"n+1") + voxels


def nifti2(size, voxels, spacing=(1, 1, 1), origin=(0, 0, 0), sform=None, order="<", offset=544):
    """NIfTI-2 in one file of uint8, voxels in mm: sform rows, else qform without a turn."""
    head = struct.pack(order + "i8shh8q3d8dq", 540, b"n+2\0\r\n\x1a\n", 2, 8, 3, *size, 1, 1, 1, 1, 0, 0, 0, 1, *spacing, 0, 0, 0, 0, offset)
    head += struct.pack(order + "6d2q104x2i6d12d", *[0] * 6, 0, 0, 0 if sform else 1, 1 if sform else 0, 0, 0, 0, *origin, *(sform or [0] * 12))
    return head + struct.pack(order + "3i32x", 0, 2, 0) + bytes(4) + voxels


def nrrd(size, voxels, spacing=(1, 1, 1), origin=(0, 0, 0), space="left-posterior-superior", encoding="raw", **fields):
    """NRRD with attached data of uint8, in mm."""
    lines = {"type": "uint8", "dimension": "3", "space": space, "sizes": "%d %d %d" % tuple(size),
             "space directions": "(%g,0,0) (0,%g,0) (0,0,%g)" % tuple(spacing), "encoding": encoding,
             "space origin": "(%g,%g,%g)" % tuple(origin), **fields}
    text = "NRRD0004\n# made by a test\n" + "".join(f"{name}: {value}\n" for name, value in lines.items() if value is not None) + "\n"
    return text.encode() + (gzip.compress(voxels) if encoding == "gzip" else voxels)


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


def bar(along=8, across=2, length=0.08, width=0.02):
    """Medit text of a bar along x from the origin, six tetrahedra in each of along x across x across cells."""
    n = across + 1
    vertices = [(length * i / along, width * j / across, width * k / across)
                for i in range(along + 1) for j in range(n) for k in range(n)]
    paths = ((4, 6), (6, 2), (2, 3), (3, 1), (1, 5), (5, 4))
    tetrahedra = []
    for i in range(along):
        for j in range(across):
            for k in range(across):
                corner = [((i + (c >> 2)) * n + j + (c >> 1 & 1)) * n + k + (c & 1) for c in range(8)]
                tetrahedra += [(corner[0], corner[a], corner[b], corner[7]) for a, b in paths]
    lines = ["MeshVersionFormatted 2", "Dimension 3", "Vertices", str(len(vertices))]
    lines += ["%.9g %.9g %.9g 0" % v for v in vertices] + ["Tetrahedra", str(len(tetrahedra))]
    lines += ["%d %d %d %d 0" % tuple(i + 1 for i in t) for t in tetrahedra] + ["End"]
    return "\n".join(lines) + "\n"


def tube(radius=0.005, length=0.08, rings=16, sectors=16):
    """A closed straight tube along x."""
    vertices = [(length * i / rings, radius * math.cos(2 * math.pi * k / sectors), radius * math.sin(2 * math.pi * k / sectors))
                for i in range(rings + 1) for k in range(sectors)] + [(0, 0, 0), (length, 0, 0)]
    first, last, end = len(vertices) - 2, len(vertices) - 1, rings * sectors
    triangles = []
    for k in range(sectors):
        after = (k + 1) % sectors
        triangles += [(first, after, k), (last, end + k, end + after)]
        for a in range(0, end, sectors):
            triangles += [(a + k, a + after, a + sectors + after), (a + k, a + sectors + after, a + sectors + k)]
    return vertices, triangles
