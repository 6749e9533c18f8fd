"""Reads pictures and films as `spore render` writes them, apart from libpng and from any player."""
import math
import pathlib
import struct
import subprocess
import zlib

HOLDERS = {0x18538067, 0x1549A966, 0x1654AE6B, 0xAE, 0xE0, 0x55B0, 0x1C53BB6B, 0xBB, 0xB7, 0x1F43B675}  # elements of elements


def png(file):
    """Rows of bytes r g b of a PNG of 8 bits."""
    data, at, packed = pathlib.Path(file).read_bytes(), 8, b""
    assert data[:8] == b"\x89PNG\r\n\x1a\n" and data.endswith(b"IEND\xaeB`\x82"), file
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        content = data[at + 8:at + 8 + size]
        at += 12 + size
        if kind == b"IHDR":
            width, height, depth, colours = struct.unpack(">IIBB", content[:10])
            assert (depth, colours) == (8, 2)
        packed += content if kind == b"IDAT" else b""
    raw, rows, above = zlib.decompress(packed), [], bytes(3 * width)
    for y in range(height):
        way, line = raw[y * (3 * width + 1)], bytearray(raw[y * (3 * width + 1) + 1:(y + 1) * (3 * width + 1)])
        for i, value in enumerate(line):
            a, b, c = (line[i - 3], above[i], above[i - 3]) if i >= 3 else (0, above[i], 0)
            nearest = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
            line[i] = (value + (0, a, b, (a + b) // 2, nearest)[way]) & 255
        rows.append(bytes(line))
        above = line
    return rows


def elements(data, at, end, first):
    """(id, content or elements, where it begins) of the elements of a WebM file; sizes are those of `first`, the segment."""
    found = []
    while at < end:
        begin, length = at, 1
        while not data[at] >> (8 - length) & 1:
            length += 1
        name = int.from_bytes(data[at:at + length], "big")
        at += length
        length = 1
        while not data[at] >> (8 - length) & 1:
            length += 1
        size = int.from_bytes(data[at:at + length], "big") & ((1 << 7 * length) - 1)
        at += length
        assert at + size <= end, "an element is longer than what holds it"
        first = at if name == 0x18538067 else first
        content = elements(data, at, at + size, first) if name in HOLDERS else data[at:at + size]
        found.append((name, content, begin - first))
        at += size
    return found


class Film:
    """times: of the pictures, s; duration: s; size: pixels."""

    def __init__(self, file):
        data = pathlib.Path(file).read_bytes()
        head, segment = elements(data, 0, len(data), 0)
        assert head[0] == 0x1A45DFA3 and b"webm" in head[1]
        parts = {}
        for name, content, at in segment[1]:
            parts.setdefault(name, []).append((content, at))
        number = lambda content: int.from_bytes(content, "big")
        info = {name: content for name, content, _ in parts[0x1549A966][0][0]}
        scale = number(info[0x2AD7B1]) * 1e-9
        self.duration = struct.unpack(">d", info[0x4489])[0] * scale
        (_, entry, _), = parts[0x1654AE6B][0][0]
        track = {name: content for name, content, _ in entry}
        video = {name: content for name, content, _ in track[0xE0]}
        self.size = number(video[0xB0]), number(video[0xBA])
        assert track[0x86] == b"V_VP9" and number(track[0x83]) == 1
        self.times, starts = [], []
        for cluster, at in parts[0x1F43B675]:
            (name, content, _), *blocks = cluster
            assert name == 0xE7
            starts.append((number(content), at))
            for name, block, _ in blocks:
                assert name == 0xA3 and block[0] == 0x81
                self.times.append((number(content) + struct.unpack(">h", block[1:3])[0]) * scale)
            assert blocks[0][1][3] & 0x80, "a cluster begins with a picture that needs another"
        cues = [{name: content for name, content, _ in point} for _, point, _ in parts[0x1C53BB6B][0][0]]
        where = [{name: content for name, content, _ in cue[0xB7]} for cue in cues]
        assert [(number(cue[0xB3]), number(at[0xF1])) for cue, at in zip(cues, where)] == starts, "the table names other clusters"


def film_pictures(file, size):
    """Rows r g b of every picture of a film, as libvpx's own program decodes it: BT.709, studio's range."""
    width, height = size
    data = subprocess.run(["vpxdec", "--rawvideo", "--i420", "-o", "-", str(file)], capture_output=True, check=True, timeout=60).stdout
    whole, quarter = width * height, width * height // 4
    assert len(data) % (whole + 2 * quarter) == 0
    pictures = []
    for at in range(0, len(data), whole + 2 * quarter):
        rows = []
        for y in range(height):
            line = []
            for x in range(width):
                i = at + whole + y // 2 * (width // 2) + x // 2
                luma, blue, red = (data[at + y * width + x] - 16) / 219, (data[i] - 128) / 224, (data[i + quarter] - 128) / 224
                line += [luma + 1.5748 * red, luma - 0.187324 * blue - 0.468124 * red, luma + 1.8556 * blue]
            rows.append([min(255, max(0, 255 * value)) for value in line])
        pictures.append(rows)
    return pictures


def likeness(one, other):
    """Peak signal to noise, dB, of two pictures."""
    differences = [(a - b) ** 2 for row, with_row in zip(one, other) for a, b in zip(row, with_row)]
    return 10 * math.log10(255 ** 2 * len(differences) / max(1e-9, sum(differences)))
