#!/usr/bin/python3
"""Scenes exported into files that other programs open. test_formats.py SPORE SCENES FEATURES KIND [MUJOCO_PROBE]"""
import array
import csv
import json
import math
import os
import pathlib
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
from xml.etree import ElementTree

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import shapes
import vtk_files
from tap import Skip, alike, check, is_sanitized, long_run, main, wait_for_work

SPORE, SCENES, FEATURES = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3].split(",")
FOLDER = pathlib.Path(tempfile.mkdtemp(prefix="spore-formats-"))
PROBE = sys.argv[5] if len(sys.argv) > 5 else None
PYTHON = "/usr/bin/python3"  # Debian's, which sees Debian's VTK


def run(*command, status=0, **how):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=250, **how)
    assert done.returncode == status, (command, done.returncode, done.stdout[-500:], done.stderr[-2000:])
    return done.stderr if status else done.stdout


def export(scene, form, output, *options):
    """The report of an export; scene: of the shipped ones."""
    report = json.loads(run(SPORE, "export", SCENES / f"{scene}.spore", "--format", form, "-o", output, "--json", *options))
    for one in report["written"]:
        assert pathlib.Path(one["file"]).stat().st_size == one["bytes"], one
    assert report["lost"]
    return report


def export_vtk(scene, *options):
    export(scene, "vtk", FOLDER / scene, *options)
    return vtk_files.series(FOLDER / scene / f"{scene}.pvd")


def watched(scene, time, every, points, *options):
    """Rows of the watched points, given as (body, point): for each moment the positions and velocities, 6 numbers a point."""
    file = FOLDER / "watched.csv"
    words = [word for body, at in points for word in ("--watch", f"{body}@" + ",".join(map(repr, at)))]
    subprocess.run([SPORE, "run", SCENES / f"{scene}.spore", "--time", time, "--every", every, "--output", file, "--quantities", "watch", *words, *options],
                   check=False, capture_output=True, timeout=250)
    with open(file, newline="") as opened:
        rows = list(csv.reader(line for line in opened if not line.startswith("#")))
    return [[float(x) for x in row[1:]] for row in rows[1:]]


@check
@alike
def a_series_is_where_the_run_is(*_):
    """Points of a VTK series are where spore run has them, at each moment, to rounding"""
    for scene, bodies in [("minimal", ["ball"]), ("plate4-deformed-ovary", ["ovary_right", "probe"]), ("plate5-string", ["string"]),
                          ("plate6-intestine", ["intestine"])]:
        moments = export_vtk(scene, "--time", "0.1", "--every", "0.02")
        assert [round(time, 9) for time, _ in moments] == [0, 0.02, 0.04, 0.06, 0.08, 0.1]
        for body in bodies:
            pieces = [vtk_files.Piece(blocks[body]) for _, blocks in moments]
            chosen = [0, len(pieces[0].points) // 2, len(pieces[0].points) - 1]
            rows = watched(scene, "0.1", "0.02", [(body, pieces[0].points[i]) for i in chosen])
            assert len(rows) == len(pieces)
            for row, piece, (time, _) in zip(rows, pieces, moments):
                assert piece.time == time
                for k, i in enumerate(chosen):
                    assert all(abs(a - b) < 1e-13 for a, b in zip(piece.points[i], row[6 * k:6 * k + 3])), (scene, body, time, i)
                    speeds = piece.at_points("velocity")[i]
                    assert all(abs(a - b) <= 1e-6 * abs(b) for a, b in zip(speeds, row[6 * k + 3:6 * k + 6])), (scene, body, time, i)


def determinant(a, b, c, d):
    (x, y, z), (u, v, w), (r, s, t) = [[q - p for p, q in zip(a, e)] for e in (b, c, d)]
    return x * (v * t - w * s) - y * (u * t - w * r) + z * (u * s - v * r)


@check
def tetrahedra_say_how_they_deform(*_):
    """Tetrahedra: displacement, strain and volume agree with the places of their corners; none at time 0; cuts divide them"""
    moments = export_vtk("cut-ovary", "--time", "1", "--every", "0.5")
    surfaces, cells = ([vtk_files.Piece(blocks["ovary_right" + part]) for _, blocks in moments] for part in ("", "+tetrahedra"))
    for name in ("strain", "volume_ratio"):
        assert len(cells[0].at_cells(name)) == len(cells[0].elements)
    assert max(abs(x) for strain in cells[0].at_cells("strain") for x in strain) < 1e-12
    for piece in cells[1:]:
        rest = [[x - d for x, d in zip(p, moved)] for p, moved in zip(piece.points, piece.at_points("displacement"))]
        for cell, strain, ratio in zip(piece.elements, piece.at_cells("strain"), piece.at_cells("volume_ratio")):
            ours = determinant(*[piece.points[i] for i in cell]) / determinant(*[rest[i] for i in cell])
            assert abs(ours - ratio) < 1e-4, (ours, ratio)
            for a, b in ((0, 1), (0, 2), (1, 3)):  # an edge e at rest is longer by 2 e.E.e, squared
                edge = [q - p for p, q in zip(rest[cell[a]], rest[cell[b]])]
                now = [q - p for p, q in zip(piece.points[cell[a]], piece.points[cell[b]])]
                xx, yy, zz, xy, yz, xz = strain
                x, y, z = edge
                grown = 2 * (xx * x * x + yy * y * y + zz * z * z + 2 * (xy * x * y + yz * y * z + xz * x * z))
                square = sum(e * e for e in edge)
                assert abs(sum(e * e for e in now) - square - grown) < 1e-4 * square
        assert max(abs(x) for strain in piece.at_cells("strain") for x in strain) > 0.01
    assert len(cells[-1].points) > len(cells[0].points) and len(cells[-1].elements) == len(cells[0].elements)
    assert len(surfaces[-1].elements) < len(surfaces[0].elements)


READ = """
import sys, json, vtk
from vtk.util.numpy_support import vtk_to_numpy
def block(data):
    points = vtk_to_numpy(data.GetPoints().GetData()) if data.GetNumberOfPoints() else None
    return {"points": data.GetNumberOfPoints(), "cells": data.GetNumberOfCells(), "type": data.GetClassName(),
            "sum": [float(x) for x in points.sum(axis=0)] if points is not None else [0, 0, 0],
            "kinds": sorted({data.GetCellType(i) for i in range(data.GetNumberOfCells())}),
            "arrays": {data.GetPointData().GetArrayName(i): data.GetPointData().GetArray(i).GetNumberOfTuples() for i in range(data.GetPointData().GetNumberOfArrays())},
            "cell_arrays": {data.GetCellData().GetArrayName(i): data.GetCellData().GetArray(i).GetNumberOfComponents() for i in range(data.GetCellData().GetNumberOfArrays())},
            "time": data.GetFieldData().GetArray("TimeValue").GetValue(0)}
said = {}
vtk.vtkObject.GlobalWarningDisplayOff()
for file in sys.argv[1:]:
    errors = []
    reader = vtk.vtkXMLMultiBlockDataReader()
    reader.AddObserver("ErrorEvent", lambda *_: errors.append(1))
    reader.SetFileName(file)
    reader.Update()
    blocks = reader.GetOutput()
    said[file] = {"errors": len(errors), "blocks": {blocks.GetMetaData(i).Get(vtk.vtkCompositeDataSet.NAME()): block(blocks.GetBlock(i)) for i in range(blocks.GetNumberOfBlocks())}}
print(json.dumps(said))
"""


@check
@alike
def vtk_reads_every_shipped_scene(*_):
    """Debian's VTK reads the series of every shipped scene, and finds the same points and elements as a parser of our own"""
    if subprocess.run([PYTHON, "-c", "import vtk"], capture_output=True, check=False).returncode:
        raise Skip("python3-vtk9 is not installed")
    scenes = sorted(path.stem for path in SCENES.glob("*.spore"))
    expected = {}
    for scene in scenes:
        series = FOLDER / f"{scene}.pvd"
        export(scene, "vtk", series)
        if is_sanitized(SPORE):
            continue  # what VTK reads of the files is seen in the other build
        (_, blocks), = vtk_files.series(series)
        expected[str(FOLDER / scene / f"{scene}-000000.vtm")] = blocks
    if is_sanitized(SPORE):
        return
    said = json.loads(run(PYTHON, "-c", READ, *expected))
    kinds = set()
    for file, blocks in expected.items():
        assert said[file]["errors"] == 0 and said[file]["blocks"].keys() == blocks.keys(), file
        for name, path in blocks.items():
            ours, theirs = vtk_files.Piece(path), said[file]["blocks"][name]
            assert (theirs["points"], theirs["cells"], theirs["time"]) == (len(ours.points), len(ours.elements), 0), path
            assert all(abs(sum(p[k] for p in ours.points) - theirs["sum"][k]) <= 1e-9 * len(ours.points) for k in range(3)), path
            assert theirs["arrays"] == {n: len(ours.points) for (section, n) in ours.arrays if section == "PointData"}
            assert theirs["cell_arrays"] == ({"strain": 6, "volume_ratio": 1} if ours.grid == "UnstructuredGrid" else {})
            kinds.update((theirs["type"], kind) for kind in theirs["kinds"])
    vertex, line, triangle, tetrahedron = 1, 4, 5, 10
    assert kinds == {("vtkPolyData", vertex), ("vtkPolyData", line), ("vtkPolyData", triangle), ("vtkUnstructuredGrid", tetrahedron)}, kinds


def obj_objects(file):
    """Vertices and triangles (numbers within the object) of each object, by name; the materials they use; the file of these."""
    objects, materials, library, before, all_vertices = {}, {}, None, 1, 0
    for line in file.read_text().splitlines():
        word, *rest = line.split()
        if word == "mtllib":
            library, = rest
        elif word == "o":
            name, before = rest[0], all_vertices + 1
            objects[name] = ([], [])
        elif word == "usemtl":
            materials[name], = rest
        elif word == "v":
            objects[name][0].append(tuple(map(float, rest)))
            all_vertices += 1
        elif word == "f":
            objects[name][1].append(tuple(int(x) - before for x in rest))
    return objects, materials, library


def volume(vertices, triangles):
    return sum(determinant((0, 0, 0), *(vertices[i] for i in triangle)) for triangle in triangles) / 6


def stl_triangles(file):
    content = file.read_bytes()
    count, = struct.unpack_from("<I", content, 80)
    assert len(content) == 84 + 50 * count and b"metre" in content[:80]
    rows = [struct.unpack_from("<12f", content, 84 + 50 * i) for i in range(count)]
    return [(row[:3], (row[3:6], row[6:9], row[9:])) for row in rows]


def ply_mesh(file):
    head, content = file.read_bytes().split(b"end_header\n", 1)
    assert head.startswith(b"ply\nformat binary_little_endian 1.0\n") and b"metre" in head
    vertices, faces = (int(head.split(b"element " + kind)[1].split()[0]) for kind in (b"vertex", b"face"))
    rows = list(struct.iter_unpack("<3f3B", content[:15 * vertices]))
    triangles = list(struct.iter_unpack("<B3i", content[15 * vertices:]))
    assert len(triangles) == faces and all(row[0] == 3 for row in triangles)
    return [row[:3] for row in rows], [row[3:] for row in rows], [row[1:] for row in triangles]


@check
@alike
@long_run
def surfaces_are_those_of_the_series(*_):
    """OBJ, PLY and STL hold the surfaces of the same moment in the VTK series, with names and colours as far as they can"""
    for scene in ("laparoscopy",):
        (_, blocks), = export_vtk(scene, "--time", "0.02")
        for form in ("obj", "ply", "stl"):
            export(scene, form, FOLDER / f"s.{form}", "--time", "0.02")
        objects, materials, library = obj_objects(FOLDER / "s.obj")
        assert library == "s.mtl" and objects.keys() == blocks.keys() - {name for name in blocks if "+" in name}
        colours = {part.split()[0]: [float(x) for x in part.split()[2:5]] for part in (FOLDER / "s.mtl").read_text().split("newmtl")[1:]}
        places, tints, faces = ply_mesh(FOLDER / "s.ply")
        flat, before = stl_triangles(FOLDER / "s.stl"), 0
        surfaces = 0
        for name, (vertices, triangles) in objects.items():
            assert materials[name] == name and len(colours[name]) == 3
            piece = vtk_files.Piece(blocks[name])
            if ("Polys", "offsets") in piece.arrays and piece.arrays["Polys", "offsets"]:
                surfaces += 1
                assert [piece.points[i] for e in piece.elements for i in e] == [vertices[i] for t in triangles for i in t], name
            first = sum(len(objects[other][0]) for other in list(objects)[:list(objects).index(name)])
            assert tints[first] == tuple(int(255 * x + 0.5) for x in colours[name])
            for t, ((normal, corners), face) in list(zip(triangles, zip(flat[before:], faces[before:])))[::5]:
                for i, corner, number in zip(t, corners, face):
                    assert all(abs(a - b) < 1e-7 for a, b in zip(vertices[i], corner))
                    assert places[number] == corner
                assert abs(math.hypot(*normal) - 1) < 1e-5 or normal == (0, 0, 0)
            before += len(triangles)
        assert before == len(flat) == len(faces) and surfaces >= 6


def area(vertices, triangles):
    sides = ([[q - p for p, q in zip(vertices[t[0]], vertices[t[k]])] for k in (1, 2)] for t in triangles)
    return sum(math.hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]) for a, b in sides) / 2


@check
def surfaces_come_back_by_import(*_):
    """spore import reads OBJ with every body by name and the volume of each, and the same area of all three"""
    if "assimp" not in FEATURES:
        raise Skip("this build reads OFF alone")
    for form in ("obj", "ply", "stl"):
        export("plate4-deformed-ovary", form, FOLDER / f"plate4.{form}")
    ours = obj_objects(FOLDER / "plate4.obj")[0]
    for form in ("obj", "ply", "stl"):
        split = ["--split", "parts"] if form == "obj" else ["--merge"]
        report = json.loads(run(SPORE, "import", FOLDER / f"plate4.{form}", "--unit", "m", *split, "-o", FOLDER / "back" / f"{form}.spore", "--json"))
        read = {mesh["body"]: mesh["as_read"] for mesh in report["meshes"]}
        assert sum(one["triangles"] for one in read.values()) == sum(len(mesh[1]) for mesh in ours.values()), form
        expected = sum(area(*mesh) for mesh in ours.values())
        assert abs(sum(one["area_m2"] for one in read.values()) - expected) < 1e-5 * expected, form
        if form == "obj":
            closed = {name: one["volume_m3"] for name, one in read.items() if not one["boundary_edges"]}
            assert read.keys() == ours.keys() and len(closed) >= 5
            assert all(abs(cubic - volume(*ours[name])) < 1e-5 * cubic for name, cubic in closed.items()), closed


@check
@alike
def bodies_without_a_mesh_are_balls_tubes_and_skins(*_):
    """What has no mesh is drawn as the editor does: spheres as balls, a line as a tube, a liquid as its skin, smoke not at all"""
    shutil.copytree(SCENES / "minimal", FOLDER / "own" / "minimal")
    text = (SCENES / "minimal.spore").read_text().replace('<visual mesh="floor" colour="0.46 0.43 0.42" wetness="0.1"/>', "")
    (FOLDER / "own" / "bare.spore").write_text(text)
    run(SPORE, "export", FOLDER / "own" / "bare.spore", "--format", "obj", "-o", FOLDER / "bare.obj")
    spheres = [list(map(float, line.split())) for line in (SCENES / "minimal" / "floor.spheres").read_text().splitlines() if line[:1] not in "#"]
    vertices, triangles = obj_objects(FOLDER / "bare.obj")[0]["floor"]
    each, corners = len(triangles) // len(spheres), len(vertices) // len(spheres)
    for i, (*centre, radius) in enumerate(spheres):
        assert all(abs(math.dist(centre, at) - radius) < 1e-9 for at in vertices[corners * i:corners * (i + 1)])
        ball = volume(vertices, triangles[each * i:each * (i + 1)])
        assert 0.85 < ball / (4 / 3 * math.pi * radius ** 3) < 1, ball
    for scene, body in (("plate5-string", "string"), ("plate3-blood", "blood")):
        export(scene, "obj", FOLDER / "one.obj")
        mesh = obj_objects(FOLDER / "one.obj")[0][body]
        edges = {}
        for t in mesh[1]:
            for a, b in zip(t, t[1:] + t[:1]):
                edges[a, b] = edges.get((a, b), 0) + 1
        assert volume(*mesh) > 0 and all(edges.get((b, a)) == n for (a, b), n in edges.items()), "closed, outward"
    report = export("plate7-steam", "obj", FOLDER / "one.obj")
    assert "steam" not in obj_objects(FOLDER / "one.obj")[0] and any("steam" in word for word in report["lost"])


class Film:
    """A .glb file, read apart from any library: where the vertices of each node are at a time."""

    def __init__(self, file):
        content = file.read_bytes()
        magic, version, size, length, kind = struct.unpack_from("<4sIII4s", content)
        assert (magic, version, size, kind) == (b"glTF", 2, len(content), b"JSON")
        self.json = json.loads(content[20:20 + length])
        size, kind = struct.unpack_from("<I4s", content, 20 + length)
        self.numbers = content[28 + length:]
        assert kind == b"BIN\0" and size == len(self.numbers) == self.json["buffers"][0]["byteLength"]
        self.nodes = {node["name"]: number for number, node in enumerate(self.json["nodes"])}
        self.tracks, read = {}, {}
        for animation in self.json.get("animations", []):
            for channel in animation["channels"]:
                sampler = animation["samplers"][channel["sampler"]]
                rows = [read.setdefault(sampler[way], self.rows(sampler[way])) for way in ("input", "output")]
                self.tracks[channel["target"]["node"], channel["target"]["path"]] = rows

    def rows(self, accessor):
        one = self.json["accessors"][accessor]
        view = self.json["bufferViews"][one["bufferView"]]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[one["type"]]
        numbers = array.array("I" if one["componentType"] == 5125 else "f", self.numbers[view["byteOffset"]:view["byteOffset"] + view["byteLength"]])
        assert len(numbers) == width * one["count"]
        rows = list(zip(*[iter(numbers)] * width))
        if "min" in one:
            assert all(abs(low(x) - y) <= 1e-6 * abs(y) for x, y, low in zip(zip(*rows), one["min"], [min] * width))
        return rows

    def mesh(self, name):
        return self.json["meshes"][self.json["nodes"][self.nodes[name]]["mesh"]]["primitives"][0]

    def keys(self, name):
        """Number of key frames of a body that changes its shape."""
        return 1 + len(self.mesh(name).get("targets", []))

    def at(self, name, time):
        number = self.nodes[name]
        node, primitive = self.json["nodes"][number], self.mesh(name)
        vertices = self.rows(primitive["attributes"]["POSITION"])
        if (number, "weights") in self.tracks:
            vertices = self.bent(vertices, primitive, *self.tracks[number, "weights"], time)
        place, turn = node["translation"], node["rotation"]
        if (number, "rotation") in self.tracks:  # asked for at the times of the file alone: nothing lies between them
            times, places = self.tracks[number, "translation"]
            at = min(range(len(times)), key=lambda i: abs(times[i][0] - time))
            assert abs(times[at][0] - time) < 1e-6
            place, turn = places[at], self.tracks[number, "rotation"][1][at]
        x, y, z, w = turn
        rows = ((1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)), (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
                (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)))
        return [[sum(a * b for a, b in zip(row, v)) + p for row, p in zip(rows, place)] for v in vertices]

    def bent(self, vertices, primitive, times, weights, time):
        """By the linear interpolation of the weights."""
        targets, times = primitive["targets"], [row[0] for row in times]
        weights = [[row[0] for row in weights[k:k + len(targets)]] for k in range(0, len(weights), len(targets))]
        assert len(weights) == len(times) == len(targets) + 1
        after = next((i for i, t in enumerate(times) if t >= time - 1e-7), len(times) - 1)
        before = max(after - 1, 0)
        part = (time - times[before]) / (times[after] - times[before]) if after > before else 0
        for k, target in enumerate(targets):
            weight = weights[before][k] + part * (weights[after][k] - weights[before][k])
            if abs(weight) > 1e-12:
                vertices = [[a + weight * b for a, b in zip(v, d)] for v, d in zip(vertices, self.rows(target["POSITION"]))]
        return vertices


@check
@alike
@long_run
def a_film_moves_as_the_series(*_):
    """glTF: at each moment of the VTK series every body is within the error that is told, and rigid ones are where they were"""
    for scene, seconds, rigid, soft in (("plate1-ovary", "0.3", ["ovary_right"], []), ("plate4-deformed-ovary", "0.3", ["probe", "uterus"], ["ovary_right"]),
                                        ("laparoscopy", "0.24", ["endoscope"], ["ligament_right", "tube_left"])):
        how = ["--time", seconds, "--every", "0.02"]
        moments, report = export_vtk(scene, *how), export(scene, "gltf", FOLDER / "film.glb", *how)
        film = Film(FOLDER / "film.glb")
        told = {one["body"]: one for one in report["animation"]}
        for name in rigid + soft:
            worst = 0
            for time, blocks in moments:
                points, ours = vtk_files.Piece(blocks[name]).points, film.at(name, time)
                assert len(points) == len(ours)
                worst = max(worst, *(math.dist(p, q) for p, q in zip(points, ours)))
            error = told[name]["error_m"] if name in soft else 0
            assert abs(worst - error) < 2e-7, (name, worst, error)
            if name in soft:
                assert error <= told[name]["bound_m"] and film.keys(name) == told[name]["keys"] <= len(moments)
        assert told.keys() >= set(soft) and any(one["keys"] < len(moments) and one["error_m"] > 1e-6 for one in told.values()) == bool(soft), told
        assert any((film.nodes[name], "rotation") in film.tracks for name in rigid)


def import_worn(folder):
    """A sphere that wears a picture with a seam, as a net that falls: its scene, and the bytes of its picture."""
    folder.mkdir()
    picture = shapes.png(16, 16, lambda x, y: (200, 16 * x, 16 * y))
    (folder / "skin.png").write_bytes(picture)
    (folder / "worn.mtl").write_text("newmtl skin\nmap_Kd skin.png\n")
    (folder / "other materials.mtl").write_text("newmtl other\n")
    (folder / "worn.obj").write_text("mtllib other materials.mtl\nmtllib none.mtl worn.mtl\n" + shapes.worn_obj(*shapes.sphere(), "worn.mtl", "skin"))
    run(SPORE, "import", folder / "worn.obj", "-o", folder / "scene" / "worn.spore")
    run(SPORE, "edit", folder / "scene" / "worn.spore", "--set", "bodies/worn/role=passive", "--add", "bodies/worn/mechanical/mass_spring_net",
        "--set", "bodies/worn/mechanical/geometry=worn")
    return folder / "scene" / "worn.spore", picture


def places_of(scene):
    """The picture's bytes and its places in a scene with one body."""
    visual = ElementTree.parse(scene).find(".//visual")
    return (scene.parent / visual.get("texture")).read_bytes(), [float(x) for x in (scene.parent / visual.get("texture_places")).read_text().split()[2:]]


@check
def pictures_come_back(*_):
    """OBJ and glTF hold the picture on a body, its places and its opacity; imported again all are the same; PLY says that it loses them"""
    if "assimp" not in FEATURES:
        raise Skip("built without assimp")
    scene, picture = import_worn(FOLDER / "worn")
    _, places = places_of(scene)
    assert ElementTree.parse(scene).find(".//visual").get("colour") == "1 1 1"
    run(SPORE, "edit", scene, "--set", "bodies/worn/visual/opacity=0.4")
    for form in ("obj", "glb"):
        report = export(scene.with_suffix(""), {"obj": "obj", "glb": "gltf"}[form], FOLDER / f"worn.{form}")
        assert not any("picture" in sentence or "opacity" in sentence for sentence in report["lost"]), report["lost"]
        run(SPORE, "import", FOLDER / f"worn.{form}", "-o", FOLDER / form / "again.spore")
        kept, again = places_of(FOLDER / form / "again.spore")
        assert ElementTree.parse(FOLDER / form / "again.spore").find(".//visual").get("opacity") == "0.4", form
        assert kept == picture and len(again) == len(places) and all(abs(a - b) < 1e-5 for a, b in zip(places, again)), form
    assert (FOLDER / "worn-worn.png").read_bytes() == picture
    lost = export(scene.with_suffix(""), "ply", FOLDER / "worn.ply")["lost"]
    assert all(any(word in sentence for sentence in lost) for word in ("picture on its surface", "opacity")), lost
    export(scene.with_suffix(""), "gltf", FOLDER / "falling.glb", "--time", "0.02", "--every", "0.01")
    film = Film(FOLDER / "falling.glb")
    mesh = film.mesh("worn")
    vertices, coordinates = (film.rows(mesh["attributes"][name]) for name in ("POSITION", "TEXCOORD_0"))
    assert len(coordinates) == len(vertices) > len(set(vertices)) == len(shapes.sphere()[0])
    for target in mesh["targets"]:
        moved = film.rows(target["POSITION"])
        assert len(moved) == len(vertices) and len(set(zip(vertices, moved))) == len(set(vertices)) and any(row[1] < -1e-5 for row in moved)


@check
def a_validator_and_an_importer_read_films(*_):
    """glTF: the validator of the Khronos Group finds nothing, and spore import the bodies with names, colours and areas"""
    files = []
    scenes = sorted(path.stem for path in SCENES.glob("*.spore"))
    for scene in scenes:
        files.append(FOLDER / f"{scene}.glb")
        step = float(re.search(r'<solver [^>]*time_step="([^"]+)"', (SCENES / f"{scene}.spore").read_text())[1])
        export(scene, "gltf", files[-1], *(["--time", repr(20 * step), "--every", repr(10 * step)] if len(files) % 2 else []))
        Film(files[-1])
    if "assimp" in FEATURES:
        export("plate4-deformed-ovary", "obj", FOLDER / "film.obj")
        ours = obj_objects(FOLDER / "film.obj")[0]
        export("plate4-deformed-ovary", "gltf", FOLDER / "film.glb")
        report = json.loads(run(SPORE, "import", FOLDER / "film.glb", "--unit", "m", "--split", "parts", "-o", FOLDER / "back" / "film.spore", "--json"))
        colours = {part.split()[0]: [float(x) for x in part.split()[2:5]] for part in (FOLDER / "film.mtl").read_text().split("newmtl")[1:]}
        assert {mesh["body"] for mesh in report["meshes"]} == ours.keys()
        for mesh in report["meshes"]:
            expected = area(*ours[mesh["body"]])
            assert abs(mesh["as_read"]["area_m2"] - expected) < 1e-5 * expected, mesh
            assert all(abs(a - b) < 0.005 for a, b in zip(mesh["colour"], colours[mesh["body"]], strict=True)), (mesh, colours)
        files.append(FOLDER / "textured.glb")
        export(import_worn(FOLDER / "textured")[0].with_suffix(""), "gltf", files[-1], "--time", "0.02", "--every", "0.01")
    validate(files)


VALIDATE = """
const validator = require("gltf-validator"), fs = require("fs");
(async () => {
  for (const file of process.argv.slice(1)) {
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)));
    const {numErrors, numWarnings, messages} = report.issues;
    if (numErrors + numWarnings || report.truncated) console.log(file, JSON.stringify(messages.slice(0, 3)));
  }
  console.log("validated", process.argv.length - 1);
})();
"""


def validate(files):
    try:
        paths = subprocess.run(["npm", "root", "-g"], capture_output=True, text=True, check=True, timeout=60).stdout.strip()
        where = {**os.environ, "NODE_PATH": paths}
        subprocess.run(["node", "-e", 'require("gltf-validator")'], env=where, capture_output=True, check=True, timeout=60)
    except (OSError, subprocess.SubprocessError) as missing:
        raise Skip("gltf-validator is not installed: npm install -g gltf-validator") from missing
    said = run("node", "-e", VALIDATE, *files, env=where)
    assert said == f"validated {len(files)}\n", said
    broken = FOLDER / "broken.glb"
    broken.write_bytes(files[0].read_bytes().replace(b'"componentType":5125', b'"componentType":5126', 1))
    assert "broken.glb" in run("node", "-e", VALIDATE, broken, env=where)


def solid_moments(vertices, triangles, density):
    """Mass, centre, and the trace of the inertia about the centre, of the solid inside a closed surface."""
    cubic, first, square = 0, [0, 0, 0], 0
    for t in triangles:
        corners = [vertices[i] for i in t]
        det = determinant((0, 0, 0), *corners)
        whole = [sum(c[k] for c in corners) for k in range(3)]
        cubic += det / 6
        first = [f + det / 24 * w for f, w in zip(first, whole)]
        square += det / 120 * sum(x * x for row in (whole, *corners) for x in row)
    centre = [f / cubic for f in first]
    return density * cubic, centre, 2 * density * (square - cubic * sum(c * c for c in centre))


@check
def mujoco_holds_ball_joints(*_):
    """MJCF: a ball joint holds a body that would fall, to the scene and to another body"""
    if not PROBE:
        raise Skip("libmujoco-dev was not installed when this was built")
    shutil.copytree(SCENES / "minimal", FOLDER / "held" / "minimal", dirs_exist_ok=True)
    text = (SCENES / "minimal.spore").read_text()
    for ends, held in (('body_a="ball"', 1), ('body_a="floor" body_b="ball"', 1), (None, 0)):
        link = f'<links><ball name="hang" {ends} point="0.0015 0.08 0.001"/></links>' if ends else ""
        (FOLDER / "held" / "held.spore").write_text(text.replace("</bodies>", "</bodies>" + link))
        run(SPORE, "export", FOLDER / "held" / "held.spore", "--format", "mjcf", "-o", FOLDER / "model.xml")
        said = json.loads(run(PROBE, FOLDER / "model.xml", "0.3"))
        fallen = said["bodies"]["ball"]["position"][1] - said["after"]["bodies"]["ball"]["position"][1]
        assert said["equalities"] == held and (fallen < 0.002) == bool(held), (ends, fallen)


@check
@alike
def mujoco_runs_rigid_bodies(*_):
    """MJCF: Debian's MuJoCo loads every shipped scene; mass, inertia, springs and motion of rigid bodies are those of SPORE"""
    if not PROBE:
        raise Skip("libmujoco-dev was not installed when this was built")
    for scene in sorted(SCENES.glob("*.spore")):
        report = export(scene.stem, "mjcf", FOLDER / "model.xml")
        if is_sanitized(SPORE):
            continue  # what MuJoCo reads of it is seen in the other build
        said = json.loads(run(PROBE, FOLDER / "model.xml", "0.01"))
        lost = [sentence.split(":")[0] for sentence in report["lost"] if "no rigid body" in sentence]
        names = re.findall(r'<body name="(\w+)"', scene.read_text())
        assert said["bodies"].keys() == set(names) - set(lost) and said["warnings"] == 0, scene
    # In steps as short as these, both come near what is exact: MuJoCo is of first order. On the floor it has a contact law of its
    # own, by which the ball rolls elsewhere: then its height alone is compared.
    for scene, body, seconds, share in (("plate1-ovary", "ovary_right", "0.1", 0.005), ("minimal", "ball", "0.08", 0.005), ("minimal", "ball", "0.5", 0.05)):
        export(scene, "mjcf", FOLDER / "model.xml", "--dt", "0.0002")
        export(scene, "obj", FOLDER / "model.obj")
        said = json.loads(run(PROBE, FOLDER / "model.xml", seconds))
        theirs, after = said["bodies"][body], said["after"]["bodies"][body]
        mass, centre, trace = solid_moments(*obj_objects(FOLDER / "model.obj")[0][body], 1060)
        assert abs(theirs["mass"] - mass) < 1e-6 * mass and abs(sum(theirs["inertia"]) - trace) < 1e-5 * trace
        assert math.dist(theirs["position"], centre) < 1e-7 and theirs["freedoms"] == 6
        assert len(said["lengths"]) == (10 if scene == "plate1-ovary" else 0)
        assert all(abs(a - b) < 1e-9 for a, b in zip(said["lengths"], said["rest"]))
        here = watched(scene, seconds, seconds, [(body, theirs["position"])], "--dt", "0.0002", "--integrator", "bdf2")[-1][:3]
        there = after["position"] if share < 0.01 else [here[0], after["position"][1], here[2]]
        moved, apart = math.dist(here, theirs["position"]), math.dist(here, there)
        print(f"# {scene} {seconds} s: moved {moved:.3g} m, MuJoCo {apart:.3g} m from there")
        assert moved > 1e-3 and apart < share * moved, (scene, here, there)


def numbers(element, name):
    return [float(word) for word in element.get(name).split()]


def sofa(scene, *options):
    """The nodes of a SOFA file by names, and the report."""
    report = export(scene, "sofa", FOLDER / "scene.scn", *options)
    root = ElementTree.parse(FOLDER / "scene.scn").getroot()
    assert root.tag == "Node" and all(node.get("name") for node in root.iter("Node"))
    return root, {node.get("name"): node for node in root.findall("Node")}, report["lost"]


@check
def sofa_has_the_masses_and_stiffnesses_of_the_scene(*_):
    """SOFA: rigid bodies, tetrahedra and springs have the places, masses, moduli, springs and pins that the scene says"""
    root, bodies, _ = sofa("plate1-ovary")
    export("plate1-ovary", "obj", FOLDER / "model.obj")
    mass, centre, trace = solid_moments(*obj_objects(FOLDER / "model.obj")[0]["ovary_right"], 1060)
    written = numbers(bodies["ovary_right"].find("UniformMass"), "vertexMass")
    assert numbers(root, "gravity") == [0, -9.81, 0] and numbers(root, "dt") == [0.004]
    assert abs(written[0] - mass) < 1e-6 * mass and abs(mass * (written[2] + written[6] + written[10]) - trace) < 1e-5 * trace
    assert math.dist(numbers(bodies["ovary_right"].find("MechanicalObject"), "position")[:3], centre) < 1e-7
    assert len(numbers(bodies["ovary_right"].find("Node/SphereCollisionModel"), "listRadius")) * 3 == \
        len(numbers(bodies["ovary_right"].find("Node/MechanicalObject"), "position"))

    _, bodies, lost = sofa("exercise-clip-and-cut")
    tube = bodies["tube"]
    places, cells = numbers(tube.find("TetrahedronSetTopologyContainer"), "position"), tube.find("TetrahedronSetTopologyContainer").get("tetrahedra").split()
    points = list(zip(*[iter(places)] * 3))
    filled = sum(determinant(*[points[int(i)] for i in cells[k:k + 4]]) for k in range(0, len(cells), 4)) / 6
    assert abs(sum(numbers(tube.find("DiagonalMass"), "vertexMass")) - 1060 * filled) < 1e-6 * 1060 * filled
    assert places == numbers(tube.find("MechanicalObject"), "position") == numbers(tube.find("MechanicalObject"), "rest_position")
    shear, pressure = numbers(tube.find("TetrahedronHyperelasticityFEMForceField"), "ParameterSet")
    assert abs(shear * (3 * pressure + 2 * shear) / (pressure + shear) - 150000) < 1e-3 and numbers(tube.find("EulerImplicitSolver"), "rayleighStiffness") == [0.01]
    held = {int(word) for word in tube.find("FixedProjectiveConstraint").get("indices").split()}
    assert held == {i for i, p in enumerate(points) if min(math.dist(p, (x, 0, 0)) for x in (-0.036, 0.036)) <= 0.005} and held
    assert any(word.startswith("scissors:") for word in lost) and not any("tube" in word for word in lost)

    _, bodies, lost = sofa("bag")
    net = bodies["bag"]
    points = list(zip(*[iter(numbers(net.find("TriangleSetTopologyContainer"), "position"))] * 3))
    triangles = list(zip(*[iter(map(int, net.find("TriangleSetTopologyContainer").get("triangles").split()))] * 3))
    total = 0.24 * area(points, triangles)
    assert abs(sum(numbers(net.find("DiagonalMass"), "vertexMass")) - total) < 1e-6 * total
    fields = [list(zip(*[iter(field.get("spring").split())] * 5)) for field in net.findall("StiffSpringForceField")]
    assert [{(float(spring[2]), float(spring[3])) for spring in field} for field in fields] == [{(200, 0.03)}, {(60, 0.03)}, {(0.5, 0.03)}]
    edges = {tuple(sorted(pair)) for t in triangles for pair in zip(t, t[1:] + t[:1])}
    assert {(int(spring[0]), int(spring[1])) for spring in fields[0]} == edges
    assert all(abs(math.dist(points[int(a)], points[int(b)]) - float(length)) < 1e-9 for a, b, _, _, length in fields[0])
    assert any(word.startswith("draw_string:") for word in lost) and any("links" in word for word in lost)


@check
@alike
def sofa_holds_or_names_every_body(*_):
    """SOFA: of scenes with every kind of body, each body is in the file or said to be lost"""
    known = set()
    for path in (SCENES / f"{name}.spore" for name in ("laparoscopy", "bag", "plate1-ovary", "exercise-clip-and-cut", "finite-differences", "plate7-steam")):
        root, bodies, lost = sofa(path.stem)
        names = re.findall(r'<body name="(\w+)"', path.read_text())
        gone = {word.split(":")[0] for word in lost if "no such body" in word}
        assert bodies.keys() == set(names) - gone and gone <= set(names), path
        known.update(element.tag for element in root.iter())
    assert known >= {"UniformMass", "DiagonalMass", "TetrahedronHyperelasticityFEMForceField", "StiffSpringForceField", "SphereCollisionModel", "RigidMapping"}
    head, body, rest = re.split(r'(<body name="bag".*?)(?=</body>)', (SCENES / "bag.spore").read_text(), maxsplit=1, flags=re.DOTALL)
    head = re.sub(r'(<mesh name="bag)(".*?/>)', r"\1\2\1_again\2", head, count=1)
    for folder in ("bag", "organs", "instruments"):
        shutil.copytree(SCENES / folder, FOLDER / "levels" / folder)
    for level in ("fine", "coarse"):
        levels = f'<fidelity level="{level}"><coarse geometry="bag_again"/></fidelity>'
        (FOLDER / "levels" / "bag.spore").write_text(head + body + levels + rest)
        _, bodies, lost = sofa(FOLDER / "levels" / "bag")
        assert ("bag" in bodies) == (level == "fine") == (not any(word.startswith("bag: the file") for word in lost)), lost
    refused = run(SPORE, "export", SCENES / "minimal.spore", "--format", "sofa", "-o", FOLDER / "no.scn", "--time", "1", status=2)
    assert "--time" in refused and not (FOLDER / "no.scn").exists()


@check
def what_is_lost_is_said(*_):
    """What a format cannot hold is said, where the scene has it"""
    lost = {scene: " ".join(export(scene, "vtk", FOLDER / "lost.pvd")["lost"]) for scene in ("minimal", "exercise-salpingectomy", "plate7-steam", "plate3-blood")}
    for word, scenes in [("links", ("exercise-salpingectomy", "plate7-steam")), ("exercise", ("exercise-salpingectomy",)), ("opaque", ("plate7-steam",)),
                         ("skin around", ("plate3-blood",)), ("gravity", tuple(lost)), ("colours", tuple(lost))]:
        for scene, said in lost.items():
            assert (word in said) == (scene in scenes), (word, scene, said)


@check
def steps_that_were_not_solved_are_counted(*_):
    """Steps that were not solved are counted, as spore run counts them"""
    for speed, any_steps in (("0 -300 0", True), ("0 0 0", False)):
        how = ["--time", "0.05", "--set", f"bodies/ball/velocity={speed}"]
        ran = subprocess.run([SPORE, "run", SCENES / "minimal.spore", *how, "--json"], capture_output=True, check=False, timeout=250)
        steps = max((one["steps"] for one in json.loads(ran.stdout)["monitor"]["unsolved"]), default=0)
        assert export("minimal", "vtk", FOLDER / "fast", *how)["unsolved"] == steps and (steps > 0) == any_steps
        said = run(SPORE, "export", SCENES / "minimal.spore", "--format", "vtk", "-o", FOLDER / "fast", *how)
        assert ("not solved" in said) == any_steps


@check
def folders_are_named_in_any_way(*_):
    """A series goes into the folder that is named: new, there already, with a slash, or the present one"""
    scene = SCENES.resolve() / "minimal.spore"
    for folder, name in (("new", "new"), ("new", "new/"), ("here", "."), ("fresh", "fresh///")):
        (FOLDER / "in").mkdir(exist_ok=True)
        where = FOLDER / "in" / folder if name == "." else FOLDER / "in"
        where.mkdir(exist_ok=True)
        report = json.loads(run(SPORE, "export", scene, "--format", "vtk", "-o", name, "--json", cwd=where))
        (_, blocks), = vtk_files.series(FOLDER / "in" / folder / f"{folder}.pvd")
        assert blocks.keys() == {"ball", "floor"} and all((where / one["file"]).is_file() for one in report["written"])
        assert {path.parent for path in (FOLDER / "in").rglob("*.vt?")} <= {FOLDER / "in" / one for one in ("new", "here", "fresh")}


@check
def bad_input(*_):
    """Bad input: one line, status 2, and nothing is written"""
    scene, target = SCENES / "minimal.spore", FOLDER / "bad"
    (FOLDER / "file").write_text("kept")
    for options, word in [(["--format", "vtk", "-o", target, "--every", "0.1"], "--time"), (["--format", "vtk", "-o", target, "--time", "x"], "--time"),
                          (["--format", "vtk", "-o", target, "--time", "1", "--every", "0.0015"], "no multiple"),
                          (["--format", "vtk", "-o", target, "--time", "-1"], "0 s or more"), (["--format", "stl", "-o", target, "--time", "1", "--every", "0.1"], "--every"), (["--format", "runtime", "-o", target, "--time", "1"], "--time"),
                          (["--format", "gltf", "-o", FOLDER / "bad.gltf"], ".glb"), (["--format", "vtk", "-o", FOLDER / "none" / "f"], "none"), (["--format", "vtk", "-o", FOLDER / "file"], "file")]:
        said = run(SPORE, "export", scene, *options, status=2)
        assert word in said and said.count("\n") == 1, said
        assert not target.exists() and not (FOLDER / "none").exists() and (FOLDER / "file").read_text() == "kept"


def tree():
    return sorted((str(path), path.read_bytes() if path.is_file() else None) for path in FOLDER.rglob("*"))


@check
@alike
def whole_or_not_at_all(*_):
    """A full disk, Ctrl-C and SIGTERM leave what was there, and nothing else"""
    export("minimal", "vtk", FOLDER / "whole", "--time", "0.01", "--every", "0.01")
    before = tree()
    scene = SCENES / "minimal.spore"
    limited = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))
    for form, target in (("vtk", "whole"), ("vtk", "fresh"), ("obj", "fresh.obj"), ("ply", "fresh.ply"), ("stl", "fresh.stl"), ("gltf", "fresh.glb"), ("mjcf", "fresh.xml")):
        said = run(SPORE, "export", scene, "--format", form, "-o", FOLDER / target, status=2, preexec_fn=limited)
        assert "nothing was changed" in said and tree() == before, said
    for number in (signal.SIGINT, signal.SIGTERM):
        for target in ("whole", "fresh"):
            process = subprocess.Popen([SPORE, "export", scene, "--format", "vtk", "-o", FOLDER / target, "--time", "100000", "--every", "50"],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            wait_for_work(process)
            process.send_signal(number)
            assert process.wait(timeout=60) == 130
            assert tree() == before


try:
    main(kind=sys.argv[4])
finally:
    shutil.rmtree(FOLDER, ignore_errors=True)
