#!/usr/bin/python3
"""Numbers of spore run --output, against what can be computed by hand. test_numbers.py SPORE."""
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

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import shapes
from tap import check, main, wait_for_work

SPORE = os.path.abspath(sys.argv[1])
WORK = pathlib.Path(tempfile.mkdtemp(prefix="spore-numbers-"))
SCENES = pathlib.Path(__file__).resolve().parent.parent.parent / "resources" / "scenes"
MINIMAL = SCENES / "minimal.spore"
G = 9.81
SCENE = """<?xml version="1.0" encoding="UTF-8"?>
<spore version="1.0">
  <environment gravity="%s"/>
  <solver %s/>
  <assets><mesh name="ball" file="ball.off"/><spheres name="one" file="one.spheres"/></assets>
  <bodies>%s</bodies>
  <links>%s</links>
</spore>
"""
BALL = """<body name="%s" role="passive" position="%s" velocity="%s"><mechanical geometry="ball"><rigid_body density="1000"/></mechanical>%s</body>"""
TOUCH = """<collision spheres="one" damping="0"/>"""
RADIUS = 0.02


def file(name, content):
    path = WORK / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def scene(name, gravity, solver, bodies, links=""):
    file("ball.off", shapes.off(*shapes.sphere(RADIUS)))
    file("one.spheres", f"0 0 0 {RADIUS}\n")
    return file(name, SCENE % (gravity, solver, "".join(bodies), links))


def spore(*arguments, status=0, **options):
    done = subprocess.run([SPORE, *map(str, arguments)], capture_output=True, text=True, timeout=300, cwd=WORK, **options)
    assert done.returncode == status, f"{arguments}: status {done.returncode}\n{done.stdout}\n{done.stderr}"
    return done


def refuses(*arguments, says):
    """Status 2, one line that holds every text of `says`; nothing is written."""
    done = spore("run", *arguments, status=2)
    assert len(done.stderr.splitlines()) == 1 and not done.stdout, done
    for text in says:
        assert text in done.stderr, f"'{text}' is not in: {done.stderr}"
    return done.stderr


def numbers(path, *options, status=0):
    """The columns of a run by name, from CSV; and the units."""
    spore("run", path, "--quiet", "--output", "n.csv", *options, status=status)
    with open(WORK / "n.csv", newline="") as opened:
        rows = list(csv.reader(opened))
    heads = [re.fullmatch(r"(.*?)(?: \[(.*)\])?", head).groups() for head in rows[0]]
    columns = {name: [float(row[i]) for row in rows[1:]] for i, (name, unit) in enumerate(heads)}
    return columns, dict(heads)


@check
def a_ball_falls_freely():
    """Free fall: a constant acceleration is met to rounding; place, momentum and energies are what they must be."""
    n, units = numbers(MINIMAL, "--steps", 60, "--watch", "ball@0.0015,0.06,0.001")
    point = "watch.ball@0.0015,0.06,0.001."
    assert units["time"] == "s" and units[point + "y"] == "m" and units[point + "velocity_y"] == "m/s"
    assert units["energy.total"] == "J" and units["momentum.y"] == "N s" and units["contacts.count"] is None
    assert len(n["time"]) == 61 and n["time"][0] == 0 and abs(n["time"][-1] - 0.06) < 1e-15
    for i, t in enumerate(n["time"]):
        assert abs(n[point + "velocity_y"][i] + G * t) < 1e-13
        exact = 0.06 - G * t * t / 2
        assert abs(n[point + "y"][i] - (exact - G * 0.001 * t / 2)) < 1e-14 # implicit Euler: first order, the error known
        assert abs(n[point + "x"][i] - 0.0015) < 1e-16
        assert n["contacts.count"][i] == n["unsolved.steps"][i] == 0
    mass = n["momentum.y"][-1] / n[point + "velocity_y"][-1]
    assert abs(mass - 1060 * 4 / 3 * math.pi * RADIUS**3) < 0.03 * mass # of a mesh inside the sphere
    kinetic = 0.5 * mass * (G * 0.06) ** 2
    assert abs(n["energy.kinetic"][-1] - kinetic) < 1e-12 * kinetic
    assert abs(n["energy.gravity"][-1] - mass * G * n[point + "y"][-1]) < 1e-12
    for i in range(61):
        parts = sum(n["energy." + kind][i] for kind in ("kinetic", "elastic", "gravity", "contact"))
        assert abs(parts - n["energy.total"][i]) < 1e-15


@check
def the_report_says_errors_and_depths():
    """--json: the estimated local error of free fall by implicit Euler is g h^2 / 2; depth and force are the largest of all steps."""
    fall = json.loads(spore("run", MINIMAL, "--steps", 70, "--json").stdout)
    assert fall["local_error"]["samples"] == 2 and fall["local_error"]["body"] == "ball" and fall["contacts"]["depth_max_m"] == 0
    assert abs(fall["local_error"]["max"] - G * 0.001**2 / 2) < 1e-12 and abs(fall["local_error"]["mean"] - fall["local_error"]["max"]) < 1e-12
    none = json.loads(spore("run", MINIMAL, "--steps", 2, "--json").stdout)["local_error"]
    assert none == {"samples": 0, "mean": None, "max": None, "body": None}
    hit = json.loads(spore("run", MINIMAL, "--steps", 300, "--json", "--output", "n.csv", "--quantities", "contacts").stdout)
    with open(WORK / "n.csv", newline="") as opened:
        rows = [[float(cell) for cell in row] for row in list(csv.reader(opened))[1:]]
    assert hit["contacts"]["depth_max_m"] == max(row[2] for row in rows) > 0 and hit["contacts"]["force_max_N"] == max(row[3] for row in rows) > 0
    assert hit["contacts"]["max"] == max(row[1] for row in rows)


@check
def what_rests_weighs_on_the_floor():
    """At rest the reaction on the floor is m g; so is the sum of the contacts' normal forces where they are vertical."""
    one = scene("rest.spore", f"0 {-G} 0", 'time_step="0.001" sleep_speed="0"',
                [BALL % ("ball", "0 0.0399 0", "0 0 0", TOUCH), '<body name="floor" role="unmovable"><collision spheres="one"/></body>'])
    n, units = numbers(one, "--time", 3, "--quantities", "reactions,contacts,momentum", "--every", 0.01, "--set", "bodies/ball/collision/damping=2")
    assert len(n["time"]) == 301 and units["reactions.floor.y"] == "N" and not any(name.startswith("reactions.ball") for name in n)
    mass = 1000 * 4 / 3 * math.pi * RADIUS**3
    weight = -n["reactions.floor.y"][-1]
    assert abs(weight / (mass * G) - 1) < 0.03 # of a mesh inside the sphere
    assert abs(n["contacts.force"][-1] - weight) < 1e-6 * weight and n["contacts.count"][-1] == 1
    assert abs(n["momentum.y"][-1]) < 1e-6 and 0 < n["contacts.depth"][-1] < 0.001
    assert abs(weight - exact_weight(one)) < 1e-5 * weight # steps are solved to 1e-6 of it, each
    assert n["reactions.floor.y"][0] == 0 and n["contacts.count"][0] == 0 # no step was taken yet


def exact_weight(path):
    """m g of the ball in a scene, from its momentum after one free step."""
    n, _ = numbers(path, "--steps", 1, "--quantities", "momentum,bodies", "--set", "bodies/ball/position=0 1 0")
    return G * n["momentum.y"][1] / n["bodies.ball.velocity_y"][1]


@check
def a_spring_oscillates():
    """A ball on a spring swings as a cosine, and the energy goes to and fro between motion and spring."""
    stiffness, reach = 50, 0.01
    path = scene("spring.spore", "0 0 0", 'time_step="0.0005" integrator="tr_bdf2"', [BALL % ("ball", "0 0 0", "0 0 0", "")],
                 f'<spring name="s" body_a="ball" point_a="0 0 0" point_b="0 {0.1 + reach} 0" rest_length="0.1" stiffness="{stiffness}" damping="0"/>')
    n, units = numbers(path, "--time", 0.5, "--watch", "ball@0,0,0")
    mass = max(n["energy.total"]) and n["momentum.y"][20] / n["watch.ball@0,0,0.velocity_y"][20]
    omega = math.sqrt(stiffness / mass)
    assert units["links.s.load"] == "N" and omega * 0.5 > 15 # more than two swings
    for i, t in enumerate(n["time"]):
        exact = reach * (1 - math.cos(omega * t))
        assert abs(n["watch.ball@0,0,0.y"][i] - exact) < 1e-3 * reach, (t, n["watch.ball@0,0,0.y"][i], exact)
        assert abs(n["energy.kinetic"][i] - 0.5 * mass * n["watch.ball@0,0,0.velocity_y"][i] ** 2) < 1e-12
        assert abs(n["energy.total"][i] - 0.5 * stiffness * reach**2) < 1e-3 * 0.5 * stiffness * reach**2
        if i > 0:
            assert abs(n["links.s.load"][i] - stiffness * abs(reach - n["watch.ball@0,0,0.y"][i])) < 2e-3 * stiffness * reach
            assert abs(n["links.s.x"][i]) < 1e-9


@check
def a_collision_keeps_momentum():
    """Two balls meet beside their middles: momentum and angular momentum stay, though each ball's own changes."""
    path = scene("collide.spore", "0 0 0", 'time_step="0.0002"',
                 [BALL % ("a", "-0.03 0.005 0.01", "0.5 0 0", TOUCH), BALL % ("b", "0.03 0 0", "-0.2 0.1 0", TOUCH)])
    n, _ = numbers(path, "--time", 0.1, "--quantities", "momentum,angular_momentum,contacts,bodies,energy")
    moved = [abs(n["bodies.a.velocity_x"][i] - 0.5) for i in range(len(n["time"]))]
    assert moved[0] < 1e-12 and moved[-1] > 0.1 and max(n["contacts.force"]) > 0.1 and n["contacts.count"][-1] == 0
    for name in ("momentum.x", "momentum.y", "momentum.z", "angular_momentum.x", "angular_momentum.y", "angular_momentum.z"):
        scale = 0.03 if name.startswith("m") else 0.03 * 0.05 # kg m/s; and times the distance
        assert max(abs(value - n[name][0]) for value in n[name]) < 1e-9 * scale, name
    assert n["energy.total"][-1] < n["energy.total"][0] * (1 + 1e-12)


@check
def files_hold_the_same():
    """JSON has what CSV has, every so many steps; the file says nothing of the clock and is the same again."""
    numbers(MINIMAL, "--steps", 40, "--every", 0.004, "--watch", "ball@0.0015,0.06,0.001", "--watch", "floor@0,0,0")
    table = (WORK / "n.csv").read_bytes()
    assert table.count(b"\r\n") == 12 and b'"watch.floor@0,0,0.x [m]"' in table
    rows = [[float(cell) for cell in row] for row in list(csv.reader(table.decode().splitlines()))[1:]]
    done = spore("run", MINIMAL, "--steps", 40, "--every", 0.004, "--watch", "ball@0.0015,0.06,0.001", "--watch", "floor@0,0,0", "--output", "n.json")
    assert "n.json: 11 rows of " in done.stdout
    answer = json.loads((WORK / "n.json").read_text())
    assert set(answer) == {"scene", "dt_s", "columns", "rows"} and answer["scene"] == str(MINIMAL) and answer["dt_s"] == 0.001
    assert answer["columns"][0] == {"name": "time", "unit": "s"} and len(answer["columns"]) == len(rows[0])
    assert answer["rows"] == rows # to the bit
    spore("run", MINIMAL, "--steps", 40, "--every", 0.004, "--watch", "ball@0.0015,0.06,0.001", "--watch", "floor@0,0,0", "--output", "again.csv", "--threads", 2)
    assert (WORK / "again.csv").read_bytes() == table
    spore("run", MINIMAL, "--steps", 2, "--quantities", "step_time,stages", "-o", "clock.json")
    clock = json.loads((WORK / "clock.json").read_text())
    assert clock["rows"][0][1] is None and clock["rows"][2][1] > 0 # no step was taken at time 0
    assert "stages.integrate" in [column["name"] for column in clock["columns"]] and "stages.tear" not in str(clock["columns"])


@check
def measuring_changes_nothing():
    """A run that is measured has the same bits as one that is not; an output of a run that was not solved is written."""
    path = SCENES / "plate8-clamp.spore"
    plain = json.loads(spore("run", path, "--steps", 50, "--json").stdout)
    measured = json.loads(spore("run", path, "--steps", 50, "--json", "-o", "m.csv", "--quantities",
                                "energy,momentum,angular_momentum,contacts,solver,unsolved,bodies,links,reactions,devices,step_time,stages").stdout)
    assert plain["state_hash"] == measured["state_hash"] and measured["dof"] == plain["dof"]
    unsolved = scene("unsolved.spore", f"0 {-G} 0", 'time_step="0.001"',
                     [BALL % ("ball", "0 0.06 0", "0 -60 0", TOUCH), '<body name="floor" role="unmovable"><collision spheres="one"/></body>'])
    n, _ = numbers(unsolved, "--steps", 20, "--quantities", "unsolved", status=1)
    steps = n["unsolved.steps"]
    assert steps[0] == 0 < steps[-1] and steps == sorted(steps)


@check
def bad_requests_are_refused():
    """Names, places and times that cannot be: one line with the remedy, and no file."""
    out = ["--steps", 3, "--output", "bad.csv"]
    listed = ", ".join(("time", "energy", "momentum", "angular_momentum", "contacts", "solver", "unsolved", "watch", "bodies", "links", "reactions"))
    for given in ("nope", "energy,nope", ""):
        refuses(MINIMAL, *out, "--quantities", given, says=["--quantities", given.split(",")[-1], listed])
    refuses(MINIMAL, "--quantities", "nope", says=[listed])
    refuses(MINIMAL, *out, "--quantities", "watch", says=["watch", "--watch BODY@X,Y,Z"])
    for alone in (["--quantities", "energy"], ["--watch", "ball@0,0.06,0"], ["--every", 0.001]):
        refuses(MINIMAL, *alone, says=[alone[0], "--output"])
    refuses(MINIMAL, *out, "--watch", "gone@0,0,0", says=["gone", "floor, ball"])
    for place in ("ball", "ball@", "ball@1,2", "ball@1,2,3,4", "ball@1,2,nan", "@0,0,0", "ball@0, 0,0"):
        refuses(MINIMAL, *out, "--watch", place, says=[place, "BODY@X,Y,Z"])
    for every, says in (("0", "0.001"), ("0.0004", "0.001"), ("0.0015", "0.001 s and 0.002 s"), ("0.00299", "0.002 s and 0.003 s"), ("-1", "0 s or more"), ("x", "0 s or more"), ("1e30", "")):
        refuses(MINIMAL, *out, "--every", every, says=["--every", says])
    for name in ("bad.txt", "bad", "bad.csv.gz", ".json/"):
        refuses(MINIMAL, "--steps", 3, "--output", name, says=[name, ".csv or .json"])
    refuses(MINIMAL, "--steps", 3, "--output", "no/such/bad.csv", says=["no/such/bad.csv"])
    refuses(MINIMAL, *out, "--record", "./bad.csv", says=["--record", "bad.csv"])
    assert not list(WORK.glob("**/bad*")) and not list(WORK.glob(".spore-*"))


@check
def the_nearest_point_is_said():
    """A place outside the body is refused with the body's nearest point, which is then taken; one on its skin is taken."""
    said = refuses(MINIMAL, "--steps", 3, "--output", "bad.csv", "--watch", "ball@0.1,0.06,0.001", says=["ball@0.1,0.06,0.001", "outside", "mean edge"])
    nearest = said.split()[-1]
    place = [float(number) for number in nearest.partition("@")[2].split(",")]
    assert math.dist(place, (0.0215, 0.06, 0.001)) < 0.002, nearest
    n, _ = numbers(MINIMAL, "--steps", 1, "--watch", nearest)
    assert math.dist([n[f"watch.{nearest}.{axis}"][0] for axis in "xyz"], place) < 1e-12
    allowed = float(re.search(r"at most ([\d.e-]+) m", said)[1])
    for beyond, taken in ((0.5 * allowed, True), (1.5 * allowed, False)):
        spore("run", MINIMAL, "--steps", 1, "--output", "edge.csv", "--watch", f"ball@{place[0] + beyond},{place[1]},{place[2]}", status=0 if taken else 2)
    for name in ("table1-deformable", "table1-spline-2d", "table1-spline-1d", "table1-mass-spring", "table1-rigid"):
        path = SCENES / f"{name}.spore" # bodies of other kinds: far away from all, and where that says
        body = re.search(r'<body name="([^"]+)"[^>]*>\s*<mechanical', path.read_text())[1]
        said = refuses(path, "--steps", 1, "--output", "bad.csv", "--watch", f"{body}@50,50,50", says=["outside"])
        n, _ = numbers(path, "--steps", 1, "--watch", said.split()[-1])
        assert len([column for column in n if column.startswith("watch.")]) == 6


@check
def points_are_followed():
    """A watched point moves by its own velocity, as implicit Euler moves it, while nodes are cut apart and levels change."""
    changes = ["--set", "bodies/ovary_right/fidelity/automatic=none", "--level", "ovary_right=coarse@0.3", "--level", "ovary_right=fine@0.8"]
    for name, options, jumps in (("cut-ovary", [], 0), ("levels", changes, 2)):
        path, step = SCENES / f"{name}.spore", 0.004
        said = refuses(path, "--steps", 1, "--output", "bad.csv", "--watch", "ovary_right@50,50,50", says=["outside"])
        point = said.split()[-1]
        done = json.loads(spore("run", path, "--time", 1.6, "--json", "--output", "follow.json", "--watch", point, "--quantities", "watch", *options).stdout)
        assert done["levels"][0]["changes"] == jumps if options else done["tools"][0]["cut"] > 0
        rows = json.loads((WORK / "follow.json").read_text())["rows"]
        off = [math.dist(b[1:4], [a[k] + step * b[3 + k] for k in (1, 2, 3)]) for a, b in zip(rows, rows[1:])]
        assert math.dist(rows[0][1:4], [float(x) for x in point.partition("@")[2].split(",")]) < 1e-12
        assert sorted(off)[-1 - jumps] < 1e-15 and max(off) < 1e-3 and (max(off) > 1e-9) == (jumps > 0), sorted(off)[-4:]
        assert max(math.dist(row[1:4], rows[0][1:4]) for row in rows) > 1e-3


@check
def no_output_destroys_an_input():
    """The output is never the scene or the track, also by another name."""
    path = scene("own.spore", "0 0 0", 'time_step="0.001"', [BALL % ("ball", "0 0 0", "0 0 0", "")])
    before = path.read_bytes()
    (WORK / "own.json").symlink_to("own.spore")
    refuses(path, "--steps", 3, "--output", "own.json", says=["own.json", "input"])
    track = file("moves.track", "")
    (WORK / "moves.csv").symlink_to("moves.track")
    refuses(path, "--steps", 3, "--input", track, "--output", "moves.csv", says=["moves.csv", "input"])
    assert path.read_bytes() == before


@check
def interruption_keeps_the_file():
    """Ctrl-C leaves the file that was there, and no part of a new one."""
    kept = file("kept.csv", "old numbers\n")
    process = subprocess.Popen([SPORE, "run", MINIMAL, "--steps", "1000000000", "--every", "1", "--output", kept], cwd=WORK, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    wait_for_work(process)
    process.send_signal(signal.SIGTERM)
    process.communicate(timeout=60)
    assert process.returncode == 130 and kept.read_text() == "old numbers\n" and not list(WORK.glob(".spore-*"))


if __name__ == "__main__":
    main()
