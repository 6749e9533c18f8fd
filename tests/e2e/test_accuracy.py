#!/usr/bin/python3
"""spore accuracy from end to end. test_accuracy.py SPORE."""
import csv
import json
import math
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import shapes
from tap import check, is_sanitized, long_run, main, wait_for_work

SPORE = os.path.abspath(sys.argv[1])
WORK = pathlib.Path(tempfile.mkdtemp(prefix="spore-accuracy-"))
SCENES = pathlib.Path(__file__).resolve().parent.parent.parent / "resources" / "scenes"
MINIMAL = SCENES / "minimal.spore"
# A ball on a spring: it swings between its place and twice m g / k below.
SWING = """<?xml version="1.0" encoding="UTF-8"?>
<spore version="1.0">
  <environment gravity="0 -9.81 0"/>
  <solver time_step="0.002" integrator="tr_bdf2" tolerance="1e-10"/>
  <assets><mesh name="ball" file="ball.off"/></assets>
  <bodies>
    <body name="ball"><mechanical geometry="ball"><rigid_body mass="0.5"/></mechanical></body>
    <body name="wall" role="unmovable"/>
  </bodies>
  <links><spring name="spring" body_a="ball" point_a="0 0 0" point_b="0 0.2 0" stiffness="200" damping="0" rest_length="0.2"/></links>
</spore>
"""
FEW = ("--methods", "implicit_euler,tr_bdf2,rk4", "--dt", "0.001:0.008:4", "--time", "0.2", "--full")


def spore(*arguments, status=0):
    done = subprocess.run([SPORE, "accuracy", *map(str, arguments)], capture_output=True, text=True, timeout=300, cwd=WORK)
    assert done.returncode == status, f"{arguments}: status {done.returncode}\n{done.stdout}\n{done.stderr}"
    return done


def refuses(*arguments, says, status=2):
    """One line that holds every text of `says`; nothing is written."""
    before = sorted(WORK.iterdir())
    done = spore(*arguments, status=status)
    assert len(done.stderr.splitlines()) == 1 and not done.stdout, done
    for text in says:
        assert text in done.stderr, f"'{text}' is not in: {done.stderr}"
    assert sorted(WORK.iterdir()) == before


def swing(name="swing.spore", replace=("", "")):
    content = shapes.off(*shapes.sphere(0.02))
    (WORK / "ball.off").write_bytes(content if isinstance(content, bytes) else content.encode())
    path = WORK / name
    path.write_text(SWING.replace(*replace))
    return path


def falling():
    """A box that falls onto one sphere, felt by 16 spheres that were generated."""
    corners = [(x, y, z) for x in (-0.04, 0.04) for y in (-0.02, 0.02) for z in (-0.03, 0.03)]
    faces = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)]
    path = WORK / "falling/falling.spore"
    path.parent.mkdir(exist_ok=True)
    content = shapes.off(corners, faces)
    (path.parent / "box.off").write_bytes(content if isinstance(content, bytes) else content.encode())
    (path.parent / "floor.spheres").write_text("0 -0.5 0 0.48\n")
    subprocess.run([SPORE, "spheres", path.parent / "box.off", "--count", "16", "--unit", "m", "-o", path.parent / "box.spheres", "--quiet"], check=True)
    path.write_text("""<?xml version="1.0" encoding="UTF-8"?>
<spore version="1.0">
  <environment gravity="0 -9.81 0"/>
  <solver time_step="0.002"/>
  <assets><mesh name="box" file="box.off"/><spheres name="felt" file="box.spheres" source="box" count="16"/><spheres name="below" file="floor.spheres"/></assets>
  <bodies>
    <body name="box" position="0.01 0.005 0"><mechanical geometry="box"><rigid_body mass="0.2"/></mechanical><collision spheres="felt" stiffness="2000" damping="5"/></body>
    <body name="floor" role="unmovable"><collision spheres="below" stiffness="2000" damping="5"/></body>
  </bodies>
</spore>
""")
    return path


def points_of(report, method):
    return [point for point in report["points"] if point["method"] == method]


@check
def report_holds_what_the_contract_says():
    """Members, the Pareto set, the files: all say the same."""
    files = ("--csv", "a.csv", "--svg", "a.svg", "--html", "a.html")
    done = spore(swing(), *FEW, "--json", *files)
    report = json.loads(done.stdout)
    assert {"method", "dt_s", "own_error"} <= set(report["reference"])
    members = {"method", "dt_s", "level", "error", "energy_drift", "penetration", "us_per_step", "real_time_factor", "stable"}
    assert len(report["points"]) == 12 and all(members <= set(point) for point in report["points"])
    pareto = [report["points"][i] for i in report["pareto"]]
    assert pareto and all(point["pareto"] and point["stable"] for point in pareto)
    assert all(a["error"] > b["error"] and a["cpu_s"] < b["cpu_s"] for a, b in zip(pareto, pareto[1:])), pareto
    assert all(point["gap_m"] == 0 and point["line_stretch"] is None for point in report["points"]), "a spring, and no line"
    assert report["sentence"].startswith("tr_bdf2 at 2 ms: ") and report["sentence"] in (WORK / "a.html").read_text()
    with open(WORK / "a.csv", newline="") as opened:
        rows = list(csv.DictReader(opened))
    for row, point in zip(rows, report["points"], strict=True):
        assert row["method"] == point["method"] and math.isclose(float(row["error"]), point["error"], rel_tol=1e-9)
    drawn = xml.etree.ElementTree.parse(WORK / "a.svg")
    assert "rk4" in "".join(drawn.getroot().itertext())
    page = (WORK / "a.html").read_text()
    assert "<svg" in page and not re.search(r'(src|href)="', page) and page.count("<tr") == 13


def named(report, words):
    """The point that the sentence calls "METHOD at N ms"."""
    method, step = re.fullmatch(r"(\S+) at (\S+) ms", words).groups()
    return next(p for p in points_of(report, method) if f"{1e3 * p['dt_s']:.3g}" == step)


@check
def the_sentence_says_what_the_points_say():
    """Whatever a clock makes of costs: what is called nearer is sound, as much nearer as is said, and takes the time that is
    said; where nothing is called nearer, nothing sound is for the same time."""
    report = json.loads(spore(swing(replace=('integrator="tr_bdf2"', 'integrator="implicit_euler"')), *FEW, "--json").stdout)
    first, _, second = report["sentence"].partition("; ")
    own, floor = named(report, first.partition(":")[0]), report["resolution"]["floor"]
    same_time = [p for p in report["points"] if p["sound"] and p["cpu_s"] <= 1.1 * own["cpu_s"] and 1.2 * max(p["error"], floor) < own["error"]]
    if "nothing" in second:
        assert not same_time, (second, same_time)
    found = re.search(r"(\S+ at \S+ ms) is (at least )?(\S+) times closer for (the same|(\S+) times the) time", second)
    assert found or second == "nothing that was tried is nearer for the same time", report["sentence"]
    if found:
        better = named(report, found[1])
        assert better["sound"] and math.isclose(own["error"] / max(better["error"], floor), float(found[3]), rel_tol=0.06), (found[0], better, own)
        assert bool(found[2]) == (better["error"] < floor), (found[0], better)
        assert better["cpu_s"] / own["cpu_s"] <= 1.1 if not found[5] else math.isclose(better["cpu_s"] / own["cpu_s"], float(found[5]), rel_tol=0.06), (found[0], better, own)


@check
@long_run
def what_is_far_off_is_not_praised():
    """Position-based steps of 4 ms on a net give it energies thousands of times what is at work: none of them is sound, nor in
    the Pareto set, and the table says so."""
    wanted = (SCENES / "table1-mass-spring.spore", "--methods", "implicit_euler,tr_bdf2,position_based", "--dt", "0.001:0.004:3", "--time", "0.05", "--full")
    report = json.loads(spore(*wanted, "--json", "--html", "far.html").stdout)
    for point in report["points"]:
        right = point["stable"] and point["as_written"] and point["energy_drift"] <= 1
        assert point["sound"] == right and (right or not point["pareto"]), point
    swept = points_of(report, "position_based")
    assert swept and not any(p["sound"] for p in swept) and all(p["sound"] for p in points_of(report, "implicit_euler")), report["points"]
    rows = [row for row in (WORK / "far.html").read_text().split("<tr") if "position_based" in row]
    assert len(rows) >= 3 and all(re.search("not stable|not as written|energy far off|below what", row) for row in rows if "<td>" in row), rows


@check
def methods_that_go_the_same_way_are_said_to():
    """A ball that bounces is moved alike by several methods: the second one, which checks the reference, is none of these."""
    report = json.loads(spore(MINIMAL, "--dt", "0.0005:0.004:4", "--time", "0.5", "--full", "--json").stdout)
    alike = {method["name"]: method["alike"] or method["name"] for method in report["methods"]}
    assert alike["implicit_euler"] == alike["symplectic_euler"] and alike["tr_bdf2"] == alike["implicit_midpoint"] == "tr_bdf2", alike
    reference = report["reference"]
    assert alike[reference["method"]] != alike[reference["cross_method"]], (reference, alike)
    apart = json.loads(spore(swing(), *FEW, "--json").stdout)
    assert all(method["alike"] is None for method in apart["methods"]), apart["methods"]


@check
def plots_are_pictures_where_that_can_be():
    """PNG of at least the size of the plot, or a refusal before any work."""
    done = subprocess.run([SPORE, "accuracy", swing(), *FEW, "--png", "a.png"], capture_output=True, text=True, cwd=WORK)
    if done.returncode == 0:
        content = (WORK / "a.png").read_bytes()
        assert content.startswith(b"\x89PNG") and int.from_bytes(content[16:20], "big") >= 960
    else:
        assert done.returncode == 2 and done.stderr.startswith("--png: ") and "--svg" in done.stderr and not (WORK / "a.png").exists(), done


@check
def errors_are_those_of_the_swing():
    """A ball on a spring swings by a cosine: what is said of each point of implicit Euler follows from that."""
    report = json.loads(spore(swing(), *FEW, "--json").stdout)
    orders = {method["name"]: method["order"] for method in report["methods"]}
    assert abs(orders["implicit_euler"] - 1) < 0.2 and abs(orders["tr_bdf2"] - 2) < 0.3, orders
    assert report["reference"]["agreed"] and not report["resolution"]["chaotic"]
    # implicit Euler damps and slows the swing: its error follows from the roots of its step, 1 / (1 -+ i h w)
    w, g_w2 = math.sqrt(200 / 0.5), 9.81 * 0.5 / 200
    length = 2 * math.sqrt(3) * 0.02 * math.sqrt(1 / 5) # box around the points at the radii of gyration of a ball
    for point in points_of(report, "implicit_euler"):
        h, squares = point["dt_s"], []
        for k in range(1, 26):
            n, t = round(0.008 * k / h), 0.008 * k
            factor, angle = (1 + (h * w) ** 2) ** (-n / 2), n * math.atan(h * w)
            squares.append((g_w2 * (factor * math.cos(angle) - math.cos(w * t))) ** 2)
        expected = math.sqrt(sum(squares) / len(squares)) / length
        assert math.isclose(point["error"], expected, rel_tol=0.05), (h, point["error"], expected)


@check
def solvers_are_an_axis():
    report = json.loads(spore(swing(), "--methods", "implicit_euler,tr_bdf2/newton,rk4", "--nonlinear", "newton,broyden", "--dt", "0.002:0.008:3", "--time", "0.05", "--json").stdout)
    assert [method["name"] for method in report["methods"]] == ["implicit_euler/newton", "implicit_euler/broyden", "tr_bdf2/newton", "rk4"]


@check
@long_run
def fewer_spheres_feel_otherwise():
    """More spheres come nearer to the finest set; the scene's file stays as it is."""
    scene = falling()
    before, wanted = scene.read_bytes(), ("--methods", "implicit_euler,tr_bdf2", "--dt", "0.001:0.004:3", "--time", "0.3", "--full", "--spheres", "1,0.25,4")
    report = json.loads(spore(scene, *wanted, "--json", "--html", "s.html").stdout)
    few, same, finest = report["spheres"]
    assert [row["factor"] for row in report["spheres"]] == [0.25, 1, 4] and few["count"] < same["count"] < finest["count"]
    for figure in ("force", "depth", "error"): # a bounce in large steps: the last are what steps alone do
        assert few[figure] > 1.5 * same[figure] > 3 * finest[figure], (figure, report["spheres"])
    assert scene.read_bytes() == before and (WORK / "s.html").read_text().count("<table>") == 2
    assert json.loads(spore(swing(), *FEW, "--json").stdout)["spheres"] == []


@check
def the_stretch_begins_where_something_happens():
    """Jaws come to a tube after 1.5 s, open, led by a device: their state there is taken over."""
    report = json.loads(spore(SCENES / "plate8-clamp.spore", "--methods", "implicit_euler,bdf2", "--seconds", 20 if is_sanitized(SPORE) else 4, "--json").stdout)
    assert 1.4 < report["stretch"]["start_s"] < 1.52 and report["stretch"]["contacts"] > 1, (report["stretch"], report["cut"])


@check
@long_run
def less_time_cuts_more():
    """What cannot be had in a few seconds is cut, and said: it would take minutes. A full study cuts nothing."""
    seconds = 20 if is_sanitized(SPORE) else 2
    short = json.loads(spore(SCENES / "plate2-tissue.spore", "--seconds", seconds, "--json").stdout)
    assert short["stretch"]["time_s"] < 1 and any("instead of 1" in cut for cut in short["cut"]), short["cut"]
    full = json.loads(spore(swing(), *FEW, "--json").stdout)
    assert full["stretch"]["time_s"] >= 0.2 and not any("instead of" in cut for cut in full["cut"]), full["cut"]


@check
def people_get_a_table():
    text = spore(swing(), *FEW).stdout
    for said in ("reference: ", "comes to the same within", "order of implicit_euler: ", "Pareto", "tr_bdf2 at 2 ms: "):
        assert said in text, text
    assert spore(swing(), *FEW, "--quiet").stdout == ""


@check
def help_explains_json():
    described = spore("--help").stdout.partition("--json prints:")[2]
    rows = {row.split()[0]: row for row in described.strip().splitlines()}
    for name, value in json.loads(spore(swing(), *FEW, "--json").stdout).items():
        below = value[0] if isinstance(value, list) and value else value
        for member in below if isinstance(below, dict) else ():
            assert member in rows[name], f"--help does not name {name}.{member}"
        assert name in rows, name


@check
def bad_wishes_are_refused():
    scene = swing()
    refuses(scene, "--methods", "nope", says=["--methods", "nope", "implicit_euler"])
    refuses(scene, "--methods", "tr_bdf2/nope", says=["--methods", "nope", "broyden"])
    refuses(scene, "--linear", "nope", says=["--linear", "nope"])
    for wrong in ("0.1", "0.01:0.001:5", "0:0.01:5", "0.001:0.01:2", "0.001:1:5", "0.001:0.01:2.5", "a:b:c"):
        refuses(scene, "--dt", wrong, says=["--dt", wrong, "LO:HI:N"])
    refuses(scene, "--time", "0", says=["--time"])
    for wrong in ("0", "0.5", "1e5", "soon"):
        refuses(scene, "--seconds", wrong, says=["--seconds"])
    for wrong in ("1", "2,2", "0,1", "a,b", "1,100"):
        refuses(scene, "--spheres", wrong, says=["--spheres", wrong, "0.5,1,2"])
    refuses(scene, "--spheres", "1,2", says=["generated", "spore spheres"])
    refuses(scene, "--seconds", "5", "--full", says=["--seconds", "--full"])
    refuses(scene, "--body", "liver", says=["--body", "liver", "ball"])
    refuses(scene, "--body", "wall", says=["--body", "wall", "passive"])
    refuses(scene, "--levels", "coarse", says=["--levels", "levels"])
    refuses(scene, "--levels", "nope", says=["--levels", "nope"])
    refuses(scene, "--svg", "nowhere/a.svg", says=["nowhere"])
    before = scene.read_bytes()
    refuses(scene, "--csv", scene.name, says=[scene.name, "input"])
    assert scene.read_bytes() == before


@check
def scenes_that_cannot_run_are_refused():
    refuses("missing.spore", "--csv", "never.csv", says=["missing.spore"])
    still = swing("still.spore", ('<rigid_body mass="0.5"/>', ""))
    refuses(still, "--csv", "never.csv", says=["still.spore", "model"])


@check
def a_reference_that_does_not_converge_is_said():
    """A ball that bounces off spheres, in steps far too large: no figures, no file, status 1."""
    refuses(MINIMAL, "--dt", "0.02:0.1:3", "--methods", "implicit_euler", "--csv", "never.csv", says=["no reference converges", "--time"], status=1)


@check
def interruption_leaves_no_part():
    (WORK / "kept.csv").write_text("old numbers\n")
    arguments = [SPORE, "accuracy", SCENES / "table1-deformable.spore", "--full", "--csv", "kept.csv", "--html", "kept.html"]
    process = subprocess.Popen(arguments, cwd=WORK, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    wait_for_work(process)
    process.send_signal(signal.SIGTERM)
    out, _ = process.communicate(timeout=60)
    assert process.returncode == 130 and not out, (process.returncode, out)
    assert (WORK / "kept.csv").read_text() == "old numbers\n" and not (WORK / "kept.html").exists()


if __name__ == "__main__":
    main()
