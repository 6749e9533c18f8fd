"""Reads VTK's XML files as `spore export` writes them, apart from VTK: numbers are found by the head alone."""
import array
import pathlib
import re
import struct
import xml.etree.ElementTree as tree

CODES = {"Float64": "d", "Float32": "f", "Int32": "i", "UInt8": "B"}


class Piece:
    """points, velocity, radius, displacement: tuples; elements: tuples of points; strain, volume_ratio: of elements."""

    def __init__(self, file):
        content = pathlib.Path(file).read_bytes()
        marker = content.index(b'<AppendedData encoding="raw">')
        data = content.index(b"_", marker) + 1
        root = tree.fromstring(content[:marker] + b"</VTKFile>")
        assert root.get("byte_order") == "LittleEndian" and root.get("header_type") == "UInt64"
        self.grid = root.get("type")
        piece = root.find(f"{self.grid}/Piece")
        self.time = float(root.find(f"{self.grid}/FieldData/DataArray").text)
        self.arrays, end = {}, 0
        for section in piece:
            for one in section:
                offset = int(one.get("offset"))
                assert offset == end, "arrays lie one behind the other"
                size, = struct.unpack_from("<Q", content, data + offset)
                end = offset + 8 + size
                self.arrays[section.tag, one.get("Name")] = self.tuples(content[data + offset + 8:data + end], one)
        assert content[data + end:] == b"\n</AppendedData>\n</VTKFile>\n"
        self.points = self.arrays["Points", "positions"]
        assert len(self.points) == int(piece.get("NumberOfPoints"))
        kind = "Cells" if self.grid == "UnstructuredGrid" else next(
            (k for k in ("Polys", "Lines", "Verts") if int(piece.get("NumberOf" + k))), "Polys")
        connectivity, offsets = self.arrays[kind, "connectivity"], self.arrays[kind, "offsets"]
        self.elements = [tuple(connectivity[a:b]) for a, b in zip([0, *offsets], offsets)]
        assert not connectivity or max(connectivity) < len(self.points)

    @staticmethod
    def tuples(content, one):
        numbers = array.array(CODES[one.get("type")], content).tolist()
        width = int(one.get("NumberOfComponents"))
        return numbers if width == 1 else list(zip(*[iter(numbers)] * width))

    def at_points(self, name):
        return self.arrays["PointData", name]

    def at_cells(self, name):
        return self.arrays["CellData", name]


def series(file):
    """Times, and for each the blocks by name: paths."""
    file = pathlib.Path(file)
    moments = []
    for one in tree.parse(file).getroot().iter("DataSet"):
        blocks = file.parent / one.get("file")
        moments.append((float(one.get("timestep")),
                        {block.get("name"): blocks.parent / block.get("file") for block in tree.parse(blocks).getroot().iter("DataSet")}))
    return moments


def kind_of(name):
    return re.search(r"\.(\w+)$", str(name))[1]
