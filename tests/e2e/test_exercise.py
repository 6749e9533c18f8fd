#!/usr/bin/python3
"""Exercises, headless: every event and every metric against a run in which it is there and one in which it is not, and
against what can be computed by hand. test_exercise.py SPORE [KIND]: as tap.main has it."""
import base64
import csv
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from tap import alike, check, is_sanitized, long_run, main

SPORE = os.path.abspath(sys.argv[1])
WORK = pathlib.Path(tempfile.mkdtemp(prefix="spore-exercise-"))
SCENES = WORK / "scenes"
shutil.copytree(pathlib.Path(__file__).resolve().parent.parent.parent / "resources" / "scenes", SCENES)
(WORK / "ball.spheres").write_text("0 0 0 0.01\n")
(WORK / "dish.spheres").write_text("".join(f"{x} 0 {z} 0.02\n" for x in (-.02, .02) for z in (-.02, .02)))

# A ball that goes along x at 0.1 m/s for a second, rests, and goes on; a wall, a dish and a second ball that stand in its way.
SCENE = """<?xml version="1.0" encoding="UTF-8"?>
<spore version="1.0"><environment gravity="0 -9.81 0"/><solver time_step="0.01"/>
<assets><spheres name="ball" file="ball.spheres"/><spheres name="dish" file="dish.spheres"/></assets>
<bodies>
<body name="tip" role="active"><collision spheres="ball" stiffness="100"/></body>
<body name="other" role="active" position="0.25 0 0"><collision spheres="ball" stiffness="100"/></body>
<body name="wall" role="unmovable" position="0.115 0 0"><collision spheres="ball"/></body>
<body name="dish" role="unmovable" position="0.2 0.002 0"><collision spheres="dish" group="7"/></body>
</bodies>
<tools><probe name="one" body="tip" device="hand"/><probe name="two" body="other" device="hand"/>
<camera name="eye" position="0 0 0.1" target="0 0 0" field_of_view="0.5"/></tools>
<devices><track name="hand" file="hand.track"/></devices>
<exercise %s>%s</exercise></spore>
"""


def track(way):
    """A line for each 10 ms: way(t) gives x."""
    rows = "".join(f"{t / 100:.2f} {way(t / 100):.9f} 0 0 1 0 0 0 0 0\n" for t in range(401))
    (WORK / "hand.track").write_text(f"spore-track 1\ndevice tip\n{rows}device other\n0 0.25 0 0 1 0 0 0 0 0\n")


def straight(t):
    return 0.1 * min(t, 1) + 0.1 * max(0, t - 2)


track(straight)


def spore(*arguments, status=0, env=None):
    done = subprocess.run([SPORE, *map(str, arguments)], capture_output=True, text=True, timeout=300, cwd=WORK,
                          env={**os.environ, **(env or {})})
    assert done.returncode == status, f"{arguments}: status {done.returncode}\n{done.stdout}{done.stderr}"
    return done


def run(parts, steps, attributes="", *options):
    (WORK / "scene.spore").write_text(SCENE % (attributes, parts))
    return json.loads(spore("run", "scene.spore", "-n", steps, "--json", *options).stdout)["exercise"]


def run_shipped(name, parts, steps, effect=""):
    """A shipped scene, with an exercise of these parts; effect: the body that is one."""
    text = (SCENES / f"{name}.spore").read_text().split("<exercise")[0].replace("</spore>", "")
    mode = ["--set", f"bodies/{effect}/fidelity/mode=effect"] if effect else []
    (SCENES / "part.spore").write_text(f"{text}<exercise>{parts}</exercise></spore>")
    done = subprocess.run([SPORE, "run", SCENES / "part.spore", "-n", str(steps), "--json", *mode], capture_output=True,
                          text=True, timeout=300)
    assert done.returncode in (0, 1), done.stderr
    return json.loads(done.stdout)["exercise"]


def steps(exercise):
    return {step["name"]: step for step in exercise["steps"]}


def metrics(exercise):
    return {metric["name"]: metric for metric in exercise["metrics"]}


def near(value, wanted, within=1e-9):
    assert abs(value - wanted) <= within, (value, wanted)


@check
@alike
def a_place_is_reached_when_the_instrument_is_there():
    found = steps(run('<reached name="near" tool="one" point="0.05 0 0" radius="0.01"/>'
                      '<reached name="stays" tool="one" point="0.1 0 0" radius="0.002" time="0.5"/>'
                      '<reached name="rushes" tool="one" point="0.05 0 0" radius="0.01" time="0.5"/>'
                      '<reached name="never" tool="two" point="0.05 0 0" radius="0.01" hint="Use the other hand."/>', 400))
    near(found["near"]["done_s"], 0.4, 0.021)
    near(found["stays"]["done_s"], 0.98 + 0.5, 0.031)
    assert found["rushes"]["phase"] == found["never"]["phase"] == "open", found
    assert "done_s" not in found["never"]
    assert found["never"]["hint"] == "Use the other hand." and "hint" not in found["near"]
    said = spore("run", "scene.spore", "-n", 100).stdout
    assert "step never: not done; Use the other hand." in said and "step rushes: not done\n" in said, said


@check
@alike
def a_ring_is_passed_in_its_direction_and_within_it():
    ring = '<passed_through name="%s" tool="one" point="0.05 %s 0" direction="%s 0 0" radius="0.01"/>'
    found = steps(run(ring % ("through", "0.005", 1) + ring % ("beside", "0.02", 1) + ring % ("against", "0.005", -1), 200))
    near(found["through"]["done_s"], 0.5, 0.021)
    assert found["beside"]["phase"] == found["against"]["phase"] == "open", found


@check
@alike
def what_is_touched_is_pressed_on():
    found = steps(run('<touched name="yes" tool="one" body="wall"/><touched name="no" tool="two" body="wall"/>'
                      '<touched name="beside" tool="one" body="dish"/>', 200))
    near(found["yes"]["done_s"], 0.96, 0.031)
    assert found["no"]["phase"] == found["beside"]["phase"] == "open", found


@check
@alike
def a_body_is_in_the_dish_when_it_lies_within():
    found = steps(run('<bagged name="in" body="tip" container="dish" share="1"/>'
                      '<bagged name="never" body="other" container="dish" share="1"/>', 400))
    assert found["in"]["phase"] == "done" and found["never"]["phase"] == "open", found
    near(found["in"]["done_s"], 2 + (0.16 - 0.1) / 0.1, 0.021)


@check
@alike
def paths_movements_economy_and_time_are_those_of_the_track():
    found = metrics(run('<path_length name="all"/><path_length name="one" tool="one"/><path_length name="two" tool="two"/>'
                        '<movements name="moves"/><economy name="economy" tool="one"/><economy name="still" tool="two"/>'
                        '<time_taken name="time"/>', 400))
    near(found["one"]["value"], straight(4), 0.002)
    near(found["all"]["value"], found["one"]["value"])
    near(found["two"]["value"], 0)
    near(found["moves"]["value"], 2)
    near(found["economy"]["value"], 1)
    assert found["still"]["value"] is None
    near(found["time"]["value"], 4)


@check
@alike
def a_path_is_that_of_the_tip():
    """A tool that turns about the origin of its body by half a turn, 0.1 m ahead of which it acts; a probe has its tip there."""
    probe, suction = '<probe name="one" body="tip"', '<suction name="one" body="tip" point="0 -0.1 0"'
    rows = "".join(f"{t / 100:.2f} 0 0 0 {math.cos(math.pi * t / 400):.9f} 0 0 {math.sin(math.pi * t / 400):.9f} 0 0\n" for t in range(201))
    parts = ('<path_length name="path" tool="one"/><reached name="side" tool="one" point="0.1 0 0" radius="0.002"/>'
             '<passed_through name="down" tool="one" point="0.070711 -0.070711 0" direction="1 1 0" radius="0.002"/>')
    (WORK / "hand.track").write_text(f"spore-track 1\ndevice tip\n{rows}device other\n0 0.25 0 0 1 0 0 0 0 0\n")
    found = []
    for tool in suction, probe:
        (WORK / "scene.spore").write_text((SCENE % ("", parts)).replace(probe, tool))
        found.append(json.loads(spore("run", "scene.spore", "-n", 200, "--json").stdout)["exercise"])
    track(straight)
    near(metrics(found[0])["path"]["value"], 0.1 * math.pi / 2, 0.002)
    near(metrics(found[1])["path"]["value"], 0)
    assert left(found[0]) == [] and left(found[1]) == ["side", "down"], found


@check
@alike
def a_detour_costs_economy_and_haste_smoothness():
    track(lambda t: 0.001 * t ** 3)
    smooth = metrics(run('<economy name="e" tool="one"/><smoothness name="s" tool="one"/>', 400))
    track(lambda t: 0.001 * t ** 3 + 0.002 * math.sin(40 * t))
    shaky = metrics(run('<economy name="e" tool="one"/><smoothness name="s" tool="one"/>', 400))
    track(straight)
    assert shaky["e"]["value"] < 0.95 < smooth["e"]["value"], (shaky, smooth)
    assert shaky["s"]["value"] > 2 * smooth["s"]["value"], (shaky, smooth)


@check
@alike
def normalised_jerk_is_that_of_a_polynomial():
    """x = t^3: the jerk is 6 m/s^3 throughout; sqrt(1/2 36 T T^5 / L^2) with L = T^3 is sqrt(18)."""
    track(lambda t: 0.001 * t ** 3)
    found = metrics(run('<smoothness name="s" tool="one"/>', 390))["s"]["value"]
    track(straight)
    near(found, math.sqrt(18), 0.1)


@check
@alike
def instruments_collide_once_where_they_stay_in_contact():
    """The balls overlap from 3.3 s to 3.7 s."""
    parts = '<collisions name="c"/><collisions name="of" tool="two"/>'
    for steps_run, wanted in (325, 0), (340, 1), (365, 1), (400, 1):
        found = metrics(run(parts, steps_run))
        assert found["c"]["value"] == found["of"]["value"] == wanted, (steps_run, found)


@check
@alike
def forces_are_those_of_the_wall():
    """The ball of 0.01 m rests 0.005 m deep in the wall's from 1 s to 2 s."""
    found = metrics(run('<peak_force name="peak" tool="one"/><mean_force name="mean" tool="one"/><peak_force name="two" '
                        'tool="two"/><excess_force name="much" tool="one" force="0.01"/>'
                        '<excess_force name="more" tool="one" force="100"/>', 200))
    assert found["peak"]["value"] > 0.1 and 0 < found["mean"]["value"] <= found["peak"]["value"], found
    near(found["much"]["value"], 1.05, 0.021)
    assert found["more"]["value"] == found["two"]["value"] == 0, found
    before = metrics(run('<peak_force name="peak"/><mean_force name="mean"/>', 90))
    assert before["mean"]["value"] == before["peak"]["value"] == 0, before


@check
@alike
def what_leaves_the_view_is_out_of_it():
    """The view is as wide as 0.1 tan(0.25) at the middle: left after 0.255 s."""
    found = metrics(run('<out_of_view name="one" tool="one" camera="eye"/><out_of_view name="any" camera="eye"/>', 100))
    near(found["one"]["value"], 1 - math.tan(0.25), 0.021)
    near(found["any"]["value"], 1)


@check
@alike
def order_and_conditions_hold():
    parts = ('<reached name="far" tool="one" point="0.1 0 0" radius="0.002"/>'
             '<reached name="near" tool="one" point="0.05 0 0" radius="0.002"/>')
    free, given = steps(run(parts, 200)), steps(run(parts, 200, 'order="given"'))
    assert free["near"]["phase"] == "done" and given["near"]["phase"] == "open" and given["far"]["phase"] == "done"
    after = steps(run(parts.replace('name="near"', 'name="near" after="far"'), 50))
    assert after["near"]["phase"] == "waiting", after


@check
@alike
def time_limit_ends_it_and_done_stops_the_clock():
    part = '<reached name="far" tool="one" point="0.1 0 0" radius="0.002"/><time_taken name="t"/>'
    late, soon = run(part, 200, 'time_limit="0.5"'), run(part, 200)
    assert late["phase"] == "out_of_time" and late["score"] == 0 and not late["passed"], late
    assert soon["phase"] == "done" and soon["passed"] and soon["score"] == 100, soon
    near(metrics(soon)["t"]["value"], steps(soon)["far"]["done_s"])


@check
@alike
def marks_and_score_follow_from_the_thresholds():
    """Two seconds: half way between good and pass is .75; worse than pass, on the same line, to 0."""
    grade = '<time_taken name="%s" good="%s" pass="%s" weight="%s"/>'
    exercise = run(grade % ("mid", "1 s", "3 s", 1) + grade % ("good", "3 s", "0.1 min", 1) +
                   grade % ("bad", "0.5 s", "1 s", 2) + '<time_taken name="only" pass="2.5 s"/>'
                   '<time_taken name="late" pass="1 s"/><time_taken name="free"/>', 200)
    found = metrics(exercise)
    for name, mark, verdict in (("mid", .75, "pass"), ("good", 1, "good"), ("bad", 0, "fail"), ("only", 1, "pass"),
                                ("late", 0, "fail"), ("free", None, "none")):
        assert found[name]["verdict"] == verdict, found[name]
        assert "mark" not in found[name] if mark is None else abs(found[name]["mark"] - mark) < 1e-9, found[name]
    near(found["good"]["pass"], 6)
    near(exercise["score"], 100 * (.75 + 1 + 0 + 1 + 0) / 6, 1e-6)
    assert not exercise["passed"]


@check
@alike
def what_is_not_finished_is_not_good():
    """Where less is better; what is too much already has failed, and more that is better counts at once."""
    grade = '<time_taken name="time" good="3 s"/><time_taken name="late" good="0.5 s"/><economy name="economy" tool="one" good="50 %"/>'
    step = '<reached name="far" tool="one" point="%s 0 0" radius="0.002"/>'
    for place, verdicts, marks in ("9", ("unfinished", "fail", "good"), (0, 0, 1)), ("0.1", ("good", "fail", "good"), (1, 0, 1)):
        exercise = run(step % place + grade, 200, "", "--report", "r.html")
        found = [metrics(exercise)[name] for name in ("time", "late", "economy")]
        assert tuple(m["verdict"] for m in found) == verdicts and tuple(m["mark"] for m in found) == marks, found
        assert ("not finished" in (WORK / "r.html").read_text()) == (place == "9")


@check
@alike
def what_no_tool_is_named_for_is_done_by_those_that_can():
    lifted = '<lifted name="%s" %s body="adnexa" height="0.0005"/>'
    found = steps(run_shipped("exercise-salpingectomy", '<grasped name="grasped" body="adnexa"/><clamped name="clamped" body="adnexa"/>' +
                              lifted % ("named", 'tool="grasper"') + lifted % ("any", ""), 600))
    assert found["grasped"]["phase"] == "done" and found["clamped"]["phase"] == "open", "a grasper is no clamp"
    assert found["named"]["phase"] == "done" and found["any"] == {**found["named"], "name": "any"}, found


@check
@alike
@long_run
def clip_holds_and_needle_pierces():
    clamp = steps(run_shipped("plate8-clamp", '<clamped name="yes" body="tube_right"/><held name="held" body="tube_right" '
                              'time="0.1"/><held name="long" body="tube_right" time="60"/>', 800))
    assert clamp["yes"]["phase"] == clamp["held"]["phase"] == "done" and clamp["long"]["phase"] == "open", clamp
    near(clamp["held"]["done_s"] - clamp["yes"]["done_s"], 0.1, 0.005)
    drawn = run_shipped("plate8-clamp", '<held name="held" body="tube_right" time="1"/><lifted name="up" body="tube_right" '
                        'height="0.0005"/><lifted name="far" body="tube_right" height="0.1"/>', 700, "tube_right")
    assert left(drawn) == ["far"], "a clamp holds an effect, and takes it along"
    needle = steps(run_shipped("suture", '<pierced name="yes" body="skin"/><pierced name="thrice" body="skin" '
                               'count="1000"/><pierced name="no" body="thread"/>', 1500))
    assert needle["yes"]["phase"] == "done" and needle["thrice"]["phase"] == needle["no"]["phase"] == "open", needle


def volume(mesh):
    """Of a closed OFF mesh, m^3."""
    words = mesh.read_text().split()
    count, faces = int(words[1]), int(words[2])
    numbers = words[4:]
    points = [tuple(map(float, numbers[3 * i:3 * i + 3])) for i in range(count)]
    corners = [[points[int(c)] for c in numbers[3 * count + 4 * i + 1:3 * count + 4 * i + 4]] for i in range(faces)]
    return sum(a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])
               for a, b, c in corners) / 6


@check
@alike
def suction_sucks_and_what_a_wound_gives_is_lost():
    """A wound that gives a particle each 2.5 ms; suction that takes one each 5 ms."""
    shipped = (SCENES / "plate3-blood.spore").read_text()
    text = shipped.replace('<probe name="right"', '<suction point="0.034 -0.01 0.014" radius="0.1" rate="200" name="right"')
    wound = ('<effects><emitter name="wound" body="blood" point="0.034 0.03 0.014" direction="0 -1 0" rate="400" speed="0.5" '
             'radius="0.003" reserve="50"/></effects><tools>')
    parts = ('<sucked name="some" body="blood" count="5"/><sucked name="all" body="blood" count="1000"/>'
             '<blood_lost name="lost" body="blood"/><blood_lost name="thin" body="blood" density="530"/>')
    found = []
    try:
        for scene in text, text.replace("<tools>", wound), shipped.replace("<tools>", wound):
            (SCENES / "plate3-blood.spore").write_text(scene)
            found.append(run_shipped("plate3-blood", parts, 400))
    finally:
        (SCENES / "plate3-blood.spore").write_text(shipped)
    sucked, both, bleeds = found
    assert [s["phase"] for s in sucked["steps"]] == ["done", "open"], sucked
    near(sucked["steps"][0]["done_s"], 0.025, 0.00011)
    assert [s["phase"] for s in bleeds["steps"]] == ["open", "open"], bleeds
    assert metrics(sucked)["lost"]["value"] == 0, sucked
    particle_ml = 1e6 * volume(SCENES / "table1" / "drop.off") / 216  # the lattice gives 216 particles of 220
    for exercise in both, bleeds:
        lost = metrics(exercise)["lost"]["value"]
        near(lost / particle_ml, round(lost / particle_ml), 0.1)
        assert 1 <= round(lost / particle_ml) <= 16, (lost, particle_ml)
        near(metrics(exercise)["thin"]["value"], 2 * lost, 1e-9 * lost)


@check
@alike
def clamps_keep_a_wound_from_bleeding():
    """A tube that is clamped on both sides and cut between gives no blood; cut too early, with one clamp where it takes two, or where none counts, it bleeds. Clips that are put on as effects keep it from bleeding, too, and what seeps is blood that is lost."""
    if is_sanitized(SPORE):
        return
    shipped = (SCENES / "exercise-clip-and-cut.spore").read_text()
    bleeding = shipped.replace("</assets>", '<mesh name="drop" file="table1/drop.off"/></assets>').replace(
        "</bodies>", '<body name="blood" position="0 0.2 0"><mechanical geometry="drop" substeps="60"><lennard_jones particles="60"/></mechanical>'
        '<fidelity mode="effect"/></body></bodies>').replace(
        "<tools>", '<effects><emitter name="wound" body="blood" source="tube" point="0 0.004 0" direction="0 1 0" rate="20" reserve="40" '
        'trigger="wound" CLAMPS/></effects><tools>')
    scene, early = SCENES / "clamped-wound.spore", SCENES / "exercise-clip-and-cut" / "early.track"

    lost = lambda done: [metric["value"] for metric in done["exercise"]["metrics"] if metric["name"] == "lost"]

    def poured(clamps, *options, seeps=False, clips=False):
        text = bleeding.replace("CLAMPS", clamps).replace("</exercise>", '<cut name="never" body="tube" count="1000000"/><blood_lost name="lost" body="blood"/></exercise>')
        settings = [f"tools/{side}_clamp/fidelity/mode=effect" for side in ("left", "right") if clips] + ["effects/wound/fidelity/mode=effect"] * seeps
        scene.write_text(text)
        done = json.loads(spore("run", scene, "-n", 2500, "--json", *options, *(word for one in settings for word in ("--set", one))).stdout)
        fluid = done["fluids"][0]
        assert fluid["poured_ml" if seeps else "seeped_ml"] == 0 and (lost(done)[0] > 0) == (fluid["poured_ml"] + fluid["seeped_ml"] > 0), done["fluids"]
        return fluid["poured_ml"] + fluid["seeped_ml"]

    try:
        assert poured('clamps="2"') == 0
        assert poured('clamps="1"', "--input", early) == 0
        assert poured('clamps="2"', "--input", early) > 0
        assert poured('clamp_distance="0"') > 0
        assert poured('clamps="2"', clips=True) == poured('clamps="2"', clips=True, seeps=True) == 0
        assert poured('clamps="2"', "--input", early, clips=True, seeps=True) > 0
    finally:
        scene.unlink()


@check
@alike
def a_wound_bleeds_from_the_cut_until_it_is_coagulated():
    if is_sanitized(SPORE):
        return
    shipped = (SCENES / "cut-ovary.spore").read_text()
    bleeding = shipped.replace("</assets>", '<mesh name="drop" file="table1/drop.off"/></assets>').replace(
        "</bodies>", '<body name="blood"><mechanical geometry="drop" substeps="60"><lennard_jones particles="60"/></mechanical></body></bodies>').replace(
        "<tools>", '<effects><emitter name="wound" body="blood" source="ovary_right" point="0.0575 0.018 0.016" direction="0 1 0.5" rate="100" '
        'reserve="30" trigger="wound"/></effects><tools>')
    burnt = bleeding.replace("</bodies>", '<body name="hot" role="active" position="0.0575 0.018 0.016"/></bodies>').replace(
        "</tools>", '<bipolar name="burn" body="hot" device="hand" point="0.0575 0.018 0.016" radius="0.01"/></tools>').replace(
        "</devices>", '<track name="hand" file="hot.track"/></devices>')
    (SCENES / "hot.track").write_text("spore-track 1\ndevice hot\n" + "".join(f"{t} 0.0575 0.018 0.016 1 0 0 0 0 1\n" for t in (0, 9)))
    nowhere = bleeding.replace('source="ovary_right"', '')
    parts = '<cut name="cut" body="ovary_right"/><cut name="never" body="ovary_right" count="1000000"/><blood_lost name="lost" body="blood"/>'
    try:
        found = []
        for text in bleeding, burnt:
            (SCENES / "cut-ovary.spore").write_text(text)
            found.append([run_shipped("cut-ovary", parts, count, effect=effect) for count, effect in ((150, ""), (225, ""), (225, "blood"))])
        (SCENES / "cut-ovary.spore").write_text(nowhere)
        refused = spore("run", SCENES / "cut-ovary.spore", "-n", 1, status=2).stderr
    finally:
        (SCENES / "cut-ovary.spore").write_text(shipped)
    assert "the mouth is in nothing that can be cut" in refused, refused
    lost = [[metrics(exercise)["lost"]["value"] for exercise in runs] for runs in found]
    assert all(steps(run)["cut"]["phase"] == "done" for runs in found for run in runs[1:]), found
    assert lost[0][0] == 0 and lost[0][1] > 0 and lost[1][1] < 0.5 * lost[0][1], lost
    assert all(abs(runs[2] - runs[1]) <= 0.1 * lost[0][1] for runs in lost), lost


@check
@alike
def salpingectomy_is_done_in_order_by_its_track_to_the_bit():
    def report(count, threads=1):
        return json.loads(spore("run", SCENES / "exercise-salpingectomy.spore", "-n", count, "--json", "--threads", threads).stdout)

    one = report(600)["exercise"]
    assert one["steps"][0]["phase"] == "done", one
    if is_sanitized(SPORE):
        return  # the whole takes two minutes there, and events of all kinds come in the other checks
    assert one == report(600, 2)["exercise"]
    exercise = report(5100)["exercise"]
    assert exercise["phase"] == "done" and exercise["passed"], exercise
    times = [step["done_s"] for step in exercise["steps"]]
    assert len(times) == 5 and times == sorted(times), times
    graded = {m["name"]: (m["good"], m["pass"]) for m in exercise["metrics"] if "good" in m}
    assert graded["time"] == (249, 401) and graded["path"] == (6.8, 8.3), graded
    assert metrics(exercise)["errors"]["value"] == metrics(exercise)["drops"]["value"] == 0


def run_exercise(name, count, *options):
    done = subprocess.run([SPORE, "run", SCENES / f"{name}.spore", "-n", str(count), "--json", *map(str, options)], capture_output=True,
                          text=True, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr
    return json.loads(done.stdout)["exercise"]


def left(exercise):
    """Names of the steps that are not done."""
    return [step["name"] for step in exercise["steps"] if step["phase"] != "done"]


@check
@alike
def rings_go_over_and_back_by_their_track():
    """From hand to hand in mid-air is no drop; the other track lets a ring fall."""
    short = is_sanitized(SPORE)
    exercise = run_exercise("exercise-peg-transfer", 4100 if short else 46400)
    assert len(exercise["steps"]) == 48 and len(left(exercise)) == (44 if short else 0), left(exercise)
    assert steps(exercise)["over_1"]["phase"] == "done" and metrics(exercise)["drops"]["value"] == 0, exercise
    if not short:
        assert exercise["passed"] and exercise["score"] == 100 and exercise["time_s"] < 48, exercise
    fallen = run_exercise("exercise-peg-transfer", 4000, "--input", SCENES / "exercise-peg-transfer" / "fall.track")
    assert metrics(fallen)["drops"]["value"] == 1 and metrics(fallen)["drops"]["verdict"] == "fail", fallen
    assert steps(fallen)["lift_1"]["phase"] == "done" and steps(fallen)["pass_1"]["phase"] == "open", fallen
    assert fallen["score"] < 5 and not fallen["passed"], fallen


def opened_between(track):
    """The track, but for the left clamp, which is opened before the cut."""
    device, rows = None, []
    for row in track.read_text().splitlines():
        words = row.split()
        device = words[1] if words[0] == "device" else device
        if device == "left" and len(words) == 10 and 4 <= float(words[0]) < 4.4:
            words[9] = "2"
        rows.append(" ".join(words))
    changed = WORK / "opened.track"
    changed.write_text("\n".join(rows) + "\n")
    return changed


@check
@alike
@long_run
def a_tube_is_clamped_on_both_sides_and_cut_between():
    """By its track; another track cuts too early, and one opens a clamp before the cut. Strain is over a limit that the squeeze reaches, not over one beyond."""
    scene = SCENES / "exercise-clip-and-cut.spore"
    text = scene.read_text()
    limits = '<excess_strain name="%s" body="tube" strain="%s"/>'
    scene.write_text(text.replace("</exercise>", limits % ("little", "0.01") + limits % ("much", "5") + "</exercise>"))
    try:
        cut = run_exercise("exercise-clip-and-cut", 1500)
        early = run_exercise("exercise-clip-and-cut", 1500, "--input", SCENES / "exercise-clip-and-cut" / "early.track")
    finally:
        scene.write_text(text)
    opened = run_exercise("exercise-clip-and-cut", 1350, "--input", opened_between(scene.with_suffix("") / "exercise-clip-and-cut.track"))
    assert steps(opened)["clamp_left"]["lost"] == 1 and left(opened) == ["clamp_left", "cut"], opened
    assert metrics(opened)["errors"]["value"] == 2 and not opened["passed"] and opened["score"] < 50, "it was opened, and then cut"
    times = [step["done_s"] for step in cut["steps"]]
    assert cut["passed"] and cut["score"] == 100 and times == sorted(times), cut
    found = metrics(cut)
    assert 0.01 < found["mean_strain"]["value"] < found["peak_strain"]["value"] < 5, found
    assert 0 < found["little"]["value"] <= cut["time_s"] and found["much"]["value"] == found["overstretched"]["value"] == 0, found
    assert left(early) == ["cut"] and metrics(early)["errors"]["value"] == 1 and not early["passed"], early
    assert metrics(early)["errors"]["verdict"] == "fail" and metrics(early)["time"]["verdict"] == "unfinished", early


@check
@alike
def pool_is_sucked_dry_by_its_track():
    """And not by a tube that takes as much as the wound gives. Then the wound is rinsed, and the water sucked away."""
    short = is_sanitized(SPORE)
    exercise = run_exercise("exercise-suction", 11000 if short else 42000)
    assert left(exercise) == (["half", "dry"] if short else []), exercise
    if not short:
        assert exercise["passed"] and exercise["score"] == 100 and exercise["time_s"] < 4.2, exercise
        slow = run_exercise("exercise-suction", 26000, "--set", "tools/suction/rate=8")
        assert left(slow) == ["half", "dry"] and slow["score"] == 0 and not slow["passed"], slow
        assert 0.2 < metrics(exercise)["blood"]["value"] < 0.9, exercise
        counted = metrics(exercise)["blood"]["value"]
    # blood as an effect is sucked dry too, at steps a hundred times as long
    drops = run_exercise("exercise-suction", 420, "--dt", "0.01", "--set", "bodies/blood/fidelity/mode=effect")
    assert drops["passed"] and drops["score"] == 100 and 3 < drops["time_s"] < 4.2, drops
    water = lambda count: json.loads(spore("run", SCENES / "exercise-suction.spore", "-n", count, "--json", "--dt", "0.01", "--set",
                                           "bodies/blood/fidelity/mode=effect").stdout)["fluids"][1]
    assert water(500)["poured_ml"] == 0, "the tube is on its way"
    rinsed = water(800)
    assert 5 < rinsed["poured_ml"] < 8 and 3 < rinsed["sucked_ml"] < rinsed["poured_ml"], rinsed
    assert short or abs(metrics(drops)["blood"]["value"] - counted) < 0.2 * counted, drops


@check
@alike
def probe_stirs_the_blood():
    """Until the probe comes to it, the blood flows as it does beside a probe that stays away."""
    if is_sanitized(SPORE):
        return

    def blood(count, *options):
        done = spore("run", SCENES / "plate3-blood.spore", "-n", count, "--json", *options)
        return next(body["hash"] for body in json.loads(done.stdout)["bodies"] if body["name"] == "blood")

    away = ("--input", SCENES / "plate1-ovary" / "plate1-ovary.track")
    assert blood(7000) == blood(7000, *away)
    assert blood(14000) != blood(14000, *away)
    touched = steps(run_shipped("plate3-blood", '<touched name="stirred" body="blood" tool="right"/>', 14000))["stirred"]
    assert touched["phase"] == "done" and touched["done_s"] > 0.7, touched
    part = '<touched name="stirred" body="blood" tool="right"/>'
    early, late = (steps(run_shipped("plate3-blood", part, count, effect="blood"))["stirred"] for count in (6000, 14000))
    assert early["phase"] != "done" and late["phase"] == "done" and abs(late["done_s"] - touched["done_s"]) < 0.3, (early, late, touched)


@check
@alike
@long_run
def what_comes_before_its_turn_is_an_error():
    exercise = run_shipped("exercise-salpingectomy", '<lifted name="high" body="adnexa" height="5"/>'
                           '<coagulated name="early" body="adnexa" after="high"/><cut name="cut" body="ovary"/>'
                           '<errors name="errors"/>', 720)
    assert metrics(exercise)["errors"]["value"] == 1 and exercise["score"] == 0, exercise
    assert [s["phase"] for s in exercise["steps"]] == ["open", "waiting", "open"], exercise


@check
@alike
@long_run
def what_jaws_lose_is_a_drop():
    drops = '<drops name="drops" body="adnexa"/><grasped name="g" body="adnexa"/><lifted name="never" body="adnexa" height="5"/>'
    assert metrics(run_shipped("exercise-salpingectomy", drops, 600))["drops"]["value"] == 0
    text = (SCENES / "exercise-salpingectomy.spore").read_text()
    (SCENES / "exercise-salpingectomy.spore").write_text(text.replace('strength="4"', 'strength="0.1"'))
    try:
        lost = run_shipped("exercise-salpingectomy", drops, 600)
    finally:
        (SCENES / "exercise-salpingectomy.spore").write_text(text)
    assert metrics(lost)["drops"]["value"] > 0 and steps(lost)["g"]["phase"] == "done", lost


@check
@alike
def reports_are_a_table_an_object_and_a_page_of_their_own():
    parts = ('<reached name="far" tool="one" point="0.1 0 0" radius="0.002"/><time_taken name="t" good="2 s" '
             'source="a &lt;b&gt; &quot;c&quot;"/><path_length name="p"/>')
    for kind in "csv", "json", "html":
        exercise = run(parts, 200, "", "--report", f"r.{kind}")
    rows = list(csv.DictReader((WORK / "r.csv").read_text().splitlines()))
    assert [r["part"] for r in rows] == ["step", "metric", "metric", "score"] and rows[1]["source"] == 'a <b> "c"', rows
    assert float(rows[0]["value"]) == exercise["steps"][0]["done_s"] and float(rows[3]["value"]) == exercise["score"]
    assert json.loads((WORK / "r.json").read_text())["exercise"] == exercise
    page = (WORK / "r.html").read_text()
    root = xml.etree.ElementTree.fromstring(page.replace("<!DOCTYPE html>", ""))
    assert len(root.findall(".//svg")) == 2 and "http" not in page and page.count("src=") == page.count('src="data:'), page


def pictures(page):
    """Names of the steps that have one, and what the page says of those that are missing."""
    root = xml.etree.ElementTree.fromstring((WORK / page).read_text().replace("<!DOCTYPE html>", ""))
    found = {figure.find("figcaption").text: figure.find("img").get("src") for figure in root.iter("figure")}
    for data in found.values():
        assert base64.b64decode(data.removeprefix("data:image/png;base64,")).startswith(b"\x89PNG"), data[:80]
    return found, [p.text for p in root.iter("p") if p.text and p.text.startswith("Pictures are missing:")]


@check
def the_page_shows_the_moments_at_which_steps_were_done():
    parts = "".join(f'<reached name="{name}" tool="one" point="{x} 0 0" radius="0.002"/>'
                    for name, x in (("near", 0.01), ("there", 0.01), ("far", 0.1), ("never", 0.5)))
    steps_of = run(parts, 200, "", "--report", "moments.html")["steps"]
    done = [f"{step['name']}, {step['done_s']:.2f} s" for step in steps_of if step["phase"] == "done"]
    found, missing = pictures("moments.html")
    if "render" in spore("--help").stdout and subprocess.run(
            [SPORE, "render", "scene.spore", "-o", "x.png"], cwd=WORK, capture_output=True).returncode == 0:
        assert list(found) == done and len(done) == 3 and not missing, (done, list(found), missing)
        near, there, far = found.values()
        assert near == there != far, "a picture of each moment, and one for two steps of one moment"
    else:
        assert not found and len(missing) == 1, (list(found), missing)
    spore("run", "scene.spore", "-n", 200, "--report", "dark.html", env={"__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent"})
    found, missing = pictures("dark.html")
    assert not found and len(missing) == 1, (list(found), missing)


def refused(parts, place, words, command="run"):
    (WORK / "scene.spore").write_text(SCENE % ("", parts))
    done = spore(command, "scene.spore", status=2 if command == "run" else 1)
    said = done.stderr if command == "run" else done.stdout
    assert all(word in said for word in words) and place in said, said


@check
@alike
def bad_exercises_are_refused_with_place_and_remedy():
    reached = '<reached name="%s" tool="one" after="%s"/>'
    for parts, words in ((reached % ("a", "b") + reached % ("b", "a"), ("waits for", "let one of them")),
                         (reached % ("a", "a"), ("waits for",)),
                         ('<touched name="a" body="gone"/>', ("gone", "names nothing")),
                         ('<touched name="a"/>', ("names no body",)),
                         ('<reached name="a"/>', ("names no body or tool",)),
                         ('<bagged name="a" body="tip"/>', ("names no container",)),
                         ('<out_of_view name="a"/>', ("names no camera",)),
                         ('<blood_lost name="a" body="tip"/>', ("no fluid",)),
                         ('<peak_strain name="a" body="tip"/>', ("no strain",)),
                         ('<excess_strain name="a"/>', ("names no body",)),
                         ('<time_taken name="a" good="249"/>', ("no unit", '"s"')),
                         ('<time_taken name="a" good="249 N"/>', ("unit", '"s"')),
                         ('<time_taken name="a" good="fast"/>', ("no number",)),
                         ('<time_taken name="a" good="2 min" pass="1 s"/>', ("worse than",))):
        for command in "run", "check":
            refused(parts, "scene.spore:13:", words, command)
    assert spore("run", "scene.spore", "--report", "x.txt", status=2).stderr
    (WORK / "scene.spore").write_text(SCENE % ("", ""))
    assert "no exercise" in spore("run", "scene.spore", "--report", "x.html", status=2).stderr
    assert "exercise" not in json.loads(spore("run", "scene.spore", "-n", "1", "--json").stdout)


main(**dict(zip(("kind",), sys.argv[2:])))
