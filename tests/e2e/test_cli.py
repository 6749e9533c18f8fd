#!/usr/bin/python3
"""The command line from end to end, as the contract has it. test_cli.py SPORE FEATURES [KIND PART PARTS]: FEATURES
is a comma-separated list of what the build holds (assimp, cgal, render, volumes); KIND, PART, PARTS: as tap.main has them."""
import csv
import gzip
import json
import math
import os
import pathlib
import re
import resource
import shlex
import signal
import struct
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import picture_files
import shapes
from tap import Skip, alike, check, is_sanitized, long_run, main, wait_for_work

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SPORE = os.path.abspath(sys.argv[1])
FEATURES = set(sys.argv[2].split(","))
WORK = pathlib.Path(tempfile.mkdtemp(prefix="spore-e2e-"))
SCENES = ROOT / "resources" / "scenes"
SANITIZED = is_sanitized(SPORE)  # then a part of what takes long: the run without sanitizers judges the whole


def spore(*arguments, status=0, **options):
    """Runs spore, asserts its exit status (or that it is one of several), returns the finished process."""
    if SANITIZED and arguments[:1] == ("render",):
        # The leak checker may die while it reads what the driver keeps for its threads; tests/render look for leaks.
        options["env"] = {**(options.get("env") or os.environ), "ASAN_OPTIONS": "detect_leaks=0:allocator_may_return_null=1"}
    done = subprocess.run([SPORE, *map(str, arguments)], capture_output=True, text=True, timeout=300, cwd=WORK, **options)
    assert done.returncode in (status if isinstance(status, tuple) else (status,)), f"{arguments}: status {done.returncode}\n{done.stdout}\n{done.stderr}"
    assert "Sanitizer" not in done.stderr, done.stderr
    return done


def report(*arguments, status=0, **options):
    """The JSON object of a command; stdout must hold nothing else."""
    return json.loads(spore(*arguments, "--json", status=status, **options).stdout)


def refuses(*arguments, says, **options):
    """The command ends with status 2, one line on stderr that holds every text of `says`, and nothing on stdout."""
    done = spore(*arguments, status=2, **options)
    lines = done.stderr.strip().splitlines()
    assert len(lines) == 1, f"expected one line:\n{done.stderr}"
    for text in says:
        assert text in lines[0], f"'{text}' is not in: {lines[0]}"
    assert not done.stdout, done.stdout
    return lines[0]


def file(name, content):
    path = WORK / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def organ():
    """A scene made by import: an organ of one mesh."""
    scene = WORK / "organ" / "ball.spore"
    if not scene.exists():
        file("ball.off", shapes.off(*shapes.sphere()))
        spore("import", "ball.off", "--unit", "m", "-o", scene)
    return scene


def soft_ball():
    """A scene with a rigid ball above unmovable spheres: contacts within a few hundred steps."""
    scene = WORK / "soft" / "soft.spore"
    if not scene.exists():
        file("soft/ball.off", shapes.off(*shapes.sphere()))
        file("soft/one.spheres", "0 0 0 0.03\n")
        file("soft/floor.spheres", "".join(f"{x / 50} -0.05 {z / 50} 0.02\n" for x in range(-3, 4) for z in range(-3, 4)))
        file("soft/soft.spore", """<?xml version="1.0" encoding="UTF-8"?>
<spore version="1.0">
  <environment gravity="0 -9.81 0"/>
  <solver time_step="0.001"/>
  <assets>
    <mesh name="ball" file="ball.off"/>
    <spheres name="one" file="one.spheres"/>
    <spheres name="floor" file="floor.spheres"/>
  </assets>
  <bodies>
    <body name="ball" role="passive" position="0 0.02 0">
      <mechanical geometry="ball">
        <rigid_body/>
      </mechanical>
      <collision spheres="one"/>
      <visual mesh="ball"/>
    </body>
    <body name="floor" role="unmovable">
      <collision spheres="floor"/>
    </body>
  </bodies>
</spore>
""")
    return scene


@check
def help_lists_commands():
    """help lists every command; no command and unknown ones are usage errors."""
    text = spore("--help").stdout
    for name in ("run", "check", "plan", "stability", "import", "edit", "centreline", "spheres", "spline", "surface", "tetrahedra", "models", "schema"):
        assert f"\n  {name} " in text
        assert "--json" in spore(name, "--help").stdout
    spore(status=2)
    refuses("fly", says=["fly"])
    refuses("run", says=["SCENE"])
    refuses("run", "--no-such-option", "x", says=["no-such-option"])
    (WORK / "-a dash first.spore").write_text('<spore version="1.0"/>')
    assert "-a dash first.spore:1:1: note: the scene has no bodies" in spore("check", "--", "-a dash first.spore").stdout
    refuses("check", "--", "-none", says=["-none: there is no such file"])


@check
def readme_agrees():
    """README shows every command and no other, each with options that it has."""
    text = (ROOT / "README.md").read_text()
    shown = re.findall(r"^\$?(spore .*)$", text, re.M) + re.findall(r"`(spore [^`]*)`", text)
    commands = set(re.findall(r"^  (\w+)  ", spore("--help").stdout, re.M))
    helps = {name: spore(name, "--help").stdout for name in commands}
    helps["sweep"] += "".join(spore("sweep", part, "--help").stdout for part in ("plan", "run", "collect"))
    used = {line.split()[1] for line in shown if line.split()[1].islower()}
    assert used == commands | {"render"}, used ^ commands # not every build has it
    assert "render" in commands or "render" not in FEATURES
    for line in shown:
        for option in re.findall(r"(?<![\w-])--[a-z][a-z-]*", line):
            name = line.split()[1]
            assert name not in helps or re.search(rf"{option}\b", helps[name]) or option == "--help", f"{option}: {line}"


def leaves(value, path=()):
    """Paths of all members at the bottom; what lies in an array counts as the array's."""
    if isinstance(value, dict):
        return {leaf for key, below in value.items() for leaf in leaves(below, (*path, key))}
    if isinstance(value, list) and value:
        return {leaf for below in value for leaf in leaves(below, path)}
    return {path}


@check
@long_run
def help_explains_json():
    """--help of each command names every member that --json prints, in the row of what it belongs to."""
    file("ball.off", shapes.off(*shapes.sphere()))
    commands = [("run", soft_ball(), "--steps", 20), ("run", grasper(), "--steps", 20), ("check", soft_ball()), ("plan", soft_ball(), "--measure"),
                ("stability", soft_ball(), "--quick", "--svg", "told.svg"),
                ("run", soft_ball(), "--steps", 5, "--realtime"), ("check", organ()), ("models",), ("models", "--materials"), ("schema",),
                ("import", "ball.off", "-o", "told/told.spore"), ("spheres", "ball.off", "--count", 5),
                ("surface", "ball.off", "--nodes", 50, "--wall", 0.01), ("centreline", file("told.off", shapes.off(*shapes.tube())), "--scene", "told/line.spore")]
    commands += [("tetrahedra", "ball.off", "--cells", 100), ("spline", "ball.off", "--corners", *CORNERS)]
    if "volumes" in FEATURES:
        size, voxels = two_boxes()
        commands.append(("tetrahedra", file("told.nrrd", shapes.nrrd(size, voxels)).name, "--cells", 100))
    commands += [("render", soft_ball(), "-o", "told.png")] if "render" in FEATURES else []
    for command in commands:
        answer = json.loads(spore(*command, "--json", status=(0, 1)).stdout)
        described = spore(command[0], "--help").stdout.partition("--json prints:")[2]
        rows = {row.split()[0]: row for row in described.strip().splitlines()}
        for path in leaves(answer):
            row = next((rows[name] for n in range(len(path), 0, -1) if (name := ".".join(path[:n])) in rows), None)
            assert row, f"{command[0]} --help says nothing of {'.'.join(path)}"
            assert path[-1] in row, f"{command[0]} --help does not name {'.'.join(path)}"


@check
@alike
def surface_makes_nets():
    """surface thins a mesh to as many nodes as asked for; what it writes runs as net, deformable surface and scene."""
    file("ball.off", shapes.off(*shapes.sphere()))
    answer = report("surface", "ball.off", "--nodes", 60, "-o", "net.off")
    assert answer["nodes"] == 60 and answer["triangles"] == 116 and answer["open_edges"] == 0 and answer["pieces"] == 1
    assert answer["hausdorff"] < 0.03 and answer["min_angle_deg"] > 20 and answer["reached"] and abs(answer["volume_change"]) < 0.06
    assert (WORK / "net.off").read_text().startswith("OFF\n60 116 0\n")
    again = report("surface", "ball.off", "--size", answer["edge_m"]["mean"])
    assert abs(again["nodes"] - 60) < 15
    written = spore("surface", "ball.off", "-n", 60, "-o", "net.obj").stdout
    assert "60 nodes, 116 triangles" in written and (WORK / "net.obj").read_text().count("\nf ") == 116
    for model in ("mass_spring_net", "deformable_surface"):
        scene = file("net.spore", f"""<spore version="1.0"><assets><mesh name="m" file="net.off"/></assets><bodies>
            <body name="b"><mechanical geometry="m"><{model}/></mechanical></body></bodies></spore>""")
        assert report("run", scene, "--steps", 50)["dof"] >= 180
    refuses("surface", "ball.off", says=["--nodes 1 to", "--size", "--wall"])
    hollow = report("surface", "ball.off", "--wall", 0.006, "-o", "wall.off", "--inner", "lumen.off")["wall"]
    assert hollow["pieces"] == 1 and 0.0055 < hollow["thickness_m"]["min"] <= hollow["thickness_m"]["mean"] < 0.0065
    assert abs(hollow["lumen_m3"] / (4 / 3 * 3.14159 * 0.024**3) - 1) < 0.06
    assert report("surface", "wall.off", "--nodes", 5000)["pieces"] == 2 and report("surface", "lumen.off", "-n", 100)["open_edges"] == 0
    refuses("surface", "ball.off", "--wall", 0.05, says=["leaves no lumen", "0.02", "thinner"])
    refuses("surface", "ball.off", "--wall", -1, says=["--wall", "-1"])
    refuses("surface", "ball.off", "--wall", 0.006, "--wall-detail", 65, says=["--wall-detail", "65", "0 to 64"])
    refuses("surface", "ball.off", "--wall", 0.006, "--detail", 4, says=["--detail", "--wall-detail"])
    refuses("surface", "ball.off", "-n", 60, "--wall-detail", 4, says=["--wall-detail", "--wall "])
    refuses("surface", "ball.off", "-n", 60, "--inner", "lumen.off", says=["--inner lumen.off"])
    refuses("surface", "ball.off", "-n", 60, "--keep-angle", -5, says=["--keep-angle", "-5", "1 to 360"])
    refuses("surface", "ball.off", "-n", 60, "-o", "ball.stl", says=["ball.stl", ".off or .obj"])
    refuses("surface", "gone.off", "-n", 60, says=["gone.off"])


@check
@alike
def a_scene_is_authored_by_commands():
    """Organs of two units in one scene; a body becomes soft and felt, of a tissue, held, and is touched: it runs."""
    file("ball.off", shapes.off(*shapes.sphere()))
    file("egg.off", shapes.off(*shapes.sphere(radius=30)))
    scene = WORK / "authored" / "two.spore"
    guessed = report("import", "ball.off", "egg.off", "--unit", "guess", "-o", WORK / "authored" / "guessed.spore")
    assert [mesh["unit"] for mesh in guessed["meshes"]] == ["m", "mm"] and not guessed["diagnostics"]
    assert all(abs(mesh["diagonal_m"] - guessed["meshes"][0]["diagonal_m"]) < 1e-6 for mesh in guessed["meshes"])
    spore("import", "ball.off", "-o", scene)
    assert report("import", "egg.off", "--unit", "mm", "--add", "-o", scene)["bodies"] == ["ball", "egg"]
    cells = report("tetrahedra", scene, "--body", "egg", "--cells", "300", "--region", "0,0.03,0,0.01,0.004")
    assert cells["body"] == "egg" and cells["tetrahedra"] > 100
    each = report("spheres", scene, "--body", "egg", "--method", "tetrahedra", "--count", "12")
    made = report("spheres", scene, "--body", "egg", "--method", "balanced", "--count", "12", "--region", "0,0.03,0,0.01,2")
    assert made["count"] == 12 and made["scene"] == str(scene)
    other = made["other"]  # the paper's way beside the fit, and the fit beside the paper's way
    assert each["count"] == other["count"] == cells["tetrahedra"] and each["other"]["count"] == 12
    assert other["depth_error"] == each["depth_error"] and each["other"]["depth_error"] > 0 and other["coverage"] > 0.98
    refuses("spheres", "ball.off", "--method", "tetrahedra", says=("ball.off", "no tetrahedra", ".mesh"))
    first = scene.read_text()
    again = report("spheres", scene, "--body", "egg")
    assert again["count"] == 12 and scene.read_text() == first, "the asset says number and regions, and no second set is made"
    spore("edit", scene, "--set", "bodies/egg/mechanical/material=liver", "--set", "bodies/egg/collision/stiffness=300",
          "--hold", "egg", "--probe")
    tree = xml.etree.ElementTree.parse(scene).getroot()
    body = tree.find("bodies/body[@name='egg']")
    assert body.get("role") is None and body.find("mechanical").get("material") == "liver"
    assert tree.find(f"assets/tetrahedra[@name='{body.find('mechanical').get('geometry')}']").get("source") == "egg"
    assert body.find("collision").get("stiffness") == "300" and len(tree.findall("assets/spheres/sphere_region")) == 1
    assert tree.find("links/pin").get("body") == "egg" and tree.find("tools/probe").get("body") == "probe"
    assert report("run", scene, "--steps", "20")["dof"] > 100
    added = report("edit", scene, "--add", "links/spring:cord", "--add", "links/spring:cord", "--add", "bodies/egg/mechanical/rigid_body",
                   "--set", "links/cord/body_a=egg", "--set", "links/cord-2/body_a=egg", "-o", scene.with_name("added.spore"))["changed"]
    assert added == ["links/cord", "links/cord-2", "bodies/egg/mechanical/rigid_body", "links/cord/body_a", "links/cord-2/body_a"], added
    assert report("run", scene.with_name("added.spore"), "--steps", "20")["dof"] <= 6, "a rigid body, pinned"
    assert not [d for d in report("check", scene)["diagnostics"] if d["severity"] == "error"]
    painted, scar, rim = scene.with_name("painted.spore"), "bodies/egg/regions/scar", "assets/egg_tetrahedra/rim"
    spore("edit", scene, "--paint", f"{scar}=0,0.03,0,0.01", "--paint", f"{scar}=0,0.03,0.001,0.01", "--paint", f"{scar}=0,0.025,0.01,0.01",
          "--set", f"{scar}/stiffness_scale=20", "--paint", f"{rim}=0.03,0,0,0.008", "--paint", f"{rim}=0.03,0.007,0,0.008", "-o", painted)
    tree = xml.etree.ElementTree.parse(painted).getroot()
    region = tree.find("bodies/body[@name='egg']/regions/region")
    assert region.get("radius") == "0.01" and [dab.get("centre") for dab in region] == ["0 0.025 0.01"], "a dab beside another adds nothing"
    assert report("run", painted, "--steps", "20")["state_hash"] != report("run", scene, "--steps", "20")["state_hash"]
    spore("tetrahedra", painted, "--body", "egg", "--cells", "400")
    assert not [d for d in report("check", painted)["diagnostics"] if "stale" in d["message"]]
    assert len(xml.etree.ElementTree.parse(painted).findall("assets/tetrahedra/cell_region/dab")) == 1
    assert [loss for loss in report("export", "--format", "sofa", painted, "-o", WORK / "authored" / "sofa")["lost"] if "egg: its stiffer and softer regions" in loss]
    refuses("edit", painted, "--paint", f"{scar}=0,0.03,0", says=[scar, "X,Y,Z,RADIUS"])
    refuses("edit", painted, "--paint", "bodies/egg/visual=0,0.03,0,0.01", says=["bodies/egg/visual", "no such region"])
    refuses("edit", painted, "--paint", "links/pin=0,0.03,0,0.01", says=["links", "has no regions"])


@check
@long_run
def levels_are_added_to_bodies():
    """--level makes a coarser form of a body, of fewer cells or of fewer points along its line, which a run takes; what has one, or cannot have one, is refused."""
    file("levels/organ.off", shapes.off(*shapes.sphere(radius=0.03)))
    file("levels/cord.curve", "".join(f"{i / 100} 0 0.1 0.002\n" for i in range(11)))
    scene = file("levels/levels.spore", '<spore version="1.0"><assets><mesh name="skin" file="organ.off"/>'
                 '<curve name="line" file="cord.curve"/></assets><bodies><body name="organ"><visual mesh="skin"/></body>'
                 '<body name="cord"><mechanical geometry="line"><spline_1d control_points="20"/></mechanical></body>'
                 '<body name="stone"><mechanical geometry="skin"><rigid_body/></mechanical></body></bodies></spore>\n')
    spore("tetrahedra", scene, "--body", "organ", "--cells", 1200)
    made = report("edit", scene, "--level", "organ=coarse", "--level", "cord=coarse", "--level", "cord=medium")
    assert made["changed"] == ["bodies/organ/fidelity/coarse", "bodies/cord/fidelity/coarse", "bodies/cord/fidelity/medium"], made
    tree = xml.etree.ElementTree.parse(scene).getroot()
    assert tree.find("bodies/body[@name='organ']/fidelity/coarse").get("geometry") == "organ_coarse"
    fine, coarse = (int((WORK / "levels" / tree.find(f"assets/tetrahedra[@name='organ_{name}']").get("file")).read_text().split("Tetrahedra")[1].split()[0])
                    for name in ("tetrahedra", "coarse"))
    assert 0.1 < coarse / fine < 0.5, (fine, coarse)
    assert [tree.find(f"bodies/body[@name='cord']/fidelity/{level}").get("settings") for level in ("coarse", "medium")] == ["control_points=8", "control_points=12"]
    assert not [one for one in report("check", scene)["diagnostics"] if "level" in one["message"]]
    ran = spore("run", scene, "--steps", 4, "--level", "cord=coarse@0.001").stdout
    assert "cord: level fine to coarse" in ran, ran
    before = scene.read_text()
    refuses("edit", scene, "--level", "organ=coarse", says=["has a level of that name already"])
    refuses("edit", scene, "--level", "stone=coarse", says=["Rigid body has no number"])
    refuses("edit", scene, "--level", "organ=fine", says=["expected BODY=coarse or BODY=medium"])
    assert scene.read_text() == before


@check
@long_run
def organs_are_made_soft_by_one_option():
    """--soft makes tetrahedra, spheres, tissue by name and a pin, before --set, which has the last word; what it cannot do changes nothing."""
    file("liver.off", shapes.off(*shapes.sphere(radius=30)))
    file("right_ovary.off", shapes.off(*shapes.sphere(radius=30, centre=(100, 0, 0))))
    scene = WORK / "authored" / "soft.spore"
    spore("import", "liver.off", "right_ovary.off", "--unit", "mm", "-o", scene)
    before = scene.read_text()
    refuses("edit", scene, "--soft", "kidney", says=('--soft: there is no body "kidney"',))
    for wrong in (("--soft", "liver", "--set", "bodies/liver/mechanical/material=stone"), ("--add", "bodies/liver/mechanical/rigid_body", "--soft", "liver")):
        refuses("edit", scene, *wrong, says=("stone",) if "--set" in wrong else ("rigid_body already",))
    assert scene.read_text() == before
    made = report("edit", scene, "--soft", "liver", "--soft", "right_ovary", "--set", "bodies/right_ovary/mechanical/material=uterus")
    assert made["changed"] == ["bodies/liver", "bodies/right_ovary", "bodies/right_ovary/mechanical/material"], made
    assert [one["body"] for one in made["soft"]] == ["liver", "right_ovary"]
    assert all(one["tetrahedra"] > 500 and one["spheres"] == 60 and 0 < one["distance"] < 0.02 for one in made["soft"]), made
    tree = xml.etree.ElementTree.parse(scene).getroot()
    assert [body.find("mechanical").get("material") for body in tree.findall("bodies/body")] == ["liver", "uterus"]
    assert [pin.get("body") for pin in tree.findall("links/pin")] == ["liver", "right_ovary"]
    assert not report("check", scene)["diagnostics"]
    assert report("run", scene, "--steps", "20")["dof"] > 600
    refuses("edit", scene, "--soft", "liver", says=("has the model", "already"))


@check
def authoring_commands_refuse_what_they_cannot_do():
    """No body, an unknown one, options that a scene says itself, a frozen asset, nothing to do: words, and no change."""
    scene = WORK / "authored" / "refused.spore"
    file("ball.off", shapes.off(*shapes.sphere()))
    spore("import", "ball.off", "ball.off", "-o", scene)
    spore("spheres", scene, "--body", "ball", "--count", "3")
    scene.write_text(scene.read_text().replace("<spheres ", '<spheres frozen="true" '))
    before = scene.read_text()
    refuses("spheres", scene, "--count", "3", says=("no body is named", "ball, ball-2"))
    refuses("tetrahedra", scene, "--body", "bal", "--cells", "100", says=('no body "bal"', "ball, ball-2"))
    refuses("spheres", scene, "--body", "ball", "--count", "4", says=("frozen",))
    refuses("spheres", scene, "--body", "ball", "--count", "3", "-o", "x.spheres", says=("--output",))
    refuses("tetrahedra", scene, "--body", "ball", "--unit", "mm", says=("--unit",))
    refuses("spheres", "ball.off", "--body", "ball", "--count", "3", says=("--body", ".spore"))
    refuses("edit", scene, says=("nothing is asked for",))
    refuses("edit", scene, "--hold", "none", says=('no body "none"',))
    refuses("edit", scene, "--hold", "ball", says=("needs no pin",))
    refuses("edit", scene, "--set", "bodies/ball/collision/stifness=3", says=("did you mean",))
    for wrong, says in (("links/sprin:c", "did you mean spring?"), ("bodies/ball/mechanical/soft", "lennard_jones, "), ("cord", "links/spring:cord"),
                        ("solver/x", "nothing can be added"), ("bodies/ball/collision", "by --set"), ("bodies/none/visual", "to add to"),
                        ("bodies/ball/fidelity:x", 'without ":x"')):
        refuses("edit", scene, "--add", wrong, says=(says,))
    refuses("edit", scene, "--set", "links/cord/stiffness=3", says=("spore edit --add 'links/", "spring|", ":cord'"))
    refuses("edit", scene, "--set", "bodies/ball/fidelity/coarse/settings=x", says=("spore edit --add 'bodies/ball/fidelity/coarse'",))
    refuses("edit", scene, "--set", "nothing/at/all=3", says=("bodies/NAME/collision",))
    refuses("import", "ball.off", "--add", "-o", WORK / "authored" / "absent.spore", says=("absent.spore", "no such file"))
    assert scene.read_text() == before


@check
def import_makes_a_scene():
    """import writes a scene that check, plan and run take."""
    scene = organ()
    text = scene.read_text()
    assert 'unit="m"' in text and "<body" in text
    assert sorted(p.name for p in scene.parent.iterdir()) == ["ball.off", "ball.spore"]
    assert isinstance(report("check", scene)["diagnostics"], list)
    assert report("plan", scene)["stages"]
    assert report("run", scene, "--steps", 1000)["steps"] == 1000


@check
def import_of_several_meshes():
    """A body a file, one of all, one a piece: named, closed, of the volume they had."""
    one, two = shapes.sphere(centre=(-0.1, 0, 0)), shapes.sphere(radius=0.02, centre=(0.1, 0, 0))
    file("one.off", shapes.off(*one))
    file("two.off", shapes.off(*two))
    file("both.off", shapes.off(*shapes.joined(one, two)))
    volume = lambda mesh: mesh["as_read"]["volume_m3"]
    apart = report("import", "one.off", "two.off", "-o", "several/apart.spore")
    assert apart["bodies"] == ["one", "two"] and [m["file"] for m in apart["meshes"]] == ["one.off", "two.off"]
    total = sum(map(volume, apart["meshes"]))
    merged = report("import", "one.off", "two.off", "--merge", "-o", "several/merged.spore")
    assert merged["bodies"] == ["one"] and abs(volume(merged["meshes"][0]) / total - 1) < 1e-9
    assert merged["meshes"][0]["as_read"]["components"] == 2
    for option in ("--split", "--split=pieces"):
        split = report("import", "both.off", option, "-o", "several/split.spore")
        assert split["bodies"] == ["both", "both-2"]
        assert [abs(volume(m) / volume(n) - 1) < 1e-9 for m, n in zip(split["meshes"], apart["meshes"])] == [True, True]
    assert report("check", "several/split.spore")["diagnostics"] == report("check", "several/apart.spore")["diagnostics"]
    assert report("import", "both.off", "-o", "several/whole.spore")["meshes"][0]["as_read"]["components"] == 2
    assert not apart["diagnostics"]
    refuses("import", "one.off", "--merge", "--split", "-o", "several/no.spore", says=["--merge", "--split"])
    refuses("import", "one.off", "--split=halves", "-o", "several/no.spore", says=["halves", "pieces"])


@check
def import_offers_to_decimate():
    """A mesh of far too many triangles is said to be so, with the option that leaves fewer."""
    if "assimp" not in FEATURES:
        raise Skip("built without assimp")
    file("heavy.stl", shapes.heavy())
    said = report("import", "heavy.stl", "-o", "several/heavy.spore")["diagnostics"]
    said = [d for d in said if "triangles, and spheres and tetrahedra" in d["message"]]
    assert len(said) == 1 and "--triangles 100000" in said[0]["remedy"] and said[0]["place"] == "heavy", said


@check
def import_names_the_parts_of_a_file():
    """The sub-meshes of a GLB become bodies of their names when it is split, a mirrored one facing outward."""
    if "assimp" not in FEATURES:
        raise Skip("built without assimp")
    file("parts.glb", shapes.glb(womb=shapes.sphere(), ovary=shapes.sphere(radius=0.01, centre=(0.05, 0, 0))))
    split = report("import", "parts.glb", "--split", "-o", "parts/split.spore")
    assert split["bodies"] == ["womb", "ovary"]
    assert all(m["as_read"]["volume_m3"] > 0 and m["as_read"]["boundary_edges"] == 0 for m in split["meshes"])
    whole = report("import", "parts.glb", "-o", "parts/whole.spore")
    assert whole["bodies"] == ["parts"] and any("2 parts" in d["message"] for d in whole["diagnostics"])


@check
def import_takes_gltf_with_its_buffer_beside_it():
    """The buffer's file is read from the same folder, and the scene needs it no more; the body is as yellow as in the file."""
    if "assimp" not in FEATURES:
        raise Skip("built without assimp")
    packed = shapes.glb(spleen=shapes.sphere())
    length = int.from_bytes(packed[12:16], "little")
    text = json.loads(packed[20:20 + length])
    text["buffers"][0]["uri"] = "spleen.bin"
    text["materials"] = [{"pbrMetallicRoughness": {"baseColorFactor": [1, 1, 0, 1]}}]
    text["meshes"][0]["primitives"][0]["material"] = 0
    file("beside/spleen.gltf", json.dumps(text))
    file("beside/spleen.bin", packed[28 + length:])
    answer = report("import", "beside/spleen.gltf", "-o", "yellow/spleen.spore")
    assert answer["meshes"][0]["colour"] == [1, 1, 0] and 'colour="1 1 0"' in (WORK / "yellow/spleen.spore").read_text()
    (WORK / "beside/spleen.bin").unlink()
    assert not [d for d in report("check", "yellow/spleen.spore")["diagnostics"] if d["severity"] == "error"]
    refuses("import", "beside/spleen.gltf", "-o", "yellow/none.spore", says=["spleen.bin", "same folder"])
    refuses("surface", "beside/spleen.gltf", "--nodes", 100, says=["spleen.bin", "same folder"])


@check
def import_keeps_the_picture_of_a_mesh():
    """The picture of a glTF lies beside the scene, goes with a mirrored copy, and is missed, or misfits, in words."""
    if "assimp" not in FEATURES:
        raise Skip("built without assimp")
    picture = shapes.png(16, 16, lambda x, y: (200, 16 * x, 16 * y))
    file("worn.gltf", shapes.textured_gltf(*shapes.sphere(), picture))
    report("import", "worn.gltf", "-o", "worn/a.spore")
    spore("edit", "worn/a.spore", "--mirror", "worn=x")
    visuals = xml.etree.ElementTree.parse(WORK / "worn/a.spore").findall(".//visual")
    assert len(visuals) == 2 and visuals[0].get("texture") == visuals[1].get("texture"), visuals
    assert (WORK / "worn" / visuals[0].get("texture")).read_bytes() == picture
    assert visuals[0].get("colour") == "1 1 1" and visuals[0].get("texture_places") != visuals[1].get("texture_places")
    says = lambda: " ".join(d["message"] for d in report("check", "worn/a.spore")["diagnostics"])
    assert "texture" not in says() and "picture" not in says(), says()
    answer = report("plan", "worn/a.spore")
    uses = {texture["file"]: texture for texture in answer["textures"]}
    assert len(uses) == 3 and uses[visuals[0].get("texture")] == {"file": visuals[0].get("texture"), "bytes": len(picture), "bodies": ["worn", visuals[1].get("mesh")]}, uses
    left, = [left for left in answer["left_out"] if "texture" in left["reason"]]
    assert left["what"] == "3 files" and left["bytes"] == sum(texture["bytes"] for texture in uses.values()), left
    left = report("export", "worn/a.spore", "--format", "runtime", "-o", "worn/a.runtime")["left_out"]
    assert all(any(name in sentence for sentence in left) for name in uses), left
    places = WORK / "worn" / visuals[0].get("texture_places")
    places.write_text("\n".join(places.read_text().splitlines()[:-1]))
    assert "expected exactly" in says()
    (WORK / "worn" / visuals[0].get("texture")).unlink()
    assert visuals[0].get("texture") in says()
    lost = report("export", "worn/a.spore", "--format", "gltf", "-o", "worn/a.glb")["lost"]
    assert sum("picture on its surface" in sentence for sentence in lost) == 2, lost


def visual_of(scene):
    return xml.etree.ElementTree.parse(WORK / scene).find(".//visual")


@check
def import_takes_pictures_beside_the_mesh():
    """An OBJ with its materials and a glTF wear the pictures beside them; seams stay; what lies elsewhere, is missing or no picture is said."""
    if "assimp" not in FEATURES:
        raise Skip("built without assimp")
    vertices, triangles = shapes.sphere()
    picture = shapes.png(16, 16, lambda x, y: (200, 16 * x, 16 * y))
    file("obj/pictures/skin a.png", picture)
    file("obj/worn.obj", shapes.worn_obj(vertices, triangles, ".\\worn.mtl", "skin", "fat"))
    described = lambda path: f"# made by a test\nnewmtl skin\n\tKd 1 0.5 0.25\n\tmap_Kd -s 1 1 1 -clamp on {path}\nnewmtl fat\nKd 1 0.5 0.25\nmap_Kd {path}\n"
    file("obj/worn.mtl", described("pictures\\skin a.png"))
    assert not report("import", "obj/worn.obj", "-o", "obj/a/a.spore")["diagnostics"]
    visual = visual_of("obj/a/a.spore")
    assert (WORK / "obj/a" / visual.get("texture")).read_bytes() == picture and visual.get("colour") == "1 0.5 0.25", visual.attrib
    places = [float(word) for word in (WORK / "obj/a" / visual.get("texture_places")).read_text().split()[2:]]
    expected = [(u, 1 - v) for corners in shapes.seamed(vertices, triangles) for u, v in corners]
    kept = list(zip(places[::2], places[1::2]))
    assert len(kept) == len(expected)
    assert all(min(abs(k[0] - e[0]) + abs(k[1] - e[1]) for e in expected) < 1e-4 for k in kept[::29])
    assert all(max(u for u, v in kept[i:i + 3]) - min(u for u, v in kept[i:i + 3]) < 0.2 for i in range(0, len(kept), 3))
    file("obj/worn.mtl", described("-s 2 3 -o 0.25 -0.5 0 pictures\\skin a.png"))  # repeated and moved, counted from below
    spore("import", "obj/worn.obj", "-o", "obj/moved/a.spore")
    moved = [float(word) for word in (WORK / "obj/moved" / visual_of("obj/moved/a.spore").get("texture_places")).read_text().split()[2:]]
    wanted = [at for u, v in kept for at in (2 * u + 0.25, 1 - (3 * (1 - v) - 0.5))]
    assert len(moved) == len(wanted) and all(abs(a - b) < 1e-4 for a, b in zip(moved, wanted)), (moved[:6], wanted[:6])
    (WORK / "link.png").write_bytes(picture)
    (WORK / "obj/link.png").symlink_to(WORK / "link.png")
    for path, words in (("none.png", "not there"), ("../link.png", "same folder or below"), (f"{WORK}/link.png", "same folder or below"),
                        ("link.png", "no regular file"), ("worn.mtl", "no PNG")):
        file("obj/worn.mtl", described(path))
        found = report("import", "obj/worn.obj", "-o", "obj/b/b.spore")["diagnostics"]
        assert any(words in d["message"] + d["remedy"] for d in found) and visual_of("obj/b/b.spore").get("texture") is None, (path, found)
        (WORK / "obj/b/b.spore").unlink()
    (WORK / "obj/worn.mtl").unlink()
    found = report("import", "obj/worn.obj", "-o", "obj/b/b.spore")["diagnostics"]
    assert any("worn.mtl" in d["message"] for d in found) and visual_of("obj/b/b.spore").get("colour") != "0.6 0.6 0.6", found
    scene = WORK / "obj/b/b.spore"
    assert report("edit", scene, "--texture", "worn=" + str(WORK / "obj/pictures/skin a.png"))["changed"] == ["bodies/worn/visual"]
    visual = visual_of(scene)
    assert (scene.parent / visual.get("texture")).read_bytes() == picture and visual.get("colour") == "1 1 1", visual.attrib
    assert [float(word) for word in (scene.parent / visual.get("texture_places")).read_text().split()[2:]] == places
    (scene.parent / visual.get("texture")).unlink()  # and is found again
    spore("edit", scene, "--texture", "worn=" + str(WORK / "obj/pictures/skin a.png"))
    assert not report("check", scene)["diagnostics"] and (scene.parent / visual.get("texture")).exists()
    if "jpeg" in FEATURES:
        spore("edit", scene, "--texture", "worn=" + str(file("obj/photo.jpg", shapes.PHOTOGRAPH)))
        assert (scene.parent / visual_of(scene).get("texture")).read_bytes()[:4] == b"\x89PNG"
    file("obj/bare.off", shapes.off(vertices, triangles))
    spore("import", WORK / "obj/bare.off", "--add", "-o", scene)
    for wrong, words in (("bare=" + str(WORK / "obj/pictures/skin a.png"), "no places in a picture"), (f"worn={WORK}/obj/worn.obj", "no PNG"),
                         (f"worn={WORK}/none.png", "cannot be read"), ("worn", "BODY=FILE"), ("none=a.png", "no body")):
        refuses("edit", scene, "--texture", wrong, says=[words])
    file("obj/worn.mtl", described("later.png"))  # a mesh that changed keeps its places
    found = report("import", "obj/worn.obj", "--triangles", 300, "-o", "obj/e/e.spore")["diagnostics"]
    assert any("later.png" in d["message"] for d in found) and any("name a texture" in d["remedy"] for d in found), found
    spore("edit", "obj/e/e.spore", "--texture", "worn=" + str(WORK / "obj/pictures/skin a.png"))
    assert not report("check", "obj/e/e.spore")["diagnostics"]
    text = json.loads(shapes.textured_gltf(vertices, triangles, picture))
    text["images"] = [{"uri": "pictures/skin%20a.png"}]
    file("obj/worn.gltf", json.dumps(text))
    assert not report("import", "obj/worn.gltf", "-o", "obj/c/c.spore")["diagnostics"]
    assert (WORK / "obj/c" / visual_of("obj/c/c.spore").get("texture")).read_bytes() == picture
    (WORK / "obj/pictures/skin a.png").unlink()
    found = report("import", "obj/worn.gltf", "-o", "obj/d/d.spore")["diagnostics"]
    assert any("skin a.png" in d["message"] for d in found) and visual_of("obj/d/d.spore").get("texture") is None, found


@check
def import_makes_one_picture_of_several():
    """A mesh of several materials wears one picture made of theirs and of plain colours, repeated where they repeat; what is missing or too small is said. Its opacity is d or what Tr leaves; what of it is not shown is said."""
    if "assimp" not in FEATURES or "render" not in FEATURES:
        raise Skip("built without assimp or libpng")
    vertices, triangles = shapes.sphere()
    file("mix/skin.png", shapes.png(16, 16, lambda x, y: (200, 16 * x, 16 * y)))
    file("mix/fat.png", shapes.png(64, 8, lambda x, y: (0, 4 * x, 32 * y)))
    materials = "newmtl skin\nmap_Kd skin.png\nnewmtl bone\nKd 0.2 0.5 0.3\nnewmtl fat\nKd 1 1 0.5\nmap_Kd -s 3 1 1 -o 7.5 0 0 %s\n"
    file("mix/worn.obj", shapes.worn_obj(vertices, triangles, "worn.mtl", "skin", "fat", "bone"))

    def looks_as_meant(scene, fat):
        visual = visual_of(scene)
        places = [float(word) for word in (WORK / scene).with_name(visual.get("texture_places")).read_text().split()[2:]]
        rows = picture_files.png((WORK / scene).with_name(visual.get("texture")))
        size = len(rows[0]) // 3, len(rows)
        assert visual.get("colour") == "1 1 1" and len(places) == 6 * len(triangles), visual.attrib
        for i, corners in enumerate(shapes.seamed(vertices, triangles)):
            kind = i // 100 % 3
            x, y = (int(sum(places[6 * i + k:6 * i + 6:2]) / 3 * size[k]) for k in range(2))
            u, v = sum(at[0] for at in corners) / 3, 1 - sum(at[1] for at in corners) / 3
            wanted = ((200, 256 * u % 256, 256 * v), (0, 256 * (3 * u + 7.5) % 256, 128 * v) if fat else (255, 255, 128), (51, 128, 77))[kind]
            near = lambda a, b: min(abs(a - b), 256 - abs(a - b)) < 25
            assert all(near(a, b) for a, b in zip(rows[y][3 * x:3 * x + 3], wanted)), (i, kind, wanted, rows[y][3 * x:3 * x + 3])

    file("mix/worn.mtl", materials % "fat.png")
    assert not report("import", "mix/worn.obj", "-o", "mix/a/a.spore")["diagnostics"]
    looks_as_meant("mix/a/a.spore", True)
    file("mix/worn.mtl", materials % "none.png")
    found = report("import", "mix/worn.obj", "-o", "mix/b/b.spore")["diagnostics"]
    assert any("none.png" in d["message"] and "not there" in d["message"] for d in found), found
    looks_as_meant("mix/b/b.spore", False)
    file("mix/worn.mtl", materials % "worn.obj")
    assert any("cannot be decoded" in d["message"] for d in report("import", "mix/worn.obj", "-o", "mix/c/c.spore")["diagnostics"])
    looks_as_meant("mix/c/c.spore", False)
    file("mix/worn.mtl", (materials % "fat.png").replace("-s 3", "-s 9000"))
    assert any("made smaller" in d["message"] for d in report("import", "mix/worn.obj", "-o", "mix/d/d.spore")["diagnostics"])
    file("mix/worn.mtl", "newmtl skin\nKd 1 0 0\nnewmtl bone\nKd 0.2 0.5 0.3\nnewmtl fat\nKd 1 0 0\n")
    spore("import", "mix/worn.obj", "-o", "mix/e/e.spore")
    assert visual_of("mix/e/e.spore").get("texture")
    file("mix/worn.mtl", "newmtl skin\nKd 1 0 0\nnewmtl bone\nKd 1 0 0\nnewmtl fat\nKd 1 0 0\n")
    spore("import", "mix/worn.obj", "-o", "mix/f/f.spore")
    assert visual_of("mix/f/f.spore").get("texture") is None and visual_of("mix/f/f.spore").get("colour") == "1 0 0"
    for case, more, opacity, word in (("g", ("d 0.5",) * 3, "0.5", None), ("h", ("Tr 0.25",) * 3, "0.75", None), ("i", ("Tr 0.25\nd 0.5",) * 3, "0.5", None),
                                      ("j", ("d 0.5", "d 0.5", "d 0.25"), "0.5", "differ in opacity"), ("k", ("", "map_d skin.png", ""), None, "map_d"), ("l", ("Tr 0",) * 3, None, None)):
        file("mix/worn.mtl", "".join(f"newmtl {name}\nKd 1 0 0\n{said}\n" for name, said in zip(("skin", "fat", "bone"), more)))
        found = report("import", "mix/worn.obj", "-o", f"mix/{case}/{case}.spore")["diagnostics"]
        assert visual_of(f"mix/{case}/{case}.spore").get("opacity") == opacity, (case, found)
        assert [word in d["message"] for d in found] == [True] if word else not found, (case, found)


@check
def import_keeps_photographs_as_png():
    """A JPEG on a mesh becomes a PNG of its colours; one that is cut off is left away in words."""
    if "assimp" not in FEATURES:
        raise Skip("built without assimp")
    for name, content in (("whole", shapes.PHOTOGRAPH), ("short", shapes.PHOTOGRAPH[:-20])):
        file(f"{name}.gltf", shapes.textured_gltf(*shapes.sphere(), content, "image/jpeg"))
        found = report("import", f"{name}.gltf", "-o", f"photo/{name}.spore")["diagnostics"]
        kept = visual_of(f"photo/{name}.spore").get("texture")
        assert (kept is not None) == (name == "whole" and "jpeg" in FEATURES), (name, kept)
        assert (kept is None) == any("no PNG" in d["message"] for d in found), (name, found)
        if kept:
            picture = (WORK / "photo" / kept).read_bytes()
            assert picture[:4] == b"\x89PNG" and picture[16:24] == bytes([0, 0, 0, 8] * 2), picture[:40]


@check
def import_mends_meshes():
    """Operations with figures before and after: a hole is filled, smoothing keeps the volume, each says how far it moved."""
    vertices, triangles = shapes.sphere()
    file("holed.off", shapes.off(vertices, triangles[6:] + triangles[-1:]))
    answer = report("import", "holed.off", "--triangles", 200, "--smooth", 5, "--fill-holes", "--clean", "-o", "mended/holed.spore")
    steps = {step["name"]: step for step in answer["meshes"][0]["operations"]}
    assert list(steps) == ["clean", "fill-holes", "smooth", "triangles"]
    assert steps["fill-holes"]["before"]["boundary_edges"] > 0 == steps["fill-holes"]["after"]["boundary_edges"]
    assert steps["fill-holes"]["moved_m"] > 0
    smooth = steps["smooth"]
    assert abs(smooth["after"]["volume_m3"] / smooth["before"]["volume_m3"] - 1) < 1e-9 and 0 < smooth["moved_m"] < 0.003
    fewer = steps["triangles"]["after"]
    assert abs(fewer["triangles"] - 200) < 10 and abs(fewer["volume_m3"] / smooth["after"]["volume_m3"] - 1) < 0.02, fewer
    assert report("import", "holed.off", "--fill-holes=3", "-o", "mended/few.spore")["meshes"][0]["operations"][0]["after"]["boundary_edges"] > 0
    mended = WORK / "mended" / re.search('file="(holed-.*off)"', (WORK / "mended/holed.spore").read_text())[1]
    saved = report("import", mended, "-o", "mended/again.spore")["meshes"][0]["as_read"]
    assert saved["boundary_edges"] == 0 and abs(saved["volume_m3"] / fewer["volume_m3"] - 1) < 1e-9
    for arguments, says in ((("--smooth", 0), "1000"), (("--smooth", "much"), "much"), (("--weld", 2), "0.1"), (("--fill-holes=-1",), "-1")):
        refuses("import", "holed.off", *arguments, "-o", "mended/no.spore", says=[says, arguments[0].split("=")[0]])
    assert not (WORK / "mended/no.spore").exists()


@check
def places_to_write_are_asked_for_first():
    """What cannot be written is said before the work on it begins: a folder that is not there, before the mesh is read."""
    for command, option, name in (("spheres --count 4", "-o", "a.spheres"), ("tetrahedra --cells 100", "-o", "a.mesh"),
                                  ("surface --nodes 100", "-o", "a.off"), ("centreline", "-o", "a.curve"),
                                  ("spheres --counts 4,8", "--svg", "a.svg")):
        stopped = spore(*command.split(), "no-such-mesh.off", option, f"nowhere/{name}", status=(2, 3)).stderr
        assert "nowhere" in stopped and "no-such-mesh" not in stopped, stopped


@check
def import_doubts_unit_and_axes():
    """A size that no organ has is said with the unit that would make it one; axes said by the file are taken, or their loss said."""
    file("mm.off", shapes.off(*shapes.sphere(radius=30)))
    found = report("import", "mm.off", "-o", "doubt/mm.spore")
    assert any("104 m across" in d["message"] and "in mm it would be 104 mm" in d["remedy"] for d in found["diagnostics"]), found
    assert found["meshes"][0]["unit"] == "m"
    assert not report("import", "mm.off", "--unit", "mm", "-o", "doubt/right.spore")["diagnostics"]
    file("tiny.off", shapes.off(*shapes.sphere(radius=5e-5)))
    assert any("in m" not in d["remedy"] and "across" in d["message"] for d in report("import", "tiny.off", "-o", "doubt/tiny.spore")["diagnostics"])
    file("slicer.off", b"OFF # SPACE=LPS\n" + shapes.off(*shapes.sphere(centre=(0.1, 0.2, 0.3)))[4:])
    said = report("import", "slicer.off", "-o", "doubt/said.spore")
    assert said["meshes"][0]["frame"] == "LPS" and 'frame="LPS"' in (WORK / "doubt/said.spore").read_text()
    other = report("import", "slicer.off", "--frame", "RAS", "-o", "doubt/other.spore")
    assert other["meshes"][0]["frame"] == "RAS" and any("LPS" in d["message"] for d in other["diagnostics"])


def medit(name):
    """(vertices, cells as (corners, label)) of a .mesh file."""
    words = iter((WORK / name).read_text().split())
    vertices, cells = [], []
    for word in words:
        if word == "Vertices":
            vertices = [tuple(float(next(words)) for _ in range(4))[:3] for _ in range(int(next(words)))]
        elif word == "Tetrahedra":
            cells = [(tuple(int(next(words)) - 1 for _ in range(4)), int(next(words))) for _ in range(int(next(words)))]
    return vertices, cells


def volume_of(vertices, corners):
    a, b, c, d = (vertices[i] for i in corners)
    u, v, w = ([q - p for p, q in zip(a, x)] for x in (b, c, d))
    return (u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) + u[2] * (v[0] * w[1] - v[1] * w[0])) / 6


def two_boxes():
    """Two boxes of 16 x 16 x 16 voxels of 1 x 2 x 0.5 mm that share a face; 32 x 16 x 16 voxels from (4, 4, 4)."""
    size = (40, 24, 24)
    return size, shapes.labels(size, lambda i, j, k: (1 if i < 20 else 2) if 4 <= i < 36 and 4 <= j < 20 and 4 <= k < 20 else 0)


@check
def tetrahedra_of_a_label_map():
    """Organs of a label map are meshed together: shared faces fit, each cell knows its label, volumes are those of the voxels."""
    if "volumes" not in FEATURES:
        raise Skip("built without volumes")
    size, voxels = two_boxes()
    file("boxes.nii.gz", gzip.compress(shapes.nifti(size, voxels, spacing=(1, 2, 0.5), origin=(10, 20, 30))))
    answer = report("tetrahedra", "boxes.nii.gz", "--cells", 1000, "-o", "boxes.mesh")
    assert answer["min_dihedral_deg"] >= 10 and abs(answer["tetrahedra"] / 1000 - 1) < 0.05 and answer["method"] == "labels"
    vertices, cells = medit("boxes.mesh")
    faces = {}
    for corners, label in cells:
        assert volume_of(vertices, corners) > 0
        for k in range(4):
            faces.setdefault(tuple(sorted(corners[:k] + corners[k + 1:])), []).append(label)
    assert max(map(len, faces.values())) == 2
    assert answer["shared_faces"] == sum(len(set(labels)) == 2 for labels in faces.values()) > 20
    for row in answer["labels"]:
        mine = [corners for corners, label in cells if label == row["label"]]
        volume = sum(volume_of(vertices, corners) for corners in mine)
        assert len(mine) == row["cells"] == round(row["share"] * answer["tetrahedra"]) and abs(volume / row["volume_m3"] - 1) < 1e-6
        assert abs(volume / 16 ** 3 / 1e-9 - 1) < 0.01 and abs(row["volume_change"]) < 0.01
    # Axes: i to the right, j to the front (SPORE's -z), k up; the middle of voxel (0, 0, 0) at (10, 20, 30) mm.
    for axis, (low, high) in enumerate(((13.5, 45.5), (31.75, 39.75), (-59, -27))):
        at = [1000 * v[axis] for v in vertices]
        assert abs(min(at) - low) < 1.5 and abs(max(at) - high) < 1.5, (axis, min(at), max(at))
    one = report("tetrahedra", "boxes.nii.gz", "--cells", 500, "--labels", "2", "-o", "one.vtu")
    assert [row["label"] for row in one["labels"]] == [2] and one["shared_faces"] == 0
    assert 'Name="label"' in (WORK / "one.vtu").read_text()
    spore("tetrahedra", "boxes.nii.gz", "--size", 0.004, "-o", "boxes.msh")
    for arguments, says in ((("--labels", "7"), "label"), (("--labels", "1,x"), "x"), (("--unit", "mm"), "--unit")):
        refuses("tetrahedra", "boxes.nii.gz", "--cells", 500, *arguments, says=[says])


@check
def labels_without_their_steps():
    """A ball of two halves, by its voxels: the cells' outside lies within .7 of a voxel of the ball, each half keeps its
    volume within half a percent, and so does a layer of two voxels."""
    if "volumes" not in FEATURES:
        raise Skip("built without volumes")
    middle, radius, n = (15.4, 15.9, 15.2), 12.3, 32
    def label(i, j, k):
        away = math.dist((i, j, k), middle)
        return 0 if away > radius else 3 if away > radius - 2 else 1 if i + j < 31 else 2
    file("halves.nii", shapes.nifti((n, n, n), shapes.labels((n, n, n), label)))
    answer = report("tetrahedra", "halves.nii", "--cells", 1500, "-o", "halves.mesh")
    assert answer["min_dihedral_deg"] >= 10
    assert all(abs(row["volume_change"]) < 0.005 for row in answer["labels"]), answer["labels"]
    vertices, cells = medit("halves.mesh")
    faces = {}
    for corners, _ in cells:
        for k in range(4):
            face = tuple(sorted(corners[:k] + corners[k + 1:]))
            faces[face] = face not in faces
    outer = [face for face, single in faces.items() if single]
    off = []
    for face in outer:
        a, b, c = (vertices[i] for i in face)
        for p in (a, b, c, tuple((x + y + z) / 3 for x, y, z in zip(a, b, c))):
            off.append(abs(1000 * math.dist(p, (middle[0] / 1000, middle[2] / 1000, -middle[1] / 1000)) - radius))
    assert max(off) < 0.7, max(off)


@check
def label_maps_are_listed_before_they_are_meshed():
    """Number, name with where it comes from, voxels, volume, size and the sides that are reached; names choose labels."""
    if "volumes" not in FEATURES:
        raise Skip("built without label maps")
    size = (10, 8, 6)
    at = lambda i, j, k: 3 if i < 4 and 1 <= j < 5 and 1 <= k < 5 else 7 if 6 <= i < 9 and 2 <= j < 6 and 2 <= k < 5 else 0
    voxels = shapes.labels(size, at)
    table = b'<CaretExtension><VolumeInformation><LabelTable><Label Key="3" Red="1">left kidney</Label></LabelTable></VolumeInformation></CaretExtension>'
    table += bytes(-(len(table) + 8) % 16)
    plain = bytearray(shapes.nifti(size, voxels, spacing=(1, 2, 3)))
    bare, own = bytes(plain), bytearray(plain)
    struct.pack_into("<f", own, 108, 352 + 8 + len(table))
    own[348] = 1
    own[352:352] = struct.pack("<ii", len(table) + 8, 30) + table
    row = lambda name: {r["label"]: r for r in report("tetrahedra", name, "--list")["labels"]}
    for name, content in (("list.nii", bare), ("list.nii.gz", gzip.compress(bare)), ("list.nrrd", shapes.nrrd(size, voxels, spacing=(1, 2, 3)))):
        file(name, content)
        rows = row(name)
        assert list(rows) == [3, 7] and [rows[n]["voxels"] for n in rows] == [64, 36], rows
        assert abs(rows[3]["volume_m3"] - 64 * 6e-9) < 1e-15 and all(abs(a - b) < 1e-12 for a, b in zip(rows[3]["size_m"] + rows[7]["size_m"], (0.004, 0.008, 0.012, 0.003, 0.008, 0.009))), rows
        assert rows[3]["cut"] == ["i-"] and rows[7]["cut"] == [] and rows[3]["name"] is None and rows[3]["named"] is None, rows
    file("own.nii.gz", gzip.compress(bytes(own)))
    assert (row("own.nii.gz")[3]["name"], row("own.nii.gz")[3]["named"], row("own.nii.gz")[7]["name"]) == ("left kidney", "file", None)
    sidecars = (("own.json", '{"labels": {"background": 0, "tumour": 7, "other": 3}}'), ("list.json", '{"name": "x", "7": "tumour"}'),
                ("list.txt", '# ITK-SnAP\n    7   255    0    0        1  1  1    "tumour"\n'), ("list.ctbl", "7 tumour 255 0 0 255\n"))
    for name, content in sidecars:
        file(name, content)
        rows = row("own.nii.gz" if name.startswith("own") else "list.nii")
        assert (rows[7]["name"], rows[7]["named"]) == ("tumour", "sidecar"), (name, rows)
        assert rows[3]["named"] == ("file" if name.startswith("own") else None), rows
        if not name.startswith("own"):
            (WORK / name).unlink()
    one = report("tetrahedra", "own.nii.gz", "--cells", 100, "--labels", "Left Kidney")
    assert [r["name"] for r in one["labels"]] == ["left kidney"], one
    both = report("tetrahedra", "own.nii.gz", "--cells", 100, "--labels", "7, left kidney")
    assert [(r["label"], r["name"]) for r in both["labels"]] == [(3, "left kidney"), (7, "tumour")], both
    refuses("tetrahedra", "own.nii.gz", "--cells", 100, "--labels", "spleen", says=["spleen", "left kidney", "--list"])
    refuses("tetrahedra", "own.nii.gz", "--list", "-o", "list.vtu", says=["--list", "-o"])
    refuses("tetrahedra", file("list.off", shapes.off(*shapes.sphere())), "--list", says=["--list", "label map"])
    assert "left kidney" in spore("tetrahedra", "own.nii.gz", "--list").stdout


@check
def names_of_labels_are_guessed_where_a_common_set_holds_them_all():
    """Told as guesses in list and scene until confirmed; nothing is guessed of few labels, of others, or against a size."""
    if "volumes" not in FEATURES:
        raise Skip("built without label maps")
    size = (10, 12, 4)
    def rows(numbers, spacing=1):
        at = lambda i, j, k: numbers[j - 1] if 1 <= j <= len(numbers) and 1 <= i < 9 and 1 <= k < 3 else 0
        file("numbers.nii", shapes.nifti(size, shapes.labels(size, at), spacing=(spacing, spacing, spacing)))
        return {r["label"]: (r["name"], r["named"]) for r in report("tetrahedra", "numbers.nii", "--list")["labels"]}
    known = rows([1, 2, 3, 4, 5, 6, 7, 8, 9, 110])
    assert known[5] == ("liver", "guessed") and known[8] == ("adrenal_gland_right", "guessed") and known[110] == ("rib_right_7", "guessed"), known
    shared = rows([1, 2, 3, 4, 5, 6, 7, 8, 9, 104])
    assert shared[5] == ("liver", "guessed") and shared[7] == shared[104] == (None, None), shared
    assert all(name == (None, None) for name in rows([1, 2, 3, 4, 5, 6, 7, 8, 110]).values())
    assert all(name == (None, None) for name in rows([1, 2, 3, 4, 5, 6, 7, 8, 9, 118]).values())
    assert all(name == (None, None) for name in rows([1, 2, 3, 4, 5, 6, 7, 8, 9, 110], 20).values())  # adrenal glands of 128 ml
    known = rows([1, 2, 3, 4, 5, 6, 7, 8, 9, 110])
    assert "  guessed" in spore("tetrahedra", "numbers.nii", "--list").stdout
    report("tetrahedra", "numbers.nii", "--size", 0.001, "--labels", "liver,stomach", "-o", "guessed.spore")
    guesses = lambda: spore("check", "guessed.spore").stdout.count("is a guess")
    assert guesses() == 2
    spore("edit", "guessed.spore", "--set", "bodies/liver/name_guessed=false")
    assert guesses() == 1
    spore("edit", "guessed.spore", "--set", "bodies/stomach/name=gaster")
    assert guesses() == 0, "who renames it knows"
    file("numbers.json", '{"5": "liver"}')
    named = {r["label"]: r["named"] for r in report("tetrahedra", "numbers.nii", "--list")["labels"]}
    assert named[5] == "sidecar" and named[6] is None, named
    (WORK / "numbers.json").unlink()


@check
def surroundings_of_chosen_labels_are_unmovable_surfaces():
    """Thin and within half a voxel, what the edge of the volume may cut told, in a scene that is drawn as it is."""
    if "volumes" not in FEATURES:
        raise Skip("built without label maps")
    size = (28, 26, 24)
    ball = lambda i, j, k, x, r: (i - x) ** 2 + (j - 13) ** 2 + (k - 12) ** 2 < r * r
    at = lambda i, j, k: 1 if i < 13 and ball(i, j, k, 9, 7) else 2 if i >= 13 and ball(i, j, k, 18, 7) else 4 if k < 2 else 0
    file("around.nii", shapes.nifti(size, shapes.labels(size, at), spacing=(1, 1, 1.5)))
    file("around.json", '{"1": "liver", "2": "stomach", "4": "table"}')
    answer = report("tetrahedra", "around.nii", "--cells", 200, "--labels", "liver", "--surroundings", "-o", "around.spore")
    assert [row["cut"] for row in answer["labels"]] == [[]], answer["labels"]
    rest = {row["name"]: row for row in answer["surroundings"]}
    assert list(rest) == ["stomach", "table"] and answer["surroundings_seconds"] > 0, answer
    assert all(3 * row["triangles"] < row["triangles_before"] and 0 < row["off_voxels"] <= 0.5 for row in rest.values()), rest
    assert rest["stomach"]["cut"] == [] and rest["table"]["cut"] == ["i-", "i+", "j-", "j+", "k-"], rest
    scene = (WORK / "around.spore").read_text()
    assert scene.count('role="unmovable"') == 2 and scene.count("<neo_hookean_tetrahedra") == 1, scene
    assert "fault" not in spore("check", "around.spore").stdout
    both = spore("tetrahedra", "around.nii", "--cells", 200, "--labels", "liver,table", "--surroundings", "-o", "both.spore").stdout
    assert [line.split(":")[0].strip() for line in both.splitlines() if "unmovable" in line] == ["stomach"], both
    assert [line.split(":")[0].strip() for line in both.splitlines() if "may cut it" in line] == ["table"], both
    refuses("tetrahedra", "around.nii", "--cells", 200, "--surroundings", "-o", "no.spore", says=["--surroundings", "--labels"])
    refuses("tetrahedra", "around.nii", "--cells", 200, "--labels", "liver", "--surroundings", "-o", "no.vtu", says=["--surroundings", "F.spore"])


@check
def scene_of_a_label_map():
    """A label map becomes a scene: a soft body of each organ, named as the file names it, joined by a seam; it runs."""
    if "volumes" not in FEATURES:
        raise Skip("built without volumes")
    size, voxels = two_boxes()
    content = shapes.nrrd(size, voxels, spacing=(1, 2, .5))
    head, data = content.split(b"\n\n", 1)
    named = head + b"\nSegment0_Name:=left lobe\nSegment0_LabelValue:=1\nSegment1_Name:=gall bladder\nSegment1_LabelValue:=2\n\n" + data
    answer = report("tetrahedra", file("patient.seg.nrrd", named), "--cells", 600, "-o", "patient/patient.spore")
    assert [row["name"] for row in answer["labels"]] == ["left lobe", "gall bladder"] and answer["seams"] == 1, answer
    scene = xml.etree.ElementTree.parse(WORK / "patient/patient.spore").getroot()
    assert [body.get("name") for body in scene.find("bodies")] == ["left_lobe", "gall_bladder"]
    assert [(seam.get("body_a"), seam.get("body_b")) for seam in scene.find("links")] == [("left_lobe", "gall_bladder")]
    assert scene.find("assets/label_map") is not None and scene.find("assets/tetrahedra").get("cells") == "600"
    assert not any("stale" in d["message"] for d in report("check", "patient/patient.spore")["diagnostics"])
    report("run", "patient/patient.spore", "--steps", 3)
    again = spore("tetrahedra", "patient.seg.nrrd", "--cells", 600, "-o", "patient/patient.spore")
    assert "takes the place" in again.stdout and "were asked for" not in again.stdout
    tissues = file("tissues.nrrd", named.replace(b"left lobe", b"stomach").replace(b"gall bladder", b"gallbladder"))
    soft, stiff = report("tetrahedra", tissues, "--cells", 600)["labels"]
    assert [row["weight"] for row in answer["labels"]] == [1, 1] and soft["weight"] > 1.5 and stiff["weight"] == 0.5, soft
    per_volume = [soft["cells"] / soft["volume_m3"], stiff["cells"] / stiff["volume_m3"]]
    assert per_volume[0] > 1.9 * per_volume[1], per_volume
    side = 16
    specks = bytes(int(i % 4 < 2 and j % 4 < 2 and k % 4 < 2) for k in range(side) for j in range(side) for i in range(side))
    assert "cells were asked for" in spore("tetrahedra", file("specks.nrrd", shapes.nrrd((side,) * 3, specks)), "--cells", 20).stdout
    file("surface.off", shapes.off(*shapes.sphere()))
    refuses("tetrahedra", "surface.off", "--cells", 100, "-o", "x.spore", says=["x.spore", "surface", "--body"])


@check
@alike
@long_run
def spheres_say_what_is_in_vain():
    """A region off the organ and walls too thin for so few spheres get a word; a surface that encloses nothing is refused."""
    ball = file("vain.off", shapes.off(*shapes.sphere()))
    ask = lambda *regions: report("spheres", "vain.off", "--count", 12, *(x for r in regions for x in ("--region", r)))["regions_missed"]
    assert ask("0,0.03,0,0.01,2", "3,0,0,0.01,2") == [1] and ask("0,0.03,0,0.01,2") == [] and ask() == []
    said = spore("spheres", "vain.off", "--count", 12, "--region", "3,0,0,0.01,2").stdout
    assert "3,0,0" in said and "no effect" in said and "hold little" not in said
    shell = shapes.joined(shapes.sphere(), tuple((x, [t[::-1] for t in y]) for x, y in [shapes.sphere(radius=0.025)])[0])
    assert "--thickness" in spore("spheres", file("shell.off", shapes.off(*shell)), "--count", 10).stdout
    wings = ([(0, 0, 0), (0.1, 0, 0), (0, 0.1, 0), (0, -0.1, 0.01), (0, 0.01, 0.1), (0, 0, -0.1)], [(0, 1, k) for k in (2, 3, 4, 5)])
    refuses("spheres", file("wings.off", shapes.off(*wings)), "--count", 5, "-o", "wings.spheres", says=["wings.off", "hold nothing", "--thickness"])
    assert not (WORK / "wings.spheres").exists()


@check
def names_from_any_script():
    """Bodies are named after files in letters that the format has: marks go, what has none of them is an organ."""
    names = ("vésicule biliaire.off", "Größe.off", "肝臓.off", "7.off")
    for name in names:
        file(name, shapes.off(*shapes.sphere()))
    bodies = report("import", *names, "-o", "names/names.spore")["bodies"]
    assert bodies == ["vesicule_biliaire", "Grosse", "organ", "organ_7"], bodies
    report("check", "names/names.spore")


@check
@alike
def lines_and_surfaces_for_bodies():
    """centreline and surface of a scene work for a body of it: a tube is carried along its line, a ball becomes a net, or hollow."""
    file("gut.off", shapes.off(*shapes.tube(rings=40)))
    file("sac.off", shapes.off(*shapes.sphere(rings=24, sectors=48)))
    spore("import", "gut.off", "sac.off", "-o", "lines/lines.spore")
    scene = "lines/lines.spore"
    body = lambda name: next(b for b in xml.etree.ElementTree.parse(WORK / scene).getroot().find("bodies") if b.get("name") == name)
    made = report("centreline", scene, "--body", "gut", "--as", "thread", "--points", 9)
    assert made["points"] == 9 and made["body"] == "gut" and abs(made["length"] - 0.08) < 0.001
    assert body("gut").find("mechanical/spline_1d") is not None and body("gut").find("mechanical").get("geometry") == "gut_line"
    assert report("centreline", scene, "--body", "gut")["points"] == 9  # as its asset says
    net = report("surface", scene, "--body", "sac", "--nodes", 150)
    assert net["nodes"] <= 150 and body("sac").find("mechanical").get("geometry") == "sac_surface"
    hollow = report("surface", scene, "--body", "sac", "--wall", 0.005, "--wall-detail", 3)
    assert abs(hollow["wall"]["thickness_m"]["mean"] / 0.005 - 1) < 0.1 and body("sac").find("visual").get("mesh") == "sac_surface"
    report("run", scene, "--steps", 3)
    refuses("centreline", scene, "--body", "gu", says=['no body "gu"', "gut, sac"])
    refuses("edit", scene, "--hold", "gu", says=['no body "gu"', "gut, sac"])
    refuses("centreline", scene, "--body", "gut", "-o", "x.curve", says=["--output"])
    refuses("surface", scene, "--body", "sac", "--unit", "mm", says=["--unit"])
    refuses("surface", "sac.off", "--nodes", 20, "--body", "sac", says=["--body", ".spore"])


@check
def label_maps_of_each_kind():
    """NIfTI 1 and 2 of both byte orders and kinds of numbers, NRRD raw and gzip: the same organs in the same place."""
    if "volumes" not in FEATURES:
        raise Skip("built without volumes")
    size, voxels = two_boxes()
    wide = lambda order, kind: struct.pack(f"{order}{len(voxels)}{kind}", *voxels)
    ras = [1, 0, 0, 10, 0, 2, 0, 20, 0, 0, .5, 30]
    maps = {"q.nii": shapes.nifti(size, voxels, spacing=(1, 2, .5), origin=(10, 20, 30)),
            "s.nii": shapes.nifti(size, wide("<", "h"), datatype=4, bits=16, sform=ras),
            "big.nii": shapes.nifti(size, wide(">", "H"), datatype=512, bits=16, sform=ras, order=">"),
            "two.nii": shapes.nifti2(size, voxels, spacing=(1, 2, .5), origin=(10, 20, 30)),
            "two-big.nii.gz": gzip.compress(shapes.nifti2(size, voxels, sform=ras, order=">")),
            "f.nii": shapes.nifti(size, wide("<", "f"), datatype=16, bits=32, sform=ras),
            "raw.nrrd": shapes.nrrd(size, voxels, spacing=(-1, -2, .5), origin=(-10, -20, 30)),
            "gz.nrrd": shapes.nrrd(size, voxels, spacing=(1, 2, .5), origin=(10, 20, 30), space="RAS", encoding="gzip"),
            "short.nrrd": shapes.nrrd(size, wide(">", "h"), spacing=(1, 2, .5), origin=(10, 20, 30), space="RAS", type="short", endian="big")}
    file("beside.raw", voxels)
    pair = lambda offset, order: (lambda head: head[:108] + struct.pack(order + "f", offset) + head[112:344] + b"ni1\0")(shapes.nifti(size, b"", sform=ras, order=order))
    file("pair.img", voxels)
    file("later.img", bytes(16) + voxels)
    maps["beside.nhdr"] = shapes.nrrd(size, b"", spacing=(1, 2, .5), origin=(10, 20, 30), space="RAS", **{"data file": "beside.raw"})
    maps["pair.hdr"], maps["later.hdr"] = pair(0, "<"), pair(16, ">")
    texts = set()
    for name, content in maps.items():
        spore("tetrahedra", file(name, content), "--cells", 100, "-o", "same.mesh")
        texts.add((WORK / "same.mesh").read_text())
    assert len(texts) == 1


@check
def import_of_a_label_map():
    """Each label becomes a body with a closed surface of its voxels' volume, nested ones with their hollow."""
    if "volumes" not in FEATURES:
        raise Skip("built without volumes")
    distance = lambda i, j, k: math.dist((i, j, k), (15.5, 15.5, 15.5))
    voxels = shapes.labels((32, 32, 32), lambda i, j, k: 5 if distance(i, j, k) < 7 else 3 if distance(i, j, k) < 13 else 0)
    file("nested.nrrd", shapes.nrrd((32, 32, 32), voxels, spacing=(2, 2, 2)))
    answer = report("import", "nested.nrrd", "-o", "nested/nested.spore")
    assert answer["bodies"] == ["nested-3", "nested-5"] and not answer["diagnostics"]
    for mesh, label, pieces in zip(answer["meshes"], (3, 5), (2, 1)):
        figures = mesh["as_read"]
        assert figures["components"] == pieces and figures["boundary_edges"] == figures["nonmanifold_edges"] == 0
        assert abs(figures["volume_m3"] / (voxels.count(label) * 8e-9) - 1) < 0.03, (figures, voxels.count(label))
    told = report("import", "nested.nrrd", "--frame", "LPS", "-o", "nested/told.spore")
    assert any("header" in d["message"] for d in told["diagnostics"])


@check
def bad_label_maps():
    """Each bad label map gets one clear line and leaves no file."""
    if "volumes" not in FEATURES:
        refuses("tetrahedra", file("any.nii", b"x" * 400), "--cells", 100, says=["any.nii", "zlib1g-dev"])
        raise Skip("built without volumes")
    size, voxels = two_boxes()
    good, nrrd = shapes.nifti(size, voxels), shapes.nrrd(size, voxels)
    patch = lambda offset, form, *values: good[:offset] + struct.pack(form, *values) + good[offset + struct.calcsize(form):]
    bombs = gzip.compress(good + bytes(1 << 20))
    cases = {"cut.nii": (good[:-100], "cut short"), "head.nii": (good[:200], "cut short"), "cut2.nii": (shapes.nifti2(size, voxels)[:500], "cut short"), "far2.nii": (shapes.nifti2(size, voxels, offset=2 ** 62), "vox_offset"),
             "wide2.nii": (shapes.nifti2((2 ** 40, 2 ** 40, 2), voxels), "268 million"), "minus2.nii": (shapes.nifti2((4, -4, 2), voxels), "dim[2]"),
             "magic.nii": (patch(344, "4s", b"ni1\0"), "magic.img"),
             "analyze.hdr": (patch(344, "4s", b"")[:348], "one file"), "two.hdr": (good[:4] + b"ni2" + bytes(533), "one file"),
             "type.nii": (patch(70, "<h", 128), "datatype 128"), "dims.nii": (patch(40, "<h", 9), "dim"), "zero.nii": (patch(42, "<h", 0), "dim[1] = 0"),
             "huge.nii": (patch(42, "<3h", 32767, 32767, 32767), "268 million"), "minus.nii": (patch(44, "<h", -4), "dim[2]"),
             "nan.nii": (patch(80, "<f", float("nan")), "size"), "flat.nii": (patch(80, "<f", 0.0), "size"),
             "offset.nii": (patch(108, "<f", 1e9), "vox_offset"), "time.nii": (patch(40, "<5h", 4, *size, 7), "dim[4]"),
             "picture.nii": (shapes.nifti(size, struct.pack(f"<{len(voxels)}f", *[0.5] * len(voxels)), datatype=16, bits=32), "label"),
             "negative.nii": (shapes.nifti(size, struct.pack(f"<{len(voxels)}h", *[-3] * len(voxels)), datatype=4, bits=16), "label"),
             "empty.nii": (shapes.nifti(size, bytes(len(voxels))), "no voxel"), "text.nii": (b"Dear diary, " * 50, "NIfTI-1"),
             "half.nii.gz": (bombs[:len(bombs) // 2], "gzip"), "noise.nii.gz": (b"\x1f\x8b" + bytes(range(256)), "gzip"),
             "cut.nrrd": (nrrd[:-1], "cut short"), "head.nrrd": (nrrd[:40], "cut short"),
             "sizes.nrrd": (shapes.nrrd(size, voxels, sizes="40 24"), "sizes"), "over.nrrd": (shapes.nrrd(size, voxels, sizes="99999 99999 99999"), "268 million"),
             "many.nrrd": (shapes.nrrd(size, voxels, sizes="1e300 2 2"), "sizes"), "four.nrrd": (shapes.nrrd(size, voxels, dimension="4"), "dimension"),
             "space.nrrd": (shapes.nrrd(size, voxels, space="scanner-xyz"), "scanner-xyz"), "bzip.nrrd": (shapes.nrrd(size, voxels, encoding="bzip2"), "bzip2"),
             "away.nrrd": (shapes.nrrd(size, voxels, **{"data file": "/etc/passwd"}), "same folder"), "up.nrrd": (shapes.nrrd(size, voxels, **{"data file": "../x.raw"}), "same folder"),
             "gone.nhdr": (shapes.nrrd(size, b"", **{"data file": "gone.raw"}), "not there"), "short.nhdr": (shapes.nrrd(size, b"", **{"data file": "short.raw"}), "cut short"),
             "nan.nrrd": (shapes.nrrd(size, voxels, **{"space directions": "(nan,0,0) (0,1,0) (0,0,1)"}), "size"),
             "order.nrrd": (shapes.nrrd(size, voxels * 2, type="short"), "endian"), "none.nrrd": (shapes.nrrd(size, voxels, sizes=None), "sizes")}
    file("short.raw", voxels[:-1])
    os.symlink("short.raw", WORK / "link.raw")
    os.mkfifo(WORK / "pipe.raw")
    cases |= {f"{name}.nhdr": (shapes.nrrd(size, b"", **{"data file": f"{name}.raw"}), "regular file") for name in ("link", "pipe")}
    for name, (content, says) in cases.items():
        refuses("tetrahedra", file(name, content), "--cells", 100, "-o", "bad.mesh", says=[name, says])
    refuses("import", "cut.nii", "-o", "bad/bad.spore", says=["cut.nii", "cut short"])
    assert not (WORK / "bad.mesh").exists() and not (WORK / "bad").exists()


@check
def pins_on_lines_say_what_they_hold():
    """plan says where a pinned line bends as if it were clamped; check does where the pin's radius says much else."""
    file("pin/line.curve", "".join(f"{i / 200} 0 0 0.001\n" for i in range(21)))
    for points, radius, held, beyond, noted in ((10, 0.02, 3, 0.29 / 7 * 0.1 - 0.02, True), (80, 0.02, 17, 14.29 / 77 * 0.1 - 0.02, False),
                                                (10, 0, 1, None, False)):
        scene = file("pin/pin.spore", f"""<spore version="1.0"><assets><curve name="c" file="line.curve"/></assets>
            <bodies><body name="b"><mechanical geometry="c"><spline_1d control_points="{points}"/></mechanical></body></bodies>
            <links><pin name="p" body="b" point="0 0 0" radius="{radius}"/></links></spore>""")
        (pin,) = report("plan", scene)["pins"]
        assert (pin["name"], pin["body"], pin["side"], pin["held"]) == ("p", "b", "end", held), pin
        if beyond is None:
            assert pin["clamp_beyond_m"] is None and "can turn" in spore("plan", scene).stdout
        else:
            assert abs(pin["clamp_beyond_m"] - beyond) < 1e-3 and abs(pin["free_m"] - 0.08) < 1e-3, pin
        said = [d["message"] for d in report("check", scene)["diagnostics"] if "as if it were clamped" in d["message"]]
        assert len(said) == noted, (points, said)
    assert report("plan", soft_ball())["pins"] == []


@check
def run_reports_the_contract():
    """run --json gives what the contract promises."""
    answer = report("run", soft_ball(), "--steps", 500)
    for key in ("scene", "steps", "time_s", "dof", "spheres", "contacts", "step_us", "stages", "energy", "monitor", "state_hash"):
        assert key in answer, key
    assert set(answer["contacts"]) >= {"mean", "max"} and answer["contacts"]["max"] > 0
    assert set(answer["step_us"]) >= {"median", "p99", "max"}
    assert set(answer["energy"]) >= {"start", "end", "max_drift"}
    assert set(answer["monitor"]) >= {"recoveries", "substeps", "frozen", "unsolved"} and answer["monitor"]["frozen"] == []
    assert {"name", "median_us", "share"} <= set(answer["stages"][0])
    assert answer["dof"] == 6 and answer["spheres"] == 50


@check
@alike
@long_run
def levels_change_by_themselves_and_are_listed():
    """Each change is in the report, with its reason; only by time the run says that another one may differ."""
    for rule, repeatable in (("error", True), ("distance", True), ("time", False)):
        options = ["--steps", 60, "--set", f"bodies/ovary_right/fidelity/automatic={rule}",
                   "--set", "bodies/ovary_right/fidelity/tool_distance=0.02"]
        answer = report("run", SCENES / "levels.spore", *options)
        assert answer["repeatable"] == repeatable, rule
        changes = answer["level_changes"]
        assert len(changes) == answer["levels"][0]["changes"]
        for change in changes:
            assert change["by"] == rule and change["reason"] and change["from"] != change["to"], change
        if repeatable:
            assert [(c["from"], c["to"]) for c in changes][:1] == [("fine", "medium")], changes
            assert report("run", SCENES / "levels.spore", *options)["state_hash"] == answer["state_hash"]
        said = spore("run", SCENES / "levels.spore", *options).stdout
        assert ("another run of this scene may end in another state" in said) != repeatable, said


@check
@alike
def shipped_levels_follow_the_probe():
    """The shipped scene with levels is fine while the probe is near, and coarser before and after; the change of the README is in its list."""
    answer = report("run", SCENES / "levels.spore", "--time", 6)
    changes = answer["level_changes"]
    assert [(c["from"], c["to"]) for c in changes] == [("fine", "medium"), ("medium", "fine"), ("fine", "medium"), ("medium", "coarse")], changes
    said = f'{changes[1]["time_s"]:.4g} s: {changes[1]["body"]}: level medium to fine: {changes[1]["reason"]}'
    assert said in (ROOT / "README.md").read_text(), said


@check
def levels_of_a_body_that_does_not_move_are_not_used():
    """A body with levels whose role is changed so that physics does not move it runs without them."""
    for role in ("unmovable", "active"):
        answer = report("run", SCENES / "levels.spore", "--steps", 2, "--set", f"bodies/ovary_left/role={role}")
        assert "ovary_left" not in {level["name"] for level in answer.get("levels", [])}, answer


@check
@alike
def run_measures_what_is_solved():
    """A status of 0 means a residual within the tolerance, measured; one above by rounding alone is told as such."""
    scene = str(SCENES / "suture.spore")
    fine = report("run", scene, "--steps", 60, "--dt", "1e-6")
    assert fine["monitor"]["unsolved"] == [] and fine["solver"]["residual_max"] <= 1e-3, fine["solver"]
    stiff = report("run", str(SCENES / "plate4-deformed-ovary.spore"), "--steps", 20, "--set",
                   "links/right_cord_1/stiffness=1e12", "--set", "solver/tolerance=1e-5", status=1)
    assert stiff["solver"]["residual_max"] > 1e-5
    for entry in stiff["monitor"]["unsolved"]:
        assert entry["body"] == "ovary_right" and entry["worst"] > 1e-5 and entry["steps"] <= 20, entry
    assert any("rounding" in entry["cause"] and "tolerance" in entry["remedy"] for entry in stiff["monitor"]["unsolved"])
    stages = [stage["name"] for stage in stiff["stages"]]
    assert stages.index("integrate") < stages.index("verify") < stages.index("accept")
    plan = {stage["name"]: stage for stage in report("plan", str(SCENES / "table1-fluid.spore"))["stages"]}
    assert plan["verify"]["included"]  # contacts that the particles' step does not resolve are implicit
    soft_ball()
    alone = file("soft/alone.spore", '<spore version="1.0"><assets><mesh name="m" file="ball.off"/></assets><bodies><body name="b">'
                 '<mechanical geometry="m"><lennard_jones particles="60"/></mechanical></body></bodies></spore>')
    plan = {stage["name"]: stage for stage in report("plan", alone)["stages"]}
    assert not plan["verify"]["included"] and plan["verify"]["reason"] == "no step solves equations"


@check
def plan_says_when_an_explicit_method_is_not_used():
    """An explicit method whose step does not resolve the links or contacts is said to give way, with the substeps that would do."""
    scene = soft_ball()
    hung = file("soft/hung.spore", scene.read_text().replace("</bodies>", '</bodies><links><spring name="s" body_a="ball" point_a="0 0 0" '
                'point_b="0 0.1 0" stiffness="1e5" damping="1"/></links>'))
    verlet = ["--integrator", "verlet"]
    (body,) = report("plan", hung, *verlet)["bodies"]
    assert body["implicit_by"] == "links" and body["resolving_substeps"] > 1 and body["nonlinear"], body
    assert "implicit_euler moves it" in spore("plan", hung, *verlet).stdout
    fine = ["--set", f"solver/substeps={body['resolving_substeps']}"]
    (body,) = report("plan", hung, *verlet, *fine)["bodies"]
    assert body["implicit_by"] == "contacts" and body["resolving_substeps"] == 0, body
    (body,) = report("plan", scene)["bodies"]
    assert body["implicit_by"] is None and body["damping_a_second"] is None, body
    assert "moves it" not in spore("plan", scene).stdout
    assert all("solver" not in left["what"] for left in report("plan", hung, *verlet)["left_out"])


@check
@alike
def run_says_what_did_not_hold():
    """A run whose equations were not solved ends with 1 and names the body; one that keeps pace says how well."""
    unsolved = report("run", SCENES / "table1-deformable.spore", "--steps", 60, "--set", "solver/newton_iterations=1", "--set",
                      "solver/linear_iterations=1", "--set", "solver/tolerance=1e-12", status=1)
    assert unsolved["monitor"]["not_converged"] > 0
    assert any("not solved to tolerance" in message for message in unsolved["monitor"]["messages"])
    entry, = unsolved["monitor"]["unsolved"]
    assert set(entry) == {"body", "steps", "worst", "cause", "remedy"} and entry["worst"] > 1e-12, entry
    assert entry["body"] == "ovary" and entry["steps"] == unsolved["monitor"]["not_converged"], entry
    assert report("run", soft_ball(), "--steps", 200)["monitor"]["unsolved"] == []
    paced = json.loads(spore("run", soft_ball(), "--steps", 20, "--realtime", "--json", status=(0, 1)).stdout)
    assert set(paced["realtime"]) >= {"factor", "deadline_misses", "worst_late_us", "jitter_us", "given_up_s"}
    assert set(paced["realtime"]["jitter_us"]) == {"median", "p99", "max"}
    assert paced["realtime"]["factor"] <= 1.001
    assert paced["state_hash"] == report("run", soft_ball(), "--steps", 20)["state_hash"]


def every_model():
    """A scene for each model: bodies that neither rest on anything nor are tied."""
    soft_ball()
    file("soft/cells.mesh", (SCENES / "organs" / "ovary_left.mesh").read_bytes())
    file("soft/line.curve", "0 0 0 0.01\n0.1 0.05 0 0.01\n0.2 0 0.1 0.01\n")
    grid = [(i, j) for j in range(4) for i in range(4)]
    halves = [(a, a + 1, a + 5, a, a + 5, a + 4) for a in range(11) if a % 4 < 3]
    file("soft/sheet.off", "OFF\n16 18 0\n" + "".join(f"{0.02 * i} {0.02 * j} 0\n" for i, j in grid)
         + "".join(f"3 {h[0]} {h[1]} {h[2]}\n3 {h[3]} {h[4]} {h[5]}\n" for h in halves))
    for model in report("models")["models"]:
        surface = "sheet.off" if model["name"] == "spline_2d" else "ball.off"
        asset, shape = {"tetrahedra": ("tetrahedra", "cells.mesh"), "curve": ("curve", "line.curve")}.get(model["geometry"], ("mesh", surface))
        yield model["name"], file(f"soft/{model['name']}.spore", f"""<spore version="1.0">
  <solver time_step="0.001"/>
  <assets><{asset} name="shape" file="{shape}"/></assets>
  <bodies><body name="it"><mechanical geometry="shape"><{model['name']}/></mechanical></body></bodies>
</spore>
""")


@check
@alike
@long_run
def every_model_by_every_integrator():
    """Each model runs with each integrator, to the same hash by 1 or 2 threads, or is refused with a place and a way out; the schema takes all of them."""
    schema = file("spore.rng", spore("schema").stdout)
    integrators = spore("run", soft_ball(), "--integrator", "?", status=2).stderr.split("one of ")[1].split(";")[0].split(", ")
    assert len(integrators) == 10, integrators
    models, steps = 0, 5 if SANITIZED else 20
    for model, scene in every_model():
        models += 1
        for integrator in integrators:
            text = scene.read_text().replace("<mechanical ", f'<mechanical integrator="{integrator}" ')
            chosen = file(f"soft/{model}-{integrator}.spore", text)
            subprocess.run(["xmllint", "--noout", "--relaxng", schema, chosen], check=True, capture_output=True)
            done = spore("run", chosen, "--steps", steps, "--json", status=(0, 1, 2))
            assert (done.returncode == 2) == (not done.stdout), done.stderr
            if not done.stdout:
                assert f"{chosen}:4:" in done.stderr and done.stderr.count(";") >= 2, done.stderr
                continue
            answer = json.loads(done.stdout)
            assert answer["monitor"]["frozen"] == [], (model, integrator)
            assert answer["state_hash"] == report("run", chosen, "--steps", steps, "--threads", 2, status=done.returncode)["state_hash"]
    assert models == len(report("models")["models"]) > 9


@check
def choices_that_make_no_sense():
    """What nothing makes use of is said by check, what cannot be is refused, each with its place."""
    text = soft_ball().read_text()

    def with_(old, new):
        assert old in text
        return file("soft/odd.spore", text.replace(old, new))

    for old, new, says in (
            ("time_step", 'error_tolerance="1e-6" time_step', "error_tolerance is not used"),
            ("<mechanical ", '<mechanical integrator="static" ', "is integrated by static"),
            ('<rigid_body/>\n      </mechanical>\n      <collision', '<mass_spring_net/>\n      </mechanical>\n      <collision surface="depth_field"', "depth field"),
    ):
        found = [d for d in report("check", with_(old, new))["diagnostics"] if says in d["message"]]
        assert len(found) == 1 and found[0]["severity"] == "warning" and found[0]["remedy"] and "odd.spore:" in found[0]["place"], found
    for old, new, says in (
            ("time_step", 'substeps="0" time_step', "from 1 to 1000"),
            ("<mechanical ", '<mechanical substeps="1001" ', "from 0 to 1000"),
            ('spheres="one"', 'spheres="one" groups="3"', 'did you mean "group"'),
            ("<rigid_body/>", '<lennard_jones period="0.05 0 0"/>', "shorter than the fluid"),
            ("<rigid_body/>", '<lennard_jones surface_tension="0"/>', "surface_tension"),
    ):
        refuses("run", with_(old, new), says=["odd.spore:", says])
    hopeless = spore("run", with_("<rigid_body/>", '<lennard_jones surface_tension="1e9"/>'), status=2).stderr
    assert "substeps" not in hopeless and "smaller time_step" in hopeless, hopeless


@check
def time_and_dt():
    """--time, --dt and --set change the run."""
    answer = report("run", soft_ball(), "--time", 0.1, "--dt", 0.0005)
    assert answer["steps"] == 200 and abs(answer["time_s"] - 0.1) < 1e-9
    still = report("run", soft_ball(), "--steps", 10, "--set", "environment/gravity=0 0 0")
    assert still["energy"]["max_drift"] < 1e-12
    refuses("run", soft_ball(), "--dt", "-1", says=["time_step", "-1"])
    refuses("run", soft_ball(), "--set", "bodies/none/role=passive", says=["bodies/none"])
    refuses("run", soft_ball(), "--set", "solver/time_stop=1", says=["time_stop", "time_step"])
    refuses("run", soft_ball(), "--integrator", "magic", says=["magic", "implicit_euler"])
    refuses("run", soft_ball(), "--steps", "-4", says=["-4"])
    refuses("run", soft_ball(), "--steps", 4, "--time", 1, says=["--time", "--steps"])
    assert report("run", soft_ball(), "--time", 0)["steps"] == 0
    for time_s in ("nan", "inf", "-1", "1e999", "", "1s"):
        refuses("run", soft_ball(), "--time", time_s, says=["--time", time_s, "0 s or more"])
    refuses("run", soft_ball(), "--time", "1e300", says=["--time", "1e300", "0.001 s", "shorter"])
    refuses("run", SCENES / "table1-mass-spring.spore", "--dt", 0.1, "--integrator", "verlet", says=["too large", "implicit_euler"])
    refuses("run", soft_ball(), "--set", "bodies/ball/mechanical/density=1", says=['"bodies/ball/mechanical/rigid_body/density"'])
    assert "did you mean" not in refuses("run", soft_ball(), "--set", "bodies/ball/collision/density=1", says=["density"])


@check
def same_run_same_hash():
    """The same scene gives the same state hash: twice, and with 1 or 2 threads."""
    runs = [report("run", soft_ball(), "--steps", 400, *more)["state_hash"] for more in ((), (), ("--threads", 2))]
    assert len(set(runs)) == 1, runs
    other = report("run", soft_ball(), "--steps", 401)["state_hash"]
    assert other != runs[0]


def instruction_sets():
    """Those that this machine has, by the names of SPORE_CPU; where nothing says, all of them, and one may be run twice."""
    said = pathlib.Path("/proc/cpuinfo")
    flags = said.read_text() if said.exists() else ""
    return ["baseline"] + [name for name, flag in (("avx2", " avx2"), ("avx512", " avx512vl")) if flag in flags or " sse2" not in flags]


@check
@alike
def shipped_scenes_run():
    """Each shipped scene is valid by the schema, checks without an error, and repeats its hash with 1 or 2 threads and every instruction set."""
    schema = file("spore.rng", spore("schema").stdout)
    scenes = sorted(SCENES.glob("*.spore"))
    assert {"minimal.spore", "laparoscopy.spore"} <= {s.name for s in scenes}
    first, *others = instruction_sets()
    steps, others = (40, others[-1:]) if SANITIZED else (300, others)
    for scene in scenes:
        subprocess.run(["xmllint", "--noout", "--relaxng", schema, scene], check=True, capture_output=True)
        bad = [d for d in report("check", scene)["diagnostics"] if d["severity"] != "note"]
        assert not bad, bad
        hashes = {report("run", scene, "--steps", steps, "--threads", threads, env={**os.environ, "SPORE_CPU": level})["state_hash"]
                  for threads, level in [(1, first)] + [(2, level) for level in others or [first]]}
        assert len(hashes) == 1, scene


@check
def frozen_bodies_are_named():
    """Bodies that links hold freeze without harm to the run, which ends with 1 and names each of them."""
    frozen = report("run", SCENES / "laparoscopy.spore", "--steps", 10, "--set", "solver/maximum_speed=0.1", status=1)
    names = frozen["monitor"]["frozen"]
    assert len(names) > 1, names
    for name in names:
        assert any(message.startswith(f"{name}: frozen") for message in frozen["monitor"]["messages"])
        assert any(u["body"] == name and "stands still" in u["cause"] for u in frozen["monitor"]["unsolved"])


@check
@alike
@long_run
def record_and_replay():
    """run --record writes a track that gives the same hash again."""
    scene, track = SCENES / "laparoscopy.spore", WORK / "again.track"
    first = report("run", scene, "--steps", 300, "--record", track)["state_hash"]
    assert report("run", scene, "--steps", 300, "--input", track)["state_hash"] == first
    refuses("run", scene, "--input", WORK / "none.track", says=["none.track"])
    refuses("run", scene, "--input", file("bad.track", "spore-track 1\ndevice probe\n0 1 2\n"), says=["bad.track:3"])


@check
def liquids_that_meet_mix_their_colours():
    """Water turns red where blood touches it, and stays clear farther away, and beside blood that does not touch it."""
    if "render" not in FEATURES:
        raise Skip("built without pictures")
    file("mixed/drop.off", shapes.off(*shapes.sphere(radius=0.005)))
    drop = ('<body name="%s" position="%g 0 0"><mechanical geometry="drop"><lennard_jones particles="120"/></mechanical><collision/>'
            '<visual colour="%s" wetness="1" opacity="%g"/></body>')
    rows = {}
    for place in (0, -0.02):
        scene = file("mixed/drops.spore", '<spore version="1.0"><solver time_step="0.00001"/><assets><mesh name="drop" file="drop.off"/></assets><bodies>'
                     + drop % ("blood", place, "0.45 0.02 0.02", 1) + drop % ("water", 0.008, "0.62 0.72 0.76", 0.15) +
                     '</bodies><tools><camera name="view" position="0.004 0.01 0.04" target="0.004 0 0"/></tools></spore>\n')
        spore("render", scene, "--size", "250x160", "--light", "-o", "mixed/drops.png")
        rows[place] = picture_files.png(WORK / "mixed/drops.png")[70:95]
    redness = lambda place, column: sum(row[3 * column] - row[3 * column + 1] for row in rows[place]) / 25
    assert redness(0, 130) > redness(-0.02, 130) + 3 and redness(0, 132) > redness(-0.02, 132) + 1.5, "where they touch"
    assert all(abs(redness(0, column) - redness(-0.02, column)) < 0.5 for column in range(144, 166, 4)), "farther away"


@check
def render_makes_a_picture():
    """render writes a PNG of the asked size without a display."""
    if "render" not in FEATURES:
        raise Skip("built without pictures")
    picture = WORK / "minimal.png"
    environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    done = spore("render", SCENES / "minimal.spore", "-o", picture, "--size", "320x200", "--json", env=environment)
    answer = json.loads(done.stdout)
    assert (answer["width"], answer["height"], answer["frames"]) == (320, 200, 1) and answer["gl_renderer"]
    head = picture.read_bytes()[:24]
    assert head[:8] == b"\x89PNG\r\n\x1a\n" and int.from_bytes(head[16:20], "big") == 320
    refuses("render", SCENES / "minimal.spore", "-o", picture, "--size", "0x9", says=["0x9"])
    for plane in ("0,0,0,1", "1,0,0", "1,0,0,0,0", "1,0,nan,0", "a", "1,0,0,1,", ""):
        refuses("render", SCENES / "minimal.spore", "-o", picture, "--clip", plane, says=[f"'{plane}' is no plane"])
    whole = picture.read_bytes()
    spore("render", SCENES / "minimal.spore", "-o", picture, "--size", "320x200", "--clip", "0,2,0,0.06", env=environment)
    assert picture.read_bytes() != whole, "the ball is cut in half"
    spore("render", SCENES / "minimal.spore", "-o", picture, "--size", "320x200", "--light", env=environment)
    assert picture.read_bytes() != whole, "the room is light"
    refuses("render", SCENES / "minimal.spore", says=["-o"])
    refuses("render", SCENES / "minimal.spore", "-o", "no/such/folder/x.png", says=["no/such/folder"])


@check
def render_shows_what_is_reached():
    """render --reach shows the cones of ports, tints what none of them reaches, and says it organ by organ."""
    if "render" not in FEATURES:
        raise Skip("built without pictures")
    picture, scene = WORK / "reach.png", WORK / "reach.spore"
    minimal = SCENES / "minimal.spore"
    spore("edit", minimal, "--instrument", "probe:near@0,0.2,0@0,0.06,0", "--instrument", "probe:far@0.5,0.06,0@0,0.06,0", "-o", scene)

    def reach(name):
        answer = report("render", scene, "-o", picture, "--size", "64x64", "--reach", name)
        return {row["body"]: row["share"] for row in answer["reach"]}, picture.read_bytes()

    far, both = reach("far_port"), reach("all")
    assert both[0]["ball"] == 1 and far[0]["ball"] == 0, (far[0], both[0])
    assert far[1] != both[1]
    refuses("render", scene, "-o", picture, "--reach", "near", says=["near: the scene has no port of this name", "or all"])
    refuses("render", minimal, "-o", picture, "--reach", "all", says=["all: no instrument passes through a port here"])


def legends_are_drawn(net, picture):
    """In pictures that have room, unless they are left out; without what draws text, the reason is told."""
    def drawn(*more):
        said = spore("render", net, "-o", picture, "--field", "strain", "--field-end", "0.25", *more).stdout
        return said, picture.read_bytes()

    (said, with_legend), (plain, without) = drawn("--size", "320x240"), drawn("--size", "320x240", "--no-legends")
    assert "The picture" not in plain and "Largest strain" in plain, plain
    if "svg" not in FEATURES:
        assert "The picture has no legend: this build draws no SVG" in said and with_legend == without, said
        return
    assert "The picture" not in said and with_legend != without, said
    assert "The picture is too small for 1 legend; a larger --size has room\n" in drawn("--size", "64x64")[0]


@check
def render_colours_what_is_strained():
    """render --field colours soft bodies, says what the colours mean, and which bodies have no stress."""
    if "render" not in FEATURES:
        raise Skip("built without pictures")
    picture, net = WORK / "field.png", SCENES / "table1-mass-spring.spore"

    def colours(field, *more):
        said = spore("render", net, "-o", picture, "--size", "64x64", *more, *(("--field", field) if field else ())).stdout
        return said, picture.read_bytes()

    own, strain = colours(None), colours("strain", "--field-end", "0.25")
    assert "Green" not in own[0] and "Largest strain (Green): 0 to 25 % (fixed scale)" in strain[0], strain[0]
    assert strain[1] != own[1]
    stress = colours("stress")
    assert re.search(r"Stress, von Mises \(Cauchy\): no stress in its law: \w+", stress[0]), stress[0]
    assert stress[1] == own[1], "a net of springs has no stress"
    answer = report("render", SCENES / "cut-ovary.spore", "-o", picture, "--size", "64x64", "--field", "velocity", "-t", "0.02")
    assert answer["field"] == "velocity" and answer["field_end"] >= 0.001, answer
    refuses("render", net, "-o", picture, "--field", "heat", says=["'heat'", "expected one of: strain, stress, velocity, level, cells"])
    said = colours("level", "--spheres", "--contacts")[0]
    assert "Level of detail: nothing here has several levels\n" in said, said
    assert re.search(r"Contact force on a sphere: 0 to 0.01 N \(scale follows the state\)\n", said), said
    assert re.search(r"Contact forces: 1 N is a line of .*; (nothing touches now|largest now: .* N)\n", said), said
    said = spore("render", SCENES / "levels.spore", "-o", picture, "--size", "64x64", "--field", "level", "--spheres").stdout
    assert "Level of detail: coarse to fine\n" in said and re.search(r"Depth error: 0 to \S+ ", said), said
    said = spore("render", SCENES / "cut-ovary.spore", "-o", picture, "--size", "64x64", "--field", "cells").stdout
    assert "Least angle of the worst cell: 0 to 60° (fixed scale)" in said, said
    assert "The picture" not in own[0], own[0]
    legends_are_drawn(net, WORK / "legend.png")
    refuses("render", net, "-o", WORK / "field.webm", "-t", "1", "--field", "strain", says=["one scale", "--field-end"])
    refuses("render", net, "-o", picture, "--field-end", "1", says=["--field as well"])


@check
def plan_says_why():
    """plan gives each stage with a reason and says what is left out."""
    answer = report("plan", soft_ball(), "--measure")
    names = {s["name"]: s for s in answer["stages"]}
    assert {"detect", "integrate"} <= set(names)
    assert all(s["reason"] for s in answer["stages"])
    assert names["detect"]["included"] and names["detect"]["measured_us"] > 0 and names["detect"]["estimate_us"] > 0
    assert not names["link"]["included"] and "measured_us" not in names["link"] and "saves_us" in names["link"]
    assert answer["unpruned"]["equal"] == "bit" and answer["unpruned"]["worst"] == 0 < answer["unpruned"]["us"]
    assert {left["what"]: left["saves"] for left in answer["left_out"]}["links"] >= 0
    assert answer["models"] == [{"name": "rigid_body", "bodies": 1}], answer["models"]
    left_out = {entry["what"] for entry in answer["left_out"]}
    assert "links" in left_out and "links other than pins" not in left_out and answer["libraries"]
    pinned = {entry["what"] for entry in report("plan", SCENES / "plate8-clamp.spore")["left_out"]}
    assert "links other than pins" in pinned and "links" not in pinned, pinned
    tied = {entry["what"] for entry in report("plan", SCENES / "plate1-ovary.spore")["left_out"]}
    assert not any(what.startswith("links") for what in tied), tied
    assert not any("gtk" in library for library in answer["libraries"])


@check
def plan_names_the_shaders_of_a_picture():
    """steam takes puffs, an organ does not, and a build that draws nothing takes none"""
    steam, organ = ({shader["name"]: shader["bodies"] for shader in report("plan", SCENES / f"{name}.spore")["shaders"]}
                    for name in ("plate7-steam", "plate1-ovary"))
    if "render" not in FEATURES:
        assert not steam and not organ, (steam, organ)
        return
    assert steam["puff.frag"] == 1 and "puff.frag" not in organ and organ["surface.frag"] > 1 and organ["composite.frag"] == 0, (steam, organ)


@check
def plan_tells_files_apart():
    """plan says which files a run reads, which are only drawn, and which others were made from."""
    needs = {asset["name"]: asset for asset in report("plan", SCENES / "plate1-ovary.spore")["assets"]}
    assert needs["uterus-spheres"]["use"] == "simulated" and needs["tube_left"]["use"] == "drawn", needs
    assert needs["uterus-spheres"]["bytes"] == (SCENES / "organs/uterus.spheres").stat().st_size
    text = soft_ball().read_text()
    file("soft/spare.off", "OFF\n0 0 0\n")
    answer = report("plan", file("soft/spare.spore", text.replace("</assets>", '<mesh name="spare" file="spare.off"/></assets>')))
    uses = {asset["name"]: asset["use"] for asset in answer["assets"]}
    assert uses["spare"] == "unused" and "simulated" in uses.values(), uses
    assert not answer["textures"] and not any("texture" in left["reason"] for left in answer["left_out"]), answer
    spare = [left for left in answer["left_out"] if left.get("bytes") == 10]
    assert spare and spare[0]["what"] == "1 file", answer["left_out"]


@check
def plan_prunes_alike():
    """Leaving out changes no bit of shipped scenes; where bodies sleep, it says how far off they are."""
    for name in ("minimal", "plate1-ovary", "plate8-clamp", "table1-fluid"):
        answer = report("plan", SCENES / f"{name}.spore", "--measure")["unpruned"]
        assert answer["equal"] == "bit" and answer["worst"] == 0, (name, answer)
    steam = report("plan", SCENES / "plate7-steam.spore", "--measure", "--set", "bodies/steam/fidelity/mode=physical")["unpruned"]
    assert steam["equal"] == "bound" and 0 <= steam["worst"] < 1e-4, steam


@check
@alike
def effects_change_nothing_else():
    """Steam as an effect and as physics: bodies that it does not touch are the same to the bit; coagulation lets it out."""
    hashes = {}
    for mode in ("effect", "physical"):
        answer = report("run", SCENES / "plate7-steam.spore", "--time", "2", "--set", f"bodies/steam/fidelity/mode={mode}")
        bodies = {body["name"]: body for body in answer["bodies"]}
        assert bodies["steam"]["moved_by"] == {"effect": "effect", "physical": "physics"}[mode], bodies
        hashes[mode] = {name: body["hash"] for name, body in bodies.items()}
        stages = {stage["name"] for stage in answer["stages"]}
        assert ("effects" in stages) == (mode == "effect"), stages
    different = {name for name in hashes["effect"] if hashes["effect"][name] != hashes["physical"][name]}
    assert different == {"steam"}, different
    poured, lapped = (report("run", SCENES / "plate3-blood.spore", "-n", "1500", "--set", f"bodies/blood/fidelity/mode={mode}")
                      for mode in ("effect", "physical"))
    hashes = [{body["name"]: body["hash"] for body in answer["bodies"]} for answer in (poured, lapped)]
    assert {name for name in hashes[0] if hashes[0][name] != hashes[1][name]} == {"blood"}, hashes
    assert poured["dof"] == 0 < lapped["dof"] and not poured["monitor"]["messages"], poured
    told, none = (report("plan", SCENES / "plate3-blood.spore", "--set", f"bodies/blood/fidelity/mode={mode}")["effects"]
                  for mode in ("effect", "physical"))
    assert none == [] and told[0]["name"] == "blood" and 0 < told[0]["effect_us"] < 0.2 * told[0]["physics_us"], (none, told)


def hanging(name, density, links='<spring name="tie" body_a="organ" body_b="extra" point_a="0 -0.03 0" point_b="0 -0.07 0" stiffness="20" damping="0.05"/>'):
    """An organ on a spring, and a ball of that density that hangs from it."""
    file("hang/ball.off", shapes.off(*shapes.sphere()))
    body = ('<body name="{}" position="0 {} 0"><mechanical geometry="ball"><rigid_body density="{}"/></mechanical>'
            '<visual mesh="ball"/></body>')
    return file(f"hang/{name}.spore", f"""<spore version="1.0">
  <environment gravity="0 -9.81 0"/>
  <solver time_step="0.004"/>
  <assets><mesh name="ball" file="ball.off"/></assets>
  <bodies>{body.format("organ", 0, 1000)}{body.format("extra", -0.1, density)}</bodies>
  <links>
    <spring name="cord" body_a="organ" point_a="0 0.03 0" point_b="0 0.05 0" stiffness="100" damping="0.1"/>
    {links}
  </links>
</spore>
""")


def unfelt(element):
    """Whether advise found nobody to feel it: an effect, unless the clock says that nothing is saved by that."""
    verdict = element["verdict"] == "effect" or any(said in element["reason"] for said in ("not worth it", "saves nothing"))
    return verdict and element["influence"] <= element["noise_floor"]


@check
@alike
def advise_tells_physical_from_effect():
    """advise: steam that only shows is an effect, what hangs on springs is physical, and a light thing becomes one as its mass is swept."""
    steam = {e["id"]: e for e in report("advise", SCENES / "plate7-steam.spore", "--time", "0.6")["elements"]}
    assert unfelt(steam["bodies/steam"]), steam
    for seconds, felt in ((0.2, False), (2, True)):  # before the clamp closes, and after
        clamp = {e["id"]: e for e in report("advise", SCENES / "plate8-clamp.spore", "--time", seconds)["elements"]}["tools/clamp"]
        assert (clamp["influence"] > clamp["noise_floor"]) == felt and (clamp["verdict"] == "physical" or not felt), clamp
        assert ("with its effect" in clamp["reason"]) == felt, clamp
    verdicts = {}
    for density in (0.001, 1000):
        answer = report("advise", hanging(f"hang{density}", density))
        element = {e["id"]: e for e in answer["elements"]}["bodies/extra"]
        verdicts[density] = element["influence"]
        assert unfelt(element) == (density == 0.001), (density, element)
        if density == 1000:
            assert element["influence"] > element["noise_floor"] and "organ" in element["reason"], element
            assert all(change["id"] != "extra" for change in answer["suggestion"]), answer["suggestion"]
    assert verdicts[0.001] < verdicts[1000], verdicts
    held = hanging("held", 1000, '<spring name="tie" body_a="extra" body_b="hand" stiffness="20"/>')
    text = held.read_text().replace("</bodies>", '<body name="hand" role="active"><visual mesh="ball"/></body></bodies>')
    extra = {e["id"]: e for e in report("advise", file("hang/held.spore", text))["elements"]}["bodies/extra"]
    assert extra["verdict"] == "physical" and "tie" in extra["reason"] and extra["influence"] is None, extra
    advised = file("hang/advised.spore", "")
    mist = '<body name="mist" position="1 0 0"><mechanical geometry="ball"><smoke particles="200"/></mechanical></body></bodies>'
    report("advise", file("hang/mist.spore", hanging("misty", 1000).read_text().replace("</bodies>", mist)), "-o", advised)
    if "advice=\"effect\"" in advised.read_text():  # else the clock says that nothing is saved
        for changes, mist in ((), "effect"), (("--set", "bodies/organ/velocity=0 0.1 0"), "physics"):
            moved = {b["name"]: b["moved_by"] for b in report("run", advised, "-n", "3", *changes)["bodies"]}
            assert moved == {"organ": "physics", "extra": "physics", "mist": mist}, moved
    for step, says in (('<reached name="down" body="organ" point="0 -0.01 0" radius="0.005"/>', "same steps done and the same score"),
                       ('<reached name="down" body="extra" point="0 -0.11 0" radius="0.005"/>', 'step "down" of the exercise is done otherwise'),
                       ('<reached name="down" body="extra" point="0 9 0"/>', "not done with this input")):
        text = hanging("exercise", 0.001).read_text().replace("</spore>", f"<exercise>{step}</exercise></spore>")
        answer = report("advise", file("hang/exercise.spore", text))
        extra = {e["id"]: e for e in answer["elements"]}["bodies/extra"]
        assert says in extra["reason"] or "same" in says and unfelt(extra), extra
        assert answer["exercise"]["steps_done"] == (says != "not done with this input"), answer["exercise"]
        assert (extra["verdict"] == "effect") <= ("same" in says), extra
    alone = report("advise", soft_ball())
    assert [e["verdict"] for e in alone["elements"]] == ["physical"] and alone["suggestion"] == []


@check
def advise_refuses_in_words():
    """advise of nothing that moves, of a bad time, or of no scene ends with status 2 and one line."""
    still = soft_ball().read_text().replace('role="passive" ', 'role="unmovable" ').replace(
        """      <mechanical geometry="ball">
        <rigid_body/>
      </mechanical>
""", "")
    refuses("advise", file("soft/still.spore", still), says=["moves no body"])
    refuses("advise", soft_ball(), "--time", "nan", says=["--time", "nan"])
    refuses("advise", WORK / "nothing.spore", says=["nothing.spore"])


@check
def plan_names_methods():
    """plan names for each body how it is integrated and solved, and whether the scene says so."""
    (body,) = report("plan", soft_ball())["bodies"]
    assert body["integrator"] == {"name": "implicit_euler", "said_by": "default"}
    assert body["substeps"] == {"count": 1, "said_by": "default"}
    assert body["nonlinear"] == {"name": "newton", "said_by": "automatic"}
    assert body["linear"] == {"name": "conjugate_gradients", "said_by": "automatic"}
    (body,) = report("plan", soft_ball(), "--integrator", "bdf2", "--set", "solver/substeps=1")["bodies"]
    assert body["integrator"]["said_by"] == body["substeps"]["said_by"] == "scene"
    chosen = ["--set", "solver/nonlinear=broyden", "--set", "solver/linear=cholesky"]
    bodies = {b["name"]: b for b in report("plan", SCENES / "laparoscopy.spore", *chosen)["bodies"]}
    for tube in (bodies["tube_left"], bodies["tube_right"]):
        assert tube["nonlinear"] == {"name": "broyden", "said_by": "scene"}
        assert tube["linear"] == {"name": "cholesky", "said_by": "scene"}
    (body,) = report("plan", soft_ball(), *chosen)["bodies"]  # a rigid body has no matrix to factorise
    assert body["linear"] == {"name": "conjugate_gradients", "said_by": "automatic"}
    mechanical = f"bodies/{body['name']}/mechanical"
    own = ["--set", f"{mechanical}/integrator=symplectic_euler", "--set", f"{mechanical}/substeps=100"]
    (body,) = report("plan", soft_ball(), *own)["bodies"]
    assert body["integrator"] == {"name": "symplectic_euler", "said_by": "body"}
    assert body["substeps"] == {"count": 100, "said_by": "body"}
    assert body["implicit_by"] == "contacts" and body["linear"], body  # it may meet the floor
    printed = spore("plan", soft_ball(), *own).stdout
    assert "symplectic_euler (body)" in printed and "100 (body)" in printed, printed


@check
def plan_names_branches():
    """plan says which of several balances static finds, and of bodies that move says nothing of the kind."""
    tissue = SCENES / "plate2-tissue.spore"
    assert report("plan", tissue, "--integrator", "static")["branches"] == ["tissue"]
    assert "following the load" in spore("plan", tissue, "--integrator", "static").stdout
    (body,) = report("plan", tissue, "--integrator", "static", "--set", "solver/nonlinear=broyden")["bodies"]
    assert body["nonlinear"] == {"name": "newton", "said_by": "automatic"}  # static has its own
    assert report("plan", soft_ball(), "--integrator", "static")["branches"] == []  # nothing holds it: it creeps
    assert report("plan", tissue)["branches"] == []
    assert "following the load" not in spore("plan", tissue).stdout


@check
def plan_measures_mappings():
    """plan says how well what is drawn and felt follows each body: exactly at rest and when all moves as one."""
    carried = {(m["name"], m["unit"]): m for m in report("plan", SCENES / "laparoscopy.spore")["mappings"]}
    assert all(max(m["rest_error_m"], m["rigid_error_m"]) < 1e-14 for m in carried.values())
    assert carried["ovary_left", "visual"]["affine_error_m"] is None  # a rigid body
    tube = carried["tube_left", "visual"]  # the smooth surface around tetrahedra
    assert 0.5 < tube["off_share"] <= 1 and 0 < tube["farthest_m"] < 0.01 and 1 < tube["leverage"] < 20
    assert tube["affine_error_m"] < 1e-14 < tube["bend_error_m"] < 1e-3


def tool_at_a_wall():
    """A scene of a tool that a track lowers 5 mm into an unmovable sphere; nothing in it is passive."""
    scene = WORK / "wall" / "wall.spore"
    file("wall/one.spheres", "0 0 0 0.03\n")
    pose = "{} 0 {} 0 1 0 0 0 0 0\n"
    file("wall/down.track", "spore-track 1\ndevice tool\n" + pose.format(0, 0.07) + pose.format(0.1, 0.055))
    file("wall/wall.spore", """<spore version="1.0">
  <solver time_step="0.001"/>
  <assets><spheres name="one" file="one.spheres"/></assets>
  <bodies>
    <body name="wall" role="unmovable"><collision spheres="one"/></body>
    <body name="tool" role="active" position="0 0.07 0"><collision spheres="one"/></body>
  </bodies>
  <tools><probe name="hand" body="tool" device="track"/></tools>
  <devices><track name="track" file="down.track"/></devices>
</spore>
""")
    return scene


@check
def a_tool_feels_a_wall():
    """A tool touches what nothing moves, also where nothing is passive: the plan says so, and the run counts it."""
    scene = tool_at_a_wall()
    names = {s["name"]: s for s in report("plan", scene)["stages"]}
    assert all(names[name]["included"] for name in ("device_input", "map", "detect", "respond", "reactions", "feedback"))
    assert "spheres to touch" in names["detect"]["reason"] and "push back" in names["reactions"]["reason"]
    assert not names["integrate"]["included"] and "physics" in names["integrate"]["reason"]
    assert report("run", scene, "--steps", 300)["contacts"]["max"] == 1
    apart = report("plan", file("wall/apart.spore", scene.read_text().replace('spheres="one"', 'spheres="one" group="1"')))
    assert not {s["name"]: s for s in apart["stages"]}["detect"]["included"]


def grasper():
    """A scene of a ball that lies on a floor, and jaws through a port that a track leads to it, closes and lifts. A second
    ball hangs on a ball joint that breaks, a third on a weld that does not."""
    file("grasp/ball.off", shapes.off(*shapes.sphere(radius=0.005)))
    file("grasp/ball.spheres", "0 0 0 0.005\n")
    file("grasp/jaw.spheres", "".join(f"0 {-0.003 * i} 0 0.002\n" for i in range(1, 8)))
    file("grasp/floor.spheres", "0 -0.5 0 0.5\n")
    rows = [(0, 0.06, 1), (0.2, 0.06, 1), (0.4, 0.022, 1), (0.5, 0.022, 0), (0.8, 0.022, 0), (1.2, 0.05, 0), (2, 0.05, 0)]
    file("grasp/hand.track", "spore-track 1\ndevice shaft\n" +
         "".join(f"{t} 0 {y} 0 1 0 0 0 {grip} 0\n" for t, y, grip in rows))
    ball = ('<body name="{0}" position="{1} {2} 0"><mechanical geometry="ball"><rigid_body mass="0.002"/></mechanical>'
            '<collision spheres="round" friction="0.3"/></body>')
    return file("grasp/grasp.spore", f"""<spore version="1.0">
  <solver time_step="0.004"/>
  <assets><mesh name="ball" file="ball.off"/><spheres name="round" file="ball.spheres"/>
    <spheres name="jaw" file="jaw.spheres"/><spheres name="floor" file="floor.spheres"/></assets>
  <bodies>
    <body name="floor" role="unmovable"><collision spheres="floor"/></body>
    <body name="shaft" role="active" position="0 0.06 0"/>
    <body name="left" role="active" position="0.002 0.06 0"><collision spheres="jaw"/></body>
    <body name="right" role="active" position="-0.002 0.06 0"><collision spheres="jaw"/></body>
    {ball.format("stone", 0, 0.005)} {ball.format("weak", 0.1, 0.1)} {ball.format("firm", -0.1, 0.1)}
  </bodies>
  <links>
    <ball name="thread" body_a="weak" point="0.1 0.105 0" strength="0.015"/>
    <weld name="glue" body_a="firm" point="-0.1 0.105 0" strength="0.03"/>
    <port name="trocar" body_a="shaft" point="0 0.2 0"/>
  </links>
  <tools><grasper name="jaws" body="shaft" device="track" jaw_a="left" jaw_b="right" hinge="0 0.06 0" axis="0 0 1"
    torque="0.003"/></tools>
  <devices><track name="track" file="hand.track"/></devices>
</spore>
""")


@check
def jaws_lift_and_links_break():
    """A grasper takes what its track tells it to; links hold, or break and stay broken; the plan and --help say so."""
    scene = grasper()
    stages = {s["name"]: s for s in report("plan", scene)["stages"]}
    assert stages["tools"]["included"] and stages["link"]["included"]
    assert not {s["name"]: s for s in report("plan", soft_ball())["stages"]}["tools"]["included"]
    done = report("run", scene, "--time", 1.8)
    assert done["tools"][0]["held"] >= 1 and done["monitor"]["lost_holds"] == 0, done["tools"]
    assert [link["broken"] for link in done["links"]] == [1, 0] and done["monitor"]["broken_links"] == 1, done["links"]
    assert any("thread: broke" in text for text in done["monitor"]["messages"])
    assert abs(done["links"][1]["load_N"] - 0.002 * 9.81) < 1e-3, done["links"]
    again = report("run", scene, "--time", 1.8, "--record", "grasp.track")
    assert again["state_hash"] == done["state_hash"] == report("run", scene, "--time", 1.8, "--input", "grasp.track")["state_hash"]


@check
@alike
@long_run
def a_net_tears():
    """Strained more than it bears, a net tears: planned, counted and said; without a strain the stage is left out."""
    scene = SCENES / "plate2-tissue.spore"
    assert not {s["name"]: s for s in report("plan", scene)["stages"]}["tear"]["included"]
    torn = "bodies/tissue/mechanical/mass_spring_net/tear_strain=0.02"
    assert {s["name"]: s for s in report("plan", scene, "--set", torn)["stages"]}["tear"]["included"]
    done = report("run", scene, "--set", torn, "--steps", 450)
    assert done["monitor"]["torn_springs"] > 0, done["monitor"]
    assert any("begins to tear" in text for text in done["monitor"]["messages"]), done["monitor"]


@check
@alike
def blood_comes_and_is_sucked_away():
    """An emitter lets particles out of a wound, a suction tube takes them away: planned, run, the same each time."""
    file("flow/drop.off", shapes.off(*shapes.sphere(radius=0.005)))
    file("flow/tube.spheres", "0 0 0 0.001\n")
    scene = file("flow/flow.spore", """<spore version="1.0">
  <environment gravity="0 0 0"/>
  <solver time_step="0.001"/>
  <assets><mesh name="drop" file="drop.off"/><spheres name="tube" file="tube.spheres"/></assets>
  <bodies>
    <body name="blood"><mechanical geometry="drop"><lennard_jones particles="100" drag="5"/></mechanical></body>
    <body name="tube" role="active" position="0.03 0.008 0"><collision spheres="tube"/></body>
  </bodies>
  <effects><emitter name="wound" body="blood" point="0.03 0 0" direction="0 1 0" rate="100" reserve="30"/></effects>
  <tools><suction name="tube" body="tube" point="0.03 0.006 0" radius="0.004"/></tools>
</spore>
""")
    assert not [d for d in report("check", scene)["diagnostics"] if d["severity"] == "fault"]
    assert all("particles" not in left["what"] for left in report("plan", scene)["left_out"])
    first = report("run", scene, "--time", 2)
    assert first["tools"][0]["taken"] > 5, first["tools"]
    assert report("run", scene, "--time", 2, "--threads", 2)["state_hash"] == first["state_hash"]
    refuses("run", file("flow/much.spore", scene.read_text().replace('"30"', '"3000"')), says=["much.spore:9:", "reserve"])


def quaternion(rotation):
    angle = math.sqrt(sum(c * c for c in rotation))
    return [math.cos(angle / 2)] + [c * math.sin(angle / 2) / angle if angle else 0 for c in rotation]


def led(scene, name, path):
    """A track that leads an instrument along (time, way from its start, button), without turning it; written beside the scene."""
    body = xml.etree.ElementTree.parse(scene).getroot().find(f"bodies/body[@name='{name}']")
    start, rotation = ([float(c) for c in body.get(key).split()] for key in ("position", "rotation"))
    turn = " ".join("%.9g" % c for c in quaternion(rotation))
    rows = "".join(f"{at} {' '.join('%.9g' % (a + b) for a, b in zip(start, way))} {turn} 0 {button}\n" for at, way, button in path)
    return file(scene.with_suffix(".track"), f"spore-track 1\ndevice {name}\n{rows}")


def slim_bar():
    """A soft bar, 50 x 8 x 8 mm, that is held at both ends."""
    file("library/bar.mesh", shapes.bar(along=10, across=2, length=0.05, width=0.008))
    file("library/bar.spheres", "".join(f"{0.002 + 0.004 * i} {y} {z} 0.002\n" for i in range(12) for y in (0.002, 0.006) for z in (0.002, 0.006)))
    pins = "".join(f'<pin name="end_{x}" body="bar" point="{x} 0.004 0.004" radius="0.006"/>' for x in (0, 0.05))
    return file("library/bar.spore", '<spore version="1.0"><solver time_step="0.002"/><assets><tetrahedra name="cells" file="bar.mesh"/>'
                '<spheres name="felt" file="bar.spheres"/></assets><bodies><body name="bar"><mechanical geometry="cells">'
                '<neo_hookean_tetrahedra young_modulus="20000" stiffness_damping="0.01"/></mechanical>'
                f'<collision spheres="felt"/></body></bodies><links>{pins}</links></spore>\n')


@check
@alike
def instruments_of_the_library_work():
    """Each instrument, put in above a soft bar and led down on it, does with its button down what it is for, and does not without; a bar that it is not led to is left alone."""
    bar = slim_bar()
    for kind, way, member in (("grasper", 0.020, "held"), ("clamp", 0.020, "held"), ("clip", 0.020, "held"), ("scissors", 0.022, "cut"), ("bipolar", 0.014, "coagulated")):
        scene = bar.with_name(f"{kind}.spore")
        assert report("edit", bar, "--instrument", f"{kind}@0.025,0.12,0.004@0.025,0.008,0.004", "-o", scene)["changed"] == [f"bodies/{kind}_1"]
        assert not report("check", scene)["diagnostics"], kind
        for depth, button in ((way, 1), (way, 0), (-0.02, 1)):
            track = led(scene, f"{kind}_1", [(0, (0, 0, 0), 0), (0.2, (0, -depth, 0), 0), (0.4, (0, -depth, 0), button), (0.6, (0, -depth, 0), button)])
            done = report("run", scene, "--input", track, "--time", 0.6)
            assert (done["tools"][0][member] > 0) == (button == 1 and depth > 0), (kind, depth, button, done["tools"])
            assert not done["monitor"]["unsolved"], done["monitor"]


@check
@alike
def a_grasper_lifts_and_lets_go():
    """A grasper of the library that lifts the bar is told its weight; opened, it lets go, and a clamp does not until the second button."""
    bar = slim_bar()
    down, up = (0, -0.02, 0), (0, -0.012, 0)
    for kind, held in (("grasper", False), ("clamp", True)):
        scene = bar.with_name(f"{kind}.spore")
        report("edit", bar, "--instrument", f"{kind}:tool@0.025,0.12,0.004@0.025,0.008,0.004", "-o", scene)
        path = [(0, (0, 0, 0), 0), (0.2, down, 0), (0.3, down, 1), (0.4, down, 1), (0.6, up, 1), (0.7, up, 1)]
        lifted = report("run", scene, "--input", led(scene, "tool", path), "--time", 0.7, "--output", "library/lifted.csv")
        rows = [line.split(",") for line in (WORK / "library" / "lifted.csv").read_text().splitlines() if not line.startswith("#")]
        force = next(i for i, name in enumerate(rows[0]) if name.startswith("device") and name.split()[0].endswith("y"))
        assert lifted["tools"][0]["held"] > 0 and float(rows[-1][force]) < -0.05, (rows[0][force], rows[-1][force])
        path += [(0.71, up, 0), (0.9, up, 0)]
        assert (report("run", scene, "--input", led(scene, "tool", path), "--time", 0.9)["tools"][0]["held"] > 0) == held
        path += [(0.91, up, 2), (1.1, up, 2)]
        assert report("run", scene, "--input", led(scene, "tool", path), "--time", 1.1)["tools"][0]["held"] == 0


@check
@alike
def what_a_kept_pose_lacks_is_listed():
    """A pose that is kept while jaws hold something lists that they let go; one of what holds nothing lists nothing."""
    lacks = lambda scene, seconds: report("edit", SCENES / f"{scene}.spore", "--keep-pose", seconds, "-o", f"kept/{scene}.spore")["not_kept"]
    (WORK / "kept").mkdir()
    assert ["left_clamp" in sentence for sentence in lacks("exercise-clip-and-cut", 2)] == [True]
    assert lacks("minimal", 0.1) == []


@check
def a_needle_and_a_suction_tube_of_the_library_work():
    """A needle led into the bar pierces it and stays in it; a suction tube takes the particles that it is led to, with its button down alone."""
    bar = slim_bar()
    sewn = bar.with_name("needle.spore")
    report("edit", bar, "--instrument", "needle@0.025,0.12,0.004@0.025,0.008,0.004", "-o", sewn)
    assert not report("check", sewn)["diagnostics"]
    for depth in (0.02, 0):
        done = report("run", sewn, "--input", led(sewn, "needle_1", [(0, (0, 0, 0), 0), (0.3, (0, -depth, 0), 0)]), "--time", 0.4)
        assert (done["tools"][0]["pierced"], done["tools"][0]["stitches"]) == ((1, 1) if depth else (0, 0)), done["tools"]
        assert not done["monitor"]["unsolved"], done["monitor"]
    file("library/drop.off", shapes.off(*shapes.sphere(radius=0.005)))
    drop = file("library/drop.spore", '<spore version="1.0"><environment gravity="0 0 0"/><solver time_step="0.001"/><assets>'
                '<mesh name="drop" file="drop.off"/></assets><bodies><body name="blood"><mechanical geometry="drop">'
                '<lennard_jones particles="100" drag="5"/></mechanical></body></bodies></spore>\n')
    report("edit", drop, "--instrument", "suction@0,0.1,0.02@0,0,0")
    for depth, button in ((0.01, 1), (0.01, 0), (0, 1)):
        aim = [-depth * c for c in (0, 0.1 / math.hypot(0.1, 0.02), 0.02 / math.hypot(0.1, 0.02))]
        track = led(drop, "suction_1", [(0, (0, 0, 0), 0), (0.1, aim, 0), (0.2, aim, button), (0.4, aim, button)])
        taken = report("run", drop, "--input", track, "--time", 0.4)["tools"][0]["taken"]
        assert (taken > 5) == (depth > 0 and button == 1), (depth, button, taken)


@check
@alike
@long_run
def an_irrigator_pours_and_draws_away():
    """Its second button pours a litre a minute, its first one draws the water away again; it pushes the blood, and the volumes are told apart from the blood's. Water that does not wash moves alike, and water as particles comes as much."""
    file("rinse/drop.off", shapes.off(*shapes.sphere(radius=0.005)))
    file("rinse/floor.spheres", "".join(f"{x / 200} 0 {z / 200} 0.004\n" for x in range(-8, 9) for z in range(-8, 9)))
    scene = file("rinse/rinse.spore", '<spore version="1.0"><solver time_step="0.004"/><assets><mesh name="drop" file="drop.off"/>'
                 '<spheres name="floor" file="floor.spheres"/></assets><bodies><body name="floor" role="unmovable"><collision spheres="floor"/></body>'
                 '<body name="blood" position="0.02 0.012 0"><mechanical geometry="drop"><lennard_jones particles="60"/></mechanical>'
                 '<collision/><fidelity mode="effect"/></body></bodies></spore>\n')
    report("edit", scene, "--instrument", "irrigator@0,0.2,0@0,0.005,0")
    assert not report("check", scene)["diagnostics"]
    refuses("edit", scene, "--set", "effects/irrigator_1_irrigation/flow=-1", says=["expected"])
    still = (0, 0, 0)
    paths = {buttons: [(0, still, 0), (0.1, still, 0), (0.101, still, buttons), (0.4, still, buttons)] for buttons in (0, 1, 2)}
    paths["after"] = paths[2] + [(0.401, still, 0), (0.5, (0, -0.018, 0), 1), (1.2, (0, -0.018, 0), 1)]
    moved = {}
    for buttons, path in paths.items():
        track = led(scene, "irrigator_1", path)
        done = report("run", scene, "--input", track, "--time", path[-1][0])
        water, blood = {one["name"]: one for one in done["fluids"]}["water"], done["fluids"][0]
        poured = 0 if buttons in (0, 1) else 0.3 * 1000 / 60
        assert abs(water["poured_ml"] - poured) < 0.13 and abs(water["present_ml"] + water["sucked_ml"] - water["poured_ml"]) < 1e-9, (buttons, water)
        assert (water["sucked_ml"] > 0.1) == (buttons == "after"), (buttons, water)
        moved[buttons] = {one["name"]: one["hash"] for one in done["bodies"]}["blood"]
        assert blood["name"] == "blood" and blood["poured_ml"] == 0, blood
        assert abs(blood["present_ml"] + blood["sucked_ml"] - 0.52) < 0.06, blood
    assert moved[0] == moved[1] != moved[2], "the water pushes the blood"
    plain = report("run", scene, "--input", track, "--time", 0.3)
    dry = report("run", scene, "--input", track, "--time", 0.3, "--set", "bodies/water/mechanical/lennard_jones/stain=0")
    assert dry["state_hash"] == plain["state_hash"] and plain["fluids"] == dry["fluids"]
    felt = report("run", scene, "--input", track, "--time", 0.22, "--dt", 0.002, "--set", "bodies/water/fidelity/mode=physical")
    assert abs(felt["fluids"][1]["poured_ml"] - 0.12 * 1000 / 60) < 0.13, felt["fluids"]
    assert {one["name"]: one.get("moved_by") for one in felt["bodies"]}["water"] == "physics"


@check
@alike
def a_bag_of_the_library_takes_what_falls_into_it():
    """A stone above the mouth of a bag of the library falls into the bag and lies in it; one beside falls past."""
    file("library/stone.off", shapes.off(*shapes.sphere(radius=0.01)))
    file("library/stone.spheres", "0 0 0 0.01\n")
    for side, caught in ((0, True), (0.06, False)):
        scene = file("library/stone.spore", '<spore version="1.0"><solver time_step="0.004"/><assets><mesh name="stone" file="stone.off"/>'
                     f'<spheres name="felt" file="stone.spheres"/></assets><bodies><body name="stone" position="0 0.03 {side}">'
                     '<mechanical geometry="stone"><rigid_body density="300"/></mechanical><collision spheres="felt"/><visual mesh="stone"/></body></bodies></spore>\n')
        assert report("edit", scene, "--instrument", "bag@0.25,0.09,0@-0.09,0,0")["changed"] == ["bodies/bag_1"]
        assert not [d for d in report("check", scene)["diagnostics"] if "overlap" in d["message"]]
        done = report("run", scene, "--time", 0.3, "--watch", f"stone@0,0.03,{side}", "--output", "library/stone.csv")
        rows = list(csv.reader((WORK / "library" / "stone.csv").read_text().splitlines()))
        height = float(rows[-1][rows[0].index(f"watch.stone@0,0.03,{side}.y [m]")])
        assert (height > -0.05) == caught and not done["monitor"]["unsolved"], (height, caught)


@check
def an_instrument_is_refused_with_a_remedy():
    """What is no instrument of the library, no place, or too near to what it points at."""
    bar = slim_bar()
    refuses("edit", bar, "--patient", "seated", says=["supine, prone, left_lateral"])
    laid = report("edit", bar, "--patient", "supine", "-o", WORK / "laid.spore")
    assert laid["changed"] == ["environment"] and 'gravity="0 0 9.81"' in (WORK / "laid.spore").read_text(), laid
    refuses("edit", bar, "--instrument", "graspr@0,0.1,0", says=["there is no instrument \"graspr\"", "grasper"])
    refuses("edit", bar, "--instrument", "grasper@0,0.1", says=["expected KIND@X,Y,Z@X,Y,Z in metres"])
    refuses("edit", bar, "--instrument", "grasper@0,0.1,0@0,0.1,0@0,0,0", says=["expected KIND@X,Y,Z@X,Y,Z in metres"])
    refuses("edit", bar, "--instrument", "grasper@0,0.02,0@0,0,0", says=["choose places that are farther apart"])
    ported = bar.with_name("ported.spore")
    report("edit", bar, "--instrument", "grasper@0.025,0.2,0.004@0.025,0.008,0.004", "-o", ported)
    assert report("edit", ported, "--port", "grasper_1_port@0.1,0.2,0.05")["changed"] == ["links/grasper_1_port"]
    assert re.search(r'point="0.10* 0.20* 0.050*"', ported.read_text()), ported.read_text()
    before = ported.read_text()
    refuses("edit", ported, "--port", "grasper_1_port@0.1", says=["expected PORT@X,Y,Z in metres"])
    refuses("edit", ported, "--port", "graspr_1_port@0.1,0,0", says=["there is no port \"graspr_1_port\"", "correct the name"])
    refuses("edit", ported, "--port", "grasper_1_port@0.025,0.018,0.004", says=["choose one farther away"])
    assert ported.read_text() == before


@check
@alike
def a_missing_file_is_located():
    """Files that a scene misses are taken from where they lie now, all of a folder at once; what is not missing or is another file is refused, and nothing is written. What needs no question is mended by the command that the check gives."""
    file("moved/at/ball.off", shapes.off(*shapes.sphere()))
    file("moved/at/picture.png", shapes.off(*shapes.sphere()))
    scene = file("moved/scene.spore", '<spore version="1.0"><assets><mesh name="ball" file="gone/ball.off"/></assets><bodies><body name="ball" role="unmovable">'
                 '<visual mesh="ball" texture="picture.png"/></body></bodies></spore>\n')
    before = scene.read_text()
    assert "--locate" in report("check", scene, status=1)["diagnostics"][0]["remedy"]
    refuses("edit", scene, "--locate", "ball.off=moved/at/ball.off", says=["no such file is missing"])
    refuses("edit", scene, "--locate", "gone/ball.off=moved/scene.spore", says=["moved/scene.spore: ", "no mesh"])
    refuses("edit", scene, "--locate", "gone/ball.off", says=["expected MISSING=FILE"])
    assert scene.read_text() == before
    found = report("edit", scene, "--locate", "gone/ball.off=moved/at/ball.off")["located"]
    assert [(one["missing"], bool(one["refused"])) for one in found] == [("gone/ball.off", False), ("picture.png", True)], found
    assert not [one for one in report("check", scene)["diagnostics"] if "ball.off" in one["message"]]
    scene.write_text(scene.read_text().replace("</assets>", '<spheres name="idle" file="idle.spheres"/></assets>'))
    file("moved/idle.spheres", "0 0 0 0.1\n")
    unused = [one for one in report("check", scene)["diagnostics"] if one["place"] == "assets/idle" or "idle" in one["message"]]
    assert [one["fix"]["kind"] for one in unused] == ["remove"] and unused[0]["fix"]["does"] == "Remove it", unused
    assert not any(one["fix"] for one in report("check", scene)["diagnostics"] if "picture.png" in one["message"])  # it is asked where the file lies
    command = shlex.split(unused[0]["fix"]["command"])
    assert command == ["spore", "edit", str(scene), "--fix"]
    spore(*command[1:])
    assert "idle" not in scene.read_text()


@check
@alike
def an_instrument_is_deleted_whole():
    """Each instrument of the library, added and deleted, leaves nothing behind but the mouse; an organ takes its pins along, another's stay; what is not there is refused."""
    bar = slim_bar()
    at = bar.with_name("deleted.spore")
    report("edit", bar, "--set", "bodies/bar/name_guessed=false", "--add", "devices/mouse:mouse", "-o", at)
    for kind in ("grasper", "needle", "bag", "endoscope_30"):
        before = at.read_text()
        report("edit", at, "--instrument", f"{kind}@0.025,0.22,0.004@0.025,0.008,0.004")
        assert at.read_text() != before
        assert report("edit", at, "--delete", f"bodies/{kind}_1")["changed"] == [f"bodies/{kind}_1"]
        assert at.read_text().replace("  <tools/>\n", "") == before.replace("  <tools/>\n", ""), kind
    refuses("edit", at, "--delete", "bodies/bra", says=["nothing of that name to delete"])
    text = at.read_text().replace("</bodies>", '<body name="block" role="unmovable"/></bodies>').replace("</links>", '<pin name="other" body="block"/></links>')
    at.write_text(text)
    report("edit", at, "--delete-alone", "bodies/bar", "-o", at.with_name("kept.spore"))
    tree = xml.etree.ElementTree.parse(at.with_name("kept.spore")).getroot()
    assert [pin.get("name") for pin in tree.findall("links/pin")] == ["other"] and tree.find("assets/tetrahedra") is not None
    at.write_text(at.read_text().replace('<body name="block"', '<body name="twin"><collision spheres="felt"/></body><body name="block"').replace(
        "</spore>", '<exercise><touched name="cut" body="bar"/><touched name="rest" body="block" after="cut"/></exercise></spore>'))
    assert report("edit", at, "--delete", "bodies/bar")["changed"] == ["bodies/bar", "exercise/cut", "assets/cells"], "the spheres are the twin's too"
    assert 'after=' not in at.read_text() and report("edit", at, "--delete", "bodies/twin")["changed"] == ["bodies/twin", "assets/felt"]


@check
@alike
def bodies_are_moved_turned_scaled_and_aligned():
    """A bar and its pins are moved, turned about its middle, scaled and aligned with a block; what is no body, way, angle, factor or side is refused, and nothing is written."""
    bar = slim_bar()
    at = bar.with_name("placed.spore")
    text = bar.read_text().replace("</bodies>", '<body name="block" role="unmovable" position="0.1 0.2 0"><collision spheres="felt"/></body></bodies>')
    at.write_text(text)

    def vector(pattern):
        return [float(v) for v in re.search(pattern, at.read_text()).group(1).split()]

    def near(vector, expected):
        return all(abs(a - b) < 2e-6 for a, b in zip(vector, expected))

    assert report("edit", at, "--move", "bar=0.01,0,-0.02")["changed"] == ["bodies/bar"]
    assert near(vector('name="bar" position="([^"]*)"'), (0.01, 0, -0.02)) and near(vector('name="end_0"[^>]* point="([^"]*)"'), (0.01, 0.004, -0.016))
    assert near(vector('name="block"[^>]* position="([^"]*)"'), (0.1, 0.2, 0))
    report("edit", at, "--turn", "bar=z:90")
    assert near(vector('name="bar"[^>]* rotation="([^"]*)"'), (0, 0, math.pi / 2)) and near(vector('name="end_0"[^>]* point="([^"]*)"'), (0.035, -0.021, -0.016))
    report("edit", at, "--turn", "bar=z:-90", "--align", "bar,block=y:least")
    assert near(vector('name="block"[^>]* position="([^"]*)"'), (0.1, 0, 0))
    report("edit", at, "--scale", "bar=2")
    assert near(vector('name="end_0"[^>]* point="([^"]*)"'), (-0.015, 0.004, -0.016)) and 'radius="0.012"' in at.read_text()
    assert "felt-2" in at.read_text(), "the spheres of the block stay"
    assert not report("run", at, "--steps", 5)["monitor"]["unsolved"]
    before = at.read_text()
    assert report("edit", at, "--copy", "bar=0,0,0.05", "-o", bar.with_name("copied.spore"))["changed"] == ["bodies/bar-2"]
    assert 'name="end_0-2" body="bar-2"' in bar.with_name("copied.spore").read_text()
    refuses("edit", at, "--copy", "bar=0,0", says=["expected BODY=X,Y,Z in metres"])
    refuses("edit", at, "--scale", "bar=0", says=["no factor to scale by"])
    refuses("edit", at, "--scale", "bar=big", says=["expected BODY=FACTOR"])
    refuses("edit", at, "--move", "bar=0.01,0", says=["expected BODY=X,Y,Z in metres"])
    refuses("edit", at, "--move", "bra=0.01,0,0", says=["there is no body \"bra\"", "bar, block"])
    refuses("edit", at, "--turn", "bar=w:90", says=["expected BODY=AXIS:DEGREES"])
    refuses("edit", at, "--turn", "bar=z:much", says=["expected BODY=AXIS:DEGREES"])
    refuses("edit", at, "--align", "bar,block=y:last", says=["least, middle or greatest"])
    refuses("edit", at, "--align", "bar=y:least", says=["nothing to align it with"])
    assert at.read_text() == before


@check
def a_fluid_lands_on_a_floor():
    """A fluid whose collision unit names no spheres collides with its own: checked, planned, run, the same each time."""
    file("fluid/drop.off", shapes.off(*shapes.sphere(radius=0.006)))
    file("fluid/floor.spheres", "".join(f"{x / 500} -0.003 {z / 500} 0.003\n" for x in range(-12, 13) for z in range(-12, 13)))
    scene = file("fluid/fluid.spore", """<spore version="1.0">
  <solver time_step="0.0005"/>
  <assets>
    <mesh name="drop" file="drop.off"/>
    <spheres name="floor" file="floor.spheres"/>
  </assets>
  <bodies>
    <body name="blood" position="0 0.012 0">
      <mechanical geometry="drop"><lennard_jones particles="100" drag="5"/></mechanical>
      <collision stiffness="20" damping="0.004"/>
    </body>
    <body name="floor" role="unmovable"><collision spheres="floor"/></body>
  </bodies>
</spore>
""")
    schema = file("spore.rng", spore("schema").stdout)
    subprocess.run(["xmllint", "--noout", "--relaxng", schema, scene], check=True, capture_output=True)
    assert report("check", scene)["diagnostics"] == []
    assert {s["name"]: s for s in report("plan", scene)["stages"]}["detect"]["included"]
    answer = report("run", scene, "--steps", 1000)
    assert answer["monitor"]["unsolved"] == []
    assert answer["spheres"] == 25 * 25 + answer["dof"] // 3
    assert answer["contacts"]["max"] > 10 and not answer["monitor"]["frozen"] and answer["monitor"]["deep_contacts"] == 0
    assert report("run", scene, "--steps", 1000, "--threads", 2)["state_hash"] == answer["state_hash"]


@check
def models_and_schema():
    """models lists parameters with unit and range; schema is a RELAX NG that accepts a scene and refuses another."""
    models = {m["name"]: m for m in report("models")["models"]}
    assert {"rigid_body", "mass_spring_net", "corotational_tetrahedra"} <= set(models)
    young = next(p for p in models["corotational_tetrahedra"]["parameters"] if "young" in p["name"])
    assert young["unit"] == "Pa" and young["doc"] and young["change"] == "live"
    liver = next(p for p in models["neo_hookean_tetrahedra"]["presets"] if p["name"] == "liver")
    assert "young_modulus=5220" in liver["settings"] and liver["source"] and not models["rigid_body"]["presets"]
    assert len(report("models", "rigid_body")["models"]) == 1
    materials = {m["name"]: {q["name"]: q for q in m["quantities"]} for m in report("models", "--materials")["materials"]}
    assert materials["liver"]["young_modulus"] | {"source": 0} == {"name": "young_modulus", "unit": "Pa", "typical": 5220,
                                                                   "minimum": 4060, "maximum": 6380, "fills": True, "source": 0}
    unknown = {m["name"]: m["unknown"] for m in report("models", "--materials")["materials"]}
    assert unknown["liver"] == [] and unknown["ovary"] == ["density", "stiffness_damping"]
    assert all(q["source"] for m in materials.values() for q in m.values()) and materials["fat"]["young_modulus"]["minimum"] is None
    assert "material" in spore("schema").stdout and "gallbladder" in spore("schema").stdout
    refuses("models", "rigid_boy", says=["rigid_boy", "rigid_body"])
    schema = file("spore.rng", spore("schema").stdout)
    subprocess.run(["xmllint", "--noout", "--relaxng", schema, soft_ball()], check=True, capture_output=True)
    wrong = file("soft/wrong.spore", soft_ball().read_text().replace("time_step", "time_stop"))
    assert subprocess.run(["xmllint", "--noout", "--relaxng", schema, wrong], capture_output=True).returncode


@check
def solids_of_tetrahedra():
    """A bar of each tetrahedral model hangs and swings, the same on two threads, and finds its balance at once; check
    says what locking costs."""
    file("solid/bar.mesh", shapes.bar())
    for model in ("neo_hookean_tetrahedra", 'neo_hookean_tetrahedra element="quadratic"', "corotational_tetrahedra",
                  "saint_venant_kirchhoff_tetrahedra", "linear_tetrahedra", "condensed_tetrahedra"):
        scene = file("solid/bar.spore", f"""<?xml version="1.0" encoding="UTF-8"?>
<spore version="1.0">
  <solver time_step="0.01" integrator="implicit_euler"/>
  <assets><tetrahedra name="cells" file="bar.mesh"/></assets>
  <bodies>
    <body name="bar">
      <mechanical geometry="cells"><{model} young_modulus="1e6" poisson_ratio="0.4"/></mechanical>
    </body>
  </bodies>
  <links><pin name="wall" body="bar" point="-10 0.01 0.01" radius="10.0001"/></links>
</spore>
""")
        warned = [d for d in report("check", scene)["diagnostics"] if d["severity"] == "warning"]
        assert not warned, (model, warned)
        moving = report("run", scene, "--steps", 60)
        assert not moving["monitor"]["frozen"] and moving["energy"]["end"] < moving["energy"]["start"], (model, moving)
        assert report("run", scene, "--steps", 60, "--threads", 2)["state_hash"] == moving["state_hash"], model
        still = report("run", scene, "--steps", 3, "--set", "bodies/bar/mechanical/integrator=static")
        assert not still["monitor"]["frozen"] and still["monitor"]["not_converged"] == 0, (model, still)
        assert report("run", scene, "--steps", 9, "--set", "bodies/bar/mechanical/integrator=static")["energy"]["end"] <= still["energy"]["end"] + 1e-9
        told = report("check", file("solid/stiff.spore", scene.read_text().replace('"0.4"', '"0.48"')))["diagnostics"]
        locks = [d for d in told if "too stiff" in d["message"]]
        assert bool(locks) == ("quadratic" not in model) and all("quadratic" in d["remedy"] for d in locks), (model, told)


@check
@alike
@long_run
def spheres_command():
    """spheres writes the asked number of spheres, the same each time, with its figures."""
    file("ball.off", shapes.off(*shapes.sphere()))
    answer = report("spheres", "ball.off", "--count", 20, "-o", "a.spheres")
    assert answer["count"] == 20 and answer["coverage"] > 0.9
    assert {"outside", "distance", "depth_error", "seconds"} <= set(answer)
    rows = [line for line in (WORK / "a.spheres").read_text().splitlines() if line and line[0] != "#"]
    assert len(rows) == 20 and all(len(row.split()) == 4 for row in rows)
    report("spheres", "ball.off", "--count", 20, "-o", "b.spheres")
    assert (WORK / "a.spheres").read_bytes() == (WORK / "b.spheres").read_bytes()
    aimed = report("spheres", "ball.off", "--coverage", 0.9, "--depth-error", 0.2)
    assert aimed["coverage"] >= 0.9 and aimed["depth_error"] <= 0.2 and aimed["hardest"] == "coverage", aimed
    assert report("spheres", "ball.off", "--count", 5)["hardest"] is None


@check
@alike
def spheres_command_says_what_it_cannot_do():
    """spheres refuses what is out of range, unknown or too much, and takes regions."""
    file("ball.off", shapes.off(*shapes.sphere()))
    refuses("spheres", "ball.off", says=["--count"])
    refuses("spheres", "ball.off", "--count", 0, says=["--count"])
    refuses("spheres", "ball.off", "--count", 5, "--coverage", 0.9, says=["--count", "--coverage"])
    refuses("spheres", "ball.off", "--coverage", 1.5, says=["--coverage", "1.5", "0 to 0.9999"])
    refuses("spheres", "ball.off", "--outside", 0.1, "--thickness", 0, says=["ball.off", "sheet", "tolerance"])
    refuses("spheres", "ball.off", "--count", 5, "--unit", "parsec", says=["parsec", "mm"])
    refuses("spheres", "ball.off", "--count", 5, "-o", "no/such/x.spheres", says=["no/such"])
    refuses("spheres", "ball.off", "--count", 5, "--method", "balancd", says=["balancd", "balanced"])
    refuses("spheres", "ball.off", "--count", 5, "--mode", "balanced", says=["--mode", "--method"])
    refuses("spheres", "ball.off", "--count", 5, "--region", "0,0,0,0.01", says=["--region", "X,Y,Z,RADIUS,DENSITY"])
    refuses("spheres", "ball.off", "--count", 5, "--region", "0,0,0,0.01,99", says=["--region", "99", "0.0625 to 16"])
    report("spheres", "ball.off", "--count", 5, "--region", "0,0.02,0,0.01,4", "--region", "0,0,0.02,0.01,0.5")


@check
def spheres_of_curves_and_sheets():
    """spheres are strung along a .curve and spread over a sheet; what does not go together is said."""
    file("two.curve", "0 0 0 0.01\n0.1 0 0 0.01\n")
    answer = report("spheres", "two.curve", "--count", 11, "-o", "two.spheres")
    assert answer["count"] == 11 and answer["coverage"] > 0.95 and answer["outside"] < 0.05
    rows = [list(map(float, line.split())) for line in (WORK / "two.spheres").read_text().splitlines() if line[0] != "#"]
    assert [round(row[0], 9) for row in rows] == [round(0.01 * i, 9) for i in range(11)], rows
    refuses("spheres", "two.curve", "--count", 11, "--unit", "mm", says=["two.curve", "--unit"])
    refuses("spheres", file("bent.curve", "0 0 0 0.01\n0.1 0 0\n"), "--count", 11, says=["bent.curve:3", "radius"])
    file("flat.off", shapes.off([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2), (0, 2, 3)]))
    refuses("spheres", "flat.off", "--count", 9, says=["flat.off", "encloses no volume", "--thickness"])
    answer = report("spheres", "flat.off", "--count", 9, "--thickness", 0)
    assert answer["coverage"] == 1 and answer["depth_error"] is None and 0.1 < answer["distance"]["mean"] < 0.25, answer
    assert report("spheres", "flat.off", "--count", 9, "--thickness", 0.1)["coverage"] < 0.1


@check
@alike
@long_run
def spheres_series():
    """--counts measures each number, and draws and tabulates the same points."""
    file("ball.off", shapes.off(*shapes.sphere()))
    answer = report("spheres", "ball.off", "--counts", "4,2,8,4", "--svg", "s.svg", "--csv", "s.csv")
    assert [point["count"] for point in answer["points"]] == [2, 4, 8] and "enough" in answer and answer["worth"] == 0.01
    rows = [line.split(",") for line in (WORK / "s.csv").read_text().splitlines()]
    assert rows[0][0] == "count" and [float(row[5]) for row in rows[1:]] == [point["depth_error"] for point in answer["points"]]
    picture = xml.etree.ElementTree.parse(WORK / "s.svg").getroot()
    assert picture.tag.endswith("svg") and len([e for e in picture.iter() if e.tag.endswith("circle") or "scale" in e.get("transform", "")]) == 2 * 4 * 3 + 4
    assert report("spheres", "ball.off", "--count", 8)["depth_error"] == answer["points"][2]["depth_error"]
    refuses("spheres", "ball.off", "--counts", "4,x", says=["--counts", "\"x\""])
    refuses("spheres", "ball.off", "--counts", "4", "-o", "s.spheres", says=["--output"])
    refuses("spheres", "ball.off", "--count", "4", "--svg", "s.svg", says=["--counts"])
    refuses("spheres", "ball.off", "--counts", "4", "--count", 4, says=["give one of them"])
    refuses("spheres", "ball.off", "--counts", "2", "--svg", "ball.off", says=["ball.off", "input"])


@check
@alike
def centreline_command():
    """centreline writes the middle line of a tube with its radius, whole or between two ends, and says what is no tube."""
    file("tube.off", shapes.off(*shapes.tube()))
    answer = report("centreline", "tube.off", "--points", 9, "-o", "tube.curve")
    assert answer["points"] == 9 and abs(answer["length"] - 0.08) < 0.001 and abs(answer["radius"]["max"] - 0.005) < 0.0003
    assert answer["branches"] == 0 and answer["side_branches"] == [] and answer["outside"] == 0 and answer["components"] == 1
    assert answer["cover"] > 0.99 and "is not followed" not in spore("centreline", "tube.off", "-o", "told.curve").stdout
    rows = [[float(word) for word in line.split()] for line in (WORK / "tube.curve").read_text().splitlines() if line[0] != "#"]
    assert len(rows) == 9 and all(abs(y) < 2e-4 and abs(z) < 2e-4 for _, y, z, _ in rows)
    answer = report("centreline", "tube.off", "--first-place", "0.02,-0.004,0", "--last-place", "0.06,0,-0.001")
    assert abs(answer["length"] - 0.04) < 0.001 and 0.6 < answer["cover"] < 0.8  # and two radii beyond each end
    assert "is not followed" in spore("centreline", "tube.off", "-o", "told.curve", "--first-place", "0.02,-0.004,0", "--last-place", "0.06,0,-0.001").stdout
    file("ball.off", shapes.off(*shapes.sphere()))
    refuses("centreline", "ball.off", "-o", "ball.curve", says=["ball.off", "not a tube"])
    assert not (WORK / "ball.curve").exists()
    refuses("centreline", "tube.off", "--first-place", "0.02,-0.004", "--last-place", "0.06,0,0", says=["--first-place", "three numbers"])
    refuses("centreline", "tube.off", "--first-place", "0.02,0,0", says=["--first-place", "--last-place"])
    refuses("centreline", "tube.off", "--ends", "0.02,0,0", "0.06,0,0", says=["--ends", "--first-place"])
    refuses("centreline", "tube.off", "--first-place", "0.02,0,0", "--last-place", "-0.06,0,0", says=["end 2", "outside"])
    refuses("centreline", "tube.off", "--points", 5, "--tolerance", 0.1, says=["--points", "--tolerance"])
    refuses("centreline", "tube.off", "--points", 1, says=["1 points"])
    refuses("centreline", "tube.off", "-o", "tube.off", says=["tube.off", "input"])


CORNERS = ("0.02,0.02,0.02", "-0.02,0.02,0.02", "-0.02,-0.02,0.02", "0.02,-0.02,0.02")


def patch_scene():
    """A ball, and a sheet of a sixth of it."""
    scene = WORK / "patch" / "patch.spore"
    if not scene.exists():
        file("ball.off", shapes.off(*shapes.sphere()))
        spore("spline", "ball.off", "--corners", *CORNERS, "--scene", scene)
    return scene


@check
@alike
def spline_command():
    """spline makes a sheet of the patch between four corners, whose scene runs under gravity, held by a pin; what is no patch is refused."""
    file("ball.off", shapes.off(*shapes.sphere()))
    answer = report("spline", "ball.off", "--corners", *CORNERS, "--control-points", 9, "-o", "patch.off")
    assert answer["control_points"] == [9, 9] and answer["fold_overs"] == 0 and answer["reached"]
    assert 0 < answer["sheet_to_patch_m"]["rms"] <= answer["sheet_to_patch_m"]["max"] < 0.001 and abs(answer["area_kept"] - 1) < 0.01
    assert [side["open_edge"] for side in answer["sides"]] == [False] * 4
    lengths = [side["length_m"] for side in answer["sides"]]
    assert max(lengths) - min(lengths) < 0.05 * max(lengths), lengths
    again = report("spline", "patch.off", "--first-corner", CORNERS[0], "--second-corner", CORNERS[1], "--third-corner", CORNERS[2],
                   "--fourth-corner", CORNERS[3])
    assert abs(again["area_m2"] / answer["area_m2"] - 1) < 1e-6 and all(side["open_edge"] for side in again["sides"])
    fewest = report("spline", "ball.off", "--corners", *CORNERS, "--tolerance", 0.002)["control_points"]
    assert fewest == [6, 6], fewest
    scene = patch_scene()
    spore("edit", scene, "--hold", "ball_sheet", "-o", "patch/held.spore")
    assert not [d for d in report("check", "patch/held.spore")["diagnostics"] if d["severity"] == "error"]
    answer = report("run", "patch/held.spore", "--time", 0.5, "--watch", "ball_sheet@0,0,0.03", "--output", "patch/held.csv", "--every", 0.1)
    assert answer["monitor"]["recoveries"] == 0 and answer["monitor"]["unsolved"] == []
    text = scene.read_text()
    anew = report("spline", scene, "--body", "ball_sheet", "--control-points", 14)
    assert anew["control_points"] == [14, 14] and scene.read_text().count("<body ") == text.count("<body ")
    refuses("spline", "ball.off", "--corners", CORNERS[0], CORNERS[2], CORNERS[1], CORNERS[3], says=["meets another side", "in turn"])
    refuses("spline", "ball.off", "--corners", *CORNERS[:3], says=["--corners", "3"])
    refuses("spline", "ball.off", "--first-corner", CORNERS[0], says=["1 corners", "four"])
    refuses("spline", "ball.off", says=["closed", "four corners"])
    refuses("spline", "ball.off", "--corners", *CORNERS, "--as", "asset", says=["--scene"])
    refuses("spline", "ball.off", "--corners", *CORNERS, "-o", "patch.stl", says=["patch.stl", ".off"])
    refuses("spline", scene, "--body", "ball", "-o", "patch.off", says=["--output"])


@check
@alike
def centreline_scenes():
    """centreline --scene writes bodies that check passes and that run without an alarm."""
    file("tube.off", shapes.off(*shapes.tube()))
    for kind in ("thread", "tube", "intestine"):
        scene = f"along/{kind}.spore"
        answer = report("centreline", "tube.off", "--scene", scene, "--as", kind)
        assert answer["skin"] == "mesh"
        worse = [d for d in report("check", scene)["diagnostics"] if d["severity"] == "error"]
        assert not worse, worse
        answer = report("run", scene, "--time", 0.2)
        assert answer["monitor"]["recoveries"] == 0 and answer["monitor"]["frozen"] == [] and answer["spheres"] > 8
    assert 'control_points="12"' in (report("centreline", "tube.off", "--scene", "along/twelve.spore", "--control-points", 12)
                                    and (WORK / "along/twelve.spore").read_text())
    answer = report("centreline", "tube.off", "--scene", "along/rooted.spore", "--as", "intestine", "--root",
                    file("root.curve", "0 0.05 0 0.001\n0.08 0.05 0 0.001\n"))["root"]
    assert answer["from"].endswith("root.curve") and abs(answer["length"] - 0.08) < 1e-9 and abs(answer["mesentery_mean"] - 0.05) < 5e-4
    assert ' root="tube-root"' in (WORK / "along/rooted.spore").read_text()
    assert report("run", "along/rooted.spore", "--time", 0.5)["monitor"]["unsolved"] == []
    answer = report("centreline", "tube.off", "--scene", "along/proposed.spore", "--as", "intestine")["root"]
    assert answer["from"] == "proposed" and answer["mesentery_max"] < 0.001  # a straight bowel is its own middle
    answer = report("centreline", "tube.off", "--scene", "along/none.spore", "--as", "intestine", "--root-degree", 0)
    assert "root" not in answer and " root=" not in (WORK / "along/none.spore").read_text()
    refuses("centreline", "tube.off", "--scene", "along/no.spore", "--as", "tube", "--root", "root.curve", says=["--root", "intestine"])
    refuses("centreline", "tube.off", "--scene", "along/no.spore", "--as", "intestine", "--root", "tube.off", says=["tube.off"])
    refuses("centreline", "tube.off", "--scene", "along/no.spore", "--as", "intestine", "--root-degree", 8, says=["--root-degree"])
    refuses("centreline", "tube.off", "--scene", "along/no.spore", "--as", "tub", says=["--as", "tube"])
    refuses("centreline", "tube.off", "--as", "tube", says=["--scene"])
    refuses("centreline", "tube.off", "--scene", "along/no.spore", "--control-points", 3, says=["3", "4 to"])
    assert not (WORK / "along/no.spore").exists()


@check
def tetrahedra_command():
    """tetrahedra fills a mesh in each format by each method, spheres fill tetrahedra; options out of range are refused."""
    file("ball.off", shapes.off(*shapes.sphere()))
    answer = report("tetrahedra", "ball.off", "--cells", 300, "-o", "ball.mesh")
    assert 250 < answer["tetrahedra"] < 350 and answer["min_dihedral_deg"] >= 10
    assert answer["method"] == ("direct" if "cgal" in FEATURES else "voxels")
    assert [r["method"] for r in answer["refused"]] == ([] if "cgal" in FEATURES else ["direct", "repaired", "wrapped"])
    assert abs(answer["volume"]["result"] / answer["volume"]["given"] - 1 - answer["volume"]["change"]) < 1e-9
    answer = report("spheres", "ball.mesh", "--count", 20, "-o", "cells.spheres")
    assert answer["count"] == 20 and answer["coverage"] > 0.9
    refuses("spheres", file("bad.mesh", "MeshVersionFormatted 2\nnonsense\n"), "--count", 20, says=["bad.mesh:3", "Tetrahedra"])
    for name, mark in (("ball.vtu", "UnstructuredGrid"), ("ball.msh", "$MeshFormat"), ("ball.mesh", "Tetrahedra")):
        spore("tetrahedra", "ball.off", "--cells", 300, "--method", "voxels", "-o", name)
        assert mark in (WORK / name).read_text()
    outer, inner = shapes.sphere(), shapes.sphere(radius=0.015)
    turned = [tuple(corner + len(outer[0]) for corner in reversed(triangle)) for triangle in inner[1]]
    file("hollow.off", shapes.off(outer[0] + inner[0], outer[1] + turned))
    answer = report("tetrahedra", "hollow.off", "--cells", 300, "--fill")
    assert abs(answer["filled_m3"] / (4 / 3 * math.pi * 0.015**3) - 1) < 0.1
    assert "nothing was filled: no cavity is closed off" in spore("tetrahedra", "ball.off", "--cells", 300, "--fill").stdout
    refuses("tetrahedra", "ball.off", "--cells", 300, "-o", "ball.xyz", says=["ball.xyz", ".vtu"])
    refuses("tetrahedra", "ball.off", "--cells", 300, "--method", "magic", says=["magic", "voxels"])
    refuses("tetrahedra", "ball.off", "--cells", 300, "--curvature", 3, says=["curvature", "5 to 90"])
    refuses("tetrahedra", "ball.off", "--cells", 300, "--tolerance", -1, says=["--tolerance"])
    refuses("tetrahedra", "ball.off", "--cells", 300, "--gap", -1, says=["--gap"])
    for region in ("1,2,3", "0,0,0,1,-1", "0,0,0,0,1", "0,0,0,1,nan", "a,b,c,d,e"):
        refuses("tetrahedra", "ball.off", "--cells", 300, "--region", region, says=["--region"])
    file("one.off", shapes.off([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]))
    refuses("tetrahedra", "one.off", "--cells", 300, says=["one.off", "volume"])


@check
def tetrahedra_of_parts():
    """tetrahedra tells what becomes of each part of a file by its name, and takes the parts that are asked for."""
    if "assimp" not in FEATURES: return
    organ, vessel, chamber = shapes.sphere(), shapes.sphere(radius=0.02), shapes.sphere(radius=0.015)
    text, before = "", 1
    for name, (corners, triangles), along in ("organ", organ, 0), ("vessel", vessel, 0.04), ("chamber", chamber, 0):
        text += f"o {name}\n" + "".join("v %.9g %.9g %.9g\n" % (x + along, y, z) for x, y, z in corners)
        text += "".join("f %d %d %d\n" % tuple(before + corner for corner in triangle) for triangle in triangles)
        before += len(corners)
    file("parts.obj", text)
    ask = "tetrahedra", "parts.obj", "--cells", 300, "--method", "voxels"
    answer = report(*ask)
    roles = {part["name"]: part["role"] for part in answer["parts"]}
    assert roles == {"organ": "merged", "vessel": "merged", "chamber": "inside"}, roles
    inside = next(part for part in answer["parts"] if part["name"] == "chamber")
    assert answer["parts"][inside["in"]]["name"] == "organ" and 0.010 < inside["least_depth_m"] < 0.0155, inside
    assert [part["wall"] for part in answer["parts"] if part["wall"] != "none"] == [inside["wall"]] == ["closed"], answer
    hollow = report(*ask, "--hollow")
    assert "cavity" in [part["role"] for part in hollow["parts"] if part["name"] == "chamber"]
    assert hollow["volume"]["result"] < answer["volume"]["result"] - 1e-5
    alone = report(*ask, "--parts", "organ")
    assert [(part["name"], part["role"]) for part in alone["parts"]] == [("organ", "bounds")], alone["parts"]
    assert [part["name"] for part in report(*ask, "--pieces", "largest")["parts"]] == ["organ", "chamber"]
    apart = report("tetrahedra", "parts.obj", "--cells", 1000, "--pieces", "apart", "-o", "apart.mesh")
    lines = (WORK / "apart.mesh").read_text().split("\n")
    first = lines.index("Tetrahedra") + 2
    tags = [int(line.split()[4]) for line in lines[first:first + apart["tetrahedra"]]]
    assert [tags.count(1 + i) for i in range(3)] == [part["cells"] for part in apart["parts"]], apart["parts"]
    assert min(part["cells"] for part in apart["parts"]) > 20 and apart["shared_faces"] > 20, apart
    assert apart["border_distance"] < 0.02 and apart["border_lost"] < 0.2, apart
    assert all(part["merged_with"] == -1 and part["thickness_m"] > 0.005 for part in apart["parts"]), apart["parts"]
    refuses(*ask, "--pieces", "apart", "--curvature", 20, says=["kept apart", "leave these out"])
    assert "chamber: " in spore(*ask).stdout and "chamber: " not in spore(*ask, "--parts", "organ, vessel").stdout
    refuses(*ask, "--parts", "spleen", says=["spleen", "organ, vessel, chamber"])


@check
def bad_meshes():
    """Each bad mesh gets one clear line and leaves no file."""
    ball = shapes.sphere()
    nan = shapes.off([(float("nan"), 0, 0)] + ball[0][1:], ball[1])
    index = shapes.off(ball[0], ball[1][:-1] + [(0, 1, 99999)])
    (WORK / "folder.stl").mkdir(exist_ok=True)
    for name, content, says in (("none.stl", None, ["none.stl"]), ("folder.stl", None, ["folder.stl"]),
                                ("empty.stl", b"", ["empty.stl"]), ("text.stl", b"Dear diary, no mesh today.\n", ["text.stl"]),
                                ("nan.off", nan, ["nan.off", "vertex"]), ("index.off", index, ["index.off", "99999"]),
                                ("cut.glb", b"glTF\x02\x00\x00\x00\xff\xff\x00\x00\x10", ["cut.glb"])):
        if content is not None:
            file(name, content)
        refuses("import", name, "--unit", "m", "-o", "bad/bad.spore", says=says)
        refuses("spheres", name, "--count", 10, "-o", "bad.spheres", says=says)
    assert not (WORK / "bad").exists() and not (WORK / "bad.spheres").exists()


@check
def bad_scenes():
    """Each bad scene gets its line, column, value and remedy."""
    good = soft_ball().read_text()
    bomb = '<?xml version="1.0"?>\n<!DOCTYPE x [<!ENTITY a "aaaaaaaaaa">' + "".join(
        f'<!ENTITY a{i} "&a{i - 1 if i else ""};&a{i - 1 if i else ""};">' for i in range(30)) + "]>\n<spore>&a29;</spore>\n"
    cases = [("unknown", good.replace("<collision spheres=\"one\"/>", "<colision spheres=\"one\"/>"), [":15:7:", "colision", "collision"]),
             ("range", good.replace('time_step="0.001"', 'time_step="-1"'), [":4:11:", "-1", "time_step"]),
             ("number", good.replace('time_step="0.001"', 'time_step="fast"'), [":4:11:", "fast"]),
             ("nan", good.replace('gravity="0 -9.81 0"', 'gravity="0 nan 0"'), [":3:16:", "nan"]),
             ("twice", good.replace('name="floor" role', 'name="ball" role'), [":18:", "ball"]),
             ("outside", good.replace('file="ball.off"', 'file="../secret.off"'), [":6:", "../secret.off"]),
             ("absolute", good.replace('file="ball.off"', 'file="/etc/passwd"'), [":6:", "/etc/passwd"]),
             ("newer", good.replace('version="1.0"', 'version="2.0"', 2).replace('<?xml version="2.0"', '<?xml version="1.0"'), ["2.0"]),
             ("noversion", good.replace('<spore version="1.0">', "<spore>"), ["version"]),
             ("bomb", bomb, [":2:", "DOCTYPE"]), ("cut", good[:300], ["cut.spore:"]), ("empty", "", ["empty.spore"]),
             ("binary", b"\x00\x01\x02\xff" * 50, ["binary.spore"]),
             ("reference", good.replace('spheres="one"', 'spheres="won"'), ["won"]),
             ("asset", good.replace('file="ball.off"', 'file="gone.off"'), ["gone.off"])]
    for name, text, says in cases:
        assert text != good, name
        refuses("run", file(f"soft/{name}.spore", text), "--steps", 1, says=[name + ".spore"] + says)
    refuses("run", WORK / "none.spore", says=["none.spore"])
    refuses("run", WORK, says=[str(WORK)])
    for name, text, _ in cases:
        (WORK / f"soft/{name}.spore").unlink()


@check
def disk_full_leaves_things_as_they_were():
    """When the disk is full, saving says so and leaves the old file whole."""
    file("ball.off", shapes.off(*shapes.sphere()))
    file("keep.spheres", "0 0 0 1\n")
    limit = lambda: (signal.signal(signal.SIGXFSZ, signal.SIG_IGN), resource.setrlimit(resource.RLIMIT_FSIZE, (16, 16)))
    refuses("spheres", "ball.off", "--count", 20, "-o", "keep.spheres", says=["keep.spheres"], preexec_fn=limit)
    assert (WORK / "keep.spheres").read_text() == "0 0 0 1\n"
    assert not [p for p in WORK.iterdir() if p.name.startswith((".keep", "keep.spheres."))]


def temporaries(folder=None):
    """Files that are left where something was not written whole."""
    return [path for path in (folder or WORK).rglob("*") if path.name.startswith(".spore-")]


def writers():
    """Every command that writes a file: its arguments, and the file."""
    file("ball.off", shapes.off(*shapes.sphere()))
    file("tube.off", shapes.off(*shapes.tube()))
    commands = [("spheres ball.off --count 5 -o", "w.spheres"), ("tetrahedra ball.off --cells 100 --method voxels -o", "w.vtu"),
                ("surface ball.off --nodes 100 -o", "w.off"), (f"spline ball.off --corners {' '.join(CORNERS)} -o", "w.off"),
                (f"spline ball.off --corners {' '.join(CORNERS)} --scene", "w.spore"), ("centreline tube.off -o", "w.curve"),
                ("spheres ball.off --counts 2,4 --csv", "w.csv"), ("import ball.off --unit m -o", "w.spore"),
                (f"edit {organ()} --probe -o", "w.spore"), ("centreline tube.off --scene", "w.spore"),
                (f"run {grasper()} --steps 20 --record", "w.track"), (f"run {soft_ball()} --steps 5 --output", "w.csv")]
    return commands + ([(f"render {soft_ball()} --size 64x64 -o", "w.png")] if "render" in FEATURES else [])


@check
@alike
def a_limit_of_size_leaves_nothing():
    """A file that grows beyond the limit of its size is an error: no file, no folder and no temporary file is left."""
    limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (16, 16))
    for command, name in writers():
        folder = f"limit/{command.split()[0]}" if name.endswith(".spore") else "."
        stopped = spore(*command.split(), f"{folder}/{name}", status=2, preexec_fn=limit).stderr
        assert "File too large" in stopped and len(stopped.splitlines()) == 1, stopped
        assert not (WORK / folder / name).exists() and not temporaries(), command
    assert not (WORK / "limit").exists()


@check
def a_full_device_is_said():
    """What cannot be printed, or written to a full device, gives status 2."""
    scene = soft_ball()
    with open("/dev/full", "w") as full:
        for command in ("--help", "--version", "run --help", "models", "models --json", "schema", f"check {scene}", f"check {scene} --json",
                        f"plan {scene}", f"plan {scene} --json", f"run {scene} --steps 2", f"run {scene} --steps 2 --json"):
            done = subprocess.run([SPORE, *command.split()], stdout=full, stderr=subprocess.PIPE, text=True, cwd=WORK, timeout=300)
            assert done.returncode == 2 and "standard output" in done.stderr, (command, done)
        subprocess.run([SPORE, "run", scene, "--steps", "2", "--quiet"], stdout=full, cwd=WORK, timeout=300, check=True) # prints nothing
    for command, name in writers():
        if not name.endswith(".spore"):
            assert "/dev/full" in spore(*command.split(), "/dev/full", status=2).stderr, command


@check
def a_read_only_folder_is_noticed_first():
    """A folder that takes no files is noticed before the input is read; nothing else is said."""
    with tempfile.TemporaryDirectory(prefix="spore-e2e-") as place:
        os.chmod(place, 0o755)
        locked = pathlib.Path(place) / "locked"
        locked.mkdir()
        (locked / "old.spore").write_text("no scene")
        locked.chmod(0o555)
        nobody = (lambda: os.setuid(65534)) if os.geteuid() == 0 else None
        if nobody and subprocess.run([SPORE, "--version"], preexec_fn=nobody, capture_output=True, cwd="/").returncode != 0:
            raise Skip("another user cannot run spore here")
        for command, name in writers():
            words = [word if not re.search(r"\.[a-z]+$", word) else f"no-such{pathlib.Path(word).suffix}" for word in command.split()]
            for target in [name] + ([f"new/{name}"] if name.endswith(".spore") else []):
                done = subprocess.run([SPORE, *words, locked / target], preexec_fn=nobody, capture_output=True, text=True, cwd="/", timeout=60)
                assert done.returncode == 2 and "Permission denied" in done.stderr and "no-such" not in done.stderr, (words, done)
        for command in ("edit --probe", "spheres --count 4"):
            done = subprocess.run([SPORE, *command.split(), locked / "old.spore"], preexec_fn=nobody, capture_output=True, text=True, cwd="/", timeout=60)
            assert done.returncode == 2 and "Permission denied" in done.stderr, done
        locked.chmod(0o755)


@check
def long_names_are_shortened():
    """A name of a megabyte is not echoed whole; the message keeps its beginning and its remedy."""
    long = "a" * (1 << 20)
    good = soft_ball().read_text()
    for name, text in (("element", good.replace("<rigid_body/>", f"<{long}/>")), ("attribute", good.replace("role=\"passive\"", f"{long}=\"1\"")),
                       ("value", good.replace("role=\"passive\"", f"role=\"{long}\"")), ("reference", good.replace("spheres=\"one\"", f"spheres=\"{long}\""))):
        assert text != good, name
        line = refuses("run", file(f"soft/long-{name}.spore", text), says=[f"long-{name}.spore:"])
        assert len(line) < 6000, (name, len(line))
    for words in ([long[:100000]], ["models", long[:100000]], ["run", long[:100000]], ["run", soft_ball(), "--set", f"{long[:100000]}/a=1"],
                  ["run", soft_ball(), f"--{long[:100000]}"], ["run", soft_ball(), "--integrator", long[:100000]]):
        line = refuses(*words, says=["aaaa", "; "])
        assert len(line) < 6000, (words[0][:20], len(line))


@check
def interruption_keeps_a_recording():
    """Ctrl-C while a run is recorded leaves the track that was there."""
    track = file("kept.track", "an old track\n")
    process = subprocess.Popen([SPORE, "run", grasper(), "--steps", "1000000000", "--record", track], cwd=WORK, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    wait_for_work(process)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=60)
    assert process.returncode == 130 and track.read_text() == "an old track\n" and not temporaries()


@check
def hostile_meshes_take_little():
    """glTF that stands for more than it holds is refused before it is expanded, by a helper that may take little."""
    def altered(change):
        whole = shapes.glb(ball=shapes.sphere())
        size = struct.unpack_from("<I", whole, 12)[0]
        text, rest = json.loads(whole[20:20 + size]), whole[20 + size:]
        change(text)
        packed = json.dumps(text).encode()
        packed += b" " * (-len(packed) % 4)
        return struct.pack("<4sII", b"glTF", 2, 20 + len(packed) + len(rest)) + struct.pack("<I4s", len(packed), b"JSON") + packed + rest

    def nested(text):
        text["nodes"] = [{"children": [i + 1, i + 1]} for i in range(60)] + [{"mesh": 0}]
        text["scenes"] = [{"nodes": [0]}]

    def shown_often(text):
        text["nodes"] = [{"mesh": 0}] * 100000
        text["scenes"] = [{"nodes": list(range(100000))}]

    spore("import", file("sound.glb", altered(lambda text: None)), "--unit", "m", "-o", "hostile/sound.spore") if "assimp" in FEATURES else None
    for name, change, says in (("nested", nested, "tree"), ("often", shown_often, "decimate"),
                               ("offset", lambda text: text["accessors"][0].update(byteOffset=-12), "byteOffset -12"),
                               ("view", lambda text: text["bufferViews"][0].update(byteOffset=-12), "byteOffset -12"),
                               ("stride", lambda text: text["bufferViews"][0].update(byteStride=1 << 31), "byteStride 2147483648")):
        refuses("import", file(f"{name}.glb", altered(change)), "--unit", "m", "-o", "hostile/no.spore", says=[f"{name}.glb", says])


@check
def short_of_memory():
    """With any limit of memory a command ends with a status of the contract and one line, and leaves no half-written file."""
    if SANITIZED:
        raise Skip("a sanitizer takes terabytes of address space")
    scene = soft_ball()
    old = "an old track\n"
    statuses = set()

    def run(limit, *words):
        bound = lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
        return subprocess.run([SPORE, *map(str, words)], capture_output=True, text=True, cwd=WORK, timeout=300, preexec_fn=bound)

    low, high = 1 << 20, 1 << 32 # the least with which the program itself is loaded
    while high - low > 1 << 16:
        middle = (low + high) // 2
        low, high = (low, middle) if run(middle, "--version").returncode == 0 else (middle, high)
    for words in (["run", scene, "--steps", 50, "--record", "short.track"], ["run", SCENES / "minimal.spore", "--steps", 50, "--json"],
                  ["check", scene], ["edit", scene, "--probe", "-o", "short/edit/new.spore"], ["import", file("ball.off", shapes.off(*shapes.sphere())), "--unit", "m", "-o", "short/import/ball.spore"]):
        fine = range(0, 64) if SCENES / "minimal.spore" in words else () # of 16 KiB
        for extra in [*(k << 14 for k in fine), *(k << 17 for k in range(0, 512))]:
            file("short.track", old)
            done = run(high + extra, *words)
            statuses.add(done.returncode)
            found = words[0] == "check" and done.returncode == 1 # what check prints is what it found
            assert done.returncode in (0, 2, 3) or found and "memory" in done.stdout and "correct it" not in done.stdout, (words, extra, done)
            assert done.returncode == 0 or len((done.stdout if found else done.stderr).strip().splitlines()) == 1, (words, extra, done)
            assert not temporaries(), (words, extra)
            assert done.returncode == 0 or (WORK / "short.track").read_text() == old
            assert words[0] not in ("edit", "import") or done.returncode != 2 or not (WORK / "short" / words[0]).exists(), extra
            if done.returncode == 0:
                break
        assert done.returncode == 0, (words, done)
    assert statuses >= {0, 2}, statuses
    print("# statuses:", sorted(statuses))


@check
def no_output_destroys_an_input():
    """No command writes over what it reads, also by another name; nor is what is no regular file read or replaced."""
    mesh = file("ball.off", shapes.off(*shapes.sphere()))
    (WORK / "other-name.off").unlink(missing_ok=True)
    (WORK / "other-name.off").symlink_to("ball.off")
    before = mesh.read_bytes()
    for output in ("ball.off", "other-name.off"):
        refuses("import", "ball.off", "-o", output, says=[output, "input"])
        refuses("spheres", "ball.off", "--count", 5, "-o", output, says=[output, "input"])
    assert mesh.read_bytes() == before
    scene = soft_ball()
    before = scene.read_bytes()
    refuses("run", scene, "--steps", 1, "--record", scene, says=[scene.name])
    if "render" in FEATURES:
        refuses("render", scene, "-o", scene, says=[scene.name])
    assert scene.read_bytes() == before
    os.mkfifo(WORK / "pipe")
    refuses("run", scene, "--steps", 1, "--input", "pipe", says=["pipe", "track"])
    if "render" in FEATURES:
        refuses("render", scene, "-o", "pipe", says=["pipe"])
        assert (WORK / "pipe").is_fifo()
    (WORK / "pipe").unlink()
    done = spore("run", scene, "--steps", 1, "--record", "no/such/folder.track", status=2)
    assert done.stderr.count("folder.track") == 1, done.stderr


def sheet_of(points):
    """A scene with a sheet of points x points control points; 200 is the most that may be."""
    file("sheets/sheet.off", "OFF\n9 8 0\n" + "".join(f"{x} {y} 0\n" for y in (0, .05, .1) for x in (0, .05, .1))
         + "".join(f"3 {a} {a + 1} {a + 4}\n3 {a} {a + 4} {a + 3}\n" for a in (0, 1, 3, 4)))
    return file(f"sheets/{points}.spore", f"""<spore version="1.0"><assets><mesh name="m" file="sheet.off"/></assets>
<bodies><body name="sheet"><mechanical geometry="m"><spline_2d control_points_u="{points}" control_points_v="{points}"/>
</mechanical></body></bodies></spore>""")


def interrupt(number, *arguments, asked_alone=False):
    """Sends the signal to a command at work. asked_alone: the timer that ends what does not ask is blocked."""
    def block():
        if asked_alone:
            signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGALRM])
    process = subprocess.Popen([SPORE, *map(str, arguments)], cwd=WORK, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                               preexec_fn=block)
    wait_for_work(process)
    assert process.poll() is None, f"{arguments} ended by itself: {process.communicate()}"
    process.send_signal(number)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 130, f"{arguments}: {process.returncode}\n{err.decode()}"
    assert b"Sanitizer" not in err, err.decode()
    return out


@check
def interruption_ends_work():
    """Ctrl-C ends long work with status 130 and leaves no half-written file (how soon: the benchmark `interrupt`)."""
    file("fine.off", shapes.off(*shapes.sphere(rings=60, sectors=120)))
    for number in (signal.SIGINT, signal.SIGTERM):
        interrupt(number, "run", soft_ball(), "--steps", 1000000000)
        interrupt(number, "spheres", "fine.off", "--count", 3000, "-o", "never.spheres")
    assert not (WORK / "never.spheres").exists()


@check
@alike
def interruption_ends_a_long_step():
    """A scene that takes minutes a step ends while it is made or stepped: the kernel asks, and there is a timer."""
    scene = sheet_of(200)
    interrupt(signal.SIGTERM, "run", scene, "-n", 100, asked_alone=True)
    interrupt(signal.SIGTERM, "plan", scene, "--measure", asked_alone=True)
    interrupt(signal.SIGTERM, "run", scene, "-n", 100, "--set", "solver/linear=cholesky")


@check
def interruption_leaves_no_torn_picture():
    """SIGTERM while a large picture is written leaves the old picture or the new one, whole, and nothing beside it."""
    if "render" not in FEATURES:
        raise Skip("built without the renderer")
    scene, picture = soft_ball(), WORK / "torn" / "large.png"
    picture.parent.mkdir(exist_ok=True)
    for _ in range(2):
        picture.write_bytes(b"old")
        process = subprocess.Popen([SPORE, "render", scene, "--size", "1200x1200", "-o", picture], cwd=WORK, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while process.poll() is None and not temporaries(picture.parent):
            time.sleep(0.0005)
        process.send_signal(signal.SIGTERM)
        assert process.wait(60) in (0, 130), process.returncode
        content = picture.read_bytes()
        assert content == b"old" or content.endswith(b"IEND\xaeB`\x82") and content.startswith(b"\x89PNG"), len(content)
        assert os.listdir(picture.parent) == ["large.png"], os.listdir(picture.parent)


@check
@alike
def stability_pushes_a_scene():
    """stability gives each case a verdict, each body its largest step, a map, and what it left out; a case that failed is status 1."""
    answer = report("stability", SCENES / "table1-rigid.spore", "--quick", "--svg", "map.svg", "--time", 0.2)
    cases = {case["name"]: case for case in answer["cases"]}
    assert cases["as_written"]["verdict"] == "stable" and cases["input_nan"]["verdict"] == "recovered", cases
    assert "held" in cases["input_nan"]["detail"] and all(case["detail"] for case in cases.values())
    assert answer["dt_limit_s"] == [{"body": "ovary", "method": "implicit_euler", "own": True, "step_s": 0.004, "predicted_s": None,
                                     "safe_s": 0.1, "unsafe_s": None}], answer["dt_limit_s"]
    assert answer["map"]["verdicts"][1][2] == "stable" and answer["map"]["time_step_s"][2] == 0.004
    assert any("not with --quick" in left["reason"] and "time step x 16" in left["what"] for left in answer["left_out"])
    picture = xml.etree.ElementTree.parse(WORK / "map.svg").getroot()
    assert "table1-rigid.spore" in picture.find("{http://www.w3.org/2000/svg}title").text
    net = report("stability", SCENES / "table1-mass-spring.spore", "--quick", "--time", 0.001)
    (limit,) = net["dt_limit_s"]
    assert limit["method"] == "symplectic_euler" and abs(limit["safe_s"] / limit["predicted_s"] - 1) < 0.05, limit
    refused = {case["name"]: case for case in net["cases"]}["time_step_x4"]
    assert refused["verdict"] == "recovered" and "expected at most" in refused["detail"], refused
    # Two bodies, one far too heavy for the other's contacts.
    failed = spore("stability", WORK / "fragile.spore", "--quick", "--time", 0.1, status=1) if fragile() else None
    assert "failed" in failed.stdout and "stack" in failed.stdout, failed.stdout


def fragile():
    """A scene that fails as written: a body with a velocity that no contact stops."""
    soft_ball()
    text = (WORK / "soft" / "soft.spore").read_text().replace('"ball" role="passive" position="0 0.02 0"', '"stack" role="passive" position="0 0.02 0" velocity="0 -200 0"')
    return file("fragile.spore", text.replace('file="', 'file="soft/'))


@check
def stability_refuses_what_it_cannot_do():
    """Bad input to stability is status 2, and leaves no map."""
    refuses("stability", "no.spore", "--svg", "never.svg", says=["no.spore"])
    refuses("stability", soft_ball(), "--time", 0, says=["--time", "expected more than 0 s"])
    refuses("stability", soft_ball(), "--seconds", "long", says=["--seconds", "long"])
    refuses("stability", soft_ball(), "--svg", "no/folder/map.svg", says=["no/folder"])
    refuses("stability", soft_ball(), "--svg", soft_ball(), says=["soft.spore", "this is the input"])
    refuses("stability", soft_ball(), "--dt", 1, says=["time_step"])
    assert not (WORK / "never.svg").exists()
    interrupt(signal.SIGTERM, "stability", sheet_of(60), "--svg", "never.svg", asked_alone=True)
    assert not (WORK / "never.svg").exists()


@check
@alike
def what_takes_long_is_said_beforehand():
    """check and plan say what takes longer than a second to make and longer than its time step to run, and no more."""
    said = [one["message"] for one in report("check", sheet_of(150))["diagnostics"]]
    for text in ("s to make", "each time that its matrix is factorised", "s a step, longer than its time step of 0.002 s"):
        assert [one for one in said if one.startswith('"sheet" takes ') and text in one], (text, said)
    assert not [one for one in report("check", sheet_of(10))["diagnostics"] if "takes" in one["message"]]
    work = {points: report("plan", sheet_of(points))["bodies"][0] for points in (10, 60)}
    assert 0 < work[10]["step_s"] < 0.002 < work[60]["step_s"] and work[60]["make_s"] < 1 and work[60]["factor_s"] < 1, work
    said = spore("plan", sheet_of(60)).stdout
    assert "longer than its time step" in said and "to make" not in said, said
    assert "takes" not in spore("plan", sheet_of(10)).stdout


@check
def links_what_it_needs():
    """spore links neither GTK nor CGAL's libraries nor assimp, in any build."""
    linked = subprocess.run(["ldd", SPORE], capture_output=True, text=True, check=True).stdout
    for library in ("gtk", "assimp", "gmp", "mpfr") + (() if "render" in FEATURES else ("epoxy", "libpng")):
        assert library not in linked, library


if __name__ == "__main__":
    main(**dict(zip(("kind", "part", "parts"), sys.argv[3:])))
