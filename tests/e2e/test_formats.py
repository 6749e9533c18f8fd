#!/usr/bin/python3
"""Scenes exported into files that other programs open. test_formats.py SPORE SCENES"""
import csv
import json
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import vtk_files
from tap import Skip, check, is_sanitized, main, wait_for_work

SPORE, SCENES = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2])
FOLDER = pathlib.Path(tempfile.mkdtemp(prefix="spore-formats-"))
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


def watched(scene, time, every, points):
    """Rows of the watched points, given as (body, point): for each moment the positions and velocities, 6 numbers a point."""
    file = FOLDER / "watched.csv"
    words = [word for body, at in points for word in ("--watch", f"{body}@" + ",".join(map(repr, at)))]
    subprocess.run([SPORE, "run", SCENES / f"{scene}.spore", "--time", time, "--every", every, "--output", file, "--quantities", "watch", *words],
                   check=False, capture_output=True, timeout=250)
    with open(file, newline="") as opened:
        rows = list(csv.reader(line for line in opened if not line.startswith("#")))
    return [[float(x) for x in row[1:]] for row in rows[1:]]


@check
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
def vtk_reads_every_shipped_scene(*_):
    """Debian's VTK reads the series of every shipped scene, and finds the same points and elements as a parser of our own"""
    if subprocess.run([PYTHON, "-c", "import vtk"], capture_output=True, check=False).returncode:
        raise Skip("python3-vtk9 is not installed")
    scenes = sorted(path.stem for path in SCENES.glob("*.spore"))
    expected = {}
    for scene in scenes[::4] if is_sanitized(SPORE) else scenes:
        series = FOLDER / f"{scene}.pvd"
        export(scene, "vtk", series)
        (_, blocks), = vtk_files.series(series)
        expected[str(FOLDER / scene / f"{scene}-000000.vtm")] = blocks
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
def bad_input(*_):
    """Bad input: one line, status 2, and nothing is written"""
    scene, target = SCENES / "minimal.spore", FOLDER / "bad"
    (FOLDER / "file").write_text("kept")
    for options, word in [(["--format", "vtk", "-o", target, "--every", "0.1"], "--time"), (["--format", "vtk", "-o", target, "--time", "x"], "--time"),
                          (["--format", "vtk", "-o", target, "--time", "1", "--every", "0.0015"], "no multiple"),
                          (["--format", "vtk", "-o", target, "--time", "-1"], "0 s or more"), (["--format", "runtime", "-o", target, "--time", "1"], "--time"),
                          (["--format", "vtk", "-o", FOLDER / "none" / "f"], "none"), (["--format", "vtk", "-o", FOLDER / "file"], "file")]:
        said = run(SPORE, "export", scene, *options, status=2)
        assert word in said and said.count("\n") == 1, said
        assert not target.exists() and not (FOLDER / "none").exists() and (FOLDER / "file").read_text() == "kept"


def tree():
    return sorted((str(path), path.read_bytes() if path.is_file() else None) for path in FOLDER.rglob("*"))


@check
def whole_or_not_at_all(*_):
    """A full disk, Ctrl-C and SIGTERM leave what was there, and nothing else"""
    export("minimal", "vtk", FOLDER / "whole", "--time", "0.01", "--every", "0.01")
    before = tree()
    scene = SCENES / "minimal.spore"
    limited = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))
    for target in ("whole", "fresh"):
        said = run(SPORE, "export", scene, "--format", "vtk", "-o", FOLDER / target, status=2, preexec_fn=limited)
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
    main()
finally:
    shutil.rmtree(FOLDER, ignore_errors=True)
